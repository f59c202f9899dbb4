// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What blocks cost and gain: bytes, times with one and two threads, working memory.
#ifndef MCC_TOOLS_BENCH_MEASURE_BLOCKS_H_
#define MCC_TOOLS_BENCH_MEASURE_BLOCKS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/geometry.h"
#include "foreign/foreign_mesh.h"

namespace mcc::bench {

inline constexpr uint32_t kMostThreads = 2;

/// What was measured with blocks of one size. Times are the least seconds that passed.
struct BlocksFigures {
  uint32_t block_triangles = 0;  ///< 0: no blocks
  uint32_t block_count = 0;      ///< 0: coded as wholes
  uint64_t bytes = 0;
  double encode_seconds[kMostThreads] = {};  ///< [threads - 1]
  double decode_seconds[kMostThreads] = {};
  uint64_t peak_bytes[kMostThreads] = {};  ///< working memory of decoding, above the arrays
};

struct BlocksOfFile {
  std::string name;
  uint64_t triangle_count = 0;
  uint64_t array_bytes = 0;         ///< of what is decoded
  double draco_decode_seconds = 0;  ///< of Draco's speed 5, on one thread
  std::vector<BlocksFigures> sizes;
};

/// Measures a file with blocks of each of the sizes. Encoding is run twice, decoding `run_count`
/// times.
foreign::Outcome measureBlocks(const std::string& name, const Geometry& geometry,
                               const std::vector<uint32_t>& sizes, uint32_t run_count,
                               const std::function<void(const std::string&)>& progress,
                               BlocksOfFile& figures);

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_MEASURE_BLOCKS_H_
