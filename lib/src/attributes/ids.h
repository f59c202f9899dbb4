// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Numbers that name things (features, parts): close ones have nothing to do with each other.  [A.8.4, B.3.3]
//
// Of a number that no neighbour has: is it the next new one; is it what came beside its neighbour's number last time; its
// place among those named last; or its distance from the neighbour's.
#ifndef MCC_ATTRIBUTES_IDS_H_
#define MCC_ATTRIBUTES_IDS_H_

#include <algorithm>
#include <cstdint>

#include "attributes/residuals.h"
#include "base/memory.h"
#include "entropy/models.h"

namespace mcc {

struct IdModels {
  BitModel is_new[2];        ///< [the one before was]
  BitModel is_successor[3];  ///< [outcome before: none, no, yes]
  TokenRow rank;
  TokenRow distance;

  IdModels() {
    rank.setUniform();
    distance.setUniform();
  }
};

class IdMemory {
 public:
  explicit IdMemory(const Allocator& allocator) : successors_(allocator) {}

  /// Forgets everything.
  [[nodiscard]] bool start() {
    recent_count_ = 0;
    last_new_ = -1;
    was_new_ = successor_outcome_ = 0;
    return successors_.assign(kSuccessors, {});
  }

  /// A number that is not that of its neighbours; `beside`: one neighbour's.
  template <class Io>
  int32_t code(Io& io, IdModels& models, int32_t beside, int32_t truth) {
    const int32_t id = find(io, models, beside, truth);
    Successor& s = successorOf(beside);
    s = {beside, id, true};
    moveToFront(id);
    last_new_ = std::max(last_new_, id);
    return id;
  }

 private:
  static constexpr uint32_t kRecent = 15;
  static constexpr uint32_t kSuccessorBits = 12;
  static constexpr uint32_t kSuccessors = 1u << kSuccessorBits;

  struct Successor {
    int32_t id;
    int32_t next;
    bool used;
  };

  Successor& successorOf(int32_t id) {
    return successors_[(static_cast<uint32_t>(id) * 0x9e3779b1u) >> (32 - kSuccessorBits)];
  }

  template <class Io>
  int32_t find(Io& io, IdModels& models, int32_t beside, int32_t truth) {
    const int32_t next = static_cast<int32_t>(static_cast<uint32_t>(last_new_) + 1);
    was_new_ = io.bit(models.is_new[was_new_], Io::kEncoding && truth == next) ? 1 : 0;
    if (was_new_ != 0) return next;
    const Successor& s = successorOf(beside);
    if (s.used && s.id == beside) {
      const bool hit =
          io.bit(models.is_successor[successor_outcome_], Io::kEncoding && truth == s.next);
      successor_outcome_ = hit ? 2 : 1;
      if (hit) return s.next;
    }
    uint32_t rank = kRecent;
    if constexpr (Io::kEncoding) {
      rank = static_cast<uint32_t>(std::find(recent_, recent_ + recent_count_, truth) - recent_);
      if (rank == recent_count_) rank = kRecent;
    }
    rank = io.template token<0>(models.rank, kAttributeSchedule, rank);
    if (rank < recent_count_) return recent_[rank];
    const uint32_t from = static_cast<uint32_t>(beside);
    uint32_t length = 0;
    const int32_t distance = codeByLength<1>(
        io, models.distance, static_cast<int32_t>(static_cast<uint32_t>(truth) - from), length);
    return static_cast<int32_t>(from + static_cast<uint32_t>(distance));
  }

  void moveToFront(int32_t id) {
    uint32_t rank =
        static_cast<uint32_t>(std::find(recent_, recent_ + recent_count_, id) - recent_);
    if (rank == recent_count_) {
      recent_count_ = std::min(recent_count_ + 1, kRecent);
      rank = recent_count_ - 1;
    }
    for (; rank != 0; --rank) recent_[rank] = recent_[rank - 1];
    recent_[0] = id;
  }

  Array<Successor> successors_;
  int32_t recent_[kRecent] = {};
  uint32_t recent_count_ = 0;
  int32_t last_new_ = -1;
  uint32_t was_new_ = 0;
  uint32_t successor_outcome_ = 0;
};

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_IDS_H_
