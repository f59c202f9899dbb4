// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The mirrors of a piece. [A.6.14]
#ifndef MCC_POSITIONS_MIRROR_H_
#define MCC_POSITIONS_MIRROR_H_

#include <algorithm>
#include <cstdint>

#include "mcc/status.h"
#include "mesh/vertex_mates.h"

namespace mcc {

/// A mirror across an axis: the image of a coordinate x on this axis is sum - x, which wraps.
struct Mirror {
  uint32_t axis;
  int32_t sum;
};
struct Mirrors {
  Mirror mirror[kMaxMirrors] = {};
  uint32_t count = 0;

  /// Returns the first mirror across an axis, or null.
  const Mirror* across(uint32_t axis) const {
    for (uint32_t i = 0; i < count; ++i) {
      if (mirror[i].axis == axis) return &mirror[i];
    }
    return nullptr;
  }
};

/// The bits of a sum, with its sign, for coordinates of `bits` bits.
constexpr uint32_t sumBits(uint32_t bits) { return std::min(bits + 2, 32u); }

/// Codes the mirrors of a piece, whose coordinates have `bits` bits.
template <class Io>
Status codeMirrors(Io& io, uint32_t bits, const Mirrors& truth, Mirrors& mirrors) {
  const uint32_t sum_bits = sumBits(bits);
  mirrors.count = 1 + io.raw(2, Io::kEncoding ? truth.count - 1 : 0);
  for (uint32_t i = 0; i < mirrors.count && i < kMaxMirrors; ++i) {
    Mirror& m = mirrors.mirror[i];
    const uint32_t sum = static_cast<uint32_t>(truth.mirror[i].sum);
    m.axis = io.raw(2, truth.mirror[i].axis);
    const uint32_t low = io.raw(sum_bits, sum << (32 - sum_bits) >> (32 - sum_bits));
    m.sum = static_cast<int32_t>(low << (32 - sum_bits)) >> (32 - sum_bits);
    if (m.axis > 2) return fail(Error::kBadAttribute, "a mirror has no axis");
  }
  if (mirrors.count > kMaxMirrors) return fail(Error::kBadAttribute, "there are too many mirrors");
  return {};
}

}  // namespace mcc

#endif  // MCC_POSITIONS_MIRROR_H_
