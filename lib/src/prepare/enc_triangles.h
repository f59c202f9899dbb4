// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_PREPARE_ENC_TRIANGLES_H_
#define MCC_PREPARE_ENC_TRIANGLES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "mcc/writer.h"

namespace mcc {

/// The triangles of all parts, sorted into those that make the surface and those beside it.
struct SortedTriangles {
  std::vector<uint32_t>
      wedges;  ///< 3 per proper triangle: three different wedges, each triple once per part
  std::vector<uint32_t> part;  ///< per proper triangle
  std::vector<uint32_t>
      duplicates;  ///< a proper triangle each: same wedges up to rotation, same part
  struct Listed {
    uint32_t wedge[3];
    uint32_t part;
  };
  std::vector<Listed> listed;      ///< triangles with a wedge twice
  std::vector<uint32_t> isolated;  ///< wedges in no proper triangle, ascending
};

/// Linear time, expected.
SortedTriangles sortTriangles(std::span<const PartView> parts, uint32_t wedge_count);

}  // namespace mcc

#endif  // MCC_PREPARE_ENC_TRIANGLES_H_
