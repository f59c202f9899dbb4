// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_PAYLOAD_H_
#define MCC_GLTF_PAYLOAD_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf/result.h"
#include "mcc/reader.h"

namespace mcc::gltf {

struct DecodedPiece {
  std::vector<std::vector<uint8_t>> attributes;  ///< tight elements, decoded order
  std::vector<std::vector<uint32_t>> parts;      ///< three wedges per triangle
};

/// A payload with everything in it decoded.
struct DecodedPayload {
  Payload payload;
  std::vector<DecodedPiece> pieces;
};

/// What all attributes and all indices of an opened payload take, those of 32 bits.
uint64_t outputBytes(const PayloadInfo& info);

/// A codec status as a result.
Result toResult(const Status& status, const std::string& where);

/// Decodes all pieces of an opened payload.
Status decodePieces(DecodedPayload& decoded, const DecodeOptions& options = {});
Result decodePieces(const std::string& where, DecodedPayload& decoded);

/// Opens and decodes. `bytes` must outlive `decoded`.
Result decodePayload(std::span<const uint8_t> bytes, const std::string& where,
                     DecodedPayload& decoded);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_PAYLOAD_H_
