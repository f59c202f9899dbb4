// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// From accessors to integers and back.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "format/codings.h"
#include "mesh/dequantize.h"
#include "prepare/enc_quantize.h"
#include "support/mesh_generators.h"
#include "vectors/octahedral.h"
#include "vectors/tangents.h"

namespace mcc::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// One attribute; it follows a position if it is not a position itself.
QuantizedAttribute quantizedAlone(const AttributeView& view, uint32_t wedge_count,
                                  std::vector<std::string>& notes) {
  const std::vector<float> origin(3 * size_t{wedge_count}, 0);
  std::vector<AttributeView> attributes(1);
  attributes[0].data = origin.data();
  attributes[0].stride_bytes = 12;
  attributes[0].quantization_bits = 1;
  if (view.format.semantic == Semantic::kPosition) attributes.clear();
  attributes.push_back(view);
  return quantizeAttributes({wedge_count, attributes, {}}, {}, notes).back();
}

struct Quantized {
  QuantizedAttribute attribute;
  std::vector<std::string> notes;
};

Quantized quantized(const std::vector<float>& values, uint8_t components, uint8_t bits,
                    Semantic semantic = Semantic::kPosition, const Lattice* lattice = nullptr) {
  AttributeView view;
  view.format.semantic = semantic;
  view.format.component_count = components;
  view.data = values.data();
  view.stride_bytes = size_t{4} * components;
  view.quantization_bits = bits;
  view.lattice = lattice;
  Quantized result;
  result.attribute =
      quantizedAlone(view, static_cast<uint32_t>(values.size() / components), result.notes);
  return result;
}

/// Returns every component as the reader will return it.
float decoded(const QuantizedAttribute& a, size_t i) {
  if (isExact(a.info.coding)) return std::bit_cast<float>(bitsFromOrdered(a.values[i]));
  return latticeValue(a.values[i], a.info.lattice.step, a.info.lattice.origin[i % a.components]);
}

void expectExact(const Quantized& q, const std::vector<float>& values) {
  EXPECT_TRUE(isExact(q.attribute.info.coding));
  for (size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::bit_cast<uint32_t>(decoded(q.attribute, i)), std::bit_cast<uint32_t>(values[i]));
  }
}

TEST(Quantize, LatticeErrorIsHalfAStep) {
  Random random(1);
  for (uint8_t bits = 1; bits <= 24; ++bits) {
    for (const float scale : {1e-20f, 1.0f, 3e7f}) {
      for (const uint8_t components : {uint8_t{1}, uint8_t{2}, uint8_t{3}, uint8_t{4}}) {
        std::vector<float> values(size_t{components} * 200);
        for (float& x : values) x = (random.unit() - 0.3f) * scale;
        const Quantized q = quantized(values, components, bits, Semantic::kCustom);
        ASSERT_EQ(q.attribute.info.coding, AttributeCoding::kLattice);
        EXPECT_EQ(q.attribute.info.bits, bits);
        EXPECT_TRUE(q.notes.empty());
        const double step = q.attribute.info.lattice.step;
        EXPECT_LE(step * (std::ldexp(1.0, bits) - 1), scale * 1.001);
        for (size_t i = 0; i < values.size(); ++i) {
          EXPECT_GE(q.attribute.values[i], 0);
          EXPECT_LE(q.attribute.values[i], 1 << bits);
          // Half a step, and what float32 cannot hold of the sum.
          const double slack = double{scale} * 2.4e-7 + step * 1e-3;
          ASSERT_LE(std::fabs(double{decoded(q.attribute, i)} - double{values[i]}),
                    step / 2 + slack)
              << "bits " << int{bits};
        }
      }
    }
  }
}

TEST(Quantize, OneValueIsKept) {
  const std::vector<float> values = {2.5f, -7, 1e-30f, 2.5f, -7, 1e-30f};
  const Quantized q = quantized(values, 3, 10);
  EXPECT_EQ(q.attribute.info.coding, AttributeCoding::kLattice);
  for (size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(decoded(q.attribute, i), values[i]);
  }
}

TEST(Quantize, MinusZeroOnTheLatticeIsZero) {
  const std::vector<float> values = {-0.0f, 0.0f, -0.0f, 0.0f, -0.0f, 8.0f};
  const Quantized q = quantized(values, 3, 3);
  ASSERT_EQ(q.attribute.info.coding, AttributeCoding::kLattice);
  for (const float origin : q.attribute.info.lattice.origin) EXPECT_FALSE(std::signbit(origin));
  EXPECT_EQ(decoded(q.attribute, 0), 0.0f);
  expectExact(quantized(values, 3, 0), values);  // exact keeps it
}

