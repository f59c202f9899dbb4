// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/extension_uses.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "gltf/document/accessors.h"

namespace mcc::gltf {

namespace {

const char* payloadErrorName(Error error) {
  switch (error) {
    case Error::kTruncated: return "PAYLOAD_TRUNCATED";
    case Error::kBadMagic: return "PAYLOAD_BAD_MAGIC";
    case Error::kUnsupportedVersion: return "PAYLOAD_UNSUPPORTED_VERSION";
    case Error::kBadChecksum: return "PAYLOAD_BAD_CHECKSUM";
    case Error::kBadHeader: return "PAYLOAD_BAD_HEADER";
    case Error::kBadConnectivity: return "PAYLOAD_BAD_CONNECTIVITY";
    case Error::kBadStitch: return "PAYLOAD_BAD_STITCH";
    case Error::kBadAttribute: return "PAYLOAD_BAD_ATTRIBUTE";
    case Error::kTrailingBytes: return "PAYLOAD_TRAILING_BYTES";
    case Error::kLimit: return "PAYLOAD_ABOVE_LIMIT";
    default: return rule::kPayload.code;  // out of memory, which is not the file's fault
  }
}

}  // namespace

void Issues::addPayloadError(const Status& status, const std::string& where) {
  add(Rule{payloadErrorName(status.error)}, toResult(status, where));
}

void Issues::append(const Issues& other) {
  for (size_t i = 0; i < std::size(counts_); ++i) counts_[i] += other.counts_[i];
  const size_t room = std::min(max_kept_ - kept_.size(), other.kept_.size());
  kept_.insert(kept_.end(), other.kept_.begin(),
               other.kept_.begin() + static_cast<std::ptrdiff_t>(room));
}

void Issues::add(const Rule& rule, Result what) {
  ++counts_[static_cast<size_t>(rule.severity)];
  if (kept_.size() < max_kept_) kept_.push_back({rule.severity, rule.code, std::move(what)});
}

namespace {

constexpr uint64_t kMaxNumber = 0xffffffffu;

/// Reads the number of an accessor at `path`. Returns false and adds an issue when it does not
/// exist.
bool readAccessorNumber(const Document& document, const Json& number, const std::string& path,
                        const Rule& rule, Issues& issues, uint32_t& accessor) {
  uint64_t index = 0;
  if (!issues.passes(rule, readUnsigned(number, path, kMaxNumber, index))) return false;
  if (index >= document.accessors.size()) {
    issues.add(rule::kReference, path, "there is no accessor ", index);
    return false;
  }
  accessor = static_cast<uint32_t>(index);
  return true;
}

/// Reads one map from names to attribute ids; the primitive's own map names the accessors.
void readMap(const Document& document, const Json& ids, const std::string& path,
             const Json* accessors, const std::string& accessors_path, uint32_t target,
             Issues& issues, ExtensionUse& use) {
  if (!ids.is_object()) return issues.add(rule::kSchema, path, "must be an object");
  for (const auto& [name, id] : ids.items()) {
    ExtensionUse::AttributeUse attribute;
    attribute.name = name;
    attribute.target = target;
    attribute.path = at(path, name);
    const bool has_id =
        issues.passes(rule::kSchema, readUnsigned(id, attribute.path, kMaxNumber, attribute.id));
    const Json* number = findMember(accessors, name);
    if (number == nullptr) {
      issues.add(rule::kAttributeName, attribute.path,
                 "the primitive has no attribute of this name");
    } else if (readAccessorNumber(document, *number, at(accessors_path, name), rule::kReference,
                                  issues, attribute.accessor) &&
               has_id) {
      use.attributes.push_back(std::move(attribute));
    }
  }
}

void readTargets(const Document& document, const Json& extension, const Json& primitive,
                 Issues& issues, ExtensionUse& use) {
  const Json* targets = findMember(extension, "targets");
  if (targets == nullptr) return;
  const std::string path = use.path + "/targets";
  if (!targets->is_array() || targets->empty()) {
    return issues.add(rule::kSchema, path, "must be an array that is not empty");
  }
  const Json& own = arrayOf(primitive, "targets");
  if (targets->size() != own.size()) {
    issues.add(rule::kTargetCount, path, "has ", targets->size(), " targets, the primitive ",
               own.size());
  }
  const std::string own_path = primitivePath(use.mesh, use.primitive) + "/targets";
  for (uint32_t i = 0; i < std::min(targets->size(), own.size()); ++i) {
    readMap(document, (*targets)[i], at(path, i), &own[i], at(own_path, i), i, issues, use);
  }
}

void readView(const Document& document, const Json& object, Issues& issues, PartUse& use) {
  uint64_t number = 0;
  if (!issues.passes(rule::kSchema,
                     readUnsigned(object, "bufferView", use.path, kMaxNumber, number))) {
    return;
  }
  const std::string path = use.path + "/bufferView";
  if (number >= document.views.size()) {
    return issues.add(rule::kReference, path, "there is no bufferView ", number);
  }
  const BufferView& view = document.views[number];
  if (!view.fault.ok()) return issues.add(rule::kPayloadView, path, view.fault.message());
  if (view.isCoded()) {
    return issues.add(rule::kPayloadView, path, "bufferView ", number, " is coded with ",
                      view.coding.extension);
  }
  use.view = static_cast<uint32_t>(number);
}

/// Reads which part of which payload an object names, the extension object or a preview.
void readPart(const Document& document, const Json& object, Issues& issues, PartUse& use) {
  readView(document, object, issues, use);
  const auto read = [&](const char* key, uint64_t& number) {
    return issues.passes(rule::kSchema,
                         readOptionalUnsigned(object, key, use.path, kMaxNumber, number));
  };
  const bool has_piece = read("piece", use.piece);
  use.has_numbers = read("part", use.part) && has_piece;
}

void readPreview(const Document& document, const Json& extension, Issues& issues,
                 ExtensionUse& use) {
  const Json* preview = findMember(extension, "preview");
  if (preview == nullptr) return;
  const std::string path = use.path + "/preview";
  if (!preview->is_object()) return issues.add(rule::kSchema, path, "must be an object");
  use.preview.emplace().path = path;
  readPart(document, *preview, issues, *use.preview);
}

void readExtension(const Document& document, const Json& extension, const Json& primitive,
                   Issues& issues, ExtensionUse& use) {
  const std::string primitive_path = primitivePath(use.mesh, use.primitive);
  use.path = primitive_path + "/extensions/" + kExtensionName;
  if (!extension.is_object()) return issues.add(rule::kSchema, use.path, "must be an object");
  if (findMember(primitive["extensions"], kMeshExtension) != nullptr) {
    issues.add(rule::kTwoCompressions, use.path, "the primitive is compressed with ",
               kMeshExtension, ", too");
  }
  readPart(document, extension, issues, use);
  uint64_t mode = 4;
  if (issues.passes(rule::kMode,
                    readOptionalUnsigned(primitive, "mode", primitive_path, 6, mode)) &&
      mode != 4) {
    issues.add(rule::kMode, primitive_path + "/mode",
               "must be 4 (triangles) in a compressed primitive");
  }
  if (const Json* indices = findMember(primitive, "indices"); indices != nullptr) {
    readAccessorNumber(document, *indices, primitive_path + "/indices", rule::kIndices, issues,
                       use.indices_accessor);
  } else {
    issues.add(rule::kIndices, primitive_path, "\"indices\" is missing");
  }
  if (const Json* ids = findMember(extension, "attributes"); ids != nullptr) {
    readMap(document, *ids, use.path + "/attributes", findMember(primitive, "attributes"),
            primitive_path + "/attributes", kNone, issues, use);
  }
  readTargets(document, extension, primitive, issues, use);
  readPreview(document, extension, issues, use);
}

std::string pathOf(const Primitive& primitive, const Primitive::Attribute& attribute) {
  const std::string path = primitive.ref.path();
  return at(
      attribute.target == kNone ? path + "/attributes" : at(path + "/targets", attribute.target),
      std::string(attribute.name));
}

/// Calls visit(const Primitive::Attribute&) for the attributes that no payload fills.
template <typename Visit>
void visitOrdinary(const Primitive& primitive, const Visit& visit) {
  const Json* extension = extensionOf(*primitive.json, kExtensionName);
  for (const Primitive::Attribute& attribute : primitive.attributes) {
    if (findMember(attributesOf(extension, attribute.target), attribute.name) == nullptr)
      visit(attribute);
  }
}

/// Finds accessors that have two sources, or that something else refers to as well.
class Sharing {
 public:
  Sharing(const Document& document, Issues& issues) : document_(document), issues_(issues) {}

