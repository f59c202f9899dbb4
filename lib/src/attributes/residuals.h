// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Residuals of attributes as tokens and raw bits.                                            [A.8.2]
#ifndef MCC_ATTRIBUTES_RESIDUALS_H_
#define MCC_ATTRIBUTES_RESIDUALS_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "entropy/models.h"

namespace mcc {

/// Contexts of a residual: the mean bit length of its neighbours' residuals, or why there is none.
inline constexpr uint32_t kLengthContexts = 12;
inline constexpr uint32_t kLongestContext = 10;
inline constexpr uint32_t kNoNeighbours = 11;
inline constexpr uint8_t kNotCoded = 0xff;  ///< as a length
inline constexpr uint32_t kTokenEscapeLength = 15;

constexpr uint32_t absoluteOf(int32_t value) {
  return value < 0 ? 0u - static_cast<uint32_t>(value) : static_cast<uint32_t>(value);
}
/// Bit length of |residual|, at most kLongestContext: what neighbours see of it.
constexpr uint32_t contextLength(int32_t residual) {
  return std::min(static_cast<uint32_t>(std::bit_width(absoluteOf(residual))), kLongestContext);
}

/// The bits of a residual below the leading one of its magnitude, and its sign. length 1..32.
template <class Io>
int32_t codeBelowLength(Io& io, uint32_t length, int32_t truth) {
  const uint32_t low_mask = static_cast<uint32_t>((uint64_t{1} << (length - 1)) - 1);
  const uint32_t a = (low_mask + 1) | io.raw(length - 1, absoluteOf(truth) & low_mask);
  const uint32_t negative = io.raw(1, truth < 0 ? 1 : 0);
  const uint32_t mask = ~negative + 1;
  return static_cast<int32_t>((a ^ mask) - mask);
}

/// A length too long for a token: 5 raw bits from `from` on.
template <class Io>
uint32_t codeLongLength(Io& io, uint32_t from, uint32_t length) {
  return std::min(from + io.raw(5, length - from), 32u);
}

/// Layout 0: the token is the bit length of |residual|.
template <uint32_t kState, class Io>
int32_t codeByLength(Io& io, TokenRow& row, int32_t truth) {
  uint32_t length = static_cast<uint32_t>(std::bit_width(absoluteOf(truth)));
  const uint32_t token =
      io.template token<kState>(row, kAttributeSchedule, std::min(length, kTokenEscapeLength));
  length = token != kTokenEscapeLength ? token : codeLongLength(io, kTokenEscapeLength, length);
  return length == 0 ? 0 : codeBelowLength(io, length, truth);
}

/// Layout 1: tokens 0..6 are 0, 1, -1, 2, -2, 3, -3; from 7 on the bit length, 3 and more.
template <uint32_t kState, class Io>
int32_t codeSmallSigned(Io& io, TokenRow& row, int32_t truth) {
  constexpr uint32_t kFirstLength = 7;  // token of length 3
  constexpr uint32_t kEscapedLength = 11;
  const uint32_t absolute = absoluteOf(truth);
  const uint32_t true_length = static_cast<uint32_t>(std::bit_width(absolute));
  uint32_t token = 0;
  if constexpr (Io::kEncoding) {
    token = absolute < 4 ? 2 * absolute - (truth > 0 ? 1 : 0)
                         : std::min(true_length + (kFirstLength - 3), kTokenEscapeLength);
  }
  token = io.template token<kState>(row, kAttributeSchedule, token);
  if (token < kFirstLength) {
    const int32_t magnitude = static_cast<int32_t>((token + 1) / 2);
    return (token & 1) != 0 ? magnitude : -magnitude;
  }
  const uint32_t length = token != kTokenEscapeLength
                              ? token - (kFirstLength - 3)
                              : codeLongLength(io, kEscapedLength, true_length);
  return codeBelowLength(io, length, truth);
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_RESIDUALS_H_
