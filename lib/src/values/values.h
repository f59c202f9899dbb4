// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Attributes without a predictor of their own (colours, custom attributes, morph deltas, floats
// that fit no grid): any number of integer components, by the parallelogram over the
// longest edge. [A.10.4]
//
// Optionally, a flag first tells that all components are 0 (morph deltas), or equal to those of a
// neighbour (colours of parts, ids, rigid regions).
#ifndef MCC_VALUES_VALUES_H_
#define MCC_VALUES_VALUES_H_

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "entropy/models.h"
#include "format/predictors.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"
#include "values/residuals.h"

namespace mcc {

inline constexpr uint32_t kValueComponents = 16;

struct ValueModels {
  TokenRow row[4][kLengthContexts];  ///< [component, 3 for all further][context]
  BitModel zero[4];                  ///< [neighbours that are 0, 3: none]
  BitModel same[2][3];  ///< [first or second neighbour][they are equal: no, yes, only one]

  ValueModels() {
    for (auto& component : row) {
      for (TokenRow& r : component) r.setUniform();
    }
  }
};

/// Codes `values`, `components` per wedge.
template <class Io>
class ValueCoder {
 public:
  ValueCoder(const AttributeJob<Io>& job, ValueModels& models)
      : job_(job),
        models_(models),
        components_(job.info.format.component_count),
        has_flags_((job.info.predictor & value_method::kFlags) != 0) {}

  void run() {
    forEachGroup<kAllComponents>(job_, Ahead<int32_t>{job_.values, components_},
                                 [this](uint32_t w) { codeGroup(w); });
  }

 private:
  static constexpr uint32_t kFaceLimit = 8;  ///< faces looked at

  int32_t* at(uint32_t w) const { return job_.values + size_t{w} * components_; }
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
  uint32_t diagonalFace(uint32_t w) const;
  void predict(uint32_t w);
  bool codeFlags(uint32_t w);
  void codeResiduals(uint32_t w);
  template <uint32_t kState>
  uint32_t codeComponent(TokenRow& row, int32_t predicted, int32_t& value) {
    const uint32_t p = static_cast<uint32_t>(predicted);
    uint32_t length = 0;
    const int32_t residual = codeByLength<kState>(
        job_.io, row, Io::kEncoding ? static_cast<int32_t>(static_cast<uint32_t>(value) - p) : 0,
        length);
    value = static_cast<int32_t>(p + static_cast<uint32_t>(residual));
    return length;
  }

  const AttributeJob<Io> job_;
  ValueModels& models_;
  const uint32_t components_;
  const bool has_flags_;
  uint32_t last_ = kNone;