  void check(const std::vector<ExtensionUse>& uses) {
    for (const ExtensionUse& use : uses) claimAll(use);
    for (const Primitive& primitive : document_.primitives) {
      const bool is_ours = extensionOf(*primitive.json, kExtensionName) != nullptr;
      if (!is_ours) note(primitive.indices, primitive.ref.path() + "/indices");
      visitOrdinary(primitive, [&](const Primitive::Attribute& attribute) {
        note(attribute.accessor, pathOf(primitive, attribute));
      });
    }
    for (const auto& [accessor, ignored] : origins_) {
      if (!document_.accessors[accessor].is_in_scene) continue;
      issues_.add(rule::kUsedElsewhere, at("/accessors", accessor),
                  "is filled from a payload, but something outside of meshes refers to it, too");
    }
  }

 private:
  /// Where the elements of an accessor come from: (buffer view, piece, is a part, id).
  using Origin = std::tuple<uint32_t, uint64_t, bool, uint64_t>;

  void claim(uint32_t accessor, const Origin& origin, const std::string& path) {
    if (accessor == kNone) return;
    const auto [found, is_new] = origins_.try_emplace(accessor, origin);
    if (is_new || found->second == origin) return;
    issues_.add(rule::kFilledTwice, path, "accessor ", accessor,
                " is filled from two different places of the payloads");
  }

