// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs the stages of one piece in turn, on a counting coder or on the real one. Trials and output
// share this code.
#ifndef MCC_WRITER_STAGES_H_
#define MCC_WRITER_STAGES_H_

#include <algorithm>
#include <vector>

#include "base/enc_exceptions.h"
#include "entropy/enc_coder.h"
#include "format/predictors.h"
#include "writer/instances.h"
#include "writer/truth.h"

namespace mcc {

/// The positions of a piece as the trials see them. They are independent of what other stages do
/// meanwhile.
struct RecordedPositions {
  Array<VertexRecord> records;
  PositionRecording recording;
  PositionCandidate candidate;  ///< refers to the recording
};

/// Runs every stage of one piece. `sizes`, if given, receives what each stage cost.
template <class Io>
class StageRunner {
 public:
  /// first_attribute  is the number of attributes of the payload before this piece's.
  StageRunner(Io& io, PayloadModels& models, Plan& plan, size_t first_attribute = 0)
      : io_(io),
        plan_(plan),
        first_attribute_(first_attribute),
        infos_(infosOf(plan)),
        piece_(io, models, plan.header, infos_, {}) {}

  Status codeSurface(StreamSizes* sizes) {
    truth_.connectivity = connectivityTruth(
        plan_.record, {plan_.node_map, plan_.source_of_vertex, plan_.source_gate});
    truth_.pivot_faces = plan_.pivots.faces.data();
    MCC_TRY(piece_.codeConnectivity(truth_));
    account(sizes, &StreamSizes::connectivity_bits);
    learnVertices(plan_);
    truth_.class_of_vertex = plan_.class_of_vertex.data();
    truth_.class_count = plan_.classes.class_count;
    truth_.corner_source = plan_.corner_source.data();
    MCC_TRY(piece_.codeStitch(truth_));
    account(sizes, &StreamSizes::stitch_bits);
    learnPositions(plan_, piece_.mesh, piece_.groups);
    truth_.positions = plan_.positions.data();
    truth_.exact_positions = plan_.exact_positions.data();
    return {};
  }

  /// Walks the surface once for the trials; codeSurface() must have run. Leaves what the stages
  /// after codePositions() need of it.
  Status recordPositions(RecordedPositions& recorded) {
    PositionRecording& recording = recorded.recording;
    PositionCandidate& candidate = recorded.candidate;
    const uint32_t group_count = piece_.groups.count;
    const std::span<const int32_t> positions(plan_.positions.data(), 3 * size_t{group_count});
    if (!recorded.records.resize(group_count)) throwBadAlloc();
    const bool with_order = piece_.needsSequence();
    if (with_order && !piece_.sequence.resize(group_count)) throwBadAlloc();
    MCC_TRY(recording.record(piece_.mesh, piece_.groups, recorded.records.data(),
                             plan_.positions.data(),
                             with_order ? piece_.sequence.data() : nullptr));
    if (with_order) storePositions();
    PositionParameters parameters;
    PieceCoder<Io>::describePositions(plan_.attributes[0].info, parameters);
    candidate.recording = &recording;
    candidate.truth = plan_.positions.data();
    candidate.bits = parameters.bits;
    plan_.coordinates.find(positions, isExact(plan_.attributes[0].info.coding));
    for (uint32_t s = 0; s < 3; ++s) candidate.palettes[s] = plan_.coordinates.palette(s);
    findPlanesOf(plan_, positions);
    if (*plan_.has_planes) candidate.planes = plan_.planes;
    return {};
  }

  Status codePositions(StreamSizes* sizes) {
    AxisPalette palettes[3];
    if (!plan_.attributes.empty()) {
      infos_[0] = plan_.attributes[0].info;
      if (plan_.finds_coordinates) {
        plan_.coordinates.find({plan_.positions.data(), 3 * size_t{piece_.groups.count}},
                               isExact(infos_[0].coding));
      }
      for (uint32_t s = 0; s < 3; ++s) palettes[s] = plan_.coordinates.palette(s);
      truth_.palettes = palettes;
      truth_.planes = plan_.planes;
    }
    MCC_TRY(piece_.codePositions(truth_, &plan_.positions_as));
    account(sizes, &StreamSizes::position_bits);
    return {};
  }

  Status codeSeams(StreamSizes* sizes) {
    MCC_TRY(piece_.codeSeams(truth_));
    account(sizes, &StreamSizes::seam_bits);
    return codeLeftovers(sizes);
  }

  Status codeLeftovers(StreamSizes* sizes) {
    learnWedges(plan_, piece_.mesh);
    truth_.leftovers = {plan_.part_of_face.data(), plan_.list.data()};
    MCC_TRY(piece_.codeLeftovers(truth_));
    account(sizes, &StreamSizes::leftover_bits);
    return {};
  }

  Status codeOrders(StreamSizes* sizes) {
    if (plan_.header.has(piece_flag::kTriangleOrder | piece_flag::kVertexOrder)) {
      learnOrders();
      MCC_TRY(piece_.codeOrders(truth_));
      account(sizes, &StreamSizes::order_bits);
    }
    return {};
  }

  Status prepareAttributes() { return piece_.prepareAttributes(); }

