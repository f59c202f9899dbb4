// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Feeds random decisions directly to the stages of the decoder, past the entropy coders: topologies
// that no writer makes (handles and dummies anywhere), claims in the header that fit them, and
// every later stage on top. MCC_MACHINE_RUNS sets the number of runs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "entropy/decoder_io.h"
#include "format/predictors.h"
#include "robustness/answers_io.h"
#include "robustness/damage.h"
#include "robustness/face_check.h"
#include "robustness/observed_codes.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

constexpr uint64_t kRuns = 30000;
constexpr uint32_t kUntouched = 0xabababab;

uint64_t runsFromEnvironment() {
  const char* text = std::getenv("MCC_MACHINE_RUNS");
  return text == nullptr ? kRuns : std::strtoull(text, nullptr, 10);
}

/// Answers that are random, with a bias that changes from time to time.
class RandomAnswers final : public Answers {
 public:
  RandomAnswers(uint64_t seed, uint32_t budget) : random_(seed), budget_(budget) { lean(); }

  bool bit(BitModel& model) override {
    step();
    const bool one = random_.chance(percent_);
    model.update(one);
    return one;
  }

  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t) override {
    step();
    const uint32_t symbol = random_.below(random_.chance(10) ? kTokenCount : 4);
    row.adapt(symbol, schedule);
    return symbol;
  }

  uint32_t raw(uint32_t bits) override {
    step();
    return static_cast<uint32_t>(random_.next() & ((uint64_t{1} << bits) - 1));
  }

  bool overrun() const override { return used_ > budget_; }
  uint64_t used() const { return used_; }

 private:
  void lean() {
    percent_ = random_.between(random_.chance(30) ? 1 : 20, random_.chance(30) ? 98 : 70);
    left_ = random_.between(3, 60);
  }
  void step() {
    ++used_;
    if (left_-- == 0) lean();
  }

  Random random_;
  uint32_t budget_;
  uint64_t used_ = 0;
  uint32_t percent_ = 50;
  uint32_t left_ = 0;
};

ObservedCodes observe(uint64_t seed, const McCounts& claims) {
  RandomAnswers answers(seed, 1u << 22);
  AnswersIo io(answers);
  ObservedCodes observed = observeCodes(io, claims);
  // Every answer belongs to an operation, or closes a node, of which an operation makes at most
  // two; handles take some more.
  if (answers.used() > 200 * (uint64_t{claims.operation_count} + 10))
    observed.failure = "too much work";
  return observed;
}

struct Depth {
  uint64_t connectivity = 0;
  uint64_t stitched = 0;
  uint64_t positions = 0;
  uint64_t seams = 0;
  uint64_t attributes = 0;
};

