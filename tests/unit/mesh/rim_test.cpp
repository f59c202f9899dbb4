// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Wedges on the cuts between blocks: which they are, and what numbers they get. The rule is written
// down a second time, as the specification says it.                                       [A.11.3]
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "mesh/rim.h"
#include "support/mesh_generators.h"
#include "unit/failing_allocator.h"

namespace mcc::test {
namespace {

/// A mesh as the stages see it. Half-edges are twins where two faces run along an edge in opposite
/// directions, but for `lone_percent` of the edges.
FaceMesh faceMesh(const TestMesh& mesh, Random& random, uint32_t lone_percent) {
  FaceMesh faces{Allocator{}};
  faces.face_count = mesh.triangleCount();
  EXPECT_TRUE(faces.words.assign(size_t{faces.face_count} * kFaceWords, kNone));
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> half_edges;
  for (uint32_t c = 0; c < mesh.indices.size(); ++c)
    faces.words[c / 3 * kFaceWords + c % 3] = mesh.indices[c];
  const FaceView view = faces.view();
  for (uint32_t c = 0; c < mesh.indices.size(); ++c) {
    const uint32_t h = c / 3 * kFaceWords + c % 3;
    const uint32_t tail = view.vertex(h);
    const uint32_t head = view.vertex(nextHalfEdge(h));
    const auto opposite = half_edges.find({head, tail});
    if (opposite == half_edges.end()) {
      half_edges[{tail, head}] = h;
    } else if (!random.chance(lone_percent)) {
      faces.words[h + 4] = opposite->second;
      faces.words[opposite->second + 4] = h;
    }
  }
  return faces;
}

std::vector<uint32_t> listed(const Array<uint32_t>& array) {
  return {array.data(), array.data() + array.size()};
}

std::vector<uint32_t> rimOf(const FaceMesh& mesh, uint32_t wedge_count) {
  Rim rim{Allocator{}};
  EXPECT_TRUE(rim.find(mesh, wedge_count));
  EXPECT_TRUE(rim.find(mesh, wedge_count));  // finds them anew
  return listed(rim.wedges);
}

TEST(Rim, HasBothEndsOfEdgesWithoutATwin) {
  Random random(1);
  for (const TestMesh& mesh : {looseTriangles(4), grid(7, 5), sheetWithHoles(3, 2), torus(6, 5),
                               openFan(9), withUnused(grid(3, 3), 1, 9)}) {
    for (const uint32_t lone_percent : {0u, 10u, 100u}) {
      const FaceMesh faces = faceMesh(mesh, random, lone_percent);
      std::set<uint32_t> expected;
      for (uint32_t c = 0; c < mesh.indices.size(); ++c) {
        if (faces.words[c / 3 * kFaceWords + 4 + c % 3] != kNone) continue;
        expected.insert({mesh.indices[c], mesh.indices[c % 3 == 2 ? c - 2 : c + 1]});
      }
      EXPECT_EQ(rimOf(faces, mesh.vertexCount()),
                std::vector<uint32_t>(expected.begin(), expected.end()))
          << mesh.name << ", " << lone_percent;
    }
  }
}

TEST(Rim, OfAClosedSurfaceIsEmpty) {
  Random random(1);
  const TestMesh mesh = icosphere(2);
  EXPECT_TRUE(rimOf(faceMesh(mesh, random, 0), mesh.vertexCount()).empty());
}

using Tuple = std::vector<int32_t>;

/// A block, as much of it as gluing looks at.
struct RimBlock {
  uint32_t wedge_count = 0;
  std::vector<uint32_t> wedges;  ///< on the rim
  std::vector<Tuple> tuples;
  std::vector<BlockException> exceptions;

