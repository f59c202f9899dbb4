// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Mirrored halves: a vertex whose mirror image is known already is coded by naming it. [A.6.14]
//
//        u0 --- c   |   ? --- n0      The neighbour n0 has the mate u0, its image under the mirror.
//                   |                 The vertices around u0 that have no mate yet are candidates:
//                mirror               the image of one of them is probably the vertex to be coded.
//
// Two vertices are mates under a mirror if one was named as the image of the other, or is exactly
// there. Nothing is assumed of the triangles: they need not be mirrored.
//
// A component that has an anchor is coded in the same way: under its isometry, the mates of its
// vertices are vertices of the component that it repeats. A vertex may become the mate of one
// vertex in each component. [A.6.15]
#ifndef MCC_POSITIONS_MIRRORS_H_
#define MCC_POSITIONS_MIRRORS_H_

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "base/memory.h"
#include "entropy/models.h"
#include "mcc/status.h"
#include "mesh/face_mesh.h"
#include "positions/anchor.h"
#include "positions/isometry.h"
#include "positions/mirror.h"
#include "positions/predict.h"
#include "positions/tables.h"

namespace mcc {

/// The candidates of a vertex that can be named.
inline constexpr uint32_t kMostCandidates = 7;
/// What is coded of a vertex that has candidates: 0 for none of them, 1 .. 7 for a candidate whose
/// image is the vertex, 8 .. 14 for one whose image is near.
inline constexpr uint32_t kNearCandidate = 1 + kMostCandidates;
/// The neighbours around whose mates candidates are found.
inline constexpr uint32_t kMostRings = 2;
/// The corners around a mate that are looked at, in each direction.
inline constexpr uint32_t kMateCorners = 16;
/// The frequencies at first, per mille: with one candidate, with one that is far nearer than the
/// others, and with several.
inline constexpr uint32_t kLeads = 3;
inline constexpr uint32_t kCandidateFrequencies[kLeads][kTokenCount] = {
    {480, 470, 1, 1, 1, 1, 1, 1, 50, 1, 1, 1, 1, 1, 1, 1},
    {160, 735, 25, 6, 5, 2, 2, 1, 70, 2, 1, 1, 1, 1, 1, 1},
    {230, 530, 100, 42, 18, 10, 5, 5, 41, 9, 4, 2, 1, 1, 1, 1}};
inline constexpr uint32_t kNearBucket = 4;  ///< whose row a near image's residual starts with

struct MirrorModels {
  TokenRow candidate[2 * kLeads];
  TokenRow residual[3];
  AnchorModels anchors;

  MirrorModels() {
    for (uint32_t i = 0; i < 2 * kLeads; ++i) {
      setTokenRow(kCandidateFrequencies[i / 2], candidate[i]);
      candidate[i].low_bits = 0;
    }
    for (TokenRow& row : residual) makeTokenRow(kNearBucket, row);
  }
};

/// The vertices coded so far with their mates, and the candidates for the next. Each vertex costs a
/// bounded number of steps, and few branches that a processor cannot foresee.
class MirrorMates {
 public:
  /// `mates` receives the mates. begin() must be called at components if there are anchors.
  MirrorMates(const FaceView& faces, const VertexRecord* records, const Mirrors& mirrors,
              VertexMates& mates, const Allocator& allocator)
      : faces_(faces), records_(records), count_(mirrors.count), mates_(mates), at_(allocator) {
    for (uint32_t m = 0; m < count_; ++m) {
      const Mirror& mirror = mirrors.mirror[m];
      mates_.axis[m] = mirror.axis;
      flip_[m][mirror.axis] = ~0u;
      move_[m][mirror.axis] = static_cast<uint32_t>(mirror.sum) + 1;
    }
  }

  [[nodiscard]] bool init(uint32_t vertex_count, bool has_anchors) {
    const uint32_t width = std::bit_width(vertex_count) + 1u;
    shift_ = 32 - width;
    return mates_.assign(count_, has_anchors, vertex_count, kNotCoded) &&
           at_.assign(size_t{1} << width, kNone);
  }

