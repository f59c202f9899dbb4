// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Normals and texture coordinates of mirrored halves: those of mates save bytes, and what is coded
// comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "container/payload_header.h"
#include "format/predictors.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "support/mirrored.h"
#include "vectors/normals.h"

namespace mcc::test {
namespace {

/// A mesh, mirrored, whose half has normals and texture coordinates that nothing predicts. Those of
/// the other half are mirrored, or the same.
TestMesh withRandomValues(TestMesh half, uint32_t axis) {
  Random random(half.vertexCount());
  const uint32_t count = half.vertexCount();
  TestMesh mesh = mirrored(std::move(half), axis);
  for (uint32_t v = 0; v < count; ++v) {
    std::array<float, 3> n = {random.unit() - 0.5f, random.unit() - 0.5f, 0.7f};
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (const float x : n) mesh.normals.push_back(x / length);
    for (int c = 0; c < 2; ++c) mesh.texcoords.push_back(random.unit());
  }
  for (uint32_t v = 0; v < count; ++v) {
    if (mesh.positions[3 * v + axis] == 0) continue;
    for (uint32_t s = 0; s < 3; ++s)
      mesh.normals.push_back((s == axis ? -1.0f : 1.0f) * mesh.normals[3 * v + s]);
    for (uint32_t c = 0; c < 2; ++c) mesh.texcoords.push_back(mesh.texcoords[2 * v + c]);
  }
  return mesh;
}

bool asksMates(const EncodeResult& result) {
  PayloadHeader header{Allocator{}};
  EXPECT_TRUE(parsePayload(result.payload, Limits{}, header).ok());
  bool asks = false;
  for (size_t p = 0; p < header.pieces.size(); ++p) {
    const AttributeInfos infos = header.attributesOf(header.pieces[p]);
    for (uint32_t i = 1; i < infos.size(); ++i)
      asks |= mcc::asksMates(methodOf(infos, i), infos[i].predictor);
  }
  EXPECT_GE(header.version_minor, asks ? 1 : 0);
  return asks;
}

std::vector<double> attributeBits(const PieceView& view, bool with_mates) {
  // The memory would find the same charts by their triangles.
  const EncodeSettings with = without({Feature::kMemory});
  const RoundTrip result =
      roundTrip(view, with_mates ? with : without({Feature::kMemory, Feature::kMates}));
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(asksMates(result.encoded), with_mates);
  return result.encoded.sizes.attribute_bits;
}

TEST(Mates, HalvesShareTheirValues) {
  for (uint32_t axis = 0; axis < 3; ++axis) {
    TestMesh half = halfSheet(14, 11, axis);
    if (axis == 2) {  // its border is on x = 0 and y = 0
      for (size_t i = 0; i < half.positions.size(); i += 3)
        std::swap(half.positions[i], half.positions[i + 2]);
    }
    const TestMesh mesh = withRandomValues(half, axis);
    const MeshPiece piece(mesh, {14, 10, 12});
    const std::vector<double> with = attributeBits(piece.view(), true);
    const std::vector<double> without = attributeBits(piece.view(), false);
    EXPECT_LT(with.at(1), 0.65 * without.at(1)) << axis;
    EXPECT_LT(with.at(2), 0.65 * without.at(2)) << axis;
  }
}

/// Vertices of several wedges: the normals of both halves' wedges are equal, and any of the mates'
/// may have the value.
TEST(Mates, WedgesOfMatesAreCandidates) {
  const TestMesh mesh = withRandomWedges(withRandomValues(halfSheet(14, 11, 3), 0), 30, 5);
  const MeshPiece piece(mesh, {14, 10, 12});
  const std::vector<double> with = attributeBits(piece.view(), true);
  const std::vector<double> without = attributeBits(piece.view(), false);
  EXPECT_LT(with.at(1), 0.8 * without.at(1));
}

TEST(Mates, NothingIsAskedWhereNothingIsEqual) {
  TestMesh mesh = withRandomValues(halfSheet(14, 11, 1), 0);
  Random random(7);
  for (float& x : mesh.texcoords) x = random.unit();
  for (size_t i = 0; i < mesh.normals.size(); i += 3) {
    const float angle = 6.0f * random.unit();
    mesh.normals[i] = std::sin(angle);
    mesh.normals[i + 1] = std::cos(angle);
    mesh.normals[i + 2] = 0;
  }
  attributeBits(MeshPiece(mesh, {14, 10, 12}).view(), false);
}

/// Random choices, with mirrors and without, of surfaces that are cut, closed, doubled and crowded.
TEST(Mates, ComeBackWithEveryChoice) {
  const TestMesh meshes[] = {
      withRandomValues(halfSheet(9, 7, 1), 0),
      withRandomWedges(withRandomValues(halfSheet(9, 7, 2), 1), 20, 4),
      withRandomWedges(withRandomValues(openFan(30), 2), 60, 4),
      withUnused(withRandomValues(halfSheet(7, 5, 3), 0), 3, 9),
      withRandomValues(book(4, 3, 2), 1),
      withNormals(icosphere(2)),
  };
  uint32_t asks = 0;
  for (const TestMesh& mesh : meshes) {
    for (const uint8_t bits : {uint8_t{0}, uint8_t{3}, uint8_t{9}}) {
      const MeshPiece piece(mesh, {14, bits, bits});
      for (uint64_t seed = 0; seed <= 12; ++seed) {
        EncodeSettings settings;
        settings.variation = seed;
        if (seed % 4 == 3) settings.without.add(Feature::kMirrors);
        const RoundTrip result = roundTrip(piece.view(), settings);
        ASSERT_EQ(result.failure, "") << mesh.name << ", bits " << int{bits} << ", seed " << seed;
        asks += asksMates(result.encoded) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(asks, 60u);
}

/// Every point of a grid: its image stands for the turned direction and is one that writers use.
TEST(Mates, ImagesOfGridPoints) {
  for (const uint8_t bits : {uint8_t{2}, uint8_t{3}, uint8_t{6}}) {
    const int32_t centre = octahedralCentre(bits);
    for (int32_t i = 0; i < (2 * centre + 1) * (2 * centre + 1); ++i) {
      const int32_t point[2] = {i % (2 * centre + 1), i / (2 * centre + 1)};
      for (Turn turn = 0; turn < kTurnCount; ++turn) {
        int32_t image[2];
        turnGridPoint(centre, turn, point, image);
        int32_t same[2] = {image[0], image[1]};
        canonicalGridPoint(centre, same);
        EXPECT_TRUE(std::equal(same, same + 2, image));
        float from[3];
        float to[3];
        octahedralToUnit(point[0], point[1], centre, from);
        octahedralToUnit(image[0], image[1], centre, to);
        for (uint32_t s = 0; s < 3; ++s) {
          const float x = from[kAxisOrder[turn >> 3][s]];
          EXPECT_NEAR((turn >> s & 1) != 0 ? -x : x, to[s], 1e-6f);
        }
      }
    }
  }
}

}  // namespace
}  // namespace mcc::test
