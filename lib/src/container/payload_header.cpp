// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "container/payload_header.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/crc32.h"
#include "format/codings.h"
#include "format/predictors.h"
#include "format/usual.h"
#include "mesh/face_mesh.h"

namespace mcc {
namespace {

bool isFinitePositive(float value) {
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  return bits != 0 && bits < 0x7f800000u;
}
bool isFinite(float value) { return (std::bit_cast<uint32_t>(value) & 0x7f800000u) != 0x7f800000u; }

bool isBasePosition(const AttributeInfo& a) {
  return a.format.semantic == Semantic::kPosition && a.format.set_index == 0 &&
         a.format.morph_target == 0;
}

/// [A.2.4]
Status parseGrid(ByteReader& in, AttributeInfo& a) {
  const size_t at = in.offset();
  uint8_t shape = 0;
  uint8_t grid = 0;
  MCC_TRY(in.readU8(shape));
  MCC_TRY(in.readU8(grid));
  a.bits = shape & 31;
  a.tails = shape >> 5;
  a.grid = grid;
  if (a.bits == 0 || a.bits > kGridBits + 1 || a.format.component_count > kGridComponents ||
      a.tails > static_cast<uint8_t>(GridTails::kCached) || (a.tails != 0 && !isBinaryGrid(grid))) {
    return fail(Error::kBadHeader, "an attribute's grid is malformed", at);
  }
  return {};
}

/// [A.2.4]
Status parseFloat(ByteReader& in, uint32_t form, float usual, float& value) {
  value = usual;
  if (form == kUsualForm) return {};
  const size_t at = in.offset();
  uint32_t bits = 0;
  MCC_TRY(in.readHighBytes(bits, 4 - form));
  value = std::bit_cast<float>(bits);
  if (formOf(value, usual) == form) return {};
  return fail(Error::kBadHeader, "a number of a lattice has a shorter form", at);
}

/// `before` are the attributes of the piece before this one. [A.2.4]
Status parseLattice(ByteReader& in, AttributeInfos before, AttributeInfo& a) {
  const size_t at = in.offset();
  uint32_t forms = 0;
  MCC_TRY(in.readVarint(forms));
  a.bits = forms % (1u << kLatticeBitsBits);
  forms >>= kLatticeBitsBits;
  if (a.bits == 0 || a.bits > kMaxLatticeBits || a.format.component_count > kMaxLatticeComponents) {
    return fail(Error::kBadHeader, "an attribute's lattice is malformed", at);
  }
  constexpr uint32_t kForm = (1u << kFormBits) - 1;
  MCC_TRY(parseFloat(in, forms & kForm, usualStep(before, a), a.lattice.step));
  bool finite = isFinitePositive(a.lattice.step);
  const bool has_origin = a.format.morph_target == 0;  // deltas are on grids through 0
  for (uint32_t c = 0; c < a.format.component_count && has_origin; ++c) {
    forms >>= kFormBits;
    MCC_TRY(parseFloat(in, forms & kForm, 0, a.lattice.origin[c]));
    finite = finite && isFinite(a.lattice.origin[c]);
  }
  if (!finite) return fail(Error::kBadHeader, "an attribute's lattice is not finite", at);
  if (forms > kForm) return fail(Error::kBadHeader, "reserved bits are set", at);
  return {};
}

/// [A.2.4]
Status parseType(ByteReader& in, AttributeFormat& format) {
  const size_t at = in.offset();
  uint8_t type = 0;
  MCC_TRY(in.readU8(type));
  if ((type & 7) > static_cast<uint8_t>(ComponentType::kFloat32)) {
    return fail(Error::kBadHeader, "an attribute has an unknown component type", at);
  }
  format.component_type = static_cast<ComponentType>(type & 7);
  format.component_count = static_cast<uint8_t>((type >> 3 & 15) + 1);
  format.normalized = (type & 0x80) != 0;
  if (!isComponentCount(format.component_count)) {
    return fail(Error::kBadHeader, "an attribute has a number of components that no type has", at);
  }
  if (!isUsualType(format)) return {};
  return fail(Error::kBadHeader, "a type is stated although it is implied", at);
}

/// `before` are the attributes of the piece before this one. [A.2.4]
Status parseAttribute(ByteReader& in, AttributeInfos before, AttributeInfo& a) {
  const size_t at = in.offset();
  uint8_t kind = 0;
  MCC_TRY(in.readU8(kind));
  a = AttributeInfo{};
  a.format.semantic = static_cast<Semantic>(kind & 7);
  a.format.component_count = kUsualComponents[kind & 7];
  if ((kind & kTypeStated) != 0) MCC_TRY(parseType(in, a.format));
  if ((kind & kMoreStated) != 0) {
    MCC_TRY(in.readU8(a.format.set_index));
    uint32_t target = 0;
    MCC_TRY(in.readVarint(target));
    if (target > 0xffff)
      return fail(Error::kBadHeader, "a morph target number is out of range", at);
    if (target == 0 && a.format.set_index == 0)
      return fail(Error::kBadHeader, "a set and a morph target that need no statement", at);
    a.format.morph_target = static_cast<uint16_t>(target);
  }
  if ((kind >> 3 & 7) > static_cast<uint8_t>(AttributeCoding::kGrid)) {
    return fail(Error::kBadHeader, "an attribute has an unknown coding", at);
  }
  a.coding = static_cast<AttributeCoding>(kind >> 3 & 7);
  if (!isDecoded(a.coding)) return fail(kNotInCore, "the core lacks a coding", at);
  const bool is_float = a.format.component_type == ComponentType::kFloat32;
  if (a.coding != AttributeCoding::kAlias && is_float == (a.coding == AttributeCoding::kInteger)) {
    return fail(Error::kBadHeader, "an attribute's coding does not fit its component type", at);
  }
  MCC_TRY(in.readU8(a.predictor));
  if (a.coding == AttributeCoding::kLattice) {
    MCC_TRY(parseLattice(in, before, a));
  } else if (a.coding == AttributeCoding::kOctahedral) {
    MCC_TRY(in.readU8(a.bits));
    const bool is_tangent = a.format.semantic == Semantic::kTangent;
    if (a.bits < kMinUnitBits || a.bits > kMaxUnitBits ||
        a.format.component_count != (is_tangent ? 4 : 3) ||
        (is_tangent && a.format.morph_target != 0)) {
      return fail(Error::kBadHeader, "an octahedral attribute is malformed", at);
    }
  }
  if (decodes::kTangents && a.coding == AttributeCoding::kTangentAngle) {
    MCC_TRY(in.readU8(a.bits));
    if (a.bits < kMinUnitBits || a.bits > kMaxUnitBits || a.format.component_count != 4 ||
        a.format.semantic != Semantic::kTangent || a.format.morph_target != 0) {
      return fail(Error::kBadHeader, "a tangent attribute is malformed", at);
    }
  }
  if (a.coding == AttributeCoding::kAlias) MCC_TRY(in.readVarint(a.alias_of));
  if (decodes::kExactFloats && a.coding == AttributeCoding::kGrid) MCC_TRY(parseGrid(in, a));
  return {};
}

/// Checks that aliases refer to earlier attributes that are neither aliases nor the position, that
/// tangents have normals, and that predictors are known in the payload's version.
Status checkReferences(AttributeInfos all, uint8_t version_minor, size_t at) {
  for (uint32_t i = 0; i < all.size(); ++i) {
    if (all[i].coding == AttributeCoding::kAlias) {
      const uint32_t source = all[i].alias_of;
      if (source == 0 || source >= i || all[source].coding == AttributeCoding::kAlias ||
          all[source].format.component_type != all[i].format.component_type ||
          all[source].format.component_count != all[i].format.component_count) {
        return fail(Error::kBadHeader, "an attribute is equal to one it cannot be equal to", at);
      }
    }
    if (decodes::kTangents && all[i].coding == AttributeCoding::kTangentAngle &&
        normalOfTangents(all) == kNone) {
      return fail(Error::kBadHeader, "tangents refer to normals that are not there", at);
    }
    const AttributeMethod method = methodOf(all, i);
    if (!isKnownPredictor(method, all[i].predictor)) {
      return fail(Error::kBadHeader, "an attribute has an unknown predictor", at);
    }
    // The core knows no predictor that later versions added, except mates.
    const uint8_t needed =
        kWhole ? minorVersionOf(method, all[i].predictor) : asksMates(method, all[i].predictor);
    if (needed > version_minor) {
      return fail(Error::kBadHeader, "a predictor is not in the payload's version", at);
    }
    if (!isDecoded(method, all[i].predictor))
      return fail(kNotInCore, "the core lacks a predictor", at);
  }
  return {};
}

/// [A.2.3]
Status parseAttributes(ByteReader& in, const Limits& limits, PayloadHeader& header,
                       PieceHeader& piece) {
  const size_t at = in.offset();
  piece.first_attribute = static_cast<uint32_t>(header.attributes.size());
  if (piece.has(piece_flag::kSameAttributes)) {
    if (header.pieces.empty())
      return fail(Error::kBadHeader, "the first piece refers to one before it", at);
    const PieceHeader& before = header.pieces.back();
    piece.attribute_count = before.attribute_count;
  } else {
    MCC_TRY(in.readVarint(piece.attribute_count));
  }
  if (piece.attribute_count == 0) {  // indices only
    return piece.has(piece_flag::kCreases | piece_flag::kSinceMinor1)
               ? fail(Error::kBadHeader, "a piece without positions has creases or mirrors", at)
               : Status{};
  }
  if (header.hasBlocks() && !header.pieces.empty()) {
    piece.first_attribute = header.pieces[0].first_attribute;
    return {};
  }
  if (header.attributes.size() + uint64_t{piece.attribute_count} > limits.max_attributes) {
    return fail(Error::kLimit, "the payload has more attributes than the limit allows", at);
  }
  for (uint32_t i = 0; i < piece.attribute_count; ++i) {
    AttributeInfo a;
    if (piece.has(piece_flag::kSameAttributes)) {
      a = header.attributes[header.pieces.back().first_attribute + i];
    } else {
      MCC_TRY(parseAttribute(in, {header.attributes.data() + piece.first_attribute, i}, a));
    }
    if (!header.attributes.push_back(a))
      return fail(Error::kOutOfMemory, "no memory for the header");
  }
  MCC_TRY(checkReferences(header.attributesOf(piece), header.version_minor, at));
  const AttributeInfo& position = header.attributes[piece.first_attribute];
  if (!isBasePosition(position) || position.format.component_count != 3 ||
      (position.coding != AttributeCoding::kLattice &&
       position.coding != AttributeCoding::kInteger && !isExact(position.coding))) {
    return fail(Error::kBadHeader, "the first attribute of a piece is not its position", at);
  }
  if ((position.predictor & position_mode::kPlanes) != 0 &&
      (position.coding != AttributeCoding::kLattice ||
       position.bits > position_mode::kMaxBitsOfPlanes)) {
    return fail(Error::kBadHeader, "these positions cannot have planes", at);
  }
  if ((position.predictor & position_mode::kPlanes) != 0 && piece.hasMates())
    return fail(Error::kBadHeader, "positions with planes have mirrors", at);
  return {};
}

/// Reads a count whose presence a flag announces. It must be at least `least`: smaller counts need
/// no flag. [A.2.2]
Status parseFlaggedCount(ByteReader& in, bool is_stated, uint32_t least, uint32_t& count) {
  if (!is_stated) return {};
  const size_t at = in.offset();
  MCC_TRY(in.readVarint(count));
  if (count >= least) return {};
  return fail(Error::kBadHeader, "a count is stated although it is implied", at);
}

/// Sums over the pieces so far, because limits apply to the payload.
struct Totals {
  uint64_t vertices = 0;
  uint64_t wedges = 0;
  uint64_t triangles = 0;
  uint64_t output_bytes = 0;  ///< size of the caller's attributes and indices of 32 bits
};

/// [A.11.1]
Status checkBlock(const PayloadHeader& header, const PieceHeader& block, size_t at) {
  const bool is_first = header.pieces.empty();
  if (block.hasPivots() || block.face_count == 0 || block.attribute_count == 0 ||
      block.has(piece_flag::kTriangleOrder | piece_flag::kVertexOrder | piece_flag::kSinceMinor1) ||
      block.has(piece_flag::kSameAttributes) == is_first ||
      (!is_first && block.part_count != header.pieces[0].part_count)) {
    return fail(Error::kBadHeader, "a block has what no block has", at);
  }
  return {};
}

/// [A.2.2]
Status parsePiece(ByteReader& in, const Limits& limits, PayloadHeader& header, Totals& totals) {
  PieceHeader piece;
  const size_t at = in.offset();
  MCC_TRY(in.readVarint(piece.flags));
  const uint32_t reserved = header.version_minor == 0 ? piece_flag::kSinceMinor1 : 0;
  if ((piece.flags & (~piece_flag::kAll | reserved)) != 0)
    return fail(Error::kBadHeader, "reserved bits are set", at);
  if (piece.has(piece_flag::kCreases) && !piece.has(piece_flag::kSeams))
    return fail(Error::kBadHeader, "a piece without seams has creases", at);
  const bool has_pivots = piece.surface() == SurfaceCoding::kPivots;
  if (has_pivots && piece.has(piece_flag::kHoles | piece_flag::kHandles))
    return fail(Error::kBadHeader, "a piece that is not cut has holes or handles", at);
  if ((piece.flags & ~piece_flag::kDecoded) != 0 || !isDecoded(piece.surface()))
    return fail(kNotInCore, "the core lacks what a piece has", at);
  uint32_t zigzagged = 0;
  MCC_TRY(in.readVarint(piece.vertex_count));
  MCC_TRY(in.readVarint(piece.face_count));
  if (!has_pivots) {
    MCC_TRY(in.readVarint(zigzagged));
    piece.operation_count = piece.vertex_count + static_cast<uint32_t>(unzigzag(zigzagged));
  }
  MCC_TRY(in.readVarint(zigzagged));
  piece.wedge_count = piece.vertex_count + static_cast<uint32_t>(unzigzag(zigzagged));
  MCC_TRY(parseFlaggedCount(in, piece.has(piece_flag::kHoles), 1, piece.dummy_count));
  MCC_TRY(parseFlaggedCount(in, piece.has(piece_flag::kIsolated), 1, piece.isolated_count));
  MCC_TRY(parseFlaggedCount(in, piece.has(piece_flag::kListed), 1, piece.listed_count));
  MCC_TRY(parseFlaggedCount(in, piece.has(piece_flag::kManyParts), 2, piece.part_count));
  const uint64_t triangles = piece.triangleCount();
  totals.vertices += piece.vertex_count;
  totals.wedges += piece.wedge_count;
  totals.triangles += triangles;
  totals.output_bytes += triangles * 3 * sizeof(uint32_t);
  if (totals.vertices > limits.max_vertices || totals.wedges > limits.max_vertices ||
      piece.vertex_count >= kMaxVertices || piece.wedge_count >= kMaxVertices) {
    return fail(Error::kLimit, "the payload has more vertices than the limit allows", at);
  }
  if (totals.triangles > limits.max_triangles || triangles >= kMaxVertices) {
    return fail(Error::kLimit, "the payload has more triangles than the limit allows", at);
  }
  if (piece.isolated_count > piece.wedge_count ||
      piece.wedge_count - piece.isolated_count > 3 * uint64_t{piece.face_count} ||
      piece.vertex_count > 3 * uint64_t{piece.face_count} ||
      piece.dummy_count > 3 * uint64_t{piece.face_count} ||
      (piece.vertex_count != 0) != (piece.face_count != 0) ||
      piece.operation_count > uint64_t{piece.vertex_count} + 4 * uint64_t{piece.face_count}) {
    return fail(Error::kBadHeader, "the counts of a piece contradict each other", at);
  }
  if (piece.part_count > in.remaining() + 1) {
    return fail(Error::kTruncated, "the payload ends inside its header", at);
  }
  piece.first_part = static_cast<uint32_t>(header.parts.size());
  uint64_t of_parts = 0;
  for (uint32_t i = 0; i < piece.part_count; ++i) {
    PartInfo part{static_cast<uint32_t>(triangles)};
    if (piece.has(piece_flag::kManyParts)) MCC_TRY(in.readVarint(part.triangle_count));
    of_parts += part.triangle_count;
    if (!header.parts.push_back(part)) return fail(Error::kOutOfMemory, "no memory for the header");
  }
  if (of_parts != triangles) {
    return fail(Error::kBadHeader,
                "the parts of a piece have another number of triangles than the piece", at);
  }
  MCC_TRY(parseAttributes(in, limits, header, piece));
  if (header.hasBlocks()) MCC_TRY(checkBlock(header, piece, at));
  for (uint32_t i = 0; i < piece.attribute_count; ++i) {
    const AttributeFormat& format = header.attributes[piece.first_attribute + i].format;
    totals.output_bytes += uint64_t{piece.wedge_count} * elementBytes(format);
  }
  if (!header.pieces.push_back(piece)) return fail(Error::kOutOfMemory, "no memory for the header");
  return {};
}

Status parsePadding(ByteReader& in, const PayloadHeader& header) {
  if ((header.flags & payload_flag::kPadded) == 0) return {};
  uint32_t padding = 0;
  std::span<const uint8_t> zeros;
  MCC_TRY(parseFlaggedCount(in, true, 1, padding));
  const size_t at = in.offset();
  MCC_TRY(in.readBytes(padding, zeros));
  for (const uint8_t byte : zeros) {
    if (byte != 0) return fail(Error::kBadHeader, "the padding is not zero", at);
  }
  return {};
}

/// Reads the lengths of all streams but the last, which takes the rest. [A.2.5]
Status parseStreams(ByteReader& in, PayloadHeader& header) {
  uint32_t codes_bytes = 0;
  uint32_t tokens_bytes = 0;
  if (!header.singleCoder()) {
    MCC_TRY(in.readVarint(codes_bytes));
    MCC_TRY(in.readVarint(tokens_bytes));
  }
  MCC_TRY(parsePadding(in, header));
  header.header_bytes = in.offset();
  if (header.singleCoder()) return in.readBytes(in.remaining(), header.streams.codes);
  MCC_TRY(in.readBytes(codes_bytes, header.streams.codes));
  MCC_TRY(in.readBytes(tokens_bytes, header.streams.tokens));
  return in.readBytes(in.remaining(), header.streams.raw);
}

/// [A.11.1]
Status parseExceptions(ByteReader& in, const PieceHeader& piece, PayloadHeader& header,
                       BlockHeader& block) {
  const size_t at = in.offset();
  MCC_TRY(in.readVarint(block.exception_count));
  uint64_t wedge = 0;
  for (uint32_t i = 0; i < block.exception_count; ++i) {
    uint32_t delta = 0;
    uint32_t back = 0;
    MCC_TRY(in.readVarint(delta));
    MCC_TRY(in.readVarint(back));
    wedge += uint64_t{delta} + (i != 0 ? 1 : 0);
    if (wedge >= piece.wedge_count - piece.isolated_count || back > block.first_wedge)
      return fail(Error::kBadHeader, "an exception names a wedge that is not there", at);
    const uint32_t number = back == 0 ? kNone : block.first_wedge - back;
    if (!header.exceptions.push_back({static_cast<uint32_t>(wedge), number}))
      return fail(Error::kOutOfMemory, "no memory for the header");
  }
  return {};
}

/// [A.11.1]
Status parseBlock(ByteReader& in, const PieceHeader& piece, PayloadHeader& header,
                  BlockHeader& block) {
  block.first_exception = static_cast<uint32_t>(header.exceptions.size());
  if (!header.blocks.empty()) {
    const size_t at = in.offset();
    MCC_TRY(in.readVarint(block.repeated_count));
    if (block.repeated_count > piece.wedge_count - piece.isolated_count)
      return fail(Error::kBadHeader, "a block repeats more wedges than it has", at);
    MCC_TRY(parseExceptions(in, piece, header, block));
  }
  MCC_TRY(in.readVarint(block.codes_bytes));
  MCC_TRY(in.readVarint(block.tokens_bytes));
  MCC_TRY(in.readVarint(block.raw_bytes));
  MCC_TRY(in.readU32(block.checksum));
  for (uint32_t s = 0; s < 3; ++s) {
    const size_t at = in.offset();
    uint32_t low = 0;
    uint32_t size = 0;
    MCC_TRY(in.readVarint(low));
    MCC_TRY(in.readVarint(size));
    const int64_t high = int64_t{unzigzag(low)} + size;
    if (high > INT32_MAX) return fail(Error::kBadHeader, "the box of a block is too large", at);
    block.box.low[s] = unzigzag(low);
    block.box.high[s] = static_cast<int32_t>(high);
  }
  return {};
}

/// [A.11.1]
Status parseBlocks(ByteReader& in, uint64_t payload_bytes, PayloadHeader& header) {
  if (!header.blocks.reserve(header.pieces.size()))
    return fail(Error::kOutOfMemory, "no memory for the header");
  const size_t at = in.offset();
  uint64_t offset_bytes = header.header_bytes;
  uint64_t wedges = 0;
  for (size_t i = 0; i < header.pieces.size(); ++i) {
    BlockHeader block;
    block.first_wedge = static_cast<uint32_t>(wedges);
    MCC_TRY(parseBlock(in, header.pieces[i], header, block));
    block.offset_bytes = static_cast<size_t>(offset_bytes);
    offset_bytes += block.streamBytes();
    wedges += header.pieces[i].wedge_count - block.repeated_count;
    if (wedges >= kMaxVertices)
      return fail(Error::kLimit, "the payload has more vertices than the limit allows", at);
    (void)header.blocks.push_back(block);  // reserved above
  }
  MCC_TRY(parsePadding(in, header));
  if (in.offset() != header.header_bytes)
    return fail(Error::kBadHeader, "the header has another length than it claims", at);
  if (offset_bytes > payload_bytes)
    return fail(Error::kTruncated, "the payload ends inside a block", header.header_bytes);
  if (offset_bytes != payload_bytes)
    return fail(Error::kTrailingBytes, "bytes follow the last block", offset_bytes);
  return in.readBytes(in.remaining(), header.streams.codes);
}

}  // namespace

uint64_t surfaceElements(const PieceHeader& piece) {
  const uint64_t triangles = piece.triangleCount();
  const uint64_t elements =
      uint64_t{piece.operation_count} + piece.vertex_count + piece.wedge_count + triangles;
  uint64_t searches = 0;
  if (piece.hasCopies()) searches += piece.vertex_count;
  if (piece.hasPivots()) searches += piece.face_count;
  searches += piece.isolated_count;
  if (piece.has(piece_flag::kTriangleOrder)) searches += triangles;
  if (piece.has(piece_flag::kVertexOrder)) searches += piece.wedge_count + triangles;
  return elements + kElementsPerSearch * searches;
}

uint64_t attributeElements(const PieceHeader& piece, const AttributeFormat& format) {
  return kElementsPerAttribute + piece.triangleCount() +
         uint64_t{piece.wedge_count} * format.component_count;
}

uint64_t elementsOf(const PayloadHeader& header) {
  uint64_t elements = header.hasBlocks() ? kElementsPerBlock * header.pieces.size() : 0;
  for (size_t i = 0; i < header.pieces.size(); ++i) {
    const PieceHeader& piece = header.pieces[i];
    elements += surfaceElements(piece);
    for (uint32_t a = 0; a < piece.attribute_count; ++a) {
      elements += attributeElements(piece, header.attributes[piece.first_attribute + a].format);
    }
  }
  return elements;
}

namespace {

bool claimsBlocks(std::span<const uint8_t> bytes) {
  return bytes.size() > kChecksummedFrom && (bytes[kChecksummedFrom] & payload_flag::kBlocks) != 0;
}

/// Finds how many bytes the checksum of a payload covers: all, or the header where blocks have
/// checksums of their own.
Status findChecksummed(std::span<const uint8_t> bytes, uint64_t payload_bytes,
                       size_t& checksummed_bytes) {
  checksummed_bytes = bytes.size();
  if (!claimsBlocks(bytes)) {
    if (bytes.size() == payload_bytes) return {};
    return fail(Error::kTruncated, "the payload ends before its last byte", bytes.size());
  }
  ByteReader in(bytes.subspan(kChecksummedFrom + 1));
  uint32_t header_bytes = 0;
  MCC_TRY(in.readVarint(header_bytes));
  if (header_bytes > bytes.size())
    return fail(Error::kTruncated, "the payload ends inside its header", bytes.size());
  checksummed_bytes = std::max<size_t>(header_bytes, kChecksummedFrom + 1);
  return {};
}

}  // namespace

uint32_t checksumOf(std::span<const uint8_t> bytes) {
  size_t checksummed_bytes = 0;
  if (!findChecksummed(bytes, bytes.size(), checksummed_bytes).ok())
    checksummed_bytes = bytes.size();
  return crc32(bytes.first(checksummed_bytes).subspan(kChecksummedFrom),
               crc32(bytes.first(kChecksumOffset)));
}

uint32_t checksumOf(const Streams& streams) {
  return crc32(streams.raw, crc32(streams.tokens, crc32(streams.codes)));
}

Status parsePayload(std::span<const uint8_t> bytes, const Limits& limits, PayloadHeader& header) {
  return parsePrefix(bytes, bytes.size(), limits, header);
}

Status parsePrefix(std::span<const uint8_t> bytes, uint64_t payload_bytes, const Limits& limits,
                   PayloadHeader& header) {
  if (bytes.size() >= 3 && std::memcmp(bytes.data(), kWithdrawnMagic, 3) == 0) {
    return fail(Error::kUnsupportedVersion,
                "the payload is of a withdrawn draft of the format: compress its source again", 0);
  }
  if (bytes.empty() || bytes[0] != kMagic) {
    return fail(Error::kBadMagic, "the bytes are not a mesh collapse payload", 0);
  }
  ByteReader in(bytes);
  uint8_t magic = 0;
  uint8_t version = 0;
  uint32_t checksum = 0;
  MCC_TRY(in.readU8(magic));
  MCC_TRY(in.readU8(version));
  if (version >> 4 != kVersionMajor) {
    return fail(Error::kUnsupportedVersion,
                version >> 4 == 0
                    ? "the payload is of a draft of the format: compress its source again"
                    : "the payload is of a version this reader does not know: it knows 1.x",
                kVersionOffset);
  }
  header.version_minor = version & 15;
  MCC_TRY(in.readU32(checksum));
  size_t checksummed_bytes = 0;
  MCC_TRY(findChecksummed(bytes, payload_bytes, checksummed_bytes));
  if (checksumOf(bytes) != checksum) {
    return fail(Error::kBadChecksum, "the checksum does not match: the payload is damaged",
                kChecksumOffset);
  }
  uint8_t flags = 0;
  MCC_TRY(in.readU8(flags));
  header.flags = flags;
  const uint32_t reserved = header.version_minor == 0 ? payload_flag::kSinceMinor1 : 0;
  if ((header.flags & (~payload_flag::kAll | reserved)) != 0) {
    return fail(Error::kBadHeader, "reserved bits are set", kChecksummedFrom);
  }
  if (!decodes::kBlocks && claimsBlocks(bytes))
    return fail(kNotInCore, "the core lacks blocks", kChecksummedFrom);
  if (header.hasBlocks()) {
    uint32_t header_bytes = 0;
    MCC_TRY(in.readVarint(header_bytes));
    header.header_bytes = header_bytes;
    if (header.singleCoder() || header.startsTrained() || (flags & payload_flag::kManyPieces) == 0)
      return fail(Error::kBadHeader, "these flags exclude each other", kChecksummedFrom);
  }
  uint32_t piece_count = 1;
  const size_t at = in.offset();
  MCC_TRY(parseFlaggedCount(in, (flags & payload_flag::kManyPieces) != 0, 2, piece_count));
  if (piece_count > limits.max_pieces) {
    return fail(Error::kLimit, "the payload has more pieces than the limit allows", at);
  }
  Totals totals;
  for (uint32_t i = 0; i < piece_count; ++i) MCC_TRY(parsePiece(in, limits, header, totals));
  // [A.11.4]
  if (header.hasBlocks() && (totals.triangles >= kMaxVertices || totals.vertices >= kMaxVertices))
    return fail(Error::kLimit, "the blocks have more triangles or vertices than a piece can", at);
  const uint64_t elements = elementsOf(header);
  if ((elements + kMaxElementsPerByte - 1) / kMaxElementsPerByte > payload_bytes) {
    return fail(Error::kLimit, "the payload claims more than its size can hold", at);
  }
  if (elements > limits.max_elements || totals.output_bytes > limits.max_output_bytes) {
    return fail(Error::kLimit, "the payload is larger than the limit allows", at);
  }
  return header.hasBlocks() ? parseBlocks(in, payload_bytes, header) : parseStreams(in, header);
}

}  // namespace mcc
