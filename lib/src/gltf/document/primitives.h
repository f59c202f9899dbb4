// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Walks over the primitives of a document, and over the accessors that a primitive names. Objects
// that do not have the shape glTF requires are skipped.
#ifndef MCC_GLTF_DOCUMENT_PRIMITIVES_H_
#define MCC_GLTF_DOCUMENT_PRIMITIVES_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "gltf/base/result.h"
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
  const Json* indices = findMember(primitive, "indices");
  if (indices != nullptr && asUnsigned(*indices, accessor)) visit(accessor);
  const Json* attribute_ids = findMember(extension, "attributes");
  const Json& target_ids = arrayOf(extension, "targets");
  visitAttributeMaps(primitive, [&](const Json& map, uint32_t target) {
    const Json* ids = attribute_ids;
    if (target != kNone) ids = target < target_ids.size() ? &target_ids[target] : nullptr;
    if (ids == nullptr || !ids->is_object()) return;
    for (const auto& [name, id] : ids->items()) {
      const Json* number = findMember(map, name);
      if (number != nullptr && asUnsigned(*number, accessor)) visit(accessor);
    }
  });
}

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_PRIMITIVES_H_
