// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Chooses bits and lattices for the float attributes of a plan.
#ifndef MCC_GLTF_COMPRESS_QUANTIZE_H_
#define MCC_GLTF_COMPRESS_QUANTIZE_H_

#include <string>
#include <vector>

#include "gltf/compress/plan.h"

namespace mcc::gltf {

/// Chooses the bits of every float attribute and, except for unit vectors, its lattice. Attributes
/// for which a lattice would be too coarse or impossible (outliers, NaN, infinity) get none and
/// stay exact, with a note.
void planQuantization(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                      std::vector<std::string>& notes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_QUANTIZE_H_
