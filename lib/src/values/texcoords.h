// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Texture coordinates, predicted from the faces a wedge completes and from the decoded
// positions. [A.10.11]
//
//        o            The wedge v completes the face v, n, p. If the face across n-p is in the same
//       / \           chart and known, it predicts v by
//      n - p            diagonal  the parallelogram u_n + u_p - u_o over the longest of the edges
//       \ /                       n-p (exact on grids), or by
//        v              hinge     its affine map from space to the chart, unfolded over the edge
//                                 n-p; without o, a map of the triangle v, n, p that keeps its
//                                 shape. The weighted mean over all faces is taken.
//
// Optionally, third corners of faces are remembered by the values at the other two: charts that are
// used twice, mirrored ones too, cost a flag per vertex.
#ifndef MCC_VALUES_TEXCOORDS_H_
#define MCC_VALUES_TEXCOORDS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "format/predictors.h"
#include "surface/face_pass.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"
#include "values/mate_values.h"
#include "values/residuals.h"
#include "values/value_memory.h"

namespace mcc {

struct TexcoordModels {
  TokenRow row[2][kLengthContexts];
  MemoryModels memory;
  MateModels mates;

  TexcoordModels() {
    for (auto& component : row) {
      for (TokenRow& r : component) r.setUniform();
    }
  }
};

using TexcoordMemory = ValueMemory<2, false>;

/// Difference of two coordinates as a float; the subtraction wraps.
inline float coordinateDifference(int32_t a, int32_t b) {
  return static_cast<float>(
      static_cast<int32_t>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b)));
}

/// Codes pairs of integers, two per wedge.
template <class Io>
class TexcoordCoder {
 public:
  /// `mates` and `memory`, which has been started with the values, are null if the predictor does
  /// not ask for them.
  TexcoordCoder(const AttributeJob<Io>& job, TexcoordModels& models, const WedgeMates* mates,
                TexcoordMemory* memory)
      : job_(job),
        models_(models),
        is_hinge_((job.info.predictor & texcoord_method::kHinge) != 0),
        mates_(job, models.mates, mates),
        memory_(memory) {}

  void run() {
    forEachGroup<2>(
        job_, Ahead<float>{job_.positions, 4}, [this](uint32_t w) { codeGroup(w); },
        [this](uint32_t w) {
          if (memory_ != nullptr) memory_->learnGroup(job_, w);
        });
  }

 private:
  static constexpr uint32_t kOneNeighbour = kLongestContext;
  static constexpr uint32_t kFaceLimit = 4;  ///< faces looked at: lanes of a Float4
  static constexpr float kSteepest =
      36;  ///< square of the largest ratio of heights a hinge unfolds

  /// Completed faces whose other corners are coded; `o` is the corner beyond n-p, or n when that is
  /// not known. [A.10.11]
  struct Faces {
    uint32_t count = 0;
    uint32_t n[kFaceLimit];
    uint32_t p[kFaceLimit];
    uint32_t o[kFaceLimit];
  };

  /// What the faces predict, relative to the value of the first one's n.
  struct Prediction {
    float u[2] = {0, 0};
  };

  const int32_t* at(uint32_t w) const { return job_.values + 2 * size_t{w}; }

  void codeGroup(uint32_t w);
  Faces completedFaces(uint32_t w) const;
  Prediction predictByDiagonal(const Faces& faces) const;
  Prediction predictByHinge(uint32_t v, const Faces& faces) const;
  bool codeMate(uint32_t w);
  bool codeKnown(uint32_t w, const Faces& faces);
  void predictFrom(uint32_t w, const Faces& faces, int32_t* predicted) const;
  void learnSide(uint32_t w, uint32_t n, uint32_t p);
  void codePair(uint32_t w, const int32_t* predicted, uint32_t context);

  const AttributeJob<Io> job_;
  TexcoordModels& models_;
  const bool is_hinge_;
  MateValues<Io> mates_;
  TexcoordMemory* const memory_;
  float side_ = 1;  ///< of the chart a face's tip lies on: 1 left of its edge, as in the last face
  int32_t last_[2] = {};
};

template <class Io>
MCC_INLINE typename TexcoordCoder<Io>::Faces TexcoordCoder<Io>::completedFaces(uint32_t w) const {
  const FaceView& view = job_.wedges.faces;
  Faces faces;
  job_.forFaces(w, [&](uint32_t h) MCC_INLINE_LAMBDA {
    const uint32_t across = nextHalfEdge(h);
    const uint32_t n = view.vertex(across);
    const uint32_t p = view.vertex(prevHalfEdge(h));
    if (!job_.isCoded(n) || !job_.isCoded(p)) return true;  // on the same vertex
    uint32_t o = n;
    const uint32_t t = view.twin(across);
    if (t != kNone && view.vertex(t) == p && view.vertex(nextHalfEdge(t)) == n) {
      const uint32_t beyond = view.vertex(prevHalfEdge(t));
      o = job_.isCoded(beyond) ? beyond : n;
    }
    faces.n[faces.count] = n;
    faces.p[faces.count] = p;
    faces.o[faces.count++] = o;
    return faces.count < kFaceLimit;
  });
  return faces;
}