TEST(Quantize, WhatNoLatticeHoldsGoesExact) {
  for (const float bad : {kNan, -kNan, kInfinity, -kInfinity}) {
    std::vector<float> values = {1, 2, 3, 4, bad, 6};
    const Quantized q = quantized(values, 3, 12);
    expectExact(q, values);
    EXPECT_EQ(q.notes.size(), 1u);
  }
  // The extent of this one is beyond float32.
  const float max = std::numeric_limits<float>::max();
  const std::vector<float> wide = {max, 0, 0, -max, 0, 0};
  const Quantized q = quantized(wide, 3, 1);
  if (q.attribute.info.coding == AttributeCoding::kLattice) {
    EXPECT_TRUE(std::isfinite(q.attribute.info.lattice.step));
  } else {
    expectExact(q, wide);
    EXPECT_EQ(q.notes.size(), 1u);
  }
  // Denormals: the step would round to zero.
  const float tiny = std::numeric_limits<float>::denorm_min();
  const std::vector<float> narrow = {0, 0, 0, tiny, 0, 0};
  const Quantized n = quantized(narrow, 3, 20);
  for (size_t i = 0; i < narrow.size(); ++i) EXPECT_EQ(decoded(n.attribute, i), narrow[i]);
}

TEST(Quantize, ExactKeepsEveryBit) {
  std::vector<float> values = {0.0f,
                               -0.0f,
                               kNan,
                               -kNan,
                               kInfinity,
                               -kInfinity,
                               std::numeric_limits<float>::denorm_min(),
                               std::bit_cast<float>(0x7fc12345u),
                               std::bit_cast<float>(0xff812345u)};
  Random random(2);
  while (values.size() < 3000)
    values.push_back(std::bit_cast<float>(static_cast<uint32_t>(random.next())));
  expectExact(quantized(values, 3, 0), values);
}

TEST(Quantize, GivenLattice) {
  Lattice lattice;
  lattice.step = 0.25f;
  lattice.origin[0] = -1;
  lattice.origin[1] = 10;
  const std::vector<float> values = {-1, 10, 0, -0.9f, 10.4f, 100, -50, 9, -0.13f};
  const Quantized q = quantized(values, 3, 8, Semantic::kPosition, &lattice);
  ASSERT_EQ(q.attribute.info.coding, AttributeCoding::kLattice);
  EXPECT_TRUE(q.attribute.info.lattice == lattice);
  EXPECT_EQ(q.attribute.values, (std::vector<int32_t>{0, 0, 0, 0, 2, 400, -196, -4, -1}));
  // Values that are out of reach are better exact than wrong.
  const std::vector<float> far = {0, 0, 0, 1e9f, 0, 0};
  const Quantized exact = quantized(far, 3, 8, Semantic::kPosition, &lattice);
  expectExact(exact, far);
  EXPECT_EQ(exact.notes.size(), 1u);
  for (const float step : {0.0f, -1.0f, kNan, kInfinity}) {
    lattice.step = step;
    expectExact(quantized(values, 3, 8, Semantic::kPosition, &lattice), values);
  }
}

TEST(Quantize, IntegersOfAllTypes) {
  const std::vector<std::pair<ComponentType, std::vector<int64_t>>> cases = {
      {ComponentType::kInt8, {-128, -1, 0, 127}},
      {ComponentType::kUint8, {0, 1, 128, 255}},
      {ComponentType::kInt16, {-32768, -1, 0, 32767}},
      {ComponentType::kUint16, {0, 1, 32768, 65535}},
      {ComponentType::kUint32, {0, 1, 0x80000000ll, 0xffffffffll}},
  };
  for (const auto& [type, values] : cases) {
    const uint32_t bytes = componentBytes(type);
    constexpr size_t kStride = 11;  // elements need not be aligned
    std::vector<uint8_t> memory(kStride * values.size(), 0xee);
    for (size_t i = 0; i < values.size(); ++i) std::memcpy(&memory[kStride * i], &values[i], bytes);
    AttributeView view;
    view.format.semantic = Semantic::kCustom;
    view.format.component_type = type;
    view.format.component_count = 1;
    view.data = memory.data();
    view.stride_bytes = kStride;
    view.quantization_bits = 8;  // ignored
    std::vector<std::string> notes;
    const QuantizedAttribute a = quantizedAlone(view, static_cast<uint32_t>(values.size()), notes);
    EXPECT_EQ(a.info.coding, AttributeCoding::kInteger);
    ASSERT_EQ(a.values.size(), values.size());
    for (size_t i = 0; i < values.size(); ++i) {
      uint8_t stored[8] = {0xcc, 0xcc, 0xcc, 0xcc, 0xcc, 0xcc, 0xcc, 0xcc};
      storeInteger(stored, type, a.values[i]);
      EXPECT_EQ(std::memcmp(stored, &values[i], bytes), 0);
      EXPECT_EQ(stored[bytes], 0xcc);
      EXPECT_TRUE(type == ComponentType::kUint32 || a.values[i] == values[i]);
    }
  }
}

