// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Re-stitches cut vertices: codes which decoded vertices share a position. [A.5]
//
// Cutting a mesh into manifold pieces duplicates vertices. Here every vertex is declared a copy of
// an earlier one, the leader of its group, or it leads a new group. The leader is searched for
// where it is likely to be, in this order:
//
//   candidates   If u is glued to u2, a neighbour of u is likely glued to a neighbour of u2. They
//                are scored, and asked for one by one.
//   near         Vertices a few edges away, for holes that touch themselves, edges of four faces
//                and cubes that touch.
//   far          Any leader, by its distance from the last far leader.
//
// After this pass, face corners hold group numbers; twins remain those of the cut pieces. Every
// walk is capped, so the time is linear in the vertices, whatever the stream says.
#ifndef MCC_CONNECTIVITY_STITCH_H_
#define MCC_CONNECTIVITY_STITCH_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/memory.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mcc/status.h"
#include "mesh/face_mesh.h"
#include "mesh/groups.h"

namespace mcc {

inline constexpr uint32_t kStitchAcrossLimit = 64;  ///< limit of vertices searched for candidates
inline constexpr uint32_t kStitchNearLimit = 288;   ///< limit of vertices searched nearby

struct StitchModels {
  BitModel copy[2][16];
  BitModel candidate[4][16];
  BitModel is_near;
  BitModel near[8];
  GolombModel far;
};

template <class Io>
class Stitcher {
 public:
  Stitcher(Io& io, StitchModels& models, FaceMesh& mesh, const uint32_t* class_of_vertex)
      : io_(io),
        models_(models),
        mesh_(mesh),
        faces_(mesh.view()),
        class_of_vertex_(class_of_vertex),
        vertices_(mesh.allocator()),
        leader_of_class_(mesh.allocator()) {}

  Status run(bool interior_copies, uint32_t class_count, Groups& groups);

 private:
  struct Vertex {
    uint32_t start = kNone;        ///< half-edge leaving it; on a boundary, the clockwise-most
    uint32_t leader = kNone;       ///< of its group; kNone until the vertex is done
    uint32_t next_member = kNone;  ///< of its group; the leader's is the latest member
    uint32_t is_glued = 0;         ///< whether it is next to a vertex whose group has copies
    uint32_t seen_by = kNone;      ///< the last vertex whose surroundings included it
    uint32_t asked_by = kNone;     ///< for a leader: the last vertex that need not ask for it again
    uint32_t group = 0;  ///< for a leader: its place in candidates_, at the end its number
  };
  struct Candidate {
    uint32_t leader;
    uint32_t score;
  };
  /// Which boundary half-edge an edge of the ring is: one leaving the vertex, one entering it, or
  /// neither.
  enum class EdgeSide : uint8_t { kInner, kOut, kIn };

  Status prepare(uint32_t class_count);
  Status stitchVertex(uint32_t v);
  void join(uint32_t v, uint32_t leader);
  void markNeighbours(uint32_t v);
  void collectCandidates(uint32_t v);
  void addCandidate(uint32_t leader, uint32_t score);
  bool codeCopy(uint32_t v, uint32_t truth);
  Status codeReference(uint32_t v, uint32_t truth, uint32_t& leader);
  bool codeCandidate(uint32_t truth, uint32_t& leader);
  Status codeNear(uint32_t v, uint32_t truth, bool& is_near, uint32_t& leader);
  bool findNear(uint32_t v, uint32_t i);
  void startNear(uint32_t v);
  bool meetNear(uint32_t v);
  Status codeFar(uint32_t truth, uint32_t& leader);
  Status listGroups(Groups& groups);

