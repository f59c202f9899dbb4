// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Beginnings of images, for tests that only look at their sizes.
#ifndef MCC_TESTS_SUPPORT_MADE_IMAGES_H_
#define MCC_TESTS_SUPPORT_MADE_IMAGES_H_

#include <cstdint>
#include <string_view>
#include <vector>

namespace mcc::gltf::test {

/// The first 24 bytes of a PNG.
inline std::vector<uint8_t> pngHeader(uint32_t width, uint32_t height) {
  constexpr std::string_view kBegin("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
  std::vector<uint8_t> bytes(kBegin.begin(), kBegin.end());
  for (const uint32_t size : {width, height}) {
    for (uint32_t shift = 32; shift != 0;)
      bytes.push_back(static_cast<uint8_t>(size >> (shift -= 8)));
  }
  return bytes;
}

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_SUPPORT_MADE_IMAGES_H_
