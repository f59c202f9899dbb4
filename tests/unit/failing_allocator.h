// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// An allocator that checks what it gets back, and can run out of memory.
#ifndef MCC_TESTS_UNIT_FAILING_ALLOCATOR_H_
#define MCC_TESTS_UNIT_FAILING_ALLOCATOR_H_

#include <cstdint>
#include <cstdlib>
#include <map>

#include "mcc/reader.h"

namespace mcc::test {

class FailingAllocator {
 public:
  static constexpr uint64_t kNever = ~uint64_t{0};

  /// Gives `allocation_count` times, then never again.
  explicit FailingAllocator(uint64_t allocation_count = kNever) : left_(allocation_count) {}
  FailingAllocator(const FailingAllocator&) = delete;
  FailingAllocator& operator=(const FailingAllocator&) = delete;
  ~FailingAllocator() {
    for (const auto& [memory, bytes] : live_) std::free(memory);
  }

  Allocator allocator() {
    return {[](void* user, size_t bytes) {
              return static_cast<FailingAllocator*>(user)->allocate(bytes);
            },
            [](void* user, void* memory, size_t bytes) {
              static_cast<FailingAllocator*>(user)->release(memory, bytes);
            },
            this};
  }

  uint64_t allocations() const { return allocations_; }
  size_t liveBlocks() const { return live_.size(); }
  /// Whether each block came back once, with its size.
  bool booksBalance() const { return books_balance_; }

 private:
  void* allocate(size_t bytes) {
    if (left_ == 0) return nullptr;
    if (left_ != kNever) --left_;
    ++allocations_;
    void* memory = std::malloc(bytes);
    live_[memory] = bytes;
    return memory;
  }
  void release(void* memory, size_t bytes) {
    const auto block = live_.find(memory);
    if (block == live_.end() || block->second != bytes) {
      books_balance_ = false;
      return;
    }
    live_.erase(block);
    std::free(memory);
  }

  uint64_t left_;
  uint64_t allocations_ = 0;
  std::map<void*, size_t> live_;
  bool books_balance_ = true;
};

}  // namespace mcc::test

#endif  // MCC_TESTS_UNIT_FAILING_ALLOCATOR_H_
