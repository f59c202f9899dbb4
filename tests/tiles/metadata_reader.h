// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads property tables of EXT_structural_metadata back as JSON, word by word from the 3D Metadata
// Specification and without the code that writes them.
#ifndef MCC_TESTS_TILES_METADATA_READER_H_
#define MCC_TESTS_TILES_METADATA_READER_H_

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "gltf/document/glb.h"
#include "gltf/document/json.h"

namespace mcc::test {

class MetadataReader {
 public:
  using Json = gltf::Json;

  explicit MetadataReader(const std::vector<uint8_t>& glb) {
    gltf::GlbFile file;
    EXPECT_TRUE(gltf::readGlb(glb, file).ok());
    EXPECT_TRUE(gltf::parseJson(file.json, root_).ok());
    bin_.assign(file.bin.begin(), file.bin.end());
  }

  const Json& root() const { return root_; }
  const std::vector<uint8_t>& bin() const { return bin_; }
  const Json& extension() const { return root_["extensions"]["EXT_structural_metadata"]; }
  const Json& table() const { return extension()["propertyTables"][0]; }
  const Json& classProperties() const {
    return extension()["schema"]["classes"][table()["class"].get<std::string>()]["properties"];
  }

  /// Returns the values of all rows. Missing values are null.
  Json valuesOf(const std::string& id) const {
    const Json& property = classProperties()[id];
    const auto row_count = table()["count"].get<size_t>();
    const bool is_stored = table().contains("properties") && table()["properties"].contains(id);
    EXPECT_TRUE(is_stored || !property.value("required", false)) << id;
    Json rows = Json::array();
    for (size_t row = 0; row < row_count; ++row) {
      Json value = is_stored ? valueOf(property, table()["properties"][id], row) : Json();
      if (property.contains("noData") && value == property["noData"]) value = nullptr;
      if (value.is_null() && property.contains("default")) value = property["default"];
      rows.push_back(value);
    }
    return rows;
  }

  /// Returns the bytes of a buffer view, which must start at a multiple of 8.
  std::vector<uint8_t> viewBytes(size_t number) const {
    const Json& view = root_["bufferViews"][number];
    const auto begin = view["byteOffset"].get<size_t>();
    const auto length = view["byteLength"].get<size_t>();
    EXPECT_EQ(view["buffer"], 0);
    EXPECT_EQ(begin % 8, 0u);
    EXPECT_GT(length, 0u);
    EXPECT_LE(begin + length, root_["buffers"][0]["byteLength"].get<size_t>());
    EXPECT_LE(begin + length, bin_.size());
    if (begin + length > bin_.size()) return std::vector<uint8_t>(length);
    return {bin_.begin() + static_cast<ptrdiff_t>(begin),
            bin_.begin() + static_cast<ptrdiff_t>(begin + length)};
  }

 private:
  template <typename T>
  static Json numberAt(const std::vector<uint8_t>& bytes, size_t index) {
    T number = {};
    EXPECT_LE((index + 1) * sizeof(T), bytes.size());
    if ((index + 1) * sizeof(T) > bytes.size()) return nullptr;
    std::memcpy(&number, bytes.data() + index * sizeof(T), sizeof(T));
    return number;
  }

  static Json componentAt(const std::string& type, const std::vector<uint8_t>& bytes,
                          size_t index) {
    if (type == "INT8") return numberAt<int8_t>(bytes, index);
    if (type == "UINT8") return numberAt<uint8_t>(bytes, index);
    if (type == "INT16") return numberAt<int16_t>(bytes, index);
    if (type == "UINT16") return numberAt<uint16_t>(bytes, index);
    if (type == "INT32") return numberAt<int32_t>(bytes, index);
    if (type == "UINT32") return numberAt<uint32_t>(bytes, index);
    if (type == "INT64") return numberAt<int64_t>(bytes, index);
    if (type == "UINT64") return numberAt<uint64_t>(bytes, index);
    if (type == "FLOAT32") return numberAt<float>(bytes, index);
    EXPECT_EQ(type, "FLOAT64");
    return numberAt<double>(bytes, index);
  }

  size_t offsetAt(const Json& stored, const std::string& member, size_t index) const {
    const std::vector<uint8_t> bytes = viewBytes(stored[member + "s"].get<size_t>());
    const Json offset = componentAt(stored.value(member + "Type", "UINT32"), bytes, index);
    return offset.is_null() ? 0 : offset.get<size_t>();
  }

  Json elementOf(const Json& property, const Json& stored, size_t element) const {
    const std::vector<uint8_t> bytes = viewBytes(stored["values"].get<size_t>());
    const auto type = property["type"].get<std::string>();
    if (type == "BOOLEAN") return ((bytes[element / 8] >> (element % 8)) & 1) != 0;
    if (type == "STRING") {
      const size_t begin = offsetAt(stored, "stringOffset", element);
      const size_t end = offsetAt(stored, "stringOffset", element + 1);
      EXPECT_LE(begin, end);
      EXPECT_LE(end, bytes.size());
      return std::string(bytes.begin() + static_cast<ptrdiff_t>(begin),
                         bytes.begin() + static_cast<ptrdiff_t>(end));
    }
    const auto component = property["componentType"].get<std::string>();
    if (type == "SCALAR") return componentAt(component, bytes, element);
    const auto count = static_cast<size_t>(type.back() - '0');
    Json vector = Json::array();
    for (size_t i = 0; i < count; ++i) {
      vector.push_back(componentAt(component, bytes, element * count + i));
    }
    return vector;
  }

  Json valueOf(const Json& property, const Json& stored, size_t row) const {
    if (!property.value("array", false)) return elementOf(property, stored, row);
    size_t begin = 0;
    size_t end = 0;
    if (property.contains("count")) {
      EXPECT_GE(property["count"], 2);
      begin = row * property["count"].get<size_t>();
      end = begin + property["count"].get<size_t>();
    } else {
      begin = offsetAt(stored, "arrayOffset", row);
      end = offsetAt(stored, "arrayOffset", row + 1);
    }
    Json array = Json::array();
    for (size_t i = begin; i < end; ++i) array.push_back(elementOf(property, stored, i));
    return array;
  }

  Json root_;
  std::vector<uint8_t> bin_;
};

}  // namespace mcc::test

#endif  // MCC_TESTS_TILES_METADATA_READER_H_
