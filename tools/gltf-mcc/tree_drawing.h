// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_TREE_DRAWING_H_
#define MCC_TOOL_TREE_DRAWING_H_

#include <cstdint>
#include <string>
#include <vector>

#include "mcc/gltf.h"

namespace mcc::tool {

/// A path of the mc-tree: the trunk, from the mc-vertex of a component, or what lies between an S and its E.
struct Branch {
  uint32_t depth = 0;              ///< branches it is inside of; 0: a trunk
  std::vector<uint32_t> vertices;  ///< two at least
  std::vector<uint32_t> order;     ///< of the edge behind each vertex: its number in McTree::edges
};

/// Takes a tree apart. Where it forks, the digon that waited, whose edge comes last, goes on with the branch; the others are
/// branches of their own. Edges that close a cycle, which handles make, are branches of one edge.
std::vector<Branch> branchesOf(const gltf::McTree& tree);

struct DrawingOptions {
  double view[3] = {0.45, 0.35, 1};  ///< from the model to the eye; +Y is up
  uint32_t width = 800;              ///< of the picture, in its pixels
  std::string title;
};

/// An SVG: the surface as it is seen from afar, and the visible part of the tree on it. Positions that are no numbers are
/// left out. The same tree gives the same text.
std::string drawTree(const gltf::McTree& tree, const DrawingOptions& options);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TREE_DRAWING_H_
