// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Surfaces whose vertices lie on the edges of a grid: its planes are found and save bytes, and what
// is coded comes back.
#include <gtest/gtest.h>

#include "container/payload_header.h"
#include "format/predictors.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

double blob(double x, double y, double z) {
  return x * x + 1.3 * y * y + 0.8 * z * z + 0.2 * x * y * z - 0.61;
}
/// Two of them, apart.
double blobs(double x, double y, double z) {
  const double left = (x + 0.5) * (x + 0.5) + y * y + z * z - 0.171;
  const double right = (x - 0.47) * (x - 0.47) + y * y + 1.2 * z * z - 0.143;
  return left * right;
}

bool hasPlanes(const EncodeResult& result) {
  PayloadHeader header{Allocator{}};
  EXPECT_TRUE(parsePayload(result.payload, Limits{}, header).ok());
  return (header.attributes[0].predictor & position_mode::kPlanes) != 0;
}

/// The same surface, moved off all planes.
TestMesh turned(TestMesh mesh) {
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    float* p = &mesh.positions[size_t{3} * v];
    const float x = 0.8f * p[0] - 0.6f * p[1];
    const float y = 0.6f * p[0] + 0.8f * p[1];
    p[0] = 0.96f * x - 0.28f * p[2];
    p[2] = 0.28f * x + 0.96f * p[2];
    p[1] = y;
  }
  return mesh;
}

TEST(Isosurface, PlanesOfTheGridAreUsed) {
  for (const TestMesh& mesh : {isosurface(40, blob), isosurface(33, blobs)}) {
    for (const uint8_t bits : {uint8_t{12}, uint8_t{14}, uint8_t{17}}) {
      SCOPED_TRACE(mesh.name + ", bits " + std::to_string(bits));
      const RoundTrip on_grid = roundTrip(MeshPiece(mesh, {bits, 0, 0}).view());
      ASSERT_EQ(on_grid.failure, "");
      EXPECT_TRUE(hasPlanes(on_grid.encoded));
      const RoundTrip off_grid = roundTrip(MeshPiece(turned(mesh), {bits, 0, 0}).view());
      ASSERT_EQ(off_grid.failure, "");
      EXPECT_FALSE(hasPlanes(off_grid.encoded));
      EXPECT_LT(on_grid.encoded.sizes.position_bits, 0.5 * off_grid.encoded.sizes.position_bits);
    }
  }
}

TEST(Isosurface, CellsMayHaveThreeSizes) {
  TestMesh mesh = isosurface(36, blob);
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    mesh.positions[size_t{3} * v + 1] *= 0.7f;
    mesh.positions[size_t{3} * v + 2] *= 1.9f;
  }
  const RoundTrip result = roundTrip(MeshPiece(mesh, {14, 0, 0}).view());
  EXPECT_EQ(result.failure, "");
  EXPECT_TRUE(hasPlanes(result.encoded));
}

TEST(Isosurface, ExactPositionsHaveNoPlanes) {
  const TestMesh mesh = isosurface(20, blob);
  for (const uint8_t bits : {uint8_t{0}, uint8_t{18}, uint8_t{24}}) {
    const RoundTrip result = roundTrip(MeshPiece(mesh, {bits, 0, 0}).view());
    EXPECT_EQ(result.failure, "");
    EXPECT_FALSE(hasPlanes(result.encoded));
  }
}

}  // namespace
}  // namespace mcc::test
