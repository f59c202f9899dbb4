// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Seams: the partition of the corners around every vertex into wedges, shared by all attributes.
// [A.7]
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

/// Returns the bit of a half-edge in its face's kSeamWord: whether a seam ends here.
inline uint32_t seamEnd(const FaceView& faces, uint32_t h) {
  return (faces.words[(h & ~7u) + kSeamWord] >> (h & 3)) & 1;
}
inline void setSeamEnd(const FaceView& faces, uint32_t h) {
  faces.words[(h & ~7u) + kSeamWord] |= 1u << (h & 3);
}

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
        fan_(mesh.allocator()),
        wedge_of_source_(mesh.allocator()) {}

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

  Status codeUmbrella(uint32_t group, uint32_t start, const SeamWedges& wedges);
  Status collectFan(uint32_t start);
  bool codeHasSeam();
  void codeSeamEnds();
  Status codeRuns(uint32_t group, const SeamWedges& wedges);
  Status codeWedge(const Run& run, uint32_t group, const SeamWedges& wedges, uint32_t& wedge);
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
  /// Returns whether the edge before fan face i (for i == 0, the edge after the last face) has a
  /// seam end here.
  bool seamBefore(uint32_t i) const { return seamEnd(faces_, fan_[i]) != 0; }
  /// Wraps an index of the fan; i must be below twice its length.
  uint32_t around(uint32_t i) const {
    const uint32_t n = static_cast<uint32_t>(fan_.size());
    return i < n ? i : i - n;
  }

  Io& io_;
  SeamModels& models_;
  const FaceView faces_;
  const uint32_t face_count_;
  const Groups& groups_;
  uint32_t wedge_limit_ = 0;
  const uint32_t* corner_source_;
  Array<uint32_t> fan_;              ///< half-edges leaving the vertex, counterclockwise
  Array<uint32_t> wedge_of_source_;  ///< encoder: kNone until it is coded
  uint32_t group_begin_ = 0;         ///< first wedge of the group; the others follow it
  bool closed_ = false;
  uint32_t known_ends_ = 0;  ///< number of seam ends at the other ends of the fan's edges
  uint32_t sharpest_ = 0;    ///< highest crease class of the fan's edges
  uint32_t wedge_count_ = 0;
};

template <class Io>
Status SeamCoder<Io>::run(uint32_t wedge_limit, const Array<uint32_t>& group_order,
                          const SeamWedges& wedges) {
  wedge_limit_ = wedge_limit;
  if (!wedges.start.reserve(wedge_limit_) || !wedges.group.reserve(wedge_limit_)) {
    return fail(Error::kOutOfMemory, "no memory for wedges");
  }
  for (size_t i = 0; i < group_order.size(); ++i) {
    const uint32_t entry = group_order[i];
    const uint32_t group = faces_.vertex(entry);
    group_begin_ = wedge_count_;
    MCC_TRY(codeUmbrella(group, entry, wedges));
    if (groups_.hasCopies()) {
      for (const uint32_t start : groups_.umbrellasOf(group)) {
        if ((faces_.vertex(start) & kDone) != 0) continue;  // the umbrella of the entry is done
        MCC_TRY(codeUmbrella(group, start, wedges));
      }
    }
    if ((i & 0xff) == 0 && io_.overrun()) {
      return fail(Error::kTruncated, "the code stream ends inside the seams");
    }
  }
  for (uint32_t f = 0; f < face_count_; ++f) {
    for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
      if ((faces_.words[h] & kDone) == 0) {
        return fail(Error::kBadConnectivity, "a corner belongs to no umbrella");
      }
      faces_.words[h] &= ~kDone;
    }
  }
  return {};
}

/// Collects the faces of the umbrella, from its clockwise boundary, or once around from `start`,
/// and notes the contexts on the way. [A.7.1]
template <class Io>
Status SeamCoder<Io>::collectFan(uint32_t start) {
  fan_.clear();
  known_ends_ = 0;
  sharpest_ = 0;
  const auto add = [this](uint32_t h) {
    const uint32_t t = faces_.twin(h);
    if (t != kNone) {
      known_ends_ += seamEnd(faces_, t);
      sharpest_ = std::max(sharpest_, creaseClass(faces_, h));
    }
    return fan_.push_back(h);
  };
  uint32_t h = start;
  do {
    if (!add(h)) return fail(Error::kOutOfMemory, "no memory for wedges");
    h = faces_.rotateCcw(h);
  } while (h != kNone && h != start);
  closed_ = h == start;
  if (closed_) return {};
  const size_t behind = fan_.size();
  for (h = faces_.rotateCw(start); h != kNone; h = faces_.rotateCw(h)) {
    if (!add(h)) return fail(Error::kOutOfMemory, "no memory for wedges");
  }
  // The faces met clockwise, in reverse, come before the others.
  std::reverse(fan_.data(), fan_.data() + fan_.size());
  std::reverse(fan_.data() + fan_.size() - behind, fan_.data() + fan_.size());
  return {};
}

