// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// One vertex of a surface with planes, see positions/planes.h. [A.6.12]
//
// On an axis whose coordinate lies on a plane, the number of the plane (its rank) is coded. The
// other axes move: their coordinates are coded. The rows of all three numbers are known before the
// first is coded. Once they are known, the coordinates move one by one, those with the largest
// normal last, by the shortest move that keeps the vertex near the tangent plane.
#ifndef MCC_POSITIONS_PLANE_VERTEX_H_
#define MCC_POSITIONS_PLANE_VERTEX_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "base/host.h"
#include "positions/planes.h"
#include "positions/predict.h"
#include "positions/residual.h"

namespace mcc {

/// For each set of axes, the axes sorted by growing normal; indexed by normalOrder().
struct MovingOrders {
  uint8_t axis[8][8][3];
};
constexpr MovingOrders makeMovingOrders() {
  MovingOrders orders{};
  for (uint32_t axes = 0; axes < 8; ++axes) {
    for (uint32_t order = 0; order < 8; ++order) {
      uint8_t* to = orders.axis[axes][order];
      for (uint32_t i = 0; i < 3; ++i) {
        const uint8_t s = kComponentOrders[order].axis[i];
        if ((axes >> s & 1) != 0) *to++ = s;
      }
    }
  }
  return orders;
}
inline constexpr MovingOrders kMovingOrders = makeMovingOrders();

template <class Io>
class PlaneVertexCoder {
 public:
  MCC_INLINE PlaneVertexCoder(Io& io, TokenRow* rows, PlaneModels& models, const GridPlanes& grid,
                              const Prediction& prediction)
      : io_(io),
        rows_(rows),
        models_(models),
        grid_(grid),
        q8_((prediction.at.step << 8) + prediction.at.fraction),
        spread_(prediction.spread),
        normals_(prediction.normal * kNormalUnit),
        across_(prediction.magnitudes[0] * 0.25f + 16),
        along_(prediction.magnitudes[2] * 0.25f + 16) {
    const Lanes<float> squares = normals_ * normals_;
    const float squared = squares[0] + squares[1] + squares[2];
    size_ = std::sqrt(squared);
    doubt_ = squared * kDoubt + kTiny;
  }

  /// Codes the vertex into `record`. `truth` has the three coordinates (encoder).
  MCC_INLINE void code(uint32_t context, const int32_t* truth, VertexRecord& record) {
    truth_ = truth;
    uint32_t kind = 0;
    if constexpr (Io::kEncoding) kind = findKind();
    kind = io_.template token<0>(models_.kind[context], kPositionSchedule, kind);
    frame_ = &grid_.frame[kind];
    alignToLine();
    orderMoving();
    place(codeNumbers());
    codeRests();
    store(record);
  }

 private:
  static constexpr float kLargestScale = 1 << 22;
  /// Keeps the squares of all normals finite.
  static constexpr float kNormalUnit = 1.0f / (uint64_t{1} << 32);
  /// How little the normal is trusted; this bounds how far a vertex moves.
  static constexpr float kDoubt = 1.0f / 64;
  static constexpr float kTiny = 1e-30f;  ///< avoids a division by 0 where there is no normal
  static constexpr int32_t kMaxRest = 2;  ///< largest rest that the writer codes

  static uint32_t wrapped(int32_t x) { return static_cast<uint32_t>(x); }
  template <class Number>
  static Lanes<Number> select(const Lanes<uint32_t>& mask, const Lanes<Number>& yes,
                              const Lanes<Number>& no) {
    return lanesAs<Number>((lanesAs<uint32_t>(yes) & mask) | (lanesAs<uint32_t>(no) & ~mask));
  }

  /// Moves the prediction to where the vertex's line begins: on a diagonal, the other coordinates
  /// move with the first.
  MCC_INLINE void alignToLine() {
    Lanes<float> at = floatsOf(q8_);
    storeLanes<float>(normals_, normal_);
    if (frame_->rests != 0) {
      const uint32_t first = frame_->first;
      at -= frame_->slope * (at[first] - grid_.origin[first]);
      const Lanes<float> moved = frame_->slope * normals_;
      normal_[first] += moved[0] + moved[1] + moved[2];
    }
    at_ = at;
    expected_ = fractionOf(at);
  }

  /// Orders the moving axes, and finds how much each moves per step away from the tangent plane.
  MCC_INLINE void orderMoving() {
    order_ = kMovingOrders.axis[frame_->moving][normalOrder(normal_)];
    float left = doubt_;
    for (uint32_t i = frame_->moving_count; i-- != 0;) {
      const float n = normal_[order_[i]];
      left += n * n;
      slope_[i] = n / left;
    }
  }

