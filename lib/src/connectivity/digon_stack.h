// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stack of the waiting digons, each represented by its top. [A.4.1] [A.4.4]
#ifndef MCC_CONNECTIVITY_DIGON_STACK_H_
#define MCC_CONNECTIVITY_DIGON_STACK_H_

#include <cstdint>
#include <cstring>

#include "base/memory.h"

namespace mcc {

/// The most digons that a handle may insert a digon below. The limit bounds the work that one
/// handle causes; the writer cuts surfaces that would exceed it.
inline constexpr uint32_t kMaxHandleDepth = 255;

class DigonStack {
 public:
  explicit DigonStack(const Allocator& allocator) : tops_(allocator) {}

  bool empty() const { return tops_.empty(); }
  size_t size() const { return tops_.size(); }
  uint32_t top() const { return tops_[tops_.size() - 1]; }
  void pop() { tops_.pop_back(); }

  /// Inserts `top` below the topmost `depth` digons; `depth` must be at most size(). Returns false
  /// if there is no memory. O(depth).
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
