// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tangents that repeat, or lie in faces: every choice of both bits comes back, the encoder takes
// them where they pay, and damaged payloads with them are harmless.
#include "vectors/tangent_repeats.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "base/enc_bytes.h"
#include "container/payload_header.h"
#include "format/predictors.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

AttributeFormat tangentFormat() {
  AttributeFormat format;
  format.semantic = Semantic::kTangent;
  format.component_type = ComponentType::kFloat32;
  format.component_count = 4;
  return format;
}

enum class Lie : uint8_t { kBesideNormals, kAnywhere, kOnePerFace };

/// Unit vectors with a sign. Those of kOnePerFace are the first edges of the triangles around.
std::vector<float> tangentsOf(const TestMesh& mesh, Lie lie, uint64_t seed) {
  Random random(seed);
  std::vector<float> values(size_t{4} * mesh.vertexCount(), 1.0f);
  const auto set = [&](uint32_t wedge, std::array<double, 3> t, float sign) {
    const double length = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    if (length < 1e-6) t = {1, 0, 0};
    for (uint32_t c = 0; c < 3; ++c)
      values[4 * size_t{wedge} + c] = static_cast<float>(length < 1e-6 ? t[c] : t[c] / length);
    values[4 * size_t{wedge} + 3] = sign;
  };
  for (uint32_t w = 0; w < mesh.vertexCount(); ++w) {
    const float few = static_cast<float>(random.below(3)) - 1;
    const std::array<double, 3> n = {double{mesh.normals[3 * size_t{w}]},
                                     double{mesh.normals[3 * size_t{w} + 1]},
                                     double{mesh.normals[3 * size_t{w} + 2]}};
    std::array<double, 3> t = {0.3, double{few}, 1};
    const double along = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
    for (uint32_t c = 0; c < 3 && lie == Lie::kBesideNormals; ++c) t[c] -= along * n[c];
    set(w, t, few < 0 ? -1.0f : 1.0f);
  }
  for (size_t i = 0; i + 2 < mesh.indices.size() && lie == Lie::kOnePerFace; i += 3) {
    std::array<double, 3> t{};
    for (size_t c = 0; c < 3; ++c) {
      t[c] = double{mesh.positions[3 * size_t{mesh.indices[i + 1]} + c]} -
             double{mesh.positions[3 * size_t{mesh.indices[i]} + c]};
    }
    for (size_t k = 0; k < 3; ++k) set(mesh.indices[i + k], t, i % 2 == 0 ? 1.0f : -1.0f);
  }
  return values;
}

std::vector<TestMesh> carriers() {
  std::vector<TestMesh> all = {torus(14, 9),
                               withNormals(chartGrid(10, 8, 4)),
                               flatShaded(icosphere(1)),
                               withNormals(randomSoup(4)),
                               withNormals(withRandomWedges(sheetWithHoles(4, 1), 2, 2)),
                               withNormals(withDegenerates(icosphere(1), 5, 20))};
  return all;
}

/// Normals of `normal_bits` (kNone: the mesh has none), tangents of `bits`.
RoundTrip tripOf(TestMesh mesh, uint32_t normal_bits, Lie lie, uint8_t bits,
                 const EncodeSettings& settings) {
  const std::vector<float> tangents = tangentsOf(mesh, lie, bits);
  if (normal_bits == kNone) mesh.normals.clear();
  const auto of_normals = static_cast<uint8_t>(normal_bits == kNone ? 10 : normal_bits);
  MeshPiece piece(mesh, {12, of_normals, 10});
  piece.add(tangentFormat(), tangents.data(), bits);
  return roundTrip(piece.view(), settings);
}

