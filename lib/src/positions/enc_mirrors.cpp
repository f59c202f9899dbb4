// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "positions/enc_mirrors.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>
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

/// The sums of coordinates of pairs of points that agree on the other axes, and how often each
/// occurs. Sums have 64 bits, since those of a wide lattice may not fit in 32.
class Votes {
 public:
  Votes(const std::vector<Point>& points, uint32_t axis);

  /// Returns the sums with most votes, most frequent first.
  std::vector<int64_t> mostFrequent() const;

  /// Returns how many points may have another one at most a step from their image: each that has
  /// is one of two with a vote, or on a line that has none because it has too many points.
  size_t mostImages(int64_t sum) const {
    size_t count = on_crowded_lines_;
    for (const int64_t off : {-1, 0, 1}) {
      const auto votes = votes_.find(sum + off);
      count += votes == votes_.end() ? 0 : 2 * votes->second;
    }
    return count;
  }

 private:
  std::unordered_map<int64_t, size_t> votes_;
  size_t on_crowded_lines_ = 0;
};

Votes::Votes(const std::vector<Point>& points, uint32_t axis) {
  struct OnLine {
    uint64_t line;  ///< the coordinates on the other axes
    int64_t at;
  };
  std::vector<OnLine> sorted;
  sorted.reserve(points.size());
  for (const Point& p : points) {
    const uint64_t high = static_cast<uint32_t>(p[(axis + 1) % 3]);
    sorted.push_back({high << 32 | static_cast<uint32_t>(p[(axis + 2) % 3]), p[axis]});
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const OnLine& a, const OnLine& b) { return a.line < b.line; });
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    auto end = begin;
    while (end != sorted.end() && end->line == begin->line) ++end;
    const size_t count = static_cast<size_t>(end - begin);
    if (count > kMostOnLine) on_crowded_lines_ += count;
    for (auto a = begin; a != end && count <= kMostOnLine; ++a) {
      for (auto b = begin; b != a; ++b) ++votes_[a->at + b->at];
    }
    begin = end;
  }
}

std::vector<int64_t> Votes::mostFrequent() const {
  std::vector<std::pair<int64_t, size_t>> all(votes_.begin(), votes_.end());
  const size_t kept = std::min(all.size(), kTriedSums);
  std::partial_sort(all.begin(), all.begin() + static_cast<ptrdiff_t>(kept), all.end(),
                    [](const auto& a, const auto& b) {
                      return a.second != b.second ? a.second > b.second : a.first < b.first;
                    });
  std::vector<int64_t> sums;
  for (size_t i = 0; i < kept; ++i) sums.push_back(all[i].first);
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
  Points all;  // empty until a sum may have enough images: most scans have none
  struct Found {
    Mirror mirror;
    size_t images;
  };
  std::vector<Found> found;
  const size_t least = std::max(kLeastImages, points.size() / kLeastShare);
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const size_t first = found.size();
    const Votes votes(points, axis);
    for (const int64_t sum : votes.mostFrequent()) {
      const int64_t limit = int64_t{1} << (sum_bits - 1);
      if (sum < -limit || sum >= limit || votes.mostImages(sum) < least) continue;
      if (all.empty()) all.insert(points.begin(), points.end());
      const size_t images = countImages(points, all, axis, sum);
      if (images < least) continue;
      // Mirrors a step apart have about the same images.
      const auto near =
          std::find_if(found.begin() + static_cast<ptrdiff_t>(first), found.end(),
                       [&](const Found& f) { return std::abs(f.mirror.sum - sum) <= 2; });
      const Found one{{axis, static_cast<int32_t>(sum)}, images};
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
