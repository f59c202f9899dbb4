// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tangents as an angle in the plane of the decoded normal and a sign. [A.10.13, A.10.12]
//
// Prediction as the tools compute tangents (Mikkelsen 2008): the sum over the faces around a group
// of equal wedges of the direction in which u grows, weighted by the angle at the corner; the sign
// from the faces' orientation in the chart.
#ifndef MCC_VECTORS_TANGENTS_H_
#define MCC_VECTORS_TANGENTS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mesh/dequantize.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"
#include "values/residuals.h"
#include "vectors/normals.h"
#include "vectors/octahedral.h"
#include "vectors/tangent_repeats.h"

namespace mcc {

struct TangentModels {
  TokenRow row[kLengthContexts];
  BitModel negative[3];  ///< [predicted: unknown, positive, negative]
  TangentRepeatModels repeats;

  TangentModels() {
    for (TokenRow& r : row) r.setUniform();
  }
};

/// Orthonormal vectors beside a unit vector: the first is perpendicular to its smallest component's
/// axis. [A.10.12]
template <class Real>
MCC_INLINE void tangentFrame(const Real* n, Real* e1, Real* e2) {
  const Real zero = constant<Real>(0.0f);
  const Real ax = magnitude(n[0]);
  const Real ay = magnitude(n[1]);
  const Real az = magnitude(n[2]);
  const auto first = (ax <= ay) & (ax <= az);  // as likely as the others: selects, no branches
  const auto second = ay <= az;
  e1[0] = select(first, zero, select(second, n[2], -n[1]));
  e1[1] = select(first, -n[2], select(second, zero, n[0]));
  e1[2] = select(first, n[1], select(second, -n[0], zero));
  const Real inverse =
      constant<Real>(1.0f) / squareRoot(e1[0] * e1[0] + e1[1] * e1[1] + e1[2] * e1[2]);
  for (int s = 0; s < 3; ++s) e1[s] = e1[s] * inverse;
  e2[0] = n[1] * e1[2] - n[2] * e1[1];
  e2[1] = n[2] * e1[0] - n[0] * e1[2];
  e2[2] = n[0] * e1[1] - n[1] * e1[0];
}

/// Angle of (x, y) in -pi..pi, by a polynomial; (0, 0) gives 0. [A.10.12]
template <class Real>
MCC_INLINE Real planeAngle(Real y, Real x) {
  const Real zero = constant<Real>(0.0f);
  const Real ax = magnitude(x);
  const Real ay = magnitude(y);
  const Real t = lower(ax, ay) / (higher(ax, ay) + constant<Real>(1e-30f));
  const Real s = t * t;
  Real r = constant<Real>(-0.01172120f) * s + constant<Real>(0.05265332f);
  r = r * s - constant<Real>(0.11643287f);
  r = r * s + constant<Real>(0.19354346f);
  r = r * s - constant<Real>(0.33262347f);
  r = (r * s + constant<Real>(0.99997726f)) * t;
  r = select(ay > ax, constant<Real>(1.57079637f) - r, r);
  r = select(x < zero, constant<Real>(3.14159274f) - r, r);
  return select(y < zero, -r, r);
}

/// An angle as quarter turns and the rest of the steps, so that polynomials see 0..pi/2.
struct AngleSteps {
  int32_t quarter;  ///< 0..3
  int32_t rest;     ///< below 2^(bits-2)

