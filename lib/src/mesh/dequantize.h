// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Converts coded integers to the components of accessors. [A.10.18]
#ifndef MCC_MESH_DEQUANTIZE_H_
#define MCC_MESH_DEQUANTIZE_H_

#include <bit>
#include <cstdint>
#include <cstring>

#include "base/host.h"
#include "mcc/types.h"

namespace mcc {

/// Returns the value of lattice coordinate q. It is rounded to float32 twice, never fused, so that
/// every machine computes the same bits.
inline float latticeValue(int32_t q, float step, float origin) {
  const float scaled = static_cast<float>(q) * step;
  return scaled + origin;
}

/// Maps floats to integers that sort like them: -NaN < -inf < .. < -0 < +0 < .. < +NaN. Every bit
/// pattern is kept.
constexpr int32_t orderedFromBits(uint32_t bits) {
  return static_cast<int32_t>((bits & 0x80000000u) != 0 ? ~bits ^ 0x80000000u : bits);
}
constexpr uint32_t bitsFromOrdered(int32_t ordered) {
  const uint32_t u = static_cast<uint32_t>(ordered);
  return ordered < 0 ? ~(u ^ 0x80000000u) : u;
}

/// Returns where the low `bytes` bytes of a uint32_t begin in the memory of this host.
constexpr uint32_t lowBytesOffset(uint32_t bytes) {
  return std::endian::native == std::endian::little ? 0 : 4 - bytes;
}

/// Stores an integer component in the host's byte order, like every number in the caller's arrays.
/// The value is taken modulo the width of the type. A copy of a size that the compiler does not
/// know would be a call, in WebAssembly one that leaves it.
inline void storeInteger(uint8_t* to, ComponentType type, int32_t value) {
  const auto store = [to](auto narrow)
                         MCC_INLINE_LAMBDA { std::memcpy(to, &narrow, sizeof narrow); };
  switch (componentBytes(type)) {
    case 1: return store(static_cast<uint8_t>(value));
    case 2: return store(static_cast<uint16_t>(value));
    default: return store(value);
  }
}

/// Returns the bits of a component in the host's byte order. The type has at most 32 bits; the bits
/// above it are 0.
inline uint32_t loadBits(const uint8_t* from, ComponentType type) {
  const uint32_t bytes = componentBytes(type);
  uint32_t value = 0;
  std::memcpy(reinterpret_cast<uint8_t*>(&value) + lowBytesOffset(bytes), from, bytes);
  return value;
}

inline void storeFloat(uint8_t* to, float value) { std::memcpy(to, &value, sizeof value); }

}  // namespace mcc

#endif  // MCC_MESH_DEQUANTIZE_H_
