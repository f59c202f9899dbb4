// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "container/enc_payload.h"

#include <algorithm>
#include <bit>

#include "base/bytes.h"
#include "base/enc_bytes.h"
#include "format/predictors.h"
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

void writePieces(ByteWriter& out, const PayloadHeader& header) {
  if (header.pieces.size() > 1) out.writeVarint(static_cast<uint32_t>(header.pieces.size()));
  for (size_t i = 0; i < header.pieces.size(); ++i) writePiece(out, header, i);
}

/// [A.11.1]
void writeBlock(ByteWriter& out, const PayloadHeader& header, size_t index) {
  const BlockHeader& block = header.blocks[index];
  if (index != 0) {
    out.writeVarint(block.repeated_count);
    out.writeVarint(block.exception_count);
    uint32_t next = 0;
    for (const BlockException& exception : header.exceptionsOf(block)) {
      out.writeVarint(exception.wedge - next);
      out.writeVarint(exception.number == kNone ? 0 : block.first_wedge - exception.number);
      next = exception.wedge + 1;
    }
  }
  out.writeVarint(block.codes_bytes);
  out.writeVarint(block.tokens_bytes);
  out.writeVarint(block.raw_bytes);
  out.writeU32(block.checksum);
  for (uint32_t s = 0; s < 3; ++s) {
    out.writeVarint(zigzag(block.box.low[s]));
    out.writeVarint(static_cast<uint32_t>(block.box.high[s]) -
                    static_cast<uint32_t>(block.box.low[s]));
  }
}

/// Adds the padding that the elements of the header ask for, if the payload would otherwise have
/// `have_bytes`. Returns the payload's flags. [A.2.6]
uint32_t writePadding(ByteWriter& out, const PayloadHeader& header, uint64_t have_bytes) {
  const uint32_t flags = header.flags | (header.pieces.size() > 1 ? payload_flag::kManyPieces : 0u);
  const uint64_t needed = (elementsOf(header) + kMaxElementsPerByte - 1) / kMaxElementsPerByte;
  if (needed <= have_bytes) return flags;
  const uint32_t padding = static_cast<uint32_t>(needed - have_bytes);
  out.writeVarint(padding);
  out.bytes().resize(out.size() + padding, 0);
  return flags | payload_flag::kPadded;
}

/// The lowest version that has everything the payload uses.
uint8_t neededMinorVersion(const PayloadHeader& header) {
  uint8_t version = (header.flags & payload_flag::kSinceMinor1) != 0 ? 1 : 0;
  for (size_t p = 0; p < header.pieces.size(); ++p) {
    if (header.pieces[p].hasMates()) version = std::max(version, uint8_t{1});
    const AttributeInfos attributes = header.attributesOf(header.pieces[p]);
    for (uint32_t i = 0; i < attributes.size(); ++i) {
      const AttributeMethod method = methodOf(attributes, i);
      version = std::max(version, minorVersionOf(method, attributes[i].predictor));
    }
  }
  return version;
}

ByteWriter beginPayload(const PayloadHeader& header, uint32_t flags) {
  ByteWriter out;
  out.writeU8(kMagic);
  out.writeU8(static_cast<uint8_t>(kVersionMajor << 4 | neededMinorVersion(header)));
  out.writeU32(0);  // the checksum
  out.writeU8(static_cast<uint8_t>(flags));
  return out;
}

std::vector<uint8_t> endPayload(ByteWriter& out) {
  const uint32_t checksum = checksumOf(std::span<const uint8_t>(out.bytes()));
  for (size_t i = 0; i < 4; ++i) {
    out.bytes()[kChecksumOffset + i] = static_cast<uint8_t>(checksum >> (8 * i));
  }
  return std::move(out.bytes());
}

void writeStreams(ByteWriter& out, const Streams& streams) {
  out.writeBytes(streams.codes);
  out.writeBytes(streams.tokens);
  out.writeBytes(streams.raw);
}

uint64_t bytesOf(const Streams& streams) {
  return uint64_t{streams.codes.size()} + streams.tokens.size() + streams.raw.size();
}

}  // namespace

std::vector<uint8_t> writePayload(const PayloadHeader& header, const Streams& streams) {
  ByteWriter pieces;
  writePieces(pieces, header);
  if (!header.singleCoder()) {
    pieces.writeVarint(static_cast<uint32_t>(streams.codes.size()));
    pieces.writeVarint(static_cast<uint32_t>(streams.tokens.size()));
  }
  const uint64_t have = kChecksummedFrom + 1 + pieces.size() + bytesOf(streams);
  ByteWriter out = beginPayload(header, writePadding(pieces, header, have));
  out.writeBytes(pieces.bytes());
  writeStreams(out, streams);
  return endPayload(out);
}

std::vector<uint8_t> writeBlocks(PayloadHeader& header, std::span<const Streams> streams) {
  ByteWriter pieces;
  writePieces(pieces, header);
  uint64_t stream_bytes = 0;
  for (size_t i = 0; i < streams.size(); ++i) {
    BlockHeader& block = header.blocks[i];
    block.codes_bytes = static_cast<uint32_t>(streams[i].codes.size());
    block.tokens_bytes = static_cast<uint32_t>(streams[i].tokens.size());
    block.raw_bytes = static_cast<uint32_t>(streams[i].raw.size());
    block.checksum = checksumOf(streams[i]);
    stream_bytes += block.streamBytes();
    writeBlock(pieces, header, i);
  }
  const uint64_t have = kChecksummedFrom + 1 + pieces.size() + stream_bytes;
  ByteWriter out = beginPayload(header, writePadding(pieces, header, have));
  const size_t other_bytes = out.size() + pieces.size();
  size_t length_bytes = 1;  // of the header's length, which counts its own bytes too
  while ((other_bytes + length_bytes) >> (7 * length_bytes) != 0) ++length_bytes;
  out.writeVarint(static_cast<uint32_t>(other_bytes + length_bytes));
  out.writeBytes(pieces.bytes());
  for (const Streams& of_block : streams) writeStreams(out, of_block);
  return endPayload(out);
}

}  // namespace mcc
