// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TESTS_SUPPORT_COUNTING_ALLOCATOR_H_
#define MCC_TESTS_SUPPORT_COUNTING_ALLOCATOR_H_

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "mcc/reader.h"

namespace mcc::test {

/// Counts the bytes that are taken from it. For one thread at a time.
class CountingAllocator {
 public:
  Allocator allocator() {
    return {[](void* user, size_t bytes) -> void* {
              auto* self = static_cast<CountingAllocator*>(user);
              self->all_bytes_ += bytes;
              self->used_bytes_ += bytes;
              self->peak_bytes_ = std::max(self->peak_bytes_, self->used_bytes_);
              return std::malloc(bytes);
            },
            [](void* user, void* memory, size_t bytes) {
              static_cast<CountingAllocator*>(user)->used_bytes_ -= bytes;
              std::free(memory);
            },
            this};
  }
  uint64_t allBytes() const { return all_bytes_; }  ///< that were ever taken
  uint64_t usedBytes() const { return used_bytes_; }
  uint64_t peakBytes() const { return peak_bytes_; }

 private:
  uint64_t all_bytes_ = 0;
  uint64_t used_bytes_ = 0;
  uint64_t peak_bytes_ = 0;
};

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_COUNTING_ALLOCATOR_H_
