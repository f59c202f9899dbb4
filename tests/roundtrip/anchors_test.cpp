// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Components that repeat others: anchors are found and save bytes, and what is coded comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "container/payload_header.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "support/mirrored.h"
#include "support/repeated.h"

namespace mcc::test {
namespace {

TestMesh part(uint32_t seed) { return jittered(torus(9, 7), seed, 0.05f); }

bool hasAnchors(const EncodeResult& result) {
  PayloadHeader header{Allocator{}};
  EXPECT_TRUE(parsePayload(result.payload, Limits{}, header).ok());
  const bool any =
      std::any_of(header.pieces.data(), header.pieces.data() + header.pieces.size(),
                  [](const PieceHeader& piece) { return piece.has(piece_flag::kAnchors); });
  EXPECT_GE(header.version_minor, any ? 1 : 0);
  return any;
}

StreamSizes sizesOf(const PieceView& view, bool with_anchors) {
  const FeatureSet none = without({Feature::kMirrors, Feature::kMemory}).without;
  EncodeSettings settings;
  settings.without = none;
  if (!with_anchors) settings.without.add(Feature::kAnchors);
  const RoundTrip result = roundTrip(view, settings);
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(hasAnchors(result.encoded), with_anchors);
  return result.encoded.sizes;
}

/// All 48 turns, alone and mixed.
TEST(Anchors, CopiesAreFoundHoweverTheyAreTurned) {
  for (Turn turn = 0; turn < kTurnCount; ++turn) {
    const TestMesh mesh = repeated(part(1), 1, turn);
    SCOPED_TRACE(mesh.name);
    const MeshPiece piece(mesh, {14, 0, 0});
    EXPECT_LT(sizesOf(piece.view(), true).position_bits,
              0.75 * sizesOf(piece.view(), false).position_bits);
  }
  const TestMesh mesh = repeated(part(2), 12, 5);
  const MeshPiece piece(mesh, {14, 0, 0});
  EXPECT_LT(sizesOf(piece.view(), true).position_bits,
            0.4 * sizesOf(piece.view(), false).position_bits);
}

TEST(Anchors, TrianglesMayDifferAndVerticesBeNear) {
  const TestMesh mesh = repeated(part(3), 5, 11);
  const TestMesh other = shuffled(flipped(mesh, 1, 40), 3);
  const MeshPiece piece(other, {14, 0, 0});
  EXPECT_LT(sizesOf(piece.view(), true).position_bits,
            0.8 * sizesOf(piece.view(), false).position_bits);
  const TestMesh noisy = withNoise(mesh, 14);
  const MeshPiece near(noisy, {14, 0, 0});
  EXPECT_LT(sizesOf(near.view(), true).position_bits,
            0.9 * sizesOf(near.view(), false).position_bits);
}

/// Normals are turned with their component, texture coordinates are those of the other.
TEST(Anchors, AttributesAreThoseOfMates) {
  TestMesh one = withNormals(part(4));
  Random random(1);
  one.texcoords.clear();
  for (uint32_t i = 0; i < 2 * one.vertexCount(); ++i) one.texcoords.push_back(random.unit());
  for (const Turn step : {Turn{0}, Turn{7}, Turn{29}}) {
    const TestMesh mesh = repeated(one, 6, step);
    const MeshPiece piece(mesh, {14, 10, 12});
    const StreamSizes with = sizesOf(piece.view(), true);
    const StreamSizes without = sizesOf(piece.view(), false);
    EXPECT_LT(with.attribute_bits.at(1), 0.5 * without.attribute_bits.at(1)) << step;
    EXPECT_LT(with.attribute_bits.at(2), 0.5 * without.attribute_bits.at(2)) << step;
  }
}

TEST(Anchors, NothingIsNamedWhereNothingRepeats) {
  const TestMesh one = repeated(part(1), 3, 0);
  for (const TestMesh& mesh : {part(1), jittered(one, 2, 0.1f)})
    sizesOf(MeshPiece(mesh, {14, 0, 0}).view(), false);
}

/// Random choices: anchors that were found and others, with all codings and predictors.
TEST(Anchors, ComeBackWithEveryChoice) {
  const TestMesh meshes[] = {
      repeated(part(1), 4, 3),
      mirrored(translated(repeated(part(2), 2, 1), 4, 1, 2), 0),
      repeated(icosphere(1), 5, 0),
      repeated(book(4, 3, 2), 2, 9),
      repeated(bowTies(4, 3, 2), 3, 2),
      repeated(pinchedSpheres(2), 2, 13),
      repeated(openFan(30), 3, 6),
      withUnused(repeated(part(3), 2, 2), 3, 9),
      withRandomWedges(repeated(withNormals(part(5)), 3, 8), 20, 4),
      repeated(tetrahedralSoup(3), 2, 4),
      tetrahedralSoup(5),
      randomSoup(11),
  };
  uint32_t with_anchors = 0;
  for (const TestMesh& mesh : meshes) {
    for (const uint8_t bits : {uint8_t{0}, uint8_t{1}, uint8_t{10}, uint8_t{24}}) {
      const MeshPiece piece(mesh, {bits, 6, 6});
      for (uint64_t seed = 0; seed <= 8; ++seed) {
        EncodeSettings settings;
        settings.variation = seed;
        const RoundTrip result = roundTrip(piece.view(), settings);
        ASSERT_EQ(result.failure, "") << mesh.name << ", bits " << int{bits} << ", seed " << seed;
        with_anchors += hasAnchors(result.encoded) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(with_anchors, std::size(meshes) * 4 * 2);
}

TEST(Anchors, BlocksHaveNone) {
  const TestMesh mesh = repeated(jittered(torus(60, 40), 1, 0.02f), 2, 0);
  EncodeSettings settings;
  settings.block_triangles = 4096;
  const RoundTrip result = roundTrip(MeshPiece(mesh).view(), settings);
  EXPECT_EQ(result.failure, "");
  EXPECT_FALSE(hasAnchors(result.encoded));
}

}  // namespace
}  // namespace mcc::test
