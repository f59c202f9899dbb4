// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_ATTRIBUTES_EDGE_MEMORY_H_
#define MCC_ATTRIBUTES_EDGE_MEMORY_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/memory.h"
#include "mcc/types.h"

namespace mcc {

/// Third corners by the values at an edge. [B.7.4]
class EdgeMemory {
 public:
  struct Entry {
    uint32_t check;
    uint32_t wedge[2];  ///< the latest first; kNone: none
  };
  struct Known {
    uint32_t wedge[2];
  };

  explicit EdgeMemory(const Allocator& allocator) : entries_(allocator) {}

  [[nodiscard]] bool prepare(uint32_t face_count) {
    bits_ = std::min(static_cast<uint32_t>(std::bit_width(face_count)) + 1, kMostBits);
    return entries_.assign(size_t{1} << bits_, Entry{0, {kNone, kNone}});
  }
  void clear() { entries_.clear(); }

  Known at(uint64_t key) const {
    const Entry& e = entries_[key >> (64 - bits_)];
    if (e.check != static_cast<uint32_t>(key)) return {{kNone, kNone}};
    return {{e.wedge[0], e.wedge[1]}};
  }
  void learn(uint64_t key, uint32_t wedge) {
    Entry& e = entries_[key >> (64 - bits_)];
    const bool known = e.check == static_cast<uint32_t>(key);
    e = Entry{static_cast<uint32_t>(key), {wedge, known ? e.wedge[0] : kNone}};
  }

 private:
  static constexpr uint32_t kMostBits = 22;

  Array<Entry> entries_;
  uint32_t bits_ = 0;
};

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_EDGE_MEMORY_H_
