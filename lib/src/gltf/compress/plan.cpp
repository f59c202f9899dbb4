// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/plan.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "base/crc32.h"
#include "host/text.h"
#include "mesh/face_mesh.h"

namespace mcc::gltf {
namespace {

constexpr uint64_t kMaxTargets = 4096;

class Planner {
 public:
  Planner(const Document& document, std::vector<PayloadPlan>& payloads,
          std::vector<LeftAlone>& left_alone)
      : document_(document),
        accessors_(arrayOf(document.json, "accessors")),
        views_(arrayOf(document.json, "bufferViews")),
        payloads_(payloads),
        left_alone_(left_alone),
        room_bytes_(kMaxSharing * (document.source_bytes + document.decoded.total()) +
                    document.decoded.zeroLimit()) {}

  Result run() {
    const Json& meshes = arrayOf(document_.json, "meshes");
    MeshExtensions mesh;
    for (const Primitive& primitive : document_.primitives) {
      const PrimitiveRef& ref = primitive.ref;
      if (!primitive.json->is_object()) return error(ref.path(), "must be an object");
      if (ref.primitive == 0) mesh = extensionsOf(meshes[ref.mesh]);
      const std::string note = planPrimitive(primitive, mesh);
      const bool is_ours = extensionOf(*primitive.json, kExtensionName) != nullptr;
      if (!note.empty()) left_alone_.push_back({ref, note + (is_ours ? "" : "; left as it was")});
    }
    return {};
  }

 private:
  /// What the extensions of a mesh demand of its primitives.
  struct MeshExtensions {
    std::string order_part;  ///< what depends on the order of their elements, or empty
    bool is_manifold = false;
    std::set<uint64_t> grouped;  ///< those that EXT_mesh_primitive_restart draws together
  };

  /// A triangle list of a piece, identified by its index accessor and mode.
  struct KnownPart {
    std::string note;   ///< why it cannot be coded
    PartPlan plan;      ///< valid until the first primitive uses it
    size_t number = 0;  ///< number in the piece, valid from then on
    bool is_used = false;
  };

  /// A piece in the plan and its parts, by index accessor and mode.
  struct KnownPiece {
    std::string note;                   ///< why its elements cannot be read
    std::vector<AccessorData> sources;  ///< of its attributes, until the first primitive uses them
    bool is_used = false;  ///< a part of it is used; only then is its place in the plan known
    size_t payload = 0;
    size_t number = 0;
    std::map<std::pair<uint32_t, uint64_t>, KnownPart> parts;
  };

  /// Shortens a name that the notes of many primitives may repeat.
  static std::string nameInNote(const std::string& name) { return shortened(name, 100); }

  static MeshExtensions extensionsOf(const Json& mesh) {
    MeshExtensions result;
    result.order_part = nameInNote(orderDependentPart(mesh, NumbersOfVertices::kStay));
    result.is_manifold = extensionOf(mesh, kManifoldExtension) != nullptr;
    visitPath(&mesh, kGroupedPrimitives, [&](const Json& number) {
      uint64_t primitive = 0;
      if (asUnsigned(number, primitive)) result.grouped.insert(primitive);
    });
    return result;
  }

  /// Returns what is wrong with a primitive. Its place begins at the primitive.
  static std::string noteOf(const Result& result) {
    const std::string message = result.message();
    return message.starts_with("/") && !message.starts_with("/accessors") ? message.substr(1)
                                                                          : message;
  }

