// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_BENCH_EMIT_DRACO_H_
#define MCC_TOOLS_BENCH_EMIT_DRACO_H_

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mcc/glb.h"

namespace mcc::bench {

/// Makes the same document with KHR_draco_mesh_compression (required), our lattices, at
/// one of Draco's speeds, 0 being the smallest. Every
/// triangle primitive gets a buffer view and accessors of its own; one with morph targets is coded
/// sequentially, so that the deltas, which stay ordinary accessors, keep their order. Primitives
/// that Draco cannot code stay as they are, with a note.
/// source  names the file in messages; the buffers of a .gltf are next to it.
/// file    its bytes.
/// output  a GLB.
/// Errors: the document contradicts itself. Tests: tests/cli/compare_test.cpp.
gltf::Result emitDraco(const std::filesystem::path& source, std::span<const uint8_t> file,
                       const gltf::ConvertOptions& options, std::vector<uint8_t>& output,
                       std::vector<std::string>& notes, int speed = 0);

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_EMIT_DRACO_H_
