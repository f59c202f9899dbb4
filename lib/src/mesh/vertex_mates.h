// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which vertices of a piece are images of each other. [A.6.14]
#ifndef MCC_MESH_VERTEX_MATES_H_
#define MCC_MESH_VERTEX_MATES_H_

#include <cstdint>

#include "base/memory.h"

namespace mcc {

inline constexpr uint32_t kMaxMirrors = 3;

/// The mates of the vertices of a piece under its mirrors.
struct VertexMates {
  explicit VertexMates(const Allocator& allocator) : states(allocator) {}

  /// Returns the mate of a vertex, maybe the vertex itself, or kNone.
  uint32_t mateOf(uint32_t mirror, uint32_t vertex) const {
    return states[placeOf(mirror, vertex)];
  }
  uint32_t& mateOf(uint32_t mirror, uint32_t vertex) { return states[placeOf(mirror, vertex)]; }
  uint32_t& startOf(uint32_t vertex) { return states[vertex * size_t{1 + mirror_count}]; }

  uint32_t mirror_count = 0;  ///< 0 without mirrors
  uint32_t axis[kMaxMirrors] = {};
  /// Each vertex has 1 + mirror_count words: a half-edge that leaves it, then its mates.
  Array<uint32_t> states;

 private:
  size_t placeOf(uint32_t mirror, uint32_t vertex) const {
    return vertex * size_t{1 + mirror_count} + 1 + mirror;
  }
};

}  // namespace mcc

#endif  // MCC_MESH_VERTEX_MATES_H_
