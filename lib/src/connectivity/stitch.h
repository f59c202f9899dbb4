// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Re-stitching of cut vertices: which decoded vertices share a position.                    [A.5]
//
// Cutting a mesh into manifold pieces duplicates vertices. Here every vertex is declared a copy of an earlier
// group of vertices, or founds one. A copy's group is looked for where it is likely, in this order:
//
//   candidates   if u is glued to u2, a neighbour of u is likely glued to a neighbour of u2: scored, asked one by one
//   the loop     vertices of the same boundary loop, by distance: holes that touch themselves
//   nearby       vertices a few edges away: edges of four faces, cubes that touch
//   recent       groups referred to lately
//   anywhere     groups whose first vertex lies on a loop of the same length, else any group
//
// After the pass face corners hold group numbers; twins stay those of the cut pieces. Every walk is capped, so the
// time is linear in the vertices whatever the stream says.
#ifndef MCC_CONNECTIVITY_STITCH_H_
#define MCC_CONNECTIVITY_STITCH_H_

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "base/memory.h"
#include "connectivity/stitch_shape.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mesh/face_mesh.h"
#include "mesh/groups.h"

namespace mcc {

inline constexpr uint32_t kStitchRingLimit = 64;    ///< neighbours looked at per vertex
inline constexpr uint32_t kStitchMemberLimit = 24;  ///< copies looked at per group
inline constexpr uint32_t kStitchWorkLimit = 128;   ///< vertices looked at for candidates of one
inline constexpr uint32_t kStitchLeastWork = 8;     ///< where candidates are useless, in soups
inline constexpr uint32_t kStitchPatience = 16;     ///< useless copies until the limit is halved
inline constexpr uint32_t kStitchCandidateLimit = 64;
inline constexpr uint32_t kStitchCodedLimit = 12;  ///< candidates asked for one by one
inline constexpr uint32_t kStitchHops = 4;
inline constexpr uint32_t kStitchSteps = 16;  ///< along the own loop, each way
inline constexpr uint32_t kStitchNearLimit =
    96;  ///< vertices visited nearby until no further ring is looked at
inline constexpr uint32_t kStitchNearRoom = kStitchNearLimit + kStitchRingLimit + 1;
inline constexpr uint32_t kStitchNearRadius = 4;
inline constexpr uint32_t kStitchRecent = 16;

struct StitchModels {
  BitModel copy[2][4][20];
  BitModel copy_shape[2][4][kStitchLoopClasses * 16];
  BitModel candidate[kStitchCodedLimit][16][2][2];
  BitModel on_loop[kStitchLoopClasses];
  BitModel loop_step[kStitchSteps + 1][4];
  BitModel near_ring[kStitchNearRadius - 1][8];
  BitModel near_place[kStitchNearRadius - 1][15];
  BitModel is_recent;
  GolombModel recent;
  BitModel same_class[2];
  TreeModel<6> far_length[2];
};

/// One decision with two models, weighted by how much each has seen, up to a limit.           [A.5.2]
template <class Io>
bool codeMixed(Io& io, BitModel& a, BitModel& b, bool truth) {
  constexpr uint32_t kCountMask = 1023;
  constexpr uint32_t kWeightLimit = 8;
  const uint32_t weight_a = std::min((a.state() & kCountMask) + 1, kWeightLimit);
  const uint32_t weight_b = std::min((b.state() & kCountMask) + 1, kWeightLimit);
  BitModel mixed;
  mixed.set(
      (a.zeroProbability() * weight_a + b.zeroProbability() * weight_b) / (weight_a + weight_b)
      << 10);
  const bool bit = io.bit(mixed, truth);
  a.update(bit);
  b.update(bit);
  return bit;
}

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
        shape_(allocator),
        vertices_(shape_.vertices),
        groups_(allocator),
        by_class_(allocator),
        leader_of_class_(allocator) {}

  Status run(bool interior_copies, uint32_t class_count, Groups& groups);

 private:
  struct Group {
    uint32_t leader;
    uint32_t last_member;
    uint32_t member_count;
    uint32_t used_at;      ///< time of its last use as a reference
    uint32_t stamp;        ///< vertex that `slot` is for
    uint32_t slot;         ///< index in candidates_, kExcluded
    uint32_t class_place;  ///< index in by_class_
    uint32_t spare;        ///< a cache line has two
  };
  struct Candidate {
    uint32_t group;
    uint32_t score;
  };
  static constexpr uint32_t kExcluded = kNone;

