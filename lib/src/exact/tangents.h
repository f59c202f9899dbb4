// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exact tangents, predicted from the decoded faces, charts and normals in binary64. [A.10.17]
#ifndef MCC_EXACT_TANGENTS_H_
#define MCC_EXACT_TANGENTS_H_

#include <algorithm>
#include <cstdint>

#include "exact/vectors.h"
#include "format/predictors.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"

namespace mcc {

struct ExactTangentModels {
  VectorModels vectors;
  BitModel negative[3];  ///< [predicted: unknown, positive, negative]
  BitModel odd;          ///< the sign is neither 1 nor -1
};

/// What tangents are predicted from, per wedge.
struct TangentSources {
  const float* positions = nullptr;  ///< 3, finite
  const float* chart = nullptr;      ///< 2, finite; null: none
  const int32_t* normals = nullptr;  ///< 3 ordered floats; null: none
};

inline void unitNormalOf(const TangentSources& from, uint32_t wedge, double* normal) {
  for (uint32_t s = 0; s < 3; ++s) {
    normal[s] = from.normals == nullptr ? 0.0 : finiteValue(from.normals[3 * size_t{wedge} + s]);
  }
  makeUnit(normal);
}

inline void projectAlong(const double* unit, double* v) {
  const double along = dot(unit, v);
  for (int s = 0; s < 3; ++s) v[s] -= along * unit[s];
}

/// Adds to the three wedges of a face (4 sums each) the direction in which u grows, of length 1,
/// and the orientation of the chart. [A.10.17]
inline void addExactTangent(const WedgeMesh& wedges, const TangentSources& from, uint32_t face,
                            double* sums) {
  const uint32_t* corner = wedges.faces.words + size_t{face} * kFaceWords;
  double p[3][3];
  double uv[3][2];
  for (uint32_t k = 0; k < 3; ++k) {
    for (uint32_t s = 0; s < 3; ++s) {
      p[k][s] = static_cast<double>(from.positions[3 * size_t{corner[k]} + s]);
    }
    for (uint32_t s = 0; s < 2; ++s) {
      uv[k][s] = static_cast<double>(from.chart[2 * size_t{corner[k]} + s]);
    }
  }
  const double v0 = uv[1][1] - uv[0][1];
  const double v1 = uv[2][1] - uv[0][1];
  const double determinant = (uv[1][0] - uv[0][0]) * v1 - (uv[2][0] - uv[0][0]) * v0;
  if (!(std::fabs(determinant) > 1e-60)) return;
  const double side = determinant < 0 ? -1.0 : 1.0;
  double along[3];
  for (int s = 0; s < 3; ++s) {
    along[s] = side * ((p[1][s] - p[0][s]) * v1 - (p[2][s] - p[0][s]) * v0);
  }
  makeUnit(along);
  for (uint32_t k = 0; k < 3; ++k) {
    double* sum = sums + 4 * size_t{corner[k]};
    for (uint32_t s = 0; s < 3; ++s) sum[s] += along[s];
    sum[3] += side;
  }
}

template <class Io>
class ExactTangentCoder {
 public:
  /// Codes four ordered floats per wedge.
  ExactTangentCoder(const AttributeJob<Io>& job, ExactTangentModels& models,
                    const TangentSources& from, const VectorWork& work)
      : job_(job),
        models_(models),
        coder_(job.io, models.vectors),
        perpendicular_((job.info.predictor & exact_tangent_method::kPerpendicular) != 0),
        from_(from),
        sums_(work.sums),
        errors_(work.errors) {}

  void run() {
    std::fill(sums_, sums_ + 4 * size_t{job_.wedges.count}, 0.0);
    std::fill(errors_, errors_ + job_.wedges.count, VectorError{});
    for (uint32_t f = 0; from_.chart != nullptr && f < job_.wedges.face_count; ++f) {
      addExactTangent(job_.wedges, from_, f, sums_);
    }
    forEachGroup<4>(job_, Ahead<double>{sums_, 4}, [this](uint32_t w) { codeGroup(w); });
  }

 private:
  void codeGroup(uint32_t w);
  void codeSign(double orientation, int32_t& value);

  const AttributeJob<Io> job_;
  ExactTangentModels& models_;
  VectorCoder<Io> coder_;
  const bool perpendicular_;
  const TangentSources from_;
  double* const sums_;
  VectorError* const errors_;
  VectorError last_error_;
  double last_[3] = {0, 0, 0};
};

template <class Io>
void ExactTangentCoder<Io>::codeGroup(uint32_t w) {
  double sum[4] = {0, 0, 0, 0};
  for (uint32_t m = w; m != kNone; m = job_.groups.nextOf(m)) {
    for (size_t s = 0; s < 4; ++s) sum[s] += sums_[4 * size_t{m} + s];
  }
  const uint32_t entry = job_.entryFace(w);
  VectorError error = last_error_;
  if (entry != kNone) {
    const auto [n, p] = job_.othersOf(entry);
    error.size = (errors_[n].size + errors_[p].size) / 2;
    error.places = (errors_[n].places + errors_[p].places) / 2;
  }
  double normal[3];
  unitNormalOf(from_, w, normal);
  projectAlong(normal, sum);
  if (!makeUnit(sum)) {
    for (int s = 0; s < 3; ++s) sum[s] = last_[s];
    projectAlong(normal, sum);
    makeUnit(sum);
  }
  int32_t* value = job_.values + 4 * size_t{w};
  coder_.code(sum, perpendicular_ ? normal : nullptr, error, value);
  codeSign(sum[3], value[3]);
  last_error_ = error;
  for (int s = 0; s < 3; ++s) last_[s] = finiteValue(value[s]);
  makeUnit(last_);
  for (uint32_t m = w; m != kNone; m = job_.groups.nextOf(m)) errors_[m] = error;
}

template <class Io>
void ExactTangentCoder<Io>::codeSign(double orientation, int32_t& value) {
  const uint32_t predicted = orientation > 0 ? 1 : orientation < 0 ? 2 : 0;
  const uint32_t bits = bitsFromOrdered(value);
  constexpr uint32_t kOne = 0x3f800000u;
  if (job_.io.bit(models_.odd, Io::kEncoding && (bits & 0x7fffffffu) != kOne)) {
    const uint32_t high = job_.io.raw(16, bits >> 16);
    value = orderedFromBits(high << 16 | job_.io.raw(16, bits & 0xffff));
    return;
  }
  const bool negative = job_.io.bit(models_.negative[predicted], Io::kEncoding && value < 0);
  value = orderedFromBits(kOne | (negative ? 0x80000000u : 0u));
}

}  // namespace mcc

#endif  // MCC_EXACT_TANGENTS_H_