TEST(OrderedFloats, AreABijectionInOrder) {
  const float ordered[] = {-kInfinity, -1e30f, -1, -1e-40f, -0.0f,
                           0.0f,       1e-40f, 1,  1e30f,   kInfinity};
  for (size_t i = 1; i < std::size(ordered); ++i) {
    EXPECT_LT(orderedFromBits(std::bit_cast<uint32_t>(ordered[i - 1])),
              orderedFromBits(std::bit_cast<uint32_t>(ordered[i])));
  }
  EXPECT_EQ(orderedFromBits(0x80000000u) + 1, orderedFromBits(0));
  Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const uint32_t bits = static_cast<uint32_t>(random.next());
    EXPECT_EQ(bitsFromOrdered(orderedFromBits(bits)), bits);
    EXPECT_EQ(orderedFromBits(bitsFromOrdered(static_cast<int32_t>(bits))),
              static_cast<int32_t>(bits));
  }
}

// ---- Octahedral grid ----------------------------------------------------------------------------

double angleBetween(const float* a, const float* b) {
  double dot = 0;
  double cross[3];
  for (int i = 0; i < 3; ++i) {
    dot += double{a[i]} * b[i];
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    cross[i] = double{a[j]} * b[k] - double{a[k]} * b[j];
  }
  return std::atan2(std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]),
                    dot);
}

std::vector<float> randomNormals(uint32_t count, Random& random) {
  std::vector<float> normals = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1};
  while (normals.size() < 3 * size_t{count}) {
    double n[3];
    double square = 0;
    for (double& x : n) {
      x = double{random.unit()} * 2 - 1;
      square += x * x;
    }
    if (square > 1 || square < 0.01) continue;
    for (const double x : n) normals.push_back(static_cast<float>(x / std::sqrt(square)));
  }
  return normals;
}

TEST(Octahedral, AngleIsBounded) {
  Random random(4);
  const std::vector<float> normals = randomNormals(3000, random);
  double before = 10;
  for (uint8_t bits = 2; bits <= 16; ++bits) {
    const Quantized q = quantized(normals, 3, bits, Semantic::kNormal);
    ASSERT_EQ(q.attribute.info.coding, AttributeCoding::kOctahedral);
    ASSERT_EQ(q.attribute.components, 2u);
    EXPECT_EQ(q.attribute.info.bits, bits);
    const int32_t centre = octahedralCentre(bits);
    double worst = 0;
    for (size_t i = 0; i < normals.size() / 3; ++i) {
      const int32_t s = q.attribute.values[2 * i];
      const int32_t t = q.attribute.values[2 * i + 1];
      ASSERT_TRUE(s >= 0 && t >= 0 && s <= 2 * centre && t <= 2 * centre);
      float unit[3];
      octahedralToUnit(s, t, centre, unit);
      worst = std::max(worst, angleBetween(unit, &normals[3 * i]));
    }
    // Half the diagonal of a cell, stretched by 3 at most where the octahedron is nearest to the
    // centre; and what float32 cannot hold.
    EXPECT_LE(worst, 3 * std::sqrt(0.5) / centre + 2e-7) << int{bits};
    EXPECT_LT(worst, before);
    before = worst;
  }
}

TEST(Octahedral, AxesAreExact) {
  const std::vector<float> axes = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1};
  for (uint8_t bits = 2; bits <= 16; ++bits) {
    const Quantized q = quantized(axes, 3, bits, Semantic::kNormal);
    for (size_t i = 0; i < 6; ++i) {
      float unit[3];
      octahedralToUnit(q.attribute.values[2 * i], q.attribute.values[2 * i + 1],
                       octahedralCentre(bits), unit);
      for (size_t k = 0; k < 3; ++k) EXPECT_EQ(unit[k], axes[3 * i + k]);
    }
  }
}

TEST(Octahedral, EveryGridPointIsAUnitVector) {
  for (const uint32_t bits : {2u, 3u, 5u, 8u, 10u}) {
    const int32_t centre = octahedralCentre(bits);
    for (int32_t s = 0; s <= 2 * centre; ++s) {
      for (int32_t t = 0; t <= 2 * centre; ++t) {
        float n[3];
        octahedralToUnit(s, t, centre, n);
        const double length =
            std::sqrt(double{n[0]} * n[0] + double{n[1]} * n[1] + double{n[2]} * n[2]);
        ASSERT_NEAR(length, 1, 1e-6) << s << ", " << t;
      }
    }
  }
}

