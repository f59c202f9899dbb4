// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which wedges of a block are wedges of the blocks before it, and how the wedges of all blocks are
// numbered. Reader and writer run the same code.                                  [A.11.3]
#ifndef MCC_MESH_RIM_H_
#define MCC_MESH_RIM_H_

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "base/memory.h"
#include "mesh/face_mesh.h"

namespace mcc {

/// A wedge that the rule of repeated wedges would get wrong.                              [A.11.1]
struct BlockException {
  uint32_t wedge = 0;
  uint32_t number = 0;  ///< in the whole piece; kNone: the wedge is not repeated
};

/// The rim wedges of a block: those on edges that have one face in the block.
struct Rim {
  explicit Rim(const Allocator& allocator) : wedges(allocator), tuples(allocator) {}

  /// Finds the rim wedges. Isolated wedges are never among them.
  [[nodiscard]] bool find(const FaceMesh& mesh, uint32_t wedge_count) {
    Array<uint8_t> is_on_rim(wedges.allocator());
    if (!is_on_rim.assign(wedge_count, 0)) return false;
    const FaceView faces{const_cast<uint32_t*>(mesh.words.data())};
    for (uint32_t f = 0; f < mesh.face_count; ++f) {
      for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
        if (faces.twin(h) != kNone) continue;
        is_on_rim[faces.vertex(h)] = is_on_rim[faces.vertex(nextHalfEdge(h))] = 1;
      }
    }
    wedges.clear();
    for (uint32_t w = 0; w < wedge_count; ++w) {
      if (is_on_rim[w] != 0 && !wedges.push_back(w)) return false;
    }
    return true;
  }

  const int32_t* tuple(size_t i) const { return tuples.data() + i * tuple_words; }

  Array<uint32_t> wedges;  ///< ascending
  Array<int32_t> tuples;   ///< tuple_words per wedge: the integers of all its attributes
  uint32_t tuple_words = 0;
};

/// The rim wedges of all blocks so far that are not repeated, found by their tuples.
///
/// Their indices are in sorted runs, the sizes of which at least halve from one to the next. So
/// finding takes O(log² n) however tuples and blocks are chosen, and adding O(log n) on average.
class RimTable {
 public:
  explicit RimTable(const Allocator& allocator)
      : tuples_(allocator),
        numbers_(allocator),
        sorted_(allocator),
        merged_(allocator),
        run_begins_(allocator) {}

  /// Returns the number of the first wedge that was added with this tuple, or kNone.
  uint32_t find(const int32_t* tuple) const {
    for (size_t run = 0; run < run_begins_.size(); ++run) {
      const uint32_t* const begin = sorted_.data() + run_begins_[run];
      const uint32_t* const end = sorted_.data() + runEnd(run);
      const uint32_t* const at =
          std::lower_bound(begin, end, tuple, [this](uint32_t entry, const int32_t* wanted) {
            return compare(tupleOf(entry), wanted) < 0;
          });
      if (at != end && compare(tupleOf(*at), tuple) == 0) return numbers_[*at];
    }
    return kNone;
  }

  /// Adds those rim wedges that `numbers`, by wedge, has and `is_entry(i)` accepts.
  template <class IsEntry>
  [[nodiscard]] bool add(const Rim& rim, const uint32_t* numbers, const IsEntry& is_entry) {
    words_ = rim.tuple_words;
    const uint32_t begin = static_cast<uint32_t>(sorted_.size());
    for (size_t i = 0; i < rim.wedges.size(); ++i) {
      if (!is_entry(i)) continue;
      const size_t words = tuples_.size();
      if (!sorted_.push_back(static_cast<uint32_t>(numbers_.size())) ||
          !numbers_.push_back(numbers[rim.wedges[i]]) || !grow(words + words_))
        return false;
      std::memcpy(tuples_.data() + words, rim.tuple(i), words_ * sizeof(int32_t));
    }
    if (begin == sorted_.size()) return true;
    std::sort(sorted_.data() + begin, sorted_.data() + sorted_.size(),
              [this](uint32_t a, uint32_t b) { return isBefore(a, b); });
    if (!run_begins_.push_back(begin)) return false;
    while (run_begins_.size() > 1) {
      const size_t last = run_begins_.size() - 1;
      if (run_begins_[last] - run_begins_[last - 1] >= 2 * (runEnd(last) - run_begins_[last]))
        break;
      if (!mergeLastRuns()) return false;
    }
    return true;
  }

