// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Memory for the many arrays of one call, in huge pages. The first access to an ordinary page of
// new memory costs as much time as decoding a dozen vertices. Large blocks have pages of their own,
// which are returned when the block is released, so that no more memory is in use than necessary.
// The other blocks share regions that are returned at the end.
#ifndef MCC_BASE_WORKING_MEMORY_H_
#define MCC_BASE_WORKING_MEMORY_H_

#include <cstddef>
#include <cstdint>

#include "mcc/allocator.h"

namespace mcc {

/// A first-fit allocator in regions of the system's memory, for few blocks; small ones come from
/// malloc. Blocks begin on cache lines. Must not be used by several threads at once.
class WorkingMemory {
 public:
  static constexpr size_t kPageBytes = size_t{1} << 21;   ///< size of a huge page
  static constexpr size_t kSmallBytes = size_t{1} << 14;  ///< smaller blocks come from malloc
  /// Blocks of at least this size have their own pages.
  static constexpr size_t kLargeBytes = 4 * kPageBytes;

  /// expected_bytes  is the size of the first region, unless its blocks will be large. Each further
  ///                 region is as large as all before it together.
  explicit WorkingMemory(uint64_t expected_bytes);
  WorkingMemory(const WorkingMemory&) = delete;
  WorkingMemory& operator=(const WorkingMemory&) = delete;
  ~WorkingMemory();  ///< all blocks must have been released

  /// Returns null when the system has no more memory.
  void* allocate(size_t bytes);
  void release(void* memory, size_t bytes);

  /// Whether this pays off. malloc may use less than a huge page for small payloads, and sanitizers
  /// can check more of its blocks.
  static bool pays(uint64_t expected_bytes);

  /// Returns an allocator that borrows this object.
  Allocator allocator();

 private:
  struct FreeBlock {
    size_t bytes;
    FreeBlock* next;  ///< the next block by address
  };
  struct Region {
    void* memory;
    size_t bytes;
  };
  static constexpr size_t kMaxRegions = 32;

  bool addRegion(size_t bytes);
  void addFree(void* memory, size_t bytes);

  FreeBlock* free_ = nullptr;
  size_t next_region_bytes_;
  Region regions_[kMaxRegions];
  size_t region_count_ = 0;
  size_t all_bytes_ = 0;  ///< sum of all regions
};

}  // namespace mcc

#endif  // MCC_BASE_WORKING_MEMORY_H_
