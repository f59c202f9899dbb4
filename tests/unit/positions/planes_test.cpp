// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Planes that coordinates lie on; the coder of their vertices is in parts_test.cpp, whole
// surfaces are in roundtrip/isosurface_test.cpp.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "entropy/decoder_io.h"
#include "entropy/enc_coder.h"
#include "positions/enc_planes.h"
#include "positions/planes.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

AxisPlanes planesAt(double origin, double step) {
  return {static_cast<int64_t>(origin * AxisPlanes::kOne),
          static_cast<int64_t>(step * AxisPlanes::kOne)};
}

TEST(PositionPlanes, BelowIsTheInverseOfAt) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const double step = 4 + static_cast<double>(random() % 100000) / 77;
    const AxisPlanes planes = planesAt(step * static_cast<double>(random() % 97) / 97, step);
    for (int32_t q = 0; q < 1 << 17; q += 1 + static_cast<int32_t>(random() % 4000)) {
      const int32_t plane = planes.below(q);
      ASSERT_LE(planes.at(plane), q);
      ASSERT_GT(planes.at(plane + 1), q);
    }
  }
}

/// Lines of diagonals go on with the same slope in each cell that they enter, and are as many as
/// planes.
TEST(PositionPlanes, KindsAreAllDifferent) {
  const AxisPlanes planes[3] = {planesAt(1, 8), planesAt(0, 16), planesAt(3, 32)};
  const GridPlanes grid(planes);
  std::set<std::vector<float>> kinds;
  for (const GridPlanes::Frame& frame : grid.frame) {
    EXPECT_EQ(frame.between & frame.moving, frame.moving);
    EXPECT_EQ(std::popcount(frame.moving), frame.moving_count);
    EXPECT_NE(frame.moving & 1u << frame.first, 0);
    EXPECT_EQ(frame.rests, frame.between & ~frame.moving);
    for (uint32_t s = 0; s < 3; ++s) {
      const float slope =
          static_cast<float>(planes[s].step) / static_cast<float>(planes[frame.first].step);
      EXPECT_EQ(std::fabs(frame.slope[s]), (frame.rests >> s & 1) != 0 ? slope : 0);
      EXPECT_EQ(frame.on_planes[s], (frame.moving >> s & 1) != 0 ? 0u : ~0u);
    }
    kinds.insert({static_cast<float>(frame.between), static_cast<float>(frame.moving),
                  frame.slope[1], frame.slope[2]});
  }
  EXPECT_EQ(kinds.size(), size_t{kTokenCount});
}

/// Vertices on the edges of a grid: two coordinates are those of planes.
std::vector<int32_t> onEdges(double origin, double step, uint32_t plane_count, uint32_t seed) {
  Random random(seed);
  std::vector<int32_t> truth;
  for (uint32_t v = 0; v < 200 * plane_count; ++v) {
    const uint32_t free_axis = random.below(3);
    for (uint32_t s = 0; s < 3; ++s) {
      const double along = s == free_axis ? static_cast<double>(random.below(1000)) / 1000 : 0;
      const double x = origin + step * (random.below(plane_count) + along);
      truth.push_back(static_cast<int32_t>(std::floor(x + 0.5)));
    }
  }
  return truth;
}

TEST(PositionPlanes, AreFoundAndHoldEveryCoordinateOnThem) {
  for (const double step : {17.25, 99.9, 137.624209, 550.529}) {
    for (const double origin : {0.0, 2.863, 11.4}) {
      SCOPED_TRACE(testing::Message() << "step " << step << ", origin " << origin);
      const uint32_t plane_count = std::min(110u, static_cast<uint32_t>(65000 / step));
      const std::vector<int32_t> truth = onEdges(origin, step, plane_count, 5);
      AxisPlanes planes[3];
      ASSERT_TRUE(findPlanes(truth, planes));
      for (uint32_t s = 0; s < 3; ++s) {
        const double found = static_cast<double>(planes[s].step) / AxisPlanes::kOne;
        EXPECT_NEAR(found, step, 0.01);
        for (uint32_t k = 0; k < plane_count; ++k) {
          const int32_t x = static_cast<int32_t>(std::floor(origin + step * k + 0.5));
          ASSERT_EQ(planes[s].at(planes[s].below(x)), x) << "plane " << k;
        }
      }
    }
  }
}

TEST(PositionPlanes, AreNotFoundWhereThereAreNone) {
  std::mt19937 random(7);
  std::vector<int32_t> anywhere(30000);
  for (int32_t& q : anywhere) q = static_cast<int32_t>(random() % 16384);
  AxisPlanes planes[3];
  EXPECT_FALSE(findPlanes(anywhere, planes));
  EXPECT_FALSE(findPlanes({}, planes));
  EXPECT_FALSE(findPlanes(std::vector<int32_t>{1, 2, 3}, planes));
  std::vector<int32_t> outside = onEdges(0, 100, 100, 1);
  outside[4] = -1;
  EXPECT_FALSE(findPlanes(outside, planes));
  outside[4] = 1 << 17;
  EXPECT_FALSE(findPlanes(outside, planes));
}

TEST(PositionPlanes, TravelAndAreRefusedOutOfRange) {
  const AxisPlanes good[] = {{0, AxisPlanes::kMinStep},
                             {AxisPlanes::kMinStep - 1, AxisPlanes::kMinStep},
                             {AxisPlanes::kEndOfSteps - 2, AxisPlanes::kEndOfSteps - 1}};
  const AxisPlanes bad[] = {{0, AxisPlanes::kMinStep - 1},
                            {AxisPlanes::kMinStep, AxisPlanes::kMinStep}};
  const auto code = [](AxisPlanes planes, AxisPlanes& parsed) {
    EncoderIo encoder(false);
    (void)codePlanes(encoder, planes);
    const EncoderIo::Streams streams = encoder.finish();
    DecoderIo<false> decoder(streams.codes, streams.tokens, streams.raw);
    return codePlanes(decoder, parsed);
  };
  for (const AxisPlanes& planes : good) {
    AxisPlanes parsed;
    ASSERT_TRUE(code(planes, parsed).ok());
    EXPECT_EQ(parsed.origin, planes.origin);
    EXPECT_EQ(parsed.step, planes.step);
  }
  for (const AxisPlanes& planes : bad) {
    AxisPlanes parsed;
    EXPECT_EQ(code(planes, parsed).error, Error::kBadAttribute);
  }
}

}  // namespace
}  // namespace mcc::test
