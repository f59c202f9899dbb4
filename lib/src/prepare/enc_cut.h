// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_PREPARE_ENC_CUT_H_
#define MCC_PREPARE_ENC_CUT_H_

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/enc_closed_mesh.h"

namespace mcc {

/// Triangles cut into oriented manifold pieces: half-edges of opposite direction are joined (at
/// edges with more than two faces, neighbours in file order), each umbrella becomes one vertex, and
/// every hole is coned to a dummy. `corner_class` has 3 position classes per triangle; triangles
/// with two corners of one class are left loose. Every boundary, non-manifold edge and inconsistent
/// orientation becomes a boundary of the result. O(n log n).
struct CutResult {
  ClosedMesh mesh;
  std::vector<uint32_t> class_of_vertex;  ///< position class of each real vertex
  uint32_t hole_count = 0;
};

/// Cuts a surface. `region_of_face` has the region of each triangle, or is empty; edges between
/// triangles of different regions are cut.
CutResult cutToManifold(std::span<const uint32_t> corner_class, uint32_t class_count,
                        uint32_t start_half_edge, std::span<const uint32_t> region_of_face = {});

/// Moves the half of a component's real faces that is farther from its start to a region of its
/// own. O(its faces).
void halveComponent(const ClosedMesh& mesh, const ClosedMesh::Component& component,
                    uint32_t new_region, std::span<uint32_t> region_of_face);

}  // namespace mcc

#endif  // MCC_PREPARE_ENC_CUT_H_
