// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Every kind of attribute comes back: integers and exact floats bit for bit, the others to the
// nearest point of their lattice.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "format/predictors.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

AttributeFormat formatOf(Semantic semantic, ComponentType type, uint8_t components,
                         bool normalized = false) {
  AttributeFormat format;
  format.semantic = semantic;
  format.component_type = type;
  format.component_count = components;
  format.normalized = normalized;
  return format;
}

/// Meshes attributes are tried on: smooth, with seams, with boundaries and several components,
/// wild.
std::vector<TestMesh> carriers() {
  return {torus(16, 10),
          chartGrid(12, 10, 4),
          withRandomWedges(sheetWithHoles(4, 1), 2, 2),
          looseTriangles(9),
          withUnused(uvSphere(7, 6), 3, 9),
          withRandomWedges(randomSoup(4), 5, 2),
          openFan(1)};
}

enum class Shape : uint8_t { kSmooth, kRandom, kConstant, kExtremes };
constexpr std::array<Shape, 4> kShapes = {Shape::kSmooth, Shape::kRandom, Shape::kConstant,
                                          Shape::kExtremes};

/// Bytes of `count` elements of an integer format.
std::vector<uint8_t> integerValues(const TestMesh& mesh, const AttributeFormat& format,
                                   Shape shape) {
  Random random(format.component_count + static_cast<uint64_t>(shape) * 64);
  const uint32_t width = componentBytes(format.component_type);
  std::vector<uint8_t> bytes;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    for (uint32_t k = 0; k < format.component_count; ++k) {
      uint32_t value = 0;
      switch (shape) {
        case Shape::kSmooth:
          value = static_cast<uint32_t>(std::lround(mesh.positions[v * 3 + k % 3] * 30)) + 60;
          break;
        case Shape::kRandom: value = static_cast<uint32_t>(random.next()); break;
        case Shape::kConstant: value = 77 + k; break;
        case Shape::kExtremes:
          value = random.chance(50) ? 0xffffffffu : (random.chance(50) ? 0x80808080u : 0);
          break;
      }
      for (uint32_t byte = 0; byte < width; ++byte)
        bytes.push_back(static_cast<uint8_t>(value >> (8 * byte)));
    }
  }
  return bytes;
}

std::vector<float> floatValues(const TestMesh& mesh, uint32_t components, Shape shape) {
  constexpr std::array<float, 12> kOdd = {0.0f,    -0.0f,    1.0f,      -1.0f,      1e-45f, -1e-39f,
                                          3.4e38f, -3.4e38f, kInfinity, -kInfinity, kNan,   0.1f};
  Random random(components + static_cast<uint64_t>(shape) * 64);
  std::vector<float> values;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    for (uint32_t k = 0; k < components; ++k) {
      switch (shape) {
        case Shape::kSmooth:
          values.push_back(mesh.positions[v * 3 + k % 3] * 0.25f + static_cast<float>(k));
          break;
        case Shape::kRandom: values.push_back(random.unit() * 200 - 100); break;
        case Shape::kConstant: values.push_back(-3.25f); break;
        case Shape::kExtremes:
          values.push_back(kOdd[random.below(static_cast<uint32_t>(kOdd.size()))]);
          break;
      }
    }
  }
  return values;
}

std::vector<float> unitVectors(const TestMesh& mesh, Shape shape) {
  Random random(9);
  std::vector<float> values;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    std::array<float, 3> n = {0, 0, 1};
    if (shape == Shape::kRandom)
      n = {random.unit() - 0.5f, random.unit() - 0.5f, random.unit() - 0.5f};
    if (shape == Shape::kSmooth) n = {mesh.positions[v * 3], mesh.positions[v * 3 + 1] + 0.01f, 2};
    if (shape == Shape::kExtremes) {  // corners, edges and folds of the octahedron
      n = {static_cast<float>(random.between(0, 2)) - 1,
           static_cast<float>(random.between(0, 2)) - 1,
           static_cast<float>(random.between(0, 2)) - 1};
      if (n[0] == 0 && n[1] == 0 && n[2] == 0) n[2] = -1;
    }
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (const float x : n) values.push_back(x / length);
  }
  return values;
}

/// Unit vectors at right angles to `normals`, with a sign.
std::vector<float> tangentsOf(const std::vector<float>& normals, Shape shape) {
  Random random(4);
  std::vector<float> values;
  for (size_t i = 0; i < normals.size(); i += 3) {
    const double x = static_cast<double>(normals[i]);
    const double y = static_cast<double>(normals[i + 1]);
    const double z = static_cast<double>(normals[i + 2]);
    // Two vectors across the normal, then an angle between them.
    std::array<double, 3> u =
        std::abs(x) < 0.7 ? std::array<double, 3>{0, z, -y} : std::array<double, 3>{-z, 0, x};
    const double length = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (double& c : u) c /= length;
    const std::array<double, 3> w = {y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0]};
    const CosSin angle = turn(shape == Shape::kRandom ? static_cast<double>(random.unit()) : 0.1);
    for (size_t k = 0; k < 3; ++k)
      values.push_back(static_cast<float>(u[k] * angle.cos + w[k] * angle.sin));
    values.push_back(shape != Shape::kConstant && random.chance(30) ? -1.0f : 1.0f);
  }
  return values;
}

