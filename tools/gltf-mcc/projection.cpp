// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mcc/types.h"

namespace mcc::tool {
namespace {

struct Vector {
  double x = 0;
  double y = 0;
  double z = 0;
};

double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vector unit(const Vector& v) {
  const double length = std::sqrt(dot(v, v));
  return length > 0 ? Vector{v.x / length, v.y / length, v.z / length} : Vector{0, 0, 1};
}

constexpr float kNothing = -std::numeric_limits<float>::infinity();

}  // namespace

Page projectMesh(std::span<const float> positions, std::span<const uint32_t> indices,
                 const double* view, double width, double margin) {
  const Vector eye = unit({view[0], view[1], view[2]});
  // When looking straight up or down, north is at the top of the page.
  const Vector up = std::abs(eye.y) < 0.9999 ? Vector{0, 1, 0} : Vector{0, 0, eye.y > 0 ? -1. : 1.};
  const Vector right = unit(cross(up, eye));
  const Vector down = cross(right, eye);
  Page page;
  page.points.resize(positions.size() / 3);
  for (size_t i = 0; i < page.points.size(); ++i) {
    const Vector p = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    PagePoint& point = page.points[i];
    point = {dot(p, right), dot(p, down), dot(p, eye), true};
    point.is_finite = std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double low[2] = {kInfinity, kInfinity};
  double high[2] = {-kInfinity, -kInfinity};
  for (const uint32_t i : indices) {
    const PagePoint& point = page.points[i];
    if (!point.is_finite) continue;
    low[0] = std::min(low[0], point.x);
    low[1] = std::min(low[1], point.y);
    high[0] = std::max(high[0], point.x);
    high[1] = std::max(high[1], point.y);
  }
  if (!(low[0] <= high[0])) low[0] = low[1] = high[0] = high[1] = 0;
  const double longest = std::max(high[0] - low[0], high[1] - low[1]);
  const double scale = longest > 0 ? (width - 2 * margin) / longest : 1;
  for (PagePoint& point : page.points) {
    point.x = (point.x - low[0]) * scale + margin;
    point.y = (point.y - low[1]) * scale + margin;
    point.z *= scale;
  }
  page.width = (high[0] - low[0]) * scale + 2 * margin;
  page.height = (high[1] - low[1]) * scale + 2 * margin;
  return page;
}

Lighting lightingOf(const PagePoint& a, const PagePoint& b, const PagePoint& c) {
  const Vector light = unit({-0.45, -0.65, 1});  // from the upper left; y points down
  // Because y points down, the cross product of a triangle's front points away from the eye.
  Vector normal = unit(cross({b.x - a.x, b.y - a.y, b.z - a.z}, {c.x - a.x, c.y - a.y, c.z - a.z}));
  const bool is_front = normal.z <= 0;
  if (is_front) normal = {-normal.x, -normal.y, -normal.z};
  return {std::max(0.0, dot(normal, light)), is_front};
}

DepthBuffer::DepthBuffer(const Page& page, std::span<const uint32_t> indices)
    : columns_(static_cast<int64_t>(page.width * kScale) + 2),
      rows_(static_cast<int64_t>(page.height * kScale) + 2),
      tolerance_(1e-3 * std::max(page.width, page.height)),
      depth_(static_cast<size_t>(columns_ * rows_), kNothing),
      triangle_(depth_.size(), kNone),
      is_seen_(indices.size() / 3, false) {
  for (uint32_t t = 0; t < is_seen_.size(); ++t) draw(page, &indices[size_t{3} * t], t);
  for (const uint32_t t : triangle_) {
    if (t != kNone) is_seen_[t] = true;
  }
}

void DepthBuffer::draw(const Page& page, const uint32_t* corners, uint32_t triangle) {
  const PagePoint* p[3] = {&page.points[corners[0]], &page.points[corners[1]],
                           &page.points[corners[2]]};
  for (const PagePoint* point : p) {
    if (!point->is_finite) return;
  }
  const double area =
      (p[1]->x - p[0]->x) * (p[2]->y - p[0]->y) - (p[1]->y - p[0]->y) * (p[2]->x - p[0]->x);
  if (area == 0) return;
  const auto [left, last] = std::minmax({p[0]->x, p[1]->x, p[2]->x});
  const auto [top, bottom] = std::minmax({p[0]->y, p[1]->y, p[2]->y});
  const int64_t last_column = std::min(columns_ - 1, static_cast<int64_t>(last * kScale) + 1);
  const int64_t last_row = std::min(rows_ - 1, static_cast<int64_t>(bottom * kScale) + 1);
  for (int64_t row = static_cast<int64_t>(top * kScale); row <= last_row; ++row) {
    for (int64_t column = static_cast<int64_t>(left * kScale); column <= last_column; ++column) {
      const double x = static_cast<double>(column) / kScale;
      const double y = static_cast<double>(row) / kScale;
      double share[3];
      for (int k = 0; k < 3; ++k) {  // barycentric coordinates
        const PagePoint& a = *p[(k + 1) % 3];
        const PagePoint& b = *p[(k + 2) % 3];
        share[k] = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
      }
      if (std::min({share[0], share[1], share[2]}) < 0) continue;
      const double z = share[0] * p[0]->z + share[1] * p[1]->z + share[2] * p[2]->z;
      const size_t place = static_cast<size_t>(row * columns_ + column);
      if (static_cast<float>(z) <= depth_[place]) continue;
      depth_[place] = static_cast<float>(z);
      triangle_[place] = triangle;
    }
  }
}

float DepthBuffer::at(int64_t column, int64_t row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return kNothing;
  return depth_[static_cast<size_t>(row * columns_ + column)];
}

/// Compares with the farthest of the places around, since the surface may be steep there.
bool DepthBuffer::sees(double x, double y, double z) const {
  const auto column = static_cast<int64_t>(x * kScale);
  const auto row = static_cast<int64_t>(y * kScale);
  float farthest = std::numeric_limits<float>::infinity();
  for (int64_t r = row - 1; r <= row + 2; ++r) {
    for (int64_t c = column - 1; c <= column + 2; ++c) {
      const float depth = at(c, r);
      if (depth != kNothing) farthest = std::min(farthest, depth);
    }
  }
  return farthest == std::numeric_limits<float>::infinity() || z >= double{farthest} - tolerance_;
}

}  // namespace mcc::tool
