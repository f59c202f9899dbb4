// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_SAMPLES_PNG_H_
#define MCC_TOOLS_SAMPLES_PNG_H_

#include <cstdint>
#include <span>
#include <vector>

namespace mcc::samples {

struct Rgb {
  uint8_t red = 0;
  uint8_t green = 0;
  uint8_t blue = 0;
};

/// Returns a PNG whose pixels are indices into a palette of at most 16 colours, top row first, in
/// stored deflate blocks; `width` is even. It takes half a byte per pixel.
std::vector<uint8_t> encodePalettePng(uint32_t width, uint32_t height,
                                      std::span<const uint8_t> indices,
                                      std::span<const Rgb> palette);

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_PNG_H_
