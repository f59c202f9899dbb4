// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "robustness/forged_payload.h"

#include <unordered_map>

#include "container/enc_payload.h"
#include "entropy/enc_coder.h"
#include "format/predictors.h"
#include "reader/starts.h"
#include "robustness/answers_io.h"
#include "robustness/observed_codes.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

/// Answers that are recorded for encoding. When a model is asked for the first time, its answer is
/// drawn. From then on it gives the same answer, which soon costs nothing, except for a few that a
/// budget of bits pays for.
class ForgedAnswers final : public Answers {
 public:
  ForgedAnswers(uint64_t seed, uint64_t budget_bits, bool single)
      : random_(seed), budget_(budget_bits * kCostOne), encoder_(single) {
    percent_ones_ = random_.between(random_.chance(50) ? 40 : 5, 70);
    surprises_ = random_.chance(50) ? 0 : random_.between(1, 200);
    odd_tokens_ = random_.chance(70) ? 0 : random_.between(1, 30);
  }

  uint64_t symbols() const { return symbols_; }
  EncoderIo::Streams finish() { return encoder_.finish(); }

  bool bit(BitModel& model) override {
    ++symbols_;
    const auto [at, is_new] = usual_.try_emplace(&model, 0);
    if (is_new) at->second = random_.chance(percent_ones_) ? 1 : 0;
    const bool one = (at->second != 0) != surprises();
    return encoder_.bit(model, one);
  }

  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t state) override {
    ++symbols_;
    const auto [at, is_new] = usual_.try_emplace(&row, 0);
    if (is_new) at->second = random_.below(random_.chance(odd_tokens_) ? kTokenCount : 2);
    last_token_ = &at->second;
    const uint32_t symbol = surprises() ? random_.below(kTokenCount) : at->second;
    switch (state) {
      case 0: return encoder_.token<0>(row, schedule, symbol);
      case 1: return encoder_.token<1>(row, schedule, symbol);
      default: return encoder_.token<2>(row, schedule, symbol);
    }
  }

  uint32_t raw(uint32_t bits) override {
    if (bits == 0) return 0;
    ++symbols_;
    if (!hasBudget() && last_token_ != nullptr)
      *last_token_ = 0;  // tokens with raw bits cost too much
    const uint64_t most = bits == 2 ? 2 : (uint64_t{1} << bits) - 1;  // mirrors and axes end at 2
    return encoder_.raw(bits, static_cast<uint32_t>(random_.next() % (most + 1)));
  }

 private:
  bool hasBudget() const { return encoder_.cost() < budget_; }
  bool surprises() { return hasBudget() && random_.below(10000) < surprises_; }

  Random random_;
  const uint64_t budget_;
  EncoderIo encoder_;
  std::unordered_map<const void*, uint32_t> usual_;  ///< answer of each model
  uint32_t* last_token_ = nullptr;
  uint32_t percent_ones_ = 0;
  uint32_t surprises_ = 0;   ///< in 10,000
  uint32_t odd_tokens_ = 0;  ///< percent of the rows
  uint64_t symbols_ = 0;
};

struct Kind {
  Semantic semantic;
  AttributeCoding coding;
  uint8_t components;
  ComponentType type = ComponentType::kFloat32;
  uint16_t morph_target = 0;
};
constexpr Kind kKinds[] = {
    {Semantic::kNormal, AttributeCoding::kOctahedral, 3},
    {Semantic::kTexcoord, AttributeCoding::kLattice, 2},
    {Semantic::kCustom, AttributeCoding::kInteger, 16, ComponentType::kUint32},
    {Semantic::kCustom, AttributeCoding::kInteger, 1, ComponentType::kUint32},
    {Semantic::kColor, AttributeCoding::kExactFloat, 4},
    {Semantic::kColor, AttributeCoding::kInteger, 4, ComponentType::kUint8},
    {Semantic::kTangent, AttributeCoding::kTangentAngle, 4},
    {Semantic::kJoints, AttributeCoding::kInteger, 4, ComponentType::kUint8},
    {Semantic::kWeights, AttributeCoding::kLattice, 4},
    {Semantic::kNormal, AttributeCoding::kExactFloat, 3},
    {Semantic::kTangent, AttributeCoding::kExactFloat, 4},
    {Semantic::kTexcoord, AttributeCoding::kGrid, 2},
    {Semantic::kTexcoord, AttributeCoding::kExactFloat, 2},
    {Semantic::kCustom, AttributeCoding::kExactFloat, 1},
    {Semantic::kTangent, AttributeCoding::kOctahedral, 4},
    {Semantic::kPosition, AttributeCoding::kLattice, 3, ComponentType::kFloat32, 1},
    {Semantic::kNormal, AttributeCoding::kLattice, 3, ComponentType::kFloat32, 1},
    {Semantic::kTangent, AttributeCoding::kLattice, 3, ComponentType::kFloat32, 1},
};

