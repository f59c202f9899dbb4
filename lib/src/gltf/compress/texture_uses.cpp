// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/texture_uses.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "gltf/document/image_size.h"
#include "gltf/document/references.h"
#include "gltf/document/uri.h"

namespace mcc::gltf {
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
      uint64_t image = 0;
      if (asUnsigned(source, image) && image < images.size())
        largest = std::max(largest, images[image]);
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
    uint64_t material = 0;
    if (!asUnsigned(number, material) || material >= of_material_.size()) return;
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
