// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Memory for reader and writer: growable arrays of plain data, which report failure instead of
// throwing.
#ifndef MCC_BASE_MEMORY_H_
#define MCC_BASE_MEMORY_H_

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/host.h"
#include "base/status.h"
#include "mcc/allocator.h"

namespace mcc {

#if defined(MCC_COMPACT)

inline void* allocateBytes(const Allocator&, size_t bytes) { return std::malloc(bytes); }
inline void releaseBytes(const Allocator&, void* memory, size_t) { std::free(memory); }
inline bool isHeap(const Allocator&) { return true; }

#else

inline void* allocateBytes(const Allocator& allocator, size_t bytes) {
  return allocator.allocate != nullptr ? allocator.allocate(allocator.user, bytes)
                                       : std::malloc(bytes);
}

inline void releaseBytes(const Allocator& allocator, void* memory, size_t bytes) {
  if (memory == nullptr) return;
  if (allocator.release != nullptr) {
    allocator.release(allocator.user, memory, bytes);
  } else if (allocator.allocate == nullptr) {
    std::free(memory);
  }
}
inline bool isHeap(const Allocator& allocator) { return allocator.allocate == nullptr; }

#endif

/// Allocates `count` elements of `bytes` each and moves the first `used` elements of `old` there;
/// `old` is released. Returns null when memory ran out; then nothing has changed.
MCC_SHARED void* moveElements(const Allocator& allocator, void* old, size_t used, size_t old_count,
                              size_t count, size_t bytes) {
  if (count > SIZE_MAX / bytes) return nullptr;
  void* memory = allocateBytes(allocator, count * bytes);
  if (memory == nullptr) return nullptr;
  if (used != 0) std::memcpy(memory, old, used * bytes);
  releaseBytes(allocator, old, old_count * bytes);
  return memory;
}

/// An array of trivially copyable elements in memory of an Allocator. Every call that may grow it
/// returns false when memory ran out, and then leaves the array as it was.
template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  explicit Array(const Allocator& allocator = {}) : allocator_(allocator) {}
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  MCC_SHARED ~Array() { reset(); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](size_t i) { return data_[i]; }
  const T& operator[](size_t i) const { return data_[i]; }
  const Allocator& allocator() const { return allocator_; }
  T& back() { return data_[size_ - 1]; }
  void pop_back() { --size_; }
  void clear() { size_ = 0; }

  /// Releases the memory.
  void reset() {
    releaseBytes(allocator_, data_, capacity_ * sizeof(T));
    data_ = nullptr;
    size_ = capacity_ = 0;
  }

  [[nodiscard]] bool reserve(size_t capacity) {
    if (capacity <= capacity_) return true;
    void* data = moveElements(allocator_, data_, size_, capacity_, capacity, sizeof(T));
    if (data == nullptr) return false;
    data_ = static_cast<T*>(data);
    capacity_ = capacity;
    return true;
  }

  /// Changes the size. New elements are uninitialised.
  [[nodiscard]] bool resize(size_t size) {
    if (!reserve(size)) return false;
    size_ = size;
    return true;
  }

  [[nodiscard]] bool assign(size_t size, T value) {
    if (!resize(size)) return false;
    if constexpr (kCompact) {  // WebAssembly has an instruction for bytes that are all alike
      const auto* const bytes = reinterpret_cast<const uint8_t*>(&value);
      const auto isFirst = [bytes](uint8_t byte) { return byte == bytes[0]; };
      if (std::all_of(bytes, bytes + sizeof value, isFirst)) {
        if (size != 0) std::memset(data_, bytes[0], size * sizeof value);
        return true;
      }
    }
    for (size_t i = 0; i < size; ++i) data_[i] = value;
    return true;
  }

  [[nodiscard]] bool push_back(T value) {
    if (size_ == capacity_ && !grow()) return false;
    data_[size_++] = value;
    return true;
  }

  void swap(Array& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    std::swap(allocator_, other.allocator_);
  }

 private:
  bool grow() { return reserve(capacity_ < 16 ? 16 : capacity_ + capacity_ / 2); }

  T* data_ = nullptr;
  size_t size_ = 0;
  size_t capacity_ = 0;
  [[no_unique_address]] Allocator allocator_;
};

}  // namespace mcc

#endif  // MCC_BASE_MEMORY_H_
