// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The functions of simple.h. Where only the reader is installed, encode() has no definition.
#ifndef MCC_SIMPLE_INLINE_H_
#define MCC_SIMPLE_INLINE_H_

#include <cstring>
#include <memory>
#include <utility>

#include "mcc/decoded_limit.h"
#include "mcc/reader.h"
#include "mcc/simple.h"
#if __has_include("mcc/writer.h")
#include "mcc/writer.h"
#endif

namespace mcc::simple {

inline std::span<const float> Attribute::floats() const {
  // Memory of a vector is aligned for every fundamental type.
  if (type != ComponentType::kFloat32) return {};
  return {reinterpret_cast<const float*>(bytes.data()), bytes.size() / sizeof(float)};
}

inline const Attribute* Mesh::find(std::string_view name, int target) const {
  for (const Attribute& attribute : attributes) {
    if (attribute.name == name && attribute.target == target) return &attribute;
  }
  return nullptr;
}

inline void Mesh::add(std::string name, std::span<const float> values, uint8_t component_count,
                      int target) {
  Attribute attribute;
  attribute.name = std::move(name);
  attribute.target = target;
  attribute.component_count = component_count;
  attribute.bytes.resize(values.size_bytes());
  if (!values.empty()) std::memcpy(attribute.bytes.data(), values.data(), values.size_bytes());
  if (vertex_count == 0 && component_count != 0) {
    vertex_count = static_cast<uint32_t>(values.size() / component_count);
  }
  attributes.push_back(std::move(attribute));
}

namespace detail {

inline std::string nameOf(const AttributeFormat& format) {
  const std::string set = std::to_string(format.set_index);
  switch (format.semantic) {
    case Semantic::kPosition: return "POSITION";
    case Semantic::kNormal: return "NORMAL";
    case Semantic::kTangent: return "TANGENT";
    case Semantic::kTexcoord: return "TEXCOORD_" + set;
    case Semantic::kColor: return "COLOR_" + set;
    case Semantic::kJoints: return "JOINTS_" + set;
    case Semantic::kWeights: return "WEIGHTS_" + set;
    case Semantic::kCustom: break;
  }
  return "_";
}

/// Gives a mesh the shape of a piece.
inline Mesh meshOf(const PieceInfo& piece) {
  Mesh mesh;
  mesh.vertex_count = piece.wedge_count;
  for (const AttributeInfo& info : piece.attributes) {
    const AttributeFormat& format = info.format;
    mesh.attributes.push_back(
        {nameOf(format), int{format.morph_target} - 1, format.component_type,
         format.component_count, format.normalized,
         std::vector<uint8_t>(size_t{piece.wedge_count} * elementBytes(format))});
  }
  for (const PartInfo& part : piece.parts) {
    mesh.primitives.emplace_back(size_t{3} * part.triangle_count);
  }
  return mesh;
}

/// The arrays of meshes as targets, which point into these.
struct Targets {
  explicit Targets(std::vector<Mesh>& meshes) : attributes(meshes.size()), parts(meshes.size()) {
    for (size_t i = 0; i < meshes.size(); ++i) {
      for (Attribute& attribute : meshes[i].attributes) {
        const size_t stride = size_t{componentBytes(attribute.type)} * attribute.component_count;
        attributes[i].push_back({attribute.bytes.data(), stride});
      }
      for (std::vector<uint32_t>& indices : meshes[i].primitives) {
        parts[i].push_back({indices.data(), IndexType::kUint32});
      }
      pieces.push_back({attributes[i], parts[i]});
    }
  }

