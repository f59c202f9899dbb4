// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Palettes: the distinct coordinates of an axis. Where few values repeat (CAD, voxels, low-poly
// models), predictions and scales are mapped to ranks among the values, and residuals are
// differences of ranks. [A.6.11]
#ifndef MCC_POSITIONS_PALETTE_H_
#define MCC_POSITIONS_PALETTE_H_

#include <algorithm>
#include <cstdint>

#include "base/host.h"
#include "base/memory.h"
#include "entropy/numbers.h"
#include "mcc/status.h"
#include "positions/mirror.h"

namespace mcc {

inline constexpr uint32_t kMaxPalette = 1u << 23;  ///< bounded so that Q8 ranks fit in 31 bits

/// The sorted distinct values of one axis, with an index that finds ranks among them. An axis
/// without values is coded without a palette.
struct AxisPalette {
  const int32_t* values = nullptr;
  uint32_t count = 0;
  /// Cell i covers the distances [i << shift, (i + 1) << shift) from the first value; cells[i] is
  /// the Q8 rank where it begins.
  const uint32_t* cells = nullptr;
  uint32_t shift = 0;

  /// Returns the number of values that are at most x.
  uint32_t countUpTo(int32_t x) const {
    return static_cast<uint32_t>(std::upper_bound(values, values + count, x) - values);
  }

  /// Returns the rank of a Q8 coordinate, also in Q8. It is linear within cells, and constant below
  /// the first and above the last value.
  MCC_INLINE int64_t rankOf(int64_t q8) const {
    const int64_t first = int64_t{values[0]} * 256;
    const int64_t last = int64_t{values[count - 1]} * 256;
    const uint64_t distance = static_cast<uint64_t>(std::clamp(q8, first, last) - first);
    const uint64_t cell = distance >> 8 >> shift;
    const uint64_t rest = distance - (cell << shift << 8);
    const uint64_t inside = cells[cell + 1] - cells[cell];
    return int64_t{cells[cell]} + static_cast<int64_t>((inside * rest) >> (shift + 8));
  }

  /// Returns the value of a rank. The rank is clamped, because a stream may claim one beyond the
  /// ends.
  MCC_INLINE int32_t valueOf(int32_t rank) const {
    return values[std::clamp<int64_t>(rank, 0, int64_t{count} - 1)];
  }
};

/// The cells of a palette: at most four for each value, so that few cells contain more than one
/// value.
struct PaletteCells {
  const int32_t* values;
  uint32_t count;  ///< at least 1
  uint32_t shift = 0;
  uint32_t cell_count = 0;  ///< one more than there are cells

  PaletteCells(const int32_t* sorted, uint32_t value_count) : values(sorted), count(value_count) {
    const uint64_t range = distanceOf(count - 1) + 1;
    while (range >> shift > 4 * uint64_t{count}) ++shift;
    cell_count = static_cast<uint32_t>(range >> shift) + 2;
  }

  uint64_t distanceOf(uint32_t i) const {
    return static_cast<uint64_t>(int64_t{values[i]} - values[0]);
  }

  /// Fills in the rank where each cell begins, interpolated linearly between the values around it.
  void fill(uint32_t* cells) const {
    uint32_t low = 0;
    for (uint32_t cell = 0; cell < cell_count; ++cell) {
      const uint64_t from = std::min(uint64_t{cell} << shift, distanceOf(count - 1));
      while (low + 1 < count && distanceOf(low + 1) <= from) ++low;
      const uint64_t above = (from - distanceOf(low)) << 8;
      cells[cell] = low << 8;
      if (above != 0)
        cells[cell] += static_cast<uint32_t>(above / (distanceOf(low + 1) - distanceOf(low)));
    }
  }
};

struct PaletteModels {
  BitModel present[3];
  GolombModel count;
  GolombModel first;
  BitModel regular[2];  ///< whether a gap is nearly the one before, given whether that one was
  BitModel change[2];
  GolombModel gap;
  BitModel image[2];  ///< whether a value is an image of one before, given whether the last was
};

/// Owns the palettes of a piece and their memory.
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

  /// Codes the palettes; `truth` has three (encoder). A palette with more values than `limit` is an
  /// error. Each axis has at most one of the mirrors that matters, the first.
  template <class Io>
  Status code(Io& io, PaletteModels& models, const AxisPalette* truth, uint32_t limit,
              const Mirrors& mirrors) {
    for (uint32_t s = 0; s < 3; ++s) {
      if (!io.bit(models.present[s], Io::kEncoding && truth[s].count != 0)) continue;
      MCC_TRY(codeAxis(io, models, Io::kEncoding ? truth[s] : AxisPalette{}, limit,
                       mirrors.across(s), values_[s]));
      if (!index(s)) return fail(Error::kOutOfMemory, "no memory for a palette");
    }
    return {};
  }

 private:
  template <class Io>
  static Status codeAxis(Io& io, PaletteModels& models, const AxisPalette& truth, uint32_t limit,
                         const Mirror* mirror, Array<int32_t>& values) {
    const uint32_t count = codeGolomb(io, models.count, truth.count - 1) + 1;
    if (count > std::min(limit, kMaxPalette) || count == 0) {
      return fail(Error::kBadAttribute, "a palette has more values than there are vertices");
    }
    if (!values.resize(count)) return fail(Error::kOutOfMemory, "no memory for a palette");
    int64_t value = codeSignedGolomb(io, models.first, Io::kEncoding ? truth.values[0] : 0);
    values[0] = static_cast<int32_t>(value);
    int64_t gap = 1;
    uint32_t context = 0;
    uint32_t is_image = 0;
    uint32_t behind = 0;  // the value whose image is the next one above `value` is before this
    for (uint32_t i = 1; i < count; ++i) {
      if (mirror != nullptr) {
        if (int64_t{mirror->sum} - value > value) behind = i;
        while (behind != 0 && int64_t{mirror->sum} - values[behind - 1] <= value) --behind;
        const int64_t image = behind != 0 ? int64_t{mirror->sum} - values[behind - 1] : 0;
        if (behind != 0 && image <= INT32_MAX) {
          is_image =
              io.bit(models.image[is_image], Io::kEncoding && truth.values[i] == image) ? 1 : 0;
          if (is_image != 0) {
            gap = image - value;
            value = image;
            values[i] = static_cast<int32_t>(value);
            continue;
          }
        }
      }
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

  bool index(uint32_t s) {
    const PaletteCells cells(values_[s].data(), static_cast<uint32_t>(values_[s].size()));
    shift_[s] = cells.shift;
    if (!cells_[s].resize(cells.cell_count)) return false;
    cells.fill(cells_[s].data());
    return true;
  }

  Array<int32_t> values_[3];
  Array<uint32_t> cells_[3];
  uint32_t shift_[3] = {};
};

}  // namespace mcc

#endif  // MCC_POSITIONS_PALETTE_H_
