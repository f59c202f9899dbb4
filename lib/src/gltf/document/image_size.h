// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_DOCUMENT_IMAGE_SIZE_H_
#define MCC_GLTF_DOCUMENT_IMAGE_SIZE_H_

#include <cstdint>
#include <span>

namespace mcc::gltf {

/// Pixels of an image; 0: unknown.
struct ImageSize {
  uint32_t width = 0;
  uint32_t height = 0;
};

/// Reads the size of a PNG, JPEG, WebP or KTX 2 image from its header. Unknown for other bytes, and
/// for a JPEG with a thousand segments before its size. Safe for untrusted input; takes constant
/// time.
ImageSize imageSizeOf(std::span<const uint8_t> bytes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_IMAGE_SIZE_H_