TEST(Octahedral, AnyIntegersGiveAFiniteVector) {
  constexpr int32_t kMin = std::numeric_limits<int32_t>::min();
  constexpr int32_t kMax = std::numeric_limits<int32_t>::max();
  Random random(5);
  std::vector<int32_t> values = {kMin, kMin + 1, -1, 0, 1, kMax - 1, kMax};
  for (int i = 0; i < 100; ++i) values.push_back(static_cast<int32_t>(random.next() >> 32));
  for (const uint32_t bits : {2u, 10u, 16u}) {
    for (const int32_t s : values) {
      for (const int32_t t : values) {
        float n[3];
        octahedralToUnit(s, t, octahedralCentre(bits), n);
        ASSERT_TRUE(std::isfinite(n[0]) && std::isfinite(n[1]) && std::isfinite(n[2]))
            << s << ", " << t;
      }
    }
  }
}

TEST(Octahedral, OnlyForUnitVectors) {
  const std::vector<float> values = {0, 0, 1, 0, 2, 0, 1, 0, 0};
  const Quantized q = quantized(values, 3, 10, Semantic::kNormal);
  EXPECT_NE(q.attribute.info.coding, AttributeCoding::kOctahedral);
  EXPECT_EQ(q.notes.size(), 1u);
  const std::vector<float> with_zero = {0, 0, 1, 0, 0, 0};
  EXPECT_NE(quantized(with_zero, 3, 10, Semantic::kNormal).attribute.info.coding,
            AttributeCoding::kOctahedral);
}

// ---- Tangents -----------------------------------------------------------------------------------

/// Unit vectors perpendicular to normals, in any direction, with a sign of 1 or -1.
std::vector<float> randomTangents(const std::vector<float>& normals, Random& random) {
  std::vector<float> tangents;
  for (size_t i = 0; i < normals.size(); i += 3) {
    float e[2][3];
    tangentFrame(&normals[i], e[0], e[1]);
    const float angle = random.unit() * 6.2831853f;
    for (int s = 0; s < 3; ++s)
      tangents.push_back(std::cos(angle) * e[0][s] + std::sin(angle) * e[1][s]);
    tangents.push_back(random.unit() < 0.5f ? 1.0f : -1.0f);
  }
  return tangents;
}

TEST(Tangents, TheAngleIsTheNearestOfAll) {
  Random random(6);
  const std::vector<float> normals = randomNormals(200, random);
  const std::vector<float> tangents = randomTangents(normals, random);
  const auto count = static_cast<uint32_t>(normals.size() / 3);
  for (const uint32_t bits : {2u, 3u, 7u, 10u}) {
    std::vector<AttributeView> attributes(3);
    const Semantic semantics[] = {Semantic::kPosition, Semantic::kNormal, Semantic::kTangent};
    for (size_t i = 0; i < 3; ++i) {
      attributes[i].format.semantic = semantics[i];
      attributes[i].format.component_count = i == 2 ? 4 : 3;
      attributes[i].data = i == 2 ? tangents.data() : normals.data();
      attributes[i].stride_bytes = size_t{4} * attributes[i].format.component_count;
      attributes[i].quantization_bits = static_cast<uint8_t>(i == 2 ? bits : 16);
    }
    std::vector<std::string> notes;
    const std::vector<QuantizedAttribute> all =
        quantizeAttributes({count, attributes, {}}, {}, notes);
    ASSERT_EQ(all[2].info.coding, AttributeCoding::kTangentAngle);
    for (uint32_t w = 0; w < count; ++w) {
      float normal[3];
      octahedralToUnit(all[1].values[2 * size_t{w}], all[1].values[2 * size_t{w} + 1],
                       octahedralCentre(16), normal);
      const auto error = [&](int32_t angle) {
        float unit[3];
        tangentFromAngle(normal, angle, bits, unit);
        return angleBetween(unit, &tangents[4 * size_t{w}]);
      };
      double least = 10;
      for (int32_t angle = 0; angle < 1 << bits; ++angle) least = std::min(least, error(angle));
      const int32_t chosen = all[2].values[2 * size_t{w}];
      ASSERT_TRUE(0 <= chosen && chosen < 1 << bits) << chosen;
      EXPECT_LE(error(chosen), least + 1e-6);
      EXPECT_EQ(all[2].values[2 * size_t{w} + 1], tangents[4 * size_t{w} + 3] < 0 ? 1 : 0);
    }
  }
}

}  // namespace
}  // namespace mcc::test
