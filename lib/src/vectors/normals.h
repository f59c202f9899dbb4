// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Unit normals on the octahedral grid, predicted from the decoded faces. [A.10.8, A.10.6]
//
// Prediction: the weighted sum of the normals of all faces around a group of equal wedges;
// optionally corrected by what the prediction missed at the two neighbours of the entry face.
// Residual: both grid points are mapped so that the prediction lies near the centre and in one
// quadrant, then subtracted modulo the grid (as in Draco's canonicalised transform).
#ifndef MCC_VECTORS_NORMALS_H_
#define MCC_VECTORS_NORMALS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "format/predictors.h"
#include "mesh/turn.h"
#include "surface/face_pass.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"
#include "values/mate_values.h"
#include "values/residuals.h"
#include "vectors/octahedral.h"

namespace mcc {

/// Weight of a face's normal at a corner.
enum class NormalWeight : uint8_t {
  kArea = 0,   ///< area of the face
  kAngle = 1,  ///< angle at the corner
  kSine = 2,   ///< area over the squared lengths of the corner's sides (Max 1999)
};

struct NormalModels {
  TokenRow row[2][kLengthContexts];
  MateModels mates;

  NormalModels() {
    for (auto& component : row) {
      for (TokenRow& r : component) r.setUniform();
    }
  }
};

MCC_SHARED void addNormalsOfWeight(NormalWeight normal_weight, const WedgeMesh& wedges,
                                   const float* positions, float* sums) {
  forFourFaces(wedges.faces, wedges.face_count, [=](const uint32_t* words, uint32_t count) {
    const FourFaces faces(words, count, positions);
    const Float4 one = allLanes(1.0f);
    const Float4 nn = dotProduct(faces.normal, faces.normal);
    const Mask4 is_face = nn > allLanes(0.0f);  // then all sides are longer than 0
    Float4 weight[3] = {one, one, one};
    if (normal_weight == NormalWeight::kAngle) {
      const Float4 length = squareRoot(nn);
      const Float4 inverse = select(is_face, one / length, allLanes(0.0f));
      faces.cornerAngles(length, weight);
      for (Float4& w : weight) w = w * inverse;
    } else if (normal_weight == NormalWeight::kSine) {
      Float4 e2[3];
      for (int s = 0; s < 3; ++s) e2[s] = faces.e1[s] - faces.e0[s];
      const Float4 q0 = dotProduct(faces.e0, faces.e0);
      const Float4 q1 = dotProduct(faces.e1, faces.e1);
      const Float4 q2 = dotProduct(e2, e2);
      // No product of three, which overflows where faces are as long as the mesh.
      const Float4 zero = allLanes(0.0f);
      weight[0] = select(is_face, one / (q0 * q1), zero);
      weight[1] = select(is_face, one / (q0 * q2), zero);
      weight[2] = select(is_face, one / (q1 * q2), zero);
    }
    Float4 rows[4] = {faces.normal[0], faces.normal[1], faces.normal[2], allLanes(0.0f)};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    CornerSums(faces, count, sums).add(rows, weight, nullptr);
  });
}

/// Adds the weighted normal of every face to its three wedges' sums (4 floats each). [A.10.7]
inline void addFaceNormals(NormalWeight weight, const WedgeMesh& wedges, const float* positions,
                           float* sums) {
  if constexpr (kCompact) return addNormalsOfWeight(weight, wedges, positions, sums);
  switch (weight) {
    case NormalWeight::kArea:
      return addNormalsOfWeight(NormalWeight::kArea, wedges, positions, sums);
    case NormalWeight::kAngle:
      return addNormalsOfWeight(NormalWeight::kAngle, wedges, positions, sums);
    case NormalWeight::kSine:
      return addNormalsOfWeight(NormalWeight::kSine, wedges, positions, sums);
  }
}

/// Sum of the coordinates' absolute values.
inline float manhattanLength(const float* v) {
  return std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]);
}
inline constexpr float kShortest = 1e-30f;  ///< shorter vectors have no direction

