// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which components of a piece repeat earlier ones; the encoder only. [A.6.15]
#ifndef MCC_POSITIONS_ENC_ANCHORS_H_
#define MCC_POSITIONS_ENC_ANCHORS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "positions/anchor.h"
#include "positions/enc_recording.h"
#include "positions/mirror.h"

namespace mcc {

struct Anchors {
  std::vector<Anchor> anchor;   ///< by vertex, for those that begin a component
  std::vector<uint32_t> mates;  ///< what about the mates will be
  std::vector<Turn> turns;      ///< of the components, by vertex
  uint32_t count = 0;
};

/// Finds components that repeat an earlier one, turned or not, and are not found by the mirrors
/// already. The time is about linear in the number of vertices.
Anchors findAnchors(std::span<const int32_t> positions, const PositionRecording& recording,
                    const Mirrors& mirrors);

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_ANCHORS_H_
