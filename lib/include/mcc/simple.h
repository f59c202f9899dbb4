// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The short way: a payload of KHR_mesh_collapse_compression becomes arrays in one call, and arrays
// a payload in another. For memory of the caller's, blocks while they load, progress or threads see
// reader.h and writer.h; for whole glTF files, glb.h and files.h. Header-only: decode() needs
// gltf-mcc::reader, encode() gltf-mcc::writer.
#ifndef MCC_SIMPLE_H_
#define MCC_SIMPLE_H_

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mcc/meshlets.h"  // Meshlet, MeshletOptions
#include "mcc/status.h"    // error, what, offset_bytes, ok()
#include "mcc/types.h"     // ComponentType: kInt8, kUint8, kInt16, kUint16, kUint32, kFloat32

namespace mcc::simple {

/// What Attribute::target is for the mesh itself.
inline constexpr int kBase = -1;

/// A vertex attribute: an element for each vertex, tightly packed, in the host's byte order.
struct Attribute {
  /// As in glTF: "POSITION", "NORMAL", "TANGENT", "TEXCOORD_n", "COLOR_n", "JOINTS_n", "WEIGHTS_n".
  /// The payload does not hold other names: such attributes come back as "_", in their order.
  std::string name;
  int target = kBase;  ///< or the index of a morph target, from 0: then these are its deltas
  ComponentType type = ComponentType::kFloat32;
  uint8_t component_count = 3;  ///< 1 to 4; 9 and 16 for matrices
  bool normalized = false;
  std::vector<uint8_t> bytes;

  /// The numbers of a kFloat32 attribute, as long as `bytes` stays; empty for other types.
  std::span<const float> floats() const;
};

/// Vertices, and the triangle lists on them. Owns all its arrays.
struct Mesh {
  uint32_t vertex_count = 0;
  std::vector<Attribute> attributes;
  /// One list for each primitive of glTF with these vertices; three vertices for each triangle.
  std::vector<std::vector<uint32_t>> primitives;

  /// Returns an attribute, or null if there is none. Borrowed.
  const Attribute* find(std::string_view name, int target = kBase) const;
  /// Adds a copy of floats, and sets vertex_count if it is 0.
  void add(std::string name, std::span<const float> values, uint8_t component_count = 3,
           int target = kBase);
};

/// Clusters of the triangles of a primitive for mesh shaders, in the layout of meshoptimizer. Owns
/// its arrays.
struct Meshlets {
  std::vector<Meshlet> meshlets;   ///< where each begins in the arrays, and how long it is
  std::vector<uint32_t> vertices;  ///< of the mesh
  std::vector<uint8_t> triangles;  ///< three for each triangle: vertices of the meshlet
};

/// What encode() keeps. Bits are those of each component of float attributes, and 0 keeps every
/// bit; other types and other attributes are exact. See QuantizationBits in glb.h.
struct EncodeOptions {
  uint8_t position_bits = 14;  ///< 0..24, on the longest side of the box; deltas have its step
  uint8_t normal_bits = 10;    ///< 0, 2..16, octahedral
  uint8_t texcoord_bits = 12;  ///< 0..24
  uint8_t color_bits = 8;      ///< 0..24
  uint8_t tangent_bits = 12;   ///< 0, 2..16
  uint8_t weight_bits = 12;    ///< 0..24
  /// Vertices, and triangles with their first corners, come back in their order. That costs bytes.
  bool keep_vertex_order = false;
  bool keep_triangle_order = false;
};

/// Decodes a payload, which is the whole content of a buffer view. The extension object's `piece`
/// and `part` are the numbers of a mesh and of a primitive in it; without them both are 0.
/// max_decoded_bytes  what all arrays may take; 0: 1024 for each byte of the payload, but at least
///                    256 MiB and at most 4 GiB
/// Returns what is wrong with the payload, and kLimit where it asks for more; `meshes` is then
/// empty. Throws std::bad_alloc only. Safe for untrusted input: all counts are checked before
/// memory is taken. Deterministic. Inverse: encode(). Tests: tests/roundtrip/simple_test.cpp.
Status decode(std::span<const uint8_t> payload, std::vector<Mesh>& meshes,
              uint64_t max_decoded_bytes = 0);

/// Divides a primitive into meshlets, see mcc/meshlets.h. Call it with those of decode(), whose
/// order of triangles is a good one for that.
/// primitive  triangles of a mesh with so many vertices
/// Returns kBadArgument (a number of indices that is no multiple of 3, an index that is no vertex,
/// options out of range), kLimit (more than 2^28 triangles), kOutOfMemory; `meshlets` is then
/// empty. Throws std::bad_alloc only. Deterministic. Tests: tests/roundtrip/simple_test.cpp.
Status buildMeshlets(std::span<const uint32_t> primitive, uint32_t vertex_count, Meshlets& meshlets,
                     const MeshletOptions& options = {});

/// Encodes a mesh. It comes back as meshes[0], with vertices and triangles in another order.
/// Returns kBadArgument (no POSITION, no primitive, an index that is no vertex, indices that are no
/// triangles, an attribute of another size, a target below kBase or above 65534, bits out of
/// range), kLimit (2^28 vertices or triangles), kOutOfMemory; `payload` is then empty.
/// Deterministic. Inverse: decode(). Tests: tests/roundtrip/simple_test.cpp.
Status encode(const Mesh& mesh, std::vector<uint8_t>& payload, const EncodeOptions& options = {});

}  // namespace mcc::simple

#include "mcc/simple_inline.h"

#endif  // MCC_SIMPLE_H_
