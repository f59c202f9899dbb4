// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writer of KHR_mesh_collapse_compression payloads.
#ifndef MCC_WRITER_H_
#define MCC_WRITER_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mcc/export.h"
#include "mcc/run_jobs.h"
#include "mcc/status.h"
#include "mcc/types.h"

namespace mcc {

/// One vertex attribute of a piece in the caller's memory.
struct AttributeView {
  AttributeFormat format;
  const void* data = nullptr;  ///< wedge_count elements
  size_t stride_bytes = 0;     ///< at least elementBytes(format)
  /// Bits of the lattice of a float attribute, 1..24, or of the octahedral grid of normals, 2..16;
  /// 0 keeps every bit. Integer attributes ignore it and are always exact. An attribute with NaN or
  /// infinity is coded exactly.
  uint8_t quantization_bits = 0;
  /// Lattice to use instead of one over the attribute's own bounding box; null: the bounding box.
  /// Borrowed. Deltas of morph targets use only its step, because their lattices go through 0.
  /// isValidLattice() must hold.
  const Lattice* lattice = nullptr;
};

/// A triangle list on the wedges of a piece. Any indices below wedge_count are allowed: triangles
/// may be degenerate or duplicate, edges non-manifold, and wedges unused.
struct PartView {
  std::span<const uint32_t> indices;  ///< 3 per triangle
};

/// A set of wedges (glTF vertices) with its attributes and the triangle lists on them.
/// attributes[0] must be POSITION of the base mesh: float32 or integer, 3 components.
struct PieceView {
  uint32_t wedge_count = 0;
  std::span<const AttributeView> attributes;
  std::span<const PartView> parts;
};

/// Options of encode(). The defaults make small payloads and let the writer choose the orders.
struct EncodeOptions {
  /// The payload holds only the triangles and no attributes. The caller reorders its attributes by
  /// source_wedge, or sets keep_vertex_order. Each PieceView has only POSITION, which is used to
  /// find equal positions.
  bool indices_only = false;
  /// Decoded triangles of every part come in the order of PartView::indices, each beginning with
  /// the same corner.
  bool keep_triangle_order = false;
  /// Decoded wedges come in the order of the PieceView: source_wedge is then the identity.
  bool keep_vertex_order = false;
  /// Whether the payload should be smaller, or faster to decode. It never changes the accuracy.
  Preference prefer = Preference::kBalanced;
  /// Cuts a surface of more triangles than this into blocks of about as many, which several threads
  /// can decode, and parts of which can be shown while the rest is loading. 0: never;
  /// kBlocksByPreference: blocks of 262,144 triangles from 524,288 on, but none to make the payload
  /// smaller (Preference::kSize), because each border costs some bytes. A surface that does not cut
  /// well stays whole, and EncodeResult::whole_because says why. There are blocks only in a payload
  /// of one piece without kept orders.
  uint32_t block_triangles = kBlocksByPreference;
  /// Runs the trials of the writer on several threads. The writer starts none itself; when empty,
  /// everything runs on the caller's thread. The bytes do not depend on it. Each job that runs at
  /// the same time takes up to half the memory of a piece more.
  RunJobs run_jobs;
};

/// Returns how many triangles the blocks of a piece have under these options; 0: the options ask
/// for none. Such a piece should be alone in its payload. Allocates nothing.
constexpr uint32_t blockTriangles(uint32_t block_triangles, Preference prefer,
                                  uint64_t triangle_count) {
  constexpr uint64_t kUsualFewestTriangles = 1u << 19;
  constexpr uint32_t kUsualBlockTriangles = 1u << 18;
  if (block_triangles == kBlocksByPreference) {
    const bool pays = prefer != Preference::kSize && triangle_count >= kUsualFewestTriangles;
    block_triangles = pays ? kUsualBlockTriangles : 0;
  }
  return triangle_count > block_triangles ? block_triangles : 0;
}

/// Bits per stream, as the entropy coders spent them. They add up to the payload's size.
struct StreamSizes {
  double header_bits = 0;        ///< container, attribute descriptions, flushes, padding
  double connectivity_bits = 0;  ///< mesh collapse codes
  double stitch_bits = 0;        ///< joins cut vertices again
  double leftover_bits = 0;      ///< duplicate and degenerate triangles, parts
  double seam_bits = 0;          ///< wedges and equality flags
  double position_bits = 0;
  double order_bits = 0;  ///< of vertices and triangles, where kept
  /// Per attribute of the payload, over all pieces in their order; 0 for positions.
  std::vector<double> attribute_bits;
  std::vector<double> piece_position_bits;  ///< position_bits of each piece
};

/// What the writer found out about a piece.
struct PieceResult {
  /// source_wedge[i] is the wedge of the PieceView that decoded wedge i carries: a bijection.
  std::vector<uint32_t> source_wedge;
  uint32_t topological_vertex_count = 0;  ///< distinct positions (classes after stitching) in use
  uint32_t cut_copy_count = 0;            ///< vertices duplicated to become manifold
  uint32_t hole_count = 0;
  uint32_t component_count = 0;
  uint32_t leftover_triangle_count = 0;  ///< duplicate and degenerate triangles, coded separately
};

/// A payload and what is known about it.
struct EncodeResult {
  std::vector<uint8_t> payload;
  StreamSizes sizes;
  std::vector<PieceResult> pieces;
  std::vector<std::string> notes;  ///< attributes that had to be coded exactly, and why
  uint32_t block_count = 0;        ///< 0: the pieces are coded as wholes
  std::string whole_because;       ///< why there are no blocks, if they were asked for
};

/// Compresses pieces into one payload; they share adaptive models.
/// Errors: kBadArgument (no pieces, a piece without parts, a part whose number of indices is not a
/// multiple of 3, an index that is not below wedge_count, no POSITION, bits or lattice out of
/// range, null data, attributes other than POSITION with indices_only, JOINTS_n of 4 components
/// with WEIGHTS_n that hold -1 or 2^32 - 1), kLimit (2^28 or more triangles or wedges in a piece),
/// kOutOfMemory. After an error `result` is unspecified. Deterministic: the same input gives the
/// same bytes on every machine. Takes time O(n log n) in triangles and wedges.
MCC_API Status encode(std::span<const PieceView> pieces, const EncodeOptions& options,
                      EncodeResult& result);

}  // namespace mcc

#endif  // MCC_WRITER_H_
