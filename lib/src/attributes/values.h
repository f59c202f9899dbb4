// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Attributes without a predictor of their own (colours, custom attributes, morph deltas, exact floats): any number of
// integer components, by parallelograms or means of neighbours.                              [A.8.4, B.3]
//
// Optionally, a flag first tells that all components are 0 (morph deltas), or equal to those of a neighbour (colours of
// parts, ids, rigid regions). Ids are not predicted, see ids.h; of deltas of unit vectors some components follow from the
// others, see unit_deltas.h.
#ifndef MCC_ATTRIBUTES_VALUES_H_
#define MCC_ATTRIBUTES_VALUES_H_

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "attributes/ids.h"
#include "attributes/residuals.h"
#include "attributes/unit_deltas.h"
#include "attributes/value_blend.h"
#include "attributes/wedges.h"
#include "base/decodes.h"
#include "entropy/models.h"
#include "mesh/attribute_method.h"

namespace mcc {

enum class ValuePredictor : uint8_t {
  kParallelograms = 0,            ///< mean of all
  kMean = 1,                      ///< of the neighbours in the entry face
  kDiagonal = 2,                  ///< the parallelogram over the longest edge (exact on grids)
  kBlend = value_method::kBlend,  ///< of several, see value_blend.h; up to 4 components
};

inline constexpr uint32_t kValueComponents = 16;

struct ValueModels {
  TokenRow row[4][kLengthContexts];  ///< [component, 3 for all further][context]
  BitModel zero
      [4][2]
      [2];  ///< [neighbours that are 0, 3: none][moved in the target before][its position moves]
  TokenRow following[2];  ///< of unit vectors' deltas: components that follow from others
  BitModel same[2][3];    ///< [first or second neighbour][they are equal: no, yes, only one]

  ValueModels() {
    for (auto& component : row) {
      for (TokenRow& r : component) r.setUniform();
    }
    for (TokenRow& r : following) r.setUniform();
  }
};

/// Codes `values`, `components` per wedge.
template <class Io>
class ValueCoder {
 public:
  /// `units`: of kUnits, else null. `ids`, `id_models`: of kIds, else null; `ids` is started. Work space: `lengths`, a byte per wedge; `errors`, of kBlend only, see ValueBlend. Of morph targets, else null, a byte per wedge with a bit per semantic that is
  /// set when the delta is not 0: `moved_before` of the targets before, `moved` of this one (written here).
  ValueCoder(Io& io, ValueModels& models, const WedgeMesh& wedges, const EqualGroups& groups,
             const AttributeInfo& info, uint32_t components, const float* positions,
             const UnitDeltas* units, IdMemory* ids, IdModels* id_models, int32_t* values,
             uint8_t* lengths, float* errors, const uint8_t* moved_before, uint8_t* moved)
      : io_(io),
        models_(models),
        wedges_(wedges),
        groups_(groups),
        components_(components),
        predictor_(static_cast<ValuePredictor>(info.predictor & value_method::kPredictorMask)),
        may_repeat_((info.predictor & value_method::kSameFlags) != 0),
        may_vanish_((info.predictor & value_method::kZeroFlags) != 0),
        small_((info.predictor & value_method::kSmallTokens) != 0),
        moved_bit_(static_cast<uint8_t>(1u << static_cast<uint32_t>(info.format.semantic))),
        positions_(positions),
        units_(units),
        ids_(ids),
        id_models_(id_models),
        values_(values),
        lengths_(lengths),
        blends_(predictor_ == ValuePredictor::kBlend),
        blend_(wedges, groups, positions, values, components, lengths, errors),
        moved_before_(moved_before),
        moved_(moved) {}

  void run() {
    std::fill(lengths_, lengths_ + wedges_.count, kNotCoded);
    for (uint32_t i = 0; i < wedges_.coded_count; ++i) {
      const uint32_t w = i < wedges_.surface_count ? wedges_.wedgeAt(i) : i;
      wedges_.prefetch(i, values_, components_);
      if (groups_.isFirst(w)) codeGroup(w);
    }
  }

 private:
  static constexpr uint32_t kFaceLimit = 8;  ///< faces looked at

  int32_t* at(uint32_t w) const { return values_ + size_t{w} * components_; }
  bool coded(uint32_t w) const { return lengths_[w] != kNotCoded; }
  bool isDelta() const { return decodes::kMorphTargets && moved_ != nullptr; }
  bool blends() const { return decodes::kBlends && blends_; }
  bool isZero(uint32_t w) const {
    for (uint32_t c = 0; c < components_; ++c) {
      if (at(w)[c] != 0) return false;
    }
    return true;
  }
  bool isEqual(uint32_t a, uint32_t b) const {
    return std::memcmp(at(a), at(b), 4 * size_t{components_}) == 0;
  }
  void copy(uint32_t to, uint32_t from) { std::memcpy(at(to), at(from), 4 * size_t{components_}); }

