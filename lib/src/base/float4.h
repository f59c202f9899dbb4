// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Four floats at once, each rounded as a float on its own: what is computed with Float4 has the
// bits of the same formula on floats. Formulas that are needed both ways are templates over float
// and Float4. [A.1.2]
#ifndef MCC_BASE_FLOAT4_H_
#define MCC_BASE_FLOAT4_H_

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/host.h"
#include "base/lanes.h"

namespace mcc {

using Float4 = Lanes<float>;
using Mask4 = Lanes<int32_t>;  ///< lanes all ones or zero

MCC_INLINE Float4 allLanes(float x) { return Float4{x, x, x, x}; }
MCC_INLINE Float4 select(const Mask4& mask, const Float4& a, const Float4& b) {
  return lanesAs<float>((mask & lanesAs<int32_t>(a)) | (~mask & lanesAs<int32_t>(b)));
}
MCC_INLINE Float4 magnitude(const Float4& x) {
  return lanesAs<float>(lanesAs<int32_t>(x) & 0x7fffffff);
}
MCC_INLINE Float4 withSignOf(const Float4& x, const Float4& sign) {
  return select(Mask4{0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff}, x, sign);
}
MCC_INLINE Float4 squareRoot(const Float4& x) {
#if defined(MCC_SSE2)
  return (Float4)_mm_sqrt_ps((__m128)x);
#elif defined(MCC_NEON)
  return (Float4)vsqrtq_f32((float32x4_t)x);
#elif defined(MCC_WASM_SIMD)
  return (Float4)wasm_f32x4_sqrt((v128_t)x);
#else
  return Float4{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}
/// a0 - b0, a1 - b1 of pairs of integers; the subtraction wraps.
MCC_INLINE Float4 pairDifferences(const int32_t* a0, const int32_t* b0, const int32_t* a1,
                                  const int32_t* b1) {
  return convertLanes<float>(lanesAs<int32_t>(loadPairs(a0, a1) - loadPairs(b0, b1)));
}
/// a - b of four integers; the subtraction wraps.
MCC_INLINE Float4 fourDifferences(const int32_t* a, const int32_t* b) {
  const Lanes<uint32_t> x = lanesAs<uint32_t>(loadLanes<int32_t>(a));
  const Lanes<uint32_t> y = lanesAs<uint32_t>(loadLanes<int32_t>(b));
  return convertLanes<float>(lanesAs<int32_t>(x - y));
}
/// Pairs (x, y) to all x and all y.
MCC_INLINE void splitPairs(const Float4& first, const Float4& second, Float4& x, Float4& y) {
  x = shuffleLanes<float, 0, 2, 4, 6>(first, second);
  y = shuffleLanes<float, 1, 3, 5, 7>(first, second);
}
template <int kLane>
MCC_INLINE Float4 broadcast(const Float4& x) {
  return shuffleLanes<float, kLane, kLane, kLane, kLane>(x, x);
}
/// Rows to columns.
MCC_INLINE void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
  const Float4 ab_low = shuffleLanes<float, 0, 4, 1, 5>(a, b);
  const Float4 ab_high = shuffleLanes<float, 2, 6, 3, 7>(a, b);
  const Float4 cd_low = shuffleLanes<float, 0, 4, 1, 5>(c, d);
  const Float4 cd_high = shuffleLanes<float, 2, 6, 3, 7>(c, d);
  a = shuffleLanes<float, 0, 1, 4, 5>(ab_low, cd_low);
  b = shuffleLanes<float, 2, 3, 6, 7>(ab_low, cd_low);
  c = shuffleLanes<float, 0, 1, 4, 5>(ab_high, cd_high);
  d = shuffleLanes<float, 2, 3, 6, 7>(ab_high, cd_high);
}

/// Stores a pair at once: loads of pairs stall after two stores.
MCC_INLINE void storePair(int32_t* to, const int32_t* pair) {
  constexpr int kLow = std::endian::native == std::endian::little ? 0 : 1;
  const uint64_t both =
      uint64_t{static_cast<uint32_t>(pair[1 - kLow])} << 32 | static_cast<uint32_t>(pair[kLow]);
  std::memcpy(to, &both, sizeof both);
}
/// Four integers as floats.
MCC_INLINE Float4 fourFloats(int32_t a, int32_t b, int32_t c, int32_t d) {
  return Float4{static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
                static_cast<float>(d)};
}
MCC_INLINE Float4 loadFloat4(const float* from) { return loadLanes<float>(from); }
MCC_INLINE void storeFloat4(float* to, const Float4& x) { storeLanes<float>(x, to); }

/// The same names for floats.
MCC_INLINE float select(bool condition, float a, float b) {  // by bits: compilers would branch
  const uint32_t mask = ~uint32_t{condition} + 1;
  return std::bit_cast<float>((mask & std::bit_cast<uint32_t>(a)) |
                              (~mask & std::bit_cast<uint32_t>(b)));
}
MCC_INLINE float magnitude(float x) { return std::fabs(x); }
MCC_INLINE float withSignOf(float x, float sign) { return std::copysign(x, sign); }
MCC_INLINE float squareRoot(float x) { return std::sqrt(x); }

/// `x` in every lane of a Real.
template <class Real>
MCC_INLINE Real constant(float x) {
  if constexpr (sizeof(Real) == sizeof(float)) {
    return x;
  } else {
    return allLanes(x);
  }
}
template <class Real>
MCC_INLINE Real lower(Real a, Real b) {
  return select(b < a, b, a);
}
template <class Real>
MCC_INLINE Real higher(Real a, Real b) {
  return select(a < b, b, a);
}

}  // namespace mcc

#endif  // MCC_BASE_FLOAT4_H_
