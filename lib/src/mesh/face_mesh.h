// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The decoded mesh: one flat array of face records, made by the connectivity stage and used by all
// others.                                                                                  [A.1.5]
//
//                 c2                     half-edge 8f+k runs from corner k to corner k+1 of face f;
//                /  \                    word 8f+k      vertex of corner k
//          h2   /    \  h1               word 8f+3      spare, for the stage at work (kFaceWord)
//              /      \                  word 8f+4+k    twin of half-edge 8f+k, kNone on a boundary
//            c0 ------ c1                word 8f+7      seam states (kSeamWord)
//                 h0
//
// Both halves of a record share a cache line, and the half-edge is the index for both look-ups.
#ifndef MCC_MESH_FACE_MESH_H_
#define MCC_MESH_FACE_MESH_H_

#include <cstdint>

#include "base/host.h"
#include "base/memory.h"
#include "mcc/types.h"

namespace mcc {

inline constexpr uint32_t kFaceWords = 8;
inline constexpr uint32_t kFaceWord = 3;
inline constexpr uint32_t kSeamWord = 7;
inline constexpr uint32_t kMaxVertices = 1u << 28;

// The next and the previous half-edge in a face: -3 after corner 2, +3 before corner 0. They have
// no branches, because those could not be predicted.
MCC_INLINE constexpr uint32_t nextHalfEdge(uint32_t h) { return h + 1 - (h & 2) - ((h & 2) >> 1); }
MCC_INLINE constexpr uint32_t prevHalfEdge(uint32_t h) { return h - 1 + (((h & 3) - 1) >> 30); }
constexpr uint32_t faceOf(uint32_t h) { return h / kFaceWords; }

/// Read access by half-edge; `words` has kFaceWords per face.
struct FaceView {
  uint32_t* words;

  MCC_INLINE uint32_t vertex(uint32_t h) const { return words[h]; }
  MCC_INLINE uint32_t twin(uint32_t h) const { return words[h + 4]; }
  /// The next half-edge leaving the same vertex, counterclockwise; kNone at a boundary.
  MCC_INLINE uint32_t rotateCcw(uint32_t h) const { return twin(prevHalfEdge(h)); }
  /// The next half-edge leaving the same vertex, clockwise; kNone at a boundary.
  MCC_INLINE uint32_t rotateCw(uint32_t h) const {
    const uint32_t t = twin(h);
    return t == kNone ? kNone : nextHalfEdge(t);
  }
};

struct FaceMesh {
  explicit FaceMesh(const Allocator& allocator) : words(allocator) {}

  Array<uint32_t> words;  ///< kFaceWords * face_count
  uint32_t face_count = 0;
  uint32_t vertex_count = 0;

  FaceView view() { return FaceView{words.data()}; }
  /// The stages take their work space from this allocator too.
  const Allocator& allocator() const { return words.allocator(); }
};

}  // namespace mcc

#endif  // MCC_MESH_FACE_MESH_H_
