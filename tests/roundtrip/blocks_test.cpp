// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Surfaces that are cut into blocks come back as one: the same triangles, the same wedges, each
// once, whatever the blocks are and whoever codes them.                                      [A.11]
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "container/payload_header.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "support/run_jobs.h"
#include "support/triangles.h"

namespace mcc::test {
namespace {

std::array<RunJobs, 3> allHooks() { return {runForwards, runBackwards, runOnThreads}; }

EncodeSettings inBlocks(uint32_t block_triangles, uint64_t variation = 0) {
  EncodeSettings settings;
  settings.block_triangles = block_triangles;
  settings.variation = variation;
  return settings;
}

/// Different triangles with three wedges: only those are cut into blocks.
uint64_t properTriangles(const PieceView& piece) {
  uint64_t count = 0;
  for (const PartView& part : piece.parts) {
    std::set<std::array<uint32_t, 3>> triangles;
    for (size_t i = 0; i < part.indices.size(); i += 3) {
      std::array<uint32_t, 3> t = {part.indices[i], part.indices[i + 1], part.indices[i + 2]};
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      triangles.insert(rotated(t));
    }
    count += triangles.size();
  }
  return count;
}

/// Encodes, decodes and compares. Returns the number of blocks.
uint32_t expectSame(const PieceView& piece, const EncodeSettings& settings,
                    const std::string& what) {
  const RoundTrip trip = roundTrip(piece, settings);
  EXPECT_EQ(trip.failure, "") << what << ", " << settings.block_triangles
                              << " triangles, variation " << settings.variation;
  if (!trip.failure.empty()) return 0;
  EXPECT_NE(trip.encoded.block_count, 1u) << what;
  const bool is_asked_for = properTriangles(piece) > settings.block_triangles;
  EXPECT_EQ(trip.encoded.block_count == 0 && is_asked_for, !trip.encoded.whole_because.empty())
      << what << ": " << trip.encoded.whole_because;
  return trip.encoded.block_count;
}

/// How the floats of a mesh are coded.
enum class Floats : uint8_t { kLattice, kCoarse, kExact, kGrid };
constexpr std::array<Floats, 4> kAllFloats = {Floats::kLattice, Floats::kCoarse, Floats::kExact,
                                              Floats::kGrid};

/// Moves positions to multiples of 1/1024, so that they are on a grid.
TestMesh onGrid(TestMesh mesh) {
  for (std::vector<float>* values : {&mesh.positions, &mesh.texcoords}) {
    for (float& x : *values) x = std::floor(x * 1024) / 1024;
  }
  return mesh;
}

uint32_t expectSame(const TestMesh& mesh, Floats floats, const EncodeSettings& settings) {
  const TestMesh source = floats == Floats::kGrid ? onGrid(mesh) : mesh;
  const bool is_exact = floats == Floats::kExact || floats == Floats::kGrid;
  const MeshPiece piece(source, is_exact                    ? kExactBits
                                : floats == Floats::kCoarse ? MeshBits{5, 4, 5}
                                                            : MeshBits{});
  return expectSame(piece.view(), settings, source.name);
}

/// Small blocks, and sometimes choices at random.
EncodeSettings anySettings(Random& random) {
  EncodeSettings settings = inBlocks(random.between(1, 50));
  if (random.chance(70)) settings.variation = random.next() | 1;
  settings.prefer = static_cast<Preference>(random.below(3));
  return settings;
}

void expectSameInAnyBlocks(const TestMesh& mesh, uint64_t seed, uint32_t times = 3) {
  Random random(seed);
  for (uint32_t i = 0; i < times; ++i)
    (void)expectSame(mesh, kAllFloats[random.below(4)], anySettings(random));
}

TEST(Blocks, GeneratedMeshes) {
  for (uint32_t i = 0; i < 60; ++i)
    expectSameInAnyBlocks(generated(i, i % 4, i % 7, i % 5 + 1), i, 2);
}

TEST(Blocks, EveryNumberOfTrianglesFromOneToFifty) {
  const TestMesh mesh = withRandomWedges(torus(9, 7), 4, 2);
  for (uint32_t n = 1; n <= 50; ++n) {
    const uint32_t blocks = expectSame(mesh, Floats::kLattice, inBlocks(n));
    EXPECT_GT(blocks, 1u) << n;
    EXPECT_LE(blocks, mesh.triangleCount() / n + 2) << n;
  }
}

TEST(Blocks, OfTheZoo) {
  uint64_t seed = 0;
  for (const TestMesh& mesh : smallZoo()) expectSameInAnyBlocks(mesh, ++seed, 4);
}

TEST(Blocks, ManifoldsWithHolesAndHandles) {
  expectSameInAnyBlocks(icosphere(3), 1);
  expectSameInAnyBlocks(flipped(icosphere(3), 2, 4000), 2);
  expectSameInAnyBlocks(plateWithTunnels(6, 2), 3);
  expectSameInAnyBlocks(mengerSponge(1), 4);
  expectSameInAnyBlocks(sheetWithHoles(9, 5), 5);
  expectSameInAnyBlocks(bipyramid(120), 6);
  expectSameInAnyBlocks(openFan(120), 7);
  expectSameInAnyBlocks(combOfStacks(9, 9), 8);
  expectSameInAnyBlocks(moebius(40, 4), 9);
  expectSameInAnyBlocks(kleinBottle(20, 12), 10);
}

TEST(Blocks, SurfacesThatTouchOrAreNotManifold) {
  expectSameInAnyBlocks(bowTies(30, 4, 3), 1);
  expectSameInAnyBlocks(bowTies(1, 90, 1), 2);
  expectSameInAnyBlocks(pinchedSpheres(6), 3);
  expectSameInAnyBlocks(book(5, 12, 3), 4);
  expectSameInAnyBlocks(book(60, 2, 1), 5);
  expectSameInAnyBlocks(fins(9), 6);
  expectSameInAnyBlocks(randomVoxels(3, 7, 50), 7);
  expectSameInAnyBlocks(tetrahedralSoup(3), 8);
  expectSameInAnyBlocks(stackedCubes(3, 4, 60), 9);
  expectSameInAnyBlocks(cellWalls(3), 10);
  expectSameInAnyBlocks(doubled(icosphere(2)), 11);
  expectSameInAnyBlocks(withFlippedTriangles(torus(20, 12), 3, 30), 12);
}

TEST(Blocks, Soups) {
  for (uint64_t seed = 0; seed < 60; ++seed) expectSameInAnyBlocks(randomSoup(seed), seed, 1);
  for (uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    const TestMesh mesh = soup(seed, random.between(3, 300), random.between(3, 60), {5, 10, 5, 30});
    expectSameInAnyBlocks(withRandomWedges(mesh, seed, 3), seed, 1);
  }
}

TEST(Blocks, DuplicatesAndDegenerates) {
  expectSameInAnyBlocks(withIndexDuplicates(torus(15, 10), 1, 80), 1);
  expectSameInAnyBlocks(withPositionDuplicates(torus(15, 10), 2, 80), 2);
  // On edges, on pairs that are none, and in one vertex.
  expectSameInAnyBlocks(withDegenerates(torus(15, 10), 3, 60), 3);
  expectSameInAnyBlocks(withDegenerates(withUnused(sheetWithHoles(3, 2), 4, 30), 5, 30), 4);
}

/// A degenerate triangle between two wedges that no block has both of rules blocks out; one on an
/// edge, or in a vertex, does not.
TEST(Blocks, DegenerateTrianglesNeedABlock) {
  TestMesh mesh = grid(12, 12);
  const uint32_t far = mesh.vertexCount() - 1;
  mesh.indices.insert(mesh.indices.end(), {0, 0, 1, far, far, far});
  EXPECT_GT(expectSame(mesh, Floats::kLattice, inBlocks(40)), 1u);
  mesh.indices.insert(mesh.indices.end(), {0, far, 0});
  const MeshPiece piece(mesh);
  const RoundTrip trip = roundTrip(piece.view(), inBlocks(40));
  EXPECT_EQ(trip.failure, "");
  EXPECT_EQ(trip.encoded.block_count, 0u);
  EXPECT_NE(trip.encoded.whole_because, "");
}

TEST(Blocks, IsolatedWedges) {
  expectSameInAnyBlocks(withUnused(torus(12, 8), 1, 90), 1, 6);
  // Their positions widen the box of the first block.
  TestMesh mesh = withUnused(icosphere(2), 2, 5);
  mesh.positions.insert(mesh.positions.end(), {90, -80, 70, -60, 50, -40});
  mesh.normals.clear();
  expectSameInAnyBlocks(mesh, 2, 6);
}

TEST(Blocks, Seams) {
  expectSameInAnyBlocks(chartGrid(12, 10, 3), 1, 6);
  expectSameInAnyBlocks(chartGrid(9, 9, 1), 2, 6);
  expectSameInAnyBlocks(flatShaded(icosphere(2)), 3, 6);
  expectSameInAnyBlocks(flatShaded(torus(12, 8)), 4, 6);
  for (const uint32_t wedges : {2u, 3u, 6u}) {
    expectSameInAnyBlocks(withRandomWedges(torus(14, 9), wedges, wedges), wedges);
    expectSameInAnyBlocks(withRandomWedges(pinchedSpheres(4), wedges, wedges), wedges);
    expectSameInAnyBlocks(withRandomWedges(bipyramid(80), wedges, wedges), wedges);
  }
}

/// The exceptions of a payload.
uint32_t exceptionCount(std::span<const uint8_t> payload) {
  PayloadHeader header{Allocator{}};
  EXPECT_TRUE(parsePayload(payload, {}, header).ok());
  return static_cast<uint32_t>(header.exceptions.size());
}

RoundTrip tripOf(const TestMesh& mesh, const EncodeSettings& settings, const MeshBits& bits = {}) {
  const MeshPiece piece(mesh, bits);
  RoundTrip trip = roundTrip(piece.view(), settings);
  EXPECT_EQ(trip.failure, "") << mesh.name;
  return trip;
}

/// Wedges with equal attributes stay different ones, on the cut too: exceptions say which is which.
TEST(Blocks, EqualTuplesOnTheCut) {
  expectSameInAnyBlocks(withEqualTuples(torus(12, 8), 1), 1, 6);
  expectSameInAnyBlocks(withEqualTuples(pinchedSpheres(4), 2), 2, 6);
  expectSameInAnyBlocks(withEqualTuples(grid(12, 12), 3), 3, 6);
  expectSameInAnyBlocks(withEqualTuples(randomSoup(9), 4), 4, 6);
  expectSameInAnyBlocks(doubled(doubled(grid(7, 7))), 5, 6);
  EXPECT_GT(exceptionCount(tripOf(withEqualTuples(torus(12, 8), 1), inBlocks(20)).encoded.payload),
            5u);
  TestMesh point = icosphere(2);  // all wedges are equal
  point.positions.assign(point.positions.size(), 2.5f);
  expectSameInAnyBlocks(point, 6, 6);
  EXPECT_EQ(exceptionCount(tripOf(torus(12, 8), inBlocks(20)).encoded.payload), 0u);
}

/// The surface touches itself in a vertex that is inside of a block: the cut ends there, and the
/// wedge is on no rim.
TEST(Blocks, WedgesThatAreOnNoRim) {
  const TestMesh mesh = pinchedSpheres(8);
  uint32_t named_count = 0;
  for (uint32_t n = 5; n < 60; n += 3)
    named_count += exceptionCount(tripOf(mesh, inBlocks(n)).encoded.payload);
  EXPECT_GT(named_count, 0u);
}

TEST(Blocks, Parts) {
  uint64_t seed = 0;
  for (const TestMesh& mesh :
       {torus(12, 9), withIndexDuplicates(chartGrid(9, 9, 3), 1, 40),
        withUnused(withDegenerates(icosphere(2), 1, 20), 2, 20), randomSoup(7)}) {
    Random random(++seed);
    std::array<std::vector<uint32_t>, 5> parts;  // some of them empty
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
      std::vector<uint32_t>& part = parts[random.chance(20)                                 ? 3
                                          : mesh.positions[3 * size_t{mesh.indices[t]}] > 0 ? 0
                                                                                            : 1];
      part.insert(part.end(), &mesh.indices[t], &mesh.indices[t] + 3);
    }
    std::vector<PartView> views;
    for (const std::vector<uint32_t>& part : parts) views.push_back({part});
    MeshPiece piece(mesh);
    piece.setParts(views);
    for (uint32_t i = 0; i < 8; ++i) (void)expectSame(piece.view(), anySettings(random), mesh.name);
  }
}

// ---- Attributes ---------------------------------------------------------------------------------

AttributeFormat formatOfSet(Semantic semantic, ComponentType type, uint8_t components,
                            uint8_t set = 0, uint16_t target = 0) {
  AttributeFormat format;
  format.semantic = semantic;
  format.component_type = type;
  format.component_count = components;
  format.set_index = set;
  format.morph_target = target;
  return format;
}

/// A mesh with attributes of every method.
class RichPiece {
 public:
  /// bits  of the lattices; 0: exact
  RichPiece(const TestMesh& mesh, uint8_t bits)
      : mesh_(withNormals(mesh)), piece_(mesh_, MeshBits{bits, bits, bits}) {
    memory_.reserve(20);
    addTangents(bits == 0 ? 0 : 9);
    addSkin(bits);
    addFloats(formatOfSet(Semantic::kColor, ComponentType::kFloat32, 4), bits, 0.3f);
    addFloats(formatOfSet(Semantic::kCustom, ComponentType::kFloat32, 2, 1), 0, 1e30f);
    addFloats(formatOfSet(Semantic::kPosition, ComponentType::kFloat32, 3, 0, 1), bits, 0.1f);
    addFloats(formatOfSet(Semantic::kNormal, ComponentType::kFloat32, 3, 0, 1), bits, 0.1f);
    addFloats(formatOfSet(Semantic::kPosition, ComponentType::kFloat32, 3, 0, 2), bits, 0.1f);
    addIntegers(ComponentType::kUint8, 4, 2);
    addIntegers(ComponentType::kInt16, 3, 3);
    addIntegers(ComponentType::kUint32, 9, 4);
    // An alias.
    piece_.add(formatOfSet(Semantic::kColor, ComponentType::kFloat32, 4, 5), memory_[3].data(),
               bits);
  }

