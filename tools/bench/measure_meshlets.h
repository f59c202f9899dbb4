// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// How good the meshlets of decoded triangles are, and what they take, beside meshoptimizer's.
#ifndef MCC_TOOLS_BENCH_MEASURE_MESHLETS_H_
#define MCC_TOOLS_BENCH_MEASURE_MESHLETS_H_

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "bench/geometry.h"
#include "foreign/meshlets.h"

namespace mcc::bench {

/// Who makes meshlets: MeshletShape::kRound, kInOrder, and meshopt_buildMeshlets().
enum class MeshletMaker : uint8_t { kRound, kInOrder, kMeshopt };
inline constexpr size_t kMeshletMakerCount = 3;

/// The meshlets of one maker. The time is the least CPU seconds of all runs, with taking the
/// arrays.
struct MeshletsMade {
  foreign::MeshletFigures figures;
  double seconds = 0;
};

struct MeshletsOfFile {
  std::string name;
  uint64_t triangle_count = 0;
  double indices_seconds = 0;  ///< decoding payloads that hold the triangles alone
  double decode_seconds = 0;   ///< decoding with all attributes
  std::array<MeshletsMade, kMeshletMakerCount> makers;

  const MeshletsMade& of(MeshletMaker maker) const { return makers[static_cast<size_t>(maker)]; }
};

/// Measures a file: all makers get the triangles of each primitive as our decoder returns them,
/// with at most 64 vertices and 124 triangles in a meshlet. Everything is run `run_count` times in
/// turn, on one thread. Fails as encoding and decoding do.
foreign::Outcome measureMeshlets(const std::string& name, const Geometry& geometry,
                                 uint32_t run_count,
                                 const std::function<void(const std::string&)>& progress,
                                 MeshletsOfFile& figures);

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_MEASURE_MESHLETS_H_
