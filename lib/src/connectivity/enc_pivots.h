// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The faces of a mesh in the order in which PivotCoder codes them.
#ifndef MCC_CONNECTIVITY_ENC_PIVOTS_H_
#define MCC_CONNECTIVITY_ENC_PIVOTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "connectivity/pivots.h"

namespace mcc {

struct PivotRecord {
  std::vector<PivotFace> faces;
  std::vector<uint32_t> class_of_vertex;
  std::vector<uint32_t> source_gate;  ///< by face: source half-edge 3f+k of its half-edge 1
};

/// Lists the faces. `corner_class` has 3 different position classes per triangle. Vertices are
/// numbered as they are met, starting from the first triangle. O(n log n), because the faces at an
/// edge are sorted.
PivotRecord listByPivots(std::span<const uint32_t> corner_class, uint32_t class_count);

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_ENC_PIVOTS_H_