  Status allocate(uint32_t class_count);
  void sortClasses();
  Status stitchVertex(uint32_t v);
  void found(uint32_t v);
  void join(uint32_t v, uint32_t group);
  void markNeighbours(uint32_t v);

  void collectCandidates(uint32_t v);
  void collectAcross(uint32_t u, EdgeSide side);
  void collectAlongBoundary(uint32_t v);
  void collectNear(uint32_t p, uint32_t hops);
  void addCandidate(uint32_t vertex, uint32_t score);
  void excludeRing(uint32_t v);
  void sortCandidates();

  uint32_t boundaryDegree(uint32_t v) const;
  bool codeCopy(uint32_t v, uint32_t truth);
  Status codeReference(uint32_t v, uint32_t truth, uint32_t& group);
  bool codeCandidate(uint32_t truth, uint32_t& group);
  bool codeOnLoop(uint32_t v, uint32_t truth, uint32_t& group);
  bool codeNearby(uint32_t v, uint32_t truth, uint32_t& group);
  uint32_t visitRing(uint32_t v, uint32_t begin, uint32_t end);
  uint32_t findEligible(uint32_t begin, uint32_t end, uint32_t truth, uint32_t& truth_place);
  Status codeRecent(uint32_t truth, uint32_t& group, bool& is_recent);
  Status codeAnywhere(uint32_t v, uint32_t truth, uint32_t& group);
  Status codeFarReference(TreeModel<6>& model, uint32_t last, uint32_t count, uint32_t truth,
                          uint32_t& index);
  void noteUse(uint32_t group);
  Status finish(Groups& groups);
  [[nodiscard]] bool listUmbrellas(uint32_t v, uint32_t number, Groups& groups) const;

  // `v`, `u`, `w` are places in vertices_.
  uint32_t vertexAt(uint32_t v) const { return faces_.vertex(vertices_[v].start); }
  bool onBoundary(uint32_t v) const { return vertices_[v].next != kNone; }
  /// `v` may be kNone.
  bool processed(uint32_t v) const { return v != kNone && vertices_[v].group != kNone; }
  bool isMulti(uint32_t v) const {
    return processed(v) && groups_[vertices_[v].group].member_count >= 2;
  }
  bool isAsked(uint32_t group) const {
    const Group& g = groups_[group];
    return g.stamp == now_ && g.slot == kExcluded;
  }
  void exclude(uint32_t group) {
    groups_[group].stamp = now_;
    groups_[group].slot = kExcluded;
  }
  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for stitching"); }
  static Status noSuchGroup() {
    return fail(Error::kBadStitch, "a copy refers to a group that is not there");
  }

  Io& io_;
  StitchModels& models_;
  FaceMesh& mesh_;
  FaceView faces_;
  const uint32_t* class_of_vertex_;  ///< encoder only
  StitchShape shape_;
  Array<StitchVertex>& vertices_;
  Array<Group> groups_;
  Array<uint32_t>
      by_class_;  ///< groups in the order they were founded, by loop class of their leaders
  Array<uint32_t> leader_of_class_;  ///< encoder only: group of a class
  uint32_t class_begin_[kStitchLoopClasses + 1];
  uint32_t class_end_[kStitchLoopClasses];
  uint32_t last_in_class_[kStitchLoopClasses];
  bool interior_copies_ = false;
  uint32_t now_ = 0;  ///< the vertex at work
  uint32_t time_ = 0;
  uint32_t copy_count_ = 0;
  uint32_t last_reference_ = 0;
  uint32_t recent_[kStitchRecent];
  uint32_t recent_count_ = 0;
  Candidate candidates_[kStitchCandidateLimit];
  uint32_t candidate_count_ = 0;
  uint32_t best_score_ = 0;
  uint32_t misses_ = 0;  ///< copies in a row that no candidate stood for
  uint32_t work_limit_ = 0;
  uint32_t work_ = 0;                   ///< vertices looked at for candidates
  uint32_t nearby_[kStitchNearRoom];    ///< vertices
  uint32_t eligible_[kStitchNearRoom];  ///< groups
};

