// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Morph targets of NORMAL and TANGENT: what is known of them from the mesh.                  [A.8.14, B.8]
//
//   bends   deltas of normals follow from how the target's positions turn the faces around a wedge
//   units   a moved normal has unit length; so has a moved tangent, which is perpendicular to the moved normal besides:
//           two components of the first and one of the second tell the others, up to rounding
#ifndef MCC_ATTRIBUTES_UNIT_DELTAS_H_
#define MCC_ATTRIBUTES_UNIT_DELTAS_H_

#include <cmath>
#include <cstdint>
#include <utility>

#include "attributes/exact_grid.h"
#include "attributes/exact_vectors.h"
#include "mcc/reader.h"

namespace mcc {

/// Length of a lattice's or grid's step of deltas, which go through 0.
inline double deltaStep(const AttributeInfo& info) {
  return info.coding == AttributeCoding::kGrid ? 1.0 / ExactGrid(info.grid).scale()
                                               : static_cast<double>(info.lattice.step);
}

/// The integer nearest to x; 0 for what has none.
inline int32_t nearestInteger(double x) {
  return x > -2e9 && x < 2e9 ? static_cast<int32_t>(x + (x < 0 ? -0.5 : 0.5)) : 0;
}

/// Deltas of unit vectors. Nothing here needs to be true: predictions of what is none are merely bad.
struct UnitDeltas {
  const float* base = nullptr;     ///< what is moved: 3 floats per wedge
  const float* normals = nullptr;  ///< of TANGENT: moved normals of length 1, 3 floats per wedge
  const int32_t* bends = nullptr;  ///< what the coded integers leave out: 3 per wedge, or null
  double step = 1;

  double movedComponent(uint32_t w, uint32_t c, int32_t q) const {
    const double bend = bends == nullptr ? 0.0 : static_cast<double>(bends[3 * size_t{w} + c]);
    return static_cast<double>(base[3 * size_t{w} + c]) + (static_cast<double>(q) + bend) * step;
  }
  /// Inverse of movedComponent().
  int32_t integerOf(uint32_t w, uint32_t c, double moved) const {
    const double bend = bends == nullptr ? 0.0 : static_cast<double>(bends[3 * size_t{w} + c]);
    return nearestInteger((moved - static_cast<double>(base[3 * size_t{w} + c])) / step - bend);
  }
};

/// The order in which the components of one delta are coded, and what the first ones tell of the later ones. [B.8.2]
class UnitDeltaFrame {
 public:
  /// `predicted`: by other means.
  UnitDeltaFrame(const UnitDeltas& deltas, uint32_t w, const int32_t* predicted)
      : deltas_(deltas), w_(w) {
    for (uint32_t c = 0; c < 3; ++c) moved_[c] = deltas.movedComponent(w, c, predicted[c]);
    if (deltas.normals == nullptr) {
      largestLast(moved_);
    } else {
      const float* n = deltas.normals + 3 * size_t{w};
      for (int s = 0; s < 3; ++s) normal_[s] = static_cast<double>(n[s]);
      const double along = dot(normal_, moved_);
      for (int s = 0; s < 3; ++s) moved_[s] -= along * normal_[s];
      cross(normal_, moved_, across_);
      largestLast(across_);
      std::swap(order_[0], order_[2]);
    }
  }

  uint32_t component(uint32_t i) const { return order_[i]; }
  /// Whether component(i) follows from the ones before.
  bool follows(uint32_t i) const { return deltas_.normals == nullptr ? i == 2 : i != 0; }

  /// After component(i) is known: changes the predictions of those that follow from it.
  void learn(uint32_t i, const int32_t* value, int32_t* predicted) const {
    if (deltas_.normals == nullptr) {
      if (i == 1) predictLength(value, predicted);
    } else if (i == 0) {
      predictAcross(value[order_[0]], predicted);
    }
  }

 private:
  void largestLast(const double* v) {
    uint32_t last = std::fabs(v[1]) > std::fabs(v[0]) ? 1 : 0;
    if (std::fabs(v[2]) > std::fabs(v[last])) last = 2;
    std::swap(order_[last], order_[2]);
  }

  /// The third component of a vector of length 1, on the side that was predicted.
  void predictLength(const int32_t* value, int32_t* predicted) const {
    const uint32_t last = order_[2];
    const double x = deltas_.movedComponent(w_, order_[0], value[order_[0]]);
    const double y = deltas_.movedComponent(w_, order_[1], value[order_[1]]);
    const double square = 1 - x * x - y * y;
    const double z = square > 0 ? std::sqrt(square) : 0.0;
    predicted[last] = deltas_.integerOf(w_, last, moved_[last] < 0 ? -z : z);
  }

  /// Of the two vectors of length 1 in the normal's plane that have this component, the one that was predicted.
  void predictAcross(int32_t value, int32_t* predicted) const {
    const uint32_t first = order_[0];
    double e1[3];
    double e2[3];
    for (uint32_t c = 0; c < 3; ++c) {
      e1[c] = (c == first ? 1.0 : 0.0) - normal_[first] * normal_[c];
    }
    const double steepness = e1[first];  // square of its length
    if (!(steepness > 1e-6) || !makeUnit(e1)) return;
    cross(normal_, e1, e2);
    const double x = deltas_.movedComponent(w_, first, value) / std::sqrt(steepness);
    const double square = 1 - x * x;
    double y = square > 0 ? std::sqrt(square) : 0.0;
    if (dot(moved_, e2) < 0) y = -y;
    for (uint32_t i = 1; i < 3; ++i) {
      const uint32_t c = order_[i];
      predicted[c] = deltas_.integerOf(w_, c, x * e1[c] + y * e2[c]);
    }
  }

  const UnitDeltas& deltas_;
  const uint32_t w_;
  uint32_t order_[3] = {0, 1, 2};
  double moved_[3];
  double normal_[3] = {0, 0, 0};
  double across_[3] = {0, 0, 0};
};

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_UNIT_DELTAS_H_
