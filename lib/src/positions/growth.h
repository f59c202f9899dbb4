// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Order of the vertices: a region of known ones grows over the surface. [A.6.1]
//
// The next vertex is one with the most faces whose other two corners are known; three FIFO queues
// of half-edges, one for each such number, find it. The fan of a vertex is what is known around it:
// the contiguous known neighbours n0, n1, .. on both sides of the face it was queued by. Nine in
// ten vertices have the plain fan:
//
//          o0 --- n1 --- o1
//           \    /  \    /      n0, n1, n2, o0 and o1 are known,
//            n0       n2        the vertices beyond both ends are not
//              \    /
//                v
//
// The order does not depend on any position, so the writer walks once and tries predictors on a
// recording of the walk. A Visitor is given plain fans, other fans and seeds (vertices without a
// known face), and must make their vertices known. Its Plain part lives in the inner loop, as far
// as possible in registers. It is closed before and reopened after every other call, including the
// call for a plain fan that it declines.
#ifndef MCC_POSITIONS_GROWTH_H_
#define MCC_POSITIONS_GROWTH_H_

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "base/host.h"
#include "base/memory.h"
#include "mesh/face_mesh.h"
#include "mesh/groups.h"
#include "positions/record.h"

namespace mcc {

/// A FIFO queue of half-edges. When the end of the buffer is reached, the entries move to its
/// beginning.
class HalfEdgeQueue {
 public:
  explicit HalfEdgeQueue(const Allocator& allocator) : buffer_(allocator) {}

  [[nodiscard]] bool init() { return buffer_.resize(1024) && makeRoom(); }
  MCC_INLINE bool empty() const { return head_ == tail_; }
  MCC_INLINE uint32_t pop() { return *head_++; }
  /// Returns false if there is no memory. The contents of the queue are then meaningless, but it is
  /// still safe to use.
  [[nodiscard]] MCC_INLINE bool push(uint32_t half_edge) {
    *tail_++ = half_edge;  // there is always room for one entry
    return tail_ != end_ || makeRoom();
  }

 private:
  /// Moves the entries to the beginning and keeps them to at most half of the buffer, so that each
  /// entry is moved a constant number of times on average.
  MCC_OUT_OF_LINE bool makeRoom() {
    const size_t count = static_cast<size_t>(tail_ - head_);
    if (count != 0) std::memmove(buffer_.data(), head_, count * sizeof(uint32_t));
    const bool done = 2 * count <= buffer_.size() || buffer_.resize(2 * buffer_.size());
    head_ = buffer_.data();
    tail_ = head_ + (done ? count : 0);
    end_ = head_ + buffer_.size();
    return done;
  }

  uint32_t* head_ = nullptr;
  uint32_t* tail_ = nullptr;
  uint32_t* end_ = nullptr;
  Array<uint32_t> buffer_;
};

/// A plain fan: two faces, three neighbours, both tips known.
struct PlainFan {
  const VertexRecord* n0;
  const VertexRecord* n1;
  const VertexRecord* n2;
  const VertexRecord* o0;
  const VertexRecord* o1;
  uint32_t beyond0;  ///< half-edge n1 -> n0 of the face (n1, n0, o0)
  uint32_t beyond1;  ///< half-edge n2 -> n1 of the face (n2, n1, o1)
};

/// Any other fan, with at most kFanLimit faces on each side of the entry face.
struct AnyFan {
  static constexpr uint32_t kFanLimit = 8;

  const VertexRecord* n[2 * kFanLimit + 2];  ///< neighbours, starting from the clockwise-most
  /// Across from v over the edge n[i], n[i+1]; null if unknown.
  const VertexRecord* o[2 * kFanLimit + 1];
  uint32_t first;  ///< the clockwise-most half-edge of the fan that leaves the vertex
  uint32_t face_count;
  uint32_t neighbour_count;  ///< face_count, or one more if the fan is not closed
  bool closed;
};

class RegionGrowth {
 public:
  RegionGrowth(FaceMesh& mesh, const Groups& groups, VertexRecord* records, bool with_degrees,
               const Allocator& allocator)
      : faces_(mesh.view()),
        face_count_(mesh.face_count),
        groups_(groups),
        records_(records),
        with_degrees_(with_degrees),
        queue_{HalfEdgeQueue(allocator), HalfEdgeQueue(allocator), HalfEdgeQueue(allocator)} {}

  /// Visits every group once. `order`, if not null, has room for all groups and receives the
  /// half-edge that each was entered by, in coding order.
  template <class Visitor>
  Status run(Visitor& visitor, uint32_t* order);

