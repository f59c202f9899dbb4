// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/plan.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <tuple>

#include "gltf/document/references.h"
#include "mesh/face_mesh.h"

namespace mcc::gltf {
namespace {

constexpr uint64_t kMaxTargets = 4096;

class Planner {
 public:
  Planner(const Document& document, std::vector<PayloadPlan>& payloads,
          std::vector<LeftAlone>& left_alone)
      : document_(document), payloads_(payloads), left_alone_(left_alone) {}

  Result run() {
    findFilledAccessors();
    Result result;
    std::string mesh_part;
    visitPrimitives(document_.json, [&](const PrimitiveRef& ref, const Json& primitive) {
      if (!result.ok()) return;
      if (ref.primitive == 0) {
        mesh_part =
            orderDependentPart(document_.json["meshes"][ref.mesh], NumbersOfVertices::kStay);
      }
      std::string note;
      result = planPrimitive(ref, primitive, mesh_part, note);
      if (!note.empty()) left_alone_.push_back({ref, note});
    });
    return result;
  }

 private:
  /// A triangle list of a piece, identified by its index accessor and mode.
  struct KnownPart {
    std::string note;   ///< why it cannot be coded
    PartPlan plan;      ///< valid until the first primitive uses it
    size_t number = 0;  ///< number in the piece, valid from then on
    bool is_used = false;
  };

  /// A piece in the plan and its parts, by index accessor and mode.
  struct KnownPiece {
    bool is_used = false;  ///< a part of it is used; only then is its place in the plan known
    size_t payload = 0;
    size_t number = 0;
    std::map<std::pair<uint32_t, uint64_t>, KnownPart> parts;
  };

  Result planPrimitive(const PrimitiveRef& ref, const Json& json, const std::string& mesh_part,
                       std::string& note) {
    if (!json.is_object()) return error(ref.path(), "must be an object");
    uint64_t mode = 4;
    MCC_GLTF_TRY(readOptionalUnsigned(json, "mode", ref.path(), kNone, mode));
    if (mode < 4) return checkReferences(ref, json);
    const Json* extensions = findMember(json, "extensions");
    if (extensions != nullptr && !extensions->is_object()) {
      return error(ref.path() + "/extensions", "must be an object");
    }
    note = mode > 6 ? "has the mode " + std::to_string(mode) + ", which is unknown; left as it was"
                    : extensionNote(json, mesh_part);
    if (!note.empty()) return {};
    const std::string own_part = orderDependentPart(json, NumbersOfVertices::kCanChange);
    const std::string& unknown = own_part.empty() ? mesh_part : own_part;

    PiecePlan piece;
    MCC_GLTF_TRY(collectAttributes(ref, json, piece));
    note = attributeNote(piece);
    if (note.empty()) note = codedNote(json, piece);
    if (!note.empty()) return {};
    piece.wedge_count =
        static_cast<uint32_t>(document_.accessors[piece.attributes[0].accessor].count);
    uint32_t indices = kNone;
    MCC_GLTF_TRY(readIndicesNumber(ref, json, indices));
    note = zeroNote(piece, indices);
    if (!note.empty()) return {};

    KnownPiece& known = pieces_[pieceKey(piece)];
    const auto [found, is_new] = known.parts.try_emplace({indices, mode});
    KnownPart& part = found->second;
    if (is_new) {
      part.plan.indices_accessor = indices;
      part.plan.mode = mode;
      MCC_GLTF_TRY(collectTriangles(ref, piece.wedge_count, part.plan, part.note));
    }
    note = part.note;
    if (note.empty() && !unknown.empty() && (mode != 4 || indices == kNone)) {
      note = "has " + unknown +
             ", which may rely on it not being an indexed triangle list; left as it was";
    }
    return note.empty() ? addUser(ref, !unknown.empty(), std::move(piece), known, part) : Result{};
  }

  static std::string extensionNote(const Json& json, const std::string& mesh_part) {
    if (mesh_part == "EXT_mesh_manifold") {  // it shares the bytes of the primitives' indices
      return "belongs to a mesh with EXT_mesh_manifold; left as it was";
    }
    return extensionOf(json, kExtensionName) == nullptr ? "" : "is compressed already";
  }

  /// Marks the accessors that payloads of the source fill.
  void findFilledAccessors() {
    is_filled_.assign(document_.accessors.size(), false);
    visitPrimitives(document_.json, [&](const PrimitiveRef&, const Json& primitive) {
      const Json* extension = extensionOf(primitive, kExtensionName);
      if (extension == nullptr) return;
      visitFilledAccessors(primitive, *extension, [&](uint64_t accessor) {
        if (accessor < is_filled_.size()) is_filled_[accessor] = true;
      });
    });
  }

