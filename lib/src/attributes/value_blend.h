// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Prediction of smooth values (colours, custom attributes, morph deltas) as a mean of several simple ones, each weighted by
// how well it did at the neighbours, component by component.                                 [A.8.4, B.3.2]
//
//        o         longest    the parallelogram n + p - o over the longest edge n-p of the faces v completes
//       / \        mean       the mean of all these parallelograms
//      n - p       line       2 a - b, where a is the nearest of the n and p, and b lies behind a as seen from v
//       \ /        nearest    a
//        v
//
// The weight of a candidate is 1 / e^2, with e the mean over the neighbours of its squared error there, plus one. The
// weighted mean of the e, which is what the prediction may be off by, is the context of the residual.
#ifndef MCC_ATTRIBUTES_VALUE_BLEND_H_
#define MCC_ATTRIBUTES_VALUE_BLEND_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "attributes/residuals.h"
#include "attributes/wedges.h"
#include "base/float4.h"

namespace mcc {

/// Lanes are components, of which there are at most 4.
class ValueBlend {
 public:
  static constexpr uint32_t kCandidates = 4;
  static constexpr uint32_t kErrorFloats = 4 * kCandidates;  ///< of work space per wedge

  /// `lengths`: kNotCoded for wedges that are not coded. `errors`: kErrorFloats floats per wedge.
  ValueBlend(const WedgeMesh& wedges, const EqualGroups& groups, const float* positions,
             const int32_t* values, uint32_t components, const uint8_t* lengths, float* errors)
      : wedges_(wedges),
        groups_(groups),
        positions_(positions),
        values_(values),
        components_(components),
        lengths_(lengths),
        errors_(errors) {}

  /// Predicts wedge w, whose group completes the face of half-edge `entry` with coded corners n and p.
  void predict(uint32_t w, int32_t* predicted, uint32_t* contexts);
  /// After a prediction of w that is now coded: what its candidates missed.
  void learn(uint32_t w);
  /// Of a wedge whose value was not predicted.
  void pass(uint32_t w) { std::fill_n(errors_ + kErrorFloats * size_t{w}, kErrorFloats, 0.0f); }
  /// Of a wedge that got the value of another.
  void copy(uint32_t to, uint32_t from) {
    std::copy_n(errors_ + kErrorFloats * size_t{from}, kErrorFloats,
                errors_ + kErrorFloats * size_t{to});
  }

 private:
  static constexpr uint32_t kFaceLimit = 8;
  static constexpr float kLargestError = 1e12f;  ///< squared

  const int32_t* at(uint32_t w) const { return values_ + size_t{w} * components_; }
  bool coded(uint32_t w) const { return lengths_[w] != kNotCoded; }

  /// The value of a wedge, relative to that of the origin; the subtraction wraps.
  MCC_INLINE Float4 relative(uint32_t w) const {
    int32_t value[4];
    load(w, value);
    return fourDifferences(value, origin_value_);
  }
  MCC_INLINE void load(uint32_t w, int32_t* value) const {
    const int32_t* from = at(w);
    switch (components_) {
      case 4: std::memcpy(value, from, 16); return;
      case 3: std::memcpy(value, from, 12); break;
      case 2: std::memcpy(value, from, 8); break;
      default: value[0] = from[0]; break;
    }
    for (uint32_t c = 3; c >= components_; --c) value[c] = 0;
  }
  void addNeighbour(uint32_t w) {
    for (uint32_t k = 0; k < kCandidates; ++k) {
      expected_[k] = expected_[k] + loadFloat4(errors_ + kErrorFloats * size_t{w} + 4 * k);
    }
    neighbours_ += 1;
  }
  /// 0..kLongestContext of a squared error of at least 1: up to 8 in half octaves, then in steps of two octaves.
  static uint32_t errorContext(float error) {
    const uint32_t length = static_cast<uint32_t>(
        std::bit_width(static_cast<uint32_t>(std::min(error, 1e9f) * 4)));  // from 3 on
    return length < 10 ? length - 3 : std::min(7 + (length - 10) / 4, kLongestContext);
  }
  void addFace(uint32_t h);
  void lookAlong(uint32_t h, uint32_t a, uint32_t v);
  uint32_t behind(uint32_t h) const;

  const WedgeMesh& wedges_;
  const EqualGroups& groups_;
  const float* const positions_;
  const int32_t* const values_;
  const uint32_t components_;
  const uint8_t* const lengths_;
  float* const errors_;

