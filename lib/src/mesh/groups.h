// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_MESH_GROUPS_H_
#define MCC_MESH_GROUPS_H_

#include <bit>
#include <cstdint>
#include <span>

#include "base/host.h"
#include "base/memory.h"

namespace mcc {

/// Groups of vertices that share a position, numbered by their first vertex. Without copies every
/// vertex is its own group and the arrays are empty. With copies, the groups that have some or lie
/// on boundaries are listed with their umbrellas.
struct Groups {
  explicit Groups(const Allocator& allocator)
      : listed(allocator), umbrella_begin(allocator), umbrellas(allocator) {}

  /// Says which of 64 groups are listed, and how many are listed before them.
  struct Listed {
    uint64_t groups;
    uint32_t before;
  };

  uint32_t count = 0;
  Array<Listed> listed;
  Array<uint32_t> umbrella_begin;  ///< offsets into umbrellas by listed group, and one more
  /// A half-edge that leaves the group in each of its umbrellas, by vertex number.
  Array<uint32_t> umbrellas;

  /// Every group lists all half-edges that leave it, not one per umbrella.
  bool has_corners = false;

  bool hasCopies() const { return !listed.empty(); }
  /// Returns the umbrellas of a group, or nothing for a group of one vertex that is not listed.
  /// hasCopies() must hold.
  MCC_INLINE std::span<const uint32_t> umbrellasOf(uint32_t group) const {
    const Listed& l = listed[group / 64];
    const uint64_t bit = uint64_t{1} << (group % 64);
    if ((l.groups & bit) == 0) return {};
    const uint32_t place = l.before + static_cast<uint32_t>(std::popcount(l.groups & (bit - 1)));
    const uint32_t begin = umbrella_begin[place];
    return {umbrellas.data() + begin, umbrella_begin[place + 1] - begin};
  }
};

}  // namespace mcc

#endif  // MCC_MESH_GROUPS_H_