  /// Finds the candidates for a vertex that is expected at `from`, around the mates of some of its
  /// known neighbours.
  void findCandidates(std::span<const VertexRecord* const> neighbours,
                      const Lanes<uint32_t>& from) {
    found_count_ = 0;
    named_ = kMostFound;
    uint32_t rings = 0;
    all_have_mates_ = true;
    for (const VertexRecord* record : neighbours) {
      const uint32_t neighbour = static_cast<uint32_t>(record - records_);
      bool has_mate = false;
      for (uint32_t m = 0; m < count_ + (component_ != 0 ? 1 : 0); ++m) {
        const uint32_t mate = mateOf(m, neighbour);
        if (mate >= kIsFound) continue;
        has_mate = true;
        if (rings < kMostRings && found_count_ != 1) collectAround(m, startOf(mate));
      }
      all_have_mates_ &= has_mate;
      rings += has_mate && found_count_ != 0 ? 1 : 0;
    }
    rank(from);
  }
  uint32_t count() const { return std::min(found_count_, kMostCandidates); }
  /// The context of the choice, by how clear it is.
  uint32_t context() const {
    const uint32_t lead = found_count_ < 2                                ? 0
                          : 3 * (best_ >> kKeyBits) < second_ >> kKeyBits ? 1
                                                                          : 2;
    return 2 * lead + (all_have_mates_ ? 1 : 0);
  }
  /// Returns the image of a candidate, by its rank below count().
  Lanes<uint32_t> imageOf(uint32_t rank) const { return image(found_[numberOf(rank)]); }
  /// Names the candidate that add() shall make the vertex's mate.
  void name(uint32_t rank) { named_ = numberOf(rank); }

  /// Finds the mates of a vertex whose position has become known. `start` is a half-edge that
  /// leaves it. findCandidates() must have been called for it.
  MCC_OUT_OF_LINE void add(uint32_t vertex, uint32_t start) {
    startOf(vertex) = start;
    const Lanes<uint32_t> q = coordinates(&records_[vertex]);
    for (uint32_t m = 0; m < count_; ++m) {
      const uint32_t mate = findMate(m, vertex, q);
      mateOf(m, vertex) = mate;
      if (mate != kNone) mateOf(m, mate) = vertex;
    }
    if (mates_.has_anchors) addRepeated(vertex, q);
    at_[placeOf(q)] = vertex;
  }

  /// Begins a component with a vertex whose position has become known, before add() is called for
  /// it. `anchor` names a known vertex or none.
  void begin(uint32_t vertex, const Anchor& anchor) {
    component_ = 0;
    if (anchor.vertex == kNone) return;
    component_ = ++anchor_count_;
    turn_ = anchor.turn;
    isometry_ = Isometry(turn_);
    isometry_.lead(coordinates(&records_[anchor.vertex]), coordinates(&records_[vertex]));
    found_[0] = {anchor.vertex, count_};
    named_ = 0;
  }

 private:
  struct Found {
    uint32_t vertex;
    uint32_t mirror;  ///< or count_ for the isometry of the component
  };
  static constexpr uint32_t kMostFound = kMostRings * (kMaxMirrors + 1) * (2 * kMateCorners + 1);
  static constexpr uint32_t kKeyBits = 9;
  static_assert(kMostFound < 1u << kKeyBits);

  /// The mates of a vertex that is not coded yet, and of one that is found already.
  static constexpr uint32_t kNotCoded = kNone - 1;
  static constexpr uint32_t kIsFound = kNone - 2;

  uint32_t& startOf(uint32_t vertex) { return mates_.startOf(vertex); }
  uint32_t& mateOf(uint32_t mirror, uint32_t vertex) { return mates_.mateOf(mirror, vertex); }
  /// sum - x is ~x + sum + 1.
  Lanes<uint32_t> image(const Lanes<uint32_t>& q, uint32_t mirror) const {
    return (q ^ flip_[mirror]) + move_[mirror];
  }
  Lanes<uint32_t> image(const Found& found) const {
    const Lanes<uint32_t> q = coordinates(&records_[found.vertex]);
    return found.mirror == count_ ? isometry_(q) : image(q, found.mirror);
  }
  static bool isNear(const Lanes<uint32_t>& a, const Lanes<uint32_t>& b) {
    const Lanes<uint32_t> d = absoluteLanes(a - b);
    return std::max({d[0], d[1], d[2]}) <= 1;
  }
  static bool isEqual(const Lanes<uint32_t>& a, const Lanes<uint32_t>& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
  }
  uint32_t placeOf(const Lanes<uint32_t>& q) const {
    return (q[0] * 0x9e3779b1u + q[1] * 0x85ebca77u + q[2] * 0xc2b2ae3du) >> shift_;
  }

  /// Returns the mate of a vertex at q: itself if it is on the mirror, else the candidate that was
  /// named, however far its image is, else a vertex exactly at the image.
  uint32_t findMate(uint32_t m, uint32_t vertex, const Lanes<uint32_t>& q) {
    const Lanes<uint32_t> opposite = image(q, m);
    if (isNear(q, opposite)) return vertex;
    if (named_ != kMostFound && found_[named_].mirror == m) return found_[named_].vertex;
    const uint32_t other = at_[placeOf(opposite)];
    const bool is_mate = other != kNone && mateOf(m, other) == kNone &&
                         isEqual(coordinates(&records_[other]), opposite);
    return is_mate ? other : kNone;
  }

