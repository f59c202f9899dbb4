// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_ALLOCATOR_H_
#define MCC_ALLOCATOR_H_

#include <cstddef>

namespace mcc {

/// Where the reader takes memory from. Both functions are null, for malloc and free, or neither.
/// `allocate` must return memory aligned as malloc's is; `release` gets the size that was asked
/// for. They are called on the threads of open(), decode() and the Payload's destructor, so they
/// must be safe for parallel calls if payloads are decoded in parallel.
struct Allocator {
  void* (*allocate)(void* user, size_t bytes) = nullptr;  ///< may return null: kOutOfMemory
  void (*release)(void* user, void* memory, size_t bytes) = nullptr;
  void* user = nullptr;
};

}  // namespace mcc

#endif  // MCC_ALLOCATOR_H_