  template <class Visit>
  MCC_INLINE void forRing(uint32_t v, Visit visit) const;
  bool onBoundary(uint32_t v) const { return faces_.twin(vertices_[v].start) == kNone; }
  bool hasCopies(uint32_t leader) const { return vertices_[leader].next_member != kNone; }
  /// Returns true the first time that the vertex at work asks for `leader`, which may be kNone.
  bool claim(uint32_t leader) {
    if (leader == kNone || vertices_[leader].asked_by == now_) return false;
    vertices_[leader].asked_by = now_;
    return true;
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
  Array<Vertex> vertices_;
  Array<uint32_t> leader_of_class_;  ///< encoder only
  uint32_t now_ = 0;                 ///< the vertex at work
  uint32_t last_far_ = 0;
  uint32_t candidate_count_ = 0;
  Candidate candidates_[kStitchAcrossLimit];  ///< leaders

  /// The search nearby, which goes on only as far as leaders are asked for.
  struct Near {
    uint32_t vertices[kStitchNearLimit + 1];  ///< in the order in which they are met
    uint32_t vertex_count;
    uint32_t neighbour_end;  ///< the vertices before it are v and its neighbours
    uint32_t walked;         ///< the neighbours of so many vertices were met
    uint32_t asked;          ///< the leaders of so many vertices were looked at
    uint32_t work;
    uint32_t leaders[kStitchNearLimit];
    uint32_t leader_count;
  } near_;
};

/// Calls visit(neighbour, side) for the ring of `v`, clockwise-most first, until it returns false.
template <class Io>
template <class Visit>
MCC_INLINE void Stitcher<Io>::forRing(uint32_t v, Visit visit) const {
  const uint32_t first = vertices_[v].start;
  uint32_t h = first;
  EdgeSide side = onBoundary(v) ? EdgeSide::kOut : EdgeSide::kInner;
  do {
    if (!visit(faces_.vertex(nextHalfEdge(h)), side)) return;
    side = EdgeSide::kInner;
    const uint32_t last = prevHalfEdge(h);
    h = faces_.twin(last);
    if (h == kNone) {
      visit(faces_.vertex(last), EdgeSide::kIn);
      return;
    }
  } while (h != first);
}

template <class Io>
Status Stitcher<Io>::run(bool interior_copies, uint32_t class_count, Groups& groups) {
  MCC_TRY(prepare(class_count));
  for (uint32_t v = 0; v < mesh_.vertex_count; ++v) {
    if (interior_copies || onBoundary(v)) MCC_TRY(stitchVertex(v));
    if ((v & 0xff) == 0 && io_.overrun()) {
      return fail(Error::kTruncated, "the code stream ends inside the stitching");
    }
  }
  return listGroups(groups);
}

template <class Io>
Status Stitcher<Io>::prepare(uint32_t class_count) {
  if (!vertices_.assign(mesh_.vertex_count, Vertex{}) ||
      (Io::kEncoding && !leader_of_class_.assign(class_count, kNone))) {
    return noMemory();
  }
  for (uint32_t f = 0; f < mesh_.face_count; ++f) {
    for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
      uint32_t& start = vertices_[faces_.vertex(h)].start;
      if (faces_.twin(h) == kNone || start == kNone || faces_.twin(start) != kNone) start = h;
    }
  }
  for (uint32_t v = 0; v < mesh_.vertex_count; ++v) {
    if (vertices_[v].start == kNone)
      return fail(Error::kBadConnectivity, "a vertex has no triangle");
  }
  return {};
}

template <class Io>
Status Stitcher<Io>::stitchVertex(uint32_t v) {
  uint32_t truth = kNone;
  if constexpr (Io::kEncoding) truth = leader_of_class_[class_of_vertex_[v]];
  now_ = v;
  collectCandidates(v);
  if (!codeCopy(v, truth)) {
    vertices_[v].leader = v;
    if constexpr (Io::kEncoding) leader_of_class_[class_of_vertex_[v]] = v;
    return {};
  }
  uint32_t leader = 0;
  MCC_TRY(codeReference(v, truth, leader));
  join(v, leader);
  return {};
}

template <class Io>
void Stitcher<Io>::join(uint32_t v, uint32_t leader) {
  if (!hasCopies(leader)) markNeighbours(leader);
  markNeighbours(v);
  vertices_[v].leader = leader;
  vertices_[v].next_member = vertices_[leader].next_member;
  vertices_[leader].next_member = v;
}

/// Marks the neighbours, so that most vertices, which have no copies around them, need not search
/// for candidates. Called once per vertex. [A.5.1]
template <class Io>
void Stitcher<Io>::markNeighbours(uint32_t v) {
  forRing(v, [this](uint32_t u, EdgeSide) {
    vertices_[u].is_glued = 1;
    return true;
  });
}

// --- candidates ----------------------------------------------------------------------------------

/// Collects the neighbours of copies of v's neighbours. [A.5.2]
template <class Io>
void Stitcher<Io>::collectCandidates(uint32_t v) {
  candidate_count_ = 0;
  if (vertices_[v].is_glued == 0) return;
  // Excludes the neighbours themselves, because no face has a vertex twice.
  forRing(v, [this](uint32_t u, EdgeSide) {
    claim(vertices_[u].leader);
    return true;
  });
  uint32_t work = 0;
  forRing(v, [this, &work](uint32_t u, EdgeSide side) {
    const uint32_t leader = vertices_[u].leader;
    if (leader == kNone || !hasCopies(leader)) return true;
    for (uint32_t u2 = leader; u2 != kNone && work < kStitchAcrossLimit;
         u2 = vertices_[u2].next_member) {
      if (u2 == u) continue;
      forRing(u2, [this, &work, side](uint32_t w, EdgeSide other) {
        // On a boundary, v -> u meets u2 -> w if the gap between them was cut.
        const bool is_gap = side != EdgeSide::kInner && other != EdgeSide::kInner;
        addCandidate(vertices_[w].leader, !is_gap ? 1 : side == other ? 6 : 5);
        return ++work < kStitchAcrossLimit;
      });
    }
    return work < kStitchAcrossLimit;
  });
}

template <class Io>
void Stitcher<Io>::addCandidate(uint32_t leader, uint32_t score) {
  if (leader == kNone || vertices_[leader].asked_by == now_) return;
  uint32_t& place = vertices_[leader].group;
  if (place >= candidate_count_ || candidates_[place].leader != leader) {
    place = candidate_count_++;
    candidates_[place] = {leader, 0};
  }
  candidates_[place].score += score;
}

// --- coding --------------------------------------------------------------------------------------

template <class Io>
bool Stitcher<Io>::codeCopy(uint32_t v, uint32_t truth) {
  uint32_t best = 0;
  for (uint32_t i = 0; i < candidate_count_; ++i) best = std::max(best, candidates_[i].score);
  return io_.bit(models_.copy[onBoundary(v) ? 1 : 0][std::min(best, 15u)],
                 Io::kEncoding && truth != kNone);
}

/// Codes one bit per candidate, the highest score first; candidates with equal scores keep their
/// order. [A.5.3]
template <class Io>
bool Stitcher<Io>::codeCandidate(uint32_t truth, uint32_t& leader) {
  for (uint32_t i = 0; i < candidate_count_; ++i) {
    uint32_t best = i;
    for (uint32_t k = i + 1; k < candidate_count_; ++k) {
      if (candidates_[k].score > candidates_[best].score) best = k;
    }
    std::swap(candidates_[i], candidates_[best]);
    leader = candidates_[i].leader;
    BitModel& model = models_.candidate[std::min(i, 3u)][std::min(candidates_[i].score, 15u)];
    if (io_.bit(model, Io::kEncoding && leader == truth)) return true;
    claim(leader);
  }
  return false;
}

template <class Io>
Status Stitcher<Io>::codeReference(uint32_t v, uint32_t truth, uint32_t& leader) {
  if (codeCandidate(truth, leader)) return {};
  bool is_near = false;
  MCC_TRY(codeNear(v, truth, is_near, leader));
  return is_near ? Status{} : codeFar(truth, leader);
}

/// Codes whether the leader is near, and if so, one bit per leader, the nearest first.
template <class Io>
Status Stitcher<Io>::codeNear(uint32_t v, uint32_t truth, bool& is_near, uint32_t& leader) {
  bool is_found = false;
  if constexpr (Io::kEncoding) {
    startNear(v);
    for (uint32_t i = 0; !is_found && findNear(v, i); ++i) is_found = near_.leaders[i] == truth;
  }
  is_near = io_.bit(models_.is_near, is_found);
  if (!is_near) return {};
  if constexpr (!Io::kEncoding) startNear(v);
  if (!findNear(v, 0)) return noSuchGroup();
  uint32_t i = 0;
  while (findNear(v, i + 1) &&
         !io_.bit(models_.near[std::min(i, 7u)], Io::kEncoding && near_.leaders[i] == truth))
    ++i;
  leader = near_.leaders[i];
  return {};
}

template <class Io>
void Stitcher<Io>::startNear(uint32_t v) {
  near_.vertices[0] = v;
  vertices_[v].seen_by = v;
  near_.vertex_count = near_.asked = 1;
  near_.work = near_.walked = near_.leader_count = 0;
  (void)meetNear(v);
  near_.neighbour_end = near_.vertex_count;
}

/// Looks for leader number i of the vertices around v, breadth first, leaving out the leaders that
/// were asked for and those of the neighbours. Returns whether there are so many.
template <class Io>
bool Stitcher<Io>::findNear(uint32_t v, uint32_t i) {
  while (near_.leader_count <= i) {
    if (near_.asked == near_.vertex_count && !meetNear(v)) return false;
    for (; near_.asked < near_.vertex_count; ++near_.asked) {
      const uint32_t leader = vertices_[near_.vertices[near_.asked]].leader;
      if (claim(leader) && near_.asked >= near_.neighbour_end)
        near_.leaders[near_.leader_count++] = leader;
    }
  }
  return true;
}

/// Meets the neighbours of the next vertex. Returns false when the search is over.
template <class Io>
bool Stitcher<Io>::meetNear(uint32_t v) {
  if (near_.walked == near_.vertex_count || near_.work >= kStitchNearLimit) return false;
  uint32_t count = near_.vertex_count;
  uint32_t work = near_.work;
  // Has no branch, because whether a vertex was seen is close to random.
  forRing(near_.vertices[near_.walked++], [&](uint32_t w, EdgeSide) {
    near_.vertices[count] = w;
    count += vertices_[w].seen_by != v ? 1 : 0;
    vertices_[w].seen_by = v;
    return ++work < kStitchNearLimit;
  });
  near_.vertex_count = count;
  near_.work = work;
  return true;
}

template <class Io>
Status Stitcher<Io>::codeFar(uint32_t truth, uint32_t& leader) {
  leader = last_far_ + static_cast<uint32_t>(codeSignedGolomb(
                           io_, models_.far, static_cast<int32_t>(truth - last_far_)));
  if (leader >= mesh_.vertex_count || vertices_[leader].leader != leader) return noSuchGroup();
  last_far_ = leader;
  return {};
}

/// Numbers the groups by their leaders, lists the groups that are on boundaries or have copies, and
/// rewrites the corners.
template <class Io>
Status Stitcher<Io>::listGroups(Groups& groups) {
  if (!groups.listed.assign(size_t{mesh_.vertex_count} / 64 + 1, Groups::Listed{}))
    return noMemory();
  groups.count = 0;
  for (uint32_t v = 0; v < mesh_.vertex_count; ++v) {
    Vertex& vertex = vertices_[v];
    if (vertex.leader == kNone) vertex.leader = v;
    if (vertex.leader != v) continue;
    vertex.group = groups.count++;
    Groups::Listed& listed = groups.listed[vertex.group / 64];
    if (vertex.group % 64 == 0) listed.before = static_cast<uint32_t>(groups.umbrella_begin.size());
    if (!hasCopies(v) && !onBoundary(v)) continue;
    listed.groups |= uint64_t{1} << (vertex.group % 64);
    bool done = groups.umbrella_begin.push_back(static_cast<uint32_t>(groups.umbrellas.size()));
    for (uint32_t u = v; u != kNone && done; u = vertices_[u].next_member) {
      done = groups.umbrellas.push_back(vertices_[u].start);
    }
    if (!done) return noMemory();
  }
  for (uint32_t f = 0; f < mesh_.face_count; ++f) {
    uint32_t* const corner = mesh_.words.data() + size_t{f} * kFaceWords;
    for (int k = 0; k < 3; ++k) corner[k] = vertices_[vertices_[corner[k]].leader].group;
  }
  const uint32_t end = static_cast<uint32_t>(groups.umbrellas.size());
  return groups.umbrella_begin.push_back(end) ? Status{} : noMemory();
}

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_STITCH_H_
