// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs the stages of one piece in turn. Trials and output share this code, and nobody else in the
// writer compiles the stages: they are templates that take long.
#ifndef MCC_WRITER_STAGES_H_
#define MCC_WRITER_STAGES_H_

#include <memory>
#include <vector>

#include "entropy/enc_coder.h"
#include "mesh/face_mesh.h"
#include "positions/record.h"
#include "writer/plan.h"

namespace mcc {

template <SymbolIo Io>
class PieceCoder;
struct PayloadModels;
struct AttributeModels;
struct PieceTruth;

/// The adaptive models of a payload.
class StageModels {
 public:
  StageModels();
  /// For a payload of these pieces, which are prepared.
  explicit StageModels(const std::vector<Plan>& plans);
  ~StageModels();
  StageModels(const StageModels&) = delete;
  StageModels& operator=(const StageModels&) = delete;
  /// For blocks, see PayloadModels::copyFrom().
  void copyFrom(const StageModels& other);
  PayloadModels& get() { return *models_; }

 private:
  const std::unique_ptr<PayloadModels> models_;
};

/// The positions of a piece as the trials see them. They are independent of what other stages do
/// meanwhile.
struct RecordedPositions {
  Array<VertexRecord> records;
  std::shared_ptr<PositionRecording> recording;
  PositionCandidate candidate;  ///< refers to the recording
};

/// Runs every stage of one piece. `sizes`, if given, receives what each stage cost.
class StageRunner {
 public:
  /// Borrows everything. For trials, `io` only counts.
  /// first_attribute  is the number of attributes of the payload before this piece's.
  StageRunner(EncoderIo& io, StageModels& models, Plan& plan, size_t first_attribute = 0);
  ~StageRunner();

  Status codeSurface(StreamSizes* sizes);

  /// Walks the surface once for the trials; codeSurface() must have run. Leaves what the stages
  /// after codePositions() need of it.
  Status recordPositions(RecordedPositions& recorded);

  /// For trials of attributes: guesses the mates of the vertices under the plan's mirrors.
  /// recordPositions() must have run, and codeSeams() not yet.
  void guessMates();

  Status codePositions(StreamSizes* sizes);
  Status codeSeams(StreamSizes* sizes);
  Status codeOrders(StreamSizes* sizes);
  Status prepareAttributes();

  /// Replaces codeSeams(): codes the seams without and with creases as contexts, and selects the
  /// cheaper way.
  Status chooseSeams();

  Status codeAttribute(uint32_t index, StreamSizes* sizes);

  /// Must be called before tryAttribute(), after the attributes before are coded.
  void prepareTrials();

  /// Counts what codeAttribute() costs for the first wedges. The models are then as before.
  Status tryAttribute(uint32_t index, uint32_t wedges, uint64_t& cost);

  /// Replaces codeAttribute() when its models are not needed any more.
  Status passAttribute(uint32_t index);

  uint32_t groupCount() const;
  const FaceMesh& mesh() const;

 private:
  Status codeLeftovers(StreamSizes* sizes);
  void storePositions();
  bool isCodedWithAnother(uint32_t index) const;
  void learnAttribute(uint32_t index);
  void learnOrders();
  void account(StreamSizes* sizes, double StreamSizes::*field);
  double since();

  EncoderIo& io_;
  PayloadModels& models_;
  Plan& plan_;
  const size_t first_attribute_;
  std::vector<AttributeInfo> infos_;
  const std::unique_ptr<PieceCoder<EncoderIo>> piece_;
  const std::unique_ptr<PieceTruth> truth_;
  const std::unique_ptr<AttributeModels> before_;  ///< see prepareTrials()
  Array<int32_t> values_;
  uint32_t learned_ = kNone;  ///< attribute whose values values_ holds
  uint64_t cost_before_ = io_.cost();
};

}  // namespace mcc

#endif  // MCC_WRITER_STAGES_H_
