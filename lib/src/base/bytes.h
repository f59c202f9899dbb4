// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Little-endian byte fields and varints of the container.                                   [A.1.1]
#ifndef MCC_BASE_BYTES_H_
#define MCC_BASE_BYTES_H_

#include <cstdint>
#include <cstring>
#include <span>

#include "base/status.h"

namespace mcc {

/// Reads fields from the front of a span. Every read checks its bound. Offsets in errors count from
/// the start of the span given to the constructor.
class ByteReader {
 public:
  explicit ByteReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  size_t offset() const { return offset_; }
  size_t remaining() const { return bytes_.size() - offset_; }

  Status readU8(uint8_t& value) {
    if (remaining() < 1) return fail(Error::kTruncated, "the payload ends inside a field", offset_);
    value = bytes_[offset_++];
    return {};
  }

  Status readU32(uint32_t& value) { return readHighBytes(value, 4); }

  /// Reads the highest bytes of a u32; those below are 0. `count` is 1 to 4.
  Status readHighBytes(uint32_t& value, uint32_t count) {
    if (remaining() < count)
      return fail(Error::kTruncated, "the payload ends inside a field", offset_);
    uint32_t high = 0;
    for (uint32_t i = 4 - count; i < 4; ++i) high |= uint32_t{bytes_[offset_++]} << (8 * i);
    value = high;
    return {};
  }

  /// Reads a varint: seven bits per byte, least significant first, at most 32 bits, no redundant
  /// zero byte.
  Status readVarint(uint32_t& value) {
    const size_t start = offset_;
    uint32_t result = 0;
    for (uint32_t shift = 0; shift < 35; shift += 7) {
      uint8_t byte = 0;
      MCC_TRY(readU8(byte));
      if (shift == 28 && byte > 0x0f) break;
      result |= uint32_t{byte & 0x7fu} << shift;
      if ((byte & 0x80u) == 0) {
        if (byte == 0 && shift != 0) break;
        value = result;
        return {};
      }
    }
    return fail(Error::kBadHeader, "a variable-length integer is malformed", start);
  }

  Status readBytes(size_t count, std::span<const uint8_t>& bytes) {
    if (remaining() < count) {
      return fail(Error::kTruncated, "the payload ends inside a stream", offset_);
    }
    bytes = bytes_.subspan(offset_, count);
    offset_ += count;
    return {};
  }

 private:
  std::span<const uint8_t> bytes_;
  size_t offset_ = 0;
};

/// Zigzag mapping of signed to unsigned integers: 0, -1, 1, -2, 2, … -> 0, 1, 2, 3, 4, …
constexpr uint32_t zigzag(int32_t value) {
  return (static_cast<uint32_t>(value) << 1) ^ static_cast<uint32_t>(value >> 31);
}
constexpr int32_t unzigzag(uint32_t value) {
  return static_cast<int32_t>((value >> 1) ^ (~(value & 1) + 1));
}

}  // namespace mcc

#endif  // MCC_BASE_BYTES_H_
