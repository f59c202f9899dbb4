// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The state of a vertex while positions are coded: half a cache line, two vector registers. [A.6.3]
#ifndef MCC_POSITIONS_RECORD_H_
#define MCC_POSITIONS_RECORD_H_

#include <cstdint>

#include "base/host.h"
#include "base/lanes.h"

namespace mcc {

/// Before a vertex is coded, VertexRecord::state() counts the faces whose other two corners are
/// known, up to kHighestScore. A single store of all lanes makes coordinates and kKnown visible at
/// once.
inline constexpr int32_t kHighestScore = 3;
inline constexpr int32_t kKnown = 4;

struct VertexRecord {
  int32_t q[4];           ///< lattice coordinates; [3] is the state
  uint32_t magnitude[4];  ///< |residual| per coded component; [3] is the degree

  MCC_INLINE int32_t state() const { return q[3]; }
  MCC_INLINE bool known() const { return q[3] == kKnown; }
  /// Number of faces; for boundary vertices min(12, 2 * faces). It stays 0 if no predictor asks for
  /// it.
  MCC_INLINE uint32_t degree() const { return magnitude[3]; }
};
static_assert(sizeof(VertexRecord) == 32);

MCC_INLINE Lanes<uint32_t> coordinates(const VertexRecord* r) {
  return lanesAs<uint32_t>(loadLanes<int32_t>(r->q));
}
MCC_INLINE Lanes<uint32_t> magnitudes(const VertexRecord* r) {
  return loadLanes<uint32_t>(r->magnitude);
}

}  // namespace mcc

#endif  // MCC_POSITIONS_RECORD_H_
