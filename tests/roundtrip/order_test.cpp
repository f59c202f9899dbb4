// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Kept orders come back exactly, whatever the triangles are, and cost no more than they may.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

EncodeOptions keeping(bool vertices, bool triangles) {
  EncodeOptions options;
  options.keep_vertex_order = vertices;
  options.keep_triangle_order = triangles;
  return options;
}

void expectKept(const TestMesh& mesh) {
  for (const uint32_t kept : {1u, 2u, 3u}) {
    const EncodeOptions options = keeping((kept & 1) != 0, (kept & 2) != 0);
    const MeshPiece piece(mesh);
    const TargetLayout narrow = {
        4, mesh.vertexCount() <= 256 ? IndexType::kUint8 : IndexType::kUint32};
    const RoundTrip result = roundTrip(piece.view(), options, narrow);
    EXPECT_EQ(result.failure, "") << mesh.name << ", kept " << kept;
    EXPECT_GT(result.encoded.sizes.order_bits, 0) << mesh.name;
  }
}

double orderBits(const TestMesh& mesh, const EncodeOptions& options) {
  const MeshPiece piece(mesh);
  const RoundTrip result = roundTrip(piece.view(), options);
  EXPECT_EQ(result.failure, "") << mesh.name;
  return result.encoded.sizes.order_bits;
}

TEST(Order, KeptOnGeneratedMeshes) {
  for (uint32_t i = 0; i < 40; ++i) {
    TestMesh mesh = generated(i, i % 3, i % 5, i % 7 + 1);
    if (i % 2 == 1) mesh = shuffled(std::move(mesh), i);
    expectKept(mesh);
  }
}

TEST(Order, KeptOnSoups) {
  for (uint32_t i = 0; i < 60; ++i) expectKept(randomSoup(i));
}

TEST(Order, KeptWithTrianglesBesideTheSurface) {
  TestMesh mesh = withDegenerates(withIndexDuplicates(icosphere(2), 1, 60), 2, 60);
  expectKept(mesh);
  expectKept(shuffled(withUnused(mesh, 3, 40), 4));
  expectKept(withPositionDuplicates(icosphere(2), 5, 50));
  expectKept(withIndexDuplicates(tetrahedron(), 6, 500));
}

TEST(Order, KeptAcrossSeams) {
  expectKept(chartGrid(20, 20, 5));
  expectKept(shuffled(flatShaded(icosphere(2)), 1));
  expectKept(withRandomWedges(moebius(30, 4), 2, 300));
  expectKept(withEqualTuples(icosphere(2), 3));
}

TEST(Order, KeptInEveryPart) {
  const TestMesh mesh = shuffled(withIndexDuplicates(icosphere(3), 1, 200), 2);
  for (const uint32_t part_count : {2u, 3u, 17u}) {
    std::vector<std::vector<uint32_t>> indices(part_count);
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t) {
      std::vector<uint32_t>& part = indices[t * t % part_count];
      part.insert(part.end(), &mesh.indices[3 * t], &mesh.indices[3 * t] + 3);
    }
    std::vector<PartView> parts;
    for (const std::vector<uint32_t>& part : indices) parts.push_back({part});
    for (const uint32_t kept : {1u, 2u, 3u}) {
      MeshPiece piece(mesh);
      piece.setParts(parts);
      EXPECT_EQ(roundTrip(piece.view(), keeping((kept & 1) != 0, (kept & 2) != 0)).failure, "");
    }
  }
}

/// Triangles without attributes, kept orders or not.
TEST(Order, IndicesOnly) {
  const TestMesh meshes[] = {tetrahedron(),
                             chartGrid(20, 20, 5),
                             flatShaded(icosphere(2)),
                             withUnused(withRandomWedges(book(4, 5, 5), 2, 200), 3, 20),
                             withDegenerates(withIndexDuplicates(torus(9, 7), 1, 60), 2, 60),
                             randomVoxels(3, 8, 40),
                             randomSoup(5),
                             unionOf(std::vector<TestMesh>{icosphere(4), moebius(40, 6)}, "two")};
  for (const TestMesh& mesh : meshes) {
    for (const uint32_t kept : {0u, 1u, 2u, 3u}) {
      EncodeOptions options = keeping((kept & 1) != 0, (kept & 2) != 0);
      options.indices_only = true;
      const MeshPiece piece(mesh, kExactBits);
      PieceView view = piece.view();
      view.attributes = view.attributes.first(1);
      const RoundTrip result = roundTrip(view, options);
      EXPECT_EQ(result.failure, "") << mesh.name << ", kept " << kept;
      EXPECT_EQ(result.encoded.sizes.position_bits, 0);
      EXPECT_TRUE(result.decoded[0].attributes.empty());
    }
  }
}

/// No order can be stored in fewer bits than log2(n!) on average.
TEST(Order, RandomOrderCostsWhatItMust) {
  TestMesh mesh = shuffled(icosphere(5), 7);  // 10,242 vertices
  const double n = mesh.vertexCount();
  const double least = std::lgamma(n + 1) / std::log(2.0);
  EXPECT_LT(orderBits(mesh, keeping(true, false)), 1.03 * least);
}

/// If vertices are numbered by first use, only the order of the triangles has to be stored.
TEST(Order, FirstUseIsFree) {
  TestMesh mesh = shuffled(icosphere(4), 3);
  std::vector<uint32_t> place(mesh.vertexCount(), kNone);
  std::vector<float> positions(mesh.positions.size());
  uint32_t next = 0;
  for (uint32_t& index : mesh.indices) {
    if (place[index] == kNone) {
      for (size_t k = 0; k < 3; ++k)
        positions[3 * size_t{next} + k] = mesh.positions[3 * size_t{index} + k];
      place[index] = next++;
    }
    index = place[index];
  }
  mesh.positions = positions;
  mesh.normals.clear();
  mesh.texcoords.clear();
  EXPECT_LT(orderBits(mesh, keeping(true, true)), orderBits(mesh, keeping(false, true)) + 64);
}

TEST(Order, RowsOfAGridAreCheap) {
  const TestMesh mesh = grid(100, 100);
  EXPECT_LT(orderBits(mesh, keeping(true, false)), 1.0 * mesh.vertexCount());
  EXPECT_LT(orderBits(mesh, keeping(false, true)), 1.0 * mesh.triangleCount());
}

}  // namespace
}  // namespace mcc::test
