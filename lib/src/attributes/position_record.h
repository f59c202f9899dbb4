// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// State of a vertex while positions are coded: half a cache line.                            [B.2.1]
#ifndef MCC_ATTRIBUTES_POSITION_RECORD_H_
#define MCC_ATTRIBUTES_POSITION_RECORD_H_

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "base/host.h"

namespace mcc {

struct VertexRecord {
  int32_t q[4];           ///< lattice coordinates; [3] is unused
  uint16_t magnitude[4];  ///< |residual| per coded component, packed; [3] is unused
  uint16_t known;
  uint16_t degree;  ///< faces; for boundary vertices min(12, 2 * faces)
  uint16_t score;   ///< faces whose other two corners are known
  uint16_t boundary;
};
static_assert(sizeof(VertexRecord) == 32);

/// |residual| as contexts keep it. Narrow lattices saturate; wide ones keep 11 leading bits.
template <class Wide>
MCC_INLINE uint16_t packMagnitude(uint32_t absolute) {
  if constexpr (std::is_same_v<Wide, int32_t>) {
    return static_cast<uint16_t>(std::min(absolute, 0xffffu));
  } else {
    const uint32_t width = static_cast<uint32_t>(std::bit_width(absolute));
    const uint32_t shift = width > 11 ? width - 11 : 0;
    return static_cast<uint16_t>(1024 * shift + (absolute >> shift));
  }
}

template <class Wide>
MCC_INLINE uint32_t unpackMagnitude(uint16_t packed) {
  if constexpr (std::is_same_v<Wide, int32_t>) {
    return packed;
  } else {
    if (packed < 2048) return packed;
    return (1024u + (packed & 1023u)) << (packed / 1024 - 1);
  }
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITION_RECORD_H_
