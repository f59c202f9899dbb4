// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which values of an attribute's header byte `predictor` the encoder tries, and in which order.
#ifndef MCC_WRITER_PREDICTOR_SEARCH_H_
#define MCC_WRITER_PREDICTOR_SEARCH_H_

#include <cstdint>
#include <vector>

#include "format/predictors.h"

namespace mcc {

/// Coordinate descent: field after field of the method's byte, the best value of each is kept.
class PredictorSearch {
 public:
  /// Leaves the fields of the features in `without` at their initial values.
  PredictorSearch(AttributeMethod method, bool has_seams, const FeatureSet& without)
      : best_(infoOf(method).start) {
    for (const PredictorField& field : infoOf(method)) {
      const bool is_off = field.mask == kHasEqualities && !has_seams;
      if (is_off || without.has(field.feature)) {
        if (field.mask == kHasEqualities) best_ = field.with(best_, 0);
        continue;
      }
      for (uint32_t value = 0; value < field.value_count; ++value) {
        // The first value has been tried already, in the best combination of all fields so far.
        if (value != field.valueOf(best_)) steps_.push_back({field.mask, field.with(0, value)});
      }
    }
  }

  /// Returns whether there is nothing to choose.
  bool isSettled() const { return steps_.empty(); }
  bool done() const { return has_first_ && step_ == steps_.size(); }
  uint8_t candidate() const { return has_first_ ? changed() : best_; }
  void report(uint64_t cost) {
    if (cost < best_cost_) {
      best_ = candidate();
      best_cost_ = cost;
    }
    if (has_first_) ++step_;
    has_first_ = true;
    while (!done() && changed() == best_) ++step_;
  }
  uint8_t best() const { return best_; }

 private:
  struct Step {
    uint8_t mask;
    uint8_t bits;
  };

  uint8_t changed() const {
    return static_cast<uint8_t>((best_ & ~steps_[step_].mask) | steps_[step_].bits);
  }

  std::vector<Step> steps_;
  size_t step_ = 0;
  bool has_first_ = false;
  uint8_t best_ = 0;
  uint64_t best_cost_ = ~uint64_t{0};
};

}  // namespace mcc

#endif  // MCC_WRITER_PREDICTOR_SEARCH_H_
