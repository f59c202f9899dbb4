// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Positions of the wedges that no triangle uses, coded as a sorted set: a box is halved until every
// half holds one position or equal ones. Since the order of the positions is not coded, the set is
// cheaper than a list by the bits that the order would take. [A.6.9]
#ifndef MCC_POSITIONS_ISOLATED_H_
#define MCC_POSITIONS_ISOLATED_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/memory.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mcc/status.h"
#include "positions/record.h"

namespace mcc {

inline constexpr uint32_t kHalvedCounts = 8;  ///< classes of the number of positions in a box

struct IsolatedModels {
  BitModel on_one_side[kHalvedCounts];
};

/// Returns whether position `a` comes before `b`. The bit that halves the largest box holding both
/// decides. `low` is a corner below both.
inline bool comesBefore(const int32_t* a, const int32_t* b, const int32_t* low) {
  uint32_t most = 0;
  bool before = false;
  for (uint32_t s = 0; s < 3; ++s) {
    const uint32_t from = static_cast<uint32_t>(a[s]) - static_cast<uint32_t>(low[s]);
    const uint32_t to = static_cast<uint32_t>(b[s]) - static_cast<uint32_t>(low[s]);
    const uint32_t differ = static_cast<uint32_t>(std::bit_width(from ^ to));
    if (differ <= most) continue;
    most = differ;
    before = from < to;
  }
  return before;
}

template <class Io>
class IsolatedCoder {
 public:
  IsolatedCoder(Io& io, IsolatedModels& models) : io_(io), models_(models) {}

  /// Codes the positions. `truth` has 3 coordinates each, in the order of comesBefore() (encoder).
  Status run(uint32_t count, VertexRecord* records, const int32_t* truth);

 private:
  struct Box {
    uint32_t low[3];
    uint32_t bits[3];  ///< of the lengths of its sides
    uint32_t count;
  };

  /// The most halves that can wait at the same time: one per bit.
  static constexpr uint32_t kDepth = 3 * 32 + 1;

  void codeBounds(Box& box, const int32_t* truth);
  uint32_t codeLowerHalf(const Box& box, uint32_t axis, const int32_t* truth);

  Io& io_;
  IsolatedModels& models_;
};

/// Codes the lowest coordinates, and how many bits the others take above them.
template <class Io>
void IsolatedCoder<Io>::codeBounds(Box& box, const int32_t* truth) {
  for (uint32_t s = 0; s < 3; ++s) {
    int32_t low = 0;
    int32_t high = 0;
    if constexpr (Io::kEncoding) {
      low = high = truth[s];
      for (uint32_t i = 1; i < box.count; ++i) {
        low = std::min(low, truth[3 * size_t{i} + s]);
        high = std::max(high, truth[3 * size_t{i} + s]);
      }
    }
    box.low[s] = io_.raw(32, static_cast<uint32_t>(low));
    const uint32_t span = static_cast<uint32_t>(high) - static_cast<uint32_t>(low);
    box.bits[s] = std::min(io_.raw(6, static_cast<uint32_t>(std::bit_width(span))), 32u);
  }
}

/// Codes how many positions of the box, whose side along `axis` has been halved, lie in the lower
/// half.
template <class Io>
uint32_t IsolatedCoder<Io>::codeLowerHalf(const Box& box, uint32_t axis, const int32_t* truth) {
  uint32_t lower = 0;
  if constexpr (Io::kEncoding) {
    const uint32_t half = uint32_t{1} << box.bits[axis];
    while (lower < box.count &&
           static_cast<uint32_t>(truth[3 * size_t{lower} + axis]) - box.low[axis] < half)
      ++lower;
  }
  BitModel& model = models_.on_one_side[std::min(box.count, kHalvedCounts + 1) - 2];
  if (io_.bit(model, lower == 0 || lower == box.count))
    return io_.raw(1, lower != 0 ? 1 : 0) != 0 ? box.count : 0;
  return 1 + codeUniform(io_, box.count - 1, lower - 1);
}

template <class Io>
Status IsolatedCoder<Io>::run(uint32_t count, VertexRecord* records, const int32_t* truth) {
  Box boxes[kDepth];
  uint32_t depth = 1;
  uint32_t done = 0;
  boxes[0].count = count;
  codeBounds(boxes[0], truth);
  while (depth != 0) {
    Box box = boxes[--depth];
    const int32_t* const first = Io::kEncoding ? truth + 3 * size_t{done} : nullptr;
    const uint32_t widest = std::max(box.bits[0], std::max(box.bits[1], box.bits[2]));
    if (box.count == 1 || widest == 0) {
      VertexRecord record{};
      for (uint32_t s = 0; s < 3; ++s) {
        const uint32_t rest =
            io_.raw(box.bits[s], Io::kEncoding ? static_cast<uint32_t>(first[s]) - box.low[s] : 0);
        record.q[s] = static_cast<int32_t>(box.low[s] + rest);
      }
      for (uint32_t i = 0; i < box.count; ++i) records[done++] = record;
      if (io_.overrun())
        return fail(Error::kTruncated, "a stream ends inside the isolated positions");
      continue;
    }
    const uint32_t axis = box.bits[0] == widest ? 0 : box.bits[1] == widest ? 1 : 2;
    --box.bits[axis];
    const uint32_t lower = codeLowerHalf(box, axis, first);
    Box upper = box;
    upper.low[axis] += uint32_t{1} << box.bits[axis];
    upper.count = box.count - lower;
    box.count = lower;
    if (upper.count != 0) boxes[depth++] = upper;
    if (box.count != 0) boxes[depth++] = box;
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_POSITIONS_ISOLATED_H_
