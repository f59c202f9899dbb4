// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Unit vectors on an octahedral grid, in float32 with one order of operations. [A.10.6]
#ifndef MCC_VECTORS_OCTAHEDRAL_H_
#define MCC_VECTORS_OCTAHEDRAL_H_

#include <cstdint>

#include "base/float4.h"

namespace mcc {

/// Grid coordinates run from 0 to 2 * octahedralCentre(bits).
constexpr int32_t octahedralCentre(uint32_t bits) {
  return static_cast<int32_t>((uint32_t{1} << (bits - 1)) - 1);
}

/// The point of the octahedron |x| + |y| + |z| = 1 that is unfolded to (x, y) in -1..1. Outside of
/// that the result is some finite vector.
template <class Real>
MCC_INLINE void foldToOctahedron(Real x, Real y, Real* point) {
  const Real one = constant<Real>(1.0f);
  const Real ax = magnitude(x);
  const Real ay = magnitude(y);
  const Real z = one - ax - ay;
  const auto folded = z < constant<Real>(0.0f);  // as likely as not: selects, no branches
  point[0] = select(folded, withSignOf(one - ay, x), x);
  point[1] = select(folded, withSignOf(one - ax, y), y);
  point[2] = z;
}

/// Unit vectors of grid points, given as floats relative to the centre, `scale` = 1 / centre.
template <class Real>
MCC_INLINE void octahedralToUnit(Real s, Real t, Real scale, Real* unit) {
  foldToOctahedron(s * scale, t * scale, unit);
  const Real inverse =
      constant<Real>(1.0f) / squareRoot(unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2]);
  for (int c = 0; c < 3; ++c) unit[c] = unit[c] * inverse;
}

/// Unit vector of a grid point. Outside the grid the result is some finite vector.
inline void octahedralToUnit(int32_t s, int32_t t, int32_t centre, float* unit) {
  const float middle = static_cast<float>(centre);
  octahedralToUnit(static_cast<float>(s) - middle, static_cast<float>(t) - middle, 1.0f / middle,
                   unit);
}

/// Unit vectors of four grid points.
MCC_SHARED void octahedralToUnit(const int32_t* const* points, int32_t centre, Float4* unit) {
  const Float4 middle = allLanes(static_cast<float>(centre));
  const Float4 s = fourFloats(points[0][0], points[1][0], points[2][0], points[3][0]);
  const Float4 t = fourFloats(points[0][1], points[1][1], points[2][1], points[3][1]);
  octahedralToUnit(s - middle, t - middle, allLanes(1.0f) / middle, unit);
}

}  // namespace mcc

#endif  // MCC_VECTORS_OCTAHEDRAL_H_
