// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Meshlets of decoded triangles: clusters of a few triangles and vertices with indices of one byte,
// as mesh shaders draw them, in the layout of meshoptimizer. Part of the reader's library.
#ifndef MCC_MESHLETS_H_
#define MCC_MESHLETS_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "mcc/allocator.h"
#include "mcc/export.h"
#include "mcc/status.h"
#include "mcc/types.h"

namespace mcc {

/// Where a meshlet is in the arrays of a MeshletTarget. Has the layout of meshopt_Meshlet.
struct Meshlet {
  uint32_t vertex_offset = 0;    ///< in MeshletTarget::vertices
  uint32_t triangle_offset = 0;  ///< in MeshletTarget::triangles, a multiple of 4
  uint32_t vertex_count = 0;
  uint32_t triangle_count = 0;
};

/// Which triangles go into a meshlet.
enum class MeshletShape : uint8_t {
  /// Those around its vertices, so that it is round: about as few vertices as with
  /// meshopt_buildMeshlets(), in less than a tenth of the time, but larger spheres
  /// (docs/benchmarks.md), because positions are not looked at.
  kRound = 0,
  /// The next ones of the list, as meshopt_buildMeshletsScan() does. Three to seven times as fast,
  /// but the decoder's list is a spiral, so that meshlets are long strips.
  kInOrder = 1,
};

/// How large meshlets may be. The defaults are those that meshoptimizer recommends.
struct MeshletOptions {
  uint32_t max_vertices = 64;    ///< 3..256; meshoptimizer before version 1.0 takes up to 255
  uint32_t max_triangles = 124;  ///< 1..512
  MeshletShape shape = MeshletShape::kRound;
  Allocator allocator;  ///< for working memory: 8 bytes a vertex and 13 a triangle; 4 a vertex with
                        ///< kInOrder
};

/// Triangles as Payload::decode() makes them for a part. Borrowed.
struct TriangleList {
  const void* indices = nullptr;  ///< three for each triangle, aligned for their type
  IndexType index_type = IndexType::kUint32;
  uint32_t triangle_count = 0;
  uint32_t vertex_count = 0;  ///< each index is below it: PieceInfo::wedge_count
};

/// Numbers of elements in the arrays of a MeshletTarget.
struct MeshletSizes {
  size_t meshlet_count = 0;
  size_t vertex_count = 0;    ///< of all meshlets: a vertex counts in each that it is in
  size_t triangle_bytes = 0;  ///< three for a triangle, and up to three zeros after a meshlet
};

/// Memory of the caller that buildMeshlets() fills.
struct MeshletTarget {
  std::span<Meshlet> meshlets;
  std::span<uint32_t> vertices;  ///< for each meshlet its vertices, as the indices have them
  /// For each triangle three bytes: the numbers of its corners among the vertices of its meshlet.
  std::span<uint8_t> triangles;
};

/// Returns how large the arrays of a MeshletTarget have to be for any list of so many triangles; at
/// most 2^28, and zeros when buildMeshlets() refuses the numbers. O(1).
MCC_API MeshletSizes meshletBound(uint32_t triangle_count, const MeshletOptions& options = {});

/// Divides a triangle list into meshlets. A meshlet begins with the first triangle of the list that
/// no earlier one has. With kRound it takes the triangles around its vertices, in the order in
/// which it has met these, and begins again elsewhere while it is less than half full; the walk of
/// the decoder gives a good list for that, because what it has left lies close together. Meshlets
/// are in the order of their first triangles. Each triangle is in one of them, with its corners in
/// the order of the list.
/// target  arrays of at least meshletBound(), apart from the list
/// used    receives how much of the arrays is in use
/// Returns kBadArgument (options out of range, an index that is no vertex, arrays that are null or
/// too small), kLimit (more than 2^28 triangles), kOutOfMemory; the target then holds unspecified
/// bytes. Safe for untrusted indices. Time is linear in the counts, whatever the triangles are.
/// Deterministic. Tests: tests/unit/reader/meshlets_test.cpp.
MCC_API Status buildMeshlets(const TriangleList& list, const MeshletTarget& target,
                             MeshletSizes& used, const MeshletOptions& options = {});

}  // namespace mcc

#endif  // MCC_MESHLETS_H_
