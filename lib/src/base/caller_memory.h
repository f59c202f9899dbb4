// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_BASE_CALLER_MEMORY_H_
#define MCC_BASE_CALLER_MEMORY_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace mcc {

/// Whether elements can be where a caller says, `stride_bytes` apart from `first` on: no object has
/// more than PTRDIFF_MAX bytes or goes beyond the last address. What really is there, only the
/// caller knows.
inline bool canBeInMemory(const void* first, uint64_t count, size_t stride_bytes,
                          size_t element_bytes) {
  if (count == 0) return true;
  const auto bytes_after = UINTPTR_MAX - reinterpret_cast<uintptr_t>(first);
  const uint64_t most = std::min<uint64_t>(PTRDIFF_MAX, bytes_after);
  return element_bytes <= most &&
         (count == 1 || stride_bytes <= (most - element_bytes) / (count - 1));
}

}  // namespace mcc

#endif  // MCC_BASE_CALLER_MEMORY_H_