  /// Adds a primitive to the plan, or returns why it stays as it was.
  std::string planPrimitive(const Primitive& primitive, const MeshExtensions& mesh) {
    const Json& json = *primitive.json;
    uint64_t mode = 4;
    const Result has_mode = readOptionalUnsigned(json, "mode", "", kNone, mode);
    if (!has_mode.ok()) return noteOf(has_mode);
    if (mode < 4) return "";
    if (mode > 6) return sentence("has the mode ", mode, ", which is unknown");
    const Json* extensions = findMember(json, "extensions");
    if (extensions != nullptr && !extensions->is_object()) return "extensions: must be an object";
    std::string note = extensionNote(primitive, mesh);
    if (!note.empty()) return note;
    const std::string own_part =
        nameInNote(orderDependentPart(json, NumbersOfVertices::kCanChange));
    const std::string& unknown = own_part.empty() ? mesh.order_part : own_part;

    if (!primitive.fault.ok()) return noteOf(primitive.fault);
    PiecePlan piece = pieceOf(primitive);
    const uint32_t indices = primitive.indices;
    note = attributeNote(piece);
    if (note.empty()) note = codedNote(primitive, piece);
    if (!note.empty()) return note;
    piece.wedge_count =
        static_cast<uint32_t>(document_.accessors[piece.attributes[0].accessor].count);
    note = zeroNote(piece, indices);
    if (!note.empty()) return note;

    const auto [place, is_new_piece] = pieces_.try_emplace(pieceKey(piece));
    KnownPiece& known = place->second;
    if (is_new_piece) readPiece(piece, known);
    if (!known.note.empty()) return known.note;
    const auto [found, is_new] = known.parts.try_emplace({indices, mode});
    KnownPart& part = found->second;
    if (is_new) {
      part.plan.indices_accessor = indices;
      part.plan.mode = mode;
      part.note = collectTriangles(piece.wedge_count, part.plan);
      if (!part.note.empty()) part.plan.triangles = {};
    }
    if (!part.note.empty()) return part.note;
    if (!unknown.empty() && (mode != 4 || indices == kNone)) {
      return "has " + unknown + ", which may rely on it not being an indexed triangle list";
    }
    addUser(primitive.ref, !unknown.empty(), std::move(piece), known, part);
    return "";
  }

  static std::string extensionNote(const Primitive& primitive, const MeshExtensions& mesh) {
    if (mesh.is_manifold) {  // the extension shares the bytes of the primitives' indices
      return "belongs to a mesh with EXT_mesh_manifold";
    }
    if (mesh.grouped.contains(primitive.ref.primitive)) {  // the same, and no list of triangles
      return "belongs to a group of EXT_mesh_primitive_restart";
    }
    return extensionOf(*primitive.json, kExtensionName) == nullptr ? "" : "is compressed already";
  }

  /// Returns why an accessor cannot be read, or may mean something else than what can be read.
  std::string unreadableNote(uint32_t index) const {
    const Accessor& accessor = document_.accessors[index];
    if (accessor.is_filled) return "is in the payload of another primitive";
    std::string unknown = unknownExtension(accessors_[index]);
    for (const uint32_t view : accessor.views()) {
      if (unknown.empty()) unknown = unknownExtension(views_[view]);
    }
    return unknown.empty() ? whyUnreadable(document_, accessor)
                           : "has the unknown extension " + nameInNote(unknown);
  }

  /// Returns why accessors of a primitive cannot be read; empty when they can be.
  std::string codedNote(const Primitive& primitive, const PiecePlan& piece) const {
    for (const AttributePlan& attribute : piece.attributes) {
      const std::string reason = unreadableNote(attribute.accessor);
      if (!reason.empty()) return attribute.label() + " " + reason;
    }
    const bool has_indices = primitive.indices != kNone;
    if (has_indices) {
      std::string reason = unreadableNote(primitive.indices);
      if (reason.empty() && document_.accessors[primitive.indices].normalized) {
        reason = "is normalized, which indices cannot be";
      }
      if (!reason.empty()) return "its index accessor " + reason;
    }
    if (extensionOf(*primitive.json, kMeshExtension) == nullptr) return "";
    const bool is_decoded = has_indices && document_.accessors[primitive.indices].decoded != kNone;
    return is_decoded ? "" : std::string("is compressed with ") + kMeshExtension;
  }

  PiecePlan pieceOf(const Primitive& primitive) const {
    PiecePlan piece;
    piece.target_count = primitive.target_count;
    for (const auto& [name, target, accessor] : primitive.attributes) {
      AttributePlan& attribute = piece.attributes.emplace_back();
      attribute.name = name;
      attribute.target = target;
      attribute.accessor = accessor;
      attribute.format = formatOf(attribute.name, target, document_.accessors[accessor]);
    }
    std::stable_sort(piece.attributes.begin(), piece.attributes.end(), comesBefore);
    return piece;
  }

