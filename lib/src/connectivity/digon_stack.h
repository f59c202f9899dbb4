// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stack of the digons that wait, by their tops.                                  [A.4.1] [A.4.4]
#ifndef MCC_CONNECTIVITY_DIGON_STACK_H_
#define MCC_CONNECTIVITY_DIGON_STACK_H_

#include <cstdint>
#include <cstring>

#include "base/memory.h"

namespace mcc {

/// Digons that a handle may put one below: so many are moved for a handle at most. The writer cuts surfaces that would
/// need more.
inline constexpr uint32_t kMaxHandleDepth = 255;

class DigonStack {
 public:
  explicit DigonStack(const Allocator& allocator) : tops_(allocator) {}

  bool empty() const { return tops_.empty(); }
  size_t size() const { return tops_.size(); }
  uint32_t top() const { return tops_[tops_.size() - 1]; }
  void pop() { tops_.pop_back(); }

  /// Below the topmost `depth` <= size() digons. O(depth). False without memory.
  [[nodiscard]] bool insertBelow(uint32_t depth, uint32_t top) {
    if (!tops_.push_back(top)) return false;
    uint32_t* at = &tops_.back() - depth;
    std::memmove(at + 1, at, sizeof(uint32_t) * depth);
    *at = top;
    return true;
  }

 private:
  Array<uint32_t> tops_;
};

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_DIGON_STACK_H_
