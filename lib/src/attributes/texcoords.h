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
    for (uint32_t i = 0; i < wedges_.surface_count; ++i) {
      const uint32_t w = wedges_.wedgeAt(i);
      if (groups_.isFirst(w)) codeGroup(w);
    }
    for (uint32_t w = wedges_.surface_count; w < wedges_.count; ++w)
      codePair(w, last_, kNoNeighbours);
  }

 private:
  static constexpr uint32_t kOneNeighbour = 10;  ///< context
  static constexpr uint32_t kFaceLimit = 16;     ///< faces looked at
  static constexpr float kSteepest =
      36;  ///< square of the largest ratio of heights a hinge unfolds

  /// A weighted sum of predictions, relative to the value `origin`.
  struct Sum {
    const int32_t* origin = nullptr;
    float u[2] = {0, 0};
    float weight = 0;
    float longest = -1;  ///< squared length of the edge used by kDiagonal
    void set(float x, float y) {
      u[0] = x;
      u[1] = y;
      weight = 1;
    }
    void add(float x, float y, float w) {
      u[0] += w * x;
      u[1] += w * y;
      weight += w;
    }
  };

  const int32_t* at(uint32_t w) const { return values_ + 2 * size_t{w}; }
  bool coded(uint32_t w) const { return lengths_[w] != kNotCoded; }

  void codeGroup(uint32_t w);
  bool isLonger(uint32_t n, uint32_t p, Sum& sum) const;
  void addFace(uint32_t h, Sum& sum);
  void addGeometry(uint32_t v, uint32_t n, uint32_t p, uint32_t o, float x, float y,
                   const float* du, const float* duo, Sum& sum);
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

/// Whether the edge n-p is the longest so far.
template <class Io>
bool TexcoordCoder<Io>::isLonger(uint32_t n, uint32_t p, Sum& sum) const {
  const float length = squaredDistance(positions_, n, p);
  if (length <= sum.longest) return false;
  sum.longest = length;
  return true;
}

/// Adds what the completed face of half-edge h (leaving v) predicts for v.
template <class Io>
void TexcoordCoder<Io>::addFace(uint32_t h, Sum& sum) {
  const FaceView& faces = wedges_.faces;
  const uint32_t across = nextHalfEdge(h);
  const uint32_t n = faces.vertex(across);
  const uint32_t p = faces.vertex(prevHalfEdge(h));
  if (!coded(n) || !coded(p)) return;
  uint32_t o = kNone;
  const uint32_t t = faces.twin(across);
  if (t != kNone && faces.vertex(t) == p && faces.vertex(nextHalfEdge(t)) == n) {
    o = faces.vertex(prevHalfEdge(t));
    if (!coded(o)) o = kNone;
  }
  const int32_t* un = at(n);
  const float du[2] = {coordinateDifference(at(p)[0], un[0]),
                       coordinateDifference(at(p)[1], un[1])};
  const float x = coordinateDifference(un[0], sum.origin[0]);
  const float y = coordinateDifference(un[1], sum.origin[1]);
  float duo[2] = {0, 0};
  if (o != kNone) {
    duo[0] = coordinateDifference(at(o)[0], un[0]);
    duo[1] = coordinateDifference(at(o)[1], un[1]);
  }
  if (predictor_ == TexcoordPredictor::kDiagonal) {
    if (o != kNone && isLonger(n, p, sum)) sum.set(x + du[0] - duo[0], y + du[1] - duo[1]);
    return;
  }
  if (predictor_ == TexcoordPredictor::kParallelograms) {
    if (o != kNone) sum.add(x + du[0] - duo[0], y + du[1] - duo[1], 1);
    return;
  }
  if (predictor_ == TexcoordPredictor::kMixed && o != kNone) {
    sum.add(x + du[0] - duo[0], y + du[1] - duo[1], 0.5f);
  }
  addGeometry(faces.vertex(h), n, p, o, x, y, du, duo, sum);
}