  /// Returns why an accessor cannot be read, or may mean something else than what can be read.
  std::string unreadableNote(uint32_t index) const {
    const Accessor& accessor = document_.accessors[index];
    if (is_filled_[index]) return "is in the payload of another primitive";
    std::string unknown = unknownExtension(document_.json["accessors"][index]);
    for (const uint32_t view :
         {accessor.view, accessor.sparse.index_view, accessor.sparse.value_view}) {
      const bool is_used = view != kNone && (view == accessor.view || accessor.sparse.count != 0);
      if (is_used && unknown.empty()) {
        unknown = unknownExtension(document_.json["bufferViews"][view]);
      }
    }
    return unknown.empty() ? whyUnreadable(document_, accessor)
                           : "has the unknown extension " + unknown;
  }

  /// Returns why accessors of a primitive cannot be read; empty when they can be.
  std::string codedNote(const Json& json, const PiecePlan& piece) const {
    for (const AttributePlan& attribute : piece.attributes) {
      const std::string reason = unreadableNote(attribute.accessor);
      if (!reason.empty()) return attribute.label() + " " + reason + "; left as it was";
    }
    uint64_t accessor = 0;
    const Json* indices = findMember(json, "indices");
    if (indices != nullptr && asUnsigned(*indices, accessor) &&
        accessor < document_.accessors.size()) {
      std::string reason = unreadableNote(static_cast<uint32_t>(accessor));
      const Accessor& claimed = document_.accessors[accessor];
      if (reason.empty() && claimed.normalized) reason = "is normalized, which indices cannot be";
      if (!reason.empty()) return "its index accessor " + reason + "; left as it was";
    }
    if (extensionOf(json, kMeshExtension) == nullptr) return "";
    const bool is_decoded = indices != nullptr && accessor < document_.accessors.size() &&
                            document_.accessors[accessor].decoded != kNone;
    return is_decoded ? ""
                      : std::string("is compressed with ") + kMeshExtension + "; left as it was";
  }

  Result readAccessorIndex(const Json& json, const std::string& path, uint32_t& accessor) const {
    uint64_t index = 0;
    if (!asUnsigned(json, index)) return error(path, "must be the number of an accessor");
    if (index >= document_.accessors.size()) {
      return error(path, "there is no accessor " + std::to_string(index));
    }
    accessor = static_cast<uint32_t>(index);
    return {};
  }

  Result checkReferences(const PrimitiveRef& ref, const Json& json) const {
    PiecePlan ignored;
    MCC_GLTF_TRY(collectAttributes(ref, json, ignored));
    uint32_t accessor = kNone;
    return readIndicesNumber(ref, json, accessor);
  }

  /// Leaves `accessor` alone when there are no indices.
  Result readIndicesNumber(const PrimitiveRef& ref, const Json& json, uint32_t& accessor) const {
    const Json* indices = findMember(json, "indices");
    if (indices == nullptr) return {};
    return readAccessorIndex(*indices, ref.path() + "/indices", accessor);
  }

  Result collectMap(const Json& map, const std::string& path, uint32_t target,
                    PiecePlan& piece) const {
    if (!map.is_object()) return error(path, "must be an object");
    for (const auto& [name, value] : map.items()) {
      AttributePlan attribute;
      attribute.name = name;
      attribute.target = target;
      MCC_GLTF_TRY(readAccessorIndex(value, at(path, name), attribute.accessor));
      attribute.format = formatOf(name, target, document_.accessors[attribute.accessor]);
      piece.attributes.push_back(std::move(attribute));
    }
    return {};
  }

  Result collectAttributes(const PrimitiveRef& ref, const Json& json, PiecePlan& piece) const {
    const Json* attributes = findMember(json, "attributes");
    if (attributes == nullptr) return error(ref.path(), "\"attributes\" is missing");
    MCC_GLTF_TRY(collectMap(*attributes, ref.path() + "/attributes", kNone, piece));
    if (const Json* targets = findMember(json, "targets"); targets != nullptr) {
      const std::string path = ref.path() + "/targets";
      if (!targets->is_array()) return error(path, "must be an array");
      piece.target_count = static_cast<uint32_t>(targets->size());
      for (uint32_t i = 0; i < targets->size(); ++i) {
        MCC_GLTF_TRY(collectMap((*targets)[i], at(path, i), i, piece));
      }
    }
    std::stable_sort(piece.attributes.begin(), piece.attributes.end(), comesBefore);
    return {};
  }

