// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/meshlets.h"

#include <meshoptimizer.h>

#include <algorithm>

namespace mcc::foreign {
namespace {

constexpr size_t kMeshletVertices = 64;
constexpr size_t kMeshletTriangles = 124;
constexpr size_t kBytesOfPosition = 3 * sizeof(float);

}  // namespace

Outcome buildMeshoptMeshlets(const MeshletMesh& mesh, simple::Meshlets& meshlets) {
  const size_t vertex_count = mesh.positions.size() / 3;
  for (const uint32_t vertex : mesh.indices) {
    if (vertex >= vertex_count) return failure("an index is no vertex");
  }
  return guarded([&]() -> Outcome {
    const size_t bound =
        meshopt_buildMeshletsBound(mesh.indices.size(), kMeshletVertices, kMeshletTriangles);
    std::vector<meshopt_Meshlet> found(bound);
    meshlets.vertices.resize(bound * kMeshletVertices);
    meshlets.triangles.resize(bound * kMeshletTriangles * 3);
    found.resize(meshopt_buildMeshlets(found.data(), meshlets.vertices.data(),
                                       meshlets.triangles.data(), mesh.indices.data(),
                                       mesh.indices.size(), mesh.positions.data(), vertex_count,
                                       kBytesOfPosition, kMeshletVertices, kMeshletTriangles, 0));
    meshlets.meshlets.clear();
    for (const meshopt_Meshlet& meshlet : found) {
      meshlets.meshlets.push_back({meshlet.vertex_offset, meshlet.triangle_offset,
                                   meshlet.vertex_count, meshlet.triangle_count});
    }
    return {};
  });
}

void addMeshletFigures(const MeshletMesh& mesh, const simple::Meshlets& meshlets,
                       MeshletFigures& figures) {
  for (const Meshlet& meshlet : meshlets.meshlets) {
    const meshopt_Bounds bounds = meshopt_computeMeshletBounds(
        &meshlets.vertices[meshlet.vertex_offset], &meshlets.triangles[meshlet.triangle_offset],
        meshlet.triangle_count, mesh.positions.data(), mesh.positions.size() / 3, kBytesOfPosition);
    ++figures.meshlet_count;
    figures.vertex_count += meshlet.vertex_count;
    figures.triangle_count += meshlet.triangle_count;
    figures.radii += double{bounds.radius};
    figures.cones += 1 - std::min(double{bounds.cone_cutoff}, 1.0);
  }
}

}  // namespace mcc::foreign
