// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Codes faces vertex by vertex, for meshes whose edges have many faces: cells, stacked boxes,
// tetrahedra. [A.4.7]
//
// Cutting such a mesh into manifolds would make dozens of copies of every vertex. Here each vertex
// keeps a single number, and in the order of the numbers each vertex is the pivot once. The faces
// that are coded then are those of the pivot whose other two vertices come after it:
//
//   spokes   The edges of the pivot to later vertices, in the order in which they are met: first
//            those of the faces that earlier pivots coded, then what the new faces add.
//   row      The new faces of one spoke. For each: is there another one? Which spoke is its other
//            edge at the pivot, or does that edge lead to a vertex that is near, new, or anywhere?
//            Which side is up?
//
// Half-edges along a spoke are joined as they are met. The time is linear in the faces, whatever
// the stream says: every face is looked at three times, every spoke once per pivot, and each face
// looks at a bounded number of other spokes.
#ifndef MCC_CONNECTIVITY_PIVOTS_H_
#define MCC_CONNECTIVITY_PIVOTS_H_

#include <algorithm>
#include <cstdint>

#include "base/memory.h"
#include "connectivity/mc_codes.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mcc/status.h"
#include "mesh/face_mesh.h"
#include "mesh/groups.h"

namespace mcc {

inline constexpr uint32_t kSpokeFaces = 16;  ///< classes of the number of faces at a spoke
/// Faces searched for a vertex near that of the row.
inline constexpr uint32_t kPivotNearFaces = 16;
/// Spokes asked for one by one; the rest are skipped by number.
inline constexpr uint32_t kPivotAsked = 32;

struct PivotModels {
  BitModel more[kSpokeFaces][3][3];        ///< [faces at the row's spoke][its balance][new ones]
  BitModel is_spoke[kSpokeFaces][3][3];    ///< [faces at the row's spoke][its balance][that fit]
  BitModel is_this[kSpokeFaces][3][3][2];  ///< [faces at it][balance of the row's][its][again]
  BitModel turned[3][3][2];                ///< [balance of the row's spoke][of the other][again]
  BitModel is_near[kPivotNearFaces];
  BitModel is_new;
  BitModel another_fan;
  GolombModel skipped;
  GolombModel far;
};

/// What the encoder knows about a face.
struct PivotFace {
  uint32_t pivot;
  uint32_t row;     ///< index of its first spoke
  uint32_t place;   ///< index of its other spoke; kNone if that is met only now
  uint32_t first;   ///< vertex at the end of the first spoke
  uint32_t second;  ///< vertex at the end of the other spoke
  bool turned;      ///< (pivot, second, first) instead of (pivot, first, second)
};

template <class Io>
class PivotCoder {
 public:
  /// `truth` has all faces in coding order (encoder). `edges`, if not null, has room for as many
  /// edges as vertices, and receives the edges by which vertices are met for the first time.
  PivotCoder(Io& io, PivotModels& models, FaceMesh& mesh, const PivotFace* truth,
             Array<McEdge>* edges)
      : io_(io),
        models_(models),
        mesh_(mesh),
        vertices_(mesh.allocator()),
        spokes_(mesh.allocator()),
        truth_(truth),
        edges_(edges) {}

  /// Codes the faces and fills `mesh`, which must have room for them.
  Status run(uint32_t vertex_count, uint32_t face_count);

 private:
  using CodesBurst = typename Io::CodesBurst;

  struct Vertex {
    /// The latest face of which it is the second vertex by number; kFaceWord links them.
    uint32_t face = kNone;
    uint32_t pivot = kNone;  ///< the pivot for which `spoke` is valid
    uint32_t spoke = 0;
  };
  struct Spoke {
    uint32_t vertex;
    uint32_t face_count;
    int32_t balance;  ///< half-edges from the pivot minus those to it; this many are open
    uint32_t open;  ///< the latest half-edge that is not joined; its twin is the open one before it

    uint32_t faceClass() const { return std::min(face_count, kSpokeFaces - 1); }
    uint32_t balanceClass() const { return (balance > 0 ? 1u : 0u) + (balance < 0 ? 2u : 0u); }
  };

