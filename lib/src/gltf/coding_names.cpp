// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/coding_names.h"

#include <initializer_list>

#include "container/payload_header.h"
#include "mesh/attribute_method.h"

namespace mcc::gltf {
namespace {

/// A word for a number, and words for bits that are set.
class Words {
 public:
  explicit Words(uint8_t bits) : bits_(bits) {}

  Words& number(uint8_t mask, uint32_t shift, std::initializer_list<const char*> names) {
    const uint32_t value = static_cast<uint32_t>(bits_ & mask) >> shift;
    if (value < names.size()) add(names.begin()[value]);
    return *this;
  }
  Words& bit(uint8_t mask, const char* name) {
    if ((bits_ & mask) != 0) add(name);
    return *this;
  }
  std::string text() const { return text_; }

 private:
  void add(const std::string& name) {
    if (!name.empty()) text_ += (text_.empty() ? "" : ", ") + name;
  }

  const uint8_t bits_;
  std::string text_;
};

std::string nameOfPosition(uint8_t bits) {
  return Words(bits)
      .bit(position_mode::kWeights, "weights")
      .bit(position_mode::kSelect, "tip selection")
      .bit(position_mode::kShear, "shear")
      .bit(position_mode::kPalette, "palette")
      .bit(position_mode::kPlanes, "planes")
      .bit(position_mode::kFold, "fold")
      .bit(position_mode::kOwnScale, "own scale")
      .bit(position_mode::kSplit, "split")
      .text();
}

constexpr uint8_t kWeightMask =
    0x03;  ///< of normals and tangents, whose methods have it in the same place
static_assert(normal_method::kWeightMask == kWeightMask);
static_assert(exact_normal_method::kWeightMask == kWeightMask);
static_assert(exact_normal_method::kBlendMask == normal_method::kBlendMask);

Words wordsOfNormal(uint8_t bits) {
  return Words(bits)
      .number(kWeightMask, 0, {"area", "angle", "sine", "equal"})
      .number(normal_method::kBlendMask, normal_method::kBlendShift,
              {"", "half blend", "whole blend"});
}

std::string nameOfValues(uint8_t bits, bool is_delta) {
  Words words(bits);
  words.number(value_method::kPredictorMask, 0, {"parallelograms", "mean", "diagonal", "blend"})
      .bit(value_method::kSameFlags, "same flags")
      .bit(value_method::kZeroFlags, "zero flags")
      .bit(value_method::kSmallTokens, "small tokens");
  if (is_delta) {
    words.bit(value_method::kBends, "bends").bit(value_method::kUnits, "units");
  } else {
    words.bit(value_method::kIds, "ids");
  }
  return words.text();
}

/// Attributes that are coded with another one have nothing of their own but a sum.
std::string nameOfPartner(const AttributeInfo& info) {
  if (info.coding == AttributeCoding::kAlias) return "";
  const std::string sum = Words(info.predictor)
                              .bit(skin_method::kUnitSum, "unit sum")
                              .bit(skin_method::kUsualSum, "usual sum")
                              .text();
  return sum.empty() ? "with joints" : "with joints, " + sum;
}

std::string nameOfMethod(AttributeMethod method, const AttributeInfo& info) {
  const uint8_t bits = info.predictor;
  switch (method) {
    case AttributeMethod::kValues: return nameOfValues(bits, info.format.morph_target != 0);
    case AttributeMethod::kNormal: return wordsOfNormal(bits).text();
    case AttributeMethod::kTexcoord:
      return Words(bits)
          .number(texcoord_method::kPredictorMask, 0,
                  {"diagonal", "parallelograms", "similarity", "hinge", "mixed"})
          .bit(texcoord_method::kRepeats, "repeats")
          .text();
    case AttributeMethod::kTangent: return "chart";
    case AttributeMethod::kTangentPoint:
      return (bits & tangent_point_method::kPerpendicular) != 0 ? "chart, perpendicular" : "chart";
    case AttributeMethod::kSkin:
      return Words(bits)
          .number(0, 0, {"skin"})
          .bit(skin_method::kIdleJoints, "idle joints")
          .bit(skin_method::kAscending, "ascending")
          .text();
    case AttributeMethod::kExactNormal:
      return wordsOfNormal(bits)
          .bit(exact_normal_method::kRemembers, "remembers")
          .bit(exact_normal_method::kRemembersEdges, "remembers edges")
          .text();
    case AttributeMethod::kExactTangent:
      return Words(bits)
          .number(exact_tangent_method::kWeightMask, 0, {"angle", "chart", "area", "equal"})
          .bit(exact_tangent_method::kPerpendicular, "perpendicular")
          .bit(exact_tangent_method::kRemembers, "remembers")
          .text();
    case AttributeMethod::kExactValues:
      return Words(bits)
          .number(exact_value_method::kPredictorMask, 0, {"parallelograms", "mean", "hinge"})
          .bit(exact_value_method::kRemembers, "remembers")
          .text();
    case AttributeMethod::kWithAnother: return nameOfPartner(info);
  }
  return "";
}

}  // namespace

std::string predictorName(const AttributeInfo* attributes, uint32_t count, uint32_t index) {
  if (index == 0) return nameOfPosition(attributes[0].predictor);
  const AttributeMethod method = methodOf(attributes, count, index);
  std::string name = nameOfMethod(method, attributes[index]);
  const bool has_equalities = method != AttributeMethod::kWithAnother &&
                              (attributes[index].predictor & kHasEqualities) != 0;
  return has_equalities ? name + ", equalities" : name;
}

}  // namespace mcc::gltf
