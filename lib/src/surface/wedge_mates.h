// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The wedges at the mates of a wedge's vertex. [A.10.20]
#ifndef MCC_SURFACE_WEDGE_MATES_H_
#define MCC_SURFACE_WEDGE_MATES_H_

#include <cstdint>

#include "base/memory.h"
#include "mcc/status.h"
#include "mesh/turn.h"
#include "mesh/vertex_mates.h"
#include "surface/wedges.h"

namespace mcc {

class WedgeMates {
 public:
  explicit WedgeMates(const Allocator& allocator) : first_(allocator) {}

  /// Borrows both. `vertex_count`: vertices of the surface.
  Status build(const WedgeMesh& wedges, const VertexMates& mates, uint32_t vertex_count) {
    wedges_ = &wedges;
    mates_ = &mates;
    if (!wedges.hasSeams()) return {};
    if (!first_.assign(vertex_count, kNone))
      return fail(Error::kOutOfMemory, "no memory for attributes");
    for (uint32_t w = wedges.surface_count; w-- != 0;) first_[wedges.vertexOf(w)] = w;
    return {};
  }
  bool empty() const { return mates_ == nullptr; }

  /// Calls visit(turn, other) for the wedges of the vertices that are mates of w's, turned: at most
  /// the first four of each, until it returns false.
  template <class Visit>
  void forMates(uint32_t w, Visit visit) const {
    if (w >= wedges_->surface_count) return;
    const uint32_t vertex = wedges_->vertexOf(w);
    for (uint32_t m = 0; m < mates_->slotCount(); ++m) {
      const uint32_t mate = mates_->mateOf(m, vertex);
      if (mate == kNone || mate == vertex) continue;
      const Turn turn =
          m < mates_->mirror_count ? Turn{1} << mates_->axis[m] : mates_->turnOf(vertex);
      uint32_t other = wedges_->hasSeams() ? first_[mate] : mate;
      for (uint32_t i = 0; i < kMostWedges && other < wedges_->surface_count; ++i, ++other) {
        if (!visit(turn, other)) return;
        if (!wedges_->continuesVertex(other + 1)) break;
      }
    }
  }

 private:
  static constexpr uint32_t kMostWedges = 4;

  const WedgeMesh* wedges_ = nullptr;
  const VertexMates* mates_ = nullptr;
  Array<uint32_t> first_;  ///< wedge of each vertex, only with seams
};

}  // namespace mcc

#endif  // MCC_SURFACE_WEDGE_MATES_H_
