// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_BASE_DECODED_BYTES_H_
#define MCC_GLTF_BASE_DECODED_BYTES_H_

#include <cstdint>

#include "gltf/base/result.h"

namespace mcc::gltf {

/// Adds up the bytes that decoding a document takes, before memory is taken for them.
class DecodedBytes {
 public:
  /// Counts without a limit.
  DecodedBytes() = default;
  /// Sets the limit from max_decoded_bytes and file_bytes, see decodedLimit().
  DecodedBytes(uint64_t max_decoded_bytes, uint64_t file_bytes);

  /// Adds to the sum without a check. The sum saturates.
  void add(uint64_t bytes);
  /// Fails when the sum is above the limit. The message states both and says how to raise the
  /// limit.
  Result check() const;

  uint64_t total() const { return total_; }
  /// Returns how much of the limit accessors may take that have no bytes in the file. They need a
  /// bound of their own, because a file can claim them at no cost.
  uint64_t zeroLimit() const { return limit_ / 32; }

 private:
  uint64_t limit_ = ~uint64_t{0};
  uint64_t file_bytes_ = 0;
  uint64_t total_ = 0;
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_BASE_DECODED_BYTES_H_
