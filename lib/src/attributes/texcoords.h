// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Texture coordinates, predicted from the faces a wedge completes and from the decoded positions.     [A.8.6, B.5]
//
//        o            The wedge v completes the face v, n, p. If the face across n-p is in the same chart and
//       / \           known, it predicts v by
//      n - p            parallelogram  u_n + u_p - u_o
//       \ /             hinge          its affine map from space to the chart, unfolded over the edge n-p
//        v              similarity     a map of the triangle v, n, p that keeps its shape, on the side away from o
//
// The prediction is the weighted mean over all faces the group of equal wedges completes. Optionally residuals that
// followed the same two residuals before are tried first (instances, regular grids).
#ifndef MCC_ATTRIBUTES_TEXCOORDS_H_
#define MCC_ATTRIBUTES_TEXCOORDS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "attributes/face_pass.h"
#include "attributes/residuals.h"
#include "attributes/wedges.h"
#include "mesh/attribute_method.h"

namespace mcc {

enum class TexcoordPredictor : uint8_t {
  kDiagonal = 0,        ///< the parallelogram over the longest of the edges n-p (exact on grids)
  kParallelograms = 1,  ///< mean of all parallelograms
  kSimilarity = 2,
  kHinge = 3,
  kMixed = 4,  ///< mean of hinge and parallelogram
};

struct TexcoordModels {
  TokenRow row[2][kLengthContexts];
  BitModel repeats[4][4];  ///< [confidence][last two outcomes]

  TexcoordModels() {
    for (auto& component : row) {
      for (TokenRow& r : component) r.setUniform();
    }
  }
};

/// Residual pairs by the two pairs before them. [B.5.4]
class ResidualMemory {
 public:
  struct Entry {
    int32_t residual[2];
    uint32_t confidence;  ///< 0..3
  };

  static constexpr uint32_t kEntries = 1024;

  /// `entries`: kEntries zeros, or null for a memory that is never asked.
  explicit ResidualMemory(Entry* entries) : entries_(entries) {}

  const Entry& guess() const { return entries_[key_]; }
  uint32_t history() const { return history_; }
  void noteOutcome(bool hit) { history_ = (history_ << 1 | (hit ? 1u : 0u)) & 3; }

  void learn(const int32_t* residual) {
    Entry& e = entries_[key_];
    if (e.residual[0] == residual[0] && e.residual[1] == residual[1]) {
      e.confidence += e.confidence < 3 ? 1 : 0;
    } else {
      e = Entry{{residual[0], residual[1]}, e.confidence > 1 ? 1u : 0u};
    }
    const uint32_t latest = static_cast<uint32_t>(residual[0]) * 0x9e3779b1u +
                            static_cast<uint32_t>(residual[1]) * 0x85ebca6bu;
    key_ = ((latest * 0xc2b2ae35u) ^ (before_ * 0x27d4eb2fu)) >> 22;
    before_ = latest;
  }

 private:
  Entry* const entries_;
  uint32_t key_ = 0;
  uint32_t before_ = 0;
  uint32_t history_ = 0;
};

/// Difference of two coordinates as a float; the subtraction wraps.
inline float coordinateDifference(int32_t a, int32_t b) {
  return static_cast<float>(
      static_cast<int32_t>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b)));
}

/// Codes pairs of integers, two per wedge.
template <class Io>
class TexcoordCoder {
 public:
  /// Work space: `lengths` a byte per wedge; `memory` ResidualMemory::kEntries entries or null.
  TexcoordCoder(Io& io, TexcoordModels& models, const WedgeMesh& wedges, const EqualGroups& groups,
                const AttributeInfo& info, const float* positions, int32_t* values,
                uint8_t* lengths, ResidualMemory::Entry* memory)
      : io_(io),
        models_(models),
        wedges_(wedges),
        groups_(groups),
        predictor_(
            static_cast<TexcoordPredictor>(info.predictor & texcoord_method::kPredictorMask)),
        positions_(positions),
        values_(values),
        lengths_(lengths),
        repeats_(memory != nullptr),
        memory_(memory) {}

  void run() {
    std::fill(lengths_, lengths_ + wedges_.count, kNotCoded);
    for (uint32_t i = 0; i < wedges_.surfaceEnd(); ++i) {
      const uint32_t w = wedges_.wedgeAt(i);
      wedges_.prefetch(i, positions_, 4);
      if (groups_.isFirst(w)) codeGroup(w);
    }
    for (uint32_t w = wedges_.surface_count; w < wedges_.coded_count; ++w)
      codePair(w, last_, kNoNeighbours);
  }

 private:
  static constexpr uint32_t kOneNeighbour = 10;  ///< context
  static constexpr uint32_t kFaceLimit = 4;      ///< faces looked at: lanes of a Float4
  static constexpr float kSteepest =
      36;  ///< square of the largest ratio of heights a hinge unfolds

