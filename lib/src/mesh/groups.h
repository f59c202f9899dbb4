// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_MESH_GROUPS_H_
#define MCC_MESH_GROUPS_H_

#include <cstdint>

#include "base/memory.h"

namespace mcc {

/// Groups of vertices that share a position. Without copies every vertex is its own group and the arrays are empty.
struct Groups {
  explicit Groups(const Allocator& allocator) : umbrella_begin(allocator), umbrellas(allocator) {}

  uint32_t count = 0;
  Array<uint32_t> umbrella_begin;  ///< group_count + 1 offsets into umbrellas
  Array<uint32_t>
      umbrellas;  ///< a half-edge leaving the group in each of its umbrellas, by vertex number
  bool hasCopies() const { return !umbrella_begin.empty(); }
};

}  // namespace mcc

#endif  // MCC_MESH_GROUPS_H_
