// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// One vertex of a surface with planes, see position_planes.h.                               [B.2.9]
//
// What is coded first are planes, then coordinates by growing normal. Each deviation from the prediction moves the
// predictions of what is left such that the vertex stays near the tangent plane: the shortest such move.
#ifndef MCC_ATTRIBUTES_POSITION_PLANE_VERTEX_H_
#define MCC_ATTRIBUTES_POSITION_PLANE_VERTEX_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "attributes/position_planes.h"
#include "attributes/position_predict.h"
#include "attributes/position_residual.h"
#include "base/host.h"

namespace mcc {

template <class Io>
class PlaneVertexCoder {
 public:
  /// `truth` has the three coordinates (encoder).
  PlaneVertexCoder(Io& io, TokenRow* rows, PlaneModels& models, const GridPlanes& grid,
                   const Prediction& prediction, const int32_t* truth)
      : io_(io), rows_(rows), models_(models), grid_(grid), truth_(truth) {
    storeLanes<float>(floatsOf(prediction.at.step) + prediction.at.rest(), predicted_);
    storeLanes<float>(prediction.normal, normal_);
    storeLanes<float>(prediction.spread, spread_);
    const float size =
        std::sqrt(normal_[0] * normal_[0] + normal_[1] * normal_[1] + normal_[2] * normal_[2]);
    const float unit = size > 0 ? 1 / size : 0;
    for (int s = 0; s < 3; ++s) {
      normal_[s] *= unit;
      squared_left_ += normal_[s] * normal_[s];
    }
    across_ = prediction.magnitudes[0] * 0.25f + prediction.disagreement * unit * 2 + 16;
    along_ = prediction.magnitudes[2] * 0.25f + 16;
  }

  /// Codes the vertex into `record`.
  void code(uint32_t context, VertexRecord& record) {
    if (Io::kEncoding) findWay();
    between_ =
        io_.template token<0>(models_.between[context], kPositionSchedule, between_) & kAllAxes;
    if (hasSeveralAxes(between_)) {
      diagonal_ = io_.template token<1>(models_.diagonal[between_], kPositionSchedule, diagonal_);
      if (diagonal_ >= kDiagonals) diagonal_ = 0;
    }
    for (uint32_t s = 0; s < 3; ++s) {
      if (!hasAxis(between_, s)) codeOnPlane(s);
    }
    if (diagonal_ != 0) {
      codeDiagonal();
    } else {
      codeCoordinates();
    }
    store(record);
  }

 private:
  /// Keeps scales in the range of the tables' buckets, whatever a payload claims.
  static constexpr float kLargestScale = 1 << 22;
  static constexpr float kSteepEnough = 1.0f / 64;

  void findWay();
  bool fitsDiagonal(uint32_t diagonal, uint32_t first) const;
  int32_t codePlane(uint32_t s, float in_planes, uint32_t kind);
  void codeOnPlane(uint32_t s);
  void codeCoordinates();
  void codeDiagonal();
  template <uint32_t kSlot>
  int32_t codeNumber(float prediction, float scale, int32_t truth);

  int32_t truthOf(uint32_t s) const { return Io::kEncoding ? truth_[s] : 0; }
  /// By how much an axis moves for each step away from the tangent plane.
  float slopeOf(uint32_t s) const { return normal_[s] / (squared_left_ + 0.1f); }
  /// Notes a coordinate that is final.
  void learn(uint32_t s, int32_t q) {
    q_[s] = q;
    squared_left_ -= normal_[s] * normal_[s];
    distance_ += normal_[s] * (static_cast<float>(q) - predicted_[s]);
  }
  void store(VertexRecord& record) const {
    float moved = 0;
    for (int s = 0; s < 3; ++s) moved += std::fabs(static_cast<float>(q_[s]) - predicted_[s]);
    record.magnitude[0] = static_cast<uint32_t>(std::min(16 * std::fabs(distance_), kLargestScale));
    record.magnitude[1] = between_;
    record.magnitude[2] = static_cast<uint32_t>(std::min(8 * moved, kLargestScale));
    storeLanes<int32_t>(Lanes<int32_t>{q_[0], q_[1], q_[2], kKnown}, record.q);
  }

