// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// The writer's choices. Each is tried with models of its own, or with a copy of the payload's. The
// smallest result wins, after the reader's time is added to its size as a surcharge.
#include "writer/choices.h"

#include <algorithm>
#include <memory>

#include "exact/enc_grid.h"
#include "positions/enc_anchors.h"
#include "positions/enc_mirrors.h"
#include "positions/enc_prices.h"
#include "writer/predictor_search.h"
#include "writer/stages.h"

namespace mcc {
namespace {

/// Candidates for an attribute are tried on half of the wedges, but on at least kFewTrialWedges and
/// at most kTrialWedges or a fraction of all.
constexpr uint32_t kFewTrialWedges = 1000;
constexpr uint32_t kTrialWedges = 4000;
constexpr uint32_t kTrialShare = 6;
/// Per vertex, assumed when surfaces and the methods of attributes are compared.
constexpr double kExpectedPositionBits = 15;

/// Returns how many vertices the surface would have if it were listed vertex by vertex.
uint32_t pivotCount(const Plan& plan) {
  std::vector<uint8_t> is_used(plan.classes.class_count, 0);
  for (const uint32_t c : plan.cut.class_of_vertex) is_used[c] = 1;
  return static_cast<uint32_t>(std::count(is_used.begin(), is_used.end(), 1));
}

Status surfaceCost(Plan& plan, uint64_t& cost) {
  EncoderIo io;
  StageModels models;
  StageRunner runner(io, models, plan);
  MCC_TRY(runner.codeSurface(nullptr));
  cost = io.cost();
  return {};
}

using Runners = std::vector<std::unique_ptr<StageRunner>>;

/// Returns the flags of what a piece has to find mates by.
uint32_t matesIn(const Plan& plan) {
  return (plan.mirrors.count != 0 ? piece_flag::kMirrors : 0) |
         (plan.anchors.count != 0 ? piece_flag::kAnchors : 0);
}

/// Returns these flags of all pieces.
uint32_t matesIn(const std::vector<Plan>& plans) {
  uint32_t flags = 0;
  for (const Plan& plan : plans) flags |= matesIn(plan);
  return flags;
}

/// The ways to code positions that are left when mirrors and anchors are still to be chosen. The
/// first is the best without them.
using PositionChoices = std::vector<PositionParameters>;

/// Chooses once for all pieces, since they share tables and models. Consumes the recordings.
PositionChoices choosePositions(std::vector<RecordedPositions> recorded, bool any_mates,
                                double surface_bits, const EncodeSettings& options,
                                const Jobs& jobs) {
  std::vector<PositionCandidate> candidates;
  for (const RecordedPositions& piece : recorded) candidates.push_back(piece.candidate);
  PositionSettings settings{options.prefer, options.without};
  PositionChoices choices = {choosePositionParameters(candidates, surface_bits, settings, jobs)};
  // A palette of all coordinates is dear when mates save half of them.
  if (any_mates && choices[0].has(position_mode::kPalette)) {
    settings.without.add(Feature::kPalette);
    choices.push_back(choosePositionParameters(candidates, surface_bits, settings, jobs));
  }
  return choices;
}

/// Gives all pieces the same way to code their positions. `mates` are flags of what they may use.
void setPositions(std::vector<Plan>& plans, const PositionParameters& parameters, uint32_t mates) {
  for (Plan& plan : plans) {
    plan.positions_as = parameters;
    plan.attributes[0].info.predictor = parameters.modes;
    plan.header.flags &= ~piece_flag::kSinceMinor1;
    plan.header.flags |= mates & matesIn(plan);
  }
}

/// Counts what the positions of all pieces cost, with their surfaces.
Status costWithPositions(std::vector<Plan>& plans, double& bits) {
  EncoderIo io;
  StageModels models(plans);
  for (Plan& plan : plans) {
    StageRunner runner(io, models, plan);
    MCC_TRY(runner.codeSurface(nullptr));
    MCC_TRY(runner.codePositions(nullptr));
  }
  bits = static_cast<double>(io.cost()) / kCostOne;
  return {};
}

/// Lets no attribute ask for mates, which pieces with neither mirrors nor anchors do not have.
void forgetMates(std::vector<Plan>& plans) {
  for (Plan& plan : plans) {
    std::vector<AttributeInfo> infos = infosOf(plan);
    for (uint32_t i = 1; i < infos.size(); ++i) {
      if (asksMates(methodOf(infos, i), infos[i].predictor))
        plan.attributes[i].info.predictor &= static_cast<uint8_t>(~kHasMates);
    }
  }
}

/// Settles how positions are coded: by the first choice with neither mirrors nor anchors, or by any
/// with them.
/// `mates_bits` is what attributes gain by mates.
Status settlePositions(std::vector<Plan>& plans, const PositionChoices& choices, double mates_bits,
                       const EncodeSettings& options) {
  setPositions(plans, choices[0], 0);
  const uint32_t all = matesIn(plans);
  if (all == 0) return {};
  if (choices[0].has(position_mode::kPlanes)) {
    forgetMates(plans);
    return {};
  }
  double least = 0;
  MCC_TRY(costWithPositions(plans, least));
  const TimePrice price(options.prefer);
  const PositionParameters* best = nullptr;
  uint32_t best_mates = 0;
  for (const uint32_t mates :
       {piece_flag::kMirrors, piece_flag::kAnchors, piece_flag::kSinceMinor1}) {
    if ((mates & ~all) != 0) continue;
    for (const PositionParameters& choice : choices) {
      double bits = 0;
      setPositions(plans, choice, mates);
      MCC_TRY(costWithPositions(plans, bits));
      bits += price.surcharge(bits, price_ns::kMirrors) - mates_bits;
      if (bits >= least) continue;
      least = bits;
      best = &choice;
      best_mates = mates;
    }
  }
  setPositions(plans, best != nullptr ? *best : choices[0], best_mates);
  if (best == nullptr) forgetMates(plans);
  return {};
}

/// Lists the ways to code an attribute. Unit vectors on a grid may be coded as floats as well;
/// their values in a plan are the same.
std::vector<AttributeInfo> exactAlternatives(const AttributeInfo& info, const FeatureSet& without) {
  std::vector<AttributeInfo> all = {info};
  const bool may_be_plain =
      info.format.semantic == Semantic::kTangent ||
      (info.format.semantic == Semantic::kNormal && !without.has(Feature::kExactNormals));
  if (info.coding == AttributeCoding::kGrid && info.format.morph_target == 0 && may_be_plain) {
    AttributeInfo plain;
    plain.format = info.format;
    plain.coding = AttributeCoding::kExactFloat;
    all.push_back(plain);
  }
  return all;
}

/// What the methods of all attributes are chosen by.
struct MethodRules {
  double wedge_share;  ///< what surfaces and positions take, per wedge, in the units of costs
  TimePrice price;
  const FeatureSet& without;
};

/// Tries the candidates of one attribute, starting from the current models, and continues with the
/// best. `goes_on` says that some later attribute shares its models. Adds to `mates_bits` what
/// mates gain.
Status chooseAttributeMethod(Plan& plan, uint32_t index, StageRunner& runner,
                             const MethodRules& rules, bool goes_on, double& mates_bits) {
  AttributeInfo& info = plan.attributes[index].info;
  const std::vector<AttributeInfo> alternatives = exactAlternatives(info, rules.without);
  const uint32_t count = plan.header.wedge_count;
  const uint32_t part =
      std::clamp(count / 2, kFewTrialWedges, std::max(kTrialWedges, count / kTrialShare));
  // Everything below a grid is always coded for all wedges, so a sample would distort the
  // comparison.
  const uint32_t sample = alternatives.size() > 1 ? kNone : part;
  runner.prepareTrials();
  AttributeInfo best = info;
  uint64_t best_cost = ~uint64_t{0};
  uint64_t best_without_mates = ~uint64_t{0};
  FeatureSet without = rules.without;
  if (matesIn(plan) == 0) without.add(Feature::kMates);
  for (AttributeInfo candidate : alternatives) {
    info = candidate;
    const std::vector<AttributeInfo> infos = infosOf(plan);
    const AttributeMethod method = methodOf(infos, index);
    if (isWithAnother(method)) return {};
    PredictorSearch search(method, plan.header.has(piece_flag::kSeams), without);
    if (alternatives.size() == 1 && search.isSettled()) {
      best.predictor = search.best();
      break;
    }
    while (!search.done()) {
      uint64_t cost = 0;
      info.predictor = candidate.predictor = search.candidate();
      MCC_TRY(runner.tryAttribute(index, sample, cost));
      const double tried = std::min(sample, plan.header.wedge_count);
      cost += static_cast<uint64_t>(
          rules.price.surcharge(tried * rules.wedge_share, timeOf(method, info.predictor)));
      search.report(cost);
      if (!asksMates(method, info.predictor))
        best_without_mates = std::min(best_without_mates, cost);
      if (cost >= best_cost) continue;
      best_cost = cost;
      best = candidate;
    }
  }
  info = best;
  if (best_cost < best_without_mates) {  // the search begins without mates
    const double tried = std::min(sample, count);
    mates_bits += static_cast<double>(best_without_mates - best_cost) / kCostOne * count / tried;
  }
  return goes_on ? runner.codeAttribute(index, nullptr) : runner.passAttribute(index);
}

/// Chooses creases and the methods of all attributes but positions; they do not depend on how
/// positions are coded, except for mates. `io` has counted the surfaces, and the positions are
/// recorded. `mates_bits` receives what mates gain.
Status chooseMethods(std::vector<Plan>& plans, Runners& runners, const EncoderIo& io,
                     const EncodeSettings& options, double& mates_bits) {
  const bool only_positions = std::all_of(plans.begin(), plans.end(), [](const Plan& plan) {
    return plan.attributes.size() == 1 && !plan.header.has(piece_flag::kSeams);
  });
  if (only_positions) return {};
  double wedges = 1;
  double expected_cost = static_cast<double>(io.cost());
  for (const Plan& plan : plans) {
    wedges += plan.header.wedge_count;
    expected_cost += plan.header.vertex_count * kExpectedPositionBits * kCostOne;
  }
  const MethodRules rules{expected_cost / wedges, TimePrice(options.prefer), options.without};
  for (size_t i = 0; i < plans.size(); ++i) {
    runners[i]->guessMates();
    const bool without_creases = options.without.has(Feature::kCreases);
    MCC_TRY(without_creases ? runners[i]->codeSeams(nullptr) : runners[i]->chooseSeams());
    MCC_TRY(runners[i]->prepareAttributes());
    const std::vector<uint32_t> order = codingOrder(plans[i]);
    for (size_t k = 0; k < order.size(); ++k) {
      bool goes_on = i + 1 < plans.size();
      for (size_t later = k + 1; later < order.size(); ++later) {
        goes_on |= plans[i].attributes[order[later]].info.format.semantic ==
                   plans[i].attributes[order[k]].info.format.semantic;
      }
      MCC_TRY(chooseAttributeMethod(plans[i], order[k], *runners[i], rules, goes_on, mates_bits));
    }
  }
  return {};
}

/// Chooses at random, instead of chooseAttributeMethod().
void varyAttributeMethod(Plan& plan, uint32_t index, Variation& variation,
                         const FeatureSet& without) {
  std::vector<AttributeInfo> infos = infosOf(plan);
  infos[index] = variation.oneOf(exactAlternatives(infos[index], {}));
  variation.predictors(infos, index, without);
  for (size_t i = 0; i < infos.size(); ++i) plan.attributes[i].info = infos[i];
}

}  // namespace

Status chooseSurface(Plan& plan, uint32_t start_half_edge, const FeatureSet& without,
                     Variation* variation, const TimePrice& price, const Jobs& jobs) {
  prepareConnectivity(plan, start_half_edge);
  if (!plan.header.hasCopies() || without.has(Feature::kPivots) || !allowsPivots(plan)) return {};
  // With few copies, seams and predictions are better with the umbrellas that the cut leaves.
  if (variation == nullptr && plan.header.vertex_count < 2 * pivotCount(plan)) return {};
  Plan other = plan;
  preparePivots(other);
  if (variation != nullptr) {
    if (variation->coin()) plan = std::move(other);
    return {};
  }
  uint64_t cut = 0;
  uint64_t pivots = 0;
  MCC_TRY(jobs.tryAll(
      2, [&](size_t i) { return i == 0 ? surfaceCost(plan, cut) : surfaceCost(other, pivots); }));
  // Times are weighed as shares of what positions and the rest take per vertex.
  const double vertices = std::max(other.header.vertex_count, 1u);
  const double copies = plan.header.vertex_count - vertices;
  const double payload = static_cast<double>(pivots) + vertices * kExpectedPositionBits * kCostOne;
  const auto costOfTime = [&](double ns) { return price.surcharge(payload, ns / vertices); };
  const double cut_cost = static_cast<double>(cut) + costOfTime(copies * price_ns::kCopy);
  const double pivots_cost =
      static_cast<double>(pivots) + costOfTime(plan.header.face_count * price_ns::kPivotFace);
  if (pivots_cost < cut_cost) plan = std::move(other);
  return {};
}

Status chooseAll(std::vector<Plan>& plans, const EncodeSettings& options, const Jobs& jobs) {
  StageModels models(plans);
  EncoderIo io;
  Runners runners;
  for (Plan& plan : plans) {
    runners.push_back(std::make_unique<StageRunner>(io, models, plan));
    MCC_TRY(runners.back()->codeSurface(nullptr));
  }
  const double surface_bits = static_cast<double>(io.cost()) / kCostOne;
  if (plans[0].attributes.empty()) return {};
  std::vector<RecordedPositions> recorded(plans.size());
  MCC_TRY(jobs.tryAll(plans.size(),
                      [&](size_t i) { return runners[i]->recordPositions(recorded[i]); }));
  for (size_t i = 0; i < plans.size() && !options.without.has(Feature::kMirrors); ++i)
    plans[i].mirrors = findMirrors(plans[i].positions, sumBits(recorded[i].candidate.bits));
  for (size_t i = 0; i < plans.size() && !options.without.has(Feature::kAnchors); ++i)
    plans[i].anchors = findAnchors(plans[i].positions, *recorded[i].recording, plans[i].mirrors);
  PositionChoices choices;
  double mates_bits = 0;
  MCC_TRY(jobs.tryAll(2, [&](size_t i) -> Status {
    if (i == 1) return chooseMethods(plans, runners, io, options, mates_bits);
    const bool any = matesIn(plans) != 0;
    choices = choosePositions(std::move(recorded), any, surface_bits, options, jobs);
    return {};
  }));
  return settlePositions(plans, choices, mates_bits, options);
}

namespace {

/// Half of the pieces have mirrors, if the way to code positions allows them.
void varyMirrors(std::vector<Plan>& plans, std::span<const PositionCandidate> candidates,
                 Variation variation) {
  for (size_t i = 0; i < plans.size(); ++i) {
    Plan& plan = plans[i];
    if (plan.positions_as.has(position_mode::kPlanes) || !variation.coin()) continue;
    plan.header.flags |= piece_flag::kMirrors;
    const uint32_t sum_bits = sumBits(candidates[i].bits);
    plan.mirrors = variation.mirrors(findMirrors(plan.positions, sum_bits), sum_bits);
  }
}

/// Likewise with anchors.
void varyAnchors(std::vector<Plan>& plans, std::span<const RecordedPositions> recorded,
                 Variation variation) {
  for (size_t i = 0; i < plans.size(); ++i) {
    Plan& plan = plans[i];
    if (plan.positions_as.has(position_mode::kPlanes) || !variation.coin()) continue;
    plan.header.flags |= piece_flag::kAnchors;
    plan.anchors = findAnchors(plan.positions, *recorded[i].recording, plan.mirrors);
    variation.anchors(*recorded[i].recording, plan.anchors);
  }
}

}  // namespace

Status varyAll(std::vector<Plan>& plans, Variation& variation, const FeatureSet& without) {
  StageModels models(plans);
  EncoderIo io;
  Runners runners;
  for (Plan& plan : plans) {
    runners.push_back(std::make_unique<StageRunner>(io, models, plan));
    MCC_TRY(runners.back()->codeSurface(nullptr));
  }
  if (plans[0].attributes.empty()) return {};
  std::vector<RecordedPositions> recorded(plans.size());
  std::vector<PositionCandidate> candidates;
  for (size_t i = 0; i < plans.size(); ++i) {
    MCC_TRY(runners[i]->recordPositions(recorded[i]));
    candidates.push_back(recorded[i].candidate);
  }
  const PositionParameters positions = variation.positions(candidates);
  for (size_t i = 0; i < plans.size(); ++i) {
    Plan& plan = plans[i];
    plan.positions_as = positions;
    plan.attributes[0].info.predictor = positions.modes;
    if (plan.header.has(piece_flag::kSeams) && variation.coin())
      plan.header.flags ^= piece_flag::kCreases;
    for (const uint32_t a : codingOrder(plan)) varyAttributeMethod(plan, a, variation, without);
  }
  if (!without.has(Feature::kMirrors)) varyMirrors(plans, candidates, variation.apart());
  if (!without.has(Feature::kAnchors)) varyAnchors(plans, recorded, variation.apart().apart());
  return {};
}

}  // namespace mcc
