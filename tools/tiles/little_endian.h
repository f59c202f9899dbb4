// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Numbers in the headers of 3D Tiles. Whoever calls has checked that the bytes are there.
#ifndef MCC_TILES_LITTLE_ENDIAN_H_
#define MCC_TILES_LITTLE_ENDIAN_H_

#include <cstdint>
#include <span>

namespace mcc::tiles {

inline uint32_t numberAt(std::span<const uint8_t> bytes, uint64_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= uint32_t{bytes[at + i]} << (8 * i);
  return value;
}

inline uint64_t longNumberAt(std::span<const uint8_t> bytes, uint64_t at) {
  return numberAt(bytes, at) | uint64_t{numberAt(bytes, at + 4)} << 32;
}

}  // namespace mcc::tiles

#endif  // MCC_TILES_LITTLE_ENDIAN_H_
