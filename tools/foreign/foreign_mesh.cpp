// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/foreign_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace mcc::foreign {
namespace {

constexpr double kDegreesPerRadian = 57.295779513082320877;

template <typename T>
double load(const std::byte* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  return static_cast<double>(value);
}

double loadComponent(const std::byte* element, ComponentType type, uint32_t component) {
  const std::byte* place = element + size_t{component} * componentBytes(type);
  switch (type) {
    case ComponentType::kInt8: return load<int8_t>(place);
    case ComponentType::kUint8: return load<uint8_t>(place);
    case ComponentType::kInt16: return load<int16_t>(place);
    case ComponentType::kUint16: return load<uint16_t>(place);
    case ComponentType::kUint32: return load<uint32_t>(place);
    case ComponentType::kInt32: return load<int32_t>(place);
    case ComponentType::kFloat32: return load<float>(place);
  }
  return 0;
}

/// atan2 keeps small angles exact where acos of a dot product loses half of the digits.
double angleDegrees(const double* a, const double* b) {
  const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                           a[0] * b[1] - a[1] * b[0]};
  const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::atan2(std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]),
                    dot) *
         kDegreesPerRadian;
}

bool hasDirection(const double* v) {
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  return std::isfinite(square) && square > 0;
}

/// Zero when both are the same value or both NaN; false when only one is NaN.
bool difference(double a, double b, double& out) {
  if (a == b || (std::isnan(a) && std::isnan(b))) {
    out = 0;
    return true;
  }
  out = std::abs(a - b);
  return !std::isnan(out);
}

}  // namespace

double readComponent(const AttributeView& view, uint32_t wedge, uint32_t component) {
  const std::byte* element =
      static_cast<const std::byte*>(view.data) + size_t{wedge} * view.stride_bytes;
  return loadComponent(element, view.format.component_type, component);
}

bool effectiveLattice(const AttributeView& view, uint32_t wedge_count, Lattice& lattice) {
  const uint32_t count = view.format.component_count;
  if (view.format.component_type != ComponentType::kFloat32 || view.quantization_bits == 0)
    return false;
  if (count > 4 || wedge_count == 0) return false;
  double low[4] = {};
  double high[4] = {};
  for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) {
    for (uint32_t c = 0; c < count; ++c) {
      const double value = readComponent(view, wedge, c);
      if (!std::isfinite(value)) return false;
      low[c] = wedge == 0 ? value : std::min(low[c], value);
      high[c] = wedge == 0 ? value : std::max(high[c], value);
    }
  }
  const double last_index = static_cast<double>((uint64_t{1} << view.quantization_bits) - 1);
  if (view.lattice != nullptr) {
    lattice = *view.lattice;
    if (!(lattice.step > 0)) lattice.step = static_cast<float>(1 / last_index);
    return true;
  }
  // The range is rounded to float32 first: Draco takes the box the same way.
  float range = 0;
  for (uint32_t c = 0; c < count; ++c) {
    lattice.origin[c] = static_cast<float>(low[c]);
    range = std::max(range, static_cast<float>(high[c]) - static_cast<float>(low[c]));
  }
  if (!std::isfinite(range)) return false;
  if (range == 0) range = 1;
  lattice.step = static_cast<float>(static_cast<double>(range) / last_index);
  return lattice.step > 0;
}

Outcome measureError(const AttributeView& source, uint32_t source_wedge_count,
                     ComponentType decoded_type, const void* decoded,
                     std::span<const uint32_t> source_wedge, AttributeError& error) {
  error = {};
  const AttributeFormat& format = source.format;
  if (decoded_type != format.component_type && decoded_type != ComponentType::kFloat32) {
    return failure("decoded attribute has another component type than its source");
  }
  const uint32_t count = format.component_count;
  if (count == 0 || count > 16) return failure("attribute has no or more than 16 components");
  error.is_angle =
      format.morph_target == 0 && ((format.semantic == Semantic::kNormal && count == 3) ||
                                   (format.semantic == Semantic::kTangent && count == 4));
  const size_t element_bytes = size_t{componentBytes(decoded_type)} * count;
  std::vector<double> errors;
  errors.reserve(source_wedge.size());
  const std::byte* element = static_cast<const std::byte*>(decoded);
  for (const uint32_t wedge : source_wedge) {
    const std::byte* here = element;
    element += element_bytes;
    if (wedge == kNone) continue;
    if (wedge >= source_wedge_count)
      return failure("decoded vertex refers to a wedge that does not exist");
    double from[16];
    double to[16];
    double largest = 0;
    bool defined = true;
    for (uint32_t c = 0; c < count; ++c) {
      from[c] = readComponent(source, wedge, c);
      to[c] = loadComponent(here, decoded_type, c);
      double distance = 0;
      defined = difference(from[c], to[c], distance) && defined;
      if (distance > largest) largest = distance;
    }
    if (error.is_angle) {
      if (count == 4 && (from[3] < 0) != (to[3] < 0)) ++error.sign_flip_count;
      const bool from_ok = hasDirection(from);
      const bool to_ok = hasDirection(to);
      if (!from_ok || !to_ok) {
        // Equal vectors have no error, whatever they are.
        if (largest == 0 && defined)
          errors.push_back(0);
        else
          ++error.undefined_count;
        continue;
      }
      errors.push_back(angleDegrees(from, to));
    } else {
      if (!defined) {
        ++error.undefined_count;
        continue;
      }
      errors.push_back(largest);
    }
    error.maximum_component = std::max(error.maximum_component, largest);
  }
  error.measured_count = static_cast<uint32_t>(errors.size());
  if (errors.empty()) return {};
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  error.median = *middle;
  error.maximum = *std::max_element(errors.begin(), errors.end());
  return {};
}

bool allFinite(const AttributeView& view, uint32_t wedge_count) {
  for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) {
    for (uint32_t c = 0; c < view.format.component_count; ++c) {
      if (!std::isfinite(readComponent(view, wedge, c))) return false;
    }
  }
  return true;
}

}  // namespace mcc::foreign
