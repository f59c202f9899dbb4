// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_CONTAINER_ENC_PAYLOAD_H_
#define MCC_CONTAINER_ENC_PAYLOAD_H_

#include <cstdint>
#include <span>
#include <vector>

#include "container/payload_header.h"

namespace mcc {

/// Inverse of parsePayload(). `header` must not contain its streams, and this function sets
/// kSameAttributes.
std::vector<uint8_t> writePayload(const PayloadHeader& header, std::span<const uint8_t> codes,
                                  std::span<const uint8_t> tokens, std::span<const uint8_t> raw);

}  // namespace mcc

#endif  // MCC_CONTAINER_ENC_PAYLOAD_H_
