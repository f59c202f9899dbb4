// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What callers prefer changes what the writer chooses, and nothing that is decoded.
#include <gtest/gtest.h>

#include "attributes/enc_prices.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

size_t bytesOf(const MeshPiece& piece, Preference prefer) {
  EncodeOptions options;
  options.prefer = prefer;
  const RoundTrip result = roundTrip(piece.view(), options);
  EXPECT_EQ(result.failure, "");
  return result.encoded.payload.size();
}

/// Planes, which a surface may have and which take long.
TEST(Preference, BytesForTime) {
  const TestMesh mesh = isosurface(40, [](double x, double y, double z) {
    return x * x + 1.3 * y * y + 0.8 * z * z + 0.2 * x * y * z - 0.61;
  });
  const MeshPiece piece(mesh, {14, 0, 0});
  const size_t balanced = bytesOf(piece, Preference::kBalanced);
  EXPECT_LT(balanced, bytesOf(piece, Preference::kSpeed));
  EXPECT_LE(bytesOf(piece, Preference::kSize), balanced);
}

TEST(Preference, PricesOfTime) {
  EXPECT_EQ(TimePrice(Preference::kSize).surcharge(1000, 50), 0);
  EXPECT_EQ(TimePrice(Preference::kBalanced).surcharge(1000, 4), 10);
  EXPECT_EQ(TimePrice(Preference::kSpeed).surcharge(1000, 1), 10);
}

}  // namespace
}  // namespace mcc::test
