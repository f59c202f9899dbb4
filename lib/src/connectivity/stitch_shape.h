// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The cut mesh as stitching looks at it: rings, boundary loops, degrees.                    [A.5.1]
#ifndef MCC_CONNECTIVITY_STITCH_SHAPE_H_
#define MCC_CONNECTIVITY_STITCH_SHAPE_H_

#include <algorithm>
#include <cstdint>

#include "base/memory.h"
#include "mcc/status.h"
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

/// All about a vertex of the cut mesh that may have copies: soups jump around. `next`, `prev` and `next_member` are places
/// in StitchShape::vertices.
struct StitchVertex {
  uint32_t start = kNone;  ///< half-edge leaving it; on a boundary the clockwise-most
  uint32_t next = kNone;   ///< along the boundary, kNone inside
  uint32_t prev = kNone;
  StitchKind kind;
  uint32_t group = kNone;  ///< once it is processed
  uint32_t next_member = kNone;
  uint32_t visited_by = kNone;  ///< the vertex whose surroundings were searched last
};

/// The vertices that may have copies, by number: all of them, or those on boundaries.
struct StitchShape {
  explicit StitchShape(const Allocator& allocator) : vertices(allocator), place_of(allocator) {}

  Array<StitchVertex> vertices;
  Array<uint32_t>
      place_of;  ///< in `vertices`, by vertex, kNone inside; empty where all may have copies

  MCC_INLINE uint32_t placeOf(uint32_t vertex) const {
    return place_of.empty() ? vertex : place_of[vertex];
  }
};

/// Calls visit(place of the neighbour, side) for the ring of `place`, clockwise-most first, until it returns false.
template <class Visit>
MCC_INLINE void forRing(const StitchShape& shape, FaceView faces, uint32_t place, Visit visit) {
  const uint32_t first = shape.vertices[place].start;
  uint32_t h = first;
  EdgeSide side = faces.twin(h) == kNone ? EdgeSide::kOut : EdgeSide::kInner;
  do {
    if (!visit(shape.placeOf(faces.vertex(nextHalfEdge(h))), side)) return;
    side = EdgeSide::kInner;
    const uint32_t last = prevHalfEdge(h);
    h = faces.twin(last);
    if (h == kNone) {
      visit(shape.placeOf(faces.vertex(last)), EdgeSide::kIn);
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

/// Half-edge `h` leaves the boundary vertex `from`; `to` may have no place.
MCC_INLINE void linkBoundary(StitchVertex* vertices, uint32_t from, uint32_t to, uint32_t h) {
  vertices[from].start = h;
  vertices[from].next = to;
  if (to != kNone) vertices[to].prev = from;
}

/// Places for the vertices on boundaries.
[[nodiscard]] inline Status buildBoundaryShape(const FaceMesh& mesh, FaceView faces,
                                               StitchShape& shape) {
  constexpr uint32_t kInside = kNone - 1;
  constexpr uint32_t kOnBoundary = kNone - 2;
  if (!shape.place_of.assign(mesh.vertex_count, kNone))
    return fail(Error::kOutOfMemory, "no memory for stitching");
  uint32_t* const place_of = shape.place_of.data();
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
      uint32_t& place = place_of[faces.vertex(h)];
      place = faces.twin(h) == kNone ? kOnBoundary : std::min(place, kInside);
    }
  }
  uint32_t count = 0;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    if (place_of[v] == kNone) return fail(Error::kBadConnectivity, "a vertex has no triangle");
    place_of[v] = place_of[v] == kOnBoundary ? count++ : kNone;
  }
  if (!shape.vertices.assign(count, StitchVertex{}))
    return fail(Error::kOutOfMemory, "no memory for stitching");
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    const uint32_t base = f * kFaceWords;
    // Only kNone has the highest bit.
    if (((faces.twin(base) | faces.twin(base + 1) | faces.twin(base + 2)) >> 31) == 0) [[likely]]
      continue;
    for (uint32_t h = base; h < base + 3; ++h) {
      if (faces.twin(h) != kNone) continue;
      linkBoundary(shape.vertices.data(), place_of[faces.vertex(h)],
                   place_of[faces.vertex(nextHalfEdge(h))], h);
    }
  }
  return {};
}

/// A place for every vertex, and degrees; on boundaries alone boundaryDegree() has them.
[[nodiscard]] inline Status buildFullShape(const FaceMesh& mesh, FaceView faces,
                                           StitchShape& shape) {
  if (!shape.vertices.assign(mesh.vertex_count, StitchVertex{}))
    return fail(Error::kOutOfMemory, "no memory for stitching");
  StitchVertex* const vertices = shape.vertices.data();
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    const uint32_t base = f * kFaceWords;
    for (uint32_t h = base; h < base + 3; ++h) {
      StitchVertex& from = vertices[faces.vertex(h)];
      uint8_t& degree = from.kind.degree;
      degree = static_cast<uint8_t>(degree + (degree < kStitchDegreeLimit ? 1 : 0));
      if (faces.twin(h) == kNone) {
        linkBoundary(vertices, faces.vertex(h), faces.vertex(nextHalfEdge(h)), h);
      } else if (from.next == kNone) {
        from.start = h;
      }
    }
  }
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    const uint32_t* corner = faces.words + size_t{f} * kFaceWords;
    StitchKind* const kind[3] = {&vertices[corner[0]].kind, &vertices[corner[1]].kind,
                                 &vertices[corner[2]].kind};
    for (uint32_t k = 0; k < 3; ++k) {
      uint8_t& highest = kind[k]->highest_degree;
      highest = std::max(highest, kind[k == 2 ? 0 : k + 1]->degree);
    }
  }
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    if (vertices[v].start == kNone)
      return fail(Error::kBadConnectivity, "a vertex has no triangle");
  }
  return {};
}

[[nodiscard]] inline Status buildShape(const FaceMesh& mesh, FaceView faces, bool with_interior,
                                       StitchShape& shape) {
  MCC_TRY(with_interior ? buildFullShape(mesh, faces, shape)
                        : buildBoundaryShape(mesh, faces, shape));
  measureLoops(shape.vertices);
  return {};
}

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_STITCH_SHAPE_H_
