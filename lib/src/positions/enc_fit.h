// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The encoder's choices for the positions of a payload: predictor, fitted tables, modes.
#ifndef MCC_POSITIONS_ENC_FIT_H_
#define MCC_POSITIONS_ENC_FIT_H_

#include <cstdint>
#include <span>
#include <vector>

#include "base/enc_jobs.h"
#include "format/features.h"
#include "mcc/types.h"
#include "positions/parameters.h"

namespace mcc {

class PositionRecording;  // positions/enc_recording.h

/// One piece as the trials see it.
struct PositionCandidate {
  const PositionRecording* recording = nullptr;
  const int32_t* truth = nullptr;      ///< 3 per record
  uint8_t bits = 0;                    ///< PositionParameters::bits
  AxisPalette palettes[3];             ///< for axes with few distinct values
  const AxisPlanes* planes = nullptr;  ///< for the three axes, or null
};

/// The sorted distinct coordinates of each axis; empty where there are too many for a palette to be
/// useful.
struct DistinctCoordinates {
  std::vector<int32_t> axis[3];
  std::vector<uint32_t> cells[3];
  uint32_t shift[3] = {};

  /// Finds the distinct coordinates. `is_exact` says that the coordinates are floats that keep
  /// every bit, for which even a large palette may pay.
  void find(std::span<const int32_t> truth, bool is_exact);
  AxisPalette palette(uint32_t s) const {
    return {axis[s].data(), static_cast<uint32_t>(axis[s].size()), cells[s].data(), shift[s]};
  }
};

/// What the choice depends on in addition to the pieces.
struct PositionSettings {
  Preference prefer = Preference::kBalanced;
  FeatureSet without;
};

/// Tries predictors and modes on the pieces, or on an even sample of their vertices if they
/// have many, and returns the cheapest combination with its tables. A choice that costs time in the
/// decoder must be worth it, see enc_prices.h; `surface_bits` is the size of the connectivity.
/// Deterministic on every machine.
PositionParameters choosePositionParameters(std::span<const PositionCandidate> pieces,
                                            double surface_bits, const PositionSettings& settings,
                                            const Jobs& jobs);

/// Chooses the weights of each class of predictors: none, the trained ones, or a least-squares fit
/// to these pieces, whichever costs the fewest bits. `robust` weighs residuals by the
/// inverse of their square instead of by the inverse of their size. tools/train uses this too.
PredictorWeights fitWeights(std::span<const PositionCandidate> pieces, bool select, bool robust,
                            uint32_t max_vertices, const FeatureSet& without);

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_FIT_H_