/// Runs all stages on one random topology. Claims that only later answers can settle are learnt in
/// a first pass.
class RandomPiece {
 public:
  RandomPiece(uint64_t seed, const PieceHeader& header)
      : seed_(seed), header_(header), attributes_(18) {
    Random random(seed + 1);
    attributes_[0].bits = static_cast<uint8_t>(random.between(1, 24));
    if (random.chance(20)) attributes_[0].coding = AttributeCoding::kExactFloat;
    if (random.chance(30)) grid(attributes_[0], random);
    do {
      attributes_[0].predictor = static_cast<uint8_t>(random.below(256));
    } while (!position_mode::goTogether(attributes_[0].predictor));
    const auto attribute = [&](uint32_t i, Semantic semantic, AttributeCoding coding,
                               uint8_t components, ComponentType type = ComponentType::kFloat32) {
      attributes_[i].format.semantic = semantic;
      attributes_[i].format.component_count = components;
      attributes_[i].format.component_type = type;
      attributes_[i].coding = coding;
      attributes_[i].bits = static_cast<uint8_t>(random.between(2, 16));
    };
    attribute(1, Semantic::kNormal, AttributeCoding::kOctahedral, 3);
    attribute(2, Semantic::kTexcoord, AttributeCoding::kLattice, 2);
    attribute(3, Semantic::kCustom, AttributeCoding::kInteger, 16, ComponentType::kUint32);
    attribute(4, Semantic::kColor, AttributeCoding::kExactFloat, 4);
    attribute(5, Semantic::kTangent, AttributeCoding::kTangentAngle, 4);
    attribute(6, Semantic::kJoints, AttributeCoding::kInteger, 4, ComponentType::kUint8);
    attribute(7, Semantic::kWeights, AttributeCoding::kLattice, 4);
    attribute(8, Semantic::kNormal, AttributeCoding::kExactFloat, 3);
    attribute(9, Semantic::kTangent, AttributeCoding::kExactFloat, 4);
    attribute(10, Semantic::kTexcoord, AttributeCoding::kGrid, 2);
    attribute(11, Semantic::kTexcoord, AttributeCoding::kExactFloat, 2);
    attribute(12, Semantic::kCustom, AttributeCoding::kGrid, 4);
    attribute(13, Semantic::kTangent, AttributeCoding::kOctahedral, 4);
    const AttributeCoding deltas =
        random.chance(50) ? AttributeCoding::kLattice : AttributeCoding::kGrid;
    attribute(14, Semantic::kPosition, deltas, 3);
    attribute(15, Semantic::kNormal, deltas, 3);
    attribute(16, Semantic::kTangent, deltas, 3);
    attribute(17, Semantic::kCustom, AttributeCoding::kInteger, 1, ComponentType::kUint32);
    for (uint32_t i = 14; i < 17; ++i) {
      attributes_[i].format.morph_target = 1;
      attributes_[i].lattice.step = random.unit() + 1e-9f;
      if (deltas == AttributeCoding::kGrid) grid(attributes_[i], random);
    }
    grid(attributes_[10], random);
    grid(attributes_[12], random);
    const uint32_t count = static_cast<uint32_t>(attributes_.size());
    for (uint32_t i = 1; i < count; ++i) {
      do {
        attributes_[i].predictor = static_cast<uint8_t>(random.below(256));
      } while (!isKnownPredictor(methodOf(attributes_, i), attributes_[i].predictor));
    }
    header_.attribute_count = static_cast<uint32_t>(attributes_.size());
  }

  static void grid(AttributeInfo& info, Random& random) {
    info.coding = AttributeCoding::kGrid;
    info.bits = static_cast<uint8_t>(random.between(1, kGridBits + 1));
    info.tails = static_cast<uint8_t>(random.below(3));
    do {
      info.grid = static_cast<uint8_t>(random.below(kGridCount));
    } while (info.tails != 0 && !isBinaryGrid(info.grid));
  }

  std::string run(Depth& depth) {
    for (int pass = 0; pass < 3 && pass_failure_.empty(); ++pass) {
      if (runOnce(pass == 2 ? &depth : nullptr)) break;
    }
    return pass_failure_;
  }

