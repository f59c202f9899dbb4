// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Whatever the triangles are, the same ones come back, on the same wedges. The environment variable
// MCC_SOUPS sets the number of random soups.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>

#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

constexpr uint32_t kSoups = 300;
constexpr uint32_t kGenerated = 500;
constexpr uint32_t kGeneratedPerTest = 50;

/// How the positions go in.
enum class Positions : uint8_t { kLattice14, kLattice6, kExact, kInt16 };
constexpr std::array<Positions, 4> kAllPositions = {Positions::kLattice14, Positions::kLattice6,
                                                    Positions::kExact, Positions::kInt16};

/// Positions on a grid of 1/64; different floats may become one.
std::vector<int16_t> integerPositions(const TestMesh& mesh) {
  std::vector<int16_t> values;
  values.reserve(mesh.positions.size());
  for (const float x : mesh.positions) values.push_back(static_cast<int16_t>(std::floor(x * 64)));
  return values;
}

RoundTrip roundTripOf(const TestMesh& mesh, Positions positions, const EncodeSettings& options = {},
                      const TargetLayout& layout = {}) {
  MeshBits bits;
  if (positions == Positions::kLattice6) bits = {6, 6, 6};
  if (positions == Positions::kExact) bits = kExactBits;
  MeshPiece piece(mesh, bits);
  std::vector<int16_t> integers;
  if (positions == Positions::kInt16) {
    integers = integerPositions(mesh);
    AttributeFormat format;
    format.component_type = ComponentType::kInt16;
    piece.setPositions(format, integers.data());
  }
  RoundTrip result = roundTrip(piece.view(), options, layout);
  if (!result.failure.empty()) return result;
  const AttributeCoding coding = result.decoded[0].attributes[0].info.coding;
  const AttributeCoding expected = positions == Positions::kExact   ? AttributeCoding::kGrid
                                   : positions == Positions::kInt16 ? AttributeCoding::kInteger
                                                                    : AttributeCoding::kLattice;
  if (coding != expected)
    result.failure = "positions have coding " + std::to_string(static_cast<int>(coding));
  return result;
}

void expectExact(const TestMesh& mesh, Positions positions = Positions::kLattice14,
                 const EncodeSettings& options = {}) {
  EXPECT_EQ(roundTripOf(mesh, positions, options).failure, "")
      << mesh.name << ", positions " << static_cast<int>(positions);
}

// ---- Manifold meshes ----------------------------------------------------------------------------

/// Genus, holes and components of the sample: every component count once, every genus and every
/// number of holes many times, in all combinations of small and large.
class Generated : public testing::TestWithParam<uint32_t> {};