  /// The word that says whether a vertex may become a mate: its mate or where it was taken.
  uint32_t& freeOf(uint32_t mirror, uint32_t vertex) {
    return mirror == count_ ? mates_.takenOf(vertex) : mateOf(mirror, vertex);
  }
  static bool isFree(uint32_t word, uint32_t free_below) {
    return word == kNone || word < free_below;
  }

  /// Finds the mate of a vertex at q under the isometry of its component, if there is one: the
  /// anchor, or else as findMate() does.
  void addRepeated(uint32_t vertex, const Lanes<uint32_t>& q) {
    uint32_t mate = kNone;
    if (component_ != 0) {
      if (named_ != kMostFound && found_[named_].mirror == count_) {
        mate = found_[named_].vertex;
      } else {
        const Lanes<uint32_t> source = isometry_.source(q);
        const uint32_t other = at_[placeOf(source)];
        if (other != kNone && isFree(mates_.takenOf(other), component_) &&
            isEqual(coordinates(&records_[other]), source))
          mate = other;
      }
      if (mate != kNone) mates_.takenOf(mate) = component_;
    }
    mates_.takenOf(vertex) = kNone;
    mates_.turnOf(vertex) = turn_;
    mateOf(count_, vertex) = mate;
  }

  /// Ranks the candidates by the distance of their images: a key is a distance above a number in
  /// found_.
  void rank(const Lanes<uint32_t>& from) {
    best_ = second_ = ~uint64_t{0};
    for (uint32_t i = 0; i < found_count_; ++i) {
      freeOf(found_[i].mirror, found_[i].vertex) = kNone;
      const Lanes<uint32_t> d = absoluteLanes(image(found_[i]) - from);
      const uint64_t key = (uint64_t{d[0]} + d[1] + d[2]) << kKeyBits | i;
      keys_[i] = key;
      second_ = std::min(second_, std::max(best_, key));
      best_ = std::min(best_, key);
    }
  }
  uint32_t numberOf(uint32_t rank) const {
    uint64_t key = best_;
    for (uint32_t before = 0; before < rank; ++before) {
      uint64_t next = ~uint64_t{0};
      for (uint32_t i = 0; i < found_count_; ++i) {
        if (keys_[i] > key) next = std::min(next, keys_[i]);
      }
      key = next;
    }
    return static_cast<uint32_t>(key & ((1u << kKeyBits) - 1));
  }

  /// Collects the vertices around that of `start` which are coded and have no mate yet.
  void collectAround(uint32_t mirror, uint32_t start) {
    uint32_t count = found_count_;
    uint32_t* const mates = &freeOf(mirror, 0);
    const size_t stride = mates_.stride;
    const uint32_t free_below = mirror == count_ ? component_ : 0;
    const auto collect = [&](uint32_t vertex) MCC_INLINE_LAMBDA {
      uint32_t& mate = mates[vertex * stride];
      const uint32_t is_new = isFree(mate, free_below) ? 1 : 0;
      found_[count] = {vertex, mirror};
      mate = is_new != 0 ? kIsFound : mate;
      count += is_new;
    };
    const FaceView faces = faces_;
    uint32_t h = start;
    uint32_t i = 0;
    for (; i < kMateCorners && h != kNone; ++i) {
      collect(faces.vertex(nextHalfEdge(h)));
      const uint32_t last = h;
      h = faces.rotateCcw(h);
      if (h == start) break;
      if (h == kNone) collect(faces.vertex(prevHalfEdge(last)));
    }
    if (h != start) {
      h = start;
      for (i = 0; i < kMateCorners; ++i) {
        h = faces.rotateCw(h);
        if (h == kNone || h == start) break;
        collect(faces.vertex(nextHalfEdge(h)));
      }
    }
    found_count_ = count;
  }

  const FaceView faces_;
  const VertexRecord* const records_;
  const uint32_t count_;  ///< of mirrors
  Isometry isometry_;     ///< of the component
  Turn turn_ = 0;
  uint32_t component_ = 0;  ///< its number among those with anchors, or 0 without one
  uint32_t anchor_count_ = 0;
  Lanes<uint32_t> flip_[kMaxMirrors] = {};
  Lanes<uint32_t> move_[kMaxMirrors] = {};
  VertexMates& mates_;
  Array<uint32_t> at_;  ///< the last vertex by the hash of its position
  uint32_t shift_ = 0;
  Found found_[kMostFound + 1] = {};  ///< and room for one that is not kept
  uint64_t keys_[kMostFound] = {};
  uint64_t best_ = 0;
  uint64_t second_ = 0;
  uint32_t found_count_ = 0;
  uint32_t named_ = kMostFound;
  bool all_have_mates_ = false;
};

}  // namespace mcc

#endif  // MCC_POSITIONS_MIRRORS_H_
