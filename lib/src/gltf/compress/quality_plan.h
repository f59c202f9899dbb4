// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Chooses bits and lattices from ConvertOptions::quality.
#ifndef MCC_GLTF_COMPRESS_QUALITY_PLAN_H_
#define MCC_GLTF_COMPRESS_QUALITY_PLAN_H_

#include <string>
#include <vector>

#include "gltf/compress/plan.h"
#include "gltf/document/document.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Does for options.quality, which is not 0, what planQuantization() does for bits: chooses those
/// of every float attribute, and lattices that keep within the errors that the quality stands for.
/// Notes say what stays exact, and which triangles lose their area. `choices` says what was chosen.
/// Takes linear time.
void planQuality(const Document& document, const ConvertOptions& options,
                 std::vector<PayloadPlan>& payloads, std::vector<std::string>& notes,
                 std::vector<QualityChoice>& choices);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_QUALITY_PLAN_H_