  PieceView view() const { return piece_.view(); }
  MeshPiece& piece() { return piece_; }

 private:
  std::vector<uint8_t>& newMemory(size_t bytes) { return memory_.emplace_back(bytes); }
  size_t wedgeCount() const { return mesh_.vertexCount(); }

  void add(const AttributeFormat& format, uint8_t bits) {
    piece_.add(format, memory_.back().data(), bits);
  }
  void addFloats(const AttributeFormat& format, uint8_t bits, float scale) {
    std::vector<uint8_t>& memory = newMemory(wedgeCount() * elementBytes(format));
    for (size_t i = 0; i < memory.size() / 4; ++i) {
      const size_t wedge = i / format.component_count;
      const float x = mesh_.positions[3 * wedge + i % 3] * scale;
      std::memcpy(&memory[4 * i], &x, 4);
    }
    add(format, bits);
  }
  void addIntegers(ComponentType type, uint8_t components, uint8_t set) {
    const AttributeFormat format = formatOfSet(Semantic::kCustom, type, components, set);
    const uint32_t width = componentBytes(type);
    std::vector<uint8_t>& memory = newMemory(wedgeCount() * elementBytes(format));
    for (size_t i = 0; i < memory.size() / width; ++i) {
      const size_t wedge = i / format.component_count;
      const auto x = static_cast<int64_t>(mesh_.positions[3 * wedge + i % 3] * 100);
      const auto value = static_cast<uint32_t>(type == ComponentType::kUint32 ? 77777777 * x : x);
      std::memcpy(&memory[width * i], &value, width);
    }
    add(format, 0);
  }
  void addTangents(uint8_t bits) {
    const AttributeFormat format = formatOfSet(Semantic::kTangent, ComponentType::kFloat32, 4);
    std::vector<uint8_t>& memory = newMemory(wedgeCount() * elementBytes(format));
    for (size_t w = 0; w < wedgeCount(); ++w) {
      const float* const n = &mesh_.normals[3 * w];
      const bool has_xy = std::fabs(n[0]) + std::fabs(n[1]) > 0.01f;
      float t[4] = {has_xy ? -n[1] : 1, has_xy ? n[0] : 0, 0, w % 5 == 0 ? -1.0f : 1.0f};
      const float length = std::sqrt(t[0] * t[0] + t[1] * t[1]);
      t[0] /= length;
      t[1] /= length;
      std::memcpy(&memory[16 * w], t, 16);
    }
    add(format, bits);
  }
  void addSkin(uint8_t bits) {
    std::vector<uint8_t>& joints = newMemory(4 * wedgeCount());
    for (size_t i = 0; i < joints.size(); ++i) {
      const float x = mesh_.positions[3 * (i / 4)] + 4;
      joints[i] = static_cast<uint8_t>(static_cast<uint32_t>(std::fabs(x)) % 40 + i % 4);
    }
    add(formatOfSet(Semantic::kJoints, ComponentType::kUint8, 4), 0);
    std::vector<uint8_t>& weights = newMemory(16 * wedgeCount());
    for (size_t w = 0; w < wedgeCount(); ++w) {
      const float x = std::fabs(mesh_.positions[3 * w + 1]);
      const float part = x - std::floor(x);
      const float all[4] = {0.5f + 0.5f * part, 0.5f - 0.5f * part, 0, 0};
      std::memcpy(&weights[16 * w], all, 16);
    }
    add(formatOfSet(Semantic::kWeights, ComponentType::kFloat32, 4), bits);
  }