TEST_P(Generated, GenusHolesAndComponents) {
  for (uint32_t i = 0; i < kGeneratedPerTest; ++i) {
    const uint32_t number = GetParam() * kGeneratedPerTest + i;
    const uint32_t components = number * 7 % kGenerated + 1;  // 7 and 500 have no common factor
    const uint32_t genus = number % 6;
    const uint32_t holes = number / 6 % 21;
    const TestMesh mesh = generated(number, genus, holes, components);
    SCOPED_TRACE(mesh.name);
    const Positions positions = kAllPositions[number % kAllPositions.size()];
    EncodeOptions options;
    options.prefer = static_cast<Preference>(number / 4 % 3);
    const RoundTrip result = roundTripOf(mesh, positions, options);
    ASSERT_EQ(result.failure, "");
    if (positions == Positions::kInt16) continue;  // equal positions may join what was apart
    const PieceResult& piece = result.encoded.pieces[0];
    EXPECT_EQ(piece.component_count, components);
    EXPECT_EQ(piece.hole_count, holes);
    EXPECT_EQ(piece.topological_vertex_count, mesh.vertexCount());
    EXPECT_EQ(piece.cut_copy_count, 0u);
    EXPECT_EQ(piece.leftover_triangle_count, 0u);
    EXPECT_EQ(result.histogram.handle > 0, genus > 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Sample, Generated, testing::Range(0u, kGenerated / kGeneratedPerTest));

TEST(Topology, Tetrahedron) {
  const RoundTrip result = roundTripOf(tetrahedron(), Positions::kLattice14);
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.encoded.pieces[0].topological_vertex_count, 4u);
}

TEST(Topology, SphereTakesAnOperationPerVertexButThree) {
  for (const TestMesh& mesh : {tetrahedron(), icosphere(2), bipyramid(40), randomStacked(1, 300),
                               flipped(icosphere(3), 2, 4000)}) {
    const RoundTrip result = roundTripOf(mesh, Positions::kLattice14);
    ASSERT_EQ(result.failure, "") << mesh.name;
    uint64_t operations = result.histogram.start;  // each divide is one S
    for (const uint64_t count : result.histogram.degree) operations += count;
    EXPECT_EQ(operations, mesh.vertexCount() - 3) << mesh.name;
    EXPECT_EQ(result.histogram.end, result.histogram.start + 1) << mesh.name;
    EXPECT_EQ(result.histogram.handle, 0u) << mesh.name;
  }
}

TEST(Topology, StarsOfDegree100000) {
  expectExact(bipyramid(100000));
  expectExact(shuffled(bipyramid(100000), 1), Positions::kExact);
  expectExact(openFan(100000));
}

TEST(Topology, StacksOf100000) {
  expectExact(deepStack(100000));
  expectExact(shuffled(deepStack(100000), 2));
}

TEST(Topology, CombsAndRandomStacks) {
  expectExact(combOfStacks(150, 150));
  expectExact(randomStacked(3, 20000));
  expectExact(shuffled(combOfStacks(3000, 5), 4));
}

TEST(Topology, RandomlyFlippedSphere) {
  expectExact(flipped(icosphere(5), 5, 150000));
  expectExact(flipped(subdivided(torus(24, 16), 2), 6, 3000), Positions::kInt16);
}

TEST(Topology, ManyHandles) {
  const TestMesh sponge = mengerSponge(2);
  const RoundTrip result = roundTripOf(sponge, Positions::kLattice14);
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.histogram.handle, 81u);
  expectExact(plateWithTunnels(150, 1));
  expectExact(plateWithTunnels(300, 1));  // handles too deep for the format
}

TEST(Topology, RegularPatterns) {
  for (const QuadSplit split :
       {QuadSplit::kSame, QuadSplit::kAlternate, QuadSplit::kRows, QuadSplit::kRandom}) {
    expectExact(grid(60, 40, split, 1));
  }
}

TEST(Topology, ManyComponents) {
  expectExact(looseTriangles(5000));
  std::vector<TestMesh> pieces;
  for (uint32_t i = 0; i < 3000; ++i) {
    const uint32_t row = i / 60;
    pieces.push_back(
        translated(tetrahedron(), static_cast<float>(i % 60) * 4, static_cast<float>(row) * 4, 0));
  }
  expectExact(shuffled(unionOf(pieces, "3000 tetrahedra"), 1));
}

TEST(Topology, EveryStartHalfEdge) {
  for (const TestMesh& mesh : {icosphere(0), torus(4, 3), grid(3, 2), plateWithTunnels(2, 1)}) {
    for (uint32_t h = 0; h < mesh.indices.size(); ++h) {
      EncodeSettings options;
      options.start_half_edge = h;
      expectExact(mesh, Positions::kLattice14, options);
    }
  }
}

TEST(Topology, ManyDegreesAndHoles) {
  for (const TestMesh& mesh : {flipped(icosphere(3), 7, 1500), sheetWithHoles(12, 8),
                               looseTriangles(40), mengerSponge(1), book(4, 9, 3)}) {
    expectExact(mesh);
  }
}

// ---- Not manifold, not orientable ---------------------------------------------------------------

TEST(Topology, OneSided) {
  expectExact(moebius(200, 10));
  expectExact(shuffled(moebius(150, 7), 1), Positions::kExact);
  expectExact(kleinBottle(60, 40));
  expectExact(withFlippedTriangles(kleinBottle(30, 20), 2, 20));
}

TEST(Topology, InconsistentOrientation) {
  for (const uint32_t percent : {1u, 10u, 50u, 100u}) {
    expectExact(withFlippedTriangles(torus(40, 25), percent, percent));
    expectExact(withFlippedTriangles(sheetWithHoles(9, 3), percent, percent), Positions::kInt16);
  }
}

