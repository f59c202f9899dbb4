// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "support/plain_reader.h"

#include <cstring>
#include <stdexcept>

#include "support/gltf_builder.h"
#ifdef MCC_HAS_FOREIGN
#include "foreign/draco_codec.h"
#include "foreign/meshopt_codec.h"
#endif

namespace mcc::gltf::test {
namespace {

constexpr char kDraco[] = "KHR_draco_mesh_compression";

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

uint32_t word(const Bytes& bytes, size_t at) {
  if (at + 4 > bytes.size()) fail("the GLB ends early");
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= uint32_t{bytes[at + i]} << (8 * i);
  return value;
}

Bytes slice(const Bytes& bytes, uint64_t offset, uint64_t length) {
  if (offset > bytes.size() || length > bytes.size() - offset) fail("a range is out of bounds");
  const auto begin = bytes.begin() + static_cast<ptrdiff_t>(offset);
  return {begin, begin + static_cast<ptrdiff_t>(length)};
}

Bytes fromBase64(const std::string& text) {
  Bytes bytes;
  uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    static const std::string kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const size_t digit = kDigits.find(c);
    if (digit == std::string::npos) continue;
    bits = bits << 6 | static_cast<uint32_t>(digit);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<uint8_t>(bits >> bit_count));
  }
  return bytes;
}

std::string withoutPercents(const std::string& uri) {
  std::string path;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size()) {
      path += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      path += uri[i];
    }
  }
  return path;
}

uint32_t bytesOfType(uint64_t component_type) {
  if (component_type < kByte || component_type > kFloat || component_type == kUnsignedShort + 1)
    fail("an unknown component type");
  return widthOf(static_cast<int>(component_type));
}

}  // namespace

const Json& memberOf(const Json& object, const char* key) {
  static const Json kNull;
  const Json* member = findMember(object, key);
  return member == nullptr ? kNull : *member;
}

uint64_t numberOf(const Json& value) {
  double number = -1;
  if (!asNumber(value, number) || number < 0) fail("a number is none");
  return static_cast<uint64_t>(number);
}

uint64_t numberOf(const Json& object, const char* key, uint64_t otherwise) {
  const Json* member = findMember(object, key);
  return member == nullptr ? otherwise : numberOf(*member);
}

double component(const Elements& elements, size_t i, size_t c) {
  return componentAt(static_cast<int>(elements.component_type), elements.values.at(i).data(), c);
}

std::vector<double> PlainDocument::numbers(uint64_t accessor) const {
  const Elements read = elements(accessor);
  std::vector<double> numbers;
  for (size_t i = 0; i < read.values.size(); ++i) {
    for (size_t c = 0; c < read.component_count; ++c) numbers.push_back(component(read, i, c));
  }
  return numbers;
}

Bytes PlainDocument::fetch(const std::string& uri) const {
  if (uri.starts_with("data:")) return fromBase64(uri.substr(uri.find(',') + 1));
  const auto found = files_.find(withoutPercents(uri));
  if (found == files_.end()) fail("there is no file " + uri);
  return found->second;
}

