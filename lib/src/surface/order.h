// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Codes the writer's order of triangles and of wedges, where it is kept. [A.9]
//
// Both are sequences of elements that earlier stages have produced in an order of their own. The
// next element is one of:
//   - the next one in a list that both sides know (mostly right if the source was in that order),
//   - one of the elements touched last: triangles across the edges of placed ones, or wedges that
//     complete triangles,
//   - any other that is left; it costs the logarithm of their number.
// Triangles come first, part by part, each with the corner it begins with. If the order of the
// wedges is kept too, they are then expected in the order of their first use.
#ifndef MCC_SURFACE_ORDER_H_
#define MCC_SURFACE_ORDER_H_

#include <cstdint>

#include "base/memory.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mesh/face_mesh.h"

namespace mcc {

inline constexpr uint32_t kRecentCount = 32;  ///< number of touched elements that a rank can name

/// The way by which an element is found.
enum class Way : uint8_t { kNear = 0, kFar = 1, kNext = 2, kAny = 3 };

struct SequenceModels {
  BitModel is_next[8][4];     ///< [the last three answers][last way]
  BitModel is_near[2][4][3];  ///< [asked for the next][last way][last near rank]
  BitModel is_far[2][4];      ///< [asked for the next][last way]
  /// [near, far][class of the last rank there][whether the last way was this one]
  TreeModel<5> rank[2][4][2];
};

struct OrderModels {
  SequenceModels triangles;
  SequenceModels wedges;
  BitModel corner[4][3][2];  ///< [way][last corner][second decision]
};

/// The elements that were touched last, the latest first.
class RecentElements {
 public:
  uint32_t count() const { return count_; }
  uint32_t element(uint32_t rank) const { return elements_[rank]; }
  uint32_t note(uint32_t rank) const { return notes_[rank]; }
  /// Returns the rank of an element, or count() if it is not among them.
  uint32_t rankOf(uint32_t element) const {
    uint32_t rank = 0;
    while (rank < count_ && elements_[rank] != element) ++rank;
    return rank;
  }

  /// Moves an element to the front.
  void touch(uint32_t element, uint32_t note) {
    uint32_t rank = rankOf(element);
    if (rank == count_) rank = count_ < kRecentCount ? count_++ : kRecentCount - 1;
    for (; rank != 0; --rank) {
      elements_[rank] = elements_[rank - 1];
      notes_[rank] = notes_[rank - 1];
    }
    elements_[0] = element;
    notes_[0] = note;
  }
  void remove(uint32_t element) {
    uint32_t rank = rankOf(element);
    if (rank == count_) return;
    for (--count_; rank < count_; ++rank) {
      elements_[rank] = elements_[rank + 1];
      notes_[rank] = notes_[rank + 1];
    }
  }
  void clear() { count_ = 0; }

 private:
  uint32_t elements_[kRecentCount];
  uint32_t notes_[kRecentCount];
  uint32_t count_ = 0;
};

/// The elements that are not placed yet, in no particular order. Those that were touched are also
/// in one of two lists: near ones, which are likely to be next, and far ones.
class OpenElements {
 public:
  explicit OpenElements(const Allocator& allocator) : open_(allocator), place_(allocator) {}

  /// Makes room for elements below `count`, none of which is open.
  [[nodiscard]] bool init(uint32_t count) {
    count_ = 0;
    return open_.resize(count) && place_.assign(count, kNone);
  }
  void add(uint32_t element) {
    place_[element] = count_;
    open_[count_++] = element;
  }

  uint32_t count() const { return count_; }
  bool isOpen(uint32_t element) const { return place_[element] != kNone; }
  uint32_t at(uint32_t place) const { return open_[place]; }
  uint32_t placeOf(uint32_t element) const { return place_[element]; }
  const RecentElements& recent(Way way) const { return way == Way::kNear ? near_ : far_; }

  /// These touch an element if it is open, and keep `note` with it. A far element can become near,
  /// but a near one stays near.
  void touchNear(uint32_t element, uint32_t note) {
    if (!isOpen(element)) return;
    far_.remove(element);
    near_.touch(element, note);
  }
  void touchFar(uint32_t element, uint32_t note) {
    if (isOpen(element) && near_.rankOf(element) == near_.count()) far_.touch(element, note);
  }

