// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Names for the ways attributes are coded.
#ifndef MCC_GLTF_INSPECT_CODING_NAMES_H_
#define MCC_GLTF_INSPECT_CODING_NAMES_H_

#include <cstdint>
#include <string>

#include "mcc/reader.h"

namespace mcc::gltf {

/// Describes the predictor byte of attribute `index` of a piece in the specification's words:
/// "fitted, sheared". Empty for an alias.
std::string predictorName(const AttributeInfo* attributes, uint32_t count, uint32_t index);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_INSPECT_CODING_NAMES_H_
