// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What leads a component to one that repeats it. [A.6.15]
#ifndef MCC_POSITIONS_ISOMETRY_H_
#define MCC_POSITIONS_ISOMETRY_H_

#include <cstdint>

#include "base/lanes.h"
#include "mesh/turn.h"

namespace mcc {

/// A turn and a move: x becomes turned x + move, which wraps.
class Isometry {
 public:
  Isometry() : Isometry(0) {}
  explicit Isometry(Turn turn) : from_(kAxisOrder[turn >> 3]) {
    for (uint32_t s = 0; s < 3; ++s) flip_[s] = 0u - (turn >> s & 1);
  }
  /// Moves so that `from` becomes `to`.
  void lead(const Lanes<uint32_t>& from, const Lanes<uint32_t>& to) {
    move_ = Lanes<uint32_t>{};
    move_ = to - (*this)(from);
  }
  Lanes<uint32_t> operator()(const Lanes<uint32_t>& q) const {
    const Lanes<uint32_t> turned = {q[from_[0]], q[from_[1]], q[from_[2]], 0};
    return (turned ^ flip_) - flip_ + move_;
  }
  /// The point that becomes q.
  Lanes<uint32_t> source(const Lanes<uint32_t>& q) const {
    const Lanes<uint32_t> turned = ((q - move_) ^ flip_) - flip_;
    Lanes<uint32_t> p{};
    for (uint32_t s = 0; s < 3; ++s) p[from_[s]] = turned[s];
    return p;
  }

 private:
  const uint8_t* from_;
  Lanes<uint32_t> flip_{};
  Lanes<uint32_t> move_{};
};

}  // namespace mcc

#endif  // MCC_POSITIONS_ISOMETRY_H_
