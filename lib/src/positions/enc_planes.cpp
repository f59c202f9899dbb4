// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "positions/enc_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace mcc {
namespace {

constexpr int32_t kLatticeEnd = 1 << 17;
constexpr size_t kFewestPeaks = 8;
constexpr size_t kFewestAtPeak = 2;  ///< vertices
constexpr double kSmallestStep = static_cast<double>(AxisPlanes::kMinStep) / AxisPlanes::kOne;

/// A candidate for the planes of an axis: x = origin + k * step, in lattice steps.
struct Line {
  double origin;
  double step;

  double number(int32_t x) const { return std::floor((x - origin) / step + 0.5); }
  double error(int32_t x) const { return x - (origin + number(x) * step); }
};

/// A coordinate and the number of vertices that have it.
struct Occupied {
  int32_t at;
  size_t count;
};

/// Counts the vertices at each coordinate that occurs, in ascending order.
std::vector<Occupied> countCoordinates(std::span<const int32_t> truth, uint32_t axis) {
  std::vector<int32_t> sorted;
  sorted.reserve(truth.size() / 3);
  for (size_t i = axis; i < truth.size(); i += 3) sorted.push_back(truth[i]);
  std::vector<Occupied> occupied;
  if (sorted.size() < kLatticeEnd / 16) {
    std::sort(sorted.begin(), sorted.end());
    for (const int32_t x : sorted) {
      if (occupied.empty() || occupied.back().at != x) occupied.push_back({x, 0});
      ++occupied.back().count;
    }
    return occupied;
  }
  std::vector<uint32_t> counts(kLatticeEnd, 0);
  for (const int32_t x : sorted) ++counts[static_cast<size_t>(x)];
  for (int32_t x = 0; x < kLatticeEnd; ++x) {
    const uint32_t count = counts[static_cast<size_t>(x)];
    if (count != 0) occupied.push_back({x, count});
  }
  return occupied;
}

/// Returns the coordinates that far more vertices have than an even distribution would give them.
std::vector<int32_t> findPeaks(std::span<const int32_t> truth, uint32_t axis) {
  const std::vector<Occupied> occupied = countCoordinates(truth, axis);
  const size_t limit = 4 * (truth.size() / 3) / (occupied.size() + 1) + kFewestAtPeak;
  std::vector<int32_t> peaks;
  for (const Occupied& here : occupied) {
    if (here.count >= limit) peaks.push_back(here.at);
  }
  return peaks;
}

/// Fits a line by least squares to the peaks, from the nearest to the farthest: a peak farther away
/// can only be numbered once the step is known more exactly.
std::optional<Line> fitLine(const std::vector<int32_t>& peaks) {
  std::vector<int32_t> gaps;
  for (size_t i = 1; i < peaks.size(); ++i) gaps.push_back(peaks[i] - peaks[i - 1]);
  const auto median = gaps.begin() + static_cast<ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), median, gaps.end());
  const double middle = peaks[peaks.size() / 2];
  Line line{middle, static_cast<double>(*median)};
  for (double reach = 4 * line.step; reach < 2 * kLatticeEnd; reach *= 2) {
    if (line.step < kSmallestStep) return std::nullopt;
    double n = 0;
    double sum_k = 0;
    double sum_x = 0;
    double sum_kk = 0;
    double sum_kx = 0;
    for (const int32_t x : peaks) {
      if (std::fabs(x - middle) > reach || std::fabs(line.error(x)) > 0.2 * line.step) continue;
      const double k = line.number(x);
      n += 1;
      sum_k += k;
      sum_x += x;
      sum_kk += k * k;
      sum_kx += k * x;
    }
    const double determinant = n * sum_kk - sum_k * sum_k;
    if (determinant <= 0) return std::nullopt;
    line.step = (n * sum_kx - sum_k * sum_x) / determinant;
    line.origin = (sum_x - line.step * sum_k) / n;
  }
  return line.step < kSmallestStep ? std::nullopt : std::optional(line);
}

/// Moves the line as little as possible, until it rounds to every peak near it.
void roundToPeaks(const std::vector<int32_t>& peaks, Line& line) {
  constexpr uint32_t kRounds = 400;
  constexpr double kLever = 0.01;  // changes origin and step by about the same part of their range
  for (uint32_t round = 0; round < kRounds; ++round) {
    bool moved = false;
    for (const int32_t x : peaks) {
      const double error = line.error(x);
      if (std::fabs(error) > 1.5 || std::fabs(error) < 0.4999) continue;
      const double excess = error > 0 ? error - 0.499 : error + 0.499;
      const double lever = line.number(x) * kLever;
      const double part = excess / (1 + lever * lever);
      line.origin += part;
      line.step += part * lever * kLever;
      moved = true;
    }
    if (!moved || line.step < kSmallestStep) return;
  }
}

bool toPlanes(const Line& line, AxisPlanes& planes) {
  if (!(line.step >= kSmallestStep && line.step < kLatticeEnd)) return false;
  constexpr double kOne = static_cast<double>(AxisPlanes::kOne);
  planes.step = static_cast<int64_t>(line.step * kOne);
  planes.origin = static_cast<int64_t>(line.origin * kOne) % planes.step;
  if (planes.origin < 0) planes.origin += planes.step;
  return planes.step >= AxisPlanes::kMinStep;
}

/// Returns whether at least one coordinate in eight lies on a plane. On the output of marching
/// cubes it is two in three.
bool holdsMany(std::span<const int32_t> truth, uint32_t axis, const AxisPlanes& planes) {
  size_t hits = 0;
  for (size_t i = axis; i < truth.size(); i += 3) {
    hits += planes.at(planes.below(truth[i])) == truth[i] ? 1 : 0;
  }
  return 8 * hits >= truth.size() / 3;
}

}  // namespace

bool findPlanes(std::span<const int32_t> truth, AxisPlanes* planes) {
  if (truth.size() / 3 < kFewestPeaks * kFewestAtPeak) return false;
  const auto is_outside = [](int32_t q) { return q < 0 || q >= kLatticeEnd; };
  if (std::any_of(truth.begin(), truth.end(), is_outside)) return false;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const std::vector<int32_t> peaks = findPeaks(truth, axis);
    if (peaks.size() < kFewestPeaks) return false;
    std::optional<Line> line = fitLine(peaks);
    if (!line.has_value()) return false;
    roundToPeaks(peaks, *line);
    if (!toPlanes(*line, planes[axis]) || !holdsMany(truth, axis, planes[axis])) return false;
  }
  return true;
}

}  // namespace mcc
