// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "prepare/enc_cut.h"

#include <algorithm>

#include "mcc/types.h"

namespace mcc {
namespace {

class Cutter {
 public:
  Cutter(std::span<const uint32_t> corner_class, uint32_t class_count,
         std::span<const uint32_t> region_of_face)
      : corner_class_(corner_class), class_count_(class_count), region_of_face_(region_of_face) {}

  CutResult run(uint32_t start_half_edge) {
    result_.mesh.real_face_count = static_cast<uint32_t>(corner_class_.size() / 3);
    pairHalfEdges();
    makeVertices();
    coneHoles();
    findComponents(start_half_edge);
    return std::move(result_);
  }

 private:
  bool isLoose(uint32_t h) const {
    const uint32_t f = h - h % 3;
    return corner_class_[f] == corner_class_[f + 1] ||
           corner_class_[f + 1] == corner_class_[f + 2] || corner_class_[f + 2] == corner_class_[f];
  }

  uint32_t regionOf(uint32_t h) const {
    return region_of_face_.empty() ? 0 : region_of_face_[h / 3];
  }

  /// Pairs the half-edges between the same two classes, in the order of their numbers and in one
  /// region: each with the latest of the other direction that is still open. Buckets them by the
  /// smaller class of their ends.
  void pairHalfEdges() {
    const uint32_t half_edge_count = static_cast<uint32_t>(corner_class_.size());
    result_.mesh.twin.assign(half_edge_count, kNone);
    std::vector<uint32_t> bucket_end(size_t{class_count_} + 1, 0);
    const auto smallerClass = [this](uint32_t h) {
      return std::min(corner_class_[h], corner_class_[nextCorner(h)]);
    };
    for (uint32_t h = 0; h < half_edge_count; ++h) ++bucket_end[smallerClass(h) + 1];
    for (uint32_t c = 0; c < class_count_; ++c) bucket_end[c + 1] += bucket_end[c];
    std::vector<uint32_t> bucketed(half_edge_count);
    std::vector<uint32_t> fill(bucket_end.begin(), bucket_end.end() - 1);
    for (uint32_t h = 0; h < half_edge_count; ++h) bucketed[fill[smallerClass(h)]++] = h;
    open_of_class_.resize(class_count_);
    next_open_.resize(half_edge_count);
    for (uint32_t c = 0; c < class_count_; ++c) {
      const auto begin = bucketed.begin() + bucket_end[c];
      const auto end = bucketed.begin() + bucket_end[c + 1];
      if (!region_of_face_.empty()) {
        std::stable_sort(begin, end,
                         [this](uint32_t a, uint32_t b) { return regionOf(a) < regionOf(b); });
      }
      uint32_t region = kNone;
      for (auto h = begin; h != end; ++h) {
        if (regionOf(*h) != region) ++search_;
        region = regionOf(*h);
        pairOne(*h);
      }
    }
  }

  void pairOne(uint32_t h) {
    if (isLoose(h)) return;
    Open& open = open_of_class_[std::max(corner_class_[h], corner_class_[nextCorner(h)])];
    if (open.search != search_) open = {search_, kNone};
    if (open.top != kNone && corner_class_[open.top] != corner_class_[h]) {
      result_.mesh.twin[h] = open.top;
      result_.mesh.twin[open.top] = h;
      open.top = next_open_[open.top];
    } else {
      next_open_[h] = open.top;
      open.top = h;
    }
  }

  /// Makes one vertex per umbrella, numbered by first corner.
  void makeVertices() {
    ClosedMesh& mesh = result_.mesh;
    mesh.corner_vertex.assign(corner_class_.size(), kNone);
    for (uint32_t corner = 0; corner < corner_class_.size(); ++corner) {
      if (mesh.corner_vertex[corner] != kNone) continue;
      const uint32_t vertex = mesh.real_vertex_count++;
      result_.class_of_vertex.push_back(corner_class_[corner]);
      uint32_t h = corner;
      for (; h != kNone && mesh.corner_vertex[h] == kNone; h = mesh.twin[prevCorner(h)]) {
        mesh.corner_vertex[h] = vertex;
      }
      if (h != kNone) continue;
      // Clockwise from the first corner.
      for (h = mesh.twin[corner]; h != kNone; h = mesh.twin[h]) {
        h = nextCorner(h);
        mesh.corner_vertex[h] = vertex;
      }
    }
  }

