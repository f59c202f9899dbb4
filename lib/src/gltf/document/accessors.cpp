// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/accessors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "mcc/reader.h"

namespace mcc::gltf {

// glTF buffers are little-endian, and accessors are filled by memcpy. Reader and writer work on
// either.
static_assert(std::endian::native == std::endian::little,
              "documents need a little-endian host; build with MCC_READER_ONLY");

namespace {

uint32_t readLittleEndian(const uint8_t* bytes, uint32_t byte_count) {
  uint32_t value = 0;
  for (uint32_t i = 0; i < byte_count; ++i) value |= uint32_t{bytes[i]} << (8 * i);
  return value;
}

const uint8_t* viewBytes(const Document& document, uint32_t view, uint64_t offset) {
  const BufferView& from = document.views[view];
  if (from.isCoded()) return document.storage[from.coding.decoded].data() + offset;
  return document.buffers[from.buffer].data() + from.offset + offset;
}

/// Returns the most bytes that an accessor may claim which has no bytes in the file.
uint64_t maxZeroBytes(const Document& document) {
  constexpr uint64_t kMost = uint64_t{1} << 28;
  return std::min(kMost, document.decoded.zeroLimit());
}

/// Removes the padding of matrix columns.
void copyTight(const uint8_t* element, const Accessor& accessor, uint8_t* out) {
  const uint32_t tight_column = accessor.rows * componentBytes(accessor.component_type);
  for (uint32_t column = 0; column < accessor.columns; ++column) {
    std::memcpy(out + column * tight_column, element + column * accessor.columnBytes(),
                tight_column);
  }
}

Result applySparse(const Document& document, const Accessor& accessor, const std::string& path,
                   std::vector<uint8_t>& tight) {
  const Sparse& sparse = accessor.sparse;
  const uint32_t index_bytes = componentBytes(sparse.index_type);
  const uint8_t* indices = viewBytes(document, sparse.index_view, sparse.index_offset);
  const uint8_t* values = viewBytes(document, sparse.value_view, sparse.value_offset);
  for (uint64_t i = 0; i < sparse.count; ++i) {
    const uint32_t index = readLittleEndian(indices + i * index_bytes, index_bytes);
    if (index >= accessor.count) {
      return error(path + "/sparse/indices", "index ", index, " is outside the accessor of ",
                   accessor.count, " elements");
    }
    copyTight(values + i * accessor.elementBytes(), accessor,
              tight.data() + uint64_t{index} * accessor.tightBytes());
  }
  return {};
}

bool canBeUsedInPlace(const Accessor& accessor, const uint8_t* bytes, uint64_t stride) {
  const uint32_t alignment = componentBytes(accessor.component_type);
  return accessor.elementBytes() == accessor.tightBytes() &&
         std::bit_cast<uintptr_t>(bytes) % alignment == 0 && stride % alignment == 0;
}

/// Copies elements; they are zeros when `bytes` is null.
void copyElements(const Accessor& accessor, const uint8_t* bytes, uint64_t stride,
                  AccessorData& elements) {
  elements.owned.resize(accessor.count * elements.element_bytes);
  for (uint64_t i = 0; bytes != nullptr && i < accessor.count; ++i) {
    copyTight(bytes + i * stride, accessor, elements.owned.data() + i * elements.element_bytes);
  }
  elements.data = elements.owned.data();
  elements.stride_bytes = elements.element_bytes;
}

}  // namespace

uint64_t AccessorData::firstDifference(const AccessorData& other) const {
  for (uint64_t i = 0; i < count; ++i) {
    const std::span<const uint8_t> a = element(i);
    const std::span<const uint8_t> b = other.element(i);
    if (!std::equal(a.begin(), a.end(), b.begin(), b.end())) return i;
  }
  return count;
}

std::string whyUnreadable(const Document& document, const Accessor& accessor) {
  if (!accessor.fault.ok()) return "cannot be read (" + accessor.fault.message() + ")";
  if (!accessor.is_known_type) return "the type or component type is unknown";
  for (const uint32_t number : accessor.views()) {
    const BufferView& view = document.views[number];
    if (!view.isCoded() || view.coding.decoded != kNone) continue;
    if (!view.fault.ok()) return "cannot be read (" + view.fault.message() + ")";
    return "is coded with " + view.coding.extension + ", which this program cannot read";
  }
  return "";
}

void readElements(const Accessor& accessor, const uint8_t* bytes, uint64_t stride_bytes,
                  AccessorData& elements) {
  const uint64_t stride = stride_bytes != 0 ? stride_bytes : accessor.elementBytes();
  elements = {};
  elements.count = accessor.count;
  elements.element_bytes = accessor.tightBytes();
  if (!canBeUsedInPlace(accessor, bytes, stride)) {
    return copyElements(accessor, bytes, stride, elements);
  }
  elements.data = bytes;
  elements.stride_bytes = stride;
}

Result readAccessor(const Document& document, uint32_t index, AccessorData& elements) {
  const Accessor& accessor = document.accessors[index];
  const std::string path = at("/accessors", index);
  elements = {};
  const std::string reason = whyUnreadable(document, accessor);
  if (!reason.empty()) return error(path, reason);
  elements.count = accessor.count;
  elements.element_bytes = accessor.tightBytes();
  elements.stride_bytes = elements.element_bytes;
  if (accessor.decoded != kNone) {
    elements.data = document.storage[accessor.decoded].data();
    return {};
  }
  const uint8_t* source = nullptr;
  uint64_t stride = 0;
  if (accessor.view != kNone) {
    stride = document.views[accessor.view].stride;
    source = viewBytes(document, accessor.view, accessor.offset);
    if (accessor.sparse.count == 0) {
      readElements(accessor, source, stride, elements);
      return {};
    }
  } else if (accessor.count * elements.element_bytes > maxZeroBytes(document)) {
    return error(path, "has no bufferView but claims ", accessor.count, " elements; at most ",
                 maxZeroBytes(document), " bytes of such elements are read");
  }
  copyElements(accessor, source, stride != 0 ? stride : accessor.elementBytes(), elements);
  if (accessor.sparse.count == 0) return {};
  return applySparse(document, accessor, path, elements.owned);
}

bool isOfIndices(const Accessor& accessor) {
  const ComponentType type = accessor.component_type;
  return accessor.is_known_type && accessor.componentCount() == 1 &&
         (type == ComponentType::kUint8 || type == ComponentType::kUint16 ||
          type == ComponentType::kUint32);
}

bool holdsIndices(ComponentType type, uint64_t vertex_count) {
  return type == ComponentType::kUint32 ||
         (type == ComponentType::kUint16 && vertex_count <= 0xffff) ||
         (type == ComponentType::kUint8 && vertex_count <= 0xff);
}

Result readIndices(const Document& document, uint32_t index, std::vector<uint32_t>& indices) {
  const Accessor& accessor = document.accessors[index];
  if (!isOfIndices(accessor)) {
    return error(at("/accessors", index), "indices must be SCALAR of an unsigned type, not ",
                 describeType(accessor));
  }
  AccessorData elements;
  MCC_GLTF_TRY(readAccessor(document, index, elements));
  indices.resize(elements.count);
  for (uint64_t i = 0; i < elements.count; ++i) {
    indices[i] = readLittleEndian(elements.element(i).data(), elements.element_bytes);
  }
  return {};
}

bool expandTriangles(uint64_t mode, std::vector<uint32_t>& vertices) {
  const size_t count = vertices.size();
  if (count < 3 || mode < 4 || mode > 6) return false;
  if (mode == 4) return count % 3 == 0;
  std::vector<uint32_t> triangles;
  triangles.reserve(3 * (count - 2));
  for (size_t i = 0; i + 2 < count; ++i) {
    if (mode == 5) {
      triangles.insert(triangles.end(),
                       {vertices[i], vertices[i + 1 + i % 2], vertices[i + 2 - i % 2]});
    } else {
      triangles.insert(triangles.end(), {vertices[i + 1], vertices[i + 2], vertices[0]});
    }
  }
  vertices = std::move(triangles);
  return true;
}

std::string describeType(const Accessor& accessor) {
  if (!accessor.is_known_type) return "an unknown type";
  std::string name = "SCALAR";
  if (accessor.columns > 1) {
    name = "MAT" + std::to_string(accessor.columns);
  } else if (accessor.rows > 1) {
    name = "VEC" + std::to_string(accessor.rows);
  }
  static constexpr const char* kNames[] = {
      "BYTE", "UNSIGNED_BYTE", "SHORT", "UNSIGNED_SHORT", "UNSIGNED_INT", "FLOAT", "INT"};
  return name + " of " + kNames[static_cast<size_t>(accessor.component_type)];
}

double componentValue(const uint8_t* bytes, ComponentType type) {
  const uint32_t raw = readLittleEndian(bytes, componentBytes(type));
  switch (type) {
    case ComponentType::kInt8: return static_cast<int8_t>(raw);
    case ComponentType::kInt16: return static_cast<int16_t>(raw);
    case ComponentType::kInt32: return static_cast<int32_t>(raw);
    case ComponentType::kFloat32: return std::bit_cast<float>(raw);
    default: return raw;
  }
}

void packElements(std::span<const uint8_t> tight, const Accessor& accessor, uint8_t* out) {
  const uint32_t stride = attributeStride(accessor);
  const uint32_t tight_bytes = accessor.tightBytes();
  const uint32_t tight_column = accessor.rows * componentBytes(accessor.component_type);
  for (uint64_t i = 0; i < accessor.count; ++i) {
    for (uint32_t column = 0; column < accessor.columns; ++column) {
      std::memcpy(out + i * stride + column * accessor.columnBytes(),
                  tight.data() + i * tight_bytes + column * tight_column, tight_column);
    }
  }
}

std::vector<uint8_t> packAttribute(std::span<const uint8_t> tight, const Accessor& accessor,
                                   uint32_t& stride_bytes) {
  const uint32_t stride = attributeStride(accessor);
  stride_bytes = stride == accessor.tightBytes() ? 0 : stride;
  std::vector<uint8_t> packed(accessor.count * stride);
  packElements(tight, accessor, packed.data());
  return packed;
}

void narrowIndices(std::span<const uint8_t> indices, uint32_t index_bytes, uint8_t* out) {
  for (size_t i = 0; i < indices.size(); i += 4, out += index_bytes) {
    std::memcpy(out, indices.data() + i, index_bytes);  // the host is little-endian
  }
}

std::vector<uint8_t> narrowIndices(std::span<const uint32_t> indices, uint32_t index_bytes) {
  std::vector<uint8_t> bytes(indices.size() * index_bytes);
  narrowIndices({reinterpret_cast<const uint8_t*>(indices.data()), indices.size_bytes()},
                index_bytes, bytes.data());
  return bytes;
}

AttributeFormat formatOf(const std::string& name, uint32_t target, const Accessor& accessor) {
  AttributeFormat type;
  // Payloads have no signed integers of 32 bits; their coding wraps around, so that bits suffice.
  const bool is_int32 = accessor.component_type == ComponentType::kInt32;
  type.component_type = is_int32 ? ComponentType::kUint32 : accessor.component_type;
  type.normalized = accessor.normalized;
  type.component_count = static_cast<uint8_t>(accessor.componentCount());
  type.morph_target = static_cast<uint16_t>(target == kNone ? 0 : target + 1);
  return namedFormat(name, type, accessor.columns != 1);
}

Json boundNumbers(const std::vector<double>& values, ComponentType type) {
  Json numbers = Json::array();
  for (const double value : values) {
    if (type == ComponentType::kFloat32) {
      numbers.push_back(Json::number(spellingOf(static_cast<float>(value))));
    } else {
      numbers.push_back(static_cast<int64_t>(value));
    }
  }
  return numbers;
}

void Bounds::add(const Bounds& other) {
  if (min.empty()) *this = other;
  for (size_t i = 0; i < min.size(); ++i) {
    min[i] = std::min(min[i], other.min[i]);
    max[i] = std::max(max[i], other.max[i]);
  }
}

double Bounds::longestSide() const {
  double longest = max[0] - min[0];
  for (size_t i = 1; i < min.size(); ++i) longest = std::max(longest, max[i] - min[i]);
  return longest;
}

Bounds boundsOf(const AccessorData& elements, ComponentType type) {
  const uint32_t bytes = componentBytes(type);
  const uint32_t component_count = elements.element_bytes / bytes;
  Bounds bounds;
  bounds.min.assign(component_count, std::numeric_limits<double>::infinity());
  bounds.max.assign(component_count, -std::numeric_limits<double>::infinity());
  for (uint64_t i = 0; i < elements.count; ++i) {
    const uint8_t* element = elements.data + i * elements.stride_bytes;
    for (uint32_t c = 0; c < component_count; ++c) {
      const double value = componentValue(element + c * bytes, type);
      if (value < bounds.min[c]) bounds.min[c] = value;
      if (value > bounds.max[c]) bounds.max[c] = value;
      if (!std::isfinite(value)) bounds.is_finite = false;
    }
  }
  return bounds;
}

Bounds boundsOf(std::span<const uint8_t> tight, ComponentType type, uint32_t component_count) {
  return boundsOf(AccessorData::packed(tight, component_count * componentBytes(type)), type);
}

Bounds boundsOf(std::span<const uint32_t> indices) {
  const auto [low, high] = std::minmax_element(indices.begin(), indices.end());
  return {{static_cast<double>(*low)}, {static_cast<double>(*high)}};
}

void setBounds(const Bounds& bounds, ComponentType type, bool is_required, Json& accessor) {
  if (!bounds.is_finite) return;
  if (is_required || accessor.contains("min")) accessor["min"] = boundNumbers(bounds.min, type);
  if (is_required || accessor.contains("max")) accessor["max"] = boundNumbers(bounds.max, type);
}

Result checkBound(const Json& accessor, const char* key, const std::vector<double>& decoded,
                  ComponentType type, const std::string& path) {
  const Json* const declared = findMember(accessor, key);
  if (declared == nullptr) return {};
  const std::string where = at(path, key);
  if (!declared->is_array() || declared->size() != decoded.size()) {
    return error(where, "must be an array of ", decoded.size(), " numbers");
  }
  for (size_t i = 0; i < decoded.size(); ++i) {
    double value = 0;
    if (!std::isfinite(decoded[i])) continue;
    if (!asNumber((*declared)[i], value)) return error(where, "must be an array of numbers");
    if (type == ComponentType::kFloat32) value = static_cast<float>(value);
    if (value == decoded[i]) continue;
    return error(where, "component ", i, " is ", printJson((*declared)[i]), ", but ",
                 printJson(Json(decoded[i])), " for the decoded elements");
  }
  return {};
}

}  // namespace mcc::gltf
