// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_DECOMPRESS_ADD_FALLBACK_H_
#define MCC_GLTF_DECOMPRESS_ADD_FALLBACK_H_

#include <cstdint>
#include <string>
#include <vector>

#include "json/json.h"

namespace mcc::gltf {

/// Adds the second buffer to a compressed document with one buffer. The extension is no longer
/// required.
/// bin       the bytes of the first buffer.
/// fallback  receives the bytes of the second one, made from the decoded payloads.
Result addFallback(const std::vector<uint8_t>& bin, const std::string& uri, Json& json,
                   std::vector<uint8_t>& fallback);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECOMPRESS_ADD_FALLBACK_H_
