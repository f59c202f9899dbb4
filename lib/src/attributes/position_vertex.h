// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// One vertex: scales, shear and the residuals of its three components.                       [A.6.3, B.2]
//
// The components do not depend on each other, except with shear, and each has its own entropy coder state. Nothing
// here knows the mesh, so that the writer can try choices on what it recorded of it.
#ifndef MCC_ATTRIBUTES_POSITION_VERTEX_H_
#define MCC_ATTRIBUTES_POSITION_VERTEX_H_

#include <cstdint>

#include "attributes/position_parameters.h"
#include "attributes/position_predict.h"
#include "attributes/position_residual.h"
#include "base/host.h"

namespace mcc {

/// `kModes` are position_mode bits: those of kCompiledModes are on or off as they say, the others as the parameters
/// say. kAnyModes leaves all of them to the parameters.
inline constexpr uint32_t kAnyModes = ~0u;
inline constexpr uint32_t kCompiledModes = position_mode::kWeights | position_mode::kSelect |
                                           position_mode::kShear | position_mode::kPalette;

template <class Io, class Wide, uint32_t kModes>
class VertexCoder {
 public:
  VertexCoder(PositionRows& rows, const PositionParameters& parameters, VertexRecord* records,
              const int32_t* truth)
      : rows_(rows.row[0]), p_(parameters), records_(records), truth_(truth) {
    for (int s = 0; s < 3; ++s) {
      last_seed_[s] = static_cast<int32_t>((uint32_t{1} << p_.bits) / 2);
      seed_scale_[0][s] = 8u << p_.bits;
      seed_scale_[1][s] = 64;
    }
  }

  MCC_INLINE void codePlain(Io& io, uint32_t v, const PlainFan& fan, const Beyond* beyond) const {
    Prediction<Wide> prediction;
    predictPlain<Wide>(p_, fan, beyond, records_[v].degree, compiledModes(), prediction);
    codeVertex(io, v, prediction, 1);
  }
  void codeAny(Io& io, uint32_t v, const AnyFan& fan) const {
    Prediction<Wide> prediction;
    predictAny<Wide>(p_, fan, records_[v].degree, prediction);
    codeVertex(io, v, prediction, 0);
  }
  void codeVertex(Io& io, uint32_t v, const Prediction<Wide>& prediction, uint32_t plain) const;
  void codeSeed(Io& io, uint32_t v, const VertexRecord* neighbour);

  bool has(uint32_t mode) const {
    if (kModes != kAnyModes && (mode & kCompiledModes) != 0) return (kModes & mode) != 0;
    return p_.has(mode);
  }

 private:
  using UWide = std::make_unsigned_t<Wide>;

  uint32_t compiledModes() const { return kModes == kAnyModes ? p_.modes : kModes; }

  template <uint32_t kSlot>
  int32_t codeComponent(Io& io, uint32_t v, uint32_t axis, UWide q8, const ScaleEstimate& scale,
                        uint32_t& magnitude) const;
  template <uint32_t kSlot>
  int32_t codeNear(Io& io, uint32_t prediction, uint32_t q8, const ScaleEstimate& scale,
                   int32_t truth) const;
  template <uint32_t kSlot>
  int32_t codeRank(Io& io, const AxisPalette& palette, int64_t q8, const ScaleEstimate& scale,
                   int32_t truth) const;

