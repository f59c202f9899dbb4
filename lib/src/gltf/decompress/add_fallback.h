// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_DECOMPRESS_ADD_FALLBACK_H_
#define MCC_GLTF_DECOMPRESS_ADD_FALLBACK_H_

#include <cstdint>
#include <vector>

#include "json/json.h"

namespace mcc::gltf {

/// Adds another buffer, the last one, to a compressed document. The extension is no longer
/// required. The caller names the buffer.
/// bin       the bytes of the first buffer.
/// fallback  receives the bytes of the new one, made from the decoded payloads.
Result addFallback(const std::vector<uint8_t>& bin, Json& json, std::vector<uint8_t>& fallback);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECOMPRESS_ADD_FALLBACK_H_
