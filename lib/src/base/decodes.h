// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the reader is compiled with. All of the format; but the core of the decoder for the web (lib/web), compiled with
// MCC_CORE, has what most files need and refuses the others with kNotInCore, before anything is decoded: the whole decoder
// takes them. Code for what the core lacks is behind these constants, and container/payload_header.cpp refuses it.
#ifndef MCC_BASE_DECODES_H_
#define MCC_BASE_DECODES_H_

#include "mcc/status.h"

namespace mcc {

#if defined(MCC_CORE)
inline constexpr bool kWhole = false;
#else
inline constexpr bool kWhole = true;
#endif

namespace decodes {
inline constexpr bool kOrders = kWhole;       ///< of triangles and vertices, if they are kept
inline constexpr bool kExactFloats = kWhole;  ///< grids too
inline constexpr bool kPivots = kWhole;       ///< faces vertex by vertex
inline constexpr bool kPlanes = kWhole;       ///< of positions
inline constexpr bool kTangentPoints = kWhole;
}  // namespace decodes

/// The payload is not damaged, so that this is none of the errors of the specification.
inline constexpr Error kNotInCore = static_cast<Error>(255);

}  // namespace mcc

#endif  // MCC_BASE_DECODES_H_
