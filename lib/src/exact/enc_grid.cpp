// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "exact/enc_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "exact/grid.h"
#include "mesh/dequantize.h"

namespace mcc {
namespace {

constexpr uint32_t kMinusZero = 0x80000000u;

uint32_t exponentField(uint32_t bits) { return (bits >> 23) & 255; }

/// Exponent of the lowest bit a float other than 0 can have.
int32_t lastPlace(uint32_t bits) {
  return static_cast<int32_t>(std::max(exponentField(bits), 1u)) - 150;
}

/// Exponent of the lowest bit it does have.
int32_t lowestBit(uint32_t bits) {
  const uint32_t mantissa = (bits & 0x7fffff) | (exponentField(bits) != 0 ? 0x800000u : 0u);
  return lastPlace(bits) + std::countr_zero(mantissa);
}

struct BitExtent {
  bool finite = true;
  bool minus_zero = false;
  uint32_t largest = 0;  ///< magnitude, as bits
  int32_t lowest_bit = 128;
  double mean_last_place = 0;  ///< of values other than 0
};

BitExtent measure(std::span<const int32_t> ordered) {
  BitExtent e;
  size_t count = 0;
  double places = 0;
  for (const int32_t o : ordered) {
    const uint32_t bits = bitsFromOrdered(o);
    const uint32_t magnitude = bits & 0x7fffffff;
    e.finite = e.finite && exponentField(bits) != 255;
    e.minus_zero = e.minus_zero || bits == kMinusZero;
    e.largest = std::max(e.largest, magnitude);
    if (magnitude == 0) continue;
    e.lowest_bit = std::min(e.lowest_bit, lowestBit(magnitude));
    places += lastPlace(magnitude);
    ++count;
  }
  e.mean_last_place = count == 0 ? 0 : places / static_cast<double>(count);
  return e;
}

bool isOn(const ExactGrid& grid, std::span<const int32_t> ordered, float largest) {
  if (std::fabs(double{largest}) * grid.scale() >= double{1u << kGridBits}) return false;
  return std::all_of(ordered.begin(), ordered.end(), [&](int32_t o) {
    const float value = std::bit_cast<float>(bitsFromOrdered(o));
    return orderedFromBits(std::bit_cast<uint32_t>(grid.valueOf(grid.nearest(value)))) == o;
  });
}

void setGrid(uint32_t grid, GridTails tails, float largest, AttributeInfo& info) {
  info.coding = AttributeCoding::kGrid;
  info.grid = static_cast<uint8_t>(grid);
  info.tails = static_cast<uint8_t>(tails);
  const uint32_t reach = static_cast<uint32_t>(double{largest} * ExactGrid(grid).scale() + 0.5);
  info.bits = static_cast<uint8_t>(std::bit_width(reach) + 1);
}

/// Tails of repeated values are worth remembering.
GridTails tailsOf(std::span<const int32_t> ordered) {
  std::vector<int32_t> distinct(ordered.begin(), ordered.end());
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return 10 * distinct.size() < 7 * ordered.size() ? GridTails::kCached : GridTails::kPlain;
}

constexpr uint32_t binaryGrid(int32_t exponent) {
  return kGridBinary + static_cast<uint32_t>(exponent - kSmallestExponent);
}

}  // namespace

bool findExactGrid(std::span<const int32_t> ordered, AttributeInfo& info) {
  if (info.format.component_count > kGridComponents) return false;
  const BitExtent e = measure(ordered);
  if (!e.finite) return false;
  const float largest = std::bit_cast<float>(e.largest);
  if (e.largest == 0) {
    setGrid(0, GridTails::kNoTails, 0, info);
    if (e.minus_zero) setGrid(binaryGrid(0), GridTails::kPlain, 0, info);
    return true;
  }
  const int32_t top = lastPlace(e.largest);
  if (top - kSmallestExponent >= kGridExponents) return false;
  setGrid(binaryGrid(top), tailsOf(ordered), largest, info);
  double best = -e.mean_last_place;  // bits per unit: what every finite set of values can have
  if (e.minus_zero) return true;
  if (e.lowest_bit - kSmallestExponent < kGridExponents && -e.lowest_bit <= best &&
      isOn(ExactGrid(binaryGrid(e.lowest_bit)), ordered, largest)) {
    best = -e.lowest_bit;
    setGrid(e.lowest_bit == 0 ? 0 : binaryGrid(e.lowest_bit), GridTails::kNoTails, largest, info);
  }
  for (uint32_t grid = 0; grid < kGridBinary; ++grid) {
    const ExactGrid candidate(grid);
    if (std::log2(candidate.scale()) >= best || !isOn(candidate, ordered, largest)) continue;
    best = std::log2(candidate.scale());
    setGrid(grid, GridTails::kNoTails, largest, info);
  }
  return true;
}

}  // namespace mcc
