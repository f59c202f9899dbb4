// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "writer/code_piece.h"

#include <algorithm>
#include <numeric>

#include "base/enc_exceptions.h"

namespace mcc {

namespace {

PieceResult resultOf(const Plan& plan, uint32_t group_count) {
  PieceResult piece;
  piece.source_wedge = plan.wedge_source;
  if (plan.header.has(piece_flag::kVertexOrder)) {
    std::iota(piece.source_wedge.begin(), piece.source_wedge.end(), 0u);
  }
  piece.topological_vertex_count = group_count;
  piece.cut_copy_count = plan.header.vertex_count - group_count;
  piece.hole_count = plan.cut.hole_count;
  piece.component_count = static_cast<uint32_t>(plan.cut.mesh.components.size());
  piece.leftover_triangle_count =
      static_cast<uint32_t>(plan.header.triangleCount()) - plan.header.face_count;
  return piece;
}

void scale(StreamSizes& sizes, double by) {
  for (double* bits : {&sizes.connectivity_bits, &sizes.stitch_bits, &sizes.leftover_bits,
                       &sizes.seam_bits, &sizes.position_bits, &sizes.order_bits}) {
    *bits *= by;
  }
  for (double& bits : sizes.attribute_bits) bits *= by;
  for (double& bits : sizes.piece_position_bits) bits *= by;
}

}  // namespace

Status codePiece(Plan& plan, EncoderIo& io, StageModels& models, size_t first_attribute,
                 EncodeResult& result, Rim* rim) {
  StreamSizes& sizes = result.sizes;
  StageRunner runner(io, models, plan, first_attribute);
  sizes.attribute_bits.resize(first_attribute + plan.attributes.size(), 0);
  MCC_TRY(runner.codeSurface(&sizes));
  const double bits_before = sizes.position_bits;
  MCC_TRY(runner.codePositions(&sizes));
  sizes.piece_position_bits.push_back(sizes.position_bits - bits_before);
  MCC_TRY(runner.codeSeams(&sizes));
  MCC_TRY(runner.codeOrders(&sizes));
  if (rim != nullptr && !rim->find(runner.mesh(), plan.header.wedge_count)) throwBadAlloc();
  MCC_TRY(runner.prepareAttributes());
  for (const uint32_t a : codingOrder(plan)) MCC_TRY(runner.codeAttribute(a, &sizes));
  result.pieces.push_back(resultOf(plan, runner.groupCount()));
  return {};
}

void addPiece(Plan& plan, PayloadHeader& header) {
  plan.header.first_attribute = static_cast<uint32_t>(header.attributes.size());
  plan.header.first_part = static_cast<uint32_t>(header.parts.size());
  for (const QuantizedAttribute& a : plan.attributes) {
    if (!header.attributes.push_back(a.info)) throwBadAlloc();
  }
  for (const PartInfo& part : plan.parts) {
    if (!header.parts.push_back(part)) throwBadAlloc();
  }
  if (!header.pieces.push_back(plan.header)) throwBadAlloc();
}

/// The counted costs are slightly off: over millions of tokens, the error may exceed what flushing
/// adds to the streams.
void accountHeader(double coded_bits, uint64_t stream_bytes, EncodeResult& result) {
  const double spent_bits = std::min(coded_bits, 8.0 * static_cast<double>(stream_bytes));
  if (spent_bits < coded_bits) scale(result.sizes, spent_bits / coded_bits);
  result.sizes.header_bits = 8.0 * static_cast<double>(result.payload.size()) - spent_bits;
}

}  // namespace mcc
