// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The search for the grid of exact floats, and its arithmetic.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "exact/enc_grid.h"
#include "exact/grid.h"
#include "mesh/dequantize.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

int32_t ordered(float value) { return orderedFromBits(std::bit_cast<uint32_t>(value)); }

std::vector<int32_t> orderedOf(const std::vector<float>& values) {
  std::vector<int32_t> all;
  for (const float x : values) all.push_back(ordered(x));
  return all;
}

AttributeInfo found(const std::vector<float>& values, bool expected = true) {
  AttributeInfo info;
  EXPECT_EQ(findExactGrid(orderedOf(values), info), expected);
  return info;
}

/// Every value back from its integer and its tail.
void expectExact(const std::vector<float>& values, const AttributeInfo& info) {
  const ExactGrid grid(info.grid);
  for (const float x : values) {
    const int32_t q = gridInteger(info, ordered(x));
    const uint32_t reach = q < 0 ? 0u - static_cast<uint32_t>(q) : static_cast<uint32_t>(q);
    EXPECT_LT(std::bit_width(reach), int{info.bits} + 1) << x;
    if (static_cast<GridTails>(info.tails) == GridTails::kNoTails) {
      EXPECT_EQ(ordered(grid.valueOf(q)), ordered(x)) << x;
    } else if (q != 0) {
      EXPECT_EQ(ordered(grid.valueOf(q, grid.tailOf(x, q))), ordered(x)) << x;
    } else {
      EXPECT_LT(std::fabs(double{x}) * grid.scale(), 1) << x;
    }
  }
}

std::vector<float> decimals(uint32_t digits, uint32_t count, int32_t reach) {
  Random random(digits + 1);
  std::vector<float> values;
  for (uint32_t i = 0; i < count; ++i) {
    const int32_t q = static_cast<int32_t>(random.below(2 * static_cast<uint32_t>(reach))) - reach;
    values.push_back(static_cast<float>(q / std::pow(10.0, digits)));
  }
  return values;
}

TEST(ExactGrid, DecimalsAreFound) {
  for (uint32_t digits = 0; digits < 10; ++digits) {
    const std::vector<float> values = decimals(digits, 3000, 900000);
    const AttributeInfo info = found(values);
    EXPECT_EQ(info.coding, AttributeCoding::kGrid);
    EXPECT_EQ(info.grid, digits);
    EXPECT_EQ(info.tails, 0);
    expectExact(values, info);
  }
}

TEST(ExactGrid, BinaryFractionsAreFound) {
  for (const int32_t exponent : {-149, -140, -100, -20, -8, 0, 5, 60, 90}) {
    Random random(7);
    std::vector<float> values = {std::ldexp(1.0f, exponent)};
    for (uint32_t i = 0; i < 500; ++i) {
      values.push_back(std::ldexp(static_cast<float>(random.below(3000)) - 1500.0f, exponent));
    }
    for (float& x : values) x += 0.0f;  // no -0
    const AttributeInfo info = found(values);
    const bool integers = exponent == 0;
    EXPECT_EQ(info.grid, integers ? 0u : kGridBinary + static_cast<uint32_t>(exponent + 149))
        << exponent;
    EXPECT_EQ(info.tails, 0);
    expectExact(values, info);
  }
}

TEST(ExactGrid, WhateverIsFiniteHasTails) {
  Random random(3);
  for (const int32_t reach : {120, 40, 3}) {
    std::vector<float> values;
    for (uint32_t i = 0; i < 4000; ++i) {
      const int32_t exponent =
          static_cast<int32_t>(random.below(static_cast<uint32_t>(reach) + 30)) - 30 - reach;
      const float x = std::ldexp(random.unit() - 0.5f, exponent);
      values.push_back(i % 97 == 0 ? -0.0f : x);
    }
    const AttributeInfo info = found(values);
    EXPECT_NE(info.tails, 0);
    expectExact(values, info);
  }
  const std::vector<float> denormals = {std::bit_cast<float>(1u), std::bit_cast<float>(0x7fffffu),
                                        std::bit_cast<float>(0x800001u), 0, -0.0f};
  expectExact(denormals, found(denormals));
}

TEST(ExactGrid, AnOutlierDecides) {
  std::vector<float> values = decimals(3, 1000, 5000);
  EXPECT_EQ(found(values).grid, 3);
  values.push_back(1e9f);  // 10^12 steps
  const AttributeInfo info = found(values);
  EXPECT_NE(info.tails, 0);
  expectExact(values, info);
  values.back() = 0.1234567f;
  expectExact(values, found(values));
}

TEST(ExactGrid, NotEverythingHasAGrid) {
  const float infinity = std::numeric_limits<float>::infinity();
  found({1, 2, infinity}, false);
  found({1, 2, -infinity}, false);
  found({1, 2, std::numeric_limits<float>::quiet_NaN()}, false);
  found({1, 3e38f}, false);  // integers times their step would overflow
  EXPECT_EQ(found({0, 0}).tails, 0);
  EXPECT_NE(found({0, -0.0f}).tails, 0);
  EXPECT_EQ(found({}).bits, 1);
}

}  // namespace
}  // namespace mcc::test
