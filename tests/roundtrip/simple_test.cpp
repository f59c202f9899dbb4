// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Whole meshes through mcc/simple.h: with every kind of attribute, with errors, and hostile bytes.
#include "mcc/simple.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mcc/glb.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

constexpr simple::EncodeOptions kExact = {0, 0, 0, 0, 0, 0, true, true};

// What is written here and in glb.h is one set of defaults.
constexpr gltf::QuantizationBits kBits;
constexpr simple::EncodeOptions kDefaults;
static_assert(kDefaults.position_bits == kBits.position_bits &&
              kDefaults.normal_bits == kBits.normal_bits &&
              kDefaults.texcoord_bits == kBits.texcoord_bits &&
              kDefaults.color_bits == kBits.color_bits &&
              kDefaults.tangent_bits == kBits.tangent_bits &&
              kDefaults.weight_bits == kBits.weight_bits);

std::vector<float> waves(uint32_t count, float scale) {
  std::vector<float> values(count);
  for (uint32_t i = 0; i < count; ++i) values[i] = scale * std::sin(static_cast<float>(i) * 0.37f);
  return values;
}

void addIntegers(simple::Mesh& mesh, const char* name, ComponentType type, uint8_t component_count,
                 bool normalized) {
  const size_t size = size_t{mesh.vertex_count} * componentBytes(type) * component_count;
  std::vector<uint8_t> bytes(size);
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(i * i >> 3);
  mesh.attributes.push_back({name, simple::kBase, type, component_count, normalized, bytes});
}

/// The generated mesh with all attributes that glTF names, one that it does not name, and two morph
/// targets; its triangles are two primitives.
simple::Mesh fullMesh(const TestMesh& source) {
  simple::Mesh mesh;
  const uint32_t count = source.vertexCount();
  mesh.add("TEXCOORD_0", waves(2 * count, 1), 2);
  mesh.add("POSITION", source.positions);
  mesh.add("NORMAL", source.normals.empty() ? waves(3 * count, 1) : source.normals);
  mesh.add("TANGENT", waves(4 * count, 1), 4);
  mesh.add("TEXCOORD_1", waves(2 * count, 7), 2);
  mesh.add("COLOR_0", waves(4 * count, 0.5f), 4);
  addIntegers(mesh, "JOINTS_0", ComponentType::kUint8, 4, false);
  mesh.add("WEIGHTS_0", std::vector<float>(size_t{4} * count, 0.25f), 4);
  addIntegers(mesh, "COLOR_1", ComponentType::kUint16, 3, true);
  addIntegers(mesh, "_FEATURE_ID_0", ComponentType::kUint16, 1, false);
  mesh.add("POSITION", waves(3 * count, 0.1f), 3, 0);
  mesh.add("NORMAL", waves(3 * count, 0.2f), 3, 0);
  mesh.add("POSITION", waves(3 * count, 3), 3, 1);
  const auto middle = source.indices.begin() + source.triangleCount() / 2 * 3;
  mesh.primitives.emplace_back(source.indices.begin(), middle);
  mesh.primitives.emplace_back(middle, source.indices.end());
  return mesh;
}

std::vector<TestMesh> meshes() {
  return {torus(16, 10), chartGrid(12, 10, 4), withRandomWedges(sheetWithHoles(4, 1), 2, 2),
          looseTriangles(9), withRandomWedges(randomSoup(4), 5, 2)};
}

/// Encodes and decodes; the one mesh that comes back.
simple::Mesh roundTripOf(const simple::Mesh& mesh, const simple::EncodeOptions& options) {
  std::vector<uint8_t> payload;
  const Status encoded = simple::encode(mesh, payload, options);
  EXPECT_TRUE(encoded.ok()) << encoded.what;
  std::vector<simple::Mesh> decoded;
  const Status status = simple::decode(payload, decoded);
  EXPECT_TRUE(status.ok()) << status.what;
  EXPECT_EQ(decoded.size(), 1u);
  return decoded.size() == 1 ? std::move(decoded[0]) : simple::Mesh();
}

TEST(Simple, EveryBitComesBack) {
  for (const TestMesh& source : meshes()) {
    SCOPED_TRACE(source.name);
    const simple::Mesh mesh = fullMesh(source);
    const simple::Mesh back = roundTripOf(mesh, kExact);
    EXPECT_EQ(back.vertex_count, mesh.vertex_count);
    EXPECT_EQ(back.primitives, mesh.primitives);
    ASSERT_EQ(back.attributes.size(), mesh.attributes.size());
    for (const simple::Attribute& expected : mesh.attributes) {
      SCOPED_TRACE(expected.name + " " + std::to_string(expected.target));
      const std::string name = expected.name[0] == '_' ? "_" : expected.name;
      const simple::Attribute* found = back.find(name, expected.target);
      ASSERT_NE(found, nullptr);
      EXPECT_EQ(found->type, expected.type);
      EXPECT_EQ(found->component_count, expected.component_count);
      EXPECT_EQ(found->normalized, expected.normalized);
      EXPECT_EQ(found->bytes, expected.bytes);
    }
    EXPECT_EQ(back.find("POSITION", 2), nullptr);
  }
}

/// The largest difference of two arrays of floats.
float farthest(std::span<const float> a, std::span<const float> b) {
  EXPECT_EQ(a.size(), b.size());
  float most = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
  }
  return most;
}

