// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the encoder chooses for the positions of a piece, and how fitted tables are coded. [A.6.2]
#ifndef MCC_POSITIONS_PARAMETERS_H_
#define MCC_POSITIONS_PARAMETERS_H_

#include <cstdint>

#include "entropy/numbers.h"
#include "format/predictors.h"
#include "mcc/status.h"
#include "positions/palette.h"
#include "positions/planes.h"
#include "positions/tables.h"

namespace mcc {

struct PositionParameters {
  uint8_t modes = 0;  ///< bits of position_mode
  uint8_t bits = 14;  ///< of the lattice; the first seed is predicted at its middle
  PredictorWeights weights = {};
  ScaleCoefficients scale[2][3] = {};  ///< [plain fan][component]
  AxisPalette palette[3];              ///< only with kPalette; borrowed
  const GridPlanes* planes = nullptr;  ///< only with kPlanes; borrowed

  bool has(uint32_t mode) const { return (modes & mode & kDecodedPositionModes) != 0; }
};

/// Sets the scale coefficients that the modes imply; the payload's tables may change them.
inline void setUniversalScale(PositionParameters& p) {
  const uint32_t weighted = p.has(position_mode::kWeights) ? 1 : 0;
  const auto& scale = (p.has(position_mode::kShear) ? kShearedScale : kUniversalScale)[weighted];
  for (uint32_t fan = 0; fan < 2; ++fan) {
    for (uint32_t s = 0; s < 3; ++s) p.scale[fan][s] = scale[fan][s];
  }
}

/// The fitted tables of a payload. Each is coded with the first piece that uses it.
struct PositionTables {
  bool has_weights = false;
  bool has_selecting = false;
  bool has_scale = false;
  PredictorWeights weights = {};
  int32_t scale_change[2][3][4] = {};  ///< added to the universal coefficients
  BitModel present;
  GolombModel weight;
  GolombModel selecting_weight;
  GolombModel coefficient[4];
  PaletteModels palettes;
};

inline constexpr int32_t kMaxWeight = 1023;
inline constexpr int32_t kMaxCoefficient = 65535;

/// Codes the weights of the classes [begin, end): all 0, or as differences from the universal ones.
template <class Io>
Status codeWeights(Io& io, PositionTables& t, const PredictorWeights& truth, uint32_t begin,
                   uint32_t end) {
  GolombModel& model = begin >= kClassSelect ? t.selecting_weight : t.weight;
  for (uint32_t c = begin; c < end; ++c) {
    const uint32_t count = weightCount(c);
    bool any = false;
    for (uint32_t i = 0; Io::kEncoding && i < count; ++i) any = any || truth.w[c][i] != 0;
    if (!io.bit(t.present, any)) continue;
    for (uint32_t i = 0; i < count; ++i) {
      const int32_t from = kUniversalWeights.w[c][i];
      const int64_t w = int64_t{from} + codeSignedGolomb(io, model, truth.w[c][i] - from);
      if (w > kMaxWeight || w < -kMaxWeight) {
        return fail(Error::kBadAttribute, "a weight of the positions is out of range");
      }
      t.weights.w[c][i] = static_cast<int16_t>(w);
    }
  }
  return {};
}

template <class Io>
Status codeScale(Io& io, PositionTables& t, const PositionParameters& universal,
                 const ScaleCoefficients (*truth)[3]) {
  for (uint32_t fan = 0; fan < 2; ++fan) {
    for (uint32_t s = 0; s < 3; ++s) {
      for (uint32_t i = 0; i < coefficientCount(fan); ++i) {
        const int32_t from = universal.scale[fan][s].c[i];
        const int32_t target = Io::kEncoding ? truth[fan][s].c[i] - from : 0;
        const int64_t change = codeSignedGolomb(io, t.coefficient[i], target);
        if (from + change < 0 || from + change > kMaxCoefficient) {
          return fail(Error::kBadAttribute, "a scale of the positions is out of range");
        }
        t.scale_change[fan][s][i] = static_cast<int32_t>(change);
      }
    }
  }
  return {};
}

/// Completes `p` with the payload's fitted tables, and reads those that no earlier piece had. In
/// the encoder, `p` already holds them.
template <class Io>
Status codePositionTables(Io& io, PositionTables& t, PositionParameters& p) {
  const PositionParameters truth = p;
  setUniversalScale(p);
  if (p.has(position_mode::kWeights)) {
    if (!t.has_weights) MCC_TRY(codeWeights(io, t, truth.weights, 0, kClassSelect));
    t.has_weights = true;
    if (p.has(position_mode::kSelect)) {
      if (!t.has_selecting) {
        MCC_TRY(codeWeights(io, t, truth.weights, kClassSelect, kPredictorClasses));
      }
      t.has_selecting = true;
    }
    p.weights = t.weights;
  }
  if (!p.has(position_mode::kOwnScale)) return {};
  if (!t.has_scale) MCC_TRY(codeScale(io, t, p, truth.scale));
  t.has_scale = true;
  for (uint32_t fan = 0; fan < 2; ++fan) {
    for (uint32_t s = 0; s < 3; ++s) {
      for (uint32_t i = 0; i < coefficientCount(fan); ++i) {
        const int32_t c = p.scale[fan][s].c[i] + t.scale_change[fan][s][i];
        if (c < 0 || c > kMaxCoefficient) {
          return fail(Error::kBadAttribute, "a scale of the positions is out of range");
        }
        p.scale[fan][s].c[i] = static_cast<uint16_t>(c);
      }
    }
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_POSITIONS_PARAMETERS_H_