template <class Io>
Status Stitcher<Io>::allocate(uint32_t class_count) {
  MCC_TRY(buildShape(mesh_, faces_, interior_copies_, shape_));
  const size_t n = vertices_.size();
  if (!groups_.reserve(n) || !by_class_.resize(n) ||
      (Io::kEncoding && !leader_of_class_.assign(class_count, kNone))) {
    return noMemory();
  }
  return {};
}

/// Room for every class in by_class_.
template <class Io>
void Stitcher<Io>::sortClasses() {
  uint32_t count[kStitchLoopClasses] = {};
  for (uint32_t v = 0; v < vertices_.size(); ++v) ++count[vertices_[v].kind.loop];
  uint32_t begin = 0;
  for (uint32_t c = 0; c < kStitchLoopClasses; ++c) {
    class_begin_[c] = class_end_[c] = begin;
    last_in_class_[c] = 0;
    begin += count[c];
  }
  class_begin_[kStitchLoopClasses] = begin;
}

template <class Io>
Status Stitcher<Io>::run(bool interior_copies, uint32_t class_count, Groups& groups) {
  interior_copies_ = interior_copies;
  MCC_TRY(allocate(class_count));
  sortClasses();
  for (uint32_t v = 0; v < vertices_.size(); ++v) {
    MCC_TRY(stitchVertex(v));
    if ((v & 0xff) == 0 && io_.overrun()) {
      return fail(Error::kTruncated, "the code stream ends inside the stitching");
    }
  }
  return finish(groups);
}

template <class Io>
Status Stitcher<Io>::stitchVertex(uint32_t v) {
  uint32_t truth = kNone;
  if constexpr (Io::kEncoding) truth = leader_of_class_[class_of_vertex_[vertexAt(v)]];
  now_ = v;
  collectCandidates(v);
  if (!codeCopy(v, truth)) {
    found(v);
    return {};
  }
  uint32_t group = 0;
  MCC_TRY(codeReference(v, truth, group));
  noteUse(group);
  join(v, group);
  return {};
}

template <class Io>
void Stitcher<Io>::found(uint32_t v) {
  const uint32_t group = static_cast<uint32_t>(groups_.size());
  const uint32_t place = class_end_[vertices_[v].kind.loop]++;
  by_class_[place] = group;
  (void)groups_.push_back(
      Group{v, v, 1, 0, kNone, 0, place, 0});  // reserved: one group per vertex at most
  vertices_[v].group = group;
  if constexpr (Io::kEncoding) leader_of_class_[class_of_vertex_[vertexAt(v)]] = group;
}

template <class Io>
void Stitcher<Io>::join(uint32_t v, uint32_t group) {
  Group& g = groups_[group];
  ++copy_count_;
  vertices_[g.last_member].next_member = v;
  vertices_[v].next_member = kNone;
  g.last_member = v;
  vertices_[v].group = group;
  if (++g.member_count == 2) markNeighbours(g.leader);
  markNeighbours(v);
}

/// So that vertices without copies around, that is most, need no look at them. Once per vertex.
template <class Io>
void Stitcher<Io>::markNeighbours(uint32_t v) {
  forRing(shape_, faces_, v, [this](uint32_t u, EdgeSide) {
    if (u == kNone) return true;
    StitchKind& kind = vertices_[u].kind;
    if (kind.gluedNeighbours() < 3) ++kind.marks;
    return true;
  });
  if (!onBoundary(v)) return;
  for (const bool forward : {true, false}) {
    uint32_t u = v;
    for (uint32_t hops = 0; hops < kStitchHops; ++hops) {
      u = forward ? vertices_[u].next : vertices_[u].prev;
      if (u == kNone) break;
      vertices_[u].kind.marks |= StitchKind::kNearGlued;
    }
  }
}

// --- candidates --------------------------------------------------------------------------------------

