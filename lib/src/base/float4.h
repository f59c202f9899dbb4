// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Four floats at once, each rounded as a float on its own: what is computed with Float4 has the bits of the same formula
// on floats. Formulas that are needed both ways are templates over float and Float4. [A.1.2]
#ifndef MCC_BASE_FLOAT4_H_
#define MCC_BASE_FLOAT4_H_

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/host.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__ARM_NEON) && defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace mcc {

#if defined(__GNUC__) && !defined(MCC_PLAIN_FLOAT4)

typedef float Float4 __attribute__((vector_size(16)));
typedef int32_t Mask4 __attribute__((vector_size(16)));  ///< lanes all ones or zero

MCC_INLINE Float4 allLanes(float x) { return Float4{x, x, x, x}; }
MCC_INLINE Float4 select(Mask4 mask, Float4 a, Float4 b) {
  return (Float4)((mask & (Mask4)a) | (~mask & (Mask4)b));
}
MCC_INLINE Float4 magnitude(Float4 x) {
  return (Float4)((Mask4)x & Mask4{0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff});
}
MCC_INLINE Float4 withSignOf(Float4 x, Float4 sign) {
  return select(Mask4{0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff}, x, sign);
}
MCC_INLINE Float4 squareRoot(Float4 x) {
#if defined(__SSE2__)
  return (Float4)_mm_sqrt_ps((__m128)x);
#elif defined(__ARM_NEON) && defined(__aarch64__)
  return (Float4)vsqrtq_f32((float32x4_t)x);
#elif defined(__wasm_simd128__)
  return (Float4)wasm_f32x4_sqrt((v128_t)x);
#else
  return Float4{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}
/// a0 - b0, a1 - b1 of pairs of integers; the subtraction wraps.
MCC_INLINE Float4 pairDifferences(const int32_t* a0, const int32_t* b0, const int32_t* a1,
                                  const int32_t* b1) {
  typedef uint32_t Unsigned4 __attribute__((vector_size(16)));
  typedef uint64_t Pairs __attribute__((vector_size(16)));
  const auto pair = [](const int32_t* from) {
    uint64_t x;
    std::memcpy(&x, from, sizeof x);
    return x;
  };
  const Unsigned4 a = (Unsigned4)Pairs{pair(a0), pair(a1)};
  const Unsigned4 b = (Unsigned4)Pairs{pair(b0), pair(b1)};
  return __builtin_convertvector((Mask4)(a - b), Float4);
}
/// a - b of four integers; the subtraction wraps.
MCC_INLINE Float4 fourDifferences(const int32_t* a, const int32_t* b) {
  typedef uint32_t Unsigned4 __attribute__((vector_size(16)));
  Unsigned4 x;
  Unsigned4 y;
  std::memcpy(&x, a, sizeof x);
  std::memcpy(&y, b, sizeof y);
  return __builtin_convertvector((Mask4)(x - y), Float4);
}
/// Pairs (x, y) to all x and all y.
MCC_INLINE void splitPairs(Float4 first, Float4 second, Float4& x, Float4& y) {
#if defined(__clang__) || __GNUC__ >= 12
  x = __builtin_shufflevector(first, second, 0, 2, 4, 6);
  y = __builtin_shufflevector(first, second, 1, 3, 5, 7);
#else
  x = Float4{first[0], first[2], second[0], second[2]};
  y = Float4{first[1], first[3], second[1], second[3]};
#endif
}
template <int kLane>
MCC_INLINE Float4 broadcast(Float4 x) {
#if defined(__clang__) || __GNUC__ >= 12
  return __builtin_shufflevector(x, x, kLane, kLane, kLane, kLane);
#else
  return __builtin_shuffle(x, Mask4{kLane, kLane, kLane, kLane});
#endif
}
/// Rows to columns.
MCC_INLINE void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
#if defined(__clang__) || __GNUC__ >= 12
  const Float4 ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Float4 ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Float4 cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
#else
  const Float4 rows[4] = {a, b, c, d};
  a = Float4{rows[0][0], rows[1][0], rows[2][0], rows[3][0]};
  b = Float4{rows[0][1], rows[1][1], rows[2][1], rows[3][1]};
  c = Float4{rows[0][2], rows[1][2], rows[2][2], rows[3][2]};
  d = Float4{rows[0][3], rows[1][3], rows[2][3], rows[3][3]};
#endif
}

#else

struct Mask4 {
  bool lane[4];
};

struct Float4 {
  float lane[4];
  float& operator[](int i) { return lane[i]; }
  float operator[](int i) const { return lane[i]; }
};

template <class Result, class Operation>
inline Result eachLane(Operation operation) {
  Result result;
  for (int i = 0; i < 4; ++i) result.lane[i] = operation(i);
  return result;
}
inline Float4 allLanes(float x) { return {{x, x, x, x}}; }
inline Float4 operator+(Float4 a, Float4 b) {
  return eachLane<Float4>([=](int i) { return a[i] + b[i]; });
}
inline Float4 operator-(Float4 a, Float4 b) {
  return eachLane<Float4>([=](int i) { return a[i] - b[i]; });
}
inline Float4 operator*(Float4 a, Float4 b) {
  return eachLane<Float4>([=](int i) { return a[i] * b[i]; });
}
inline Float4 operator/(Float4 a, Float4 b) {
  return eachLane<Float4>([=](int i) { return a[i] / b[i]; });
}
inline Float4 operator-(Float4 a) {
  return eachLane<Float4>([=](int i) { return -a[i]; });
}
inline Mask4 operator<(Float4 a, Float4 b) {
  return eachLane<Mask4>([=](int i) { return a[i] < b[i]; });
}
inline Mask4 operator>(Float4 a, Float4 b) { return b < a; }
inline Mask4 operator<=(Float4 a, Float4 b) {
  return eachLane<Mask4>([=](int i) { return a[i] <= b[i]; });
}
inline Mask4 operator&(Mask4 a, Mask4 b) {
  return eachLane<Mask4>([=](int i) { return a.lane[i] && b.lane[i]; });
}
inline Mask4 operator|(Mask4 a, Mask4 b) {
  return eachLane<Mask4>([=](int i) { return a.lane[i] || b.lane[i]; });
}
inline Float4 select(Mask4 mask, Float4 a, Float4 b) {
  return eachLane<Float4>([=](int i) { return mask.lane[i] ? a[i] : b[i]; });
}
inline Float4 magnitude(Float4 x) {
  return eachLane<Float4>([=](int i) { return std::fabs(x[i]); });
}
inline Float4 withSignOf(Float4 x, Float4 sign) {
  return eachLane<Float4>([=](int i) { return std::copysign(x[i], sign[i]); });
}
inline Float4 squareRoot(Float4 x) {
  return eachLane<Float4>([=](int i) { return std::sqrt(x[i]); });
}
inline Float4 pairDifferences(const int32_t* a0, const int32_t* b0, const int32_t* a1,
                              const int32_t* b1) {
  const auto difference = [](int32_t a, int32_t b) {
    return static_cast<float>(
        static_cast<int32_t>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b)));
  };
  return {{difference(a0[0], b0[0]), difference(a0[1], b0[1]), difference(a1[0], b1[0]),
           difference(a1[1], b1[1])}};
}
inline Float4 fourDifferences(const int32_t* a, const int32_t* b) {
  return eachLane<Float4>([=](int i) {
    return static_cast<float>(
        static_cast<int32_t>(static_cast<uint32_t>(a[i]) - static_cast<uint32_t>(b[i])));
  });
}
inline void splitPairs(Float4 first, Float4 second, Float4& x, Float4& y) {
  x = {{first[0], first[2], second[0], second[2]}};
  y = {{first[1], first[3], second[1], second[3]}};
}
template <int kLane>
inline Float4 broadcast(Float4 x) {
  return allLanes(x[kLane]);
}
inline void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
  const Float4 rows[4] = {a, b, c, d};
  for (int i = 0; i < 4; ++i) {
    a[i] = rows[i][0];
    b[i] = rows[i][1];
    c[i] = rows[i][2];
    d[i] = rows[i][3];
  }
}

#endif

/// Stores a pair at once: loads of pairs stall behind two stores.
MCC_INLINE void storePair(int32_t* to, const int32_t* pair) {
  const uint64_t both =
      uint64_t{static_cast<uint32_t>(pair[1])} << 32 | static_cast<uint32_t>(pair[0]);
  std::memcpy(to, &both, sizeof both);
}
/// Four integers as floats.
MCC_INLINE Float4 fourFloats(int32_t a, int32_t b, int32_t c, int32_t d) {
  return Float4{static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
                static_cast<float>(d)};
}
MCC_INLINE Float4 loadFloat4(const float* from) {
  Float4 x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
MCC_INLINE void storeFloat4(float* to, Float4 x) { std::memcpy(to, &x, sizeof x); }

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