  TestMesh mesh_;
  MeshPiece piece_;
  std::vector<std::vector<uint8_t>> memory_;
};

TEST(Blocks, AttributesOfEveryKind) {
  const TestMesh meshes[] = {torus(12, 9),
                             chartGrid(9, 9, 3),
                             withRandomWedges(sheetWithHoles(4, 1), 2, 2),
                             withUnused(uvSphere(14, 9), 3, 9),
                             withRandomWedges(book(4, 8, 4), 5, 2),
                             flatShaded(icosphere(1))};
  uint64_t seed = 0;
  for (const TestMesh& mesh : meshes) {
    for (const uint8_t bits : {uint8_t{0}, uint8_t{4}, uint8_t{12}}) {
      const RichPiece rich(mesh, bits);
      Random random(++seed);
      for (uint32_t i = 0; i < 5; ++i)
        (void)expectSame(rich.view(), anySettings(random), mesh.name);
    }
  }
}

TEST(Blocks, IntegerPositions) {
  uint64_t seed = 0;
  for (const TestMesh& mesh : {torus(12, 9), withRandomWedges(randomVoxels(3, 6, 40), 1, 2)}) {
    for (const ComponentType type : {ComponentType::kInt8, ComponentType::kUint16,
                                     ComponentType::kInt16, ComponentType::kUint32}) {
      const uint32_t width = componentBytes(type);
      std::vector<uint8_t> values(mesh.positions.size() * width);
      for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const auto x = static_cast<int64_t>(std::floor(mesh.positions[i] * 20));
        const auto value =
            static_cast<uint32_t>(type == ComponentType::kUint32 ? x * 90000000 : x + 40);
        std::memcpy(&values[i * width], &value, width);
      }
      MeshPiece piece(mesh);
      piece.setPositions(formatOfSet(Semantic::kPosition, type, 3), values.data());
      Random random(++seed);
      for (uint32_t i = 0; i < 4; ++i)
        (void)expectSame(piece.view(), anySettings(random), mesh.name);
    }
  }
}

