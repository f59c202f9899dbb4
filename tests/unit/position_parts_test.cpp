// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Pieces of the position coder by themselves; the whole is in attributes_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <random>
#include <vector>

#include "attributes/position_palette.h"
#include "attributes/position_predict.h"
#include "attributes/position_residual.h"

namespace mcc::test {
namespace {

TEST(PositionParts, HalfEdgesGoAroundAFace) {
  for (const uint32_t face : {0u, 8u, 8000u}) {
    for (uint32_t k = 0; k < 3; ++k) {
      EXPECT_EQ(nextHalfEdge(face + k), face + (k + 1) % 3);
      EXPECT_EQ(prevHalfEdge(face + k), face + (k + 2) % 3);
    }
  }
}

TEST(PositionParts, ScaleBucketsAreHalfOctaves) {
  const auto expected = [](uint32_t scale) {
    const uint32_t y = scale + 1;
    const uint32_t k = static_cast<uint32_t>(std::bit_width(y)) - 1;
    return std::min(2 * k + ((2 * y >> k) & 1), kScaleBuckets - 1);
  };
  for (uint32_t scale = 0; scale < 1'000'000; scale += 3) {
    const Lanes<uint32_t> buckets = scaleBuckets(Lanes<uint32_t>{scale, scale + 1, scale + 2, 0});
    for (uint32_t i = 0; i < 3; ++i) ASSERT_EQ(buckets[i], expected(scale + i));
  }
  const Lanes<uint32_t> last =
      scaleBuckets(Lanes<uint32_t>{kScaleLimit, kScaleLimit - 1, 1u << 24, 0});
  for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(last[i], kScaleBuckets - 1);
}

TEST(PositionParts, ShearCodesComponentsByGrowingNormal) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto next = [&] { return static_cast<float>(static_cast<int>(random() % 9) - 4); };
    const float n[3] = {next(), next(), next()};
    const Shear shear = makeShear(Lanes<float>{n[0], n[1], n[2], 0});
    for (uint32_t s = 0; s < 3; ++s) EXPECT_EQ(shear.slot[shear.axis[s]], s);
    EXPECT_LE(std::abs(n[shear.axis[0]]), std::abs(n[shear.axis[1]]));
    EXPECT_LE(std::abs(n[shear.axis[1]]), std::abs(n[shear.axis[2]]));
    for (const int32_t c : {shear.c10, shear.c20, shear.c21}) EXPECT_LE(std::abs(c), 4096);
  }
}

struct IndexedPalette {
  std::vector<int32_t> values;
  std::vector<uint32_t> cells;
  std::vector<uint32_t> inverse;
  AxisPalette palette;

  explicit IndexedPalette(std::vector<int32_t> sorted) : values(std::move(sorted)) {
    const PaletteIndex index(values.data(), static_cast<uint32_t>(values.size()));
    cells.resize(index.cell_count);
    inverse.resize(values.size());
    index.fill(cells.data(), inverse.data());
    palette = {values.data(), index.count, inverse.data(), cells.data(), index.shift};
  }
};

void checkRanks(const IndexedPalette& indexed) {
  const AxisPalette& palette = indexed.palette;
  const int64_t last = 256 * (int64_t{palette.count} - 1);
  for (uint32_t i = 0; i < palette.count; ++i) {
    EXPECT_EQ(palette.rankOf(int64_t{palette.values[i]} * 256), int64_t{i} * 256);
    EXPECT_EQ(palette.valueOf(static_cast<int32_t>(i)), palette.values[i]);
    EXPECT_EQ(palette.countUpTo(palette.values[i]), i + 1);
  }
  for (const int64_t far : {int64_t{1} << 20, int64_t{1} << 41}) {
    EXPECT_EQ(palette.rankOf(int64_t{palette.values[0]} * 256 - far), 0);
    EXPECT_EQ(palette.rankOf(int64_t{palette.values[palette.count - 1]} * 256 + far), last);
    EXPECT_LE(palette.roughRankOf(int64_t{palette.values[palette.count - 1]} * 256 + far), last);
  }
  const int64_t first = int64_t{palette.values[0]} * 256 - 300;
  const int64_t end = int64_t{palette.values[palette.count - 1]} * 256 + 300;
  int64_t before = 0;
  int64_t rough_before = 0;
  for (int64_t i = 0; i <= 5000; ++i) {
    const int64_t x = first + (end - first) / 5000 * i;
    EXPECT_GE(palette.rankOf(x), before);
    EXPECT_GE(palette.roughRankOf(x), rough_before);
    before = palette.rankOf(x);
    rough_before = palette.roughRankOf(x);
  }
}

TEST(PositionParts, PaletteRanksGrowAndAreExactAtValues) {
  checkRanks(IndexedPalette({7}));
  checkRanks(IndexedPalette({-5, -4, -3, 1000, 1001, 1003, 20000}));
  checkRanks(IndexedPalette({INT32_MIN, -1, 0, 1, INT32_MAX}));
  std::mt19937 random(2);
  for (int round = 0; round < 20; ++round) {
    std::vector<int32_t> values;
    for (int i = 0; i < 200; ++i) {
      values.push_back(static_cast<int32_t>(random() % 100 == 0 ? random() >> 16 : random() % 500));
    }
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    checkRanks(IndexedPalette(values));
  }
}

TEST(PositionParts, RanksBeyondThePaletteAreItsEnds) {
  const IndexedPalette indexed({3, 9});
  EXPECT_EQ(indexed.palette.valueOf(INT32_MIN), 3);
  EXPECT_EQ(indexed.palette.valueOf(INT32_MAX), 9);
}

}  // namespace
}  // namespace mcc::test
