// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which values of an attribute's header byte `predictor` the encoder tries, and in which order.
#ifndef MCC_VECTORS_ENC_PREDICTOR_SEARCH_H_
#define MCC_VECTORS_ENC_PREDICTOR_SEARCH_H_

#include <cstdint>
#include <vector>

#include "format/enc_features.h"
#include "format/methods.h"
#include "vectors/normals.h"

namespace mcc {

/// Coordinate descent: field after field of the method's byte, the best value of each is kept.
class PredictorSearch {
 public:
  /// Without some features, whose fields stay as they are at first.
  PredictorSearch(AttributeMethod method, bool has_seams, const FeatureSet& without) {
    if (method == AttributeMethod::kNormal || method == AttributeMethod::kExactNormal) {
      best_ = static_cast<uint8_t>(NormalWeight::kAngle);
    }
    for (const PredictorField& field : fieldsOf(method)) {
      if (isOff(method, field.mask, without)) continue;
      for (uint32_t value = 0; value < field.value_count; ++value) {
        steps_.push_back({field.mask, field.with(0, value)});
      }
    }
    if (!has_seams || without.has(Feature::kEqualities)) return;
    best_ |= kHasEqualities;
    steps_.push_back({kHasEqualities, 0});
  }

  /// Whether there is nothing to choose.
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

  static bool isOff(AttributeMethod method, uint8_t mask, const FeatureSet& without) {
    const auto has = [&](Feature feature, uint8_t field) {
      return without.has(feature) && mask == field;
    };
    switch (method) {
      case AttributeMethod::kValues: return has(Feature::kValueFlags, value_method::kFlags);
      case AttributeMethod::kTexcoord:
        return has(Feature::kTexcoordHinge, texcoord_method::kHinge) ||
               has(Feature::kMemory, texcoord_method::kRemembers);
      case AttributeMethod::kNormal:
      case AttributeMethod::kExactNormal:
        return has(Feature::kNormalWeights, normal_method::kWeightMask) ||
               has(Feature::kNormalBlend, normal_method::kBlend) ||
               (method == AttributeMethod::kExactNormal &&
                has(Feature::kMemory, exact_normal_method::kRemembers));
      case AttributeMethod::kExactTangent:
        return has(Feature::kPerpendicular, exact_tangent_method::kPerpendicular);
      default: return false;
    }
  }
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

#endif  // MCC_VECTORS_ENC_PREDICTOR_SEARCH_H_
