// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tangents as an angle in the plane of the decoded normal and a sign.                        [A.8.7, B.6]
//
// Prediction as the tools compute tangents (Mikkelsen 2008): the sum over the faces around a group of equal wedges of
// the direction in which u grows, weighted by the angle at the corner; the sign from the faces' orientation in the chart.
#ifndef MCC_ATTRIBUTES_TANGENTS_H_
#define MCC_ATTRIBUTES_TANGENTS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "attributes/dequantize.h"
#include "attributes/normals.h"
#include "attributes/octahedral.h"
#include "attributes/residuals.h"
#include "attributes/wedges.h"

namespace mcc {

struct TangentModels {
  TokenRow row[kLengthContexts];
  BitModel negative[3];  ///< [predicted: unknown, positive, negative]

  TangentModels() {
    for (TokenRow& r : row) r.setUniform();
  }
};

/// Orthonormal vectors beside a unit vector: the first is perpendicular to its smallest component's axis. [B.6.1]
inline void tangentFrame(const float* n, float* e1, float* e2) {
  const float ax = std::fabs(n[0]);
  const float ay = std::fabs(n[1]);
  const float az = std::fabs(n[2]);
  e1[0] = e1[1] = e1[2] = 0;
  if (ax <= ay && ax <= az) {
    e1[1] = -n[2];
    e1[2] = n[1];
  } else if (ay <= az) {
    e1[0] = n[2];
    e1[2] = -n[0];
  } else {
    e1[0] = -n[1];
    e1[1] = n[0];
  }
  const float inverse = 1.0f / std::sqrt(e1[0] * e1[0] + e1[1] * e1[1] + e1[2] * e1[2]);
  for (int s = 0; s < 3; ++s) e1[s] *= inverse;
  e2[0] = n[1] * e1[2] - n[2] * e1[1];
  e2[1] = n[2] * e1[0] - n[0] * e1[2];
  e2[2] = n[0] * e1[1] - n[1] * e1[0];
}

/// Angle of (x, y) in -pi..pi, by a polynomial; (0, 0) gives 0. [B.6.2]
inline float planeAngle(float y, float x) {
  const float ax = std::fabs(x);
  const float ay = std::fabs(y);
  const float high = std::max(ax, ay);
  if (!(high > 0)) return 0;
  const float t = std::min(ax, ay) / high;
  const float s = t * t;
  float r =
      ((((-0.01172120f * s + 0.05265332f) * s - 0.11643287f) * s + 0.19354346f) * s - 0.33262347f) *
          s +
      0.99997726f;
  r *= t;
  if (ay > ax) r = 1.57079637f - r;
  if (x < 0) r = 3.14159274f - r;
  return y < 0 ? -r : r;
}

/// Unit vector of `angle` (modulo 2^bits steps of a turn) in the plane of a unit normal. [B.6.3]
inline void tangentFromAngle(const float* normal, int32_t angle, uint32_t bits, float* tangent) {
  float e1[3];
  float e2[3];
  tangentFrame(normal, e1, e2);
  // By quarter turns, so that the polynomials see 0..pi/2.
  const uint32_t steps = static_cast<uint32_t>(angle) & ((uint32_t{1} << bits) - 1);
  const uint32_t quarter = steps >> (bits - 2);
  const uint32_t rest = steps & ((uint32_t{1} << (bits - 2)) - 1);
  const double x = static_cast<double>(rest) *
                   (1.5707963267948966 / static_cast<double>(uint32_t{1} << (bits - 2)));
  const double xx = x * x;
  const double sine =
      x * (1 + xx * (-1.0 / 6 +
                     xx * (1.0 / 120 + xx * (-1.0 / 5040 + xx * (1.0 / 362880 - xx / 39916800)))));
  const double cosine =
      1 + xx * (-0.5 + xx * (1.0 / 24 +
                             xx * (-1.0 / 720 +
                                   xx * (1.0 / 40320 + xx * (-1.0 / 3628800 + xx / 479001600)))));
  float along = static_cast<float>((quarter & 1) == 0 ? cosine : sine);
  float across = static_cast<float>((quarter & 1) == 0 ? sine : cosine);
  if (quarter == 1 || quarter == 2) along = -along;
  if (quarter >= 2) across = -across;
  for (int s = 0; s < 3; ++s) tangent[s] = along * e1[s] + across * e2[s];
}

/// Adds to the three wedges of every face (4 floats each) the direction in which u grows, weighted by the angle at the
/// corner, and the orientation of the chart. `chart` has 2 finite floats per wedge, see chartCoordinates(). [B.6.4]
inline void addFaceTangents(const WedgeMesh& wedges, const float* positions, const float* chart,
                            float* sums) {
  for (uint32_t h = 0; h < wedges.face_count * kFaceWords; h += kFaceWords) {
    const uint32_t* corner = wedges.faces.words + h;
    const float* a = positions + 4 * size_t{corner[0]};
    const float* b = positions + 4 * size_t{corner[1]};
    const float* c = positions + 4 * size_t{corner[2]};
    const float* ua = chart + 2 * size_t{corner[0]};
    const float* ub = chart + 2 * size_t{corner[1]};
    const float* uc = chart + 2 * size_t{corner[2]};
    const float v0 = ub[1] - ua[1];
    const float v1 = uc[1] - ua[1];
    const float determinant = (ub[0] - ua[0]) * v1 - (uc[0] - ua[0]) * v0;
    if (determinant == 0) continue;
    const float side = determinant < 0 ? -1.0f : 1.0f;
    const float e0[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const float e1[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    float t[3];
    for (int s = 0; s < 3; ++s) t[s] = side * (e0[s] * v1 - e1[s] * v0);
    const float tt = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    if (!(tt > 0)) continue;
    const float inverse = 1.0f / std::sqrt(tt);
    const float n[3] = {e0[1] * e1[2] - e0[2] * e1[1], e0[2] * e1[0] - e0[0] * e1[2],
                        e0[0] * e1[1] - e0[1] * e1[0]};
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const float d0 = e0[0] * e1[0] + e0[1] * e1[1] + e0[2] * e1[2];
    const float at_a = cornerAngle(length, d0);
    const float at_b = cornerAngle(length, e0[0] * e0[0] + e0[1] * e0[1] + e0[2] * e0[2] - d0);
    const float angle[3] = {at_a, at_b, 3.14159274f - at_a - at_b};
    for (uint32_t k = 0; k < 3; ++k) {
      float* sum = sums + 4 * size_t{corner[k]};
      const float weight = angle[k] * inverse;
      for (int s = 0; s < 3; ++s) sum[s] += weight * t[s];
      sum[3] += side;
    }
  }
}

/// Texture coordinates as finite floats whose products neither overflow nor become denormal. [B.6.5]
inline void chartCoordinates(const AttributeInfo& info, const int32_t* values, size_t count,
                             float* chart) {
  const bool exact =
      info.coding == AttributeCoding::kExactFloat || info.coding == AttributeCoding::kGrid;
  for (size_t i = 0; i < count; ++i) {
    if (!exact) {
      chart[i] = static_cast<float>(values[i]);
      continue;
    }
    const float x = std::bit_cast<float>(bitsFromOrdered(values[i]));
    const float absolute = std::fabs(x);
    chart[i] = absolute >= 1e-9f && absolute <= 1e9f ? x : 0.0f;  // 0 for NaN
  }
}

/// Codes pairs (angle, 1 if the sign is negative), two per wedge.
template <class Io>
class TangentCoder {
 public:
  /// `normals`: grid points of the wedges' normals, coded as `normal_info` says. `sums`: 4 floats per wedge, from
  /// addFaceTangents(). `lengths`: work space, a byte per wedge.
  TangentCoder(Io& io, TangentModels& models, const WedgeMesh& wedges, const EqualGroups& groups,
               const AttributeInfo& info, const AttributeInfo& normal_info, const int32_t* normals,
               const float* sums, int32_t* values, uint8_t* lengths)
      : io_(io),
        models_(models),
        wedges_(wedges),
        groups_(groups),
        bits_(info.bits),
        centre_(octahedralCentre(normal_info.bits)),
        normals_(normals),
        sums_(sums),
        values_(values),
        lengths_(lengths) {}

  void run() {
    std::fill(lengths_, lengths_ + wedges_.count, kNotCoded);
    for (uint32_t i = 0; i < wedges_.surface_count; ++i) {
      const uint32_t w = wedges_.wedgeAt(i);
      if (groups_.isFirst(w)) codeGroup(w);
    }
    for (uint32_t w = wedges_.surface_count; w < wedges_.count; ++w)
      codeTangent(w, last_, 0, kNoNeighbours);
  }

 private:
  void codeGroup(uint32_t w);
  void codeTangent(uint32_t w, int32_t predicted, uint32_t predicted_sign, uint32_t context);

  Io& io_;
  TangentModels& models_;
  const WedgeMesh& wedges_;
  const EqualGroups& groups_;
  const uint32_t bits_;
  const int32_t centre_;
  const int32_t* const normals_;
  const float* const sums_;
  int32_t* const values_;
  uint8_t* const lengths_;
  int32_t last_ = 0;
};

template <class Io>
void TangentCoder<Io>::codeGroup(uint32_t w) {
  float sum[4] = {0, 0, 0, 0};
  uint32_t entry = kNone;
  for (uint32_t m = w; m != kNone; m = groups_.nextOf(m)) {
    for (int s = 0; s < 4; ++s) sum[s] += sums_[4 * size_t{m} + static_cast<size_t>(s)];
    if (entry == kNone) entry = wedges_.firstCompleted(m);
  }
  int32_t predicted = last_;
  uint32_t context = kNoNeighbours;
  if (entry != kNone) {
    const uint32_t n = wedges_.faces.vertex(nextHalfEdge(entry));
    const uint32_t p = wedges_.faces.vertex(prevHalfEdge(entry));
    context = std::min((lengths_[n] + lengths_[p] + 1u) / 2, kLongestContext);
    predicted = values_[2 * size_t{n}];
  }
  float normal[3];
  float e1[3];
  float e2[3];
  octahedralToUnit(normals_[2 * size_t{w}], normals_[2 * size_t{w} + 1], centre_, normal);
  tangentFrame(normal, e1, e2);
  const float x = sum[0] * e1[0] + sum[1] * e1[1] + sum[2] * e1[2];
  const float y = sum[0] * e2[0] + sum[1] * e2[1] + sum[2] * e2[2];
  if (std::fabs(x) + std::fabs(y) > 1e-6f) {
    const float steps = static_cast<float>(uint32_t{1} << bits_) * 0.159154943f * planeAngle(y, x);
    predicted = static_cast<int32_t>(steps + (steps < 0 ? -0.5f : 0.5f));
  }
  codeTangent(w, predicted, sum[3] > 0 ? 1 : sum[3] < 0 ? 2 : 0, context);
  for (uint32_t m = groups_.nextOf(w); m != kNone; m = groups_.nextOf(m)) {
    values_[2 * size_t{m}] = values_[2 * size_t{w}];
    values_[2 * size_t{m} + 1] = values_[2 * size_t{w} + 1];
    lengths_[m] = lengths_[w];
  }
}

template <class Io>
void TangentCoder<Io>::codeTangent(uint32_t w, int32_t predicted, uint32_t predicted_sign,
                                   uint32_t context) {
  int32_t* value = values_ + 2 * size_t{w};
  int32_t residual = 0;
  if constexpr (Io::kEncoding) {  // the difference modulo 2^bits nearest to 0
    const uint32_t difference = static_cast<uint32_t>(value[0]) - static_cast<uint32_t>(predicted);
    residual = static_cast<int32_t>(difference << (32 - bits_)) >> (32 - bits_);
  }
  residual = codeSmallSigned<0>(io_, models_.row[context], residual);
  const uint32_t mask = (uint32_t{1} << bits_) - 1;
  value[0] = static_cast<int32_t>(
      (static_cast<uint32_t>(predicted) + static_cast<uint32_t>(residual)) & mask);
  value[1] = io_.bit(models_.negative[predicted_sign], value[1] != 0) ? 1 : 0;
  lengths_[w] = static_cast<uint8_t>(contextLength(residual));
  last_ = value[0];
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_TANGENTS_H_
