// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writer: prepares every piece (writer/plan.h), makes the format's choices on a counting coder
// (writer/choices.h), then runs the stages of reader/piece.h with the real one (writer/stages.h).
#include "mcc/writer.h"

#include <algorithm>
#include <memory>

#include "base/enc_exceptions.h"
#include "container/enc_payload.h"
#include "positions/enc_prices.h"
#include "writer/blocks.h"
#include "writer/choices.h"
#include "writer/code_piece.h"
#include "writer/settings.h"

namespace mcc {
namespace {

constexpr uint32_t kSingleCoderVertices = 400;  ///< up to here the single coder is also tried
constexpr uint64_t kTrainedVertices = 65536;    ///< beyond, models learn from nothing soon enough

Status codeAll(std::vector<Plan>& plans, EncoderIo& io, StageModels& models, PayloadHeader& header,
               EncodeResult& result) {
  for (Plan& plan : plans) {
    MCC_TRY(codePiece(plan, io, models, header.attributes.size(), result));
    addPiece(plan, header);
  }
  return {};
}

uint64_t verticesOf(const std::vector<Plan>& plans) {
  uint64_t vertices = 0;
  for (const Plan& plan : plans) vertices += plan.header.vertex_count;
  return vertices;
}

/// Codes the pieces as their plans say. A payload of few vertices is coded in both ways at once.
Status codePayload(std::vector<Plan>& plans, const EncodeSettings& options, Variation& variation,
                   EncodeResult& result) {
  const bool tries_single =
      verticesOf(plans) <= kSingleCoderVertices && !options.without.has(Feature::kSingleCoder);
  EncoderIo io(true, tries_single);
  StageModels models(plans);
  PayloadHeader header{Allocator{}};
  if (plans[0].starts_trained) header.flags |= payload_flag::kTrained;
  MCC_TRY(codeAll(plans, io, models, header, result));
  EncoderIo::Streams streams = io.finish();
  result.payload = writePayload(header, {streams.codes, streams.tokens, streams.raw});
  if (tries_single) {
    EncoderIo::Streams single_stream = io.finishSingle();
    header.flags |= payload_flag::kSingleCoder;
    std::vector<uint8_t> single = writePayload(header, {single_stream.codes, {}, {}});
    const double bytes = static_cast<double>(single.size());
    const double surcharge = TimePrice(options.prefer).surcharge(bytes, price_ns::kSingleCoder);
    const bool pays = bytes + surcharge < static_cast<double>(result.payload.size());
    if (variation.active() ? variation.coin() : pays) {
      result.payload = std::move(single);
      streams = std::move(single_stream);
    }
  }
  accountHeader(static_cast<double>(io.cost()) / kCostOne,
                streams.codes.size() + streams.tokens.size() + streams.raw.size(), result);
  return {};
}

/// Codes the pieces with models that start trained, and without, unless choices are made at random.
/// Some shapes are unlike all assets.
Status codeSmaller(std::vector<Plan>& plans, const EncodeSettings& options, Variation& variation,
                   EncodeResult& result) {
  EncodeResult untrained = result;
  MCC_TRY(codePayload(plans, options, variation, result));
  if (!plans[0].starts_trained || variation.active()) return {};
  for (Plan& plan : plans) plan.starts_trained = false;
  MCC_TRY(codePayload(plans, options, variation, untrained));
  if (untrained.payload.size() <= result.payload.size()) result = std::move(untrained);
  return {};
}

Status encodePieces(std::span<const PieceView> pieces, const EncodeSettings& options,
                    EncodeResult& result) {
  if (pieces.empty()) return fail(Error::kBadArgument, "there is nothing to encode");
  if (options.prefer > Preference::kSpeed)
    return fail(Error::kBadArgument, "prefer is not one of the preferences");
  result = EncodeResult{};
  const Jobs jobs(options.run_jobs);
  std::vector<Plan> plans(pieces.size());
  std::vector<std::vector<std::string>> notes(pieces.size());
  const auto prepare = [&](size_t i) -> Status {
    MCC_TRY(preparePiece(pieces[i], options, jobs, plans[i], notes[i]));
    if (pieces.size() == 1) {
      MCC_TRY(encodeBlocks(plans[0], options, jobs, result));
      if (!result.payload.empty()) return {};
    }
    Variation variation(options.variation == 0 ? 0 : options.variation + 1 + i);
    return chooseSurface(plans[i], i == 0 ? options.start_half_edge : kNone, options.without,
                         variation.active() ? &variation : nullptr, TimePrice(options.prefer),
                         jobs);
  };
  MCC_TRY(jobs.tryAll(pieces.size(), prepare));
  for (const std::vector<std::string>& of_piece : notes) {
    result.notes.insert(result.notes.end(), of_piece.begin(), of_piece.end());
  }
  if (!result.payload.empty()) return {};
  Variation variation(options.variation);
  const bool trained = !options.without.has(Feature::kStarts) &&
                       verticesOf(plans) <= kTrainedVertices &&
                       (!variation.active() || variation.apart(3).coin());
  for (Plan& plan : plans) plan.starts_trained = trained;
  MCC_TRY(variation.active() ? varyAll(plans, variation, options.without)
                             : chooseAll(plans, options, jobs));
  return codeSmaller(plans, options, variation, result);
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
