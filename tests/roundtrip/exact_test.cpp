// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// Exact floats of every semantic come back bit for bit, whether they are on a grid or not.
// Exact floats of every semantic come back bit for bit, whatever grid they are on or not.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

enum class Kind : uint8_t {
  kThousandths,
  kMillionths,
  kBinary,
  kBytes,
  kFull,      ///< all bits in use
  kRepeated,  ///< the same, few distinct values
  kOutlier,
  kMinusZero,
  kDenormal,
  kInfinite,
  kNan,
  kCount,
};

double nearest(float x, double scale) {
  return std::round(static_cast<double>(x) * scale) + 0.0;
}  // no -0

float valueOf(Kind kind, float x, uint32_t i) {
  const bool odd = i % 31 == 7;
  switch (kind) {
    case Kind::kThousandths: return static_cast<float>(nearest(x, 1000) / 1000.0);
    case Kind::kMillionths: return static_cast<float>(nearest(x, 1e6) / 1e6);
    case Kind::kBinary: return static_cast<float>(nearest(x, 4096) / 4096.0);
    case Kind::kBytes:
      return static_cast<float>((static_cast<int32_t>(nearest(x, 77)) & 255) / 255.0);
    case Kind::kFull: return x * 1.2345678f + 0.1f;
    case Kind::kRepeated: return static_cast<float>(nearest(x, 5)) * 1.2345678f;
    case Kind::kOutlier: return odd ? x * 1e7f : static_cast<float>(nearest(x, 100) / 100.0);
    case Kind::kMinusZero: return odd ? -0.0f : i % 3 == 0 ? 0.0f : x;
    case Kind::kDenormal: return odd ? std::bit_cast<float>(i * 37 % 0x800000) : x;
    case Kind::kInfinite:
      return odd ? (i % 2 == 0 ? 1.0f : -1.0f) * std::numeric_limits<float>::infinity() : x;
    case Kind::kNan: return odd ? std::bit_cast<float>(0xff812345u ^ (i << 3)) : x;
    case Kind::kCount: break;
  }
  return x;
}

std::vector<float> valuesOf(Kind kind, const TestMesh& mesh, uint32_t components) {
  std::vector<float> values;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    for (uint32_t c = 0; c < components; ++c) {
      values.push_back(valueOf(kind, mesh.positions[3 * v + c % 3], components * v + c));
    }
  }
  return values;
}

std::vector<TestMesh> exactCarriers() {
  return {grid(7, 6),
          chartGrid(12, 10, 4),
          withNormals(torus(16, 10)),
          doubled(torus(9, 7)),
          withRandomWedges(sheetWithHoles(4, 1), 2, 2),
          withUnused(uvSphere(7, 6), 3, 9),
          withRandomWedges(randomSoup(4), 5, 2),
          withPositionDuplicates(icosphere(1), 5, 9),
          openFan(1)};
}

AttributeFormat floatsOf(Semantic semantic, uint8_t components, uint16_t target = 0) {
  AttributeFormat format;
  format.semantic = semantic;
  format.component_count = components;
  format.morph_target = target;
  return format;
}

TEST(Exact, EverySemanticOnEveryGrid) {
  const std::vector<AttributeFormat> formats = {
      floatsOf(Semantic::kNormal, 3),      floatsOf(Semantic::kTangent, 4),
      floatsOf(Semantic::kTexcoord, 2),    floatsOf(Semantic::kColor, 4),
      floatsOf(Semantic::kColor, 3),       floatsOf(Semantic::kWeights, 4),
      floatsOf(Semantic::kCustom, 1),      floatsOf(Semantic::kCustom, 16),
      floatsOf(Semantic::kPosition, 3, 1), floatsOf(Semantic::kNormal, 3, 1),
      floatsOf(Semantic::kTangent, 3, 1),
  };
  for (const TestMesh& carrier : exactCarriers()) {
    for (uint8_t k = 0; k < static_cast<uint8_t>(Kind::kCount); ++k) {
      const Kind kind = static_cast<Kind>(k);
      TestMesh mesh = carrier;
      mesh.normals.clear();
      mesh.texcoords.clear();
      mesh.positions = valuesOf(kind, carrier, 3);
      MeshPiece piece(mesh, kExactBits);
      std::vector<std::vector<float>> memory;
      for (const AttributeFormat& format : formats) {
        memory.push_back(valuesOf(kind, carrier, format.component_count));
      }
      for (size_t i = 0; i < formats.size(); ++i) piece.add(formats[i], memory[i].data());
      EXPECT_EQ(roundTrip(piece.view()).failure, "") << mesh.name << ", kind " << int{k};
    }
  }
}

