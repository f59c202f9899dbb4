// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exact float32 values on a grid through 0: most files come from numbers with a few decimals, or
// from computations whose results lie far above the precision of their smallest values. Coded are
// the grid's integers, like those of a lattice; grids of binary fractions may leave bits below
// their step, the tails.                      [A.10.5]
#ifndef MCC_EXACT_GRID_H_
#define MCC_EXACT_GRID_H_

#include <bit>
#include <cstdint>

#include "format/methods.h"
#include "mcc/reader.h"
#include "mesh/dequantize.h"

namespace mcc {

/// 2^exponent, normal as a double.
constexpr double powerOfTwo(int32_t exponent) {
  return std::bit_cast<double>(static_cast<uint64_t>(exponent + 1023) << 52);
}

class ExactGrid {
 public:
  explicit ExactGrid(uint32_t grid) {
    if (isBinaryGrid(grid)) {
      exponent_ = static_cast<int32_t>(grid - kGridBinary) + kSmallestExponent;
      scale_ = powerOfTwo(-exponent_);
    } else {
      for (uint32_t i = 0; i < grid; ++i) scale_ *= 10;
    }
  }

  double scale() const { return scale_; }  ///< steps per unit

  /// One division and one rounding.
  float valueOf(int32_t q) const { return static_cast<float>(static_cast<double>(q) / scale_); }

  /// Number of bits a float of integer part q != 0 has below the step. Binary grids only.
  uint32_t tailBits(int32_t q) const {
    const uint32_t magnitude = q < 0 ? 0u - static_cast<uint32_t>(q) : static_cast<uint32_t>(q);
    const int32_t unused = 24 - static_cast<int32_t>(std::bit_width(magnitude));
    const int32_t below = exponent_ - kSmallestExponent;
    return static_cast<uint32_t>(unused < 0 ? 0 : unused < below ? unused : below);
  }

  /// The float of integer part q != 0 (rounded towards 0) and `tail` below it, tailBits(q) long.
  float valueOf(int32_t q, uint32_t tail) const {
    const uint32_t bits = tailBits(q);
    if (bits == 0) return valueOf(q);
    const uint32_t magnitude = q < 0 ? 0u - static_cast<uint32_t>(q) : static_cast<uint32_t>(q);
    const float value = static_cast<float>(static_cast<double>(magnitude << bits | tail) *
                                           powerOfTwo(exponent_ - static_cast<int32_t>(bits)));
    return q < 0 ? -value : value;
  }

  /// Inverse of valueOf(): the grid's integer nearest to a value on a grid without tails.
  int32_t nearest(float value) const {
    const double scaled = static_cast<double>(value) * scale_;
    return static_cast<int32_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
  }
  /// Inverse of valueOf(q, tail): the integer part of a finite value, below 2^31 steps.
  int32_t integerPart(float value) const {
    return static_cast<int32_t>(static_cast<double>(value) * scale_);
  }
  /// The tail of a value whose integer part is q != 0.
  uint32_t tailOf(float value, int32_t q) const {
    const uint32_t bits = tailBits(q);
    const double absolute = static_cast<double>(value < 0 ? -value : value);
    const uint32_t mantissa =
        static_cast<uint32_t>(absolute * scale_ * static_cast<double>(uint32_t{1} << bits));
    return mantissa & ((uint32_t{1} << bits) - 1);
  }

 private:
  double scale_ = 1;
  int32_t exponent_ = 0;  ///< of the step, of binary grids
};

/// The integer of an ordered float (encoder).
inline int32_t gridInteger(const AttributeInfo& info, int32_t ordered) {
  const ExactGrid grid(info.grid);
  const float value = std::bit_cast<float>(bitsFromOrdered(ordered));
  return static_cast<GridTails>(info.tails) == GridTails::kNoTails ? grid.nearest(value)
                                                                   : grid.integerPart(value);
}

}  // namespace mcc

#endif  // MCC_EXACT_GRID_H_
