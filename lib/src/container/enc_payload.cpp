// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "container/enc_payload.h"

#include "base/crc32.h"
#include "base/enc_bytes.h"

namespace mcc {
namespace {

void writeAttribute(ByteWriter& out, const AttributeInfo& a) {
  const AttributeFormat& f = a.format;
  const bool more = f.set_index != 0 || f.morph_target != 0;
  out.writeU8(static_cast<uint8_t>(static_cast<uint32_t>(f.semantic) |
                                   static_cast<uint32_t>(f.component_type) << 3 |
                                   (f.normalized ? 0x40u : 0u) | (more ? 0x80u : 0u)));
  out.writeU8(
      static_cast<uint8_t>((f.component_count - 1u) | static_cast<uint32_t>(a.coding) << 4));
  if (more) {
    out.writeU8(f.set_index);
    out.writeVarint(f.morph_target);
  }
  out.writeU8(a.predictor);
  if (a.coding == AttributeCoding::kLattice) {
    out.writeU8(a.bits);
    out.writeF32(a.lattice.step);
    for (uint32_t c = 0; c < f.component_count && f.morph_target == 0; ++c)
      out.writeF32(a.lattice.origin[c]);
  } else if (a.coding == AttributeCoding::kOctahedral ||
             a.coding == AttributeCoding::kTangentAngle) {
    out.writeU8(a.bits);
  } else if (a.coding == AttributeCoding::kGrid) {
    out.writeU8(static_cast<uint8_t>(a.bits | a.tails << 5));
    out.writeU8(a.grid);
  } else if (a.coding == AttributeCoding::kAlias) {
    out.writeVarint(a.alias_of);
  }
}

bool sameAttribute(const AttributeInfo& a, const AttributeInfo& b) {
  if (a.format != b.format || a.coding != b.coding || a.predictor != b.predictor ||
      a.bits != b.bits || a.alias_of != b.alias_of || a.grid != b.grid || a.tails != b.tails) {
    return false;
  }
  return a.coding != AttributeCoding::kLattice || a.lattice == b.lattice;
}

bool sameAttributes(const PayloadHeader& header, const PieceHeader& a, const PieceHeader& b) {
  if (a.attribute_count != b.attribute_count) return false;
  for (uint32_t i = 0; i < a.attribute_count; ++i) {
    if (!sameAttribute(header.attributes[a.first_attribute + i],
                       header.attributes[b.first_attribute + i])) {
      return false;
    }
  }
  return true;
}

void writePiece(ByteWriter& out, const PayloadHeader& header, size_t index) {
  const PieceHeader& piece = header.pieces[index];
  const bool same = index != 0 && sameAttributes(header, header.pieces[index - 1], piece);
  out.writeVarint(piece.flags | (same ? piece_flag::kSameAttributes : 0));
  out.writeVarint(piece.vertex_count);
  out.writeVarint(piece.face_count);
  if (!piece.hasPivots())
    out.writeVarint(zigzag(static_cast<int32_t>(piece.operation_count - piece.vertex_count)));
  out.writeVarint(zigzag(static_cast<int32_t>(piece.wedge_count - piece.vertex_count)));
  if (piece.has(piece_flag::kHoles)) out.writeVarint(piece.dummy_count);
  if (piece.has(piece_flag::kIsolated)) out.writeVarint(piece.isolated_count);
  if (piece.has(piece_flag::kListed)) out.writeVarint(piece.listed_count);
  if (piece.has(piece_flag::kManyParts)) {
    out.writeVarint(piece.part_count);
    for (uint32_t i = 0; i < piece.part_count; ++i) {
      out.writeVarint(header.parts[piece.first_part + i].triangle_count);
    }
  }
  if (same) return;
  out.writeVarint(piece.attribute_count);
  for (uint32_t i = 0; i < piece.attribute_count; ++i) {
    writeAttribute(out, header.attributes[piece.first_attribute + i]);
  }
}

}  // namespace

std::vector<uint8_t> writePayload(const PayloadHeader& header, std::span<const uint8_t> codes,
                                  std::span<const uint8_t> tokens, std::span<const uint8_t> raw) {
  ByteWriter pieces;
  if (header.pieces.size() > 1) pieces.writeVarint(static_cast<uint32_t>(header.pieces.size()));
  for (size_t i = 0; i < header.pieces.size(); ++i) writePiece(pieces, header, i);
  if (!header.singleCoder()) {
    pieces.writeVarint(static_cast<uint32_t>(codes.size()));
    pieces.writeVarint(static_cast<uint32_t>(tokens.size()));
  }
  const uint64_t needed = (elementsOf(header) + kMaxElementsPerByte - 1) / kMaxElementsPerByte;
  const uint64_t have =
      kChecksummedFrom + 1 + pieces.size() + codes.size() + tokens.size() + raw.size();
  uint32_t flags = header.flags;
  if (header.pieces.size() > 1) flags |= payload_flag::kManyPieces;
  if (needed > have) {
    flags |= payload_flag::kPadded;
    const uint32_t padding = static_cast<uint32_t>(needed - have);
    pieces.writeVarint(padding);
    pieces.bytes().resize(pieces.size() + padding, 0);
  }
  ByteWriter out;
  out.writeBytes(kMagic);
  out.writeU8(static_cast<uint8_t>(kVersionMajor << 4 | kVersionMinor));
  out.writeU32(0);
  out.writeU8(static_cast<uint8_t>(flags));
  out.writeBytes(pieces.bytes());
  out.writeBytes(codes);
  out.writeBytes(tokens);
  out.writeBytes(raw);
  const std::span<const uint8_t> all(out.bytes());
  const uint32_t checksum = crc32(all.subspan(kChecksummedFrom), crc32(all.first(kChecksumOffset)));
  for (size_t i = 0; i < 4; ++i) {
    out.bytes()[kChecksumOffset + i] = static_cast<uint8_t>(checksum >> (8 * i));
  }
  return std::move(out.bytes());
}

}  // namespace mcc
