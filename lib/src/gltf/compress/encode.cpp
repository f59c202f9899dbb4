// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/encode.h"

#include <mutex>

#include "gltf/compress/vertices.h"
#include "host/parallel.h"

namespace mcc::gltf {
namespace {

/// The input of the codec for one piece. The views borrow from the plan.
struct PieceInput {
  std::vector<AttributeView> attributes;
  std::vector<PartView> parts;
  PieceView view;

  explicit PieceInput(const PiecePlan& plan) {
    for (const AttributePlan& attribute : plan.attributes) attributes.push_back(attribute.view());
    if (plan.attributes.empty()) attributes.push_back(weldingView(plan));
    for (const PartPlan& part : plan.parts) parts.push_back({part.triangles});
    view = {plan.wedge_count, attributes, parts};
  }
};

Status encodePieces(const std::vector<const PiecePlan*>& plans, const EncodeOptions& options,
                    EncodeResult& result) {
  std::vector<PieceInput> inputs;
  inputs.reserve(plans.size());  // the views point into the elements, which must not move
  std::vector<PieceView> views;
  for (const PiecePlan* plan : plans) {
    inputs.emplace_back(*plan);
    views.push_back(inputs.back().view);
  }
  return encode(views, options, result);
}

EncodeOptions optionsOf(const ConvertOptions& options, const PayloadPlan& plan) {
  EncodeOptions encode_options;
  encode_options.prefer = options.prefer;
  encode_options.block_triangles = options.block_triangles;
  encode_options.indices_only = plan.indices_only;
  encode_options.keep_vertex_order = plan.keep_vertex_order;
  encode_options.keep_triangle_order = plan.keep_triangle_order;
  return encode_options;
}

std::string refusal(const Status& status) {
  return "the codec refuses it (" + toResult(status, "").what + "); left as it was";
}

/// Removes the pieces that the codec refuses.
void removeRefusedPieces(const EncodeOptions& options, PayloadPlan& plan,
                         std::vector<LeftAlone>& left_alone) {
  std::vector<PiecePlan> accepted;
  for (PiecePlan& piece : plan.pieces) {
    EncodeResult ignored;
    const Status status = encodePieces({&piece}, options, ignored);
    if (status.ok()) {
      accepted.push_back(std::move(piece));
    } else {
      leaveAlone(piece, refusal(status), false, left_alone);
    }
  }
  plan.pieces = std::move(accepted);
}

Status encodePlan(const EncodeOptions& options, const PayloadPlan& plan, EncodeResult& result) {
  std::vector<const PiecePlan*> pieces;
  for (const PiecePlan& piece : plan.pieces) pieces.push_back(&piece);
  return encodePieces(pieces, options, result);
}

void leaveAllAlone(const std::string& note, EncodedPayload& payload,
                   std::vector<LeftAlone>& left_alone) {
  for (const PiecePlan& piece : payload.plan.pieces) leaveAlone(piece, note, false, left_alone);
  payload = {};
}

Result encodeOne(const EncodeOptions& options, EncodedPayload& payload,
                 std::vector<LeftAlone>& left_alone) {
  if (!encodePlan(options, payload.plan, payload.result).ok()) {
    removeRefusedPieces(options, payload.plan, left_alone);
    payload.result = {};
    if (payload.plan.pieces.empty()) return {};
    const Status status = encodePlan(options, payload.plan, payload.result);
    if (!status.ok()) {  // the codec accepts each piece alone, but not all of them together
      leaveAllAlone(refusal(status), payload, left_alone);
      return {};
    }
  }
  Payload opened;
  const Status status = opened.open(payload.result.payload);
  if (status.error == Error::kLimit) leaveAllAlone(refusal(status), payload, left_alone);
  return {};
}

/// Reports how much of the payloads' triangles is encoded.
class EncodingProgress {
 public:
  EncodingProgress(const ConvertOptions& options, const std::vector<PayloadPlan>& plans)
      : options_(options) {
    for (const PayloadPlan& plan : plans) all_ += plan.triangleCount();
  }

  void advance(uint64_t triangle_count) {
    if (!options_.progress || all_ == 0) return;
    const std::lock_guard lock(mutex_);
    done_ += triangle_count;
    options_.progress("encoding", static_cast<double>(done_) / static_cast<double>(all_));
  }

 private:
  const ConvertOptions& options_;
  std::mutex mutex_;
  uint64_t all_ = 0;
  uint64_t done_ = 0;
};

}  // namespace

std::vector<const PayloadPlan*> plansOf(const std::vector<EncodedPayload>& payloads) {
  std::vector<const PayloadPlan*> plans;
  for (const EncodedPayload& payload : payloads) plans.push_back(&payload.plan);
  return plans;
}

uint64_t bytesAlone(const ConvertOptions& options, const PayloadPlan& plan,
                    const PiecePlan& piece) {
  EncodeResult result;
  return encodePieces({&piece}, optionsOf(options, plan), result).ok() ? result.payload.size() : 0;
}

Result encodePayloads(const ConvertOptions& options, std::vector<PayloadPlan> plans,
                      std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone) {
  std::vector<EncodedPayload> encoded(plans.size());
  std::vector<std::vector<LeftAlone>> refused(plans.size());
  EncodingProgress progress(options, plans);
  ThreadBudget threads(options.thread_count);
  const RunJobs run_jobs = runJobsOn(threads);
  MCC_GLTF_TRY(runParallel(plans.size(), threads, [&](size_t i) {
    PayloadPlan& plan = encoded[i].plan;
    plan = std::move(plans[i]);
    plan.keep_vertex_order |= options.keep_vertex_order;
    plan.keep_triangle_order |= options.keep_triangle_order;
    EncodeOptions encode_options = optionsOf(options, plan);
    encode_options.run_jobs = run_jobs;
    const uint64_t triangle_count = plan.triangleCount();
    Result result = encodeOne(encode_options, encoded[i], refused[i]);
    progress.advance(triangle_count);
    return result;
  }));
  for (size_t i = 0; i < encoded.size(); ++i) {
    left_alone.insert(left_alone.end(), refused[i].begin(), refused[i].end());
    if (!encoded[i].plan.pieces.empty()) payloads.push_back(std::move(encoded[i]));
  }
  return {};
}

}  // namespace mcc::gltf