  /// Codes the ranks and the coordinates before they are moved.
  MCC_INLINE Lanes<int32_t> codeNumbers() {
    const Lanes<uint32_t> on_planes = frame_->on_planes;
    const uint32_t last = frame_->moving_count - 1;
    const float width_of_last = across_ * std::fabs(slope_[last]) * size_;
    const Lanes<float> of_last = {width_of_last, width_of_last, width_of_last, 0};
    Lanes<float> width = select<float>(
        on_planes, (spread_ * 8 + along_ * 0.5f) * grid_.inverse_step, spread_ * 2 + along_);
    width = select<float>(loadLanes<uint32_t>(kLaneMasks[order_[last]]), of_last, width);
    const Lanes<uint32_t> rank = fractionOf((at_ - grid_.origin) * grid_.inverse_step);
    const Lanes<uint32_t> rounded = select<uint32_t>(on_planes, rank, expected_) + 128;
    ResidualContexts c;
    findContexts({width, on_planes & 1}, rounded, true, std::true_type{}, c);
    const Lanes<uint32_t> near = lanesAs<uint32_t>(lanesAs<int32_t>(rounded) >> 8);
    int32_t target[3] = {};
    if constexpr (Io::kEncoding) findTargets(lanesAs<int32_t>(near), target);
    return lanesAs<int32_t>(near + codeResiduals(io_, rows_, c, target, std::true_type{}));
  }

  MCC_INLINE void place(const Lanes<int32_t>& number) {
    storeLanes<int32_t>(number, q_);
    const Lanes<uint32_t> base = placeRanks();
    for (uint32_t i = 0; i < frame_->moving_count; ++i) {
      const uint32_t s = order_[i];
      q_[s] = static_cast<int32_t>(wrapped(q_[s]) + wrapped(shift(i)));
      learn(s);
    }
    const Lanes<int32_t> moved = {q_[0], q_[1], q_[2], 0};
    storeLanes<int32_t>(
        select<int32_t>(frame_->on_planes, lanesAs<int32_t>(base + 128) >> 8, moved), q_);
  }
  /// Finds the planes or lines of the ranks in q_, and how far they have moved the vertex from the
  /// tangent plane.
  MCC_INLINE Lanes<uint32_t> placeRanks() {
    const Lanes<uint32_t> base = {wrapped(grid_.axis[0].q8At(q_[0])),
                                  wrapped(grid_.axis[1].q8At(q_[1])),
                                  wrapped(grid_.axis[2].q8At(q_[2])), 0};
    storeLanes<uint32_t>(base, base_);
    const Lanes<uint32_t> off = (base - expected_) & frame_->on_planes;
    const Lanes<float> d = floatsOf(off) * normals_;
    distance_ = d[0] + d[1] + d[2];
    return base;
  }
  MCC_INLINE int32_t shift(uint32_t i) const {
    return (static_cast<int32_t>(boundMove(-slope_[i] * distance_)) + 128) >> 8;
  }
  /// Takes a final coordinate into account.
  MCC_INLINE void learn(uint32_t s) {
    const uint32_t off = (wrapped(q_[s]) << 8) - expected_[s];
    distance_ += normal_[s] * static_cast<float>(static_cast<int32_t>(off));
  }

  /// Returns how far a line that begins at plane 0 of its first axis has moved by there, in Q8.
  MCC_INLINE static int32_t movedTo(const GridPlanes& grid, const GridPlanes::Frame& frame,
                                    uint32_t s, int32_t q) {
    const float along = static_cast<float>(q) * 256 - grid.origin[frame.first];
    return static_cast<int32_t>(boundMove(frame.slope[s] * along));
  }
  /// Codes where diagonals meet the lattice.
  MCC_INLINE void codeRests() {
    switch (frame_->rests) {
      case 0: break;
      case 1u << 1: codeRest<1>(); break;
      case 1u << 2: codeRest<2>(); break;
      default: codeRest<1>(); codeRest<2>();
    }
  }
  template <uint32_t kAxis>
  MCC_INLINE void codeRest() {
    const int32_t moved = movedTo(grid_, *frame_, kAxis, q_[frame_->first]);
    const uint32_t rounded = base_[kAxis] + wrapped(moved) + 128;
    const int32_t fraction = static_cast<int32_t>(rounded & 255) - 128;
    const uint32_t near = wrapped(static_cast<int32_t>(rounded) >> 8);
    TokenRow& row = models_.rest[std::min(std::abs(fraction) >> 5, 3)];
    const int32_t target = Io::kEncoding ? static_cast<int32_t>(wrapped(truth_[kAxis]) - near) : 0;
    const int32_t rest =
        codeResidual<kAxis>(io_, row, 0, ~0u, fraction < 0 ? 1 : 0, target, std::true_type{});
    q_[kAxis] = static_cast<int32_t>(near + wrapped(rest));
  }

