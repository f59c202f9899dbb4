// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes a payload into named arrays, and encodes a mesh, in one call each:
//
//   mcc::Mesh mesh;
//   if (const mcc::Status status = mcc::decodeMesh(bytes, mesh); !status.ok()) return status.what;
//   const mcc::MeshAttribute* normals = mesh.find("NORMAL");
//
// Threads, blocks, memory of your own, kept orders and lattices: reader.h and writer.h. These
// functions are made of those, and need gltf-mcc::reader, and gltf-mcc::writer to encode. They may
// throw std::bad_alloc.
#ifndef MCC_SIMPLE_H_
#define MCC_SIMPLE_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mcc/reader.h"
#if __has_include("mcc/writer.h")
#include "mcc/writer.h"
#endif

namespace mcc {

/// An attribute of the vertices of a mesh.
struct MeshAttribute {
  std::string name;       ///< "POSITION", "TEXCOORD_1"; "_" when only the glTF file has its name
  int morph_target = -1;  ///< number of the morph target that it is a delta of; -1: the base mesh
  ComponentType component_type = ComponentType::kFloat32;
  uint32_t component_count = 3;
  bool normalized = false;    ///< integers stand for 0 to 1, or -1 to 1
  std::vector<uint8_t> data;  ///< the components of one vertex after the other, without gaps
};

/// Vertices and the triangles of the primitives that use them.
struct Mesh {
  uint32_t vertex_count = 0;
  std::vector<MeshAttribute> attributes;          ///< numbered as in the glTF file; POSITION first
  std::vector<std::vector<uint32_t>> primitives;  ///< numbers of vertices, three per triangle

