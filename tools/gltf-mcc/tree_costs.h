// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What each position of a payload costs.
#ifndef MCC_TOOL_TREE_COSTS_H_
#define MCC_TOOL_TREE_COSTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "mcc/status.h"

namespace mcc::tool {

/// Decodes the positions of a payload's first piece, and fills `bits` with how many bits each
/// vertex's position took, by the probabilities that the coders gave to its symbols. Vertices that
/// share a position across a seam share what it took. What an anchor takes counts for the vertex
/// after the one that it belongs to; tables and isolated vertices count for none. `payload` must be
/// one that decodes. Errors: it has blocks, or no positions. Safe for untrusted input. Tests:
/// tests/cli/tree_test.cpp.
Status positionCosts(std::span<const uint8_t> payload, std::vector<float>& bits);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TREE_COSTS_H_
