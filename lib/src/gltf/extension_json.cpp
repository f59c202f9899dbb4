// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reading and checking the extension objects of primitives.
#include <set>

#include "gltf/accessors.h"
#include "gltf/decompress.h"
#include "gltf/plan.h"

namespace mcc::gltf {
namespace {

constexpr uint64_t kMaxNumber = 0xffffffffu;

Result readAccessorNumber(const Document& document, const Json& object, const char* key,
                          const std::string& path, uint32_t& accessor) {
  uint64_t index = 0;
  MCC_GLTF_TRY(readUnsigned(object, key, path, kMaxNumber, index));
  if (index >= document.accessors.size()) {
    return error(at(path, key), "there is no accessor " + std::to_string(index));
  }
  accessor = static_cast<uint32_t>(index);
  return {};
}

/// Reads one map name -> attribute id; the primitive's own map names the accessors.
Result readMap(const Document& document, const Json& ids, const std::string& path,
               const Json* accessors, const std::string& accessors_path, uint32_t target,
               ExtensionUse& use) {
  if (!ids.is_object()) return error(path, "must be an object");
  for (const auto& [name, ignored] : ids.items()) {
    ExtensionUse::AttributeUse attribute;
    attribute.name = name;
    attribute.target = target;
    attribute.path = at(path, name);
    MCC_GLTF_TRY(readUnsigned(ids, name.c_str(), path, kMaxNumber, attribute.id));
    if (accessors == nullptr || findMember(*accessors, name.c_str()) == nullptr) {
      return error(attribute.path, "the primitive has no attribute of this name");
    }
    MCC_GLTF_TRY(
        readAccessorNumber(document, *accessors, name.c_str(), accessors_path, attribute.accessor));
    use.attributes.push_back(std::move(attribute));
  }
  return {};
}

Result readTargets(const Document& document, const Json& extension, const Json& primitive,
                   ExtensionUse& use) {
  const Json* targets = findMember(extension, "targets");
  if (targets == nullptr) return {};
  const std::string path = use.path + "/targets";
  if (!targets->is_array()) return error(path, "must be an array");
  const Json& own = arrayOf(primitive, "targets");
  if (targets->size() != own.size()) {
    return error(path, "has " + std::to_string(targets->size()) + " targets, the primitive " +
                           std::to_string(own.size()));
  }
  const std::string own_path = primitivePath(use.mesh, use.primitive) + "/targets";
  for (uint32_t i = 0; i < targets->size(); ++i) {
    MCC_GLTF_TRY(readMap(document, (*targets)[i], at(path, i), &own[i], at(own_path, i), i, use));
  }
  return {};
}

Result readExtension(const Document& document, const Json& extension, const Json& primitive,
                     ExtensionUse& use) {
  const std::string primitive_path = primitivePath(use.mesh, use.primitive);
  use.path = primitive_path + "/extensions/" + kExtensionName;
  if (!extension.is_object()) return error(use.path, "must be an object");
  if (findMember(primitive["extensions"], "KHR_draco_mesh_compression") != nullptr) {
    return error(use.path, "the primitive is compressed with KHR_draco_mesh_compression, too");
  }
  uint64_t view = 0;
  MCC_GLTF_TRY(readUnsigned(extension, "bufferView", use.path, kMaxNumber, view));
  if (view >= document.views.size()) {
    return error(use.path + "/bufferView", "there is no bufferView " + std::to_string(view));
  }
  if (document.views[view].isCoded()) {
    return error(use.path + "/bufferView", "bufferView " + std::to_string(view) +
                                               " is coded with " +
                                               document.views[view].coding.extension);
  }
  use.view = static_cast<uint32_t>(view);
  MCC_GLTF_TRY(readOptionalUnsigned(extension, "piece", use.path, kMaxNumber, use.piece));
  MCC_GLTF_TRY(readOptionalUnsigned(extension, "part", use.path, kMaxNumber, use.part));
  uint64_t mode = 4;
  MCC_GLTF_TRY(readOptionalUnsigned(primitive, "mode", primitive_path, 6, mode));
  if (mode != 4) {
    return error(primitive_path + "/mode", "must be 4 (triangles) in a compressed primitive");
  }
  MCC_GLTF_TRY(
      readAccessorNumber(document, primitive, "indices", primitive_path, use.indices_accessor));
  if (const Json* ids = findMember(extension, "attributes"); ids != nullptr) {
    MCC_GLTF_TRY(readMap(document, *ids, use.path + "/attributes",
                         findMember(primitive, "attributes"), primitive_path + "/attributes", kNone,
                         use));
  }
  return readTargets(document, extension, primitive, use);
}

Result checkAttribute(const Document& document, const ExtensionUse::AttributeUse& attribute,
                      const PieceInfo& piece) {
  if (attribute.id >= piece.attributes.size()) {
    return error(attribute.path, "there is no attribute " + std::to_string(attribute.id) +
                                     " in the payload's piece, which has " +
                                     std::to_string(piece.attributes.size()));
  }
  const Accessor& accessor = document.accessors[attribute.accessor];
  const std::string accessor_path = at("/accessors", attribute.accessor);
  if (accessor.count != piece.wedge_count) {
    return error(accessor_path + "/count", std::to_string(accessor.count) +
                                               " does not match the payload, which has " +
                                               std::to_string(piece.wedge_count) + " vertices");
  }
  if (!accessor.is_known_type) return error(accessor_path, "the type is unknown");
  if (attribute.name == "POSITION" && attribute.target == kNone && attribute.id != 0) {
    return error(attribute.path, "must be attribute 0, which all others are predicted from");
  }
  const AttributeFormat& coded = piece.attributes[attribute.id].format;
  const AttributeFormat named = formatOf(attribute.name, attribute.target, accessor);
  if (coded.component_type != named.component_type ||
      coded.component_count != named.component_count || coded.normalized != named.normalized) {
    return error(accessor_path, "its type is " + describeType(accessor) +
                                    ", which is not that of attribute " +
                                    std::to_string(attribute.id) + " in the payload");
  }
  if (coded != named) {
    return error(attribute.path, "attribute " + std::to_string(attribute.id) +
                                     " of the payload is no " + attribute.name +
                                     (attribute.target == kNone ? "" : " of this morph target"));
  }
  return {};
}

Result checkIndices(const Document& document, const ExtensionUse& use, const PieceInfo& piece) {
  const Accessor& accessor = document.accessors[use.indices_accessor];
  const std::string path = at("/accessors", use.indices_accessor);
  const uint64_t count = uint64_t{3} * piece.parts[use.part].triangle_count;
  if (accessor.count != count) {
    return error(path + "/count", std::to_string(accessor.count) +
                                      " does not match the payload, which has " +
                                      std::to_string(count) + " indices");
  }
  const ComponentType type = accessor.component_type;
  if (!accessor.is_known_type || accessor.componentCount() != 1 || accessor.normalized) {
    return error(path, "indices must be SCALAR of an unsigned type");
  }
  // The largest value of a type is no index: it restarts strips.
  const bool fits = type == ComponentType::kUint32 ||
                    (type == ComponentType::kUint16 && piece.wedge_count <= 0xffff) ||
                    (type == ComponentType::kUint8 && piece.wedge_count <= 0xff);
  if (!fits) {
    return error(path + "/componentType",
                 "cannot hold indices of " + std::to_string(piece.wedge_count) + " vertices");
  }
  return {};
}

Result checkCounts(const Document& document, const Json& attributes, const std::string& path,
                   uint32_t wedge_count) {
  for (const auto& [name, value] : attributes.items()) {
    uint64_t index = 0;
    if (!asUnsigned(value, index) || index >= document.accessors.size() ||
        document.accessors[index].count != wedge_count) {
      return error(at(path, name), "the accessor has not the " + std::to_string(wedge_count) +
                                       " elements of the payload");
    }
  }
  return {};
}

/// Attributes beside the payload must have as many elements, those of morph targets too.
Result checkOrdinaryAttributes(const Document& document, const ExtensionUse& use,
                               const PieceInfo& piece) {
  const Json& primitive = document.json["meshes"][use.mesh]["primitives"][use.primitive];
  const std::string path = primitivePath(use.mesh, use.primitive);
  if (const Json* attributes = findMember(primitive, "attributes"); attributes != nullptr) {
    MCC_GLTF_TRY(checkCounts(document, *attributes, path + "/attributes", piece.wedge_count));
  }
  const Json& targets = arrayOf(primitive, "targets");
  for (uint32_t i = 0; i < targets.size(); ++i) {
    MCC_GLTF_TRY(checkCounts(document, targets[i], at(path + "/targets", i), piece.wedge_count));
  }
  return {};
}

}  // namespace

Result findExtensionUses(const Document& document, std::vector<ExtensionUse>& uses) {
  uses.clear();
  const Json& meshes = arrayOf(document.json, "meshes");
  for (uint32_t m = 0; m < meshes.size(); ++m) {
    const Json& primitives = arrayOf(meshes[m], "primitives");
    for (uint32_t p = 0; p < primitives.size(); ++p) {
      const Json* extensions = findMember(primitives[p], "extensions");
      const Json* ours = extensions == nullptr ? nullptr : findMember(*extensions, kExtensionName);
      if (ours == nullptr) continue;
      ExtensionUse use;
      use.mesh = m;
      use.primitive = p;
      MCC_GLTF_TRY(readExtension(document, *ours, primitives[p], use));
      uses.push_back(std::move(use));
    }
  }
  return {};
}

std::span<const uint8_t> payloadBytes(const Document& document, uint32_t view) {
  const BufferView& range = document.views[view];
  return document.buffers[range.buffer].subspan(range.offset, range.length);
}

Result checkAgainstPayload(const Document& document, const ExtensionUse& use,
                           const PayloadInfo& info) {
  if (use.piece >= info.pieces.size()) {
    return error(use.path + "/piece", "there is no piece " + std::to_string(use.piece) +
                                          " in the payload, which has " +
                                          std::to_string(info.pieces.size()));
  }
  const PieceInfo& piece = info.pieces[use.piece];
  if (use.part >= piece.parts.size()) {
    return error(use.path + "/part", "there is no part " + std::to_string(use.part) +
                                         " in the piece, which has " +
                                         std::to_string(piece.parts.size()));
  }
  for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
    MCC_GLTF_TRY(checkAttribute(document, attribute, piece));
  }
  MCC_GLTF_TRY(checkIndices(document, use, piece));
  return checkOrdinaryAttributes(document, use, piece);
}

}  // namespace mcc::gltf
