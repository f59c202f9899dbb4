// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_BASE_HOST_H_
#define MCC_BASE_HOST_H_

#include <cfloat>
#include <type_traits>

// With MCC_PORTABLE nothing is used that the standard does not have: no vector types, no vector
// instructions and no builtins. It is meant for compilers other than gcc and clang, and for testing
// with those that such a build computes the same.
#if !defined(MCC_PORTABLE) && !defined(__GNUC__)
#define MCC_PORTABLE 1
#endif

// The vector instructions of the target, of which at most one is defined.
#if defined(MCC_PORTABLE)
#elif defined(__SSE2__)
#define MCC_SSE2 1
#include <emmintrin.h>
#elif defined(__ARM_NEON) && defined(__aarch64__)
#define MCC_NEON 1
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#define MCC_WASM_SIMD 1
#include <wasm_simd128.h>
#endif

namespace mcc {

// The decoded bytes are the same everywhere only if float32 is rounded after every operation.
static_assert(FLT_EVAL_METHOD == 0,
              "x87 arithmetic rounds differently: compile for x86 with -msse2 -mfpmath=sse");

}  // namespace mcc

/// For the few functions of inner loops that compilers would rather call, for what must not be
/// inlined there, and for loops over the three components, which gcc keeps as loops at -O2. With
/// MCC_CALLS functions are called unless the compiler thinks otherwise, which takes half of the time
/// to compile.
#if defined(MCC_PORTABLE)
#if defined(_MSC_VER)
#define MCC_INLINE __forceinline
#define MCC_OUT_OF_LINE __declspec(noinline)
#else
#define MCC_INLINE inline
#define MCC_OUT_OF_LINE
#endif
#define MCC_INLINE_LAMBDA
#define MCC_PREFETCH(address) static_cast<void>(address)
#define MCC_UNROLL
#else
#if defined(MCC_CALLS)
#define MCC_INLINE inline
#define MCC_INLINE_LAMBDA
#else
#define MCC_INLINE inline __attribute__((always_inline))
#define MCC_INLINE_LAMBDA __attribute__((always_inline))
#endif
#define MCC_OUT_OF_LINE __attribute__((noinline))
#if defined(__wasm__)  // has no such instruction, but would still compute the address
#define MCC_PREFETCH(address) static_cast<void>(address)
#else
#define MCC_PREFETCH(address) __builtin_prefetch(address)
#endif
#if defined(__clang__)
#define MCC_UNROLL _Pragma("unroll")
#else
#define MCC_UNROLL _Pragma("GCC unroll 4")
#endif
#endif

namespace mcc {

/// Where the size of the code counts (WebAssembly), what is compiled for every choice elsewhere is
/// compiled once.
#if defined(MCC_COMPACT)
inline constexpr bool kCompact = true;
#define MCC_SHARED inline MCC_OUT_OF_LINE
#else
inline constexpr bool kCompact = false;
#define MCC_SHARED MCC_INLINE
#endif

/// Compact code that is compiled for size alone: it also calls what is worth its length inlined.
#if defined(MCC_SMALL)
inline constexpr bool kSmall = true;
#define MCC_CALLED_IF_SMALL inline MCC_OUT_OF_LINE
#else
inline constexpr bool kSmall = false;
#define MCC_CALLED_IF_SMALL MCC_INLINE
#endif

/// For what runs once per payload: where the size of the code counts, that is all that counts.
#if defined(MCC_COMPACT) && defined(__clang__)
#define MCC_ONCE __attribute__((minsize, noinline))
#else
#define MCC_ONCE
#endif

/// A table of constants: made by the compiler; in compact code, where it would be data, by
/// prepare(), before all that looks at it.
template <auto kMake>
struct ConstantTable {
#if defined(MCC_COMPACT)
  static inline bool is_prepared = false;
  static inline decltype(kMake()) table;
  static void prepare() {
    if (!is_prepared) table = kMake();
    is_prepared = true;
  }
#else
  static constexpr auto table = kMake();
  static void prepare() {}
#endif
};

/// Calls `function` with `choice`: as a constant, for which it is compiled apart, unless the code
/// is compact.
template <class Function>
MCC_INLINE auto withChoice(bool choice, const Function& function) {
  if constexpr (kCompact) {
    return function(choice);
  } else {
    return choice ? function(std::true_type{}) : function(std::false_type{});
  }
}

}  // namespace mcc

#endif  // MCC_BASE_HOST_H_