  void claimAll(const ExtensionUse& use) {
    for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
      claim(attribute.accessor, {use.view, use.piece, false, attribute.id}, attribute.path);
    }
    claim(use.indices_accessor, {use.view, use.piece, true, use.part}, use.path);
  }

  /// Notes that something refers to an accessor which a payload fills. `accessor` may be kNone.
  void note(uint32_t accessor, const std::string& path) {
    if (!origins_.contains(accessor)) return;
    issues_.add(rule::kUsedElsewhere, path, "accessor ", accessor,
                " is filled from a payload; only what that payload fills may refer to it");
  }

  const Document& document_;
  Issues& issues_;
  std::map<uint32_t, Origin> origins_;
};

/// Checks that a piece has an attribute. `path` is the place in the JSON that says so.
bool hasAttribute(uint64_t id, const std::string& path, const PieceInfo& piece, Issues& issues) {
  if (id < piece.attributes.size()) return true;
  issues.add(rule::kAttributeNumber, path, "there is no attribute ", id,
             " in the payload's piece, which has ", piece.attributes.size());
  return false;
}

void checkAttribute(const Document& document, const ExtensionUse::AttributeUse& attribute,
                    const PieceInfo& piece, Issues& issues) {
  if (!hasAttribute(attribute.id, attribute.path, piece, issues)) return;
  const Accessor& accessor = document.accessors[attribute.accessor];
  const std::string accessor_path = at("/accessors", attribute.accessor);
  if (accessor.count != piece.wedge_count) {
    issues.add(rule::kCount, accessor_path + "/count", accessor.count,
               " does not match the payload, which has ", piece.wedge_count, " vertices");
  }
  if (!accessor.is_known_type) {
    return issues.add(rule::kType, accessor_path,
                      accessor.fault.ok() ? "the type is unknown" : accessor.fault.what);
  }
  if (attribute.name == "POSITION" && attribute.target == kNone && attribute.id != 0) {
    return issues.add(rule::kAttributeNumber, attribute.path,
                      "must be attribute 0, which all others are predicted from");
  }
  const AttributeFormat& coded = piece.attributes[attribute.id].format;
  const AttributeFormat named = formatOf(attribute.name, attribute.target, accessor);
  if (coded.component_type != named.component_type ||
      coded.component_count != named.component_count || coded.normalized != named.normalized) {
    return issues.add(rule::kType, accessor_path, "its type is ", describeType(accessor),
                      ", which is not that of attribute ", attribute.id, " in the payload");
  }
  if (coded != named) {
    issues.add(rule::kSemantic, attribute.path, "attribute ", attribute.id,
               " of the payload is not ", attribute.name,
               (attribute.target == kNone ? "" : " of this morph target"));
  }
}

void checkIndices(const Document& document, const ExtensionUse& use, const PieceInfo& piece,
                  Issues& issues) {
  if (use.indices_accessor == kNone) return;
  const Accessor& accessor = document.accessors[use.indices_accessor];
  const std::string path = at("/accessors", use.indices_accessor);
  if (use.part < piece.parts.size()) {
    const uint64_t count = uint64_t{3} * piece.parts[use.part].triangle_count;
    if (accessor.count != count) {
      issues.add(rule::kCount, path + "/count", accessor.count,
                 " does not match the payload, which has ", count, " indices");
    }
  }
  if (!isOfIndices(accessor) || accessor.normalized) {
    return issues.add(rule::kIndices, path, "indices must be SCALAR of an unsigned type");
  }
  if (!holdsIndices(accessor.component_type, piece.wedge_count)) {
    issues.add(rule::kIndexRange, path + "/componentType", "cannot hold indices of ",
               piece.wedge_count, " vertices");
  }
}

/// Attributes next to the payload must have as many elements as the piece has vertices, also in
/// morph targets. Accessors that the payload fills are checked where they are named.
void checkOrdinaryAttributes(const Document& document, const ExtensionUse& use,
                             const PieceInfo& piece, Issues& issues) {
  const Primitive& primitive = document.primitive({use.mesh, use.primitive});
  visitOrdinary(primitive, [&](const Primitive::Attribute& attribute) {
    const bool fits = attribute.accessor != kNone &&
                      document.accessors[attribute.accessor].count == piece.wedge_count;
    if (fits) return;
    issues.add(rule::kCount, pathOf(primitive, attribute),
               "the accessor does not have the payload's ", piece.wedge_count, " elements");
  });
}

void checkPart(const PartUse& use, const PieceInfo& piece, Issues& issues) {
  if (use.part >= piece.parts.size()) {
    issues.add(rule::kPart, use.path + "/part", "there is no part ", use.part,
               " in the piece, which has ", piece.parts.size());
  } else if (piece.parts[use.part].triangle_count == 0) {
    issues.add(rule::kPart, use.path, "part ", use.part,
               " of the piece has no triangles, so no primitive may name it");
  }
}

/// Returns the piece of a use; null, with an issue, if there is none or it has no vertices.
const PieceInfo* pieceOf(const PartUse& use, const PayloadInfo& info, Issues& issues) {
  if (use.piece >= info.pieces.size()) {
    issues.add(rule::kPiece, use.path + "/piece", "there is no piece ", use.piece,
               " in the payload, which has ", info.pieces.size());
    return nullptr;
  }
  const PieceInfo& piece = info.pieces[use.piece];
  if (piece.wedge_count != 0) return &piece;
  issues.add(rule::kPiece, use.path, "piece ", use.piece,
             " of the payload has no vertices, so no primitive may name it");
  return nullptr;
}

}  // namespace