  AngleSteps(int32_t angle, uint32_t bits) {
    const uint32_t steps = static_cast<uint32_t>(angle) & ((uint32_t{1} << bits) - 1);
    quarter = static_cast<int32_t>(steps >> (bits - 2));
    rest = static_cast<int32_t>(steps & ((uint32_t{1} << (bits - 2)) - 1));
  }
};

/// Unit vectors of angles in the planes of unit normals; `quarter`, `rest` as in
/// AngleSteps. [A.10.12]
template <class Real>
MCC_INLINE void tangentFromSteps(const Real* normal, Real quarter, Real rest, uint32_t bits,
                                 Real* tangent) {
  Real e1[3];
  Real e2[3];
  tangentFrame(normal, e1, e2);
  const Real one = constant<Real>(1.0f);
  const Real x = rest * constant<Real>(1.57079637f / static_cast<float>(uint32_t{1} << (bits - 2)));
  const Real xx = x * x;
  Real sine = xx * constant<Real>(-1.0f / 39916800) + constant<Real>(1.0f / 362880);
  sine = xx * sine + constant<Real>(-1.0f / 5040);
  sine = xx * sine + constant<Real>(1.0f / 120);
  sine = xx * sine + constant<Real>(-1.0f / 6);
  sine = x + x * (xx * sine);
  Real cosine = xx * constant<Real>(1.0f / 479001600) + constant<Real>(-1.0f / 3628800);
  cosine = xx * cosine + constant<Real>(1.0f / 40320);
  cosine = xx * cosine + constant<Real>(-1.0f / 720);
  cosine = xx * cosine + constant<Real>(1.0f / 24);
  cosine = xx * cosine + constant<Real>(-0.5f);
  cosine = one + xx * cosine;
  const auto past_first = quarter > constant<Real>(0.5f);
  const auto past_second = quarter > constant<Real>(1.5f);
  const auto past_third = quarter > constant<Real>(2.5f);
  const Real along_if_odd = select(past_third, sine, -sine);
  const Real along_if_even = select(past_second, -cosine, cosine);
  const Real across_if_odd = select(past_third, -cosine, cosine);
  const Real across_if_even = select(past_second, -sine, sine);
  const auto odd = past_third | (past_first & (quarter < constant<Real>(1.5f)));
  const Real along = select(odd, along_if_odd, along_if_even);
  const Real across = select(odd, across_if_odd, across_if_even);
  for (int s = 0; s < 3; ++s) tangent[s] = along * e1[s] + across * e2[s];
}

/// Unit vector of `angle` (modulo 2^bits steps of a turn) in the plane of a unit normal.
inline void tangentFromAngle(const float* normal, int32_t angle, uint32_t bits, float* tangent) {
  const AngleSteps steps(angle, bits);
  tangentFromSteps(normal, static_cast<float>(steps.quarter), static_cast<float>(steps.rest), bits,
                   tangent);
}

/// Adds to the three wedges of every face (4 floats each) the direction in which u grows, weighted
/// by the angle at the corner, and the orientation of the chart. `chart` has 2 finite floats per
/// wedge, see chartCoordinates(). [A.10.12]
inline void addFaceTangents(const WedgeMesh& wedges, const float* positions, const float* chart,
                            float* sums) {
  forFourFaces(wedges.faces, wedges.face_count, [=](const uint32_t* words, uint32_t count) {
    const FourFaces faces(words, count, positions);
    const Float4 zero = allLanes(0.0f);
    Float4 u0;
    Float4 v0;
    Float4 u1;
    Float4 v1;
    for (int i = 0; i < 4; ++i) {
      const float* a = chart + 2 * size_t{faces.corner[i][0]};
      const float* b = chart + 2 * size_t{faces.corner[i][1]};
      const float* c = chart + 2 * size_t{faces.corner[i][2]};
      u0[i] = b[0] - a[0];
      v0[i] = b[1] - a[1];
      u1[i] = c[0] - a[0];
      v1[i] = c[1] - a[1];
    }
    const Float4 determinant = u0 * v1 - u1 * v0;
    Float4 side = select(determinant < zero, allLanes(-1.0f), allLanes(1.0f));
    Float4 rows[4];
    for (int s = 0; s < 3; ++s) rows[s] = side * (faces.e0[s] * v1 - faces.e1[s] * v0);
    const Float4 tt = dotProduct(rows, rows);
    const Mask4 counts = (magnitude(determinant) > zero) & (tt > zero);
    const Float4 inverse = select(counts, allLanes(1.0f) / squareRoot(tt), zero);
    side = select(counts, side, zero);
    Float4 weight[3];
    faces.cornerAngles(squareRoot(dotProduct(faces.normal, faces.normal)), weight);
    for (Float4& w : weight) w = w * inverse;
    for (int s = 0; s < 3; ++s) rows[s] = select(counts, rows[s], zero);  // not an infinite one
    rows[3] = zero;
    Float4 sides[4] = {zero, zero, zero, side};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    transpose(sides[0], sides[1], sides[2], sides[3]);
    CornerSums(faces, count, sums).add(rows, weight, sides);
  });
}

/// Texture coordinates as finite floats whose products neither overflow nor become
/// denormal. [A.10.12]
inline void chartCoordinates(const AttributeInfo& info, const int32_t* values, size_t count,
                             float* chart) {
  const bool exact = isExact(info.coding);
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
  /// `normals` are the grid points of the wedges' normals, coded as `normal_info` says. `sums` has
  /// 4 floats per wedge, from addFaceTangents(), which are overwritten.
  TangentCoder(const AttributeJob<Io>& job, TangentModels& models, const AttributeInfo& normal_info,
               const int32_t* normals, float* sums)
      : job_(job),
        models_(models),
        bits_(job.info.bits),
        centre_(octahedralCentre(normal_info.bits)),
        normals_(normals),
        sums_(sums),
        repeats_(job, models.repeats, normals) {}

  void run() {
    gatherGroups(job_.wedges, job_.groups, sums_);
    for (uint32_t w = 0; w < job_.wedges.surface_count; w += 4) predictFour(w);
    forEachGroup<2>(job_, Ahead<float>{sums_, 4}, [this](uint32_t w) { codeGroup(w); });
  }

 private:
  void predictFour(uint32_t w);
  void codeGroup(uint32_t w);
  void codeTangent(uint32_t w, int32_t predicted, uint32_t predicted_sign, uint32_t context);

  const AttributeJob<Io> job_;
  TangentModels& models_;
  const uint32_t bits_;
  const int32_t centre_;
  const int32_t* const normals_;
  float* const
      sums_;  ///< then: steps of the predicted angle, whether there are any, -, sum of signs
  int32_t last_ = 0;
  TangentRepeats<Io, 2> repeats_;
};

/// Angles of the sums of wedges w .. w+3 in the planes of their normals.
template <class Io>
MCC_INLINE void TangentCoder<Io>::predictFour(uint32_t w) {
  const uint32_t count = std::min(job_.wedges.surface_count - w, 4u);
  const int32_t* points[4];
  Float4 rows[4];
  for (uint32_t i = 0; i < 4; ++i) {
    const size_t from = w + (i < count ? i : 0);
    points[i] = normals_ + 2 * from;
    rows[i] = loadFloat4(sums_ + 4 * from);
  }
  transpose(rows[0], rows[1], rows[2], rows[3]);
  Float4 normal[3];
  Float4 e1[3];
  Float4 e2[3];
  octahedralToUnit(points, centre_, normal);
  tangentFrame(normal, e1, e2);
  const Float4 x = dotProduct(rows, e1);
  const Float4 y = dotProduct(rows, e2);
  const Float4 zero = allLanes(0.0f);
  rows[0] = allLanes(static_cast<float>(uint32_t{1} << bits_) * 0.159154943f) * planeAngle(y, x);
  rows[1] = select(magnitude(x) + magnitude(y) > allLanes(1e-6f), allLanes(1.0f), zero);
  rows[2] = zero;
  transpose(rows[0], rows[1], rows[2], rows[3]);
  for (uint32_t i = 0; i < count; ++i) storeFloat4(sums_ + 4 * size_t{w + i}, rows[i]);
}

template <class Io>
void TangentCoder<Io>::codeGroup(uint32_t w) {
  const float* sum = sums_ + 4 * size_t{w};
  if (repeats_.code(w, sum[1] != 0)) {
    last_ = job_.values[2 * size_t{w}];
    return;
  }
  const uint32_t entry = job_.entryFace(w);
  int32_t predicted = last_;
  uint32_t context = kNoNeighbours;
  if (entry != kNone) {
    const auto [n, p] = job_.othersOf(entry);
    context = job_.contextOf(n, p);
    if (job_.isCoded(n)) predicted = job_.values[2 * size_t{n}];
  }
  if (sum[1] != 0) {
    predicted = static_cast<int32_t>(sum[0] + std::copysign(0.5f, sum[0]));
  }
  codeTangent(w, predicted, sum[3] > 0 ? 1 : sum[3] < 0 ? 2 : 0, context);
}

template <class Io>
void TangentCoder<Io>::codeTangent(uint32_t w, int32_t predicted, uint32_t predicted_sign,
                                   uint32_t context) {
  int32_t* value = job_.values + 2 * size_t{w};
  int32_t residual = 0;
  if constexpr (Io::kEncoding) {  // the difference modulo 2^bits nearest to 0
    const uint32_t difference = static_cast<uint32_t>(value[0]) - static_cast<uint32_t>(predicted);
    residual = static_cast<int32_t>(difference << (32 - bits_)) >> (32 - bits_);
  }
  uint32_t length = 0;
  residual = codeSmallSigned<0>(job_.io, models_.row[context], residual, length);
  const uint32_t mask = (uint32_t{1} << bits_) - 1;
  value[0] = static_cast<int32_t>(
      (static_cast<uint32_t>(predicted) + static_cast<uint32_t>(residual)) & mask);
  value[1] = job_.io.bit(models_.negative[predicted_sign], value[1] != 0) ? 1 : 0;
  job_.lengths[w] = static_cast<uint8_t>(length);
  last_ = value[0];
}

}  // namespace mcc

#endif  // MCC_VECTORS_TANGENTS_H_
