// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Re-stitching of cut vertices: which decoded vertices share a position.                    [A.5]
//
// Cutting a mesh into manifold pieces duplicates vertices. Here every vertex is declared a copy of an earlier
// group of vertices, or founds one. Candidates come from the neighbours' groups: if u is glued to u2, then a
// neighbour of u is likely glued to a neighbour of u2. After the pass face corners hold group numbers; twins stay
// those of the cut pieces.
#ifndef MCC_CONNECTIVITY_STITCH_H_
#define MCC_CONNECTIVITY_STITCH_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/memory.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mesh/face_mesh.h"
#include "mesh/groups.h"

namespace mcc {

inline constexpr uint32_t kStitchRingLimit = 64;    ///< neighbours looked at per vertex
inline constexpr uint32_t kStitchMemberLimit = 24;  ///< copies looked at per group
inline constexpr uint32_t kStitchCandidateLimit = 32;
inline constexpr uint32_t kStitchCodedLimit = 12;  ///< candidates asked for one by one
inline constexpr uint32_t kStitchHops = 4;
inline constexpr uint32_t kStitchRecent = 16;

struct StitchModels {
  BitModel copy[2][4][20];
  BitModel candidate[kStitchCodedLimit][16][2][2];
  BitModel is_recent;
  GolombModel recent;
  TreeModel<6> far_length;
};

template <class Io>
class Stitcher {
 public:
  Stitcher(Io& io, StitchModels& models, FaceMesh& mesh, const Allocator& allocator,
           const uint32_t* class_of_vertex)
      : io_(io),
        models_(models),
        mesh_(mesh),
        faces_(mesh.view()),
        class_of_vertex_(class_of_vertex),
        start_(allocator),
        boundary_next_(allocator),
        boundary_prev_(allocator),
        group_(allocator),
        next_member_(allocator),
        leaders_(allocator),
        last_member_(allocator),
        member_count_(allocator),
        used_at_(allocator),
        leader_of_class_(allocator),
        allocator_(allocator) {}

  Status run(bool interior_copies, uint32_t class_count, Groups& groups);

 private:
  struct Candidate {
    uint32_t group;
    uint32_t score;
  };
  enum class EdgeSide : uint8_t {
    kInner,
    kOut,
    kIn
  };  ///< boundary half-edge leaving or entering the vertex

  Status allocate(uint32_t class_count);
  void findBoundaries();
  void collectCandidates(uint32_t v);
  void collectAcross(uint32_t u, EdgeSide side);
  void collectAlongBoundary(uint32_t v);
  void collectNear(uint32_t p, uint32_t hops);
  void addCandidate(uint32_t vertex, uint32_t score);
  void sortCandidates();
  bool codeCopy(uint32_t v, uint32_t truth);
  Status codeReference(uint32_t truth, uint32_t& group);
  Status codeFarReference(uint32_t truth, uint32_t& group);
  void noteUse(uint32_t group);
  Status finish(Groups& groups);

  bool onBoundary(uint32_t v) const { return boundary_next_[v] != kNone; }
  bool processed(uint32_t v) const { return group_[v] != kNone; }
  bool isMulti(uint32_t v) const { return processed(v) && member_count_[group_[v]] >= 2; }

  /// Calls visit(neighbour, side) for the ring of v, clockwise-most first, at most kStitchRingLimit times.
  template <class Visit>
  void forRing(uint32_t v, Visit visit) const {
    const uint32_t start = start_[v];
    uint32_t h = start;
    for (uint32_t n = 0; n < kStitchRingLimit; ++n) {
      const bool leaves = faces_.twin(h) == kNone;
      visit(faces_.vertex(nextHalfEdge(h)), leaves ? EdgeSide::kOut : EdgeSide::kInner);
      const uint32_t last = prevHalfEdge(h);
      h = faces_.twin(last);
      if (h == kNone) {
        visit(faces_.vertex(last), EdgeSide::kIn);
        return;
      }
      if (h == start) return;
    }
  }