void drawGrid(AttributeInfo& info, Random& random) {
  info.bits = static_cast<uint8_t>(random.between(1, kGridBits + 1));
  info.tails = static_cast<uint8_t>(random.below(3));
  do {
    info.grid = static_cast<uint8_t>(random.below(kGridCount));
  } while (info.tails != 0 && !isBinaryGrid(info.grid));
}

AttributeInfo drawPosition(Random& random) {
  AttributeInfo info;
  info.bits = static_cast<uint8_t>(random.between(1, 17));
  info.lattice.step = 1;
  if (random.chance(20)) info.coding = AttributeCoding::kExactFloat;
  if (random.chance(10)) {
    info.coding = AttributeCoding::kGrid;
    drawGrid(info, random);
  }
  do {
    info.predictor = static_cast<uint8_t>(random.below(256));
  } while (
      !position_mode::goTogether(info.predictor) ||
      ((info.predictor & position_mode::kPlanes) != 0 && info.coding != AttributeCoding::kLattice));
  return info;
}

AttributeInfo drawAttribute(const Kind& kind, Random& random) {
  AttributeInfo info;
  info.format.semantic = kind.semantic;
  info.format.component_type = kind.type;
  info.format.component_count = kind.components;
  info.format.morph_target = kind.morph_target;
  info.format.set_index = random.chance(80) ? 0 : 1;
  info.coding = kind.coding;
  info.bits = static_cast<uint8_t>(random.between(2, 16));
  info.lattice.step = 0.5f;
  if (kind.coding == AttributeCoding::kGrid) drawGrid(info, random);
  return info;
}

/// A piece under construction.
struct Draft {
  PieceHeader header;
  std::vector<AttributeInfo> attributes;
  bool single = false;
  bool is_trained = false;

  PayloadHeader payloadHeader() const {
    PayloadHeader payload{Allocator{}};
    if (single) payload.flags |= payload_flag::kSingleCoder;
    if (is_trained) payload.flags |= payload_flag::kTrained;
    (void)payload.pieces.push_back(header);
    (void)payload.parts.push_back(PartInfo{static_cast<uint32_t>(header.triangleCount())});
    for (const AttributeInfo& a : attributes) (void)payload.attributes.push_back(a);
    return payload;
  }
};

void drawAttributes(Draft& draft, Random& random) {
  if (random.chance(10)) return;  // only triangles
  draft.attributes.push_back(drawPosition(random));
  constexpr uint32_t kMany = sizeof(kKinds) / sizeof(kKinds[0]);
  const uint32_t more = random.below(random.chance(50) ? 3 : 40);
  const uint32_t kinds =
      random.between(1, 3);  // few kinds of many attributes, for the worst of each
  uint32_t kind[3];
  for (uint32_t& k : kind) k = random.below(kMany);
  for (uint32_t i = 0; i < more; ++i)
    draft.attributes.push_back(drawAttribute(kKinds[kind[random.below(kinds)]], random));
  // Tangents need normals.
  if (random.chance(60)) draft.attributes.push_back(drawAttribute(kKinds[0], random));
  const uint32_t count = static_cast<uint32_t>(draft.attributes.size());
  for (uint32_t i = 1; i < count; ++i) {
    const uint32_t predictor = random.below(256);
    for (uint32_t k = 0; k < 256; ++k) {
      draft.attributes[i].predictor = static_cast<uint8_t>(predictor + k);
      if (isKnownPredictor(methodOf(draft.attributes, i), draft.attributes[i].predictor)) break;
    }
  }
  for (uint32_t i = 1; i < draft.attributes.size(); ++i) {
    if (draft.attributes[i].coding == AttributeCoding::kTangentAngle &&
        normalOfTangents(draft.attributes) == kNone) {
      draft.attributes.resize(1);
    }
  }
}

