// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_SAMPLES_PNG_H_
#define MCC_TOOLS_SAMPLES_PNG_H_

#include <cstdint>
#include <span>
#include <vector>

namespace mcc::samples {

/// Returns an 8-bit RGB PNG of width * height * 3 bytes, top row first, in stored (uncompressed)
/// deflate blocks.
std::vector<uint8_t> encodePng(uint32_t width, uint32_t height, std::span<const uint8_t> rgb);

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_PNG_H_
