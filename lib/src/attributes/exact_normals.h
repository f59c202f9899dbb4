// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exact normals, predicted from the decoded faces in binary64: where a program computed them from the same positions,
// little more is left than its rounding.                                                     [A.8.9]
#ifndef MCC_ATTRIBUTES_EXACT_NORMALS_H_
#define MCC_ATTRIBUTES_EXACT_NORMALS_H_

#include <cmath>
#include <cstdint>

#include "attributes/edge_memory.h"
#include "attributes/exact_vectors.h"
#include "attributes/wedges.h"
#include "mcc/reader.h"
#include "mesh/attribute_method.h"

namespace mcc {

/// Weight of a face's unit normal at a corner.
enum class ExactWeight : uint8_t {
  kArea = 0,
  kAngle = 1,
  kSine = 2,  ///< see NormalWeight
  kEqual = 3,
};

/// Angle between two vectors by the length of their cross product and their dot product. [B.4.3]
inline double exactAngle(double cross_length, double dot_product) {
  const double h = std::sqrt(cross_length * cross_length + dot_product * dot_product);
  const double t = cross_length / (h + std::fabs(dot_product));
  const double u = t / (1.0 + std::sqrt(1.0 + t * t));  // tangent of a quarter of an acute angle
  const double s = u * u;
  double sum = 0;
  for (int k = 23; k >= 1; k -= 2) sum = 1.0 / k - s * sum;
  const double acute = 4.0 * u * sum;
  return dot_product < 0 ? 3.141592653589793 - acute : acute;
}

MCC_SHARED void addExactNormalsOfWeight(ExactWeight exact_weight, const WedgeMesh& wedges,
                                        const float* positions, double* sums) {
  for (uint32_t f = 0; f < wedges.face_count; ++f) {
    const uint32_t* corner = wedges.faces.words + size_t{f} * kFaceWords;
    double p[3][3];
    for (uint32_t k = 0; k < 3; ++k) {
      for (uint32_t s = 0; s < 3; ++s) {
        p[k][s] = static_cast<double>(positions[3 * size_t{corner[k]} + s]);
      }
    }
    double side[3][3];  // [k]: from corner k to the next
    for (uint32_t k = 0; k < 3; ++k) {
      for (uint32_t s = 0; s < 3; ++s) side[k][s] = p[(k + 1) % 3][s] - p[k][s];
    }
    double normal[3];
    cross(side[0], side[1], normal);
    double weight[3] = {1, 1, 1};
    if (exact_weight != ExactWeight::kArea) {
      const double square = dot(normal, normal);
      if (!(square > 1e-290)) continue;
      const double length = std::sqrt(square);
      const double inverse = 1.0 / length;
      if (exact_weight == ExactWeight::kEqual) {
        for (double& w : weight) w = inverse;
      } else if (exact_weight == ExactWeight::kAngle) {
        const double at_0 = exactAngle(length, -dot(side[0], side[2]));
        const double at_1 = exactAngle(length, -dot(side[1], side[0]));
        weight[0] = at_0 * inverse;
        weight[1] = at_1 * inverse;
        weight[2] = (3.141592653589793 - at_0 - at_1) * inverse;
      } else {
        const double q[3] = {dot(side[0], side[0]), dot(side[1], side[1]), dot(side[2], side[2])};
        weight[0] = 1.0 / (q[0] * q[2]);
        weight[1] = 1.0 / (q[1] * q[0]);
        weight[2] = 1.0 / (q[2] * q[1]);
      }
    }
    for (uint32_t k = 0; k < 3; ++k) {
      double* sum = sums + 3 * size_t{corner[k]};
      for (uint32_t s = 0; s < 3; ++s) sum[s] += weight[k] * normal[s];
    }
  }
}

/// Adds the weighted normals of all faces to their wedges' sums (3 per wedge). `positions`: 3 floats per wedge. [B.4.7]
inline void addExactFaces(ExactWeight weight, const WedgeMesh& wedges, const float* positions,
                          double* sums) {
  if constexpr (kCompact) return addExactNormalsOfWeight(weight, wedges, positions, sums);
  switch (weight) {
    case ExactWeight::kArea:
      return addExactNormalsOfWeight(ExactWeight::kArea, wedges, positions, sums);
    case ExactWeight::kAngle:
      return addExactNormalsOfWeight(ExactWeight::kAngle, wedges, positions, sums);
    case ExactWeight::kSine:
      return addExactNormalsOfWeight(ExactWeight::kSine, wedges, positions, sums);
    case ExactWeight::kEqual:
      return addExactNormalsOfWeight(ExactWeight::kEqual, wedges, positions, sums);
  }
}

template <class Io>
class ExactNormalCoder {
 public:
  /// Work space: `sums` 3 per wedge, `errors` one per wedge. `values`: three ordered floats per wedge.
  ExactNormalCoder(Io& io, VectorModels& models, const WedgeMesh& wedges, const EqualGroups& groups,
                   const AttributeInfo& info, int32_t* values, double* sums, VectorError* errors,
                   EdgeMemory* edges)
      : io_(io),
        models_(models),
        edges_(edges),
        coder_(io, models, (info.predictor & exact_normal_method::kRemembers) != 0),
        wedges_(wedges),
        groups_(groups),
        weight_(static_cast<ExactWeight>(info.predictor & exact_normal_method::kWeightMask)),
        blend_((info.predictor & exact_normal_method::kBlendMask) >>
               exact_normal_method::kBlendShift),
        values_(values),
        sums_(sums),
        errors_(errors) {}

