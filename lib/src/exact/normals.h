// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exact normals, predicted from the decoded faces in binary64: where a program computed them from
// the same positions, little more is left than its rounding. [A.10.16]
#ifndef MCC_EXACT_NORMALS_H_
#define MCC_EXACT_NORMALS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "exact/vectors.h"
#include "format/predictors.h"
#include "mcc/reader.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"
#include "values/value_memory.h"
#include "vectors/normals.h"

namespace mcc {

/// Angle between two vectors by the length of their cross product and their dot product. [A.10.7]
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

MCC_SHARED void addExactNormalsOfWeight(NormalWeight normal_weight, const WedgeMesh& wedges,
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
    if (normal_weight != NormalWeight::kArea) {
      const double square = dot(normal, normal);
      if (!(square > 1e-290)) continue;
      const double length = std::sqrt(square);
      const double inverse = 1.0 / length;
      if (normal_weight == NormalWeight::kAngle) {
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

/// Adds the weighted normals of all faces to their wedges' sums (3 per wedge). `positions`: 3
/// floats per wedge. [A.10.16]
inline void addExactFaces(NormalWeight weight, const WedgeMesh& wedges, const float* positions,
                          double* sums) {
  if constexpr (kCompact) return addExactNormalsOfWeight(weight, wedges, positions, sums);
  switch (weight) {
    case NormalWeight::kArea:
      return addExactNormalsOfWeight(NormalWeight::kArea, wedges, positions, sums);
    case NormalWeight::kAngle:
      return addExactNormalsOfWeight(NormalWeight::kAngle, wedges, positions, sums);
    case NormalWeight::kSine:
      return addExactNormalsOfWeight(NormalWeight::kSine, wedges, positions, sums);
  }
}

using ExactNormalMemory = ValueMemory<3, true>;  ///< mirrored parts are alike but for signs

template <class Io>
class ExactNormalCoder {
 public:
  /// Codes three ordered floats per wedge. `positions` has 3 floats per wedge. `memory` has been
  /// started with the values; it is null if the predictor remembers nothing.
  ExactNormalCoder(const AttributeJob<Io>& job, VectorModels& models, const float* positions,
                   const VectorWork& work, ExactNormalMemory* memory)
      : job_(job),
        models_(models),
        memory_(memory),
        coder_(job.io, models),
        weight_(static_cast<NormalWeight>(job.info.predictor & normal_method::kWeightMask)),
        blends_((job.info.predictor & normal_method::kBlend) != 0),
        positions_(positions),
        sums_(work.sums),
        errors_(work.errors) {}

  void run() {
    std::fill(sums_, sums_ + 3 * size_t{job_.wedges.count}, 0.0);
    addExactFaces(weight_, job_.wedges, positions_, sums_);
    forEachGroup<3>(
        job_, Ahead<double>{sums_, 3}, [this](uint32_t w) { codeGroup(w); },
        [this](uint32_t w) {
          if (memory_ != nullptr) memory_->learnGroup(job_, w);
        });
  }

 private:
  double* sum(uint32_t w) { return sums_ + 3 * size_t{w}; }
  void codeGroup(uint32_t w);

  bool codeKnown(uint32_t w, uint32_t entry, const double* predicted);
  static uint64_t predictionKey(const double* predicted);

  static constexpr double kBlendPart = 0.5;  ///< of what both neighbours' predictions missed

  const AttributeJob<Io> job_;
  VectorModels& models_;
  ExactNormalMemory* const memory_;
  VectorCoder<Io> coder_;
  const NormalWeight weight_;
  const bool blends_;
  const float* const positions_;
  double* const sums_;  ///< of faces; once a wedge is coded: what its prediction missed
  VectorError* const errors_;
  VectorError last_error_;
  double last_[3] = {0, 0, 0};
};

template <class Io>
void ExactNormalCoder<Io>::codeGroup(uint32_t w) {
  double direction[3] = {sum(w)[0], sum(w)[1], sum(w)[2]};
  for (uint32_t m = job_.groups.nextOf(w); m != kNone; m = job_.groups.nextOf(m)) {
    for (int s = 0; s < 3; ++s) direction[s] += sum(m)[s];
  }
  if (!makeUnit(direction)) {
    for (int s = 0; s < 3; ++s) direction[s] = last_[s];
  }
  VectorError error = last_error_;
  double predicted[3] = {direction[0], direction[1], direction[2]};
  uint32_t entry = job_.entryFace(w);
  if (entry != kNone) {
    const auto [n, p] = job_.othersOf(entry);
    if (!job_.isCoded(n) || !job_.isCoded(p))
      entry = kNone;  // two of its corners are at one vertex
  }
  if (entry != kNone) {
    const auto [n, p] = job_.othersOf(entry);
    error.size = (errors_[n].size + errors_[p].size) / 2;
    error.places = (errors_[n].places + errors_[p].places) / 2;
    if (blends_) {
      for (int s = 0; s < 3; ++s) predicted[s] += kBlendPart * (sum(n)[s] + sum(p)[s]);
      makeUnit(predicted);
    }
  }
  int32_t* value = job_.values + 3 * size_t{w};
  if (memory_ == nullptr || !codeKnown(w, entry, predicted)) {
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
  for (uint32_t m = w; m != kNone; m = job_.groups.nextOf(m)) {
    std::copy_n(missed, 3, sum(m));
    errors_[m] = error;
  }
  job_.lengths[w] = 0;
  if (memory_ != nullptr) memory_->learn(predictionKey(predicted), w);
}

/// The key of a prediction: its components without signs, in steps of 2^-12.
template <class Io>
uint64_t ExactNormalCoder<Io>::predictionKey(const double* predicted) {
  uint32_t rounded[3];
  for (int s = 0; s < 3; ++s) {
    rounded[s] = static_cast<uint32_t>(std::fabs(predicted[s]) * 4096 + 0.5);
  }
  return ExactNormalMemory::predictionKey(rounded);
}

/// Whether the vector is, but for signs, one that was predicted like this before, or stood beside
/// those of the entry face. It is then in place, with the signs of the prediction.
template <class Io>
bool ExactNormalCoder<Io>::codeKnown(uint32_t w, uint32_t entry, const double* predicted) {
  int32_t* value = job_.values + 3 * size_t{w};
  const auto withSigns = [=, this](uint32_t k, int32_t* to) {
    for (uint32_t s = 0; s < 3; ++s) {
      const uint32_t bits = bitsFromOrdered(job_.values[3 * size_t{k} + s]) & 0x7fffffffu;
      to[s] = orderedFromBits(bits | (predicted[s] < 0 ? 0x80000000u : 0u));
    }
  };
  const auto isValue = [=](uint32_t k) {
    int32_t candidate[3];
    withSigns(k, candidate);
    return std::equal(candidate, candidate + 3, value);
  };
  memory_->begin();
  uint32_t k = memory_->ask(job_.io, models_.memory, predictionKey(predicted), kNone, isValue);
  if (k == kNone && entry != kNone) {
    const FaceView& faces = job_.wedges.faces;
    const uint32_t across = nextHalfEdge(entry);
    const uint32_t t = faces.twin(across);
    const uint32_t o = t == kNone ? kNone : faces.vertex(prevHalfEdge(t));
    k = memory_->ask(job_.io, models_.memory,
                     memory_->edgeKey(faces.vertex(across), faces.vertex(prevHalfEdge(entry))),
                     o != kNone && job_.isCoded(o) ? o : kNone, isValue);
  }
  if (k != kNone) withSigns(k, value);
  return k != kNone;
}

}  // namespace mcc

#endif  // MCC_EXACT_NORMALS_H_