TEST(TangentRepeats, AllChoicesComeBack) {
  std::set<uint32_t> seen;  // the coding, and the bits
  for (const TestMesh& mesh : carriers()) {
    for (const uint32_t normal_bits : {kNone, 0u, 4u, 10u}) {
      for (const Lie lie : {Lie::kBesideNormals, Lie::kAnywhere, Lie::kOnePerFace}) {
        for (uint64_t seed = 0; seed < 6; ++seed) {
          EncodeSettings settings =
              without({Feature::kStarts, Feature::kMirrors, Feature::kAnchors, Feature::kMates});
          settings.variation = seed == 0 ? 0 : seed + 10 * normal_bits + 100 * uint64_t(lie);
          const auto bits = static_cast<uint8_t>(2 + 3 * (seed % 4));
          const RoundTrip trip = tripOf(mesh, normal_bits, lie, bits, settings);
          ASSERT_EQ(trip.failure, "")
              << mesh.name << ", normals " << normal_bits << ", bits " << int{bits} << ", lie "
              << static_cast<int>(lie) << ", seed " << seed;
          const AttributeInfo& info = trip.decoded[0].attributes.back().info;
          const uint32_t choice = info.predictor & 3u;
          seen.insert(static_cast<uint32_t>(info.coding) << 2 | choice);
          EXPECT_EQ(trip.encoded.payload[kVersionOffset], choice == 0 ? 0x10 : 0x11);
        }
      }
    }
  }
  const auto has = [&](AttributeCoding coding, uint32_t choice) {
    return seen.count(static_cast<uint32_t>(coding) << 2 | choice) != 0;
  };
  for (uint32_t choice = 0; choice < 4; ++choice) {
    EXPECT_TRUE(has(AttributeCoding::kOctahedral, choice)) << choice;
    EXPECT_EQ(has(AttributeCoding::kTangentAngle, choice), choice < 2) << choice;
  }
}

/// Bytes with all choices but those of `features`.
size_t bytesWithout(const TestMesh& mesh, Lie lie, std::initializer_list<Feature> features) {
  const RoundTrip trip = tripOf(mesh, 10, lie, 12, without(features));
  EXPECT_EQ(trip.failure, "");
  return trip.encoded.payload.size();
}

/// Three corners of a face with one tangent, in its plane, cost little more than one corner.
TEST(TangentRepeats, OnePerFacePays) {
  TestMesh mesh = flatShaded(icosphere(2));
  mesh.normals = mesh.positions;
  for (size_t w = 0; w < mesh.vertexCount(); ++w) {
    mesh.texcoords.push_back(mesh.positions[3 * w] + 0.3f * mesh.positions[3 * w + 2]);
    mesh.texcoords.push_back(mesh.positions[3 * w + 1]);
  }
  const auto bytes = [&](std::initializer_list<Feature> features) {
    return bytesWithout(mesh, Lie::kOnePerFace, features);
  };
  const size_t with = bytes({});
  EXPECT_LT(2 * with, bytes({Feature::kTangentRepeats})) << "1812 and 4006 when this was written";
  EXPECT_LT(100 * with, 97 * bytes({Feature::kTangentFaces})) << "1812 and 1888";
}

TEST(TangentRepeats, WithoutThemTheVersionIs10) {
  for (const TestMesh& mesh : carriers()) {
    for (const uint64_t variation : {0, 1, 2, 3}) {
      EncodeSettings settings =
          without({Feature::kStarts, Feature::kMirrors, Feature::kAnchors, Feature::kMates,
                   Feature::kTangentRepeats, Feature::kTangentFaces});
      settings.variation = variation;
      const RoundTrip trip = tripOf(mesh, 8, Lie::kOnePerFace, 8, settings);
      EXPECT_EQ(trip.failure, "") << mesh.name;
      EXPECT_EQ(trip.encoded.payload[kVersionOffset], 0x10) << mesh.name;
    }
  }
}

/// Whatever the streams hold, the reader ends with values or an error.
TEST(TangentRepeats, DamagedPayloads) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    EncodeSettings settings;
    settings.variation = seed;
    const std::vector<uint8_t> payload =
        tripOf(carriers()[seed % 3], seed % 2 == 0 ? 6 : kNone, Lie::kOnePerFace, 8, settings)
            .encoded.payload;
    Random random(seed);
    for (uint32_t i = 0; i < 150; ++i) {
      std::vector<uint8_t> damaged = payload;
      for (uint32_t k = random.between(1, 4); k != 0; --k) {
        damaged[random.between(kChecksummedFrom, static_cast<uint32_t>(payload.size()) - 1)] =
            static_cast<uint8_t>(random.below(256));
      }
      const uint32_t checksum = checksumOf(damaged);
      for (size_t b = 0; b < 4; ++b)
        damaged[kChecksumOffset + b] = static_cast<uint8_t>(checksum >> (8 * b));
      std::vector<DecodedPiece> pieces;
      decodePayload(damaged, {}, pieces);
    }
  }
}

}  // namespace
}  // namespace mcc::test
