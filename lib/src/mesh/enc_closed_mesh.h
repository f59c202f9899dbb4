// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_MESH_ENC_CLOSED_MESH_H_
#define MCC_MESH_ENC_CLOSED_MESH_H_

#include <cstdint>
#include <vector>

namespace mcc {

/// Half-edges that are numbered 3 * face + corner.
constexpr uint32_t nextCorner(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
constexpr uint32_t prevCorner(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// A closed, oriented manifold in which every hole is coned to a dummy vertex. Half-edge 3f+k runs
/// from corner k to corner k+1 of face f. Every vertex is one umbrella, and no face has a vertex
/// twice.
struct ClosedMesh {
  std::vector<uint32_t> corner_vertex;  ///< 3 per face; cone faces come after the real ones
  std::vector<uint32_t> twin;           ///< 3 per face, never kNone
  uint32_t real_face_count = 0;
  uint32_t real_vertex_count = 0;  ///< dummies are numbered after the real vertices
  uint32_t dummy_count = 0;

  struct Component {
    uint32_t start_half_edge = 0;  ///< leaves the mc-vertex
    bool has_handles = false;
  };
  std::vector<Component> components;

  uint32_t faceCount() const { return static_cast<uint32_t>(twin.size() / 3); }
};

}  // namespace mcc

#endif  // MCC_MESH_ENC_CLOSED_MESH_H_
