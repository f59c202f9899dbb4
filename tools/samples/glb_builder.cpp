// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "glb_builder.h"

#include <algorithm>

namespace mcc::samples {
namespace {

using namespace gltf::test;  // the numbers of component types and targets

constexpr uint32_t kLinear = 9729;
constexpr uint32_t kLinearMipmapLinear = 9987;
constexpr uint32_t kRepeat = 10497;
constexpr uint32_t kClampToEdge = 33071;

}  // namespace

GlbBuilder::GlbBuilder(const std::string& title) {
  json["asset"]["generator"] = "gltf-mcc generate-samples";
  json["scene"] = 0;
  json["scenes"] = Json::array({Json{{"name", title}, {"nodes", Json::array()}}});
}

uint32_t GlbBuilder::addFloats(const std::vector<float>& values, uint32_t components) {
  const uint32_t accessor = Builder::addFloats(values, components, kForVertices);
  setBounds<float>(json["accessors"].back(), values, components);
  return accessor;
}

uint32_t GlbBuilder::addPlainFloats(const std::vector<float>& values, uint32_t components) {
  const std::string type = components == 16 ? "MAT4" : vectorType(components);
  const uint32_t accessor = addAccessor(values, kFloat, type, values.size() / components);
  if (components == 1)
    setBounds<float>(json["accessors"].back(), values, 1);  // animation inputs need them
  return accessor;
}

uint32_t GlbBuilder::addIntegers(std::span<const int32_t> values, uint32_t components,
                                 ComponentType type, bool normalized) {
  const uint32_t width = componentBytes(type);
  const uint32_t stride = (components * width + 3) / 4 * 4;
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < values.size(); ++i) {
    append(bytes, static_cast<uint32_t>(values[i]), width);
    if ((i + 1) % components == 0) bytes.resize((i + 1) / components * stride, 0);
  }
  const uint32_t view = addView(bytes, stride, kForVertices);
  const uint32_t accessor =
      addAccessor(view, enumerantOf(type), vectorType(components), values.size() / components);
  if (normalized) json["accessors"].back()["normalized"] = true;
  setBounds(json["accessors"].back(), values, components);
  return accessor;
}

uint32_t GlbBuilder::addIndices(std::span<const uint32_t> indices) {
  return addIndices(indices, kForIndices);
}

uint32_t GlbBuilder::addPlainIndices(std::span<const uint32_t> indices) {
  return addIndices(indices, 0);
}

uint32_t GlbBuilder::addIndices(std::span<const uint32_t> indices, int target) {
  const bool is_short = *std::max_element(indices.begin(), indices.end()) < 65535;
  std::vector<uint8_t> bytes;
  for (const uint32_t index : indices) append(bytes, index, is_short ? 2 : 4);
  const uint32_t view = addView(bytes, 0, target);
  return addAccessor(view, is_short ? kUnsignedShort : kUnsignedInt, "SCALAR", indices.size());
}

Json GlbBuilder::addReplacements(std::span<const uint32_t> where,
                                 const std::vector<float>& values) {
  std::vector<uint8_t> indices;
  for (const uint32_t index : where) append(indices, index, 2);
  const uint32_t index_view = addView(indices);
  const uint32_t value_view = addView(bytesOf(values));
  return {{"count", where.size()},
          {"indices", {{"bufferView", index_view}, {"componentType", kUnsignedShort}}},
          {"values", {{"bufferView", value_view}}}};
}

uint32_t GlbBuilder::addSparseFloats(uint32_t base_accessor, std::span<const float> base,
                                     std::span<const uint32_t> where,
                                     const std::vector<float>& values) {
  std::vector<float> all(base.begin(), base.end());
  for (size_t i = 0; i < where.size(); ++i) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * 3), 3,
                all.begin() + static_cast<std::ptrdiff_t>(size_t{where[i]} * 3));
  }
  Json sparse = addReplacements(where, values);
  Json accessor = json["accessors"][base_accessor];
  json["bufferViews"][accessor["bufferView"].get<size_t>()]["byteStride"] =
      12;  // it has two users now
  setBounds(accessor, std::span<const float>(all), 3);
  accessor["sparse"] = std::move(sparse);
  return push("accessors", std::move(accessor));
}

uint32_t GlbBuilder::addSparseZeros(size_t count, std::span<const uint32_t> where,
                                    const std::vector<float>& values) {
  std::vector<float> bounding(values.begin(), values.end());
  if (where.size() < count) bounding.insert(bounding.end(), 3, 0.0f);
  Json accessor = {{"componentType", kFloat}, {"count", count}, {"type", "VEC3"}};
  setBounds(accessor, std::span<const float>(bounding), 3);
  if (!where.empty()) accessor["sparse"] = addReplacements(where, values);
  return push("accessors", std::move(accessor));
}

uint32_t GlbBuilder::addMaterial(const std::string& name, float red, float green, float blue,
                                 float metallic, float roughness, bool double_sided) {
  Json material = {{"name", name},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {red, green, blue, 1.0f}},
                     {"metallicFactor", metallic},
                     {"roughnessFactor", roughness}}}};
  if (double_sided) material["doubleSided"] = true;
  return push("materials", std::move(material));
}

uint32_t GlbBuilder::addTexture(const std::string& name, const std::vector<uint8_t>& png) {
  const uint32_t view = addView(png);
  const uint32_t image =
      push("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}});
  if (!json.contains("samplers")) {
    push("samplers", {{"magFilter", kLinear},
                      {"minFilter", kLinearMipmapLinear},
                      {"wrapS", kClampToEdge},
                      {"wrapT", kClampToEdge}});
  }
  return push("textures", {{"sampler", 0}, {"source", image}});
}

uint32_t GlbBuilder::addExternalTexture(const std::string& name, const std::string& uri) {
  const uint32_t image = push("images", {{"name", name}, {"uri", uri}});
  const uint32_t sampler = push("samplers", {{"magFilter", kLinear},
                                             {"minFilter", kLinearMipmapLinear},
                                             {"wrapS", kRepeat},
                                             {"wrapT", kRepeat}});
  return push("textures", {{"sampler", sampler}, {"source", image}});
}

uint32_t GlbBuilder::addBytes(const std::vector<uint8_t>& bytes) {
  while (bin.size() % 8 != 0) bin.push_back(0);
  return addView(bytes);
}

uint32_t GlbBuilder::addMesh(const std::string& name, const Json& primitives) {
  return push("meshes", {{"name", name}, {"primitives", primitives}});
}

uint32_t GlbBuilder::addNode(const Json& node, bool in_scene) {
  const uint32_t index = push("nodes", node);
  if (in_scene) json["scenes"][0]["nodes"].push_back(index);
  return index;
}

std::vector<uint8_t> GlbBuilder::finish() const {
  Builder padded = *this;
  padded.bin.resize((bin.size() + 3) & ~size_t{3}, 0);
  return padded.toGlb();
}

}  // namespace mcc::samples
