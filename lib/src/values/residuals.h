// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Residuals of attributes as tokens and raw bits. [A.10.2]
#ifndef MCC_VALUES_RESIDUALS_H_
#define MCC_VALUES_RESIDUALS_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/host.h"
#include "entropy/models.h"

namespace mcc {

/// Contexts of a residual: the mean bit length of its neighbours' residuals, or why there is none.
inline constexpr uint32_t kLengthContexts = 12;
inline constexpr uint32_t kLongestContext = 10;
inline constexpr uint32_t kNoNeighbours = 11;
inline constexpr uint32_t kTokenEscapeLength = 15;

/// Context of a further residual of the same wedge, after one with `length`.
constexpr uint32_t contextAfter(uint32_t context, uint32_t length) {
  return context == kNoNeighbours ? context : (context + length + 1) / 2;
}

constexpr uint32_t absoluteOf(int32_t value) {
  return value < 0 ? 0u - static_cast<uint32_t>(value) : static_cast<uint32_t>(value);
}
/// Bit length of |residual|, at most kLongestContext: what neighbours see of it.
constexpr uint32_t contextLength(int32_t residual) {
  return std::min(static_cast<uint32_t>(std::bit_width(absoluteOf(residual))), kLongestContext);
}

/// A length too long for a token: 5 raw bits from `from` on.
template <class Io>
MCC_OUT_OF_LINE uint32_t codeLongLength(Io& io, uint32_t from, uint32_t length) {
  return std::min(from + io.raw(5, length - from), 32u);
}

/// The bits of a magnitude of `length` bits (0..32) below its leading one, and a sign above them;
/// returns the magnitude. No branches: lengths are close to random. `negative`: all ones or zero.
template <class Io>
MCC_INLINE uint32_t codeBelowLength(Io& io, uint32_t length, int32_t truth, uint32_t& negative) {
  const uint32_t leading = static_cast<uint32_t>((uint64_t{1} << length) >> 1);
  uint32_t bits = 0;
  if constexpr (Io::kEncoding) {
    bits = leading == 0 ? 0 : (absoluteOf(truth) & (leading - 1)) | (truth < 0 ? leading : 0);
  }
  bits = io.raw(length, bits);
  negative = ~uint32_t{(bits & leading) != 0} + 1;
  return leading | bits;
}

/// What follows a token of layout 0.
template <class Io>
MCC_SHARED int32_t codeBehindLength(Io& io, uint32_t token, int32_t truth, uint32_t& seen) {
  uint32_t length = token;
  seen = std::min(token, kLongestContext);
  if (token == kTokenEscapeLength) [[unlikely]] {
    length = codeLongLength(io, kTokenEscapeLength,
                            static_cast<uint32_t>(std::bit_width(absoluteOf(truth))));
  }
  uint32_t negative = 0;
  const uint32_t absolute = codeBelowLength(io, length, truth, negative);
  return static_cast<int32_t>((absolute ^ negative) - negative);
}

/// Layout 0: the token is the bit length of |residual|. `seen`: contextLength() of the residual,
/// known earlier.
template <uint32_t kState, class Io>
MCC_INLINE int32_t codeByLength(Io& io, TokenRow& row, int32_t truth, uint32_t& seen) {
  const uint32_t length = static_cast<uint32_t>(std::bit_width(absoluteOf(truth)));
  const uint32_t token =
      io.template token<kState>(row, kAttributeSchedule, std::min(length, kTokenEscapeLength));
  return codeBehindLength(io, token, truth, seen);
}

/// What the tokens of layout 1 stand for.
struct SmallSignedToken {
  uint8_t length;      ///< of the magnitude that follows, 0: none does
  int8_t value;        ///< when none does
  uint8_t in_context;  ///< contextLength()
};
inline constexpr SmallSignedToken kSmallSignedTokens[16] = {
    {0, 0, 0}, {0, 1, 1}, {0, -1, 1}, {0, 2, 2}, {0, -2, 2}, {0, 3, 2}, {0, -3, 2},  {3, 0, 3},
    {4, 0, 4}, {5, 0, 5}, {6, 0, 6},  {7, 0, 7}, {8, 0, 8},  {9, 0, 9}, {10, 0, 10}, {11, 0, 10}};

inline constexpr uint32_t kFirstLengthToken = 7;  ///< of length 3

/// What follows a token of layout 1.
template <class Io>
MCC_SHARED int32_t codeBehindSmall(Io& io, uint32_t token, int32_t truth, uint32_t& seen) {
  constexpr uint32_t kEscapedLength = 11;
  const SmallSignedToken& t = kSmallSignedTokens[token];
  seen = t.in_context;
  uint32_t length = t.length;
  if (token == kTokenEscapeLength) [[unlikely]] {
    length = codeLongLength(io, kEscapedLength,
                            static_cast<uint32_t>(std::bit_width(absoluteOf(truth))));
  }
  uint32_t negative = 0;
  const uint32_t large = codeBelowLength(io, length, truth, negative);
  return static_cast<int32_t>((large ^ negative) - negative) + t.value;
}

/// Layout 1: tokens 0..6 are 0, 1, -1, 2, -2, 3, -3; from 7 on the bit length, 3 and more.
template <uint32_t kState, class Io>
MCC_INLINE int32_t codeSmallSigned(Io& io, TokenRow& row, int32_t truth, uint32_t& seen) {
  uint32_t token = 0;
  if constexpr (Io::kEncoding) {
    const uint32_t absolute = absoluteOf(truth);
    const uint32_t length = static_cast<uint32_t>(std::bit_width(absolute));
    token = absolute < 4 ? 2 * absolute - (truth > 0 ? 1 : 0)
                         : std::min(length + (kFirstLengthToken - 3), kTokenEscapeLength);
  }
  token = io.template token<kState>(row, kAttributeSchedule, token);
  return codeBehindSmall(io, token, truth, seen);
}

}  // namespace mcc

#endif  // MCC_VALUES_RESIDUALS_H_
