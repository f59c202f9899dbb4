// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_FOREIGN_SIMPLIFY_H_
#define MCC_TOOLS_FOREIGN_SIMPLIFY_H_

#include <cstdint>
#include <vector>

#include "mcc/glb.h"

namespace mcc::foreign {

/// Simplifies with meshoptimizer, for ConvertOptions::simplify. Seams between vertices with the
/// same position stay, unless they keep too many triangles: then the surface is simplified as if
/// there were none. Deterministic; always succeeds. Tests: tests/foreign/simplify_test.cpp.
gltf::Result simplifyMesh(const gltf::TriangleList& list, uint64_t triangle_count,
                          std::vector<uint32_t>& simplified);

}  // namespace mcc::foreign

#endif  // MCC_TOOLS_FOREIGN_SIMPLIFY_H_