  Rim rim(uint32_t tuple_words) const {
    Rim made{Allocator{}};
    made.tuple_words = tuple_words;
    for (const uint32_t w : wedges) EXPECT_TRUE(made.wedges.push_back(w));
    for (const Tuple& tuple : tuples) {
      for (const int32_t word : tuple) EXPECT_TRUE(made.tuples.push_back(word));
    }
    return made;
  }
};

/// Glues as the specification says.
class NaiveGlue {
 public:
  std::vector<uint32_t> add(const RimBlock& block, uint32_t& repeated_count) {
    std::map<uint32_t, Tuple> tuple_of;
    for (size_t i = 0; i < block.wedges.size(); ++i) tuple_of[block.wedges[i]] = block.tuples[i];
    std::map<uint32_t, uint32_t> exceptions;
    for (const BlockException& e : block.exceptions) exceptions[e.wedge] = e.number;
    std::vector<uint32_t> numbers;
    uint32_t wedges = first_;
    repeated_count = 0;
    for (uint32_t w = 0; w < block.wedge_count; ++w) {
      uint32_t earlier = kNone;
      if (exceptions.contains(w)) {
        earlier = exceptions[w];
      } else if (tuple_of.contains(w) && rim_.contains(tuple_of[w])) {
        earlier = rim_[tuple_of[w]];
      }
      numbers.push_back(earlier == kNone ? wedges++ : earlier);
      repeated_count += earlier == kNone ? 0 : 1;
    }
    for (const auto& [w, tuple] : tuple_of) {
      if (numbers[w] < first_ || exceptions.contains(w) || rim_.contains(tuple)) continue;
      rim_[tuple] = numbers[w];
    }
    first_ = wedges;
    return numbers;
  }
  uint32_t first() const { return first_; }

