// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/image_type.h"

#include <algorithm>
#include <string_view>

namespace mcc::gltf {

std::string imageTypeOf(std::span<const uint8_t> bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                              std::min<size_t>(bytes.size(), 12));
  if (head.starts_with("\x89PNG")) return "image/png";
  if (head.starts_with("\xff\xd8\xff")) return "image/jpeg";
  if (head.starts_with("\xabKTX 20\xbb")) return "image/ktx2";
  if (head.starts_with("RIFF") && head.substr(8).starts_with("WEBP")) return "image/webp";
  if (head.starts_with("DDS ")) return "image/vnd-ms.dds";
  if (head.size() == 12 && (head.substr(4) == "ftypavif" || head.substr(4) == "ftypavis")) {
    return "image/avif";
  }
  // The signature "sB", the version, and the header's size of 77 bytes, each in two bytes.
  if (head.starts_with("sB") && head.size() >= 6 && head[4] == 77 && head[5] == 0) {
    return "image/basis";
  }
  return "";
}

}  // namespace mcc::gltf
