// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Codes one vertex: scales, shear and the residuals of its three components. [A.6.3, A.6]
//
// The components do not depend on each other, except with shear, and each has its own entropy coder
// state. Nothing here knows the mesh, so that the writer can try choices on a recording of it.
#ifndef MCC_POSITIONS_VERTEX_H_
#define MCC_POSITIONS_VERTEX_H_

#include <cstdint>

#include "base/host.h"
#include "format/predictors.h"
#include "positions/parameters.h"
#include "positions/plane_vertex.h"
#include "positions/predict.h"
#include "positions/residual.h"

namespace mcc {

/// Which position_mode bits are fixed at compile time, above their values. The parameters have the
/// others, and all of kAnyModes.
constexpr uint32_t fixedModes(uint32_t which, uint32_t modes) {
  return which << 8 | (modes & which);
}
inline constexpr uint32_t kAnyModes = fixedModes(0, 0);
/// What inner loops differ by.
inline constexpr uint32_t kLoopModes =
    position_mode::kWeights | position_mode::kSelect | position_mode::kKinds;
/// Apart from inner loops, only the kind is worth fixing.
constexpr uint32_t fixedKind(uint32_t fixed_modes) {
  return fixed_modes & fixedModes(position_mode::kKinds, position_mode::kKinds);
}
/// The most tokens that a vertex takes from the streams, without and with planes.
inline constexpr uint32_t kTokensOfVertex = 3;
inline constexpr uint32_t kTokensWithPlanes = 6;

inline constexpr uint8_t kFileOrder[4] = {0, 1, 2, 3};
inline constexpr Shear kNoShear = {kFileOrder, kFileOrder, 0, 0, 0};

template <class Io, uint32_t kModes>
class VertexCoder {
 public:
  VertexCoder(PositionRows& rows, const PositionParameters& parameters, VertexRecord* records,
              const int32_t* truth)
      : rows_(rows.row[0]),
        planes_(rows.planes),
        p_(parameters),
        records_(records),
        truth_(truth),
        scale_{ScaleLanes(parameters.scale[0]), ScaleLanes(parameters.scale[1])} {
    for (int s = 0; s < 3; ++s) {
      last_seed_[s] = static_cast<int32_t>((uint32_t{1} << p_.bits) / 2);
      seed_scale_[0][s] = 8u << p_.bits;
      seed_scale_[1][s] = 64;
    }
  }

  /// Codes a vertex with a plain fan. `prediction` receives what was expected.
  MCC_INLINE void codePlain(Io& io, uint32_t v, const PlainFan& fan, const Beyond* beyond,
                            Prediction& prediction) const {
    predictPlain(p_, fan, beyond, records_[v].degree(), modes(), prediction);
    codePredicted(io, v, fan, prediction);
  }
  void codeAny(Io& io, uint32_t v, const AnyFan& fan, Prediction& prediction) const {
    predictAny(p_, fan, prediction);
    codePredicted(io, v, fan, prediction);
  }
  /// Codes a vertex that has been predicted from its fan.
  MCC_INLINE void codePredicted(Io& io, uint32_t v, const PlainFan& fan,
                                const Prediction& prediction) const {
    if (has(position_mode::kPlanes)) {
      return codeOnPlanes(io, v, prediction, axesAround(fan.n0, fan.n1, fan.n2));
    }
    codeVertex(io, v, prediction, 1);
  }
  MCC_INLINE void codePredicted(Io& io, uint32_t v, const AnyFan& fan,
                                const Prediction& prediction) const {
    if (has(position_mode::kPlanes)) {
      const uint32_t last = fan.neighbour_count - 1;
      return codeOnPlanes(io, v, prediction,
                          axesAround(fan.n[0], fan.n[(last + 1) / 2], fan.n[last]));
    }
    codeVertex(io, v, prediction, 0);
  }
  /// Inner loops that decode three residuals at once have copies of this; others call one.
  MCC_SHARED void codeVertex(Io& io, uint32_t v, const Prediction& prediction,
                             uint32_t plain) const {
    if constexpr (ThreeAtOnceIo<Io>) {
      withChoice(has(position_mode::kFold), [&](auto fold) MCC_INLINE_LAMBDA {
        codeComponents(io, v, prediction, plain, fold);
      });
    } else {
      codeVertexApart(io, v, prediction, plain);
    }
  }
  void codeSeed(Io& io, uint32_t v, const VertexRecord* neighbour);

