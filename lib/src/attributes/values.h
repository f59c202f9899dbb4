// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Attributes by parallelograms and means of neighbours: any number of integer components.    [A.8, B.3]
#ifndef MCC_ATTRIBUTES_VALUES_H_
#define MCC_ATTRIBUTES_VALUES_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "attributes/residuals.h"
#include "base/memory.h"
#include "entropy/models.h"
#include "mesh/face_mesh.h"

namespace mcc {

/// Order in which wedges are coded: wedge faces.vertex(sequence[i]) is the i-th, isolated wedges follow.
struct WedgeSequence {
  const uint32_t* half_edges = nullptr;
  uint32_t count = 0;
  uint32_t isolated_first = 0;  ///< wedges that are in no triangle are numbered from here
  uint32_t isolated_count = 0;
};

enum class ValuePredictor : uint8_t { kParallelogram = 0, kMean = 1 };
inline constexpr uint32_t kValuePredictors = 2;

inline constexpr uint32_t kMaxComponents = 16;

struct ValueModels {
  TokenRow row[4][kLengthContexts];  ///< [component, 3 for all further][context]

  ValueModels() {
    for (auto& component : row) {
      for (TokenRow& r : component) r.setUniform();
    }
  }
};

/// Codes `values`, component_count per wedge. `lengths` is work space, one byte per wedge.
template <class Io>
class ValueCoder {
 public:
  ValueCoder(Io& io, ValueModels& models, const FaceView& faces, const WedgeSequence& sequence,
             uint32_t component_count, ValuePredictor predictor, int32_t* values, uint8_t* lengths)
      : io_(io),
        models_(models),
        faces_(faces),
        sequence_(sequence),
        components_(component_count),
        predictor_(predictor),
        values_(values),
        lengths_(lengths) {}

  void run() {
    const uint32_t wedge_count = sequence_.isolated_first + sequence_.isolated_count;
    for (uint32_t w = 0; w < wedge_count; ++w) lengths_[w] = kNotCoded;
    int64_t prediction[kMaxComponents] = {};
    for (uint32_t i = 0; i < sequence_.count; ++i) {
      const uint32_t h = sequence_.half_edges[i];
      const uint32_t w = faces_.vertex(h);
      const uint32_t context = predict(h, w, prediction);
      code(w, prediction, context);
    }
    for (uint32_t i = 0; i < sequence_.isolated_count; ++i) {
      const uint32_t w = sequence_.isolated_first + i;
      for (uint32_t c = 0; c < components_; ++c) prediction[c] = last_ == nullptr ? 0 : last_[c];
      code(w, prediction, kNoNeighbours);
    }
  }

 private:
  static constexpr uint32_t kRunLimit = 16;  ///< corners of a wedge looked at

  const int32_t* at(uint32_t wedge) const { return values_ + size_t{wedge} * components_; }
  bool coded(uint32_t wedge) const { return lengths_[wedge] != kNotCoded; }

  /// Returns the context: mean bit length of the two neighbours' residuals.
  uint32_t predict(uint32_t start, uint32_t w, int64_t* prediction);
  void visitCorner(uint32_t h);
  void code(uint32_t w, const int64_t* prediction, uint32_t context);

  Io& io_;
  ValueModels& models_;
  const FaceView faces_;
  const WedgeSequence& sequence_;
  const uint32_t components_;
  const ValuePredictor predictor_;
  int32_t* const values_;
  uint8_t* const lengths_;
  const int32_t* last_ = nullptr;

  // What visitCorner() gathers.
  int64_t parallelogram_sum_[kMaxComponents];
  int64_t neighbour_sum_[kMaxComponents];
  uint32_t parallelograms_ = 0;
  uint32_t neighbours_ = 0;
  uint32_t length_sum_ = 0;
};

template <class Io>
void ValueCoder<Io>::visitCorner(uint32_t h) {
  const uint32_t next = nextHalfEdge(h);
  const uint32_t a = faces_.vertex(next);
  const uint32_t b = faces_.vertex(prevHalfEdge(h));
  const bool a_coded = coded(a);
  const bool b_coded = coded(b);
  for (const uint32_t n : {a, b}) {
    if (!coded(n)) continue;
    for (uint32_t c = 0; c < components_; ++c) neighbour_sum_[c] += at(n)[c];
    length_sum_ += std::min<uint32_t>(lengths_[n], 10);
    ++neighbours_;
  }
  if (!a_coded || !b_coded) return;
  const uint32_t t = faces_.twin(next);
  if (t == kNone || faces_.vertex(t) != b || faces_.vertex(nextHalfEdge(t)) != a) return;
  const uint32_t o = faces_.vertex(prevHalfEdge(t));
  if (!coded(o)) return;
  for (uint32_t c = 0; c < components_; ++c) {
    parallelogram_sum_[c] += int64_t{at(a)[c]} + at(b)[c] - at(o)[c];
  }
  ++parallelograms_;
}

template <class Io>
uint32_t ValueCoder<Io>::predict(uint32_t start, uint32_t w, int64_t* prediction) {
  parallelograms_ = neighbours_ = length_sum_ = 0;
  for (uint32_t c = 0; c < components_; ++c) parallelogram_sum_[c] = neighbour_sum_[c] = 0;
  uint32_t corners = 0;
  uint32_t h = start;
  do {
    visitCorner(h);
    h = faces_.rotateCcw(h);
  } while (h != kNone && h != start && faces_.vertex(h) == w && ++corners < kRunLimit);
  if (h != start) {
    for (h = faces_.rotateCw(start); h != kNone && faces_.vertex(h) == w && ++corners < kRunLimit;
         h = faces_.rotateCw(h)) {
      visitCorner(h);
    }
  }
  const bool use_tips = parallelograms_ != 0 && predictor_ == ValuePredictor::kParallelogram;
  for (uint32_t c = 0; c < components_; ++c) {
    if (use_tips) {
      prediction[c] = parallelogram_sum_[c] / int64_t{parallelograms_};
    } else if (neighbours_ != 0) {
      prediction[c] = neighbour_sum_[c] / int64_t{neighbours_};
    } else {
      prediction[c] = last_ == nullptr ? 0 : last_[c];
    }
  }
  return neighbours_ == 0 ? kNoNeighbours : length_sum_ / neighbours_;
}

template <class Io>
void ValueCoder<Io>::code(uint32_t w, const int64_t* prediction, uint32_t context) {
  int32_t* value = values_ + size_t{w} * components_;
  uint32_t longest = 0;
  for (uint32_t c = 0; c < components_; ++c) {
    TokenRow& row = models_.row[std::min(c, 3u)][context];
    const uint32_t p = static_cast<uint32_t>(prediction[c]);
    const int32_t truth =
        Io::kEncoding ? static_cast<int32_t>(static_cast<uint32_t>(value[c]) - p) : 0;
    const int32_t residual = c % 3 == 0   ? codeByLength<0>(io_, row, truth)
                             : c % 3 == 1 ? codeByLength<1>(io_, row, truth)
                                          : codeByLength<2>(io_, row, truth);
    value[c] = static_cast<int32_t>(p + static_cast<uint32_t>(residual));
    const uint32_t bits = static_cast<uint32_t>(residual);
    const uint32_t absolute = residual < 0 ? 0u - bits : bits;
    longest = std::max(longest, static_cast<uint32_t>(std::bit_width(absolute)));
  }
  lengths_[w] = static_cast<uint8_t>(longest);
  last_ = value;
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_VALUES_H_