void expectRoundTrip(const MeshPiece& piece, const std::string& what) {
  for (uint32_t prefer = 0; prefer <= 2; ++prefer) {
    EncodeOptions options;
    options.prefer = static_cast<Preference>(prefer);
    EXPECT_EQ(roundTrip(piece.view(), options, {prefer == 2 ? 4u : 0u, IndexType::kUint32}).failure,
              "")
        << what << ", preference " << prefer;
  }
}

TEST(Attributes, IntegersOfEveryFormat) {
  constexpr std::array<ComponentType, 5> kTypes = {ComponentType::kInt8, ComponentType::kUint8,
                                                   ComponentType::kInt16, ComponentType::kUint16,
                                                   ComponentType::kUint32};
  constexpr std::array<Semantic, 5> kSemantics = {Semantic::kTexcoord, Semantic::kColor,
                                                  Semantic::kJoints, Semantic::kNormal,
                                                  Semantic::kCustom};
  for (const TestMesh& mesh : carriers()) {
    for (const Shape shape : kShapes) {
      MeshPiece piece(mesh);
      std::vector<std::vector<uint8_t>> kept;
      for (const ComponentType type : kTypes) {
        for (const Semantic semantic : kSemantics) {
          uint8_t components = static_cast<uint8_t>(1 + kept.size() % 4);
          if (semantic == Semantic::kNormal) components = 3;
          AttributeFormat format = formatOf(semantic, type, components, kept.size() % 2 == 0);
          format.set_index = static_cast<uint8_t>(type);
          kept.push_back(integerValues(mesh, format, shape));
          piece.add(format, kept.back().data(), 12);  // integers ignore the bits
        }
      }
      EXPECT_EQ(roundTrip(piece.view()).failure, "")
          << mesh.name << ", shape " << static_cast<int>(shape);
    }
  }
}

TEST(Attributes, IntegerPositions) {
  for (const TestMesh& mesh : carriers()) {
    for (const ComponentType type :
         {ComponentType::kInt8, ComponentType::kUint8, ComponentType::kInt16,
          ComponentType::kUint16, ComponentType::kUint32}) {
      for (const Shape shape : kShapes) {
        const AttributeFormat format =
            formatOf(Semantic::kPosition, type, 3, shape == Shape::kRandom);
        const std::vector<uint8_t> values = integerValues(mesh, format, shape);
        MeshPiece piece(mesh);
        piece.setPositions(format, values.data());
        EXPECT_EQ(roundTrip(piece.view()).failure, "")
            << mesh.name << ", type " << static_cast<int>(type) << ", shape "
            << static_cast<int>(shape);
      }
    }
  }
}

TEST(Attributes, FloatsOfEverySemantic) {
  constexpr std::array<Semantic, 5> kSemantics = {Semantic::kTexcoord, Semantic::kColor,
                                                  Semantic::kWeights, Semantic::kCustom,
                                                  Semantic::kNormal};
  for (const TestMesh& mesh : carriers()) {
    for (const Shape shape : kShapes) {
      for (const uint8_t bits : {uint8_t{0}, uint8_t{1}, uint8_t{8}, uint8_t{12}, uint8_t{16}}) {
        MeshPiece piece(mesh);
        std::vector<std::vector<float>> kept;
        for (const Semantic semantic : kSemantics) {
          uint8_t components = semantic == Semantic::kTexcoord ? 2 : 4;
          if (semantic == Semantic::kNormal) components = 3;  // no unit vectors
          if (semantic == Semantic::kWeights && bits > 0) continue;
          if (semantic == Semantic::kNormal && bits == 1) continue;
          kept.push_back(floatValues(mesh, components, shape));
          piece.add(formatOf(semantic, ComponentType::kFloat32, components), kept.back().data(),
                    bits);
        }
        EXPECT_EQ(roundTrip(piece.view()).failure, "")
            << mesh.name << ", shape " << static_cast<int>(shape) << ", bits " << int{bits};
      }
    }
  }
}

TEST(Attributes, PositionBits) {
  const TestMesh mesh = flipped(icosphere(3), 1, 500);
  for (uint8_t bits = 0; bits <= 24; ++bits) {
    const MeshPiece piece(mesh, {bits, 10, 12});
    EXPECT_EQ(roundTrip(piece.view()).failure, "") << int{bits};
  }
}

TEST(Attributes, OddExactPositions) {
  for (const TestMesh& mesh : carriers()) {
    for (const Shape shape : kShapes) {
      TestMesh odd = mesh;
      odd.positions = floatValues(mesh, 3, shape);
      const MeshPiece exact(odd, kExactBits);
      EXPECT_EQ(roundTrip(exact.view()).failure, "")
          << mesh.name << ", shape " << static_cast<int>(shape);
      const MeshPiece lossy(odd);  // NaN and infinity make them exact
      EXPECT_EQ(roundTrip(lossy.view()).failure, "")
          << mesh.name << ", lossy, shape " << static_cast<int>(shape);
    }
  }
}

