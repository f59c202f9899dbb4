// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What choices of the encoder cost the decoder. A choice that takes t ns per vertex longer must
// make the payload smaller by t / 4 percent, or by what the caller's Preference says. This way
// every choice trades bytes for time at the same rate.
//
// The times are those of a release build with gcc 12 on a Zen 4, rounded. They only have to rank
// the choices, which they do on any machine. The times of predictors are in format/predictors.h.
#ifndef MCC_POSITIONS_ENC_PRICES_H_
#define MCC_POSITIONS_ENC_PRICES_H_

#include "format/predictors.h"
#include "mcc/types.h"
#include "positions/parameters.h"

namespace mcc {

namespace price_ns {
/// Folding has to wait for the weighted prediction, so it costs more with weights.
inline constexpr double kFoldWithWeights = 12;
/// For each distinct value, divided by the number of vertices.
inline constexpr double kPaletteValue = 40;
/// kCopy is charged for each copy that is stitched, kPivotFace for each face that is listed by
/// pivots instead of collapsed.
inline constexpr double kCopy = 250;
inline constexpr double kPivotFace = 40;
/// Candidates are looked for around the mates of the neighbours, by mirrors or by anchors.
inline constexpr double kMirrors = 20;
/// Compared with three streams; a single coder needs a division per token.
inline constexpr double kSingleCoder = 60;
}  // namespace price_ns

/// Returns how many nanoseconds per vertex the choice takes in addition to the plain average of the
/// tips. `palette_values` is the number of distinct coordinates per vertex, over all axes that have
/// a palette.
inline double timeOf(const PositionParameters& p, double palette_values) {
  double ns = timeOf(AttributeMethod::kPosition, p.modes);
  if (p.has(position_mode::kWeights) && p.has(position_mode::kFold)) {
    ns += price_ns::kFoldWithWeights;
  }
  return p.has(position_mode::kPalette) ? ns + price_ns::kPaletteValue * palette_values : ns;
}

/// The exchange rate between decoding time and bytes.
class TimePrice {
 public:
  explicit TimePrice(Preference prefer)
      : payload_ns_(prefer == Preference::kSpeed  ? 240
                    : prefer == Preference::kSize ? 1500
                                                  : 400) {}

  /// Returns the bits to add to the cost of a payload of `bits` for choices that take `ns` per
  /// vertex.
  double surcharge(double bits, double ns) const { return bits * ns / payload_ns_; }

 private:
  const double payload_ns_;  ///< this many nanoseconds per vertex are worth the whole payload
};

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_PRICES_H_