  /// Predicts a vertex with a plain fan, which codePlain() does by itself.
  void predict(uint32_t v, const FaceView& faces, const PlainFan& fan,
               Prediction& prediction) const {
    Beyond beyond{};
    if (has(position_mode::kWeights))
      beyond = lookBeyond(faces, records_, fan, has(position_mode::kSelect));
    predictPlain(p_, fan, &beyond, records_[v].degree(), modes(), prediction);
  }
  /// Stores a vertex at `q` that was expected at `from`. `axis` is that of each slot.
  void storeAt(uint32_t v, const Lanes<uint32_t>& q, const Lanes<uint32_t>& from,
               const uint8_t* axis) const {
    const Lanes<uint32_t> d = q - from;
    store(v, q, Lanes<uint32_t>{d[axis[0]], d[axis[1]], d[axis[2]], 0});
  }

  bool has(uint32_t mode) const {
    if ((kModes >> 8 & mode) != 0) return (kModes & mode) != 0;
    return p_.has(mode);
  }

 private:
  uint32_t modes() const { return (p_.modes & ~(kModes >> 8)) | (kModes & 0xff); }

  MCC_OUT_OF_LINE void codeVertexApart(Io& io, uint32_t v, const Prediction& prediction,
                                       uint32_t plain) const {
    withChoice(has(position_mode::kFold), [&](auto fold) MCC_INLINE_LAMBDA {
      codeComponents(io, v, prediction, plain, fold);
    });
  }
  template <class Fold>
  void codeComponents(Io& io, uint32_t v, const Prediction& prediction, uint32_t plain,
                      Fold fold) const;
  /// Computes how far the slots before move the prediction of a slot; 0 without shear.
  template <class Fold, class Shears>
  struct Shift {
    Shears shears;
    Fold fold;
    Shear shear;
    FinePoint at;
    Lanes<float> rest;  ///< fraction of `at` in steps

    /// Deviations are from the unrounded, unsheared prediction. With folding, the shift is rounded
    /// to whole steps, so that the prediction keeps its fraction.
    MCC_INLINE uint32_t operator()(int s, const int32_t* q) const {
      if (!shears) return 0;
      const auto deviation = [&](int k) MCC_INLINE_LAMBDA {
        const uint32_t steps = static_cast<uint32_t>(q[k]) - at.step[k];
        return static_cast<float>(static_cast<int32_t>(steps)) - rest[k];
      };
      const float by =
          s == 1 ? shear.c10 * deviation(0) : shear.c20 * deviation(0) + shear.c21 * deviation(1);
      const int32_t shift = static_cast<int32_t>(boundMove(by));
      return static_cast<uint32_t>(fold ? (shift + 128) & ~255 : shift);
    }
  };
  /// Codes the components in the order of the file, without shear.
  template <class Fold>
  MCC_INLINE void codeInFileOrder(Io& io, uint32_t v, const FinePoint& at,
                                  const ScaleEstimate& scale, Fold fold) const {
    if constexpr (kCompact && decodes::kShear) {
      codeSlots(io, v, scale, Shift<bool, bool>{false, fold, kNoShear, at, {}});
    } else {
      codeSlots(io, v, scale, Shift<Fold, std::false_type>{{}, fold, kNoShear, at, {}});
    }
  }
  template <class Fold, class Shears>
  void codeSlots(Io& io, uint32_t v, const ScaleEstimate& scale,
                 const Shift<Fold, Shears>& shift) const;
  template <uint32_t kState, class Fold>
  int32_t codeSlot(Io& io, uint32_t slot, const ResidualContexts& c, uint32_t prediction,
                   int32_t truth, int32_t* residual, Fold fold) const;
  /// Compact code calls codeSlot() only with the single coder, which has no states.
  static constexpr uint32_t stateOf(uint32_t slot) { return kCompact ? 0 : slot; }
  void codeOnPlanes(Io& io, uint32_t v, const Prediction& prediction, uint32_t context) const {
    const int32_t* truth = Io::kEncoding ? truth_ + 3 * size_t{v} : nullptr;
    PlaneVertexCoder<Io>(io, rows_, planes_, *p_.planes, prediction)
        .code(context, truth, records_[v]);
  }
  /// Returns on which axes three neighbours lie between planes, as a context.
  MCC_INLINE static uint32_t axesAround(const VertexRecord* a, const VertexRecord* b,
                                        const VertexRecord* c) {
    return (a->magnitude[1] & 7) << 6 | (b->magnitude[1] & 7) << 3 | (c->magnitude[1] & 7);
  }
  template <class Fold>
  void codeRanks(Io& io, uint32_t v, const FinePoint& at, const ScaleEstimate& scale,
                 Fold fold) const;

