// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Meshlets: each triangle once with its orientation, within the limits, and in linear time.
#include "mcc/meshlets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>
#include <set>
#include <vector>

#include "support/mesh_generators.h"
#include "unit/failing_allocator.h"

namespace mcc::test {
namespace {

constexpr MeshletOptions limitsOf(uint32_t max_vertices, uint32_t max_triangles,
                                  MeshletShape shape = MeshletShape::kRound) {
  return {max_vertices, max_triangles, shape, {}};
}

/// Arrays of exactly the size that is asked for, so that sanitizers see what is written beyond.
struct Meshlets {
  Meshlets(uint32_t triangle_count, const MeshletOptions& options)
      : bound(meshletBound(triangle_count, options)),
        meshlets(bound.meshlet_count),
        vertices(bound.vertex_count),
        triangles(bound.triangle_bytes, 0xee) {}
  MeshletTarget target() { return {meshlets, vertices, triangles}; }

  MeshletSizes bound;
  std::vector<Meshlet> meshlets;
  std::vector<uint32_t> vertices;
  std::vector<uint8_t> triangles;
  MeshletSizes used;
};

template <class Index>
Meshlets built(const std::vector<Index>& indices, uint32_t vertex_count,
               const MeshletOptions& options = {}) {
  const uint32_t triangle_count = static_cast<uint32_t>(indices.size() / 3);
  Meshlets made(triangle_count, options);
  const TriangleList list = {indices.data(), static_cast<IndexType>(sizeof(Index)), triangle_count,
                             vertex_count};
  const Status status = buildMeshlets(list, made.target(), made.used, options);
  EXPECT_TRUE(status.ok()) << status.what;
  return made;
}

using Triangles = std::multiset<std::array<uint32_t, 3>>;

Triangles trianglesOf(const std::vector<uint32_t>& indices) {
  Triangles all;
  for (size_t i = 0; i < indices.size(); i += 3)
    all.insert({indices[i], indices[i + 1], indices[i + 2]});
  return all;
}

/// Checks a meshlet, which follows the one before without gaps, and adds its triangles.
void expectMeshlet(const Meshlets& made, size_t number, const MeshletOptions& options,
                   MeshletSizes& end, Triangles& all) {
  const Meshlet& meshlet = made.meshlets[number];
  EXPECT_EQ(meshlet.vertex_offset, end.vertex_count);
  EXPECT_EQ(meshlet.triangle_offset, end.triangle_bytes);
  ASSERT_LE(meshlet.vertex_count, options.max_vertices);
  ASSERT_LE(meshlet.triangle_count, options.max_triangles);
  ASSERT_GE(meshlet.triangle_count, 1u);
  const uint32_t* vertices = made.vertices.data() + meshlet.vertex_offset;
  const uint8_t* locals = made.triangles.data() + meshlet.triangle_offset;
  const std::set<uint32_t> distinct(vertices, vertices + meshlet.vertex_count);
  EXPECT_EQ(distinct.size(), meshlet.vertex_count) << "a vertex is there twice";
  for (uint32_t i = 0; i < meshlet.triangle_count; ++i, locals += 3) {
    ASSERT_LT(*std::max_element(locals, locals + 3), meshlet.vertex_count);
    all.insert({vertices[locals[0]], vertices[locals[1]], vertices[locals[2]]});
  }
  end.vertex_count += meshlet.vertex_count;
  end.triangle_bytes += size_t{3} * meshlet.triangle_count;
  for (; end.triangle_bytes % 4 != 0; ++end.triangle_bytes)
    EXPECT_EQ(made.triangles[end.triangle_bytes], 0);
}

void expectMeshlets(const std::string& name, const std::vector<uint32_t>& indices,
                    const Meshlets& made, const MeshletOptions& options) {
  SCOPED_TRACE(name + " " + std::to_string(options.max_vertices) + " " +
               std::to_string(options.max_triangles));
  ASSERT_LE(made.used.meshlet_count, made.bound.meshlet_count);
  MeshletSizes end;
  Triangles all;
  for (size_t i = 0; i < made.used.meshlet_count; ++i) expectMeshlet(made, i, options, end, all);
  EXPECT_EQ(end.vertex_count, made.used.vertex_count);
  EXPECT_EQ(end.triangle_bytes, made.used.triangle_bytes);
  EXPECT_EQ(all, trianglesOf(indices));
}

constexpr std::array kLimits = {
    MeshletOptions{}, limitsOf(3, 1),     limitsOf(3, 512),   limitsOf(4, 2),   limitsOf(5, 124),
    limitsOf(64, 1),  limitsOf(255, 512), limitsOf(256, 512), limitsOf(256, 3), limitsOf(128, 256)};

TEST(Meshlets, HaveEachTriangleOnceWithItsOrientation) {
  std::vector<TestMesh> meshes = smallZoo();
  for (uint64_t seed = 0; seed < 20; ++seed) meshes.push_back(randomSoup(seed));
  meshes.push_back(withDegenerates(withIndexDuplicates(torus(30, 20), 1, 50), 2, 50));
  meshes.push_back(openFan(2000));
  meshes.push_back(shuffled(grid(40, 40), 3));
  for (const TestMesh& mesh : meshes) {
    for (MeshletOptions options : kLimits) {
      for (const MeshletShape shape : {MeshletShape::kRound, MeshletShape::kInOrder}) {
        options.shape = shape;
        const Meshlets made = built(mesh.indices, mesh.vertexCount(), options);
        expectMeshlets(mesh.name, mesh.indices, made, options);
      }
    }
  }
}

TEST(Meshlets, OfAListAreKnown) {
  // A strip of four triangles and one elsewhere; six vertices suffice for all of the strip.
  const std::vector<uint32_t> indices = {0, 1, 2, 2, 1, 3, 7, 8, 9, 2, 3, 4, 4, 3, 5};
  const Meshlets made = built(indices, 10, limitsOf(6, 16));
  ASSERT_EQ(made.used.meshlet_count, 2u);
  const std::vector<uint32_t> vertices = {0, 1, 2, 3, 4, 5, 7, 8, 9};
  EXPECT_TRUE(std::equal(vertices.begin(), vertices.end(), made.vertices.begin()));
  const std::vector<uint8_t> triangles = {0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5, 0, 1, 2, 0};
  EXPECT_TRUE(std::equal(triangles.begin(), triangles.end(), made.triangles.begin()));
  EXPECT_EQ(made.meshlets[1].vertex_offset, 6u);
  EXPECT_EQ(made.meshlets[1].triangle_offset, 12u);
}

TEST(Meshlets, KeepTheOrderOfTheListOnRequest) {
  const TestMesh mesh = shuffled(grid(30, 30), 7);
  const MeshletOptions options = limitsOf(64, 124, MeshletShape::kInOrder);
  const Meshlets made = built(mesh.indices, mesh.vertexCount(), options);
  std::vector<uint32_t> again;
  for (size_t i = 0; i < made.used.meshlet_count; ++i) {
    const Meshlet& meshlet = made.meshlets[i];
    for (uint32_t corner = 0; corner < 3 * meshlet.triangle_count; ++corner) {
      const uint8_t local = made.triangles[meshlet.triangle_offset + corner];
      again.push_back(made.vertices[meshlet.vertex_offset + local]);
    }
  }
  EXPECT_EQ(again, mesh.indices);
}

TEST(Meshlets, AreTheSameForEachTypeOfIndices) {
  const TestMesh mesh = torus(15, 10);
  const Meshlets made = built(mesh.indices, mesh.vertexCount());
  const Meshlets of16 =
      built(std::vector<uint16_t>(mesh.indices.begin(), mesh.indices.end()), mesh.vertexCount());
  const Meshlets of8 =
      built(std::vector<uint8_t>(mesh.indices.begin(), mesh.indices.end()), mesh.vertexCount());
  EXPECT_EQ(made.vertices, of16.vertices);
  EXPECT_EQ(made.triangles, of16.triangles);
  EXPECT_EQ(made.vertices, of8.vertices);
  EXPECT_EQ(made.triangles, of8.triangles);
}

TEST(Meshlets, AreRound) {
  // Rows of a grid are long strips, and meshlets of 64 vertices in their order would have 62
  // triangles. Around a vertex there are more.
  const TestMesh mesh = grid(200, 200);
  const Meshlets made = built(mesh.indices, mesh.vertexCount());
  EXPECT_LT(made.used.vertex_count, 7 * size_t{mesh.triangleCount()} / 10);
  EXPECT_LT(made.used.meshlet_count, mesh.triangleCount() / 90);
}

TEST(Meshlets, OfNothingAreNone) {
  const Meshlets made = built(std::vector<uint32_t>{}, 0);
  EXPECT_EQ(made.used.meshlet_count, 0u);
  EXPECT_EQ(made.bound.triangle_bytes, 0u);
}

Error errorOf(const std::vector<uint32_t>& indices, uint32_t vertex_count,
              const MeshletOptions& options) {
  const uint32_t triangle_count = static_cast<uint32_t>(indices.size() / 3);
  Meshlets made(triangle_count, options);
  MeshletSizes used;
  return buildMeshlets({indices.data(), IndexType::kUint32, triangle_count, vertex_count},
                       made.target(), used, options)
      .error;
}

TEST(Meshlets, RefuseWhatCannotBe) {
  const std::vector<uint32_t> one = {0, 1, 2};
  EXPECT_EQ(errorOf(one, 3, {}), Error::kOk);
  EXPECT_EQ(errorOf(one, 2, {}), Error::kBadArgument);
  EXPECT_EQ(errorOf({0, 1, kNone}, 3, {}), Error::kBadArgument);
  for (const MeshletOptions& wrong :
       {limitsOf(2, 124), limitsOf(257, 124), limitsOf(64, 0), limitsOf(64, 513),
        limitsOf(64, 124, static_cast<MeshletShape>(2))}) {
    EXPECT_EQ(errorOf(one, 3, wrong), Error::kBadArgument);
    EXPECT_EQ(meshletBound(1, wrong).meshlet_count, 0u);
  }
  EXPECT_EQ(meshletBound((1u << 28) + 1).meshlet_count, 0u);
}

TEST(Meshlets, RefuseArraysThatCannotBe) {
  const std::vector<uint32_t> indices = {0, 1, 2};
  const TriangleList list = {indices.data(), IndexType::kUint32, 1, 3};
  Meshlets made(1, {});
  const MeshletTarget whole = made.target();
  const auto error = [&](const TriangleList& from, const MeshletTarget& target) {
    MeshletSizes used;
    return buildMeshlets(from, target, used).error;
  };
  EXPECT_EQ(error(list, whole), Error::kOk);
  EXPECT_EQ(error({nullptr, IndexType::kUint32, 1, 3}, whole), Error::kBadArgument);
  EXPECT_EQ(error({indices.data(), static_cast<IndexType>(3), 1, 3}, whole), Error::kBadArgument);
  EXPECT_EQ(error({indices.data(), IndexType::kUint32, 1u << 29, 3}, whole), Error::kLimit);
  EXPECT_EQ(error(list, {{}, whole.vertices, whole.triangles}), Error::kBadArgument);
  EXPECT_EQ(error(list, {whole.meshlets, whole.vertices.first(2), whole.triangles}),
            Error::kBadArgument);
  EXPECT_EQ(error(list, {whole.meshlets, whole.vertices, whole.triangles.first(5)}),
            Error::kBadArgument);
}

TEST(Meshlets, SayWhenMemoryRunsOut) {
  TestMesh mesh = torus(15, 10);
  for (uint64_t left = 0; left <= 4; ++left) {
    FailingAllocator memory(left);
    MeshletOptions options;
    options.allocator = memory.allocator();
    EXPECT_EQ(errorOf(mesh.indices, mesh.vertexCount(), options),
              left < 4 ? Error::kOutOfMemory : Error::kOk);
    EXPECT_EQ(memory.liveBlocks(), 0u);
    EXPECT_TRUE(memory.booksBalance());
  }
}

double secondsFor(const std::vector<uint32_t>& indices, uint32_t vertex_count) {
  const auto start = std::chrono::steady_clock::now();
  (void)built(indices, vertex_count);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Meshlets, TakeLinearTimeForAFan) {
  // All triangles meet in one vertex, in an order in which most of those that a meshlet meets do
  // not fit: if it looked at all of them, that would be 4000 times the work.
  constexpr uint32_t kTriangles = 1 << 19;
  std::vector<uint32_t> fan;
  for (uint32_t i = 0; i < kTriangles; ++i) fan.insert(fan.end(), {0, 2 * i + 1, 2 * i + 2});
  std::vector<uint32_t> apart(fan.size());
  std::iota(apart.begin(), apart.end(), 0u);
  const double of_apart = secondsFor(apart, 3 * kTriangles);
  EXPECT_LT(secondsFor(fan, 2 * kTriangles + 1), 20 * of_apart + 0.1);
}

}  // namespace
}  // namespace mcc::test
