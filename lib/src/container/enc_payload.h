// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_CONTAINER_ENC_PAYLOAD_H_
#define MCC_CONTAINER_ENC_PAYLOAD_H_

#include <cstdint>
#include <span>
#include <vector>

#include "container/payload_header.h"

namespace mcc {

/// Inverse of parsePayload(). `header` must not contain its streams, and this function sets
/// kSameAttributes, kManyPieces and kPadded.
std::vector<uint8_t> writePayload(const PayloadHeader& header, const Streams& streams);

/// The same for a payload with blocks, which have one element of `streams` each. Fills in what the
/// table says of the streams.
std::vector<uint8_t> writeBlocks(PayloadHeader& header, std::span<const Streams> streams);

}  // namespace mcc

#endif  // MCC_CONTAINER_ENC_PAYLOAD_H_
