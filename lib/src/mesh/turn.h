// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The turns of the lattice: axes change their places, and some of them their directions. [A.6.15]
#ifndef MCC_MESH_TURN_H_
#define MCC_MESH_TURN_H_

#include <cstdint>

namespace mcc {

/// One of the 48 turns: 8 times the number of an order of axes, and a bit for each axis of the
/// result that changes its direction. 0 turns nothing; 1, 2 and 4 mirror across an axis.
using Turn = uint32_t;

inline constexpr uint32_t kOrderCount = 6;
inline constexpr uint32_t kTurnCount = 8 * kOrderCount;
/// From which axis each one of the result comes.
inline constexpr uint8_t kAxisOrder[kOrderCount][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                                       {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

}  // namespace mcc

#endif  // MCC_MESH_TURN_H_
