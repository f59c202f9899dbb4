// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tangents that are equal to one seen before: to that of another corner of the face, as exporters
// write them which compute a tangent per face, or to the last one beside the same normal, as they
// do where charts have no direction. [A.10.19]
#ifndef MCC_VECTORS_TANGENT_REPEATS_H_
#define MCC_VECTORS_TANGENT_REPEATS_H_

#include <algorithm>
#include <cstdint>

#include "format/predictors.h"
#include "values/attribute_job.h"

namespace mcc {

struct TangentRepeatModels {
  BitModel same[2][2][4];  ///< [candidate][whether the chart has a direction][last two answers]
};

/// Codes whether a bundle's tangent is that of a candidate. `kWords`: integers per wedge.
template <class Io, uint32_t kWords>
class TangentRepeats {
 public:
  /// `normals` are grid points, 2 per wedge; null if the piece has none.
  TangentRepeats(const AttributeJob<Io>& job, TangentRepeatModels& models, const int32_t* normals)
      : job_(job),
        models_(models),
        is_on_((job.info.predictor & tangent_method::kRepeats) != 0),
        normals_(normals) {
    if (is_on_) std::fill_n(latest_, kSlots, kNone);
  }

  /// Returns whether the tangent of bundle `w` is a candidate's; then it has that value.
  bool code(uint32_t w, bool has_direction) {
    if (!is_on_) return false;
    uint32_t& latest = latest_[slotOf(w)];
    const uint32_t beside = latest;
    latest = w;
    const uint32_t near = job_.neighbourAlongRun(w);
    if (near != kNone && isSame(0, w, near, has_direction)) return true;
    if (beside == kNone || !isBesideSameNormal(w, beside)) return false;
    if (near != kNone && std::equal(at(near), at(near) + kWords, at(beside))) return false;
    return isSame(1, w, beside, has_direction);
  }

 private:
  static constexpr uint32_t kSlots = 256;

  int32_t* at(uint32_t w) const { return job_.values + kWords * size_t{w}; }
  uint32_t slotOf(uint32_t w) const {
    if (normals_ == nullptr) return 0;
    const int32_t* n = normals_ + 2 * size_t{w};
    return (static_cast<uint32_t>(n[0]) + 37 * static_cast<uint32_t>(n[1])) % kSlots;
  }
  bool isBesideSameNormal(uint32_t a, uint32_t b) const {
    return normals_ == nullptr || std::equal(normals_ + 2 * size_t{a}, normals_ + 2 * size_t{a} + 2,
                                             normals_ + 2 * size_t{b});
  }
  bool isSame(uint32_t candidate, uint32_t w, uint32_t other, bool has_direction) {
    uint32_t& answers = answers_[candidate];
    const bool truth = Io::kEncoding && std::equal(at(w), at(w) + kWords, at(other));
    const bool same = job_.io.bit(models_.same[candidate][has_direction ? 1 : 0][answers], truth);
    answers = (2 * answers + (same ? 1 : 0)) & 3;
    if (!same) return false;
    std::copy_n(at(other), kWords, at(w));
    job_.lengths[w] = 0;
    return true;
  }

  const AttributeJob<Io> job_;
  TangentRepeatModels& models_;
  const bool is_on_;
  const int32_t* const normals_;
  uint32_t answers_[2] = {};
  uint32_t latest_[kSlots];  ///< the bundle that came last, by its normal
};

}  // namespace mcc

#endif  // MCC_VECTORS_TANGENT_REPEATS_H_