  Io& io_;
  TokenRow* const rows_;
  PlaneModels& models_;
  const GridPlanes& grid_;
  const int32_t* const truth_;
  float predicted_[4];
  float normal_[4];
  float spread_[4];
  float across_;            ///< expected distance from the tangent plane, in 1/16, as scales are
  float along_;             ///< expected movement of an axis within the tangent plane
  float squared_left_ = 0;  ///< of the normal, over the axes that are not known
  float distance_ = 0;      ///< from the tangent plane, of what is known
  uint32_t between_ = 0;
  uint32_t diagonal_ = 0;
  int32_t q_[3] = {};
};

/// Encoder: chooses axes and diagonal.
template <class Io>
void PlaneVertexCoder<Io>::findWay() {
  uint32_t first = 3;
  for (uint32_t s = 0; s < 3; ++s) {
    if (grid_.axis[s].at(grid_.axis[s].below(truth_[s])) == truth_[s]) continue;
    between_ |= 1u << s;
    first = std::min(first, s);
  }
  if (!hasSeveralAxes(between_)) return;
  for (uint32_t d = 1; d < kDiagonals && diagonal_ == 0; ++d) {
    if (fitsDiagonal(d, first)) diagonal_ = d;
  }
}

template <class Io>
bool PlaneVertexCoder<Io>::fitsDiagonal(uint32_t diagonal, uint32_t first) const {
  const int32_t t = truth_[first] - grid_.axis[first].at(grid_.axis[first].below(truth_[first]));
  for (uint32_t s = first + 1; s < 3; ++s) {
    if (!hasAxis(between_, s)) continue;
    const int32_t direction = directionOf(diagonal, first, s);
    const int32_t plane = grid_.axis[s].below(truth_[s]) + (direction < 0 ? 1 : 0);
    const int32_t rest = truth_[s] - grid_.axis[s].at(plane) - direction * grid_.along(first, s, t);
    if (rest > kMaxDiagonalRest || rest < -kMaxDiagonalRest) return false;
  }
  return true;
}

/// Number of the plane at or below axis `s`, predicted to be the largest that is not above `in_planes`.
template <class Io>
MCC_INLINE int32_t PlaneVertexCoder<Io>::codePlane(uint32_t s, float in_planes, uint32_t kind) {
  const int32_t near = floorOf(in_planes);
  const float off_middle = in_planes - static_cast<float>(near) - 0.5f;
  const float spread = (spread_[s] + along_ * (1.0f / 16)) * grid_.inverse_step[s];
  const uint32_t spread_class =
      static_cast<uint32_t>(spread >= 0.25f) + (spread >= 0.5f) + (spread >= 0.75f);
  const uint32_t fraction = static_cast<uint32_t>(std::min(std::fabs(off_middle) * 8, 3.0f));
  TokenRow& row = models_.plane[kind][spread_class][fraction];
  const int32_t target = Io::kEncoding ? grid_.axis[s].below(truthOf(s)) - near : 0;
  const uint32_t flip = off_middle < 0 ? 1 : 0;
  const int32_t change = codeResidual<2>(io_, row, 0, ~0u, flip, target, std::true_type{});
  return static_cast<int32_t>(static_cast<uint32_t>(near) + static_cast<uint32_t>(change));
}

template <class Io>
MCC_INLINE void PlaneVertexCoder<Io>::codeOnPlane(uint32_t s) {
  const float at = predicted_[s] - distance_ * slopeOf(s);
  const float in_planes = (at - grid_.origin[s]) * grid_.inverse_step[s];
  learn(s, grid_.axis[s].at(codePlane(s, in_planes + 0.5f, 0)));
}

/// The coordinates between planes, those with the largest normal last.
template <class Io>
MCC_INLINE void PlaneVertexCoder<Io>::codeCoordinates() {
  uint32_t left[3];
  uint32_t count = 0;
  for (uint32_t s = 0; s < 3; ++s) {
    if (hasAxis(between_, s)) left[count++] = s;
  }
  const auto order = [&](uint32_t a, uint32_t b) {
    if (std::fabs(normal_[left[b]]) < std::fabs(normal_[left[a]])) std::swap(left[a], left[b]);
  };
  if (count > 1) order(count - 2, count - 1);
  if (count > 2) {
    order(0, 1);
    order(1, 2);
  }
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t s = left[i];
    const float slope = slopeOf(s);
    const float squared = normal_[s] * normal_[s];
    const float others = std::max(squared_left_ - squared, 0.0f);
    const float freedom = others / (others + squared + 1e-6f);
    const float at = predicted_[s] - distance_ * slope;
    const float scale = across_ * std::fabs(slope) + freedom * (along_ + 2 * spread_[s]);
    const uint32_t slot = count - 1 - i;  // rows of their own for how much is left
    learn(s, slot == 0   ? codeNumber<0>(at, scale, truthOf(s))
             : slot == 1 ? codeNumber<1>(at, scale, truthOf(s))
                         : codeNumber<2>(at, scale, truthOf(s)));
  }
}

