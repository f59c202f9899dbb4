// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_PART_H_
#define MCC_TILES_PART_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "jobs/hash.h"

namespace mcc::tiles {

/// One of `count` shares of the files of a tileset. Each file is in one of them, by its name alone,
/// so that machines that work on different parts need not know of each other.
struct Part {
  uint32_t number = 1;  ///< from 1
  uint32_t count = 1;

  bool isWhole() const { return count == 1; }
  bool has(std::string_view name) const { return jobs::hashOf(name) % count == number - 1; }
  /// Whether some file may be in both.
  bool overlaps(const Part& other) const { return count != other.count || number == other.number; }
  /// Returns "whole" or "3-of-8".
  std::string name() const {
    return isWhole() ? "whole" : std::to_string(number) + "-of-" + std::to_string(count);
  }
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_PART_H_
