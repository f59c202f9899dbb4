// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds out what refers to buffer views and accessors, in the document, in the extensions of others
// that we know, and in parts of it that we do not understand.
#ifndef MCC_GLTF_DOCUMENT_REFERENCES_H_
#define MCC_GLTF_DOCUMENT_REFERENCES_H_

#include <algorithm>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "host/result.h"
#include "json/json.h"
#include "mcc/types.h"

namespace mcc::gltf {

struct PrimitiveRef {
  uint32_t mesh = 0;
  uint32_t primitive = 0;

  std::string path() const { return primitivePath(mesh, primitive); }
  auto operator<=>(const PrimitiveRef&) const = default;
};

/// Returns the name of an attribute of a mesh or of one of its morph targets for messages:
/// "POSITION" or "target 2 POSITION".
inline std::string attributeLabel(const std::string& name, uint32_t target) {
  return target == kNone ? name : sentence("target ", target, " ", name);
}

/// Returns the member of an object that may be null. `J` is Json or const Json.
template <typename J>
J* member(J* json, std::string_view key) {
  if (json == nullptr) return nullptr;
  J* const found = json->find(key);
  return found == json->end() ? nullptr : found;
}

/// Calls visit(J&) for all that is at a path below `json`, which may be null:
/// "meshes/[]/weights/[]", where [] stands for the elements of an array and {} for the members of
/// an object. Returns whether all containers on the way are of these kinds; what is missing is of
/// any.
template <typename J, typename Visit>
bool visitPath(J* json, std::string_view path, const Visit& visit) {
  if (json == nullptr) return true;
  if (path.empty()) {
    visit(*json);
    return true;
  }
  const std::string_view step = path.substr(0, path.find('/'));
  path.remove_prefix(std::min(path.size(), step.size() + 1));
  if (step != "[]" && step != "{}") return visitPath(member(json, step), path, visit);
  if (step == "[]" ? !json->is_array() : !json->is_object()) return false;
  bool is_of_kind = true;
  for (J& value : *json) is_of_kind &= visitPath(&value, path, visit);
  return is_of_kind;
}

/// Returns a number that is one of `count` elements; kNone for all other values, and for null.
inline uint32_t indexOf(const Json* number, size_t count) {
  uint64_t index = 0;
  return asUnsigned(number, index) && index < count ? static_cast<uint32_t>(index) : kNone;
}

/// Returns an extension of an object, or null.
inline const Json* extensionOf(const Json& object, std::string_view name) {
  const Json* extensions = findMember(object, "extensions");
  return extensions == nullptr ? nullptr : findMember(*extensions, name);
}

/// Calls visit(const PrimitiveRef&, const Json& primitive) for all primitives in their order.
template <typename Visit>
void visitPrimitives(const Json& root, const Visit& visit) {
  PrimitiveRef ref;
  for (const Json& mesh : arrayOf(root, "meshes")) {
    ref.primitive = 0;
    for (const Json& primitive : arrayOf(mesh, "primitives")) {
      visit(static_cast<const PrimitiveRef&>(ref), primitive);
      ++ref.primitive;
    }
    ++ref.mesh;
  }
}

/// Returns the attributes, or those of a morph target, that an object names: a primitive, or our
/// extension object, which may be null.
inline const Json* attributesOf(const Json* object, uint32_t target) {
  if (object == nullptr) return nullptr;
  if (target == kNone) return findMember(*object, "attributes");
  const Json& targets = arrayOf(*object, "targets");
  return target < targets.size() ? &targets[target] : nullptr;
}

/// Calls visit(uint64_t accessor) for the accessors that the payload of a compressed primitive
/// fills: its indices, and the attributes that the extension object names.
template <typename Visit>
void visitFilledAccessors(const Json& primitive, const Json& extension, const Visit& visit) {
  uint64_t accessor = 0;
  if (asUnsigned(findMember(primitive, "indices"), accessor)) visit(accessor);
  const auto visitMap = [&](uint32_t target) {
    const Json* ids = attributesOf(&extension, target);
    if (ids == nullptr) return;
    for (const auto& [name, id] : ids->items()) {
      if (asUnsigned(findMember(attributesOf(&primitive, target), name), accessor)) visit(accessor);
    }
  };
  visitMap(kNone);
  for (uint32_t i = 0; i < arrayOf(extension, "targets").size(); ++i) visitMap(i);
}

/// The extension whose property tables lie in buffer views.
inline constexpr char kMetadataExtension[] = "EXT_structural_metadata";
/// Describes all primitives of its mesh once more, as one list of triangles over the same bytes.
inline constexpr char kManifoldExtension[] = "EXT_mesh_manifold";
/// Where a mesh names primitives that EXT_mesh_primitive_restart draws together with others. They
/// share the bytes of their indices with their group.
inline constexpr char kGroupedPrimitives[] =
    "extensions/EXT_mesh_primitive_restart/primitiveGroups/[]/primitives/[]";

/// Extensions that code the elements of buffer views.
inline constexpr const char* kViewExtensions[] = {"EXT_meshopt_compression",
                                                  "KHR_meshopt_compression"};
/// The other extension that codes primitives.
inline constexpr char kMeshExtension[] = "KHR_draco_mesh_compression";

/// What an accessor that an extension of a primitive names is made of.
enum class ExtensionAccessor : uint8_t {
  kVertexNumbers,  ///< nothing but numbers of vertices of the primitive
  kOther,
};

/// Calls visit(number, what) for each accessor number in the extensions of a primitive.
void visitExtensionAccessors(
    const Json& primitive,
    const std::function<void(const Json& number, ExtensionAccessor what)>& visit);
/// Where the extensions of a mesh itself name accessors.
inline constexpr std::string_view kMeshExtensionAccessors[] = {
    "extensions/EXT_mesh_primitive_restart/primitiveGroups/[]/indices",
    "extensions/EXT_mesh_manifold/mergeIndices",
    "extensions/EXT_mesh_manifold/mergeValues",
    "extensions/EXT_mesh_manifold/manifoldPrimitive/indices",
    "extensions/EXT_mesh_manifold/manifoldPrimitive/attributes/{}",
};

/// Whether accessors hold numbers of 64 bits: component types 5130, 5134 and 5135 of glTF 2.1.
bool hasWideAccessors(const Json& root);

/// References in extras and in extensions that are not on our list. Anything there that looks like
/// a reference ("bufferView": 3, "myAccessors": [1, 2]) is treated as one.
struct ForeignReferences {
  /// There is something we do not understand, so buffer views keep their numbers and all their
  /// bytes.
  bool keep_numbers = false;
  std::string reason;     ///< the first extension or path that made keep_numbers true
  std::string extension;  ///< the first extension that is not on our list
  std::set<uint64_t> views;
  std::set<uint64_t> accessors;
  bool has_tables = false;          ///< the document may have property tables
  bool has_wide_accessors = false;  ///< see hasWideAccessors()

