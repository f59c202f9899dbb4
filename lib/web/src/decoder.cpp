// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the WebAssembly decoder exports; core.mjs is the only caller. An instance decodes one
// payload at a time: allocate() bytes for the payload, fill them, open(), read table(), decode(),
// copy the outputs, close().
//
// The table describes the whole payload in 32-bit words:
//   number of pieces; for each piece: wedges, vertices, attributes, parts;
//   for each attribute: semantic, set, component type, normalized, components, morph target,
//   address;
//   for each part: triangles, bytes of an index, address.
// The addresses are those of the outputs; they are valid after decode().
#include <algorithm>
#include <cstdlib>

#include "base/memory.h"
#include "mcc/reader.h"

#define MCC_EXPORT(name) extern "C" __attribute__((export_name(name), used))

namespace mcc {
namespace {

constexpr uint32_t kPieceWords = 4;
constexpr uint32_t kAttributeWords = 7;
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

/// The open payload and everything that belongs to it.
struct Session {
  Payload payload;
  Array<uint32_t> table;
  Array<AttributeTarget> attributes;
  Array<PartTarget> parts;
  Array<PieceTarget> pieces;
  Array<uint8_t> outputs;

  Status open(std::span<const uint8_t> bytes, const Limits& limits) {
    MCC_TRY(payload.open(bytes, limits));
    if (!describe()) return fail(Error::kOutOfMemory, "no memory for the header");
    return {};
  }

  Status decode(IndexType widest_short) {
    MCC_TRY(placeOutputs(widest_short));
    return payload.decode({pieces.data(), pieces.size()});
  }

 private:
  bool describe() {
    const std::span<const PieceInfo> infos = payload.info().pieces;
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
    }
    for (const PartInfo& part : piece.parts) {
      add(part.triangle_count);
      add(0);
      add(0);
    }
  }

  /// Cannot fail, because the table was reserved as a whole.
  void add(size_t word) { (void)table.push_back(static_cast<uint32_t>(word)); }

  /// Places all outputs in one block. Indices have the type `widest_short` if it can hold them,
  /// else 32 bits. (The largest value of a type is not a valid index in glTF.)
  Status placeOutputs(IndexType widest_short) {
    const uint64_t bytes = layOut(widest_short, nullptr);
    if (bytes > SIZE_MAX || !outputs.resize(static_cast<size_t>(bytes)))
      return fail(Error::kOutOfMemory, "no memory for the decoded mesh");
    layOut(widest_short, outputs.data());
    return {};
  }

  /// Returns the number of bytes of all outputs. Assigns their addresses too, unless `memory` is
  /// null.
  uint64_t layOut(IndexType widest_short, uint8_t* memory) {
    uint64_t bytes = 0;
    const auto place = [&](uint64_t size) {
      uint8_t* at = memory == nullptr ? nullptr : memory + bytes;
      bytes += (size + kAlignmentBytes - 1) / kAlignmentBytes * kAlignmentBytes;
      return at;
    };
    const std::span<const PieceInfo> infos = payload.info().pieces;
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
        word[kAttributeWords - 1] = addressOf(attribute++->data);
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

uint32_t numberOf(Status status) { return static_cast<uint32_t>(status.error); }

}  // namespace
}  // namespace mcc

using namespace mcc;

MCC_EXPORT("allocate") void* mccAllocate(size_t bytes) { return std::malloc(bytes); }

/// Returns the error's number. The limits are those of mcc::Limits.
MCC_EXPORT("open")
uint32_t mccOpen(const uint8_t* bytes, size_t size, double max_vertices, double max_triangles,
                 double max_attributes, double max_pieces, double max_elements,
                 double max_output_bytes) {
  Limits limits;
  limits.max_vertices = std::min(limits.max_vertices, limitOf(max_vertices));
  limits.max_triangles = std::min(limits.max_triangles, limitOf(max_triangles));
  limits.max_attributes = std::min(limits.max_attributes, shortLimitOf(max_attributes));
  limits.max_pieces = std::min(limits.max_pieces, shortLimitOf(max_pieces));
  limits.max_elements = limitOf(max_elements);
  limits.max_output_bytes = limitOf(max_output_bytes);
  return numberOf(session.open({bytes, size}, limits));
}

MCC_EXPORT("table") const uint32_t* mccTable() { return session.table.data(); }

/// Decodes, and returns the error's number. `short_indices` asks for 16-bit indices where they
/// suffice.
MCC_EXPORT("decode") uint32_t mccDecode(uint32_t short_indices) {
  return numberOf(session.decode(short_indices != 0 ? IndexType::kUint16 : IndexType::kUint32));
}

/// Releases the payload, including its `bytes`, and its outputs.
MCC_EXPORT("close") void mccClose(void* bytes) {
  session = Session();
  std::free(bytes);
}
