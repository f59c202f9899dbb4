// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "container/enc_payload.h"

#include <bit>

#include "base/enc_bytes.h"
#include "format/usual.h"

namespace mcc {
namespace {

void writeLattice(ByteWriter& out, AttributeInfos before, const AttributeInfo& a) {
  const uint32_t origins = a.format.morph_target == 0 ? a.format.component_count : 0;
  ByteWriter floats;
  uint32_t forms = a.bits;
  const auto add = [&](uint32_t place, float value, float usual) {
    const uint32_t form = formOf(value, usual);
    forms |= form << (kLatticeBitsBits + kFormBits * place);
    if (form != kUsualForm) floats.writeHighBytes(std::bit_cast<uint32_t>(value), 4 - form);
  };
  add(0, a.lattice.step, usualStep(before, a));
  for (uint32_t c = 0; c < origins; ++c) add(1 + c, a.lattice.origin[c], 0);
  out.writeVarint(forms);
  out.writeBytes(floats.bytes());
}

void writeAttribute(ByteWriter& out, AttributeInfos before, const AttributeInfo& a) {
  const AttributeFormat& f = a.format;
  const bool more = f.set_index != 0 || f.morph_target != 0;
  const bool typed = !isUsualType(f);
  out.writeU8(static_cast<uint8_t>(static_cast<uint32_t>(f.semantic) |
                                   static_cast<uint32_t>(a.coding) << 3 |
                                   (typed ? kTypeStated : 0u) | (more ? kMoreStated : 0u)));
  if (typed) {
    out.writeU8(static_cast<uint8_t>(static_cast<uint32_t>(f.component_type) |
                                     (f.component_count - 1u) << 3 | (f.normalized ? 0x80u : 0u)));
  }
  if (more) {
    out.writeU8(f.set_index);
    out.writeVarint(f.morph_target);
  }
  out.writeU8(a.predictor);
  if (a.coding == AttributeCoding::kLattice) {
    writeLattice(out, before, a);
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
  const AttributeInfos attributes = header.attributesOf(piece);
  for (uint32_t i = 0; i < piece.attribute_count; ++i)
    writeAttribute(out, attributes.first(i), attributes[i]);
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
  out.writeU8(kMagic);
  out.writeU8(static_cast<uint8_t>(kVersionMajor << 4 | kVersionMinor));
  out.writeU32(0);
  out.writeU8(static_cast<uint8_t>(flags));
  out.writeBytes(pieces.bytes());
  out.writeBytes(codes);
  out.writeBytes(tokens);
  out.writeBytes(raw);
  const uint32_t checksum = checksumOf(out.bytes());
  for (size_t i = 0; i < 4; ++i) {
    out.bytes()[kChecksumOffset + i] = static_cast<uint8_t>(checksum >> (8 * i));
  }
  return std::move(out.bytes());
}

}  // namespace mcc