/// Grid point, relative to the centre, nearest to the projection of a vector along z; `length`: its
/// manhattanLength(), above kShortest. Vectors with z < 0 are mirrored first. [A.10.6]
inline void projectToGrid(const float* v, float length, int32_t centre, int32_t* point) {
  const float scale = static_cast<float>(centre) / length;
  for (int s = 0; s < 2; ++s) {
    const float scaled = v[s] * scale;  // rounding errors stay below half a step
    point[s] = static_cast<int32_t>(scaled + std::copysign(0.5f, scaled));
  }
}

/// The residual's frame, chosen by the predicted point; maps grid points to and fro. The cases are
/// equally likely, so it is all selects and no branches. [A.10.6]
class OctahedralFrame {
 public:
  /// `inside`: the predicted point or, if that is `turned_over`, its image in the diamond.
  OctahedralFrame(const int32_t* inside, bool turned_over, int32_t centre)
      : centre_(centre), turned_over_(turned_over) {
    // Quarter turns that bring the point to x < 0, y <= 0: signs are flipped, then both swapped.
    const int32_t x = inside[0];
    const int32_t y = inside[1];
    // One turn if y > 0 and x <= 0, two if x > 0 and y >= 0, three if y < 0 and x >= 0. A shift by
    // 31 makes a mask of a sign.
    flip_[0] = ((y >> 31) - x) >> 31;
    flip_[1] = ((-x >> 31) - y) >> 31;
    swap_ = flip_[0] ^ flip_[1];
    p_[0] = -std::abs(x);
    p_[1] = -std::abs(y);
    swapIfOdd(p_);
  }

  static OctahedralFrame around(const int32_t* predicted, int32_t centre) {
    int32_t inside[2] = {predicted[0], predicted[1]};
    const bool turned_over = std::abs(inside[0]) + std::abs(inside[1]) > centre;
    if (turned_over) turnOver(inside, centre);
    return OctahedralFrame(inside, turned_over, centre);
  }

  /// Swaps the inside and the outside of the diamond |x| + |y| = centre.
  static void turnOver(int32_t* p, int32_t centre) {
    const int32_t x = p[0];
    const int32_t y = p[1];
    const int32_t x_negative = (x + (y >> 31)) >> 31;  // or x is 0, and y is negative
    const int32_t y_negative = (y + (x >> 31)) >> 31;
    p[0] = ((centre - std::abs(y)) ^ x_negative) - x_negative;
    p[1] = ((centre - std::abs(x)) ^ y_negative) - y_negative;
  }

  /// Turns a small step from the predicted point as points near it are turned. `step` is seen from
  /// inside the diamond.
  void turnStep(float* step) const {
    for (int k = 0; k < 2; ++k) step[k] = flip_[k] != 0 ? -step[k] : step[k];
    if (swap_ != 0) std::swap(step[0], step[1]);
  }

  void residualOf(const int32_t* point, int32_t* residual) const {
    int32_t p[2] = {point[0], point[1]};
    turnOverIf(turned_over_, p);
    flip(p);
    swapIfOdd(p);
    for (int k = 0; k < 2; ++k) {
      const int32_t distance = p[k] - p_[k];
      residual[k] = distance - (distance > centre_ ? size() : 0);
    }
  }

  /// `residual` may be anything; the point is on the grid.
  void pointOf(const int32_t* residual, int32_t* point) const {
    for (int k = 0; k < 2; ++k) {
      const int32_t sum = p_[k] + std::clamp(residual[k], -centre_, centre_);
      point[k] = sum + (sum < -centre_ ? size() : 0);
    }
    swapIfOdd(point);
    flip(point);
    turnOverIf(turned_over_, point);
  }

 private:
  void flip(int32_t* p) const {
    for (int k = 0; k < 2; ++k) p[k] = (p[k] ^ flip_[k]) - flip_[k];
  }
  void swapIfOdd(int32_t* p) const {
    const int32_t change = (p[0] ^ p[1]) & swap_;
    p[0] ^= change;
    p[1] ^= change;
  }
  void turnOverIf(bool condition, int32_t* p) const {
    int32_t q[2] = {p[0], p[1]};
    turnOver(q, centre_);
    const int32_t change = -int32_t{condition};  // by bits: compilers would branch
    for (int k = 0; k < 2; ++k) p[k] ^= (p[k] ^ q[k]) & change;
  }
  int32_t size() const { return 2 * centre_ + 1; }