  void coneHoles() {
    ClosedMesh& mesh = result_.mesh;
    const uint32_t real_half_edges = static_cast<uint32_t>(corner_class_.size());
    std::vector<uint32_t> boundary_from(mesh.real_vertex_count, kNone);
    for (uint32_t h = 0; h < real_half_edges; ++h) {
      if (mesh.twin[h] == kNone) boundary_from[mesh.corner_vertex[h]] = h;
    }
    for (uint32_t h = 0; h < real_half_edges; ++h) {
      if (mesh.twin[h] != kNone) continue;
      const uint32_t dummy = mesh.real_vertex_count + mesh.dummy_count++;
      const uint32_t first_cone = static_cast<uint32_t>(mesh.twin.size());
      uint32_t g = h;
      do {  // makes a cone face (end, start, dummy) for each boundary half-edge
        const uint32_t cone = static_cast<uint32_t>(mesh.twin.size());
        const uint32_t end = mesh.corner_vertex[nextCorner(g)];
        mesh.corner_vertex.insert(mesh.corner_vertex.end(), {end, mesh.corner_vertex[g], dummy});
        mesh.twin[g] = cone;
        // dummy -> end meets end -> dummy of the next cone, which is the half-edge after its first
        mesh.twin.insert(mesh.twin.end(), {g, cone - 1, cone + 4});
        g = boundary_from[end];
      } while (g != h);
      mesh.twin[first_cone + 1] = static_cast<uint32_t>(mesh.twin.size()) - 1;
      mesh.twin.back() = first_cone + 1;
    }
    result_.hole_count = mesh.dummy_count;
  }

  /// Finds the components by flood fill. The mc-vertex is the dummy of the largest hole, because
  /// that makes this hole free.
  void findComponents(uint32_t start_half_edge) {
    ClosedMesh& mesh = result_.mesh;
    const uint32_t vertex_count = mesh.real_vertex_count + mesh.dummy_count;
    std::vector<uint32_t> degree(vertex_count, 0);
    for (const uint32_t v : mesh.corner_vertex) ++degree[v];
    std::vector<uint8_t> face_seen(mesh.faceCount(), 0);
    std::vector<uint8_t> vertex_seen(vertex_count, 0);
    std::vector<uint32_t> todo;
    for (uint32_t first = 0; first < mesh.real_face_count; ++first) {
      if (face_seen[first] != 0) continue;
      ClosedMesh::Component component;
      component.start_half_edge = 3 * first;
      uint32_t largest_hole = 0;
      int64_t vertices = 0;
      int64_t faces = 0;
      face_seen[first] = 1;
      todo.push_back(first);
      while (!todo.empty()) {
        const uint32_t f = todo.back();
        todo.pop_back();
        ++faces;
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
          const uint32_t v = mesh.corner_vertex[h];
          if (vertex_seen[v] == 0) {
            vertex_seen[v] = 1;
            ++vertices;
          }
          if (v >= mesh.real_vertex_count &&
              (degree[v] > largest_hole ||
               (degree[v] == largest_hole && h < component.start_half_edge))) {
            largest_hole = degree[v];
            component.start_half_edge = h;
          }
          const uint32_t neighbour = mesh.twin[h] / 3;
          if (face_seen[neighbour] != 0) continue;
          face_seen[neighbour] = 1;
          todo.push_back(neighbour);
        }
      }
      component.has_handles = vertices - faces / 2 < 2;  // Euler, with 3/2 edges per face
      mesh.components.push_back(component);
    }
    if (start_half_edge < mesh.twin.size() && !mesh.components.empty()) {
      mesh.components.front().start_half_edge = start_half_edge;
    }
  }

  std::span<const uint32_t> corner_class_;
  uint32_t class_count_;
  std::span<const uint32_t> region_of_face_;
  CutResult result_;

  /// The open half-edges from the bucket's class to another, or back: valid for one search only.
  struct Open {
    uint32_t search = 0;
    uint32_t top = kNone;  ///< the latest; next_open_ links to the one before
  };
  std::vector<Open> open_of_class_;
  std::vector<uint32_t> next_open_;
  uint32_t search_ = 0;  ///< number of the bucket and region
};

}  // namespace

CutResult cutToManifold(std::span<const uint32_t> corner_class, uint32_t class_count,
                        uint32_t start_half_edge, std::span<const uint32_t> region_of_face) {
  return Cutter(corner_class, class_count, region_of_face).run(start_half_edge);
}

void halveComponent(const ClosedMesh& mesh, const ClosedMesh::Component& component,
                    uint32_t new_region, std::span<uint32_t> region_of_face) {
  std::vector<uint32_t> faces = {component.start_half_edge / 3};  // sorted by distance from start
  std::vector<uint32_t> real_faces;
  std::vector<uint8_t> is_seen(mesh.faceCount(), 0);
  is_seen[faces[0]] = 1;
  for (size_t i = 0; i < faces.size(); ++i) {
    const uint32_t f = faces[i];
    if (f < mesh.real_face_count) real_faces.push_back(f);
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
      const uint32_t neighbour = mesh.twin[h] / 3;
      if (is_seen[neighbour] != 0) continue;
      is_seen[neighbour] = 1;
      faces.push_back(neighbour);
    }
  }
  for (size_t i = real_faces.size() / 2; i < real_faces.size(); ++i)
    region_of_face[real_faces[i]] = new_region;
}

}  // namespace mcc
