// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// How triangles are divided into blocks: every triangle once, blocks of about the size that was
// asked for, short borders, and the same result on any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "mcc/types.h"
#include "prepare/enc_blocks.h"
#include "support/mesh_generators.h"
#include "support/run_jobs.h"

namespace mcc::test {
namespace {

std::vector<float> centroidSums(const TestMesh& mesh) {
  std::vector<float> sums(mesh.indices.size());
  for (size_t t = 0; t < sums.size(); t += 3) {
    for (size_t s = 0; s < 3; ++s) {
      for (size_t k = 0; k < 3; ++k)
        sums[t + s] += mesh.positions[3 * size_t{mesh.indices[t + k]} + s];
    }
  }
  return sums;
}

BlockCut cutOf(const TestMesh& mesh, uint32_t block_triangles, const RunJobs& hook = {}) {
  return cutIntoBlocks(centroidSums(mesh), mesh.indices, mesh.vertexCount(), block_triangles,
                       Jobs(hook));
}

std::vector<uint32_t> blocksOf(const BlockCut& cut) {
  std::vector<uint32_t> block_of(cut.triangles.size(), kNone);
  for (uint32_t b = 0; b < cut.blockCount(); ++b) {
    for (const uint32_t t : cut.trianglesOf(b)) block_of[t] = b;
  }
  return block_of;
}

/// Blocks are not empty, ascend, and have each triangle once.
void expectPartition(const BlockCut& cut, uint32_t triangle_count, const std::string& name) {
  std::vector<uint32_t> all;
  for (uint32_t b = 0; b < cut.blockCount(); ++b) {
    const std::span<const uint32_t> triangles = cut.trianglesOf(b);
    EXPECT_FALSE(triangles.empty()) << name;
    EXPECT_TRUE(std::is_sorted(triangles.begin(), triangles.end())) << name;
    all.insert(all.end(), triangles.begin(), triangles.end());
  }
  std::sort(all.begin(), all.end());
  std::vector<uint32_t> expected(triangle_count);
  std::iota(expected.begin(), expected.end(), 0u);
  EXPECT_EQ(all, expected) << name;
}

TEST(CutIntoBlocks, EveryTriangleIsInOneBlock) {
  for (const TestMesh& mesh : smallZoo()) {
    for (const uint32_t size : {1u, 2u, 3u, 7u, 8u, 50u, 1000u}) {
      if (mesh.triangleCount() <= size) continue;
      expectPartition(cutOf(mesh, size), mesh.triangleCount(),
                      mesh.name + ", " + std::to_string(size));
    }
  }
}

TEST(CutIntoBlocks, SizesAreNearTheAim) {
  for (const TestMesh& mesh : {icosphere(5), jittered(grid(90, 70), 3, 0.01f), torus(120, 60),
                               flipped(icosphere(4), 3, 4000)}) {
    for (const uint32_t aim : {100u, 333u, 1000u}) {
      const BlockCut cut = cutOf(mesh, aim);
      // The first block has an eighth, an even number of others shares the rest. A first block that
      // is a strip of few triangles may be smoothed away.
      const uint32_t rest = mesh.triangleCount() - aim / 8;
      const auto others = static_cast<uint32_t>(2 * std::lround(rest / (2.0 * aim)));
      const bool has_first = cut.blockCount() == 1 + others;
      EXPECT_TRUE(has_first || (cut.blockCount() == others && aim < 1000))
          << mesh.name << ", " << aim;
      if (has_first) {
        EXPECT_LT(cut.trianglesOf(0).size(), aim / 4) << mesh.name << ", " << aim;
      }
      const double each = static_cast<double>(rest) / others;
      for (uint32_t b = has_first ? 1 : 0; b < cut.blockCount(); ++b) {
        const auto size = static_cast<double>(cut.trianglesOf(b).size());
        EXPECT_GT(size, 0.7 * each) << mesh.name << ", " << aim;
        EXPECT_LT(size, 1.4 * each) << mesh.name << ", " << aim;
      }
    }
  }
}

/// The faces across the edges of each triangle of a mesh whose edges have two faces at most.
std::vector<std::vector<uint32_t>> neighboursOf(const TestMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> faces_of;
  for (uint32_t c = 0; c < mesh.indices.size(); ++c) {
    const uint32_t a = mesh.indices[c];
    const uint32_t b = mesh.indices[c % 3 == 2 ? c - 2 : c + 1];
    faces_of[std::minmax(a, b)].push_back(c / 3);
  }
  std::vector<std::vector<uint32_t>> neighbours(mesh.triangleCount());
  for (const auto& [edge, faces] : faces_of) {
    if (faces.size() != 2) continue;
    neighbours[faces[0]].push_back(faces[1]);
    neighbours[faces[1]].push_back(faces[0]);
  }
  return neighbours;
}

TEST(CutIntoBlocks, BordersAreShort) {
  for (const TestMesh& mesh : {icosphere(5), torus(120, 60), flipped(icosphere(4), 3, 2000)}) {
    const BlockCut cut = cutOf(mesh, 700);
    const std::vector<uint32_t> block_of = blocksOf(cut);
    const auto neighbours = neighboursOf(mesh);
    uint64_t border_edges = 0;
    uint32_t sticking_out = 0;
    for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
      std::map<uint32_t, uint32_t> across;
      for (const uint32_t other : neighbours[t]) {
        if (block_of[other] == block_of[t]) continue;
        ++border_edges;
        sticking_out += ++across[block_of[other]] == 2 ? 1 : 0;
      }
    }
    // A square of n triangles has a circumference of 4 sqrt(n / 2) edges, half of each border.
    const double squares = static_cast<double>(cut.blockCount()) * 4 * std::sqrt(350.0);
    EXPECT_LT(static_cast<double>(border_edges), 1.6 * squares) << mesh.name;
    EXPECT_LE(sticking_out, border_edges / 100) << mesh.name;
  }
}

TEST(CutIntoBlocks, JobsDoNotMatter) {
  for (const TestMesh& mesh : {icosphere(4), randomVoxels(3, 8, 50), soup(1, 900, 40, {})}) {
    for (const uint32_t size : {7u, 20u, 300u}) {
      const BlockCut alone = cutOf(mesh, size);
      for (const RunJobs& hook : {RunJobs(runBackwards), RunJobs(runOnThreads)}) {
        const BlockCut cut = cutOf(mesh, size, hook);
        EXPECT_EQ(cut.triangles, alone.triangles) << mesh.name << ", " << size;
        EXPECT_EQ(cut.block_begin, alone.block_begin) << mesh.name << ", " << size;
      }
    }
  }
}

/// Without places to go by, triangles are divided by their numbers.
TEST(CutIntoBlocks, EverythingInOnePlace) {
  TestMesh mesh = icosphere(2);
  mesh.positions.assign(mesh.positions.size(), 2.5f);
  for (const uint32_t size : {1u, 10u, 100u}) {
    const BlockCut cut = cutOf(mesh, size);
    expectPartition(cut, mesh.triangleCount(), "one place");
    EXPECT_GT(cut.blockCount(), 1u);
  }
  // Both sides of a triangle, which two edges lead to each other: they may become one block.
  TestMesh sides = looseTriangles(1);
  sides.indices = {0, 1, 2, 0, 2, 1};
  expectPartition(cutOf(sides, 1), 2, "both sides");
}

}  // namespace
}  // namespace mcc::test
