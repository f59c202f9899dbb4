// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/api/convert_report.h"

#include <map>

namespace mcc::gltf {
namespace {

void addStreams(const StreamSizes& sizes, PayloadReport& report) {
  report.streams = {{"connectivity", sizes.connectivity_bits},
                    {"stitching", sizes.stitch_bits},
                    {"leftovers", sizes.leftover_bits},
                    {"seams", sizes.seam_bits},
                    {"order", sizes.order_bits},
                    {"header", sizes.header_bits}};
}

void addCounts(const EncodedPayload& payload, PayloadReport& report) {
  report.mesh = payload.plan.mesh;
  report.same_as = payload.same_as;
  report.freed_bytes = payload.freed_bytes;
  report.piece_count = static_cast<uint32_t>(payload.plan.pieces.size());
  report.block_count = payload.result.block_count;
  report.whole_because = payload.result.whole_because;
  for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
    const PiecePlan& piece = payload.plan.pieces[i];
    const PieceResult& result = payload.result.pieces[i];
    report.wedge_count += piece.wedge_count;
    report.vertex_count += result.topological_vertex_count;
    report.component_count += result.component_count;
    report.hole_count += result.hole_count;
    report.cut_copy_count += result.cut_copy_count;
    report.leftover_triangle_count += result.leftover_triangle_count;
    for (const PartPlan& part : piece.parts) report.triangle_count += part.triangles.size() / 3;
  }
}

/// Adds the coded bits to the measured attributes.
void addAttributeBits(const EncodedPayload& payload, const std::vector<size_t>& rows,
                      std::vector<AttributeReport>& attributes) {
  const StreamSizes& sizes = payload.result.sizes;
  size_t next = 0;
  for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
    for (const AttributePlan& attribute : payload.plan.pieces[i].attributes) {
      double bits = next < sizes.attribute_bits.size() ? sizes.attribute_bits[next] : 0;
      const bool is_position = attribute.format.semantic == Semantic::kPosition &&
                               attribute.target == kNone && i < sizes.piece_position_bits.size();
      if (is_position) bits += sizes.piece_position_bits[i];
      attributes[rows[next++]].coded_bits += bits;
    }
  }
}

}  // namespace

void addPrimitives(const Document& document, const Compressed& compressed, ConvertReport& report) {
  std::map<PrimitiveRef, PrimitiveReport> known;
  for (uint32_t i = 0; i < compressed.payloads.size(); ++i) {
    const EncodeResult& result = compressed.payloads[i].result;
    if (!result.whole_because.empty()) {
      report.remarks.push_back(at("/meshes", compressed.payloads[i].plan.mesh) +
                               ": is not cut into blocks: " + result.whole_because);
    }
    for (const PiecePlan& piece : compressed.payloads[i].plan.pieces) {
      for (const PartPlan& part : piece.parts) {
        for (const PrimitiveRef& user : part.users) {
          PrimitiveReport& row = known[user];
          row.compressed = true;
          row.payload = i;
          row.triangle_count = part.triangles.size() / 3;
          row.wedge_count = piece.wedge_count;
        }
      }
    }
  }
  for (const EncodedPayload& preview : compressed.previews) {
    report.preview_bytes += preview.result.payload.size();
    for (const PiecePlan& piece : preview.plan.pieces) {
      for (const PartPlan& part : piece.parts) {
        for (const PrimitiveRef& user : part.users) {
          known[user].preview_triangle_count = part.triangles.size() / 3;
        }
      }
    }
  }
  for (const LeftAlone& left : compressed.left_alone) {
    known[left.primitive].note = left.note;
    (left.is_larger ? report.remarks : report.notes)
        .push_back(left.primitive.path() + ": " + left.note);
  }
  for (const Primitive& primitive : document.primitives) {
    PrimitiveReport& row = known[primitive.ref];
    row.mesh = primitive.ref.mesh;
    row.primitive = primitive.ref.primitive;
    report.primitives.push_back(std::move(row));
  }
}

void addPayloads(const std::vector<EncodedPayload>& payloads,
                 const std::vector<PayloadProof>& proofs, ConvertReport& report) {
  for (size_t i = 0; i < payloads.size(); ++i) {
    PayloadReport payload;
    addCounts(payloads[i], payload);
    payload.attributes = proofs[i].attributes;
    if (payloads[i].same_as == kNone) {  // else it takes no bytes
      payload.payload_bytes = payloads[i].result.payload.size();
      addStreams(payloads[i].result.sizes, payload);
      addAttributeBits(payloads[i], proofs[i].rows, payload.attributes);
    }
    report.payloads.push_back(std::move(payload));
  }
}

}  // namespace mcc::gltf
