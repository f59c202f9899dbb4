// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What choices of the encoder cost the decoder. A choice that takes t ns per vertex longer must make the payload smaller
// by t / 4 percent, or as many as the caller prefers, see Preference; a choice between some bytes and some time is thereby the same
// everywhere.
//
// The times are those of a release build with gcc 12 on a Zen 4, rounded: they rank the choices, on any machine. Those of
// predictors are in format/predictors.h.
#ifndef MCC_POSITIONS_ENC_PRICES_H_
#define MCC_POSITIONS_ENC_PRICES_H_

#include "format/predictors.h"
#include "mcc/types.h"
#include "positions/parameters.h"

namespace mcc {

namespace price_ns {
inline constexpr double kPaletteValue = 40;  ///< for each distinct value per vertex
/// Per copy that is stitched, and per face that is listed by pivots more than by the collapse.
inline constexpr double kCopy = 250;
inline constexpr double kPivotFace = 40;
inline constexpr double kSingleCoder = 60;  ///< more than three streams; a division per token
}  // namespace price_ns

/// Nanoseconds per vertex, more than the plain average of the tips takes. `palette_values`: distinct coordinates per
/// vertex, of all axes that have a palette.
inline double timeOf(const PositionParameters& p, double palette_values) {
  const double ns = timeOf(AttributeMethod::kPosition, p.modes);
  return p.has(position_mode::kPalette) ? ns + price_ns::kPaletteValue * palette_values : ns;
}

/// What time is worth.
class TimePrice {
 public:
  explicit TimePrice(Preference prefer)
      : payload_ns_(prefer == Preference::kSpeed  ? 240
                    : prefer == Preference::kSize ? 1500
                                                  : 400) {}

  /// What is added to a payload of so many bits for choices that take so long.
  double surcharge(double bits, double ns) const { return bits * ns / payload_ns_; }

 private:
  const double payload_ns_;  ///< as many nanoseconds per vertex are worth the whole payload
};

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_PRICES_H_
