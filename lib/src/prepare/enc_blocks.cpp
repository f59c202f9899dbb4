// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "prepare/enc_blocks.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace mcc {
namespace {

/// The first block has one of this many parts of what others have.
constexpr uint32_t kFirstBlockShare = 8;
constexpr uint32_t kSmoothingRounds = 4;

struct Centroid {
  float sum[3];
  uint32_t triangle;
};

/// A range of centroids that is to become `block_count` blocks.
struct Region {
  std::span<Centroid> centroids;
  uint32_t first_block;
  uint32_t block_count;
};

uint32_t longestAxis(std::span<const Centroid> centroids) {
  std::array<float, 3> low;
  std::array<float, 3> high;
  std::copy_n(centroids[0].sum, 3, low.begin());
  high = low;
  for (const Centroid& c : centroids) {
    for (size_t s = 0; s < 3; ++s) {
      low[s] = std::min(low[s], c.sum[s]);
      high[s] = std::max(high[s], c.sum[s]);
    }
  }
  uint32_t longest = 0;
  for (uint32_t s = 1; s < 3; ++s) {
    if (high[s] - low[s] > high[longest] - low[longest]) longest = s;
  }
  return longest;
}

/// Moves the `count` centroids that are lowest along the longest side to the front.
void divideAt(std::span<Centroid> centroids, size_t count) {
  const uint32_t axis = longestAxis(centroids);
  std::nth_element(centroids.begin(), centroids.begin() + static_cast<ptrdiff_t>(count),
                   centroids.end(), [axis](const Centroid& a, const Centroid& b) {
                     return a.sum[axis] != b.sum[axis] ? a.sum[axis] < b.sum[axis]
                                                       : a.triangle < b.triangle;
                   });
}

/// Divides a region of several blocks into two.
std::pair<Region, Region> halve(const Region& region) {
  const uint32_t blocks = region.block_count / 2;
  const size_t count = region.centroids.size() * uint64_t{blocks} / region.block_count;
  divideAt(region.centroids, count);
  return {
      {region.centroids.first(count), region.first_block, blocks},
      {region.centroids.subspan(count), region.first_block + blocks, region.block_count - blocks}};
}

/// Returns how many blocks the triangles after the first block make: an even number, because with
/// an odd one of two threads would wait while the other codes the last block.
uint32_t countAfterFirst(uint64_t triangle_count, uint64_t block_triangles) {
  if (2 * triangle_count < 3 * block_triangles) return 1;
  return static_cast<uint32_t>(
      2 * std::max<uint64_t>(1, (triangle_count + block_triangles) / (2 * block_triangles)));
}

/// Returns the block of each triangle.
std::vector<uint32_t> divide(std::vector<Centroid> centroids, uint32_t block_triangles,
                             uint32_t& block_count, const Jobs& jobs) {
  const size_t triangle_count = centroids.size();
  const size_t first_count =
      std::clamp<size_t>(block_triangles / kFirstBlockShare, 1, triangle_count - 1);
  const size_t rest = triangle_count - first_count;
  const uint32_t rest_blocks = countAfterFirst(rest, block_triangles);
  block_count = 1 + rest_blocks;
  divideAt(centroids, first_count);
  std::vector<Region> done = {{std::span(centroids).first(first_count), 0, 1}};
  std::vector<Region> regions = {{std::span(centroids).subspan(first_count), 1, rest_blocks}};
  while (!regions.empty()) {
    std::vector<Region> halves(2 * regions.size());
    jobs.run(regions.size(), [&](size_t i) {
      if (regions[i].block_count > 1)
        std::tie(halves[2 * i], halves[2 * i + 1]) = halve(regions[i]);
    });
    std::vector<Region> next;
    for (size_t i = 0; i < regions.size(); ++i) {
      if (regions[i].block_count == 1) {
        done.push_back(regions[i]);
      } else {
        next.insert(next.end(), {halves[2 * i], halves[2 * i + 1]});
      }
    }
    regions = std::move(next);
  }
  std::vector<uint32_t> block_of(triangle_count);
  jobs.run(done.size(), [&](size_t i) {
    for (const Centroid& c : done[i].centroids) block_of[c.triangle] = done[i].first_block;
  });
  return block_of;
}

/// Moves triangles to the block that two of their edges lead to.
class Smoothing {
 public:
  Smoothing(std::span<const uint32_t> corner_class, uint32_t class_count,
            std::vector<uint32_t>& block_of)
      : block_of_(block_of) {
    std::vector<uint32_t> block_of_class(class_count, kNoBlock);
    for (uint32_t t = 0; t < block_of.size(); ++t) {
      for (size_t k = 0; k < 3; ++k) {
        uint32_t& block = block_of_class[corner_class[3 * size_t{t} + k]];
        block = block == kNoBlock || block == block_of[t] ? block_of[t] : kManyBlocks;
      }
    }
    // Only edges between vertices of several blocks may lead to another block.
    for (uint32_t h = 0; h < corner_class.size(); ++h) {
      const uint32_t a = corner_class[h];
      const uint32_t b = corner_class[h % 3 == 2 ? h - 2 : h + 1];
      if (block_of_class[a] == kManyBlocks && block_of_class[b] == kManyBlocks)
        edges_.push_back({uint64_t{std::min(a, b)} << 32 | std::max(a, b), h / 3});
    }
    std::sort(edges_.begin(), edges_.end());
    for (size_t i = 0; i < edges_.size(); ++i) triangles_.push_back({edges_[i].triangle, i});
    std::sort(triangles_.begin(), triangles_.end());
  }