  /// Replaces codeSeams(): codes the seams without and with creases as contexts, and selects the
  /// cheaper way.
  Status chooseSeams(PayloadModels& models) {
    if (!plan_.header.has(piece_flag::kSeams) || plan_.attributes.empty())
      return codeSeams(nullptr);
    Surface other;
    copyArray(piece_.mesh.words, other.words);
    copyArray(piece_.sequence, other.sequence);
    SeamModels models_of_other = models.seams;
    const auto exchange = [&] {
      piece_.mesh.words.swap(other.words);
      piece_.sequence.swap(other.sequence);
      piece_.wedge_group.swap(other.wedge_group);
      std::swap(models.seams, models_of_other);
    };
    const uint64_t start = io_.cost();
    plan_.header.flags &= ~piece_flag::kCreases;
    MCC_TRY(piece_.codeSeams(truth_));
    const uint64_t without = io_.cost() - start;
    exchange();
    plan_.header.flags |= piece_flag::kCreases;
    MCC_TRY(piece_.codeSeams(truth_));
    const uint64_t with = io_.cost() - start - without;
    if (with < without) return codeLeftovers(nullptr);
    exchange();
    piece_.wedges.half_edges = piece_.sequence.data();
    plan_.header.flags &= ~piece_flag::kCreases;
    return codeLeftovers(nullptr);
  }

  Status codeAttribute(uint32_t index, StreamSizes* sizes) {
    infos_[index] = plan_.attributes[index].info;
    if (isCodedWithAnother(index)) return {};
    learnAttribute(index);
    MCC_TRY(piece_.codeAttribute(index, values_));
    if (sizes != nullptr) sizes->attribute_bits[first_attribute_ + index] += since();
    return {};
  }

  /// Counts what codeAttribute() costs for the first wedges. The models adapt.
  Status tryAttribute(uint32_t index, uint32_t wedges, uint64_t& cost) {
    const uint64_t spent = io_.cost();
    piece_.codeFirstWedges(wedges);
    const Status status = codeAttribute(index, nullptr);
    piece_.codeFirstWedges(kNone);
    cost = io_.cost() - spent;
    return status;
  }

  /// Replaces codeAttribute() when its models are not needed any more.
  Status passAttribute(uint32_t index) {
    infos_[index] = plan_.attributes[index].info;
    if (isCodedWithAnother(index)) return {};
    learnAttribute(index);
    return piece_.keepForOthers(index, values_);
  }

  uint32_t groupCount() const { return piece_.groups.count; }
  const FaceMesh& mesh() const { return piece_.mesh; }

 private:
  /// What coding the seams changes.
  struct Surface {
    Array<uint32_t> words;
    Array<uint32_t> sequence;
    Array<uint32_t> wedge_group;
  };
  static void copyArray(const Array<uint32_t>& from, Array<uint32_t>& to) {
    if (!to.resize(from.size())) throwBadAlloc();
    std::copy(from.data(), from.data() + from.size(), to.data());
  }

  /// Stores the positions of all groups and isolated vertices where later stages find them.
  void storePositions() {
    const std::vector<int32_t>& from =
        plan_.exact_positions.empty() ? plan_.positions : plan_.exact_positions;
    if (!piece_.records.resize(from.size() / 3)) throwBadAlloc();
    for (size_t v = 0; v < piece_.records.size(); ++v) {
      std::copy_n(from.data() + 3 * v, 3, piece_.records[v].q);
    }
  }

  bool isCodedWithAnother(uint32_t index) const { return isWithAnother(methodOf(infos_, index)); }

  /// Fills values_. Coding does not change them.
  void learnAttribute(uint32_t index) {
    if (learned_ == index) return;
    learned_ = index;
    const uint32_t stride = piece_.codedComponentsOf(index);
    if (!values_.resize(size_t{plan_.header.wedge_count} * stride)) throwBadAlloc();
    learnValues(plan_, index, 0, stride, values_);
    if (methodOf(infos_, index) != AttributeMethod::kSkin) return;
    learnValues(plan_, skinPartner(infos_, index), kSkinSlots, stride, values_);
  }

  static std::vector<AttributeInfo> infosOf(const Plan& plan) {
    std::vector<AttributeInfo> infos;
    for (const QuantizedAttribute& a : plan.attributes) infos.push_back(a.info);
    return infos;
  }
  void learnOrders() {
    if (!piece_.listTriangles()) throwBadAlloc();
    if (plan_.header.has(piece_flag::kTriangleOrder)) learnTriangleOrder(plan_, piece_.triangles);
    plan_.wedge_order.resize(plan_.wedge_source.size());
    for (uint32_t w = 0; w < plan_.wedge_source.size(); ++w) {
      plan_.wedge_order[plan_.wedge_source[w]] = w;
    }
    truth_.triangle_order = plan_.triangle_order.data();
    truth_.wedge_order = plan_.wedge_order.data();
  }
  double since() {
    const uint64_t before = cost_before_;
    cost_before_ = io_.cost();
    return static_cast<double>(cost_before_ - before) / kCostOne;
  }
  void account(StreamSizes* sizes, double StreamSizes::*field) {
    if (sizes != nullptr) sizes->*field += since();
  }

  Io& io_;
  Plan& plan_;
  const size_t first_attribute_;
  std::vector<AttributeInfo> infos_;
  PieceCoder<Io> piece_;
  PieceTruth truth_;
  Array<int32_t> values_;
  uint32_t learned_ = kNone;  ///< attribute whose values values_ holds
  uint64_t cost_before_ = io_.cost();
};

}  // namespace mcc

#endif  // MCC_WRITER_STAGES_H_
