// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Four numbers at once: the components of a vertex and one to spare. Compilers make vector instructions of it where the
// target has them; integers wrap, floats are rounded after every operation, so that all targets agree.
#ifndef MCC_BASE_LANES_H_
#define MCC_BASE_LANES_H_

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/host.h"

#if !defined(__GNUC__)
#error "lanes need the vector types of gcc and clang"
#endif

// Calls with vectors of 64-bit numbers would depend on the target. There are none: all that takes them is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace mcc {

template <class T>
struct LanesOf;
template <>
struct LanesOf<uint8_t> {
  using Type = uint8_t __attribute__((vector_size(4)));
};
template <>
struct LanesOf<int32_t> {
  using Type = int32_t __attribute__((vector_size(16)));
};
template <>
struct LanesOf<uint32_t> {
  using Type = uint32_t __attribute__((vector_size(16)));
};
template <>
struct LanesOf<int64_t> {
  using Type = int64_t __attribute__((vector_size(32)));
};
template <>
struct LanesOf<uint64_t> {
  using Type = uint64_t __attribute__((vector_size(32)));
};
template <>
struct LanesOf<float> {
  using Type = float __attribute__((vector_size(16)));
};

template <class T>
using Lanes = typename LanesOf<T>::Type;

/// The four numbers at `from`, converted to To.
template <class To, class From>
MCC_INLINE Lanes<To> loadLanes(const From* from) {
  Lanes<From> lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return __builtin_convertvector(lanes, Lanes<To>);
}
template <class T>
MCC_INLINE void storeLanes(const Lanes<T>& lanes, T* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}
template <class To, class From>
MCC_INLINE Lanes<To> convertLanes(const From& lanes) {
  return __builtin_convertvector(lanes, Lanes<To>);
}

/// |x| of numbers taken as signed; the smallest stays.
template <class UWide>
MCC_INLINE Lanes<UWide> absoluteLanes(const Lanes<UWide>& x) {
  const Lanes<UWide> negative = (Lanes<UWide>)((Lanes<std::make_signed_t<UWide>>)x < 0);
  return (x ^ negative) - negative;
}

/// Of unsigned numbers below 2^31 (2^63).
template <class UWide>
MCC_INLINE Lanes<UWide> minimumLanes(const Lanes<UWide>& x, UWide limit) {
  using Signed = std::make_signed_t<UWide>;
  const Lanes<UWide> below = (Lanes<UWide>)((Lanes<Signed>)x < static_cast<Signed>(limit));
  return (x & below) | (~below & limit);
}

}  // namespace mcc

#endif  // MCC_BASE_LANES_H_