std::string PlainDocument::load(const Files& files, const std::string& main) try {
  files_ = files;
  if (files.count(main) == 0) fail("there is no " + main);
  const Bytes& file = files.at(main);
  Bytes text = file;
  Bytes bin;
  if (file.size() >= 12 && std::memcmp(file.data(), "glTF", 4) == 0) {
    const bool is_glb3 = word(file, 4) == 3;
    const size_t header_bytes = is_glb3 ? 16 : 8;
    const size_t alignment = is_glb3 ? 8 : 4;
    for (size_t at = is_glb3 ? 16 : 12; at + header_bytes <= file.size();) {
      const uint32_t length = word(file, is_glb3 ? at + 8 : at);
      const uint32_t type = word(file, is_glb3 ? at : at + 4);
      if (type == 0x4e4f534a) text = slice(file, at + header_bytes, length);
      if (type == 0x004e4942) bin = slice(file, at + header_bytes, length);
      at += header_bytes + (length + alignment - 1) / alignment * alignment;
    }
  }
  if (text.size() >= 3 && text[0] == 0xef) text.erase(text.begin(), text.begin() + 3);
  const Result parsed = parseJson(text, json);
  if (!parsed.ok()) fail(parsed.message());
  for (const Json& buffer : memberOf(json, "buffers")) {
    const Json& uri = memberOf(buffer, "uri");
    const uint64_t length = numberOf(buffer, "byteLength", 0);
    const Json& coding = memberOf(memberOf(buffer, "extensions"), "EXT_meshopt_compression");
    const bool is_placeholder = uri.is_null() && !coding.is_null() && !buffers_.empty();
    if (is_placeholder) {
      buffers_.emplace_back();
    } else {
      buffers_.push_back(slice(uri.is_null() ? bin : fetch(uri.get<std::string>()), 0, length));
    }
  }
  decodeMeshes();
  return "";
} catch (const std::exception& error) {
  return error.what();
}

#ifdef MCC_HAS_FOREIGN

void PlainDocument::decodeMeshes() {
  for (const Json& mesh : memberOf(json, "meshes")) {
    for (const Json& primitive : memberOf(mesh, "primitives")) {
      const Json& coded = memberOf(memberOf(primitive, "extensions"), kDraco);
      if (coded.is_null()) continue;
      foreign::DecodedMesh decoded;
      const auto outcome =
          foreign::decodeDraco(viewBytes(numberOf(coded, "bufferView", 0)), decoded);
      if (!outcome.ok()) fail(outcome.message);
      for (const auto& [name, id] : memberOf(coded, "attributes").items()) {
        const auto* values = decoded.find(static_cast<uint32_t>(numberOf(id)));
        if (values == nullptr) fail("Draco lacks an attribute");
        const auto* first = reinterpret_cast<const uint8_t*>(values->values.get());
        decoded_[numberOf(memberOf(primitive, "attributes"), name.c_str(), 0)] = {
            first, first + values->elementBytes() * decoded.vertex_count};
      }
      const uint64_t indices = numberOf(primitive, "indices", 0);
      const uint32_t width =
          bytesOfType(numberOf(memberOf(json, "accessors")[indices], "componentType", 0));
      Bytes& bytes = decoded_[indices];
      for (const uint32_t index : decoded.indexSpan()) append(bytes, index, width);
    }
  }
}

Bytes PlainDocument::decodedView(const Json& coding, const Bytes& coded) {
  const Json& filter = memberOf(coding, "filter");
  Bytes elements;
  const auto outcome = foreign::decodeMeshoptView(
      coded, numberOf(coding, "count", 0), static_cast<uint32_t>(numberOf(coding, "byteStride", 0)),
      memberOf(coding, "mode").get<std::string>(),
      filter.is_null() ? "NONE" : filter.get<std::string>(), elements);
  if (!outcome.ok()) fail(outcome.message);
  return elements;
}

#else

void PlainDocument::decodeMeshes() {}

Bytes PlainDocument::decodedView(const Json&, const Bytes&) { fail("this build has no meshopt"); }

#endif

Bytes PlainDocument::viewBytes(uint64_t view) const {
  const Json& views = memberOf(json, "bufferViews");
  if (view >= views.size()) fail("there is no such view");
  const auto rangeOf = [&](const Json& range) {
    const uint64_t buffer = numberOf(range, "buffer", 0);
    if (buffer >= buffers_.size()) fail("there is no such buffer");
    return slice(buffers_[buffer], numberOf(range, "byteOffset", 0),
                 numberOf(range, "byteLength", 0));
  };
  const Json& coding = memberOf(memberOf(views[view], "extensions"), "EXT_meshopt_compression");
  if (coding.is_null()) return rangeOf(views[view]);
  return decodedView(coding, rangeOf(coding));
}

