// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Uncompressed data beside the payloads, for loaders that do not know the extension: the compressed
// accessors refer to buffer views of a second buffer, which those who know it never read.
#ifndef MCC_GLTF_FALLBACK_H_
#define MCC_GLTF_FALLBACK_H_

#include <cstdint>
#include <string>
#include <vector>

#include "gltf/json.h"

namespace mcc::gltf {

/// Adds the second buffer to a compressed document with one buffer; the extension is no longer required.
/// bin       the bytes of that buffer.
/// fallback  receives those of the second one, made from the decoded payloads.
Result addFallback(const std::vector<uint8_t>& bin, const std::string& uri, Json& json,
                   std::vector<uint8_t>& fallback);

/// Takes a fallback out of a document whose buffer `number` is not there. False, and nothing is
/// changed, when anything but compressed accessors may need that buffer.
bool removeFallback(size_t number, Json& json);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FALLBACK_H_
