// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_TREE_DRAWING_H_
#define MCC_TOOL_TREE_DRAWING_H_

#include <cstdint>
#include <string>
#include <vector>

#include "tree_of_edges.h"

namespace mcc::tool {

/// A path of the mc-tree: the trunk, which starts at the mc-vertex of a component, or the part
/// between an S and its E.
struct Branch {
  uint32_t depth = 0;              ///< number of branches around it; 0: a trunk
  std::vector<uint32_t> vertices;  ///< at least two
  std::vector<uint32_t> order;     ///< number in McTree::edges of the edge after each vertex
};

/// Splits a tree into branches. Where it forks, the branch continues with the digon that waited,
/// whose edge comes last; the others become branches of their own. Edges that close a cycle, as
/// handles do, are branches of one edge.
std::vector<Branch> branchesOf(const McTree& tree);

struct DrawingOptions {
  double view[3] = {0.45, 0.35, 1};  ///< from the model to the eye; +Y is up
  uint32_t width = 800;              ///< width of the picture in pixels
  std::string title;
  /// By vertex, what its position takes: colours the surface, on which no tree is drawn. Or empty.
  std::vector<float> bits;
};

/// Returns an SVG that shows the surface from far away, with the visible part of the tree on it, or
/// what its positions take.
/// Positions that are not finite are left out. The same tree gives the same text.
std::string drawTree(const McTree& tree, const DrawingOptions& options);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TREE_DRAWING_H_
