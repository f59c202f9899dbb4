// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_BENCH_MEASURE_LOAD_H_
#define MCC_TOOLS_BENCH_MEASURE_LOAD_H_

#include <cstdint>
#include <filesystem>
#include <span>

#include "foreign/foreign_mesh.h"
#include "mcc/glb.h"

namespace mcc::bench {

/// Loading a whole GLB with tinygltf, the least of all runs: CPU seconds of loads with one thread,
/// and by the clock on the wall how long decoding takes.
struct LoadFigures {
  bool is_measured = false;
  double mcc = 0;       ///< our file, with our adapter
  double draco_0 = 0;   ///< Draco's file of its smallest speed, with tinygltf's own Draco path
  double draco_5 = 0;   ///< of glTF-Transform's default speed
  double decode_1 = 0;  ///< decoding of our file with one thread
  double decode_2 = 0;  ///< with two threads
  uint64_t payload_count = 0;  ///< what two threads can share
};

/// Makes our file and Draco's from a model, and loads them in turn.
foreign::Outcome measureLoad(const std::filesystem::path& path, std::span<const uint8_t> file,
                             const gltf::ConvertOptions& options, uint32_t run_count,
                             LoadFigures& figures);

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_MEASURE_LOAD_H_