  /// Returns the power of two by which bytes stay aligned as in the source: property tables and
  /// accessors may hold numbers of 64 bits, and so may what we do not understand.
  uint32_t alignment() const { return keep_numbers || has_tables || has_wide_accessors ? 8 : 4; }
};

ForeignReferences findForeignReferences(const Json& root);

/// Where glTF 2.0 and EXT_mesh_gpu_instancing name accessors: in meshes, and elsewhere.
inline constexpr std::string_view kMeshAccessors[] = {"meshes/[]/primitives/[]/attributes/{}",
                                                      "meshes/[]/primitives/[]/targets/[]/{}",
                                                      "meshes/[]/primitives/[]/indices"};
inline constexpr std::string_view kAnimationAccessors[] = {"skins/[]/inverseBindMatrices",
                                                           "animations/[]/samplers/[]/input",
                                                           "animations/[]/samplers/[]/output"};
inline constexpr std::string_view kInstanceAccessors =
    "nodes/[]/extensions/EXT_mesh_gpu_instancing/attributes/{}";

/// Calls visit(J& number) for every number of an accessor in these places. `J` is Json, of which a
/// visitor may change the numbers, or const Json.
template <typename J, typename Visit>
void visitAccessorReferences(J& root, const Visit& visit) {
  for (const std::string_view path : kMeshAccessors) visitPath(&root, path, visit);
  for (const std::string_view path : kAnimationAccessors) visitPath(&root, path, visit);
  visitPath(&root, kInstanceAccessors, visit);
}

/// Whether a reference names none of the accessors.
bool isMissing(const Json& number, size_t accessor_count);
/// Changes the numbers of accessors that do not exist to one that never will.
void hideMissingAccessors(size_t accessor_count, Json& root);

/// Where property tables name buffer views.
inline constexpr std::string_view kTableViews[] = {
    "extensions/EXT_structural_metadata/propertyTables/[]/properties/{}/values",
    "extensions/EXT_structural_metadata/propertyTables/[]/properties/{}/arrayOffsets",
    "extensions/EXT_structural_metadata/propertyTables/[]/properties/{}/stringOffsets"};
/// Where the rest of a document does, apart from accessors.
inline constexpr std::string_view kOtherViews[] = {
    "images/[]/bufferView",
    "meshes/[]/primitives/[]/extensions/KHR_mesh_collapse_compression/bufferView",
    "meshes/[]/primitives/[]/extensions/KHR_mesh_collapse_compression/preview/bufferView",
    "meshes/[]/primitives/[]/extensions/KHR_draco_mesh_compression/bufferView"};

/// Calls visit(J& number, uint32_t accessor) for every number of a buffer view in the places that
/// glTF 2.0 and the extensions on our list define. `accessor` is the accessor that the reference
/// belongs to, or kNone.
template <typename J, typename Visit>
void visitViewReferences(J& root, const Visit& visit) {
  uint32_t index = 0;
  visitPath(&root, "accessors/[]", [&](J& accessor) {
    for (const char* path : {"bufferView", "sparse/indices/bufferView", "sparse/values/bufferView"})
      visitPath(&accessor, path, [&](J& number) { visit(number, index); });
    ++index;
  });
  const auto visitOther = [&](J& number) { visit(number, uint32_t{kNone}); };
  for (const std::string_view path : kOtherViews) visitPath(&root, path, visitOther);
  for (const std::string_view path : kTableViews) visitPath(&root, path, visitOther);
}

/// Whether accessors that hold numbers of vertices can get others.
enum class NumbersOfVertices : uint8_t { kStay, kCanChange };

/// Returns the part of a mesh or primitive that depends on the order of vertices or triangles, as
/// far as we know: the first extension that is not on our list or says so, a key of its extras that
/// suggests it ("drawRange"), or an empty string.
std::string orderDependentPart(const Json& mesh_or_primitive, NumbersOfVertices numbers);

/// Returns the first extension of an object that is not on our list, or an empty string.
std::string unknownExtension(const Json& object);

/// Returns the first extension of the document that may refer to nodes and expect their meshes
/// there, or an empty string.
std::string nodeDependentExtension(const Json& root, const ForeignReferences& foreign);

/// Returns the names in a list of extensions.
std::vector<std::string> extensionNames(const Json& root, const char* list);
/// Removes a name from a list of extensions. A list that becomes empty is removed.
void removeExtensionName(Json& root, const char* list, const char* name);
/// Makes both lists of extensions name one, or not. Lists that become empty are removed.
void listExtension(Json& root, const char* name, bool is_used_and_required);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_REFERENCES_H_
