// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_PREPARE_ENC_BLOCKS_H_
#define MCC_PREPARE_ENC_BLOCKS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "base/enc_jobs.h"

namespace mcc {

/// A surface divided into blocks.
struct BlockCut {
  std::vector<uint32_t> triangles;    ///< of block after block, ascending in each
  std::vector<uint32_t> block_begin;  ///< where each block begins in `triangles`, and the end

  uint32_t blockCount() const { return static_cast<uint32_t>(block_begin.size()) - 1; }
  std::span<const uint32_t> trianglesOf(uint32_t block) const {
    return std::span(triangles).subspan(block_begin[block],
                                        block_begin[block + 1] - block_begin[block]);
  }
};

/// Divides triangles into compact blocks of about `block_triangles`, by planes across the longest
/// side of what is divided. The first block is smaller, because all others wait for it. Then
/// triangles that stick out of their block join the one around them, so that borders are short.
/// centroid_sums  3 per triangle, finite: the sum of its corners
/// corner_class   3 position classes per triangle, below class_count
/// Takes O(n log blocks). The result does not depend on the number of threads.
BlockCut cutIntoBlocks(std::span<const float> centroid_sums, std::span<const uint32_t> corner_class,
                       uint32_t class_count, uint32_t block_triangles, const Jobs& jobs);

}  // namespace mcc

#endif  // MCC_PREPARE_ENC_BLOCKS_H_
