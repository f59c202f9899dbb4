// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "base/working_memory.h"

#include <algorithm>
#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#elif defined(_WIN32)
#include <malloc.h>
#endif

namespace mcc {
namespace {

constexpr size_t kLineBytes = 64;
constexpr size_t kLargestMemory = SIZE_MAX / 4;

constexpr size_t roundUp(size_t bytes, size_t unit) { return (bytes + unit - 1) / unit * unit; }

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
constexpr bool kIsSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kIsSanitized = false;
#endif

#if defined(__linux__) && defined(MADV_HUGEPAGE)

constexpr bool kHasHugePages = true;

/// Maps memory aligned to kPageBytes. `bytes` must be a multiple of kPageBytes.
void* mapPages(size_t bytes) {
  constexpr size_t kPage = WorkingMemory::kPageBytes;
  void* mapped =
      mmap(nullptr, bytes + kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) return nullptr;
  const uintptr_t begin = reinterpret_cast<uintptr_t>(mapped);
  const size_t before = static_cast<size_t>((0 - begin) % kPage);
  uint8_t* aligned = static_cast<uint8_t*>(mapped) + before;
  if (before != 0) munmap(mapped, before);
  munmap(aligned + bytes, kPage - before);
  (void)madvise(aligned, bytes, MADV_HUGEPAGE);  // without huge pages it is only slower
  return aligned;
}
void unmapPages(void* memory, size_t bytes) { munmap(memory, bytes); }

#else

constexpr bool kHasHugePages = false;

#if defined(_WIN32)
void* mapPages(size_t bytes) { return _aligned_malloc(bytes, kLineBytes); }
void unmapPages(void* memory, size_t) { _aligned_free(memory); }
#else
void* mapPages(size_t bytes) { return std::aligned_alloc(kLineBytes, bytes); }
void unmapPages(void* memory, size_t) { std::free(memory); }
#endif

#endif

}  // namespace

WorkingMemory::WorkingMemory(uint64_t expected_bytes)
    : next_region_bytes_(static_cast<size_t>(std::min<uint64_t>(expected_bytes, kLargeBytes))) {}

WorkingMemory::~WorkingMemory() {
  for (size_t i = 0; i < region_count_; ++i) unmapPages(regions_[i].memory, regions_[i].bytes);
}

bool WorkingMemory::pays(uint64_t expected_bytes) {
  return kHasHugePages && !kIsSanitized && expected_bytes >= kPageBytes;
}

void* WorkingMemory::allocate(size_t bytes) {
  if (bytes < kSmallBytes) return std::malloc(bytes);
  if (bytes > kLargestMemory) return nullptr;
  if (bytes >= kLargeBytes) return mapPages(roundUp(bytes, kPageBytes));
  bytes = roundUp(bytes, kLineBytes);
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (FreeBlock** link = &free_; *link != nullptr; link = &(*link)->next) {
      FreeBlock* block = *link;
      if (block->bytes < bytes) continue;
      if (block->bytes == bytes) {
        *link = block->next;
      } else {
        FreeBlock* rest = reinterpret_cast<FreeBlock*>(reinterpret_cast<uint8_t*>(block) + bytes);
        *rest = {block->bytes - bytes, block->next};
        *link = rest;
      }
      return block;
    }
    if (attempt == 0 && !addRegion(bytes)) return nullptr;
  }
  return nullptr;
}

void WorkingMemory::release(void* memory, size_t bytes) {
  if (bytes < kSmallBytes) return std::free(memory);
  if (bytes >= kLargeBytes) return unmapPages(memory, roundUp(bytes, kPageBytes));
  addFree(memory, roundUp(bytes, kLineBytes));
}

bool WorkingMemory::addRegion(size_t bytes) {
  if (region_count_ == kMaxRegions) return false;
  size_t region_bytes = roundUp(std::max(bytes, next_region_bytes_), kPageBytes);
  void* memory = mapPages(region_bytes);
  if (memory == nullptr) {  // try the smallest region that is enough
    region_bytes = roundUp(bytes, kPageBytes);
    memory = mapPages(region_bytes);
  }
  if (memory == nullptr) return false;
  regions_[region_count_++] = {memory, region_bytes};
  all_bytes_ += region_bytes;
  next_region_bytes_ = all_bytes_;
  addFree(memory, region_bytes);
  return true;
}

/// Adds a free block, and joins it with its neighbours in the list if they touch.
void WorkingMemory::addFree(void* memory, size_t bytes) {
  FreeBlock* before = nullptr;
  FreeBlock* after = free_;
  while (after != nullptr &&
         reinterpret_cast<uintptr_t>(after) < reinterpret_cast<uintptr_t>(memory)) {
    before = after;
    after = after->next;
  }
  const auto endOf = [](FreeBlock* block) {
    return reinterpret_cast<uint8_t*>(block) + block->bytes;
  };
  FreeBlock* block = static_cast<FreeBlock*>(memory);
  *block = {bytes, after};
  if (after != nullptr && endOf(block) == reinterpret_cast<uint8_t*>(after)) {
    *block = {bytes + after->bytes, after->next};
  }
  if (before == nullptr) {
    free_ = block;
  } else if (endOf(before) == reinterpret_cast<uint8_t*>(block)) {
    *before = {before->bytes + block->bytes, block->next};
  } else {
    before->next = block;
  }
}

Allocator WorkingMemory::allocator() {
  return {
      [](void* user, size_t bytes) { return static_cast<WorkingMemory*>(user)->allocate(bytes); },
      [](void* user, void* memory, size_t bytes) {
        static_cast<WorkingMemory*>(user)->release(memory, bytes);
      },
      this};
}

}  // namespace mcc
