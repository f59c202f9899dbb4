// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress/add_fallback.h"

#include "gltf/decompress/decompress.h"
#include "gltf/document/references.h"

namespace mcc::gltf {

Result addFallback(const std::vector<uint8_t>& bin, Json& json, std::vector<uint8_t>& fallback) {
  std::vector<uint8_t> glb;
  Document document;
  MCC_GLTF_TRY(writeGlb(printJson(json), bin, {}, glb));
  MCC_GLTF_TRY(loadDocument(glb, nullptr, document));
  PayloadDecoder decoder(document, PayloadDecoder::Views::kShared);
  MCC_GLTF_TRY(decoder.open());
  const std::vector<NewView> decoded = decoder.takeViews();
  std::vector<uint64_t> numbers(decoded.size(), kNone);  // numbers of the views in the JSON
  std::vector<uint64_t> offsets(decoded.size());
  uint64_t end = 0;
  const size_t buffer = json["buffers"].size();
  Json& accessors = json["accessors"];
  Json& views = json["bufferViews"];
  for (const auto& [accessor, number] : decoder.filled()) {
    if (document.accessors[accessor].view != kNone) continue;  // it already has a fallback
    if (numbers[number] == kNone) {
      const NewView& view = decoded[number];
      offsets[number] = (end + 3) & ~uint64_t{3};
      end = offsets[number] + view.byte_count;
      numbers[number] = views.size();
      Json added = {
          {"buffer", buffer}, {"byteOffset", offsets[number]}, {"byteLength", view.byte_count}};
      if (view.stride_bytes != 0) added["byteStride"] = view.stride_bytes;
      added["target"] = view.target;
      views.push_back(std::move(added));
    }
    accessors[accessor]["bufferView"] = numbers[number];
  }
  json["buffers"].push_back({{"uri", ""}, {"byteLength", end}});
  removeExtensionName(json, "extensionsRequired", kExtensionName);
  fallback.assign(end, 0);
  return decoder.decode(1, [&](size_t view) {
    return numbers[view] == kNone ? nullptr : fallback.data() + offsets[view];
  });
}

}  // namespace mcc::gltf
