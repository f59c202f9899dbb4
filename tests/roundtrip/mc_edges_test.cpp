// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// DecodeOptions::mc_edge: the edges along which a mesh was contracted are edges of it and join all
// of its vertices.
#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "mcc/reader.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

struct Told {
  uint32_t piece;
  uint32_t vertex;
  uint32_t from;
};

/// Indices of the first piece; attributes are dropped.
std::vector<uint32_t> decodeWithEdges(std::span<const uint8_t> bytes, std::vector<Told>& edges) {
  Payload payload;
  EXPECT_TRUE(payload.open(bytes).ok());
  std::vector<std::vector<uint32_t>> indices;
  std::vector<std::vector<AttributeTarget>> attributes;
  std::vector<PartTarget> parts;
  for (const PieceInfo& piece : payload.info().pieces) {
    attributes.emplace_back(piece.attributes.size());
    EXPECT_EQ(piece.parts.size(), 1u);
    parts.push_back({indices.emplace_back(3 * size_t{piece.parts[0].triangle_count}).data()});
  }
  std::vector<PieceTarget> targets;
  for (size_t i = 0; i < parts.size(); ++i) targets.push_back({attributes[i], {&parts[i], 1}});
  DecodeOptions options;
  options.mc_edge = [](void* user, uint32_t piece, uint32_t vertex, uint32_t from) {
    static_cast<std::vector<Told>*>(user)->push_back({piece, vertex, from});
  };
  options.mc_edge_user = &edges;
  EXPECT_TRUE(payload.decode(targets, options).ok());
  return indices[0];
}

uint32_t rootOf(std::vector<uint32_t>& parents, uint32_t v) {
  while (parents[v] != v) v = parents[v] = parents[parents[v]];
  return v;
}

void expectTree(const TestMesh& mesh, const EncodeOptions& options, uint32_t components) {
  SCOPED_TRACE(mesh.name);
  MeshPiece piece(mesh, {});
  const RoundTrip result = roundTrip(piece.view(), options);
  ASSERT_EQ(result.failure, "");
  std::vector<Told> told;
  const std::vector<uint32_t> indices = decodeWithEdges(result.encoded.payload, told);

  std::set<std::pair<uint32_t, uint32_t>> sides;
  for (size_t c = 0; c < indices.size(); ++c) {
    const uint32_t next = indices[c % 3 == 2 ? c - 2 : c + 1];
    sides.insert({indices[c], next});
    sides.insert({next, indices[c]});
  }
  std::vector<uint32_t> parents(mesh.vertexCount());
  std::iota(parents.begin(), parents.end(), 0u);
  for (const Told& edge : told) {
    EXPECT_EQ(edge.piece, 0u);
    EXPECT_EQ(sides.count({edge.vertex, edge.from}), 1u);
    parents[rootOf(parents, edge.vertex)] = rootOf(parents, edge.from);
  }
  std::set<uint32_t> roots;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) roots.insert(rootOf(parents, v));
  EXPECT_EQ(roots.size(), components);
  // A divide meets a vertex again; nothing else adds edges beyond those of a tree.
  if (result.histogram.dummy == 0 && result.histogram.handle == 0) {
    EXPECT_LE(told.size(), mesh.vertexCount() - components + result.histogram.start);
  }
}

TEST(McEdges, JoinAllVerticesOfClosedMeshes) {
  for (const TestMesh& mesh : {tetrahedron(), icosphere(3), torus(16, 8), bipyramid(40),
                               randomStacked(1, 300), plateWithTunnels(3, 1)}) {
    expectTree(mesh, {}, 1);
  }
  expectTree(looseTriangles(20), {}, 20);
}

TEST(McEdges, AreNumberedAsTheIndicesWhereOrdersAreKept) {
  EncodeOptions options;
  options.keep_vertex_order = options.keep_triangle_order = true;
  expectTree(shuffled(icosphere(3), 5), options, 1);
}

}  // namespace
}  // namespace mcc::test
