// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Meshes whose components repeat each other, for tests and the conformance suite.
#ifndef MCC_TESTS_SUPPORT_REPEATED_H_
#define MCC_TESTS_SUPPORT_REPEATED_H_

#include <cmath>
#include <cstdint>
#include <string>

#include "mesh/turn.h"
#include "support/mesh_generators.h"

namespace mcc::test {

/// The mesh and its copies, with their normals and texture coordinates: copy k, of the turn
/// k * `step`, lies somewhere else. Turns that mirror turn the triangles over.
inline TestMesh repeated(const TestMesh& mesh, uint32_t copies, Turn step) {
  TestMesh all = mesh;
  const uint32_t count = mesh.vertexCount();
  for (uint32_t k = 1; k <= copies; ++k) {
    const Turn turn = k * step % kTurnCount;
    const uint8_t* const from = kAxisOrder[turn >> 3];
    const auto append = [&](std::vector<float>& to, const std::vector<float>& values, float move) {
      for (size_t i = 0; i < values.size(); i += 3) {
        for (uint32_t s = 0; s < 3; ++s) {
          const float x = values[i + from[s]];
          to.push_back(((turn >> s & 1) != 0 ? -x : x) + (s == 0 ? move : 0));
        }
      }
    };
    append(all.positions, mesh.positions, 8.0f * static_cast<float>(k));
    append(all.normals, mesh.normals, 0);
    all.texcoords.insert(all.texcoords.end(), mesh.texcoords.begin(), mesh.texcoords.end());
    const uint32_t swaps = (from[0] != 0) + (from[1] != 1) + (from[2] != 2) == 2 ? 1 : 0;
    const bool turns_over = ((turn & 1) + (turn >> 1 & 1) + (turn >> 2 & 1) + swaps) % 2 != 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      for (const size_t c : {size_t{0}, size_t{turns_over ? 2u : 1u}, size_t{turns_over ? 1u : 2u}})
        all.indices.push_back(mesh.indices[i + c] + k * count);
    }
  }
  all.name += " repeated " + std::to_string(copies) + ", " + std::to_string(step);
  return all;
}

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_REPEATED_H_
