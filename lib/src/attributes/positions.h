// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Positions. Reader and writer run the same code.                                           [A.6, B.2]
//
//   position_growth.h      order of the vertices, what is known around each
//   position_predict.h     prediction from the fan, normal shear
//   position_residual.h    scale of the residual -> row of token frequencies -> residual
//   position_parameters.h  the encoder's choices
//
// The scale is a linear function of the neighbours' residuals and of the disagreement of the tips. The components of a
// vertex do not depend on each other, except with shear, and each has its own entropy coder state.
#ifndef MCC_ATTRIBUTES_POSITIONS_H_
#define MCC_ATTRIBUTES_POSITIONS_H_

#include <cstdint>

#include "attributes/position_growth.h"
#include "attributes/position_parameters.h"
#include "attributes/position_predict.h"
#include "attributes/position_residual.h"

namespace mcc {

struct PositionModels {
  PositionRows rows;
  PositionTables tables;
};

/// `kModes` are the position_mode bits known when compiling; kAnyModes takes them from the parameters.
inline constexpr uint32_t kAnyModes = ~0u;

template <class Io, class Wide, uint32_t kModes>
class PositionCoder {
 public:
  PositionCoder(Io& io, PositionModels& models, const PositionParameters& parameters,
                FaceMesh& mesh, const Groups& groups, VertexRecord* records,
                const Allocator& allocator, const int32_t* truth)
      : io_(io),
        rows_(models.rows.row[0]),
        p_(parameters),
        growth_(mesh, groups, records, allocator),
        faces_(mesh.view()),
        group_count_(groups.count),
        records_(records),
        truth_(truth) {}

  /// Codes all groups of vertices, then the isolated ones. `records` has an entry for each; `order`, if not null,
  /// has room for the groups, see RegionGrowth. `truth` has 3 coordinates per record (encoder).
  Status run(uint32_t* order, uint32_t isolated_count);

  // --- visitor of RegionGrowth ---

  /// The inner loop: a copy of the decoder's state, which no other pointer sees.
  class Plain {
   public:
    explicit Plain(PositionCoder& coder) : coder_(coder), io_(coder.io_) {}
    void visit(uint32_t v, const PlainFan& fan) {
      const Beyond beyond =
          coder_.has(position_mode::kWeights)
              ? lookBeyond(coder_.faces_, coder_.records_, fan, coder_.has(position_mode::kSelect))
              : Beyond{};
      VertexRecord& r = coder_.records_[v];
      Prediction<Wide> prediction;
      predictPlain<Wide>(coder_.p_, fan, beyond, r.degree, coder_.modes(), prediction);
      coder_.codeVertex(io_, v, r, prediction, 1);
    }
    void close(PositionCoder& coder) {
      if constexpr (!Io::kEncoding) coder.io_ = io_;
    }
    void reopen(PositionCoder& coder) {
      if constexpr (!Io::kEncoding) io_ = coder.io_;
    }

   private:
    const PositionCoder& coder_;
    std::conditional_t<Io::kEncoding, Io&, Io> io_;
  };

  void fan(uint32_t v, const AnyFan& fan) {
    Prediction<Wide> prediction;
    predictAny<Wide>(p_, fan, records_[v].degree, prediction);
    codeVertex(io_, v, records_[v], prediction, 0);
  }
  void seed(uint32_t v, const VertexRecord* neighbour);
  Status check() const {
    if (!io_.overrun()) return {};
    return fail(Error::kTruncated, "the token stream ends inside the positions");
  }

 private:
  using UWide = std::make_unsigned_t<Wide>;

  uint32_t modes() const { return kModes == kAnyModes ? p_.modes : kModes; }
  bool has(uint32_t mode) const { return (modes() & mode) != 0; }

  void codeVertex(Io& io, uint32_t v, VertexRecord& r, const Prediction<Wide>& prediction,
                  uint32_t plain) const;
  template <uint32_t kSlot>
  int32_t codeComponent(Io& io, uint32_t v, uint32_t axis, UWide q8, const ScaleEstimate& scale,
                        uint32_t& magnitude) const;

