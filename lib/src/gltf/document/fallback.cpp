// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/fallback.h"

#include <set>

#include "gltf/document/references.h"
#include "mcc/glb.h"

namespace mcc::gltf {
namespace {

/// Returns the accessors that payloads fill, according to the extension objects of the primitives.
std::set<uint64_t> compressedAccessors(const Json& root) {
  std::set<uint64_t> compressed;
  visitPrimitives(root, [&](const PrimitiveRef&, const Json& primitive) {
    const Json* extension = extensionOf(primitive, kExtensionName);
    if (extension == nullptr) return;
    visitFilledAccessors(primitive, *extension,
                         [&](uint64_t accessor) { compressed.insert(accessor); });
  });
  return compressed;
}

bool isAt(const Json& object, const char* key, uint64_t number) {
  uint64_t value = 0;
  const Json* member = findMember(object, key);
  return member != nullptr && asUnsigned(*member, value) && value == number;
}

}  // namespace

bool removeFallback(size_t number, Json& json) {
  const Json& buffers = arrayOf(json, "buffers");
  if (number + 1 != buffers.size()) return false;  // the others would get new numbers
  const Json& views = arrayOf(json, "bufferViews");
  size_t view_count = views.size();
  while (view_count != 0 && isAt(views[view_count - 1], "buffer", number)) --view_count;
  if (view_count == views.size()) return false;
  for (size_t i = 0; i < view_count; ++i) {
    if (isAt(views[i], "buffer", number)) return false;
  }
  if (findForeignReferences(json).keep_numbers) return false;
  const std::set<uint64_t> compressed = compressedAccessors(json);
  bool is_needed = false;
  visitViewReferences(json, [&](const Json& reference, uint32_t accessor) {
    uint64_t view = 0;
    const bool is_lost = !asUnsigned(reference, view) || view >= view_count;
    is_needed |= is_lost && compressed.count(accessor) == 0;
  });
  if (is_needed) return false;
  if (!compressed.empty() && *compressed.rbegin() >= arrayOf(json, "accessors").size()) {
    return false;
  }
  Json* const accessors = compressed.empty() ? nullptr : &json["accessors"];
  for (const uint64_t index : compressed) {
    Json& accessor = (*accessors)[index];
    uint64_t view = 0;
    const Json* reference = findMember(accessor, "bufferView");
    if (reference == nullptr || !asUnsigned(*reference, view) || view < view_count) continue;
    for (const char* key : {"bufferView", "byteOffset", "sparse"}) accessor.erase(key);
  }
  json["bufferViews"].erase(json["bufferViews"].begin() + static_cast<ptrdiff_t>(view_count),
                            json["bufferViews"].end());
  json["buffers"].erase(&json["buffers"][number]);
  return true;
}

}  // namespace mcc::gltf
