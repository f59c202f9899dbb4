// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// `min` and `max` of accessors.
#ifndef MCC_GLTF_BOUNDS_H_
#define MCC_GLTF_BOUNDS_H_

#include <string>
#include <vector>

#include "gltf/accessors.h"
#include "gltf/json.h"

namespace mcc::gltf {

/// Smallest and largest value of each component. NaN is neither; a component without numbers has infinite ones.
struct Bounds {
  std::vector<double> min;
  std::vector<double> max;
  bool is_finite = true;  ///< no value is NaN or infinite, so that JSON can say the bounds
};

Bounds boundsOf(const AccessorData& elements, ComponentType type);
/// Of elements without padding between them.
Bounds boundsOf(std::span<const uint8_t> tight, ComponentType type, uint32_t component_count);
/// Of indices that are not empty.
Bounds boundsOf(std::span<const uint32_t> indices);

/// Writes finite bounds into an accessor: both when it must have them, else those that it has.
void setBounds(const Bounds& bounds, ComponentType type, bool is_required, Json& accessor);

/// How `min` or `max` of an accessor differs from the decoded values; empty when it does not. What JSON cannot say need not
/// be there.
std::string boundsDifference(const Json& declared, const std::vector<double>& decoded,
                             ComponentType type);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_BOUNDS_H_
