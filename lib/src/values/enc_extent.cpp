// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "values/enc_extent.h"

#include <algorithm>
#include <limits>

namespace mcc {

Extent::Extent(uint32_t components) : component_count(components) {
  std::fill_n(min, kLatticeComponents, std::numeric_limits<float>::infinity());
  std::fill_n(max, kLatticeComponents, -std::numeric_limits<float>::infinity());
}

void Extent::addValue(uint32_t c, float value, bool is_sample) {
  value += 0.0f;  // -0 counts as +0
  min[c] = std::min(min[c], value);
  max[c] = std::max(max[c], value);
  if (is_sample) samples[c].push_back(value);
}

double Extent::size() const {
  double largest = 0;
  for (uint32_t c = 0; c < component_count; ++c)
    largest = std::max(largest, double{max[c]} - double{min[c]});
  return largest;
}

double Extent::farthest() const {
  double largest = 0;
  for (uint32_t c = 0; c < component_count; ++c)
    largest = std::max({largest, std::abs(double{min[c]}), std::abs(double{max[c]})});
  return largest;
}

void Extent::innerEnds(uint32_t c, double& low, double& high) {
  constexpr size_t kFewestSamples = 16;
  std::vector<float>& values = samples[c];
  low = min[c];
  high = max[c];
  if (values.size() < kFewestSamples) return;
  const auto trimmed = static_cast<ptrdiff_t>(std::max<size_t>(values.size() / 100, 1));
  std::nth_element(values.begin(), values.begin() + trimmed, values.end());
  low = values[static_cast<size_t>(trimmed)];
  std::nth_element(values.begin(), values.end() - 1 - trimmed, values.end());
  high = *(values.end() - 1 - trimmed);
}

double Extent::innerSize() {
  double largest = 0;
  for (uint32_t c = 0; c < component_count; ++c) {
    double low = 0;
    double high = 0;
    innerEnds(c, low, high);
    largest = std::max(largest, high - low);
  }
  return largest;
}

double Extent::innerFarthest() {
  double largest = 0;
  for (uint32_t c = 0; c < component_count; ++c) {
    double low = 0;
    double high = 0;
    innerEnds(c, low, high);
    largest = std::max({largest, std::abs(low), std::abs(high)});
  }
  return largest;
}

bool Extent::isInside(float low, float high) const {
  for (uint32_t c = 0; c < component_count; ++c) {
    if (min[c] < low || max[c] > high) return false;
  }
  return true;
}

bool fitLattice(const Extent& extent, uint8_t bits, Lattice& lattice) {
  const double last_point = static_cast<double>((uint64_t{1} << bits) - 1);
  lattice = {};
  const double size = extent.size();
  constexpr float kAnyStep = 0x1p-24f;  // any step will do, since all values are the origin
  lattice.step = size == 0 ? kAnyStep : static_cast<float>(size / last_point);
  if (!std::isnormal(lattice.step)) return false;
  for (uint32_t c = 0; c < extent.component_count; ++c) {
    lattice.origin[c] = extent.min[c];
    while (latticePoint(extent.max[c], lattice.origin[c], lattice.step) > last_point) {
      lattice.step = std::nextafter(lattice.step, std::numeric_limits<float>::infinity());
      if (!std::isfinite(lattice.step)) return false;
    }
  }
  return true;
}

bool isRuinedByOutliers(Extent& extent, uint8_t bits) {
  const double size = extent.size();
  return size > 0 && extent.innerSize() * std::exp2((bits + 1) / 2) < size;
}

Lattice unitLattice(uint8_t bits) {
  Lattice lattice;
  lattice.step = static_cast<float>(1.0 / static_cast<double>((uint64_t{1} << bits) - 1));
  return lattice;
}

void roundTogether(std::vector<double>& points, double total) {
  double sum = 0;
  double floor_sum = 0;
  for (const double point : points) {
    sum += point;
    floor_sum += std::floor(point);
  }
  if (std::abs(sum - total) > 0.25) {
    for (double& point : points) point = std::floor(point + 0.5);
    return;
  }
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i) {
    if (points[i] > std::floor(points[i])) order.push_back(i);
  }
  const auto loss = [&](size_t i) { return points[i] - std::floor(points[i]); };
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return loss(a) > loss(b); });
  const size_t missing = static_cast<size_t>(std::max(0.0, total - floor_sum));
  if (missing > order.size()) order.clear();  // cannot be: the sum is near
  for (size_t i = 0; i < std::min(missing, order.size()); ++i) points[order[i]] += 1;
  for (double& point : points) point = std::floor(point);
}

}  // namespace mcc
