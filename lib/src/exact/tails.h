// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// From the integers of an exact grid to its floats, with what they have below the
// grid's step. [A.10.5]
#ifndef MCC_EXACT_TAILS_H_
#define MCC_EXACT_TAILS_H_

#include <cstdint>

#include "base/memory.h"
#include "entropy/models.h"
#include "exact/grid.h"

namespace mcc {

struct TailModels {
  BitModel again[4][2];  ///< [component][outcome before]
  BitModel zero[4];      ///< between -1 and 1 step: whether 0
  BitModel minus[4];     ///< of zeros
};

/// Turns grid integers into ordered floats (dequantize.h), one component after another.
template <class Io>
class TailCoder {
 public:
  TailCoder(Io& io, TailModels& models, const AttributeInfo& info, const Allocator& allocator)
      : io_(io),
        models_(models),
        grid_(info.grid),
        tails_(static_cast<GridTails>(info.tails)),
        cache_(allocator) {}

  Status prepare() {
    if (tails_ != GridTails::kCached) return {};
    if (!cache_.assign(kEntries, {})) {
      return fail(Error::kOutOfMemory, "no memory for the tails of an attribute");
    }
    return {};
  }

  /// `truth`: the ordered float (encoder).
  int32_t code(uint32_t component, int32_t q, int32_t truth) {
    if (tails_ == GridTails::kNoTails) return orderedFromFloat(grid_.valueOf(q));
    if (tails_ == GridTails::kPlain) return codeTail(component, q, truth);
    Entry& entry = cache_[hashOf(component, q)];
    if (entry.used && entry.q == q) {
      BitModel& model = models_.again[component][before_];
      before_ = io_.bit(model, Io::kEncoding && entry.ordered == truth) ? 1 : 0;
      if (before_ != 0) return entry.ordered;
    } else if (q != 0 && grid_.tailBits(q) == 0) {
      return orderedFromFloat(grid_.valueOf(q));
    }
    entry = Entry{q, codeTail(component, q, truth), true};
    return entry.ordered;
  }

 private:
  static constexpr uint32_t kEntryBits = 13;
  static constexpr uint32_t kEntries = 1u << kEntryBits;

  struct Entry {
    int32_t q;
    int32_t ordered;
    bool used;
  };

  static int32_t orderedFromFloat(float value) {
    return orderedFromBits(std::bit_cast<uint32_t>(value));
  }
  static uint32_t hashOf(uint32_t component, int32_t q) {
    return (static_cast<uint32_t>(q) * 4 + component) * 0x9e3779b1u >> (32 - kEntryBits);
  }

  int32_t codeTail(uint32_t component, int32_t q, int32_t truth) {
    if (q == 0) return codeSmall(component, truth);
    const float value = Io::kEncoding ? std::bit_cast<float>(bitsFromOrdered(truth)) : 0.0f;
    const uint32_t bits = grid_.tailBits(q);
    return orderedFromFloat(
        grid_.valueOf(q, io_.raw(bits, Io::kEncoding ? grid_.tailOf(value, q) : 0)));
  }

  /// Less than a step from 0.
  int32_t codeSmall(uint32_t component, int32_t truth) {
    const uint32_t bits = bitsFromOrdered(truth);
    if (io_.bit(models_.zero[component], Io::kEncoding && (bits & 0x7fffffffu) == 0)) {
      const bool minus = io_.bit(models_.minus[component], Io::kEncoding && bits != 0);
      return orderedFromBits(minus ? 0x80000000u : 0u);
    }
    const uint32_t high = io_.raw(16, bits >> 16);
    return orderedFromBits(high << 16 | io_.raw(16, bits & 0xffff));
  }

  Io& io_;
  TailModels& models_;
  const ExactGrid grid_;
  const GridTails tails_;
  Array<Entry> cache_;
  uint32_t before_ = 0;
};

}  // namespace mcc

#endif  // MCC_EXACT_TAILS_H_