  Io& io_;
  StitchModels& models_;
  FaceMesh& mesh_;
  FaceView faces_;
  const uint32_t* class_of_vertex_;  ///< encoder only
  Array<uint32_t> start_;  ///< half-edge leaving each vertex; on a boundary the clockwise-most
  Array<uint32_t> boundary_next_;
  Array<uint32_t> boundary_prev_;
  Array<uint32_t> group_;
  Array<uint32_t> next_member_;
  Array<uint32_t> leaders_;  ///< by group
  Array<uint32_t> last_member_;
  Array<uint32_t> member_count_;
  Array<uint32_t> used_at_;          ///< by group: time of its last use as a reference
  Array<uint32_t> leader_of_class_;  ///< encoder only: group of a class
  const Allocator allocator_;
  uint32_t time_ = 0;
  uint32_t last_reference_ = 0;
  uint32_t recent_[kStitchRecent];
  uint32_t recent_count_ = 0;
  uint32_t excluded_[kStitchRingLimit + 1];
  uint32_t excluded_count_ = 0;
  uint32_t multi_neighbours_ = 0;
  Candidate candidates_[2 * kStitchCandidateLimit];
  uint32_t candidate_count_ = 0;
};

template <class Io>
Status Stitcher<Io>::allocate(uint32_t class_count) {
  const uint32_t n = mesh_.vertex_count;
  if (!start_.assign(n, kNone) || !boundary_next_.assign(n, kNone) ||
      !boundary_prev_.assign(n, kNone) || !group_.assign(n, kNone) ||
      !next_member_.assign(n, kNone) || !leaders_.reserve(n) || !last_member_.reserve(n) ||
      !member_count_.reserve(n) || !used_at_.reserve(n) ||
      (Io::kEncoding && !leader_of_class_.assign(class_count, kNone))) {
    return fail(Error::kOutOfMemory, "no memory for stitching");
  }
  return {};
}

template <class Io>
void Stitcher<Io>::findBoundaries() {
  for (uint32_t f = 0; f < mesh_.face_count; ++f) {
    for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
      const uint32_t from = faces_.vertex(h);
      if (start_[from] == kNone) start_[from] = h;
      if (faces_.twin(h) != kNone) continue;
      const uint32_t to = faces_.vertex(nextHalfEdge(h));
      start_[from] = h;
      boundary_next_[from] = to;
      boundary_prev_[to] = from;
    }
  }
}

template <class Io>
Status Stitcher<Io>::run(bool interior_copies, uint32_t class_count, Groups& groups) {
  MCC_TRY(allocate(class_count));
  findBoundaries();
  for (uint32_t v = 0; v < mesh_.vertex_count; ++v) {
    if (start_[v] == kNone) return fail(Error::kBadConnectivity, "a vertex has no triangle");
    if (!interior_copies && !onBoundary(v)) continue;
    uint32_t truth = kNone;
    if constexpr (Io::kEncoding) truth = leader_of_class_[class_of_vertex_[v]];
    collectCandidates(v);
    uint32_t group = static_cast<uint32_t>(leaders_.size());
    if (codeCopy(v, truth)) {
      MCC_TRY(codeReference(truth, group));
      noteUse(group);
      next_member_[last_member_[group]] = v;
      last_member_[group] = v;
      ++member_count_[group];
    } else {
      // Reserved above: one group per vertex at most.
      (void)(leaders_.push_back(v) && last_member_.push_back(v) && member_count_.push_back(1) &&
             used_at_.push_back(0));
      if constexpr (Io::kEncoding) leader_of_class_[class_of_vertex_[v]] = group;
    }
    group_[v] = group;
    if ((v & 0xff) == 0 && io_.overrun()) {
      return fail(Error::kTruncated, "the code stream ends inside the stitching");
    }
  }
  return finish(groups);
}

template <class Io>
void Stitcher<Io>::collectCandidates(uint32_t v) {
  candidate_count_ = 0;
  excluded_count_ = 0;
  multi_neighbours_ = 0;
  forRing(v, [this](uint32_t u, EdgeSide) {
    if (!processed(u)) return;
    excluded_[excluded_count_++] = group_[u];  // no face has a vertex twice
    multi_neighbours_ += member_count_[group_[u]] >= 2 ? 1 : 0;
  });
  if (multi_neighbours_ != 0) {
    forRing(v, [this](uint32_t u, EdgeSide side) {
      if (isMulti(u)) collectAcross(u, side);
    });
  }
  if (onBoundary(v)) collectAlongBoundary(v);
  sortCandidates();
}

