// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Payloads and everything decoded from them, and how much that may be.
#ifndef MCC_GLTF_DOCUMENT_PAYLOAD_H_
#define MCC_GLTF_DOCUMENT_PAYLOAD_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/parallel.h"
#include "host/result.h"
#include "mcc/reader.h"

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

struct DecodedPiece {
  std::vector<std::vector<uint8_t>> attributes;  ///< packed elements in decoded order
  std::vector<std::vector<uint32_t>> parts;      ///< three wedges per triangle
};

/// A payload and everything decoded from it.
struct DecodedPayload {
  Payload payload;
  std::vector<DecodedPiece> pieces;
};

/// Returns the bytes of all attributes of an opened payload, and of all its indices with 32 bits
/// each.
uint64_t outputBytes(const PayloadInfo& info);

/// Converts a codec status to a result.
Result toResult(const Status& status, const std::string& where);

/// Decodes all pieces of an opened payload.
Status decodePieces(DecodedPayload& decoded, const mcc::DecodeOptions& options = {});
Result decodePieces(const std::string& where, DecodedPayload& decoded, const RunJobs& run_jobs);

/// Opens a payload and decodes all of it. `bytes` must outlive `decoded`.
Result decodePayload(std::span<const uint8_t> bytes, const std::string& where,
                     DecodedPayload& decoded, const RunJobs& run_jobs = {});

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_PAYLOAD_H_