TEST(Attributes, ZeroAndMinusZeroWeldWhenLossy) {
  TestMesh mesh = grid(4, 4);
  for (float& x : mesh.positions) {
    if (x == 0) x = -0.0f;
  }
  mesh = doubled(mesh);
  for (size_t i = 0; i < mesh.positions.size() / 2; ++i) mesh.positions[i] += 0.0f;  // -0 + 0 = 0
  for (const uint8_t bits : {uint8_t{0}, uint8_t{14}}) {
    const MeshPiece piece(mesh, {bits, 10, 12});
    EXPECT_EQ(roundTrip(piece.view()).failure, "") << int{bits};
  }
}

TEST(Attributes, GivenLattice) {
  const TestMesh mesh = torus(20, 12);
  MeshPiece piece(mesh);
  const Lattice lattice = {{-2, -1.5f, -2, 0}, 1.0f / 1024};
  PieceView view = piece.view();
  std::vector<AttributeView> attributes(view.attributes.begin(), view.attributes.end());
  attributes[0].lattice = &lattice;
  view.attributes = attributes;
  const RoundTrip result = roundTrip(view);
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.decoded[0].attributes[0].info.coding, AttributeCoding::kLattice);
}

TEST(Attributes, NormalsAndTangents) {
  for (const TestMesh& carrier : carriers()) {
    for (const Shape shape : kShapes) {
      TestMesh mesh = carrier;
      mesh.normals = unitVectors(mesh, shape);
      const std::vector<float> tangents = tangentsOf(mesh.normals, shape);
      for (const uint8_t bits : {uint8_t{0}, uint8_t{2}, uint8_t{8}, uint8_t{10}, uint8_t{16}}) {
        MeshPiece piece(mesh, {14, bits, 12});
        piece.add(formatOf(Semantic::kTangent, ComponentType::kFloat32, 4), tangents.data(),
                  static_cast<uint8_t>(bits == 0 ? 0 : 12));
        expectRoundTrip(piece, mesh.name + ", shape " + std::to_string(static_cast<int>(shape)) +
                                   ", bits " + std::to_string(bits));
      }
    }
  }
}

/// Four components per wedge, sometimes with a sign.
std::vector<float> withSigns(const std::vector<float>& unit) {
  std::vector<float> tangents;
  for (size_t i = 0; i < unit.size(); i += 3) {
    for (size_t k = 0; k < 3; ++k) tangents.push_back(unit[i + k]);
    tangents.push_back(i % 2 == 0 ? 1.0f : -1.0f);
  }
  return tangents;
}

/// Expects how TANGENT is coded with normals of `normal_bits` (0: exact), or without normals.
AttributeCoding tangentCoding(TestMesh mesh, const std::vector<float>* normals, uint8_t normal_bits,
                              const std::vector<float>& tangents, uint8_t bits) {
  mesh.normals = normals == nullptr ? std::vector<float>() : *normals;
  MeshPiece piece(mesh, {14, normal_bits, 12});
  piece.add(formatOf(Semantic::kTangent, ComponentType::kFloat32, 4), tangents.data(), bits);
  expectRoundTrip(piece, mesh.name + ", normals " + std::to_string(normal_bits) + ", tangents " +
                             std::to_string(bits));
  return roundTrip(piece.view()).decoded[0].attributes.back().info.coding;
}

TEST(Attributes, TangentsWithoutGoodNormals) {
  for (const TestMesh& mesh : carriers()) {
    for (const Shape shape : kShapes) {
      const std::vector<float> normals = unitVectors(mesh, shape);
      const std::vector<float> beside = tangentsOf(normals, shape);
      const std::vector<float> askew = withSigns(unitVectors(mesh, Shape::kRandom));
      for (const uint8_t bits : {uint8_t{2}, uint8_t{8}, uint8_t{12}, uint8_t{16}}) {
        EXPECT_EQ(tangentCoding(mesh, nullptr, 0, beside, bits), AttributeCoding::kOctahedral);
        EXPECT_EQ(tangentCoding(mesh, &normals, 0, beside, bits), AttributeCoding::kOctahedral);
        EXPECT_EQ(tangentCoding(mesh, &normals, 10, askew, bits), AttributeCoding::kOctahedral);
        EXPECT_EQ(tangentCoding(mesh, &normals, 10, beside, bits), AttributeCoding::kTangentAngle);
      }
    }
  }
}

