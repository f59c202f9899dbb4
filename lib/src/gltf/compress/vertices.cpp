// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/vertices.h"

#include <cstring>
#include <iterator>
#include <set>
#include <utility>

#include "gltf/compress/savings.h"
#include "gltf/document/accessors.h"

namespace mcc::gltf {
namespace {

/// Marks accessors that more than one piece uses, or a piece and something else.
std::vector<bool> sharedAccessors(const Document& document,
                                  const std::vector<PayloadPlan>& payloads) {
  std::vector<bool> is_shared = accessorsOutsidePayloads(document, plansOf(payloads));
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
    addView(std::move(view), accessors[attribute.accessor], views);
  }
}

namespace {

/// Finds the accessors of vertex numbers of pieces.
class Collector {
 public:
  explicit Collector(const Document& document)
      : document_(document),
        accessors_(arrayOf(document.json, "accessors")),
        views_(arrayOf(document.json, "bufferViews")),
        room_(kMaxSharing * document.source_bytes) {}

  /// Collects the accessors of a piece. Returns false if one of them is also used by something
  /// else, or cannot be changed.
  bool collect(PiecePlan& piece) {
    std::vector<uint32_t> named;
    for (const PartPlan& part : piece.parts) {
      for (const PrimitiveRef& user : part.users) {
        visitExtensionAccessors(*document_.primitive(user).json,
                                [&](const Json& number, ExtensionAccessor what) {
                                  if (what != ExtensionAccessor::kVertexNumbers) return;
                                  named.push_back(indexOf(&number, document_.accessors.size()));
                                });
      }
    }
    std::sort(named.begin(), named.end());
    for (size_t i = 0, end = 0; i < named.size(); i = end) {
      while (end < named.size() && named[end] == named[i]) ++end;
      if (named[i] == kNone) return false;
      const Accessor& accessor = document_.accessors[named[i]];
      const bool is_only_ours =
          !accessor.isUsedOutsideMeshes() &&
          uint64_t{accessor.primitive_uses} + accessor.extension_uses == end - i;
      if (!is_only_ours || !canBeChanged(named[i], piece.wedge_count)) return false;
      piece.vertex_numbers.push_back(named[i]);
    }
    return true;
  }

 private:
  /// Whether the elements can be read and stored again in the same way. Accessors over the same
  /// bytes become separate, so there is a limit to them.
  bool canBeChanged(uint32_t index, uint32_t vertex_count) {
    const Accessor& accessor = document_.accessors[index];
    if (accessor.view == kNone || accessor.sparse.count != 0 || accessor.normalized) return false;
    if (document_.views[accessor.view].isCoded() || !unknownExtension(accessors_[index]).empty() ||
        !unknownExtension(views_[accessor.view]).empty() || accessor.count > room_) {
      return false;
    }
    room_ -= accessor.count;
    std::vector<uint32_t> numbers;
    if (!readIndices(document_, index, numbers).ok()) return false;
    return std::all_of(numbers.begin(), numbers.end(),
                       [&](uint32_t number) { return number < vertex_count; });
  }

