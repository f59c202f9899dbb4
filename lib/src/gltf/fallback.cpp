// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/fallback.h"

#include <set>

#include "gltf/decompress.h"
#include "gltf/references.h"

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

Result addFallback(const std::vector<uint8_t>& bin, const std::string& uri, Json& json,
                   std::vector<uint8_t>& fallback) {
  Document document;
  MCC_GLTF_TRY(adoptDocument(json, bin, document));
  DecodedAccessors decoded;
  MCC_GLTF_TRY(decodeAccessors(document, decoded));
  fallback.clear();
  std::vector<size_t> numbers(decoded.views.size(), kNone);  // numbers of the views in the JSON
  for (const DecodedAccessors::Filled& filled : decoded.filled) {
    if (document.accessors[filled.accessor].view != kNone) continue;  // it already has a fallback
    Json& accessor = json["accessors"][filled.accessor];
    if (numbers[filled.view] != kNone) {
      accessor["bufferView"] = numbers[filled.view];
      continue;
    }
    const NewView& decoded_view = decoded.views[filled.view];
    fallback.resize((fallback.size() + 3) & ~size_t{3}, 0);
    Json view = {{"buffer", json["buffers"].size()},
                 {"byteOffset", fallback.size()},
                 {"byteLength", decoded_view.bytes.size()}};
    if (decoded_view.stride_bytes != 0) view["byteStride"] = decoded_view.stride_bytes;
    view["target"] = decoded_view.target;
    fallback.insert(fallback.end(), decoded_view.bytes.begin(), decoded_view.bytes.end());
    numbers[filled.view] = json["bufferViews"].size();
    accessor["bufferView"] = numbers[filled.view];
    json["bufferViews"].push_back(std::move(view));
  }
  json["buffers"].push_back({{"uri", uri}, {"byteLength", fallback.size()}});
  removeExtensionName(json, "extensionsRequired", kExtensionName);
  return {};
}

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
  for (const uint64_t index : compressed) {
    if (index >= arrayOf(json, "accessors").size()) return false;
    Json& accessor = json["accessors"][index];
    uint64_t view = 0;
    const Json* reference = findMember(accessor, "bufferView");
    if (reference == nullptr || !asUnsigned(*reference, view) || view < view_count) continue;
    for (const char* key : {"bufferView", "byteOffset", "sparse"}) accessor.erase(key);
  }
  json["bufferViews"].erase(json["bufferViews"].begin() + static_cast<ptrdiff_t>(view_count),
                            json["bufferViews"].end());
  json["buffers"].erase(number);
  return true;
}

}  // namespace mcc::gltf