template <class Io>
void Stitcher<Io>::collectCandidates(uint32_t v) {
  candidate_count_ = 0;
  best_score_ = 0;
  work_ = 0;
  work_limit_ = std::max(kStitchWorkLimit >> (misses_ / kStitchPatience), kStitchLeastWork);
  if (vertices_[v].kind.gluedNeighbours() != 0) {
    excludeRing(v);
    uint32_t seen = 0;
    forRing(shape_, faces_, v, [this, &seen](uint32_t u, EdgeSide side) {
      if (isMulti(u)) collectAcross(u, side);
      return ++seen < kStitchRingLimit && work_ < work_limit_;
    });
  }
  if ((vertices_[v].kind.marks & StitchKind::kNearGlued) != 0) collectAlongBoundary(v);
}

/// No face has a vertex twice.
template <class Io>
void Stitcher<Io>::excludeRing(uint32_t v) {
  uint32_t seen = 0;
  forRing(shape_, faces_, v, [this, &seen](uint32_t u, EdgeSide) {
    if (processed(u)) exclude(vertices_[u].group);
    return ++seen < kStitchRingLimit;
  });
}

/// v is a neighbour of u: neighbours of u's copies. [A.5.3]
template <class Io>
void Stitcher<Io>::collectAcross(uint32_t u, EdgeSide side) {
  uint32_t seen = 0;
  for (uint32_t u2 = groups_[vertices_[u].group].leader;
       u2 != kNone && seen < kStitchMemberLimit && work_ < work_limit_;
       u2 = vertices_[u2].next_member) {
    if (u2 == u) continue;
    ++seen;
    forRing(shape_, faces_, u2, [this, side](uint32_t w, EdgeSide other) {
      if (processed(w)) {
        uint32_t score = 1;
        // v -> u on a boundary meets u2 -> w if the gap between them was cut.
        if (side != EdgeSide::kInner && other != EdgeSide::kInner) score = side == other ? 6 : 5;
        addCandidate(w, score);
      }
      return ++work_ < work_limit_;
    });
  }
}

