// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/structural_metadata.h"

#include <map>
#include <set>
#include <utility>

#include "tiles/json_edit.h"

namespace mcc::tiles {
namespace {

using gltf::Result;

constexpr char kClass[] = "batch_table";

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Returns the name with an underscore for each character that an id cannot have.
std::string idOf(const std::string& name) {
  std::string id;
  for (const char c : name) {
    const bool continues_character = (static_cast<uint8_t>(c) & 0xc0) == 0x80;
    if (isLetter(c) || isDigit(c)) {
      id += c;
    } else if (!continues_character) {
      id += '_';
    }
  }
  return id.empty() || isDigit(id[0]) ? "_" + id : id;
}

/// Returns the bytes of offsets, with the smallest type that holds the last one.
std::vector<uint8_t> packOffsets(const std::vector<uint64_t>& offsets, const char*& type) {
  const uint64_t largest = offsets.back();
  const uint32_t bytes = largest <= 0xff         ? 1
                         : largest <= 0xffff     ? 2
                         : largest <= 0xffffffff ? 4
                                                 : 8;
  type = bytes == 1 ? "UINT8" : bytes == 2 ? "UINT16" : bytes == 4 ? "UINT32" : "UINT64";
  std::vector<uint8_t> packed;
  packed.reserve(offsets.size() * bytes);
  for (const uint64_t offset : offsets) {
    for (uint32_t i = 0; i < bytes; ++i) packed.push_back(static_cast<uint8_t>(offset >> (8 * i)));
  }
  return packed;
}

Json classPropertyOf(const Column& column, const std::string& id) {
  Json property = Json::object();
  if (column.name != id) addMember(property, "name", column.name);
  addMember(property, "type", column.type);
  if (!column.component_type.empty()) addMember(property, "componentType", column.component_type);
  if (column.is_array) addMember(property, "array", true);
  if (column.array_length != 0) addMember(property, "count", column.array_length);
  if (column.is_required) addMember(property, "required", true);
  if (!column.no_data.is_null()) addMember(property, "noData", column.no_data);
  if (!column.default_value.is_null()) addMember(property, "default", column.default_value);
  return property;
}

Result addOffsets(const std::vector<uint64_t>& offsets, const std::string& member, Json& root,
                  BinEnd& bin, Json& property) {
  if (offsets.empty()) return {};
  const char* type = "";
  uint32_t view = 0;
  MCC_GLTF_TRY(bin.addView(packOffsets(offsets, type), Json::object(), root, view));
  addMember(property, member + "s", view);
  addMember(property, member + "Type", type);
  return {};
}

Result addValues(const Column& column, Json& root, BinEnd& bin, Json& property) {
  uint32_t view = 0;
  MCC_GLTF_TRY(bin.addView(column.values, Json::object(), root, view));
  property = Json::object();
  addMember(property, "values", view);
  MCC_GLTF_TRY(addOffsets(column.array_offsets, "arrayOffset", root, bin, property));
  return addOffsets(column.string_offsets, "stringOffset", root, bin, property);
}

}  // namespace

std::vector<std::string> propertyIds(const std::vector<std::string>& names) {
  std::vector<std::string> ids;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    const std::string id = idOf(name);
    ids.push_back(id == name && taken.insert(id).second ? id : "");
  }
  std::map<std::string, size_t> next_numbers;  // so that many names with one id take linear time
  for (size_t i = 0; i < names.size(); ++i) {
    if (!ids[i].empty()) continue;
    const std::string base = idOf(names[i]);
    std::string id = base;
    size_t& number = next_numbers.try_emplace(base, 2).first->second;
    while (!taken.insert(id).second) id = base + "_" + std::to_string(number++);
    ids[i] = std::move(id);
  }
  return ids;
}

Result addPropertyTable(const BatchTable& table, uint64_t row_count, Json& root, BinEnd& bin) {
  std::vector<std::string> names;
  for (const Column& column : table.columns) names.push_back(column.name);
  const std::vector<std::string> ids = propertyIds(names);
  Json class_properties = Json::object();
  Json table_properties = Json::object();
  for (size_t i = 0; i < ids.size(); ++i) {
    const Column& column = table.columns[i];
    addMember(class_properties, ids[i], classPropertyOf(column, ids[i]));
    if (column.values.empty()) continue;
    Json property;
    MCC_GLTF_TRY(addValues(column, root, bin, property));
    addMember(table_properties, ids[i], std::move(property));
  }
  Json of_class = Json::object();
  if (!class_properties.empty()) addMember(of_class, "properties", std::move(class_properties));
  Json of_table = Json::object();
  addMember(of_table, "class", kClass);
  addMember(of_table, "count", row_count);
  if (!table_properties.empty()) addMember(of_table, "properties", std::move(table_properties));
  Json extension = Json::object();
  Json& schema = addMember(extension, "schema", Json::object());
  addMember(schema, "id", kClass);
  addMember(addMember(schema, "classes", Json::object()), kClass, std::move(of_class));
  addMember(extension, "propertyTables", Json::array()).push_back(std::move(of_table));
  if (!table.extras.is_null()) addMember(extension, "extras", table.extras);
  Json& extensions = memberOrNew(root, "extensions", Json::object());
  if (!extensions.is_object()) return gltf::error("/extensions", "must be an object");
  addMember(extensions, "EXT_structural_metadata", std::move(extension));
  return {};
}

}  // namespace mcc::tiles
