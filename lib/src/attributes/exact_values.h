// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exact floats that fit no grid well, or that repeat: any attribute of up to four components without a coder of its own.
// Predictions are made in binary64 from the neighbours' values.                              [A.8.11]
//
// Optionally, the third corners of faces are remembered by the values at the other two: charts that are used twice,
// mirrored ones too, cost a flag per vertex.
#ifndef MCC_ATTRIBUTES_EXACT_VALUES_H_
#define MCC_ATTRIBUTES_EXACT_VALUES_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "attributes/edge_memory.h"
#include "attributes/exact_vectors.h"
#include "attributes/wedges.h"
#include "mesh/attribute_method.h"

namespace mcc {

enum class ExactPredictor : uint8_t {
  kParallelograms = 0,  ///< mean of all
  kMean = 1,            ///< of the neighbours in the entry face
  kHinge = 2,  ///< affine map from space to values, unfolded over the edge; see texcoords.h
};

struct ExactValueModels {
  TokenRow row[kGridComponents][kScaleBuckets];
  BitModel known[2][4];  ///< [first or second wedge known][last two outcomes]

  bool is_ready = false;

  /// Before the first use: most payloads have no such values.
  void prepare() {
    if (is_ready) return;
    is_ready = true;
    for (auto& component : row) {
      std::copy_n(InitialRowTable::table.plain, kScaleBuckets, component);
    }
  }
};

/// Codes ordered floats, `components` per wedge.
template <class Io>
class ExactValueCoder {
 public:
  /// `positions`: 3 finite floats per wedge. Work space: `errors` a float per wedge. `edges`: prepared, or null.
  ExactValueCoder(Io& io, ExactValueModels& models, const WedgeMesh& wedges,
                  const EqualGroups& groups, const AttributeInfo& info, const float* positions,
                  int32_t* values, float* errors, EdgeMemory* edges)
      : io_(io),
        models_(models),
        wedges_(wedges),
        groups_(groups),
        components_(info.format.component_count),
        predictor_(
            static_cast<ExactPredictor>(info.predictor & exact_value_method::kPredictorMask)),
        positions_(positions),
        values_(values),
        errors_(errors),
        edges_(edges) {
    models_.prepare();
  }

  void run() {
    std::fill(errors_, errors_ + wedges_.count, kNotYet);
    for (uint32_t i = 0; i < wedges_.count; ++i) {
      const uint32_t w = i < wedges_.surface_count ? wedges_.wedgeAt(i) : i;
      if (groups_.isFirst(w)) codeGroup(w);
    }
  }

 private:
  static constexpr float kNotYet = -1;
  static constexpr uint32_t kFaceLimit = 16;
  static constexpr double kSteepest = 36;  ///< see texcoords.h

