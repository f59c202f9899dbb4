// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "connectivity/enc_pivots.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "mesh/enc_closed_mesh.h"

namespace mcc {
namespace {

/// Visits the faces in the order in which PivotCoder codes them.
class PivotLister {
 public:
  PivotLister(std::span<const uint32_t> corner_class, uint32_t class_count)
      : corner_class_(corner_class),
        corners_begin_(size_t{class_count} + 1, 0),
        corners_(corner_class.size()),
        classes_(class_count),
        is_done_(corner_class.size() / 3, 0) {
    for (const uint32_t c : corner_class) ++corners_begin_[c + 1];
    for (uint32_t c = 0; c < class_count; ++c) corners_begin_[c + 1] += corners_begin_[c];
    std::vector<uint32_t> fill(corners_begin_.begin(), corners_begin_.end() - 1);
    for (uint32_t h = 0; h < corner_class.size(); ++h) corners_[fill[corner_class[h]]++] = h;
  }

  PivotRecord run() {
    record_.faces.reserve(is_done_.size());
    record_.source_gate.reserve(is_done_.size());
    size_t cursor = 0;
    for (uint32_t p = 0;; ++p) {
      if (p == record_.class_of_vertex.size()) {
        while (cursor < is_done_.size() && is_done_[cursor] != 0) ++cursor;
        if (cursor == is_done_.size()) return std::move(record_);
        (void)numberOf(corner_class_[3 * cursor]);
      }
      listPivot(p);
    }
  }

 private:
  /// What is known about a position class; `spoke` and `link` are valid for one pivot only.
  struct Class {
    uint32_t number = kNone;
    uint32_t face = kNone;  ///< the latest, in known_
    uint32_t pivot = kNone;
    uint32_t spoke = kNone;
    uint32_t link = kNone;  ///< in links_: new faces with this class
  };
  struct Link {
    uint32_t item;  ///< class of the other vertex, or the corner at the pivot
    uint32_t next;
  };
  struct Entry {
    uint32_t place;
    uint32_t other_class;
    bool turned;
    uint32_t corner;
    bool operator<(const Entry& o) const {
      return std::tie(place, other_class, turned, corner) <
             std::tie(o.place, o.other_class, o.turned, o.corner);
    }
  };

  uint32_t numberOf(uint32_t c) {
    uint32_t& number = classes_[c].number;
    if (number == kNone) {
      number = static_cast<uint32_t>(record_.class_of_vertex.size());
      record_.class_of_vertex.push_back(c);
    }
    return number;
  }
  Class& atPivot(uint32_t c) {
    Class& state = classes_[c];
    if (state.pivot != pivot_) {
      state.pivot = pivot_;
      state.spoke = state.link = kNone;
    }
    return state;
  }
  void addSpoke(uint32_t c) {
    uint32_t& spoke = atPivot(c).spoke;
    if (spoke != kNone) return;
    spoke = static_cast<uint32_t>(spokes_.size());
    spokes_.push_back(c);
    (void)numberOf(c);
  }
  static void push(std::vector<Link>& links, uint32_t& head, uint32_t item) {
    links.push_back({item, head});
    head = static_cast<uint32_t>(links.size() - 1);
  }

  void listPivot(uint32_t p) {
    pivot_ = p;
    const uint32_t own = record_.class_of_vertex[p];
    spokes_.clear();
    for (uint32_t f = classes_[own].face; f != kNone; f = known_[f].next) addSpoke(known_[f].item);
    links_.clear();
    const std::span<const uint32_t> corners(corners_.data() + corners_begin_[own],
                                            corners_begin_[own + 1] - corners_begin_[own]);
    for (const uint32_t h : corners) {
      if (is_done_[h / 3] != 0) continue;
      push(links_, atPivot(corner_class_[nextCorner(h)]).link, h);
      push(links_, atPivot(corner_class_[prevCorner(h)]).link, h);
    }
    size_t row = 0;
    for (const uint32_t h : corners) {
      for (; row < spokes_.size(); ++row) listRow(static_cast<uint32_t>(row));
      if (is_done_[h / 3] == 0) addSpoke(corner_class_[nextCorner(h)]);  // begins another fan
    }
    for (; row < spokes_.size(); ++row) listRow(static_cast<uint32_t>(row));
  }

  void listRow(uint32_t row) {
    const uint32_t c = spokes_[row];
    entries_.clear();
    for (uint32_t l = atPivot(c).link; l != kNone; l = links_[l].next) {
      const uint32_t corner = links_[l].item;
      if (is_done_[corner / 3] != 0) continue;
      is_done_[corner / 3] = 1;
      const bool turned = corner_class_[nextCorner(corner)] != c;
      const uint32_t other = corner_class_[turned ? nextCorner(corner) : prevCorner(corner)];
      entries_.push_back({atPivot(other).spoke, other, turned, corner});
    }
    std::sort(entries_.begin(), entries_.end());
    for (const Entry& e : entries_) {
      const uint32_t place = atPivot(e.other_class).spoke;
      addSpoke(e.other_class);
      const uint32_t first = numberOf(c);
      const uint32_t second = numberOf(e.other_class);
      record_.faces.push_back({pivot_, row, place, first, second, e.turned});
      record_.source_gate.push_back(nextCorner(e.corner));
      const bool is_second = first < second;
      push(known_, classes_[is_second ? c : e.other_class].face, is_second ? e.other_class : c);
    }
  }

  const std::span<const uint32_t> corner_class_;
  std::vector<uint32_t> corners_begin_;  ///< by class, offsets into corners_
  std::vector<uint32_t> corners_;
  std::vector<Class> classes_;
  std::vector<uint8_t> is_done_;  ///< by source face
  /// Coded faces by their second vertex; the item is the class of the third.
  std::vector<Link> known_;
  std::vector<Link> links_;  ///< faces of the pivot that are not coded yet, by both other classes
  std::vector<uint32_t> spokes_;  ///< classes
  std::vector<Entry> entries_;
  uint32_t pivot_ = 0;
  PivotRecord record_;
};

}  // namespace

PivotRecord listByPivots(std::span<const uint32_t> corner_class, uint32_t class_count) {
  return PivotLister(corner_class, class_count).run();
}

}  // namespace mcc