  std::vector<std::vector<AttributeTarget>> attributes;
  std::vector<std::vector<PartTarget>> parts;
  std::vector<PieceTarget> pieces;
};

}  // namespace detail

inline Status decode(std::span<const uint8_t> payload, std::vector<Mesh>& meshes,
                     uint64_t max_decoded_bytes) {
  meshes.clear();
  Limits limits;
  limits.max_output_bytes = decodedLimit(max_decoded_bytes, payload.size());
  Payload opened;
  Status status = opened.open(payload, limits);
  if (!status.ok()) return status;
  for (const PieceInfo& piece : opened.info().pieces) meshes.push_back(detail::meshOf(piece));
  const detail::Targets targets(meshes);
  status = opened.decode(targets.pieces);
  if (!status.ok()) meshes.clear();
  return status;
}

inline Status buildMeshlets(std::span<const uint32_t> primitive, uint32_t vertex_count,
                            Meshlets& meshlets, const MeshletOptions& options) {
  meshlets = {};
  if (primitive.size() % 3 != 0)
    return fail(Error::kBadArgument, "the number of indices is no multiple of 3");
  if (primitive.size() / 3 > UINT32_MAX) return fail(Error::kLimit, "more than 2^28 triangles");
  const auto triangle_count = static_cast<uint32_t>(primitive.size() / 3);
  MeshletSizes sizes = meshletBound(triangle_count, options);
  meshlets.meshlets.resize(sizes.meshlet_count);
  meshlets.triangles.resize(sizes.triangle_bytes);
  // The bound is three to four times what most meshes need, so nothing is stored beyond that.
  const std::unique_ptr<uint32_t[]> vertices(new uint32_t[sizes.vertex_count]);
  const Status status = mcc::buildMeshlets(
      {primitive.data(), IndexType::kUint32, triangle_count, vertex_count},
      {meshlets.meshlets, {vertices.get(), sizes.vertex_count}, meshlets.triangles}, sizes,
      options);
  if (!status.ok()) {
    meshlets = {};
    return status;
  }
  meshlets.meshlets.resize(sizes.meshlet_count);
  meshlets.vertices.assign(vertices.get(), vertices.get() + sizes.vertex_count);
  meshlets.triangles.resize(sizes.triangle_bytes);
  return status;
}

#if __has_include("mcc/writer.h")
namespace detail {

inline uint8_t bitsOf(Semantic semantic, const EncodeOptions& options) {
  switch (semantic) {
    case Semantic::kPosition: return options.position_bits;
    case Semantic::kNormal: return options.normal_bits;
    case Semantic::kTangent: return options.tangent_bits;
    case Semantic::kTexcoord: return options.texcoord_bits;
    case Semantic::kColor: return options.color_bits;
    case Semantic::kWeights: return options.weight_bits;
    case Semantic::kJoints:
    case Semantic::kCustom: break;
  }
  return 0;
}

/// Describes an attribute. Errors: it has another size than its vertices, or no possible type.
inline Status viewOf(const Attribute& attribute, uint32_t vertex_count,
                     const EncodeOptions& options, AttributeView& view) {
  if (attribute.target < kBase || attribute.target > 0xfffe)
    return fail(Error::kBadArgument, "target is neither kBase nor a possible morph target");
  AttributeFormat type;
  type.component_type = attribute.type;
  type.normalized = attribute.normalized;
  type.component_count = attribute.component_count;
  type.morph_target = static_cast<uint16_t>(attribute.target + 1);
  view.stride_bytes = elementBytes(type);
  if (!isComponentCount(type.component_count) || view.stride_bytes == 0)
    return fail(Error::kBadArgument, "an attribute has an impossible type");
  if (attribute.bytes.size() != uint64_t{vertex_count} * view.stride_bytes)
    return fail(Error::kBadArgument, "an attribute has not one element for each vertex");
  view.format = namedFormat(attribute.name, type, attribute.component_count > 4);
  view.data = attribute.bytes.data();
  if (attribute.type == ComponentType::kFloat32)
    view.quantization_bits = bitsOf(view.format.semantic, options);
  return {};
}

/// Returns whether an attribute has to be the first of its piece.
inline bool isBasePosition(const AttributeFormat& format) {
  return format.semantic == Semantic::kPosition && format.morph_target == 0;
}

}  // namespace detail

inline Status encode(const Mesh& mesh, std::vector<uint8_t>& payload,
                     const EncodeOptions& options) {
  payload.clear();
  std::vector<AttributeView> attributes;
  for (const Attribute& attribute : mesh.attributes) {
    AttributeView view;
    const Status status = detail::viewOf(attribute, mesh.vertex_count, options, view);
    if (!status.ok()) return status;
    const bool is_first = detail::isBasePosition(view.format);
    attributes.insert(is_first ? attributes.begin() : attributes.end(), view);
  }
  std::vector<PartView> parts;
  for (const std::vector<uint32_t>& indices : mesh.primitives) parts.push_back({indices});
  const PieceView piece = {mesh.vertex_count, attributes, parts};
  mcc::EncodeOptions of_writer;
  of_writer.keep_vertex_order = options.keep_vertex_order;
  of_writer.keep_triangle_order = options.keep_triangle_order;
  EncodeResult result;
  const Status status = mcc::encode({&piece, 1}, of_writer, result);
  if (status.ok()) payload = std::move(result.payload);
  return status;
}
#endif

}  // namespace mcc::simple

#endif  // MCC_SIMPLE_INLINE_H_