  void codeGroup(uint32_t w);
  void findNeighbours(uint32_t w);
  void predict(uint32_t w);
  bool addParallelogram(uint32_t h, float& longest);
  bool codeFlags(uint32_t w);
  void codeResiduals(uint32_t w, bool blended);
  void codeUnitResiduals(uint32_t w, const uint32_t* contexts);
  /// A component near its prediction; `place` picks the coder's state. Returns the length of the residual.
  uint32_t codeComponent(uint32_t place, TokenRow& row, int32_t predicted, int32_t& value) {
    const uint32_t p = static_cast<uint32_t>(predicted);
    const int32_t truth =
        Io::kEncoding ? static_cast<int32_t>(static_cast<uint32_t>(value) - p) : 0;
    uint32_t length = 0;
    const int32_t residual = place % 3 == 0   ? codeResidual<0>(row, truth, length)
                             : place % 3 == 1 ? codeResidual<1>(row, truth, length)
                                              : codeResidual<2>(row, truth, length);
    value = static_cast<int32_t>(p + static_cast<uint32_t>(residual));
    return length;
  }
  template <uint32_t kState>
  int32_t codeResidual(TokenRow& row, int32_t truth, uint32_t& length) {
    return small_ ? codeSmallSigned<kState>(io_, row, truth, length)
                  : codeByLength<kState>(io_, row, truth, length);
  }

  Io& io_;
  ValueModels& models_;
  const WedgeMesh& wedges_;
  const EqualGroups& groups_;
  const uint32_t components_;
  const ValuePredictor predictor_;
  const bool may_repeat_;
  const bool may_vanish_;
  const bool small_;
  const uint8_t moved_bit_;
  const float* const positions_;
  const UnitDeltas* const units_;
  IdMemory* const ids_;
  IdModels* const id_models_;
  int32_t* const values_;
  uint8_t* const lengths_;
  const bool blends_;
  ValueBlend blend_;
  const uint8_t* const moved_before_;
  uint8_t* const moved_;
  uint32_t last_ = kNone;

