// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Memory of one call for many arrays, in huge pages. The first touch of an ordinary page of new memory takes the system as
// long as a dozen vertices take the decoder. Large blocks have pages of their own, given back with them, so that no more is
// in use than must be; the others share regions that are given back at the end.
#ifndef MCC_BASE_WORKING_MEMORY_H_
#define MCC_BASE_WORKING_MEMORY_H_

#include <cstddef>
#include <cstdint>

#include "mcc/reader.h"

namespace mcc {

/// First fit in regions of the system's memory, for blocks that are few; small ones come from malloc. Blocks begin on cache
/// lines. Not for several threads at once.
class WorkingMemory {
 public:
  static constexpr size_t kPageBytes = size_t{1} << 21;   ///< of a huge page
  static constexpr size_t kSmallBytes = size_t{1} << 14;  ///< blocks below come from malloc
  static constexpr size_t kLargeBytes =
      4 * kPageBytes;  ///< blocks from here on have their own pages

  /// expected_bytes  the size of the first region, unless its blocks will be large; the next ones are as large as all before.
  explicit WorkingMemory(uint64_t expected_bytes);
  WorkingMemory(const WorkingMemory&) = delete;
  WorkingMemory& operator=(const WorkingMemory&) = delete;
  ~WorkingMemory();  ///< all blocks must have been released

  /// Null when the system gives no more.
  void* allocate(size_t bytes);
  void release(void* memory, size_t bytes);

  /// Whether this pays: malloc may have less than a huge page at hand, and sanitizers see more of its blocks.
  static bool pays(uint64_t expected_bytes);

  /// Borrows this.
  Allocator allocator();

 private:
  struct FreeBlock {
    size_t bytes;
    FreeBlock* next;  ///< by address
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
  size_t all_bytes_ = 0;  ///< of all regions
};

}  // namespace mcc

#endif  // MCC_BASE_WORKING_MEMORY_H_