TEST(Attributes, TangentsThatAreNone) {
  const TestMesh mesh = torus(16, 10);
  const std::vector<float> good = tangentsOf(mesh.normals, Shape::kSmooth);
  std::vector<float> longer = good;
  for (size_t k = 0; k < 3; ++k) longer[40 + k] *= 1.02f;
  std::vector<float> half_sign = good;
  half_sign[43] = 0.5f;
  std::vector<float> nothing = good;
  for (size_t k = 0; k < 4; ++k) nothing[40 + k] = 0;
  std::vector<float> odd = good;
  odd[40] = kNan;
  for (const std::vector<float>* normals :
       {&mesh.normals, static_cast<const std::vector<float>*>(nullptr)}) {
    EXPECT_EQ(tangentCoding(mesh, normals, 10, longer, 12), AttributeCoding::kLattice);
    EXPECT_EQ(tangentCoding(mesh, normals, 10, half_sign, 12), AttributeCoding::kLattice);
    EXPECT_EQ(tangentCoding(mesh, normals, 10, nothing, 12), AttributeCoding::kLattice);
    const AttributeCoding exact = tangentCoding(mesh, normals, 10, odd, 12);
    EXPECT_TRUE(exact == AttributeCoding::kExactFloat || exact == AttributeCoding::kGrid);
  }
}

/// Tangents along u cost little on the grid, and less when projected on exact normals.
TEST(Attributes, TangentsOnTheGridFollowTheChart) {
  TestMesh mesh = torus(48, 32);
  mesh.texcoords.clear();
  std::vector<float> tangents;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const float* p = &mesh.positions[v * 3];
    const float* n = &mesh.normals[v * 3];
    mesh.texcoords.push_back(p[0] + 0.25f * p[1]);
    mesh.texcoords.push_back(p[2]);
    // In the plane of the normal and across the gradient of v, where u grows.
    std::array<double, 3> t = {static_cast<double>(n[1]), -static_cast<double>(n[0]), 0};
    const double length = std::hypot(t[0], t[1]);
    const double side = t[0] + 0.25 * t[1] < 0 ? -1 : 1;
    if (length < 1e-6) t = {1, 0, 0};
    for (const double x : t)
      tangents.push_back(static_cast<float>(length < 1e-6 ? x : side * x / length));
    tangents.push_back(1);
  }
  const auto bitsPerTangent = [&](bool with_normals) {
    TestMesh carrier = mesh;
    if (!with_normals) carrier.normals.clear();
    MeshPiece piece(carrier, {14, 0, 12});
    piece.add(formatOf(Semantic::kTangent, ComponentType::kFloat32, 4), tangents.data(), 12);
    const RoundTrip result = roundTrip(piece.view());
    EXPECT_EQ(result.failure, "");
    EXPECT_EQ(result.decoded[0].attributes.back().info.coding, AttributeCoding::kOctahedral);
    return result.encoded.sizes.attribute_bits.back() / mesh.vertexCount();
  };
  const double alone = bitsPerTangent(false);
  RecordProperty("alone", std::to_string(alone));
  RecordProperty("with_normals", std::to_string(bitsPerTangent(true)));
  EXPECT_LT(alone, 12);
  EXPECT_LT(bitsPerTangent(true), 0.9 * alone);
}

TEST(Attributes, Skins) {
  for (const TestMesh& mesh : carriers()) {
    Random random(2);
    std::vector<uint8_t> joints;
    std::vector<float> weights;
    std::vector<uint8_t> normalized;
    for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
      const float second = random.chance(50) ? 0.0f : random.unit() * 0.5f;
      const float third = second > 0 && random.chance(50) ? random.unit() * 0.25f : 0.0f;
      for (const float w : {1 - second - third, second, third, 0.0f}) weights.push_back(w);
      for (const bool uses : {true, second > 0, third > 0, false}) {
        joints.push_back(static_cast<uint8_t>(uses ? v / 9 + random.below(3) : 0));
      }
      const uint8_t part = static_cast<uint8_t>(random.below(100));
      for (const int w : {255 - part, int{part}, 0, 0})
        normalized.push_back(static_cast<uint8_t>(w));
    }
    for (const uint8_t bits : {uint8_t{0}, uint8_t{8}, uint8_t{12}}) {
      MeshPiece piece(mesh);
      piece.add(formatOf(Semantic::kJoints, ComponentType::kUint8, 4), joints.data());
      piece.add(formatOf(Semantic::kWeights, ComponentType::kFloat32, 4), weights.data(), bits);
      AttributeFormat second_set = formatOf(Semantic::kJoints, ComponentType::kUint8, 4);
      second_set.set_index = 1;
      piece.add(second_set, joints.data());
      second_set = formatOf(Semantic::kWeights, ComponentType::kUint8, 4, true);
      second_set.set_index = 1;
      piece.add(second_set, normalized.data());
      expectRoundTrip(piece, mesh.name + ", bits " + std::to_string(bits));
    }
  }
}

