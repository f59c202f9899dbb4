// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress/add_fallback.h"

#include "gltf/decompress/decompress.h"
#include "gltf/document/references.h"

namespace mcc::gltf {

Result addFallback(const std::vector<uint8_t>& bin, Json& json, std::vector<uint8_t>& fallback) {
  Document document;
  MCC_GLTF_TRY(adoptDocument(json, bin, document));
  DecodedAccessors decoded;
  MCC_GLTF_TRY(decodeAccessors(document, decoded));
  fallback.clear();
  std::vector<size_t> numbers(decoded.views.size(), kNone);  // numbers of the views in the JSON
  const size_t buffer = json["buffers"].size();
  Json& accessors = json["accessors"];
  Json& views = json["bufferViews"];
  for (const DecodedAccessors::Filled& filled : decoded.filled) {
    if (document.accessors[filled.accessor].view != kNone) continue;  // it already has a fallback
    Json& accessor = accessors[filled.accessor];
    if (numbers[filled.view] != kNone) {
      accessor["bufferView"] = numbers[filled.view];
      continue;
    }
    const NewView& decoded_view = decoded.views[filled.view];
    fallback.resize((fallback.size() + 3) & ~size_t{3}, 0);
    Json view = {{"buffer", buffer},
                 {"byteOffset", fallback.size()},
                 {"byteLength", decoded_view.bytes.size()}};
    if (decoded_view.stride_bytes != 0) view["byteStride"] = decoded_view.stride_bytes;
    view["target"] = decoded_view.target;
    fallback.insert(fallback.end(), decoded_view.bytes.begin(), decoded_view.bytes.end());
    numbers[filled.view] = views.size();
    accessor["bufferView"] = numbers[filled.view];
    views.push_back(std::move(view));
  }
  json["buffers"].push_back({{"uri", ""}, {"byteLength", fallback.size()}});
  removeExtensionName(json, "extensionsRequired", kExtensionName);
  return {};
}

}  // namespace mcc::gltf
