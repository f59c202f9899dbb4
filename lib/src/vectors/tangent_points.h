// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tangents as points of an octahedral grid and a sign: those that have no octahedral normals to be
// perpendicular to, or are not perpendicular to them. [A.10.13, A.10.12]
//
// Prediction: the direction in which u grows around the group, as for angles (tangents.h); without
// one, the mean of the neighbours' tangents. Projected on the plane of the wedge's normal, if the
// piece has normals of any kind.
#ifndef MCC_VECTORS_TANGENT_POINTS_H_
#define MCC_VECTORS_TANGENT_POINTS_H_

#include <algorithm>
#include <cstdint>

#include "values/attribute_job.h"
#include "vectors/normals.h"
#include "vectors/tangent_repeats.h"
#include "vectors/tangents.h"

namespace mcc {

inline constexpr uint32_t kTangentPointWords = 3;  ///< grid point, 1 if the sign is negative

struct TangentPointModels {
  TokenRow row[2][kLengthContexts];
  BitModel negative[3];  ///< [predicted: unknown, positive, negative]
  TangentRepeatModels repeats;

  TangentPointModels() {
    for (auto& component : row) {
      for (TokenRow& r : component) r.setUniform();
    }
  }
};

/// Takes from v what points along a vector of any length. [A.10.12]
inline void projectOnPlane(const float* normal, float* v) {
  const float square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  if (!(square > 1e-12f && square < 1e12f)) return;
  const float along = (normal[0] * v[0] + normal[1] * v[1] + normal[2] * v[2]) / square;
  for (int s = 0; s < 3; ++s) v[s] = v[s] - along * normal[s];
}

/// A line through the predicted point, in the residual's frame: where residuals lie if tangents lie
/// in a plane. That of slope 0 along component 0 predicts nothing.
struct ResidualLine {
  uint32_t along = 0;  ///< the component that is coded first
  float slope = 0;     ///< what the other one changes by, at most 1

  /// The line of the plane with `normal` at a `direction` in it whose manhattanLength() is
  /// `length`. The octahedron shows planes as lines. [A.10.19]
  static ResidualLine ofPlane(const float* normal, const float* direction, float length,
                              const OctahedralFrame& frame) {
    float turn[3];
    float shrink = 0;
    for (uint32_t s = 0; s < 3; ++s) {
      const uint32_t next = (s + 1) % 3;
      const uint32_t last = (s + 2) % 3;
      turn[s] = normal[next] * direction[last] - normal[last] * direction[next];
      shrink = shrink + (direction[s] < 0 ? -turn[s] : turn[s]);
    }
    float step[2];
    for (uint32_t s = 0; s < 2; ++s) step[s] = turn[s] * length - direction[s] * shrink;
    frame.turnStep(step);
    ResidualLine line;
    line.along = std::fabs(step[1]) > std::fabs(step[0]) ? 1 : 0;
    const float first = step[line.along];
    if (std::fabs(first) > 0) line.slope = step[1 - line.along] / first;
    return line;
  }
  int32_t other(int32_t residual) const {
    const float change = slope * static_cast<float>(residual);
    return static_cast<int32_t>(change + std::copysign(0.5f, change));
  }
};

/// Codes kTangentPointWords integers per wedge.
template <class Io>
class TangentPointCoder {
 public:
  /// `normals` has 3 floats per wedge; it is null if the piece has no normals. `sums` has 4 floats
  /// per wedge, from addFaceTangents(), which are overwritten.
  TangentPointCoder(const AttributeJob<Io>& job, TangentPointModels& models, const float* normals,
                    const int32_t* normal_points, float* sums)
      : job_(job),
        models_(models),
        centre_(octahedralCentre(job.info.bits)),
        in_faces_((job.info.predictor & tangent_method::kFaces) != 0),
        normals_(normals),
        sums_(sums),
        repeats_(job, models.repeats, normal_points) {}

  void run() {
    gatherGroups(job_.wedges, job_.groups, sums_);
    forEachGroup<kTangentPointWords>(job_, Ahead<float>{sums_, 4},
                                     [this](uint32_t w) { codeGroup(w); });
  }

 private:
  static constexpr float kShortestSum = 1e-6f;  ///< sums of corners' angles are much longer, or 0

