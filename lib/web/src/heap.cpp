// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The decoder's heap. It holds few blocks, most of them large, so a simple list of free blocks
// suffices; the C library's allocator would be ten times the code.
#include <cstddef>
#include <cstdint>

namespace {

constexpr size_t kUnit = 16;  ///< alignment, and the size of a block's header
constexpr size_t kPage = 65536;
constexpr size_t kLargest = SIZE_MAX / 2;

/// The header of every block. `next` is used by free blocks only; they are sorted by address.
struct Block {
  size_t bytes;  ///< including this header
  Block* next;

  uint8_t* end() { return reinterpret_cast<uint8_t*>(this) + bytes; }
};
static_assert(sizeof(Block) <= kUnit);

Block* free_blocks = nullptr;

void insert(Block* block) {
  Block** link = &free_blocks;
  Block* before = nullptr;
  while (*link != nullptr && *link < block) {
    before = *link;
    link = &before->next;
  }
  block->next = *link;
  *link = block;
  if (block->end() == reinterpret_cast<uint8_t*>(block->next)) {
    block->bytes += block->next->bytes;
    block->next = block->next->next;
  }
  if (before != nullptr && before->end() == reinterpret_cast<uint8_t*>(block)) {
    before->bytes += block->bytes;
    before->next = block->next;
  }
}

/// Adds a free block at the end of the memory. insert() joins it with a free block before it.
bool grow(size_t bytes) {
  const size_t pages = (bytes + kPage - 1) / kPage;
  const size_t old_pages = __builtin_wasm_memory_grow(0, pages);
  if (old_pages == SIZE_MAX) return false;
  Block* block = reinterpret_cast<Block*>(old_pages * kPage);
  block->bytes = pages * kPage;
  insert(block);
  return true;
}

Block* take(size_t bytes) {
  for (Block** link = &free_blocks; *link != nullptr; link = &(*link)->next) {
    Block* block = *link;
    if (block->bytes < bytes) continue;
    *link = block->next;
    if (block->bytes - bytes >= 2 * kUnit) {
      Block* rest = reinterpret_cast<Block*>(reinterpret_cast<uint8_t*>(block) + bytes);
      rest->bytes = block->bytes - bytes;
      block->bytes = bytes;
      insert(rest);
    }
    return block;
  }
  return nullptr;
}

}  // namespace

extern "C" void* malloc(size_t size) {
  if (size > kLargest) return nullptr;
  const size_t bytes = (size + 2 * kUnit - 1) / kUnit * kUnit;
  Block* block = take(bytes);
  if (block == nullptr && grow(bytes)) block = take(bytes);
  return block == nullptr ? nullptr : reinterpret_cast<uint8_t*>(block) + kUnit;
}

extern "C" void free(void* memory) {
  if (memory != nullptr) insert(reinterpret_cast<Block*>(static_cast<uint8_t*>(memory) - kUnit));
}