 private:
  /// Returns false if claims were learnt and another pass is needed.
  bool runOnce(Depth* depth) {
    RandomAnswers answers(seed_, 1u << 22);
    AnswersIo io(answers);
    PayloadModels models;
    PieceCoder<AnswersIo> piece(io, models, header_, attributes_, {});
    const PieceTruth nothing;
    // Fails when the last vertices have no triangle, which the faces cannot show.
    if (!piece.codeConnectivity(nothing).ok()) return true;
    if (depth != nullptr) ++depth->connectivity;
    if (!piece.codeStitch(nothing).ok()) return depth != nullptr;
    if (piece.groups.count > header_.vertex_count) return end("stitching makes vertices");
    pass_failure_ = checkFaces(piece.mesh.words.data(), piece.mesh.face_count, piece.groups.count);
    if (!pass_failure_.empty()) return true;
    if (depth != nullptr) ++depth->stitched;
    const bool seams = header_.has(piece_flag::kSeams);
    if (!seams) header_.wedge_count = piece.groups.count + header_.isolated_count;
    if (!piece.codePositions(nothing).ok()) return true;
    if (depth != nullptr) ++depth->positions;
    if (!piece.codeSeams(nothing).ok()) {
      if (seams) {
        header_.wedge_count =
            static_cast<uint32_t>(piece.wedge_group.size()) + header_.isolated_count;
      }
      return depth != nullptr;
    }
    const uint32_t surface_wedges = header_.wedge_count - header_.isolated_count;
    for (uint32_t f = 0; f < piece.mesh.face_count; ++f) {
      for (uint32_t k = 0; k < 3; ++k) {
        if (piece.mesh.words[size_t{f} * kFaceWords + k] >= surface_wedges)
          return end("a corner has no wedge");
      }
    }
    for (uint32_t w = 0; w < header_.wedge_count; ++w) {
      if (piece.groupOf(w) >= piece.records.size()) return end("a wedge has no position");
    }
    if (depth != nullptr) ++depth->seams;
    if (!piece.codeLeftovers(nothing).ok()) return true;
    for (size_t i = 0; i < piece.list.size(); ++i) {
      for (const uint32_t w : piece.list[i].wedge) {
        if (w >= header_.wedge_count) return end("a listed triangle has no wedge");
      }
      if (piece.list[i].part >= header_.part_count) return end("a listed triangle has no part");
    }
    if (!piece.codeOrders(nothing).ok()) return true;
    if (!isPermutation(piece.wedge_order, 1)) return end("the wedges are in no order");
    if (!isPermutation(piece.triangle_order, 4)) return end("the triangles are in no order");
    Array<int32_t> values;
    if (!piece.prepareAttributes().ok()) return true;
    for (uint32_t a = 1; a < attributes_.size(); ++a) {
      if (!piece.codeAttribute(a, values).ok()) return true;
    }
    if (depth != nullptr) ++depth->attributes;
    return false;
  }
  static bool isPermutation(const Array<uint32_t>& order, uint32_t unit) {
    std::vector<bool> is_seen(order.size(), false);
    for (size_t i = 0; i < order.size(); ++i) {
      const uint32_t element = order[i] / unit;
      if (element >= order.size() || order[i] % unit == 3 || is_seen[element]) return false;
      is_seen[element] = true;
    }
    return true;
  }
  bool end(const char* what) {
    pass_failure_ = what;
    return true;
  }

  const uint64_t seed_;
  PieceHeader header_;
  std::vector<AttributeInfo> attributes_;
  std::string pass_failure_;
};

TEST(Machine, RandomAnswers) {
  const uint64_t runs = runsFromEnvironment();
  Watchdog watchdog;
  Depth depth;
  uint64_t with_handles = 0;
  for (uint64_t i = 0; i < runs; ++i) {
    watchdog.step(0, i);
    Random random(i);
    McCounts claims;
    claims.operation_count = random.between(1, random.chance(80) ? 30 : 400);
    claims.vertex_count = 4 * claims.operation_count + 8;
    claims.face_count = 8 * claims.operation_count + 8;
    claims.dummy_count = random.chance(50) ? 0 : random.between(1, 4);
    claims.has_handles = random.chance(70);
    const uint64_t seed = random.next();
    const ObservedCodes observed = observe(seed, claims);
    ASSERT_EQ(observed.failure, "") << "run " << i;
    if (!observed.complete || observed.dummies != claims.dummy_count || observed.faces == 0)
      continue;
    PieceHeader header;
    header.operation_count = claims.operation_count;
    header.vertex_count = observed.vertices;
    header.face_count = observed.faces;
    header.dummy_count = claims.dummy_count;
    header.isolated_count = random.chance(50) ? 0 : random.between(1, 5);
    header.wedge_count = 3 * observed.faces + header.isolated_count;
    header.flags = claims.has_handles ? piece_flag::kHandles : 0;
    header.setSurface(static_cast<SurfaceCoding>(random.below(3)));
    if (random.chance(60)) header.flags |= piece_flag::kSeams;
    if (header.has(piece_flag::kSeams) && random.chance(50)) header.flags |= piece_flag::kCreases;
    if (random.chance(50)) header.flags |= piece_flag::kTriangleOrder;
    if (random.chance(50)) header.flags |= piece_flag::kVertexOrder;
    if (random.chance(50)) header.part_count = random.between(2, 4);
    if (random.chance(50)) {
      header.flags |= piece_flag::kListed;
      header.listed_count = random.between(1, 20);
    }
    with_handles += claims.has_handles ? 1 : 0;
    ASSERT_EQ(RandomPiece(seed, header).run(depth), "") << "run " << i;
  }
  RecordProperty("connectivity", std::to_string(depth.connectivity));
  RecordProperty("stitched", std::to_string(depth.stitched));
  RecordProperty("positions", std::to_string(depth.positions));
  RecordProperty("seams", std::to_string(depth.seams));
  RecordProperty("attributes", std::to_string(depth.attributes));
  // Make sure that the runs are useful: some of them reach the end.
  EXPECT_GT(with_handles, runs / 200);
  EXPECT_GT(depth.attributes, runs / 200);
}

