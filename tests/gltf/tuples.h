// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Bit-equal vertices and triangles of two documents. Only reading is shared with the library's own
// check.
#ifndef MCC_TESTS_GLTF_TUPLES_H_
#define MCC_TESTS_GLTF_TUPLES_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "gltf/document/accessors.h"
#include "json/json.h"

namespace mcc::gltf::test {

/// A triangle primitive: the bytes of all attributes of each vertex, and the expanded triangles.
struct Primitive {
  std::vector<std::string> tuples;
  std::vector<uint32_t> indices;
};

inline void addTuples(const Document& document, const Json& map, std::vector<std::string>& tuples) {
  std::map<std::string, uint32_t> sorted;
  for (const auto& [name, accessor] : map.items()) sorted[name] = accessor.get<uint32_t>();
  for (const auto& [name, accessor] : sorted) {
    AccessorData data;
    ASSERT_TRUE(readAccessor(document, accessor, data).ok());
    tuples.resize(data.count);
    for (uint64_t i = 0; i < data.count; ++i) {
      const auto element = data.element(i);
      tuples[i].append(element.begin(), element.end());
    }
  }
}

inline void readPrimitive(const Document& document, const Json& json, Primitive& primitive) {
  addTuples(document, json["attributes"], primitive.tuples);
  for (const Json& target : arrayOf(json, "targets")) addTuples(document, target, primitive.tuples);
  if (json.contains("indices")) {
    ASSERT_TRUE(readIndices(document, json["indices"], primitive.indices).ok());
  } else {
    for (uint32_t i = 0; i < primitive.tuples.size(); ++i) primitive.indices.push_back(i);
  }
  const uint64_t mode = json.contains("mode") ? json["mode"].get<uint64_t>() : 4;
  if (mode < 4) return;  // points and lines
  EXPECT_TRUE(expandTriangles(mode, primitive.indices));
}

/// The triangles with each vertex replaced by a number of its tuple, rotated and sorted.
inline std::vector<std::array<uint32_t, 3>> tupleTriangles(
    const Primitive& primitive, std::unordered_map<std::string, uint32_t>& numbers) {
  std::vector<uint32_t> number_of;
  for (const std::string& tuple : primitive.tuples) {
    number_of.push_back(
        numbers.try_emplace(tuple, static_cast<uint32_t>(numbers.size())).first->second);
  }
  std::vector<std::array<uint32_t, 3>> triangles(primitive.indices.size() / 3);
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) triangles[i][k] = number_of[primitive.indices[3 * i + k]];
    const auto [x, y, z] = triangles[i];
    triangles[i] = std::min({triangles[i], {y, z, x}, {z, x, y}});
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

inline void comparePrimitives(const Primitive& source, const Primitive& decoded, bool keeps_order) {
  ASSERT_EQ(source.tuples.size(), decoded.tuples.size());
  ASSERT_EQ(source.indices.size(), decoded.indices.size());
  if (keeps_order) {
    EXPECT_TRUE(source.tuples == decoded.tuples);
    EXPECT_TRUE(source.indices == decoded.indices);
    return;
  }
  std::unordered_map<std::string, uint32_t> numbers;
  const auto triangles = tupleTriangles(source, numbers);
  const size_t tuple_count = numbers.size();
  EXPECT_TRUE(triangles == tupleTriangles(decoded, numbers));
  EXPECT_EQ(numbers.size(), tuple_count) << "vertices the source has not";
}

/// Expects that every primitive has the same number of vertices and the same triangles over
/// bit-equal attributes and, with `keeps_order`, the same bytes and the same expanded indices.
inline void compareTuples(const std::vector<uint8_t>& source_file,
                          const std::vector<uint8_t>& decoded_file, bool keeps_order) {
  Document source, decoded;
  ASSERT_TRUE(loadDocument(source_file, nullptr, source).ok());
  ASSERT_TRUE(loadDocument(decoded_file, nullptr, decoded).ok());
  const Json& meshes = arrayOf(source.json, "meshes");
  for (size_t mesh = 0; mesh < meshes.size(); ++mesh) {
    for (size_t i = 0; i < meshes[mesh]["primitives"].size(); ++i) {
      SCOPED_TRACE(primitivePath(mesh, i));
      Primitive of_source, of_decoded;
      readPrimitive(source, meshes[mesh]["primitives"][i], of_source);
      readPrimitive(decoded, decoded.json["meshes"][mesh]["primitives"][i], of_decoded);
      comparePrimitives(of_source, of_decoded, keeps_order);
    }
  }
}

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_GLTF_TUPLES_H_
