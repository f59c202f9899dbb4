// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Meshlets as meshoptimizer makes them, and how good any meshlets are by its measures.
#ifndef MCC_TOOLS_FOREIGN_MESHLETS_H_
#define MCC_TOOLS_FOREIGN_MESHLETS_H_

#include <cstdint>
#include <span>

#include "foreign/foreign_mesh.h"
#include "mcc/simple.h"

namespace mcc::foreign {

/// A triangle list, and three floats for each of its vertices. Borrowed.
struct MeshletMesh {
  std::span<const uint32_t> indices;
  std::span<const float> positions;
};

/// Sums over meshlets. Those of several meshes are added up by measuring one after the other.
struct MeshletFigures {
  uint64_t meshlet_count = 0;
  uint64_t vertex_count = 0;  ///< a vertex counts in each meshlet that has it
  uint64_t triangle_count = 0;
  double radii = 0;  ///< of bounding spheres, in units of the positions
  /// 1 - cone_cutoff of each: 0 where no view lets a renderer skip the whole meshlet for its
  /// normals, 1 where half of the views do.
  double cones = 0;
};

/// Calls meshopt_buildMeshlets() with at most 64 vertices and 124 triangles and a cone weight of 0.
/// Fails when memory runs out or an index is no vertex. Deterministic. Tests:
/// tests/foreign/meshlets_test.cpp.
Outcome buildMeshoptMeshlets(const MeshletMesh& mesh, simple::Meshlets& meshlets);

/// Adds what meshopt_computeMeshletBounds() says about meshlets of the mesh, whoever made them.
void addMeshletFigures(const MeshletMesh& mesh, const simple::Meshlets& meshlets,
                       MeshletFigures& figures);

}  // namespace mcc::foreign

#endif  // MCC_TOOLS_FOREIGN_MESHLETS_H_