TEST(Topology, BowTies) {
  expectExact(bowTies(200, 2, 3));
  expectExact(bowTies(50, 7, 2), Positions::kExact);
  expectExact(bowTies(1, 3000, 1));
  expectExact(pinchedSpheres(100));
  expectExact(shuffled(pinchedSpheres(40), 1), Positions::kInt16);
}

TEST(Topology, EdgesOfManyFaces) {
  expectExact(book(3, 40, 6));
  expectExact(book(4, 40, 6), Positions::kExact);
  expectExact(shuffled(book(9, 25, 4), 1));
  expectExact(book(500, 1, 1));
  expectExact(fins(40));
  expectExact(withFlippedTriangles(fins(21), 2, 30));
}

TEST(Topology, Voxels) {
  expectExact(randomVoxels(1, 12, 50));
  expectExact(randomVoxels(2, 16, 10));
  expectExact(shuffled(randomVoxels(3, 10, 70), 4), Positions::kExact);
}

TEST(Topology, Tetrahedra) { expectExact(tetrahedralSoup(7)); }

TEST(Topology, DuplicatesByIndex) {
  expectExact(withIndexDuplicates(torus(30, 20), 1, 300));
  expectExact(withIndexDuplicates(tetrahedron(), 2, 2000), Positions::kExact);
  expectExact(withIndexDuplicates(moebius(30, 3), 3, 50), Positions::kInt16);
}

TEST(Topology, DuplicatesByPosition) {
  expectExact(withPositionDuplicates(torus(30, 20), 1, 300));
  expectExact(withPositionDuplicates(tetrahedron(), 2, 300), Positions::kExact);
  expectExact(doubled(icosphere(3)));
  expectExact(doubled(doubled(sheetWithHoles(5, 1))), Positions::kInt16);
}

TEST(Topology, Degenerates) {
  expectExact(withDegenerates(torus(30, 20), 1, 400));
  expectExact(withDegenerates(tetrahedron(), 2, 60), Positions::kExact);
  TestMesh only;
  only.name = "nothing but degenerates";
  only.positions = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0};
  only.indices = {0, 0, 1, 2, 2, 2, 3, 4, 3, 3, 3, 4};
  for (const Positions positions : kAllPositions) expectExact(only, positions);
}

TEST(Topology, EqualPositionsOnDifferentWedges) {
  // All corners of a triangle in one place; two of three; a whole mesh in one place.
  TestMesh mesh = torus(6, 5);
  mesh.name = "crumpled torus";
  for (size_t i = 0; i < mesh.positions.size(); i += 15) {
    for (size_t k = 0; k < 9 && i + 3 + k < mesh.positions.size(); ++k) {
      mesh.positions[i + 3 + k] = mesh.positions[i + k % 3];
    }
  }
  for (const Positions positions : kAllPositions) expectExact(mesh, positions);
  TestMesh point = icosphere(1);
  point.name = "sphere in one place";
  point.positions.assign(point.positions.size(), 2.5f);
  for (const Positions positions : kAllPositions) expectExact(point, positions);
}

TEST(Topology, UnusedWedges) {
  expectExact(withUnused(torus(20, 12), 1, 500));
  expectExact(withUnused(bowTies(9, 3, 2), 2, 30), Positions::kExact);
  TestMesh none;
  none.name = "wedges without triangles";
  none.positions = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 2, 0};
  for (const Positions positions : kAllPositions) expectExact(none, positions);
}

TEST(Topology, TinyMeshes) {
  TestMesh one = openFan(1);
  for (const Positions positions : kAllPositions) expectExact(one, positions);
  one.indices = {0, 1, 2, 0, 2, 1};  // both sides
  one.name = "both sides of a triangle";
  for (const Positions positions : kAllPositions) expectExact(one, positions);
  one.indices = {0, 1, 2, 1, 2, 0, 2, 0, 1, 0, 2, 1};
  one.name = "four times the same triangle";
  for (const Positions positions : kAllPositions) expectExact(one, positions);
}