  uint32_t entry_ = kNone;  ///< first face the group completes
  uint32_t n_ = kNone;      ///< its corners, or whatever neighbour there is
  uint32_t p_ = kNone;
  int32_t predicted_[kValueComponents];
};

/// [A.10.4]
template <class Io>
void ValueCoder<Io>::findNeighbours(uint32_t w) {
  n_ = p_ = kNone;
  entry_ = job_.entryFace(w);
  if (entry_ != kNone) {
    const auto [n, p] = job_.othersOf(entry_);
    if (job_.isCoded(n)) n_ = n;  // as in every sound mesh
    if (job_.isCoded(p)) p_ = p;
  } else {
    n_ = job_.neighbourAlongRun(w);
  }
  if (n_ == kNone) std::swap(n_, p_);
}

/// The half-edge across which a parallelogram has the longest diagonal, among the first faces that
/// the group of w completes; or kNone. [A.10.4]
template <class Io>
uint32_t ValueCoder<Io>::diagonalFace(uint32_t w) const {
  const FaceView& view = job_.wedges.faces;
  uint32_t found = kNone;
  float longest = -1;
  uint32_t faces = 0;
  job_.forFaces(w, [&](uint32_t h) {
    const uint32_t n = view.vertex(nextHalfEdge(h));
    const uint32_t p = view.vertex(prevHalfEdge(h));
    const uint32_t t = view.twin(nextHalfEdge(h));
    const bool is_parallelogram = t != kNone && view.vertex(t) == p &&
                                  view.vertex(nextHalfEdge(t)) == n && job_.isCoded(n) &&
                                  job_.isCoded(p) && job_.isCoded(view.vertex(prevHalfEdge(t)));
    const float length = is_parallelogram ? squaredDistance(job_.positions, n, p) : -1;
    if (length > longest) {
      longest = length;
      found = t;
    }
    return ++faces < kFaceLimit;
  });
  return found;
}

/// All sums and differences wrap.
template <class Io>
void ValueCoder<Io>::predict(uint32_t w) {
  const uint32_t t = entry_ == kNone ? kNone : diagonalFace(w);
  if (t != kNone) {
    const FaceView& view = job_.wedges.faces;
    const int32_t* n = at(view.vertex(nextHalfEdge(t)));
    const int32_t* p = at(view.vertex(t));
    const int32_t* o = at(view.vertex(prevHalfEdge(t)));
    for (uint32_t c = 0; c < components_; ++c) {
      predicted_[c] = static_cast<int32_t>(
          static_cast<uint32_t>(n[c]) + static_cast<uint32_t>(p[c]) - static_cast<uint32_t>(o[c]));
    }
    return;
  }
  const uint32_t from = n_ != kNone ? n_ : last_;
  for (uint32_t c = 0; c < components_; ++c) {
    const uint32_t x = from == kNone ? 0 : static_cast<uint32_t>(at(from)[c]);
    const uint32_t y = p_ == kNone ? x : static_cast<uint32_t>(at(p_)[c]);
    predicted_[c] =
        static_cast<int32_t>(x + static_cast<uint32_t>(static_cast<int32_t>(y - x) / 2));
  }
}

/// Whether a flag tells the value; it is then in place.
template <class Io>
bool ValueCoder<Io>::codeFlags(uint32_t w) {
  const bool n_is_zero = n_ != kNone && isZero(n_);
  const bool p_is_zero = p_ != kNone ? isZero(p_) : n_is_zero;
  const uint32_t zeros = n_ == kNone ? 3u : (n_is_zero ? 1u : 0u) + (p_is_zero ? 1u : 0u);
  if (job_.io.bit(models_.zero[zeros], Io::kEncoding && isZero(w))) {
    std::fill(at(w), at(w) + components_, 0);
    return true;
  }
  if (n_ == kNone) return false;
  const uint32_t kind = p_ == kNone ? 2 : isEqual(n_, p_) ? 1 : 0;
  if (!n_is_zero && job_.io.bit(models_.same[0][kind], Io::kEncoding && isEqual(n_, w))) {
    copy(w, n_);
    return true;
  }
  if (kind == 0 && job_.io.bit(models_.same[1][kind], Io::kEncoding && isEqual(p_, w))) {
    copy(w, p_);
    return true;
  }
  return false;
}

template <class Io>
void ValueCoder<Io>::codeResiduals(uint32_t w) {
  uint32_t context = kNoNeighbours;
  if (n_ != kNone) {
    context = job_.contextOf(n_, p_ != kNone ? p_ : n_);
  }
  uint32_t longest = 0;
  for (uint32_t c = 0; c < components_; ++c) {
    TokenRow& row = models_.row[std::min(c, 3u)][context];
    const uint32_t length = c % 3 == 0   ? codeComponent<0>(row, predicted_[c], at(w)[c])
                            : c % 3 == 1 ? codeComponent<1>(row, predicted_[c], at(w)[c])
                                         : codeComponent<2>(row, predicted_[c], at(w)[c]);
    longest = std::max(longest, length);
    context = contextAfter(context, length);
  }
  job_.lengths[w] = static_cast<uint8_t>(longest);
}

template <class Io>
void ValueCoder<Io>::codeGroup(uint32_t w) {
  findNeighbours(w);
  if (has_flags_ && codeFlags(w)) {
    job_.lengths[w] = 0;
  } else {
    predict(w);
    codeResiduals(w);
  }
  last_ = w;
}

}  // namespace mcc

#endif  // MCC_VALUES_VALUES_H_
