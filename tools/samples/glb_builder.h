// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Builds one GLB with what samples show beside meshes: materials, pictures, sparse and integer
// accessors, scenes with names.
#ifndef MCC_TOOLS_SAMPLES_GLB_BUILDER_H_
#define MCC_TOOLS_SAMPLES_GLB_BUILDER_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "support/gltf_builder.h"

namespace mcc::samples {

using gltf::Json;

class GlbBuilder : public gltf::test::Builder {
 public:
  /// `title` names the scene and its first node.
  explicit GlbBuilder(const std::string& title);

  /// Adds vertex attributes: `components` (1..4) floats per element. Writes min and max.
  uint32_t addFloats(const std::vector<float>& values, uint32_t components);
  /// Like addFloats(), for anything that is not a vertex attribute (animation; inverse bind
  /// matrices, with 16 components).
  uint32_t addPlainFloats(const std::vector<float>& values, uint32_t components);
  /// Adds integer vertex attributes. Elements are padded to a multiple of four bytes, as glTF
  /// requires. `values` holds components * count numbers in the range of `type`.
  uint32_t addIntegers(std::span<const int32_t> values, uint32_t components, ComponentType type,
                       bool normalized);
  /// Adds indices, 16 bits wide if they fit.
  uint32_t addIndices(std::span<const uint32_t> indices);
  /// Adds a VEC3 float accessor that takes the elements of `base`, and replaces those at `where`
  /// (ascending) by `values`.
  uint32_t addSparseFloats(uint32_t base_accessor, std::span<const float> base,
                           std::span<const uint32_t> where, const std::vector<float>& values);
  /// Adds a VEC3 float accessor of zeros, and replaces those at `where` (ascending) by `values`.
  uint32_t addSparseZeros(size_t count, std::span<const uint32_t> where = {},
                          const std::vector<float>& values = {});
  /// Adds a material; colour components are 0..1, linear.
  uint32_t addMaterial(const std::string& name, float red, float green, float blue, float metallic,
                       float roughness, bool double_sided = false);
  /// Embeds a PNG and adds a texture that does not repeat.
  uint32_t addTexture(const std::string& name, const std::vector<uint8_t>& png);
  /// Adds a texture that repeats, of an image file at `uri`.
  uint32_t addExternalTexture(const std::string& name, const std::string& uri);
  /// Adds bytes at a multiple of eight of the buffer, and returns the buffer view.
  uint32_t addBytes(const std::vector<uint8_t>& bytes);
  /// Like addIndices(), for indices that are not those of triangles.
  uint32_t addPlainIndices(std::span<const uint32_t> indices);
  /// Adds a mesh and returns its index.
  uint32_t addMesh(const std::string& name, const Json& primitives);
  /// Adds a node; `in_scene` makes it a root of the scene.
  uint32_t addNode(const Json& node, bool in_scene = true);

  std::vector<uint8_t> finish() const;

 private:
  uint32_t addIndices(std::span<const uint32_t> indices, int target);
  Json addReplacements(std::span<const uint32_t> where, const std::vector<float>& values);
};

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_GLB_BUILDER_H_