  const Document& document_;
  const Json& accessors_;
  const Json& views_;
  uint64_t room_;  ///< numbers that may still be read
};

}  // namespace

void planVertexNumbers(const Document& document, std::vector<PayloadPlan>& payloads) {
  Collector collector(document);
  for (PayloadPlan& payload : payloads) {
    for (PiecePlan& piece : payload.pieces) {
      if (!collector.collect(piece)) payload.keep_vertex_order = true;
    }
    if (!payload.keep_vertex_order) continue;
    for (PiecePlan& piece : payload.pieces) piece.vertex_numbers.clear();
  }
}

void renumberVertices(const Document& document, const PiecePlan& piece,
                      const std::vector<uint32_t>& source_wedge, Json& accessors,
                      std::vector<NewView>& views) {
  if (piece.vertex_numbers.empty() || isIdentity(source_wedge)) return;
  const Json& old_views = arrayOf(document.json, "bufferViews");
  std::vector<uint32_t> decoded_wedge(source_wedge.size());
  for (uint32_t i = 0; i < source_wedge.size(); ++i) decoded_wedge[source_wedge[i]] = i;
  for (const uint32_t index : piece.vertex_numbers) {
    const Accessor& accessor = document.accessors[index];
    std::vector<uint32_t> numbers;
    // They could be read before. Without numbers, there is nothing to change.
    if (!readIndices(document, index, numbers).ok() || numbers.empty()) continue;
    for (uint32_t& number : numbers) number = decoded_wedge[number];
    NewView view;
    view.hold(narrowIndices(numbers, componentBytes(accessor.component_type)));
    uint64_t target = 0;
    if (asUnsigned(findMember(old_views[accessor.view], "target"), target) && target <= kNone) {
      view.target = static_cast<uint32_t>(target);
    }
    setBounds(boundsOf(numbers), ComponentType::kUint32, false, accessors[index]);
    addView(std::move(view), accessors[index], views);
  }
}

std::vector<uint32_t> usedVertices(const PiecePlan& piece) {
  std::vector<bool> is_used(piece.wedge_count, false);
  for (const PartPlan& part : piece.parts) {
    for (const uint32_t vertex : part.triangles) is_used[vertex] = true;
  }
  std::vector<uint32_t> used;
  for (uint32_t vertex = 0; vertex < piece.wedge_count; ++vertex) {
    if (is_used[vertex]) used.push_back(vertex);
  }
  return used;
}

void keepVertices(std::vector<uint32_t> kept, PiecePlan& piece) {
  std::vector<uint32_t> new_number(piece.wedge_count, kNone);
  for (uint32_t i = 0; i < kept.size(); ++i) new_number[kept[i]] = i;
  for (PartPlan& part : piece.parts) {
    for (uint32_t& vertex : part.triangles) vertex = new_number[vertex];
  }
  for (AttributePlan& attribute : piece.attributes) {
    AccessorData& source = attribute.source;
    std::vector<uint8_t> elements(kept.size() * source.element_bytes);
    for (size_t i = 0; i < kept.size(); ++i) {
      std::memcpy(elements.data() + i * source.element_bytes, source.element(kept[i]).data(),
                  source.element_bytes);
    }
    source.owned = std::move(elements);
    source.data = source.owned.data();
    source.stride_bytes = source.element_bytes;
    source.count = kept.size();
  }
  piece.wedge_count = static_cast<uint32_t>(kept.size());
  for (uint32_t& vertex : kept) {
    if (!piece.kept.empty()) vertex = piece.kept[vertex];
  }
  piece.kept = std::move(kept);
}

void planUnused(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                std::vector<std::string>& notes) {
  for (PayloadPlan& payload : payloads) {
    uint64_t unused = 0;
    bool is_kept = !options.drop_unused;
    for (PiecePlan& piece : payload.pieces) {
      std::vector<uint32_t> used = usedVertices(piece);
      if (used.size() == piece.wedge_count) continue;
      unused += piece.wedge_count - used.size();
      // An extension may refer to vertices by number, attributes may stay next to the payload, and
      // a primitive needs at least one vertex.
      const bool must_stay = payload.keep_vertex_order || !piece.vertex_numbers.empty() ||
                             !piece.ordinary.empty() || used.empty();
      if (must_stay) is_kept = true;
      if (options.drop_unused && !must_stay) keepVertices(std::move(used), piece);
    }
    if (unused == 0) continue;
    const std::string which =
        unused == 1 ? "1 vertex is" : std::to_string(unused) + " vertices are";
    notes.push_back(at("/meshes", payload.mesh) + ": " + which + " in no triangle" +
                    (!options.drop_unused ? "; --drop-unused leaves out what nothing refers to"
                     : is_kept            ? ", and not all can be left out"
                                          : ", and left out"));
  }
}

}  // namespace mcc::gltf
