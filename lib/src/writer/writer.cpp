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

constexpr uint32_t kSingleCoderVertices = 400;  ///< up to here the single coder is also tried

void scale(StreamSizes& sizes, double by) {
  for (double* bits : {&sizes.connectivity_bits, &sizes.stitch_bits, &sizes.leftover_bits,
                       &sizes.seam_bits, &sizes.position_bits, &sizes.order_bits}) {
    *bits *= by;
  }
  for (double& bits : sizes.attribute_bits) bits *= by;
  for (double& bits : sizes.piece_position_bits) bits *= by;
}

/// What becomes of one piece, after its stages have run.
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

Status codeAll(std::vector<Plan>& plans, EncoderIo& io, PayloadModels& models,
               PayloadHeader& header, EncodeResult& result) {
  for (Plan& plan : plans) {
    StageRunner<EncoderIo> runner(io, models, plan, header.attributes.size());
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
    result.pieces.push_back(resultOf(plan, runner.groupCount()));
  }
  return {};
}

/// Completes the sizes. The counted costs are slightly off: over millions of tokens, the error may
/// exceed what flushing adds to the streams.
void accountHeader(double coded_bits, const EncoderIo::Streams& streams, EncodeResult& result) {
  const double stream_bits =
      8.0 * static_cast<double>(streams.codes.size() + streams.tokens.size() + streams.raw.size());
  const double spent_bits = std::min(coded_bits, stream_bits);
  if (spent_bits < coded_bits) scale(result.sizes, spent_bits / coded_bits);
  result.sizes.header_bits = 8.0 * static_cast<double>(result.payload.size()) - spent_bits;
}

/// Codes the pieces as their plans say. A payload of few vertices is coded in both ways at once.
Status codePayload(std::vector<Plan>& plans, uint32_t context_set, const EncodeSettings& options,
                   Variation& variation, EncodeResult& result) {
  uint64_t vertices = 0;
  for (const Plan& plan : plans) vertices += plan.header.vertex_count;
  const bool tries_single =
      vertices <= kSingleCoderVertices && !options.without.has(Feature::kSingleCoder);
  EncoderIo io(true, tries_single);
  auto models = makeModels(context_set);
  PayloadHeader header{Allocator{}};
  header.flags = context_set << payload_flag::kContextSetShift;
  MCC_TRY(codeAll(plans, io, *models, header, result));
  EncoderIo::Streams streams = io.finish();
  result.payload = writePayload(header, streams.codes, streams.tokens, streams.raw);
  if (tries_single) {
    EncoderIo::Streams single_stream = io.finishSingle();
    header.flags |= payload_flag::kSingleCoder;
    std::vector<uint8_t> single = writePayload(header, single_stream.codes, {}, {});
    const double bytes = static_cast<double>(single.size());
    const double surcharge = TimePrice(options.prefer).surcharge(bytes, price_ns::kSingleCoder);
    const bool pays = bytes + surcharge < static_cast<double>(result.payload.size());
    if (variation.active() ? variation.coin() : pays) {
      result.payload = std::move(single);
      streams = std::move(single_stream);
    }
  }
  accountHeader(static_cast<double>(io.cost()) / kCostOne, streams, result);
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
  for (const std::vector<std::string>& of_piece : notes) {
    result.notes.insert(result.notes.end(), of_piece.begin(), of_piece.end());
  }
  uint32_t context_set = kNone;
  Variation variation(options.variation);
  MCC_TRY(variation.active() ? varyAll(plans, options, variation, context_set)
                             : chooseAll(plans, options, jobs, context_set));
  return codePayload(plans, context_set, options, variation, result);
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
