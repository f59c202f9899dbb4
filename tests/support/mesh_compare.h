// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exact comparison of a source mesh with what came back, and the round trip that feeds it. Uses the
// public headers, and the settings that only tests have. Every function that returns a string
// returns "" for success, else what is wrong.
#ifndef MCC_TESTS_SUPPORT_MESH_COMPARE_H_
#define MCC_TESTS_SUPPORT_MESH_COMPARE_H_

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "mcc/reader.h"
#include "mcc/types.h"
#include "mcc/writer.h"
#include "support/mesh_generators.h"
#include "writer/settings.h"

namespace mcc::test {

struct DecodedAttribute {
  AttributeInfo info;
  std::vector<uint8_t> bytes;  ///< tight elements, one per wedge
};

struct DecodedPiece {
  uint32_t wedge_count = 0;
  uint32_t vertex_count = 0;
  std::vector<DecodedAttribute> attributes;
  std::vector<std::vector<uint32_t>> parts;  ///< 3 indices per triangle
};

/// Whether source_wedge[i] for all decoded wedges i names each of `wedge_count` source wedges once.
std::string compareWedges(uint32_t wedge_count, std::span<const uint32_t> source_wedge);

/// Whether the triangles, taken through source_wedge, are those of the source: as a multiset, each
/// with its orientation, up to which corner comes first.
std::string compareTriangles(std::span<const uint32_t> source, std::span<const uint32_t> decoded,
                             std::span<const uint32_t> source_wedge);

/// Whether attribute `which` of a piece holds, wedge for wedge,
///   integers, exact floats  the source's bits;
///   lattices                fl(fl(q * step) + origin) with q = floor((x - origin) / step + .5);
///                           weights within one step of the source;
///   octahedral normals      a unit vector within half a cell of the grid;
///   tangents                a direction within half a step of the angle, the same sign;
/// and whether a lattice is as fine as was asked for.
std::string compareAttribute(const PieceView& source, const DecodedPiece& decoded, size_t which,
                             std::span<const uint32_t> source_wedge);

/// All of the above for one piece.
std::string comparePiece(const PieceView& source, const DecodedPiece& decoded,
                         std::span<const uint32_t> source_wedge);

/// Whether the orders that the options keep are the source's.
std::string compareOrder(const PieceView& source, const DecodedPiece& decoded,
                         std::span<const uint32_t> source_wedge, const EncodeOptions& options);

/// Memory the decoder is given.
struct TargetLayout {
  uint32_t padding_bytes = 0;  ///< between the elements of attributes; must stay untouched
  IndexType index_type = IndexType::kUint32;
};

/// Opens and decodes a payload.
std::string decodePayload(std::span<const uint8_t> payload, const TargetLayout& layout,
                          std::vector<DecodedPiece>& pieces, CodeHistogram* histogram = nullptr);

struct RoundTrip {
  std::string failure;  ///< "" when what came back is exact
  EncodeResult encoded;
  std::vector<DecodedPiece> decoded;
  CodeHistogram histogram;
};

/// Encodes, decodes and compares.
RoundTrip roundTrip(std::span<const PieceView> pieces, const EncodeSettings& settings = {},
                    const TargetLayout& layout = {});
RoundTrip roundTrip(const PieceView& piece, const EncodeSettings& settings = {},
                    const TargetLayout& layout = {});

/// Settings without some of the encoder's choices.
inline EncodeSettings without(std::initializer_list<Feature> features) {
  EncodeSettings settings;
  for (const Feature feature : features) settings.without.add(feature);
  return settings;
}

/// Bits of the float attributes of a MeshPiece; 0 is exact.
struct MeshBits {
  uint8_t position = 14;
  uint8_t normal = 10;
  uint8_t texcoord = 12;
};
inline constexpr MeshBits kExactBits = {0, 0, 0};

/// A TestMesh as a PieceView with one part. Borrows the mesh.
class MeshPiece {
 public:
  explicit MeshPiece(const TestMesh& mesh, const MeshBits& bits = {});
  MeshPiece(const MeshPiece&) = delete;
  MeshPiece& operator=(const MeshPiece&) = delete;

  PieceView view() const { return {wedge_count_, attributes_, parts_}; }
  /// Adds an attribute of tight elements that the caller keeps.
  void add(const AttributeFormat& format, const void* data, uint8_t quantization_bits = 0);
  /// Replaces POSITION.
  void setPositions(const AttributeFormat& format, const void* data);
  /// Replaces the triangle lists.
  void setParts(std::vector<PartView> parts) { parts_ = std::move(parts); }

 private:
  uint32_t wedge_count_;
  std::vector<AttributeView> attributes_;
  std::vector<PartView> parts_;
};

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_MESH_COMPARE_H_
