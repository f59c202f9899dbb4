// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Triangles that are not part of the surface: exact duplicates of faces, and degenerate ones; and
// the parts that all triangles belong to. [A.8]
#ifndef MCC_SURFACE_LEFTOVERS_H_
#define MCC_SURFACE_LEFTOVERS_H_

#include <algorithm>
#include <cstdint>

#include "base/memory.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mesh/face_mesh.h"

namespace mcc {

struct LeftoverModels {
  BitModel same_part[4];
  GolombModel part;
  TreeModel<3> list_shape[8];  ///< [shape of the triangle before]
  GolombModel list_gap[2];     ///< [0: faces again, 1: on edges]
  GolombModel list_wedge[3];
  GolombModel list_part;
};

/// A triangle that is not part of the surface.
struct ListedTriangle {
  uint32_t wedge[3];
  uint32_t part;
  uint32_t shape;  ///< listed_shape
  uint32_t face;   ///< the face that the shape refers to
};

/// What the encoder knows; the pointers are null when decoding.
struct LeftoverTruth {
  const uint32_t* part_of_face = nullptr;
  const ListedTriangle* list = nullptr;
};

/// Sizes that are known before the leftovers are coded.
struct LeftoverCounts {
  uint32_t faces;
  uint32_t wedges;
  uint32_t parts;
  uint32_t listed;  ///< triangles that are not part of the surface
};

/// Codes the part of each face into its kFaceWord. It is predicted from the face across half-edge 1
/// if that was decoded before, else from the previous face. [A.8.1]
template <class Io>
Status codeParts(Io& io, LeftoverModels& models, const FaceView& faces,
                 const LeftoverCounts& counts, const LeftoverTruth& truth) {
  const uint32_t part_count = counts.parts;
  if (part_count < 2) return {};
  uint32_t previous = 0;
  for (uint32_t f = 0; f < counts.faces; ++f) {
    const uint32_t entry = faces.twin(f * kFaceWords + 1);
    const bool has_entry = entry != kNone && faceOf(entry) < f;
    const uint32_t guess = has_entry ? faces.words[(entry & ~7u) + kFaceWord] : previous;
    uint32_t part = guess;
    const bool truth_same = Io::kEncoding && truth.part_of_face[f] == guess;
    if (!io.bit(models.same_part[(has_entry ? 1 : 0) + (guess == previous ? 2 : 0)], truth_same)) {
      uint32_t distance = 0;
      if constexpr (Io::kEncoding) {
        distance = (truth.part_of_face[f] + part_count - guess) % part_count - 1;
      }
      distance = codeGolomb(io, models.part, distance);
      if (distance >= part_count - 1) return fail(Error::kBadAttribute, "a triangle is in no part");
      part = (guess + 1 + distance) % part_count;
    }
    faces.words[f * kFaceWords + kFaceWord] = part;
    previous = part;
  }
  return {};
}

/// What a listed triangle is: a copy of a face; (a, a, b) or (b, b, a) for the ends a, b of a
/// half-edge of a face; or any other.
namespace listed_shape {
inline constexpr uint32_t kFaceAgain = 0;
inline constexpr uint32_t kOnEdge = 1;  ///< 1 + 2 * half-edge, plus one for (b, b, a)
inline constexpr uint32_t kAny = 7;
}  // namespace listed_shape

/// Sets the wedges of a triangle whose shape refers to a face.
inline void placeOnFace(const FaceView& faces, ListedTriangle& t) {
  const uint32_t base = t.face * kFaceWords;
  if (t.shape == listed_shape::kFaceAgain) {
    for (uint32_t k = 0; k < 3; ++k) t.wedge[k] = faces.vertex(base + k);
    return;
  }
  const uint32_t h = base + (t.shape - listed_shape::kOnEdge) / 2;
  const bool reversed = (t.shape - listed_shape::kOnEdge) % 2 != 0;
  t.wedge[0] = t.wedge[1] = faces.vertex(reversed ? nextHalfEdge(h) : h);
  t.wedge[2] = faces.vertex(reversed ? h : nextHalfEdge(h));
}

/// Codes the triangles one by one; those that refer to faces are in ascending order of
/// the faces. [A.8.2]
template <class Io>
Status codeList(Io& io, LeftoverModels& models, const FaceView& faces, const LeftoverCounts& counts,
                const LeftoverTruth& truth, Array<ListedTriangle>& list) {
  if (!list.reserve(counts.listed))
    return fail(Error::kOutOfMemory, "no memory for listed triangles");
  ListedTriangle t{};
  for (uint32_t i = 0; i < counts.listed; ++i) {
    const ListedTriangle last = t;
    const ListedTriangle* known = Io::kEncoding ? truth.list + i : &t;
    t.shape = codeTree<Io, 3>(io, models.list_shape[last.shape], known->shape);
    uint32_t guess = last.part;
    if (t.shape != listed_shape::kAny) {
      const uint32_t gap =
          codeGolomb(io, models.list_gap[t.shape == 0 ? 0 : 1], known->face - last.face);
      if (uint64_t{last.face} + gap >= counts.faces)
        return fail(Error::kBadAttribute, "a listed triangle refers to a face that is not there");
      t.face = last.face + gap;
      placeOnFace(faces, t);
      guess = faces.words[t.face * kFaceWords + kFaceWord];
    }
    for (uint32_t k = 0; k < 3 && t.shape == listed_shape::kAny; ++k) {
      const uint32_t from = k == 0 ? last.wedge[0] : t.wedge[0];
      const int32_t difference =
          codeSignedGolomb(io, models.list_wedge[k], static_cast<int32_t>(known->wedge[k] - from));
      t.wedge[k] = from + static_cast<uint32_t>(difference);
      if (t.wedge[k] >= counts.wedges)
        return fail(Error::kBadAttribute, "a listed triangle refers to a vertex that is not there");
    }
    if (counts.parts > 1) {
      const uint32_t distance =
          codeGolomb(io, models.list_part, (known->part + counts.parts - guess) % counts.parts);
      if (distance >= counts.parts) return fail(Error::kBadAttribute, "a triangle is in no part");
      t.part = (guess + distance) % counts.parts;
    }
    (void)list.push_back(t);  // reserved above
    if ((i & 0xff) == 0 && io.overrun())
      return fail(Error::kTruncated, "the code stream ends inside the list of triangles");
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_SURFACE_LEFTOVERS_H_
