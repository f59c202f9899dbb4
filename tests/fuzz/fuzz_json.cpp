// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Any text: what is JSON prints as JSON that is equal to it, and prints the same again.
#include <cstdlib>
#include <span>
#include <string>

#include "json/json.h"

using mcc::gltf::Json;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Json json;
  if (!mcc::gltf::parseJson({data, size}, json).ok()) return 0;
  const std::string text = json.dump();
  Json again;
  const std::span bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  if (!mcc::gltf::parseJson(bytes, again).ok() || again != json || again.dump() != text)
    std::abort();
  if (Json::parse(json.dump(1, true)) != json) std::abort();
  return 0;
}