/// Positions without an order or a sum: infinities, NaNs, zeros of both signs, the largest floats.
TEST(Blocks, OddFloats) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr std::array<float, 9> kOdd = {0.0f,      -0.0f,      1e-45f, 3.4e38f, -3.4e38f,
                                         kInfinity, -kInfinity, kNan,   0.1f};
  for (const uint32_t percent : {5u, 40u, 100u}) {
    TestMesh mesh = withRandomWedges(torus(10, 8), 1, 2);
    Random random(percent);
    for (std::vector<float>* values : {&mesh.positions, &mesh.texcoords}) {
      for (float& x : *values) {
        if (random.chance(percent)) x = kOdd[random.below(static_cast<uint32_t>(kOdd.size()))];
      }
    }
    for (const uint32_t n : {1u, 7u, 30u}) {
      (void)expectSame(mesh, Floats::kExact, inBlocks(n));
      (void)expectSame(mesh, Floats::kExact, inBlocks(n, n + 1));
    }
  }
}

// ---- Jobs ---------------------------------------------------------------------------------------

/// Memory for what decode() writes, and what it says meanwhile.
struct Decoded {
  std::vector<std::vector<uint8_t>> attributes;
  std::vector<std::vector<uint32_t>> parts;

  bool operator==(const Decoded&) const = default;

  Status decode(const Payload& payload, const DecodeOptions& options) {
    const PieceInfo& piece = payload.info().pieces[0];
    std::vector<AttributeTarget> attribute_targets;
    std::vector<PartTarget> part_targets;
    for (const AttributeInfo& a : piece.attributes) {
      const size_t stride = elementBytes(a.format);
      attributes.emplace_back(stride * piece.wedge_count, uint8_t{0xa5});
      attribute_targets.push_back({attributes.back().data(), stride});
    }
    for (const PartInfo& part : piece.parts) {
      parts.emplace_back(3 * size_t{part.triangle_count}, kNone);
      part_targets.push_back({parts.back().data()});
    }
    const PieceTarget target = {attribute_targets, part_targets};
    return payload.decode({&target, 1}, options);
  }
};

