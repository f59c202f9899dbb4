// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "positions/enc_mirrors.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/enc_exceptions.h"
#include "positions/enc_point.h"

namespace mcc {
namespace {

using Points = std::unordered_set<Point, PointHash>;

/// Sums with more votes than others are tried.
constexpr size_t kTriedSums = 6;
/// On a line along the axis with more points than this, most pairs are no images of each other.
constexpr size_t kMostOnLine = 16;
/// A mirror must have images of this share of the positions, and of this many.
constexpr size_t kLeastShare = 10;
constexpr size_t kLeastImages = 6;

/// Sums as 64 bits, since those of a wide lattice may not fit in 32.
struct Sum {
  int64_t sum;
  size_t votes;
};

/// Returns the sums of pairs of coordinates that agree on the other axes, most frequent first.
std::vector<Sum> voteForSums(const std::vector<Point>& points, uint32_t axis) {
  std::unordered_map<Point, std::vector<int32_t>, PointHash> lines;
  for (Point p : points) {
    const int32_t x = p[axis];
    p[axis] = 0;
    lines[p].push_back(x);
  }
  std::unordered_map<int64_t, size_t> votes;
  for (const auto& [line, on] : lines) {
    for (size_t i = 0; i < on.size() && on.size() <= kMostOnLine; ++i) {
      for (size_t k = 0; k < i; ++k) ++votes[int64_t{on[i]} + on[k]];
    }
  }
  std::vector<Sum> sums;
  for (const auto& [sum, count] : votes) sums.push_back({sum, count});
  const auto before = [](const Sum& a, const Sum& b) {
    return a.votes != b.votes ? a.votes > b.votes : a.sum < b.sum;
  };
  const size_t kept = std::min(sums.size(), kTriedSums);
  std::partial_sort(sums.begin(), sums.begin() + static_cast<ptrdiff_t>(kept), sums.end(), before);
  sums.resize(kept);
  return sums;
}

/// Returns how many points have another one at most a step from their image.
size_t countImages(const std::vector<Point>& points, const Points& all, uint32_t axis,
                   int64_t sum) {
  size_t count = 0;
  for (const Point& p : points) {
    const int64_t image = sum - p[axis];
    if (std::abs(image - p[axis]) <= 2) continue;
    Point q = p;
    for (const int64_t off : {0, -1, 1}) {
      q[axis] = static_cast<int32_t>(image + off);
      if (q[axis] != image + off || !all.contains(q)) continue;
      ++count;
      break;
    }
  }
  return count;
}

}  // namespace

Mirrors findMirrors(std::span<const int32_t> positions, uint32_t sum_bits) {
  std::vector<Point> points(positions.size() / 3);
  for (size_t v = 0; v < points.size(); ++v) std::copy_n(&positions[3 * v], 3, points[v].data());
  const Points all(points.begin(), points.end());
  struct Found {
    Mirror mirror;
    size_t images;
  };
  std::vector<Found> found;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const size_t first = found.size();
    for (const Sum& tried : voteForSums(points, axis)) {
      const int64_t limit = int64_t{1} << (sum_bits - 1);
      if (tried.sum < -limit || tried.sum >= limit) continue;
      const size_t images = countImages(points, all, axis, tried.sum);
      if (images < std::max(kLeastImages, points.size() / kLeastShare)) continue;
      // Mirrors a step apart have about the same images.
      const auto near =
          std::find_if(found.begin() + static_cast<ptrdiff_t>(first), found.end(),
                       [&](const Found& f) { return std::abs(f.mirror.sum - tried.sum) <= 2; });
      const Found one{{axis, static_cast<int32_t>(tried.sum)}, images};
      if (near == found.end()) {
        found.push_back(one);
      } else if (images > near->images) {
        *near = one;
      }
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.images > b.images; });
  Mirrors mirrors;
  for (const Found& f : found) {
    if (mirrors.count < kMaxMirrors) mirrors.mirror[mirrors.count++] = f.mirror;
  }
  return mirrors;
}

void guessMates(std::span<const int32_t> positions, std::span<const uint32_t> order,
                const Mirrors& mirrors, const Anchors& anchors, VertexMates& mates) {
  if (!mates.assign(mirrors.count, anchors.count != 0, order.size(), kNone)) throwBadAlloc();
  for (uint32_t m = 0; m < mirrors.count; ++m) mates.axis[m] = mirrors.mirror[m].axis;
  PointMap at;
  for (const uint32_t v : order) {
    Point p;
    std::copy_n(&positions[3 * size_t{v}], 3, p.data());
    at[p] = v;
    if (mates.has_anchors) {
      mates.mateOf(mirrors.count, v) = anchors.mates[v];
      mates.turnOf(v) = anchors.turns[v];
    }
    for (uint32_t m = 0; m < mirrors.count; ++m) {
      const uint32_t axis = mirrors.mirror[m].axis;
      for (const uint32_t off : {0u, ~0u, 1u}) {
        Point q = p;
        q[axis] = static_cast<int32_t>(static_cast<uint32_t>(mirrors.mirror[m].sum) + off -
                                       static_cast<uint32_t>(p[axis]));
        const auto mate = at.find(q);
        if (mate == at.end() || mates.mateOf(m, mate->second) != kNone) continue;
        mates.mateOf(m, v) = mate->second;
        mates.mateOf(m, mate->second) = v;
        break;
      }
    }
  }
}

}  // namespace mcc
