// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// JOINTS_n and WEIGHTS_n together: rigid parts repeat their neighbour's tuple, blends share its
// joints.   [A.10.14]
//
// Per group of equal wedges: is the tuple that of a neighbour? If not, slot by slot: is the weight
// 0; the joint, by its rank among the neighbours' joints; the weight, against what the neighbours
// give that joint. When the weights of a tuple have a known sum, the last one follows.
#ifndef MCC_VALUES_SKIN_H_
#define MCC_VALUES_SKIN_H_

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "entropy/numbers.h"
#include "format/methods.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"
#include "values/residuals.h"

namespace mcc {

inline constexpr uint32_t kSkinSlots = 4;
inline constexpr uint32_t kSkinNeighbours = 4;
inline constexpr uint32_t kSkinWords = 2 * kSkinSlots;  ///< joints, then weights

struct SkinModels {
  BitModel same[kSkinNeighbours][4];   ///< [which one][how many more share its tuple]
  BitModel weightless[kSkinSlots][5];  ///< [slot][neighbours' influences]
  BitModel rank[kSkinSlots][6][3];  ///< [slot][rank][the first neighbour's here; of all; of some]
  BitModel idle_joint;              ///< of a weightless slot: 0
  BitModel has_sum;
  GolombModel joint;
  TokenRow weight[3][kLengthContexts];  ///< [slot][context]

  SkinModels() {
    for (auto& slot : weight) {
      for (TokenRow& r : slot) r.setUniform();
    }
  }
};

/// Codes tuples of kSkinWords integers per wedge.
template <class Io>
class SkinCoder {
 public:
  /// `sum` is that of the weights of every tuple (of most, if `sums_vary`), or 0.
  SkinCoder(const AttributeJob<Io>& job, SkinModels& models, int32_t sum, bool sums_vary)
      : job_(job), models_(models), usual_sum_(sum), sums_vary_(sums_vary) {}

  void run() {
    forEachGroup<kSkinWords>(job_, Ahead<int32_t>{job_.values, kSkinWords}, [this](uint32_t w) {
      codeTuple(w);
      last_ = w;
    });
  }

 private:
  static constexpr uint32_t kCandidates = kSkinNeighbours * kSkinSlots;
  static constexpr uint32_t kFaceLimit = 3;  ///< faces looked at
  static constexpr uint32_t kRanks = 6;      ///< asked for before the joint is spelled out

  static constexpr int64_t kTypicalShare = 8;

  struct Candidate {
    int32_t joint;
    uint32_t count;  ///< neighbours that use it
    int64_t weight;  ///< sum over them
    bool taken;
  };

  int32_t* tuple(uint32_t w) const { return job_.values + kSkinWords * size_t{w}; }
  void copyTuple(uint32_t to, uint32_t from) {
    std::memcpy(tuple(to), tuple(from), 4 * kSkinWords);
  }
  bool sameTuple(uint32_t a, uint32_t b) const {
    return std::memcmp(tuple(a), tuple(b), 4 * kSkinWords) == 0;
  }

  void collectNeighbours(uint32_t w);
  void addNeighbour(uint32_t w);
  void collectCandidates();
  bool codeSame(uint32_t w);
  int32_t codeSum(const int32_t* weights);
  void codeTuple(uint32_t w);
  uint32_t codeJoints(int32_t* t, int64_t* expected);
  void codeWeights(uint32_t w, uint32_t used, const int64_t* expected);
  int32_t codeJoint(uint32_t slot, int32_t truth, int64_t& weight);
  int32_t codeIdleJoint(int32_t truth);
  int32_t codeWeight(uint32_t slot, uint32_t context, uint32_t predicted, int32_t truth,
                     uint32_t& longest);

  const AttributeJob<Io> job_;
  SkinModels& models_;
  const int32_t usual_sum_;
  const bool sums_vary_;
  uint32_t last_ = kNone;

