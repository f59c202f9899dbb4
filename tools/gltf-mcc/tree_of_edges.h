// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The mc-tree of a primitive: that of its payload, or that of a payload made for this purpose.
#ifndef MCC_TOOL_TREE_OF_EDGES_H_
#define MCC_TOOL_TREE_OF_EDGES_H_

#include <cstdint>
#include <vector>

#include "mcc/files.h"

namespace mcc::tool {

/// The tree of the edges along which a surface was contracted.
struct McTree {
  /// One contracted edge. `parent` is the mc-vertex, or was contracted before `child`.
  struct Edge {
    uint32_t parent = 0;
    uint32_t child = 0;
  };
  std::vector<float> positions;   ///< 3 per vertex
  std::vector<uint32_t> indices;  ///< 3 per triangle
  std::vector<Edge> edges;        ///< in the order of the contractions, without those to dummies
  bool is_of_payload = false;     ///< false: the source was compressed in memory to get a tree
  std::vector<uint8_t> payload;   ///< the payload that the tree is of
  uint32_t piece = 0;             ///< and its piece
};

/// Returns the mc-tree of a primitive. Where the primitive is compressed, this is the tree of the
/// payload's piece, with all triangles of that piece. Otherwise the primitive is compressed in
/// memory as convert() would. Errors: there is no such primitive; it has no triangles, or cannot be
/// read. Safe for untrusted input. Deterministic. Tests: tests/gltf/tree_test.cpp.
gltf::Result mcTree(const gltf::Source& source, uint32_t mesh, uint32_t primitive,
                    const gltf::ForeignDecoders& decoders, McTree& tree);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TREE_OF_EDGES_H_
