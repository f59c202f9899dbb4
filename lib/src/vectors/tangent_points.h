// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tangents as points of an octahedral grid and a sign: those that have no octahedral normals to be perpendicular to, or
// are not perpendicular to them.                                                             [A.8.7, B.6.6]
//
// Prediction: the direction in which u grows around the group, as for angles (tangents.h); without one, the mean of the
// neighbours' tangents. Projected on the plane of the wedge's normal, if the piece has normals of any kind.
#ifndef MCC_VECTORS_TANGENT_POINTS_H_
#define MCC_VECTORS_TANGENT_POINTS_H_

#include <algorithm>
#include <cstdint>

#include "vectors/normals.h"
#include "vectors/tangents.h"

namespace mcc {

inline constexpr uint32_t kTangentPointWords = 3;  ///< grid point, 1 if the sign is negative

struct TangentPointModels {
  TokenRow row[2][kLengthContexts];
  BitModel negative[3];  ///< [predicted: unknown, positive, negative]

  TangentPointModels() {
    for (auto& component : row) {
      for (TokenRow& r : component) r.setUniform();
    }
  }
};

/// Takes from v what points along a vector of any length. [B.6.6]
inline void projectOnPlane(const float* normal, float* v) {
  const float square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  if (!(square > 1e-12f && square < 1e12f)) return;
  const float along = (normal[0] * v[0] + normal[1] * v[1] + normal[2] * v[2]) / square;
  for (int s = 0; s < 3; ++s) v[s] = v[s] - along * normal[s];
}

/// Codes kTangentPointWords integers per wedge.
template <class Io>
class TangentPointCoder {
 public:
  /// `sums`: 4 floats per wedge, from addFaceTangents(), overwritten. `normals`: 3 floats per wedge, or null if the
  /// piece has none. `lengths`: work space, a byte per wedge.
  TangentPointCoder(Io& io, TangentPointModels& models, const WedgeMesh& wedges,
                    const EqualGroups& groups, const AttributeInfo& info, const float* normals,
                    float* sums, int32_t* values, uint8_t* lengths)
      : io_(io),
        models_(models),
        wedges_(wedges),
        groups_(groups),
        centre_(octahedralCentre(info.bits)),
        normals_(normals),
        sums_(sums),
        values_(values),
        lengths_(lengths) {}

  void run() {
    std::fill(lengths_, lengths_ + wedges_.count, kNotCoded);
    gatherGroups(wedges_, groups_, sums_);
    for (uint32_t i = 0; i < wedges_.surfaceEnd(); ++i) {
      const uint32_t w = wedges_.wedgeAt(i);
      if (groups_.isFirst(w)) codeGroup(w);
    }
    for (uint32_t w = wedges_.surface_count; w < wedges_.coded_count; ++w)
      codeTangent(w, OctahedralFrame::around(last_, centre_), 0, kNoNeighbours);
  }

 private:
  static constexpr float kShortestSum = 1e-6f;  ///< sums of corners' angles are much longer, or 0

  int32_t* at(uint32_t w) const { return values_ + kTangentPointWords * size_t{w}; }
  void addDecoded(uint32_t w, float* direction) const {
    if (lengths_[w] == kNotCoded) return;
    float unit[3];
    octahedralToUnit(at(w)[0], at(w)[1], centre_, unit);
    for (int s = 0; s < 3; ++s) direction[s] += unit[s];
  }
  void codeGroup(uint32_t w);
  void codeTangent(uint32_t w, const OctahedralFrame& frame, uint32_t predicted_sign,
                   uint32_t context);

  Io& io_;
  TangentPointModels& models_;
  const WedgeMesh& wedges_;
  const EqualGroups& groups_;
  const int32_t centre_;
  const float* const normals_;
  float* const sums_;
  int32_t* const values_;
  uint8_t* const lengths_;
  int32_t last_[2] = {};
};

template <class Io>
void TangentPointCoder<Io>::codeGroup(uint32_t w) {
  const float* sum = sums_ + 4 * size_t{w};
  uint32_t entry = kNone;
  for (uint32_t m = w; m != kNone && entry == kNone; m = groups_.nextOf(m)) {
    entry = wedges_.firstCompleted(m);
  }
  float direction[3] = {sum[0], sum[1], sum[2]};
  uint32_t context = kNoNeighbours;
  if (normals_ != nullptr) projectOnPlane(normals_ + 3 * size_t{w}, direction);
  float length = manhattanLength(direction);
  if (entry != kNone) {
    const uint32_t n = wedges_.faces.vertex(nextHalfEdge(entry));
    const uint32_t p = wedges_.faces.vertex(prevHalfEdge(entry));
    context = std::min((lengths_[n] + lengths_[p] + 1u) / 2, kNoNeighbours);  // kNotCoded is long
    if (!(length > kShortestSum)) {
      addDecoded(n, direction);
      addDecoded(p, direction);
      if (normals_ != nullptr) projectOnPlane(normals_ + 3 * size_t{w}, direction);
      length = manhattanLength(direction);
    }
  }
  const uint32_t predicted_sign = sum[3] > 0 ? 1 : sum[3] < 0 ? 2 : 0;
  if (length > kShortestSum && length < 1e30f) {
    int32_t inside[2];
    projectToGrid(direction, length, centre_, inside);
    codeTangent(w, OctahedralFrame(inside, direction[2] < 0, centre_), predicted_sign, context);
  } else {
    codeTangent(w, OctahedralFrame::around(last_, centre_), predicted_sign, context);
  }
  for (uint32_t m = groups_.nextOf(w); m != kNone; m = groups_.nextOf(m)) {
    std::copy_n(at(w), kTangentPointWords, at(m));
    lengths_[m] = lengths_[w];
  }
}

template <class Io>
void TangentPointCoder<Io>::codeTangent(uint32_t w, const OctahedralFrame& frame,
                                        uint32_t predicted_sign, uint32_t context) {
  int32_t* value = at(w);
  codeGridPoint(io_, models_.row, frame, centre_, context, value, lengths_[w], last_);
  value[2] = io_.bit(models_.negative[predicted_sign], value[2] != 0) ? 1 : 0;
}

}  // namespace mcc

#endif  // MCC_VECTORS_TANGENT_POINTS_H_
