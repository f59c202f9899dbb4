// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <numeric>

#include "tree_drawing.h"

namespace mcc::tool {
namespace {

/// The edges to the children of every vertex, in the order of the tree's edges.
struct Children {
  std::vector<uint32_t> first;  ///< where each vertex's edges start in `edges`; one entry more
  std::vector<uint32_t> edges;

  explicit Children(const McTree& tree) : first(tree.positions.size() / 3 + 1, 0) {
    for (const McTree::Edge& edge : tree.edges) ++first[edge.parent + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    edges.resize(tree.edges.size());
    std::vector<uint32_t> fill(first.begin(), first.end() - 1);
    for (uint32_t e = 0; e < tree.edges.size(); ++e) edges[fill[tree.edges[e].parent]++] = e;
  }
};

class Brancher {
 public:
  explicit Brancher(const McTree& tree)
      : tree_(tree), children_(tree), is_done_(tree.edges.size(), false) {}

  std::vector<Branch> run() {
    std::vector<bool> is_child(children_.first.size(), false);
    for (const McTree::Edge& edge : tree_.edges) is_child[edge.child] = true;
    // Start at the roots; what is left after that can be reached only through cycles.
    for (const bool from_roots : {true, false}) {
      for (uint32_t e = 0; e < tree_.edges.size(); ++e) {
        if (is_done_[e] || (from_roots && is_child[tree_.edges[e].parent])) continue;
        follow(lastOpenEdge(tree_.edges[e].parent), 0);
        drainForks();
      }
    }
    return std::move(branches_);
  }

 private:
  uint32_t lastOpenEdge(uint32_t vertex) const {
    for (uint32_t i = children_.first[vertex + 1]; i-- != children_.first[vertex];) {
      if (!is_done_[children_.edges[i]]) return children_.edges[i];
    }
    return kNone;
  }

  /// Follows the last edges from `edge` on, which makes a branch, and notes where others fork off.
  void follow(uint32_t edge, uint32_t depth) {
    Branch branch;
    branch.depth = depth;
    branch.vertices.push_back(tree_.edges[edge].parent);
    for (; edge != kNone; edge = lastOpenEdge(tree_.edges[edge].child)) {
      is_done_[edge] = true;
      if (lastOpenEdge(tree_.edges[edge].parent) != kNone) {
        forks_.push_back({tree_.edges[edge].parent, depth + 1});
      }
      branch.order.push_back(edge);
      branch.vertices.push_back(tree_.edges[edge].child);
    }
    branch.order.push_back(branch.order.back());
    branches_.push_back(std::move(branch));
  }

  void drainForks() {
    while (!forks_.empty()) {
      const Fork fork = forks_.back();
      forks_.pop_back();
      const uint32_t edge = lastOpenEdge(fork.vertex);
      if (edge != kNone) follow(edge, fork.depth);
    }
  }

  struct Fork {
    uint32_t vertex;
    uint32_t depth;
  };
  const McTree& tree_;
  const Children children_;
  std::vector<bool> is_done_;
  std::vector<Fork> forks_;
  std::vector<Branch> branches_;
};

}  // namespace

std::vector<Branch> branchesOf(const McTree& tree) { return Brancher(tree).run(); }

}  // namespace mcc::tool