  const FaceView& faces() const { return faces_; }

 private:
  void prepareRecords();
  void countDegrees();
  template <class Visitor>
  Status plantSeed(Visitor& visitor, uint32_t& cursor);
  template <class Visitor>
  Status grow(Visitor& visitor);
  bool plainFan(uint32_t half_edge, PlainFan& fan, uint32_t& ccw_tip, uint32_t& cw_tip) const;
  void walkFan(uint32_t half_edge, AnyFan& fan);
  MCC_INLINE void entered(uint32_t half_edge) {
    ++known_count_;
    if (order_ != nullptr) *order_++ = half_edge;
  }

  /// Queues an unknown vertex, and prefetches the faces across its edges. A vertex is usually
  /// visited the second or third time it is queued; by then the faces have arrived.
  MCC_INLINE void push(uint32_t half_edge) {
    int32_t& state = records_[faces_.vertex(half_edge)].q[3];
    const int32_t score = state + (state < kHighestScore ? 1 : 0);
    state = score;
    MCC_PREFETCH(faces_.words + faces_.twin(half_edge));
    MCC_PREFETCH(faces_.words + faces_.twin(prevHalfEdge(half_edge)));
    if (!queue_[score - 1].push(half_edge)) [[unlikely]]
      no_memory_ = true;
  }
  void pushFace(uint32_t h);
  void pushRing(uint32_t start);
  void pushOtherUmbrellas(uint32_t v, uint32_t entry);
  bool ringContains(uint32_t start, uint32_t half_edge) const;

  bool known(uint32_t v) const { return records_[v].known(); }
  const VertexRecord& recordAt(uint32_t half_edge) const {
    return records_[faces_.vertex(half_edge)];
  }
  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for the traversal"); }

