// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Codes which wedges of a vertex have the same value of an attribute. [A.10.3]
//
// For every wedge except the first of a vertex, in coding order: is it equal to the wedge before?
// If not, is it equal to the first wedge of the vertex? (Umbrellas are closed, so the last wedge
// may continue the first.)
#ifndef MCC_SURFACE_EQUALITY_H_
#define MCC_SURFACE_EQUALITY_H_

#include <cstdint>
#include <cstring>

#include "entropy/models.h"
#include "surface/creases.h"
#include "surface/wedges.h"

namespace mcc {

struct EqualityModels {
  /// [other end of the seam][previous answer at this vertex: none, no, yes][crease]
  BitModel previous[4][3][kCreaseClasses];
  BitModel first[4];  ///< [other end of the seam]
};

template <class Io>
class EqualityCoder {
 public:
  /// `truth` has `components` values per wedge (encoder).
  EqualityCoder(Io& io, EqualityModels& models, const WedgeMesh& wedges, const int32_t* truth,
                uint32_t components)
      : io_(io), models_(models), wedges_(wedges), truth_(truth), components_(components) {}

  Status run(EqualGroups& groups) {
    if (!groups.first.resize(wedges_.count) || !groups.next.assign(wedges_.count, kNone)) {
      return fail(Error::kOutOfMemory, "no memory for attributes");
    }
    uint32_t vertex_first = 0;
    uint32_t last_like_first = 0;  // the last of the vertex's wedges that equals its first
    uint32_t answer_before = 0;
    typename Io::CodesBurst codes(io_);
    for (uint32_t w = 0; w < wedges_.count; ++w) {
      groups.first[w] = w;
      if (w >= wedges_.coded_count || !wedges_.continuesVertex(w)) {
        vertex_first = last_like_first = w;
        answer_before = 0;
        continue;
      }
      const uint32_t other_end = otherEnd(groups, w);
      const uint32_t crease = creaseClass(wedges_.faces, wedges_.startOf(w));
      const bool equal =
          codes.bit(models_.previous[other_end][answer_before][crease], isEqual(w - 1, w));
      answer_before = equal ? 2 : 1;
      if (equal) {
        join(groups, w - 1, w);
      } else if (groups.first[w - 1] != vertex_first &&
                 codes.bit(models_.first[other_end], isEqual(vertex_first, w))) {
        join(groups, last_like_first, w);
      }
      if (groups.first[w] == vertex_first) last_like_first = w;
    }
    codes.giveBack(io_);
    return {};
  }

 private:
  bool isEqual(uint32_t a, uint32_t b) const {
    if constexpr (!Io::kEncoding) return false;
    return std::memcmp(truth_ + size_t{a} * components_, truth_ + size_t{b} * components_,
                       4 * size_t{components_}) == 0;
  }

  /// Appends w to a group, after its last wedge so far.
  void join(EqualGroups& groups, uint32_t last, uint32_t w) const {
    groups.first[w] = groups.first[last];
    groups.next[last] = w;
  }

  /// Returns how the wedges on both sides of the seam before w relate at its other end: 0 not coded
  /// yet, 1 the same wedge, 2 equal, 3 different.
  uint32_t otherEnd(const EqualGroups& groups, uint32_t w) const {
    const uint32_t h = wedges_.startOf(w);
    const uint32_t t = wedges_.faces.twin(h);
    if (t == kNone) return 0;
    const uint32_t a = wedges_.faces.vertex(nextHalfEdge(h));
    const uint32_t b = wedges_.faces.vertex(t);
    if (a >= w || b >= w) return 0;
    if (a == b) return 1;
    return groups.first[a] == groups.first[b] ? 2 : 3;
  }

  Io& io_;
  EqualityModels& models_;
  const WedgeMesh& wedges_;
  const int32_t* const truth_;
  const uint32_t components_;
};

}  // namespace mcc

#endif  // MCC_SURFACE_EQUALITY_H_
