// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// How sharply the faces on both sides of an edge meet: a context of seams.                   [A.7.4]
#ifndef MCC_ATTRIBUTES_CREASES_H_
#define MCC_ATTRIBUTES_CREASES_H_

#include <cmath>
#include <cstdint>

#include "base/memory.h"
#include "mesh/face_mesh.h"

namespace mcc {

/// Classes of the angle between two faces' normals: 0 flat (or not known) .. 3 sharp.
inline constexpr uint32_t kCreaseClasses = 4;
inline constexpr uint32_t kCreaseShift = 8;  ///< in the kSeamWord of a face; two bits per half-edge

inline uint32_t creaseClass(const FaceView& faces, uint32_t h) {
  return (faces.words[(h & ~7u) + kSeamWord] >> (kCreaseShift + 2 * (h & 3))) & 3;
}

/// Unit normals of faces from `positions` (4 floats per vertex); all zeros for a degenerate face.
inline void faceNormals(const FaceView& faces, uint32_t face_count, const float* positions,
                        float* normals) {
  for (uint32_t f = 0; f < face_count; ++f, normals += 3) {
    const uint32_t* corner = faces.words + size_t{f} * kFaceWords;
    const float* a = positions + 4 * size_t{corner[0]};
    const float* b = positions + 4 * size_t{corner[1]};
    const float* c = positions + 4 * size_t{corner[2]};
    const float d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const float e[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const float n[3] = {d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2],
                        d[0] * e[1] - d[1] * e[0]};
    const float nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    const float inverse = nn > 0 ? 1.0f / std::sqrt(nn) : 0.0f;
    for (int s = 0; s < 3; ++s) normals[s] = n[s] * inverse;
  }
}

/// Writes the class of every half-edge into its face. `positions` as for faceNormals().
inline Status classifyCreases(const FaceView& faces, uint32_t face_count, const float* positions,
                              const Allocator& allocator) {
  Array<float> normals(allocator);
  if (!normals.resize(3 * size_t{face_count})) {
    return fail(Error::kOutOfMemory, "no memory for the seams");
  }
  faceNormals(faces, face_count, positions, normals.data());
  for (uint32_t f = 0; f < face_count; ++f) {
    const float* a = &normals[3 * size_t{f}];
    uint32_t classes = 0;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t t = faces.twin(f * kFaceWords + k);
      if (t == kNone) continue;
      const float* b = &normals[3 * size_t{faceOf(t)}];
      const float cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      const uint32_t crease =
          (cosine < 0.99f ? 1u : 0u) + (cosine < 0.9f ? 1u : 0u) + (cosine < 0.6f ? 1u : 0u);
      classes |= crease << (2 * k);
    }
    faces.words[f * kFaceWords + kSeamWord] |= classes << kCreaseShift;
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_CREASES_H_
