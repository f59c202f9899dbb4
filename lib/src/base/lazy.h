// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_BASE_LAZY_H_
#define MCC_BASE_LAZY_H_

#include <cstddef>
#include <cstring>
#include <new>
#include <type_traits>

#include "base/memory.h"

namespace mcc {

/// Plain data that is created when it is first needed. A payload needs only few of the models, and
/// a small payload should not spend time and memory on the others.
template <class T>
class Lazy {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  Lazy() = default;
  Lazy(const Lazy&) = delete;
  Lazy& operator=(const Lazy&) = delete;
  ~Lazy() { releaseBytes(allocator_, made_, sizeof(T)); }

  /// Returns the data, or null when memory ran out. All calls must have the same allocator.
  T* get(const Allocator& allocator) {
    if (made_ != nullptr) return made_;
    allocator_ = allocator;
    void* memory = allocateBytes(allocator, sizeof(T));
    if (memory != nullptr) made_ = new (memory) T;
    return made_;
  }

  /// Becomes a copy of `other` in memory of `allocator`, as for get(). Returns false when memory
  /// ran out.
  [[nodiscard]] bool copyFrom(const Lazy& other, const Allocator& allocator) {
    if (this == &other) return true;
    if (other.made_ == nullptr) {
      releaseBytes(allocator_, made_, sizeof(T));
      made_ = nullptr;
      return true;
    }
    if (get(allocator) == nullptr) return false;
    std::memcpy(static_cast<void*>(made_), other.made_, sizeof(T));
    return true;
  }

 private:
  T* made_ = nullptr;
  [[no_unique_address]] Allocator allocator_;
};

/// The same for arrays of lazy data.
template <class T>
[[nodiscard]] bool copyLazy(Lazy<T>& to, const Lazy<T>& from, const Allocator& allocator) {
  return to.copyFrom(from, allocator);
}
template <class T, size_t kCount>
[[nodiscard]] bool copyLazy(T (&to)[kCount], const T (&from)[kCount], const Allocator& allocator) {
  for (size_t i = 0; i < kCount; ++i) {
    if (!copyLazy(to[i], from[i], allocator)) return false;
  }
  return true;
}

}  // namespace mcc

#endif  // MCC_BASE_LAZY_H_
