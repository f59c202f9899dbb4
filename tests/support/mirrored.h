// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Meshes with equal halves, for tests and the conformance suite.
#ifndef MCC_TESTS_SUPPORT_MIRRORED_H_
#define MCC_TESTS_SUPPORT_MIRRORED_H_

#include <algorithm>
#include <string>

#include "support/mesh_generators.h"

namespace mcc::test {

/// The mesh and its image under x -> -x of an axis. Vertices at x = 0 are shared.
inline TestMesh mirrored(TestMesh mesh, uint32_t axis) {
  const uint32_t count = mesh.vertexCount();
  std::vector<uint32_t> image(count);
  for (uint32_t v = 0; v < count; ++v) {
    image[v] = v;
    if (mesh.positions[3 * v + axis] == 0) continue;
    image[v] = mesh.vertexCount();
    for (uint32_t s = 0; s < 3; ++s) {
      const float x = mesh.positions[3 * v + s];
      mesh.positions.push_back(s == axis ? -x : x);
    }
  }
  for (size_t i = 0, n = mesh.indices.size(); i < n; i += 3) {
    for (const size_t k : {size_t{0}, size_t{2}, size_t{1}})
      mesh.indices.push_back(image[mesh.indices[i + k]]);
  }
  mesh.normals.clear();
  mesh.texcoords.clear();
  mesh.name += " mirrored " + std::to_string(axis);
  return mesh;
}

/// A waved sheet in general position, whose borders are on x = 0 and on y = 0.
inline TestMesh halfSheet(uint32_t w, uint32_t h, uint32_t seed) {
  TestMesh mesh = jittered(grid(w, h, QuadSplit::kRandom, seed), seed, 0.02f);
  float low[3] = {1e9f, 1e9f, 1e9f};
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    low[i % 3] = std::min(low[i % 3], mesh.positions[i]);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    float& x = mesh.positions[i];
    x -= low[i % 3];
    if (i % 3 != 2 && x < 0.05f) x = 0;
  }
  return mesh;
}

/// Moves a fifth of the coordinates by about a step of a lattice of `bits` bits.
inline TestMesh withNoise(TestMesh mesh, uint32_t bits) {
  Random random(5);
  const auto [least, most] = std::minmax_element(mesh.positions.begin(), mesh.positions.end());
  const float low = *least;
  const float high = *most;
  const float step = (high - low) / static_cast<float>(1u << bits);
  for (float& x : mesh.positions) {
    if (x != low && x != high && random.chance(20)) x += random.chance(50) ? step : -step;
  }
  mesh.name += ", noisy";
  return mesh;
}

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_MIRRORED_H_