  /// Returns why the attributes cannot be coded; empty when they can.
  std::string attributeNote(const PiecePlan& piece) const {
    if (piece.target_count > kMaxTargets) {
      return sentence("has ", piece.target_count, " morph targets, more than the ", kMaxTargets,
                      " of a payload");
    }
    if (piece.attributes.empty() || !piece.attributes[0].isBase(Semantic::kPosition)) {
      return "has no POSITION of three components";
    }
    const uint64_t count = document_.accessors[piece.attributes[0].accessor].count;
    if (count == 0) return "has 0 vertices";
    if (count >= kMaxVertices) return "has 2^28 or more vertices";
    for (const AttributePlan& attribute : piece.attributes) {
      const Accessor& accessor = document_.accessors[attribute.accessor];
      if (!accessor.fault.ok()) {
        return attribute.label() + " " + whyUnreadable(document_, accessor);
      }
      if (!accessor.is_known_type) {
        return attribute.label() + " has a type that payloads cannot hold";
      }
      // glTF 2.1 has them for names that applications choose.
      if (accessor.component_type == ComponentType::kInt32 && !attribute.name.starts_with('_')) {
        return attribute.label() + " has signed integers of 32 bits";
      }
      if (accessor.count != count) {
        return sentence("has ", count, " positions but ", accessor.count, " elements of ",
                        attribute.label());
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
      return sentence("has accessors that have no bytes in the file and claim ", bytes,
                      " (max_decoded_bytes, --max-decoded-bytes allow more)");
    }
    zero_bytes_ += bytes;
    zeros_.insert(accessors.begin(), accessors.end());
    return "";
  }

  /// Takes room for elements that are going to be held, however many others share their bytes.
  /// Without this, a file could name the same bytes for each of its primitives.
  bool takeRoom(uint64_t bytes) {
    if (bytes > room_bytes_) return false;
    room_bytes_ -= bytes;
    return true;
  }

  static std::string roomNote() {
    return sentence("shares its bytes with so many others that together they hold more than ",
                    kMaxSharing, " times those of the file");
  }

  /// Reads the elements of a piece, or notes why they cannot be read.
  void readPiece(const PiecePlan& piece, KnownPiece& known) {
    uint64_t bytes = 0;
    for (const AttributePlan& attribute : piece.attributes) {
      bytes += uint64_t{piece.wedge_count} * document_.accessors[attribute.accessor].tightBytes();
    }
    if (!takeRoom(bytes)) known.note = roomNote();
    for (const AttributePlan& attribute : piece.attributes) {
      if (!known.note.empty()) break;
      known.sources.emplace_back();
      known.note = noteOf(readAccessor(document_, attribute.accessor, known.sources.back()));
    }
    if (!known.note.empty()) known.sources.clear();
  }

  std::string collectTriangles(uint32_t wedge_count, PartPlan& part) {
    const bool has_indices = part.indices_accessor != kNone;
    const uint64_t index_count =
        has_indices ? document_.accessors[part.indices_accessor].count : wedge_count;
    if (!takeRoom(index_count * (part.mode == 4 ? 4 : 12))) return roomNote();
    if (has_indices) {
      const Result read = readIndices(document_, part.indices_accessor, part.triangles);
      if (!read.ok()) return noteOf(read);
    } else {
      part.triangles.resize(wedge_count);
      std::iota(part.triangles.begin(), part.triangles.end(), 0u);
    }
    for (size_t i = 0; i < part.triangles.size(); ++i) {
      if (part.triangles[i] < wedge_count) continue;
      return sentence("index number ", i, " is ", part.triangles[i], " but there are only ",
                      wedge_count, " vertices");
    }
    if (!expandTriangles(part.mode, part.triangles)) {
      return sentence("has ", index_count, " indices, which make no triangles");
    }
    if (part.triangles.size() / 3 >= kMaxVertices) return "has 2^28 or more triangles";
    return "";
  }

  static std::string pieceKey(const PiecePlan& piece) {
    std::string key = std::to_string(piece.target_count);
    for (const AttributePlan& attribute : piece.attributes) {
      key += "/" + std::to_string(attribute.target + 1) + Json(attribute.name).dump() +
             std::to_string(attribute.accessor);
    }
    return key;
  }

  void addUser(const PrimitiveRef& ref, bool keep_orders, PiecePlan&& piece, KnownPiece& known,
               KnownPart& part) {
    if (!known.is_used) {
      for (size_t i = 0; i < piece.attributes.size(); ++i) {
        piece.attributes[i].source = std::move(known.sources[i]);
      }
      keepBesidePayload(piece);
      known.is_used = true;
      if (payloads_.empty() || payloads_.back().mesh != ref.mesh)
        payloads_.emplace_back().mesh = ref.mesh;
      known.payload = payloads_.size() - 1;
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
  const Json& accessors_;
  const Json& views_;
  std::vector<PayloadPlan>& payloads_;
  std::vector<LeftAlone>& left_alone_;
  std::map<std::string, KnownPiece> pieces_;
  std::set<uint32_t> zeros_;  ///< accessors whose zeros were counted, and others
  uint64_t zero_bytes_ = 0;   ///< sum over all accessors that are read
  uint64_t room_bytes_;       ///< that may still be held
};

}  // namespace

AttributeView AttributePlan::view() const {
  AttributeView view;
  view.format = format;
  view.data = source.data;
  view.stride_bytes = source.stride_bytes;
  view.quantization_bits = bits;
  view.lattice = has_lattice ? &lattice : nullptr;
  return view;
}

uint64_t PiecePlan::triangleCount() const {
  uint64_t count = 0;
  for (const PartPlan& part : parts) count += part.triangles.size() / 3;
  return count;
}

uint64_t PayloadPlan::triangleCount() const {
  uint64_t count = 0;
  for (const PiecePlan& piece : pieces) count += piece.triangleCount();
  return count;
}

void leaveAlone(const PiecePlan& piece, const std::string& note, bool is_larger,
                std::vector<LeftAlone>& left_alone) {
  for (const PartPlan& part : piece.parts) {
    for (const PrimitiveRef& user : part.users) left_alone.push_back({user, note, is_larger});
  }
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
    triangles += piece.triangleCount();
  }
  bool isAccepted() const {
    constexpr Limits kLimits;
    return attributes <= kLimits.max_attributes && pieces <= kLimits.max_pieces &&
           wedges <= kLimits.max_vertices && triangles <= kLimits.max_triangles;
  }
};

bool mayHaveBlocks(const ConvertOptions& options, const PayloadPlan& payload,
                   const PiecePlan& piece) {
  if (payload.keep_vertex_order || payload.keep_triangle_order || payload.indices_only)
    return false;
  return blockTriangles(options.block_triangles, options.prefer, piece.triangleCount()) != 0;
}

}  // namespace

void splitPayloads(const ConvertOptions& options, std::vector<PayloadPlan>& payloads) {
  std::vector<PayloadPlan> split;
  for (PayloadPlan& payload : payloads) {
    std::vector<PiecePlan> pieces = std::exchange(payload.pieces, {});
    PayloadCounts counts;
    bool is_open = false;
    for (PiecePlan& piece : pieces) {
      const bool is_alone = mayHaveBlocks(options, payload, piece);
      counts.add(piece);
      if (!is_open || is_alone || !counts.isAccepted()) {
        counts = {};
        counts.add(piece);
        split.push_back(payload);
      }
      is_open = !is_alone;
      // Attributes inside the payload and next to it must have the same order.
      split.back().keep_vertex_order |= !payload.indices_only && !piece.ordinary.empty();
      split.back().pieces.push_back(std::move(piece));
    }
  }
  payloads = std::move(split);
}

namespace {

/// The payload of a larger mesh has little header, and fills models of its own.
constexpr uint64_t kSmallWedges = 256;
/// Takes a few milliseconds to decode, so that workers can still divide a file among them.
constexpr uint64_t kGatheredWedges = 16384;

uint64_t wedgesOf(const PayloadPlan& payload) {
  uint64_t count = 0;
  for (const PiecePlan& piece : payload.pieces) count += piece.wedge_count;
  return count;
}

bool isSmall(const PayloadPlan& payload) {
  // Attributes next to a payload make it keep the order of its vertices.
  const auto is_inside = [](const PiecePlan& piece) { return piece.ordinary.empty(); };
  return wedgesOf(payload) <= kSmallWedges &&
         std::all_of(payload.pieces.begin(), payload.pieces.end(), is_inside);
}

/// Returns a number that is the same for equal meshes.
uint32_t hashOf(const PayloadPlan& payload) {
  uint32_t crc = 0;
  for (const PiecePlan& piece : payload.pieces) {
    for (const PartPlan& part : piece.parts) {
      crc = crc32({reinterpret_cast<const uint8_t*>(part.triangles.data()),
                   part.triangles.size() * sizeof(uint32_t)},
                  crc);
    }
    for (const AttributePlan& attribute : piece.attributes) {
      for (uint64_t i = 0; i < attribute.source.count; ++i) {
        crc = crc32(attribute.source.element(i), crc);
      }
    }
  }
  return crc;
}

/// Says of each payload whether it is small, and that of a mesh which equals no other.
std::vector<bool> mayBeGathered(const std::vector<PayloadPlan>& payloads) {
  std::vector<uint32_t> hashes;
  std::map<uint32_t, size_t> count_of;
  for (const PayloadPlan& payload : payloads) {
    hashes.push_back(isSmall(payload) ? hashOf(payload) : 0);
    ++count_of[hashes.back()];
  }
  std::vector<bool> may_be_gathered;
  for (size_t i = 0; i < payloads.size(); ++i) {
    may_be_gathered.push_back(isSmall(payloads[i]) && count_of[hashes[i]] == 1);
  }
  return may_be_gathered;
}

}  // namespace

void gatherPayloads(std::vector<PayloadPlan>& payloads) {
  const std::vector<bool> may_be_gathered = mayBeGathered(payloads);
  std::vector<PayloadPlan> gathered;
  size_t open = 0;                             // the payload that others join
  uint64_t wedge_count = kGatheredWedges + 1;  // its vertices; no payload is open yet
  for (size_t i = 0; i < payloads.size(); ++i) {
    PayloadPlan& payload = payloads[i];
    const uint64_t more = wedgesOf(payload);
    if (may_be_gathered[i] && wedge_count + more <= kGatheredWedges &&
        payload.keep_vertex_order == gathered[open].keep_vertex_order &&
        payload.keep_triangle_order == gathered[open].keep_triangle_order) {
      std::move(payload.pieces.begin(), payload.pieces.end(),
                std::back_inserter(gathered[open].pieces));
      wedge_count += more;
      continue;
    }
    if (may_be_gathered[i]) {
      open = gathered.size();
      wedge_count = more;
    }
    gathered.push_back(std::move(payload));
  }
  payloads = std::move(gathered);
}

Json extensionJson(uint64_t buffer_view, size_t piece_number, const PiecePlan& piece,
                   size_t part_number) {
  Json attributes = Json::object();
  std::vector<Json> targets(piece.attributes.empty() ? 0 : piece.target_count, Json::object());
  for (size_t id = 0; id < piece.attributes.size(); ++id) {
    const AttributePlan& attribute = piece.attributes[id];
    Json& map = attribute.target == kNone ? attributes : targets[attribute.target];
    map.append(attribute.name, id);  // names are unique
  }
  Json json = Json::object();
  // First, like the attributes of the primitive: brotli makes less of files whose parts resemble.
  if (!piece.attributes.empty()) json["attributes"] = std::move(attributes);
  json["bufferView"] = buffer_view;
  if (piece_number != 0) json["piece"] = piece_number;
  if (part_number != 0) json["part"] = part_number;
  if (!targets.empty()) json["targets"] = std::move(targets);
  return json;
}

Result planPayloads(const Document& document, std::vector<PayloadPlan>& payloads,
                    std::vector<LeftAlone>& left_alone) {
  return Planner(document, payloads, left_alone).run();
}

}  // namespace mcc::gltf