  Status codePivot(uint32_t p);
  Status meetKnownFaces(uint32_t p);
  Status codeRow(CodesBurst& codes, uint32_t p, uint32_t row, bool begins_fan);
  Status codeOther(CodesBurst& codes, uint32_t p, uint32_t row, uint32_t from, uint32_t& place);
  Status codeNear(uint32_t p, uint32_t w, uint32_t truth, uint32_t& place);
  Status meet(uint32_t p, uint32_t truth, uint32_t& place);
  Status addSpoke(uint32_t p, uint32_t vertex, uint32_t& place);
  void addFace(uint32_t p, uint32_t first, uint32_t second);
  void join(Spoke& spoke, uint32_t half_edge, int32_t direction);
  void closeSpokes();
  /// Returns whether the next face belongs to this pivot (encoder).
  bool isNext(uint32_t p) const {
    return Io::kEncoding && face_count_ != face_limit_ && truth_[face_count_].pivot == p;
  }

  static Status noMemory() {
    return fail(Error::kOutOfMemory, "no memory for the connectivity decoder");
  }
  static Status noSuchSpoke() {
    return fail(Error::kBadConnectivity, "a triangle refers to a spoke that does not exist");
  }
  static Status noSuchVertex() {
    return fail(Error::kBadConnectivity, "a triangle refers to a vertex that does not exist");
  }
  static Status isSpoke() {
    return fail(Error::kBadConnectivity, "a new spoke leads to the vertex of another one");
  }