/// Cells, then t on the first axis, then what the others are off.
template <class Io>
MCC_INLINE void PlaneVertexCoder<Io>::codeDiagonal() {
  uint32_t first = 3;
  int32_t base[3] = {};
  float height = -distance_;  // of the tangent plane above the planes
  float slope = 0;            // by which the diagonal nears it
  for (uint32_t s = 0; s < 3; ++s) {
    if (!hasAxis(between_, s)) continue;
    if (first == 3) first = s;
    const int32_t direction = directionOf(diagonal_, first, s);
    const float in_planes = (predicted_[s] - grid_.origin[s]) * grid_.inverse_step[s];
    const uint32_t plane =
        static_cast<uint32_t>(codePlane(s, in_planes, 1)) + (direction < 0 ? 1 : 0);
    base[s] = grid_.axis[s].at(static_cast<int32_t>(plane));
    height += normal_[s] * (predicted_[s] - static_cast<float>(base[s]));
    slope += normal_[s] * static_cast<float>(direction) * grid_.step[s];
  }
  slope *= grid_.inverse_step[first];
  const float steep = std::max(std::fabs(slope), kSteepEnough);
  const float width = grid_.step[first];
  const float t = steep > kSteepEnough ? std::clamp(height / slope, 0.0f, width) : width / 2;
  const int32_t base_truth = Io::kEncoding ? truthOf(first) - base[first] : 0;
  const int32_t moved = codeNumber<0>(t, std::min(across_ / steep, 4 * width), base_truth);
  for (uint32_t s = first; s < 3; ++s) {
    if (!hasAxis(between_, s)) continue;
    const int32_t by = directionOf(diagonal_, first, s) * grid_.along(first, s, moved);
    uint32_t q = static_cast<uint32_t>(base[s]) + static_cast<uint32_t>(s == first ? moved : by);
    if (s != first) {
      const int32_t off = static_cast<int32_t>(static_cast<uint32_t>(truthOf(s)) - q);
      q += static_cast<uint32_t>(
          codeResidual<1>(io_, models_.rest, 0, ~0u, 0, off, std::true_type{}));
    }
    learn(s, static_cast<int32_t>(q));
  }
}

/// A number near its prediction.
template <class Io>
template <uint32_t kSlot>
MCC_INLINE int32_t PlaneVertexCoder<Io>::codeNumber(float prediction, float scale, int32_t truth) {
  constexpr float kFarthest = 1 << 22;  // in Q8 and rounded it fits
  const int32_t q8 = static_cast<int32_t>(std::clamp(prediction, -kFarthest, kFarthest) * 256);
  const uint32_t rounded = static_cast<uint32_t>(q8) + 128;
  const float s = std::clamp(scale, 0.0f, kLargestScale);
  ResidualContexts c;
  findContexts(ScaleEstimate{Lanes<float>{s, s, s, 0}, Lanes<uint32_t>{}},
               Lanes<uint32_t>{rounded, rounded, rounded, 0}, false, std::true_type{}, c);
  const uint32_t from = static_cast<uint32_t>(static_cast<int32_t>(rounded) >> 8);
  const int32_t target = static_cast<int32_t>(static_cast<uint32_t>(truth) - from);
  TokenRow& row = rows_[c.row[kSlot]];
  const int32_t residual = codeResidual<kSlot>(io_, row, row.low_bits, c.folded[kSlot],
                                               c.flip[kSlot], target, std::true_type{});
  return static_cast<int32_t>(from + static_cast<uint32_t>(residual));
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITION_PLANE_VERTEX_H_
