// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the names of glTF attributes mean.                                                  [A.2.4]
#include "base/crc32.h"
#include "mcc/reader.h"

namespace mcc {
namespace {

struct SemanticRule {
  std::string_view name;
  Semantic semantic;
  uint32_t min_components;
  uint32_t max_components;
  bool has_set;  ///< the name ends with a number, NAME_n
};
constexpr SemanticRule kSemanticRules[] = {
    {"POSITION", Semantic::kPosition, 3, 3, false}, {"NORMAL", Semantic::kNormal, 3, 3, false},
    {"TANGENT", Semantic::kTangent, 3, 4, false},   {"TEXCOORD_", Semantic::kTexcoord, 2, 2, true},
    {"COLOR_", Semantic::kColor, 3, 4, true},       {"JOINTS_", Semantic::kJoints, 4, 4, true},
    {"WEIGHTS_", Semantic::kWeights, 4, 4, true}};

bool parseSet(std::string_view digits, uint8_t& set) {
  if (digits.empty() || digits.size() > 3) return false;
  uint32_t number = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return false;
    number = number * 10 + static_cast<uint32_t>(c - '0');
  }
  if (number > 255 || (digits.size() > 1 && digits[0] == '0')) return false;
  set = static_cast<uint8_t>(number);
  return true;
}

bool matches(const SemanticRule& rule, std::string_view name, const AttributeFormat& type,
             uint8_t& set) {
  if (type.component_count < rule.min_components || type.component_count > rule.max_components) {
    return false;
  }
  if (rule.semantic == Semantic::kJoints && type.component_type == ComponentType::kFloat32) {
    return false;
  }
  if (!rule.has_set) return name == rule.name;
  return name.starts_with(rule.name) && parseSet(name.substr(rule.name.size()), set);
}

}  // namespace

AttributeFormat namedFormat(std::string_view name, const AttributeFormat& type, bool is_matrix) {
  AttributeFormat format = type;
  for (const SemanticRule& rule : kSemanticRules) {
    if (is_matrix || !matches(rule, name, type, format.set_index)) continue;
    format.semantic = rule.semantic;
    return format;
  }
  format.semantic = Semantic::kCustom;
  format.set_index =
      static_cast<uint8_t>(crc32({reinterpret_cast<const uint8_t*>(name.data()), name.size()}));
  return format;
}

}  // namespace mcc
