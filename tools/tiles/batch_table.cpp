// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/batch_table.h"

#include <bit>
#include <cmath>

namespace mcc::tiles {
namespace {

using gltf::Json;
using gltf::Result;

constexpr char kTable[] = "batch table";

struct BinaryType {
  const char* name;            ///< in the batch table
  const char* component_type;  ///< in the 3D Metadata Specification
  uint32_t bytes;
};

constexpr BinaryType kBinaryTypes[] = {
    {"BYTE", "INT8", 1},     {"UNSIGNED_BYTE", "UINT8", 1},   {"SHORT", "INT16", 2},
    {"INT", "INT32", 4},     {"UNSIGNED_SHORT", "UINT16", 2}, {"UNSIGNED_INT", "UINT32", 4},
    {"FLOAT", "FLOAT32", 4}, {"DOUBLE", "FLOAT64", 8}};

constexpr const char* kVectorTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};

/// Returns a member that must be text, or an empty string.
std::string textOf(const Json& object, const char* key) {
  const Json* member = gltf::findMember(object, key);
  return member != nullptr && member->is_string() ? member->get<std::string>() : "";
}

template <typename Bits, typename Float>
bool areFinite(std::span<const uint8_t> bytes) {
  for (size_t at = 0; at + sizeof(Bits) <= bytes.size(); at += sizeof(Bits)) {
    Bits bits = 0;
    for (size_t i = 0; i < sizeof(Bits); ++i) bits |= Bits{bytes[at + i]} << (8 * i);
    if (!std::isfinite(std::bit_cast<Float>(bits))) return false;
  }
  return true;
}

/// Reads a property whose values are in the binary part of the table. They keep their bits.
Result readBinaryColumn(const Json& property, std::span<const uint8_t> binary, uint64_t batch_count,
                        const std::string& path, Column& column) {
  const std::string type_name = textOf(property, "componentType");
  const BinaryType* type = nullptr;
  for (const BinaryType& one : kBinaryTypes) {
    if (type_name == one.name) type = &one;
  }
  if (type == nullptr) return gltf::error(path, "its componentType is none of 3D Tiles");
  column.type = textOf(property, "type");
  uint64_t component_count = 0;
  for (uint64_t i = 0; i < 4; ++i) {
    if (column.type == kVectorTypes[i]) component_count = i + 1;
  }
  if (component_count == 0) return gltf::error(path, "its type is none of 3D Tiles");
  for (const auto& [key, value] : property.get_ref<const Json::object_t&>()) {
    if (key != "byteOffset" && key != "componentType" && key != "type") {
      return gltf::error(path, "it has a member \"" + key + "\", whose meaning is not known");
    }
  }
  uint64_t offset = 0;
  const Json* at = gltf::findMember(property, "byteOffset");
  if (at == nullptr || !gltf::asUnsigned(*at, offset) || offset > binary.size() ||
      batch_count > (binary.size() - offset) / (component_count * type->bytes)) {
    return gltf::error(path, "its values reach beyond the binary part of the table");
  }
  const auto bytes = binary.subspan(offset, batch_count * component_count * type->bytes);
  if ((type_name == "FLOAT" && !areFinite<uint32_t, float>(bytes)) ||
      (type_name == "DOUBLE" && !areFinite<uint64_t, double>(bytes))) {
    return gltf::error(path, "a value is not finite, which property tables cannot hold");
  }
  column.component_type = type->component_type;
  column.values.assign(bytes.begin(), bytes.end());
  return {};
}

Result readColumn(const std::string& name, const Json& property, std::span<const uint8_t> binary,
                  uint64_t batch_count, Column& column) {
  const std::string path = gltf::at(kTable, name);
  column.name = name;
  if (property.is_object()) {
    return readBinaryColumn(property, binary, batch_count, path, column);
  }
  if (!property.is_array()) {
    return gltf::error(path, "it is neither an array nor a place in the binary part");
  }
  if (property.size() != batch_count) {
    return gltf::error(path, "it has " + std::to_string(property.size()) + " values for " +
                                 std::to_string(batch_count) + " batches");
  }
  Result read = readJsonColumn(property, column);
  return read.ok() ? read : gltf::error(path, read.message());
}

}  // namespace

Result readBatchTable(std::span<const uint8_t> json, std::span<const uint8_t> binary,
                      uint64_t batch_count, BatchTable& table) {
  table = {};
  if (json.empty()) return {};
  Json root;
  const Result parsed = gltf::parseJson(json, root);
  if (!parsed.ok()) return gltf::error(kTable, parsed.message());
  if (!root.is_object()) return gltf::error(kTable, "it is not a JSON object");
  for (auto& [name, property] : root.get_ref<Json::object_t&>()) {
    if (name == "extras") {
      table.extras = std::move(property);
    } else if (name == "HIERARCHY" && property.is_object()) {
      return gltf::error(kTable, "the hierarchy of its batches has no counterpart");
    } else if (name == "extensions") {
      if (property.is_object() && property.empty()) continue;
      const std::string first = property.is_object() ? property.begin().key() : "";
      return gltf::error(kTable, "its extension \"" + first + "\" has no counterpart");
    } else if (batch_count != 0) {
      Column& column = table.columns.emplace_back();
      MCC_GLTF_TRY(readColumn(name, property, binary, batch_count, column));
    } else if (!property.is_object() && !(property.is_array() && property.empty())) {
      return gltf::error(gltf::at(kTable, name), "it has values, and there are no batches");
    }
  }
  return {};
}

}  // namespace mcc::tiles