TEST(Blocks, JobsChangeNothing) {
  const TestMesh meshes[] = {torus(16, 12), withUnused(chartGrid(10, 10, 3), 1, 9),
                             withRandomWedges(randomVoxels(3, 6, 40), 1, 2)};
  for (const TestMesh& mesh : meshes) {
    const RichPiece rich(mesh, 11);
    const PieceView view = rich.view();
    EncodeSettings settings = inBlocks(30);
    EncodeResult alone;
    ASSERT_TRUE(encodeWith({&view, 1}, settings, alone).ok()) << mesh.name;
    ASSERT_GT(alone.block_count, 4u);
    Payload payload;
    ASSERT_TRUE(payload.open(alone.payload).ok());
    Decoded expected;
    ASSERT_TRUE(expected.decode(payload, {}).ok());
    for (const RunJobs& hook : allHooks()) {
      settings.run_jobs = hook;
      EncodeResult result;
      ASSERT_TRUE(encodeWith({&view, 1}, settings, result).ok()) << mesh.name;
      EXPECT_EQ(result.payload, alone.payload) << mesh.name;
      EXPECT_EQ(result.pieces[0].source_wedge, alone.pieces[0].source_wedge) << mesh.name;
      EXPECT_EQ(result.block_count, alone.block_count) << mesh.name;
      DecodeOptions options;
      options.run_jobs = runnerOf(hook);
      for (int i = 0; i < 5; ++i) {
        Decoded decoded;
        ASSERT_TRUE(decoded.decode(payload, options).ok()) << mesh.name;
        EXPECT_TRUE(decoded == expected) << mesh.name;
      }
    }
  }
}

/// A hook that leaves out jobs, or makes up some, is the caller's mistake. What is missing must not
/// pass for decoded.
TEST(Blocks, JobsThatAreLeftOutAreReported) {
  const TestMesh mesh = torus(16, 12);
  const RichPiece rich(mesh, 11);
  const PieceView view = rich.view();
  EncodeResult result;
  ASSERT_TRUE(encodeWith({&view, 1}, inBlocks(30), result).ok());
  Payload payload;
  ASSERT_TRUE(payload.open(result.payload).ok());
  const auto errorOf = [&](const RunJobs& hook) {
    DecodeOptions options;
    options.run_jobs = runnerOf(hook);
    Decoded decoded;
    return decoded.decode(payload, options).error;
  };
  using Job = std::function<void(size_t)>;
  EXPECT_EQ(errorOf([](size_t, const Job&) {}), Error::kBadArgument);
  for (const size_t left_out : {0u, 1u, 3u}) {
    EXPECT_EQ(errorOf([=](size_t count, const Job& job) {
                for (size_t i = 0; i < count; ++i) {
                  if (i != left_out) job(i);
                }
              }),
              Error::kBadArgument);
  }
  EXPECT_EQ(errorOf([](size_t count, const Job& job) {
              for (const size_t i : {count, count + 1, SIZE_MAX - 1, SIZE_MAX}) job(i);
              runForwards(count, job);
            }),
            Error::kOk);
}

/// Where several blocks are damaged, the first says what is wrong.
TEST(Blocks, TheFirstFailureIsReported) {
  const TestMesh mesh = torus(16, 12);
  const MeshPiece piece(mesh);
  const PieceView view = piece.view();
  EncodeResult result;
  ASSERT_TRUE(encodeWith({&view, 1}, inBlocks(30), result).ok());
  Payload intact;
  ASSERT_TRUE(intact.open(result.payload).ok());
  const std::span<const BlockInfo> blocks = intact.info().pieces[0].blocks;
  ASSERT_GT(blocks.size(), 8u);
  for (const size_t first : {size_t{0}, size_t{1}, size_t{4}, blocks.size() - 1}) {
    std::vector<uint8_t> damaged = result.payload;
    for (size_t b = first; b < blocks.size(); b += 2) {
      uint8_t& byte = damaged[blocks[b].offset_bytes];
      byte = static_cast<uint8_t>(byte ^ 1);
    }
    Payload payload;
    ASSERT_TRUE(payload.open(damaged).ok());
    for (const RunJobs& hook : allHooks()) {
      DecodeOptions options;
      options.run_jobs = runnerOf(hook);
      Decoded decoded;
      const Status status = decoded.decode(payload, options);
      EXPECT_EQ(status.error, Error::kBadChecksum);
      EXPECT_EQ(status.offset_bytes, blocks[first].offset_bytes);
    }
  }
}

// ---- What callers are told ----------------------------------------------------------------------

