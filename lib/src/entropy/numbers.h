// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Codes for integers, made of binary decisions and tokens.                                 [A.3.5]
#ifndef MCC_ENTROPY_NUMBERS_H_
#define MCC_ENTROPY_NUMBERS_H_

#include <bit>
#include <cstdint>

#include "base/bytes.h"
#include "entropy/models.h"

namespace mcc {

/// Adaptive exponential-Golomb code of 0 .. 2^32-2: the length of value+1 in unary, then the two
/// bits below its leading one modelled, and the rest raw.
struct GolombModel {
  BitModel length[32];
  BitModel mantissa[32][3];
};

template <class Io>
uint32_t codeGolomb(Io& io, GolombModel& model, uint32_t truth) {
  const uint32_t target = static_cast<uint32_t>(std::bit_width(uint64_t{truth} + 1)) - 1;
  uint32_t length = 0;
  while (length < 31 && io.bit(model.length[length], Io::kEncoding && length < target)) ++length;
  uint64_t value = 1;
  const uint64_t shifted = uint64_t{truth} + 1;
  uint32_t node = 0;
  for (uint32_t i = 0; i < length; ++i) {
    const uint32_t below = length - 1 - i;
    if (i >= 2) {
      const uint32_t count = below + 1;
      const uint32_t mask = static_cast<uint32_t>((uint64_t{1} << count) - 1);
      value = value << count | io.raw(count, static_cast<uint32_t>(shifted) & mask);
      break;
    }
    const bool bit =
        io.bit(model.mantissa[length][node], Io::kEncoding && ((shifted >> below) & 1));
    value = value << 1 | (bit ? 1 : 0);
    node = bit ? 2 : 1;
  }
  return static_cast<uint32_t>(value - 1);
}

template <class Io>
int32_t codeSignedGolomb(Io& io, GolombModel& model, int32_t truth) {
  return unzigzag(codeGolomb(io, model, zigzag(truth)));
}

/// Adaptive tree over values of kBits bits, most significant bit first.
template <uint32_t kBits>
struct TreeModel {
  BitModel node[1u << kBits];
};

template <class Io, uint32_t kBits>
uint32_t codeTree(Io& io, TreeModel<kBits>& model, uint32_t truth) {
  uint32_t node = 1;
  for (uint32_t i = kBits; i-- != 0;) {
    node = node << 1 | (io.bit(model.node[node], Io::kEncoding && ((truth >> i) & 1)) ? 1u : 0u);
  }
  return node - (1u << kBits);
}

/// Codes one of `count` equally likely values. [A.3.5]
template <class Io>
uint32_t codeUniform(Io& io, uint32_t count, uint32_t truth) {
  const uint32_t bits = static_cast<uint32_t>(std::bit_width(count)) - 1;
  const uint32_t shorts =
      static_cast<uint32_t>((uint64_t{2} << bits) - count);  // values with `bits` bits
  const bool is_short = Io::kEncoding && truth < shorts;
  const uint32_t head = io.raw(bits, is_short ? truth : (truth + shorts) >> 1);
  if (head < shorts) return head;
  return 2 * head + io.raw(1, (truth + shorts) & 1) - shorts;
}

}  // namespace mcc

#endif  // MCC_ENTROPY_NUMBERS_H_
