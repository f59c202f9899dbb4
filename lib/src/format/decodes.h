// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the reader is compiled with. Normally this is all of the format. The core of the decoder for
// the web (lib/web), compiled with MCC_CORE, has what most files need. It refuses other files with
// kNotInCore before anything is decoded, and the whole decoder then takes them. Code that the core
// lacks is guarded by these constants, and container/payload_header.cpp refuses payloads that need
// it.
#ifndef MCC_FORMAT_DECODES_H_
#define MCC_FORMAT_DECODES_H_

#include <cstddef>
#include <cstdint>

#include "mcc/status.h"

namespace mcc {

#if defined(MCC_CORE)
inline constexpr bool kWhole = false;
#else
inline constexpr bool kWhole = true;
#endif

namespace decodes {
inline constexpr bool kOrders = kWhole;       ///< kept orders of triangles and vertices
inline constexpr bool kExactFloats = kWhole;  ///< also exact grids
inline constexpr bool kPivots = kWhole;       ///< faces coded vertex by vertex
inline constexpr bool kIsolated = kWhole;     ///< vertices without faces
inline constexpr bool kListed = kWhole;       ///< duplicate and degenerate triangles
inline constexpr bool kPlanes = kWhole;       ///< planes of positions
inline constexpr bool kShear = kWhole;        ///< shear of positions, which only scans use
inline constexpr bool kTangents = kWhole;     ///< tangents that are quantised
inline constexpr bool kBlocks = kWhole;       ///< surfaces cut into blocks
}  // namespace decodes

/// A bit for each row of a table whose `is_decoded` is set, by the number of its `coding`. The
/// decoder keeps the mask instead of the table, whose words would make the core larger.
template <class Info, size_t kRows>
constexpr uint32_t decodedMask(const Info (&table)[kRows]) {
  uint32_t mask = 0;
  for (const Info& info : table)
    mask |= uint32_t{info.is_decoded} << static_cast<uint32_t>(info.coding);
  return mask;
}

/// Says that the core cannot decode a payload. The payload is not damaged, so this is not one of
/// the specification's errors.
inline constexpr Error kNotInCore = static_cast<Error>(255);

}  // namespace mcc

#endif  // MCC_FORMAT_DECODES_H_
