// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writer of KHR_mesh_collapse_compression payloads.
#ifndef MCC_WRITER_H_
#define MCC_WRITER_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mcc/export.h"
#include "mcc/status.h"
#include "mcc/types.h"

namespace mcc {

/// One vertex attribute of a piece as the caller holds it.
struct AttributeView {
  AttributeFormat format;
  const void* data = nullptr;  ///< wedge_count elements
  size_t stride_bytes = 0;     ///< at least elementBytes(format)
  /// Bits of the lattice of a float attribute (1..24; octahedral bits of normals 2..16); 0: exact.
  /// Ignored by integer attributes, which are exact. An attribute with NaN or infinity goes exact.
  uint8_t quantization_bits = 0;
  /// Lattice to use instead of the attribute's own bounding box; null: own box. Borrowed. Deltas of morph targets use its
  /// step alone: their lattices go through 0. Must be one that isValidLattice().
  const Lattice* lattice = nullptr;
};

/// A triangle list on the wedges of a piece. Any indices below wedge_count are allowed: degenerate and
/// duplicate triangles, non-manifold edges, unused wedges.
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

/// Runs job(0) … job(count - 1), in any order, at the same time where it likes, and returns when all have ended. Jobs
/// throw nothing; they may call it again, also at the same time.
using RunJobs = std::function<void(size_t count, const std::function<void(size_t)>& job)>;

/// How to encode. The defaults make small payloads whose orders are free.
struct EncodeOptions {
  /// Half-edge (3 * triangle + corner) the first component's collapse starts at; kNone: the encoder chooses.
  /// A test hook.
  uint32_t start_half_edge = kNone;
  /// Not normally set: forces one of the two connectivity context sets.
  uint32_t context_set = kNone;
  /// The payload holds no attributes, only the triangles. The caller reorders its attributes by source_wedge, or keeps the
  /// vertex order. Each PieceView has POSITION alone, which is used to find equal positions.
  bool indices_only = false;
  /// The decoded triangles of every part in the order of PartView::indices, each beginning with the same corner.
  bool keep_triangle_order = false;
  /// The decoded wedges in the order of the PieceView: source_wedge is then the identity.
  bool keep_vertex_order = false;
  /// Effort: 0 fast (few trials) .. 2 (all trials). The bytes depend on it, exactness does not.
  uint8_t effort = 1;
  /// Smaller, or faster to decode. Exactness does not depend on it.
  Preference prefer = Preference::kBalanced;
  /// Threads for the trials of the writer, which starts none itself; empty: it runs on the caller's alone. The bytes do not
  /// depend on it. Takes up to half the memory of a piece more for each job at a time.
  RunJobs run_jobs;
  /// Not normally set: every choice is made at random among those the format allows, by this seed, instead of for the
  /// smallest result. A test hook.
  uint64_t variation = 0;
};

/// Bits per stream, as the entropy coders spent them (the sum over streams is total_bytes * 8).
struct StreamSizes {
  double header_bits = 0;        ///< container, attribute descriptions, flushes, padding
  double connectivity_bits = 0;  ///< mesh collapse codes
  double stitch_bits = 0;        ///< re-joining of cut vertices
  double leftover_bits = 0;      ///< duplicate and degenerate triangles, parts
  double seam_bits = 0;          ///< wedges and equality flags
  double position_bits = 0;
  double order_bits = 0;  ///< of vertices and triangles, where kept
  std::vector<double>
      attribute_bits;  ///< per attribute of the payload, in piece order; position included as 0
  std::vector<double> piece_position_bits;  ///< position_bits of each piece
};

/// What became of a piece.
struct PieceResult {
  /// source_wedge[i] is the wedge of the PieceView that decoded wedge i carries: a bijection.
  std::vector<uint32_t> source_wedge;
  uint32_t topological_vertex_count = 0;  ///< distinct positions (classes after stitching) in use
  uint32_t cut_copy_count = 0;            ///< vertices duplicated to become manifold
  uint32_t hole_count = 0;
  uint32_t component_count = 0;
  uint32_t leftover_triangle_count = 0;  ///< duplicates and degenerates coded apart
};

/// A payload and what is known about it.
struct EncodeResult {
  std::vector<uint8_t> payload;
  StreamSizes sizes;
  std::vector<PieceResult> pieces;
  std::vector<std::string> notes;  ///< attributes that went exact and why, in plain English
};

/// Compresses pieces into one payload; they share adaptive models.
/// Errors: kBadArgument (an index >= wedge_count, no POSITION, bits or lattice out of range, null data, further attributes with
/// indices_only, JOINTS_n of 4 components with WEIGHTS_n that hold -1 or 2^32 - 1),
/// kLimit (more than 2^28 triangles or wedges), kOutOfMemory. Deterministic: the same input gives the
/// same bytes on every machine. Time O(n log n) in triangles and wedges.
/// Inverse: Payload::decode(). Tests: tests/roundtrip/.
MCC_API Status encode(std::span<const PieceView> pieces, const EncodeOptions& options,
                      EncodeResult& result);

}  // namespace mcc

#endif  // MCC_WRITER_H_
