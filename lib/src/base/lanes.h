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
MCC_INLINE Lanes<uint32_t> absoluteLanes(const Lanes<uint32_t>& x) {
  const Lanes<uint32_t> negative = (Lanes<uint32_t>)((Lanes<int32_t>)x < 0);
  return (x ^ negative) - negative;
}

/// Of unsigned numbers below 2^31.
MCC_INLINE Lanes<uint32_t> minimumLanes(const Lanes<uint32_t>& x, uint32_t limit) {
  const Lanes<uint32_t> below = (Lanes<uint32_t>)((Lanes<int32_t>)x < static_cast<int32_t>(limit));
  return (x & below) | (~below & limit);
}

}  // namespace mcc

#endif  // MCC_BASE_LANES_H_
