// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Draco with plain structs: what it makes of a primitive, at our quantisation and measured like our
// codec.
#ifndef MCC_TOOLS_FOREIGN_DRACO_CODEC_H_
#define MCC_TOOLS_FOREIGN_DRACO_CODEC_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "foreign/foreign_mesh.h"
#include "mcc/types.h"
#include "mcc/writer.h"

namespace mcc::foreign {

enum class DracoMethod : uint8_t {
  /// Smallest; loses the orders, splits non-manifold vertices, drops degenerate triangles.
  kEdgebreaker,
  /// Keeps every wedge, every triangle and both orders.
  kSequential,
};

struct DracoAttribute {
  AttributeView view;             ///< borrowed data
  uint32_t piece_attribute = 0;   ///< index in PieceView::attributes
  uint8_t quantization_bits = 0;  ///< 0: stored exactly; octahedral bits when is_octahedral
  bool is_octahedral = false;     ///< float NORMAL of three components
  Lattice lattice;                ///< of a quantised attribute that is not octahedral
  float range = 0;                ///< step * (2^bits - 1), what Draco is told
};

/// One primitive as Draco's encoder wrapper for JavaScript, hence glTF-Transform, hands it over.
struct DracoInput {
  uint32_t wedge_count = 0;
  std::span<const uint32_t> indices;  ///< borrowed, 3 per triangle
  /// Attribute i gets Draco's unique id i; POSITION is first.
  std::vector<DracoAttribute> attributes;
  /// Attributes of the piece Draco cannot take: morph deltas and those of more than four
  /// components. glTF keeps them as ordinary accessors next to a Draco payload.
  std::vector<uint32_t> left_out;
  DracoMethod method = DracoMethod::kEdgebreaker;
  /// DeduplicateAttributeValues and DeduplicatePointIds before encoding, as the wrapper does.
  bool deduplicate = true;
};

/// Describes one part of a piece to Draco. POSITION, NORMAL, COLOR and TEX_COORD keep their types,
/// everything else is GENERIC, including integer normals; integers are exact; floats with
/// quantization_bits > 0 get our lattice as
/// explicit quantisation (origin and range), so that bits mean the same on both sides; normals get
/// octahedral bits. Attributes with NaN, infinity or a range beyond float32 stay exact.
/// Fails without POSITION, without triangles, on an index beyond the wedges and on bits Draco has
/// not. The piece's arrays must outlive `input`.
Outcome makeDracoInput(const PieceView& piece, size_t part, DracoInput& input);

/// The same primitive with POSITION only: Draco then codes the mesh welded by position, without
/// seams.
DracoInput positionsOnly(const DracoInput& input);

/// Bytes per stream; their sum is the size of the whole. They are the places of the output at which
/// a derived encoder saw the stages begin and end, hence exact, not differences between encodes.
struct DracoStreams {
  size_t header_bytes = 0;  ///< header, attribute descriptions, parameters of the quantisation
  size_t connectivity_bytes = 0;  ///< triangles with the seams of all attributes
  /// Per attribute of the input. Sequential: all of them together in the first, Draco does not
  /// separate them.
  std::vector<size_t> attribute_bytes;
};

struct DracoEncoded {
  std::vector<uint8_t> bytes;
  DracoStreams streams;
  double prepare_ms = 0;  ///< building Draco's mesh, deduplication included
  double encode_ms = 0;   ///< Draco's encoder alone
};

/// Encodes at one speed for both directions (0 smallest, 3, 5 glTF-Transform's default, 10
/// fastest). The bytes are those of draco::ExpertEncoder with the same options. Deterministic.
/// Inverse: decodeDraco(). Tests: tests/foreign/draco_codec_test.cpp.
Outcome encodeDraco(const DracoInput& input, int speed, DracoEncoded& encoded);

/// Bytes of the triangles alone, on the mesh welded by position, and of the whole of that encode.
struct DracoConnectivity {
  size_t connectivity_bytes = 0;
  DracoEncoded positions_only;
};
Outcome encodeDracoConnectivity(const DracoInput& input, int speed,
                                DracoConnectivity& connectivity);

/// Decodes to final arrays. Touches nothing but `bytes` and memory it allocates, keeps no state.
/// Fails on anything that is not a triangle mesh, with Draco's own message. Draco checks the bytes,
/// but bounds neither time nor memory: do not give it untrusted files without an outer limit.
Outcome decodeDraco(std::span<const uint8_t> bytes, DecodedMesh& mesh);

/// What a Draco mesh says of itself before its data.
struct DracoCounts {
  uint64_t triangle_count = 0;
  uint64_t vertex_count =
      0;  ///< edgebreaker: before seams split vertices; the decoded ones are not fewer
};

/// Reads only the counts, and takes no memory for what they claim. Fails on anything that is not a
/// triangle mesh.
Outcome readDracoCounts(std::span<const uint8_t> bytes, DracoCounts& counts);

/// What a decode did to the values. Draco gives no map from decoded to source vertices. So the same
/// attributes, with the same quantisation, are coded once more in sequential mode, which
/// keeps the order of the wedges; the errors are measured there. That both modes decode to the same
/// values is checked, not assumed: every attribute tuple of `decoded` has to occur among them.
struct DracoErrors {
  std::vector<AttributeError> attributes;  ///< per attribute of the input
  uint32_t unmatched_vertex_count = 0;  ///< decoded vertices whose tuple no wedge has: has to be 0
  /// Wedges in use by a triangle whose tuple is in no decoded vertex: their triangles were all
  /// dropped.
  uint32_t missing_wedge_count = 0;
};
/// decoded  result of decodeDraco() on encodeDraco(input, ...). Wedges that are missing from it or
///          in no triangle of the input are left out of the errors. The errors do not depend on the
///          speed: once per input is enough.
Outcome measureDracoErrors(const DracoInput& input, const DecodedMesh& decoded,
                           DracoErrors& errors);

/// One attribute of KHR_draco_mesh_compression and what its accessor has to say.
struct DracoPrimitiveAttribute {
  uint32_t piece_attribute = 0;
  uint32_t unique_id = 0;       ///< value in the extension's `attributes`
  std::vector<double> minimum;  ///< of the decoded values, per component
  std::vector<double> maximum;
};

/// What KHR_draco_mesh_compression needs: a buffer view's bytes, and accessors "matching the
/// decompressed data".
struct DracoPrimitive {
  std::vector<uint8_t> bytes;
  uint32_t vertex_count = 0;    ///< `count` of the attribute accessors
  uint32_t triangle_count = 0;  ///< a third of `count` of the index accessor
  std::vector<DracoPrimitiveAttribute> attributes;
  std::vector<uint32_t> left_out;  ///< attributes that stay ordinary accessors
  DracoMethod method = DracoMethod::kEdgebreaker;
};

/// Encodes one part for a glTF file. A part with attributes that stay ordinary accessors, such as
/// morph targets, is coded sequentially without deduplication: the order of its wedges is kept.
Outcome emitDracoPrimitive(const PieceView& piece, size_t part, int speed,
                           DracoPrimitive& primitive);

/// "1.5.5".
std::string dracoVersion();

}  // namespace mcc::foreign

#endif  // MCC_TOOLS_FOREIGN_DRACO_CODEC_H_