  const int32_t centre_;
  const bool turned_over_;
  int32_t p_[2];     ///< the predicted point turned: -centre_ .. 0, so that sums wrap on one side
  int32_t flip_[2];  ///< all ones: the sign of the coordinate changes
  int32_t swap_;     ///< all ones: the coordinates are swapped, at odd numbers of quarter turns
};

/// One of the up to four grid points that stand for the same direction on the border. Writers store
/// only it.
inline void canonicalGridPoint(int32_t centre, int32_t* point) {
  int32_t p[2] = {point[0] - centre, point[1] - centre};
  if (std::abs(p[0]) != centre && std::abs(p[1]) != centre) return;
  OctahedralFrame::turnOver(p, centre);
  OctahedralFrame::turnOver(p, centre);
  point[0] = p[0] + centre;
  point[1] = p[1] + centre;
}

/// The grid point that stands for the direction of `value`, turned. [A.10.20]
inline void turnGridPoint(int32_t centre, Turn turn, const int32_t* value, int32_t* to) {
  int32_t p[3] = {value[0] - centre, value[1] - centre, 0};
  p[2] = centre - std::abs(p[0]) - std::abs(p[1]);
  if (p[2] < 0) OctahedralFrame::turnOver(p, centre);
  const uint8_t* const from = kAxisOrder[turn >> 3];
  int32_t q[3];
  for (uint32_t s = 0; s < 3; ++s) q[s] = (turn >> s & 1) != 0 ? -p[from[s]] : p[from[s]];
  if (q[2] < 0) OctahedralFrame::turnOver(q, centre);
  for (int s = 0; s < 2; ++s) to[s] = q[s] + centre;
}

/// Codes a grid point `value` in 0..2*centre; `point`: relative to the centre. `context`: up to
/// kNoNeighbours. [A.10.8]
template <class Io>
MCC_INLINE void codeGridPoint(Io& io, TokenRow (&rows)[2][kLengthContexts],
                              const OctahedralFrame& frame, int32_t centre, uint32_t context,
                              int32_t* value, uint8_t& longest, int32_t* point) {
  int32_t residual[2] = {};
  int32_t p[2] = {};
  if constexpr (Io::kEncoding) {
    p[0] = value[0] - centre;
    p[1] = value[1] - centre;
    frame.residualOf(p, residual);
  }
  uint32_t length = 0;
  uint32_t second_length = 0;
  residual[0] = codeSmallSigned<0>(io, rows[0][context], residual[0], length);
  const uint32_t second = context == kNoNeighbours ? length : contextAfter(context, length);
  residual[1] = codeSmallSigned<1>(io, rows[1][second], residual[1], second_length);
  longest = static_cast<uint8_t>(std::max(length, second_length));
  frame.pointOf(residual, p);
  for (int s = 0; s < 2; ++s) {
    value[s] = static_cast<int32_t>(static_cast<uint32_t>(p[s]) + static_cast<uint32_t>(centre));
    point[s] = p[s];
  }
}

/// Codes grid points (s, t) in 0..2*centre, two per wedge.
template <class Io>
class NormalCoder {
 public:
  /// `mates` is null if the predictor does not ask for them. `sums` is work space, 4 floats per
  /// wedge.
  NormalCoder(const AttributeJob<Io>& job, NormalModels& models, const WedgeMates* mates,
              float* sums)
      : job_(job),
        models_(models),
        mates_(job, models.mates, mates),
        weight_(static_cast<NormalWeight>(job.info.predictor & normal_method::kWeightMask)),
        blends_((job.info.predictor & normal_method::kBlend) != 0),
        centre_(octahedralCentre(job.info.bits)),
        scale_(1.0f / static_cast<float>(centre_)),
        sums_(sums) {}

