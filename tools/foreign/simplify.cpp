// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/simplify.h"

#include <span>

#include <meshoptimizer.h>

namespace mcc::foreign {
namespace {

constexpr size_t kPositionBytes = 3 * sizeof(float);

std::vector<uint32_t> simplifyOnce(std::span<const float> positions,
                                   std::span<const uint32_t> triangles, uint64_t triangle_count) {
  // Relative to the extent of the mesh, so that the number of triangles alone decides.
  constexpr float kAnyError = 1;
  std::vector<uint32_t> simplified(triangles.size());
  simplified.resize(meshopt_simplify(simplified.data(), triangles.data(), triangles.size(),
                                     positions.data(), positions.size() / 3, kPositionBytes,
                                     3 * triangle_count, kAnyError, 0, nullptr));
  return simplified;
}

/// Returns the triangles with one vertex for each position: the first that has it.
std::vector<uint32_t> weld(const gltf::TriangleList& list) {
  const size_t vertex_count = list.positions.size() / 3;
  std::vector<uint32_t> welded(list.triangles.size());
  meshopt_generateShadowIndexBuffer(welded.data(), list.triangles.data(), list.triangles.size(),
                                    list.positions.data(), vertex_count, kPositionBytes,
                                    kPositionBytes);
  return welded;
}

}  // namespace

gltf::Result simplifyMesh(const gltf::TriangleList& list, uint64_t triangle_count,
                          std::vector<uint32_t>& simplified) {
  simplified = simplifyOnce(list.positions, list.triangles, triangle_count);
  // Vertices at seams hardly move. A mesh of flat triangles is nothing but seams.
  if (simplified.size() / 3 > 2 * triangle_count) {
    simplified = simplifyOnce(list.positions, weld(list), triangle_count);
  }
  return {};
}

}  // namespace mcc::foreign