  uint32_t entry_ = kNone;  ///< first face the group completes
  uint32_t n_ = kNone;      ///< its corners, or whatever neighbour there is
  uint32_t p_ = kNone;
  int64_t sum_[kValueComponents];  ///< of parallelograms
  uint32_t parallelograms_ = 0;
  int32_t predicted_[kValueComponents];
  uint32_t contexts_[kValueComponents];
};

template <class Io>
void ValueCoder<Io>::findNeighbours(uint32_t w) {
  entry_ = n_ = p_ = kNone;
  if (w >= wedges_.surface_count) return;
  for (uint32_t m = w; m != kNone && entry_ == kNone; m = groups_.nextOf(m)) {
    entry_ = wedges_.firstCompleted(m);
  }
  if (entry_ != kNone) {
    n_ = wedges_.faces.vertex(nextHalfEdge(entry_));
    p_ = wedges_.faces.vertex(prevHalfEdge(entry_));
    if (!coded(n_)) n_ = kNone;  // no sound mesh has such a face
    if (!coded(p_)) p_ = kNone;
  } else {
    wedges_.forRun(w, [this](uint32_t h) {
      const uint32_t a = wedges_.faces.vertex(nextHalfEdge(h));
      const uint32_t b = wedges_.faces.vertex(prevHalfEdge(h));
      n_ = coded(a) ? a : coded(b) ? b : kNone;
      return n_ == kNone;
    });
  }
  if (n_ == kNone) std::swap(n_, p_);
}

/// The face of half-edge h (leaving the wedge) and the one behind it. [B.3.1]
template <class Io>
bool ValueCoder<Io>::addParallelogram(uint32_t h, float& longest) {
  const FaceView& faces = wedges_.faces;
  const uint32_t n = faces.vertex(nextHalfEdge(h));
  const uint32_t p = faces.vertex(prevHalfEdge(h));
  const uint32_t t = faces.twin(nextHalfEdge(h));
  if (t == kNone || faces.vertex(t) != p || faces.vertex(nextHalfEdge(t)) != n) return false;
  const uint32_t o = faces.vertex(prevHalfEdge(t));
  if (!coded(n) || !coded(p) || !coded(o)) return false;
  if (predictor_ == ValuePredictor::kDiagonal) {
    const float length = squaredDistance(positions_, n, p);
    if (length <= longest) return false;
    longest = length;
    parallelograms_ = 0;
    std::fill(sum_, sum_ + components_, 0);
  }
  for (uint32_t c = 0; c < components_; ++c) {
    sum_[c] += int64_t{at(n)[c]} + at(p)[c] - at(o)[c];
  }
  ++parallelograms_;
  return true;
}

template <class Io>
void ValueCoder<Io>::predict(uint32_t w) {
  parallelograms_ = 0;
  if (predictor_ != ValuePredictor::kMean && entry_ != kNone) {
    std::fill(sum_, sum_ + components_, 0);
    uint32_t faces = 0;
    float longest = -1;
    for (uint32_t m = w; m != kNone && faces < kFaceLimit; m = groups_.nextOf(m)) {
      for (uint32_t h = wedges_.firstCompleted(m); h != kNone && faces < kFaceLimit;
           h = wedges_.nextCompleted(h), ++faces) {
        addParallelogram(h, longest);
      }
    }
  }
  const uint32_t fallback = n_ != kNone ? n_ : last_;
  for (uint32_t c = 0; c < components_; ++c) {
    int64_t p = 0;
    if (parallelograms_ != 0) {
      p = sum_[c] / int64_t{parallelograms_};
    } else if (p_ != kNone) {
      p = (int64_t{at(n_)[c]} + at(p_)[c]) / 2;
    } else if (fallback != kNone) {
      p = at(fallback)[c];
    }
    predicted_[c] = static_cast<int32_t>(static_cast<uint32_t>(p));
  }
}

/// Whether a flag tells the value; it is then in place.
template <class Io>
bool ValueCoder<Io>::codeFlags(uint32_t w) {
  bool n_is_zero = false;
  if (may_vanish_) {
    n_is_zero = n_ != kNone && isZero(n_);
    const uint32_t zeros = n_ == kNone ? 3u
                                       : (n_is_zero ? 1u : 0u) + (p_ == kNone  ? n_is_zero
                                                                  : isZero(p_) ? 1u
                                                                               : 0u);
    const uint32_t moved = !isDelta() || (moved_before_[w] & moved_bit_) == 0 ? 0 : 1;
    const uint32_t position_moved = !isDelta() ? 0 : moved_[w] & 1;
    const bool zero =
        io_.bit(models_.zero[zeros][moved][position_moved], Io::kEncoding && isZero(w));
    if (zero) {
      std::fill(at(w), at(w) + components_, 0);
      return true;
    }
  }
  if (!may_repeat_ || n_ == kNone) return false;
  const uint32_t kind = p_ == kNone ? 2 : isEqual(n_, p_) ? 1 : 0;
  if (!n_is_zero && io_.bit(models_.same[0][kind], Io::kEncoding && isEqual(n_, w))) {
    copy(w, n_);
    return true;
  }
  if (kind == 0 && io_.bit(models_.same[1][kind], Io::kEncoding && isEqual(p_, w))) {
    copy(w, p_);
    return true;
  }
  return false;
}

template <class Io>
void ValueCoder<Io>::codeResiduals(uint32_t w, bool blended) {
  uint32_t context = kNoNeighbours;
  if (n_ != kNone) {
    const uint32_t other = p_ != kNone ? p_ : n_;
    context = std::min((lengths_[n_] + lengths_[other] + 1u) / 2, kLongestContext);
  }
  if (decodes::kMorphTargets && units_ != nullptr) {
    const uint32_t alike[3] = {context, context, context};
    return codeUnitResiduals(w, blended ? contexts_ : alike);
  }
  int32_t* value = at(w);
  uint32_t longest = 0;
  for (uint32_t c = 0; c < components_; ++c) {
    if (decodes::kBlends && blended) context = contexts_[c];
    TokenRow& row = models_.row[std::min(c, 3u)][context];
    const uint32_t length = codeComponent(c, row, predicted_[c], value[c]);
    longest = std::max(longest, length);
    if (context != kNoNeighbours) context = (context + length + 1) / 2;
  }
  lengths_[w] = static_cast<uint8_t>(longest);
}

/// The same for three components of which some follow from the others.
template <class Io>
void ValueCoder<Io>::codeUnitResiduals(uint32_t w, const uint32_t* contexts) {
  const UnitDeltaFrame frame(*units_, w, predicted_);
  int32_t* value = at(w);
  uint32_t longest = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t c = frame.component(i);
    const bool follows = frame.follows(i);
    TokenRow& row = follows ? models_.following[i - 1] : models_.row[i][contexts[c]];
    const uint32_t length = codeComponent(i, row, predicted_[c], value[c]);
    if (!follows) longest = std::max(longest, length);
    frame.learn(i, value, predicted_);
  }
  lengths_[w] = static_cast<uint8_t>(longest);
}

template <class Io>
void ValueCoder<Io>::codeGroup(uint32_t w) {
  findNeighbours(w);
  if ((may_repeat_ || may_vanish_) && codeFlags(w)) {
    lengths_[w] = 0;
    if (blends()) blend_.pass(w);
  } else if (decodes::kIds && ids_ != nullptr) {
    const uint32_t beside = n_ != kNone ? n_ : last_;
    *at(w) = ids_->code(io_, *id_models_, beside == kNone ? 0 : *at(beside), *at(w));
    lengths_[w] = 0;
  } else if (blends() && entry_ != kNone && p_ != kNone) {
    blend_.predict(w, predicted_, contexts_);
    codeResiduals(w, true);
    blend_.learn(w);
  } else {
    predict(w);
    codeResiduals(w, false);
    if (blends()) blend_.pass(w);
  }
  last_ = w;
  uint8_t moved = 0;
  if (isDelta() && !isZero(w)) moved = moved_bit_;
  for (uint32_t m = w; m != kNone; m = groups_.nextOf(m)) {
    if (m != w) {
      copy(m, w);
      if (blends()) blend_.copy(m, w);
    }
    lengths_[m] = lengths_[w];
    if (isDelta()) moved_[m] = static_cast<uint8_t>((moved_[m] & ~moved_bit_) | moved);
  }
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_VALUES_H_