  void close(uint32_t element) {
    const uint32_t place = place_[element];
    const uint32_t last = open_[--count_];
    open_[place] = last;
    place_[last] = place;
    place_[element] = kNone;
    near_.remove(element);
    far_.remove(element);
  }

  void forgetTouched() {
    near_.clear();
    far_.clear();
  }

 private:
  Array<uint32_t> open_;
  Array<uint32_t> place_;
  uint32_t count_ = 0;
  RecentElements near_;
  RecentElements far_;
};

struct Found {
  uint32_t element = 0;
  uint32_t note = 0;  ///< note of the touch; 0 if it was not touched
  Way way = Way::kAny;
};

/// Codes the choice of elements, one by one. [A.9.1]
template <class Io>
class SequenceCoder {
 public:
  SequenceCoder(Io& io, SequenceModels& models, OpenElements& elements)
      : io_(io), models_(models), elements_(elements) {}

  /// Codes the next element and closes it. `expected` must be open.
  Found next(uint32_t expected, uint32_t truth) {
    Found found;
    found.way = codeWay(expected, truth);
    switch (found.way) {
      case Way::kNext: found.element = expected; break;
      case Way::kAny:
        found.element = elements_.at(
            codeUniform(io_, elements_.count(), Io::kEncoding ? elements_.placeOf(truth) : 0));
        break;
      default: codeRank(truth, found);
    }
    elements_.close(found.element);
    last_way_ = found.way;
    return found;
  }

  /// Returns an error if any of the elements referred to a place beyond the end of a list. Called
  /// after the last element.
  Status finish() const {
    if (!is_malformed_) return {};
    return fail(Error::kBadAttribute, "an order refers to an element that is not there");
  }

 private:
  Way codeWay(uint32_t expected, uint32_t truth) {
    const uint32_t last = static_cast<uint32_t>(last_way_);
    const bool is_next = io_.bit(models_.is_next[history_][last], truth == expected);
    history_ = (2 * history_ + (is_next ? 1 : 0)) & 7;
    if (is_next) return Way::kNext;
    const uint32_t hopeful = history_ != 0 ? 1 : 0;
    const RecentElements& near = elements_.recent(Way::kNear);
    const RecentElements& far = elements_.recent(Way::kFar);
    const bool is_near = Io::kEncoding && near.rankOf(truth) != near.count();
    const bool is_far = Io::kEncoding && far.rankOf(truth) != far.count();
    const uint32_t close = class_[0] < 2 ? class_[0] : 2;
    if (near.count() != 0 && io_.bit(models_.is_near[hopeful][last][close], is_near))
      return Way::kNear;
    if (far.count() != 0 && io_.bit(models_.is_far[hopeful][last], is_far)) return Way::kFar;
    return Way::kAny;
  }

  void codeRank(uint32_t truth, Found& found) {
    const uint32_t which = found.way == Way::kNear ? 0 : 1;
    const RecentElements& recent = elements_.recent(found.way);
    TreeModel<5>& model = models_.rank[which][class_[which]][last_way_ == found.way ? 1 : 0];
    uint32_t rank = codeTree(io_, model, Io::kEncoding ? recent.rankOf(truth) : 0);
    if (rank >= recent.count()) {
      rank = 0;
      is_malformed_ = true;
    }
    class_[which] = rank < 2 ? rank : (rank < 4 ? 2 : 3);
    found.element = recent.element(rank);
    found.note = recent.note(rank);
  }

  Io& io_;
  SequenceModels& models_;
  OpenElements& elements_;
  uint32_t history_ = 0;
  uint32_t class_[2] = {0, 0};
  bool is_malformed_ = false;
  Way last_way_ = Way::kAny;
};

/// The triangles of a piece in the reader's natural order: the faces, then the listed triangles.
struct TriangleTable {
  explicit TriangleTable(const Allocator& allocator) : wedges(allocator), part(allocator) {}

  Array<uint32_t> wedges;  ///< 3 per triangle
  Array<uint32_t> part;    ///< per triangle; only if there are several parts