  uint32_t neighbours_[kSkinNeighbours];  ///< coded ones with different tuples
  uint32_t shared_[kSkinNeighbours];      ///< further neighbours with the same tuple
  uint32_t neighbour_count_ = 0;
  Candidate candidates_[kCandidates];
  uint32_t candidate_count_ = 0;
  int64_t typical_ = 0;  ///< weight expected of joints the neighbours do not have
  uint32_t uses_ = 0;    ///< neighbours, equal ones included
};

template <class Io>
void SkinCoder<Io>::addNeighbour(uint32_t w) {
  if (!job_.isCoded(w)) return;
  for (uint32_t i = 0; i < neighbour_count_; ++i) {
    if (sameTuple(neighbours_[i], w)) {
      ++shared_[i];
      return;
    }
  }
  if (neighbour_count_ == kSkinNeighbours) return;
  shared_[neighbour_count_] = 0;
  neighbours_[neighbour_count_++] = w;
}

/// From the first faces the group completes; the last coded wedge when there are none.
template <class Io>
void SkinCoder<Io>::collectNeighbours(uint32_t w) {
  neighbour_count_ = 0;
  uint32_t faces = 0;
  const auto addOthers = [this](uint32_t h) {
    const auto [n, p] = job_.othersOf(h);
    addNeighbour(n);
    addNeighbour(p);
  };
  job_.forFaces(w, [&](uint32_t h) {
    addOthers(h);
    return ++faces < kFaceLimit;
  });
  if (neighbour_count_ == 0) {
    job_.wedges.forRun(w, [&](uint32_t h) {
      addOthers(h);
      return neighbour_count_ == 0;
    });
  }
  if (neighbour_count_ == 0 && last_ != kNone) addNeighbour(last_);
}

template <class Io>
bool SkinCoder<Io>::codeSame(uint32_t w) {
  for (uint32_t i = 0; i < neighbour_count_; ++i) {
    BitModel& model = models_.same[i][std::min(shared_[i], 3u)];
    if (job_.io.bit(model, Io::kEncoding && sameTuple(neighbours_[i], w))) {
      copyTuple(w, neighbours_[i]);
      job_.lengths[w] = 0;
      return true;
    }
  }
  return false;
}

/// The neighbours' joints with weight, in the order they are met.
template <class Io>
void SkinCoder<Io>::collectCandidates() {
  candidate_count_ = 0;
  uses_ = 0;
  typical_ = 0;
  for (uint32_t i = 0; i < neighbour_count_; ++i) {
    const int32_t* t = tuple(neighbours_[i]);
    const uint32_t uses = 1 + shared_[i];
    uses_ += uses;
    for (uint32_t k = 0; k < kSkinSlots; ++k) {
      if (t[kSkinSlots + k] == 0) continue;
      uint32_t c = 0;
      while (c < candidate_count_ && candidates_[c].joint != t[k]) ++c;
      if (c == candidate_count_) candidates_[candidate_count_++] = {t[k], 0, 0, false};
      candidates_[c].count += uses;
      candidates_[c].weight += int64_t{t[kSkinSlots + k]} * uses;
      typical_ += int64_t{t[kSkinSlots + k]} * uses;
    }
  }
  typical_ /= kTypicalShare * int64_t{std::max(uses_, 1u)};
}

/// The sum of the tuple's weights if that is known, else 0.
template <class Io>
int32_t SkinCoder<Io>::codeSum(const int32_t* weights) {
  if (usual_sum_ == 0 || !sums_vary_) return usual_sum_;
  int64_t truth = 0;
  if constexpr (Io::kEncoding) {
    for (uint32_t k = 0; k < kSkinSlots; ++k) truth += weights[k];
  }
  return job_.io.bit(models_.has_sum, truth == usual_sum_) ? usual_sum_ : 0;
}

template <class Io>
void SkinCoder<Io>::codeTuple(uint32_t w) {
  collectNeighbours(w);
  if (codeSame(w)) return;
  collectCandidates();
  int64_t expected[kSkinSlots];
  const uint32_t used = codeJoints(tuple(w), expected);
  codeWeights(w, used, expected);
}

/// Which slots have weight (a bit each), and all joints. `expected`: the neighbours' weights of
/// each joint.
template <class Io>
uint32_t SkinCoder<Io>::codeJoints(int32_t* t, int64_t* expected) {
  uint32_t influences = 0;
  for (uint32_t i = 0; i < neighbour_count_; ++i) {
    const int32_t* weights = tuple(neighbours_[i]) + kSkinSlots;
    for (uint32_t k = 0; k < kSkinSlots; ++k) influences += weights[k] != 0 ? 1 : 0;
  }
  if (neighbour_count_ != 0) influences = (influences + neighbour_count_ / 2) / neighbour_count_;
  uint32_t used = 0;
  for (uint32_t k = 0; k < kSkinSlots; ++k) {
    BitModel& model = models_.weightless[k][influences];
    expected[k] = 0;
    if (job_.io.bit(model, Io::kEncoding && t[kSkinSlots + k] == 0)) {
      t[k] = codeIdleJoint(t[k]);
      continue;
    }
    used |= 1u << k;
    t[k] = codeJoint(k, t[k], expected[k]);
  }
  return used;
}

/// Codes each weight against what the neighbours give its joint; the last one is what is left, if
/// the sum is known.
template <class Io>
void SkinCoder<Io>::codeWeights(uint32_t w, uint32_t used, const int64_t* expected) {
  uint32_t context = kNoNeighbours;
  if (neighbour_count_ != 0) {
    uint32_t length = 0;
    for (uint32_t i = 0; i < neighbour_count_; ++i) length += job_.lengths[neighbours_[i]];
    context = std::min((length + neighbour_count_ / 2) / neighbour_count_, kLongestContext);
  }
  int32_t* weights = tuple(w) + kSkinSlots;
  const int32_t sum = codeSum(weights);
  int64_t rest = sum;
  uint32_t longest = 0;
  for (uint32_t k = 0; k < kSkinSlots; ++k) {
    if ((used >> k & 1) == 0) {
      weights[k] = 0;
      continue;
    }
    const bool is_last = used >> k == 1;
    if (sum != 0 && is_last) {
      weights[k] = static_cast<int32_t>(static_cast<uint32_t>(rest));
      continue;
    }
    weights[k] = codeWeight(k, context, static_cast<uint32_t>(expected[k]), weights[k], longest);
    rest -= weights[k];
  }
  job_.lengths[w] = static_cast<uint8_t>(longest);
}

/// `weight`: what the neighbours give the joint.
template <class Io>
int32_t SkinCoder<Io>::codeJoint(uint32_t slot, int32_t truth, int64_t& weight) {
  uint32_t rank = 0;
  for (uint32_t i = 0; i < candidate_count_ && rank < kRanks; ++i) {
    Candidate& c = candidates_[i];
    if (c.taken) continue;
    const bool here = tuple(neighbours_[0])[slot] == c.joint;
    const uint32_t kind = here ? 0 : c.count == uses_ ? 1 : 2;
    if (job_.io.bit(models_.rank[slot][rank][kind], Io::kEncoding && c.joint == truth)) {
      c.taken = true;
      weight = c.weight / int64_t{c.count};
      return c.joint;
    }
    ++rank;
  }
  weight = typical_;
  return static_cast<int32_t>(codeGolomb(job_.io, models_.joint, static_cast<uint32_t>(truth)));
}

template <class Io>
int32_t SkinCoder<Io>::codeIdleJoint(int32_t truth) {
  if (job_.io.bit(models_.idle_joint, Io::kEncoding && truth == 0)) return 0;
  return static_cast<int32_t>(codeGolomb(job_.io, models_.joint, static_cast<uint32_t>(truth)));
}

template <class Io>
int32_t SkinCoder<Io>::codeWeight(uint32_t slot, uint32_t context, uint32_t predicted,
                                  int32_t truth, uint32_t& longest) {
  const uint32_t mixed = slot == 0 ? context : contextAfter(context, longest);
  TokenRow& row = models_.weight[std::min(slot, 2u)][mixed];
  int32_t residual =
      Io::kEncoding ? static_cast<int32_t>(static_cast<uint32_t>(truth) - predicted) : 0;
  uint32_t length = 0;
  residual = codeByLength<0>(job_.io, row, residual, length);
  longest = std::max(longest, length);
  return static_cast<int32_t>(predicted + static_cast<uint32_t>(residual));
}

}  // namespace mcc

#endif  // MCC_VALUES_SKIN_H_
