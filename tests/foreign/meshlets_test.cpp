// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include "foreign/meshlets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/gltf_builder.h"

namespace mcc::foreign {
namespace {

using Triangle = std::array<uint32_t, 3>;

/// Returns the triangles of meshlets in the numbers of the mesh, each with its lowest corner first.
std::vector<Triangle> trianglesOf(const simple::Meshlets& meshlets) {
  std::vector<Triangle> triangles;
  for (const Meshlet& meshlet : meshlets.meshlets) {
    for (uint32_t t = 0; t < meshlet.triangle_count; ++t) {
      Triangle triangle;
      for (uint32_t k = 0; k < 3; ++k) {
        const uint8_t local = meshlets.triangles[meshlet.triangle_offset + 3 * t + k];
        triangle[k] = meshlets.vertices[meshlet.vertex_offset + local];
      }
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                  triangle.end());
      triangles.push_back(triangle);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TEST(MeshoptMeshlets, HaveTheTrianglesOfTheMesh) {
  const gltf::test::Sheet sheet(60);
  const std::vector<uint32_t> indices(sheet.indices.begin(), sheet.indices.end());
  const MeshletMesh mesh{indices, sheet.positions};
  simple::Meshlets theirs;
  ASSERT_TRUE(buildMeshoptMeshlets(mesh, theirs).ok());
  simple::Meshlets ours;
  ASSERT_TRUE(
      simple::buildMeshlets(indices, static_cast<uint32_t>(sheet.positions.size() / 3), ours).ok());
  EXPECT_EQ(trianglesOf(theirs), trianglesOf(ours));
  MeshletFigures figures;
  addMeshletFigures(mesh, theirs, figures);
  EXPECT_EQ(figures.triangle_count, indices.size() / 3);
  EXPECT_EQ(figures.meshlet_count, theirs.meshlets.size());
  EXPECT_GT(figures.vertex_count, sheet.positions.size() / 3) << "those on borders count twice";
}

TEST(MeshoptMeshlets, FiguresOfFlatTrianglesAreKnown) {
  const std::vector<float> positions = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};
  const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
  const MeshletMesh mesh{indices, positions};
  simple::Meshlets meshlets;
  ASSERT_TRUE(buildMeshoptMeshlets(mesh, meshlets).ok());
  MeshletFigures figures;
  addMeshletFigures(mesh, meshlets, figures);
  addMeshletFigures(mesh, meshlets, figures);
  EXPECT_EQ(figures.meshlet_count, 2u);
  EXPECT_EQ(figures.vertex_count, 8u);
  EXPECT_EQ(figures.triangle_count, 4u);
  EXPECT_NEAR(figures.radii, 2 * std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(figures.cones, 2, 1e-5);
}

TEST(MeshoptMeshlets, RefuseAnIndexThatIsNoVertex) {
  const std::vector<float> positions(9);
  const std::vector<uint32_t> indices = {0, 1, 3};
  simple::Meshlets meshlets;
  EXPECT_FALSE(buildMeshoptMeshlets({indices, positions}, meshlets).ok());
}

}  // namespace
}  // namespace mcc::foreign

#endif  // MCC_HAS_FOREIGN
