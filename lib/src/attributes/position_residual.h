// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// From the expected scale of a residual to its row of token frequencies, and the residual's code. [B.2.5]
#ifndef MCC_ATTRIBUTES_POSITION_RESIDUAL_H_
#define MCC_ATTRIBUTES_POSITION_RESIDUAL_H_

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "attributes/position_tables.h"
#include "base/host.h"
#include "entropy/models.h"

namespace mcc {

/// Rows of one component: 40 buckets, then the folded ones by fraction class; all of it three times, by which term of
/// the scale dominates (only with position_mode::kSplit).
inline constexpr uint32_t kFoldBuckets = 10;
inline constexpr uint32_t kFractionClasses = 4;
inline constexpr uint32_t kRowsPerSet = kScaleBuckets + kFractionClasses * kFoldBuckets;
inline constexpr uint32_t kRowSets = 3;

/// Rows start when a piece first needs their kind.
struct PositionRows {
  TokenRow row[3][kRowSets * kRowsPerSet];
  bool has_basic = false;
  bool has_folded = false;
  bool has_split = false;

  void prepare(bool fold, bool split) {
    for (uint32_t set = 0; set < kRowSets; ++set) {
      const bool old_set = set == 0 ? has_basic : has_split;
      if (set != 0 && !split && !has_split) break;
      TokenRow* rows = row[0] + set * kRowsPerSet;
      if (!old_set) {
        for (uint32_t b = 0; b < kScaleBuckets; ++b) initialTokenRow(b, rows[b]);
        copyToComponents(set * kRowsPerSet, kScaleBuckets);
      }
      if ((fold || has_folded) && !(old_set && has_folded)) {
        constexpr uint32_t kFoldedRows = kFractionClasses * kFoldBuckets;
        for (uint32_t i = 0; i < kFoldedRows; ++i) {
          initialFoldedRow(i / kFoldBuckets, i % kFoldBuckets, rows[kScaleBuckets + i]);
        }
        copyToComponents(set * kRowsPerSet + kScaleBuckets, kFoldedRows);
      }
    }
    has_basic = true;
    has_folded = has_folded || fold;
    has_split = has_split || split;
  }

 private:
  void copyToComponents(uint32_t begin, uint32_t count) {
    for (uint32_t s = 1; s < 3; ++s) {
      for (uint32_t i = begin; i < begin + count; ++i) row[s][i] = row[0][i];
    }
  }
};

/// Scale in 1/16 of a lattice step, and which of its two terms is more than twice the other.
struct ScaleEstimate {
  uint32_t scale;
  uint32_t set;  ///< 1: spread, 2: neighbours, 0: neither
};

template <class Wide>
MCC_INLINE ScaleEstimate estimateScale(const ScaleCoefficients& c, uint64_t magnitudes,
                                       uint32_t spread) {
  using Sum = std::conditional_t<std::is_same_v<Wide, int32_t>, uint32_t, uint64_t>;
  const Sum of_neighbours = c.c[0] * static_cast<Sum>(magnitudes);
  const Sum of_spread = c.c[1] * Sum{spread};
  const Sum scale = (of_neighbours + of_spread + c.c[2]) >> 6;
  const uint32_t set =
      (of_spread / 2 > of_neighbours ? 1u : 0u) + (of_neighbours / 2 > of_spread ? 2u : 0u);
  return {static_cast<uint32_t>(std::min<Sum>(scale, 0x7fffffff)), set};
}

/// Half-octave bucket of a scale, 0 .. kScaleBuckets-1.
MCC_INLINE uint32_t scaleBucket(uint32_t scale) {
  const uint32_t y = scale + 1;
  const uint32_t k = static_cast<uint32_t>(std::bit_width(y)) - 1;
  const uint32_t bucket = 2 * k + ((2 * y >> k) & 1);
  return std::min(bucket, kScaleBuckets - 1);
}

/// Small residuals are numbered outwards from the unrounded prediction: 0, +1, -1, .. or 0, -1, +1, ..
struct Folding {
  uint32_t fraction_class;
  bool flip;  ///< the prediction was rounded up
};

MCC_INLINE Folding foldingOf(int32_t fraction) {  // -128 .. 127
  const uint32_t size = static_cast<uint32_t>(fraction < 0 ? -fraction : fraction);
  return {std::min<uint32_t>(size >> 5, kFractionClasses - 1), fraction < 0};
}

/// One residual: its magnitude above the bucket's low bits as a token, then raw bits, then a sign unless folded.
template <uint32_t kState, class Io>
MCC_INLINE int32_t codeResidual(Io& io, TokenRow& row, uint32_t bucket, bool folded, bool flip,
                                int32_t truth) {
  const uint32_t low_bits = bucket >= 10 ? bucket / 2 - 5 : 0;
  uint32_t a = 0;
  uint32_t token = 0;
  if constexpr (Io::kEncoding) {
    const uint32_t t = static_cast<uint32_t>(truth);
    a = truth < 0 ? 0u - t : t;
    // -2^31 and 2^31 are the same residual; only the latter has a folded number.
    const bool odd = (truth > 0) != flip || a == 0x80000000u;
    if (folded && a != 0) a = 2 * a - (odd ? 1 : 0);
    token = tokenOf(a >> low_bits);
  }
  token = io.template token<kState>(row, kPositionSchedule, token);
  uint32_t negative = truth < 0 ? 1 : 0;
  if (token == kTokenEscape) [[unlikely]] {
    const uint32_t above = (a >> low_bits) - 127;
    const uint32_t k =
        io.raw(5, Io::kEncoding ? static_cast<uint32_t>(std::bit_width(above)) - 1 : 0);
    const uint32_t mask = (uint32_t{1} << k) - 1;
    const uint32_t z = ((mask + 1) | io.raw(k, above & mask)) + 127;
    a = z << low_bits | io.raw(low_bits, a & ((1u << low_bits) - 1));
    if (!folded) negative = io.raw(1, negative);
  } else {
    const uint32_t base = uint32_t{kTokenBase[token]} << low_bits;
    a = io.magnitude(base, kTokenExtraBits[token] + low_bits, !folded, a, negative);
  }
  const uint32_t unfolded = a / 2 + (a & 1);
  const uint32_t side = (~a & 1) ^ (flip ? 1u : 0u);
  a = folded ? unfolded : a;
  negative = folded ? side : negative;
  const uint32_t mask = ~negative + 1;
  return static_cast<int32_t>((a ^ mask) - mask);
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITION_RESIDUAL_H_
