// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// How much memory a piece of code has in use at most. Linking this file replaces operator new and
// delete of the program, hence also those of the codecs it calls.
#ifndef MCC_TOOLS_BENCH_MEMORY_COUNT_H_
#define MCC_TOOLS_BENCH_MEMORY_COUNT_H_

#include <cstdint>

#include "mcc/reader.h"

namespace mcc::bench {

/// Counts from its construction to its end, on this thread: the bytes asked for from operator new
/// and from countedAllocator(), and not yet given back. Not counted: what C code takes from malloc
/// (zstd's context of 160 kB), and what an allocator adds of its own. One at a time per thread.
class MemoryCount {
 public:
  MemoryCount();
  ~MemoryCount();
  MemoryCount(const MemoryCount&) = delete;
  MemoryCount& operator=(const MemoryCount&) = delete;

  uint64_t liveBytes() const;
  uint64_t peakBytes() const;
  /// The peak from now on.
  void restartPeak();
};

/// malloc and free, counted while a MemoryCount exists.
Allocator countedAllocator();

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_MEMORY_COUNT_H_
