// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What all comparisons of tests need: triangles regardless of their order and rotation.
#ifndef MCC_TESTS_SUPPORT_TRIANGLES_H_
#define MCC_TESTS_SUPPORT_TRIANGLES_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace mcc::test {

template <typename Corner>
using TriangleOf = std::array<Corner, 3>;

/// The triangle, beginning with the corner for which it comes first in order.
template <typename Corner>
TriangleOf<Corner> rotated(const TriangleOf<Corner>& t) {
  return std::min({t, TriangleOf<Corner>{t[1], t[2], t[0]}, TriangleOf<Corner>{t[2], t[0], t[1]}});
}

/// The triangles of a list of indices, each index replaced by `corner_of(index)`.
template <typename Index, typename CornerOf>
auto trianglesOf(const Index& indices, const CornerOf& corner_of) {
  using Corner = std::decay_t<decltype(corner_of(indices[0]))>;
  std::vector<TriangleOf<Corner>> triangles(indices.size() / 3);
  for (size_t i = 0; i < 3 * triangles.size(); ++i) triangles[i / 3][i % 3] = corner_of(indices[i]);
  return triangles;
}

template <typename Corner>
std::vector<TriangleOf<Corner>> sorted(std::vector<TriangleOf<Corner>> triangles) {
  for (TriangleOf<Corner>& t : triangles) t = rotated(t);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// In radians; exact enough for small angles.
inline double angleBetween(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  double dot = 0;
  double square = 0;
  for (size_t c = 0; c < 3; ++c) {
    const double part = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
    dot += a[c] * b[c];
    square += part * part;
  }
  return std::atan2(std::sqrt(square), dot);
}

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_TRIANGLES_H_
