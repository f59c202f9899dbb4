// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tree_faces.h"

#include <algorithm>
#include <map>

namespace mcc::tool {
namespace {

constexpr size_t kWindow = 400;  // faces that are compared with one
constexpr double kTouch = 0.01;  // square pixels: less is a common side, with its rounding

/// Returns whether a side of `a` has `a` on one side and `b` on the other.
bool hasSideBetween(const FlatFace& a, const FlatFace& b) {
  const auto area = [&](size_t k, double x, double y) {
    const size_t next = (k + 1) % 3;
    return (a.x[next] - a.x[k]) * (y - a.y[k]) - (a.y[next] - a.y[k]) * (x - a.x[k]);
  };
  const double sign = area(0, a.x[2], a.y[2]) < 0 ? -1 : 1;
  for (size_t k = 0; k < 3; ++k) {
    bool is_outside = true;
    for (size_t i = 0; i < 3; ++i) {
      is_outside = is_outside && sign * area(k, b.x[i], b.y[i]) <= kTouch;
    }
    if (is_outside) return true;
  }
  return false;
}

bool overlap(const FlatFace& a, const FlatFace& b) {
  const auto areApart = [](const std::array<double, 3>& p, const std::array<double, 3>& q) {
    return *std::max_element(p.begin(), p.end()) <= *std::min_element(q.begin(), q.end());
  };
  if (areApart(a.x, b.x) || areApart(b.x, a.x) || areApart(a.y, b.y) || areApart(b.y, a.y)) {
    return false;
  }
  return !hasSideBetween(a, b) && !hasSideBetween(b, a);
}

}  // namespace

std::vector<FaceGroup> groupsOf(const std::vector<FlatFace>& faces) {
  std::vector<FaceGroup> groups;
  std::vector<size_t> group_of;                 // of each face before
  std::map<std::string, size_t> last_of_color;  // the last group of a colour
  size_t first = 0;                             // the first group behind which there is no face
                                                // that is too far back to be compared
  for (uint32_t f = 0; f < faces.size(); ++f) {
    if (f >= kWindow) first = std::max(first, group_of[f - kWindow]);
    size_t lowest = first;
    for (size_t other = f > kWindow ? f - kWindow : 0; other < f; ++other) {
      if (group_of[other] > lowest && overlap(faces[f], faces[other])) lowest = group_of[other];
    }
    const auto [last, is_new] = last_of_color.try_emplace(faces[f].color, groups.size());
    if (is_new || last->second < lowest) {
      last->second = groups.size();
      groups.push_back({faces[f].color, {}});
    }
    groups[last->second].faces.push_back(f);
    group_of.push_back(last->second);
  }
  return groups;
}

}  // namespace mcc::tool
