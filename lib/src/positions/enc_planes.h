// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds the planes of positions/planes.h in the coordinates of a surface.
#ifndef MCC_POSITIONS_ENC_PLANES_H_
#define MCC_POSITIONS_ENC_PLANES_H_

#include <cstdint>
#include <span>

#include "positions/planes.h"

namespace mcc {

/// Finds the planes of the three axes on which a good part of the coordinates (3 per vertex) lie;
/// returns false if some axis has none. O(vertices + lattice). Deterministic on every machine.
bool findPlanes(std::span<const int32_t> truth, AxisPlanes* planes);

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_PLANES_H_
