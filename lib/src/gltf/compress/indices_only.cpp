// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/indices_only.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "gltf/compress/compress.h"

namespace mcc::gltf {
namespace {

/// Marks accessors that more than one piece uses, or a piece and something else.
std::vector<bool> sharedAccessors(const Document& document,
                                  const std::vector<PayloadPlan>& payloads) {
  std::vector<const PayloadPlan*> all;
  for (const PayloadPlan& payload : payloads) all.push_back(&payload);
  std::vector<bool> is_shared = accessorsOutsidePayloads(document, all);
  std::vector<const PiecePlan*> user(is_shared.size(), nullptr);  // the first user
  for (const PayloadPlan& payload : payloads) {
    for (const PiecePlan& piece : payload.pieces) {
      for (const AttributePlan& attribute : piece.ordinary) {
        const PiecePlan*& first = user[attribute.accessor];
        if (first == nullptr) first = &piece;
        if (first != &piece) is_shared[attribute.accessor] = true;
      }
    }
  }
  return is_shared;
}

/// Whether the elements may be stored in another order. Sparse and coded accessors would grow, and
/// accessors without a view have no elements to move.
bool canBeReordered(const Document& document, const Accessor& accessor) {
  const bool is_coded = accessor.view != kNone && document.views[accessor.view].isCoded();
  return accessor.sparse.count == 0 && accessor.is_known_type && !is_coded;
}

}  // namespace

void planIndicesOnly(const Document& document, std::vector<PayloadPlan>& payloads) {
  for (PayloadPlan& payload : payloads) {
    payload.indices_only = true;
    for (PiecePlan& piece : payload.pieces) {
      std::vector<AttributePlan> all = std::exchange(piece.attributes, {});
      std::move(piece.ordinary.begin(), piece.ordinary.end(), std::back_inserter(all));
      piece.ordinary = std::move(all);
    }
  }
  const std::vector<bool> is_shared = sharedAccessors(document, payloads);
  for (PayloadPlan& payload : payloads) {
    payload.keep_vertex_order |= document.foreign.keep_numbers;
    for (const PiecePlan& piece : payload.pieces) {
      for (const AttributePlan& attribute : piece.ordinary) {
        payload.keep_vertex_order |=
            is_shared[attribute.accessor] ||
            !canBeReordered(document, document.accessors[attribute.accessor]);
      }
    }
  }
}

AttributeView weldingView(const PiecePlan& piece) {
  const AttributePlan& position = piece.ordinary[0];
  AttributeView view;
  view.format = position.format;
  view.data = position.source.data;
  view.stride_bytes = position.source.stride_bytes;
  return view;
}

void reorderAttributes(const Document& document, const PiecePlan& piece,
                       const std::vector<uint32_t>& source_wedge, Json& accessors,
                       std::vector<NewView>& views) {
  std::set<uint32_t> reordered;  // an accessor may serve as several attributes
  for (const AttributePlan& attribute : piece.ordinary) {
    const Accessor& accessor = document.accessors[attribute.accessor];
    if (accessor.view == kNone || !reordered.insert(attribute.accessor).second) continue;
    std::vector<uint8_t> tight;
    for (const uint32_t wedge : source_wedge) {
      const auto element = attribute.source.element(wedge);
      tight.insert(tight.end(), element.begin(), element.end());
    }
    NewView view;
    view.target = kArrayBuffer;
    view.hold(packAttribute(tight, accessor, view.stride_bytes));
    Json& edited = accessors[attribute.accessor];
    edited.erase("byteOffset");
    edited["bufferView"] = kFirstNewView + views.size();
    views.push_back(std::move(view));
  }
}

}  // namespace mcc::gltf
