// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Constants of the position coder; they are part of the format. [A.6]
#ifndef MCC_POSITIONS_TABLES_H_
#define MCC_POSITIONS_TABLES_H_

#include <cstdint>

#include "entropy/models.h"

namespace mcc {

/// Predictor classes by what is known around a vertex. Classes 0..5 are fans that are not plain, by
/// their tips; classes 6..12 are plain fans, by the vertex's degree; classes 13..21 are plain fans
/// by how well the three kinds of parallelograms did one step back (tip selection).
inline constexpr uint32_t kClassClosedFewTips = 4;
inline constexpr uint32_t kClassClosedManyTips = 5;
inline constexpr uint32_t kClassPlain = 6;
inline constexpr uint32_t kLeastDegree = 3;  ///< lower degrees share this class
inline constexpr uint32_t kMostDegree = 9;
inline constexpr uint32_t kClassSelect = 13;
inline constexpr uint32_t kPredictorClasses = 22;
inline constexpr uint32_t kMostWeights = 8;

/// Returns the number of weights of a class.
constexpr uint32_t weightCount(uint32_t predictor_class) {
  return predictor_class < kClassPlain ? 1 : predictor_class < kClassSelect ? 5 : kMostWeights;
}

/// Weights in units of 1/128. A plain fan has weights of the features f0, f1, fy, fd and of f0 by
/// degrees, and of three more with tip selection; any other fan has one, of the mean of the
/// neighbours. [A.6.4, A.6.5]
struct PredictorWeights {
  int16_t w[kPredictorClasses][kMostWeights];
};

inline constexpr PredictorWeights kUniversalWeights{{
    {5},
    {37},
    {23},
    {26},
    {84},
    {78},
    {0, 0, 0, 0, 0},
    {98, -97, -4, -2, -4},
    {71, -53, -5, -4, -4},
    {50, -5, -7, -7, -3},
    {34, 13, -8, -9, -4},
    {20, 35, -9, -10, -4},
    {3, 60, -15, -11, -5},
}};

/// Coefficients of a residual's scale in 1/64: for the neighbours' residuals, the spread of the
/// tips, a constant, and for a plain fan the distance of the parallelogram within it.
struct ScaleCoefficients {
  uint16_t c[4];
};

/// Returns the number of coefficients of a fan, plain or not.
constexpr uint32_t coefficientCount(uint32_t plain) { return plain != 0 ? 4 : 3; }

/// Indexed by [weighted predictor][fan of three][component].
inline constexpr ScaleCoefficients kUniversalScale[2][2][3] = {
    {{{{196, 12, 1662, 0}}, {{216, 12, 1638, 0}}, {{208, 13, 1749, 0}}},
     {{{138, 155, 1222, 52}}, {{143, 158, 1186, 52}}, {{140, 151, 1299, 52}}}},
    {{{{200, 17, 1672, 0}}, {{207, 19, 1672, 0}}, {{188, 18, 1766, 0}}},
     {{{136, 90, 1207, 25}}, {{142, 93, 1185, 25}}, {{136, 91, 1292, 25}}}}};
/// The same with shear.
inline constexpr ScaleCoefficients kShearedScale[2][2][3] = {
    {{{{183, 9, 1774, 0}}, {{170, 13, 1780, 0}}, {{147, 17, 1437, 0}}},
     {{{112, 154, 1364, 49}}, {{110, 155, 1382, 49}}, {{140, 65, 1151, 7}}}},
    {{{{169, 13, 1818, 0}}, {{160, 16, 1786, 0}}, {{157, 14, 1446, 0}}},
     {{{113, 87, 1386, 21}}, {{108, 91, 1378, 24}}, {{123, 49, 1121, 6}}}}};

inline constexpr uint32_t kScaleBuckets = 40;
inline constexpr uint32_t kFirstTabledBucket = 2;
inline constexpr uint32_t kLastTabledBucket = 22;

/// Initial frequencies of the tokens, per mille, for the scale buckets 2..22.
inline constexpr uint16_t kTokenFrequencies[kLastTabledBucket - kFirstTabledBucket + 1][16] = {
    {902, 97, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {795, 193, 7, 2, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0},
    {751, 235, 10, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {627, 342, 23, 5, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {530, 409, 47, 9, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {420, 445, 96, 23, 8, 3, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0},
    {313, 419, 165, 57, 23, 10, 5, 3, 4, 1, 1, 0, 0, 0, 0, 0},
    {226, 355, 213, 102, 48, 23, 12, 7, 10, 2, 1, 0, 0, 0, 0, 0},
    {153, 266, 204, 145, 86, 50, 30, 19, 32, 8, 5, 1, 1, 0, 0, 0},
    {105, 191, 163, 139, 115, 81, 53, 37, 72, 23, 15, 4, 3, 1, 0, 0},
    {214, 232, 196, 121, 74, 46, 31, 21, 39, 13, 9, 3, 1, 0, 0, 0},
    {140, 165, 149, 130, 99, 72, 51, 38, 83, 35, 25, 8, 4, 1, 0, 0},
    {202, 204, 180, 125, 79, 53, 38, 27, 55, 19, 11, 3, 1, 0, 0, 0},
    {134, 141, 141, 143, 109, 75, 56, 41, 90, 36, 23, 6, 3, 1, 0, 0},
    {197, 201, 211, 138, 80, 51, 34, 24, 43, 13, 7, 1, 0, 0, 0, 0},
    {147, 144, 150, 167, 117, 69, 50, 36, 74, 26, 15, 3, 1, 0, 0, 0},
    {225, 203, 252, 110, 74, 46, 29, 18, 31, 8, 3, 0, 0, 0, 0, 0},
    {183, 160, 142, 126, 108, 80, 57, 39, 72, 20, 10, 2, 0, 0, 0, 0},
    {268, 206, 178, 146, 87, 45, 27, 14, 23, 5, 1, 0, 0, 0, 0, 0},
    {209, 153, 141, 132, 127, 83, 48, 32, 56, 11, 5, 0, 0, 0, 0, 0},
    {370, 196, 176, 117, 69, 31, 16, 9, 15, 1, 0, 0, 0, 0, 0, 0},
};

inline constexpr uint32_t kTokenInitialUses = 6;
inline constexpr uint32_t kTokenInitialFloor = 8;

/// What follows a token: it stands for the values [base, base + 2^extra), times the scale's low
/// bits. The escape has no such range; its 64 is more than one look at the raw bits can hold, so it
/// always takes the slow path.
inline constexpr uint8_t kTokenExtraBits[kTokenCount] = {0, 0, 0, 0, 0, 0, 0, 0,
                                                         2, 2, 3, 3, 4, 4, 6, 64};
inline constexpr uint8_t kTokenBase[kTokenCount] = {0, 1,  2,  3,  4,  5,  6,  7,
                                                    8, 12, 16, 24, 32, 48, 64, 128};
inline constexpr uint32_t kTokenEscape = 15;

constexpr uint32_t lowBitsOf(uint32_t bucket) { return bucket >= 10 ? bucket / 2 - 5 : 0; }
inline constexpr uint32_t kMaxLowBits = lowBitsOf(kScaleBuckets - 1);

/// For each number of low bits, the base and the number of raw bits of every token.
struct TokenSpans {
  struct Span {
    uint32_t base;
    uint32_t bits;
  };
  Span of[kMaxLowBits + 1][kTokenCount];
};
constexpr TokenSpans makeTokenSpans() {
  TokenSpans spans{};
  for (uint32_t low = 0; low <= kMaxLowBits; ++low) {
    for (uint32_t token = 0; token < kTokenCount; ++token) {
      spans.of[low][token] = {uint32_t{kTokenBase[token]} << low, kTokenExtraBits[token] + low};
    }
  }
  return spans;
}
inline constexpr TokenSpans kTokenSpans = makeTokenSpans();

constexpr uint32_t tokenOf(uint32_t z) {
  if (z < 8) return z;
  uint32_t token = 8;
  while (token < kTokenEscape && kTokenBase[token + 1] <= z) ++token;
  return token;
}

/// Fills a row with frequencies in these proportions.
constexpr void setTokenRow(const uint32_t* frequency, TokenRow& row) {
  uint32_t sum = 0;
  for (uint32_t i = 0; i < kTokenCount; ++i) sum += frequency[i];
  const uint64_t shared = kTokenOne - kTokenCount * kTokenInitialFloor;
  uint64_t before = 0;
  for (uint32_t i = 0; i < kTokenCount; ++i) {
    row.c[i] = static_cast<uint16_t>(before * shared / sum + i * kTokenInitialFloor);
    before += frequency[i];
  }
  row.c[kTokenCount] = static_cast<uint16_t>(kTokenOne);
  row.uses = kTokenInitialUses;
}

/// Returns the trained frequencies of a bucket. Beyond the table the last rows repeat, because
/// tokens are relative to the scale there.
constexpr const uint16_t* trainedFrequencies(uint32_t bucket) {
  uint32_t b = bucket < kFirstTabledBucket ? kFirstTabledBucket : bucket;
  if (b > kLastTabledBucket) b = kLastTabledBucket - ((b - kLastTabledBucket) & 1);
  return kTokenFrequencies[b - kFirstTabledBucket];
}

/// Fills the row of a scale bucket as it is before the first symbol.
constexpr void makeTokenRow(uint32_t bucket, TokenRow& row) {
  uint32_t frequency[kTokenCount] = {};
  const uint16_t* trained = trainedFrequencies(bucket);
  for (uint32_t i = 0; i < kTokenCount; ++i) frequency[i] = trained[i];
  setTokenRow(frequency, row);
  row.low_bits = static_cast<uint16_t>(lowBitsOf(bucket));
}

/// Fills the row of a folded bucket as it is before the first symbol: the trained density of
/// |residual|, taken as symmetric and linear between integers, moved by the middle of the fraction
/// class, (2k+1)/16. [A.6.7]
constexpr void makeFoldedRow(uint32_t fraction_class, uint32_t bucket, TokenRow& row) {
  constexpr uint32_t kReach = 128;
  constexpr uint32_t kUnit = 64;  // resolution of densities within a token of 64 values
  const uint16_t* trained = trainedFrequencies(bucket);
  uint32_t density[kReach + 1] = {};  // the density of +i, and equally of -i
  for (uint32_t i = 0; i <= kReach; ++i) {
    const uint32_t token = tokenOf(i);
    density[i] = token == kTokenEscape ? 0 : (trained[token] * kUnit) >> kTokenExtraBits[token];
    if (i == 0) density[i] *= 2;
  }
  const uint32_t part = 2 * fraction_class + 1;
  uint32_t frequency[kTokenCount] = {};
  for (uint32_t a = 0; a < kReach; ++a) {
    const uint32_t i = (a + 1) / 2;
    const uint32_t towards = (a & 1) != 0 ? i - 1 : i + 1;  // +i lies nearer to the prediction
    frequency[tokenOf(a)] += density[towards] * part + density[i] * (16 - part);
  }
  uint32_t sum = 0;
  for (const uint32_t f : frequency) sum += f;
  for (uint32_t& f : frequency) f += sum / 2000;
  setTokenRow(frequency, row);
}

/// Small residuals have rows of their own by class of the prediction's fraction, see Folding.
inline constexpr uint32_t kFoldBuckets = 10;
inline constexpr uint32_t kFractionClasses = 4;

/// The initial rows are mostly computed by the compiler, since computing them takes longer than
/// decoding a small mesh.
struct InitialTokenRows {
  TokenRow plain[kScaleBuckets];
  TokenRow folded[kFractionClasses * kFoldBuckets];
};
constexpr InitialTokenRows makeInitialTokenRows() {
  InitialTokenRows rows{};
  for (uint32_t b = 0; b < kScaleBuckets; ++b) makeTokenRow(b, rows.plain[b]);
  for (uint32_t i = 0; i < kFractionClasses * kFoldBuckets; ++i) {
    makeFoldedRow(i / kFoldBuckets, i % kFoldBuckets, rows.folded[i]);
  }
  return rows;
}
using InitialRowTable = ConstantTable<makeInitialTokenRows>;

}  // namespace mcc

#endif  // MCC_POSITIONS_TABLES_H_