  Io& io_;
  PivotModels& models_;
  FaceMesh& mesh_;
  uint32_t face_limit_ = 0;
  Array<Vertex> vertices_;
  Array<Spoke> spokes_;
  const PivotFace* const truth_;
  Array<McEdge>* const edges_;
  uint32_t face_count_ = 0;
  uint32_t known_count_ = 0;   ///< number of vertices met
  uint32_t balanced_[3] = {};  ///< number of spokes of each class of balance
};

template <class Io>
Status PivotCoder<Io>::run(uint32_t vertex_count, uint32_t face_count) {
  face_limit_ = face_count;
  if (!vertices_.assign(vertex_count, Vertex{})) return noMemory();
  for (uint32_t p = 0; p < vertex_count; ++p) {
    MCC_TRY(codePivot(p));
    if ((p & 0xff) == 0 && io_.overrun())
      return fail(Error::kTruncated, "the code stream ends inside the faces");
  }
  if (face_count_ != face_limit_)
    return fail(Error::kBadConnectivity, "the codes yield fewer triangles than the header claims");
  mesh_.face_count = face_count_;
  mesh_.vertex_count = vertex_count;
  return {};
}

/// Codes all faces of which p is the first vertex by number.
template <class Io>
Status PivotCoder<Io>::codePivot(uint32_t p) {
  spokes_.clear();
  balanced_[0] = balanced_[1] = balanced_[2] = 0;
  const bool is_new = p == known_count_;  // no face has led to it
  if (is_new) ++known_count_;
  MCC_TRY(meetKnownFaces(p));
  uint32_t row = 0;
  bool begins_fan = false;
  for (;;) {
    CodesBurst codes(io_);
    for (; row < spokes_.size(); ++row, begins_fan = false)
      MCC_TRY(codeRow(codes, p, row, begins_fan));
    codes.giveBack(io_);
    if (face_count_ == face_limit_) break;
    begins_fan = (is_new && row == 0) || io_.bit(models_.another_fan, isNext(p));
    if (!begins_fan) break;
    uint32_t place = 0;
    MCC_TRY(meet(p, Io::kEncoding ? truth_[face_count_].first : 0, place));
  }
  if (is_new && row == 0)
    return fail(Error::kBadConnectivity, "the codes leave a vertex without a triangle");
  closeSpokes();
  return {};
}

/// Meets the coded faces of which p is the second vertex. Each has one edge that no pivot has
/// looked at yet.
template <class Io>
Status PivotCoder<Io>::meetKnownFaces(uint32_t p) {
  for (uint32_t f = vertices_[p].face; f != kNone;) {
    uint32_t* const face = mesh_.words.data() + size_t{f} * kFaceWords;
    const bool leaves = face[1] == p;
    const uint32_t w = face[leaves ? 2 : 1];
    uint32_t place = vertices_[w].spoke;
    if (vertices_[w].pivot != p) MCC_TRY(addSpoke(p, w, place));
    join(spokes_[place], f * kFaceWords + 1, leaves ? 1 : -1);
    f = face[kFaceWord];
    face[kFaceWord] = 0;
  }
  return {};
}

/// Codes the new faces between the spoke `row` and a later one.
template <class Io>
MCC_INLINE Status PivotCoder<Io>::codeRow(CodesBurst& codes, uint32_t p, uint32_t row,
                                          bool begins_fan) {
  uint32_t place = row + 1;
  for (uint32_t count = 0; face_count_ != face_limit_; ++count) {
    const Spoke spoke = spokes_[row];
    const uint32_t balance = spoke.balanceClass();
    if (!begins_fan || count != 0) {
      BitModel& model = models_.more[spoke.faceClass()][balance][std::min(count, 2u)];
      if (!codes.bit(model, isNext(p) && truth_[face_count_].row == row)) break;
    }
    const uint32_t last = place;
    MCC_TRY(codeOther(codes, p, row, last, place));
    const uint32_t again = count != 0 && last == place ? 1 : 0;
    const bool turned = codes.bit(models_.turned[balance][spokes_[place].balanceClass()][again],
                                  Io::kEncoding && truth_[face_count_].turned);
    addFace(p, turned ? place : row, turned ? row : place);
  }
  return {};
}

/// Codes which spoke a face ends at; the search starts at `from`, the last one used in this row.
template <class Io>
MCC_INLINE Status PivotCoder<Io>::codeOther(CodesBurst& codes, uint32_t p, uint32_t row,
                                            uint32_t from, uint32_t& place) {
  const Spoke spoke = spokes_[row];
  const uint32_t balance = spoke.balanceClass();
  const uint32_t fitting = balance == 0 ? 2 : std::min(2u, balanced_[3 - balance]);
  const uint32_t truth = Io::kEncoding ? truth_[face_count_].place : kNone;
  if (from == spokes_.size() ||
      !codes.bit(models_.is_spoke[spoke.faceClass()][balance][fitting], truth != kNone)) {
    codes.giveBack(io_);
    MCC_TRY(codeNear(p, spoke.vertex, Io::kEncoding ? truth_[face_count_].second : 0, place));
    codes.take(io_);
    return {};
  }
  for (place = from; place + 1 < spokes_.size(); ++place) {
    if (place - from == kPivotAsked) {
      codes.giveBack(io_);
      const uint32_t skipped = codeGolomb(io_, models_.skipped, truth - place);
      codes.take(io_);
      if (skipped >= spokes_.size() - place) return noSuchSpoke();
      place += skipped;
      break;
    }
    const Spoke& s = spokes_[place];
    const uint32_t again = place == from && from != row + 1 ? 1 : 0;
    if (codes.bit(models_.is_this[s.faceClass()][balance][s.balanceClass()][again], place == truth))
      break;
  }
  return {};
}

/// Codes a vertex that is not on a spoke; the vertices of the faces of which w is the second are
/// tried first.
template <class Io>
Status PivotCoder<Io>::codeNear(uint32_t p, uint32_t w, uint32_t truth, uint32_t& place) {
  uint32_t asked = 0;
  uint32_t f = vertices_[w].face;
  for (uint32_t i = 0; i < kPivotNearFaces && f != kNone; ++i) {
    const uint32_t* const face = mesh_.words.data() + size_t{f} * kFaceWords;
    const uint32_t v = face[face[1] == w ? 2 : 1];
    f = face[kFaceWord];
    if (vertices_[v].pivot == p) continue;
    if (io_.bit(models_.is_near[asked++], v == truth)) return addSpoke(p, v, place);
  }
  return meet(p, truth, place);
}

/// Codes a vertex that is new, or any that is known.
template <class Io>
Status PivotCoder<Io>::meet(uint32_t p, uint32_t truth, uint32_t& place) {
  uint32_t vertex = known_count_;
  const uint32_t old_count = known_count_ - p - 1;
  bool is_new = known_count_ != vertices_.size();
  if (is_new && old_count != 0) is_new = io_.bit(models_.is_new, truth == known_count_);
  if (is_new) {
    ++known_count_;
    if (kTellsMcEdges && edges_ != nullptr) (void)edges_->push_back(McEdge{vertex, p});
  } else {
    const uint32_t distance = codeGolomb(io_, models_.far, known_count_ - 1 - truth);
    vertex = known_count_ - 1 - distance;
    if (distance >= old_count) return noSuchVertex();
    if (vertices_[vertex].pivot == p) return isSpoke();
  }
  return addSpoke(p, vertex, place);
}

template <class Io>
MCC_INLINE Status PivotCoder<Io>::addSpoke(uint32_t p, uint32_t vertex, uint32_t& place) {
  place = static_cast<uint32_t>(spokes_.size());
  vertices_[vertex].pivot = p;
  vertices_[vertex].spoke = place;
  ++balanced_[0];
  return spokes_.push_back(Spoke{vertex, 0, 0, kNone}) ? Status{} : noMemory();
}

/// Adds the face (p, end of `first`, end of `second`).
template <class Io>
MCC_INLINE void PivotCoder<Io>::addFace(uint32_t p, uint32_t first, uint32_t second) {
  Spoke& a = spokes_[first];
  Spoke& b = spokes_[second];
  const uint32_t base = face_count_ * kFaceWords;
  uint32_t* const face = mesh_.words.data() + base;
  uint32_t& latest = vertices_[std::min(a.vertex, b.vertex)].face;
  face[0] = p;
  face[1] = a.vertex;
  face[2] = b.vertex;
  face[kFaceWord] = latest;
  face[kSeamWord] = 0;
  latest = face_count_++;
  join(a, base, 1);
  join(b, base + 2, -1);
}

/// Joins a half-edge of the spoke with the latest open one of the other direction, or leaves it
/// open. It has no branches, because they could not be predicted.
template <class Io>
MCC_INLINE void PivotCoder<Io>::join(Spoke& spoke, uint32_t half_edge, int32_t direction) {
  uint32_t* const twins = mesh_.words.data() + 4;
  --balanced_[spoke.balanceClass()];
  const bool joins = spoke.balance * direction < 0;
  const uint32_t open = spoke.open;
  twins[half_edge] = open;
  const uint32_t at = joins ? open : half_edge;
  const uint32_t before = twins[at];
  twins[at] = joins ? half_edge : open;
  spoke.open = joins ? before : half_edge;
  spoke.balance += direction;
  ++spoke.face_count;
  ++balanced_[spoke.balanceClass()];
}

/// Turns the half-edges that are still open into boundaries.
template <class Io>
void PivotCoder<Io>::closeSpokes() {
  uint32_t* const twins = mesh_.words.data() + 4;
  for (size_t i = 0; i < spokes_.size(); ++i) {
    for (uint32_t h = spokes_[i].open; h != kNone;) {
      const uint32_t before = twins[h];
      twins[h] = kNone;
      h = before;
    }
  }
}

/// Makes every vertex a group. Its umbrellas are represented by all half-edges that leave it, by
/// their numbers.
inline Status listCorners(const FaceMesh& mesh, Groups& groups) {
  const uint32_t* const words = mesh.words.data();
  const size_t end = mesh.words.size();
  groups.count = mesh.vertex_count;
  groups.has_corners = true;
  if (!groups.listed.resize(size_t{groups.count} / 64 + 1) ||
      !groups.umbrella_begin.assign(size_t{groups.count} + 2, 0) ||
      !groups.umbrellas.resize(3 * size_t{mesh.face_count}))
    return fail(Error::kOutOfMemory, "no memory for the corners");
  for (uint32_t i = 0; i < groups.listed.size(); ++i)
    groups.listed[i] = Groups::Listed{~uint64_t{0}, 64 * i};
  uint32_t* const begin = groups.umbrella_begin.data();
  for (size_t f = 0; f < end; f += kFaceWords) {
    for (size_t h = f; h < f + 3; ++h) ++begin[words[h] + 2];
  }
  for (uint32_t v = 0; v < groups.count; ++v) begin[v + 2] += begin[v + 1];
  for (uint32_t f = 0; f < end; f += kFaceWords) {
    for (uint32_t h = f; h < f + 3; ++h) groups.umbrellas[begin[words[h] + 1]++] = h;
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_PIVOTS_H_
