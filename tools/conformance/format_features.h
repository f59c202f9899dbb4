// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds out which features of the format a payload uses.
#ifndef MCC_TOOLS_CONFORMANCE_FORMAT_FEATURES_H_
#define MCC_TOOLS_CONFORMANCE_FORMAT_FEATURES_H_

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>

namespace mcc::conformance {

/// Features by name, each with the sections of the specification it is an example of.
using Features = std::map<std::string, std::set<std::string>>;

/// Returns the features of a payload that decodes: choices of its header, and operations of its
/// codes.
Features featuresOf(std::span<const uint8_t> payload);

/// The sections that the features stand for together, without those that every payload shows.
std::set<std::string> sectionsOf(const Features& features);

}  // namespace mcc::conformance

#endif  // MCC_TOOLS_CONFORMANCE_FORMAT_FEATURES_H_