  void run(const float* positions) {
    std::fill(sums_, sums_ + 3 * size_t{wedges_.count}, 0.0);
    std::fill(errors_, errors_ + wedges_.count, VectorError{0, kNotYet});
    addExactFaces(weight_, wedges_, positions, sums_);
    for (uint32_t i = 0; i < wedges_.count; ++i) {
      const uint32_t w = i < wedges_.surface_count ? wedges_.wedgeAt(i) : i;
      if (groups_.isFirst(w)) codeGroup(w);
    }
  }

 private:
  double* sum(uint32_t w) { return sums_ + 3 * size_t{w}; }
  void codeGroup(uint32_t w);

  /// Without signs: mirrored parts are alike.
  uint64_t hashOf(uint32_t w) const {
    uint64_t h = 0x243f6a8885a308d3u;
    for (uint32_t s = 0; s < 3; ++s) {
      const uint32_t bits = bitsFromOrdered(values_[3 * size_t{w} + s]) & 0x7fffffffu;
      h = (h ^ bits) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return h;
  }
  uint64_t keyOf(uint32_t a, uint32_t b) const {
    const uint64_t h = (hashOf(a) + hashOf(b)) * 0xbf58476d1ce4e5b9u;
    return h ^ (h >> 32);
  }
  bool codeKnown(uint32_t w, uint32_t entry, const double* predicted);
  void learnFaces(uint32_t w);

  static constexpr uint32_t kFaceLimit = 16;
  static constexpr float kNotYet = -1;

  bool coded(uint32_t w) const { return errors_[w].places >= 0; }

  Io& io_;
  VectorModels& models_;
  EdgeMemory* const edges_;  ///< prepared, or null
  uint32_t history_ = 0;
  VectorCoder<Io> coder_;
  const WedgeMesh& wedges_;
  const EqualGroups& groups_;
  const ExactWeight weight_;
  const uint32_t blend_;
  int32_t* const values_;
  double* const sums_;  ///< of faces; once a wedge is coded: what its prediction missed
  VectorError* const errors_;
  VectorError last_error_;
  double last_[3] = {0, 0, 0};
};

template <class Io>
void ExactNormalCoder<Io>::codeGroup(uint32_t w) {
  double direction[3] = {sum(w)[0], sum(w)[1], sum(w)[2]};
  uint32_t entry = w < wedges_.surface_count ? wedges_.firstCompleted(w) : kNone;
  for (uint32_t m = groups_.nextOf(w); m != kNone; m = groups_.nextOf(m)) {
    for (int s = 0; s < 3; ++s) direction[s] += sum(m)[s];
    if (entry == kNone && m < wedges_.surface_count) entry = wedges_.firstCompleted(m);
  }
  if (!makeUnit(direction)) {
    for (int s = 0; s < 3; ++s) direction[s] = last_[s];
  }
  VectorError error = last_error_;
  double predicted[3] = {direction[0], direction[1], direction[2]};
  if (entry != kNone) {
    const uint32_t n = wedges_.faces.vertex(nextHalfEdge(entry));
    const uint32_t p = wedges_.faces.vertex(prevHalfEdge(entry));
    if (!coded(n) || !coded(p)) entry = kNone;  // a face with two corners at one vertex
  }
  if (entry != kNone) {
    const uint32_t n = wedges_.faces.vertex(nextHalfEdge(entry));
    const uint32_t p = wedges_.faces.vertex(prevHalfEdge(entry));
    error.size = (errors_[n].size + errors_[p].size) / 2;
    error.places = (errors_[n].places + errors_[p].places) / 2;
    if (blend_ != 0) {
      const double part = blend_ == 1 ? 0.25 : 0.5;
      for (int s = 0; s < 3; ++s) predicted[s] += part * (sum(n)[s] + sum(p)[s]);
      makeUnit(predicted);
    }
  }
  int32_t* value = values_ + 3 * size_t{w};
  if (edges_ == nullptr || entry == kNone || !codeKnown(w, entry, predicted)) {
    coder_.code(predicted, nullptr, error, value);
  }
  last_error_ = error;
  double missed[3];
  for (int s = 0; s < 3; ++s) {
    last_[s] = finiteValue(value[s]);
    if (!(std::fabs(last_[s]) < 4)) last_[s] = 0;
    missed[s] = last_[s] - direction[s];
  }
  makeUnit(last_);
  for (uint32_t m = w; m != kNone; m = groups_.nextOf(m)) {
    std::copy_n(value, 3, values_ + 3 * size_t{m});
    std::copy_n(missed, 3, sum(m));
    errors_[m] = error;
    if (edges_ != nullptr) learnFaces(m);
  }
}

/// Whether the vector is, but for signs, one that stood beside those of the entry face before.
template <class Io>
bool ExactNormalCoder<Io>::codeKnown(uint32_t w, uint32_t entry, const double* predicted) {
  const FaceView& faces = wedges_.faces;
  const uint32_t t = faces.twin(nextHalfEdge(entry));
  const uint32_t o = t == kNone ? w : faces.vertex(prevHalfEdge(t));
  const EdgeMemory::Known known =
      edges_->at(keyOf(faces.vertex(nextHalfEdge(entry)), faces.vertex(prevHalfEdge(entry))));
  int32_t* value = values_ + 3 * size_t{w};
  uint32_t asked = 0;
  for (const uint32_t k : known.wedge) {
    if (k == kNone || k == o) continue;
    int32_t candidate[3];
    for (uint32_t s = 0; s < 3; ++s) {
      const uint32_t bits = bitsFromOrdered(values_[3 * size_t{k} + s]) & 0x7fffffffu;
      candidate[s] = orderedFromBits(bits | (predicted[s] < 0 ? 0x80000000u : 0u));
    }
    const bool equal = std::equal(candidate, candidate + 3, value);
    const bool hit = io_.bit(models_.beside[asked][history_], Io::kEncoding && equal);
    history_ = (history_ << 1 | (hit ? 1u : 0u)) & 3;
    if (hit) {
      std::copy_n(candidate, 3, value);
      return true;
    }
    asked = 1;
  }
  return false;
}

template <class Io>
void ExactNormalCoder<Io>::learnFaces(uint32_t w) {
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

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_EXACT_NORMALS_H_
