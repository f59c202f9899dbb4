// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Sums over the faces around every wedge, computed for four faces at a time. [A.10.7]
#ifndef MCC_SURFACE_FACE_PASS_H_
#define MCC_SURFACE_FACE_PASS_H_

#include <cstdint>

#include "base/float4.h"
#include "mesh/face_mesh.h"

namespace mcc {

template <class Real>
MCC_INLINE Real dotProduct(const Real* a, const Real* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns the angle of the vector (x, y), y >= 0, in 0..pi, by a polynomial. [A.10.7]
template <class Real>
MCC_SHARED Real cornerAngle(Real y, Real x) {
  const Real ax = magnitude(x);
  const Real t = lower(ax, y) / (higher(ax, y) + constant<Real>(1e-30f));
  const Real s = t * t;
  const Real p = (constant<Real>(-0.0464964749f) * s + constant<Real>(0.15931422f)) * s -
                 constant<Real>(0.327622764f);
  Real r = p * s * t + t;
  r = select(y > ax, constant<Real>(1.57079637f) - r, r);
  return select(x < constant<Real>(0.0f), constant<Real>(3.14159274f) - r, r);
}

/// The faces f .. f+count-1, one per lane; the remaining lanes repeat the first.
struct FourFaces {
  const uint32_t* corner[4];
  Float4 e0[3];      ///< from corner 0 to corner 1
  Float4 e1[3];      ///< from corner 0 to corner 2
  Float4 normal[3];  ///< cross product of e0 and e1

  /// `positions` has 4 floats per vertex, the last one 0.
  MCC_SHARED FourFaces(const uint32_t* words, uint32_t count, const float* positions) {
    Float4 rows0[4];
    Float4 rows1[4];
    for (uint32_t i = 0; i < 4; ++i) {
      corner[i] = words + (i < count ? kFaceWords * i : 0);
      const Float4 a = loadFloat4(positions + 4 * size_t{corner[i][0]});
      rows0[i] = loadFloat4(positions + 4 * size_t{corner[i][1]}) - a;
      rows1[i] = loadFloat4(positions + 4 * size_t{corner[i][2]}) - a;
    }
    transpose(rows0[0], rows0[1], rows0[2], rows0[3]);
    transpose(rows1[0], rows1[1], rows1[2], rows1[3]);
    for (int s = 0; s < 3; ++s) {
      e0[s] = rows0[s];
      e1[s] = rows1[s];
    }
    normal[0] = e0[1] * e1[2] - e0[2] * e1[1];
    normal[1] = e0[2] * e1[0] - e0[0] * e1[2];
    normal[2] = e0[0] * e1[1] - e0[1] * e1[0];
  }

  /// Computes the angles at the corners. `length` has the lengths of the normals.
  MCC_INLINE void cornerAngles(Float4 length, Float4* angle) const {
    const Float4 d0 = dotProduct(e0, e1);
    angle[0] = cornerAngle(length, d0);
    angle[1] = cornerAngle(length, dotProduct(e0, e0) - d0);
    angle[2] = allLanes(3.14159274f) - angle[0] - angle[1];
  }
};

/// Adds a vector per face, weighted per corner, to the sums of its corners (4 floats each), face by
/// face.
class CornerSums {
 public:
  CornerSums(const FourFaces& faces, uint32_t count, float* sums)
      : faces_(faces), count_(count), sums_(sums) {}

  /// `rows` is the vector of each face; `fixed` is added in addition, without a weight.
  MCC_INLINE void add(const Float4* rows, const Float4* weight, const Float4* fixed) const {
    if constexpr (kCompact) return addFaces(rows, weight, fixed);
    addFace<0>(rows, weight, fixed);
    if (count_ > 1) addFace<1>(rows, weight, fixed);
    if (count_ > 2) addFace<2>(rows, weight, fixed);
    if (count_ > 3) addFace<3>(rows, weight, fixed);
  }

 private:
  template <int kFace>
  MCC_INLINE void addFace(const Float4* rows, const Float4* weight, const Float4* fixed) const {
    addCorner(faces_.corner[kFace][0], rows[kFace] * broadcast<kFace>(weight[0]), fixed, kFace);
    addCorner(faces_.corner[kFace][1], rows[kFace] * broadcast<kFace>(weight[1]), fixed, kFace);
    addCorner(faces_.corner[kFace][2], rows[kFace] * broadcast<kFace>(weight[2]), fixed, kFace);
  }
  void addFaces(const Float4* rows, const Float4* weight, const Float4* fixed) const {
    for (uint32_t f = 0; f < count_; ++f) {
      const int face = static_cast<int>(f);
      for (int k = 0; k < 3; ++k)
        addCorner(faces_.corner[f][k], rows[f] * allLanes(weight[k][face]), fixed, face);
    }
  }
  MCC_INLINE void addCorner(uint32_t vertex, Float4 row, const Float4* fixed, int face) const {
    float* sum = sums_ + 4 * size_t{vertex};
    const Float4 weighted = loadFloat4(sum) + row;
    storeFloat4(sum, fixed == nullptr ? weighted : weighted + fixed[face]);
  }

  const FourFaces& faces_;
  const uint32_t count_;
  float* const sums_;
};

/// Calls visit(words, count) for every four faces, and for the remaining ones.
template <class Visit>
MCC_INLINE void forFourFaces(const FaceView& faces, uint32_t face_count, Visit visit) {
  for (uint32_t f = 0; f < face_count; f += 4) {
    visit(faces.words + size_t{f} * kFaceWords, face_count - f < 4 ? face_count - f : 4u);
  }
}

}  // namespace mcc

#endif  // MCC_SURFACE_FACE_PASS_H_
