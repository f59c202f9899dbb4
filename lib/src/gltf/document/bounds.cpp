// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mcc::gltf {

Json boundNumbers(const std::vector<double>& values, ComponentType type) {
  Json numbers = Json::array();
  for (const double value : values) {
    if (type == ComponentType::kFloat32) {
      numbers.push_back(value);
    } else {
      numbers.push_back(static_cast<int64_t>(value));
    }
  }
  return numbers;
}

Bounds boundsOf(const AccessorData& elements, ComponentType type) {
  const uint32_t bytes = componentBytes(type);
  const uint32_t component_count = elements.element_bytes / bytes;
  Bounds bounds;
  bounds.min.assign(component_count, std::numeric_limits<double>::infinity());
  bounds.max.assign(component_count, -std::numeric_limits<double>::infinity());
  for (uint64_t i = 0; i < elements.count; ++i) {
    const uint8_t* element = elements.data + i * elements.stride_bytes;
    for (uint32_t c = 0; c < component_count; ++c) {
      const double value = componentValue(element + c * bytes, type);
      if (value < bounds.min[c]) bounds.min[c] = value;
      if (value > bounds.max[c]) bounds.max[c] = value;
      if (!std::isfinite(value)) bounds.is_finite = false;
    }
  }
  return bounds;
}

Bounds boundsOf(std::span<const uint8_t> tight, ComponentType type, uint32_t component_count) {
  AccessorData elements;
  elements.element_bytes = component_count * componentBytes(type);
  elements.stride_bytes = elements.element_bytes;
  elements.count = tight.size() / elements.element_bytes;
  elements.data = tight.data();
  return boundsOf(elements, type);
}

Bounds boundsOf(std::span<const uint32_t> indices) {
  const auto [low, high] = std::minmax_element(indices.begin(), indices.end());
  return {{static_cast<double>(*low)}, {static_cast<double>(*high)}};
}

void setBounds(const Bounds& bounds, ComponentType type, bool is_required, Json& accessor) {
  if (!bounds.is_finite) return;
  if (is_required || findMember(accessor, "min") != nullptr) {
    accessor["min"] = boundNumbers(bounds.min, type);
  }
  if (is_required || findMember(accessor, "max") != nullptr) {
    accessor["max"] = boundNumbers(bounds.max, type);
  }
}

std::string boundsDifference(const Json& declared, const std::vector<double>& decoded,
                             ComponentType type) {
  if (!declared.is_array() || declared.size() != decoded.size()) {
    return "must be an array of " + std::to_string(decoded.size()) + " numbers";
  }
  for (size_t i = 0; i < decoded.size(); ++i) {
    double value = 0;
    if (!std::isfinite(decoded[i])) continue;
    if (!asNumber(declared[i], value)) return "must be an array of numbers";
    if (type == ComponentType::kFloat32) value = static_cast<float>(value);
    if (value != decoded[i]) {
      return "component " + std::to_string(i) + " is " + printJson(declared[i]) + ", but " +
             printJson(Json(decoded[i])) + " for the decoded elements";
    }
  }
  return "";
}

}  // namespace mcc::gltf
