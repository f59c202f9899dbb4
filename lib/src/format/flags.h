// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The first bytes of a payload, and the flags of payloads and pieces. [A.2.1, A.2.2]
#ifndef MCC_FORMAT_FLAGS_H_
#define MCC_FORMAT_FLAGS_H_

#include <cstdint>
#include <iterator>

#include "format/decodes.h"
#include "mcc/reader.h"

namespace mcc {

inline constexpr uint8_t kMagic = 'K';
inline constexpr uint8_t kWithdrawnMagic[3] = {'M', 'C', 'C'};  ///< of a draft
/// The version of the format. Readers accept any minor one: reserved bits announce what it adds.
inline constexpr uint8_t kVersionMajor = 1;
inline constexpr uint8_t kVersionMinor = 1;  ///< the highest; what uses nothing new is written as 0
inline constexpr size_t kVersionOffset = 1;
inline constexpr size_t kChecksumOffset = 2;
inline constexpr size_t kChecksummedFrom = 6;  ///< the checksum covers bytes 0, 1 and from here on

namespace payload_flag {
inline constexpr uint32_t kSingleCoder = 1u << 0;
inline constexpr uint32_t kManyPieces = 1u << 1;
inline constexpr uint32_t kPadded = 1u << 2;
inline constexpr uint32_t kBlocks = 1u << 3;
inline constexpr uint32_t kTrained = 1u << 4;
inline constexpr uint32_t kAll = 0x1f;
inline constexpr uint32_t kSinceMinor1 = kTrained;  ///< what minor version 1 added
}  // namespace payload_flag

namespace piece_flag {
inline constexpr uint32_t kSeams = 1u << 0;
inline constexpr uint32_t kManyParts = 1u << 1;
inline constexpr uint32_t kSameAttributes = 1u << 2;
inline constexpr uint32_t kHoles = 1u << 3;
inline constexpr uint32_t kHandles = 1u << 4;
// The varint of the flags takes one byte, unless a flag beyond the next two is set.
inline constexpr uint32_t kCreases = 1u << 5;
inline constexpr uint32_t kIsolated = 1u << 6;
inline constexpr uint32_t kSurfaceShift = 7;
inline constexpr uint32_t kSurfaceMask = 3u << kSurfaceShift;  ///< SurfaceCoding
inline constexpr uint32_t kListed = 1u << 9;
inline constexpr uint32_t kTriangleOrder = 1u << 10;
inline constexpr uint32_t kVertexOrder = 1u << 11;
inline constexpr uint32_t kMirrors = 1u << 12;
inline constexpr uint32_t kAnchors = 1u << 13;
inline constexpr uint32_t kAll = 0x3fff;
inline constexpr uint32_t kSinceMinor1 = kMirrors | kAnchors;  ///< what minor version 1 added
/// The flags of pieces that this decoder knows.
inline constexpr uint32_t kDecoded =
    kAll & ~(decodes::kOrders ? 0 : kTriangleOrder | kVertexOrder) &
    ~(decodes::kIsolated ? 0 : kIsolated) & ~(decodes::kListed ? 0 : kListed);
}  // namespace piece_flag

struct PieceFlagInfo {
  uint32_t bit;
  const char* name;      ///< in the specification
  const char* sections;  ///< sections of the specification
};

inline constexpr PieceFlagInfo kPieceFlags[] = {
    {piece_flag::kSeams, "SEAMS", "A.7 A.7.1 A.7.2 A.7.3"},
    {piece_flag::kManyParts, "MANY_PARTS", "A.8.1"},
    {piece_flag::kSameAttributes, "SAME_ATTRIBUTES", "A.2.3"},
    {piece_flag::kHoles, "HOLES", "A.4.6"},
    {piece_flag::kHandles, "HANDLES", "A.4.4"},
    {piece_flag::kIsolated, "ISOLATED", "A.2.2 A.6.9"},
    {piece_flag::kListed, "LISTED", "A.8.2"},
    {piece_flag::kCreases, "CREASES", "A.7.4"},
    {piece_flag::kTriangleOrder, "TRIANGLE_ORDER", "A.3.5 A.9.1 A.9.2"},
    {piece_flag::kVertexOrder, "VERTEX_ORDER", "A.3.5 A.9.1 A.9.3"},
    {piece_flag::kMirrors, "MIRRORS", "A.6.14"},
    {piece_flag::kAnchors, "ANCHORS", "A.6.15"},
};

struct SurfaceInfo {
  SurfaceCoding coding;
  const char* name;      ///< in the specification
  const char* sections;  ///< sections of the specification
  bool is_decoded;       ///< otherwise this decoder, which is the core alone, refuses the surface
};

/// The codings of surfaces, in the order of SurfaceCoding.
inline constexpr SurfaceInfo kSurfaces[] = {
    {SurfaceCoding::kManifold, "MANIFOLD", "A.4 A.4.2 A.4.5", true},
    {SurfaceCoding::kBoundaryCopies, "COPIES", "A.5 A.5.1 A.5.2 A.5.3 A.3.5", true},
    {SurfaceCoding::kCopies, "INTERIOR_COPIES", "A.5 A.5.1 A.5.2 A.5.3", true},
    {SurfaceCoding::kPivots, "PIVOTS", "A.4.7", decodes::kPivots},
};

constexpr const SurfaceInfo& infoOf(SurfaceCoding coding) {
  return kSurfaces[static_cast<size_t>(coding)];
}

inline constexpr uint32_t kDecodedSurfaces = decodedMask(kSurfaces);

constexpr bool isDecoded(SurfaceCoding coding) {
  return kWhole || (kDecodedSurfaces >> static_cast<uint32_t>(coding) & 1) != 0;
}

}  // namespace mcc

#endif  // MCC_FORMAT_FLAGS_H_
