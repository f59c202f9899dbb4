// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Values that are those of a mate: normals mirrored, texture coordinates as they are. [A.10.20]
#ifndef MCC_VALUES_MATE_VALUES_H_
#define MCC_VALUES_MATE_VALUES_H_

#include <algorithm>
#include <cstdint>

#include "entropy/models.h"
#include "surface/wedge_mates.h"
#include "values/attribute_job.h"

namespace mcc {

inline constexpr uint32_t kMostAskedMates = 3;

struct MateModels {
  BitModel same[kMostAskedMates][4];  ///< [asked before][last two answers]
};

/// Codes whether the two integers of a bundle are those of a mate.
template <class Io>
class MateValues {
 public:
  /// `mates` is null if the predictor does not ask for them.
  MateValues(const AttributeJob<Io>& job, MateModels& models, const WedgeMates* mates)
      : job_(job), models_(models), mates_(mates) {}

  /// Returns whether the value of bundle `w` is that of a mate; then it is in place.
  /// image(turn, value, to) computes what a value is, turned.
  template <class Image>
  bool code(uint32_t w, Image image) {
    if (mates_ == nullptr) return false;
    int32_t* const value = job_.values + 2 * size_t{w};
    int32_t asked[kMostAskedMates][2];
    uint32_t count = 0;
    bool is_known = false;
    mates_->forMates(w, [&](uint32_t turn, uint32_t other) {
      if (!job_.isCoded(other)) return true;
      int32_t* const it = asked[count];
      image(turn, job_.values + 2 * size_t{other}, it);
      for (uint32_t i = 0; i < count; ++i) {
        if (asked[i][0] == it[0] && asked[i][1] == it[1]) return true;
      }
      const bool truth = Io::kEncoding && value[0] == it[0] && value[1] == it[1];
      is_known = job_.io.bit(models_.same[count][answers_], truth);
      answers_ = (2 * answers_ + (is_known ? 1 : 0)) & 3;
      if (is_known) std::copy_n(it, 2, value);
      return !is_known && ++count < kMostAskedMates;
    });
    return is_known;
  }

 private:
  const AttributeJob<Io> job_;
  MateModels& models_;
  const WedgeMates* const mates_;
  uint32_t answers_ = 0;
};

}  // namespace mcc

#endif  // MCC_VALUES_MATE_VALUES_H_
