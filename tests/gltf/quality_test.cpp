// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mcc::gltf::test {
namespace {

TEST(Quality, ErrorsFollowFromPixels) {
  const StatedErrors usual(4096);
  EXPECT_EQ(usual.share, 1.0 / 4096);
  EXPECT_DOUBLE_EQ(usual.radians, 0.25 / 180 * std::numbers::pi);
  EXPECT_EQ(usual.weight, 1.0 / 2048);
  const StatedErrors fine(4 * 4096);
  EXPECT_EQ(fine.share, usual.share / 4);
  EXPECT_DOUBLE_EQ(fine.radians, usual.radians / 2);
  EXPECT_EQ(fine.color, usual.color);
}

TEST(Quality, TexelsAndPixels) {
  const StatedErrors usual(4096);
  EXPECT_EQ(usual.texcoord(2048, 1), 1.0 / 8192);
  EXPECT_EQ(usual.texcoord(0, 1), 1.0 / 16384);
  EXPECT_EQ(usual.texcoord(8192, 1), 1.0 / 16384) << "a pixel is larger";
  EXPECT_TRUE(usual.isPixel(8192, 1));
  EXPECT_FALSE(usual.isPixel(4096, 1));
  EXPECT_EQ(usual.texcoord(8192, 0.25), 1.0 / 32768) << "the model shows a quarter of the texture";
  EXPECT_EQ(usual.texcoord(16, 1), 1.0 / 4096) << "a palette";
  EXPECT_EQ(StatedErrors(256).texcoord(4096, 1000), 1.0 / 1024) << "it repeats";
}

TEST(Quality, BitsAreTheFewestThatSuffice) {
  for (double radians = 1; radians > 1e-4; radians /= 1.3) {
    const uint8_t bits = octahedralBitsFor(radians);
    EXPECT_LE(octahedralBound(bits), radians);
    if (bits > 2) {
      EXPECT_GT(octahedralBound(bits - 1u), radians);
    }
    EXPECT_LE(std::ldexp(std::numbers::pi, -bits), radians) << "angles around a normal";
  }
  EXPECT_EQ(octahedralBitsFor(1e-9), 16);
  EXPECT_EQ(unitBitsFor(1.0 / 255), 8);
  EXPECT_EQ(unitBitsFor(1.0 / 256), 9);
  EXPECT_EQ(unitBitsFor(5), 1);
  EXPECT_EQ(unitBitsFor(1e-30), 24);
  // Whatever quality there is, the bits of unit vectors suffice.
  EXPECT_LE(octahedralBound(octahedralBitsFor(StatedErrors(kMostPixels).radians)),
            StatedErrors(kMostPixels).radians);
}

}  // namespace
}  // namespace mcc::gltf::test
