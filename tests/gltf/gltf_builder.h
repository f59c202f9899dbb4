// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Builds small glTF documents in memory for tests.
#ifndef MCC_TESTS_GLTF_GLTF_BUILDER_H_
#define MCC_TESTS_GLTF_GLTF_BUILDER_H_

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "gltf/document/glb.h"
#include "json/json.h"

namespace mcc::gltf::test {

inline constexpr int kByte = 5120;
inline constexpr int kUnsignedByte = 5121;
inline constexpr int kShort = 5122;
inline constexpr int kUnsignedShort = 5123;
inline constexpr int kUnsignedInt = 5125;
inline constexpr int kFloat = 5126;

template <typename T>
std::vector<uint8_t> bytesOf(const std::vector<T>& values) {
  std::vector<uint8_t> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

class Builder {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::vector<uint8_t> bin;

  /// Adds a buffer view with these bytes, and returns its number.
  uint32_t addView(const std::vector<uint8_t>& bytes, uint32_t stride = 0) {
    bin.resize((bin.size() + 3) & ~size_t{3}, 0);
    Json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    json["bufferViews"].push_back(view);
    return static_cast<uint32_t>(json["bufferViews"].size() - 1);
  }

  uint32_t addAccessor(const Json& accessor) {
    json["accessors"].push_back(accessor);
    return static_cast<uint32_t>(json["accessors"].size() - 1);
  }

  /// Adds an accessor over a view of its own.
  template <typename T>
  uint32_t addAccessor(const std::vector<T>& values, int component_type, const std::string& type,
                       size_t count) {
    const uint32_t view = addView(bytesOf(values));
    return addAccessor({{"bufferView", view},
                        {"componentType", component_type},
                        {"count", count},
                        {"type", type}});
  }

  uint32_t addFloats(const std::vector<float>& values, uint32_t components) {
    const std::string type = components == 1 ? "SCALAR" : "VEC" + std::to_string(components);
    return addAccessor(values, kFloat, type, values.size() / components);
  }

  /// Positions have bounds, as glTF demands.
  uint32_t addPositions(const std::vector<float>& values) {
    const uint32_t accessor = addFloats(values, 3);
    Json low = Json::array();
    Json high = Json::array();
    for (size_t c = 0; c < 3; ++c) {
      float min = values[c];
      float max = values[c];
      for (size_t i = c; i < values.size(); i += 3) {
        min = std::min(min, values[i]);
        max = std::max(max, values[i]);
      }
      low.push_back(min);
      high.push_back(max);
    }
    json["accessors"][accessor]["min"] = low;
    json["accessors"][accessor]["max"] = high;
    return accessor;
  }

  uint32_t addIndices(const std::vector<uint16_t>& values) {
    return addAccessor(values, kUnsignedShort, "SCALAR", values.size());
  }

  /// Adds a mesh with these primitives and a node that shows it.
  uint32_t addMesh(const std::vector<Json>& primitives) {
    json["meshes"].push_back({{"primitives", primitives}});
    json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
    json["scenes"] = {{{"nodes", Json::array()}}};
    for (size_t i = 0; i < json["nodes"].size(); ++i) json["scenes"][0]["nodes"].push_back(i);
    return static_cast<uint32_t>(json["meshes"].size() - 1);
  }

  std::vector<uint8_t> toGlb() const {
    Json complete = json;
    if (!bin.empty()) complete["buffers"] = {{{"byteLength", bin.size()}}};
    std::vector<uint8_t> file;
    const Result result = writeGlb(printJson(complete), bin, {}, file);
    return result.ok() ? file : std::vector<uint8_t>{};
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

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_GLTF_GLTF_BUILDER_H_
