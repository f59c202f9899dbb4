// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks what the generators promise, because other tests rely on it.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

void expectClosed(const TestMesh& mesh, uint32_t genus) {
  SCOPED_TRACE(mesh.name);
  const MeshTopology topology = measureTopology(mesh);
  EXPECT_TRUE(topology.manifold());
  EXPECT_TRUE(topology.orientable);
  EXPECT_EQ(topology.inconsistent_edges, 0u);
  EXPECT_EQ(topology.duplicate_triangles, 0u);
  EXPECT_EQ(topology.boundary_loops, 0u);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.genus, genus);
  EXPECT_EQ(topology.unused_vertices, 0u);
  EXPECT_TRUE(positionsDiffer(mesh));
}

void expectSheet(const TestMesh& mesh, uint32_t loops) {
  SCOPED_TRACE(mesh.name);
  const MeshTopology topology = measureTopology(mesh);
  EXPECT_TRUE(topology.manifold());
  EXPECT_EQ(topology.inconsistent_edges, 0u);
  EXPECT_EQ(topology.boundary_loops, loops);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.genus, 0u);
  EXPECT_TRUE(positionsDiffer(mesh));
}

double signedVolume(const TestMesh& mesh) {
  double volume = 0;
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    const auto at = [&](size_t corner, size_t axis) {
      return static_cast<double>(mesh.positions[size_t{mesh.indices[t + corner]} * 3 + axis]);
    };
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t j = (axis + 1) % 3;
      const size_t k = (axis + 2) % 3;
      volume += at(0, axis) * (at(1, j) * at(2, k) - at(1, k) * at(2, j)) / 6;
    }
  }
  return volume;
}

/// Hash of all arrays: a change of a generator changes it.
uint64_t fingerprint(const TestMesh& mesh) {
  uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](const auto& values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (size_t i = 0; i < values.size() * sizeof(values[0]); ++i)
      hash = (hash ^ bytes[i]) * 0x100000001b3u;
  };
  add(mesh.positions);
  add(mesh.indices);
  add(mesh.normals);
  add(mesh.texcoords);
  return hash;
}

TEST(Generators, RandomIsSplitMix64) {
  Random random(1234567);  // first values of the published reference implementation
  EXPECT_EQ(random.next(), 6457827717110365317u);
  EXPECT_EQ(random.next(), 3203168211198807973u);
  Random bounded(5);
  std::set<uint32_t> seen;
  for (int i = 0; i < 200; ++i) seen.insert(bounded.between(3, 9));
  EXPECT_EQ(seen, (std::set<uint32_t>{3, 4, 5, 6, 7, 8, 9}));
}

TEST(Generators, TurnIsCosineAndSine) {
  for (int i = -100; i <= 300; ++i) {
    const double turns = i / 97.0;
    EXPECT_NEAR(turn(turns).cos, std::cos(turns * 6.283185307179586), 1e-14);
    EXPECT_NEAR(turn(turns).sin, std::sin(turns * 6.283185307179586), 1e-14);
  }
}

TEST(Generators, ClosedSurfacesHaveTheirGenus) {
  expectClosed(tetrahedron(), 0);
  for (uint32_t level = 0; level <= 3; ++level) {
    const TestMesh sphere = icosphere(level);
    expectClosed(sphere, 0);
    EXPECT_EQ(sphere.triangleCount(), 20u << (2 * level));
  }
  expectClosed(uvSphere(3, 2), 0);
  expectClosed(uvSphere(24, 13), 0);
  expectClosed(torus(3, 3), 1);
  expectClosed(torus(20, 11), 1);
  for (uint32_t genus = 0; genus <= 5; ++genus) {
    for (uint32_t fineness = 1; fineness <= 4; ++fineness) {
      expectClosed(plateWithTunnels(genus, fineness), genus);
    }
  }
  expectClosed(bipyramid(3), 0);
  expectClosed(bipyramid(100), 0);
  expectClosed(deepStack(500), 0);
  expectClosed(randomStacked(1, 500), 0);
  expectClosed(combOfStacks(9, 30), 0);
  expectClosed(mengerSponge(1), 5);
  expectClosed(mengerSponge(2), 81);
  expectClosed(flipped(icosphere(3), 1, 5000), 0);
  expectClosed(shuffled(flipped(subdivided(torus(8, 5), 2), 2, 100), 3), 1);
}