TEST(Attributes, MorphTargets) {
  for (const TestMesh& mesh : carriers()) {
    std::vector<std::vector<float>> kept;
    MeshPiece piece(mesh);
    for (uint16_t target = 1; target <= 5; ++target) {
      std::vector<float> deltas(mesh.positions.size(), 0.0f);
      Random random(target);
      for (size_t i = 0; i < deltas.size(); ++i) {  // some move all, some few, one nothing
        if (target != 3 && (target == 1 || i / 3 % 11 < target))
          deltas[i] = random.unit() * 0.1f - 0.05f;
      }
      kept.push_back(std::move(deltas));
      AttributeFormat format = formatOf(Semantic::kPosition, ComponentType::kFloat32, 3);
      format.morph_target = target;
      piece.add(format, kept.back().data(), target == 5 ? 0 : 12);
      format.semantic = Semantic::kNormal;
      piece.add(format, kept.back().data(), target == 5 ? 0 : 10);
      format.semantic = Semantic::kTangent;
      piece.add(format, kept.back().data(), 10);
    }
    expectRoundTrip(piece, mesh.name);
  }
}

/// Scrambled names of the stripes of a sheet: most vertices have the name of their neighbours.
TEST(Attributes, IdsOfStripes) {
  const TestMesh mesh = grid(80, 80);
  std::vector<uint16_t> ids;
  std::vector<float> floats;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const uint32_t stripe = v / 81 / 4;
    ids.push_back(static_cast<uint16_t>(stripe * 40503u));
    floats.push_back(static_cast<float>(stripe * 7919u % 104729u));
  }
  MeshPiece piece(mesh);
  AttributeFormat format = formatOf(Semantic::kCustom, ComponentType::kUint16, 1);
  piece.add(format, ids.data());
  format.component_type = ComponentType::kFloat32;
  format.set_index = 1;
  piece.add(format, floats.data());
  expectRoundTrip(piece, "stripes");
  const RoundTrip result = roundTrip(piece.view());
  const auto& attributes = result.decoded[0].attributes;
  const std::vector<double>& bits = result.encoded.sizes.attribute_bits;
  for (size_t i = attributes.size() - 2; i < attributes.size(); ++i) {
    EXPECT_NE(attributes[i].info.predictor & value_method::kFlags, 0) << i;
    RecordProperty("bytes_" + std::to_string(i), std::to_string(bits[i] / 8));
    EXPECT_LT(bits[i] / 8, 500) << i;
  }
}

/// Eight influences: tuples whose sum over both sets is 1 still sum to 1.
TEST(Attributes, WeightsOfTwoSetsSumToOne) {
  for (const TestMesh& mesh : carriers()) {
    Random random(3);
    std::array<std::vector<float>, 2> weights;
    std::array<std::vector<uint8_t>, 2> joints;
    for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
      std::array<double, 8> w{};
      double sum = 0;
      const uint32_t used = random.between(1, 8);
      for (uint32_t k = 0; k < used; ++k) sum += w[k] = 0.01 + static_cast<double>(random.unit());
      for (uint32_t k = 0; k < 8; ++k) {
        weights[k / 4].push_back(static_cast<float>(w[k] / sum));
        joints[k / 4].push_back(static_cast<uint8_t>(k < used ? v / 20 + 3 * k : 0));
      }
    }
    for (const uint8_t bits : {uint8_t{0}, uint8_t{8}, uint8_t{12}, uint8_t{16}}) {
      MeshPiece piece(mesh);
      for (uint8_t set = 0; set < 2; ++set) {
        AttributeFormat format = formatOf(Semantic::kJoints, ComponentType::kUint8, 4);
        format.set_index = set;
        piece.add(format, joints[set].data());
        format = formatOf(Semantic::kWeights, ComponentType::kFloat32, 4);
        format.set_index = set;
        piece.add(format, weights[set].data(), bits);
      }
      const RoundTrip result = roundTrip(piece.view());
      ASSERT_EQ(result.failure, "") << mesh.name << ", bits " << int{bits};
      if (bits == 0) continue;
      const auto& decoded = result.decoded[0].attributes;
      const size_t last = decoded.size() - 1;  // WEIGHTS_1, after WEIGHTS_0 and JOINTS_1
      for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        double points = 0;
        for (const size_t a : {last - 2, last}) {
          for (uint32_t k = 0; k < 4; ++k) {
            float w = 0;
            std::memcpy(&w, decoded[a].bytes.data() + 16 * size_t{v} + 4 * size_t{k}, 4);
            points += std::round(static_cast<double>(w) /
                                 static_cast<double>(decoded[a].info.lattice.step));
          }
        }
        ASSERT_EQ(points, std::ldexp(1.0, bits) - 1) << mesh.name << ", wedge " << v;
      }
    }
  }
}

