// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The cut mesh as stitching looks at it: rings, boundary loops, degrees.                    [A.5.1]
#ifndef MCC_CONNECTIVITY_STITCH_SHAPE_H_
#define MCC_CONNECTIVITY_STITCH_SHAPE_H_

#include <algorithm>
#include <cstdint>

#include "base/memory.h"
#include "mesh/face_mesh.h"

namespace mcc {

inline constexpr uint32_t kStitchLoopClasses = 64;  ///< 0: not on a boundary, else min(length, 63)
inline constexpr uint32_t kStitchDegreeLimit = 31;  ///< degrees above count as this

/// Boundary half-edge leaving or entering the vertex, or neither.
enum class EdgeSide : uint8_t { kInner, kOut, kIn };

/// What contexts need to know of a vertex.
struct StitchKind {
  uint8_t loop = 0;            ///< class of its boundary loop
  uint8_t degree = 0;          ///< triangles; set where copies may lie inside
  uint8_t highest_degree = 0;  ///< of its neighbours, likewise
  uint8_t marks = 0;           ///< neighbours that have copies so far, up to 3, and kNearGlued

  static constexpr uint8_t kNearGlued = 4;  ///< copies few steps along the boundary
  uint32_t gluedNeighbours() const { return marks & 3u; }
};

/// All about a vertex of the cut mesh: soups jump around.
struct StitchVertex {
  uint32_t start = kNone;  ///< half-edge leaving it; on a boundary the clockwise-most
  uint32_t next = kNone;   ///< along the boundary, kNone inside
  uint32_t prev = kNone;
  StitchKind kind;
  uint32_t group = kNone;  ///< once it is processed
  uint32_t next_member = kNone;
  uint32_t visited_by = kNone;  ///< the vertex whose surroundings were searched last
};

/// Calls visit(neighbour, side) for the ring of v, clockwise-most first, until it returns false.
template <class Visit>
MCC_INLINE void forRing(const Array<StitchVertex>& vertices, FaceView faces, uint32_t v,
                        Visit visit) {
  const uint32_t first = vertices[v].start;
  uint32_t h = first;
  EdgeSide side = faces.twin(h) == kNone ? EdgeSide::kOut : EdgeSide::kInner;
  do {
    if (!visit(faces.vertex(nextHalfEdge(h)), side)) return;
    side = EdgeSide::kInner;
    const uint32_t last = prevHalfEdge(h);
    h = faces.twin(last);
    if (h == kNone) {
      visit(faces.vertex(last), EdgeSide::kIn);
      return;
    }
  } while (h != first);
}

/// Classes of loops by their length. A damaged stream may have vertices on several boundaries, so that a walk need
/// not return: it ends at the first vertex that was visited.
inline void measureLoops(Array<StitchVertex>& vertices) {
  for (uint32_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v].next == kNone || vertices[v].kind.loop != 0) continue;
    uint32_t length = 0;
    for (uint32_t u = v; u != kNone && vertices[u].kind.loop == 0; u = vertices[u].next) {
      vertices[u].kind.loop = 1;
      ++length;
    }
    const uint8_t loop = static_cast<uint8_t>(std::min(length, kStitchLoopClasses - 1));
    for (uint32_t u = v, i = 0; i < length; u = vertices[u].next, ++i) vertices[u].kind.loop = loop;
  }
}

inline void measureDegrees(const FaceMesh& mesh, FaceView faces, Array<StitchVertex>& vertices) {
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    const uint32_t* corner = faces.words + size_t{f} * kFaceWords;
    for (uint32_t k = 0; k < 3; ++k) {
      uint8_t& degree = vertices[corner[k]].kind.degree;
      degree = static_cast<uint8_t>(degree + (degree < kStitchDegreeLimit ? 1 : 0));
    }
  }
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    const uint32_t* corner = faces.words + size_t{f} * kFaceWords;
    for (uint32_t k = 0; k < 3; ++k) {
      StitchKind& kind = vertices[corner[k]].kind;
      kind.highest_degree =
          std::max(kind.highest_degree, vertices[corner[k == 2 ? 0 : k + 1]].kind.degree);
    }
  }
}

/// Degrees only `with_interior`, else boundaryDegree() has them. False without memory.
[[nodiscard]] inline bool buildShape(const FaceMesh& mesh, FaceView faces, bool with_interior,
                                     Array<StitchVertex>& vertices) {
  if (!vertices.assign(mesh.vertex_count, StitchVertex{})) return false;
  StitchVertex* const vertex = vertices.data();
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    const uint32_t base = f * kFaceWords;
    for (uint32_t h = base; h < base + 3; ++h) {
      StitchVertex& from = vertex[faces.vertex(h)];
      if (faces.twin(h) == kNone) {
        const uint32_t to = faces.vertex(nextHalfEdge(h));
        from.start = h;
        from.next = to;
        vertex[to].prev = faces.vertex(h);
      } else if (from.next == kNone) {
        from.start = h;
      }
    }
  }
  measureLoops(vertices);
  if (with_interior) measureDegrees(mesh, faces, vertices);
  return true;
}

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_STITCH_SHAPE_H_
