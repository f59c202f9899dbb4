// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_MESHLETS_REPORT_H_
#define MCC_TOOL_MESHLETS_REPORT_H_

#if defined(MCC_HAS_FOREIGN)

#include <string>
#include <vector>

#include "bench/measure_meshlets.h"
#include "table.h"

namespace mcc::tool {

/// Returns what `bench --meshlets` prints: a row per file and maker of meshlets.
///
/// radius         mean of the bounding spheres, in units of the file; /meshopt: divided by the mean
///                of meshopt_buildMeshlets()
/// 1-cutoff       mean of 1 - cone_cutoff
/// ns             of CPU time per triangle: for the meshlets, for decoding the triangles alone, for
///                decoding everything
/// with meshlets  triangles and meshlets together, divided by the triangles alone
std::string meshletsReport(const std::vector<bench::MeshletsOfFile>& files, Format format);

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN

#endif  // MCC_TOOL_MESHLETS_REPORT_H_
