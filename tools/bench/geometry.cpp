// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/geometry.h"

#include <algorithm>

#include "gltf/compress/quantize.h"
#include "gltf/decompress/coded_input.h"
#include "gltf/files/file_io.h"
#include "host/parallel.h"

namespace mcc::bench {
namespace {

using gltf::PayloadPlan;
using gltf::PiecePlan;

/// Drops parts no wanted primitive uses, and what becomes empty by that.
void applyFilter(const PrimitiveFilter& wanted, std::vector<PayloadPlan>& plans) {
  const auto is_unwanted_part = [&](const gltf::PartPlan& part) {
    return std::none_of(part.users.begin(), part.users.end(),
                        [&](const auto& user) { return wanted(user.mesh, user.primitive); });
  };
  for (PayloadPlan& plan : plans) {
    for (PiecePlan& piece : plan.pieces) std::erase_if(piece.parts, is_unwanted_part);
    std::erase_if(plan.pieces, [](const PiecePlan& piece) { return piece.parts.empty(); });
  }
  std::erase_if(plans, [](const PayloadPlan& plan) { return plan.pieces.empty(); });
}

void addInputs(Geometry& geometry) {
  for (const gltf::EncodedPayload& payload : geometry.payloads) {
    PayloadInput input;
    for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
      input.pieces.push_back(makePiece(payload.plan.pieces[i], false));
      const PieceInput& piece = input.pieces.back();
      geometry.has_left_out = geometry.has_left_out || piece.has_left_out;
      geometry.wedge_count += piece.wedge_count;
      if (i < payload.result.pieces.size()) {
        geometry.vertex_count += payload.result.pieces[i].topological_vertex_count;
      }
      for (const PartView& part : piece.parts) geometry.triangle_count += part.indices.size() / 3;
    }
    geometry.inputs.push_back(std::move(input));
  }
}

gltf::Result load(const std::filesystem::path& path, std::span<const uint8_t> file,
                  const gltf::ConvertOptions& options, const PrimitiveFilter& wanted,
                  OurPayloads ours, Geometry& geometry) {
  MCC_GLTF_TRY(gltf::loadDocument(file, gltf::readerOf(path.parent_path()), geometry.document));
  gltf::Result refused;
  MCC_GLTF_TRY(gltf::decodeViews(options.decoders, geometry.document, nullptr, &refused));
  MCC_GLTF_TRY(gltf::decodeMeshes(options.decoders, geometry.document, &refused));
  std::vector<PayloadPlan> plans;
  std::vector<gltf::LeftAlone> left_alone;
  MCC_GLTF_TRY(gltf::planPayloads(geometry.document, plans, left_alone));
  gltf::planQuantization(options, plans, geometry.notes);
  if (wanted) applyFilter(wanted, plans);
  if (ours == OurPayloads::kEncoded) {
    MCC_GLTF_TRY(gltf::encodePayloads(options, std::move(plans), geometry.payloads, left_alone));
  } else {
    for (PayloadPlan& plan : plans) geometry.payloads.emplace_back().plan = std::move(plan);
  }
  if (geometry.payloads.empty() && !refused.ok()) return refused;
  for (const gltf::LeftAlone& left : left_alone) {
    geometry.notes.push_back(left.primitive.path() + ": " + left.note);
  }
  geometry.prefer = options.prefer;
  geometry.block_triangles = options.block_triangles;
  addInputs(geometry);
  return {};
}

}  // namespace

gltf::Result loadGeometry(const std::filesystem::path& path, std::span<const uint8_t> file,
                          const gltf::ConvertOptions& options, const PrimitiveFilter& wanted,
                          Geometry& geometry, OurPayloads ours) {
  gltf::Result result =
      gltf::guarded([&]() { return load(path, file, options, wanted, ours, geometry); });
  if (!result.ok()) {
    result.where = path.string() + (result.where.empty() ? "" : ": " + result.where);
  }
  return result;
}

bool isLeftOut(const AttributeFormat& format) {
  return format.morph_target != 0 || format.component_count > 4;
}

PieceInput makePiece(const PiecePlan& plan, bool keep_all) {
  PieceInput piece;
  piece.wedge_count = plan.wedge_count;
  for (const gltf::AttributePlan& attribute : plan.attributes) {
    if (!keep_all && isLeftOut(attribute.format)) {
      piece.has_left_out = true;
      continue;
    }
    piece.source.push_back(attribute.view());
    piece.labels.push_back(attribute.label());
  }
  for (const gltf::PartPlan& part : plan.parts) piece.parts.push_back({part.triangles});
  return piece;
}

std::vector<PrimitiveInput> primitivesOf(const Geometry& geometry) {
  std::vector<PrimitiveInput> primitives;
  for (const PayloadInput& input : geometry.inputs) {
    for (const PieceInput& piece : input.pieces) {
      for (size_t part = 0; part < piece.parts.size(); ++part) primitives.push_back({&piece, part});
    }
  }
  return primitives;
}

}  // namespace mcc::bench