/// [A.10.11]
template <class Io>
typename TexcoordCoder<Io>::Prediction TexcoordCoder<Io>::predictByDiagonal(
    const Faces& faces) const {
  Prediction prediction;
  float longest = -1;
  const int32_t* origin = at(faces.n[0]);
  for (uint32_t i = 0; i < faces.count; ++i) {
    if (faces.o[i] == faces.n[i]) continue;
    const float length = squaredDistance(job_.positions, faces.n[i], faces.p[i]);
    if (length <= longest) continue;
    longest = length;
    for (int c = 0; c < 2; ++c) {
      prediction.u[c] = coordinateDifference(at(faces.n[i])[c], origin[c]) +
                        coordinateDifference(at(faces.p[i])[c], at(faces.o[i])[c]);
    }
  }
  return prediction;
}

/// All faces at once, a lane each. [A.10.11]
template <class Io>
typename TexcoordCoder<Io>::Prediction TexcoordCoder<Io>::predictByHinge(uint32_t v,
                                                                         const Faces& faces) const {
  Float4 e[4];  // rows, then columns: from n to p, to v, to o
  Float4 d[4];
  Float4 f[4];
  const int32_t* un[4];
  const int32_t* up[4];
  const int32_t* uo[4];
  const Float4 pv = loadFloat4(job_.positions + 4 * size_t{v});
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t k = i < faces.count ? i : 0;
    const Float4 pn = loadFloat4(job_.positions + 4 * size_t{faces.n[k]});
    e[i] = loadFloat4(job_.positions + 4 * size_t{faces.p[k]}) - pn;
    d[i] = pv - pn;
    f[i] = loadFloat4(job_.positions + 4 * size_t{faces.o[k]}) - pn;
    un[i] = at(faces.n[k]);
    up[i] = at(faces.p[k]);
    uo[i] = at(faces.o[k]);
  }
  transpose(e[0], e[1], e[2], e[3]);
  transpose(d[0], d[1], d[2], d[3]);
  transpose(f[0], f[1], f[2], f[3]);
  const Float4 zero = allLanes(0.0f);
  const Float4 one = allLanes(1.0f);
  const Float4 ee = dotProduct(e, e);
  const Float4 inverse = one / ee;
  const Float4 ed = dotProduct(e, d);
  const Float4 s = ed * inverse;
  const Float4 height = higher(dotProduct(d, d) - s * ed, zero);
  const Float4 ef = dotProduct(e, f);
  const Float4 so = ef * inverse;
  const Float4 height_o = dotProduct(f, f) - so * ef;

  const int32_t* origin = un[0];
  Float4 x, y, du, dv, ou, ov;
  splitPairs(pairDifferences(un[0], origin, un[1], origin),
             pairDifferences(un[2], origin, un[3], origin), x, y);
  splitPairs(pairDifferences(up[0], un[0], up[1], un[1]),
             pairDifferences(up[2], un[2], up[3], un[3]), du, dv);
  splitPairs(pairDifferences(uo[0], un[0], uo[1], un[1]),
             pairDifferences(uo[2], un[2], uo[3], un[3]), ou, ov);

  const Float4 turn = du * ov - dv * ou;
  Float4 side = select(turn < zero, one, allLanes(side_));
  side = select(turn > zero, allLanes(-1.0f), side);
  const Float4 k = side * squareRoot(height * inverse);
  Float4 across_u = zero - k * dv;
  Float4 across_v = k * du;
  Float4 weight = allLanes(0.25f);
  const Mask4 unfolds = height < allLanes(kSteepest) * height_o;  // never when o is n
  const Float4 ratio2 = height / height_o;
  const Float4 ratio = squareRoot(ratio2);
  across_u = select(unfolds, ratio * (so * du - ou), across_u);
  across_v = select(unfolds, ratio * (so * dv - ov), across_v);
  weight = select(unfolds, one / (one + ratio2), weight);
  const Float4 count = allLanes(static_cast<float>(faces.count));
  const Mask4 is_face = (ee > zero) & (Float4{0.0f, 1.0f, 2.0f, 3.0f} < count);
  weight = select(is_face, weight, zero);
  Float4 rows[4] = {select(is_face, weight * (x + s * du + across_u), zero),
                    select(is_face, weight * (y + s * dv + across_v), zero), weight, zero};
  transpose(rows[0], rows[1], rows[2], rows[3]);
  const Float4 sum = (rows[0] + rows[1]) + (rows[2] + rows[3]);
  Prediction prediction;
  if (sum[2] > 0) {
    const float scale = 1.0f / sum[2];
    prediction.u[0] = sum[0] * scale;
    prediction.u[1] = sum[1] * scale;
  }
  return prediction;
}

