// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_PREPARE_ENC_TRIANGLES_H_
#define MCC_PREPARE_ENC_TRIANGLES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "mcc/writer.h"

namespace mcc {

/// The triangles of all parts, sorted into those that make the surface and those that are coded
/// apart from it.
struct SortedTriangles {
  /// 3 per proper triangle: three different wedges, each triple once per part.
  std::vector<uint32_t> wedges;
  std::vector<uint32_t> part;  ///< per proper triangle
  /// Repeats of a proper triangle, which each entry names: the same wedges up to rotation, in the
  /// same part.
  std::vector<uint32_t> duplicates;
  struct Listed {
    uint32_t wedge[3];
    uint32_t part;
  };
  std::vector<Listed> listed;      ///< triangles that have a wedge twice
  std::vector<uint32_t> isolated;  ///< wedges in no proper triangle, ascending
};

/// Sorts the triangles. Takes linear time on average.
SortedTriangles sortTriangles(std::span<const PartView> parts, uint32_t wedge_count);

}  // namespace mcc

#endif  // MCC_PREPARE_ENC_TRIANGLES_H_
