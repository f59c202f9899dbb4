// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The container: header, piece headers, three streams.                                      [A.2]
#ifndef MCC_CONTAINER_PAYLOAD_HEADER_H_
#define MCC_CONTAINER_PAYLOAD_HEADER_H_

#include <cstdint>
#include <span>

#include "base/bytes.h"
#include "base/memory.h"
#include "format/flags.h"
#include "format/methods.h"
#include "mcc/reader.h"
#include "mcc/status.h"
#include "mesh/rim.h"

namespace mcc {

/// Bounds the work per byte; writers pad a payload to keep it. [A.2.6]
/// Known meshes have fewer than 50 elements per byte;
/// only the triangles of a regular grid reach 2200.
inline constexpr uint64_t kMaxElementsPerByte = 1024;
/// The elements that an attribute counts in addition to its values, because its tables of up to
/// 4096 entries start anew.
inline constexpr uint64_t kElementsPerAttribute = 1024;
/// The elements that a search among neighbours and recent ones counts. There is one for each vertex
/// where vertices may share groups, each face of a pivot, each isolated position, and each place in
/// a kept order.
inline constexpr uint64_t kElementsPerSearch = 8;
/// The elements that a block counts in addition, because it begins with a copy of all models.
inline constexpr uint64_t kElementsPerBlock = 16384;

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
  /// Whether vertices may have mates.
  bool hasMates() const { return has(piece_flag::kSinceMinor1); }
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

/// Count the elements of a piece without its attributes, and of one of its attributes.
/// Time and working memory of decoding are proportional
/// to them. [A.2.6]
uint64_t surfaceElements(const PieceHeader& piece);
uint64_t attributeElements(const PieceHeader& piece, const AttributeFormat& format);

/// What the coders of a payload or of a block read. A single coder reads only the codes.
struct Streams {
  std::span<const uint8_t> codes;
  std::span<const uint8_t> tokens;
  std::span<const uint8_t> raw;
};

/// The smallest box of a block's positions, as the integers that they are coded as.
struct CodedBox {
  int32_t low[3] = {};
  int32_t high[3] = {};

  /// Equal in every member.
  bool operator==(const CodedBox&) const = default;
};

/// A row of the table of blocks. The piece of the same index has its counts.               [A.11.1]
struct BlockHeader {
  uint32_t first_wedge = 0;     ///< wedges of the whole piece before this block
  uint32_t repeated_count = 0;  ///< wedges that blocks before this one have
  uint32_t first_exception = 0;
  uint32_t exception_count = 0;
  size_t offset_bytes = 0;  ///< of its streams in the payload
  uint32_t codes_bytes = 0;
  uint32_t tokens_bytes = 0;
  uint32_t raw_bytes = 0;
  uint32_t checksum = 0;
  CodedBox box;

  uint64_t streamBytes() const { return uint64_t{codes_bytes} + tokens_bytes + raw_bytes; }
};

struct PayloadHeader {
  explicit PayloadHeader(const Allocator& allocator)
      : pieces(allocator),
        parts(allocator),
        attributes(allocator),
        blocks(allocator),
        exceptions(allocator) {}

  uint8_t version_minor = 0;
  uint32_t flags = 0;
  Array<PieceHeader> pieces;  ///< with blocks, one for each of them
  Array<PartInfo> parts;
  Array<AttributeInfo> attributes;
  Array<BlockHeader> blocks;
  Array<BlockException> exceptions;  ///< of all blocks
  size_t header_bytes = 0;
  Streams streams;  ///< with blocks, the streams of all of them are in `codes`

  bool singleCoder() const { return (flags & payload_flag::kSingleCoder) != 0; }
  bool startsTrained() const { return (flags & payload_flag::kTrained) != 0; }
  bool hasBlocks() const { return decodes::kBlocks && (flags & payload_flag::kBlocks) != 0; }
  /// Whether all streams of a block are there, see parsePrefix().
  bool isLoaded(const BlockHeader& block) const {
    return block.offset_bytes + block.streamBytes() <= header_bytes + streams.codes.size();
  }
  /// The streams of a block, all of which must be there.
  Streams streamsOf(const BlockHeader& block) const {
    std::span<const uint8_t> bytes = streams.codes.subspan(block.offset_bytes - header_bytes);
    const auto take = [&bytes](size_t count) {
      const std::span<const uint8_t> taken = bytes.first(count);
      bytes = bytes.subspan(count);
      return taken;
    };
    const std::span<const uint8_t> codes = take(block.codes_bytes);
    const std::span<const uint8_t> tokens = take(block.tokens_bytes);
    return {codes, tokens, take(block.raw_bytes)};
  }
  std::span<const BlockException> exceptionsOf(const BlockHeader& block) const {
    return {exceptions.data() + block.first_exception, block.exception_count};
  }
  AttributeInfos attributesOf(const PieceHeader& piece) const {
    return {attributes.data() + piece.first_attribute, piece.attribute_count};
  }
};

/// Counts the elements of all pieces
/// and their attributes. [A.2.6]
uint64_t elementsOf(const PayloadHeader& header);

/// Returns the CRC-32 of a payload of at least kChecksummedFrom bytes, less its checksum; with
/// blocks, of its header. [A.2.1]
uint32_t checksumOf(std::span<const uint8_t> bytes);
/// Returns the CRC-32 of a block's streams.                                                [A.11.1]
uint32_t checksumOf(const Streams& streams);

/// Parses and checks everything before the streams. Allocates only in proportion to the bytes.
/// payload_bytes  is the size of the payload, if `bytes` are only its beginning: its header, and
///                with blocks any part of its streams.
/// [A.2.1, A.11.5]
Status parsePayload(std::span<const uint8_t> bytes, const Limits& limits, PayloadHeader& header);
Status parsePrefix(std::span<const uint8_t> bytes, uint64_t payload_bytes, const Limits& limits,
                   PayloadHeader& header);

}  // namespace mcc

#endif  // MCC_CONTAINER_PAYLOAD_HEADER_H_