  /// Completed faces whose other corners are coded; `o` is the corner behind n-p, or n when that is not known. [B.5.1]
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

  const int32_t* at(uint32_t w) const { return values_ + 2 * size_t{w}; }
  bool coded(uint32_t w) const { return lengths_[w] != kNotCoded; }

  void codeGroup(uint32_t w);
  Faces completedFaces(uint32_t w) const;
  Prediction predictByParallelograms(const Faces& faces) const;
  Prediction predictByGeometry(uint32_t v, const Faces& faces) const;
  void learnSide(uint32_t w, uint32_t n, uint32_t p);
  uint32_t codedNeighbour(uint32_t w) const;
  void codePair(uint32_t w, const int32_t* predicted, uint32_t context);

  Io& io_;
  TexcoordModels& models_;
  const WedgeMesh& wedges_;
  const EqualGroups& groups_;
  const TexcoordPredictor predictor_;
  const float* const positions_;
  int32_t* const values_;
  uint8_t* const lengths_;
  const bool repeats_;
  ResidualMemory memory_;
  float side_ = 1;  ///< of the chart a face's tip lies on: 1 left of its edge, as in the last face
  int32_t last_[2] = {};
};

template <class Io>
MCC_INLINE typename TexcoordCoder<Io>::Faces TexcoordCoder<Io>::completedFaces(uint32_t w) const {
  const FaceView& view = wedges_.faces;
  Faces faces;
  for (uint32_t m = w; m != kNone; m = groups_.nextOf(m)) {
    for (uint32_t h = wedges_.firstCompleted(m); h != kNone; h = wedges_.nextCompleted(h)) {
      if (faces.count == kFaceLimit) return faces;
      const uint32_t across = nextHalfEdge(h);
      const uint32_t n = view.vertex(across);
      const uint32_t p = view.vertex(prevHalfEdge(h));
      if (!coded(n) || !coded(p)) continue;  // on the same vertex
      uint32_t o = n;
      const uint32_t t = view.twin(across);
      if (t != kNone && view.vertex(t) == p && view.vertex(nextHalfEdge(t)) == n) {
        const uint32_t behind = view.vertex(prevHalfEdge(t));
        o = coded(behind) ? behind : n;
      }
      faces.n[faces.count] = n;
      faces.p[faces.count] = p;
      faces.o[faces.count++] = o;
    }
  }
  return faces;
}

/// Their mean, or the one over the longest edge. [B.5.3]
template <class Io>
typename TexcoordCoder<Io>::Prediction TexcoordCoder<Io>::predictByParallelograms(
    const Faces& faces) const {
  Prediction sum;
  float count = 0;
  float longest = -1;
  const int32_t* origin = at(faces.n[0]);
  for (uint32_t i = 0; i < faces.count; ++i) {
    if (faces.o[i] == faces.n[i]) continue;
    if (predictor_ == TexcoordPredictor::kDiagonal) {
      const float length = squaredDistance(positions_, faces.n[i], faces.p[i]);
      if (length <= longest) continue;
      longest = length;
      sum = Prediction{};
      count = 0;
    }
    for (int c = 0; c < 2; ++c) {
      sum.u[c] += coordinateDifference(at(faces.n[i])[c], origin[c]) +
                  coordinateDifference(at(faces.p[i])[c], at(faces.o[i])[c]);
    }
    count += 1;
  }
  if (count > 1) {
    for (float& u : sum.u) u /= count;
  }
  return sum;
}

