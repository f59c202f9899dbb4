// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the WebAssembly decoder exports; core.mjs is the only caller. An instance decodes one
// payload at a time: allocate() bytes for the payload, fill them, open(), read table(), decode(),
// copy the outputs, close().
//
// The table describes the whole payload in 32-bit words:
//   number of pieces; for each piece: wedges, vertices, attributes, parts;
//   for each attribute: semantic, set, component type, normalized, components, morph target,
//   address, bits of quantised floats or 0, address of the lattice (origin: 4 floats, step: a
//   float) or 0;
//   for each part: triangles, bytes of an index, address.
// The addresses are those of the outputs; they are valid after decode().
//
// The whole decoder also decodes and numbers blocks; for that, block_decoder.mjs is the only
// caller. An instance opens one payload for good: open_prefix() with its beginning, until that is
// not truncated; then in any order decode_block(), or in the order of blocks number_block(). After
// decode_block(), table() describes the block as if it were the only piece. The table of blocks has
// in 32-bit words:
//   bytes of the header, number of blocks; for each block: wedges, repeated wedges, triangles,
//   where its streams begin, their bytes, box: 3 floats, 3 floats.
#include <cstdlib>

#include "session.h"
#if !defined(MCC_CORE)
#include "block_session.h"
#endif

#define MCC_EXPORT(name) extern "C" __attribute__((export_name(name), used))

namespace mcc {
namespace {

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
  return numberOf(
      session.open({bytes, size}, limitsOf(max_vertices, max_triangles, max_attributes, max_pieces,
                                           max_elements, max_output_bytes)));
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

#if !defined(MCC_CORE)

/// Opens the beginning of a payload with blocks; may be called again with more bytes if it was
/// truncated. Returns the error's number. The limits are those of mcc::Limits.
MCC_EXPORT("open_prefix")
uint32_t mccOpenPrefix(const uint8_t* bytes, size_t size, double payload_bytes, double max_vertices,
                       double max_triangles, double max_attributes, double max_pieces,
                       double max_elements, double max_output_bytes) {
  blocks.emplace();
  return numberOf(blocks->open({bytes, size}, limitOf(payload_bytes),
                               limitsOf(max_vertices, max_triangles, max_attributes, max_pieces,
                                        max_elements, max_output_bytes)));
}

MCC_EXPORT("blocks") const uint32_t* mccBlocks() { return blocks->words(); }

/// Decodes a block in its own numbers, and returns the error's number.
MCC_EXPORT("decode_block")
uint32_t mccDecodeBlock(uint32_t index, uint32_t short_indices, uint32_t finds_rim) {
  const IndexType widest_short = short_indices != 0 ? IndexType::kUint16 : IndexType::kUint32;
  return numberOf(blocks->decode(index, widest_short, finds_rim != 0));
}

/// The rim of the block that was decoded last: its wedges, and the words of all their tuples.
MCC_EXPORT("rim_count") uint32_t mccRimCount() { return blocks->rim().wedges.size(); }
MCC_EXPORT("rim_wedges") const uint32_t* mccRimWedges() { return blocks->rim().wedges.data(); }
MCC_EXPORT("rim_words") uint32_t mccRimWords() { return blocks->rim().tuples.size(); }
MCC_EXPORT("rim_tuples") const int32_t* mccRimTuples() { return blocks->rim().tuples.data(); }

/// Numbers the wedges of the next block, from its rim. Returns the error's number.
MCC_EXPORT("number_block")
uint32_t mccNumberBlock(const uint32_t* wedges, size_t wedge_count, const int32_t* tuples,
                        size_t word_count) {
  return numberOf(blocks->number({wedges, wedge_count}, {tuples, word_count}));
}

MCC_EXPORT("numbers") const uint32_t* mccNumbers() { return blocks->numbers(); }

MCC_EXPORT("release") void mccRelease(void* bytes) { std::free(bytes); }

#endif