 private:
  std::map<Tuple, uint32_t> rim_;
  uint32_t first_ = 0;
};

/// Few different tuples, so that many are equal, within a block and among blocks.
RimBlock anyBlock(Random& random, uint32_t tuple_words, uint32_t first) {
  RimBlock block;
  block.wedge_count = random.between(1, random.chance(10) ? 300 : 20);
  const uint32_t values = random.between(1, 4);
  for (uint32_t w = 0; w < block.wedge_count; ++w) {
    if (random.chance(60)) {
      block.wedges.push_back(w);
      Tuple& tuple = block.tuples.emplace_back();
      for (uint32_t i = 0; i < tuple_words; ++i) {
        constexpr int32_t kOdd[] = {0, INT32_MIN, INT32_MAX, -1, 1};
        tuple.push_back(kOdd[random.below(values + 1)]);
      }
    }
    if (!random.chance(15)) continue;
    const bool names_one = first != 0 && random.chance(60);
    block.exceptions.push_back({w, names_one ? random.below(first) : kNone});
  }
  return block;
}

TEST(Rim, WedgesAreNumberedAsTheSpecificationSays) {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const uint32_t tuple_words = random.between(3, 7);
    RimTable table{Allocator{}};
    NaiveGlue naive;
    for (uint32_t b = 0; b < 40; ++b) {
      const uint32_t first = naive.first();
      const RimBlock block = anyBlock(random, tuple_words, first);
      uint32_t expected_count = 0;
      const std::vector<uint32_t> expected = naive.add(block, expected_count);
      Array<uint32_t> numbers;
      uint32_t repeated_count = kNone;
      ASSERT_TRUE(numberWedges(table, block.rim(tuple_words), block.exceptions, first,
                               block.wedge_count, numbers, repeated_count));
      ASSERT_EQ(listed(numbers), expected) << "seed " << seed << ", block " << b;
      ASSERT_EQ(repeated_count, expected_count) << "seed " << seed << ", block " << b;
    }
  }
}

TEST(Rim, ExceptionsDoNotEnterTheTable) {
  RimTable table{Allocator{}};
  const auto number = [&](const RimBlock& block, uint32_t first) {
    Array<uint32_t> numbers;
    uint32_t repeated_count = 0;
    EXPECT_TRUE(numberWedges(table, block.rim(1), block.exceptions, first, block.wedge_count,
                             numbers, repeated_count));
    return listed(numbers);
  };
  EXPECT_EQ(number({2, {0, 1}, {{7}, {8}}, {{0, kNone}}}, 0), (std::vector<uint32_t>{0, 1}));
  // 7 is not there, although it is new in the first block; 8 is.
  EXPECT_EQ(number({2, {0, 1}, {{7}, {8}}, {}}, 2), (std::vector<uint32_t>{2, 1}));
  // Now it is. The exception names another wedge than the table.
  EXPECT_EQ(number({2, {0, 1}, {{7}, {7}}, {{1, 0}}}, 3), (std::vector<uint32_t>{2, 0}));
}

TEST(Rim, EqualTuplesOfABlockStayApart) {
  RimTable table{Allocator{}};
  Array<uint32_t> numbers;
  uint32_t repeated_count = 0;
  const RimBlock block = {3, {0, 1, 2}, {{5}, {5}, {5}}, {}};
  ASSERT_TRUE(numberWedges(table, block.rim(1), {}, 0, 3, numbers, repeated_count));
  EXPECT_EQ(listed(numbers), (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(repeated_count, 0u);
  // All of the next block are the first of them.
  ASSERT_TRUE(numberWedges(table, block.rim(1), {}, 3, 3, numbers, repeated_count));
  EXPECT_EQ(listed(numbers), (std::vector<uint32_t>{0, 0, 0}));
  EXPECT_EQ(repeated_count, 3u);
}

/// Adds runs of many sizes, small after large and large after small, so that all kinds of merges
/// occur, and looks everything up after each.
TEST(Rim, TableFindsTheFirstOfEqualTuples) {
  for (uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    RimTable table{Allocator{}};
    std::map<Tuple, uint32_t> naive;
    uint32_t next = 0;
    for (uint32_t round = 0; round < 60; ++round) {
      RimBlock block;
      block.wedge_count = random.chance(20) ? random.between(0, 400) : random.between(0, 5);
      std::vector<uint32_t> numbers;
      std::vector<bool> is_entry;
      for (uint32_t w = 0; w < block.wedge_count; ++w) {
        block.wedges.push_back(w);
        const auto word = [&] { return static_cast<int32_t>(random.below(25)) - 12; };
        block.tuples.push_back({word(), word()});
        numbers.push_back(next++);
        is_entry.push_back(random.chance(90));
        if (is_entry.back()) naive.insert({block.tuples.back(), numbers.back()});
      }
      ASSERT_TRUE(table.add(block.rim(2), numbers.data(), [&](size_t i) { return is_entry[i]; }));
      for (int32_t x = -13; x < 14; ++x) {
        for (int32_t y = -13; y < 14; ++y) {
          const auto it = naive.find({x, y});
          const int32_t tuple[] = {x, y};
          ASSERT_EQ(table.find(tuple), it == naive.end() ? kNone : it->second)
              << "seed " << seed << ", round " << round;
        }
      }
    }
  }
}

TEST(Rim, OutOfMemory) {
  Random random(3);
  const TestMesh mesh = grid(9, 9);
  const FaceMesh faces = faceMesh(mesh, random, 0);
  for (uint64_t allocations = 0;; ++allocations) {
    FailingAllocator memory(allocations);
    bool is_done = true;
    {
      Rim rim(memory.allocator());
      RimTable table(memory.allocator());
      Array<uint32_t> numbers(memory.allocator());
      uint32_t first = 0;
      for (int32_t block = 0; block < 6 && is_done; ++block) {
        uint32_t repeated_count = 0;
        rim.tuple_words = 3;
        is_done = rim.find(faces, mesh.vertexCount()) && rim.tuples.resize(3 * rim.wedges.size());
        if (!is_done) break;
        for (size_t i = 0; i < rim.tuples.size(); ++i)
          rim.tuples[i] = block / 2 + static_cast<int32_t>(i);
        is_done = numberWedges(table, rim, {}, first, mesh.vertexCount(), numbers, repeated_count);
        first += mesh.vertexCount() - repeated_count;
      }
    }
    EXPECT_EQ(memory.liveBlocks(), 0u);
    EXPECT_TRUE(memory.booksBalance());
    if (is_done) break;
    ASSERT_LT(allocations, 1000u);
  }
}

}  // namespace
}  // namespace mcc::test
