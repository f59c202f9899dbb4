// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Parts of the position coder by themselves; roundtrip/attribute_test.cpp tests the whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <random>
#include <vector>

#include "format/predictors.h"
#include "positions/palette.h"
#include "positions/predict.h"
#include "positions/residual.h"

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
    const Lanes<float> scales = floatsOf(Lanes<uint32_t>{scale, scale + 1, scale + 2, 0});
    const Lanes<uint32_t> buckets = scaleBuckets(scales);
    for (uint32_t i = 0; i < 3; ++i) {
      ASSERT_EQ(buckets[i], expected(scale + i));
      ASSERT_EQ(scaleBucket(scales[i]), buckets[i]);
    }
  }
  const Lanes<uint32_t> last = scaleBuckets(Lanes<float>{1 << 24, 0x1p43f, 0x1p127f, 0});
  for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(last[i], kScaleBuckets - 1);
}

/// A plain fan of these coordinates on all axes: n0, n1, n2, o0, o1, ya, yb, xa, xb.
struct PlainCase {
  VertexRecord records[9] = {};
  PlainFan fan;
  Beyond beyond;

  explicit PlainCase(const int32_t* q) {
    for (uint32_t i = 0; i < 9; ++i) {
      std::fill_n(records[i].q, 3, q[i]);
      std::fill_n(records[i].magnitude, 3, 0x80000000u >> i);
      records[i].magnitude[3] = 6 + i;
    }
    const VertexRecord* r = records;
    fan = {r, r + 1, r + 2, r + 3, r + 4, kNone, kNone};
    beyond = {r + 5, r + 6, r + 7, r + 8, true, true, true};
  }
};

TEST(PositionParts, PredictionsMoveWithTheirFan) {
  PositionParameters p;
  p.modes = position_mode::kWeights | position_mode::kSelect | position_mode::kShear;
  p.weights = kUniversalWeights;
  std::mt19937 random(3);
  for (int round = 0; round < 1000; ++round) {
    int32_t q[9];
    for (int32_t& x : q) x = static_cast<int32_t>(random() >> (random() % 32));
    const uint32_t by = static_cast<uint32_t>(random());
    Prediction before;
    Prediction after;
    const PlainCase still(q);
    for (int32_t& x : q) x = static_cast<int32_t>(static_cast<uint32_t>(x) + by);
    const PlainCase moved(q);
    for (const uint32_t degree : {3u, 6u, 9u}) {
      predictPlain(p, still.fan, &still.beyond, degree, p.modes, before);
      predictPlain(p, moved.fan, &moved.beyond, degree, p.modes, after);
      for (int s = 0; s < 3; ++s) {
        EXPECT_EQ(before.at.step[s] + by, after.at.step[s]);
        EXPECT_EQ(before.at.fraction[s], after.at.fraction[s]);
        EXPECT_EQ(before.spread[s], after.spread[s]);
        EXPECT_EQ(before.third[s], after.third[s]);
        EXPECT_GE(after.magnitudes[s], 0);
      }
    }
  }
}

TEST(PositionParts, NoCoordinatesMoveAPredictionTooFar) {
  PositionParameters p;
  p.modes = position_mode::kWeights | position_mode::kSelect;
  for (auto& w : p.weights.w) std::fill_n(w, kMostWeights, static_cast<int16_t>(kMaxWeight));
  for (uint32_t signs = 0; signs < 1u << 9; ++signs) {
    int32_t q[9];
    for (uint32_t i = 0; i < 9; ++i) q[i] = (signs >> i & 1) != 0 ? INT32_MAX : INT32_MIN;
    const PlainCase far(q);
    Prediction prediction;
    predictPlain(p, far.fan, &far.beyond, 6, p.modes, prediction);
    AnyFan any = {};
    any.face_count = 2;
    any.neighbour_count = 3;
    for (uint32_t i = 0; i < 3; ++i) any.n[i] = far.records + i;
    for (uint32_t i = 0; i < 2; ++i) any.o[i] = far.records + 3 + i;
    Prediction of_any;
    predictAny(p, any, of_any);
    for (int s = 0; s < 3; ++s) {
      EXPECT_LE(std::abs(static_cast<int32_t>(prediction.at.fraction[s])), (1 << 29) + 128);
      EXPECT_LE(std::abs(static_cast<int32_t>(of_any.at.fraction[s])), 1 << 29);
      EXPECT_GE(of_any.magnitudes[s], 0);
    }
  }
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
    for (const float c : {shear.c10, shear.c20, shear.c21}) EXPECT_LE(std::abs(c), 256);
  }
}

struct IndexedPalette {
  std::vector<int32_t> values;
  std::vector<uint32_t> cells;
  AxisPalette palette;

  explicit IndexedPalette(std::vector<int32_t> sorted) : values(std::move(sorted)) {
    const PaletteCells index(values.data(), static_cast<uint32_t>(values.size()));
    cells.resize(index.cell_count);
    index.fill(cells.data());
    palette = {values.data(), index.count, cells.data(), index.shift};
  }

  /// Q8 rank of a coordinate within the palette, linear between its values: what cells begin with.
  int64_t linearRank(int64_t x) const {
    const auto next = std::upper_bound(values.begin(), values.end(), x);
    const int64_t rank = 256 * (next - values.begin() - 1);
    return next == values.end() ? rank : rank + 256 * (x - next[-1]) / (int64_t{*next} - next[-1]);
  }
};

void checkRanks(const IndexedPalette& indexed) {
  const AxisPalette& palette = indexed.palette;
  const int64_t first = palette.values[0];
  const int64_t end = palette.values[palette.count - 1];
  const int64_t last = 256 * (int64_t{palette.count} - 1);
  for (uint32_t i = 0; i < palette.count; ++i) {
    EXPECT_EQ(palette.valueOf(static_cast<int32_t>(i)), palette.values[i]);
    EXPECT_EQ(palette.countUpTo(palette.values[i]), i + 1);
  }
  for (const int64_t far : {int64_t{1} << 20, int64_t{1} << 41}) {
    EXPECT_EQ(palette.rankOf(first * 256 - far), 0);
    EXPECT_EQ(palette.rankOf(end * 256 + far), palette.rankOf(end * 256));
  }
  for (int64_t x = first, cell = 0; x <= end; x += int64_t{1} << palette.shift, ++cell) {
    ASSERT_EQ(palette.rankOf(256 * x), indexed.linearRank(x)) << cell;
  }
  int64_t before = 0;
  for (int64_t i = 0; i <= 5000; ++i) {
    const int64_t rank = palette.rankOf(first * 256 - 300 + (256 * (end - first) + 600) / 5000 * i);
    EXPECT_GE(rank, before);
    EXPECT_LE(rank, last);
    before = rank;
  }
}

TEST(PositionParts, PaletteRanksGrowAndAreExactWhereCellsBegin) {
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
