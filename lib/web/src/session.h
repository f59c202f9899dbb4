// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_WEB_SESSION_H_
#define MCC_WEB_SESSION_H_

// A part of decoder.cpp. The namespace has no name, because the core is smaller when the compiler
// knows that nothing else calls these functions.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/memory.h"
#include "format/decodes.h"
#include "mcc/reader.h"

namespace mcc {
namespace {

constexpr uint32_t kPieceWords = 4;
constexpr uint32_t kAttributeWords = 9;
constexpr uint32_t kAddressWord = 6;  ///< of an attribute
constexpr uint32_t kPartWords = 3;
constexpr uint64_t kAlignmentBytes = 8;

/// Converts a number of JavaScript. Infinity becomes the largest number, and NaN becomes 0, so that
/// a mistake limits too much rather than nothing.
uint64_t limitOf(double number) {
  return static_cast<uint64_t>(__builtin_wasm_trunc_saturate_u_i64_f64(number));
}
uint32_t shortLimitOf(double number) {
  return static_cast<uint32_t>(__builtin_wasm_trunc_saturate_u_i32_f64(number));
}

/// The arguments are those of the exports that open a payload.
Limits limitsOf(double max_vertices, double max_triangles, double max_attributes, double max_pieces,
                double max_elements, double max_output_bytes) {
  Limits limits;
  limits.max_vertices = std::min(limits.max_vertices, limitOf(max_vertices));
  limits.max_triangles = std::min(limits.max_triangles, limitOf(max_triangles));
  limits.max_attributes = std::min(limits.max_attributes, shortLimitOf(max_attributes));
  limits.max_pieces = std::min(limits.max_pieces, shortLimitOf(max_pieces));
  limits.max_elements = limitOf(max_elements);
  limits.max_output_bytes = limitOf(max_output_bytes);
  return limits;
}

static_assert(offsetof(Lattice, step) == 4 * sizeof(float), "core.mjs reads origin, then step");

/// The open payload and everything that belongs to it. The table is described in decoder.cpp.
struct Session {
  Payload payload;
  Array<uint32_t> table;
  Array<AttributeTarget> attributes;
  Array<PartTarget> parts;
  Array<PieceTarget> pieces;
  Array<uint8_t> outputs;

  Status open(std::span<const uint8_t> bytes, const Limits& limits) {
    MCC_TRY(payload.open(bytes, limits));
    return describe();
  }

  Status decode(IndexType widest_short) {
    MCC_TRY(placeOutputs(widest_short));
    return payload.decode({pieces.data(), pieces.size()});
  }

  /// Makes the table.
  Status describe() {
    if (!list()) return fail(Error::kOutOfMemory, "no memory for the header");
    return {};
  }

  /// Places all outputs in one block. Indices have the type `widest_short` if it can hold them,
  /// else 32 bits. (The largest value of a type is not a valid index in glTF.)
  Status placeOutputs(IndexType widest_short) {
    const uint64_t bytes = layOut(widest_short, nullptr);
    if (bytes > SIZE_MAX || !outputs.resize(static_cast<size_t>(bytes)))
      return fail(Error::kOutOfMemory, "no memory for the decoded mesh");
    layOut(widest_short, outputs.data());
    return {};
  }

#if !defined(MCC_CORE)
  const PieceInfo* block = nullptr;  ///< what takes the place of the payload's pieces
  std::span<const PieceInfo> shown() const {
    return block == nullptr ? payload.info().pieces : std::span<const PieceInfo>(block, 1);
  }
#else
  std::span<const PieceInfo> shown() const { return payload.info().pieces; }
#endif

 private:
  bool list() {
    const std::span<const PieceInfo> infos = shown();
    if constexpr (decodes::kBlocks) table.clear();
    size_t attribute_count = 0;
    size_t part_count = 0;
    for (const PieceInfo& piece : infos) {
      attribute_count += piece.attributes.size();
      part_count += piece.parts.size();
    }
    if (!table.reserve(1 + kPieceWords * infos.size() + kAttributeWords * attribute_count +
                       kPartWords * part_count) ||
        !attributes.resize(attribute_count) || !parts.resize(part_count) ||
        !pieces.resize(infos.size())) {
      return false;
    }
    add(infos.size());
    for (const PieceInfo& piece : infos) describePiece(piece);
    return true;
  }

  void describePiece(const PieceInfo& piece) {
    add(piece.wedge_count);
    add(piece.vertex_count);
    add(piece.attributes.size());
    add(piece.parts.size());
    for (const AttributeInfo& attribute : piece.attributes) {
      const AttributeFormat& format = attribute.format;
      add(static_cast<uint32_t>(format.semantic));
      add(format.set_index);
      add(static_cast<uint32_t>(format.component_type));
      add(format.normalized ? 1 : 0);
      add(format.component_count);
      add(format.morph_target);
      add(0);
      const bool is_lattice = attribute.coding == AttributeCoding::kLattice;
      const bool is_quantised = is_lattice || attribute.coding == AttributeCoding::kOctahedral ||
                                attribute.coding == AttributeCoding::kTangentAngle;
      add(is_quantised ? attribute.bits : 0);
      add(is_lattice ? addressOf(&attribute.lattice) : 0);
    }
    for (const PartInfo& part : piece.parts) {
      add(part.triangle_count);
      add(0);
      add(0);
    }
  }

  /// Cannot fail, because the table was reserved as a whole.
  void add(size_t word) { (void)table.push_back(static_cast<uint32_t>(word)); }

  /// Returns the number of bytes of all outputs. Assigns their addresses too, unless `memory` is
  /// null.
  uint64_t layOut(IndexType widest_short, uint8_t* memory) {
    const std::span<const PieceInfo> infos = shown();
    uint64_t bytes = 0;
    const auto place = [&](uint64_t size) {
      uint8_t* at = memory == nullptr ? nullptr : memory + bytes;
      bytes += (size + kAlignmentBytes - 1) / kAlignmentBytes * kAlignmentBytes;
      return at;
    };
    AttributeTarget* attribute = attributes.data();
    PartTarget* part = parts.data();
    uint32_t* word = table.data() + 1;
    for (size_t i = 0; i < infos.size(); ++i) {
      const PieceInfo& piece = infos[i];
      pieces[i] = {{attribute, piece.attributes.size()}, {part, piece.parts.size()}};
      word += kPieceWords;
      for (const AttributeInfo& info : piece.attributes) {
        const uint32_t stride = elementBytes(info.format);
        *attribute = {place(uint64_t{piece.wedge_count} * stride), stride};
        word[kAddressWord] = addressOf(attribute++->data);
        word += kAttributeWords;
      }
      const bool is_short = widest_short == IndexType::kUint16 && piece.wedge_count <= 0xffff;
      const IndexType type = is_short ? IndexType::kUint16 : IndexType::kUint32;
      for (const PartInfo& info : piece.parts) {
        *part = {place(uint64_t{3} * info.triangle_count * static_cast<uint32_t>(type)), type};
        word[1] = static_cast<uint32_t>(type);
        word[2] = addressOf(part++->indices);
        word += kPartWords;
      }
    }
    return bytes;
  }

  static uint32_t addressOf(const void* pointer) {
    return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(pointer));
  }
};

Session session;

}  // namespace
}  // namespace mcc

#endif  // MCC_WEB_SESSION_H_
