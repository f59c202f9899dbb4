// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What all attributes of a piece share: the order of the wedges, the faces that each wedge
// completes, positions as the predictions see them, and groups of wedges with equal values.
// [A.10.1]
#ifndef MCC_SURFACE_WEDGES_H_
#define MCC_SURFACE_WEDGES_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/float4.h"
#include "base/memory.h"
#include "mesh/dequantize.h"
#include "mesh/face_mesh.h"

namespace mcc {

/// The wedges in coding order. Built once per piece, after the seams; keeps links in the faces'
/// kFaceWord.
class WedgeMesh {
 public:
  explicit WedgeMesh(const Allocator& allocator)
      : faces(FaceView{nullptr}), order_(allocator), rank_(allocator), completed_(allocator) {}

  /// Builds the order. `starts` has a half-edge per wedge in coding order. Wedges from
  /// `surface_wedges` on are in no face. Without seams, `group_of_wedge` is null and wedges have
  /// the numbers of their groups; with seams, wedges are numbered in coding order.
  Status build(FaceMesh& mesh, const uint32_t* starts, uint32_t surface_wedges,
               uint32_t wedge_count, const uint32_t* group_of_wedge);

  /// Calls visit(wedge) for the first `end` wedges in coding order. `data`, of `stride` elements
  /// per wedge, is fetched before it is visited.
  template <class T, class Visit>
  MCC_INLINE void forCoded(uint32_t end, const T* data, size_t stride, Visit visit) const {
    const uint32_t* const order = order_.empty() ? nullptr : order_.data();
    const auto wedgeAt = [order](uint32_t i) { return order == nullptr ? i : order[i]; };
    const uint32_t* const completed = completed_.data();
    for (uint32_t i = 0; i < end; ++i) {
      if (i + 2 * kPrefetch < surface_count) {
        const uint32_t far = wedgeAt(i + 2 * kPrefetch);
        MCC_PREFETCH(&completed[far]);
        MCC_PREFETCH(data + stride * far);
        const uint32_t entry = completed[wedgeAt(i + kPrefetch)];
        if (entry != kNone) MCC_PREFETCH(&faces.words[entry]);
      }
      visit(wedgeAt(i));
    }
  }
  /// The half-edges that leave `wedge` in the faces it completes, those in which all other corners
  /// come before it in coding order.
  uint32_t firstCompleted(uint32_t wedge) const { return completed_[wedge]; }
  uint32_t nextCompleted(uint32_t h) const { return faces.words[(h & ~7u) + kFaceWord]; }
  uint32_t vertexOf(uint32_t w) const {
    return group_of_wedge_ == nullptr ? w : group_of_wedge_[w];
  }
  /// Returns whether wedge `w` is on the same vertex as wedge w-1.
  bool continuesVertex(uint32_t w) const {
    return group_of_wedge_ != nullptr && w != 0 && w < surface_count &&
           group_of_wedge_[w] == group_of_wedge_[w - 1];
  }
  /// Calls visit(h) for the half-edges that leave `wedge` in its first run of faces, until it
  /// returns false; at most 16 times.
  template <class Visit>
  void forRun(uint32_t wedge, Visit visit) const;
  bool hasSeams() const { return group_of_wedge_ != nullptr; }
  /// The clockwise-most half-edge of the wedge's first run of faces.
  uint32_t startOf(uint32_t wedge) const { return starts_[rankOf(wedge)]; }

  FaceView faces;
  uint32_t face_count = 0;
  uint32_t surface_count = 0;  ///< wedges in faces
  uint32_t count = 0;
  /// Number of wedges in coding order; lower than `count` in the writer's trials.
  uint32_t coded_count = 0;

 private:
  static constexpr uint32_t kPrefetch = 4;  ///< places ahead

  // Places in coding order do not leave this class: outside, a wedge has its number only.
  uint32_t rankOf(uint32_t wedge) const { return rank_.empty() ? wedge : rank_[wedge]; }

