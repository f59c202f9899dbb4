// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writer: prepares every piece (writer/plan.h), makes the format's choices on a counting coder
// (writer/choices.h), then runs the stages of reader/piece.h with the real one (writer/stages.h).
#include "mcc/writer.h"

#include <algorithm>
#include <numeric>

#include "base/enc_exceptions.h"
#include "container/enc_payload.h"
#include "positions/enc_prices.h"
#include "writer/choices.h"
#include "writer/settings.h"
#include "writer/stages.h"

namespace mcc {
namespace {

constexpr uint32_t kSingleCoderVertices = 2000;  ///< up to here the single coder is also tried

void scale(StreamSizes& sizes, double by) {
  for (double* bits : {&sizes.connectivity_bits, &sizes.stitch_bits, &sizes.leftover_bits,
                       &sizes.seam_bits, &sizes.position_bits, &sizes.order_bits}) {
    *bits *= by;
  }
  for (double& bits : sizes.attribute_bits) bits *= by;
  for (double& bits : sizes.piece_position_bits) bits *= by;
}

Status codeAll(std::vector<Plan>& plans, uint32_t context_set, bool single, EncodeResult& result) {
  EncoderIo io(single);
  auto models = makeModels(context_set);
  PayloadHeader header{Allocator{}};
  header.flags =
      context_set << payload_flag::kContextSetShift | (single ? payload_flag::kSingleCoder : 0);
  result.sizes = StreamSizes{};
  result.pieces.clear();
  for (Plan& plan : plans) {
    StageRunner<EncoderIo> runner(io, *models, plan, header.attributes.size());
    result.sizes.attribute_bits.resize(header.attributes.size() + plan.attributes.size(), 0);
    MCC_TRY(runner.codeSurface(&result.sizes));
    const double bits_before = result.sizes.position_bits;
    MCC_TRY(runner.codePositions(&result.sizes));
    result.sizes.piece_position_bits.push_back(result.sizes.position_bits - bits_before);
    MCC_TRY(runner.codeSeams(&result.sizes));
    MCC_TRY(runner.codeOrders(&result.sizes));
    MCC_TRY(runner.prepareAttributes());
    for (const uint32_t a : codingOrder(plan)) MCC_TRY(runner.codeAttribute(a, &result.sizes));

    plan.header.first_attribute = static_cast<uint32_t>(header.attributes.size());
    plan.header.first_part = static_cast<uint32_t>(header.parts.size());
    for (const QuantizedAttribute& a : plan.attributes) {
      if (!header.attributes.push_back(a.info)) throwBadAlloc();
    }
    for (const PartView& part : plan.view->parts) {
      if (!header.parts.push_back({static_cast<uint32_t>(part.indices.size() / 3)}))
        throwBadAlloc();
    }
    if (!header.pieces.push_back(plan.header)) throwBadAlloc();

    PieceResult piece;
    piece.source_wedge = plan.wedge_source;
    if (plan.header.has(piece_flag::kVertexOrder)) {
      std::iota(piece.source_wedge.begin(), piece.source_wedge.end(), 0u);
    }
    piece.topological_vertex_count = runner.groupCount();
    piece.cut_copy_count = plan.header.vertex_count - runner.groupCount();
    piece.hole_count = plan.cut.hole_count;
    piece.component_count = static_cast<uint32_t>(plan.cut.mesh.components.size());
    piece.leftover_triangle_count =
        static_cast<uint32_t>(plan.header.triangleCount()) - plan.header.face_count;
    result.pieces.push_back(std::move(piece));
  }
  const double coded_bits = static_cast<double>(io.cost()) / kCostOne;
  const EncoderIo::Streams streams = io.finish();
  result.payload = writePayload(header, streams.codes, streams.tokens, streams.raw);
  const double stream_bits =
      8.0 * static_cast<double>(streams.codes.size() + streams.tokens.size() + streams.raw.size());
  // The counted costs are slightly off. Over millions of tokens, the error may exceed what flushing
  // adds to the streams.
  const double spent_bits = std::min(coded_bits, stream_bits);
  if (spent_bits < coded_bits) scale(result.sizes, spent_bits / coded_bits);
  result.sizes.header_bits = 8.0 * static_cast<double>(result.payload.size()) - spent_bits;
  return {};
}

Status encodePieces(std::span<const PieceView> pieces, const EncodeSettings& options,
                    EncodeResult& result) {
  if (pieces.empty()) return fail(Error::kBadArgument, "there is nothing to encode");
  result = EncodeResult{};
  const Jobs jobs(options.run_jobs);
  std::vector<Plan> plans(pieces.size());
  std::vector<std::vector<std::string>> notes(pieces.size());
  const auto prepare = [&](size_t i) -> Status {
    MCC_TRY(preparePiece(pieces[i], options, jobs, plans[i], notes[i]));
    Variation variation(options.variation == 0 ? 0 : options.variation + 1 + i);
    return chooseSurface(plans[i], i == 0 ? options.start_half_edge : kNone, options.without,
                         variation.active() ? &variation : nullptr, TimePrice(options.prefer),
                         jobs);
  };
  MCC_TRY(jobs.tryAll(pieces.size(), prepare));
  uint64_t vertices = 0;
  for (size_t i = 0; i < pieces.size(); ++i) {
    vertices += plans[i].header.vertex_count;
    result.notes.insert(result.notes.end(), notes[i].begin(), notes[i].end());
  }
  uint32_t context_set = kNone;
  Variation variation(options.variation);
  MCC_TRY(variation.active() ? varyAll(plans, options, variation, context_set)
                             : chooseAll(plans, options, jobs, context_set));
  MCC_TRY(codeAll(plans, context_set, false, result));
  const bool tries_single = !options.without.has(Feature::kSingleCoder);
  if (vertices > kSingleCoderVertices || !tries_single) return {};
  EncodeResult single;
  MCC_TRY(codeAll(plans, context_set, true, single));
  const double single_bytes = static_cast<double>(single.payload.size());
  const bool pays =
      single_bytes + TimePrice(options.prefer).surcharge(single_bytes, price_ns::kSingleCoder) <
      static_cast<double>(result.payload.size());
  if (variation.active() ? variation.coin() : pays) {
    single.notes = std::move(result.notes);
    result = std::move(single);
  }
  return {};
}

}  // namespace

Status encodeWith(std::span<const PieceView> pieces, const EncodeSettings& settings,
                  EncodeResult& result) {
  return catchBadAlloc([&]() { return encodePieces(pieces, settings, result); },
                       []() { return fail(Error::kOutOfMemory, "no memory for the encoder"); });
}

Status encode(std::span<const PieceView> pieces, const EncodeOptions& options,
              EncodeResult& result) {
  return encodeWith(pieces, options, result);
}

}  // namespace mcc