TEST(Generators, ClosedSurfacesFaceOutwards) {
  for (const TestMesh& mesh :
       {tetrahedron(), icosphere(0), icosphere(2), uvSphere(9, 7), torus(9, 8), bipyramid(7),
        plateWithTunnels(2, 2), mengerSponge(1), shuffled(uvSphere(5, 4), 1)}) {
    EXPECT_GT(signedVolume(mesh), 0) << mesh.name;
  }
}

TEST(Generators, BigStarsAndStacksAreWhatTheySay) {
  EXPECT_EQ(measureTopology(bipyramid(100000)).max_degree, 100000u);
  EXPECT_EQ(measureTopology(openFan(100000)).max_degree, 100000u);
  expectSheet(openFan(100000), 1);
  const TestMesh stack = deepStack(100000);
  EXPECT_EQ(stack.vertexCount(), 100004u);
  expectClosed(stack, 0);
}

TEST(Generators, SheetsHaveTheirHoles) {
  for (const QuadSplit split :
       {QuadSplit::kSame, QuadSplit::kAlternate, QuadSplit::kRows, QuadSplit::kRandom}) {
    expectSheet(grid(9, 6, split, 1), 1);
  }
  for (uint32_t holes = 0; holes <= 20; ++holes)
    expectSheet(sheetWithHoles(holes, holes), holes + 1);
  const MeshTopology loose = measureTopology(looseTriangles(30));
  EXPECT_EQ(loose.components, 30u);
  EXPECT_EQ(loose.boundary_loops, 30u);
}

TEST(Generators, GeneratedHasGenusHolesAndComponents) {
  Random random(7);
  for (uint64_t seed = 0; seed < 150; ++seed) {
    const uint32_t genus = random.below(6);
    const uint32_t holes = random.below(21);
    const uint32_t components = random.chance(70) ? random.between(1, 12) : random.between(1, 500);
    const TestMesh mesh = generated(seed, genus, holes, components);
    SCOPED_TRACE(mesh.name);
    const MeshTopology topology = measureTopology(mesh);
    EXPECT_TRUE(topology.manifold());
    EXPECT_EQ(topology.inconsistent_edges, 0u);
    EXPECT_EQ(topology.genus, genus);
    EXPECT_EQ(topology.boundary_loops, holes);
    EXPECT_EQ(topology.components, components);
    EXPECT_EQ(topology.unused_vertices, 0u);
    EXPECT_TRUE(positionsDiffer(mesh));
  }
}

TEST(Generators, OneSidedSurfacesAreNotOrientable) {
  for (const TestMesh& mesh : {moebius(3, 1), moebius(30, 5)}) {
    const MeshTopology topology = measureTopology(mesh);
    EXPECT_TRUE(topology.manifold()) << mesh.name;
    EXPECT_FALSE(topology.orientable) << mesh.name;
    EXPECT_EQ(topology.boundary_loops, 1u) << mesh.name;
    EXPECT_GT(topology.inconsistent_edges, 0u) << mesh.name;
  }
  for (const TestMesh& mesh : {kleinBottle(4, 4), kleinBottle(20, 9), kleinBottle(12, 8)}) {
    const MeshTopology topology = measureTopology(mesh);
    EXPECT_TRUE(topology.manifold()) << mesh.name;
    EXPECT_FALSE(topology.orientable) << mesh.name;
    EXPECT_EQ(topology.boundary_loops, 0u) << mesh.name;
    EXPECT_TRUE(positionsDiffer(mesh)) << mesh.name;
  }
}

TEST(Generators, NonManifoldOnesAreNot) {
  EXPECT_EQ(measureTopology(bowTies(6, 3, 4)).non_manifold_vertices, 6u);
  EXPECT_EQ(measureTopology(bowTies(6, 3, 4)).components, 6u);
  EXPECT_EQ(measureTopology(pinchedSpheres(5)).non_manifold_vertices, 4u);
  EXPECT_EQ(measureTopology(pinchedSpheres(5)).components, 1u);
  EXPECT_EQ(measureTopology(book(5, 7, 2)).crowded_edges, 7u);
  EXPECT_EQ(measureTopology(fins(9)).crowded_edges, 4u * 9u);
  EXPECT_GT(measureTopology(randomVoxels(1, 6, 50)).crowded_edges, 20u);
  EXPECT_GT(measureTopology(tetrahedralSoup(3)).duplicate_triangles, 100u);
  EXPECT_GT(measureTopology(tetrahedralSoup(3)).crowded_edges, 50u);
  EXPECT_TRUE(positionsDiffer(bowTies(6, 3, 4)));
  EXPECT_TRUE(positionsDiffer(book(5, 7, 2)));
  EXPECT_TRUE(positionsDiffer(pinchedSpheres(5)));
}