/// Gives random answers about faces that are listed by pivots, through all stages.
TEST(Machine, RandomPivots) {
  const uint64_t runs = runsFromEnvironment();
  Watchdog watchdog;
  Depth depth;
  for (uint64_t i = 0; i < runs; ++i) {
    watchdog.step(1, i);
    Random random(i);
    PieceHeader header;
    header.setSurface(SurfaceCoding::kPivots);
    header.face_count = random.between(1, random.chance(80) ? 30 : 400);
    header.vertex_count = random.between(3, 3 * header.face_count);
    header.isolated_count = random.chance(50) ? 0 : random.between(1, 5);
    header.wedge_count = 3 * header.face_count + header.isolated_count;
    if (random.chance(60)) header.flags |= piece_flag::kSeams;
    if (header.has(piece_flag::kSeams) && random.chance(50)) header.flags |= piece_flag::kCreases;
    if (random.chance(50)) header.flags |= piece_flag::kTriangleOrder;
    if (random.chance(50)) header.part_count = random.between(2, 4);
    ASSERT_EQ(RandomPiece(random.next(), header).run(depth), "") << "run " << i;
  }
  EXPECT_GT(depth.attributes, runs / 200);
}

/// Uses random bytes as code stream, under any claims.
TEST(Machine, RandomCodeStreams) {
  const uint64_t runs = runsFromEnvironment();
  Watchdog watchdog;
  for (uint64_t i = 0; i < runs; ++i) {
    watchdog.step(2, i);
    Random random(~i);
    std::vector<uint8_t> bytes(random.below(60));
    const uint32_t kind = random.below(3);  // random, all ones, few ones
    for (uint8_t& byte : bytes) {
      byte = static_cast<uint8_t>(kind == 0   ? random.below(256)
                                  : kind == 1 ? 0xffu
                                              : 1u << random.below(8));
    }
    McCounts claims;
    claims.operation_count = random.below(3000);
    claims.vertex_count = random.below(2000);
    claims.face_count = random.below(4000);
    claims.dummy_count = random.below(5);
    claims.has_handles = random.chance(70);
    FaceMesh mesh{Allocator{}};
    McModels models;
    ASSERT_TRUE(mesh.words.assign(size_t{claims.face_count} * kFaceWords, kUntouched));
    DecoderIo<true> io(bytes, {}, {});
    const Status status = McMachine<DecoderIo<true>>(io, models, claims, mesh, McTruth{}).run();
    if (status.ok()) {
      ASSERT_EQ(checkFaces(mesh.words.data(), mesh.face_count, mesh.vertex_count), "")
          << "run " << i;
      EXPECT_EQ(mesh.face_count, claims.face_count);
      EXPECT_EQ(mesh.vertex_count, claims.vertex_count);
    } else {
      ASSERT_TRUE(status.error == Error::kBadConnectivity || status.error == Error::kTruncated)
          << "run " << i << ": " << status.what;
    }
  }
}

}  // namespace
}  // namespace mcc::test