TEST(Blocks, InfoAddsUp) {
  uint64_t seed = 0;
  for (const TestMesh& mesh :
       {torus(16, 12), withUnused(chartGrid(10, 10, 3), 1, 9), book(5, 12, 3),
        withDegenerates(withIndexDuplicates(icosphere(2), 1, 30), 1, 20)}) {
    for (const Floats floats : kAllFloats) {
      const TestMesh source = floats == Floats::kGrid ? onGrid(mesh) : mesh;
      const MeshPiece piece(source, floats == Floats::kLattice ? MeshBits{} : kExactBits);
      const PieceView view = piece.view();
      EncodeResult result;
      ++seed;
      const uint64_t variation = seed % 2 == 0 ? 0 : seed;
      ASSERT_TRUE(encodeWith({&view, 1}, inBlocks(25, variation), result).ok());
      if (result.block_count == 0) continue;  // a degenerate triangle belongs to no block
      Payload payload;
      ASSERT_TRUE(payload.open(result.payload).ok());
      ASSERT_EQ(payload.info().pieces.size(), 1u);
      const PieceInfo& info = payload.info().pieces[0];
      ASSERT_EQ(info.blocks.size(), result.block_count);
      EXPECT_FALSE(info.keeps_vertex_order || info.keeps_triangle_order);
      EXPECT_FALSE(payload.info().single_coder);
      uint64_t wedges = 0;
      uint64_t triangles = 0;
      uint64_t offset_bytes = payload.info().header_bytes;
      for (const BlockInfo& block : info.blocks) {
        EXPECT_LE(block.repeated_count, block.wedge_count);
        EXPECT_EQ(block.offset_bytes, offset_bytes);
        wedges += block.wedge_count - block.repeated_count;
        triangles += block.triangle_count;
        offset_bytes += block.stream_bytes;
      }
      EXPECT_EQ(info.blocks[0].repeated_count, 0u);
      EXPECT_EQ(wedges, mesh.vertexCount());
      EXPECT_EQ(wedges, info.wedge_count);
      EXPECT_EQ(triangles, mesh.triangleCount());
      EXPECT_EQ(offset_bytes, result.payload.size());
      const PayloadInfo& all = payload.info();
      EXPECT_EQ(all.header_bytes + all.codes_bytes + all.tokens_bytes + all.raw_bits_bytes,
                result.payload.size());

      // The boxes of blocks: their triangles come one block after the other.
      Decoded decoded;
      ASSERT_TRUE(decoded.decode(payload, {}).ok());
      const auto position = [&](uint32_t wedge, uint32_t s) {
        float x = 0;
        std::memcpy(&x, &decoded.attributes[0][12 * size_t{wedge} + 4 * size_t{s}], 4);
        return x;
      };
      size_t at = 0;
      uint32_t first_wedge = 0;
      for (const BlockInfo& block : info.blocks) {
        std::set<uint32_t> used;
        for (size_t i = 0; i < 3 * size_t{block.triangle_count}; ++i)
          used.insert(decoded.parts[0][at + i]);
        at += 3 * size_t{block.triangle_count};
        const uint32_t end = first_wedge + block.wedge_count - block.repeated_count;
        for (uint32_t w = first_wedge; w < end; ++w) used.insert(w);  // isolated ones too
        first_wedge = end;
        // Two wedges of a block may be one, but never more.
        EXPECT_LE(used.size(), block.wedge_count);
        EXPECT_LT(*used.rbegin(), end);
        for (uint32_t s = 0; s < 3; ++s) {
          float low = position(*used.begin(), s);
          float high = low;
          for (const uint32_t w : used) {
            low = std::min(low, position(w, s));
            high = std::max(high, position(w, s));
          }
          EXPECT_EQ(block.low[s], low) << mesh.name;
          EXPECT_EQ(block.high[s], high) << mesh.name;
        }
      }
    }
  }
}

/// Their boxes hardly overlap, whatever the order of the triangles.
TEST(Blocks, AreCompact) {
  const TestMesh mesh = shuffled(grid(60, 60), 1);
  for (const MeshBits& bits : {MeshBits{}, kExactBits}) {
    const MeshPiece piece(mesh, bits);
    const PieceView view = piece.view();
    EncodeResult result;
    ASSERT_TRUE(encodeWith({&view, 1}, inBlocks(100), result).ok());
    ASSERT_GT(result.block_count, 50u);
    Payload payload;
    ASSERT_TRUE(payload.open(result.payload).ok());
    const auto areaOf = [](const float* low, const float* high) {
      return (high[0] - low[0]) * (high[1] - low[1]);
    };
    float low[2] = {INFINITY, INFINITY};
    float high[2] = {-INFINITY, -INFINITY};
    float sum = 0;
    for (const BlockInfo& block : payload.info().pieces[0].blocks) {
      sum += areaOf(block.low, block.high);
      for (size_t s = 0; s < 2; ++s) {
        low[s] = std::min(low[s], block.low[s]);
        high[s] = std::max(high[s], block.high[s]);
      }
    }
    EXPECT_GT(areaOf(low, high), 0);
    EXPECT_LT(sum, 1.5f * areaOf(low, high));
  }
}

TEST(Blocks, SizesAddUpToThePayload) {
  for (const TestMesh& mesh : {torus(20, 14), withUnused(chartGrid(10, 10, 3), 1, 9),
                               book(5, 12, 3), withIndexDuplicates(icosphere(2), 1, 30)}) {
    const RichPiece rich(mesh, 11);
    const RoundTrip trip = roundTrip(rich.view(), inBlocks(40));
    ASSERT_EQ(trip.failure, "") << mesh.name;
    ASSERT_GT(trip.encoded.block_count, 1u) << mesh.name;
    const StreamSizes& sizes = trip.encoded.sizes;
    const double bits =
        sizes.header_bits + sizes.connectivity_bits + sizes.stitch_bits + sizes.leftover_bits +
        sizes.seam_bits + sizes.position_bits + sizes.order_bits +
        std::accumulate(sizes.attribute_bits.begin(), sizes.attribute_bits.end(), 0.0);
    EXPECT_NEAR(bits, static_cast<double>(trip.encoded.payload.size()) * 8, 1.0) << mesh.name;
  }
}