  MCC_INLINE void store(VertexRecord& record) const {
    const Lanes<int32_t> q = {q_[0], q_[1], q_[2], kKnown};
    const Lanes<uint32_t> off = absoluteLanes((lanesAs<uint32_t>(q) << 8) - q8_) >> 5;
    const float across = std::fabs(distance_) * (1 / (16 * size_ + kTiny));
    const Lanes<uint32_t> magnitudes = {
        wrapped(static_cast<int32_t>(std::min(across, kLargestScale))), frame_->between,
        std::min(off[0] + off[1] + off[2], 1u << 22), record.degree()};
    storeLanes<uint32_t>(magnitudes, record.magnitude);
    storeLanes<int32_t>(q, record.q);
  }

  // --- encoder ---

  /// Returns the line nearest to the truth.
  int32_t lineOf(const GridPlanes::Frame& frame, uint32_t s) const {
    const int32_t start = truth_[s] * 256 - movedTo(grid_, frame, s, truth_[frame.first]);
    const float rank = (static_cast<float>(start) - grid_.origin[s]) * grid_.inverse_step[s];
    return static_cast<int32_t>(std::floor(rank / 256 + 0.5f));
  }
  bool isNearLine(const GridPlanes::Frame& frame, uint32_t s) const {
    const int32_t from = grid_.axis[s].q8At(lineOf(frame, s));
    const int32_t near = (from + movedTo(grid_, frame, s, truth_[frame.first]) + 128) >> 8;
    return std::abs(truth_[s] - near) <= kMaxRest;
  }
  uint32_t findKind() const {
    uint32_t between = 0;
    for (uint32_t s = 0; s < 3; ++s) {
      if (grid_.axis[s].at(grid_.axis[s].below(truth_[s])) != truth_[s]) between |= 1u << s;
    }
    uint32_t kind = 0;  // on planes of all axes, if nothing else fits
    for (uint32_t k = 0; k < kTokenCount; ++k) {
      const GridPlanes::Frame& frame = grid_.frame[k];
      bool fits = frame.between == between;
      for (uint32_t s = 0; s < 3; ++s) {
        if ((frame.rests >> s & 1) != 0) fits = fits && isNearLine(frame, s);
      }
      if (!fits) continue;
      kind = k;
      if (frame.rests != 0) break;  // takes the first diagonal that fits
    }
    return kind;
  }
  /// Finds the numbers that codeNumbers() has to code; sets q_ to the truth.
  void findTargets(const Lanes<int32_t>& near, int32_t* target) {
    for (uint32_t s = 0; s < 3; ++s) {
      q_[s] = (frame_->rests >> s & 1) != 0 ? lineOf(*frame_, s)
              : frame_->on_planes[s] != 0   ? grid_.axis[s].below(truth_[s])
                                            : truth_[s];
      target[s] = q_[s] - near[s];
    }
    placeRanks();
    for (uint32_t i = 0; i < frame_->moving_count; ++i) {
      target[order_[i]] -= shift(i);
      learn(order_[i]);
    }
  }

  static constexpr uint32_t kLaneMasks[3][4] = {{~0u, 0, 0, 0}, {0, ~0u, 0, 0}, {0, 0, ~0u, 0}};

  Io& io_;
  TokenRow* const rows_;
  PlaneModels& models_;
  const GridPlanes& grid_;
  const int32_t* truth_ = nullptr;
  const Lanes<uint32_t> q8_;
  const Lanes<float> spread_;
  const Lanes<float> normals_;
  const float across_;  ///< expected distance from the tangent plane, in 1/16, like all scales
  const float along_;   ///< expected movement of an axis within the tangent plane
  float size_;          ///< length of the normal
  float doubt_;
  const GridPlanes::Frame* frame_ = nullptr;
  Lanes<float> at_;  ///< the prediction, where the line begins
  Lanes<uint32_t> expected_;
  float normal_[4];  ///< the normal, adapted to the line
  const uint8_t* order_ = nullptr;
  float slope_[3];
  /// Distance of what is known so far from the tangent plane, times the normal's length.
  float distance_ = 0;
  uint32_t base_[4];  ///< positions of planes and lines, in Q8
  int32_t q_[4];
};

}  // namespace mcc

#endif  // MCC_POSITIONS_PLANE_VERTEX_H_