void findExtensionUses(const Document& document, Issues& issues, std::vector<ExtensionUse>& uses) {
  uses.clear();
  for (const Primitive& primitive : document.primitives) {
    const Json* extension = extensionOf(*primitive.json, kExtensionName);
    if (extension == nullptr) continue;
    ExtensionUse& use = uses.emplace_back();
    use.mesh = primitive.ref.mesh;
    use.primitive = primitive.ref.primitive;
    use.json = primitive.json;
    readExtension(document, *extension, *primitive.json, issues, use);
  }
  if (!uses.empty()) Sharing(document, issues).check(uses);
}

Result findExtensionUses(const Document& document, std::vector<ExtensionUse>& uses) {
  Issues issues(1);
  findExtensionUses(document, issues, uses);
  return issues.first();
}

std::string PayloadUse::where() const {
  const std::string& path = users.empty() ? previewed[0]->preview->path : users[0]->path;
  return path + "/bufferView";
}

std::vector<PayloadUse> payloadUses(const Document& document,
                                    const std::vector<ExtensionUse>& uses) {
  using Range = std::tuple<uint32_t, uint64_t, uint64_t>;
  std::map<uint32_t, PayloadUse> by_view;
  for (const ExtensionUse& use : uses) {
    if (use.view != kNone) by_view[use.view].users.push_back(&use);
    if (use.preview && use.preview->view != kNone) {
      by_view[use.preview->view].previewed.push_back(&use);
    }
  }
  std::vector<PayloadUse> payloads;
  std::map<Range, size_t> by_range;
  for (const auto& [number, of_view] : by_view) {
    const BufferView& view = document.views[number];
    const Range range = {view.buffer, view.offset, view.length};
    const auto [found, is_new] = by_range.try_emplace(range, payloads.size());
    if (is_new) payloads.push_back({number, {}, {}});
    PayloadUse& all = payloads[found->second];
    all.users.insert(all.users.end(), of_view.users.begin(), of_view.users.end());
    all.previewed.insert(all.previewed.end(), of_view.previewed.begin(), of_view.previewed.end());
  }
  return payloads;
}

