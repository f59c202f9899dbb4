// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "unit/surface.h"

#include "writer/truth.h"

#include <algorithm>

namespace mcc::test {

Surface::Surface(const TestMesh& mesh, uint32_t start_half_edge)
    : class_count_(mesh.vertexCount()),
      cut_(cutToManifold(mesh.indices, mesh.vertexCount(), start_half_edge)),
      record_(collapse(cut_.mesh)),
      node_map_(record_.node_count),
      source_of_vertex_(cut_.mesh.real_vertex_count),
      source_gate_(cut_.mesh.real_face_count) {}

PieceHeader Surface::header() const {
  PieceHeader h;
  h.vertex_count = cut_.mesh.real_vertex_count;
  h.face_count = cut_.mesh.real_face_count;
  h.operation_count = static_cast<uint32_t>(record_.operations.size());
  h.dummy_count = cut_.mesh.dummy_count;
  if (h.dummy_count != 0) h.flags |= piece_flag::kHoles;
  if (!record_.handles.empty()) h.flags |= piece_flag::kHandles;
  if (hasCopies()) h.setSurface(SurfaceCoding::kCopies);
  h.wedge_count = h.vertex_count;
  return h;
}

McTruth Surface::truth() {
  return connectivityTruth(record_, {node_map_, source_of_vertex_, source_gate_});
}

std::vector<uint32_t> Surface::classOfVertex() const {
  std::vector<uint32_t> classes;
  for (const uint32_t source : source_of_vertex_) classes.push_back(cut_.class_of_vertex[source]);
  return classes;
}

bool Surface::hasCopies() const {
  std::vector<uint8_t> seen(class_count_, 0);
  for (const uint32_t c : cut_.class_of_vertex) {
    if (seen[c]++ != 0) return true;
  }
  return false;
}

AttributeInfo positionInfo(uint8_t bits) {
  AttributeInfo info;
  info.coding = AttributeCoding::kLattice;
  info.bits = bits;
  info.lattice.step = 1;
  return info;
}

std::string checkFaceMesh(const FaceMesh& mesh, uint32_t vertex_count) {
  const uint32_t* words = mesh.words.data();
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
      if (words[h] >= vertex_count) return "a corner has no vertex";
      const uint32_t t = words[h + 4];
      if (t == kNone) continue;
      if (t >= mesh.face_count * kFaceWords || t % kFaceWords > 2) return "a twin is no half-edge";
      if (words[t + 4] != h) return "a twin is not mutual";
      if (words[t] != words[nextHalfEdge(h)] || words[nextHalfEdge(t)] != words[h])
        return "twins have other ends";
    }
  }
  return "";
}

}  // namespace mcc::test
