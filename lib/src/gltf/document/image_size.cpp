// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/image_size.h"

#include <cstddef>
#include <string>

#include "gltf/document/package.h"

namespace mcc::gltf {
namespace {

using Bytes = std::span<const uint8_t>;

/// Reads a number of `count` bytes; 0 when they are not all there.
uint32_t bigEndian(Bytes bytes, size_t at, size_t count) {
  if (at > bytes.size() || bytes.size() - at < count) return 0;
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

uint32_t littleEndian(Bytes bytes, size_t at, size_t count) {
  if (at > bytes.size() || bytes.size() - at < count) return 0;
  uint32_t value = 0;
  for (size_t i = count; i-- != 0;) value = value << 8 | bytes[at + i];
  return value;
}

/// Walks over the segments of a JPEG to the first start of frame.
ImageSize sizeOfJpeg(Bytes bytes) {
  constexpr int kMostSegments = 1000;
  size_t at = 2;  // behind the start of the image
  for (int i = 0; i < kMostSegments && bigEndian(bytes, at, 1) == 0xff; ++i) {
    const uint32_t marker = bigEndian(bytes, at + 1, 1);
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    const bool is_table = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    if (marker >= 0xc0 && marker <= 0xcf && !is_table) {
      return {bigEndian(bytes, at + 7, 2), bigEndian(bytes, at + 5, 2)};
    }
    const uint32_t length = bigEndian(bytes, at + 2, 2);
    if (length < 2) break;
    at += 2 + size_t{length};
  }
  return {};
}

ImageSize sizeOfWebp(Bytes bytes) {
  switch (bigEndian(bytes, 12, 4)) {
    case 0x56503820:  // "VP8 ": 14 bits each, behind the start code
      return {littleEndian(bytes, 26, 2) & 0x3fff, littleEndian(bytes, 28, 2) & 0x3fff};
    case 0x5650384c: {  // "VP8L": 14 bits each, less one
      const uint32_t sizes = littleEndian(bytes, 21, 4);
      if (bytes.size() < 25) return {};
      return {(sizes & 0x3fff) + 1, (sizes >> 14 & 0x3fff) + 1};
    }
    case 0x56503858:  // "VP8X": 24 bits each, less one
      if (bytes.size() < 30) return {};
      return {littleEndian(bytes, 24, 3) + 1, littleEndian(bytes, 27, 3) + 1};
    default: return {};
  }
}

}  // namespace

ImageSize imageSizeOf(std::span<const uint8_t> bytes) {
  const std::string type = imageTypeOf(bytes);
  if (type == "image/png") return {bigEndian(bytes, 16, 4), bigEndian(bytes, 20, 4)};
  if (type == "image/jpeg") return sizeOfJpeg(bytes);
  if (type == "image/webp") return sizeOfWebp(bytes);
  if (type == "image/ktx2") return {littleEndian(bytes, 20, 4), littleEndian(bytes, 24, 4)};
  return {};
}

}  // namespace mcc::gltf
