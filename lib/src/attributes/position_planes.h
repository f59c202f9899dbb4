// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Planes: evenly spaced coordinates that many vertices share. Isosurfaces (marching cubes, marching tetrahedra) have
// their vertices on the edges, faces or diagonals of the cells of a grid.                    [B.2.9]
//
// Of each vertex the payload tells
//   - on which axes it lies between planes; on the others the number of its plane is coded;
//   - where that is more than one axis, whether it moves along a diagonal: all of them then have the same distance t
//     from their planes, and the cells are coded;
//   - what is left, t or coordinates, from where the tangent plane through the prediction meets what is known.
#ifndef MCC_ATTRIBUTES_POSITION_PLANES_H_
#define MCC_ATTRIBUTES_POSITION_PLANES_H_

#include <cstdint>

#include "base/host.h"
#include "entropy/models.h"
#include "mcc/status.h"

namespace mcc {

/// Evenly spaced planes across an axis, in 2^-32 lattice steps.
struct AxisPlanes {
  static constexpr int64_t kOne = int64_t{1} << 32;
  /// Closer ones would say nothing; no lattice that has planes is wider.
  static constexpr int64_t kMinStep = 4 * kOne;
  static constexpr int64_t kEndOfSteps = (int64_t{1} << 17) * kOne;
  static constexpr uint32_t kBits = 49;

  int64_t origin = 0;  ///< of plane 0, 0 <= origin < step
  int64_t step = kMinStep;

  /// Lattice coordinate of a plane; wraps.
  MCC_INLINE int32_t at(int32_t plane) const {
    const uint64_t distance = static_cast<uint64_t>(int64_t{plane}) * static_cast<uint64_t>(step);
    const uint64_t sum = static_cast<uint64_t>(origin + kOne / 2) + distance;
    return static_cast<int32_t>(static_cast<int64_t>(sum) >> 32);
  }
  /// The last plane whose coordinate is at most q, which is a coordinate of a lattice.
  int32_t below(int32_t q) const {
    int32_t plane = static_cast<int32_t>((int64_t{q} * kOne - origin) / step);
    while (at(plane) > q) --plane;
    while (at(plane + 1) <= q) ++plane;
    return plane;
  }
};

/// Planes travel as they are.
template <class Io>
Status codePlanes(Io& io, AxisPlanes& planes) {
  constexpr uint32_t kHalf = 24;
  for (int64_t* number : {&planes.step, &planes.origin}) {
    const uint64_t truth = static_cast<uint64_t>(*number);
    const uint64_t low = io.raw(kHalf, static_cast<uint32_t>(truth & ((1u << kHalf) - 1)));
    const uint64_t high = io.raw(AxisPlanes::kBits - kHalf, static_cast<uint32_t>(truth >> kHalf));
    *number = static_cast<int64_t>(high << kHalf | low);
  }
  if (planes.step < AxisPlanes::kMinStep || planes.origin >= planes.step) {
    return fail(Error::kBadAttribute, "the planes of the positions are out of range");
  }
  return {};
}

/// Rounds down; values far beyond any plane come to +-2^20.
MCC_INLINE int32_t floorOf(float x) {
  constexpr int32_t kReach = 1 << 20;
  const float low = -static_cast<float>(kReach);
  const float inside = x > low ? (x < -low ? x : -low) : low;
  const int32_t truncated = static_cast<int32_t>(inside);
  return truncated - (static_cast<float>(truncated) > inside ? 1 : 0);
}

/// The planes of the three axes, ready to be used.
struct GridPlanes {
  AxisPlanes axis[3];
  float origin[3];
  float step[3];
  float inverse_step[3];

  explicit GridPlanes(const AxisPlanes* planes) {
    for (int s = 0; s < 3; ++s) {
      axis[s] = planes[s];
      origin[s] = inSteps(planes[s].origin);
      step[s] = inSteps(planes[s].step);
      inverse_step[s] = 1 / step[s];
    }
  }
  /// How far a diagonal moves on axis `s` while it moves by `t` on axis `first`.
  MCC_INLINE int32_t along(uint32_t first, uint32_t s, int32_t t) const {
    return floorOf(static_cast<float>(t) * (step[s] * inverse_step[first]) + 0.5f);
  }

 private:
  static float inSteps(int64_t number) {
    return static_cast<float>(number) / static_cast<float>(AxisPlanes::kOne);
  }
};

// A set of axes has bit s for axis s.
inline constexpr uint32_t kAllAxes = 7;
constexpr bool hasAxis(uint32_t axes, uint32_t s) { return (axes >> s & 1) != 0; }
constexpr bool hasSeveralAxes(uint32_t axes) { return (axes & (axes - 1)) != 0; }

/// Diagonals a vertex may move along, 0: none. All count upwards on their first axis; bits 0 and 1 of d - 1 tell that d
/// counts downwards on axes 1 and 2.
inline constexpr uint32_t kDiagonals = 5;
constexpr int32_t directionOf(uint32_t diagonal, uint32_t first, uint32_t s) {
  return s != first && ((diagonal - 1) >> (s - 1) & 1) != 0 ? -1 : 1;
}
/// Further coordinates of a diagonal may be so far off.
inline constexpr int32_t kMaxDiagonalRest = 2;

struct PlaneModels {
  static constexpr uint32_t kNoFan = 8 * 8 * 8;
  static constexpr uint32_t kSpreads = 4;
  static constexpr uint32_t kFractions = 4;

  TokenRow between[kNoFan + 1];     ///< on which axes; by those of three neighbours
  TokenRow diagonal[kAllAxes + 1];  ///< by axes
  TokenRow plane
      [2][kSpreads]
      [kFractions];  ///< [cell of a diagonal][spread][how far the prediction is from the middle]
  TokenRow rest;     ///< see kMaxDiagonalRest

  void setUniform() {
    for (TokenRow& row : between) row.setUniform();
    for (TokenRow& row : diagonal) row.setUniform();
    for (auto& kind : plane) {
      for (auto& spread : kind) {
        for (TokenRow& row : spread) row.setUniform();
      }
    }
    rest.setUniform();
  }
};

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITION_PLANES_H_
