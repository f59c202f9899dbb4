// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exports the edges of a payload's collapse to programs that draw it; encoder.mjs is the only
// caller.
#include <span>
#include <vector>

#include "base/status.h"
#include "mcc/reader.h"

#define MCC_EXPORT(name) extern "C" __attribute__((export_name(name), used))

namespace {

std::vector<uint32_t> edges;
size_t piece_count = 0;
mcc::Status status;

/// Decodes for the edges alone; attributes and triangles are dropped.
mcc::Status collectEdges(std::span<const uint8_t> bytes) {
  mcc::Payload payload;
  MCC_TRY(payload.open(bytes));
  std::vector<std::vector<mcc::AttributeTarget>> attributes;
  std::vector<std::vector<mcc::PartTarget>> parts;
  std::vector<mcc::PieceTarget> targets;
  for (const mcc::PieceInfo& piece : payload.info().pieces) {
    attributes.emplace_back(piece.attributes.size());
    parts.emplace_back(piece.parts.size());
    targets.push_back({attributes.back(), parts.back()});
  }
  mcc::DecodeOptions options;
  options.mc_edge = [](void*, uint32_t piece, uint32_t vertex, uint32_t from) {
    edges.insert(edges.end(), {piece, vertex, from});
  };
  edges.clear();
  piece_count = targets.size();
  return payload.decode(targets, options);
}

}  // namespace

/// Returns 1 on success; edges() then has three words per mc-edge: piece, vertex, from; sorted by
/// piece. Returns 0 on failure; edgesError() then tells why.
MCC_EXPORT("findEdges") uint32_t mccFindEdges(const uint8_t* bytes, size_t size) {
  status = collectEdges({bytes, size});
  return status.ok() ? 1 : 0;
}
MCC_EXPORT("edgesPieces") size_t mccEdgesPieces() { return piece_count; }
MCC_EXPORT("edges") const uint32_t* mccEdges() { return edges.data(); }
MCC_EXPORT("edgesWords") size_t mccEdgesWords() { return edges.size(); }
/// Returns the error message, which ends with a zero.
MCC_EXPORT("edgesError") const char* mccEdgesError() { return status.what; }
