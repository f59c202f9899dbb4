// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds and drops vertices that no triangle uses.
#ifndef MCC_GLTF_COMPRESS_UNUSED_H_
#define MCC_GLTF_COMPRESS_UNUSED_H_

#include <string>
#include <vector>

#include "gltf/compress/plan.h"

namespace mcc::gltf {

/// Notes how many vertices of each mesh no triangle uses. With options.drop_unused they are removed
/// from the pieces, except where something may refer to vertices by number. Linear in the vertices
/// and triangles.
void planUnused(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                std::vector<std::string>& notes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_UNUSED_H_
