// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_DOCUMENT_IMAGE_TYPE_H_
#define MCC_GLTF_DOCUMENT_IMAGE_TYPE_H_

#include <cstdint>
#include <span>
#include <string>

namespace mcc::gltf {

/// Returns the media type of an image by its first bytes, for the types of glTF and of its
/// extensions for textures (PNG, JPEG, KTX 2, WebP, AVIF, DDS, Basis), and an empty string for
/// everything else. What the JSON or the name of a file says does not count.
std::string imageTypeOf(std::span<const uint8_t> bytes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_IMAGE_TYPE_H_