  Array<uint32_t> order_;  ///< empty if wedges are numbered in coding order
  Array<uint32_t> rank_;
  Array<uint32_t> completed_;
  const uint32_t* starts_ = nullptr;
  const uint32_t* group_of_wedge_ = nullptr;
};

inline Status WedgeMesh::build(FaceMesh& mesh, const uint32_t* starts, uint32_t surface_wedges,
                               uint32_t wedge_count, const uint32_t* group_of_wedge) {
  faces = mesh.view();
  face_count = mesh.face_count;
  surface_count = surface_wedges;
  count = coded_count = wedge_count;
  starts_ = starts;
  group_of_wedge_ = group_of_wedge;
  order_.clear();
  rank_.clear();
  if (!completed_.assign(wedge_count, kNone) ||
      (group_of_wedge == nullptr &&
       (!order_.resize(wedge_count) || !rank_.resize(surface_wedges)))) {
    return fail(Error::kOutOfMemory, "no memory for attributes");
  }
  for (uint32_t i = 0; group_of_wedge == nullptr && i < surface_wedges; ++i) {
    order_[i] = faces.vertex(starts[i]);
    rank_[order_[i]] = i;
  }
  for (uint32_t i = surface_wedges; i < order_.size(); ++i) order_[i] = i;
  for (uint32_t f = face_count; f-- != 0;) {  // backwards, so that the lists ascend
    // No branches, because which corner is the last one is close to random.
    const uint32_t* corner = faces.words + f * kFaceWords;
    uint32_t latest = 4 * rankOf(corner[0]) + 3;  // and, below the rank, 3 - corner
    latest = std::max(latest, 4 * rankOf(corner[1]) + 2);
    latest = std::max(latest, 4 * rankOf(corner[2]) + 1);
    const uint32_t last = f * kFaceWords + 3 - (latest & 3);
    uint32_t& first = completed_[faces.vertex(last)];
    faces.words[f * kFaceWords + kFaceWord] = first;
    first = last;
  }
  return {};
}

template <class Visit>
void WedgeMesh::forRun(uint32_t wedge, Visit visit) const {
  if (wedge >= surface_count) return;
  const uint32_t start = startOf(wedge);
  uint32_t budget = 16;
  uint32_t h = start;
  do {
    if (!visit(h) || --budget == 0) return;
    h = faces.rotateCcw(h);
  } while (h != kNone && h != start && faces.vertex(h) == wedge);
  if (h == start) return;
  for (h = faces.rotateCw(start); h != kNone && faces.vertex(h) == wedge; h = faces.rotateCw(h)) {
    if (!visit(h) || --budget == 0) return;
  }
}

/// Groups of wedges of a vertex that have equal values; each group is coded once, at its first
/// wedge.
struct EqualGroups {
  explicit EqualGroups(const Allocator& allocator) : first(allocator), next(allocator) {}

  Array<uint32_t> first;  ///< of the group; empty if every wedge is its own group
  Array<uint32_t> next;   ///< of the same group; kNone for the last

