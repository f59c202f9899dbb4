// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/memory_count.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <new>
#include <unordered_map>

namespace mcc::bench {
namespace {

/// The table of sizes must not count itself.
template <typename T>
struct PlainAllocator {
  using value_type = T;

  PlainAllocator() = default;
  template <typename Other>
  PlainAllocator(const PlainAllocator<Other>&) {}

  T* allocate(size_t count) {
    void* memory = std::malloc(count * sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t) { std::free(memory); }
  bool operator==(const PlainAllocator&) const { return true; }
};

struct Counts {
  std::unordered_map<void*, size_t, std::hash<void*>, std::equal_to<void*>,
                     PlainAllocator<std::pair<void* const, size_t>>>
      sizes;
  uint64_t live_bytes = 0;
  uint64_t peak_bytes = 0;
};

thread_local bool is_counting = false;
thread_local Counts* counts = nullptr;  // alive while is_counting

void noteAllocation(void* memory, size_t bytes) {
  if (!is_counting) return;
  counts->sizes[memory] = bytes;
  counts->live_bytes += bytes;
  counts->peak_bytes = std::max(counts->peak_bytes, counts->live_bytes);
}

void noteRelease(void* memory) {
  if (!is_counting) return;
  const auto found = counts->sizes.find(memory);
  if (found == counts->sizes.end()) return;  // older than the count
  counts->live_bytes -= found->second;
  counts->sizes.erase(found);
}

void* countedAllocate(void*, size_t bytes) {
  void* memory = std::malloc(bytes);
  if (memory != nullptr) noteAllocation(memory, bytes);
  return memory;
}

void countedRelease(void*, void* memory, size_t) {
  noteRelease(memory);
  std::free(memory);
}

/// What the replaced operators do.
void* allocateForNew(size_t bytes, size_t alignment) {
  bytes = std::max<size_t>(bytes, 1);
  void* memory = nullptr;
  if (alignment <= alignof(std::max_align_t)) {
    memory = std::malloc(bytes);
  } else {
    memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  }
  if (memory != nullptr) noteAllocation(memory, bytes);
  return memory;
}

void releaseForDelete(void* memory) {
  if (memory == nullptr) return;
  noteRelease(memory);
  std::free(memory);
}

}  // namespace

MemoryCount::MemoryCount() {
  void* place = std::malloc(sizeof(Counts));
  if (place == nullptr) throw std::bad_alloc();
  counts = new (place) Counts;
  is_counting = true;
}

MemoryCount::~MemoryCount() {
  is_counting = false;
  counts->~Counts();
  std::free(counts);
  counts = nullptr;
}

uint64_t MemoryCount::liveBytes() const { return counts->live_bytes; }

uint64_t MemoryCount::peakBytes() const { return counts->peak_bytes; }

void MemoryCount::restartPeak() { counts->peak_bytes = counts->live_bytes; }

Allocator countedAllocator() { return {countedAllocate, countedRelease, nullptr}; }

}  // namespace mcc::bench

// All forms of the operators: those of the standard library would call the first ones, those of a
// sanitizer would not, and it asks that memory go back to where it came from.
void* operator new(std::size_t bytes) {
  void* memory = mcc::bench::allocateForNew(bytes, 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  void* memory = mcc::bench::allocateForNew(bytes, static_cast<std::size_t>(alignment));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return mcc::bench::allocateForNew(bytes, 1);
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return mcc::bench::allocateForNew(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { mcc::bench::releaseForDelete(memory); }
void operator delete(void* memory, std::size_t) noexcept { mcc::bench::releaseForDelete(memory); }
void operator delete(void* memory, std::align_val_t) noexcept {
  mcc::bench::releaseForDelete(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  mcc::bench::releaseForDelete(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  mcc::bench::releaseForDelete(memory);
}
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
  mcc::bench::releaseForDelete(memory);
}
void* operator new[](std::size_t bytes) {
  void* memory = mcc::bench::allocateForNew(bytes, 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  void* memory = mcc::bench::allocateForNew(bytes, static_cast<std::size_t>(alignment));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return mcc::bench::allocateForNew(bytes, 1);
}
void* operator new[](std::size_t bytes, std::align_val_t alignment,
                     const std::nothrow_t&) noexcept {
  return mcc::bench::allocateForNew(bytes, static_cast<std::size_t>(alignment));
}
void operator delete[](void* memory) noexcept { mcc::bench::releaseForDelete(memory); }
void operator delete[](void* memory, std::size_t) noexcept { mcc::bench::releaseForDelete(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept {
  mcc::bench::releaseForDelete(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  mcc::bench::releaseForDelete(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
  mcc::bench::releaseForDelete(memory);
}
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
  mcc::bench::releaseForDelete(memory);
}
