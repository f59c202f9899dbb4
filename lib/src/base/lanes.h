// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Four numbers at once: the components of a vertex and one to spare. gcc and clang have types for
// them, which become vector instructions where the target has such; elsewhere, and with
// MCC_PORTABLE, they are a struct of four numbers with the same operators. Integers wrap, floats
// are rounded after every operation, so that all targets agree.
#ifndef MCC_BASE_LANES_H_
#define MCC_BASE_LANES_H_

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/host.h"

namespace mcc {

#if !defined(MCC_PORTABLE)

template <class T>
struct LanesOf {
  using Type __attribute__((vector_size(4 * sizeof(T)))) = T;
};
template <class T>
using Lanes = typename LanesOf<T>::Type;

/// The bits of `lanes` as numbers of another type of the same size.
template <class To, class From>
MCC_INLINE Lanes<To> lanesAs(const From& lanes) {
  return (Lanes<To>)lanes;
}
/// Every number converted to To.
template <class To, class From>
MCC_INLINE Lanes<To> convertLanes(const From& lanes) {
  return __builtin_convertvector(lanes, Lanes<To>);
}
/// a where `mask` is all ones, b where it is 0.
template <class T, class Mask>
MCC_INLINE Lanes<T> chooseLanes(const Mask& mask, const Lanes<T>& a, const Lanes<T>& b) {
  return mask ? a : b;
}
/// Lanes k0 .. k3 of the eight of `a` and `b`, both of the type Lanes<T>.
template <class T, int k0, int k1, int k2, int k3>
MCC_INLINE Lanes<T> shuffleLanes(const Lanes<T>& a, const Lanes<T>& b) {
#if defined(__clang__) || __GNUC__ >= 12
  return __builtin_shufflevector(a, b, k0, k1, k2, k3);
#else
  return __builtin_shuffle(a, b, Lanes<int32_t>{k0, k1, k2, k3});
#endif
}
/// a[0], a[1], b[0], b[1]; loads a pair at once.
MCC_INLINE Lanes<uint32_t> loadPairs(const int32_t* a, const int32_t* b) {
  typedef uint64_t Pairs __attribute__((vector_size(16)));
  const auto pair = [](const int32_t* from) {
    uint64_t x;
    std::memcpy(&x, from, sizeof x);
    return x;
  };
  return (Lanes<uint32_t>)Pairs{pair(a), pair(b)};
}

#else

template <class T>
struct Lanes {
  using Unsigned = typename std::conditional_t<std::is_integral_v<T>, std::make_unsigned<T>,
                                               std::type_identity<T>>::type;  // wraps
  /// All ones where a comparison holds, else 0.
  using Mask = Lanes<int32_t>;

  T lane[4];

  template <std::integral Index>
  MCC_INLINE T& operator[](Index i) {
    return lane[i];
  }
  template <std::integral Index>
  MCC_INLINE T operator[](Index i) const {
    return lane[i];
  }

  /// operation(i) in every lane i.
  template <class Operation>
  MCC_INLINE static Lanes each(Operation operation) {
    return {{operation(0u), operation(1u), operation(2u), operation(3u)}};
  }
  MCC_INLINE static Lanes all(T x) { return {{x, x, x, x}}; }

#define MCC_LANES_OPERATOR(op, Operand)                                                \
  MCC_INLINE friend Lanes operator op(const Lanes& a, const Lanes& b) {                \
    return each([&](uint32_t i) {                                                      \
      return static_cast<T>(static_cast<Operand>(a[i]) op static_cast<Operand>(b[i])); \
    });                                                                                \
  }                                                                                    \
  MCC_INLINE friend Lanes operator op(const Lanes& a, T b) { return a op all(b); }     \
  MCC_INLINE friend Lanes operator op(T a, const Lanes& b) { return all(a) op b; }     \
  MCC_INLINE friend Lanes& operator op##=(Lanes& a, const Lanes& b) { return a = a op b; }
  MCC_LANES_OPERATOR(+, Unsigned)
  MCC_LANES_OPERATOR(-, Unsigned)
  MCC_LANES_OPERATOR(*, Unsigned)
  MCC_LANES_OPERATOR(/, T)
  MCC_LANES_OPERATOR(&, T)
  MCC_LANES_OPERATOR(|, T)
  MCC_LANES_OPERATOR(^, T)
#undef MCC_LANES_OPERATOR