  /// Returns why the attributes cannot be coded; empty when they can.
  std::string attributeNote(const PiecePlan& piece) const {
    if (piece.target_count > kMaxTargets) {
      return "has " + std::to_string(piece.target_count) + " morph targets, more than the " +
             std::to_string(kMaxTargets) + " of a payload; left as it was";
    }
    if (piece.attributes.empty() || piece.attributes[0].format.semantic != Semantic::kPosition ||
        piece.attributes[0].target != kNone) {
      return "has no POSITION of three components; left as it was";
    }
    const uint64_t count = document_.accessors[piece.attributes[0].accessor].count;
    if (count == 0) return "has 0 vertices; left as it was";
    if (count >= kMaxVertices) return "has 2^28 or more vertices; left as it was";
    for (const AttributePlan& attribute : piece.attributes) {
      const Accessor& accessor = document_.accessors[attribute.accessor];
      if (!accessor.is_known_type) {
        return attribute.label() + " has an unknown type; left as it was";
      }
      if (accessor.count != count) {
        return "has " + std::to_string(count) + " positions but " + std::to_string(accessor.count) +
               " elements of " + attribute.label() + "; left as it was";
      }
    }
    return "";
  }

  /// Returns why accessors without bytes in the file are too large together. If they are not,
  /// counts them and returns an empty string. The bound is needed because claimed counts cost a
  /// file nothing, while their elements cost us as much as any others.
  std::string zeroNote(const PiecePlan& piece, uint32_t indices) {
    std::set<uint32_t> accessors;
    for (const AttributePlan& attribute : piece.attributes) accessors.insert(attribute.accessor);
    if (indices != kNone) accessors.insert(indices);
    uint64_t bytes = 0;
    for (const uint32_t index : accessors) {
      const Accessor& accessor = document_.accessors[index];
      const bool is_zero = accessor.view == kNone && accessor.decoded == kNone;
      if (is_zero && !zeros_.contains(index)) bytes += accessor.count * accessor.tightBytes();
    }
    if (bytes > document_.decoded.zeroLimit() - zero_bytes_) {
      return "has accessors that have no bytes in the file and claim " + std::to_string(bytes) +
             "; left as it was (max_decoded_bytes, --max-decoded-bytes allow more)";
    }
    zero_bytes_ += bytes;
    zeros_.insert(accessors.begin(), accessors.end());
    return "";
  }

  Result collectTriangles(const PrimitiveRef& ref, uint32_t wedge_count, PartPlan& part,
                          std::string& note) const {
    if (part.indices_accessor != kNone) {
      MCC_GLTF_TRY(readIndices(document_, part.indices_accessor, part.triangles));
    } else {
      part.triangles.resize(wedge_count);
      std::iota(part.triangles.begin(), part.triangles.end(), 0u);
    }
    for (size_t i = 0; i < part.triangles.size(); ++i) {
      if (part.triangles[i] < wedge_count) continue;
      return error(ref.path() + "/indices", "index number " + std::to_string(i) + " is " +
                                                std::to_string(part.triangles[i]) +
                                                " but there are only " +
                                                std::to_string(wedge_count) + " vertices");
    }
    const size_t count = part.triangles.size();
    if (!expandTriangles(part.mode, part.triangles)) {
      note = "has " + std::to_string(count) + " indices, which make no triangles; left as it was";
    } else if (part.triangles.size() / 3 >= kMaxVertices) {
      note = "has 2^28 or more triangles; left as it was";
    }
    return {};
  }

  static std::string pieceKey(const PiecePlan& piece) {
    std::string key = std::to_string(piece.target_count);
    for (const AttributePlan& attribute : piece.attributes) {
      key += "/" + std::to_string(attribute.target + 1) + Json(attribute.name).dump() +
             std::to_string(attribute.accessor);
    }
    return key;
  }

  /// Returns the number of the payload of a mesh, which is created for its first piece.
  size_t payloadOf(uint32_t mesh) {
    if (payloads_.empty() || payloads_.back().mesh != mesh) {
      payloads_.emplace_back();
      payloads_.back().mesh = mesh;
    }
    return payloads_.size() - 1;
  }

  Result addUser(const PrimitiveRef& ref, bool keep_orders, PiecePlan&& piece, KnownPiece& known,
                 KnownPart& part) {
    if (!known.is_used) {
      keepBesidePayload(piece);
      for (auto* attributes : {&piece.attributes, &piece.ordinary}) {
        for (AttributePlan& attribute : *attributes) {
          MCC_GLTF_TRY(readAccessor(document_, attribute.accessor, attribute.source));
        }
      }
      known.is_used = true;
      known.payload = payloadOf(ref.mesh);
      known.number = payloads_[known.payload].pieces.size();
      payloads_[known.payload].pieces.push_back(std::move(piece));
    }
    PayloadPlan& payload = payloads_[known.payload];
    payload.keep_vertex_order |= keep_orders;
    payload.keep_triangle_order |= keep_orders;
    std::vector<PartPlan>& parts = payload.pieces[known.number].parts;
    if (!part.is_used) {
      part.is_used = true;
      part.number = parts.size();
      parts.push_back(std::move(part.plan));
    }
    parts[part.number].users.push_back(ref);
    return {};
  }

