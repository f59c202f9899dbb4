// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Palettes: the distinct coordinates of an axis. Where few values repeat (CAD, voxels, low-poly models) predictions and
// scales are mapped to ranks among them, and residuals are differences of ranks.             [B.2.8]
#ifndef MCC_ATTRIBUTES_POSITION_PALETTE_H_
#define MCC_ATTRIBUTES_POSITION_PALETTE_H_

#include <algorithm>
#include <cstdint>

#include "base/memory.h"
#include "entropy/numbers.h"
#include "mcc/status.h"

namespace mcc {

/// Sorted distinct values of one axis; none: the axis is coded without a palette.
struct AxisPalette {
  const int32_t* values = nullptr;
  uint32_t count = 0;
  /// Where to look: cell i covers values of [values[0] + i << shift, values[0] + (i+1) << shift) and begins at rank
  /// cells[i]; null: everywhere.
  const uint32_t* cells = nullptr;
  uint32_t shift = 0;

  /// Number of values that are at most x.
  uint32_t countUpTo(int64_t x) const {
    if (x < values[0]) return 0;
    if (x >= values[count - 1]) return count;
    uint32_t low = 0;
    uint32_t length = count;
    if (cells != nullptr) {
      const uint64_t cell = static_cast<uint64_t>(x - values[0]) >> shift;
      low = cells[cell];
      length = cells[cell + 1] - low;
    }
    while (length != 0) {
      const uint32_t half = length / 2;
      const bool right = values[low + half] <= x;
      low += right ? half + 1 : 0;
      length = right ? length - half - 1 : half;
    }
    return low;
  }

  /// Rank of a Q8 coordinate, in Q8 as well: linear between the values, constant beyond them.
  int64_t rankOf(int64_t q8) const {
    const uint32_t up_to = countUpTo(q8 >> 8);
    if (up_to == 0) return 0;
    const int64_t rank = int64_t{up_to - 1} * 256;
    if (up_to == count) return rank;
    const int64_t gap = int64_t{values[up_to]} - values[up_to - 1];
    return rank + (q8 - int64_t{values[up_to - 1]} * 256) / gap;
  }

  /// Value of a rank, which a stream may claim beyond the ends.
  int32_t valueOf(int32_t rank) const {
    return values[std::clamp<int64_t>(rank, 0, int64_t{count} - 1)];
  }
};

struct PaletteModels {
  BitModel present[3];
  GolombModel count;
  GolombModel first;
  BitModel regular[2];  ///< whether a gap is nearly the one before, by whether that one was
  BitModel change[2];
  GolombModel gap;
};

/// The palettes of a piece and their memory.
class PositionPalettes {
 public:
  explicit PositionPalettes(const Allocator& allocator)
      : values_{Array<int32_t>(allocator), Array<int32_t>(allocator), Array<int32_t>(allocator)},
        cells_{Array<uint32_t>(allocator), Array<uint32_t>(allocator), Array<uint32_t>(allocator)} {
  }

  AxisPalette axis(uint32_t s) const {
    return {values_[s].data(), static_cast<uint32_t>(values_[s].size()), cells_[s].data(),
            shift_[s]};
  }

  /// Codes the palettes; `truth` has three (encoder). No palette has more values than `limit`.
  template <class Io>
  Status code(Io& io, PaletteModels& models, const AxisPalette* truth, uint32_t limit) {
    for (uint32_t s = 0; s < 3; ++s) {
      if (!io.bit(models.present[s], Io::kEncoding && truth[s].count != 0)) continue;
      MCC_TRY(codeAxis(io, models, Io::kEncoding ? truth[s] : AxisPalette{}, limit, values_[s]));
      if (!index(s)) return fail(Error::kOutOfMemory, "no memory for a palette");
    }
    return {};
  }

 private:
  template <class Io>
  static Status codeAxis(Io& io, PaletteModels& models, const AxisPalette& truth, uint32_t limit,
                         Array<int32_t>& values) {
    const uint32_t count = codeGolomb(io, models.count, truth.count - 1) + 1;
    if (count > limit || count == 0) {
      return fail(Error::kBadAttribute, "a palette has more values than there are vertices");
    }
    if (!values.resize(count)) return fail(Error::kOutOfMemory, "no memory for a palette");
    int64_t value = codeSignedGolomb(io, models.first, Io::kEncoding ? truth.values[0] : 0);
    values[0] = static_cast<int32_t>(value);
    int64_t gap = 1;
    uint32_t context = 0;
    for (uint32_t i = 1; i < count; ++i) {
      const int64_t target = Io::kEncoding ? int64_t{truth.values[i]} - truth.values[i - 1] : 0;
      const bool regular = target - gap <= 1 && gap - target <= 1;
      context = io.bit(models.regular[context], regular) ? 1 : 0;
      if (context != 0) {
        if (io.bit(models.change[0], target != gap)) {
          gap += io.bit(models.change[1], target > gap) ? 1 : -1;
        }
      } else {
        gap = int64_t{codeGolomb(io, models.gap, static_cast<uint32_t>(target - 1))} + 1;
      }
      value += gap;
      if (gap < 1 || value > INT32_MAX || ((i & 0xfff) == 0 && io.overrun())) {
        return fail(Error::kBadAttribute, "a palette is not increasing");
      }
      values[i] = static_cast<int32_t>(value);
    }
    return {};
  }

  /// Cells for AxisPalette: about as many as there are values.
  bool index(uint32_t s) {
    const Array<int32_t>& values = values_[s];
    const uint32_t count = static_cast<uint32_t>(values.size());
    const uint64_t range = static_cast<uint64_t>(int64_t{values[count - 1]} - values[0]) + 1;
    shift_[s] = 0;
    while (range >> shift_[s] > count) ++shift_[s];
    const uint32_t cells = static_cast<uint32_t>(range >> shift_[s]) + 1;
    if (!cells_[s].resize(size_t{cells} + 1)) return false;
    uint32_t rank = 0;
    for (uint32_t cell = 0; cell <= cells; ++cell) {
      const int64_t from = values[0] + (int64_t{cell} << shift_[s]);
      while (rank < count && values[rank] < from) ++rank;
      cells_[s][cell] = rank;
    }
    return true;
  }

  Array<int32_t> values_[3];
  Array<uint32_t> cells_[3];
  uint32_t shift_[3] = {};
};

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITION_PALETTE_H_