void drawFlags(Draft& draft, Random& random) {
  uint32_t& flags = draft.header.flags;
  const auto perhaps = [&](uint32_t percent, uint32_t flag) {
    if (random.chance(percent)) flags |= flag;
  };
  perhaps(30, piece_flag::kHandles);
  constexpr SurfaceCoding kSurfaces[] = {SurfaceCoding::kBoundaryCopies, SurfaceCoding::kCopies,
                                         SurfaceCoding::kPivots};
  if (random.chance(40)) draft.header.setSurface(kSurfaces[random.below(3)]);
  if (draft.header.hasPivots()) flags &= ~piece_flag::kHandles;
  perhaps(40, piece_flag::kSeams);
  if (draft.header.has(piece_flag::kSeams) && !draft.attributes.empty())
    perhaps(50, piece_flag::kCreases);
  perhaps(20, piece_flag::kTriangleOrder);
  perhaps(20, piece_flag::kVertexOrder);
  perhaps(10, piece_flag::kListed);
  perhaps(10, piece_flag::kIsolated);
  draft.single = random.chance(40);
  draft.is_trained = random.chance(20);
  if (draft.attributes.empty() || draft.attributes[0].predictor & position_mode::kPlanes) return;
  perhaps(20, piece_flag::kMirrors);
  perhaps(20, piece_flag::kAnchors);
}

class Forger {
 public:
  Forger(uint64_t seed, size_t max_bytes) : seed_(seed), max_bytes_(max_bytes) {
    Random random(seed);
    drawAttributes(draft_, random);
    drawFlags(draft_, random);
    draft_.header.attribute_count = static_cast<uint32_t>(draft_.attributes.size());
    share_ = random.between(1, 100);
    has_dummies_ = random.chance(30);
  }

  ForgedPayload run() {
    const uint64_t most = kMaxElementsPerByte * max_bytes_;
    operations_ = static_cast<uint32_t>(most / 8);
    uint32_t smaller = operations_;
    for (int attempt = 0; attempt < 12; ++attempt) {
      ForgedPayload forged;
      if (!claimCounts() || !code(forged)) return {};
      if (forged.elements <= most && forged.bytes.size() <= max_bytes_) {
        if (forged.elements > most - most / 8 || attempt > 6) return forged;
      }
      // Fewer bytes or elements take proportionally fewer operations.
      const double by_elements =
          0.97 * static_cast<double>(most) / static_cast<double>(forged.elements);
      const double factor =
          forged.bytes.size() > max_bytes_ ? std::min(0.6, by_elements) : by_elements;
      smaller = static_cast<uint32_t>(static_cast<double>(operations_) * factor);
      if (smaller == operations_ || smaller < 2) return {};
      operations_ = smaller;
    }
    return {};
  }

 private:
  uint64_t budgetBits() const { return max_bytes_ * 8 / 3; }

  /// Counts that fit the answers; with pivots any, which fit as far as they go.
  bool claimCounts() {
    PieceHeader& h = draft_.header;
    if (h.hasPivots()) {
      h.vertex_count = operations_ / 8 + 1;
      h.face_count = h.vertex_count * (1 + share_ / 16);
      claimWedges();
      return true;
    }
    McCounts claims;
    claims.operation_count = operations_;
    claims.vertex_count = 4 * operations_ + 8;
    claims.face_count = 8 * operations_ + 8;
    claims.dummy_count = has_dummies_ ? 3 : 0;
    claims.has_handles = draft_.header.has(piece_flag::kHandles);
    ForgedAnswers answers(seed_, budgetBits(), draft_.single);
    AnswersIo io(answers);
    const ObservedCodes observed = observeCodes(io, claims);
    if (!observed.failure.empty() || !observed.complete || observed.faces == 0 ||
        observed.faces > kMaxElementsPerByte * max_bytes_)
      return false;
    h.operation_count = operations_;
    h.vertex_count = observed.vertices;
    h.face_count = observed.faces;
    h.dummy_count = observed.dummies;
    if (observed.dummies != 0) h.flags |= piece_flag::kHoles;
    claimWedges();
    return true;
  }