  int32_t* at(uint32_t w) const { return values_ + size_t{w} * components_; }
  bool coded(uint32_t w) const { return errors_[w] >= 0; }
  bool isEqual(uint32_t a, uint32_t b) const {
    return std::equal(at(a), at(a) + components_, at(b));
  }
  uint64_t hashOf(uint32_t w) const {
    uint64_t h = 0x243f6a8885a308d3u;
    for (uint32_t c = 0; c < components_; ++c) {
      h = (h ^ static_cast<uint32_t>(at(w)[c])) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return h;
  }
  /// Alike for both directions of the edge.
  uint64_t keyOf(uint32_t a, uint32_t b) const {
    const uint64_t h = (hashOf(a) + hashOf(b)) * 0xbf58476d1ce4e5b9u;
    return h ^ (h >> 32);
  }

  void codeGroup(uint32_t w);
  void addFace(uint32_t h);
  void addHinge(uint32_t v, uint32_t n, uint32_t p, uint32_t o);
  bool codeKnown(uint32_t w, uint32_t n, uint32_t p, uint32_t o);
  void codeComponents(uint32_t w, const double* predicted, double expected);
  void learnFaces(uint32_t w);
  uint32_t across(uint32_t h) const;
  template <uint32_t kState>
  double codeComponent(uint32_t c, double predicted, double expected, int32_t& value);

  Io& io_;
  ExactValueModels& models_;
  const WedgeMesh& wedges_;
  const EqualGroups& groups_;
  const uint32_t components_;
  const ExactPredictor predictor_;
  const float* const positions_;
  int32_t* const values_;
  float* const errors_;
  EdgeMemory* const edges_;
  uint32_t history_ = 0;
  uint32_t last_ = kNone;
  double sum_[kGridComponents] = {};
  double weight_ = 0;
};

/// The coded wedge behind the edge opposite to half-edge h, in the same chart; or kNone. [B.7.5]
template <class Io>
uint32_t ExactValueCoder<Io>::across(uint32_t h) const {
  const FaceView& faces = wedges_.faces;
  const uint32_t t = faces.twin(nextHalfEdge(h));
  if (t == kNone || faces.vertex(t) != faces.vertex(prevHalfEdge(h)) ||
      faces.vertex(nextHalfEdge(t)) != faces.vertex(nextHalfEdge(h))) {
    return kNone;
  }
  const uint32_t o = faces.vertex(prevHalfEdge(t));
  return coded(o) ? o : kNone;
}

template <class Io>
void ExactValueCoder<Io>::addFace(uint32_t h) {
  const uint32_t n = wedges_.faces.vertex(nextHalfEdge(h));
  const uint32_t p = wedges_.faces.vertex(prevHalfEdge(h));
  if (!coded(n) || !coded(p)) return;
  const uint32_t o = across(h);
  if (o == kNone) return;
  if (predictor_ == ExactPredictor::kHinge) return addHinge(wedges_.faces.vertex(h), n, p, o);
  for (uint32_t c = 0; c < components_; ++c) {
    sum_[c] += finiteValue(at(n)[c]) + finiteValue(at(p)[c]) - finiteValue(at(o)[c]);
  }
  weight_ += 1;
}

template <class Io>
void ExactValueCoder<Io>::addHinge(uint32_t v, uint32_t n, uint32_t p, uint32_t o) {
  double e[3];
  double d[3];
  double f[3];
  for (uint32_t s = 0; s < 3; ++s) {
    const double from = static_cast<double>(positions_[3 * size_t{n} + s]);
    e[s] = static_cast<double>(positions_[3 * size_t{p} + s]) - from;
    d[s] = static_cast<double>(positions_[3 * size_t{v} + s]) - from;
    f[s] = static_cast<double>(positions_[3 * size_t{o} + s]) - from;
  }
  const double ee = dot(e, e);
  if (!(ee > 1e-90)) return;
  const double along = dot(e, d) / ee;
  const double along_o = dot(e, f) / ee;
  const double height = std::max(dot(d, d) - along * along * ee, 0.0);
  const double height_o = dot(f, f) - along_o * along_o * ee;
  if (!(height < kSteepest * height_o)) return;
  const double ratio2 = height / height_o;
  const double ratio = std::sqrt(ratio2);
  const double weight = 1.0 / (1.0 + ratio2);
  for (uint32_t c = 0; c < components_; ++c) {
    const double x = finiteValue(at(n)[c]);
    const double dx = finiteValue(at(p)[c]) - x;
    const double dxo = finiteValue(at(o)[c]) - x;
    sum_[c] += weight * (x + along * dx + ratio * (along_o * dx - dxo));
  }
  weight_ += weight;
}

template <class Io>
void ExactValueCoder<Io>::codeGroup(uint32_t w) {
  weight_ = 0;
  std::fill(sum_, sum_ + components_, 0.0);
  uint32_t entry = kNone;
  uint32_t faces = 0;
  for (uint32_t m = w; m != kNone && faces < kFaceLimit; m = groups_.nextOf(m)) {
    if (m >= wedges_.surface_count) continue;
    for (uint32_t h = wedges_.firstCompleted(m); h != kNone && faces < kFaceLimit;
         h = wedges_.nextCompleted(h), ++faces) {
      if (entry == kNone) entry = h;
      if (predictor_ != ExactPredictor::kMean) addFace(h);
    }
  }
  uint32_t n = kNone;
  uint32_t p = kNone;
  if (entry != kNone) {
    n = wedges_.faces.vertex(nextHalfEdge(entry));
    p = wedges_.faces.vertex(prevHalfEdge(entry));
    if (!coded(n) || !coded(p)) n = p = kNone;  // no sound mesh has such a face
  }
  const bool known = edges_ != nullptr && n != kNone && codeKnown(w, n, p, across(entry));
  const uint32_t from = n != kNone ? n : last_;
  const uint32_t beside = n != kNone ? p : last_;
  const double expected =
      from == kNone
          ? 0.0
          : (static_cast<double>(errors_[from]) + static_cast<double>(errors_[beside])) / 2;
  errors_[w] = static_cast<float>(expected);
  if (!known) {
    double predicted[kGridComponents];
    for (uint32_t c = 0; c < components_; ++c) {
      predicted[c] = weight_ > 0     ? sum_[c] / weight_
                     : from == kNone ? 0.0
                                     : (finiteValue(at(from)[c]) + finiteValue(at(beside)[c])) / 2;
    }
    codeComponents(w, predicted, expected);
  }
  last_ = w;
  for (uint32_t m = groups_.nextOf(w); m != kNone; m = groups_.nextOf(m)) {
    std::copy_n(at(w), components_, at(m));
    errors_[m] = errors_[w];
  }
  if (edges_ == nullptr) return;
  for (uint32_t m = w; m != kNone; m = groups_.nextOf(m)) learnFaces(m);
}

/// Whether the value is one that stood beside the values of n and p before; not that of o, which stands there now.
template <class Io>
bool ExactValueCoder<Io>::codeKnown(uint32_t w, uint32_t n, uint32_t p, uint32_t o) {
  const EdgeMemory::Known known = edges_->at(keyOf(n, p));
  uint32_t asked = kNone;
  for (const uint32_t k : known.wedge) {
    if (k == kNone || (o != kNone && isEqual(k, o)) || (asked != kNone && isEqual(k, asked))) {
      continue;
    }
    BitModel& model = models_.known[asked == kNone ? 0 : 1][history_];
    const bool hit = io_.bit(model, Io::kEncoding && isEqual(k, w));
    history_ = (history_ << 1 | (hit ? 1u : 0u)) & 3;
    if (hit) {
      std::copy_n(at(k), components_, at(w));
      return true;
    }
    asked = k;
  }
  return false;
}

template <class Io>
void ExactValueCoder<Io>::learnFaces(uint32_t w) {
  if (w >= wedges_.surface_count) return;
  uint32_t faces = 0;
  for (uint32_t h = wedges_.firstCompleted(w); h != kNone && faces < kFaceLimit;
       h = wedges_.nextCompleted(h), ++faces) {
    const uint32_t n = wedges_.faces.vertex(nextHalfEdge(h));
    const uint32_t p = wedges_.faces.vertex(prevHalfEdge(h));
    if (!coded(n) || !coded(p)) continue;
    edges_->learn(keyOf(n, p), w);
    edges_->learn(keyOf(w, n), p);
    edges_->learn(keyOf(w, p), n);
  }
}

template <class Io>
void ExactValueCoder<Io>::codeComponents(uint32_t w, const double* predicted, double expected) {
  double error = expected;
  double all = 0;
  for (uint32_t c = 0; c < components_; ++c) {
    int32_t& value = at(w)[c];
    const double missed = c % 3 == 0   ? codeComponent<0>(c, predicted[c], error, value)
                          : c % 3 == 1 ? codeComponent<1>(c, predicted[c], error, value)
                                       : codeComponent<2>(c, predicted[c], error, value);
    error = (error + missed) / 2;
    all += missed;
  }
  errors_[w] = static_cast<float>(all / components_);
}

template <class Io>
template <uint32_t kState>
double ExactValueCoder<Io>::codeComponent(uint32_t c, double predicted, double expected,
                                          int32_t& value) {
  const double near = std::fabs(predicted) < 1e38 ? predicted : 0.0;
  const int32_t from = orderedFromFloat(static_cast<float>(near));
  const double place = lastPlaceOf(from);
  const double scale = 16.0 * expected / place;
  const uint32_t bucket = scaleBucket(scale < 2e9 ? static_cast<uint32_t>(scale) : 2000000000u);
  const uint32_t target = static_cast<uint32_t>(value) - static_cast<uint32_t>(from);
  const int32_t residual =
      codeScaledResidual<kState>(io_, models_.row[c][bucket], bucket, static_cast<int32_t>(target));
  value = static_cast<int32_t>(static_cast<uint32_t>(from) + static_cast<uint32_t>(residual));
  // Of a prediction of another sign or far too small, the difference tells more than the places.
  const double missed = std::fabs(finiteValue(value) - near);
  return missed < 1e30 ? missed : 1e30;
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_EXACT_VALUES_H_