/// v is a neighbour of u: neighbours of u's copies.
template <class Io>
void Stitcher<Io>::collectAcross(uint32_t u, EdgeSide side) {
  uint32_t seen = 0;
  for (uint32_t u2 = leaders_[group_[u]]; u2 != kNone && seen < kStitchMemberLimit;
       u2 = next_member_[u2]) {
    if (u2 == u) continue;
    ++seen;
    forRing(u2, [this, side](uint32_t w, EdgeSide other) {
      if (!processed(w)) return;
      uint32_t score = 1;
      // v -> u on a boundary meets u2 -> w if the gap between them was cut.
      if (side != EdgeSide::kInner && other != EdgeSide::kInner) score = side == other ? 6 : 5;
      addCandidate(w, score);
    });
  }
}

template <class Io>
void Stitcher<Io>::collectAlongBoundary(uint32_t v) {
  for (const bool forward : {true, false}) {
    uint32_t p = v;
    for (uint32_t hops = 1; hops <= kStitchHops; ++hops) {
      p = forward ? boundary_next_[p] : boundary_prev_[p];
      if (p == kNone) break;
      if (!isMulti(p)) continue;
      uint32_t seen = 0;
      for (uint32_t p2 = leaders_[group_[p]]; p2 != kNone && seen < kStitchMemberLimit;
           p2 = next_member_[p2]) {
        if (p2 == p) continue;
        ++seen;
        if (onBoundary(p2)) collectNear(p2, hops);
      }
      break;
    }
  }
}

template <class Io>
void Stitcher<Io>::collectNear(uint32_t p, uint32_t hops) {
  for (const bool forward : {true, false}) {
    uint32_t w = p;
    for (uint32_t k = 1; k <= kStitchHops; ++k) {
      w = forward ? boundary_next_[w] : boundary_prev_[w];
      if (w == kNone) break;
      if (!processed(w) || (hops == 1 && k == 1)) continue;
      addCandidate(w, hops == k ? 3 : (hops + 1 == k || k + 1 == hops ? 2 : 1));
    }
  }
}

template <class Io>
void Stitcher<Io>::addCandidate(uint32_t vertex, uint32_t score) {
  const uint32_t group = group_[vertex];
  for (uint32_t i = 0; i < excluded_count_; ++i) {
    if (excluded_[i] == group) return;
  }
  for (uint32_t i = 0; i < candidate_count_; ++i) {
    if (candidates_[i].group == group) {
      candidates_[i].score += score;
      return;
    }
  }
  if (candidate_count_ < 2 * kStitchCandidateLimit)
    candidates_[candidate_count_++] = {group, score};
}

template <class Io>
void Stitcher<Io>::sortCandidates() {
  const auto before = [this](const Candidate& a, const Candidate& b) {
    if (a.score != b.score) return a.score > b.score;
    if (used_at_[a.group] != used_at_[b.group]) return used_at_[a.group] > used_at_[b.group];
    return a.group > b.group;
  };
  for (uint32_t i = 1; i < candidate_count_; ++i) {
    const Candidate c = candidates_[i];
    uint32_t k = i;
    for (; k != 0 && before(c, candidates_[k - 1]); --k) candidates_[k] = candidates_[k - 1];
    candidates_[k] = c;
  }
  candidate_count_ = std::min(candidate_count_, kStitchCandidateLimit);
}

template <class Io>
bool Stitcher<Io>::codeCopy(uint32_t v, uint32_t truth) {
  if (leaders_.empty()) return false;
  const uint32_t best = candidate_count_ == 0 ? 0 : 1 + std::min(18u, candidates_[0].score);
  BitModel& model = models_.copy[onBoundary(v) ? 1 : 0][std::min(3u, multi_neighbours_)][best];
  return io_.bit(model, Io::kEncoding && truth != kNone);
}

