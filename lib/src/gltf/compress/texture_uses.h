// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds out which textures the texture coordinates of primitives look up, and how large they are.
#ifndef MCC_GLTF_COMPRESS_TEXTURE_USES_H_
#define MCC_GLTF_COMPRESS_TEXTURE_USES_H_

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "gltf/document/document.h"

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

/// Textures of a document. Borrows it. Takes time proportional to its JSON and its data URIs.
class TextureUses {
 public:
  /// What is taken for a texture whose size is not known: its image is a file of its own or of
  /// another format.
  static constexpr double kUsualTexels = 4096;

  explicit TextureUses(const Document& document);

  /// Returns the texels along the longer side of the largest texture that the materials of a
  /// primitive look up by TEXCOORD_<set>, times the scale of its KHR_texture_transform; 0: there is
  /// no such texture. Materials are also those of KHR_materials_variants.
  double texels(const PrimitiveRef& primitive, uint32_t set) const;

 private:
  using BySet = std::map<uint64_t, double>;  ///< texels

  void addTextures(const Json& json, BySet& texels) const;
  double sizeOf(uint64_t texture) const;
  void findTextureSizes();
  double imageTexels(const Json& image) const;

  const Document& document_;
  std::vector<double> texture_texels_;
  std::vector<BySet> of_material_;
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_TEXTURE_USES_H_
