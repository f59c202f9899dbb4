// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_BASE_LAZY_H_
#define MCC_BASE_LAZY_H_

#include <cstddef>
#include <cstring>
#include <new>
#include <type_traits>

namespace mcc {

/// Plain data that is made when it is first asked for: a payload needs few of all models, and a small one has no time for
/// the others. Copies have what the original had.
template <class T>
class Lazy {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  Lazy() {}  // leaves the memory alone
  Lazy(const Lazy& other) { *this = other; }
  Lazy& operator=(const Lazy& other) {
    is_made_ = other.is_made_;
    if (is_made_ && this != &other) std::memcpy(memory_, other.memory_, sizeof memory_);
    return *this;
  }

  T& get() {
    if (!is_made_) new (memory_) T;
    is_made_ = true;
    return *std::launder(reinterpret_cast<T*>(memory_));
  }

 private:
  alignas(T) std::byte memory_[sizeof(T)];
  bool is_made_ = false;
};

}  // namespace mcc

#endif  // MCC_BASE_LAZY_H_
