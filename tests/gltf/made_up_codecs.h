// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Made-up codecs that stand for others: views have their bits inverted, and meshes are lists of
// their arrays.
#ifndef MCC_TESTS_GLTF_MADE_UP_CODECS_H_
#define MCC_TESTS_GLTF_MADE_UP_CODECS_H_

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "gltf/round_trip.h"

namespace mcc::gltf::test {

inline constexpr char kViewName[] = "EXT_meshopt_compression";
inline constexpr char kMeshName[] = "KHR_draco_mesh_compression";

inline std::vector<uint8_t> inverted(std::span<const uint8_t> bytes) {
  std::vector<uint8_t> result(bytes.begin(), bytes.end());
  for (uint8_t& byte : result) byte ^= 0xff;
  return result;
}

inline ForeignDecoders madeUpDecoders() {
  ForeignDecoders decoders;
  decoders.view = [](const CodedView& view, std::vector<uint8_t>& elements) -> Result {
    if (view.filter != "NONE") return {"", "has an unknown filter"};
    elements = inverted(view.bytes);
    return {};
  };
  decoders.mesh = [](const CodedMesh& coded, DecodedMesh& mesh) -> Result {
    size_t at = 0;
    const auto take = [&](size_t bytes) {
      const auto part = coded.bytes.subspan(at, std::min(bytes, coded.bytes.size() - at));
      at += part.size();
      return std::vector<uint8_t>(part.begin(), part.end());
    };
    if (coded.bytes.size() < 12 * coded.triangle_count) return {"", "is damaged"};
    const std::vector<uint8_t> indices = take(12 * coded.triangle_count);
    mesh.indices.resize(3 * coded.triangle_count);
    std::memcpy(mesh.indices.data(), indices.data(), indices.size());
    for (const CodedMesh::Attribute& attribute : coded.attributes) {
      mesh.attributes.push_back(take(coded.vertex_count * componentBytes(attribute.component_type) *
                                     attribute.component_count));
    }
    return {};
  };
  return decoders;
}

inline ConvertOptions withDecoders() {
  ConvertOptions options;
  options.decoders = madeUpDecoders();
  return options;
}

/// Turns the views of a document into coded ones, which claim to be in the second buffer.
inline void codeViews(Builder& builder, const std::vector<uint32_t>& views) {
  uint64_t placeholder_bytes = 0;
  for (const uint32_t number : views) {
    Json& view = builder.json["bufferViews"][number];
    const size_t offset = view["byteOffset"];
    const size_t length = view["byteLength"];
    const auto begin = builder.bin.begin() + static_cast<ptrdiff_t>(offset);
    const std::vector<uint8_t> coded = inverted({begin, begin + static_cast<ptrdiff_t>(length)});
    std::copy(coded.begin(), coded.end(), begin);
    view["extensions"][kViewName] = {{"buffer", 0},          {"byteOffset", offset},
                                     {"byteLength", length}, {"byteStride", 2},
                                     {"count", length / 2},  {"mode", "ATTRIBUTES"}};
    view["buffer"] = 1;
    view["byteOffset"] = placeholder_bytes;
    placeholder_bytes += length;
  }
  builder.json["buffers"] = {
      {{"byteLength", builder.bin.size()}},
      {{"byteLength", placeholder_bytes}, {"extensions", {{kViewName, {{"fallback", true}}}}}}};
  builder.json["extensionsUsed"] = {kViewName};
  builder.json["extensionsRequired"] = {kViewName};
}

/// Moves the primitive's attributes and indices into one coded view.
inline void codeMesh(Builder& builder, size_t mesh, bool keep_bytes = false) {
  Json& primitive = builder.json["meshes"][mesh]["primitives"][0];
  const std::vector<uint8_t> file = builder.toGlb();
  std::vector<uint8_t> coded;
  for (const std::string& index : elementsInOrder(file, primitive["indices"])) {
    coded.insert(coded.end(),
                 {static_cast<uint8_t>(index[0]), static_cast<uint8_t>(index[1]), 0, 0});
  }
  Json ids = Json::object();
  for (const auto& [name, accessor] : primitive["attributes"].items()) {
    for (const std::string& element : elementsInOrder(file, accessor)) {
      coded.insert(coded.end(), element.begin(), element.end());
    }
    ids[name] = 7 * ids.size();
    if (!keep_bytes) builder.json["accessors"][accessor.get<size_t>()].erase("bufferView");
  }
  if (!keep_bytes)
    builder.json["accessors"][primitive["indices"].get<size_t>()].erase("bufferView");
  const uint32_t view = builder.addView(coded);
  primitive["extensions"][kMeshName] = {{"bufferView", view}, {"attributes", ids}};
  builder.json["extensionsUsed"] = {kMeshName};
  builder.json["extensionsRequired"] = {kMeshName};
}

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_GLTF_MADE_UP_CODECS_H_
