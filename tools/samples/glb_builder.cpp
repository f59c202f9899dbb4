// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "glb_builder.h"

#include <algorithm>
#include <bit>

namespace mcc::samples {
namespace {

constexpr uint32_t kArrayBuffer = 34962;
constexpr uint32_t kElementArrayBuffer = 34963;
constexpr uint32_t kNoTarget = 0;
constexpr uint32_t kUnsignedShort = 5123;
constexpr uint32_t kUnsignedInt = 5125;
constexpr uint32_t kFloat = 5126;
constexpr uint32_t kLinear = 9729;
constexpr uint32_t kLinearMipmapLinear = 9987;
constexpr uint32_t kRepeat = 10497;
constexpr uint32_t kClampToEdge = 33071;

void putU32(std::vector<uint8_t>& bytes, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<uint8_t>(value >> shift));
}

void putInteger(std::vector<uint8_t>& bytes, uint32_t value, uint32_t width) {
  for (uint32_t k = 0; k < width; ++k) bytes.push_back(static_cast<uint8_t>(value >> (8 * k)));
}

std::vector<uint8_t> bytesOf(std::span<const float> values) {
  std::vector<uint8_t> bytes;
  bytes.reserve(values.size() * 4);
  for (const float value : values) putU32(bytes, std::bit_cast<uint32_t>(value));
  return bytes;
}

const char* typeName(uint32_t components) {
  switch (components) {
    case 1: return "SCALAR";
    case 2: return "VEC2";
    case 3: return "VEC3";
    case 4: return "VEC4";
    default: return "MAT4";
  }
}

uint32_t glEnumerant(ComponentType type) {
  switch (type) {
    case ComponentType::kInt8: return 5120;
    case ComponentType::kUint8: return 5121;
    case ComponentType::kInt16: return 5122;
    case ComponentType::kUint16: return kUnsignedShort;
    case ComponentType::kUint32: return kUnsignedInt;
    case ComponentType::kFloat32: break;
  }
  return kFloat;
}

/// Writes min and max of tightly packed elements.
template <typename Number>
void setBounds(Json& accessor, std::span<const Number> values, uint32_t components) {
  std::vector<Number> low(values.begin(), values.begin() + components);
  std::vector<Number> high = low;
  for (size_t i = 0; i < values.size(); ++i) {
    low[i % components] = std::min(low[i % components], values[i]);
    high[i % components] = std::max(high[i % components], values[i]);
  }
  accessor["min"] = low;
  accessor["max"] = high;
}

}  // namespace

GlbBuilder::GlbBuilder(const std::string& title) {
  json_["asset"] = {{"version", "2.0"}, {"generator", "gltf-mcc generate-samples"}};
  json_["scene"] = 0;
  json_["scenes"] = Json::array({Json{{"name", title}, {"nodes", Json::array()}}});
}

uint32_t GlbBuilder::push(const char* array, Json element) {
  Json& elements = json_[array];
  elements.push_back(std::move(element));
  return static_cast<uint32_t>(elements.size() - 1);
}

uint32_t GlbBuilder::addView(std::span<const uint8_t> bytes, uint32_t target,
                             uint32_t stride_bytes) {
  while (binary_.size() % 4 != 0) binary_.push_back(0);
  Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (stride_bytes > 0) view["byteStride"] = stride_bytes;
  if (target != kNoTarget) view["target"] = target;
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  return push("bufferViews", std::move(view));
}

