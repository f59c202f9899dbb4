// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The container: header, piece headers, three streams.                                      [A.2]
#ifndef MCC_CONTAINER_PAYLOAD_HEADER_H_
#define MCC_CONTAINER_PAYLOAD_HEADER_H_

#include <cstdint>
#include <span>

#include "base/bytes.h"
#include "base/memory.h"
#include "format/decodes.h"
#include "mcc/reader.h"
#include "mcc/status.h"

namespace mcc {

inline constexpr uint8_t kMagic[3] = {'K', 'M', 'C'};
inline constexpr uint8_t kWithdrawnMagic[3] = {'M', 'C', 'C'};  ///< the first format
/// A draft (major version 0) is not compatible with any other version.
inline constexpr uint8_t kVersionMajor = 0;
inline constexpr uint8_t kVersionMinor = 9;
inline constexpr size_t kChecksumOffset = 4;
inline constexpr size_t kChecksummedFrom = 8;  ///< the checksum covers bytes 0..3 and from here on

/// Bounds the work per byte; writers pad a payload to keep it. Known meshes have fewer than 50
/// elements per byte; only the triangles of a regular grid reach 2200.
/// [A.2.6]
inline constexpr uint64_t kMaxElementsPerByte = 1024;
/// The elements that an attribute counts in addition to its values, because its tables of up to
/// 4096 entries start anew.
inline constexpr uint64_t kElementsPerAttribute = 1024;
/// The elements that a search among neighbours and recent ones counts. There is one for each vertex
/// where vertices may share groups, each face of a pivot, each isolated position, and each place in
/// a kept order.
inline constexpr uint64_t kElementsPerSearch = 8;

namespace payload_flag {
inline constexpr uint32_t kSingleCoder = 1u << 0;
inline constexpr uint32_t kManyPieces = 1u << 1;
inline constexpr uint32_t kPadded = 1u << 2;
inline constexpr uint32_t kContextSetShift = 3;  ///< one bit
inline constexpr uint32_t kAll = 0xf;
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
inline constexpr uint32_t kAll = 0xfff;
/// The flags of pieces that this reader can decode.
inline constexpr uint32_t kDecoded = kAll & ~(decodes::kOrders ? 0 : kTriangleOrder | kVertexOrder);
}  // namespace piece_flag

struct PieceHeader {
  uint32_t flags = 0;
  uint32_t vertex_count = 0;  ///< umbrellas of the cut mesh, or groups if the piece has pivots
  uint32_t face_count = 0;
  uint32_t operation_count = 0;
  uint32_t dummy_count = 0;
  uint32_t wedge_count = 0;  ///< including isolated wedges
  uint32_t isolated_count = 0;
  uint32_t listed_count = 0;
  uint32_t first_part = 0;
  uint32_t part_count = 1;
  uint32_t first_attribute = 0;
  uint32_t attribute_count = 0;

  bool has(uint32_t flag) const { return (flags & flag & piece_flag::kDecoded) != 0; }
  uint64_t triangleCount() const { return uint64_t{face_count} + listed_count; }
  SurfaceCoding surface() const {
    return static_cast<SurfaceCoding>((flags & piece_flag::kSurfaceMask) >>
                                      piece_flag::kSurfaceShift);
  }
  void setSurface(SurfaceCoding coding) {
    flags = (flags & ~piece_flag::kSurfaceMask) | static_cast<uint32_t>(coding)
                                                      << piece_flag::kSurfaceShift;
  }
  bool hasPivots() const { return decodes::kPivots && surface() == SurfaceCoding::kPivots; }
  bool hasCopies() const {
    return surface() == SurfaceCoding::kBoundaryCopies || surface() == SurfaceCoding::kCopies;
  }
};

/// Count the elements of a piece without its attributes, and of one of its attributes. Time and
/// working memory of decoding are proportional to them.
/// [A.2.6]
uint64_t surfaceElements(const PieceHeader& piece);
uint64_t attributeElements(const PieceHeader& piece, const AttributeFormat& format);

struct PayloadHeader {
  explicit PayloadHeader(const Allocator& allocator)
      : pieces(allocator), parts(allocator), attributes(allocator) {}

  uint8_t version_minor = 0;
  uint32_t flags = 0;
  Array<PieceHeader> pieces;
  Array<PartInfo> parts;
  Array<AttributeInfo> attributes;
  size_t header_bytes = 0;
  std::span<const uint8_t> codes;
  std::span<const uint8_t> tokens;
  std::span<const uint8_t> raw;

  bool singleCoder() const { return (flags & payload_flag::kSingleCoder) != 0; }
  uint32_t contextSet() const { return flags >> payload_flag::kContextSetShift; }
};

/// Counts the elements of all pieces and their attributes.
/// [A.2.6]
uint64_t elementsOf(const PayloadHeader& header);

/// Parses and checks everything before the streams. Allocates only in proportion to the bytes.
/// [A.2.1]
Status parsePayload(std::span<const uint8_t> bytes, const Limits& limits, PayloadHeader& header);

}  // namespace mcc

#endif  // MCC_CONTAINER_PAYLOAD_HEADER_H_
