// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_DECODED_BYTES_H_
#define MCC_GLTF_DECODED_BYTES_H_

#include <cstdint>

#include "gltf/result.h"

namespace mcc::gltf {

/// What decoding a document takes, added up before memory is taken for it.
class DecodedBytes {
 public:
  /// No limit.
  DecodedBytes() = default;
  /// max_decoded_bytes, file_bytes  as decodedLimit() takes them.
  DecodedBytes(uint64_t max_decoded_bytes, uint64_t file_bytes);

  /// Counts without a check; saturates.
  void add(uint64_t bytes);
  /// Errors: more than the limit. They say how much, and what raises the limit.
  Result check() const;

  uint64_t total() const { return total_; }
  /// What accessors without bytes in the file may take of the limit. They cost a file nothing at all.
  uint64_t zeroLimit() const { return limit_ / 32; }

 private:
  uint64_t limit_ = ~uint64_t{0};
  uint64_t file_bytes_ = 0;
  uint64_t total_ = 0;
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECODED_BYTES_H_
