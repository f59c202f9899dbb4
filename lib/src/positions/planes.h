// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Planes: evenly spaced coordinates that many vertices share. Isosurfaces (marching cubes, marching
// tetrahedra) have their vertices on the edges, faces or diagonals of the cells of a grid. [A.6.12]
//
// The kind of a vertex tells on which axes it lies between planes, and whether it moves along a
// diagonal there. If so, the number of its line is coded on all of these axes except the first.
#ifndef MCC_POSITIONS_PLANES_H_
#define MCC_POSITIONS_PLANES_H_

#include <bit>
#include <cstdint>

#include "base/host.h"
#include "base/lanes.h"
#include "entropy/models.h"
#include "mcc/status.h"

namespace mcc {

/// Evenly spaced planes across an axis, in units of 2^-32 lattice steps.
struct AxisPlanes {
  static constexpr int64_t kOne = int64_t{1} << 32;
  /// The smallest distance of planes; closer ones would carry no information. kEndOfSteps is above
  /// the width of every lattice that has planes.
  static constexpr int64_t kMinStep = 4 * kOne;
  static constexpr int64_t kEndOfSteps = (int64_t{1} << 17) * kOne;
  static constexpr uint32_t kBits = 49;

  int64_t origin = 0;  ///< coordinate of plane 0; 0 <= origin < step
  int64_t step = kMinStep;

  /// Returns the lattice coordinate of a plane in Q8; wraps.
  MCC_INLINE int32_t q8At(int32_t plane) const {
    const uint64_t distance = static_cast<uint64_t>(int64_t{plane}) * static_cast<uint64_t>(step);
    return static_cast<int32_t>(static_cast<int64_t>(static_cast<uint64_t>(origin) + distance) >>
                                24);
  }
  /// Returns the lattice coordinate that vertices on a plane have.
  int32_t at(int32_t plane) const {
    return static_cast<int32_t>(static_cast<uint32_t>(q8At(plane)) + 128) >> 8;
  }
  /// Returns the last plane whose coordinate is at most q; q is a coordinate of a lattice.
  int32_t below(int32_t q) const {
    int32_t plane = static_cast<int32_t>((int64_t{q} * kOne - origin) / step);
    while (at(plane) > q) --plane;
    while (at(plane + 1) <= q) ++plane;
    return plane;
  }
};

/// Codes the planes as raw bits.
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

/// One kind of vertex. Axis s has bit s. A diagonal counts upwards on its first axis.
struct VertexKind {
  uint8_t between;   ///< axes on which the vertex lies between planes
  uint8_t diagonal;  ///< the same axes, or 0 if it is not on a diagonal
  uint8_t down;      ///< axes of the diagonal on which it counts downwards
};
inline constexpr VertexKind kVertexKinds[kTokenCount] = {
    {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {6, 0, 0}, {7, 0, 0}, {3, 3, 0},
    {3, 3, 2}, {5, 5, 0}, {5, 5, 4}, {6, 6, 0}, {6, 6, 4}, {7, 7, 0}, {7, 7, 2}, {7, 7, 4}};

/// The planes of the three axes, and what follows from them for each kind of vertex.
struct GridPlanes {
  struct Frame {
    Lanes<float> slope{};         ///< of a diagonal, per step on its first axis; else 0
    Lanes<uint32_t> on_planes{};  ///< all ones where a rank (of a plane or line) is coded
    uint8_t between;
    uint8_t first;  ///< the first axis of `between`
    uint8_t moving;
    uint8_t moving_count;
    uint8_t rests;  ///< axes of a diagonal that follow its first axis
  };

  AxisPlanes axis[3];
  Lanes<float> origin{};  ///< in Q8
  Lanes<float> inverse_step{};
  Frame frame[kTokenCount];

  explicit GridPlanes(const AxisPlanes* planes) {
    float step[3];
    for (int s = 0; s < 3; ++s) {
      axis[s] = planes[s];
      origin[s] = static_cast<float>(planes[s].origin) / (1 << 24);
      step[s] = static_cast<float>(planes[s].step) / static_cast<float>(AxisPlanes::kOne);
      inverse_step[s] = 1 / step[s];
    }
    for (uint32_t k = 0; k < kTokenCount; ++k) {
      const VertexKind& kind = kVertexKinds[k];
      const uint32_t first = static_cast<uint32_t>(std::countr_zero(uint32_t{kind.between}));
      Frame& f = frame[k];
      f.between = kind.between;
      f.first = static_cast<uint8_t>(first);
      f.moving = kind.diagonal != 0 ? static_cast<uint8_t>(1u << first) : kind.between;
      f.moving_count = static_cast<uint8_t>(std::popcount(f.moving));
      f.rests = static_cast<uint8_t>(kind.between & ~f.moving);
      for (uint32_t s = 0; s < 3; ++s) {
        f.on_planes[s] = (f.moving >> s & 1) != 0 ? 0 : ~0u;
        if ((f.rests >> s & 1) != 0) {
          f.slope[s] = (kind.down >> s & 1) != 0 ? -step[s] * inverse_step[first]
                                                 : step[s] * inverse_step[first];
        }
      }
    }
  }
};

struct PlaneModels {
  static constexpr uint32_t kNoFan = 8 * 8 * 8;
  static constexpr uint32_t kFractions = 4;

  TokenRow kind[kNoFan + 1];  ///< by the axes on which three neighbours lie between planes
  TokenRow rest[kFractions];  ///< of diagonals, by the fraction of the prediction

  void setUniform() {
    for (TokenRow& row : kind) row.setUniform();
    for (TokenRow& row : rest) row.setUniform();
  }
};

}  // namespace mcc

#endif  // MCC_POSITIONS_PLANES_H_
