// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Search for the grid of exact floats.
#ifndef MCC_EXACT_ENC_GRID_H_
#define MCC_EXACT_ENC_GRID_H_

#include <cstdint>
#include <span>

#include "mcc/reader.h"

namespace mcc {

/// Sets coding, bits, grid and tails of `info` if the values, as ordered integers, are all finite
/// and fit a grid; returns whether they do. The grid is the one that leaves the least to code per
/// value.
bool findExactGrid(std::span<const int32_t> ordered, AttributeInfo& info);

}  // namespace mcc

#endif  // MCC_EXACT_ENC_GRID_H_