  Io& io_;
  TokenRow* const rows_;
  const PositionParameters& p_;
  RegionGrowth growth_;
  const FaceView faces_;
  const uint32_t group_count_;
  VertexRecord* const records_;
  const int32_t* const truth_;
  int32_t last_seed_[3] = {};
  uint32_t seed_scale_[2][3] = {};
};

template <class Io, class Wide, uint32_t kModes>
Status PositionCoder<Io, Wide, kModes>::run(uint32_t* order, uint32_t isolated_count) {
  for (int s = 0; s < 3; ++s) {
    last_seed_[s] = static_cast<int32_t>((uint32_t{1} << p_.bits) / 2);
    seed_scale_[0][s] = 8u << p_.bits;
    seed_scale_[1][s] = 64;
  }
  MCC_TRY(growth_.run(*this, order));
  for (uint32_t i = 0; i < isolated_count; ++i) {
    records_[group_count_ + i] = VertexRecord{};
    seed(group_count_ + i, nullptr);
    if ((i & 0xfff) == 0) MCC_TRY(check());
  }
  return {};
}

template <class Io, class Wide, uint32_t kModes>
void PositionCoder<Io, Wide, kModes>::codeVertex(Io& io, uint32_t v, VertexRecord& r,
                                                 const Prediction<Wide>& prediction,
                                                 uint32_t plain) const {
  const ScaleCoefficients* c = p_.scale[plain];
  uint32_t axis[3] = {0, 1, 2};
  Shear shear;
  if (has(position_mode::kShear)) {
    shear = makeShear(prediction.normal);
    for (int s = 0; s < 3; ++s) axis[s] = shear.axis[s];
  }
  ScaleEstimate scale[3];
  UWide q8[3];
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
  for (int s = 0; s < 3; ++s) {
    r.q[axis[s]] = q[s];
    r.magnitude[s] = packMagnitude<Wide>(magnitude[s]);
  }
}

template <class Io, class Wide, uint32_t kModes>
template <uint32_t kSlot>
int32_t PositionCoder<Io, Wide, kModes>::codeComponent(Io& io, uint32_t v, uint32_t axis, UWide q8,
                                                       const ScaleEstimate& scale,
                                                       uint32_t& magnitude) const {
  const int32_t prediction = static_cast<int32_t>(static_cast<Wide>(q8 + 128) >> 8);
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
  int32_t residual = 0;
  if constexpr (Io::kEncoding) {
    residual = static_cast<int32_t>(static_cast<uint32_t>(truth_[3 * size_t{v} + axis]) -
                                    static_cast<uint32_t>(prediction));
  }
  residual = codeResidual<kSlot>(io, rows_[kSlot * kRowSets * kRowsPerSet + row], bucket, folded,
                                 flip, residual);
  const uint32_t bits = static_cast<uint32_t>(residual);
  magnitude = residual < 0 ? 0u - bits : bits;
  return static_cast<int32_t>(static_cast<uint32_t>(prediction) + bits);
}

/// A vertex without a known face around it: a neighbour's position or the last seed's, scale by earlier seeds. [B.2.7]
template <class Io, class Wide, uint32_t kModes>
void PositionCoder<Io, Wide, kModes>::seed(uint32_t v, const VertexRecord* neighbour) {
  VertexRecord& r = records_[v];
  uint32_t* scale = seed_scale_[neighbour != nullptr ? 1 : 0];
  const int32_t* from = neighbour != nullptr ? neighbour->q : last_seed_;
  const UWide q8[3] = {static_cast<UWide>(from[0]) << 8, static_cast<UWide>(from[1]) << 8,
                       static_cast<UWide>(from[2]) << 8};
  uint32_t magnitude[3];
  const int32_t q[3] = {codeComponent<0>(io_, v, 0, q8[0], {scale[0], 0}, magnitude[0]),
                        codeComponent<1>(io_, v, 1, q8[1], {scale[1], 0}, magnitude[1]),
                        codeComponent<2>(io_, v, 2, q8[2], {scale[2], 0}, magnitude[2])};
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

#endif  // MCC_ATTRIBUTES_POSITIONS_H_
