// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/simplify.h"

#include <algorithm>
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

/// The same as if vertices with the same position were one. The others must be gone: the simplifier
/// looks for seams at all vertices, used or not.
std::vector<uint32_t> simplifyWelded(const gltf::TriangleList& list, uint64_t triangle_count) {
  const size_t vertex_count = list.positions.size() / 3;
  std::vector<uint32_t> number(vertex_count);
  const size_t welded_count = meshopt_generateVertexRemap(
      number.data(), nullptr, vertex_count, list.positions.data(), vertex_count, kPositionBytes);
  std::vector<uint32_t> vertex_of(welded_count);
  std::vector<float> positions(3 * welded_count);
  for (size_t vertex = vertex_count; vertex-- != 0;) {  // the first one stays
    vertex_of[number[vertex]] = static_cast<uint32_t>(vertex);
    std::copy_n(&list.positions[3 * vertex], 3, &positions[size_t{3} * number[vertex]]);
  }
  std::vector<uint32_t> triangles;
  for (const uint32_t vertex : list.triangles) triangles.push_back(number[vertex]);
  std::vector<uint32_t> simplified = simplifyOnce(positions, triangles, triangle_count);
  for (uint32_t& vertex : simplified) vertex = vertex_of[vertex];
  return simplified;
}

}  // namespace

gltf::Result simplifyMesh(const gltf::TriangleList& list, uint64_t triangle_count,
                          std::vector<uint32_t>& simplified) {
  simplified = simplifyOnce(list.positions, list.triangles, triangle_count);
  // Vertices at seams hardly move. A mesh of flat triangles is nothing but seams.
  if (simplified.size() / 3 > 2 * triangle_count) {
    simplified = simplifyWelded(list, triangle_count);
  }
  return {};
}

}  // namespace mcc::foreign
