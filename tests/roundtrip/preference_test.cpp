// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The caller's preference changes what the writer chooses, but nothing that is decoded.
#include <gtest/gtest.h>

#include "positions/enc_prices.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

/// Returns the bytes of small surfaces, for which one coder for all streams saves bytes and takes
/// longer, and of others.
size_t bytesOf(Preference prefer) {
  EncodeOptions options;
  options.prefer = prefer;
  size_t bytes = 0;
  for (uint32_t cells = 4; cells <= 20; ++cells) {
    const TestMesh mesh = isosurface(cells, [](double x, double y, double z) {
      return x * x + 1.3 * y * y + 0.8 * z * z + 0.2 * x * y * z - 0.61;
    });
    const RoundTrip result = roundTrip(MeshPiece(mesh, {14, 0, 0}).view(), options);
    EXPECT_EQ(result.failure, "");
    bytes += result.encoded.payload.size();
  }
  return bytes;
}

TEST(Preference, BytesForTime) {
  const size_t balanced = bytesOf(Preference::kBalanced);
  EXPECT_LT(balanced, bytesOf(Preference::kSpeed));
  EXPECT_LT(bytesOf(Preference::kSize), balanced);
}

TEST(Preference, PricesOfTime) {
  EXPECT_DOUBLE_EQ(TimePrice(Preference::kSize).surcharge(1000, 15), 10);
  EXPECT_DOUBLE_EQ(TimePrice(Preference::kBalanced).surcharge(1000, 4), 10);
  EXPECT_DOUBLE_EQ(TimePrice(Preference::kSpeed).surcharge(1000, 2.4), 10);
}

}  // namespace
}  // namespace mcc::test