  int32_t* at(uint32_t w) const { return job_.values + kTangentPointWords * size_t{w}; }
  void addDecoded(uint32_t w, float* direction) const {
    if (!job_.isCoded(w)) return;
    float unit[3];
    octahedralToUnit(at(w)[0], at(w)[1], centre_, unit);
    for (int s = 0; s < 3; ++s) direction[s] += unit[s];
  }
  void codeGroup(uint32_t w);
  void codeTangent(uint32_t w, const OctahedralFrame& frame, const ResidualLine& line,
                   uint32_t predicted_sign, uint32_t context);
  void projectBesideNormal(uint32_t w, float* direction) const {
    if (normals_ != nullptr && !in_faces_) projectOnPlane(normals_ + 3 * size_t{w}, direction);
  }
  /// The normal of the first face around w.
  void faceNormal(uint32_t w, float* normal) const {
    const auto [n, p] = job_.othersOf(job_.wedges.startOf(w));
    const Float4 corner = loadFloat4(job_.positions + 4 * size_t{w});
    const Float4 a = loadFloat4(job_.positions + 4 * size_t{n}) - corner;
    const Float4 b = loadFloat4(job_.positions + 4 * size_t{p}) - corner;
    normal[0] = a[1] * b[2] - a[2] * b[1];
    normal[1] = a[2] * b[0] - a[0] * b[2];
    normal[2] = a[0] * b[1] - a[1] * b[0];
  }

  const AttributeJob<Io> job_;
  TangentPointModels& models_;
  const int32_t centre_;
  const bool in_faces_;
  const float* const normals_;
  float* const sums_;
  int32_t last_[2] = {};
  TangentRepeats<Io, kTangentPointWords> repeats_;
};

template <class Io>
void TangentPointCoder<Io>::codeGroup(uint32_t w) {
  const float* sum = sums_ + 4 * size_t{w};
  float direction[3] = {sum[0], sum[1], sum[2]};
  if (repeats_.code(w, manhattanLength(direction) > kShortestSum)) {
    for (uint32_t s = 0; s < 2; ++s) last_[s] = at(w)[s] - centre_;
    return;
  }
  const uint32_t entry = job_.entryFace(w);
  uint32_t context = kNoNeighbours;
  projectBesideNormal(w, direction);
  float length = manhattanLength(direction);
  if (entry != kNone) {
    const auto [n, p] = job_.othersOf(entry);
    context = job_.contextOf(n, p);
    if (!(length > kShortestSum)) {
      addDecoded(n, direction);
      addDecoded(p, direction);
      projectBesideNormal(w, direction);
      length = manhattanLength(direction);
    }
  }
  const uint32_t predicted_sign = sum[3] > 0 ? 1 : sum[3] < 0 ? 2 : 0;
  if (length > kShortestSum && length < 1e30f) {
    int32_t inside[2];
    projectToGrid(direction, length, centre_, inside);
    const OctahedralFrame frame(inside, direction[2] < 0, centre_);
    ResidualLine line;
    if (in_faces_) {
      float normal[3];
      faceNormal(w, normal);
      line = ResidualLine::ofPlane(normal, direction, length, frame);
    }
    codeTangent(w, frame, line, predicted_sign, context);
  } else {
    codeTangent(w, OctahedralFrame::around(last_, centre_), {}, predicted_sign, context);
  }
}

template <class Io>
void TangentPointCoder<Io>::codeTangent(uint32_t w, const OctahedralFrame& frame,
                                        const ResidualLine& line, uint32_t predicted_sign,
                                        uint32_t context) {
  int32_t* value = at(w);
  int32_t residual[2] = {};
  if constexpr (Io::kEncoding) {
    const int32_t point[2] = {value[0] - centre_, value[1] - centre_};
    frame.residualOf(point, residual);
  }
  uint32_t length = 0;
  uint32_t other_length = 0;
  int32_t& first = residual[line.along];
  int32_t& other = residual[1 - line.along];
  first = codeSmallSigned<0>(job_.io, models_.row[0][context], first, length);
  const uint32_t second = context == kNoNeighbours ? length : contextAfter(context, length);
  const int32_t expected = line.other(std::clamp(first, -centre_, centre_));
  other = codeSmallSigned<1>(job_.io, models_.row[1][second], other - expected, other_length);
  // Wraps, because a file may hold any residual.
  other = static_cast<int32_t>(static_cast<uint32_t>(other) + static_cast<uint32_t>(expected));
  frame.pointOf(residual, last_);
  for (uint32_t s = 0; s < 2; ++s) value[s] = last_[s] + centre_;
  value[2] = job_.io.bit(models_.negative[predicted_sign], value[2] != 0) ? 1 : 0;
  job_.lengths[w] = static_cast<uint8_t>(std::max(length, other_length));
}

}  // namespace mcc

#endif  // MCC_VECTORS_TANGENT_POINTS_H_
