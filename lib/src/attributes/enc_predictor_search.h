// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which values of an attribute's header byte `predictor` the encoder tries, and in which order.
#ifndef MCC_ATTRIBUTES_ENC_PREDICTOR_SEARCH_H_
#define MCC_ATTRIBUTES_ENC_PREDICTOR_SEARCH_H_

#include <cstdint>
#include <vector>

#include "base/enc_features.h"
#include "mesh/attribute_method.h"

namespace mcc {

/// Coordinate descent: each step varies one field of the byte and keeps the best value so far.
class PredictorSearch {
 public:
  /// Of attribute `index` of a piece, without some features.
  PredictorSearch(const AttributeInfo* attributes, uint32_t count, uint32_t index, bool has_seams,
                  const FeatureSet& without) {
    const AttributeInfo& info = attributes[index];
    const bool is_target = info.format.morph_target != 0;
    has_seams = has_seams && !without.has(Feature::kEqualities);
    switch (methodOf(attributes, count, index)) {
      case AttributeMethod::kNormal:
        best_ = has_seams ? 1 | kHasEqualities : 1;
        steps_ = {{normal_method::kWeightMask, {1, 0, 2}},
                  {normal_method::kBlendMask,
                   {1 << normal_method::kBlendShift, 2 << normal_method::kBlendShift}}};
        break;
      case AttributeMethod::kExactNormal:
        best_ = has_seams ? kHasEqualities : 0;
        steps_ = {{exact_normal_method::kWeightMask, {0, 1, 2, 3}},
                  {exact_normal_method::kRemembers, {exact_normal_method::kRemembers}},
                  {exact_normal_method::kRemembersEdges, {exact_normal_method::kRemembersEdges}},
                  {exact_normal_method::kBlendMask,
                   {1 << exact_normal_method::kBlendShift, 2 << exact_normal_method::kBlendShift}}};
        break;
      case AttributeMethod::kExactTangent:
        best_ = has_seams ? kHasEqualities : 0;
        steps_ = {{exact_tangent_method::kWeightMask, {0, 1, 2, 3}},
                  {exact_tangent_method::kRemembers, {exact_tangent_method::kRemembers}}};
        if (exactNormalOf(attributes, count) != kNone) {
          best_ |= exact_tangent_method::kPerpendicular;
          steps_.push_back({exact_tangent_method::kPerpendicular, {0}});
        }
        break;
      case AttributeMethod::kExactValues:
        best_ = has_seams ? kHasEqualities : 0;
        steps_ = {{exact_value_method::kPredictorMask, {0, 1, 2}},
                  {exact_value_method::kRemembers, {exact_value_method::kRemembers}}};
        break;
      case AttributeMethod::kTexcoord:
        best_ = has_seams ? kHasEqualities : 0;
        steps_ = {{texcoord_method::kPredictorMask, {0, 1, 3, 2, 4}},
                  {texcoord_method::kRepeats, {texcoord_method::kRepeats}}};
        break;
      case AttributeMethod::kTangent:
        best_ = has_seams ? kHasEqualities : 0;
        steps_ = {{0, {0}}};
        break;
      case AttributeMethod::kTangentPoint:
        best_ = has_seams ? kHasEqualities : 0;
        steps_ = {{0, {0}}};
        if (hasNormals(attributes, count)) {
          steps_[0] = {tangent_point_method::kPerpendicular,
                       {tangent_point_method::kPerpendicular, 0}};
        }
        break;
      case AttributeMethod::kSkin:
        best_ = static_cast<uint8_t>(info.predictor | (has_seams ? kHasEqualities : 0));
        steps_ = {{0, {0}}};
        break;
      case AttributeMethod::kWithAnother: break;
      case AttributeMethod::kValues:
        best_ = static_cast<uint8_t>((has_seams ? kHasEqualities : 0) |
                                     (is_target ? value_method::kZeroFlags : 0));
        steps_ = {{value_method::kPredictorMask, {0, 1, 2}},
                  {value_method::kSameFlags, {value_method::kSameFlags}},
                  {value_method::kSmallTokens, {value_method::kSmallTokens}}};
        if (info.format.component_count <= value_method::kBlendComponents) {
          steps_[0].values.push_back(value_method::kBlend);
        }
        if ((knownValueBits(attributes, count, index) & value_method::kIds) != 0 && !is_target) {
          steps_.push_back({value_method::kIds | value_method::kSameFlags,
                            {value_method::kIds, value_method::kIds | value_method::kSameFlags}});
        }
        if (is_target) steps_.push_back({value_method::kZeroFlags, {0}});
        for (const uint8_t bit : {value_method::kBends, value_method::kUnits}) {
          if (is_target && (knownValueBits(attributes, count, index) & bit) != 0)
            steps_.insert(steps_.begin(), {bit, {0, bit}});
        }
        break;
    }
    if (has_seams && best_ >= kHasEqualities) steps_.push_back({kHasEqualities, {0}});
    drop(methodOf(attributes, count, index), without);
  }

  /// Whether there is nothing to choose.
  bool isSettled() const {
    return steps_.empty() || (steps_.size() == 1 && steps_[0].values.size() == 1);
  }
  bool done() const { return step_ == steps_.size(); }
  uint8_t candidate() const {
    const Step& step = steps_[step_];
    return static_cast<uint8_t>((best_ & ~step.mask) | step.values[value_]);
  }
  void report(uint64_t cost) {
    if (cost < best_cost_) {
      best_cost_ = cost;
      found_ = candidate();
    }
    if (++value_ != steps_[step_].values.size()) return;
    value_ = 0;
    ++step_;
    best_ = found_;
  }
  uint8_t best() const { return best_; }

 private:
  struct Step {
    uint8_t mask;
    std::vector<uint8_t> values;
  };

  /// The steps of a feature that is switched off go; its bits are as without it.
  void drop(AttributeMethod method, const FeatureSet& without) {
    const auto dropStep = [&](Feature feature, AttributeMethod of, uint8_t mask, uint8_t value) {
      if (method != of || !without.has(feature)) return;
      best_ = static_cast<uint8_t>((best_ & ~mask) | value);
      std::erase_if(steps_, [mask](const Step& step) { return step.mask == mask; });
      if (steps_.empty()) steps_.push_back({0, {0}});
    };
    using enum AttributeMethod;
    dropStep(Feature::kNormalWeights, kNormal, normal_method::kWeightMask, 1);
    dropStep(Feature::kNormalBlend, kNormal, normal_method::kBlendMask, 0);
    dropStep(Feature::kNormalBlend, kExactNormal, exact_normal_method::kBlendMask, 0);
    dropStep(Feature::kTexcoordHinge, kTexcoord, texcoord_method::kPredictorMask, 0);
    dropStep(Feature::kSameFlags, kValues, value_method::kSameFlags, 0);
    dropStep(Feature::kZeroFlags, kValues, value_method::kZeroFlags, 0);
    dropStep(Feature::kMemory, kExactNormal, exact_normal_method::kRemembers, 0);
    dropStep(Feature::kMemory, kExactNormal, exact_normal_method::kRemembersEdges, 0);
    dropStep(Feature::kMemory, kExactTangent, exact_tangent_method::kRemembers, 0);
    dropStep(Feature::kMemory, kExactValues, exact_value_method::kRemembers, 0);
  }

  std::vector<Step> steps_;
  size_t step_ = 0;
  size_t value_ = 0;
  uint8_t best_ = 0;  ///< of the steps done
  uint8_t found_ = 0;
  uint64_t best_cost_ = ~uint64_t{0};
};

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_ENC_PREDICTOR_SEARCH_H_
