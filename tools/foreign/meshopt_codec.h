// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// meshoptimizer's codec and zstd with plain structs: what `gltfpack -c` or `-cc` makes of a
// primitive at our quantisation.
#ifndef MCC_TOOLS_FOREIGN_MESHOPT_CODEC_H_
#define MCC_TOOLS_FOREIGN_MESHOPT_CODEC_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "foreign/foreign_mesh.h"
#include "mcc/types.h"
#include "mcc/writer.h"

namespace mcc::foreign {

struct MeshoptOptions {
  /// Floats as they are, quantization_bits ignored.
  bool is_lossless = false;
  /// As `gltfpack -cc`: octahedral filter for normals and tangents, triangles ordered for the strip
  /// cache.
  bool use_filters = false;
  int zstd_level = 19;
};

/// How an attribute is stored in its stream.
enum class MeshoptStorage : uint8_t {
  kRaw,         ///< the accessor's own values, elements padded to 4 bytes
  kLattice,     ///< unsigned lattice indices of 1, 2 or 4 bytes
  kSigned,      ///< normals and tangents: signed fractions of `bits` bits in 1 or 2 bytes
  kOctahedral,  ///< the same after meshoptimizer's octahedral filter
};

/// Description of a stream; in a file it is the JSON's part, so it counts no bytes.
struct MeshoptStream {
  uint32_t piece_attribute = 0;
  MeshoptStorage storage = MeshoptStorage::kRaw;
  ComponentType component_type = ComponentType::kFloat32;  ///< of the source
  uint8_t component_count = 0;
  uint8_t component_bytes = 0;  ///< as stored
  uint8_t bits = 0;
  uint32_t stride_bytes = 0;  ///< as stored
  Lattice lattice;            ///< of kLattice
  size_t bytes = 0;           ///< of the coded stream
};

struct MeshoptEncoded {
  std::vector<uint8_t> bytes;       ///< index stream, then the attribute streams
  std::vector<uint8_t> zstd_bytes;  ///< one zstd frame of `bytes`
  size_t index_bytes = 0;
  std::vector<MeshoptStream> streams;
  uint32_t vertex_count = 0;
  uint32_t triangle_count = 0;
  /// Per wedge of the source its decoded vertex; kNone: dropped.
  std::vector<uint32_t> wedge_vertex;
  double encode_ms = 0;  ///< all but zstd
  double zstd_ms = 0;
};

/// Encodes one part of a piece: quantise, merge vertices with equal stored values, drop triangles
/// that use a vertex twice and unused vertices, optimise the vertex cache and fetch orders, code,
/// compress. Float attributes with quantization_bits > 0 go on our lattice, NORMAL and TANGENT of
/// the base mesh to signed fractions of that many bits (at most 16) per component; all else is
/// stored exactly. Fails on a part without triangles, an index beyond the wedges, elements above
/// 256 bytes. Deterministic. Inverse: decodeMeshopt(). Tests: tests/foreign/draco_codec_test.cpp.
Outcome encodeMeshopt(const PieceView& piece, size_t part, const MeshoptOptions& options,
                      MeshoptEncoded& encoded);

/// Decodes to final arrays: floats where the source had floats, uint32 indices.
/// layout  the description; its `bytes` and `zstd_bytes` are not read.
/// bytes   MeshoptEncoded::bytes.
Outcome decodeMeshopt(const MeshoptEncoded& layout, std::span<const uint8_t> bytes,
                      DecodedMesh& mesh);
/// The same from MeshoptEncoded::zstd_bytes.
Outcome decodeMeshoptZstd(const MeshoptEncoded& layout, std::span<const uint8_t> zstd_bytes,
                          DecodedMesh& mesh);

/// Decodes a buffer view of EXT_meshopt_compression, or of KHR_meshopt_compression as far as this
/// version of meshoptimizer can: `count` elements of `stride` bytes. Safe for untrusted input; the
/// caller bounds the product.
Outcome decodeMeshoptView(std::span<const uint8_t> bytes, uint64_t count, uint32_t stride,
                          const std::string& mode, const std::string& filter,
                          std::vector<uint8_t>& elements);

/// Encodes `count` elements of `stride` bytes as EXT_meshopt_compression stores them in a buffer
/// view, without a filter. The mode is ATTRIBUTES (a stride of up to 256 bytes, a multiple of 4),
/// TRIANGLES (of 2 or 4; may rotate triangles) or INDICES (of 2 or 4). Fails on anything else.
/// Deterministic. Inverse: decodeMeshoptView().
Outcome encodeMeshoptView(std::span<const uint8_t> elements, uint64_t count, uint32_t stride,
                          const std::string& mode, std::vector<uint8_t>& bytes);

/// Errors per stream of `layout`, from a decode of it, over all wedges that were not dropped.
Outcome measureMeshoptErrors(const PieceView& piece, const MeshoptEncoded& layout,
                             const DecodedMesh& decoded, std::vector<AttributeError>& errors);

/// Average vertex cache misses per triangle of an index list, FIFO cache; 0 for an empty list.
double averageCacheMissRatio(std::span<const uint32_t> indices, uint32_t vertex_count,
                             uint32_t cache_size = 16);

std::string meshoptVersion();  ///< "0.18"
std::string zstdVersion();     ///< "1.5.4"

}  // namespace mcc::foreign

#endif  // MCC_TOOLS_FOREIGN_MESHOPT_CODEC_H_
