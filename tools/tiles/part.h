// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_PART_H_
#define MCC_TILES_PART_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace mcc::tiles {

/// Returns a number of 64 bits for a text, the same on every machine: FNV-1a, and MurmurHash3's
/// last steps, so that all bits depend on all bytes.
constexpr uint64_t hashOf(std::string_view text) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3u;
  hash = (hash ^ (hash >> 33)) * 0xff51afd7ed558ccdu;
  hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53u;
  return hash ^ (hash >> 33);
}

/// One of `count` shares of the files of a tileset. Each file is in one of them, by its name alone,
/// so that machines that work on different parts need not know of each other.
struct Part {
  uint32_t number = 1;  ///< from 1
  uint32_t count = 1;

  bool isWhole() const { return count == 1; }
  bool has(std::string_view name) const { return hashOf(name) % count == number - 1; }
  /// Whether some file may be in both.
  bool overlaps(const Part& other) const { return count != other.count || number == other.number; }
  /// Returns "whole" or "3-of-8".
  std::string name() const {
    return isWhole() ? "whole" : std::to_string(number) + "-of-" + std::to_string(count);
  }
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_PART_H_