  /// Returns an attribute, or null.
  const MeshAttribute* find(std::string_view name, int morph_target = -1) const;
};

/// Decodes one piece of a payload: the bytes of the buffer view that
/// KHR_mesh_collapse_compression names, and its `piece`. The extension's `part` is the number of
/// the primitive. On an error `mesh` is unspecified; the errors are those of Payload::open() and
/// Payload::decode(), and kBadArgument when there is no such piece. Safe for untrusted bytes, and
/// from several threads. Time and memory are linear in what is decoded, which `limits` bounds.
/// Tests: tests/roundtrip/simple_test.cpp.
inline Status decodeMesh(std::span<const uint8_t> payload, Mesh& mesh, size_t piece = 0,
                         const Limits& limits = {});

/// Bits of each component of float attributes; 0 keeps every bit. Other types stay exact.
struct MeshBits {
  uint8_t position = 14;  ///< 1 to 24, over the longest side of the mesh; also those below
  uint8_t normal = 10;    ///< 2 to 16
  uint8_t texcoord = 12;
  uint8_t color = 8;
  uint8_t tangent = 12;  ///< 2 to 16
  uint8_t weight = 12;
};

#if __has_include("mcc/writer.h")
/// Encodes a mesh. Its vertices and triangles get another order in the payload, in which
/// decodeMesh() returns them: `source_vertices`, if not null, says which vertex each of them was.
/// Attributes are sorted as payloads have them. Errors: those of encode(), and kBadArgument when an
/// attribute has another size than its vertices need. Deterministic. Inverse: decodeMesh().
inline Status encodeMesh(const Mesh& mesh, std::vector<uint8_t>& payload, const MeshBits& bits = {},
                         std::vector<uint32_t>* source_vertices = nullptr);
#endif

// ------------------------------------------------------------------- Implementation

namespace simple {

inline std::string nameOf(const AttributeFormat& format) {
  static constexpr const char* kNames[] = {"POSITION", "NORMAL",  "TANGENT",  "TEXCOORD_",
                                           "COLOR_",   "JOINTS_", "WEIGHTS_", "_"};
  std::string name = kNames[static_cast<size_t>(format.semantic)];
  const bool has_number =
      format.semantic >= Semantic::kTexcoord && format.semantic != Semantic::kCustom;
  return has_number ? name + std::to_string(unsigned{format.set_index}) : name;
}

inline AttributeFormat formatOf(const MeshAttribute& attribute) {
  AttributeFormat type;
  type.component_type = attribute.component_type;
  type.normalized = attribute.normalized;
  type.component_count = static_cast<uint8_t>(attribute.component_count);
  type.morph_target = static_cast<uint16_t>(attribute.morph_target + 1);
  return namedFormat(attribute.name, type, attribute.component_count > 4);
}

inline uint8_t bitsOf(const AttributeFormat& format, const MeshBits& bits) {
  switch (format.semantic) {
    case Semantic::kPosition: return bits.position;
    case Semantic::kNormal: return bits.normal;
    case Semantic::kTangent: return bits.tangent;
    case Semantic::kTexcoord: return bits.texcoord;
    case Semantic::kColor: return bits.color;
    case Semantic::kWeights: return bits.weight;
    default: return 0;
  }
}

/// Makes room for a piece, and says where its attributes and triangles go.
inline void takeRoom(const PieceInfo& info, Mesh& mesh, std::vector<AttributeTarget>& attributes,
                     std::vector<PartTarget>& parts) {
  mesh.vertex_count = info.wedge_count;
  for (const AttributeInfo& coded : info.attributes) {
    const AttributeFormat& format = coded.format;
    MeshAttribute& attribute = mesh.attributes.emplace_back();
    attribute.name = nameOf(format);
    attribute.morph_target = int{format.morph_target} - 1;
    attribute.component_type = format.component_type;
    attribute.component_count = format.component_count;
    attribute.normalized = format.normalized;
    attribute.data.resize(size_t{info.wedge_count} * elementBytes(format));
    attributes.push_back({attribute.data.data(), elementBytes(format)});
  }
  for (const PartInfo& part : info.parts) {
    mesh.primitives.emplace_back(size_t{3} * part.triangle_count);
    parts.push_back({mesh.primitives.back().data(), IndexType::kUint32});
  }
}

}  // namespace simple

inline const MeshAttribute* Mesh::find(std::string_view name, int morph_target) const {
  for (const MeshAttribute& attribute : attributes) {
    if (attribute.name == name && attribute.morph_target == morph_target) return &attribute;
  }
  return nullptr;
}

inline Status decodeMesh(std::span<const uint8_t> payload, Mesh& mesh, size_t piece,
                         const Limits& limits) {
  Payload opened;
  mesh = {};
  if (const Status status = opened.open(payload, limits); !status.ok()) return status;
  const std::span<const PieceInfo> infos = opened.info().pieces;
  if (piece >= infos.size()) return fail(Error::kBadArgument, "the payload has no such piece");
  std::vector<AttributeTarget> attributes;
  std::vector<PartTarget> parts;
  simple::takeRoom(infos[piece], mesh, attributes, parts);
  size_t most_attributes = 0;
  size_t most_parts = 0;
  for (const PieceInfo& info : infos) {
    most_attributes = std::max(most_attributes, info.attributes.size());
    most_parts = std::max(most_parts, info.parts.size());
  }
  // Other pieces are decoded, because pieces share what they have learnt, and dropped.
  const std::vector<AttributeTarget> no_attributes(most_attributes);
  const std::vector<PartTarget> no_parts(most_parts);
  std::vector<PieceTarget> targets;
  for (const PieceInfo& info : infos) {
    targets.push_back({std::span(no_attributes).first(info.attributes.size()),
                       std::span(no_parts).first(info.parts.size())});
  }
  targets[piece] = {attributes, parts};
  return opened.decode(targets);
}

#if __has_include("mcc/writer.h")
inline Status encodeMesh(const Mesh& mesh, std::vector<uint8_t>& payload, const MeshBits& bits,
                         std::vector<uint32_t>* source_vertices) {
  std::vector<AttributeView> attributes;
  for (const MeshAttribute& attribute : mesh.attributes) {
    AttributeView view;
    view.format = simple::formatOf(attribute);
    if (!isComponentCount(attribute.component_count) || attribute.morph_target < -1 ||
        attribute.morph_target > 65533 ||
        attribute.data.size() != uint64_t{mesh.vertex_count} * elementBytes(view.format)) {
      return fail(Error::kBadArgument, "an attribute has another size than its vertices need");
    }
    view.data = attribute.data.data();
    view.stride_bytes = elementBytes(view.format);
    view.quantization_bits = simple::bitsOf(view.format, bits);
    attributes.push_back(view);
  }
  std::stable_sort(attributes.begin(), attributes.end(),
                   [](const AttributeView& a, const AttributeView& b) {
                     const auto key = [](const AttributeFormat& f) {
                       return uint32_t{f.morph_target} << 16 |
                              static_cast<uint32_t>(f.semantic) << 8 | f.set_index;
                     };
                     return key(a.format) < key(b.format);
                   });
  std::vector<PartView> parts;
  for (const std::vector<uint32_t>& indices : mesh.primitives) parts.push_back({indices});
  const PieceView piece = {mesh.vertex_count, attributes, parts};
  EncodeResult result;
  const Status status = encode({&piece, 1}, {}, result);
  if (!status.ok()) return status;
  payload = std::move(result.payload);
  if (source_vertices != nullptr) *source_vertices = std::move(result.pieces[0].source_wedge);
  return {};
}
#endif

}  // namespace mcc

#endif  // MCC_SIMPLE_H_