  MCC_INLINE int32_t truthOf(uint32_t v, uint32_t axis) const {
    return Io::kEncoding ? truth_[3 * size_t{v} + axis] : 0;
  }
  MCC_INLINE void store(uint32_t v, int32_t x, int32_t y, int32_t z,
                        const int32_t* residual) const {
    const Lanes<uint32_t> q = {static_cast<uint32_t>(x), static_cast<uint32_t>(y),
                               static_cast<uint32_t>(z), 0};
    const Lanes<uint32_t> residuals = {static_cast<uint32_t>(residual[0]),
                                       static_cast<uint32_t>(residual[1]),
                                       static_cast<uint32_t>(residual[2]), 0};
    store(v, q, residuals);
  }
  /// Stores a vertex; `residuals` must have 0 in lane 3.
  MCC_INLINE void store(uint32_t v, const Lanes<uint32_t>& q,
                        const Lanes<uint32_t>& residuals) const {
    VertexRecord& r = records_[v];
    storeLanes<uint32_t>(absoluteLanes(residuals) | Lanes<uint32_t>{0, 0, 0, r.degree()},
                         r.magnitude);
    constexpr uint32_t kAll = ~0u;
    const Lanes<uint32_t> three = {kAll, kAll, kAll, 0};
    storeLanes<uint32_t>((q & three) | Lanes<uint32_t>{0, 0, 0, kKnown},
                         reinterpret_cast<uint32_t*>(r.q));
  }

