// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What all coders of attributes share: the data they work on, and the walk over the wedges. A coder
// predicts the value of a group of equal wedges and codes what the prediction missed; the walk
// decides which group is next, and copies its value to all members.                      [A.10.1]
#ifndef MCC_VALUES_ATTRIBUTE_JOB_H_
#define MCC_VALUES_ATTRIBUTE_JOB_H_

#include <algorithm>
#include <cstdint>

#include "base/host.h"
#include "entropy/io.h"
#include "mcc/types.h"
#include "surface/wedges.h"
#include "values/residuals.h"

namespace mcc {

inline constexpr uint8_t kNotCoded = 0xff;  ///< the length of a wedge that has no value yet

/// The corners of a face other than the one that a half-edge leaves.
struct OtherCorners {
  uint32_t n;  ///< at the end of the half-edge
  uint32_t p;
};

/// One attribute of a piece, as its coder sees it. A job owns nothing, so copies are cheap.
template <SymbolIo Io>
struct AttributeJob {
  Io& io;
  const AttributeInfo& info;
  const WedgeMesh& wedges;
  const EqualGroups& groups;  ///< every wedge is its own group if the attribute has no equalities
  const float* positions;     ///< 4 per wedge, see surface/wedges.h
  int32_t* values;            ///< as many per wedge as the method has; the encoder's are known
  uint8_t* lengths;           ///< of the wedges' residuals, as their neighbours see them
  uint32_t end;               ///< number of wedges to code, in coding order

  bool isCoded(uint32_t w) const { return lengths[w] != kNotCoded; }
  /// Returns the context of a residual between two wedges; it is long if one of them is not coded.
  uint32_t contextOf(uint32_t a, uint32_t b) const {
    return std::min((lengths[a] + lengths[b] + 1u) / 2, kLongestContext);
  }

  OtherCorners othersOf(uint32_t h) const {
    return {wedges.faces.vertex(nextHalfEdge(h)), wedges.faces.vertex(prevHalfEdge(h))};
  }
  /// Returns the half-edge that leaves the group of w in the first face that the group completes,
  /// or kNone.
  MCC_INLINE uint32_t entryFace(uint32_t w) const {
    uint32_t entry = wedges.firstCompleted(w);
    for (uint32_t m = groups.nextOf(w); m != kNone && entry == kNone; m = groups.nextOf(m)) {
      entry = wedges.firstCompleted(m);
    }
    return entry;
  }
  /// Returns a wedge next to w that is coded, for groups that complete no face; or kNone.
  uint32_t neighbourAlongRun(uint32_t w) const {
    uint32_t found = kNone;
    wedges.forRun(w, [&](uint32_t h) {
      const auto [n, p] = othersOf(h);
      found = isCoded(n) ? n : isCoded(p) ? p : kNone;
      return found == kNone;
    });
    return found;
  }
  /// Calls visit(h) with the half-edges that leave the group of w in the faces that the group
  /// completes, until it returns false.
  template <class Visit>
  MCC_INLINE void forFaces(uint32_t w, Visit visit) const {
    for (uint32_t m = w; m != kNone; m = groups.nextOf(m)) {
      for (uint32_t h = wedges.firstCompleted(m); h != kNone; h = wedges.nextCompleted(h)) {
        if (!visit(h)) return;
      }
    }
  }
};

/// What a coder looks at in every wedge: `stride` elements each, fetched ahead of their use.
template <class T>
struct Ahead {
  const T* data;
  uint32_t stride;
};

/// Calls code(w) with the first wedge of every group, in coding order. Afterwards copies its value
/// of kWords integers, and its length, to the other members of the group, and calls learn(w).
template <uint32_t kWords, class Io, class T, class Code, class Learn>
MCC_INLINE void forEachGroup(const AttributeJob<Io>& job, Ahead<T> ahead, Code code, Learn learn) {
  std::fill(job.lengths, job.lengths + job.wedges.count, kNotCoded);
  job.wedges.forCoded(job.end, ahead.data, ahead.stride, [&](uint32_t w) MCC_INLINE_LAMBDA {
    if (!job.groups.isFirst(w)) return;
    code(w);
    for (uint32_t m = job.groups.nextOf(w); m != kNone; m = job.groups.nextOf(m)) {
      const size_t words = kWords == 0 ? job.info.format.component_count : kWords;
      std::copy_n(job.values + words * w, words, job.values + words * m);
      job.lengths[m] = job.lengths[w];
    }
    learn(w);
  });
}
template <uint32_t kWords, class Io, class T, class Code>
MCC_INLINE void forEachGroup(const AttributeJob<Io>& job, Ahead<T> ahead, Code code) {
  forEachGroup<kWords>(job, ahead, code, [](uint32_t) {});
}

/// As kWords of forEachGroup(): one per component.
inline constexpr uint32_t kAllComponents = 0;

}  // namespace mcc

#endif  // MCC_VALUES_ATTRIBUTE_JOB_H_