  void claimWedges() {
    PieceHeader& h = draft_.header;
    const auto some = [&](uint32_t flag) {
      return h.has(flag) ? 1 + h.face_count / 100 * share_ : 0;
    };
    h.listed_count = some(piece_flag::kListed);
    h.isolated_count = some(piece_flag::kIsolated);
    h.wedge_count = 3 * h.face_count + h.isolated_count;
  }

  /// Runs all stages as far as they go: the reader is meant to find an error only after all that
  /// work.
  bool code(ForgedPayload& forged) {
    for (int pass = 0; pass < 3; ++pass) {
      ForgedAnswers answers(seed_, budgetBits(), draft_.single);
      if (codeStages(answers)) continue;
      forged.symbols = answers.symbols();
      const EncoderIo::Streams streams = answers.finish();
      const PayloadHeader header = draft_.payloadHeader();
      forged.elements = elementsOf(header);
      forged.bytes = writePayload(header, {streams.codes, streams.tokens, streams.raw});
      describe(forged);
      return true;
    }
    return false;
  }

  /// Returns true if a count was learnt, so that everything has to be coded again.
  bool codeStages(Answers& answers) {
    AnswersIo io(answers);
    PayloadModels models;
    if (draft_.is_trained && !startTrained(models, draft_.attributes.size() > 1, {})) return false;
    PieceHeader& h = draft_.header;
    PieceCoder<AnswersIo> piece(io, models, h, draft_.attributes, {});
    const PieceTruth nothing;
    if (!piece.codeConnectivity(nothing).ok() || !piece.codeStitch(nothing).ok()) return false;
    const auto learnWedges = [&](size_t surface_wedges) {
      const uint32_t found = static_cast<uint32_t>(surface_wedges) + h.isolated_count;
      if (h.wedge_count == found) return false;
      h.wedge_count = found;
      return true;
    };
    if (!h.has(piece_flag::kSeams) && learnWedges(piece.groups.count)) return true;
    if (!piece.codePositions(nothing).ok()) return false;
    const Status seams = piece.codeSeams(nothing);
    if (h.has(piece_flag::kSeams) && learnWedges(piece.wedge_group.size())) return true;
    if (!seams.ok() || !piece.codeLeftovers(nothing).ok()) return false;
    if (!piece.codeOrders(nothing).ok() || !piece.prepareAttributes().ok()) return false;
    Array<int32_t> values;
    for (uint32_t phase = 0; phase < kCodingPhases; ++phase) {
      for (uint32_t a = 1; a < draft_.attributes.size(); ++a) {
        if (codingPhase(draft_.attributes[a]) != phase) continue;
        if (!piece.codeAttribute(a, values).ok()) return false;
      }
    }
    return false;
  }

  void describe(ForgedPayload& forged) const {
    const PieceHeader& h = draft_.header;
    std::string& text = forged.description;
    text = (draft_.is_trained ? "trained, flags " : "flags ") + std::to_string(h.flags) + ", " +
           std::to_string(h.operation_count) + " operations, " + std::to_string(h.vertex_count) +
           " vertices, " + std::to_string(h.face_count) + " faces, " +
           std::to_string(h.triangleCount()) + " triangles, " + std::to_string(h.wedge_count) +
           " wedges";
    std::unordered_map<std::string, int> counts;
    std::vector<std::string> order;
    for (const AttributeInfo& a : draft_.attributes) {
      const std::string name = std::to_string(static_cast<int>(a.format.semantic)) + ":" +
                               std::to_string(static_cast<int>(a.coding)) + "x" +
                               std::to_string(a.format.component_count) + "/" +
                               std::to_string(a.predictor);
      if (counts[name]++ == 0) order.push_back(name);
    }
    text += "; semantic:coding x components / predictor";
    for (const std::string& name : order)
      text += " " + name + (counts[name] > 1 ? "(" + std::to_string(counts[name]) + ")" : "");
  }

  const uint64_t seed_;
  const size_t max_bytes_;
  Draft draft_;
  uint32_t operations_ = 0;
  uint32_t share_ = 0;
  bool has_dummies_ = false;
};

}  // namespace

ForgedPayload forgePayload(uint64_t seed, size_t max_bytes) {
  return Forger(seed, max_bytes).run();
}

}  // namespace mcc::test
