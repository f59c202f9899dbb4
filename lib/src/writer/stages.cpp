// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stages of reader/piece.h are compiled for the encoder here, and only here.
#include "writer/stages.h"

#include <algorithm>

#include "base/enc_exceptions.h"
#include "format/predictors.h"
#include "positions/enc_mirrors.h"
#include "positions/enc_recording.h"
#include "reader/starts.h"
#include "writer/instances.h"
#include "writer/truth.h"

namespace mcc {

MCC_ALL_INSTANCES(, EncoderIo)
MCC_MODES_INSTANCE(, EncoderIo, kAnyModes)

StageModels::StageModels() : models_(std::make_unique<PayloadModels>()) {}
StageModels::StageModels(const std::vector<Plan>& plans) : StageModels() {
  if (!plans[0].starts_trained) return;
  size_t attribute_count = 0;
  for (const Plan& plan : plans) attribute_count += plan.attributes.size();
  if (!startTrained(*models_, attribute_count > 1, {})) throwBadAlloc();
}
StageModels::~StageModels() = default;

void StageModels::copyFrom(const StageModels& other) {
  if (!models_->copyFrom(*other.models_, {})) throwBadAlloc();
}

namespace {

/// What coding the seams changes.
struct Surface {
  Array<uint32_t> words;
  Array<uint32_t> sequence;
  Array<uint32_t> wedge_group;
};

void copyArray(const Array<uint32_t>& from, Array<uint32_t>& to) {
  if (!to.resize(from.size())) throwBadAlloc();
  std::copy(from.data(), from.data() + from.size(), to.data());
}

}  // namespace

StageRunner::StageRunner(EncoderIo& io, StageModels& models, Plan& plan, size_t first_attribute)
    : io_(io),
      models_(models.get()),
      plan_(plan),
      first_attribute_(first_attribute),
      infos_(infosOf(plan)),
      piece_(
          std::make_unique<PieceCoder<EncoderIo>>(io, models_, plan.header, infos_, Allocator{})),
      truth_(std::make_unique<PieceTruth>()),
      before_(std::make_unique<AttributeModels>()) {}

StageRunner::~StageRunner() = default;

Status StageRunner::codeSurface(StreamSizes* sizes) {
  truth_->connectivity =
      connectivityTruth(plan_.record, {plan_.node_map, plan_.source_of_vertex, plan_.source_gate});
  truth_->pivot_faces = plan_.pivots.faces.data();
  MCC_TRY(piece_->codeConnectivity(*truth_));
  account(sizes, &StreamSizes::connectivity_bits);
  learnVertices(plan_);
  truth_->class_of_vertex = plan_.class_of_vertex.data();
  truth_->class_count = plan_.classes.class_count;
  truth_->corner_source = plan_.corner_source.data();
  MCC_TRY(piece_->codeStitch(*truth_));
  account(sizes, &StreamSizes::stitch_bits);
  learnPositions(plan_, piece_->mesh, piece_->groups);
  truth_->positions = plan_.positions.data();
  truth_->exact_positions = plan_.exact_positions.data();
  return {};
}

Status StageRunner::recordPositions(RecordedPositions& recorded) {
  recorded.recording = std::make_shared<PositionRecording>();
  PositionRecording& recording = *recorded.recording;
  PositionCandidate& candidate = recorded.candidate;
  const uint32_t group_count = piece_->groups.count;
  const std::span<const int32_t> positions(plan_.positions.data(), 3 * size_t{group_count});
  if (!recorded.records.resize(group_count)) throwBadAlloc();
  const bool with_order = piece_->needsSequence();
  if (with_order && !piece_->sequence.resize(group_count)) throwBadAlloc();
  MCC_TRY(recording.record(piece_->mesh, piece_->groups, recorded.records.data(),
                           plan_.positions.data(), with_order ? piece_->sequence.data() : nullptr));
  if (with_order) storePositions();
  PositionParameters parameters;
  PieceCoder<EncoderIo>::describePositions(plan_.attributes[0].info, parameters);
  candidate.recording = &recording;
  candidate.truth = plan_.positions.data();
  candidate.bits = parameters.bits;
  plan_.coordinates.find(positions, isExact(plan_.attributes[0].info.coding));
  for (uint32_t s = 0; s < 3; ++s) candidate.palettes[s] = plan_.coordinates.palette(s);
  findPlanesOf(plan_, positions);
  if (*plan_.has_planes) candidate.planes = plan_.planes;
  return {};
}

void StageRunner::guessMates() {
  if ((plan_.mirrors.count == 0 && plan_.anchors.count == 0) || plan_.attributes.size() < 2) return;
  std::vector<uint32_t> order;
  for (size_t i = 0; i < piece_->groups.count; ++i)
    order.push_back(piece_->mesh.words[piece_->sequence[i]]);
  mcc::guessMates(plan_.positions, order, plan_.mirrors, plan_.anchors, piece_->mates);
}

Status StageRunner::codePositions(StreamSizes* sizes) {
  AxisPalette palettes[3];
  if (!plan_.attributes.empty()) {
    infos_[0] = plan_.attributes[0].info;
    if (plan_.finds_coordinates) {
      plan_.coordinates.find({plan_.positions.data(), 3 * size_t{piece_->groups.count}},
                             isExact(infos_[0].coding));
    }
    for (uint32_t s = 0; s < 3; ++s) palettes[s] = plan_.coordinates.palette(s);
    truth_->palettes = palettes;
    truth_->planes = plan_.planes;
    truth_->mirrors = &plan_.mirrors;
    truth_->anchors = plan_.anchors.anchor.data();
  }
  MCC_TRY(piece_->codePositions(*truth_, &plan_.positions_as));
  account(sizes, &StreamSizes::position_bits);
  return {};
}

Status StageRunner::codeSeams(StreamSizes* sizes) {
  MCC_TRY(piece_->codeSeams(*truth_));
  account(sizes, &StreamSizes::seam_bits);
  return codeLeftovers(sizes);
}

Status StageRunner::codeLeftovers(StreamSizes* sizes) {
  learnWedges(plan_, piece_->mesh);
  truth_->leftovers = {plan_.part_of_face.data(), plan_.list.data()};
  MCC_TRY(piece_->codeLeftovers(*truth_));
  account(sizes, &StreamSizes::leftover_bits);
  return {};
}

Status StageRunner::codeOrders(StreamSizes* sizes) {
  if (plan_.header.has(piece_flag::kTriangleOrder | piece_flag::kVertexOrder)) {
    learnOrders();
    MCC_TRY(piece_->codeOrders(*truth_));
    account(sizes, &StreamSizes::order_bits);
  }
  return {};
}

Status StageRunner::prepareAttributes() { return piece_->prepareAttributes(); }

Status StageRunner::chooseSeams() {
  if (!plan_.header.has(piece_flag::kSeams) || plan_.attributes.empty()) return codeSeams(nullptr);
  Surface other;
  copyArray(piece_->mesh.words, other.words);
  copyArray(piece_->sequence, other.sequence);
  SeamModels models_of_other = models_.seams;
  const auto exchange = [&] {
    piece_->mesh.words.swap(other.words);
    piece_->sequence.swap(other.sequence);
    piece_->wedge_group.swap(other.wedge_group);
    std::swap(models_.seams, models_of_other);
  };
  const uint64_t start = io_.cost();
  plan_.header.flags &= ~piece_flag::kCreases;
  MCC_TRY(piece_->codeSeams(*truth_));
  const uint64_t without = io_.cost() - start;
  exchange();
  plan_.header.flags |= piece_flag::kCreases;
  MCC_TRY(piece_->codeSeams(*truth_));
  const uint64_t with = io_.cost() - start - without;
  if (with < without) return codeLeftovers(nullptr);
  exchange();
  piece_->wedges.half_edges = piece_->sequence.data();
  plan_.header.flags &= ~piece_flag::kCreases;
  return codeLeftovers(nullptr);
}

Status StageRunner::codeAttribute(uint32_t index, StreamSizes* sizes) {
  infos_[index] = plan_.attributes[index].info;
  if (isCodedWithAnother(index)) return {};
  learnAttribute(index);
  MCC_TRY(piece_->codeAttribute(index, values_));
  if (sizes != nullptr) sizes->attribute_bits[first_attribute_ + index] += since();
  return {};
}

void StageRunner::prepareTrials() {
  if (!before_->copyFrom(models_.attributes, {})) throwBadAlloc();
}

Status StageRunner::tryAttribute(uint32_t index, uint32_t wedges, uint64_t& cost) {
  const uint64_t spent = io_.cost();
  piece_->codeFirstWedges(wedges);
  MCC_TRY(codeAttribute(index, nullptr));
  piece_->codeFirstWedges(kNone);
  cost = io_.cost() - spent;
  if (!models_.attributes.copyFrom(*before_, {})) throwBadAlloc();
  return {};
}

Status StageRunner::passAttribute(uint32_t index) {
  infos_[index] = plan_.attributes[index].info;
  if (isCodedWithAnother(index)) return {};
  learnAttribute(index);
  return piece_->keepForOthers(index, values_);
}

uint32_t StageRunner::groupCount() const { return piece_->groups.count; }
const FaceMesh& StageRunner::mesh() const { return piece_->mesh; }

/// Stores the positions of all groups and isolated vertices where later stages find them.
void StageRunner::storePositions() {
  const std::vector<int32_t>& from =
      plan_.exact_positions.empty() ? plan_.positions : plan_.exact_positions;
  if (!piece_->records.resize(from.size() / 3)) throwBadAlloc();
  for (size_t v = 0; v < piece_->records.size(); ++v) {
    std::copy_n(from.data() + 3 * v, 3, piece_->records[v].q);
  }
}

bool StageRunner::isCodedWithAnother(uint32_t index) const {
  return isWithAnother(methodOf(infos_, index));
}

/// Fills values_. Coding does not change them.
void StageRunner::learnAttribute(uint32_t index) {
  if (learned_ == index) return;
  learned_ = index;
  const uint32_t stride = piece_->codedComponentsOf(index);
  if (!values_.resize(size_t{plan_.header.wedge_count} * stride)) throwBadAlloc();
  learnValues(plan_, index, 0, stride, values_);
  if (methodOf(infos_, index) != AttributeMethod::kSkin) return;
  learnValues(plan_, skinPartner(infos_, index), kSkinSlots, stride, values_);
}

void StageRunner::learnOrders() {
  if (!piece_->listTriangles()) throwBadAlloc();
  if (plan_.header.has(piece_flag::kTriangleOrder)) learnTriangleOrder(plan_, piece_->triangles);
  plan_.wedge_order.resize(plan_.wedge_source.size());
  for (uint32_t w = 0; w < plan_.wedge_source.size(); ++w) {
    plan_.wedge_order[plan_.wedge_source[w]] = w;
  }
  truth_->triangle_order = plan_.triangle_order.data();
  truth_->wedge_order = plan_.wedge_order.data();
}

double StageRunner::since() {
  const uint64_t before = cost_before_;
  cost_before_ = io_.cost();
  return static_cast<double>(cost_before_ - before) / kCostOne;
}

void StageRunner::account(StreamSizes* sizes, double StreamSizes::*field) {
  if (sizes != nullptr) sizes->*field += since();
}

}  // namespace mcc
