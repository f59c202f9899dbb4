// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_FOREIGN_TINYGLTF_LOADER_H_
#define MCC_TOOLS_FOREIGN_TINYGLTF_LOADER_H_

#include <cstdint>
#include <span>

#include "foreign/foreign_mesh.h"

namespace mcc::foreign {

/// What loading a GLB took.
struct TinygltfLoad {
  double cpu_seconds = 0;  ///< of this thread, from bytes in memory to a model with plain accessors
  double decode_seconds = 0;  ///< by the clock on the wall, of mcc::tinygltf::decode()
  uint64_t vertex_count = 0;  ///< of the POSITION accessors, to see that it is the same model
};

/// Loads a GLB with tinygltf: one of ours with our adapter, one of Draco's with tinygltf's own
/// Draco path (TINYGLTF_ENABLE_DRACO). Images are kept as they are. Fails with the loader's words.
/// Tests: tests/cli/bench_test.cpp.
Outcome loadWithTinygltf(std::span<const uint8_t> glb, uint32_t thread_count, TinygltfLoad& load);

}  // namespace mcc::foreign

#endif  // MCC_TOOLS_FOREIGN_TINYGLTF_LOADER_H_
