// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Surfaces with equal halves: their mirrors are found and save bytes, and what is coded comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "container/payload_header.h"
#include "format/predictors.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "support/mirrored.h"

namespace mcc::test {
namespace {

constexpr uint32_t kMeshSeeds = 3;

TestMesh sheet(uint32_t seed) { return halfSheet(14, 11, seed); }
TestMesh noisy(TestMesh mesh) { return withNoise(std::move(mesh), 14); }

bool hasMirrors(const EncodeResult& result) {
  PayloadHeader header{Allocator{}};
  EXPECT_TRUE(parsePayload(result.payload, Limits{}, header).ok());
  const bool any =
      std::any_of(header.pieces.data(), header.pieces.data() + header.pieces.size(),
                  [](const PieceHeader& piece) { return piece.has(piece_flag::kMirrors); });
  EXPECT_GE(header.version_minor, any ? 1 : 0);
  return any;
}

double positionBits(const PieceView& view, bool with_mirrors) {
  const RoundTrip result =
      roundTrip(view, with_mirrors ? EncodeSettings{} : without({Feature::kMirrors}));
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(hasMirrors(result.encoded), with_mirrors);
  return result.encoded.sizes.position_bits;
}

TEST(Mirrors, HalvesAreFoundAndSaveBytes) {
  for (uint32_t seed = 0; seed < kMeshSeeds; ++seed) {
    TestMesh one = mirrored(sheet(seed), seed % 2);
    const TestMesh two = mirrored(one, 1 - seed % 2);
    const TestMesh three = mirrored(two, 2);
    for (const auto& [mesh, share] : {std::pair{one, 0.75}, {two, 0.55}, {three, 0.45}}) {
      SCOPED_TRACE(mesh.name);
      for (const uint8_t bits : {uint8_t{12}, uint8_t{16}}) {
        const MeshPiece piece(mesh, {bits, 0, 0});
        EXPECT_LT(positionBits(piece.view(), true), share * positionBits(piece.view(), false));
      }
    }
  }
}

TEST(Mirrors, WithNoiseAndOtherTriangles) {
  for (uint32_t seed = 0; seed < kMeshSeeds; ++seed) {
    const TestMesh mesh = mirrored(sheet(seed), 0);
    const TestMesh with_noise = noisy(mesh);
    const MeshPiece near(with_noise, {14, 0, 0});
    EXPECT_LT(positionBits(near.view(), true), 0.9 * positionBits(near.view(), false));
    const TestMesh other_triangles = shuffled(flipped(mesh, seed, 60), 3);
    const MeshPiece other(other_triangles, {14, 0, 0});
    EXPECT_LT(positionBits(other.view(), true), 0.8 * positionBits(other.view(), false));
  }
}

TEST(Mirrors, NothingIsMirroredWhereNothingIsEqual) {
  for (const TestMesh& mesh : {jittered(torus(30, 20), 1, 0.02f), sheet(4)}) {
    const RoundTrip result = roundTrip(MeshPiece(mesh, {14, 0, 0}).view());
    EXPECT_EQ(result.failure, "");
    EXPECT_FALSE(hasMirrors(result.encoded)) << mesh.name;
  }
}

/// Surfaces of all kinds with halves that are joined, disconnected, doubled and not manifold.
std::vector<TestMesh> surfaces() {
  std::vector<TestMesh> all = {
      mirrored(sheet(1), 0),
      noisy(mirrored(mirrored(sheet(2), 1), 0)),
      mirrored(translated(jittered(torus(9, 7), 1, 0.05f), 4, 1, 2), 0),  // apart
      mirrored(sheetWithHoles(4, 1), 1),
      mirrored(generated(5, 4, 6, 7), 2),
      doubled(mirrored(sheet(3), 0)),
      mirrored(book(4, 3, 2), 0),
      mirrored(fins(7), 1),
      mirrored(randomVoxels(3, 5, 50), 0),
      mirrored(pinchedSpheres(3), 0),
      mirrored(openFan(50), 0),
      withUnused(mirrored(sheet(1), 0), 3, 9),
      withPositionDuplicates(mirrored(sheet(5), 0), 5, 9),
      mirrored(tetrahedralSoup(3), 1),
      withRandomWedges(mirrored(book(3, 4, 3), 0), 4, 3),
      mirrored(randomSoup(11), 2),
      mirrored(icosphere(2), 0),
      icosphere(2),
      mengerSponge(1),
  };
  return all;
}

/// Random choices: mirrors that were found and others, with all codings and predictors.
TEST(Mirrors, ComeBackWithEveryChoice) {
  uint32_t with_mirrors = 0;
  for (const TestMesh& mesh : surfaces()) {
    for (const uint8_t bits : {uint8_t{0}, uint8_t{1}, uint8_t{10}, uint8_t{14}, uint8_t{24}}) {
      const MeshPiece piece(mesh, {bits, 0, 0});
      for (uint64_t seed = 0; seed <= 8; ++seed) {
        EncodeSettings settings;
        settings.variation = seed;
        const RoundTrip result = roundTrip(piece.view(), settings);
        ASSERT_EQ(result.failure, "") << mesh.name << ", bits " << int{bits} << ", seed " << seed;
        with_mirrors += hasMirrors(result.encoded) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(with_mirrors, surfaces().size() * 5 * 2);
}

/// Positions that are integers, exact floats, and exact floats on a grid with a fine part.
TEST(Mirrors, OfExactPositions) {
  const TestMesh mesh = mirrored(mirrored(sheet(2), 0), 1);
  AttributeFormat integers;
  integers.component_type = ComponentType::kInt16;
  integers.component_count = 3;
  std::vector<int16_t> truth;
  TestMesh thousandths = mesh;
  TestMesh full = mesh;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const float x = mesh.positions[i];
    truth.push_back(static_cast<int16_t>(x * 3000));
    thousandths.positions[i] = static_cast<float>(static_cast<int32_t>(x * 1000)) / 1000.0f;
    full.positions[i] = x * 1.2345678f;
  }
  MeshPiece piece(mesh, kExactBits);
  piece.setPositions(integers, truth.data());
  EXPECT_LT(positionBits(piece.view(), true), 0.6 * positionBits(piece.view(), false));
  for (const TestMesh& exact : {thousandths, full}) {
    const RoundTrip result = roundTrip(MeshPiece(exact, kExactBits).view());
    EXPECT_EQ(result.failure, "");
  }
}

TEST(Mirrors, EachPieceHasItsOwn) {
  const TestMesh meshes[] = {mirrored(sheet(1), 0), sheet(2), mirrored(sheet(3), 1)};
  std::vector<std::unique_ptr<MeshPiece>> pieces;
  std::vector<PieceView> views;
  for (const TestMesh& mesh : meshes) {
    pieces.push_back(std::make_unique<MeshPiece>(mesh));
    views.push_back(pieces.back()->view());
  }
  const RoundTrip result = roundTrip(views);
  EXPECT_EQ(result.failure, "");
  PayloadHeader header{Allocator{}};
  ASSERT_TRUE(parsePayload(result.encoded.payload, Limits{}, header).ok());
  EXPECT_TRUE(header.pieces[0].has(piece_flag::kMirrors));
  EXPECT_FALSE(header.pieces[1].has(piece_flag::kMirrors));
  EXPECT_TRUE(header.pieces[2].has(piece_flag::kMirrors));
}

TEST(Mirrors, BlocksHaveNone) {
  const TestMesh mesh = mirrored(mirrored(jittered(grid(60, 60), 1, 0.02f), 0), 1);
  for (const uint64_t seed : {0, 1, 2}) {
    EncodeSettings settings;
    settings.block_triangles = 4096;
    settings.variation = seed;
    const RoundTrip result = roundTrip(MeshPiece(mesh).view(), settings);
    EXPECT_EQ(result.failure, "");
    EXPECT_FALSE(hasMirrors(result.encoded));
  }
}

}  // namespace
}  // namespace mcc::test