TEST(Blocks, SmallerOnesOfARealMeshCostLittle) {
  const TestMesh mesh = jittered(icosphere(5), 1, 0.002f);
  const size_t whole = tripOf(mesh, inBlocks(0)).encoded.payload.size();
  const size_t cut = tripOf(mesh, inBlocks(2048)).encoded.payload.size();
  EXPECT_LT(cut, whole + whole / 6);
}

/// mc_edge, histogram and stage_bits are told about the glued piece.
TEST(Blocks, CallbacksWork) {
  struct Told {
    std::vector<std::array<uint32_t, 3>> edges;
    uint64_t bits = 0;
    std::set<DecodeStage> stages;
  };
  for (const RunJobs& hook : allHooks()) {
    const RichPiece rich(chartGrid(12, 12, 4), 10);
    const PieceView view = rich.view();
    EncodeResult result;
    ASSERT_TRUE(encodeWith({&view, 1}, inBlocks(40), result).ok());
    Payload payload;
    ASSERT_TRUE(payload.open(result.payload).ok());
    Told told;
    CodeHistogram histogram{};
    DecodeOptions options;
    options.run_jobs = runnerOf(hook);
    options.histogram = &histogram;
    options.mc_edge = [](void* user, uint32_t piece, uint32_t vertex, uint32_t from) {
      static_cast<Told*>(user)->edges.push_back({piece, vertex, from});
    };
    options.mc_edge_user = &told;
    options.stage_bits = [](void* user, uint32_t piece, DecodeStage stage, uint32_t,
                            uint64_t bits) {
      EXPECT_EQ(piece, 0u);
      static_cast<Told*>(user)->bits += bits;
      static_cast<Told*>(user)->stages.insert(stage);
    };
    options.stage_bits_user = &told;
    Decoded decoded;
    ASSERT_TRUE(decoded.decode(payload, options).ok());
    Decoded plain;
    ASSERT_TRUE(plain.decode(payload, {}).ok());
    EXPECT_TRUE(decoded == plain);

    // Edges are sides of triangles, up to which wedge of a vertex is meant.
    std::map<uint32_t, uint32_t> class_of;
    std::map<std::array<uint8_t, 12>, uint32_t> classes;
    for (uint32_t w = 0; w < payload.info().pieces[0].wedge_count; ++w) {
      std::array<uint8_t, 12> bytes;
      std::copy_n(&decoded.attributes[0][12 * size_t{w}], 12, bytes.begin());
      class_of[w] = classes.insert({bytes, w}).first->second;
    }
    std::set<std::pair<uint32_t, uint32_t>> sides;
    const std::vector<uint32_t>& indices = decoded.parts[0];
    for (size_t c = 0; c < indices.size(); ++c) {
      const uint32_t a = class_of.at(indices[c]);
      const uint32_t b = class_of.at(indices[c % 3 == 2 ? c - 2 : c + 1]);
      sides.insert(std::minmax(a, b));
    }
    EXPECT_GT(told.edges.size(), classes.size() / 2);
    for (const auto& [piece, vertex, from] : told.edges) {
      EXPECT_EQ(piece, 0u);
      EXPECT_EQ(sides.count(std::minmax(class_of.at(vertex), class_of.at(from))), 1u);
    }
    uint64_t operations = histogram.end;
    for (const uint64_t count : histogram.degree) operations += count;
    EXPECT_GT(operations, classes.size() / 2);
    EXPECT_LE(told.bits, 8 * result.payload.size());
    const StreamSizes& sizes = result.sizes;
    EXPECT_NEAR(static_cast<double>(told.bits),
                static_cast<double>(result.payload.size()) * 8 - sizes.header_bits,
                0.02 * static_cast<double>(told.bits) + 200.0 * result.block_count);
    for (const DecodeStage stage : {DecodeStage::kConnectivity, DecodeStage::kPositions,
                                    DecodeStage::kSeams, DecodeStage::kAttribute})
      EXPECT_TRUE(told.stages.contains(stage));
  }
}

struct Progress {
  std::vector<double> done;
  size_t cancel_at = ~size_t{0};
};

Status decodeWithProgress(const Payload& payload, const RunJobs& hook, Progress& progress) {
  DecodeOptions options;
  options.run_jobs = runnerOf(hook);
  options.progress = [](void* user, double done) {
    auto* const seen = static_cast<Progress*>(user);
    seen->done.push_back(done);
    return seen->done.size() <= seen->cancel_at;
  };
  options.progress_user = &progress;
  Decoded decoded;
  return decoded.decode(payload, options);
}

TEST(Blocks, ProgressRisesToOneAndCancels) {
  const RichPiece rich(chartGrid(12, 12, 4), 10);
  const PieceView view = rich.view();
  EncodeResult result;
  ASSERT_TRUE(encodeWith({&view, 1}, inBlocks(40), result).ok());
  Payload payload;
  ASSERT_TRUE(payload.open(result.payload).ok());
  for (const RunJobs& hook : {RunJobs(), RunJobs(runForwards), RunJobs(runBackwards)}) {
    Progress all;
    ASSERT_TRUE(decodeWithProgress(payload, hook, all).ok());
    ASSERT_GT(all.done.size(), 2u * result.block_count);
    EXPECT_TRUE(std::is_sorted(all.done.begin(), all.done.end()));
    EXPECT_GT(all.done[0], 0);
    EXPECT_EQ(all.done.back(), 1.0);
    for (size_t at = 0; at < all.done.size(); at += 7) {
      Progress some;
      some.cancel_at = at;
      EXPECT_EQ(decodeWithProgress(payload, hook, some).error, Error::kCancelled) << at;
    }
  }
}

