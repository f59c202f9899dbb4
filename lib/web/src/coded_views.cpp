// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "coded_views.h"

#include "gltf/decompress/coded_input.h"
#include "gltf/document/extension_uses.h"
#include "host/result.h"

namespace mcc::web {
namespace {

using gltf::CodedView;
using gltf::Result;

/// Stands for a decoder: makes room for the elements.
Result makeRoom(const CodedView& view, std::vector<uint8_t>& elements) {
  elements.resize(view.count * view.stride_bytes);
  return {};
}

uint64_t addressOf(const uint8_t* bytes) { return reinterpret_cast<uintptr_t>(bytes); }

}  // namespace

CodedViews::Key CodedViews::keyOf(const CodedView& view) {
  const auto* first = reinterpret_cast<const char*>(view.bytes.data());
  return {view.count, view.stride_bytes, view.mode, view.filter, {first, view.bytes.size()}};
}

Result CodedViews::find(std::span<const uint8_t> file) {
  MCC_GLTF_TRY(gltf::loadDocument(file, nullptr, document_));
  document_.decoded = gltf::DecodedBytes(0, document_.source_bytes);
  MCC_GLTF_TRY(gltf::decodeViews({makeRoom, nullptr}, document_));
  for (uint32_t number = 0; number < document_.views.size(); ++number) {
    const gltf::ViewCoding& coding = document_.views[number].coding;
    if (coding.decoded == kNone) continue;
    const CodedView view = {gltf::payloadBytes(document_, number), coding.count, coding.stride,
                            coding.mode, coding.filter};
    if (numbers_.emplace(keyOf(view), number).second) views_.push_back(number);
  }
  return {};
}

gltf::Json CodedViews::list() const {
  gltf::Json views = gltf::Json::array();
  for (const uint32_t number : views_) {
    const std::span<const uint8_t> bytes = gltf::payloadBytes(document_, number);
    const gltf::ViewCoding& coding = document_.views[number].coding;
    const std::vector<uint8_t>& elements = document_.storage[coding.decoded];
    views.push_back({{"path", gltf::at("/bufferViews", number) + "/extensions/" + coding.extension},
                     {"address", addressOf(bytes.data())},
                     {"length", bytes.size()},
                     {"elements", addressOf(elements.data())},
                     {"count", coding.count},
                     {"stride", coding.stride},
                     {"mode", coding.mode},
                     {"filter", coding.filter}});
  }
  return views;
}

Result CodedViews::elementsOf(const CodedView& view, std::vector<uint8_t>& elements) const {
  const auto found = numbers_.find(keyOf(view));
  if (found == numbers_.end()) {
    return {"",
            "can be read only with the option meshoptDecoder, for which MeshoptDecoder of the npm "
            "package meshoptimizer is made"};
  }
  elements = document_.storage[document_.views[found->second].coding.decoded];
  return {};
}

}  // namespace mcc::web
