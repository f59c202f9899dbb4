// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/texture_uses.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "gltf/document/package.h"
#include "gltf/document/references.h"

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

namespace {

/// Returns the larger scale of a texture's transform, of which there may be none.
double scaleOf(const Json* transform) {
  const Json* scale = findMember(transform, "scale");
  if (scale == nullptr || !scale->is_array()) return 1;
  double largest = 0;
  for (const Json& number : *scale) {
    double value = 0;
    if (asNumber(number, value) && std::isfinite(value))
      largest = std::max(largest, std::abs(value));
  }
  return largest;
}

}  // namespace

TextureUses::TextureUses(const Document& document) : document_(document) {
  findTextureSizes();
  for (const Json& material : arrayOf(document.json, "materials")) {
    addTextures(material, of_material_.emplace_back());
  }
}

/// Adds what has the form of a textureInfo: an object with a number `index`. Extensions of
/// materials have theirs in many places. JSON is at most kMaxJsonDepth deep.
void TextureUses::addTextures(const Json& json, BySet& texels) const {
  if (!json.is_structured()) return;
  uint64_t texture = 0;
  if (json.is_object() && asUnsigned(findMember(json, "index"), texture)) {
    uint64_t set = 0;
    (void)asUnsigned(findMember(json, "texCoord"), set);
    const Json* transform = extensionOf(json, "KHR_texture_transform");
    (void)asUnsigned(findMember(transform, "texCoord"), set);
    double& largest = texels[set];
    largest = std::max(largest, sizeOf(texture) * scaleOf(transform));
  }
  for (const Json& value : json) addTextures(value, texels);
}

double TextureUses::sizeOf(uint64_t texture) const {
  return texture < texture_texels_.size() ? texture_texels_[texture] : kUsualTexels;
}

void TextureUses::findTextureSizes() {
  std::vector<double> images;
  for (const Json& image : arrayOf(document_.json, "images")) images.push_back(imageTexels(image));
  for (const Json& texture : arrayOf(document_.json, "textures")) {
    double largest = 0;
    const auto add = [&](const Json* source) {
      const uint32_t image = indexOf(source, images.size());
      if (image != kNone) largest = std::max(largest, images[image]);
    };
    add(findMember(texture, "source"));
    if (const Json* extensions = findMember(texture, "extensions")) {
      for (const Json& extension : *extensions) add(findMember(extension, "source"));
    }
    texture_texels_.push_back(largest == 0 ? kUsualTexels : largest);
  }
}

double TextureUses::imageTexels(const Json& image) const {
  ImageSize size;
  uint64_t number = 0;
  const Json* uri = findMember(image, "uri");
  if (uri != nullptr && uri->is_string() && isDataUri(uri->text())) {
    std::vector<uint8_t> bytes;
    if (decodeDataUri(uri->text(), "", bytes).ok()) size = imageSizeOf(bytes);
  } else if (asUnsigned(findMember(image, "bufferView"), number) &&
             number < document_.views.size()) {
    const BufferView& view = document_.views[number];
    if (!view.isCoded() && view.buffer < document_.buffers.size()) {
      const std::span<const uint8_t> buffer = document_.buffers[view.buffer];
      const uint64_t offset = std::min<uint64_t>(view.offset, buffer.size());
      const uint64_t length = std::min<uint64_t>(view.length, buffer.size() - offset);
      size = imageSizeOf(buffer.subspan(offset, length));
    }
  }
  const double texels = std::max(size.width, size.height);
  return texels == 0 ? kUsualTexels : texels;
}

double TextureUses::texels(const PrimitiveRef& primitive, uint32_t set) const {
  double largest = 0;
  const auto add = [&](const Json* number) {
    const uint32_t material = indexOf(number, of_material_.size());
    if (material == kNone) return;
    const auto found = of_material_[material].find(set);
    if (found != of_material_[material].end()) largest = std::max(largest, found->second);
  };
  const Json& json = *document_.primitive(primitive).json;
  add(findMember(json, "material"));
  if (const Json* variants = extensionOf(json, "KHR_materials_variants")) {
    for (const Json& mapping : arrayOf(*variants, "mappings")) add(findMember(mapping, "material"));
  }
  return largest;
}

}  // namespace mcc::gltf
