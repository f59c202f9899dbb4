// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Builds glTF documents in memory, for tests and for the programs that make samples and the
// conformance suite. Only random documents (tests/documents) place their bytes themselves, because
// their layout is what they vary.
#ifndef MCC_TESTS_SUPPORT_GLTF_BUILDER_H_
#define MCC_TESTS_SUPPORT_GLTF_BUILDER_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gltf/document/glb.h"
#include "json/json.h"
#include "mcc/types.h"

namespace mcc::gltf::test {

inline constexpr int kByte = 5120;
inline constexpr int kUnsignedByte = 5121;
inline constexpr int kShort = 5122;
inline constexpr int kUnsignedShort = 5123;
inline constexpr int kUnsignedInt = 5125;
inline constexpr int kFloat = 5126;

/// Values of a view's target, for vertex attributes and for indices.
inline constexpr int kForVertices = 34962;
inline constexpr int kForIndices = 34963;

/// The number of a component type in glTF.
inline int enumerantOf(ComponentType type) {
  static constexpr int kNumbers[] = {kByte,          kUnsignedByte, kShort,
                                     kUnsignedShort, kUnsignedInt,  kFloat};
  return kNumbers[static_cast<size_t>(type)];
}

/// Bytes of a component.
inline uint32_t widthOf(int component_type) {
  if (component_type <= kUnsignedByte) return 1;
  return component_type <= kUnsignedShort ? 2 : 4;
}

/// Calls `use` with a zero of a component type.
template <typename Use>
auto withType(int component_type, const Use& use) {
  switch (component_type) {
    case kByte: return use(int8_t{});
    case kUnsignedByte: return use(uint8_t{});
    case kShort: return use(int16_t{});
    case kUnsignedShort: return use(uint16_t{});
    case kUnsignedInt: return use(uint32_t{});
    default: return use(float{});
  }
}

/// The value of a component of tight elements.
inline double componentAt(int component_type, const void* tight, size_t number) {
  return withType(component_type, [&](auto typed) {
    std::memcpy(&typed, static_cast<const uint8_t*>(tight) + number * sizeof typed, sizeof typed);
    return static_cast<double>(typed);
  });
}

inline std::string vectorType(uint32_t components) {
  return components == 1 ? "SCALAR" : "VEC" + std::to_string(components);
}

struct Shape {
  uint32_t columns = 1;
  uint32_t rows = 1;
};

/// The shape of a type like "VEC3" or "MAT4".
inline Shape shapeOf(const std::string& type) {
  if (type.front() == 'S') return {};
  const auto size = static_cast<uint32_t>(type.back() - '0');
  return {type.front() == 'M' ? size : 1, size};
}

inline std::string base64Of(std::span<const uint8_t> bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

template <typename T>
std::vector<uint8_t> bytesOf(const std::vector<T>& values) {
  std::vector<uint8_t> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Appends a number as bytes, the lowest first.
inline void append(std::vector<uint8_t>& to, uint64_t value, size_t byte_count = 4) {
  for (size_t i = 0; i < byte_count; ++i) to.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

/// A GLB of a document and of its BIN chunk.
inline std::vector<uint8_t> glbOf(const Json& json, std::span<const uint8_t> bin) {
  std::vector<uint8_t> file;
  const Result result = writeGlb(printJson(json), bin, {}, file);
  if (!result.ok()) throw std::runtime_error("GLB: " + result.message());
  return file;
}

struct Chunk3 {
  std::string type;  ///< four characters
  std::vector<uint8_t> bytes;
  uint32_t encoding = 0;
};

/// A GLB of version 3, byte by byte from the draft and without the library, so that tests of
/// reading do not depend on writing. Padding follows each chunk, also the last one, and counts in
/// the length of the file alone.
inline std::vector<uint8_t> glb3Of(const std::vector<Chunk3>& chunks) {
  std::vector<uint8_t> body;
  for (const Chunk3& chunk : chunks) {
    body.insert(body.end(), chunk.type.begin(), chunk.type.end());
    append(body, chunk.encoding);
    append(body, chunk.bytes.size(), 8);
    body.insert(body.end(), chunk.bytes.begin(), chunk.bytes.end());
    body.resize((body.size() + 7) / 8 * 8, 0);
  }
  std::vector<uint8_t> file = {'g', 'l', 'T', 'F', 3, 0, 0, 0};
  append(file, 16 + body.size(), 8);
  file.insert(file.end(), body.begin(), body.end());
  return file;
}

inline Chunk3 jsonChunk(const std::string& text) { return {"JSON", {text.begin(), text.end()}}; }
inline Chunk3 binChunk(std::vector<uint8_t> bytes) {
  return {std::string("BIN\0", 4), std::move(bytes)};
}

class Builder {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::vector<uint8_t> bin;

  /// Adds an element to an array of the document, and returns its number.
  uint32_t push(const char* array, Json element) {
    Json& elements = json[array];
    elements.push_back(std::move(element));
    return static_cast<uint32_t>(elements.size() - 1);
  }

  /// Adds a buffer view with these bytes, and returns its number. A stride or target of 0 is none.
  uint32_t addView(const std::vector<uint8_t>& bytes, uint32_t stride = 0, int target = 0) {
    bin.resize((bin.size() + 3) & ~size_t{3}, 0);
    Json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    if (target != 0) view["target"] = target;
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    return push("bufferViews", std::move(view));
  }

  uint32_t addAccessor(const Json& accessor) { return push("accessors", accessor); }

  /// Adds an accessor over a view.
  uint32_t addAccessor(uint32_t view, int component_type, const std::string& type, size_t count) {
    return addAccessor({{"bufferView", view},
                        {"componentType", component_type},
                        {"count", count},
                        {"type", type}});
  }

  /// Adds an accessor over a view of its own.
  template <typename T>
  uint32_t addAccessor(const std::vector<T>& values, int component_type, const std::string& type,
                       size_t count, int target = 0) {
    return addAccessor(addView(bytesOf(values), 0, target), component_type, type, count);
  }

  uint32_t addFloats(const std::vector<float>& values, uint32_t components, int target = 0) {
    return addAccessor(values, kFloat, vectorType(components), values.size() / components, target);
  }

  /// Positions have bounds, as glTF demands.
  uint32_t addPositions(const std::vector<float>& values) {
    const uint32_t accessor = addFloats(values, 3);
    setBounds<float>(json["accessors"][accessor], values, 3);
    return accessor;
  }

  /// Writes min and max of tight elements.
  template <typename T>
  static void setBounds(Json& accessor, std::span<const T> values, uint32_t components) {
    std::vector<T> low(values.begin(), values.begin() + components);
    std::vector<T> high = low;
    for (size_t i = 0; i < values.size(); ++i) {
      low[i % components] = std::min(low[i % components], values[i]);
      high[i % components] = std::max(high[i % components], values[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
  }

  uint32_t addIndices(const std::vector<uint16_t>& values) {
    return addAccessor(values, kUnsignedShort, "SCALAR", values.size());
  }

  /// Adds a mesh with these primitives and a node that shows it.
  uint32_t addMesh(const std::vector<Json>& primitives) {
    const uint32_t mesh = push("meshes", {{"primitives", primitives}});
    push("nodes", {{"mesh", mesh}});
    json["scenes"] = {{{"nodes", Json::array()}}};
    for (size_t i = 0; i < json["nodes"].size(); ++i) json["scenes"][0]["nodes"].push_back(i);
    return mesh;
  }

  std::vector<uint8_t> toGlb() const {
    Json complete = json;
    if (!bin.empty()) complete["buffers"] = {{{"byteLength", bin.size()}}};
    return glbOf(complete, bin);
  }
};

/// A bumpy sheet of (n + 1)^2 vertices and 2 n^2 triangles.
struct Sheet {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> texcoords;
  std::vector<uint16_t> indices;

  explicit Sheet(uint32_t n, float height = 0.1f) {
    for (uint32_t y = 0; y <= n; ++y) {
      for (uint32_t x = 0; x <= n; ++x) {
        const float u = static_cast<float>(x) / static_cast<float>(n);
        const float v = static_cast<float>(y) / static_cast<float>(n);
        const float slope = height * 6 * std::cos(6 * u);
        const float length = std::sqrt(slope * slope + 1);
        positions.insert(positions.end(), {u, v, height * std::sin(6 * u)});
        normals.insert(normals.end(), {-slope / length, 0, 1 / length});
        texcoords.insert(texcoords.end(), {u, 1 - v});
      }
    }
    for (uint32_t y = 0; y < n; ++y) {
      for (uint32_t x = 0; x < n; ++x) {
        const auto a = static_cast<uint16_t>(y * (n + 1) + x);
        const auto b = static_cast<uint16_t>(a + n + 1);
        const auto a1 = static_cast<uint16_t>(a + 1);
        const auto b1 = static_cast<uint16_t>(b + 1);
        indices.insert(indices.end(), {a, a1, b1, a, b1, b});
      }
    }
  }

  uint32_t count() const { return static_cast<uint32_t>(positions.size() / 3); }

  /// Adds its accessors; returns a primitive that uses them.
  Json addTo(Builder& builder) const {
    return {{"attributes",
             {{"POSITION", builder.addPositions(positions)},
              {"NORMAL", builder.addFloats(normals, 3)},
              {"TEXCOORD_0", builder.addFloats(texcoords, 2)}}},
            {"indices", builder.addIndices(indices)}};
  }
};

inline std::span<const uint8_t> asBytes(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

/// The JSON of a GLB.
inline Json jsonOf(std::span<const uint8_t> file) {
  GlbFile glb;
  Json json;
  if (!readGlb(file, glb).ok() || !parseJson(glb.json, json).ok()) return nullptr;
  return json;
}

/// A GLB with another JSON.
inline std::vector<uint8_t> withJson(std::span<const uint8_t> file, const Json& json) {
  GlbFile glb;
  const Result result = readGlb(file, glb);
  if (!result.ok()) throw std::runtime_error("GLB: " + result.message());
  return glbOf(json, glb.bin);
}

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_SUPPORT_GLTF_BUILDER_H_
