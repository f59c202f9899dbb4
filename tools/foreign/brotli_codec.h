// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_FOREIGN_BROTLI_CODEC_H_
#define MCC_TOOLS_FOREIGN_BROTLI_CODEC_H_

#include <cstdint>
#include <span>

namespace mcc::foreign {

/// Bytes of a file after brotli of this quality (0 to 11); the result itself is not kept.
/// Throws std::bad_alloc.
uint64_t brotliBytes(std::span<const uint8_t> file, int quality);

}  // namespace mcc::foreign

#endif  // MCC_TOOLS_FOREIGN_BROTLI_CODEC_H_
