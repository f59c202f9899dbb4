// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// One call to decode and one to encode: what they return is what the reader and the writer do.
#include "mcc/simple.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

template <typename T>
MeshAttribute attributeOf(const std::string& name, const std::vector<T>& values, uint32_t count,
                          ComponentType type, bool normalized = false, int target = -1) {
  MeshAttribute attribute;
  attribute.name = name;
  attribute.morph_target = target;
  attribute.component_type = type;
  attribute.component_count = count;
  attribute.normalized = normalized;
  attribute.data.resize(values.size() * sizeof(T));
  std::memcpy(attribute.data.data(), values.data(), attribute.data.size());
  return attribute;
}

std::vector<float> floatsOf(const MeshAttribute& attribute) {
  std::vector<float> values(attribute.data.size() / 4);
  std::memcpy(values.data(), attribute.data.data(), attribute.data.size());
  return values;
}

/// A mesh with every kind of attribute, in another order than payloads have.
Mesh meshOf(const TestMesh& source, uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto anyFloats = [&](uint32_t count, float low, float high) {
    std::vector<float> values(size_t{count} * source.vertexCount());
    for (float& value : values) {
      value = std::uniform_real_distribution<float>(low, high)(random);
    }
    return values;
  };
  Mesh mesh;
  mesh.vertex_count = source.vertexCount();
  std::vector<float> normals = anyFloats(3, -1, 1);
  for (size_t i = 0; i < normals.size(); i += 3) {
    const float length = std::hypot(normals[i], normals[i + 1], normals[i + 2]);
    for (size_t c = 0; c < 3; ++c) normals[i + c] /= length;
  }
  std::vector<uint8_t> colours(size_t{4} * source.vertexCount());
  for (uint8_t& colour : colours) colour = static_cast<uint8_t>(random());
  mesh.attributes.push_back(
      attributeOf("TEXCOORD_1", anyFloats(2, 0, 1), 2, ComponentType::kFloat32));
  mesh.attributes.push_back(
      attributeOf("COLOR_0", colours, 4, ComponentType::kUint8, /*normalized=*/true));
  mesh.attributes.push_back(attributeOf("POSITION", source.positions, 3, ComponentType::kFloat32));
  mesh.attributes.push_back(attributeOf("_HEAT", anyFloats(1, 0, 9), 1, ComponentType::kFloat32));
  mesh.attributes.push_back(attributeOf("NORMAL", normals, 3, ComponentType::kFloat32));
  mesh.attributes.push_back(attributeOf("POSITION", anyFloats(3, -.1f, .1f), 3,
                                        ComponentType::kFloat32, false, /*target=*/1));
  const size_t half = source.indices.size() / 6 * 3;
  const auto middle = source.indices.begin() + static_cast<ptrdiff_t>(half);
  mesh.primitives = {{source.indices.begin(), middle}, {middle, source.indices.end()}};
  return mesh;
}

void expectNear(const MeshAttribute& source, const MeshAttribute& decoded, double distance,
                const std::vector<uint32_t>& source_vertices) {
  const std::vector<float> a = floatsOf(source);
  const std::vector<float> b = floatsOf(decoded);
  const uint32_t count = source.component_count;
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < b.size(); ++i) {
    EXPECT_NEAR(b[i], a[source_vertices[i / count] * count + i % count], distance) << source.name;
  }
}

TEST(Simple, EveryKindOfAttributeComesBackUnderItsName) {
  for (const TestMesh& source : {torus(20, 9), soup(3, 40, 20, {}),
                                 unionOf(std::vector{icosphere(1), tetrahedron()}, "two")}) {
    const Mesh mesh = meshOf(source, 7);
    std::vector<uint8_t> payload;
    std::vector<uint32_t> vertices;
    ASSERT_EQ(encodeMesh(mesh, payload, {}, &vertices).what, std::string());
    Mesh decoded;
    ASSERT_EQ(decodeMesh(payload, decoded).what, std::string());
    EXPECT_EQ(decoded.vertex_count, mesh.vertex_count);
    ASSERT_EQ(decoded.primitives.size(), 2u);
    EXPECT_EQ(decoded.primitives[0].size(), mesh.primitives[0].size());
    EXPECT_EQ(decoded.primitives[1].size(), mesh.primitives[1].size());
    ASSERT_EQ(decoded.attributes.size(), mesh.attributes.size());
    EXPECT_EQ(decoded.attributes[0].name, "POSITION");
    EXPECT_EQ(decoded.find("_HEAT"), nullptr);
    ASSERT_NE(decoded.find("_"), nullptr);
    EXPECT_EQ(decoded.find("POSITION", 0), nullptr);
    ASSERT_NE(decoded.find("POSITION", 1), nullptr);
    expectNear(*mesh.find("POSITION"), *decoded.find("POSITION"), 1e-3, vertices);
    expectNear(*mesh.find("POSITION", 1), *decoded.find("POSITION", 1), 1e-3, vertices);
    expectNear(*mesh.find("NORMAL"), *decoded.find("NORMAL"), 5e-3, vertices);
    expectNear(*mesh.find("TEXCOORD_1"), *decoded.find("TEXCOORD_1"), 3e-4, vertices);
    expectNear(*mesh.find("_HEAT"), *decoded.find("_"), 0, vertices);
    const MeshAttribute& colours = *decoded.find("COLOR_0");
    EXPECT_TRUE(colours.normalized);
    EXPECT_EQ(colours.component_type, ComponentType::kUint8);
    for (size_t i = 0; i < colours.data.size(); ++i) {
      EXPECT_EQ(colours.data[i], mesh.attributes[1].data[vertices[i / 4] * 4 + i % 4]);
    }
  }
}