/// Threads take turns to tell, and the last one tells that all is done.
TEST(Blocks, ProgressIsToldByOneThreadAtATime) {
  const RichPiece rich(chartGrid(12, 12, 4), 10);
  const PieceView view = rich.view();
  EncodeResult result;
  ASSERT_TRUE(encodeWith({&view, 1}, inBlocks(40), result).ok());
  Payload payload;
  ASSERT_TRUE(payload.open(result.payload).ok());
  struct Watch {
    std::atomic<int> tellers{0};
    double last = 0;
    bool is_good = true;
  };
  for (int i = 0; i < 20; ++i) {
    Watch watch;
    DecodeOptions options;
    const RunJobs hook = runOnThreads;
    options.run_jobs = runnerOf(hook);
    options.progress = [](void* user, double done) {
      auto* const w = static_cast<Watch*>(user);
      w->is_good = w->is_good && ++w->tellers == 1 && done >= w->last && done <= 1;
      w->last = done;
      --w->tellers;
      return true;
    };
    options.progress_user = &watch;
    Decoded decoded;
    ASSERT_TRUE(decoded.decode(payload, options).ok());
    EXPECT_TRUE(watch.is_good);
    EXPECT_EQ(watch.last, 1.0);
  }
  Progress cancelled;
  cancelled.cancel_at = 0;
  EXPECT_EQ(decodeWithProgress(payload, runOnThreads, cancelled).error, Error::kCancelled);
}

TEST(Blocks, TargetsMayBeLeftOutOrPadded) {
  const RichPiece rich(chartGrid(12, 12, 4), 10);
  const PieceView view = rich.view();
  for (const IndexType type : {IndexType::kUint16, IndexType::kUint32})
    EXPECT_EQ(roundTrip(view, inBlocks(40), {12, type}).failure, "");
  const TestMesh mesh = torus(12, 9);
  const MeshPiece small(mesh);
  EXPECT_EQ(roundTrip(small.view(), inBlocks(40), {4, IndexType::kUint8}).failure, "");
  EncodeResult result;
  ASSERT_TRUE(encodeWith({&view, 1}, inBlocks(40), result).ok());
  Payload payload;
  ASSERT_TRUE(payload.open(result.payload).ok());
  const PieceInfo& info = payload.info().pieces[0];
  const std::vector<AttributeTarget> attributes(info.attributes.size());
  const std::vector<PartTarget> parts(info.parts.size());
  const PieceTarget nothing = {attributes, parts};
  EXPECT_TRUE(payload.decode({&nothing, 1}).ok());
  const PieceTarget wrong = {attributes, {}};
  EXPECT_EQ(payload.decode({&wrong, 1}).error, Error::kBadArgument);
}

// ---- When there are none ------------------------------------------------------------------------

TEST(Blocks, AreRuledOutBySomeOptions) {
  const TestMesh mesh = torus(16, 12);
  const MeshPiece piece(mesh, kExactBits);
  const PieceView view = piece.view();
  const auto encoded = [&](const EncodeSettings& settings, std::span<const PieceView> pieces) {
    EncodeResult result;
    EXPECT_TRUE(encodeWith(pieces, settings, result).ok());
    EXPECT_EQ(roundTrip(pieces, settings).failure, "");
    return result;
  };
  EncodeSettings plain = inBlocks(50);
  EXPECT_GT(encoded(plain, {&view, 1}).block_count, 1u);
  EXPECT_EQ(encoded(plain, {&view, 1}).whole_because, "");

  for (const int which : {0, 1, 2}) {
    EncodeSettings settings = plain;
    settings.keep_vertex_order = which == 0;
    settings.keep_triangle_order = which == 1;
    settings.indices_only = which == 2;
    PieceView of_positions = view;
    of_positions.attributes =
        of_positions.attributes.first(which == 2 ? 1 : view.attributes.size());
    const EncodeResult result = encoded(settings, {&of_positions, 1});
    EXPECT_EQ(result.block_count, 0u) << which;
    EXPECT_NE(result.whole_because, "") << which;
  }
  const PieceView two[] = {view, view};
  EXPECT_EQ(encoded(plain, two).block_count, 0u);

  // Nobody asked for any.
  for (const uint32_t n :
       {0u, mesh.triangleCount(), mesh.triangleCount() + 1, kBlocksByPreference}) {
    const EncodeResult result = encoded(inBlocks(n), {&view, 1});
    EXPECT_EQ(result.block_count, 0u) << n;
    EXPECT_EQ(result.whole_because, "") << n;
  }
  EXPECT_GT(encoded(inBlocks(mesh.triangleCount() - 1), {&view, 1}).block_count, 1u);
}

TEST(Blocks, OfAPieceWithoutBlocksAreNone) {
  const RoundTrip trip = tripOf(torus(16, 12), inBlocks(0));
  Payload payload;
  ASSERT_TRUE(payload.open(trip.encoded.payload).ok());
  EXPECT_TRUE(payload.info().pieces[0].blocks.empty());
}

/// A surface above the usual bound is cut without being asked, unless size is all that counts.
TEST(Blocks, LargeSurfacesHaveThemByPreference) {
  const TestMesh mesh = grid(520, 520);
  for (const Preference prefer : {Preference::kSize, Preference::kBalanced, Preference::kSpeed}) {
    EncodeSettings settings;
    settings.prefer = prefer;
    const RoundTrip trip = tripOf(mesh, settings);
    EXPECT_EQ(trip.encoded.block_count > 1, prefer != Preference::kSize);
  }
}

}  // namespace
}  // namespace mcc::test