/// Tuples whose sum is not even close to 1 are rounded one by one.
TEST(Attributes, OtherWeightsMoveByHalfAStep) {
  const TestMesh mesh = torus(16, 12);
  Random random(9);
  std::vector<float> weights;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const float a = 0.9995f * random.unit();
    weights.insert(weights.end(), {a, 0.9995f - a, 0, 0});
  }
  MeshPiece piece(mesh);
  piece.add(formatOf(Semantic::kWeights, ComponentType::kFloat32, 4), weights.data(), 12);
  const RoundTrip result = roundTrip(piece.view());
  ASSERT_EQ(result.failure, "");
  const DecodedAttribute& decoded = result.decoded[0].attributes.back();
  const std::vector<uint32_t>& source = result.encoded.pieces[0].source_wedge;
  for (size_t i = 0; i < weights.size(); ++i) {
    float w = 0;
    std::memcpy(&w, decoded.bytes.data() + 4 * i, 4);
    const float from = weights[4 * size_t{source[i / 4]} + i % 4];
    ASSERT_LE(std::fabs(double{w} - double{from}), 0.5001 / 4095);
  }
}

/// A few far values do not cost all other values their precision.
TEST(Attributes, OutliersKeepAnAttributeExact) {
  const TestMesh mesh = torus(24, 16);
  std::vector<float> texcoords(size_t{2} * mesh.vertexCount());
  for (size_t i = 0; i < texcoords.size(); ++i) texcoords[i] = 0.001f * static_cast<float>(i);
  const auto codingOf = [&](std::vector<std::string>& notes) {
    MeshPiece piece(mesh);
    piece.add(formatOf(Semantic::kTexcoord, ComponentType::kFloat32, 2), texcoords.data(), 12);
    const PieceView view = piece.view();
    EncodeResult result;
    EXPECT_TRUE(encode(std::span<const PieceView>(&view, 1), {}, result).ok());
    notes = result.notes;
    Payload payload;
    EXPECT_TRUE(payload.open(result.payload).ok());
    return payload.info().pieces[0].attributes.back().coding;
  };
  std::vector<std::string> notes;
  EXPECT_EQ(codingOf(notes), AttributeCoding::kLattice);
  EXPECT_TRUE(notes.empty());
  texcoords[17] = 1e6f;
  EXPECT_NE(codingOf(notes), AttributeCoding::kLattice);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("TEXCOORD_0 has outliers"), std::string::npos) << notes[0];
}

/// Deltas to normals and tangents of the moved surface, and what they cost per moved wedge.
TEST(Attributes, MorphTargetsOfUnitVectors) {
  const TestMesh mesh = torus(48, 32);
  const std::vector<float> tangents = tangentsOf(mesh.normals, Shape::kConstant);
  TestMesh moved = mesh;
  uint32_t moved_count = 0;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    float* p = &moved.positions[v * 3];
    if (p[0] < 0) continue;
    ++moved_count;
    p[1] += 0.3f * p[0] * p[2];
  }
  moved.normals.assign(mesh.positions.size(), 0.0f);
  std::vector<double> sums(mesh.positions.size());
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::array<std::array<double, 3>, 2> e{};
    for (size_t k = 0; k < 3; ++k) {
      for (size_t i = 0; i < 2; ++i) {
        e[i][k] = static_cast<double>(moved.positions[mesh.indices[t + 1 + i] * 3 + k]) -
                  static_cast<double>(moved.positions[mesh.indices[t] * 3 + k]);
      }
    }
    for (size_t k = 0; k < 3; ++k) {
      const double area =
          e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
      for (size_t i = 0; i < 3; ++i) sums[mesh.indices[t + i] * 3 + k] += area;
    }
  }
  for (size_t v = 0; v < sums.size(); v += 3) {
    const double length = std::hypot(sums[v], sums[v + 1], sums[v + 2]);
    const bool moves = moved.positions[v + 1] != mesh.positions[v + 1];
    for (size_t k = 0; k < 3; ++k) {
      moved.normals[v + k] = moves ? static_cast<float>(sums[v + k] / length) : mesh.normals[v + k];
    }
  }
  std::vector<float> moved_tangents = tangentsOf(moved.normals, Shape::kConstant);
  std::array<std::vector<float>, 3> deltas;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    deltas[0].push_back(moved.positions[i] - mesh.positions[i]);
    deltas[1].push_back(moved.normals[i] - mesh.normals[i]);
    deltas[2].push_back(moved_tangents[i / 3 * 4 + i % 3] - tangents[i / 3 * 4 + i % 3]);
  }
  for (const uint8_t bits : {uint8_t{0}, uint8_t{10}}) {
    MeshPiece piece(mesh, {static_cast<uint8_t>(bits == 0 ? 0 : 14), bits, 12});
    piece.add(formatOf(Semantic::kTangent, ComponentType::kFloat32, 4), tangents.data(), bits);
    AttributeFormat format = formatOf(Semantic::kPosition, ComponentType::kFloat32, 3);
    format.morph_target = 1;
    piece.add(format, deltas[0].data(), bits == 0 ? 0 : 14);
    format.semantic = Semantic::kNormal;
    piece.add(format, deltas[1].data(), bits);
    format.semantic = Semantic::kTangent;
    piece.add(format, deltas[2].data(), bits);
    const RoundTrip result = roundTrip(piece.view());
    ASSERT_EQ(result.failure, "") << int{bits};
    const size_t count = result.encoded.sizes.attribute_bits.size();
    const double normal_bits = result.encoded.sizes.attribute_bits[count - 2] / moved_count;
    const double tangent_bits = result.encoded.sizes.attribute_bits[count - 1] / moved_count;
    RecordProperty("normal_bits_" + std::to_string(bits), std::to_string(normal_bits));
    RecordProperty("tangent_bits_" + std::to_string(bits), std::to_string(tangent_bits));
    if (bits == 0) continue;
    EXPECT_LT(normal_bits, 13);
    EXPECT_LT(tangent_bits, 14);
  }
}

