// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stack of the digons that wait, by their tops. Handles put a digon below others; so that this costs the same
// however many wait, the stack is kept in blocks: all but the topmost hold at least half of what fits, and the depth of
// a handle is bounded. [A.4.1] [A.4.4]
#ifndef MCC_CONNECTIVITY_DIGON_STACK_H_
#define MCC_CONNECTIVITY_DIGON_STACK_H_

#include <cstdint>
#include <cstring>

#include "base/memory.h"
#include "mcc/types.h"

namespace mcc {

/// Digons a handle may put one below, at most. Known meshes stay below 5,000.
inline constexpr uint32_t kMaxHandleDepth = 65535;

class DigonStack {
 public:
  explicit DigonStack(const Allocator& allocator) : blocks_(allocator), order_(allocator) {}

  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }
  uint32_t top() const {
    const Block& block = blocks_[order_[order_.size() - 1]];
    return block.tops[block.count - 1];
  }

  /// False without memory.
  [[nodiscard]] bool push(uint32_t top) {
    if (order_.empty() || topBlock().count == kBlock) {
      if (!addBlock(order_.size())) return false;
    }
    Block& block = topBlock();
    block.tops[block.count++] = top;
    ++size_;
    return true;
  }

  void pop() {
    Block& block = topBlock();
    --size_;
    if (--block.count != 0) return;
    block.count = first_free_;
    first_free_ = order_.back();
    order_.pop_back();
  }

  /// Below the topmost `depth` <= size() digons. O(depth / kBlock + kBlock). False without memory.
  [[nodiscard]] bool insertBelow(uint32_t depth, uint32_t top) {
    if (depth == 0) return push(top);
    size_t place = order_.size() - 1;
    while (depth > blocks_[order_[place]].count) depth -= blocks_[order_[place--]].count;
    if (blocks_[order_[place]].count == kBlock) {
      if (!addBlock(place + 1)) return false;
      Block& lower = blocks_[order_[place]];
      Block& upper = blocks_[order_[place + 1]];
      std::memcpy(upper.tops, lower.tops + kBlock / 2, sizeof(uint32_t) * (kBlock / 2));
      lower.count = upper.count = kBlock / 2;
      if (depth <= kBlock / 2) {
        ++place;
      } else {
        depth -= kBlock / 2;
      }
    }
    Block& block = blocks_[order_[place]];
    uint32_t* at = block.tops + (block.count - depth);
    std::memmove(at + 1, at, sizeof(uint32_t) * depth);
    *at = top;
    ++block.count;
    ++size_;
    return true;
  }

 private:
  static constexpr uint32_t kBlock = 512;
  struct Block {
    uint32_t count;  ///< of a block that is not in use: the next of those
    uint32_t tops[kBlock];
  };

  Block& topBlock() { return blocks_[order_.back()]; }

  /// An empty block at `place` of order_.
  [[nodiscard]] bool addBlock(size_t place) {
    if (!order_.push_back(0)) return false;
    uint32_t block = first_free_;
    if (block != kNone) {
      first_free_ = blocks_[block].count;
    } else {
      block = static_cast<uint32_t>(blocks_.size());
      if (!blocks_.push_back(Block{})) {
        order_.pop_back();
        return false;
      }
    }
    blocks_[block].count = 0;
    uint32_t* at = order_.data() + place;
    std::memmove(at + 1, at, sizeof(uint32_t) * (order_.size() - 1 - place));
    *at = block;
    return true;
  }

  Array<Block> blocks_;
  Array<uint32_t> order_;  ///< blocks, from the bottom of the stack
  uint32_t first_free_ = kNone;
  size_t size_ = 0;
};

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_DIGON_STACK_H_