  TokenRow* const rows_;
  const PositionParameters& p_;
  VertexRecord* const records_;
  const int32_t* const truth_;
  int32_t last_seed_[3] = {};
  uint32_t seed_scale_[2][3] = {};
};

template <class Io, class Wide, uint32_t kModes>
MCC_INLINE void VertexCoder<Io, Wide, kModes>::codeVertex(Io& io, uint32_t v,
                                                          const Prediction<Wide>& prediction,
                                                          uint32_t plain) const {
  const ScaleCoefficients* c = p_.scale[plain];
  uint32_t axis[3] = {0, 1, 2};
  Shear shear;
  if (has(position_mode::kShear)) {
    shear = makeShear(prediction.normal);
    MCC_UNROLL
    for (int s = 0; s < 3; ++s) axis[s] = shear.axis[s];
  }
  ScaleEstimate scale[3];
  UWide q8[3];
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {
    scale[s] = estimateScale<Wide>(c[s], prediction.magnitudes[s], prediction.spread[axis[s]]);
    q8[s] = prediction.q8[axis[s]];
  }
  uint32_t magnitude[3];
  int32_t q[3];
  // Deviation from the unrounded, unsheared prediction; with fold the shift keeps its fraction.
  const auto deviation = [&](uint32_t s) {
    return static_cast<Wide>((static_cast<UWide>(q[s]) << 8) - prediction.q8[axis[s]]);
  };
  const auto shift = [&](int64_t sum) {
    sum >>= 12;
    return static_cast<UWide>(has(position_mode::kFold) ? (sum + 128) & ~int64_t{255} : sum);
  };
  q[0] = codeComponent<0>(io, v, axis[0], q8[0], scale[0], magnitude[0]);
  if (has(position_mode::kShear)) {
    q8[1] += shift(wrappingMultiply(shear.c10, deviation(0)));
  }
  q[1] = codeComponent<1>(io, v, axis[1], q8[1], scale[1], magnitude[1]);
  if (has(position_mode::kShear)) {
    q8[2] += shift(wrappingAdd(wrappingMultiply(shear.c20, deviation(0)),
                               wrappingMultiply(shear.c21, deviation(1))));
  }
  q[2] = codeComponent<2>(io, v, axis[2], q8[2], scale[2], magnitude[2]);
  VertexRecord& r = records_[v];
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {
    r.q[axis[s]] = q[s];
    r.magnitude[s] = packMagnitude<Wide>(magnitude[s]);
  }
}

template <class Io, class Wide, uint32_t kModes>
template <uint32_t kSlot>
MCC_INLINE int32_t VertexCoder<Io, Wide, kModes>::codeComponent(Io& io, uint32_t v, uint32_t axis,
                                                                UWide q8,
                                                                const ScaleEstimate& scale,
                                                                uint32_t& magnitude) const {
  const int32_t truth = Io::kEncoding ? truth_[3 * size_t{v} + axis] : 0;
  const uint32_t prediction = static_cast<uint32_t>(static_cast<Wide>(q8 + 128) >> 8);
  int32_t value = 0;
  if (has(position_mode::kPalette) && p_.palette[axis].count != 0) {
    value = codeRank<kSlot>(io, p_.palette[axis], static_cast<Wide>(q8), scale, truth);
  } else {
    value = codeNear<kSlot>(io, prediction, static_cast<uint32_t>(q8), scale, truth);
  }
  const uint32_t residual = static_cast<uint32_t>(value) - prediction;
  magnitude = static_cast<int32_t>(residual) < 0 ? 0u - residual : residual;
  return value;
}

/// An integer near its prediction, whose Q8 form gives the fraction.
template <class Io, class Wide, uint32_t kModes>
template <uint32_t kSlot>
MCC_INLINE int32_t VertexCoder<Io, Wide, kModes>::codeNear(Io& io, uint32_t prediction, uint32_t q8,
                                                           const ScaleEstimate& scale,
                                                           int32_t truth) const {
  const uint32_t bucket = scaleBucket(scale.scale);
  uint32_t row = bucket;
  bool folded = false;
  bool flip = false;
  if (has(position_mode::kFold)) {
    const Folding folding = foldingOf(static_cast<int32_t>((q8 + 128) & 255) - 128);
    folded = bucket < kFoldBuckets;
    flip = folding.flip;
    row = folded ? kScaleBuckets + kFoldBuckets * folding.fraction_class + bucket : bucket;
  }
  if (has(position_mode::kSplit)) row += scale.set * kRowsPerSet;
  const int32_t target = static_cast<int32_t>(static_cast<uint32_t>(truth) - prediction);
  const int32_t residual = codeResidual<kSlot>(io, rows_[kSlot * kRowSets * kRowsPerSet + row],
                                               bucket, folded, flip, target);
  return static_cast<int32_t>(prediction + static_cast<uint32_t>(residual));
}

/// The same among the values of a palette: prediction and scale become ranks.
template <class Io, class Wide, uint32_t kModes>
template <uint32_t kSlot>
int32_t VertexCoder<Io, Wide, kModes>::codeRank(Io& io, const AxisPalette& palette, int64_t q8,
                                                const ScaleEstimate& scale, int32_t truth) const {
  const int64_t reach = int64_t{16} * scale.scale;
  const int64_t rank = palette.rankOf(q8);
  const int64_t width = palette.rankOf(q8 + reach) - palette.rankOf(q8 - reach);
  const ScaleEstimate of_rank{static_cast<uint32_t>(width >> 5), scale.set};
  const int32_t true_rank = Io::kEncoding ? static_cast<int32_t>(palette.countUpTo(truth)) - 1 : 0;
  return palette.valueOf(codeNear<kSlot>(io, static_cast<uint32_t>((rank + 128) >> 8),
                                         static_cast<uint32_t>(rank), of_rank, true_rank));
}

/// A vertex without a known face around it: a neighbour's position or the last seed's, scale by earlier seeds. [B.2.7]
template <class Io, class Wide, uint32_t kModes>
void VertexCoder<Io, Wide, kModes>::codeSeed(Io& io, uint32_t v, const VertexRecord* neighbour) {
  VertexRecord& r = records_[v];
  uint32_t* scale = seed_scale_[neighbour != nullptr ? 1 : 0];
  const int32_t* from = neighbour != nullptr ? neighbour->q : last_seed_;
  const UWide q8[3] = {static_cast<UWide>(from[0]) << 8, static_cast<UWide>(from[1]) << 8,
                       static_cast<UWide>(from[2]) << 8};
  uint32_t magnitude[3];
  const int32_t q[3] = {codeComponent<0>(io, v, 0, q8[0], {scale[0], 0}, magnitude[0]),
                        codeComponent<1>(io, v, 1, q8[1], {scale[1], 0}, magnitude[1]),
                        codeComponent<2>(io, v, 2, q8[2], {scale[2], 0}, magnitude[2])};
  for (int s = 0; s < 3; ++s) {
    r.q[s] = q[s];
    r.magnitude[s] = packMagnitude<Wide>(magnitude[s]);
    scale[s] = (scale[s] + 16 * std::min(magnitude[s], 1u << 24)) / 2;
    if (neighbour == nullptr) {
      last_seed_[s] = q[s];
      // The distance between components says nothing about the residuals around this vertex.
      r.magnitude[s] = packMagnitude<Wide>(seed_scale_[1][s] / 16);
    }
  }
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITION_VERTEX_H_
