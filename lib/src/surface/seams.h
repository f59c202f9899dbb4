// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Seams: the partition of the corners around every vertex into wedges, shared by all
// attributes. [A.7]
//
// The umbrellas come in traversal order. For each one: does it have a seam at all? If so, for each
// edge: are the corners on its two sides, at this vertex, different wedges? The other end of the
// edge has its own answer, which serves as a context. A wedge that is not one contiguous run of
// corners is a run with a merge flag and the number of an earlier wedge of the same group. The pass
// rewrites face corners from groups to wedges.
#ifndef MCC_SURFACE_SEAMS_H_
#define MCC_SURFACE_SEAMS_H_

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/lanes.h"
#include "base/memory.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mesh/face_mesh.h"
#include "mesh/groups.h"
#include "surface/creases.h"

namespace mcc {

struct SeamModels {
  /// [number of seam ends known on the ring][boundary][sharpest crease]
  BitModel has_seam[4][2][kCreaseClasses];
  /// [other end: unknown, no, yes][number of seam ends so far][boundary][crease]
  BitModel edge[3][3][2][kCreaseClasses];
  BitModel merge[2][4];  ///< [first run of its umbrella][candidates]
  GolombModel merge_with;
};

/// What becomes of the seams, per wedge.
struct SeamWedges {
  Array<uint32_t>& start;  ///< clockwise-most half-edge of its first run
  Array<uint32_t>& group;
};

template <class Io>
class SeamCoder {
 public:
  /// `corner_source` has the source wedge of corner 3f+k (encoder).
  SeamCoder(Io& io, SeamModels& models, FaceMesh& mesh, const Groups& groups,
            const uint32_t* corner_source)
      : io_(io),
        models_(models),
        faces_(mesh.view()),
        face_count_(mesh.face_count),
        groups_(groups),
        corner_source_(corner_source),
        wedge_of_source_(mesh.allocator()),
        fan_(mesh.allocator()),
        run_begins_(mesh.allocator()) {}

  /// Codes the seams. `group_order` has a half-edge per group in coding order. More than
  /// `wedge_limit` wedges are an error.
  Status run(uint32_t wedge_limit, const Array<uint32_t>& group_order, const SeamWedges& wedges);

 private:
  /// Marks corners that have become wedges, and thereby reveals a corner that no umbrella reached.
  static constexpr uint32_t kDone = 1u << 31;

  /// A run of faces of one umbrella between two seam ends. It has another wedge than its
  /// neighbours.
  struct Run {
    uint32_t first;          ///< its first half-edge
    bool is_first;           ///< of the umbrella
    uint32_t neighbours[2];  ///< wedges of the runs beside it, as far as they are known, or kNone
  };

  Status codeUmbrella(uint32_t group, uint32_t start);
  bool collectFan(uint32_t start);
  bool walkFan(uint32_t start);
  bool makeRoom() {
    const size_t size = 2 * fan_.size();
    return fan_.resize(size) && run_begins_.resize(size + 1);
  }
  bool codeHasSeam();
  void codeSeamEnds();
  Status codeRuns(uint32_t group);
  Status codeWedge(const Run& run, uint32_t group, uint32_t& wedge);
  Status makeWedge(uint32_t first, uint32_t group, uint32_t& wedge);
  Status finishCorners();
  uint32_t source(uint32_t h) const { return corner_source_[3 * size_t{faceOf(h)} + (h & 3)]; }
  /// Returns the wedge that a source wedge has become (encoder).
  uint32_t wedgeOf(uint32_t source) const {
    return source < wedge_of_source_.size() ? wedge_of_source_[source] : kNone;
  }
  bool noteSource(uint32_t source, uint32_t wedge) {
    const size_t known = wedge_of_source_.size();
    if (source >= known) {
      if (!wedge_of_source_.resize(std::max<size_t>(size_t{source} + 1, wedge_limit_)))
        return false;
      std::fill(wedge_of_source_.data() + known, wedge_of_source_.data() + wedge_of_source_.size(),
                kNone);
    }
    wedge_of_source_[source] = wedge;
    return true;
  }
  /// Makes the corners of the fan faces `begin` .. `end`-1 corners of `wedge`.
  void setCorners(uint32_t begin, uint32_t end, uint32_t wedge) {
    for (uint32_t i = begin; i < end; ++i) faces_.words[fan_[i]] = wedge | kDone;
  }

