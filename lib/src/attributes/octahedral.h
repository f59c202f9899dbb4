// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Unit vectors on an octahedral grid, in float32 with one order of operations.               [B.4.1]
#ifndef MCC_ATTRIBUTES_OCTAHEDRAL_H_
#define MCC_ATTRIBUTES_OCTAHEDRAL_H_

#include <cmath>
#include <cstdint>

namespace mcc {

/// Grid coordinates run from 0 to 2 * octahedralCentre(bits).
constexpr int32_t octahedralCentre(uint32_t bits) {
  return static_cast<int32_t>((uint32_t{1} << (bits - 1)) - 1);
}

/// Unit vector of a grid point. Outside the grid the result is some finite vector.
inline void octahedralToUnit(int32_t s, int32_t t, int32_t centre, float* unit) {
  const float scale = 1.0f / static_cast<float>(centre);
  const float grid_x = (static_cast<float>(s) - static_cast<float>(centre)) * scale;
  const float grid_y = (static_cast<float>(t) - static_cast<float>(centre)) * scale;
  const float ax = std::fabs(grid_x);
  const float ay = std::fabs(grid_y);
  const float z = 1.0f - ax - ay;
  const bool folded = z < 0.0f;  // as likely as not: selects, no branches
  const float folded_x = std::copysign(1.0f - ay, grid_x);
  const float folded_y = std::copysign(1.0f - ax, grid_y);
  const float x = folded ? folded_x : grid_x;
  const float y = folded ? folded_y : grid_y;
  const float length = std::sqrt(x * x + y * y + z * z);
  const float inverse = 1.0f / length;
  unit[0] = x * inverse;
  unit[1] = y * inverse;
  unit[2] = z * inverse;
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_OCTAHEDRAL_H_
