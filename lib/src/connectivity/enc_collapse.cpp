// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "connectivity/enc_collapse.h"

#include <cassert>
#include <utility>

namespace mcc {
namespace {

/// Digons as circular lists of nodes, see mc_codes.h. Here gate[i] is the half-edge (a_i -> a_i+1)
/// of the triangle on the side of the mc-vertex; the triangle of its twin is still to be
/// contracted.
class Collapser {
 public:
  explicit Collapser(const ClosedMesh& mesh) : mesh_(mesh), node_of_gate_(mesh.twin.size(), kNone) {
    for (const ClosedMesh::Component& c : mesh.components) track_digons_ |= c.has_handles;
    record_.vertex_is_dummy.assign(mesh.real_vertex_count + mesh.dummy_count, 0);
    for (uint32_t d = 0; d < mesh.dummy_count; ++d) {
      record_.vertex_is_dummy[mesh.real_vertex_count + d] = 1;
    }
    record_.gates.reserve(mesh.faceCount());
    record_.operations.reserve(mesh.real_vertex_count + mesh.dummy_count);
    nodes_.reserve(mesh.real_vertex_count + mesh.dummy_count);
  }

  McRecord run() {
    // The decoder meets the components in reverse.
    for (size_t i = mesh_.components.size(); i-- != 0;) collapseComponent(mesh_.components[i]);
    record_.node_count = static_cast<uint32_t>(nodes_.size());
    return std::move(record_);
  }

 private:
  struct Node {
    uint32_t next;
    uint32_t prev;
    uint32_t gate;
    uint32_t digon;  ///< label of the digon; valid while track_digons_
  };

  uint32_t vertexOf(uint32_t node) const { return mesh_.corner_vertex[nodes_[node].gate]; }

  uint32_t newNode(uint32_t gate, uint32_t digon) {
    const uint32_t node = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({node, node, gate, digon});
    node_of_gate_[gate] = node;
    return node;
  }
  void link(uint32_t a, uint32_t b) {
    nodes_[a].next = b;
    nodes_[b].prev = a;
  }
  void setGate(uint32_t node, uint32_t gate) {
    nodes_[node].gate = gate;
    node_of_gate_[gate] = node;
  }

  void collapseComponent(const ClosedMesh::Component& component) {
    uint32_t top = makeFirstDigon(component.start_half_edge);
    for (;;) {
      McOperation op;
      const uint32_t s = rotateFan(top, op);
      if (s != top) divide(top, s, op);
      const uint32_t before = nodes_[top].prev;
      op.vertex_a = mesh_.corner_vertex[mesh_.twin[nodes_[before].gate]];
      op.node_a = top;
      if (op.degree != 0 || nodes_[top].next != before) {
        top = contract(top, op);
        record_.operations.push_back(op);
        continue;
      }
      op.vertex_b = vertexOf(before);  // the digon is trivial
      op.node_b = before;
      op.kind = op.join == McJoin::kStart ? McKind::kTwig : McKind::kEnd;
      const bool waits = !stack_.empty();
      op.finishes = !waits;
      op.join = McJoin::kSimple;
      record_.operations.push_back(op);
      if (!waits) return;
      top = stack_.back();
      stack_.pop_back();
    }
  }

  /// Opens the mesh along the mc-edge. The first digon is the link of the mc-vertex,
  /// counterclockwise from the edge's end.
  uint32_t makeFirstDigon(uint32_t mc_edge) {
    McComponent component;
    component.vertex = mesh_.corner_vertex[mc_edge];
    component.first_gate = static_cast<uint32_t>(record_.gates.size());
    const uint32_t digon = digon_count_++;
    uint32_t first = kNone;
    uint32_t last = kNone;
    uint32_t h = mc_edge;
    do {
      const uint32_t node = newNode(nextCorner(h), digon);
      record_.gates.push_back(nextCorner(h));
      if (first == kNone) first = node;
      if (last != kNone) link(last, node);
      last = node;
      h = mesh_.twin[prevCorner(h)];
    } while (h != mc_edge);
    link(last, first);
    record_.components.push_back(component);
    return first;
  }

