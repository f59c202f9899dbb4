// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_BASE_CRC32_H_
#define MCC_BASE_CRC32_H_

#include <cstdint>
#include <span>

namespace mcc {

/// Returns the CRC-32 of ISO 3309 (polynomial 0xedb88320 reflected, as in PNG and zlib). To
/// continue over further bytes, pass the previous result as `crc`. No tables are kept between
/// calls.                 [A.1.3]
uint32_t crc32(std::span<const uint8_t> bytes, uint32_t crc = 0);

}  // namespace mcc

#endif  // MCC_BASE_CRC32_H_
