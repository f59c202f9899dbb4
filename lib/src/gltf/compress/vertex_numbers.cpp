// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/vertex_numbers.h"

#include <algorithm>

#include "gltf/document/accessors.h"
#include "gltf/document/bounds.h"
#include "gltf/document/known_extensions.h"

namespace mcc::gltf {
namespace {

/// Calls visit(uint64_t accessor) for the accessors of vertex numbers of a primitive. A member that
/// is no number of an accessor counts as one that does not exist.
template <typename Visit>
void visitVertexNumbers(const Json& primitive, const Visit& visit) {
  visitExtensionAccessors(primitive, [&](const Json& number, ExtensionAccessor what) {
    if (what != ExtensionAccessor::kVertexNumbers) return;
    uint64_t accessor = 0;
    visit(asUnsigned(number, accessor) ? accessor : uint64_t{kNone});
  });
}

/// Counts the uses of an accessor: each member of a primitive that names it, and one for everything
/// else.
uint64_t useCount(const Accessor& accessor) {
  return uint64_t{accessor.primitive_uses} + accessor.extension_uses +
         (accessor.isUsedOutsideMeshes() ? 1 : 0);
}

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
    std::vector<uint64_t> named;
    for (const PartPlan& part : piece.parts) {
      for (const PrimitiveRef& user : part.users) {
        visitVertexNumbers(*document_.primitive(user).json,
                           [&](uint64_t accessor) { named.push_back(accessor); });
      }
    }
    std::sort(named.begin(), named.end());
    for (size_t i = 0, end = 0; i < named.size(); i = end) {
      while (end < named.size() && named[end] == named[i]) ++end;
      if (named[i] >= document_.accessors.size()) return false;
      const auto accessor = static_cast<uint32_t>(named[i]);
      const bool is_only_ours = useCount(document_.accessors[accessor]) == end - i;
      if (!is_only_ours || !canBeChanged(accessor, piece.wedge_count)) return false;
      piece.vertex_numbers.push_back(accessor);
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

bool isIdentity(const std::vector<uint32_t>& source_wedge) {
  for (uint32_t i = 0; i < source_wedge.size(); ++i) {
    if (source_wedge[i] != i) return false;
  }
  return true;
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
    const uint32_t bytes_each = componentBytes(accessor.component_type);
    std::vector<uint8_t> bytes;
    for (uint32_t& number : numbers) {
      number = decoded_wedge[number];
      for (uint32_t byte = 0; byte < bytes_each; ++byte) {
        bytes.push_back(static_cast<uint8_t>(number >> (8 * byte)));
      }
    }
    NewView view;
    view.hold(std::move(bytes));
    Json& edited = accessors[index];
    edited.erase("byteOffset");
    edited["bufferView"] = kFirstNewView + views.size();
    const Json* target = findMember(old_views[accessor.view], "target");
    uint64_t number = 0;
    if (target != nullptr && asUnsigned(*target, number) && number <= 0xffffffffu) {
      view.target = static_cast<uint32_t>(number);
    }
    setBounds(boundsOf(numbers), ComponentType::kUint32, false, edited);
    views.push_back(std::move(view));
  }
}

}  // namespace mcc::gltf