/// All 64 index triples, degenerate ones too, with one another; then random sets of up to nine.
TEST(Topology, AllPairsOfTrianglesOnFourVertices) {
  TestMesh mesh = tetrahedron();
  const auto set_triangle = [&mesh](size_t t, uint32_t code) {
    for (size_t k = 0; k < 3; ++k) mesh.indices[t * 3 + k] = code >> (2 * k) & 3;
  };
  const EncodeOptions options;
  mesh.indices.resize(6);
  for (uint32_t first = 0; first < 64; ++first) {
    for (uint32_t second = first; second < 64; ++second) {
      set_triangle(0, first);
      set_triangle(1, second);
      ASSERT_EQ(roundTripOf(mesh, Positions::kLattice14, options).failure, "")
          << first << ' ' << second;
    }
  }
  Random random(1);
  for (int trial = 0; trial < 1500; ++trial) {
    const uint32_t count = random.between(3, 9);
    mesh.indices.resize(size_t{count} * 3);
    for (uint32_t t = 0; t < count; ++t) set_triangle(t, random.below(64));
    ASSERT_EQ(roundTripOf(mesh, Positions::kLattice14, options).failure, "")
        << testing::PrintToString(mesh.indices);
  }
}

TEST(Topology, RandomSoups) {
  const char* wanted = std::getenv("MCC_SOUPS");
  const uint32_t count =
      wanted == nullptr ? kSoups : static_cast<uint32_t>(std::strtoul(wanted, nullptr, 10));
  for (uint32_t seed = 0; seed < count; ++seed) {
    const TestMesh mesh = randomSoup(seed);
    EncodeOptions options;
    options.prefer = static_cast<Preference>(seed % 3);
    ASSERT_EQ(roundTripOf(mesh, kAllPositions[seed / 3 % kAllPositions.size()], options).failure,
              "")
        << mesh.name;
  }
}

TEST(Topology, DenseSoups) {
  expectExact(soup(1, 3000, 20, {}));
  expectExact(soup(2, 3000, 3, {}), Positions::kExact);
  expectExact(soup(3, 3000, 300, {20, 20, 20, 50}));
  expectExact(soup(4, 50, 3000, {0, 0, 0, 50}));
}

// ---- Seams --------------------------------------------------------------------------------------

TEST(Topology, Charts) {
  for (const Positions positions : {Positions::kLattice14, Positions::kExact}) {
    expectExact(chartGrid(40, 30, 8), positions);
    expectExact(shuffled(chartGrid(24, 24, 3), 1), positions);
    expectExact(chartGrid(15, 15, 1), positions);
    expectExact(flatShaded(icosphere(2)), positions);
  }
  const RoundTrip result = roundTripOf(chartGrid(40, 30, 8), Positions::kLattice14);
  EXPECT_EQ(result.encoded.pieces[0].topological_vertex_count, 41u * 31u);
  EXPECT_EQ(result.encoded.pieces[0].component_count, 1u);
}

TEST(Topology, NonContiguousWedges) {
  for (const uint32_t wedges : {2u, 3u, 6u}) {
    expectExact(withRandomWedges(torus(30, 18), wedges, wedges));
    expectExact(withRandomWedges(sheetWithHoles(7, wedges), wedges, wedges), Positions::kExact);
    expectExact(withRandomWedges(bipyramid(400), wedges, wedges));
  }
}

TEST(Topology, WedgesThatSpanFans) {
  expectExact(withRandomWedges(bowTies(60, 4, 3), 1, 2));
  expectExact(withRandomWedges(pinchedSpheres(20), 2, 3), Positions::kExact);
  expectExact(withRandomWedges(book(5, 30, 4), 3, 2));
  expectExact(withRandomWedges(randomVoxels(4, 8, 50), 4, 3));
  expectExact(withRandomWedges(moebius(60, 5), 5, 2));
  expectExact(withRandomWedges(doubled(icosphere(2)), 6, 2));
}

TEST(Topology, EqualTuplesStayTwoWedges) {
  for (const Positions positions : kAllPositions) {
    expectExact(withEqualTuples(torus(20, 12), 1), positions);
    expectExact(withEqualTuples(pinchedSpheres(9), 2), positions);
    expectExact(withEqualTuples(randomSoup(9), 3), positions);
  }
}

TEST(Topology, SoupsWithSeams) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const TestMesh mesh = soup(seed, random.between(3, 400), random.between(3, 80), {5, 10, 5, 20});
    expectExact(withRandomWedges(mesh, seed, random.between(2, 4)), kAllPositions[seed % 4]);
  }
}

