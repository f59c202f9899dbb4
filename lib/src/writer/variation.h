// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes random choices, for tests: decoders must handle even what the encoder would seldom choose.
#ifndef MCC_WRITER_VARIATION_H_
#define MCC_WRITER_VARIATION_H_

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "format/predictors.h"
#include "positions/enc_anchors.h"
#include "positions/enc_fit.h"
#include "positions/enc_recording.h"
#include "positions/mirror.h"

namespace mcc {

/// A sequence of choices (SplitMix64), the same on every machine.
class Variation {
 public:
  /// With seed 0 it is inactive, and the encoder chooses the smallest result.
  explicit Variation(uint64_t seed) : state_(seed), active_(seed != 0) {}

  bool active() const { return active_; }

  /// Returns a number in 0 .. bound - 1; bound must be positive.
  uint32_t below(uint32_t bound) {
    state_ += 0x9e3779b97f4a7c15u;
    uint64_t x = state_;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return static_cast<uint32_t>((x ^ (x >> 31)) >> 33) % bound;
  }
  bool coin() { return below(2) != 0; }
  template <class T>
  T oneOf(const std::vector<T>& all) {
    return all[below(static_cast<uint32_t>(all.size()))];
  }

  /// Returns a sequence for choices that came later, which leave those of this one as they are:
  /// another for each odd number.
  Variation apart(uint64_t number = 1) const {
    return Variation((state_ ^ number * 0xd1b54a32d192ed03u) | 1);
  }

  /// Returns the mirrors of a piece: those that were found, or any. `sum_bits` is how many bits a
  /// sum may have, with its sign.
  Mirrors mirrors(const Mirrors& found, uint32_t sum_bits) {
    if (found.count != 0 && below(4) != 0) return found;
    Mirrors any;
    any.count = 1 + below(kMaxMirrors);
    for (uint32_t i = 0; i < any.count; ++i) {
      const uint32_t sum = below(1u << 31) << 1 | below(2);
      any.mirror[i] = {below(3), static_cast<int32_t>(sum) >> (32 - sum_bits)};
    }
    return any;
  }

  /// Names any anchors, with any turns, for some of the components of a piece.
  void anchors(const PositionRecording& recording, Anchors& anchors) {
    std::vector<uint32_t> known;
    for (const PositionRecording::Visit& visit : recording.visits()) {
      if (!known.empty() && recording.beginsComponent(visit) && below(4) == 0)
        anchors.anchor[visit.vertex] = {oneOf(known), below(kTurnCount)};
      known.push_back(visit.vertex);
    }
  }

  PositionParameters positions(std::span<const PositionCandidate> pieces) {
    const bool planes =
        std::all_of(pieces.begin(), pieces.end(),
                    [](const PositionCandidate& piece) { return piece.planes != nullptr; });
    using namespace position_mode;
    // The kind is chosen first, because planes combine with so few of the other modes that they
    // would hardly ever occur.
    const uint8_t kinds[] = {0, kShear, kPalette, kPlanes};
    const uint8_t kind = kinds[below(planes ? 4 : 3)];
    const uint8_t others = kind == kPlanes ? kWithPlanes : static_cast<uint8_t>(~kKinds);
    PositionParameters p;
    do {
      p.modes = kind | (static_cast<uint8_t>(below(256)) & others);
    } while (!goTogether(p.modes));
    setUniversalScale(p);
    if (p.has(position_mode::kWeights)) varyWeights(p);
    if (p.has(position_mode::kOwnScale)) varyScale(p);
    return p;
  }

  /// Sets the predictor of attribute `index` and of its partner to any that are valid for their
  /// values. Fields that a later version added are drawn beside the sequence, which thus stays what
  /// it was; those of features in `without` are left at 0.
  void predictors(std::vector<AttributeInfo>& infos, uint32_t index, const FeatureSet& without) {
    AttributeInfo& info = infos[index];
    const AttributeMethod method = methodOf(infos, index);
    if (isWithAnother(method)) return;
    // Omits some of what holds for the sums, which is allowed.
    if (method == AttributeMethod::kSkin) {
      uint8_t& sums = infos[skinPartner(infos, index)].predictor;
      if (sums != 0 && coin())
        sums = static_cast<uint8_t>(coin() ? SkinSums::kUsual : SkinSums::kUnknown);
    }
    do {
      info.predictor = static_cast<uint8_t>(below(256));
    } while (!isValidPredictor(method, info.predictor) ||
             minorVersionOf(method, info.predictor) != 0);
    Variation later = apart();
    for (const PredictorField& field : infoOf(method)) {
      if (field.since == 0 || without.has(field.feature)) continue;
      info.predictor = field.with(info.predictor, later.below(field.value_count));
    }
  }

 private:
  void varyWeights(PositionParameters& p) {
    const uint32_t classes = p.has(position_mode::kSelect) ? kPredictorClasses : kClassSelect;
    p.weights = kUniversalWeights;
    for (uint32_t c = 0; c < classes; ++c) {
      if (below(4) == 0) continue;
      for (uint32_t i = 0; i < weightCount(c); ++i) {
        const int32_t far = static_cast<int32_t>(below(33)) - 16;
        p.weights.w[c][i] = static_cast<int16_t>(p.weights.w[c][i] + far);
      }
    }
  }

  void varyScale(PositionParameters& p) {
    for (uint32_t fan = 0; fan < 2; ++fan) {
      for (ScaleCoefficients& scale : p.scale[fan]) {
        for (uint32_t i = 0; i < coefficientCount(fan); ++i) {
          const int32_t from = scale.c[i];
          const int32_t to = from + static_cast<int32_t>(below(81)) - 40;
          scale.c[i] = static_cast<uint16_t>(std::clamp(to, 0, kMaxCoefficient));
        }
      }
    }
  }

  uint64_t state_;
  bool active_;
};

}  // namespace mcc

#endif  // MCC_WRITER_VARIATION_H_
