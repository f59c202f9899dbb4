// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds out what refers to buffer views and accessors, in the document and in parts of it that we
// do not understand.
#ifndef MCC_GLTF_DOCUMENT_REFERENCES_H_
#define MCC_GLTF_DOCUMENT_REFERENCES_H_

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

/// Returns the member of an object that may be null. `J` is Json or const Json.
template <typename J>
J* member(J* json, std::string_view key) {
  if (json == nullptr) return nullptr;
  J* const found = json->find(key);
  return found == json->end() ? nullptr : found;
}

/// Visits the elements of an array that may be null. Anything but an array has no elements.
template <typename J, typename Visit>
void visitElements(J* array, const Visit& visit) {
  if (array == nullptr || !array->is_array()) return;
  for (J& element : *array) visit(element);
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

/// Calls visit(const Json& map, uint32_t target) for `attributes`, whose target is kNone, and for
/// each of `targets`.
template <typename Visit>
void visitAttributeMaps(const Json& primitive, const Visit& visit) {
  const Json* attributes = findMember(primitive, "attributes");
  if (attributes != nullptr && attributes->is_object()) visit(*attributes, kNone);
  uint32_t target = 0;
  for (const Json& map : arrayOf(primitive, "targets")) {
    if (map.is_object()) visit(map, target);
    ++target;
  }
}

/// Calls visit(uint64_t accessor) for the accessors that the payload of a compressed primitive
/// fills: its indices, and the attributes that the extension object names.
template <typename Visit>
void visitFilledAccessors(const Json& primitive, const Json& extension, const Visit& visit) {
  uint64_t accessor = 0;
  if (asUnsigned(findMember(primitive, "indices"), accessor)) visit(accessor);
  const Json* attribute_ids = findMember(extension, "attributes");
  const Json& target_ids = arrayOf(extension, "targets");
  visitAttributeMaps(primitive, [&](const Json& map, uint32_t target) {
    const Json* ids = attribute_ids;
    if (target != kNone) ids = target < target_ids.size() ? &target_ids[target] : nullptr;
    if (ids == nullptr || !ids->is_object()) return;
    for (const auto& [name, id] : ids->items()) {
      if (asUnsigned(findMember(map, name), accessor)) visit(accessor);
    }
  });
}

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

/// Calls `visit` with every number of an accessor that does not exist, in the places that glTF 2.0
/// and EXT_mesh_gpu_instancing define.
void visitMissingAccessors(const Json& root, size_t accessor_count,
                           const std::function<void(const Json& number)>& visit);
/// Changes these numbers to one that never will exist.
void hideMissingAccessors(size_t accessor_count, Json& root);

/// Calls `visit` with every number of a buffer view in the places that glTF 2.0 and the extensions
/// on our list define. `accessor` is the accessor that the reference belongs to, or kNone.
void visitViewReferences(const Json& root,
                         const std::function<void(const Json& number, uint32_t accessor)>& visit);
/// The same for a visitor that changes the numbers.
void editViewReferences(Json& root,
                        const std::function<void(Json& number, uint32_t accessor)>& visit);

/// Whether accessors that hold numbers of vertices can get others, see isRenumberable().
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

/// Extensions that code the elements of buffer views.
inline constexpr const char* kViewExtensions[] = {"EXT_meshopt_compression",
                                                  "KHR_meshopt_compression"};
/// The other extension that codes primitives.
inline constexpr char kMeshExtension[] = "KHR_draco_mesh_compression";

/// Adds a name to a list of extensions, or removes it. A list that becomes empty is removed.
void addExtensionName(Json& root, const char* list, const char* name);
void removeExtensionName(Json& root, const char* list, const char* name);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_REFERENCES_H_