uint32_t GlbBuilder::addAccessor(uint32_t view, uint32_t component_type, size_t count,
                                 const char* type) {
  return push(
      "accessors",
      {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
}

uint32_t GlbBuilder::addFloats(std::span<const float> values, uint32_t components) {
  const uint32_t view = addView(bytesOf(values), kArrayBuffer, 0);
  const uint32_t accessor =
      addAccessor(view, kFloat, values.size() / components, typeName(components));
  setBounds(json_["accessors"].back(), values, components);
  return accessor;
}

uint32_t GlbBuilder::addPlainFloats(std::span<const float> values, uint32_t components) {
  const uint32_t view = addView(bytesOf(values), kNoTarget, 0);
  const uint32_t accessor =
      addAccessor(view, kFloat, values.size() / components, typeName(components));
  if (components == 1)
    setBounds(json_["accessors"].back(), values, components);  // animation inputs need them
  return accessor;
}

uint32_t GlbBuilder::addIntegers(std::span<const int32_t> values, uint32_t components,
                                 ComponentType type, bool normalized) {
  const uint32_t width = componentBytes(type);
  const uint32_t stride = (components * width + 3) / 4 * 4;
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < values.size(); ++i) {
    putInteger(bytes, static_cast<uint32_t>(values[i]), width);
    if ((i + 1) % components == 0) bytes.resize((i + 1) / components * stride, 0);
  }
  const uint32_t view = addView(bytes, kArrayBuffer, stride);
  const uint32_t accessor =
      addAccessor(view, glEnumerant(type), values.size() / components, typeName(components));
  if (normalized) json_["accessors"].back()["normalized"] = true;
  setBounds(json_["accessors"].back(), values, components);
  return accessor;
}

uint32_t GlbBuilder::addIndices(std::span<const uint32_t> indices) {
  return addIndices(indices, kElementArrayBuffer);
}

uint32_t GlbBuilder::addPlainIndices(std::span<const uint32_t> indices) {
  return addIndices(indices, kNoTarget);
}

uint32_t GlbBuilder::addIndices(std::span<const uint32_t> indices, uint32_t target) {
  const uint32_t last = *std::max_element(indices.begin(), indices.end());
  const bool is_short = last < 65535;
  std::vector<uint8_t> bytes;
  for (const uint32_t index : indices) putInteger(bytes, index, is_short ? 2 : 4);
  const uint32_t view = addView(bytes, target, 0);
  return addAccessor(view, is_short ? kUnsignedShort : kUnsignedInt, indices.size(), "SCALAR");
}

Json GlbBuilder::addReplacements(std::span<const uint32_t> where, std::span<const float> values) {
  std::vector<uint8_t> indices;
  for (const uint32_t index : where) putInteger(indices, index, 2);
  const uint32_t index_view = addView(indices, kNoTarget, 0);
  const uint32_t value_view = addView(bytesOf(values), kNoTarget, 0);
  return {{"count", where.size()},
          {"indices", {{"bufferView", index_view}, {"componentType", kUnsignedShort}}},
          {"values", {{"bufferView", value_view}}}};
}

uint32_t GlbBuilder::addSparseFloats(uint32_t base_accessor, std::span<const float> base,
                                     std::span<const uint32_t> where,
                                     std::span<const float> values) {
  std::vector<float> all(base.begin(), base.end());
  for (size_t i = 0; i < where.size(); ++i) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * 3), 3,
                all.begin() + static_cast<std::ptrdiff_t>(size_t{where[i]} * 3));
  }
  Json sparse = addReplacements(where, values);
  Json accessor = json_["accessors"][base_accessor];
  json_["bufferViews"][accessor["bufferView"].get<size_t>()]["byteStride"] =
      12;  // it has two users now
  setBounds(accessor, std::span<const float>(all), 3);
  accessor["sparse"] = std::move(sparse);
  return push("accessors", std::move(accessor));
}

uint32_t GlbBuilder::addSparseZeros(size_t count, std::span<const uint32_t> where,
                                    std::span<const float> values) {
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

uint32_t GlbBuilder::addTexture(const std::string& name, std::span<const uint8_t> png) {
  const uint32_t view = addView(png, kNoTarget, 0);
  const uint32_t image =
      push("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}});
  if (!json_.contains("samplers")) {
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

uint32_t GlbBuilder::addBytes(std::span<const uint8_t> bytes) {
  while (binary_.size() % 8 != 0) binary_.push_back(0);
  return addView(bytes, kNoTarget, 0);
}

uint32_t GlbBuilder::addMesh(const std::string& name, const Json& primitives) {
  return push("meshes", {{"name", name}, {"primitives", primitives}});
}

uint32_t GlbBuilder::addNode(const Json& node, bool in_scene) {
  const uint32_t index = push("nodes", node);
  if (in_scene) json_["scenes"][0]["nodes"].push_back(index);
  return index;
}

std::vector<uint8_t> GlbBuilder::finish() const {
  std::vector<uint8_t> binary = binary_;
  while (binary.size() % 4 != 0) binary.push_back(0);
  Json json = json_;
  json["buffers"] = Json::array({Json{{"byteLength", binary.size()}}});
  std::string text = json.dump();
  while (text.size() % 4 != 0) text += ' ';

  std::vector<uint8_t> glb;
  putU32(glb, 0x46546c67);  // "glTF"
  putU32(glb, 2);
  putU32(glb, static_cast<uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
  putU32(glb, static_cast<uint32_t>(text.size()));
  putU32(glb, 0x4e4f534a);  // "JSON"
  glb.insert(glb.end(), text.begin(), text.end());
  putU32(glb, static_cast<uint32_t>(binary.size()));
  putU32(glb, 0x004e4942);  // "BIN"
  glb.insert(glb.end(), binary.begin(), binary.end());
  return glb;
}

}  // namespace mcc::samples
