// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The collapse: contracts mc-edges and divides complex digons until one vertex is left.
#ifndef MCC_CONNECTIVITY_ENC_COLLAPSE_H_
#define MCC_CONNECTIVITY_ENC_COLLAPSE_H_

#include <cstdint>
#include <vector>

#include "connectivity/mc_codes.h"
#include "mesh/enc_closed_mesh.h"

namespace mcc {

/// What the collapse did, in collapse order; McMachine replays it from the end.
struct McRecord {
  std::vector<McOperation> operations;
  std::vector<McHandle> handles;
  std::vector<McComponent> components;
  std::vector<uint32_t> gates;
  std::vector<uint8_t> vertex_is_dummy;
  uint32_t node_count = 0;
};

/// Collapses the mesh. O(faces) for spheres with holes; with handles O(faces log faces + handles *
/// digons).
McRecord collapse(const ClosedMesh& mesh);

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_ENC_COLLAPSE_H_