  uint32_t count() const { return static_cast<uint32_t>(wedges.size() / 3); }
  uint32_t partOf(uint32_t triangle) const { return part.empty() ? 0 : part[triangle]; }
};

/// Packs a triangle and the corner it begins with into one number: 4 * triangle + corner.
constexpr uint32_t orderedTriangle(uint32_t triangle, uint32_t corner) {
  return 4 * triangle + corner;
}

/// Codes the order of the triangles within each part. Reads only the twins of `faces`. [A.9.2]
template <class Io>
class TriangleOrderCoder {
 public:
  TriangleOrderCoder(Io& io, OrderModels& models, FaceMesh& mesh, const TriangleTable& table)
      : io_(io),
        models_(models),
        faces_(mesh.view()),
        face_count_(mesh.face_count),
        table_(table),
        allocator_(mesh.allocator()),
        by_part_(mesh.allocator()),
        open_(mesh.allocator()) {}

  /// Fills `order` with orderedTriangle() by place, part after part. `truth` is the same (encoder).
  Status run(uint32_t part_count, const uint32_t* truth, Array<uint32_t>& order) {
    const uint32_t count = table_.count();
    if (!order.resize(count) || !open_.init(count) || !sortByPart(part_count)) return noMemory();
    SequenceCoder<Io> sequence(io_, models_.triangles, open_);
    uint32_t place = 0;
    while (place < count) {
      const uint32_t part = table_.partOf(by_part_[place]);
      uint32_t end = place;
      for (; end < count && table_.partOf(by_part_[end]) == part; ++end) open_.add(by_part_[end]);
      open_.forgetTouched();
      uint32_t cursor = place;
      for (; place < end; ++place) {
        while (!open_.isOpen(by_part_[cursor])) ++cursor;
        const Found found = sequence.next(by_part_[cursor], Io::kEncoding ? truth[place] >> 2 : 0);
        const uint32_t corner = codeCorner(found, Io::kEncoding ? truth[place] & 3 : 0);
        order[place] = orderedTriangle(found.element, corner);
        touchNeighbours(found.element, corner);
        if ((place & 0xfff) == 0 && io_.overrun()) return truncated();
      }
    }
    return sequence.finish();
  }

 private:
  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for the order"); }
  static Status truncated() {
    return fail(Error::kTruncated, "a stream ends inside the order of the triangles");
  }

  [[nodiscard]] bool sortByPart(uint32_t part_count) {
    const uint32_t count = table_.count();
    if (!by_part_.resize(count)) return false;
    if (part_count < 2) {
      for (uint32_t t = 0; t < count; ++t) by_part_[t] = t;
      return true;
    }
    Array<uint32_t> starts(allocator_);
    if (!starts.assign(size_t{part_count} + 1, 0)) return false;
    for (uint32_t t = 0; t < count; ++t) ++starts[table_.part[t] + 1];
    for (uint32_t p = 0; p < part_count; ++p) starts[p + 1] += starts[p];
    for (uint32_t t = 0; t < count; ++t) by_part_[starts[table_.part[t]]++] = t;
    return true;
  }
  uint32_t codeCorner(const Found& found, uint32_t truth) {
    BitModel* models = models_.corner[static_cast<uint32_t>(found.way)][last_corner_];
    const uint32_t target = (truth + 3 - found.note) % 3;
    uint32_t turn = 0;
    if (io_.bit(models[0], target != 0)) turn = io_.bit(models[1], target == 2) ? 2 : 1;
    last_corner_ = turn;
    return (found.note + turn) % 3;
  }

  /// Triangles across the edges are near, those across their edges are far. They are touched from
  /// the first corner on, so that the one across the last edge ends up in front.
  void touchNeighbours(uint32_t triangle, uint32_t corner) {
    if (triangle >= face_count_) return;
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t twin = faces_.twin(triangle * kFaceWords + (corner + i) % 3);
      if (twin == kNone || !open_.isOpen(faceOf(twin))) continue;
      for (const uint32_t beyond : {nextHalfEdge(twin), prevHalfEdge(twin)}) {
        const uint32_t t = faces_.twin(beyond);
        if (t != kNone) open_.touchFar(faceOf(t), t % kFaceWords);
      }
      open_.touchNear(faceOf(twin), twin % kFaceWords);
    }
  }

  Io& io_;
  OrderModels& models_;
  const FaceView faces_;
  const uint32_t face_count_;
  const TriangleTable& table_;
  const Allocator allocator_;
  Array<uint32_t> by_part_;  ///< triangles, part after part
  OpenElements open_;
  uint32_t last_corner_ = 0;
};

