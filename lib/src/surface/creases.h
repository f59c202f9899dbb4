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

/// What is known of the edge that a half-edge runs along: a byte of its face's kSeamWord.
namespace seam_state {
inline constexpr uint32_t kCrease = 7;  ///< as many of these bits as the crease class says
inline constexpr uint32_t kEnd = 8;     ///< a seam ends where the half-edge begins
}  // namespace seam_state

/// Returns the states of a half-edge, below other bits.
MCC_INLINE uint32_t seamStates(const FaceView& faces, uint32_t h) {
  return faces.words[h | kSeamWord] >> (8 * (h & 3));
}
/// The class of a crease, or the sharper one of several whose states were combined by "or".
MCC_INLINE uint32_t creaseOf(uint32_t states) {
  const uint32_t bits = states & seam_state::kCrease;
  return bits - (bits >> 1) - (bits >> 2);  // their number
}
MCC_INLINE uint32_t creaseClass(const FaceView& faces, uint32_t h) {
  return creaseOf(seamStates(faces, h));
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

/// Stores the crease of every half-edge in its face. `positions` as for faceNormals().
inline Status classifyCreases(const FaceView& faces, uint32_t face_count, const float* positions,
                              const Allocator& allocator) {
  Array<float> normals(allocator);
  if (!normals.resize(4 * size_t{face_count})) {
    return fail(Error::kOutOfMemory, "no memory for the seams");
  }
  faceNormals(faces, face_count, positions, normals.data());
  const auto bitsOf = [](int32_t bit) { return Mask4{bit, bit << 8, bit << 16, 0}; };
  for (uint32_t f = 0; f < face_count; ++f) {
    uint32_t* words = faces.words + size_t{f} * kFaceWords;
    const Float4 own = loadFloat4(&normals[4 * size_t{f}]);
    Float4 rows[4] = {own, own, own, own};
    uint32_t known = 0;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t t = faces.twin(f * kFaceWords + k);
      if (t == kNone) continue;
      known |= seam_state::kCrease << (8 * k);
      rows[k] = loadFloat4(&normals[4 * size_t{faceOf(t)}]);
    }
    transpose(rows[0], rows[1], rows[2], rows[3]);
    const Float4 cosine =
        broadcast<0>(own) * rows[0] + broadcast<1>(own) * rows[1] + broadcast<2>(own) * rows[2];
    const Mask4 creases = ((cosine < allLanes(0.99f)) & bitsOf(1)) |
                          ((cosine < allLanes(0.9f)) & bitsOf(2)) |
                          ((cosine < allLanes(0.6f)) & bitsOf(4));
    words[kSeamWord] |= static_cast<uint32_t>(creases[0] | creases[1] | creases[2]) & known;
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_SURFACE_CREASES_H_