  void run() {
    for (uint32_t round = 0; round < kSmoothingRounds; ++round) {
      bool has_moved = false;
      for (size_t i = 0; i < triangles_.size();) {
        size_t end = i;
        while (end < triangles_.size() && triangles_[end].triangle == triangles_[i].triangle) ++end;
        has_moved |= move(i, end);
        i = end;
      }
      if (!has_moved) return;
    }
  }

 private:
  static constexpr uint32_t kNoBlock = 0xffffffffu;
  static constexpr uint32_t kManyBlocks = 0xfffffffeu;

  struct Edge {
    uint64_t ends;
    uint32_t triangle;
    bool operator<(const Edge& o) const {
      return ends != o.ends ? ends < o.ends : triangle < o.triangle;
    }
  };
  struct TriangleEdge {
    uint32_t triangle;
    size_t edge;
    bool operator<(const TriangleEdge& o) const {
      return triangle != o.triangle ? triangle < o.triangle : edge < o.edge;
    }
  };

  /// Moves the triangle of triangles_[begin .. end), its edges.
  bool move(size_t begin, size_t end) {
    uint32_t& block = block_of_[triangles_[begin].triangle];
    uint32_t candidate = block;
    for (size_t i = begin; i < end; ++i) {
      const uint32_t across = blockAcross(triangles_[i].edge);
      if (across == block) continue;
      if (across == candidate) {
        block = candidate;
        return true;
      }
      candidate = across;
    }
    return false;
  }

  /// Returns the block on the other side of an edge of two faces; otherwise its own.
  uint32_t blockAcross(size_t edge) const {
    const Edge& own = edges_[edge];
    const bool before = edge != 0 && edges_[edge - 1].ends == own.ends;
    const bool after = edge + 1 < edges_.size() && edges_[edge + 1].ends == own.ends;
    if (before == after) return block_of_[own.triangle];
    return block_of_[edges_[before ? edge - 1 : edge + 1].triangle];
  }

  std::vector<uint32_t>& block_of_;
  std::vector<Edge> edges_;
  std::vector<TriangleEdge> triangles_;
};

}  // namespace

BlockCut cutIntoBlocks(std::span<const float> centroid_sums, std::span<const uint32_t> corner_class,
                       uint32_t class_count, uint32_t block_triangles, const Jobs& jobs) {
  const uint32_t triangle_count = static_cast<uint32_t>(centroid_sums.size() / 3);
  std::vector<Centroid> centroids(triangle_count);
  for (uint32_t t = 0; t < triangle_count; ++t) {
    std::copy_n(&centroid_sums[3 * size_t{t}], 3, centroids[t].sum);
    centroids[t].triangle = t;
  }
  uint32_t block_count = 0;
  std::vector<uint32_t> block_of = divide(std::move(centroids), block_triangles, block_count, jobs);
  Smoothing(corner_class, class_count, block_of).run();

  std::vector<uint32_t> sizes(block_count, 0);
  for (const uint32_t block : block_of) ++sizes[block];
  BlockCut cut;
  std::vector<uint32_t> place(block_count, 0);
  cut.block_begin.push_back(0);
  for (uint32_t b = 0; b < block_count; ++b) {
    place[b] = cut.block_begin.back();
    if (sizes[b] != 0) cut.block_begin.push_back(place[b] + sizes[b]);
  }
  cut.triangles.resize(triangle_count);
  for (uint32_t t = 0; t < triangle_count; ++t) cut.triangles[place[block_of[t]]++] = t;
  return cut;
}

}  // namespace mcc