TEST(Simple, ZeroBitsAreExact) {
  const Mesh mesh = meshOf(torus(7, 5), 9);
  std::vector<uint8_t> payload;
  std::vector<uint32_t> vertices;
  ASSERT_TRUE(encodeMesh(mesh, payload, {0, 0, 0, 0, 0, 0}, &vertices).ok());
  Mesh decoded;
  ASSERT_TRUE(decodeMesh(payload, decoded).ok());
  for (const MeshAttribute& attribute : decoded.attributes) {
    if (attribute.name == "_" || attribute.name == "COLOR_0") continue;
    expectNear(*mesh.find(attribute.name, attribute.morph_target), attribute, 0, vertices);
  }
}

TEST(Simple, OnePieceOfSeveralIsTheSameAsAlone) {
  const TestMesh first = torus(9, 5);
  const TestMesh second = icosphere(2);
  std::vector<AttributeView> views[2];
  std::vector<PieceView> pieces;
  std::vector<PartView> parts[2];
  size_t i = 0;
  for (const TestMesh* mesh : {&first, &second}) {
    AttributeView view;
    view.data = mesh->positions.data();
    view.stride_bytes = 12;
    views[i] = {view};
    parts[i] = {PartView{mesh->indices}};
    pieces.push_back({mesh->vertexCount(), views[i], parts[i]});
    ++i;
  }
  EncodeResult result;
  ASSERT_TRUE(encode(pieces, {}, result).ok());
  Mesh decoded;
  ASSERT_TRUE(decodeMesh(result.payload, decoded, 1).ok());
  EXPECT_EQ(decoded.vertex_count, second.vertexCount());
  EXPECT_EQ(decoded.primitives[0].size(), second.indices.size());
  const std::vector<float> positions = floatsOf(decoded.attributes[0]);
  for (uint32_t v = 0; v < decoded.vertex_count; ++v) {
    const uint32_t source = result.pieces[1].source_wedge[v];
    for (uint32_t c = 0; c < 3; ++c) {
      EXPECT_EQ(positions[3 * v + c], second.positions[3 * source + c]);
    }
  }
  EXPECT_EQ(decodeMesh(result.payload, decoded, 2).error, Error::kBadArgument);
}

TEST(Simple, RefusesWhatItCannotEncode) {
  std::vector<uint8_t> payload;
  Mesh mesh = meshOf(tetrahedron(), 1);
  mesh.attributes[0].data.pop_back();
  EXPECT_EQ(encodeMesh(mesh, payload).error, Error::kBadArgument);
  mesh = meshOf(tetrahedron(), 1);
  mesh.attributes[0].component_count = 7;
  EXPECT_EQ(encodeMesh(mesh, payload).error, Error::kBadArgument);
  mesh = meshOf(tetrahedron(), 1);
  mesh.attributes[5].morph_target = 70000;
  EXPECT_EQ(encodeMesh(mesh, payload).error, Error::kBadArgument);
  mesh = meshOf(tetrahedron(), 1);
  mesh.primitives[0][0] = 4;
  EXPECT_EQ(encodeMesh(mesh, payload).error, Error::kBadArgument);
  EXPECT_EQ(encodeMesh({}, payload).error, Error::kBadArgument);
}

TEST(Simple, DamagedPayloadsAreRefusedOrDecoded) {
  std::vector<uint8_t> payload;
  ASSERT_TRUE(encodeMesh(meshOf(torus(6, 5), 3), payload).ok());
  Mesh decoded;
  for (size_t i = 0; i < payload.size(); ++i) {
    payload[i] ^= 0x10;
    EXPECT_FALSE(decodeMesh(payload, decoded).ok()) << i;
    payload[i] ^= 0x10;
    EXPECT_FALSE(decodeMesh(std::span(payload).first(i), decoded).ok()) << i;
  }
  Limits limits;
  limits.max_triangles = 59;
  EXPECT_EQ(decodeMesh(payload, decoded, 0, limits).error, Error::kLimit);
}

}  // namespace
}  // namespace mcc::test
