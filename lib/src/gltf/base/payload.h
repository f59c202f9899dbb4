// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_BASE_PAYLOAD_H_
#define MCC_GLTF_BASE_PAYLOAD_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf/base/parallel.h"
#include "gltf/base/result.h"
#include "mcc/reader.h"

namespace mcc::gltf {

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
Status decodePieces(DecodedPayload& decoded, const DecodeOptions& options = {});
Result decodePieces(const std::string& where, DecodedPayload& decoded, const RunJobs& run_jobs);

/// Opens a payload and decodes all of it. `bytes` must outlive `decoded`.
Result decodePayload(std::span<const uint8_t> bytes, const std::string& where,
                     DecodedPayload& decoded, const RunJobs& run_jobs = {});

}  // namespace mcc::gltf

#endif  // MCC_GLTF_BASE_PAYLOAD_H_
