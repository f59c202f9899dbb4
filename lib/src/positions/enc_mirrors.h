// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds the mirrors of a piece.
#ifndef MCC_POSITIONS_ENC_MIRRORS_H_
#define MCC_POSITIONS_ENC_MIRRORS_H_

#include <cstdint>
#include <span>

#include "positions/enc_anchors.h"
#include "positions/mirrors.h"

namespace mcc {

/// Returns the mirrors across an axis that have images of most positions (3 coordinates each), with
/// at least a tenth of all. `sum_bits` is how many bits a sum may have, with its sign.
/// The time is that of sorting the positions.
Mirrors findMirrors(std::span<const int32_t> positions, uint32_t sum_bits);

/// Finds about the mates that the positions will have when they are coded with these mirrors: those
/// whose images are at most a step along the axis away. `order` lists the vertices in coding order.
void guessMates(std::span<const int32_t> positions, std::span<const uint32_t> order,
                const Mirrors& mirrors, const Anchors& anchors, VertexMates& mates);

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_MIRRORS_H_
