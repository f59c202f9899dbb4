// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Maps the expected scale of a residual to its row of token frequencies, and codes the
// residual. [A.6.6]
#ifndef MCC_POSITIONS_RESIDUAL_H_
#define MCC_POSITIONS_RESIDUAL_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/host.h"
#include "base/lanes.h"
#include "entropy/io.h"
#include "entropy/models.h"
#include "format/decodes.h"
#include "format/predictors.h"
#include "positions/parameters.h"
#include "positions/planes.h"
#include "positions/tables.h"

namespace mcc {

/// Rows of one component: 40 buckets, then the folded ones by fraction class. There are three such
/// sets with position_mode::kSplit, selected by which term of the scale dominates, and two with
/// planes, the second for ranks.
inline constexpr uint32_t kRowsPerSet = kScaleBuckets + kFractionClasses * kFoldBuckets;
inline constexpr uint32_t kRowSets = 3;

/// The rows of a payload. Rows are initialised when a piece first needs their kind.
struct PositionRows {
  TokenRow row[3][kRowSets * kRowsPerSet];
  PlaneModels planes;
  bool has_planes = false;
  bool has_basic = false;
  bool has_folded = false;
  bool has_split = false;

  /// Initialises the rows that these position_mode bits need.
  void prepare(uint32_t modes) {
    const bool fold = (modes & (position_mode::kFold | position_mode::kPlanes)) != 0;
    const bool split = (modes & (position_mode::kSplit | position_mode::kPlanes)) != 0;
    if (decodes::kPlanes && (modes & position_mode::kPlanes) != 0 && !has_planes) {
      planes.setUniform();
      has_planes = true;
    }
    for (uint32_t set = 0; set < kRowSets; ++set) {
      const bool old_set = set == 0 ? has_basic : has_split;
      if (set != 0 && !split && !has_split) break;
      TokenRow* rows = row[0] + set * kRowsPerSet;
      if (!old_set) {
        std::copy_n(InitialRowTable::table.plain, kScaleBuckets, rows);
        copyToComponents(set * kRowsPerSet, kScaleBuckets);
      }
      if ((fold || has_folded) && !(old_set && has_folded)) {
        constexpr uint32_t kFoldedRows = kFractionClasses * kFoldBuckets;
        std::copy_n(InitialRowTable::table.folded, kFoldedRows, rows + kScaleBuckets);
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

/// The coefficients of the scale by component, for one kind of fan.
struct ScaleLanes {
  Lanes<float> neighbours;
  Lanes<float> spread;
  Lanes<float> constant;
  Lanes<float> third;

  explicit ScaleLanes(const ScaleCoefficients* c)
      : neighbours(coefficients(c, 0)),
        spread(coefficients(c, 1)),
        constant(coefficients(c, 2)),
        third(coefficients(c, 3)) {}

 private:
  static Lanes<float> coefficients(const ScaleCoefficients* c, uint32_t i) {
    const auto of = [&](uint32_t s) { return static_cast<float>(c[s].c[i]) * (1.0f / 64); };
    return Lanes<float>{of(0), of(1), of(2), 0};
  }
};

/// The scale in 1/16 of a lattice step, not negative, and which of its two terms is more than twice
/// the other.
struct ScaleEstimate {
  Lanes<float> scale;
  Lanes<uint32_t> set;  ///< 1: spread, 2: neighbours, 0: neither; only with kSplit
};

MCC_INLINE ScaleEstimate estimateScale(const ScaleLanes& c, const Lanes<float>& magnitudes,
                                       const Lanes<float>& spread, const Lanes<float>& third,
                                       bool split) {
  const Lanes<float> of_neighbours = c.neighbours * magnitudes;
  const Lanes<float> of_spread = c.spread * spread + c.third * third;
  const Lanes<float> scale = of_neighbours + of_spread + c.constant;
  if (!split) return {scale, Lanes<uint32_t>{}};
  const Lanes<int32_t> by_spread = of_spread > 2 * of_neighbours;
  const Lanes<int32_t> by_neighbours = of_neighbours > 2 * of_spread;
  return {scale, lanesAs<uint32_t>((by_spread & 1) | (by_neighbours & 2))};
}

/// Returns the half-octave buckets of scales, 0 .. kScaleBuckets-1: the exponent and the highest
/// fraction bit of scale + 1.
MCC_INLINE Lanes<uint32_t> scaleBuckets(const Lanes<float>& scale) {
  const Lanes<uint32_t> bucket = (lanesAs<uint32_t>(scale + 1.0f) >> 22) - 2 * 127;
  return minimumLanes(bucket, kScaleBuckets - 1);
}
/// Returns the bucket of one scale.
MCC_INLINE uint32_t scaleBucket(float scale) {
  return std::min((std::bit_cast<uint32_t>(scale + 1.0f) >> 22) - 2 * 127, kScaleBuckets - 1);
}

/// How the residuals of a vertex are coded, by component.
struct ResidualContexts {
  uint32_t row[4];
  /// Small residuals are numbered outwards from the unrounded prediction: 0, +1, -1, .. or 0, -1,
  /// +1, ..
  uint32_t folded[4];  ///< all ones or 0
  uint32_t flip[4];    ///< 1 if the prediction was rounded up
};

/// Finds the contexts of all components. `rounded` is the fraction of the prediction plus one half.
template <class Fold>
MCC_INLINE void findContexts(const ScaleEstimate& scale, const Lanes<uint32_t>& rounded, bool split,
                             Fold fold, ResidualContexts& out) {
  constexpr uint32_t kRows = kRowSets * kRowsPerSet;
  const Lanes<uint32_t> bucket = scaleBuckets(scale.scale);
  Lanes<uint32_t> row = bucket + Lanes<uint32_t>{0, kRows, 2 * kRows, 0};
  if (split) row += scale.set * kRowsPerSet;
  if (fold) {
    const Lanes<uint32_t> fraction = (rounded & 255) - 128;
    const Lanes<uint32_t> folded = lanesAs<uint32_t>(bucket < kFoldBuckets);
    const Lanes<uint32_t> fraction_class =
        minimumLanes(absoluteLanes(fraction) >> 5, kFractionClasses - 1);
    row += folded & (fraction_class * kFoldBuckets + kScaleBuckets);
    storeLanes<uint32_t>(folded, out.folded);
    storeLanes<uint32_t>(fraction >> 31, out.flip);
  }
  storeLanes<uint32_t>(row, out.row);
}

/// Codes what follows the token of a magnitude: raw bits and a sign.
template <class Io>
MCC_SHARED uint32_t codeBelowToken(Io& io, uint32_t token, uint32_t low_bits, bool has_sign,
                                   uint32_t truth, uint32_t& negative) {
  if (token != kTokenEscape) [[likely]] {
    const uint32_t base = uint32_t{kTokenBase[token]} << low_bits;
    return io.magnitude(base, kTokenExtraBits[token] + low_bits, has_sign, truth, negative);
  }
  const uint32_t above = (truth >> low_bits) - 127;
  const uint32_t k =
      io.raw(5, Io::kEncoding ? static_cast<uint32_t>(std::bit_width(above)) - 1 : 0);
  const uint32_t mask = (uint32_t{1} << k) - 1;
  const uint32_t z = ((mask + 1) | io.raw(k, above & mask)) + 127;
  const uint32_t a = z << low_bits | io.raw(low_bits, truth & ((1u << low_bits) - 1));
  if (has_sign) negative = io.raw(1, negative);
  return a;
}

/// Codes one residual: its magnitude above the bucket's low bits as a token, then raw bits, then a
/// sign unless it is folded.
template <uint32_t kState, class Io, class Fold>
MCC_INLINE int32_t codeResidual(Io& io, TokenRow& row, uint32_t low_bits, uint32_t folded,
                                uint32_t flip, int32_t truth, Fold fold) {
  const bool has_sign = !fold || folded == 0;
  uint32_t a = 0;
  uint32_t token = 0;
  if constexpr (Io::kEncoding) {
    const uint32_t t = static_cast<uint32_t>(truth);
    a = truth < 0 ? 0u - t : t;
    // -2^31 and 2^31 are the same residual; only the latter has a folded number.
    const bool odd = (truth > 0) != (flip != 0) || a == 0x80000000u;
    if (!has_sign && a != 0) a = 2 * a - (odd ? 1 : 0);
    token = tokenOf(a >> low_bits);
  }
  token = io.template token<kState>(row, kPositionSchedule, token);
  uint32_t negative = truth < 0 ? 1 : 0;
  a = codeBelowToken(io, token, low_bits, has_sign, a, negative);
  if (fold) {
    const uint32_t unfolded = a / 2 + (a & 1);
    const uint32_t side = (~a & 1) ^ flip;
    a ^= (a ^ unfolded) & folded;
    negative ^= (negative ^ side) & folded;
  }
  const uint32_t mask = ~negative + 1;
  return static_cast<int32_t>((a ^ mask) - mask);
}

MCC_INLINE TokenSpans::Span tokenSpan(uint32_t low_bits, uint32_t token) {
  if constexpr (kCompact) {
    return {uint32_t{kTokenBase[token]} << low_bits, kTokenExtraBits[token] + low_bits};
  } else {
    return kTokenSpans.of[low_bits][token];
  }
}

/// Decodes the residuals of all components with a ThreeAtOnceIo; lane 3 is 0.
template <class Io, class Fold>
MCC_INLINE Lanes<uint32_t> decodeResiduals(Io& io, TokenRow* rows, const ResidualContexts& c,
                                           Fold fold) {
  TokenRow* const row[3] = {rows + c.row[0], rows + c.row[1], rows + c.row[2]};
  uint32_t token[3];
  io.threeTokens(row, kPositionSchedule, token);
  uint32_t base[3];
  uint32_t bits[3];
  uint32_t signs[3];
  uint32_t a[3];
  uint32_t negative[3];
  MCC_UNROLL
  for (uint32_t s = 0; s < 3; ++s) {
    const TokenSpans::Span span = tokenSpan(row[s]->low_bits, token[s]);
    base[s] = span.base;
    bits[s] = span.bits;
    signs[s] = fold ? ~c.folded[s] & 1 : 1;
  }
  if (!io.threeMagnitudes(base, bits, signs, a, negative)) [[unlikely]] {
    MCC_UNROLL  // else gcc keeps the arrays in memory for this rare case
        for (uint32_t s = 0; s < 3; ++s) {
      negative[s] = 0;
      a[s] = codeBelowToken(io, token[s], row[s]->low_bits, signs[s] != 0, 0, negative[s]);
    }
  }
  Lanes<uint32_t> size = {a[0], a[1], a[2], 0};
  Lanes<uint32_t> side = {negative[0], negative[1], negative[2], 0};
  if (fold) {
    const Lanes<uint32_t> folded = loadLanes<uint32_t>(c.folded);
    const Lanes<uint32_t> unfolded = (size >> 1) + (size & 1);
    const Lanes<uint32_t> side_of_folded = (~size & 1) ^ loadLanes<uint32_t>(c.flip);
    size ^= (size ^ unfolded) & folded;
    side ^= (side ^ side_of_folded) & folded;
  }
  const Lanes<uint32_t> mask = 0u - side;
  return (size ^ mask) - mask;
}

/// Codes the residuals of all components. Their rows must be known before the first is coded.
/// `truth` has three (encoder). Lane 3 is 0.
template <class Io, class Fold>
MCC_INLINE Lanes<uint32_t> codeResiduals(Io& io, TokenRow* rows, const ResidualContexts& c,
                                         const int32_t* truth, Fold fold) {
  if constexpr (ThreeAtOnceIo<Io>) {
    if (io.threeAtOnce()) return decodeResiduals(io, rows, c, fold);
  }
  const auto code = [&](auto state, uint32_t s) MCC_INLINE_LAMBDA {
    TokenRow& row = rows[c.row[s]];
    const uint32_t folded = fold ? c.folded[s] : 0;
    const uint32_t flip = fold ? c.flip[s] : 0;
    return static_cast<uint32_t>(codeResidual<state>(io, row, row.low_bits, folded, flip,
                                                     Io::kEncoding ? truth[s] : 0, fold));
  };
  using State = std::integral_constant<uint32_t, 0>;
  if constexpr (kCompact) {  // compact code has one coder only, which has no states
    Lanes<uint32_t> residuals{};
    for (uint32_t s = 0; s < 3; ++s) residuals[s] = code(State{}, s);
    return residuals;
  } else {
    const uint32_t x = code(State{}, 0);
    const uint32_t y = code(std::integral_constant<uint32_t, 1>{}, 1);
    const uint32_t z = code(std::integral_constant<uint32_t, 2>{}, 2);
    return Lanes<uint32_t>{x, y, z, 0};
  }
}

/// Codes a single residual in the row of its scale's bucket.
template <uint32_t kState, class Io>
MCC_INLINE int32_t codeScaledResidual(Io& io, TokenRow& row, uint32_t bucket, int32_t truth) {
  return codeResidual<kState>(io, row, lowBitsOf(bucket), 0, 0, truth, std::false_type{});
}

}  // namespace mcc

#endif  // MCC_POSITIONS_RESIDUAL_H_