  TokenRow* const rows_;
  PlaneModels& planes_;
  const PositionParameters& p_;
  VertexRecord* const records_;
  const int32_t* const truth_;
  const ScaleLanes scale_[2];  ///< [plain fan]
  int32_t last_seed_[3] = {};
  uint32_t seed_scale_[2][3] = {};
};

template <class Io, uint32_t kModes>
template <class Fold>
MCC_INLINE void VertexCoder<Io, kModes>::codeComponents(Io& io, uint32_t v,
                                                        const Prediction& prediction,
                                                        uint32_t plain, Fold fold) const {
  if (!has(position_mode::kShear)) {
    const ScaleEstimate scale =
        estimateScale(scale_[plain], prediction.magnitudes, prediction.spread, prediction.third,
                      has(position_mode::kSplit));
    if (has(position_mode::kPalette)) return codeRanks(io, v, prediction.at, scale, fold);
    return codeInFileOrder(io, v, prediction.at, scale, fold);
  }
  const Shear shear = makeShear(prediction.normal);
  const auto inOrder = [&]<class X>(const X& x) MCC_INLINE_LAMBDA {
    return X{x[shear.axis[0]], x[shear.axis[1]], x[shear.axis[2]], 0};
  };
  const ScaleEstimate scale =
      estimateScale(scale_[plain], prediction.magnitudes, inOrder(prediction.spread),
                    inOrder(prediction.third), has(position_mode::kSplit));
  const FinePoint at = {inOrder(prediction.at.step), inOrder(prediction.at.fraction)};
  const Lanes<float> rest = at.rest();
  if constexpr (kCompact) {
    codeSlots(io, v, scale, Shift<bool, bool>{true, fold, shear, at, rest});
  } else {
    codeSlots(io, v, scale, Shift<Fold, std::true_type>{{}, fold, shear, at, rest});
  }
}

/// Codes the components by slot, in the order that the shear prescribes.
template <class Io, uint32_t kModes>
template <class Fold, class Shears>
MCC_CALLED_IF_SMALL void VertexCoder<Io, kModes>::codeSlots(
    Io& io, uint32_t v, const ScaleEstimate& scale, const Shift<Fold, Shears>& shift) const {
  const Fold fold = shift.fold;
  const uint8_t* axis = decodes::kShear ? shift.shear.axis : kFileOrder;
  const uint8_t* slot = decodes::kShear ? shift.shear.slot : kFileOrder;
  const Lanes<uint32_t> rounded = shift.at.fraction + 128;
  ResidualContexts c;
  findContexts(scale, rounded, has(position_mode::kSplit), fold, c);
  const auto prediction = [&](int s, uint32_t by) MCC_INLINE_LAMBDA {
    return shift.at.step[s] + static_cast<uint32_t>(static_cast<int32_t>(rounded[s] + by) >> 8);
  };
  int32_t q[3];
  int32_t residual[3];
  if constexpr (ThreeAtOnceIo<Io>) {
    if (io.threeAtOnce()) {
      const Lanes<uint32_t> residuals = decodeResiduals(io, rows_, c, fold);
      if (!shift.shears) {
        const Lanes<uint32_t> steps = lanesAs<uint32_t>(lanesAs<int32_t>(rounded) >> 8);
        return store(v, shift.at.step + steps + residuals, residuals);
      }
      q[0] = static_cast<int32_t>(prediction(0, 0) + residuals[0]);
      q[1] = static_cast<int32_t>(prediction(1, shift(1, q)) + residuals[1]);
      q[2] = static_cast<int32_t>(prediction(2, shift(2, q)) + residuals[2]);
      const Lanes<uint32_t> by_axis = {static_cast<uint32_t>(q[slot[0]]),
                                       static_cast<uint32_t>(q[slot[1]]),
                                       static_cast<uint32_t>(q[slot[2]]), 0};
      return store(v, by_axis, residuals);
    }
  }
  q[0] = codeSlot<stateOf(0)>(io, 0, c, prediction(0, 0), truthOf(v, axis[0]), residual, fold);
  q[1] = codeSlot<stateOf(1)>(io, 1, c, prediction(1, shift(1, q)), truthOf(v, axis[1]), residual,
                              fold);
  q[2] = codeSlot<stateOf(2)>(io, 2, c, prediction(2, shift(2, q)), truthOf(v, axis[2]), residual,
                              fold);
  store(v, q[slot[0]], q[slot[1]], q[slot[2]], residual);
}

/// Codes a number near its prediction; `residual` receives the difference.
template <class Io, uint32_t kModes>
template <uint32_t kState, class Fold>
MCC_SHARED int32_t VertexCoder<Io, kModes>::codeSlot(Io& io, uint32_t slot,
                                                     const ResidualContexts& c, uint32_t prediction,
                                                     int32_t truth, int32_t* residual,
                                                     Fold fold) const {
  const int32_t target = static_cast<int32_t>(static_cast<uint32_t>(truth) - prediction);
  TokenRow& row = rows_[c.row[slot]];
  residual[slot] = codeResidual<kState>(io, row, row.low_bits, fold ? c.folded[slot] : 0,
                                        fold ? c.flip[slot] : 0, target, fold);
  return static_cast<int32_t>(prediction + static_cast<uint32_t>(residual[slot]));
}

/// Codes the components with palettes, never sheared: where an axis has a palette, prediction and
/// scale become ranks.
template <class Io, uint32_t kModes>
template <class Fold>
void VertexCoder<Io, kModes>::codeRanks(Io& io, uint32_t v, const FinePoint& at,
                                        const ScaleEstimate& scale, Fold fold) const {
  uint32_t step[4];
  uint32_t fraction[4];
  float width[4];
  storeLanes<uint32_t>(at.step, step);
  storeLanes<uint32_t>(at.fraction, fraction);
  storeLanes<float>(scale.scale, width);
  uint32_t near[3];
  int32_t truth[3];
  for (uint32_t s = 0; s < 3; ++s) {
    near[s] = step[s] + static_cast<uint32_t>(static_cast<int32_t>(fraction[s] + 128) >> 8);
    truth[s] = truthOf(v, s);
    const AxisPalette& palette = p_.palette[s];
    if (palette.count == 0) continue;
    if (Io::kEncoding) truth[s] = static_cast<int32_t>(palette.countUpTo(truth[s])) - 1;
    const int64_t q8 =
        int64_t{256} * static_cast<int32_t>(step[s]) + static_cast<int32_t>(fraction[s]);
    const int64_t reach = static_cast<int64_t>(16 * width[s]);
    const int64_t ranks = palette.rankOf(q8 + reach) - palette.rankOf(q8 - reach);
    step[s] = 0;
    fraction[s] = static_cast<uint32_t>(palette.rankOf(q8));
    width[s] = static_cast<float>(ranks) * (1.0f / 32);
  }
  const Lanes<uint32_t> rounded = loadLanes<uint32_t>(fraction) + 128;
  ResidualContexts c;
  findContexts({loadLanes<float>(width), scale.set}, rounded, has(position_mode::kSplit), fold, c);
  const Lanes<uint32_t> expected =
      loadLanes<uint32_t>(step) + lanesAs<uint32_t>(lanesAs<int32_t>(rounded) >> 8);
  for (uint32_t s = 0; s < 3; ++s)
    truth[s] = static_cast<int32_t>(static_cast<uint32_t>(truth[s]) - expected[s]);
  const Lanes<uint32_t> known = expected + codeResiduals(io, rows_, c, truth, fold);
  int32_t residual[3];
  int32_t q[3] = {static_cast<int32_t>(known[0]), static_cast<int32_t>(known[1]),
                  static_cast<int32_t>(known[2])};
  for (uint32_t s = 0; s < 3; ++s) {
    if (p_.palette[s].count != 0) q[s] = p_.palette[s].valueOf(q[s]);
    residual[s] = static_cast<int32_t>(static_cast<uint32_t>(q[s]) - near[s]);
  }
  store(v, q[0], q[1], q[2], residual);
}

/// Codes a vertex without a known face around it: it is predicted from a neighbour or from the last
/// seed, with a scale that adapts over the seeds. [A.6.8]
template <class Io, uint32_t kModes>
void VertexCoder<Io, kModes>::codeSeed(Io& io, uint32_t v, const VertexRecord* neighbour) {
  VertexRecord& r = records_[v];
  uint32_t* scale = seed_scale_[neighbour != nullptr ? 1 : 0];
  const int32_t* from = neighbour != nullptr ? neighbour->q : last_seed_;
  const FinePoint at = {{static_cast<uint32_t>(from[0]), static_cast<uint32_t>(from[1]),
                         static_cast<uint32_t>(from[2]), 0},
                        {}};
  const ScaleEstimate estimate{floatsOf(Lanes<uint32_t>{scale[0], scale[1], scale[2], 0}), {}};
  if (has(position_mode::kPlanes)) {
    Prediction prediction{};
    prediction.at = at;
    codeOnPlanes(io, v, prediction, PlaneModels::kNoFan);
    if (neighbour == nullptr) std::copy(r.q, r.q + 3, last_seed_);
    return;
  }
  if (has(position_mode::kPalette)) {
    codeRanks(io, v, at, estimate, has(position_mode::kFold));
  } else {
    codeInFileOrder(io, v, at, estimate, has(position_mode::kFold));
  }
  for (int s = 0; s < 3; ++s) {
    scale[s] = (scale[s] + 16 * std::min(r.magnitude[s], 1u << 24)) / 2;
    if (neighbour != nullptr) continue;
    last_seed_[s] = r.q[s];
    // The distance between components says nothing about the residuals around this vertex.
    r.magnitude[s] = seed_scale_[1][s] / 16;
  }
}

}  // namespace mcc

#endif  // MCC_POSITIONS_VERTEX_H_