  /// Collects the gates that appear when the top's vertex is contracted. Returns the node of the
  /// gate that decides whether the digon is complex; for a simple digon that is `top` itself.
  uint32_t rotateFan(uint32_t top, McOperation& op) {
    op.first_gate = static_cast<uint32_t>(record_.gates.size());
    uint32_t g = nodes_[nodes_[top].prev].gate;
    for (;;) {
      const uint32_t t = mesh_.twin[g];
      if (node_of_gate_[t] != kNone) return node_of_gate_[t];
      record_.gates.push_back(nextCorner(t));
      ++op.degree;
      g = prevCorner(t);
    }
  }

  /// Divides along the edge mc-vertex -- vertex that `top` and `s` represent: by mc-divide if both
  /// are on one digon. Otherwise the digon of `s` waits on the stack, and a handle joins the two.
  void divide(uint32_t top, uint32_t s, McOperation& op) {
    const bool same = !track_digons_ || nodes_[top].digon == nodes_[s].digon;
    if (!same) {
      op.join = McJoin::kHandle;
      op.handle = takeFromStack(s);
    }
    const uint32_t after_top = nodes_[top].next;
    const uint32_t after_s = nodes_[s].next;
    link(top, after_s);
    link(s, after_top);
    const uint32_t gate_top = nodes_[top].gate;
    setGate(top, nodes_[s].gate);
    setGate(s, gate_top);
    if (same) {
      op.join = McJoin::kStart;
      stack_.push_back(s);
      if (track_digons_) relabelShorter(top, s, digon_count_++);
    } else {
      relabelMerged(top);
    }
  }

  uint32_t takeFromStack(uint32_t s) {
    size_t place = stack_.size();
    do {
      --place;
    } while (nodes_[stack_[place]].digon != nodes_[s].digon);
    McHandle handle;
    handle.node = s;
    handle.top = stack_[place];
    handle.stack_depth = static_cast<uint32_t>(stack_.size() - 1 - place);
    handle.component = static_cast<uint32_t>(record_.components.size() - 1);
    stack_.erase(stack_.begin() + static_cast<std::ptrdiff_t>(place));
    record_.handles.push_back(handle);
    return static_cast<uint32_t>(record_.handles.size() - 1);
  }

  /// Walks both digons in step and gives the one that ends first the new label, so that the cost is
  /// that of the shorter digon.
  void relabelShorter(uint32_t a, uint32_t b, uint32_t label) {
    uint32_t x = nodes_[a].next;
    uint32_t y = nodes_[b].next;
    while (x != a && y != b) {
      x = nodes_[x].next;
      y = nodes_[y].next;
    }
    relabel(x == a ? a : b, label);
  }
  void relabelMerged(uint32_t node) { relabel(node, nodes_[node].digon); }
  void relabel(uint32_t node, uint32_t label) {
    uint32_t x = node;
    do {
      nodes_[x].digon = label;
      x = nodes_[x].next;
    } while (x != node);
  }

  /// Removes the top; the node before it becomes the new top.
  uint32_t contract(uint32_t top, McOperation& op) {
    const uint32_t before = nodes_[top].prev;
    const uint32_t after = nodes_[top].next;
    node_of_gate_[nodes_[before].gate] = kNone;
    node_of_gate_[nodes_[top].gate] = kNone;
    if (op.degree == 0) {  // a spur: the next node is a second node of the vertex before
      op.node_b = after;
      setGate(before, nodes_[after].gate);
      link(before, nodes_[after].next);
      return before;
    }
    setGate(before, record_.gates[op.first_gate]);
    uint32_t last = before;
    for (uint32_t i = 1; i < op.degree; ++i) {
      const uint32_t node = newNode(record_.gates[op.first_gate + i], nodes_[before].digon);
      link(last, node);
      last = node;
    }
    link(last, after);
    return before;
  }

  const ClosedMesh& mesh_;
  std::vector<uint32_t> node_of_gate_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> stack_;
  McRecord record_;
  uint32_t digon_count_ = 0;
  bool track_digons_ = false;
};

}  // namespace

McRecord collapse(const ClosedMesh& mesh) { return Collapser(mesh).run(); }

}  // namespace mcc
