// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Models that start trained.                                                               [A.3.9]
#include "reader/starts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "container/payload_header.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

size_t rowsOf(std::string_view seen) {
  return 1 + static_cast<size_t>(std::count(seen.begin(), seen.end(), ','));
}

bool startsTrained(const RoundTrip& result) {
  EXPECT_EQ(result.failure, "");
  PayloadHeader header{Allocator{}};
  EXPECT_TRUE(parsePayload(result.encoded.payload, Limits{}, header).ok());
  EXPECT_GE(header.version_minor, header.startsTrained() ? 1 : 0);
  return header.startsTrained();
}

/// No table has more than its models.
TEST(Starts, TablesFitTheirModels) {
  const auto models = std::make_unique<PayloadModels>();
  const SeamModels& seams = models->seams;
  EXPECT_LE(sizeof kRunStarts - 1, std::size(models->mc.run));
  EXPECT_LE(sizeof kGapStarts - 1, std::size(models->positions.tables.palettes.gap.length));
  EXPECT_LE(sizeof kHasSeamStarts - 1, sizeof seams.has_seam / sizeof(BitModel));
  EXPECT_LE(sizeof kSeamEdgeStarts - 1, sizeof seams.edge / sizeof(BitModel));
  EXPECT_LE(sizeof kEqualityStarts - 1, sizeof EqualityModels{}.previous / sizeof(BitModel));
  EXPECT_LE(rowsOf(kTexcoordStarts), 2 * kLengthContexts);
  EXPECT_LE(rowsOf(kNormalStarts), 2 * kLengthContexts);
}

TEST(Starts, LettersAreOutcomes) {
  BitModel models[5];
  showOutcomes(".adgi", models);
  BitModel expected[5];
  expected[1].update(false);
  for (int i = 0; i < 3; ++i) expected[2].update(true);
  expected[3].update(true);
  expected[3].update(false);
  expected[4].update(true);
  for (int i = 0; i < 3; ++i) expected[4].update(false);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(models[i].state(), expected[i].state()) << i;
}

/// A payload starts trained if that makes it smaller, as it does of most shapes.
TEST(Starts, SmallPayloadsAreSmaller) {
  uint32_t trained_count = 0;
  for (const TestMesh& surface :
       {grid(6, 5), grid(12, 9), torus(9, 7), icosphere(1), book(4, 3, 3)}) {
    const TestMesh mesh = withNormals(surface);
    const MeshPiece piece(mesh, {12, 8, 0});
    const RoundTrip with = roundTrip(piece.view(), EncodeSettings{});
    const RoundTrip untrained = roundTrip(piece.view(), without({Feature::kStarts}));
    EXPECT_FALSE(startsTrained(untrained));
    if (!startsTrained(with)) continue;
    ++trained_count;
    EXPECT_LT(with.encoded.payload.size(), untrained.encoded.payload.size());
  }
  EXPECT_GE(trained_count, 2u);
}

}  // namespace
}  // namespace mcc::test