// ---- The whole zoo, parts and pieces ------------------------------------------------------------

TEST(Topology, ZooInEveryCoding) {
  for (const TestMesh& mesh : smallZoo()) {
    for (const Positions positions : kAllPositions) {
      expectExact(mesh, positions);
      expectExact(shuffled(mesh, 1), positions);
    }
  }
}

TEST(Topology, ZooWithEveryPreferenceAndTarget) {
  for (const TestMesh& mesh : smallZoo()) {
    for (uint32_t prefer = 0; prefer <= 2; ++prefer) {
      EncodeOptions options;
      options.prefer = static_cast<Preference>(prefer);
      const TargetLayout layout = {prefer * 4,
                                   prefer == 0 ? IndexType::kUint16 : IndexType::kUint32};
      EXPECT_EQ(roundTripOf(mesh, Positions::kLattice14, options, layout).failure, "") << mesh.name;
    }
    if (mesh.vertexCount() > 256) continue;
    EXPECT_EQ(roundTripOf(mesh, Positions::kExact, {}, {12, IndexType::kUint8}).failure, "")
        << mesh.name;
  }
}

TEST(Topology, ZooAsOnePayload) {
  const std::vector<TestMesh> zoo = smallZoo();
  std::vector<std::unique_ptr<MeshPiece>> pieces;
  std::vector<PieceView> views;
  for (const TestMesh& mesh : zoo) {
    pieces.push_back(
        std::make_unique<MeshPiece>(mesh, pieces.size() % 3 == 2 ? kExactBits : MeshBits{}));
    views.push_back(pieces.back()->view());
  }
  EXPECT_EQ(roundTrip(views).failure, "");
}

TEST(Topology, PartsShareWedges) {
  for (const TestMesh& mesh : smallZoo()) {
    Random random(7);
    std::array<std::vector<uint32_t>, 4>
        parts;  // random triangles, rows of triangles, none, a copy of some
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
      std::vector<uint32_t>& part = parts[random.chance(20) ? 0 : 1];
      part.insert(part.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(t),
                  mesh.indices.begin() + static_cast<std::ptrdiff_t>(t + 3));
    }
    parts[3] = parts[0];
    MeshPiece piece(mesh);
    piece.setParts(
        {PartView{parts[0]}, PartView{parts[1]}, PartView{parts[2]}, PartView{parts[3]}});
    EXPECT_EQ(roundTrip(piece.view()).failure, "") << mesh.name;
  }
}

TEST(Topology, SameInputSameBytes) {
  for (const TestMesh& mesh :
       {flipped(icosphere(3), 1, 2000), randomVoxels(1, 6, 40), chartGrid(12, 12, 3)}) {
    const MeshPiece piece(mesh);
    EXPECT_EQ(roundTrip(piece.view()).encoded.payload, roundTrip(piece.view()).encoded.payload)
        << mesh.name;
  }
}

TEST(Topology, SizesAddUpToThePayload) {
  for (const TestMesh& mesh : smallZoo()) {
    const RoundTrip result = roundTripOf(mesh, Positions::kLattice14);
    ASSERT_EQ(result.failure, "") << mesh.name;
    const StreamSizes& sizes = result.encoded.sizes;
    const double attributes =
        std::accumulate(sizes.attribute_bits.begin(), sizes.attribute_bits.end(), 0.0);
    const double bits = sizes.header_bits + sizes.connectivity_bits + sizes.stitch_bits +
                        sizes.leftover_bits + sizes.seam_bits + sizes.position_bits +
                        sizes.order_bits + attributes;
    EXPECT_NEAR(bits, static_cast<double>(result.encoded.payload.size()) * 8, 1.0) << mesh.name;
  }
}

// ---- Large: left out under the sanitizers -------------------------------------------------------

TEST(Topology, LargeStarsAndStacksOfAMillion) {
  expectExact(bipyramid(1000000));
  expectExact(openFan(1000000));
  expectExact(deepStack(1000000));
}

TEST(Topology, LargeSpongeAndSoups) {
  expectExact(mengerSponge(3));
  expectExact(tetrahedralSoup(12));
  expectExact(randomVoxels(1, 24, 50));
  expectExact(soup(1, 60000, 6000, {5, 5, 5, 10}));
}

}  // namespace
}  // namespace mcc::test