/// (x, y), du, duo: the coordinates of n relative to the sum's origin, of p and o relative to n's. [B.5.2]
template <class Io>
void TexcoordCoder<Io>::addGeometry(uint32_t v, uint32_t n, uint32_t p, uint32_t o, float x,
                                    float y, const float* du, const float* duo, Sum& sum) {
  const float* pn = positions_ + 4 * size_t{n};
  const float* pp = positions_ + 4 * size_t{p};
  const float* pv = positions_ + 4 * size_t{v};
  const float e[3] = {pp[0] - pn[0], pp[1] - pn[1], pp[2] - pn[2]};
  const float d[3] = {pv[0] - pn[0], pv[1] - pn[1], pv[2] - pn[2]};
  const float ee = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
  if (ee == 0) return;
  const float inverse = 1.0f / ee;
  const float ed = e[0] * d[0] + e[1] * d[1] + e[2] * d[2];
  const float s = ed * inverse;
  const float height = std::max(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - s * ed, 0.0f);
  if (o != kNone && predictor_ != TexcoordPredictor::kSimilarity) {
    const float* po = positions_ + 4 * size_t{o};
    const float f[3] = {po[0] - pn[0], po[1] - pn[1], po[2] - pn[2]};
    const float ef = e[0] * f[0] + e[1] * f[1] + e[2] * f[2];
    const float so = ef * inverse;
    const float height_o = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] - so * ef;
    if (height < kSteepest * height_o) {
      const float ratio2 = height / height_o;
      const float ratio = std::sqrt(ratio2);
      sum.add(x + s * du[0] + ratio * (so * du[0] - duo[0]),
              y + s * du[1] + ratio * (so * du[1] - duo[1]), 1.0f / (1.0f + ratio2));
      return;
    }
  }
  float side = side_;
  if (o != kNone) {
    const float turn = du[0] * duo[1] - du[1] * duo[0];
    if (turn != 0) side = turn > 0 ? -1.0f : 1.0f;
  }
  const float k = side * std::sqrt(height * inverse);
  sum.add(x + s * du[0] - k * du[1], y + s * du[1] + k * du[0], 0.25f);
}

template <class Io>
void TexcoordCoder<Io>::codeGroup(uint32_t w) {
  uint32_t entry = kNone;
  uint32_t faces = 0;
  Sum sum;
  for (uint32_t m = w; m != kNone && faces < kFaceLimit; m = groups_.nextOf(m)) {
    for (uint32_t h = wedges_.firstCompleted(m); h != kNone && faces < kFaceLimit;
         h = wedges_.nextCompleted(h)) {
      if (entry == kNone) {
        entry = h;
        sum.origin = at(wedges_.faces.vertex(nextHalfEdge(h)));
      }
      addFace(h, sum);
      ++faces;
    }
  }
  int32_t predicted[2] = {last_[0], last_[1]};
  uint32_t context = kNoNeighbours;
  uint32_t n = kNone;
  if (entry != kNone) {
    n = wedges_.faces.vertex(nextHalfEdge(entry));
    const uint32_t p = wedges_.faces.vertex(prevHalfEdge(entry));
    context = std::min((lengths_[n] + lengths_[p] + 1u) / 2, kOneNeighbour);
  } else {
    n = codedNeighbour(w);
    if (n != kNone) context = kOneNeighbour;
  }
  if (n != kNone) {
    const int32_t* from = entry != kNone ? sum.origin : at(n);
    const float inverse = sum.weight > 0 ? 1.0f / sum.weight : 0.0f;
    for (int c = 0; c < 2; ++c) {
      const float delta = sum.u[c] * inverse;
      predicted[c] = from[c];
      if (std::fabs(delta) < 1e9f) {  // not with wild values, not with NaN
        const int32_t step = static_cast<int32_t>(delta + (delta < 0 ? -0.5f : 0.5f));
        predicted[c] =
            static_cast<int32_t>(static_cast<uint32_t>(from[c]) + static_cast<uint32_t>(step));
      }
    }
  }
  codePair(w, predicted, context);
  if (entry != kNone && predictor_ >= TexcoordPredictor::kSimilarity) {
    const int32_t* un = at(n);
    const int32_t* up = at(wedges_.faces.vertex(prevHalfEdge(entry)));
    const int32_t* uv = at(w);
    const float turn = coordinateDifference(up[0], un[0]) * coordinateDifference(uv[1], un[1]) -
                       coordinateDifference(up[1], un[1]) * coordinateDifference(uv[0], un[0]);
    if (turn != 0) side_ = turn > 0 ? 1.0f : -1.0f;
  }
  for (uint32_t m = groups_.nextOf(w); m != kNone; m = groups_.nextOf(m)) {
    values_[2 * size_t{m}] = at(w)[0];
    values_[2 * size_t{m} + 1] = at(w)[1];
    lengths_[m] = lengths_[w];
  }
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
    value[c] = static_cast<int32_t>(static_cast<uint32_t>(predicted[c]) +
                                    static_cast<uint32_t>(residual[c]));
    last_[c] = value[c];
  }
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_TEXCOORDS_H_