  MCC_INLINE friend Lanes operator<<(const Lanes& a, int bits) {
    return each([&](uint32_t i) { return static_cast<T>(a[i] << bits); });
  }
  MCC_INLINE friend Lanes operator>>(const Lanes& a, int bits) {
    return each([&](uint32_t i) { return static_cast<T>(a[i] >> bits); });
  }
  MCC_INLINE friend Lanes operator-(const Lanes& a) {
    return each([&](uint32_t i) { return static_cast<T>(-static_cast<Unsigned>(a[i])); });
  }
  MCC_INLINE friend Lanes operator~(const Lanes& a) {
    return each([&](uint32_t i) { return static_cast<T>(~a[i]); });
  }
  MCC_INLINE friend Mask operator<(const Lanes& a, const Lanes& b) {
    return Mask::each([&](uint32_t i) { return a[i] < b[i] ? -1 : 0; });
  }
  MCC_INLINE friend Mask operator<=(const Lanes& a, const Lanes& b) {
    return Mask::each([&](uint32_t i) { return a[i] <= b[i] ? -1 : 0; });
  }
  MCC_INLINE friend Mask operator>(const Lanes& a, const Lanes& b) { return b < a; }
  MCC_INLINE friend Mask operator<(const Lanes& a, T b) { return a < all(b); }
};

template <class To, class From>
MCC_INLINE Lanes<To> lanesAs(const Lanes<From>& lanes) {
  return std::bit_cast<Lanes<To>>(lanes);
}
template <class To, class From>
MCC_INLINE Lanes<To> convertLanes(const Lanes<From>& lanes) {
  return Lanes<To>::each([&](uint32_t i) { return static_cast<To>(lanes[i]); });
}
template <class T>
MCC_INLINE Lanes<T> chooseLanes(const typename Lanes<T>::Mask& mask, const Lanes<T>& a,
                                const Lanes<T>& b) {
  return Lanes<T>::each([&](uint32_t i) { return mask[i] != 0 ? a[i] : b[i]; });
}
template <class T, int k0, int k1, int k2, int k3>
MCC_INLINE Lanes<T> shuffleLanes(const Lanes<T>& a, const Lanes<T>& b) {
  const auto of = [&](uint32_t i) { return i < 4 ? a[i] : b[i - 4]; };
  return {{of(k0), of(k1), of(k2), of(k3)}};
}
MCC_INLINE Lanes<uint32_t> loadPairs(const int32_t* a, const int32_t* b) {
  return lanesAs<uint32_t>(Lanes<int32_t>{{a[0], a[1], b[0], b[1]}});
}

#endif

/// The four numbers at `from`, converted to To.
template <class To, class From>
MCC_INLINE Lanes<To> loadLanes(const From* from) {
  Lanes<From> lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return convertLanes<To>(lanes);
}
template <class T>
MCC_INLINE void storeLanes(const Lanes<T>& lanes, T* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

/// |x| of numbers taken as signed; the smallest stays.
MCC_INLINE Lanes<uint32_t> absoluteLanes(const Lanes<uint32_t>& x) {
  const Lanes<uint32_t> negative = lanesAs<uint32_t>(lanesAs<int32_t>(x) < 0);
  return (x ^ negative) - negative;
}

/// The smaller of each number and `limit`, all below 2^31.
MCC_INLINE Lanes<uint32_t> minimumLanes(const Lanes<uint32_t>& x, uint32_t limit) {
  const Lanes<uint32_t> below =
      lanesAs<uint32_t>(lanesAs<int32_t>(x) < static_cast<int32_t>(limit));
  return (x & below) | (~below & limit);
}

}  // namespace mcc

#endif  // MCC_BASE_LANES_H_