/// Every semantic that can move, densely and sparsely.
TEST(Attributes, MorphTargetsOfColorsAndCharts) {
  for (const TestMesh& carrier : carriers()) {
    for (const uint8_t bits : {uint8_t{0}, uint8_t{8}, uint8_t{12}}) {
      MeshPiece piece(carrier);
      const std::vector<float> colors = floatValues(carrier, 4, Shape::kSmooth);
      const std::vector<float> chart = floatValues(carrier, 2, Shape::kSmooth);
      piece.add(formatOf(Semantic::kTexcoord, ComponentType::kFloat32, 2), chart.data(), bits);
      piece.add(formatOf(Semantic::kColor, ComponentType::kFloat32, 4), colors.data(), bits);
      std::vector<std::vector<float>> kept;
      for (uint16_t target = 1; target <= 4; ++target) {
        for (const Semantic semantic : {Semantic::kTexcoord, Semantic::kColor}) {
          const uint8_t components = semantic == Semantic::kColor ? 4 : 2;
          const Shape shape = target % 2 == 0 ? Shape::kRandom : Shape::kSmooth;
          std::vector<float> deltas = floatValues(carrier, components, shape);
          for (size_t i = 0; i < deltas.size(); ++i) {
            if (target > 2 && i / components % 7 != 0) deltas[i] = 0;
          }
          kept.push_back(std::move(deltas));
          AttributeFormat format = formatOf(semantic, ComponentType::kFloat32, components);
          format.morph_target = target;
          piece.add(format, kept.back().data(), bits);
        }
      }
      expectRoundTrip(piece, carrier.name + ", bits " + std::to_string(bits));
    }
  }
}

/// Deltas with NaN and infinity are coded exactly, whatever the bits.
TEST(Attributes, MorphTargetsWithOddFloats) {
  for (const TestMesh& carrier : carriers()) {
    TestMesh mesh = carrier;
    mesh.normals = unitVectors(mesh, Shape::kRandom);
    const std::vector<float> tangents = tangentsOf(mesh.normals, Shape::kRandom);
    const std::vector<float> smooth = floatValues(mesh, 3, Shape::kSmooth);
    const std::vector<float> odd = floatValues(mesh, 3, Shape::kExtremes);
    MeshPiece piece(mesh);
    piece.add(formatOf(Semantic::kTangent, ComponentType::kFloat32, 4), tangents.data(), 12);
    for (uint16_t target = 1; target <= 4; ++target) {
      uint32_t place = 0;
      for (const Semantic semantic : {Semantic::kPosition, Semantic::kNormal, Semantic::kTangent}) {
        AttributeFormat format = formatOf(semantic, ComponentType::kFloat32, 3);
        format.morph_target = target;
        const bool is_odd = target == 4 || ++place == target;
        piece.add(format, is_odd ? odd.data() : smooth.data(), 10);
      }
    }
    expectRoundTrip(piece, mesh.name);
  }
}

TEST(Attributes, EqualAttributesAndManyOfThem) {
  const TestMesh mesh = chartGrid(10, 10, 5);
  MeshPiece piece(mesh);
  for (uint8_t set = 1; set < 60; ++set) {
    AttributeFormat format = formatOf(Semantic::kTexcoord, ComponentType::kFloat32, 2);
    format.set_index = set;
    piece.add(format, mesh.texcoords.data(), set % 2 == 0 ? 12 : 0);
  }
  expectRoundTrip(piece, "sixty times the same texture coordinates");
}

TEST(Attributes, WideCustomOnes) {
  for (const TestMesh& mesh : carriers()) {
    std::vector<std::vector<uint8_t>> integers;
    std::vector<std::vector<float>> floats;
    MeshPiece piece(mesh);
    for (const uint8_t components :
         {uint8_t{1}, uint8_t{2}, uint8_t{3}, uint8_t{4}, uint8_t{9}, uint8_t{16}}) {
      AttributeFormat format = formatOf(Semantic::kCustom, ComponentType::kUint16, components);
      format.set_index = components;
      integers.push_back(integerValues(mesh, format, Shape::kSmooth));
      piece.add(format, integers.back().data());
      format.component_type = ComponentType::kFloat32;
      format.set_index = static_cast<uint8_t>(100 + components);
      floats.push_back(floatValues(mesh, components, Shape::kSmooth));
      piece.add(format, floats.back().data());
    }
    expectRoundTrip(piece, mesh.name);
  }
}

