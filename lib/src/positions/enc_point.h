// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Points of the lattice as keys, for the writer's searches for mirrors and anchors.
#ifndef MCC_POSITIONS_ENC_POINT_H_
#define MCC_POSITIONS_ENC_POINT_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace mcc {

using Point = std::array<int32_t, 3>;

struct PointHash {
  size_t operator()(const Point& p) const {
    uint64_t h = 0;
    for (const int32_t x : p) h = (h ^ static_cast<uint32_t>(x)) * 0x9e3779b97f4a7c15u;
    return static_cast<size_t>(h ^ h >> 32);
  }
};

/// A vertex by its position.
using PointMap = std::unordered_map<Point, uint32_t, PointHash>;

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_POINT_H_