  int32_t origin_value_[4];        ///< what the predictions are made relative to
  Float4 candidate_[kCandidates];  ///< relative to the origin
  Float4 expected_[kCandidates];
  float neighbours_ = 0;
  float parallelograms_ = 0;
  float longest_ = 0;
  float shortest_ = 0;
  uint32_t nearest_ = kNone;
  uint32_t nearest_edge_ = kNone;  ///< half-edge from it to v
};

/// The vertex behind the start of half-edge h, which ends at v: three edges further around it, inside of its chart.
inline uint32_t ValueBlend::behind(uint32_t h) const {
  const FaceView& faces = wedges_.faces;
  const uint32_t a = faces.vertex(h);
  uint32_t r = h;
  for (uint32_t i = 0; i < 3; ++i) {
    r = faces.rotateCcw(r);
    if (r == kNone || faces.vertex(r) != a) return kNone;
  }
  const uint32_t b = faces.vertex(nextHalfEdge(r));
  return coded(b) ? b : kNone;
}

/// Notes that half-edge h runs from a to v.
inline void ValueBlend::lookAlong(uint32_t h, uint32_t a, uint32_t v) {
  const float length = squaredDistance(positions_, a, v);
  if (nearest_ != kNone && !(length < shortest_)) return;
  shortest_ = length;
  nearest_ = a;
  nearest_edge_ = h != kNone && wedges_.faces.vertex(h) == a ? h : kNone;
}

/// The face of half-edge h, which leaves v, and the one behind it.
inline void ValueBlend::addFace(uint32_t h) {
  const FaceView& faces = wedges_.faces;
  const uint32_t v = faces.vertex(h);
  const uint32_t across = nextHalfEdge(h);
  const uint32_t n = faces.vertex(across);
  const uint32_t p = faces.vertex(prevHalfEdge(h));
  if (!coded(n) || !coded(p)) return;
  addNeighbour(n);
  addNeighbour(p);
  lookAlong(faces.twin(h), n, v);
  lookAlong(prevHalfEdge(h), p, v);
  const uint32_t t = faces.twin(across);
  if (t == kNone || faces.vertex(t) != p || faces.vertex(nextHalfEdge(t)) != n) return;
  const uint32_t o = faces.vertex(prevHalfEdge(t));
  if (!coded(o)) return;
  addNeighbour(o);
  const Float4 sum = relative(n) + relative(p) - relative(o);
  const float length = squaredDistance(positions_, n, p);
  if (parallelograms_ == 0 || length > longest_) {
    longest_ = length;
    candidate_[0] = sum;
  }
  candidate_[1] = parallelograms_ == 0 ? sum : candidate_[1] + sum;
  parallelograms_ += 1;
}

inline void ValueBlend::predict(uint32_t w, int32_t* predicted, uint32_t* contexts) {
  neighbours_ = parallelograms_ = 0;
  nearest_ = nearest_edge_ = kNone;
  std::fill_n(expected_, kCandidates, allLanes(0.0f));
  uint32_t faces = 0;
  for (uint32_t m = w; m != kNone && faces < kFaceLimit; m = groups_.nextOf(m)) {
    for (uint32_t h = wedges_.firstCompleted(m); h != kNone && faces < kFaceLimit;
         h = wedges_.nextCompleted(h), ++faces) {
      if (faces == 0) load(wedges_.faces.vertex(nextHalfEdge(h)), origin_value_);
      addFace(h);
    }
  }
  candidate_[3] = relative(nearest_);
  const uint32_t b = nearest_edge_ == kNone ? kNone : behind(nearest_edge_);
  if (b != kNone) addNeighbour(b);
  candidate_[2] = b == kNone ? candidate_[3] : candidate_[3] + candidate_[3] - relative(b);
  if (parallelograms_ == 0) {
    candidate_[0] = candidate_[1] = candidate_[3];
  } else {
    candidate_[1] = candidate_[1] * allLanes(1.0f / parallelograms_);
  }
  const Float4 one = allLanes(1.0f);
  const Float4 share = allLanes(1.0f / neighbours_);
  Float4 weights = allLanes(0.0f);
  Float4 values = weights;
  Float4 errors = weights;
  for (uint32_t k = 0; k < kCandidates; ++k) {
    const Float4 e = expected_[k] * share + one;
    const Float4 weight = one / (e * e);
    weights = weights + weight;
    values = values + weight * candidate_[k];
    errors = errors + weight * e;
  }
  const Float4 inverse = one / weights;
  values = values * inverse;
  errors = errors * inverse;
  for (uint32_t c = 0; c < components_; ++c) {
    const float delta = values[static_cast<int>(c)];
    const int32_t step =
        std::fabs(delta) < 2e9f ? static_cast<int32_t>(delta + std::copysign(0.5f, delta)) : 0;
    predicted[c] =
        static_cast<int32_t>(static_cast<uint32_t>(origin_value_[c]) + static_cast<uint32_t>(step));
    contexts[c] = errorContext(errors[static_cast<int>(c)]);
  }
}

inline void ValueBlend::learn(uint32_t w) {
  const Float4 truth = relative(w);
  for (uint32_t k = 0; k < kCandidates; ++k) {
    const Float4 missed = truth - candidate_[k];
    storeFloat4(errors_ + kErrorFloats * size_t{w} + 4 * k,
                lower(missed * missed, allLanes(kLargestError)));
  }
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_VALUE_BLEND_H_