TEST(Attributes, StridedSources) {
  const TestMesh mesh = torus(9, 7);
  std::vector<float> interleaved;
  for (size_t v = 0; v < mesh.vertexCount(); ++v) {
    for (size_t k = 0; k < 3; ++k) interleaved.push_back(mesh.positions[v * 3 + k]);
    for (size_t k = 0; k < 3; ++k) interleaved.push_back(mesh.normals[v * 3 + k]);
  }
  const MeshPiece piece(mesh);
  PieceView view = piece.view();
  std::vector<AttributeView> attributes(view.attributes.begin(), view.attributes.end());
  attributes[0].data = interleaved.data();
  attributes[1].data = interleaved.data() + 3;
  attributes[0].stride_bytes = attributes[1].stride_bytes = 24;
  const RoundTrip tight = roundTrip(view);
  view.attributes = attributes;
  const RoundTrip strided = roundTrip(view);
  EXPECT_EQ(tight.failure, "");
  EXPECT_EQ(strided.failure, "");
  EXPECT_EQ(strided.encoded.payload, tight.encoded.payload);
}

/// The codes of joints end below this value.
TEST(Attributes, JointsOfAllOnesAreRefused) {
  const TestMesh mesh = torus(4, 4);
  const std::vector<uint8_t> weights(size_t{4} * mesh.vertexCount(), 63);
  for (const uint32_t joint : {~1u, ~0u}) {
    std::vector<uint32_t> joints(size_t{4} * mesh.vertexCount(), 3);
    joints[9] = joint;
    MeshPiece piece(mesh);
    piece.add(formatOf(Semantic::kJoints, ComponentType::kUint32, 4), joints.data());
    piece.add(formatOf(Semantic::kWeights, ComponentType::kUint8, 4, true), weights.data());
    const RoundTrip result = roundTrip(piece.view());
    if (joint == ~0u) {
      EXPECT_NE(result.failure.find("cannot be -1"), std::string::npos) << result.failure;
    } else {
      EXPECT_EQ(result.failure, "");
    }
  }
}

TEST(Attributes, WrongArgumentsAreRefused) {
  const TestMesh mesh = torus(4, 4);
  const MeshPiece piece(mesh);
  const auto refuses = [](const PieceView& view) {
    EncodeResult result;
    return encode(std::span<const PieceView>(&view, 1), {}, result).error == Error::kBadArgument;
  };
  std::vector<AttributeView> attributes(piece.view().attributes.begin(),
                                        piece.view().attributes.end());
  PieceView view = piece.view();
  view.attributes = attributes;
  EXPECT_FALSE(refuses(view));

  const std::vector<uint32_t> beyond = {0, 1, mesh.vertexCount()};
  const PartView bad_part = {beyond};
  view.parts = std::span<const PartView>(&bad_part, 1);
  EXPECT_TRUE(refuses(view)) << "index out of range";
  view.parts = piece.view().parts;

  attributes[0].data = nullptr;
  EXPECT_TRUE(refuses(view)) << "no data";
  attributes[0] = piece.view().attributes[0];
  attributes[0].quantization_bits = 25;
  EXPECT_TRUE(refuses(view)) << "too many bits";
  attributes[0] = piece.view().attributes[0];
  attributes[0].stride_bytes = 11;
  EXPECT_TRUE(refuses(view)) << "stride below the element";
  attributes[0] = piece.view().attributes[0];
  attributes[0].format.component_count = 2;
  EXPECT_TRUE(refuses(view)) << "positions of two components";
  view.attributes = std::span<const AttributeView>(attributes).subspan(1);
  EXPECT_TRUE(refuses(view)) << "no positions";
}

TEST(Attributes, LatticesThatAreNoneAreRefused) {
  const TestMesh mesh = torus(4, 4);
  const MeshPiece piece(mesh);
  AttributeView position = piece.view().attributes[0];
  position.quantization_bits = 14;
  PieceView view = piece.view();
  view.attributes = std::span<const AttributeView>(&position, 1);
  const auto errorOn = [&](const Lattice& lattice) {
    position.lattice = &lattice;
    EncodeResult result;
    return encode(std::span<const PieceView>(&view, 1), {}, result).error;
  };
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(errorOn({{-2, -2, -2, 0}, 0.125f}), Error::kOk);
  EXPECT_EQ(errorOn({{-2, -2, -2, kNaN}, 0.125f}), Error::kOk);  // positions have three origins
  for (const float step : {0.0f, -0.0f, -1.0f, kInfinity, -kInfinity, kNaN})
    EXPECT_EQ(errorOn({{0, 0, 0, 0}, step}), Error::kBadArgument) << step;
  for (const float origin : {kInfinity, -kInfinity, kNaN}) {
    for (uint32_t c = 0; c < 3; ++c) {
      Lattice lattice{{0, 0, 0, 0}, 0.125f};
      lattice.origin[c] = origin;
      EXPECT_EQ(errorOn(lattice), Error::kBadArgument) << origin;
    }
  }
}

}  // namespace
}  // namespace mcc::test
