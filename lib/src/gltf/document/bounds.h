// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Computes and compares `min` and `max` of accessors.
#ifndef MCC_GLTF_DOCUMENT_BOUNDS_H_
#define MCC_GLTF_DOCUMENT_BOUNDS_H_

#include <string>
#include <vector>

#include "gltf/document/accessors.h"
#include "json/json.h"

namespace mcc::gltf {

/// Smallest and largest value of each component. NaN is ignored; for a component without numbers
/// they are infinite.
struct Bounds {
  std::vector<double> min;
  std::vector<double> max;
  bool is_finite = true;  ///< all values are finite, so that JSON can represent the bounds
};

Bounds boundsOf(const AccessorData& elements, ComponentType type);
/// The same for elements without padding between them.
Bounds boundsOf(std::span<const uint8_t> tight, ComponentType type, uint32_t component_count);
/// The same for indices, of which there must be at least one.
Bounds boundsOf(std::span<const uint32_t> indices);

/// Returns finite bounds as `min` and `max` of an accessor hold them: integers have no fraction.
Json boundNumbers(const std::vector<double>& values, ComponentType type);

/// Writes finite bounds into an accessor: both when `is_required`, else only those it already has.
void setBounds(const Bounds& bounds, ComponentType type, bool is_required, Json& accessor);

/// Returns how `min` or `max` of an accessor differs from the decoded values; empty when it does
/// not. Bounds that JSON cannot represent may be missing.
std::string boundsDifference(const Json& declared, const std::vector<double>& decoded,
                             ComponentType type);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_BOUNDS_H_
