// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/subtree.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "host/result.h"
#include "json/json.h"
#include "tiles/little_endian.h"

namespace mcc::tiles {
namespace {

using gltf::arrayOf;
using gltf::findMember;
using gltf::Json;
using gltf::Result;

constexpr uint64_t kHeaderBytes = 24;  // magic, version, length of the JSON, length of the rest
constexpr uint64_t kMostBuffers = 1024;
constexpr char kSemantic[] = "TILE_GEOMETRIC_ERROR";

bool isText(const Json* json, const char* text) {
  return json != nullptr && json->is_string() && json->text() == text;
}

}  // namespace

ImplicitPlace ImplicitPlace::below(uint32_t levels, uint64_t morton, uint32_t dimensions) const {
  ImplicitPlace place = {level + levels, x << levels, y << levels, z << levels};
  uint64_t* const axes[] = {&place.x, &place.y, &place.z};
  for (uint32_t bit = 0; bit < levels * dimensions; ++bit) {
    *axes[bit % dimensions] |= (morton >> bit & 1) << (bit / dimensions);
  }
  return place;
}

std::string ImplicitPlace::uriOf(const std::string& uri_template) const {
  const std::pair<std::string_view, uint64_t> kNames[] = {
      {"{level}", level}, {"{x}", x}, {"{y}", y}, {"{z}", z}};
  std::string uri;
  for (size_t at = 0; at < uri_template.size();) {
    const std::string_view rest = std::string_view(uri_template).substr(at);
    size_t length = 0;
    for (const auto& [name, value] : kNames) {
      if (!rest.starts_with(name)) continue;
      uri += std::to_string(value);
      length = name.size();
    }
    if (length == 0) uri += uri_template[at];
    at += std::max<size_t>(length, 1);
  }
  return uri;
}

ErrorSchema errorSchemaOf(const Json& schema) {
  ErrorSchema found;
  const Json* classes = findMember(schema, "classes");
  if (classes == nullptr || !classes->is_object()) return found;
  for (const auto& [class_name, of_class] : classes->items()) {
    const Json* properties = findMember(of_class, "properties");
    if (properties == nullptr || !properties->is_object()) continue;
    for (const auto& [name, property] : properties->items()) {
      if (!isText(findMember(property, "semantic"), kSemantic)) continue;
      const Json* component = findMember(property, "componentType");
      found.class_name = class_name;
      found.property = name;
      found.is_double = isText(component, "FLOAT64");
      bool is_plain = found.is_double || isText(component, "FLOAT32");
      is_plain = is_plain && isText(findMember(property, "type"), "SCALAR");
      for (const char* more : {"array", "offset", "scale", "noData"}) {
        is_plain = is_plain && findMember(property, more) == nullptr;
      }
      if (!is_plain) found.unknown_because = "is not a plain FLOAT32 or FLOAT64";
    }
  }
  return found;
}

Result Subtree::readJsonPart(std::span<const uint8_t>& json,
                             std::span<const uint8_t>& binary) const {
  json = file_;
  if (file_.size() < 4 || std::memcmp(file_.data(), "subt", 4) != 0) return {};  // JSON alone
  if (file_.size() < kHeaderBytes) return gltf::error("byte 0", "the header is cut off");
  if (numberAt(file_, 4) != 1) return gltf::error("byte 4", "only version 1 of subtrees is known");
  const uint64_t room = file_.size() - kHeaderBytes;
  const uint64_t json_bytes = longNumberAt(file_, 8);
  if (json_bytes > room) return gltf::error("byte 8", "the JSON reaches beyond the file");
  const uint64_t binary_bytes = longNumberAt(file_, 16);
  if (binary_bytes > room - json_bytes) {
    return gltf::error("byte 16", "the binary part reaches beyond the file");
  }
  json = std::span<const uint8_t>(file_).subspan(kHeaderBytes, json_bytes);
  binary = std::span<const uint8_t>(file_).subspan(kHeaderBytes + json_bytes, binary_bytes);
  return {};
}

Result Subtree::readBuffers(const BufferReader& read_buffer, std::span<const uint8_t> binary) {
  const Json& buffers = arrayOf(json_, "buffers");
  if (buffers.size() > kMostBuffers) return gltf::error("/buffers", "are more than 1024");
  loaded_.resize(buffers.size());
  for (size_t i = 0; i < buffers.size(); ++i) {
    const std::string where = gltf::at("/buffers", i);
    uint64_t bytes = 0;
    MCC_GLTF_TRY(gltf::readUnsigned(buffers[i], "byteLength", where, UINT64_MAX, bytes));
    std::span<const uint8_t> buffer = binary;
    const Json* uri = findMember(buffers[i], "uri");
    if (uri != nullptr && uri->is_string()) {
      MCC_GLTF_TRY(read_buffer(uri->get<std::string>(), loaded_[i]));
      buffer = loaded_[i];
    }
    if (bytes > buffer.size()) return gltf::error(where, "claims more bytes than there are");
    buffers_.push_back(buffer.subspan(0, bytes));
  }
  return {};
}

Result Subtree::viewAt(const std::string& where, const Json& number,
                       std::span<const uint8_t>& bytes) const {
  const Json& views = arrayOf(json_, "bufferViews");
  uint64_t view = 0;
  if (!gltf::asUnsigned(number, view) || view >= views.size()) {
    return gltf::error(where, "names no buffer view");
  }
  const std::string at = gltf::at("/bufferViews", view);
  uint64_t buffer = 0;
  uint64_t begin = 0;
  uint64_t length = 0;
  if (buffers_.empty()) return gltf::error(at, "names no buffer");
  MCC_GLTF_TRY(gltf::readUnsigned(views[view], "buffer", at, buffers_.size() - 1, buffer));
  const uint64_t size = buffers_[buffer].size();
  MCC_GLTF_TRY(gltf::readOptionalUnsigned(views[view], "byteOffset", at, size, begin));
  MCC_GLTF_TRY(gltf::readUnsigned(views[view], "byteLength", at, size - begin, length));
  bytes = buffers_[buffer].subspan(begin, length);
  return {};
}

Result Subtree::readAvailability(const Json* json, const std::string& where, uint64_t bit_count,
                                 Availability& availability) const {
  if (json == nullptr || !json->is_object()) return gltf::error(where, "is not an object");
  if (const Json* constant = findMember(*json, "constant")) {
    uint64_t value = 0;
    if (!gltf::asUnsigned(*constant, value) || value > 1) {
      return gltf::error(where + "/constant", "is neither 0 nor 1");
    }
    availability = Availability(value == 1);
    return {};
  }
  const char* name = findMember(*json, "bitstream") != nullptr ? "bitstream" : "bufferView";
  const Json* view = findMember(*json, name);  // of the extension
  if (view == nullptr) return gltf::error(where, "has neither a constant nor a bitstream");
  std::span<const uint8_t> bits;
  MCC_GLTF_TRY(viewAt(where + "/" + name, *view, bits));
  if (bits.size() < (bit_count + 7) / 8) {
    return gltf::error(where, "has fewer than " + std::to_string(bit_count) + " bits");
  }
  availability = Availability(bits);
  return {};
}

Result Subtree::readErrors(const ErrorSchema& schema) {
  const Json* table_number = findMember(json_, "tileMetadata");
  if (table_number == nullptr || schema.class_name.empty()) return {};
  const Json& tables = arrayOf(json_, "propertyTables");
  uint64_t number = 0;
  if (!gltf::asUnsigned(*table_number, number) || number >= tables.size()) {
    return gltf::error("/tileMetadata", "names no property table");
  }
  const std::string where = gltf::at("/propertyTables", number);
  if (!isText(findMember(tables[number], "class"), schema.class_name.c_str())) return {};
  const Json* properties = findMember(tables[number], "properties");
  const Json* property = properties == nullptr ? nullptr : findMember(*properties, schema.property);
  if (property == nullptr) return {};
  if (!schema.unknown_because.empty()) {
    return gltf::error(where, std::string(kSemantic) + " " + schema.unknown_because +
                                  "; the tiles of this subtree are only copied");
  }
  const Json* values = findMember(*property, "values");
  if (values == nullptr) values = findMember(*property, "bufferView");  // of the extension
  if (values == nullptr) return gltf::error(where, "has no values");
  is_double_ = schema.is_double;
  return viewAt(where, *values, errors_);
}

std::optional<double> Subtree::errorOf(uint64_t rank) const {
  const uint64_t size = is_double_ ? 8 : 4;
  if (rank >= errors_.size() / size) return std::nullopt;
  const double error = is_double_ ? std::bit_cast<double>(longNumberAt(errors_, rank * size))
                                  : std::bit_cast<float>(numberAt(errors_, rank * size));
  return std::isfinite(error) && error >= 0 ? std::optional(error) : std::nullopt;
}

Result Subtree::read(std::vector<uint8_t> file, uint32_t dimensions, uint32_t levels,
                     const ErrorSchema& schema, const BufferReader& read_buffer) {
  *this = {};
  file_ = std::move(file);
  std::span<const uint8_t> json;
  std::span<const uint8_t> binary;
  MCC_GLTF_TRY(readJsonPart(json, binary));
  MCC_GLTF_TRY(gltf::parseJson(json, json_));
  MCC_GLTF_TRY(readBuffers(read_buffer, binary));
  const uint64_t children = uint64_t{1} << (levels * dimensions);
  const uint64_t tiles = (children - 1) / ((uint64_t{1} << dimensions) - 1);
  MCC_GLTF_TRY(
      readAvailability(findMember(json_, "tileAvailability"), "/tileAvailability", tiles, tiles_));
  MCC_GLTF_TRY(readAvailability(findMember(json_, "childSubtreeAvailability"),
                                "/childSubtreeAvailability", children, children_));
  const Json* contents = findMember(json_, "contentAvailability");
  if (contents != nullptr && contents->is_object()) {  // of the extension
    MCC_GLTF_TRY(
        readAvailability(contents, "/contentAvailability", tiles, contents_.emplace_back()));
  }
  const Json* multiple = findMember(json_, "extensions");
  if (multiple != nullptr) multiple = findMember(*multiple, "3DTILES_multiple_contents");
  const Json& list = arrayOf(multiple != nullptr ? *multiple : json_, "contentAvailability");
  for (size_t i = 0; i < list.size(); ++i) {
    const std::string where = gltf::at("/contentAvailability", i);
    MCC_GLTF_TRY(readAvailability(&list[i], where, tiles, contents_.emplace_back()));
  }
  const Result errors = readErrors(schema);
  json_ = {};  // takes many times the memory of the rest, and was all read
  return errors;
}

}  // namespace mcc::tiles
