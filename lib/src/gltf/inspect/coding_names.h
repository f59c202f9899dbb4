// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Names for the ways attributes are coded.
#ifndef MCC_GLTF_INSPECT_CODING_NAMES_H_
#define MCC_GLTF_INSPECT_CODING_NAMES_H_

#include <cstdint>
#include <string>

#include "format/methods.h"

namespace mcc::gltf {

/// Describes the predictor byte of attribute `index` of a piece in the specification's words:
/// "weights, palette". Empty for an alias.
std::string predictorName(AttributeInfos attributes, uint32_t index);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_INSPECT_CODING_NAMES_H_