template <class Io>
void Stitcher<Io>::collectAlongBoundary(uint32_t v) {
  for (const bool forward : {true, false}) {
    uint32_t p = v;
    for (uint32_t hops = 1; hops <= kStitchHops; ++hops) {
      p = forward ? vertices_[p].next : vertices_[p].prev;
      if (p == kNone) break;
      if (!isMulti(p)) continue;
      uint32_t seen = 0;
      for (uint32_t p2 = groups_[vertices_[p].group].leader;
           p2 != kNone && seen < kStitchMemberLimit && work_ < work_limit_;
           p2 = vertices_[p2].next_member) {
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
      w = forward ? vertices_[w].next : vertices_[w].prev;
      if (w == kNone) break;
      ++work_;
      if (!processed(w) || (hops == 1 && k == 1)) continue;
      addCandidate(w, hops == k ? 3 : (hops + 1 == k || k + 1 == hops ? 2 : 1));
    }
  }
}

template <class Io>
void Stitcher<Io>::addCandidate(uint32_t vertex, uint32_t score) {
  const uint32_t group = vertices_[vertex].group;
  Group& g = groups_[group];
  if (g.stamp != now_) {
    if (candidate_count_ == kStitchCandidateLimit) return;
    g.stamp = now_;
    g.slot = candidate_count_;
    candidates_[candidate_count_++] = {group, 0};
  } else if (g.slot == kExcluded) {
    return;
  }
  uint32_t& sum = candidates_[g.slot].score;
  sum += score;
  best_score_ = std::max(best_score_, sum);
}

/// The candidates that may be asked for, and one more, move to the front in order.
template <class Io>
void Stitcher<Io>::sortCandidates() {
  const auto before = [this](const Candidate& a, const Candidate& b) {
    if (a.score != b.score) return a.score > b.score;
    const uint32_t time_a = groups_[a.group].used_at;
    const uint32_t time_b = groups_[b.group].used_at;
    if (time_a != time_b) return time_a > time_b;
    return a.group > b.group;
  };
  uint32_t sorted = 0;
  for (uint32_t i = 0; i < candidate_count_; ++i) {
    const Candidate c = candidates_[i];
    uint32_t k = sorted;
    if (sorted <= kStitchCodedLimit) {
      ++sorted;
    } else if (before(c, candidates_[--k])) {
      // The last of the sorted drops out.
    } else {
      continue;
    }
    for (; k != 0 && before(c, candidates_[k - 1]); --k) candidates_[k] = candidates_[k - 1];
    candidates_[k] = c;
  }
  candidate_count_ = sorted;
}

// --- coding ------------------------------------------------------------------------------------------

/// Triangles at a vertex of a boundary, up to 15.
template <class Io>
uint32_t Stitcher<Io>::boundaryDegree(uint32_t v) const {
  uint32_t degree = 1;
  for (uint32_t h = faces_.rotateCcw(vertices_[v].start); h != kNone && degree < 15; ++degree) {
    h = faces_.rotateCcw(h);
  }
  return degree;
}

template <class Io>
bool Stitcher<Io>::codeCopy(uint32_t v, uint32_t truth) {
  if (groups_.empty()) return false;
  const StitchKind& kind = vertices_[v].kind;
  const uint32_t best = candidate_count_ == 0 ? 0 : 1 + std::min(18u, best_score_);
  const uint32_t edge = onBoundary(v) ? 1 : 0;
  const uint32_t level = std::min(3u, (best + 2) / 3);
  const uint32_t shape = edge != 0 ? kind.loop * 16 + boundaryDegree(v)
                                   : kind.highest_degree * 16 + std::min<uint32_t>(kind.degree, 15);
  return codeMixed(io_, models_.copy[edge][kind.gluedNeighbours()][best],
                   models_.copy_shape[edge][level][shape], Io::kEncoding && truth != kNone);
}

template <class Io>
Status Stitcher<Io>::codeReference(uint32_t v, uint32_t truth, uint32_t& group) {
  if (codeCandidate(truth, group)) {
    misses_ = 0;
    return {};
  }
  misses_ = std::min(misses_ + 1, 8 * kStitchPatience);
  if (vertices_[v].kind.gluedNeighbours() == 0) excludeRing(v);
  if (onBoundary(v) ? codeOnLoop(v, truth, group) : codeNearby(v, truth, group)) return {};
  bool is_recent = false;
  MCC_TRY(codeRecent(truth, group, is_recent));
  return is_recent ? Status{} : codeAnywhere(v, truth, group);
}

/// One bit per candidate. Those answered with no are excluded from what follows. [A.5.4]
template <class Io>
bool Stitcher<Io>::codeCandidate(uint32_t truth, uint32_t& group) {
  sortCandidates();
  const uint32_t asked = std::min(candidate_count_, kStitchCodedLimit);
  for (uint32_t i = 0; i < asked; ++i) {
    const Candidate& c = candidates_[i];
    const bool tied = i + 1 < candidate_count_ && candidates_[i + 1].score == c.score;
    const bool multi = groups_[c.group].member_count >= 2;
    BitModel& model = models_.candidate[i][std::min(15u, c.score)][multi ? 1 : 0][tied ? 1 : 0];
    if (io_.bit(model, Io::kEncoding && c.group == truth)) {
      group = c.group;
      return true;
    }
    exclude(c.group);
  }
  return false;
}

/// Vertices of v's boundary loop at 2, 3, ... steps, forward and back, one bit each.
template <class Io>
bool Stitcher<Io>::codeOnLoop(uint32_t v, uint32_t truth, uint32_t& group) {
  struct Place {
    uint32_t group;
    uint32_t steps;
  };
  Place places[2 * kStitchSteps];
  uint32_t place_count = 0;
  uint32_t truth_place = kNone;
  const uint32_t length = vertices_[v].kind.loop;
  uint32_t ahead = v;
  uint32_t behind = v;
  for (uint32_t steps = 1; steps <= kStitchSteps && 2 * steps <= length; ++steps) {
    ahead = vertices_[ahead].next;
    behind = vertices_[behind].prev;
    if (ahead == kNone || behind == kNone) break;
    for (const uint32_t w : {ahead, behind}) {
      if (!processed(w) || isAsked(vertices_[w].group)) continue;
      exclude(vertices_[w].group);
      if (Io::kEncoding && vertices_[w].group == truth) truth_place = place_count;
      places[place_count++] = {vertices_[w].group, steps};
    }
  }
  if (place_count == 0 || !io_.bit(models_.on_loop[length], truth_place != kNone)) return false;
  for (uint32_t i = 0; i < place_count; ++i) {
    const uint32_t rest = std::min(length - 2 * places[i].steps, 3u);
    group = places[i].group;
    if (i + 1 == place_count ||
        io_.bit(models_.loop_step[places[i].steps][rest], i == truth_place)) {
      break;
    }
  }
  return true;
}

/// Vertices a few edges away, ring by ring: is it in this ring, and which?
template <class Io>
bool Stitcher<Io>::codeNearby(uint32_t v, uint32_t truth, uint32_t& group) {
  uint32_t begin = 0;
  uint32_t end = 1;
  nearby_[0] = v;
  vertices_[v].visited_by = v;
  for (uint32_t distance = 1; distance <= kStitchNearRadius && begin != end; ++distance) {
    const uint32_t next_end = visitRing(v, begin, end);
    begin = end;
    end = next_end;
    if (distance == 1) continue;  // excluded
    uint32_t truth_place = kNone;
    const uint32_t count = findEligible(begin, end, truth, truth_place);
    if (count == 0) continue;
    BitModel& model = models_.near_ring[distance - 2][std::min(count, 8u) - 1];
    if (!io_.bit(model, truth_place != kNone)) continue;
    uint32_t i = 0;
    for (; i + 1 < count; ++i) {
      const uint32_t left = std::min(count - i, 16u) - 2;
      if (io_.bit(models_.near_place[distance - 2][left], i == truth_place)) break;
    }
    group = eligible_[i];
    return true;
  }
  return false;
}

/// Appends the neighbours of nearby_[begin, end) that were not visited yet; returns their end.
template <class Io>
uint32_t Stitcher<Io>::visitRing(uint32_t v, uint32_t begin, uint32_t end) {
  uint32_t count = end;
  for (uint32_t i = begin; i < end && count < kStitchNearLimit; ++i) {
    uint32_t seen = 0;
    // Branch-free: whether a vertex was visited is close to random.
    forRing(shape_, faces_, nearby_[i], [&](uint32_t w, EdgeSide) {
      nearby_[count] = w;
      count += vertices_[w].visited_by != v ? 1 : 0;
      vertices_[w].visited_by = v;
      return ++seen < kStitchRingLimit;
    });
  }
  return count;
}

/// Fills eligible_ with the groups of nearby_[begin, end) that were not asked for yet.
template <class Io>
uint32_t Stitcher<Io>::findEligible(uint32_t begin, uint32_t end, uint32_t truth,
                                    uint32_t& truth_place) {
  uint32_t count = 0;
  for (uint32_t i = begin; i < end; ++i) {
    const uint32_t group = vertices_[nearby_[i]].group;
    if (group == kNone || isAsked(group)) continue;
    exclude(group);
    if (Io::kEncoding && group == truth) truth_place = count;
    eligible_[count++] = group;
  }
  return count;
}

template <class Io>
Status Stitcher<Io>::codeRecent(uint32_t truth, uint32_t& group, bool& is_recent) {
  uint32_t rank = recent_count_;
  if constexpr (Io::kEncoding) {
    rank = 0;
    while (rank < recent_count_ && recent_[rank] != truth) ++rank;
  }
  is_recent =
      recent_count_ != 0 && io_.bit(models_.is_recent, Io::kEncoding && rank < recent_count_);
  if (!is_recent) return {};
  rank = codeGolomb(io_, models_.recent, rank);
  if (rank >= recent_count_) return noSuchGroup();
  group = recent_[rank];
  return {};
}

template <class Io>
Status Stitcher<Io>::codeAnywhere(uint32_t v, uint32_t truth, uint32_t& group) {
  const uint32_t loop = vertices_[v].kind.loop;
  const uint32_t begin = class_begin_[loop];
  const uint32_t count = class_end_[loop] - begin;
  const bool alike = Io::kEncoding && vertices_[groups_[truth].leader].kind.loop == loop;
  if (count != 0 && io_.bit(models_.same_class[loop != 0 ? 1 : 0], alike)) {
    uint32_t place = 0;
    if constexpr (Io::kEncoding) place = groups_[truth].class_place - begin;
    MCC_TRY(codeFarReference(models_.far_length[1], last_in_class_[loop], count, place, place));
    last_in_class_[loop] = place;
    group = by_class_[begin + place];
    return {};
  }
  return codeFarReference(models_.far_length[0], last_reference_,
                          static_cast<uint32_t>(groups_.size()), truth, group);
}

/// Distance to the last reference, the shorter way around: length by a tree, the rest raw.
template <class Io>
Status Stitcher<Io>::codeFarReference(TreeModel<6>& model, uint32_t last, uint32_t count,
                                      uint32_t truth, uint32_t& index) {
  uint32_t distance = 0;
  if constexpr (Io::kEncoding) {
    int32_t difference = static_cast<int32_t>(truth - last);
    const int32_t half = static_cast<int32_t>(count / 2);
    if (difference > half) difference -= static_cast<int32_t>(count);
    if (difference < -half) difference += static_cast<int32_t>(count);
    distance = zigzag(difference);
  }
  uint32_t length = static_cast<uint32_t>(std::bit_width(distance));
  length = codeTree<Io, 6>(io_, model, length);
  if (length > 30) return noSuchGroup();
  if (length > 1) {
    const uint32_t low = (uint32_t{1} << (length - 1)) - 1;
    distance = (low + 1) | io_.raw(length - 1, distance & low);
  } else {
    distance = length;
  }
  index = last + static_cast<uint32_t>(unzigzag(distance));
  if (index >= count) index += index < 2 * count ? ~count + 1 : count;  // around either end
  return index < count ? Status{} : noSuchGroup();
}

template <class Io>
void Stitcher<Io>::noteUse(uint32_t group) {
  groups_[group].used_at = ++time_;
  last_reference_ = group;
  const uint32_t loop = vertices_[groups_[group].leader].kind.loop;
  last_in_class_[loop] = groups_[group].class_place - class_begin_[loop];
  uint32_t rank = 0;
  while (rank < recent_count_ && recent_[rank] != group) ++rank;
  if (rank == recent_count_ && recent_count_ < kStitchRecent) ++recent_count_;
  rank = std::min(rank, kStitchRecent - 1);
  for (; rank != 0; --rank) recent_[rank] = recent_[rank - 1];
  recent_[0] = group;
}

/// Numbers the groups by their first vertex, lists those on boundaries or with copies and rewrites the corners.
template <class Io>
Status Stitcher<Io>::finish(Groups& groups) {
  const uint32_t n = mesh_.vertex_count;
  groups.count = n - copy_count_;
  if (!groups.listed.assign(size_t{groups.count} / 64 + 1, Groups::Listed{})) return noMemory();
  // By vertex, in memory that is not needed any more: of the classes, or of the places behind.
  uint32_t* const number_of = (interior_copies_ ? by_class_ : shape_.place_of).data();
  uint32_t number = 0;
  for (uint32_t vertex = 0; vertex < n; ++vertex) {
    const uint32_t v = shape_.placeOf(vertex);
    const uint32_t leader = v == kNone ? v : groups_[vertices_[v].group].leader;
    if (leader != v) {
      number_of[vertex] = number_of[vertexAt(leader)];
      continue;
    }
    if (v != kNone && (onBoundary(v) || vertices_[v].next_member != kNone) &&
        !listUmbrellas(v, number, groups)) {
      return noMemory();
    }
    number_of[vertex] = number++;
  }
  if (!groups.umbrella_begin.push_back(static_cast<uint32_t>(groups.umbrellas.size())))
    return noMemory();
  uint32_t before = 0;
  for (size_t i = 0; i < groups.listed.size(); ++i) {
    groups.listed[i].before = before;
    before += static_cast<uint32_t>(std::popcount(groups.listed[i].groups));
  }
  for (uint32_t f = 0; f < mesh_.face_count; ++f) {
    uint32_t* corner = mesh_.words.data() + size_t{f} * kFaceWords;
    for (int k = 0; k < 3; ++k) corner[k] = number_of[corner[k]];
  }
  return {};
}

/// Group `number`, whose first vertex is v, is the last one listed so far. False without memory.
template <class Io>
bool Stitcher<Io>::listUmbrellas(uint32_t v, uint32_t number, Groups& groups) const {
  groups.listed[number / 64].groups |= uint64_t{1} << (number % 64);
  bool done = groups.umbrella_begin.push_back(static_cast<uint32_t>(groups.umbrellas.size()));
  for (uint32_t u = v; u != kNone && done; u = vertices_[u].next_member) {
    done = groups.umbrellas.push_back(vertices_[u].start);
  }
  return done;
}

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_STITCH_H_