  Io& io_;
  SeamModels& models_;
  const FaceView faces_;
  const uint32_t face_count_;
  const Groups& groups_;
  uint32_t wedge_limit_ = 0;
  const uint32_t* corner_source_;
  uint32_t* starts_ = nullptr;          ///< see SeamWedges
  uint32_t* group_of_wedge_ = nullptr;  ///< see SeamWedges
  Array<uint32_t> wedge_of_source_;     ///< encoder: kNone until it is coded
  uint32_t group_begin_ = 0;            ///< first wedge of the group; the others follow it
  uint32_t wedge_count_ = 0;

  // The umbrella at work.
  static constexpr uint32_t kUsualFan = 64;
  Array<uint32_t> fan_;  ///< half-edges leaving the vertex, counterclockwise, and room for more
  Array<uint32_t> run_begins_;  ///< fan faces; room for one more than the fan; see codeSeamEnds()
  uint32_t run_end_ = 0;        ///< of run_begins_
  uint32_t first_run_ = 0;      ///< of run_begins_
  uint32_t fan_count_ = 0;
  bool closed_ = false;
  uint32_t known_ends_ = 0;  ///< number of seam ends at the other ends of the fan's edges
  uint32_t states_ = 0;      ///< seam states of the fan's edges, combined by "or"
};

template <class Io>
Status SeamCoder<Io>::run(uint32_t wedge_limit, const Array<uint32_t>& group_order,
                          const SeamWedges& wedges) {
  wedge_limit_ = wedge_limit;
  if (!wedges.start.resize(wedge_limit_) || !wedges.group.resize(wedge_limit_) ||
      !fan_.resize(kUsualFan) || !run_begins_.resize(kUsualFan + 1)) {
    return fail(Error::kOutOfMemory, "no memory for wedges");
  }
  starts_ = wedges.start.data();
  group_of_wedge_ = wedges.group.data();
  for (size_t i = 0; i < group_order.size(); ++i) {
    const uint32_t entry = group_order[i];
    const uint32_t group = faces_.vertex(entry);
    group_begin_ = wedge_count_;
    MCC_TRY(codeUmbrella(group, entry));
    if (groups_.hasCopies()) {
      for (const uint32_t start : groups_.umbrellasOf(group)) {
        if ((faces_.vertex(start) & kDone) != 0) continue;  // the umbrella of the entry is done
        MCC_TRY(codeUmbrella(group, start));
      }
    }
    if ((i & 0xff) == 0 && io_.overrun()) {
      return fail(Error::kTruncated, "the code stream ends inside the seams");
    }
  }
  (void)wedges.start.resize(wedge_count_);  // they shrink
  (void)wedges.group.resize(wedge_count_);
  return finishCorners();
}

/// Takes the marks off the corners.
template <class Io>
Status SeamCoder<Io>::finishCorners() {
  Lanes<uint32_t> all = {kDone, kDone, kDone, kDone};
  for (uint32_t f = 0; f < face_count_; ++f) {
    uint32_t* const corners = faces_.words + size_t{f} * kFaceWords;
    const Lanes<uint32_t> words = loadLanes<uint32_t>(corners);
    all &= words;
    storeLanes(words & Lanes<uint32_t>{~kDone, ~kDone, ~kDone, ~0u}, corners);
  }
  if ((all[0] & all[1] & all[2] & kDone) != 0) return {};
  return fail(Error::kBadConnectivity, "a corner belongs to no umbrella");
}

/// Collects the faces of the umbrella, from its clockwise boundary, or once around from `start`,
/// and notes the contexts on the way. False without memory. [A.7.1]
template <class Io>
bool SeamCoder<Io>::collectFan(uint32_t start) {
  if (!walkFan(start)) return false;
  if (closed_ || faces_.twin(start) == kNone) return true;
  uint32_t first = start;
  for (uint32_t h = start; h != kNone; h = faces_.rotateCw(h)) first = h;
  return walkFan(first);
}

/// Does so counterclockwise from `start`. An edge between two faces has its states in both of them;
/// they are looked up in the face at hand, at the half-edge that begins at the edge's other end.
template <class Io>
bool SeamCoder<Io>::walkFan(uint32_t start) {
  const FaceView faces = faces_;
  uint32_t count = 0;
  uint32_t ends = 0;
  uint32_t states = 0;
  uint32_t h = start;
  do {
    if (count == fan_.size() && !makeRoom()) [[unlikely]]
      return false;
    fan_[count++] = h;
    const uint32_t edge = prevHalfEdge(h);
    h = faces.twin(edge);
    if (h == kNone) break;
    const uint32_t of_edge = seamStates(faces, edge);
    states |= of_edge;
    ends += of_edge & seam_state::kEnd;
  } while (h != start);
  fan_count_ = count;
  closed_ = h == start;
  known_ends_ = ends / seam_state::kEnd;
  states_ = states;
  return true;
}

template <class Io>
bool SeamCoder<Io>::codeHasSeam() {
  if (fan_count_ < 2) return false;  // a closed umbrella needs two seam ends, an open one needs one
  bool any = false;
  if constexpr (Io::kEncoding) {
    for (uint32_t i = 1; i < fan_count_; ++i) any |= source(fan_[i]) != source(fan_[0]);
  }
  return io_.bit(models_.has_seam[std::min(known_ends_, 3u)][closed_ ? 0 : 1][creaseOf(states_)],
                 any);
}

/// Codes bits for the edges 1 .. n-1 between the fan faces i-1 and i, then for the closing edge 0.
/// Each edge with a seam end begins a run, which is listed. Fan face 0 also begins one in an open
/// fan; in a closed fan whose closing edge has no seam end, the last run reaches over it. [A.7.2]
template <class Io>
void SeamCoder<Io>::codeSeamEnds() {
  const uint32_t n = fan_count_;
  const uint32_t edges = closed_ ? n : n - 1;
  const uint32_t boundary = closed_ ? 0 : 1;
  const uint32_t needed = closed_ ? 2 : 1;
  const uint32_t* const fan = fan_.data();
  uint32_t* const begins = run_begins_.data();
  begins[0] = 0;
  first_run_ = boundary ^ 1;
  uint32_t ends = 0;
  for (uint32_t k = 1; k <= edges; ++k) {
    const uint32_t i = k == n ? 0 : k;
    bool seam = ends + (edges - k + 1) == needed;  // implied when every remaining edge is needed
    if (!seam) {
      const uint32_t t = faces_.twin(fan[i]);
      const uint32_t states = seamStates(faces_, t);
      const uint32_t seam_there = (states & seam_state::kEnd) != 0 ? 2 : 1;
      const uint32_t other = (faces_.vertex(t) & kDone) == 0 ? 0 : seam_there;
      bool truth = false;
      if constexpr (Io::kEncoding) truth = source(fan[i]) != source(fan[i == 0 ? n - 1 : i - 1]);
      seam = io_.bit(models_.edge[other][std::min(ends, 2u)][boundary][creaseOf(states)], truth);
    }
    if (!seam) continue;
    ++ends;
    begins[ends] = i;
    faces_.words[fan[i] | kSeamWord] |= seam_state::kEnd << (8 * (fan[i] & 3));
  }
  run_end_ = ends + 1;
  if (begins[ends] != 0) return;
  first_run_ = 0;
  --run_end_;
}

template <class Io>
MCC_INLINE Status SeamCoder<Io>::codeUmbrella(uint32_t group, uint32_t start) {
  if (!collectFan(start)) return fail(Error::kOutOfMemory, "no memory for wedges");
  if (codeHasSeam()) {
    codeSeamEnds();
    return codeRuns(group);
  }
  uint32_t wedge = kNone;
  if (wedge_count_ == group_begin_) {  // there are no other wedges to merge with
    MCC_TRY(makeWedge(fan_[0], group, wedge));
  } else {
    MCC_TRY(codeWedge({fan_[0], true, {kNone, kNone}}, group, wedge));
  }
  setCorners(0, fan_count_, wedge);
  return {};
}

/// Codes the runs. The last one may reach over the closing edge.
template <class Io>
Status SeamCoder<Io>::codeRuns(uint32_t group) {
  uint32_t first_wedge = kNone;
  uint32_t previous = kNone;
  for (uint32_t r = first_run_; r < run_end_; ++r) {
    const uint32_t begin = run_begins_[r];
    const bool is_last = r + 1 == run_end_;
    uint32_t wedge = kNone;
    const uint32_t next = is_last && closed_ ? first_wedge : kNone;
    MCC_TRY(codeWedge({fan_[begin], r == first_run_, {previous, next}}, group, wedge));
    setCorners(begin, is_last ? fan_count_ : run_begins_[r + 1], wedge);
    if (is_last && first_run_ != 0) setCorners(0, run_begins_[first_run_], wedge);
    if (first_wedge == kNone) first_wedge = wedge;
    previous = wedge;
  }
  return {};
}

/// Codes a run as a new wedge, or as one of the group's wedges again. The rank of the latter counts
/// back from the latest wedge, skipping those of the neighbouring runs. [A.7.3]
template <class Io>
Status SeamCoder<Io>::codeWedge(const Run& run, uint32_t group, uint32_t& wedge) {
  const uint32_t latest = wedge_count_ - 1;
  uint32_t excluded_a = run.neighbours[0];
  uint32_t excluded_b = run.neighbours[1];
  // Sorts the excluded wedges, the latest first.
  if (excluded_a == excluded_b) excluded_b = kNone;
  if (excluded_a < excluded_b) std::swap(excluded_a, excluded_b);
  if (excluded_a == kNone) std::swap(excluded_a, excluded_b);
  const uint32_t excluded_count = (excluded_a != kNone ? 1u : 0u) + (excluded_b != kNone ? 1u : 0u);
  const uint32_t candidates = wedge_count_ - group_begin_ - excluded_count;
  bool merged = false;
  uint32_t rank = 0;
  if constexpr (Io::kEncoding) {
    const uint32_t known = wedgeOf(source(run.first));
    merged = candidates != 0 && known != kNone && known >= group_begin_ && known != excluded_a &&
             known != excluded_b;
    if (merged) {
      rank = latest - known;
      rank -= excluded_a != kNone && excluded_a > known ? 1 : 0;
      rank -= excluded_b != kNone && excluded_b > known ? 1 : 0;
    }
  }
  if (candidates != 0) {
    merged = io_.bit(models_.merge[run.is_first ? 1 : 0][std::min(candidates, 4u) - 1], merged);
  }
  if (merged) {
    if (candidates > 1) rank = codeGolomb(io_, models_.merge_with, rank);
    if (rank >= candidates)
      return fail(Error::kBadAttribute, "a wedge is merged with none of its group");
    wedge = latest - rank;
    if (excluded_a != kNone && wedge <= excluded_a) --wedge;
    if (excluded_b != kNone && wedge <= excluded_b) --wedge;
    return {};
  }
  return makeWedge(run.first, group, wedge);
}

template <class Io>
MCC_INLINE Status SeamCoder<Io>::makeWedge(uint32_t first, uint32_t group, uint32_t& wedge) {
  if (wedge_count_ == wedge_limit_) {
    return fail(Error::kBadAttribute, "the seams make more wedges than the header claims");
  }
  wedge = wedge_count_++;
  starts_[wedge] = first;
  group_of_wedge_[wedge] = group;
  if constexpr (Io::kEncoding) {
    if (!noteSource(source(first), wedge)) return fail(Error::kOutOfMemory, "no memory for wedges");
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_SURFACE_SEAMS_H_