TEST(Simple, BitsBoundTheErrors) {
  simple::EncodeOptions options;
  options.keep_vertex_order = true;
  for (const TestMesh& source : meshes()) {
    SCOPED_TRACE(source.name);
    const simple::Mesh mesh = fullMesh(source);
    const simple::Mesh back = roundTripOf(mesh, options);
    float largest = 0;
    for (const float x : source.positions) largest = std::max(largest, std::abs(x));
    const auto error = [&](const char* name, int target = simple::kBase) {
      return farthest(mesh.find(name, target)->floats(), back.find(name, target)->floats());
    };
    EXPECT_GT(error("TEXCOORD_1"), 0);
    EXPECT_LE(error("POSITION"), 2 * largest / 16383);
    EXPECT_LE(error("TEXCOORD_1"), 14.0f / 4095);
    EXPECT_LE(error("POSITION", 0), 2 * largest / 16383);
    EXPECT_LE(error("POSITION", 1), 2 * largest / 16383);
    EXPECT_TRUE(back.find("JOINTS_0")->floats().empty());
    EXPECT_EQ(back.find("JOINTS_0")->bytes, mesh.find("JOINTS_0")->bytes);
  }
}

/// Without kept orders triangles still have their corners' positions.
TEST(Simple, OrdersMayChange) {
  const auto trianglesOf = [](const simple::Mesh& mesh) {
    std::map<std::array<float, 9>, int> triangles;
    const std::span<const float> positions = mesh.find("POSITION")->floats();
    for (const std::vector<uint32_t>& indices : mesh.primitives) {
      for (size_t i = 0; i < indices.size(); i += 3) {
        std::array<std::array<float, 3>, 3> corners;
        for (size_t k = 0; k < 3; ++k) {
          std::copy_n(positions.begin() + indices[i + k] * 3, 3, corners[k].begin());
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        std::array<float, 9> key;
        for (size_t k = 0; k < 9; ++k) key[k] = corners[k / 3][k % 3];
        ++triangles[key];
      }
    }
    return triangles;
  };
  simple::EncodeOptions options;
  options.position_bits = 0;
  for (const TestMesh& source : {torus(16, 10), chartGrid(12, 10, 4)}) {
    simple::Mesh mesh;
    mesh.add("POSITION", source.positions);
    mesh.primitives = {source.indices};
    EXPECT_EQ(trianglesOf(roundTripOf(mesh, options)), trianglesOf(mesh)) << source.name;
  }
}

TEST(Simple, WrongMeshes) {
  const simple::Mesh good = fullMesh(torus(6, 4));
  const auto refused = [&](auto change) {
    simple::Mesh mesh = good;
    simple::EncodeOptions options;
    change(mesh, options);
    std::vector<uint8_t> payload = {1};
    const Status status = simple::encode(mesh, payload, options);
    EXPECT_TRUE(payload.empty());
    return status.error == Error::kBadArgument;
  };
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh = {}; }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.primitives.clear(); }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.attributes.clear(); }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.attributes[1].name = "Position"; }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.attributes[1].target = -2; }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.attributes[0].target = 0xffff; }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.attributes[0].bytes.pop_back(); }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.attributes[0].component_count = 5; }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.attributes[0].component_count = 0; }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.attributes[0].type = ComponentType{9}; }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.primitives[0].pop_back(); }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { mesh.primitives[0][0] = mesh.vertex_count; }));
  EXPECT_TRUE(refused([](auto& mesh, auto&) { ++mesh.vertex_count; }));
  EXPECT_TRUE(refused([](auto&, auto& options) { options.position_bits = 25; }));
  EXPECT_TRUE(refused([](auto&, auto& options) { options.normal_bits = 1; }));
}

TEST(Simple, MeshletsOfADecodedMesh) {
  simple::Mesh mesh;
  mesh.add("POSITION", torus(40, 30).positions);
  mesh.primitives = {torus(40, 30).indices};
  const simple::Mesh decoded = roundTripOf(mesh, kDefaults);
  simple::Meshlets made;
  ASSERT_TRUE(
      simple::buildMeshlets(decoded.primitives[0], decoded.vertex_count, made, {32, 60, {}, {}})
          .ok());
  EXPECT_GE(made.meshlets.size(), 2400u / 60);
  EXPECT_LT(made.meshlets.size(), 2400u / 30);
  const Meshlet& last = made.meshlets.back();
  EXPECT_EQ(made.vertices.size(), last.vertex_offset + last.vertex_count);
  EXPECT_EQ(made.triangles.size(), (last.triangle_offset + 3 * last.triangle_count + 3) / 4 * 4);
  const std::vector<uint32_t> wrong = {0, 1, 2, 3};
  EXPECT_EQ(simple::buildMeshlets(wrong, 4, made).error, Error::kBadArgument);
  EXPECT_TRUE(made.meshlets.empty());
  EXPECT_EQ(simple::buildMeshlets({wrong.data(), 3}, 2, made).error, Error::kBadArgument);
  EXPECT_TRUE(made.vertices.empty());
}

TEST(Simple, HostileBytes) {
  std::vector<uint8_t> payload;
  ASSERT_TRUE(simple::encode(fullMesh(torus(8, 6)), payload).ok());
  std::vector<simple::Mesh> decoded;
  const auto decode = [&](std::span<const uint8_t> bytes) {
    decoded.resize(1);
    const Status status = simple::decode(bytes, decoded);
    EXPECT_EQ(decoded.empty(), !status.ok());
    return status.error;
  };
  for (size_t size = 0; size < payload.size(); ++size) {
    EXPECT_NE(decode({payload.data(), size}), Error::kOk) << size;
  }
  for (size_t i = 0; i < payload.size(); ++i) {
    std::vector<uint8_t> damaged = payload;
    damaged[i] ^= static_cast<uint8_t>(1u << i % 8);
    EXPECT_NE(decode(damaged), Error::kOk) << i;
  }
  EXPECT_EQ(decode(payload), Error::kOk);
  EXPECT_EQ(simple::decode(payload, decoded, 100).error, Error::kLimit);
  EXPECT_TRUE(decoded.empty());
}

}  // namespace
}  // namespace mcc::test