  const FaceView faces_;
  const uint32_t face_count_;
  const Groups& groups_;
  VertexRecord* const records_;
  const bool with_degrees_;
  HalfEdgeQueue queue_[3];  ///< by score
  uint32_t* order_ = nullptr;
  uint32_t known_count_ = 0;
  bool no_memory_ = false;
};

inline void RegionGrowth::prepareRecords() {
  if (groups_.count != 0) std::memset(records_, 0, groups_.count * sizeof(VertexRecord));
  if (with_degrees_) countDegrees();
}

inline void RegionGrowth::countDegrees() {
  bool any_boundary = false;
  for (uint32_t f = 0; f < face_count_; ++f) {
    const uint32_t h = f * kFaceWords;
    for (uint32_t k = 0; k < 3; ++k) ++records_[faces_.vertex(h + k)].magnitude[3];
    // Only kNone has the highest bit set.
    if (((faces_.twin(h) | faces_.twin(h + 1) | faces_.twin(h + 2)) >> 31) == 0) [[likely]]
      continue;
    any_boundary = true;
    for (uint32_t k = 0; k < 3; ++k) {
      if (faces_.twin(h + k) != kNone) continue;
      records_[faces_.vertex(h + k)].magnitude[0] = 1;
      records_[faces_.vertex(nextHalfEdge(h + k))].magnitude[0] = 1;
    }
  }
  for (uint32_t v = 0; v < groups_.count && any_boundary; ++v) {
    uint32_t* r = records_[v].magnitude;
    if (r[0] != 0) r[3] = std::min(12u, 2 * r[3]);
  }
}

template <class Visitor>
Status RegionGrowth::run(Visitor& visitor, uint32_t* order) {
  for (HalfEdgeQueue& queue : queue_) {
    if (!queue.init()) return noMemory();
  }
  order_ = order;
  prepareRecords();
  uint32_t cursor = 0;
  while (known_count_ < groups_.count) {
    MCC_TRY(visitor.check());
    MCC_TRY(plantSeed(visitor, cursor));
    MCC_TRY(grow(visitor));
  }
  return {};
}

/// Finds the next face with an unknown corner and visits its vertices until two corners are known;
/// that queues the third.
template <class Visitor>
Status RegionGrowth::plantSeed(Visitor& visitor, uint32_t& cursor) {
  for (; cursor < face_count_; ++cursor) {
    const uint32_t base = cursor * kFaceWords;
    uint32_t known_corners = 0;
    for (uint32_t k = 0; k < 3; ++k) known_corners += known(faces_.vertex(base + k)) ? 1 : 0;
    if (known_corners == 3) continue;
    if (known_corners == 2) {  // lies between two fans, so neither queued it
      for (uint32_t k = 0; k < 3; ++k) {
        if (!known(faces_.vertex(base + k))) push(base + k);
      }
    }
    for (uint32_t k = 0; k < 3 && known_corners < 2; ++k) {
      const uint32_t h = base + k;
      const uint32_t v = faces_.vertex(h);
      if (known(v)) continue;
      const VertexRecord* neighbour = nullptr;
      if (known(faces_.vertex(nextHalfEdge(h)))) neighbour = &recordAt(nextHalfEdge(h));
      if (known(faces_.vertex(prevHalfEdge(h)))) neighbour = &recordAt(prevHalfEdge(h));
      visitor.seed(v, neighbour, h);
      entered(h);
      pushRing(h);
      pushOtherUmbrellas(v, h);
      ++known_corners;
    }
    return no_memory_ ? noMemory() : Status{};
  }
  return fail(Error::kBadConnectivity, "a vertex has no triangle");
}

template <class Visitor>
Status RegionGrowth::grow(Visitor& visitor) {
  const bool copies = groups_.hasCopies();
  typename Visitor::Plain plain(visitor);
  for (;;) {
    uint32_t level = 2;
    while (queue_[level].empty()) {
      if (level-- == 0) {
        plain.close(visitor);
        return no_memory_ ? noMemory() : Status{};
      }
    }
    const uint32_t h = queue_[level].pop();
    const uint32_t v = faces_.vertex(h);
    if (records_[v].state() != static_cast<int32_t>(level) + 1) continue;  // queued again since
    PlainFan fan;
    uint32_t ccw_tip = h;
    uint32_t cw_tip = h;
    if (plainFan(h, fan, ccw_tip, cw_tip)) [[likely]] {
      if (ccw_tip != h) [[likely]]
        push(ccw_tip);
      if (cw_tip != h) [[likely]]
        push(cw_tip);
      if (!plain.visit(v, fan)) [[unlikely]] {
        const PlainFan copy = fan;  // taking the address of `fan` itself would force it into memory
        plain.close(visitor);
        visitor.plain(v, copy);
        plain.reopen(visitor);
      }
    } else {
      AnyFan any;
      walkFan(h, any);
      plain.close(visitor);
      visitor.fan(v, any);
      plain.reopen(visitor);
    }
    entered(h);
    if (copies) pushOtherUmbrellas(v, h);
    if ((known_count_ & 0xfff) == 0) [[unlikely]] {
      if (no_memory_) return noMemory();
      plain.close(visitor);
      MCC_TRY(visitor.check());
      plain.reopen(visitor);
    }
  }
}

/// Returns `a` where `mask` has ones, else `b`. It has no branch, because which side of a fan is
/// known is close to random.
MCC_INLINE uint32_t select(uint32_t mask, uint32_t a, uint32_t b) { return b ^ ((a ^ b) & mask); }

/// Recognises the plain fan around `half_edge`. `ccw_tip` and `cw_tip` receive the half-edges of
/// the vertices beyond its ends, or `half_edge` itself at a boundary. Queues nothing.
MCC_INLINE bool RegionGrowth::plainFan(uint32_t half_edge, PlainFan& fan, uint32_t& ccw_tip,
                                       uint32_t& cw_tip) const {
  // Returns the half-edge of the vertex across from `h`. Across a boundary, the vertex itself
  // stands in: it is not known, as required.
  const auto across = [&](uint32_t twin) MCC_INLINE_LAMBDA {
    return twin != kNone ? prevHalfEdge(twin) : half_edge;
  };
  const uint32_t ccw = faces_.rotateCcw(half_edge);
  const uint32_t cw_twin = faces_.twin(half_edge);
  const uint32_t ccw_third = across(ccw);
  const uint32_t cw_third = across(cw_twin);
  const bool ccw_known = recordAt(ccw_third).known();
  if (ccw_known == recordAt(cw_third).known()) return false;
  // The fan's second face is on the known side; the vertex beyond it is the only end not seen yet.
  const uint32_t mask = 0u - (ccw_known ? 1u : 0u);
  const uint32_t cw_next = nextHalfEdge(cw_twin);
  const uint32_t h0 = select(mask, half_edge, cw_next);
  const uint32_t h1 = select(mask, ccw, half_edge);
  const uint32_t outer_third = across(faces_.twin(select(mask, ccw_third, cw_next)));
  fan.beyond0 = faces_.twin(nextHalfEdge(h0));
  fan.beyond1 = faces_.twin(nextHalfEdge(h1));
  fan.n0 = &recordAt(nextHalfEdge(h0));
  fan.n1 = &recordAt(prevHalfEdge(h0));
  fan.n2 = &recordAt(prevHalfEdge(h1));
  fan.o0 = &recordAt(across(fan.beyond0));
  fan.o1 = &recordAt(across(fan.beyond1));
  const uint32_t inner_third = select(mask, cw_third, ccw_third);
  ccw_tip = select(mask, outer_third, inner_third);
  cw_tip = select(mask, inner_third, outer_third);
  const bool closed = recordAt(outer_third).known();
  return (uint32_t{fan.o0->known()} & uint32_t{fan.o1->known()} & uint32_t{!closed}) != 0;
}

/// Collects the known neighbours on both sides of the entry face, and queues the vertices beyond
/// the ends of the fan.
inline void RegionGrowth::walkFan(uint32_t half_edge, AnyFan& fan) {
  constexpr uint32_t kLimit = AnyFan::kFanLimit;
  uint32_t h[2 * kLimit + 1];
  uint32_t first = kLimit;
  uint32_t end = kLimit;
  h[end++] = half_edge;
  fan.closed = false;
  while (end - kLimit <= kLimit) {
    const uint32_t next = faces_.rotateCcw(h[end - 1]);
    if (next == kNone) break;
    if (next == half_edge) {
      fan.closed = true;
      break;
    }
    const uint32_t third = prevHalfEdge(next);
    if (!known(faces_.vertex(third))) {
      push(third);
      break;
    }
    h[end++] = next;
  }
  while (first != 0 && !fan.closed) {
    const uint32_t t = faces_.twin(h[first]);
    if (t == kNone) break;
    const uint32_t third = prevHalfEdge(t);
    if (!known(faces_.vertex(third))) {
      push(third);
      break;
    }
    const uint32_t next = nextHalfEdge(t);
    if (next == h[end - 1]) break;  // met the other side beyond its limit
    h[--first] = next;
  }
  fan.first = h[first];
  fan.face_count = end - first;
  fan.neighbour_count = fan.face_count + (fan.closed ? 0 : 1);
  for (uint32_t i = 0; i < fan.face_count; ++i) {
    fan.n[i] = &recordAt(nextHalfEdge(h[first + i]));
    const uint32_t t = faces_.twin(nextHalfEdge(h[first + i]));
    fan.o[i] =
        t != kNone && recordAt(prevHalfEdge(t)).known() ? &recordAt(prevHalfEdge(t)) : nullptr;
  }
  fan.n[fan.face_count] = &recordAt(prevHalfEdge(h[end - 1]));
}

/// Queues the unknown corner of the face of `h`, whose vertex is known, if it has exactly one.
inline void RegionGrowth::pushFace(uint32_t h) {
  const uint32_t a = nextHalfEdge(h);
  const uint32_t b = prevHalfEdge(h);
  const bool a_known = known(faces_.vertex(a));
  const bool b_known = known(faces_.vertex(b));
  if (a_known != b_known) push(a_known ? b : a);
}

/// Does the same for every face around `start`.
inline void RegionGrowth::pushRing(uint32_t start) {
  uint32_t h = start;
  bool ccw = true;
  for (;;) {
    pushFace(h);
    h = ccw ? faces_.rotateCcw(h) : faces_.rotateCw(h);
    if (h == start) return;
    if (h == kNone) {
      if (!ccw) return;
      ccw = false;
      h = faces_.rotateCw(start);
      if (h == kNone) return;
    }
  }
}

/// Queues from the faces of a group's other umbrellas: a position that is known through one piece
/// of the surface is known to all.
inline void RegionGrowth::pushOtherUmbrellas(uint32_t v, uint32_t entry) {
  if (!groups_.hasCopies()) return;
  const std::span<const uint32_t> umbrellas = groups_.umbrellasOf(v);
  if (umbrellas.size() < 2) return;
  if (groups_.has_corners) {
    for (const uint32_t h : umbrellas) pushFace(h);
    return;
  }
  for (const uint32_t start : umbrellas) {
    if (!ringContains(start, entry)) pushRing(start);
  }
}

inline bool RegionGrowth::ringContains(uint32_t start, uint32_t half_edge) const {
  uint32_t h = start;
  do {
    if (h == half_edge) return true;
    h = faces_.rotateCcw(h);
  } while (h != kNone && h != start);
  if (h == start) return false;
  for (h = faces_.rotateCw(start); h != kNone; h = faces_.rotateCw(h)) {
    if (h == half_edge) return true;
  }
  return false;
}

}  // namespace mcc

#endif  // MCC_POSITIONS_GROWTH_H_