Bytes PlainDocument::imageBytes(uint64_t image) const {
  const Json& json_image = memberOf(json, "images")[image];
  const Json& uri = memberOf(json_image, "uri");
  if (uri.is_string()) return fetch(uri.get<std::string>());
  return viewBytes(numberOf(json_image, "bufferView", 0));
}

Elements PlainDocument::elements(uint64_t accessor) const {
  const Json& accessors = memberOf(json, "accessors");
  if (accessor >= accessors.size()) fail("there is no accessor " + std::to_string(accessor));
  const Json& source = accessors[accessor];
  Elements elements;
  elements.type = memberOf(source, "type").get<std::string>();
  elements.component_type = numberOf(source, "componentType", 0);
  elements.is_normalized = memberOf(source, "normalized") == true;
  if (elements.type != "SCALAR" && !elements.type.starts_with("VEC") &&
      !elements.type.starts_with("MAT")) {
    fail("an unknown type");
  }
  const Shape shape = shapeOf(elements.type);
  const uint32_t width = bytesOfType(elements.component_type);
  const uint32_t column = shape.rows * width;
  const uint32_t padded_column = shape.columns == 1 ? column : (column + 3) / 4 * 4;
  const uint32_t element = shape.columns * padded_column;
  elements.component_count = shape.columns * shape.rows;
  const uint64_t count = numberOf(source, "count", 0);
  if (count > 1 << 24) fail("too many elements");
  elements.values.assign(count, std::string(shape.columns * column, '\0'));

  const auto fill = [&](const Bytes& bytes, uint64_t offset, uint64_t stride, uint64_t i,
                        std::string& value) {
    for (uint32_t c = 0; c < shape.columns; ++c) {
      const uint64_t at = offset + i * stride + c * padded_column;
      if (at > bytes.size() || column > bytes.size() - at) fail("an element is out of bounds");
      std::memcpy(value.data() + c * column, &bytes[at], column);
    }
  };
  if (const auto decoded = decoded_.find(accessor); decoded != decoded_.end()) {
    for (uint64_t i = 0; i < count; ++i) {
      const Bytes part =
          slice(decoded->second, i * elements.values[i].size(), elements.values[i].size());
      std::memcpy(elements.values[i].data(), part.data(), part.size());
    }
    return elements;
  }
  if (const Json& view = memberOf(source, "bufferView"); !view.is_null()) {
    const uint64_t stride =
        numberOf(memberOf(json, "bufferViews")[numberOf(view)], "byteStride", element);
    const Bytes bytes = viewBytes(numberOf(view));
    const uint64_t offset = numberOf(source, "byteOffset", 0);
    for (uint64_t i = 0; i < count; ++i) fill(bytes, offset, stride, i, elements.values[i]);
  }
  const Json& sparse = memberOf(source, "sparse");
  const uint64_t sparse_count = numberOf(sparse, "count", 0);
  if (sparse_count == 0) return elements;
  const Json& indices = memberOf(sparse, "indices");
  const Json& values = memberOf(sparse, "values");
  const Bytes index_bytes = viewBytes(numberOf(indices, "bufferView", 0));
  const Bytes value_bytes = viewBytes(numberOf(values, "bufferView", 0));
  const uint32_t index_width = bytesOfType(numberOf(indices, "componentType", 0));
  for (uint64_t i = 0; i < sparse_count; ++i) {
    const Bytes part =
        slice(index_bytes, numberOf(indices, "byteOffset", 0) + i * index_width, index_width);
    uint64_t index = 0;
    for (uint32_t k = 0; k < index_width; ++k) index |= uint64_t{part[k]} << 8 * k;
    if (index >= count) fail("a sparse index is out of range");
    fill(value_bytes, numberOf(values, "byteOffset", 0), element, i, elements.values[index]);
  }
  return elements;
}

}  // namespace mcc::gltf::test