  /// Keeps attributes next to the payload that are more than all readers accept.
  static void keepBesidePayload(PiecePlan& piece) {
    constexpr size_t kMaxAttributes = Limits{}.max_attributes;
    if (piece.attributes.size() <= kMaxAttributes) return;
    const auto first = piece.attributes.begin() + kMaxAttributes;
    piece.ordinary.assign(std::make_move_iterator(first),
                          std::make_move_iterator(piece.attributes.end()));
    piece.attributes.erase(first, piece.attributes.end());
  }

  const Document& document_;
  std::vector<PayloadPlan>& payloads_;
  std::vector<LeftAlone>& left_alone_;
  std::map<std::string, KnownPiece> pieces_;
  std::vector<bool> is_filled_;  ///< accessors that are already compressed
  std::set<uint32_t> zeros_;     ///< accessors whose zeros were counted, and others
  uint64_t zero_bytes_ = 0;      ///< sum over all accessors that are read
};

}  // namespace

std::string AttributePlan::label() const {
  return target == kNone ? name : "target " + std::to_string(target) + " " + name;
}

AttributeView AttributePlan::view() const {
  AttributeView view;
  view.format = format;
  view.data = source.data;
  view.stride_bytes = source.stride_bytes;
  view.quantization_bits = bits;
  view.lattice = has_lattice ? &lattice : nullptr;
  return view;
}

bool comesBefore(const AttributePlan& a, const AttributePlan& b) {
  const auto key = [](const AttributePlan& attribute) {
    return std::tie(attribute.format.morph_target, attribute.format.semantic,
                    attribute.format.set_index, attribute.name);
  };
  return key(a) < key(b);
}

namespace {

/// What the limits of readers count in a payload.
struct PayloadCounts {
  uint64_t attributes = 0;
  uint64_t pieces = 0;
  uint64_t wedges = 0;
  uint64_t triangles = 0;

  void add(const PiecePlan& piece) {
    attributes += piece.attributes.size();
    ++pieces;
    wedges += piece.wedge_count;
    for (const PartPlan& part : piece.parts) triangles += part.triangles.size() / 3;
  }
  bool isAccepted() const {
    constexpr Limits kLimits;
    return attributes <= kLimits.max_attributes && pieces <= kLimits.max_pieces &&
           wedges <= kLimits.max_vertices && triangles <= kLimits.max_triangles;
  }
};

}  // namespace

namespace {

bool mayHaveBlocks(const ConvertOptions& options, const PayloadPlan& payload,
                   const PiecePlan& piece) {
  if (payload.keep_vertex_order || payload.keep_triangle_order || payload.indices_only)
    return false;
  uint64_t triangle_count = 0;
  for (const PartPlan& part : piece.parts) triangle_count += part.triangles.size() / 3;
  return blockTriangles(options.block_triangles, options.prefer, triangle_count) != 0;
}

}  // namespace

void splitPayloads(const ConvertOptions& options, std::vector<PayloadPlan>& payloads) {
  std::vector<PayloadPlan> split;
  for (PayloadPlan& payload : payloads) {
    PayloadCounts counts;
    bool is_open = false;
    for (PiecePlan& piece : payload.pieces) {
      const bool is_alone = mayHaveBlocks(options, payload, piece);
      counts.add(piece);
      if (!is_open || is_alone || !counts.isAccepted()) {
        counts = {};
        counts.add(piece);
        PayloadPlan& next = split.emplace_back();
        next.mesh = payload.mesh;
        next.keep_vertex_order = payload.keep_vertex_order;
        next.keep_triangle_order = payload.keep_triangle_order;
        next.indices_only = payload.indices_only;
      }
      is_open = !is_alone;
      // Attributes inside the payload and next to it must have the same order.
      split.back().keep_vertex_order |= !payload.indices_only && !piece.ordinary.empty();
      split.back().pieces.push_back(std::move(piece));
    }
  }
  payloads = std::move(split);
}

Result planPayloads(const Document& document, std::vector<PayloadPlan>& payloads,
                    std::vector<LeftAlone>& left_alone) {
  return Planner(document, payloads, left_alone).run();
}

}  // namespace mcc::gltf