template <class Io>
bool SeamCoder<Io>::codeHasSeam() {
  const uint32_t n = static_cast<uint32_t>(fan_.size());
  if (n < 2) return false;  // a closed umbrella needs two seam ends, an open one needs one
  bool any = false;
  if constexpr (Io::kEncoding) {
    for (uint32_t i = 1; i < n; ++i) any |= source(fan_[i]) != source(fan_[0]);
  }
  return io_.bit(models_.has_seam[std::min(known_ends_, 3u)][closed_ ? 0 : 1][sharpest_], any);
}

/// Codes bits for the edges 1 .. n-1 between the fan faces i-1 and i, then for the closing edge 0.
/// [A.7.2]
template <class Io>
void SeamCoder<Io>::codeSeamEnds() {
  const uint32_t n = static_cast<uint32_t>(fan_.size());
  const uint32_t edges = closed_ ? n : n - 1;
  const uint32_t boundary = closed_ ? 0 : 1;
  const uint32_t needed = closed_ ? 2 : 1;
  uint32_t ends = 0;
  for (uint32_t k = 1; k <= edges; ++k) {
    const uint32_t i = k == n ? 0 : k;
    bool seam = ends + (edges - k + 1) == needed;  // implied when every remaining edge is needed
    if (!seam) {
      const uint32_t t = faces_.twin(fan_[i]);
      const uint32_t other = (faces_.vertex(t) & kDone) == 0 ? 0 : 1 + seamEnd(faces_, t);
      bool truth = false;
      if constexpr (Io::kEncoding) truth = source(fan_[i]) != source(fan_[i == 0 ? n - 1 : i - 1]);
      const uint32_t crease = creaseClass(faces_, fan_[i]);
      seam = io_.bit(models_.edge[other][std::min(ends, 2u)][boundary][crease], truth);
    }
    if (!seam) continue;
    ++ends;
    setSeamEnd(faces_, fan_[i]);
  }
}

template <class Io>
Status SeamCoder<Io>::codeUmbrella(uint32_t group, uint32_t start, const SeamWedges& wedges) {
  MCC_TRY(collectFan(start));
  if (codeHasSeam()) {
    codeSeamEnds();
    return codeRuns(group, wedges);
  }
  uint32_t wedge = kNone;
  MCC_TRY(codeWedge({fan_[0], true, {kNone, kNone}}, group, wedges, wedge));
  for (size_t i = 0; i < fan_.size(); ++i) faces_.words[fan_[i]] = wedge | kDone;
  return {};
}

/// Codes the runs. A run starts after a seam end; the first may reach back over the closing edge.
template <class Io>
Status SeamCoder<Io>::codeRuns(uint32_t group, const SeamWedges& wedges) {
  const uint32_t n = static_cast<uint32_t>(fan_.size());
  uint32_t first = 0;
  while (closed_ && first < n && !seamBefore(first)) ++first;
  if (first == n) first = 0;
  uint32_t first_wedge = kNone;
  uint32_t previous = kNone;
  for (uint32_t i = 0; i < n;) {
    uint32_t length = 1;
    while (i + length < n && !seamBefore(around(first + i + length))) ++length;
    const bool last = i + length == n;
    uint32_t wedge = kNone;
    const uint32_t next = last && closed_ ? first_wedge : kNone;
    const Run run{fan_[around(first + i)], i == 0, {previous, next}};
    MCC_TRY(codeWedge(run, group, wedges, wedge));
    for (uint32_t k = 0; k < length; ++k) {
      faces_.words[fan_[around(first + i + k)]] = wedge | kDone;
    }
    if (first_wedge == kNone) first_wedge = wedge;
    previous = wedge;
    i += length;
  }
  return {};
}

/// Codes a run as a new wedge, or as one of the group's wedges again. The rank of the latter counts
/// back from the latest wedge, skipping those of the neighbouring runs. [A.7.3]
template <class Io>
Status SeamCoder<Io>::codeWedge(const Run& run, uint32_t group, const SeamWedges& wedges,
                                uint32_t& wedge) {
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
  if (wedge_count_ == wedge_limit_) {
    return fail(Error::kBadAttribute, "the seams make more wedges than the header claims");
  }
  wedge = wedge_count_++;
  bool ok = wedges.start.push_back(run.first) && wedges.group.push_back(group);
  if constexpr (Io::kEncoding) ok = ok && noteSource(source(run.first), wedge);
  return ok ? Status{} : fail(Error::kOutOfMemory, "no memory for wedges");
}

}  // namespace mcc

#endif  // MCC_SURFACE_SEAMS_H_