/// Adds what the faces predict to the value of the first one's n.
template <class Io>
MCC_SHARED void TexcoordCoder<Io>::predictFrom(uint32_t w, const Faces& faces,
                                               int32_t* predicted) const {
  const Prediction prediction = is_hinge_ ? predictByHinge(w, faces) : predictByDiagonal(faces);
  for (int c = 0; c < 2; ++c) {
    const float delta = prediction.u[c];
    if (!(std::fabs(delta) < 1e9f)) continue;  // wild values, NaN
    const int32_t step = static_cast<int32_t>(delta + std::copysign(0.5f, delta));
    predicted[c] =
        static_cast<int32_t>(static_cast<uint32_t>(predicted[c]) + static_cast<uint32_t>(step));
  }
}

/// Whether the value is that of a mate; it is then in place.
template <class Io>
bool TexcoordCoder<Io>::codeMate(uint32_t w) {
  const auto same = [](uint32_t, const int32_t* value, int32_t* to) { std::copy_n(value, 2, to); };
  if (!mates_.code(w, same)) return false;
  std::copy(at(w), at(w) + 2, last_);
  return true;
}

/// Whether the value is one that stood beside those of the first face before; it is then in place.
template <class Io>
bool TexcoordCoder<Io>::codeKnown(uint32_t w, const Faces& faces) {
  const uint32_t o = faces.o[0] == faces.n[0] ? kNone : faces.o[0];
  memory_->begin();
  const uint32_t k = memory_->ask(
      job_.io, models_.memory, memory_->edgeKey(faces.n[0], faces.p[0]), o,
      [=, this](uint32_t other) { return std::equal(at(other), at(other) + 2, at(w)); });
  if (k == kNone) return false;
  storePair(job_.values + 2 * size_t{w}, at(k));
  std::copy(at(w), at(w) + 2, last_);
  return true;
}

template <class Io>
void TexcoordCoder<Io>::codeGroup(uint32_t w) {
  const Faces faces = completedFaces(w);
  const bool has_faces = faces.count != 0;
  const uint32_t n = has_faces ? faces.n[0] : job_.neighbourAlongRun(w);
  uint32_t context = n == kNone ? kNoNeighbours : kOneNeighbour;
  if (has_faces) context = job_.contextOf(n, faces.p[0]);
  if (codeMate(w) || (memory_ != nullptr && has_faces && codeKnown(w, faces))) {
    job_.lengths[w] = static_cast<uint8_t>(context);
  } else {
    int32_t predicted[2] = {last_[0], last_[1]};
    if (n != kNone) std::copy(at(n), at(n) + 2, predicted);
    if (has_faces) predictFrom(w, faces, predicted);
    codePair(w, predicted, context);
  }
  if (has_faces && is_hinge_) learnSide(w, n, faces.p[0]);
}

template <class Io>
void TexcoordCoder<Io>::learnSide(uint32_t w, uint32_t n, uint32_t p) {
  const int32_t* un = at(n);
  const float turn = coordinateDifference(at(p)[0], un[0]) * coordinateDifference(at(w)[1], un[1]) -
                     coordinateDifference(at(p)[1], un[1]) * coordinateDifference(at(w)[0], un[0]);
  // Branches, which are predicted: a select would tie the next prediction to this value.
  if (turn > 0) side_ = 1.0f;
  if (turn < 0) side_ = -1.0f;
}

template <class Io>
MCC_SHARED void TexcoordCoder<Io>::codePair(uint32_t w, const int32_t* predicted,
                                            uint32_t context) {
  int32_t* value = job_.values + 2 * size_t{w};
  int32_t residual[2] = {};
  if constexpr (Io::kEncoding) {
    for (int c = 0; c < 2; ++c) {
      residual[c] = static_cast<int32_t>(static_cast<uint32_t>(value[c]) -
                                         static_cast<uint32_t>(predicted[c]));
    }
  }
  uint32_t length = 0;
  uint32_t second_length = 0;
  residual[0] = codeByLength<0>(job_.io, models_.row[0][context], residual[0], length);
  const uint32_t second = contextAfter(context, length);
  residual[1] = codeByLength<1>(job_.io, models_.row[1][second], residual[1], second_length);
  job_.lengths[w] = static_cast<uint8_t>(std::max(length, second_length));
  for (int c = 0; c < 2; ++c) {
    last_[c] = static_cast<int32_t>(static_cast<uint32_t>(predicted[c]) +
                                    static_cast<uint32_t>(residual[c]));
  }
  storePair(value, last_);
}

}  // namespace mcc

#endif  // MCC_VALUES_TEXCOORDS_H_