/// All faces at once, a lane each. [B.5.2]
template <class Io>
typename TexcoordCoder<Io>::Prediction TexcoordCoder<Io>::predictByGeometry(
    uint32_t v, const Faces& faces) const {
  Float4 e[4];  // rows, then columns: from n to p, to v, to o
  Float4 d[4];
  Float4 f[4];
  const int32_t* un[4];
  const int32_t* up[4];
  const int32_t* uo[4];
  const Float4 pv = loadFloat4(positions_ + 4 * size_t{v});
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t k = i < faces.count ? i : 0;
    const Float4 pn = loadFloat4(positions_ + 4 * size_t{faces.n[k]});
    e[i] = loadFloat4(positions_ + 4 * size_t{faces.p[k]}) - pn;
    d[i] = pv - pn;
    f[i] = loadFloat4(positions_ + 4 * size_t{faces.o[k]}) - pn;
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
  if (predictor_ != TexcoordPredictor::kSimilarity) {
    const Mask4 unfolds = height < allLanes(kSteepest) * height_o;  // never when o is n
    const Float4 ratio2 = height / height_o;
    const Float4 ratio = squareRoot(ratio2);
    across_u = select(unfolds, ratio * (so * du - ou), across_u);
    across_v = select(unfolds, ratio * (so * dv - ov), across_v);
    weight = select(unfolds, one / (one + ratio2), weight);
  }
  const Float4 count = allLanes(static_cast<float>(faces.count));
  const Mask4 is_face = (ee > zero) & (Float4{0.0f, 1.0f, 2.0f, 3.0f} < count);
  weight = select(is_face, weight, zero);
  Float4 rows[4] = {select(is_face, weight * (x + s * du + across_u), zero),
                    select(is_face, weight * (y + s * dv + across_v), zero), weight, zero};
  if (predictor_ == TexcoordPredictor::kMixed) {
    const Mask4 has_o = (dotProduct(f, f) > zero) & is_face;
    const Float4 half = select(has_o, allLanes(0.5f), zero);
    rows[0] = rows[0] + half * (x + du - ou);
    rows[1] = rows[1] + half * (y + dv - ov);
    rows[2] = rows[2] + half;
  }
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

template <class Io>
void TexcoordCoder<Io>::codeGroup(uint32_t w) {
  const Faces faces = completedFaces(w);
  const bool has_faces = faces.count != 0;
  const uint32_t n = has_faces ? faces.n[0] : codedNeighbour(w);
  uint32_t context = n == kNone ? kNoNeighbours : kOneNeighbour;
  int32_t predicted[2] = {last_[0], last_[1]};
  if (n != kNone) std::copy(at(n), at(n) + 2, predicted);
  if (has_faces) {
    context = std::min((lengths_[n] + lengths_[faces.p[0]] + 1u) / 2, kOneNeighbour);
    const Prediction prediction = predictor_ < TexcoordPredictor::kSimilarity
                                      ? predictByParallelograms(faces)
                                      : predictByGeometry(w, faces);
    for (int c = 0; c < 2; ++c) {
      const float delta = prediction.u[c];
      if (!(std::fabs(delta) < 1e9f)) continue;  // wild values, NaN
      const int32_t step = static_cast<int32_t>(delta + std::copysign(0.5f, delta));
      predicted[c] =
          static_cast<int32_t>(static_cast<uint32_t>(predicted[c]) + static_cast<uint32_t>(step));
    }
  }
  codePair(w, predicted, context);
  if (has_faces && predictor_ >= TexcoordPredictor::kSimilarity) learnSide(w, n, faces.p[0]);
  for (uint32_t m = groups_.nextOf(w); m != kNone; m = groups_.nextOf(m)) {
    storePair(values_ + 2 * size_t{m}, at(w));
    lengths_[m] = lengths_[w];
  }
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

/// Some neighbour of the wedge that is coded, for wedges without a completed face.
template <class Io>
uint32_t TexcoordCoder<Io>::codedNeighbour(uint32_t w) const {
  uint32_t found = kNone;
  wedges_.forRun(w, [&](uint32_t h) {
    const uint32_t n = wedges_.faces.vertex(nextHalfEdge(h));
    const uint32_t p = wedges_.faces.vertex(prevHalfEdge(h));
    if (coded(n)) found = n;
    if (coded(p)) found = p;
    return found == kNone;
  });
  return found;
}

template <class Io>
void TexcoordCoder<Io>::codePair(uint32_t w, const int32_t* predicted, uint32_t context) {
  int32_t* value = values_ + 2 * size_t{w};
  int32_t residual[2] = {};
  if constexpr (Io::kEncoding) {
    for (int c = 0; c < 2; ++c) {
      residual[c] = static_cast<int32_t>(static_cast<uint32_t>(value[c]) -
                                         static_cast<uint32_t>(predicted[c]));
    }
  }
  bool hit = false;
  uint32_t longest = 0;
  if (repeats_ && memory_.guess().confidence != 0) {
    const ResidualMemory::Entry& guess = memory_.guess();
    hit = io_.bit(
        models_.repeats[guess.confidence][memory_.history()],
        Io::kEncoding && residual[0] == guess.residual[0] && residual[1] == guess.residual[1]);
    memory_.noteOutcome(hit);
    if (hit) {
      residual[0] = guess.residual[0];
      residual[1] = guess.residual[1];
      longest = std::max(contextLength(residual[0]), contextLength(residual[1]));
    }
  }
  if (!hit) {
    uint32_t length = 0;
    uint32_t second_length = 0;
    residual[0] = codeByLength<0>(io_, models_.row[0][context], residual[0], length);
    const uint32_t second = context == kNoNeighbours ? context : (context + length + 1) / 2;
    residual[1] = codeByLength<1>(io_, models_.row[1][second], residual[1], second_length);
    longest = std::max(length, second_length);
  }
  if (repeats_) memory_.learn(residual);
  lengths_[w] = static_cast<uint8_t>(longest);
  for (int c = 0; c < 2; ++c) {
    last_[c] = static_cast<int32_t>(static_cast<uint32_t>(predicted[c]) +
                                    static_cast<uint32_t>(residual[c]));
  }
  storePair(value, last_);
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_TEXCOORDS_H_
