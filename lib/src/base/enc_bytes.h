// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_BASE_ENC_BYTES_H_
#define MCC_BASE_ENC_BYTES_H_

#include <cstdint>
#include <span>
#include <vector>

namespace mcc {

/// Writes the fields that ByteReader reads.
class ByteWriter {
 public:
  std::vector<uint8_t>& bytes() { return bytes_; }
  size_t size() const { return bytes_.size(); }

  void writeU8(uint8_t value) { bytes_.push_back(value); }
  void writeU32(uint32_t value) { writeHighBytes(value, 4); }
  void writeHighBytes(uint32_t value, uint32_t count) {
    for (uint32_t i = 4 - count; i < 4; ++i)
      bytes_.push_back(static_cast<uint8_t>(value >> (8 * i)));
  }
  void writeVarint(uint32_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<uint8_t>(value | 0x80));
    bytes_.push_back(static_cast<uint8_t>(value));
  }
  void writeBytes(std::span<const uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

 private:
  std::vector<uint8_t> bytes_;
};

}  // namespace mcc

#endif  // MCC_BASE_ENC_BYTES_H_