/// The largest numbers of a coarse lattice, rounded up.
TEST(Exact, WhatWouldRoundToInfinity) {
  TestMesh mesh = grid(8, 6);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.positions[i] = i % 3 == 0 ? -3.0e38f : i % 3 == 1 ? 3.39e38f : 0.0f;
  }
  for (uint8_t bits = 1; bits <= 6; ++bits) {
    EXPECT_EQ(roundTrip(MeshPiece(mesh, {bits, 0, 0}).view()).failure, "") << int{bits};
  }
}

/// The bits of such a NaN are the least number there is. It begins the list of the few values of
/// each axis.
TEST(Exact, NanOfAllOnes) {
  TestMesh mesh = grid(24, 20);
  for (size_t i = 0; i < mesh.positions.size(); i += 31) {
    mesh.positions[i] = std::bit_cast<float>(~0u);
  }
  EXPECT_EQ(roundTrip(MeshPiece(mesh, kExactBits).view()).failure, "");
}

/// Unit normals as programs compute them, with tangents, and charts that are used twice.
TEST(Exact, ComputedNormalsAndTangents) {
  for (TestMesh mesh : {withNormals(torus(16, 10)), withNormals(chartGrid(12, 10, 4)),
                        withNormals(doubled(torus(9, 7))), withNormals(randomSoup(4))}) {
    std::vector<float> tangents;
    std::vector<float> chart;
    for (size_t v = 0; v < mesh.vertexCount(); ++v) {
      const double nx = double{mesh.normals[3 * v]};
      const double ny = double{mesh.normals[3 * v + 1]};
      const double length = std::sqrt(nx * nx + ny * ny) + 1e-30;
      tangents.insert(tangents.end(),
                      {static_cast<float>(-ny / length), static_cast<float>(nx / length), 0.0f,
                       v % 5 == 0 ? -1.0f : 1.0f});
      chart.push_back(std::fabs(mesh.positions[3 * v]) * 0.37f);
      chart.push_back(std::fabs(mesh.positions[3 * v + 1]) * 0.37f);
    }
    mesh.texcoords = chart;
    MeshPiece piece(mesh, kExactBits);
    piece.add(floatsOf(Semantic::kTangent, 4), tangents.data());
    EXPECT_EQ(roundTrip(piece.view()).failure, "") << mesh.name;
    // Exact values next to a lattice.
    MeshPiece mixed(mesh, {14, 0, 12});
    mixed.add(floatsOf(Semantic::kTangent, 4), tangents.data());
    EXPECT_EQ(roundTrip(mixed.view()).failure, "") << mesh.name;
    MeshPiece other(mesh, {0, 10, 0});
    other.add(floatsOf(Semantic::kTangent, 4), tangents.data());
    EXPECT_EQ(roundTrip(other.view()).failure, "") << mesh.name;
  }
}

TEST(Exact, SkinsWithWeightsOnGrids) {
  const TestMesh mesh = withRandomWedges(torus(12, 8), 3, 2);
  std::vector<uint8_t> joints;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    for (uint32_t c = 0; c < 4; ++c) joints.push_back(static_cast<uint8_t>((v / 9 + c * 3) % 11));
  }
  AttributeFormat format = floatsOf(Semantic::kJoints, 4);
  format.component_type = ComponentType::kUint8;
  for (uint8_t k = 0; k < static_cast<uint8_t>(Kind::kCount); ++k) {
    std::vector<float> weights = valuesOf(static_cast<Kind>(k), mesh, 4);
    for (float& w : weights) w = std::fabs(w) < 0.3f ? w * 1e-30f : w;
    MeshPiece piece(mesh, kExactBits);
    piece.add(format, joints.data());
    piece.add(floatsOf(Semantic::kWeights, 4), weights.data());
    EXPECT_EQ(roundTrip(piece.view()).failure, "") << "kind " << int{k};
  }
}

}  // namespace
}  // namespace mcc::test
