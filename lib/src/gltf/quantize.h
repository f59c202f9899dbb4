// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Bits and lattices of the float attributes of a plan.
#ifndef MCC_GLTF_QUANTIZE_H_
#define MCC_GLTF_QUANTIZE_H_

#include <string>
#include <vector>

#include "gltf/plan.h"

namespace mcc::gltf {

/// Chooses for every float attribute its bits and, but for unit vectors, its lattice. Attributes that a lattice would ruin
/// (NaN, infinity, outliers) get none and stay exact; a note says which.
void planQuantization(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                      std::vector<std::string>& notes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_QUANTIZE_H_