Result checkPayloadLengths(const Document& document, const std::vector<PayloadUse>& payloads) {
  uint64_t available = 0;
  for (const auto& buffer : document.buffers) available += buffer.size();
  for (const PayloadUse& payload : payloads) {
    const uint64_t length = document.views[payload.view].length;
    if (length > available) {
      return error(at("/bufferViews", payload.view),
                   "overlaps other payloads, which together are longer than all buffers");
    }
    available -= length;
  }
  return {};
}

std::span<const uint8_t> payloadBytes(const Document& document, uint32_t view) {
  const BufferView& range = document.views[view];
  return document.buffers[range.buffer].subspan(range.offset, range.length);
}

void checkAgainstPayload(const Document& document, const ExtensionUse& use, const PayloadInfo& info,
                         Issues& issues) {
  const PieceInfo* const piece = pieceOf(use, info, issues);
  if (piece == nullptr) return;
  checkPart(use, *piece, issues);
  for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
    checkAttribute(document, attribute, *piece, issues);
  }
  checkIndices(document, use, *piece, issues);
  checkOrdinaryAttributes(document, use, *piece, issues);
}

void checkPreview(const Document& document, const ExtensionUse& use, const PayloadInfo& info,
                  Issues& issues) {
  const PartUse& preview = *use.preview;
  const PieceInfo* const piece = pieceOf(preview, info, issues);
  if (piece == nullptr) return;
  checkPart(preview, *piece, issues);
  for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
    if (!hasAttribute(attribute.id, preview.path, *piece, issues)) continue;
    const Accessor& accessor = document.accessors[attribute.accessor];
    if (!accessor.is_known_type) continue;  // reported for the payload of the primitive
    const AttributeFormat named = formatOf(attribute.name, attribute.target, accessor);
    if (piece->attributes[attribute.id].format == named) continue;
    issues.add(rule::kSemantic, preview.path, "attribute ", attribute.id, " of the preview is not ",
               attribute.name, (attribute.target == kNone ? "" : " of this morph target"),
               ", or has another type");
  }
}

Result checkAgainstPayload(const Document& document, const PayloadUse& payload,
                           const PayloadInfo& info) {
  Issues issues(1);
  for (const ExtensionUse* use : payload.users) checkAgainstPayload(document, *use, info, issues);
  for (const ExtensionUse* use : payload.previewed) checkPreview(document, *use, info, issues);
  return issues.first();
}

}  // namespace mcc::gltf
