// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The anchor of a component: a vertex of an earlier component that it repeats. [A.6.15]
#ifndef MCC_POSITIONS_ANCHOR_H_
#define MCC_POSITIONS_ANCHOR_H_

#include <bit>
#include <cstdint>

#include "entropy/models.h"
#include "mcc/status.h"
#include "mesh/face_mesh.h"
#include "positions/isometry.h"
#include "positions/record.h"

namespace mcc {

/// What a component that begins repeats: the surroundings of a vertex, turned, and moved so that
/// this vertex becomes the first of the component.
struct Anchor {
  uint32_t vertex = kNone;  ///< or none
  Turn turn = 0;
};

struct AnchorModels {
  BitModel is_named[2];  ///< [the answer before]
  BitModel is_last;
  BitModel flips[3];
  BitModel reorders;
};

/// Codes the anchors of the components of a piece but the first, one after the other. Safe for
/// untrusted input.
template <class Io>
class AnchorCoder {
 public:
  /// `models` are null in pieces without anchors.
  AnchorCoder(Io& io, AnchorModels* models, const VertexRecord* records, uint32_t vertex_count)
      : io_(io), models_(models), records_(records), vertex_count_(vertex_count) {}

  /// Codes the anchor of the component that begins with `first`, which is known. An anchor that
  /// is not is kBadAttribute.
  Status code(uint32_t first, const Anchor& truth, Anchor& anchor) {
    if (is_first_component_) {
      is_first_component_ = false;
      return {};
    }
    is_named_ = io_.bit(models_->is_named[is_named_ ? 1 : 0], truth.vertex != kNone);
    if (!is_named_) return {};
    const bool is_last = last_ != kNone && io_.bit(models_->is_last, truth.vertex == last_);
    const uint32_t bits = static_cast<uint32_t>(std::bit_width(vertex_count_ - 1));
    const uint32_t vertex = is_last ? last_ : io_.raw(bits, truth.vertex);
    if (vertex >= vertex_count_) return fail(Error::kBadAttribute, "an anchor is no vertex");
    if (vertex == first || !records_[vertex].known())
      return fail(Error::kBadAttribute, "an anchor is not known");
    Turn turn = 0;
    for (uint32_t s = 0; s < 3; ++s)
      turn |= io_.bit(models_->flips[s], (truth.turn >> s & 1) != 0) ? 1u << s : 0u;
    const uint32_t order =
        io_.bit(models_->reorders, truth.turn >= 8) ? io_.raw(3, truth.turn >> 3) : 0;
    if (order >= kOrderCount) return fail(Error::kBadAttribute, "a turn has no order of axes");
    last_ = vertex;
    anchor = {vertex, order << 3 | turn};
    return {};
  }

 private:
  Io& io_;
  AnchorModels* const models_;
  const VertexRecord* const records_;
  const uint32_t vertex_count_;
  uint32_t last_ = kNone;
  bool is_first_component_ = true;
  bool is_named_ = false;
};

}  // namespace mcc

#endif  // MCC_POSITIONS_ANCHOR_H_
