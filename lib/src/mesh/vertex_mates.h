// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which vertices of a piece are images of others. [A.6.14, A.6.15]
#ifndef MCC_MESH_VERTEX_MATES_H_
#define MCC_MESH_VERTEX_MATES_H_

#include <cstdint>

#include "base/memory.h"

namespace mcc {

inline constexpr uint32_t kMaxMirrors = 3;

/// The mates of the vertices of a piece: under its mirrors and, with anchors, under the isometries
/// of its components, which count as one mirror more.
struct VertexMates {
  explicit VertexMates(const Allocator& allocator) : states(allocator) {}

  /// Makes room for the mates under `count` mirrors, with every word `word`.
  [[nodiscard]] bool assign(uint32_t count, bool anchors, size_t vertex_count, uint32_t word) {
    mirror_count = count;
    has_anchors = anchors;
    stride = size_t{1 + count} + (anchors ? 3 : 0);
    return states.assign(stride * vertex_count, word);
  }
  bool empty() const { return mirror_count == 0 && !has_anchors; }
  uint32_t slotCount() const { return mirror_count + (has_anchors ? 1 : 0); }

  /// Returns the mate of a vertex, maybe the vertex itself, or kNone.
  uint32_t mateOf(uint32_t mirror, uint32_t vertex) const {
    return states[placeOf(mirror, vertex)];
  }
  uint32_t& mateOf(uint32_t mirror, uint32_t vertex) { return states[placeOf(mirror, vertex)]; }
  uint32_t& startOf(uint32_t vertex) { return states[vertex * stride]; }
  /// The number of the last component in which the vertex became a mate, or kNone; with anchors.
  uint32_t& takenOf(uint32_t vertex) { return states[placeOf(mirror_count + 1, vertex)]; }
  /// How the component of the vertex is turned; with anchors.
  uint32_t turnOf(uint32_t vertex) const { return states[placeOf(mirror_count + 2, vertex)]; }
  uint32_t& turnOf(uint32_t vertex) { return states[placeOf(mirror_count + 2, vertex)]; }

  uint32_t mirror_count = 0;
  bool has_anchors = false;
  size_t stride = 1;  ///< words of each vertex
  uint32_t axis[kMaxMirrors] = {};
  /// Of each vertex: a half-edge that leaves it, its mates, then, with anchors, where it was taken
  /// and its turn.
  Array<uint32_t> states;

 private:
  size_t placeOf(uint32_t mirror, uint32_t vertex) const { return vertex * stride + 1 + mirror; }
};

}  // namespace mcc

#endif  // MCC_MESH_VERTEX_MATES_H_
