// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Code lengths in integers, so that the encoder's choices are the same on every machine.
#ifndef MCC_ENTROPY_ENC_COST_H_
#define MCC_ENTROPY_ENC_COST_H_

#include <array>
#include <bit>
#include <cstdint>

namespace mcc {

inline constexpr uint32_t kCostOne = 1u << 16;  ///< one bit

/// Computes 65536 * log2(1 + i/1024) by repeated squaring.
constexpr std::array<uint32_t, 1025> makeLogTable() {
  std::array<uint32_t, 1025> table{};
  for (uint32_t i = 0; i <= 1024; ++i) {
    uint64_t x = (uint64_t{1024} + i) << 20;  // 1.x in 2.30
    uint32_t log = 0;
    if (i == 1024) {
      log = kCostOne;
    } else {
      for (uint32_t bit = kCostOne / 2; bit != 0; bit /= 2) {
        x = (x * x) >> 30;
        if (x >= (uint64_t{2} << 30)) {
          x >>= 1;
          log += bit;
        }
      }
    }
    table[i] = log;
  }
  return table;
}
inline constexpr std::array<uint32_t, 1025> kLogTable = makeLogTable();

/// Returns the cost of an event of probability `numerator` / 2^bits, in units of 1/65536 bit.
/// `numerator` must be at least 1.
constexpr uint32_t costOf(uint32_t numerator, uint32_t bits) {
  const uint32_t zeros = static_cast<uint32_t>(std::countl_zero(numerator | 1));
  const uint32_t index = ((numerator << zeros) >> 21) - 1024;
  return (bits + zeros - 31) * kCostOne - kLogTable[index];
}

}  // namespace mcc

#endif  // MCC_ENTROPY_ENC_COST_H_
