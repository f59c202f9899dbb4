// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds the planes of position_planes.h in the coordinates of a surface.
#ifndef MCC_ATTRIBUTES_ENC_POSITION_PLANES_H_
#define MCC_ATTRIBUTES_ENC_POSITION_PLANES_H_

#include <cstdint>
#include <span>

#include "attributes/position_planes.h"

namespace mcc {

/// Planes of the three axes on which a good part of the coordinates (3 per vertex) lie; false if some axis has none.
/// O(vertices + lattice). Deterministic on every machine.
bool findPlanes(std::span<const int32_t> truth, AxisPlanes* planes);

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_ENC_POSITION_PLANES_H_