TEST(Generators, SoupsHaveEveryOddity) {
  const TestMesh mesh = soup(3, 400, 60, {10, 10, 10, 20});
  const MeshTopology topology = measureTopology(mesh);
  EXPECT_EQ(mesh.triangleCount(), 400u);
  EXPECT_EQ(mesh.vertexCount(), 60u);
  EXPECT_GT(topology.degenerate_triangles, 10u);
  EXPECT_GT(topology.duplicate_triangles, 30u);
  EXPECT_FALSE(positionsDiffer(mesh));
  const MeshTopology sparse = measureTopology(soup(4, 10, 200, {}));
  EXPECT_GT(sparse.unused_vertices, 100u);
  EXPECT_EQ(sparse.degenerate_triangles, 0u);
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const TestMesh random = randomSoup(seed);
    EXPECT_GE(random.triangleCount(), 3u);
    EXPECT_LE(random.triangleCount(), 3000u);
    EXPECT_GE(random.vertexCount(), 3u);
    EXPECT_LE(random.vertexCount(), 300u);
    for (const uint32_t v : random.indices) ASSERT_LT(v, random.vertexCount());
  }
}

TEST(Generators, ChangesDoWhatTheySay) {
  const TestMesh sphere = uvSphere(9, 6);
  EXPECT_EQ(measureTopology(withIndexDuplicates(sphere, 1, 12)).duplicate_triangles, 12u);
  const TestMesh copies = withPositionDuplicates(sphere, 1, 12);
  EXPECT_EQ(measureTopology(copies).components, 13u);
  EXPECT_FALSE(positionsDiffer(copies));
  EXPECT_EQ(copies.normals.size(), copies.positions.size());
  EXPECT_EQ(measureTopology(withDegenerates(sphere, 1, 30)).degenerate_triangles, 30u);
  EXPECT_EQ(measureTopology(withUnused(sphere, 1, 8)).unused_vertices, 8u);
  EXPECT_GT(measureTopology(withFlippedTriangles(sphere, 1, 30)).inconsistent_edges, 5u);
  EXPECT_EQ(measureTopology(doubled(sphere)).components, 2u);
  EXPECT_FALSE(positionsDiffer(doubled(sphere)));
  TestMesh punched = sphere;
  EXPECT_EQ(punchHoles(punched, 1, 3), 3u);
  EXPECT_EQ(measureTopology(punched).boundary_loops, 3u);
}

TEST(Generators, FlippingChangesTheDegrees) {
  const TestMesh regular = torus(30, 20);
  EXPECT_EQ(measureTopology(regular).max_degree, 6u);
  EXPECT_GT(measureTopology(flipped(regular, 1, 2000)).max_degree, 9u);
}

TEST(Generators, SeamsSplitVertices) {
  const TestMesh charts = chartGrid(12, 8, 4);
  EXPECT_EQ(measureTopology(charts).components, 6u);
  EXPECT_EQ(charts.vertexCount(), 6u * 25u);
  EXPECT_EQ(charts.texcoords.size(), charts.vertexCount() * size_t{2});
  const TestMesh random = withRandomWedges(icosphere(2), 1, 3);
  EXPECT_GT(random.vertexCount(), 2 * icosphere(2).vertexCount());
  EXPECT_EQ(random.texcoords.size(), random.vertexCount() * size_t{2});
  EXPECT_EQ(measureTopology(random).unused_vertices, 0u);
  const TestMesh equal = withEqualTuples(torus(9, 7), 1);
  EXPECT_GT(equal.vertexCount(), 63u);
  EXPECT_FALSE(positionsDiffer(equal));
  EXPECT_EQ(flatShaded(icosphere(1)).vertexCount(), 240u);
}

TEST(Generators, SameArgumentsSameBits) {
  const std::vector<TestMesh> first = smallZoo();
  const std::vector<TestMesh> second = smallZoo();
  std::set<std::string> names;
  uint64_t all = 0;
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(fingerprint(first[i]), fingerprint(second[i])) << first[i].name;
    all = all * 31 + fingerprint(first[i]);
    names.insert(first[i].name);
    for (const uint32_t v : first[i].indices) ASSERT_LT(v, first[i].vertexCount()) << first[i].name;
  }
  EXPECT_EQ(names.size(), first.size()) << "two meshes of one name";
  // The hash is the same for every compiler and platform. After an intended change of the zoo, put
  // the new number here.
  EXPECT_EQ(all, 278442443620685855u);
}

}  // namespace
}  // namespace mcc::test
