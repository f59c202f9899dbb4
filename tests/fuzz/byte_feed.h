// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes decisions from the bytes of a fuzzer, and reports what a target finds.
#ifndef MCC_TESTS_FUZZ_BYTE_FEED_H_
#define MCC_TESTS_FUZZ_BYTE_FEED_H_

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

/// The entry point of a target; always returns 0. Does not keep `data`.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace mcc::test {

/// Reports a finding: the process ends, and the fuzzer keeps the input.
inline void require(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "found: %s\n", what.c_str());
  std::abort();
}

/// Takes bytes from the front; returns zeros after the end.
class ByteFeed {
 public:
  ByteFeed(const uint8_t* data, size_t size) : bytes_(data, size) {}

  bool empty() const { return bytes_.empty(); }
  uint32_t byte() {
    if (bytes_.empty()) return 0;
    const uint32_t value = bytes_[0];
    bytes_ = bytes_.subspan(1);
    return value;
  }
  uint32_t u16() {
    const uint32_t low = byte();
    return low | byte() << 8;
  }
  uint32_t u32() {
    const uint32_t low = u16();
    return low | u16() << 16;
  }
  /// At most `count` bytes.
  std::span<const uint8_t> take(size_t count) {
    const std::span<const uint8_t> taken =
        bytes_.first(count < bytes_.size() ? count : bytes_.size());
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }
  std::span<const uint8_t> rest() { return take(bytes_.size()); }

 private:
  std::span<const uint8_t> bytes_;
};

}  // namespace mcc::test

#endif  // MCC_TESTS_FUZZ_BYTE_FEED_H_
