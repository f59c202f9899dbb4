// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TESTS_ROBUSTNESS_FACE_CHECK_H_
#define MCC_TESTS_ROBUSTNESS_FACE_CHECK_H_

#include <cstdint>
#include <string>

#include "mesh/face_mesh.h"

namespace mcc::test {

/// Checks what is promised of the faces of every code, even of one that no writer makes.
inline std::string checkFaces(const uint32_t* words, uint32_t face_count, uint32_t vertex_count) {
  const uint32_t end = face_count * kFaceWords;
  for (uint32_t f = 0; f < face_count; ++f) {
    for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
      if (words[h] >= vertex_count) return "a corner has no vertex";
      const uint32_t t = words[h + 4];
      if (t == kNone) continue;
      if (t >= end || t % kFaceWords > 2) return "a twin is no half-edge";
      if (words[t + 4] != h) return "a twin is not mutual";
      if (words[t] != words[nextHalfEdge(h)] || words[nextHalfEdge(t)] != words[h])
        return "twins have other ends";
    }
  }
  return "";
}

}  // namespace mcc::test

#endif  // MCC_TESTS_ROBUSTNESS_FACE_CHECK_H_