  bool isFirst(uint32_t wedge) const { return first.empty() || first[wedge] == wedge; }
  uint32_t firstOf(uint32_t wedge) const { return first.empty() ? wedge : first[wedge]; }
  uint32_t nextOf(uint32_t wedge) const { return next.empty() ? kNone : next[wedge]; }
  void clear() {
    first.clear();
    next.clear();
  }
};

/// Adds the sums (4 floats each) of all members of a group to those of its first wedge.
inline void gatherGroups(const WedgeMesh& wedges, const EqualGroups& groups, float* sums) {
  if (groups.first.empty()) return;
  for (uint32_t w = 0; w < wedges.surface_count; ++w) {
    const uint32_t first = groups.first[w];
    if (first == w) continue;
    storeFloat4(sums + 4 * size_t{first},
                loadFloat4(sums + 4 * size_t{first}) + loadFloat4(sums + 4 * size_t{w}));
  }
}

/// The order in which wedges are coded: wedge faces.vertex(half_edges[i]) is the i-th; isolated
/// wedges follow.
struct WedgeSequence {
  const uint32_t* half_edges = nullptr;
  uint32_t count = 0;
  /// Number of the first wedge that is in no triangle; the others follow it.
  uint32_t isolated_first = 0;
  uint32_t isolated_count = 0;
};

/// Returns the squared distance of two wedges; `positions` as below.
inline float squaredDistance(const float* positions, uint32_t a, uint32_t b) {
  const float* p = positions + 4 * size_t{a};
  const float* q = positions + 4 * size_t{b};
  const float d[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/// The coordinates that predictions see are integers of at most this many bits, stored as floats.
/// Products of a few of their differences therefore neither overflow nor become denormal. [A.6.13]
inline constexpr uint32_t kPredictionBits = 22;

/// Converts wedge positions to float32 integers, 4 per wedge. `position(w)` returns coordinates of
/// any range and one more integer (int32[4]).
template <class Position>
Status latticePredictionPositions(uint32_t count, Position position, Array<float>& out) {
  if (!out.resize(4 * size_t{count})) return fail(Error::kOutOfMemory, "no memory for attributes");
  if (count == 0) return {};
  const Lanes<int32_t> centre = loadLanes<int32_t>(position(0));
  Lanes<int32_t> lowest = centre;
  Lanes<int32_t> highest = centre;
  for (uint32_t w = 0; w < count; ++w) {
    const Lanes<int32_t> q = loadLanes<int32_t>(position(w));
    lowest = chooseLanes<int32_t>(q < lowest, q, lowest);
    highest = chooseLanes<int32_t>(q > highest, q, highest);
  }
  int64_t reach = 0;
  for (int s = 0; s < 3; ++s) {
    reach = std::max({reach, int64_t{highest[s]} - centre[s], int64_t{centre[s]} - lowest[s]});
  }
  const uint32_t length = static_cast<uint32_t>(std::bit_width(static_cast<uint64_t>(reach)));
  const int32_t shift =
      length > kPredictionBits ? static_cast<int32_t>(length - kPredictionBits) : 0;
  for (uint32_t w = 0; w < count; ++w) {
    // The differences have 33 bits, so negative ones are shifted as their complements.
    const Lanes<int32_t> q = loadLanes<int32_t>(position(w));
    const Lanes<uint32_t> negative = lanesAs<uint32_t>(q < centre);
    const Lanes<uint32_t> difference = lanesAs<uint32_t>(q) - lanesAs<uint32_t>(centre);
    const Lanes<uint32_t> shifted = ((difference ^ negative) >> shift) ^ negative;
    storeFloat4(&out[4 * size_t{w}],
                convertLanes<float>(lanesAs<int32_t>(shifted & Lanes<uint32_t>{~0u, ~0u, ~0u, 0})));
  }
  return {};
}

/// Does the same for exact floats, given as ordered integers; values that are not finite count as
/// 0.
template <class Position>
Status floatPredictionPositions(uint32_t count, Position position, Array<float>& out) {
  if (!out.resize(4 * size_t{count})) return fail(Error::kOutOfMemory, "no memory for attributes");
  if (count == 0) return {};
  const auto valueOf = [](int32_t ordered) {
    const uint32_t bits = bitsFromOrdered(ordered);
    return (bits & 0x7f800000u) == 0x7f800000u ? 0.0
                                               : static_cast<double>(std::bit_cast<float>(bits));
  };
  const int32_t* q0 = position(0);
  const double centre[3] = {valueOf(q0[0]), valueOf(q0[1]), valueOf(q0[2])};
  double reach = 0;
  for (uint32_t w = 0; w < count; ++w) {
    const int32_t* q = position(w);
    for (int s = 0; s < 3; ++s) {
      const double d = valueOf(q[s]) - centre[s];
      const double absolute = d < 0 ? -d : d;
      reach = absolute > reach ? absolute : reach;
    }
  }
  // A power of two that brings `reach` (below 2^129, and not denormal as a double) to at most 2^22.
  const uint64_t exponent = std::bit_cast<uint64_t>(reach) >> 52;
  const uint64_t scale_exponent = exponent == 0 ? 1023 : 2 * 1023 + kPredictionBits - 1 - exponent;
  const double scale = std::bit_cast<double>(scale_exponent << 52);
  for (uint32_t w = 0; w < count; ++w) {
    const int32_t* q = position(w);
    float* p = &out[4 * size_t{w}];
    for (int s = 0; s < 3; ++s) {
      p[s] = static_cast<float>(static_cast<int32_t>((valueOf(q[s]) - centre[s]) * scale));
    }
    p[3] = 0;
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_SURFACE_WEDGES_H_