/// Codes the order of the wedges. [A.9.3]
template <class Io>
class WedgeOrderCoder {
 public:
  WedgeOrderCoder(Io& io, OrderModels& models, const TriangleTable& table,
                  const Allocator& allocator)
      : io_(io),
        models_(models),
        table_(table),
        starts_(allocator),
        corners_(allocator),
        expected_(allocator),
        open_(allocator) {}

  /// Fills `order` with the wedge at each place. `triangle_order`, if not empty, gives the order of
  /// first use.
  Status run(uint32_t wedge_count, const Array<uint32_t>& triangle_order, const uint32_t* truth,
             Array<uint32_t>& order) {
    if (!order.resize(wedge_count) || !open_.init(wedge_count) || !findCorners(wedge_count) ||
        !expectFirstUse(wedge_count, triangle_order)) {
      return fail(Error::kOutOfMemory, "no memory for the order");
    }
    SequenceCoder<Io> sequence(io_, models_.wedges, open_);
    uint32_t cursor = 0;
    for (uint32_t place = 0; place < wedge_count; ++place) {
      while (!open_.isOpen(expected_[cursor])) ++cursor;
      const Found found = sequence.next(expected_[cursor], Io::kEncoding ? truth[place] : 0);
      order[place] = found.element;
      touchNeighbours(found.element);
      if ((place & 0xfff) == 0 && io_.overrun()) {
        return fail(Error::kTruncated, "a stream ends inside the order of the vertices");
      }
    }
    return sequence.finish();
  }

 private:
  /// Lists the corners of every wedge.
  [[nodiscard]] bool findCorners(uint32_t wedge_count) {
    if (!starts_.assign(size_t{wedge_count} + 2, 0) || !corners_.resize(table_.wedges.size()))
      return false;
    for (size_t c = 0; c < table_.wedges.size(); ++c) ++starts_[table_.wedges[c] + 2];
    for (uint32_t w = 0; w < wedge_count; ++w) starts_[w + 1] += starts_[w];
    for (size_t c = 0; c < table_.wedges.size(); ++c) {
      corners_[starts_[table_.wedges[c] + 1]++] = static_cast<uint32_t>(c);
    }
    return true;
  }

  [[nodiscard]] bool expectFirstUse(uint32_t wedge_count, const Array<uint32_t>& triangle_order) {
    if (!expected_.resize(wedge_count)) return false;
    for (const uint32_t* t = triangle_order.data();
         t != triangle_order.data() + triangle_order.size(); ++t) {
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t wedge = table_.wedges[3 * size_t{*t >> 2} + ((*t & 3) + i) % 3];
        if (!open_.isOpen(wedge)) add(wedge);
      }
    }
    for (uint32_t w = 0; w < wedge_count; ++w) {
      if (!open_.isOpen(w)) add(w);
    }
    return true;
  }
  void add(uint32_t wedge) {
    expected_[open_.count()] = wedge;
    open_.add(wedge);
  }

  /// Wedges that would complete a triangle are near; those of triangles with two open corners are
  /// far.
  void touchNeighbours(uint32_t wedge) {
    const uint32_t begin = starts_[wedge];
    const uint32_t end = starts_[wedge + 1];
    const uint32_t last = end - begin > kMostTriangles ? begin + kMostTriangles : end;
    for (uint32_t i = begin; i < last; ++i) {
      const uint32_t c = corners_[i];
      const uint32_t k = c % 3;
      const uint32_t a = table_.wedges[c - k + (k + 1) % 3];
      const uint32_t b = table_.wedges[c - k + (k + 2) % 3];
      if (open_.isOpen(a) && open_.isOpen(b)) {
        open_.touchFar(b, 0);
        open_.touchFar(a, 0);
      } else {
        open_.touchNear(b, 0);
        open_.touchNear(a, 0);
      }
    }
  }

  static constexpr uint32_t kMostTriangles = 32;  ///< limit of triangles searched per wedge

  Io& io_;
  OrderModels& models_;
  const TriangleTable& table_;
  Array<uint32_t> starts_;  ///< by wedge, offsets into corners_
  Array<uint32_t> corners_;
  Array<uint32_t> expected_;
  OpenElements open_;
};

}  // namespace mcc

#endif  // MCC_SURFACE_ORDER_H_