  void run() {
    std::fill(sums_, sums_ + 4 * size_t{job_.wedges.count}, 0.0f);
    addFaceNormals(weight_, job_.wedges, job_.positions, sums_);
    forEachGroup<2>(
        job_, Ahead<float>{sums_, 4}, [this](uint32_t w) { codeGroup(w); },
        [this](uint32_t w) {
          if (blends_) copyMissed(w);
        });
  }

 private:
  static constexpr float kBlendPart = 0.25f;  ///< of what both neighbours' predictions missed

  float* sum(uint32_t w) { return sums_ + 4 * size_t{w}; }

  void codeGroup(uint32_t w);
  void copyMissed(uint32_t w) {
    for (uint32_t m = job_.groups.nextOf(w); m != kNone; m = job_.groups.nextOf(m)) {
      std::copy_n(sum(w), 3, sum(m));
    }
  }
  void codePoint(uint32_t w, const OctahedralFrame& frame, uint32_t context);
  bool codeMate(uint32_t w);

  const AttributeJob<Io> job_;
  NormalModels& models_;
  MateValues<Io> mates_;
  const NormalWeight weight_;
  const bool blends_;
  const int32_t centre_;
  const float scale_;
  float* const sums_;  ///< of faces; once a wedge is coded: what its prediction missed, if blending
  int32_t last_[2] = {};
};

template <class Io>
void NormalCoder<Io>::codeGroup(uint32_t w) {
  float direction[3] = {sum(w)[0], sum(w)[1], sum(w)[2]};
  for (uint32_t m = job_.groups.nextOf(w); m != kNone; m = job_.groups.nextOf(m)) {
    for (int s = 0; s < 3; ++s) direction[s] += sum(m)[s];
  }
  const uint32_t entry = job_.entryFace(w);
  float length = manhattanLength(direction);
  uint32_t context = kNoNeighbours;
  float used[3] = {direction[0], direction[1], direction[2]};
  if (blends_) {
    const float inverse = length > kShortest ? 1.0f / length : 0.0f;
    for (int s = 0; s < 3; ++s) used[s] = direction[s] = direction[s] * inverse;
  }
  if (entry != kNone) {
    const auto [n, p] = job_.othersOf(entry);
    context = job_.contextOf(n, p);
    if (blends_) {
      for (int s = 0; s < 3; ++s) used[s] = direction[s] + kBlendPart * (sum(n)[s] + sum(p)[s]);
    }
  }
  if (blends_) length = manhattanLength(used);
  if (codeMate(w)) {
    job_.lengths[w] = static_cast<uint8_t>(context);
  } else if (length > kShortest) [[likely]] {
    int32_t inside[2];
    projectToGrid(used, length, centre_, inside);
    codePoint(w, OctahedralFrame(inside, used[2] < 0, centre_), context);
  } else {
    codePoint(w, OctahedralFrame::around(last_, centre_), context);
  }
  if (blends_) {
    float missed[4] = {0, 0, 0, 0};
    foldToOctahedron(static_cast<float>(last_[0]) * scale_, static_cast<float>(last_[1]) * scale_,
                     missed);
    for (int s = 0; s < 3; ++s) sum(w)[s] = missed[s] - direction[s];
  }
}

/// Whether the point is the image of a mate's; it is then in place.
template <class Io>
bool NormalCoder<Io>::codeMate(uint32_t w) {
  const auto turned = [this](Turn turn, const int32_t* value, int32_t* to) {
    turnGridPoint(centre_, turn, value, to);
  };
  if (!mates_.code(w, turned)) return false;
  for (uint32_t s = 0; s < 2; ++s) last_[s] = job_.values[2 * size_t{w} + s] - centre_;
  return true;
}

template <class Io>
MCC_SHARED void NormalCoder<Io>::codePoint(uint32_t w, const OctahedralFrame& frame,
                                           uint32_t context) {
  codeGridPoint(job_.io, models_.row, frame, centre_, context, job_.values + 2 * size_t{w},
                job_.lengths[w], last_);
}

}  // namespace mcc

#endif  // MCC_VECTORS_NORMALS_H_