template <class Io>
Status Stitcher<Io>::codeReference(uint32_t truth, uint32_t& group) {
  const uint32_t asked = std::min(candidate_count_, kStitchCodedLimit);
  for (uint32_t i = 0; i < asked; ++i) {
    const Candidate& c = candidates_[i];
    const bool tied = i + 1 < candidate_count_ && candidates_[i + 1].score == c.score;
    const bool multi = member_count_[c.group] >= 2;
    BitModel& model = models_.candidate[i][std::min(15u, c.score)][multi ? 1 : 0][tied ? 1 : 0];
    if (io_.bit(model, Io::kEncoding && c.group == truth)) {
      group = c.group;
      return {};
    }
  }
  uint32_t rank = recent_count_;
  if constexpr (Io::kEncoding) {
    rank = 0;
    while (rank < recent_count_ && recent_[rank] != truth) ++rank;
  }
  if (recent_count_ == 0 || !io_.bit(models_.is_recent, Io::kEncoding && rank < recent_count_)) {
    return codeFarReference(truth, group);
  }
  rank = codeGolomb(io_, models_.recent, rank);
  if (rank >= recent_count_)
    return fail(Error::kBadStitch, "a copy refers to a group that is not there");
  group = recent_[rank];
  return {};
}

/// Signed distance to the last reference in the list of groups: length by a tree, the rest raw.
template <class Io>
Status Stitcher<Io>::codeFarReference(uint32_t truth, uint32_t& group) {
  uint32_t distance = 0;
  if constexpr (Io::kEncoding) distance = zigzag(static_cast<int32_t>(truth - last_reference_));
  uint32_t length = static_cast<uint32_t>(std::bit_width(distance));
  length = codeTree<Io, 6>(io_, models_.far_length, length);
  if (length > 32) return fail(Error::kBadStitch, "a copy refers to a group that is not there");
  if (length > 1) {
    const uint32_t low = (uint32_t{1} << (length - 1)) - 1;
    distance = (low + 1) | io_.raw(length - 1, distance & low);
  } else {
    distance = length;
  }
  group = last_reference_ + static_cast<uint32_t>(unzigzag(distance));
  if (group >= leaders_.size()) {
    return fail(Error::kBadStitch, "a copy refers to a group that is not there");
  }
  return {};
}

template <class Io>
void Stitcher<Io>::noteUse(uint32_t group) {
  used_at_[group] = ++time_;
  last_reference_ = group;
  uint32_t rank = 0;
  while (rank < recent_count_ && recent_[rank] != group) ++rank;
  if (rank == recent_count_ && recent_count_ < kStitchRecent) ++recent_count_;
  rank = std::min(rank, kStitchRecent - 1);
  for (; rank != 0; --rank) recent_[rank] = recent_[rank - 1];
  recent_[0] = group;
}

/// Numbers the groups by their first vertex and rewrites the corners.
template <class Io>
Status Stitcher<Io>::finish(Groups& groups) {
  const uint32_t n = mesh_.vertex_count;
  Array<uint32_t> number(allocator_);
  groups.count = 0;
  if (!number.resize(n) || !groups.umbrellas.reserve(n) ||
      !groups.umbrella_begin.reserve(size_t{n} + 1)) {
    return fail(Error::kOutOfMemory, "no memory for stitching");
  }
  for (uint32_t v = 0; v < n; ++v) {
    if (processed(v) && leaders_[group_[v]] != v) {
      number[v] = number[leaders_[group_[v]]];
      continue;
    }
    number[v] = groups.count++;
    (void)groups.umbrella_begin.push_back(static_cast<uint32_t>(groups.umbrellas.size()));
    (void)groups.umbrellas.push_back(start_[v]);
    if (!processed(v)) continue;
    for (uint32_t u = next_member_[v]; u != kNone; u = next_member_[u]) {
      (void)groups.umbrellas.push_back(start_[u]);
    }
  }
  (void)groups.umbrella_begin.push_back(static_cast<uint32_t>(groups.umbrellas.size()));
  for (uint32_t f = 0; f < mesh_.face_count; ++f) {
    uint32_t* corner = mesh_.words.data() + size_t{f} * kFaceWords;
    for (int k = 0; k < 3; ++k) corner[k] = number[corner[k]];
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_STITCH_H_
