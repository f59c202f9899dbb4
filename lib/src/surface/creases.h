// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// How sharply the faces on both sides of an edge meet; used as a context of seams. [A.7.4]
#ifndef MCC_SURFACE_CREASES_H_
#define MCC_SURFACE_CREASES_H_

#include <cstdint>

#include "base/memory.h"
#include "mesh/face_mesh.h"
#include "surface/face_pass.h"

namespace mcc {

/// Classes of the angle between two faces' normals, from 0 (flat or unknown) to 3 (sharp).
inline constexpr uint32_t kCreaseClasses = 4;
/// Where the classes begin in a face's kSeamWord; they take two bits per half-edge.
inline constexpr uint32_t kCreaseShift = 8;

inline uint32_t creaseClass(const FaceView& faces, uint32_t h) {
  return (faces.words[(h & ~7u) + kSeamWord] >> (kCreaseShift + 2 * (h & 3))) & 3;
}

/// Computes unit normals of the faces (4 floats each) from `positions` (4 floats per vertex). The
/// normal of a degenerate face is all zeros.
inline void faceNormals(const FaceView& faces, uint32_t face_count, const float* positions,
                        float* normals) {
  forFourFaces(faces, face_count, [=](const uint32_t* words, uint32_t count) {
    const FourFaces four(words, count, positions);
    const Float4 zero = allLanes(0.0f);
    const Float4 nn = dotProduct(four.normal, four.normal);
    const Float4 inverse = select(nn > zero, allLanes(1.0f) / squareRoot(nn), zero);
    Float4 rows[4] = {four.normal[0] * inverse, four.normal[1] * inverse, four.normal[2] * inverse,
                      zero};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    const size_t f = static_cast<size_t>(words - faces.words) / kFaceWords;
    for (uint32_t i = 0; i < count; ++i) storeFloat4(normals + 4 * (f + i), rows[i]);
  });
}

/// Stores the class of every half-edge in its face. `positions` as for faceNormals().
inline Status classifyCreases(const FaceView& faces, uint32_t face_count, const float* positions,
                              const Allocator& allocator) {
  Array<float> normals(allocator);
  if (!normals.resize(4 * size_t{face_count})) {
    return fail(Error::kOutOfMemory, "no memory for the seams");
  }
  faceNormals(faces, face_count, positions, normals.data());
  const Float4 zero = allLanes(0.0f);
  const Float4 one = allLanes(1.0f);
  for (uint32_t f = 0; f < face_count; ++f) {
    uint32_t* words = faces.words + size_t{f} * kFaceWords;
    const Float4 own = loadFloat4(&normals[4 * size_t{f}]);
    Float4 rows[4] = {own, own, own, zero};
    uint32_t known = 0;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t t = faces.twin(f * kFaceWords + k);
      if (t == kNone) continue;
      known |= 3u << (2 * k);
      rows[k] = loadFloat4(&normals[4 * size_t{faceOf(t)}]);
    }
    transpose(rows[0], rows[1], rows[2], rows[3]);
    const Float4 cosine =
        broadcast<0>(own) * rows[0] + broadcast<1>(own) * rows[1] + broadcast<2>(own) * rows[2];
    const Float4 crease = select(cosine < allLanes(0.99f), one, zero) +
                          select(cosine < allLanes(0.9f), one, zero) +
                          select(cosine < allLanes(0.6f), one, zero);
    const float classes = crease[0] + 4 * crease[1] + 16 * crease[2];
    words[kSeamWord] |= (static_cast<uint32_t>(static_cast<int32_t>(classes)) & known)
                        << kCreaseShift;
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_SURFACE_CREASES_H_
