// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include "foreign/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/gltf_builder.h"

namespace mcc::foreign {
namespace {

constexpr uint64_t kWanted = 200;

std::vector<uint32_t> simplified(const std::vector<float>& positions,
                                 const std::vector<uint32_t>& triangles) {
  std::vector<uint32_t> result;
  EXPECT_TRUE(simplifyMesh({positions, triangles}, kWanted, result).ok());
  EXPECT_EQ(result.size() % 3, 0u);
  for (const uint32_t vertex : result) EXPECT_LT(vertex, positions.size() / 3);
  return result;
}

TEST(Simplify, HasAboutAsManyTrianglesAsAskedFor) {
  const gltf::test::Sheet sheet(60);
  const std::vector<uint32_t> triangles(sheet.indices.begin(), sheet.indices.end());
  const std::vector<uint32_t> result = simplified(sheet.positions, triangles);
  EXPECT_LE(result.size() / 3, kWanted);
  EXPECT_GE(result.size() / 3, kWanted * 9 / 10);
  EXPECT_EQ(result, simplified(sheet.positions, triangles)) << "not deterministic";
}

TEST(Simplify, FlatTrianglesHaveSeamsEverywhere) {
  const gltf::test::Sheet sheet(60);
  std::vector<float> positions;
  std::vector<uint32_t> triangles;
  for (const uint16_t vertex : sheet.indices) {
    triangles.push_back(static_cast<uint32_t>(positions.size() / 3));
    positions.insert(positions.end(), &sheet.positions[size_t{3} * vertex],
                     &sheet.positions[size_t{3} * vertex] + 3);
  }
  const std::vector<uint32_t> result = simplified(positions, triangles);
  EXPECT_LE(result.size() / 3, kWanted);
  EXPECT_GE(result.size() / 3, kWanted * 9 / 10);
}

}  // namespace
}  // namespace mcc::foreign

#endif