 private:
  const int32_t* tupleOf(uint32_t entry) const { return tuples_.data() + size_t{entry} * words_; }
  size_t runEnd(size_t run) const {
    return run + 1 < run_begins_.size() ? run_begins_[run + 1] : sorted_.size();
  }
  [[nodiscard]] bool grow(size_t words) {
    return (words <= capacity_ || reserve(words)) && tuples_.resize(words);
  }
  [[nodiscard]] bool reserve(size_t words) {
    capacity_ = words + words / 2;
    return tuples_.reserve(capacity_);
  }

  int compare(const int32_t* a, const int32_t* b) const {
    for (uint32_t i = 0; i < words_; ++i) {
      if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    }
    return 0;
  }
  /// Equal tuples are in the order of their numbers.
  bool isBefore(uint32_t a, uint32_t b) const {
    const int order = compare(tupleOf(a), tupleOf(b));
    return order != 0 ? order < 0 : a < b;
  }

  [[nodiscard]] bool mergeLastRuns() {
    const uint32_t begin = run_begins_[run_begins_.size() - 2];
    const uint32_t middle = run_begins_.back();
    const size_t count = sorted_.size() - begin;
    if (!merged_.resize(count)) return false;
    std::merge(sorted_.data() + begin, sorted_.data() + middle, sorted_.data() + middle,
               sorted_.data() + sorted_.size(), merged_.data(),
               [this](uint32_t a, uint32_t b) { return isBefore(a, b); });
    std::copy(merged_.data(), merged_.data() + count, sorted_.data() + begin);
    run_begins_.pop_back();
    return true;
  }

  uint32_t words_ = 0;
  size_t capacity_ = 0;
  Array<int32_t> tuples_;    ///< words_ per entry
  Array<uint32_t> numbers_;  ///< by entry, ascending
  Array<uint32_t> sorted_;   ///< entries by their tuples, in runs
  Array<uint32_t> merged_;
  Array<uint32_t> run_begins_;
};

/// Numbers the wedges of a block: `numbers` receives the number of each in the whole piece.
/// Wedges that are not repeated follow one another from `first` on. `repeated_count` receives how
/// many are repeated. The exceptions ascend. Returns false when memory ran out.
[[nodiscard]] inline bool numberWedges(RimTable& table, const Rim& rim,
                                       std::span<const BlockException> exceptions, uint32_t first,
                                       uint32_t wedge_count, Array<uint32_t>& numbers,
                                       uint32_t& repeated_count) {
  if (!numbers.assign(wedge_count, kNone)) return false;
  for (size_t i = 0; i < rim.wedges.size(); ++i) numbers[rim.wedges[i]] = table.find(rim.tuple(i));
  for (const BlockException& e : exceptions) numbers[e.wedge] = e.number;
  uint32_t next = first;
  for (uint32_t w = 0; w < wedge_count; ++w) {
    if (numbers[w] == kNone) numbers[w] = next++;
  }
  repeated_count = wedge_count - (next - first);
  const BlockException* exception = exceptions.data();
  const BlockException* const end = exception + exceptions.size();
  return table.add(rim, numbers.data(), [&](size_t i) {
    const uint32_t wedge = rim.wedges[i];
    while (exception != end && exception->wedge < wedge) ++exception;
    return numbers[wedge] >= first && (exception == end || exception->wedge != wedge);
  });
}

}  // namespace mcc

#endif  // MCC_MESH_RIM_H_
