// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Triangles beside the surface: exact duplicates of faces, degenerate triangles, and the parts all belong to.   [A.9]
#ifndef MCC_ATTRIBUTES_LEFTOVERS_H_
#define MCC_ATTRIBUTES_LEFTOVERS_H_

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
  BitModel duplicate[4][4]
                    [2];  ///< [earlier neighbours][how many of them are duplicates][previous face]
  BitModel more_duplicates;
  GolombModel list_wedge[3];
};

struct ListedTriangle {
  uint32_t wedge[3];
  uint32_t part;
};

/// Encoder's knowledge; null when decoding.
struct LeftoverTruth {
  const uint32_t* part_of_face = nullptr;
  const uint32_t* duplicates_of_face = nullptr;
  const ListedTriangle* list = nullptr;
};

/// Part of each face into its kFaceWord. Predicted from the neighbour behind half-edge 1 (decoded before), else from the
/// face before.                                                                              [A.9.1]
template <class Io>
Status codeParts(Io& io, LeftoverModels& models, const FaceView& faces, uint32_t face_count,
                 uint32_t part_count, const LeftoverTruth& truth) {
  if (part_count < 2) return {};
  uint32_t previous = 0;
  for (uint32_t f = 0; f < face_count; ++f) {
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

/// Number of further copies of each face. [A.9.2]
template <class Io>
Status codeDuplicates(Io& io, LeftoverModels& models, const FaceView& faces, uint32_t face_count,
                      uint32_t limit, const LeftoverTruth& truth, Array<uint32_t>& copies) {
  if (!copies.resize(face_count)) return fail(Error::kOutOfMemory, "no memory for duplicates");
  uint32_t total = 0;
  uint32_t previous = 0;
  for (uint32_t f = 0; f < face_count; ++f) {
    uint32_t earlier = 0;
    uint32_t duplicated = 0;
    for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
      const uint32_t t = faces.twin(h);
      if (t == kNone || faceOf(t) >= f) continue;
      ++earlier;
      duplicated += copies[faceOf(t)] != 0 ? 1 : 0;
    }
    uint32_t target = 0;
    if constexpr (Io::kEncoding) target = truth.duplicates_of_face[f];
    uint32_t count = io.bit(models.duplicate[earlier][duplicated][previous], target != 0) ? 1 : 0;
    while (count != 0 && total + count < limit && io.bit(models.more_duplicates, target > count))
      ++count;
    copies[f] = count;
    total += count;
    previous = count != 0 ? 1 : 0;
    if (total > limit || ((f & 0xfff) == 0 && io.overrun())) {
      return fail(Error::kBadAttribute, "more duplicate triangles than the header claims");
    }
  }
  if (total != limit)
    return fail(Error::kBadAttribute, "fewer duplicate triangles than the header claims");
  return {};
}

/// Triangles one by one: first corner against the last triangle's, the others against the first. [A.9.4]
template <class Io>
Status codeList(Io& io, LeftoverModels& models, uint32_t wedge_count, uint32_t part_count,
                uint32_t count, const LeftoverTruth& truth, Array<ListedTriangle>& list) {
  if (!list.reserve(count)) return fail(Error::kOutOfMemory, "no memory for listed triangles");
  uint32_t last = 0;
  for (uint32_t i = 0; i < count; ++i) {
    ListedTriangle t{};
    if constexpr (Io::kEncoding) t = truth.list[i];
    for (int k = 0; k < 3; ++k) {
      const uint32_t from = k == 0 ? last : t.wedge[0];
      const int32_t difference =
          codeSignedGolomb(io, models.list_wedge[k], static_cast<int32_t>(t.wedge[k] - from));
      t.wedge[k] = from + static_cast<uint32_t>(difference);
      if (t.wedge[k] >= wedge_count) {
        return fail(Error::kBadAttribute, "a listed triangle refers to a vertex that is not there");
      }
    }
    if (part_count > 1) t.part = codeGolomb(io, models.part, t.part);
    if (t.part >= part_count) return fail(Error::kBadAttribute, "a triangle is in no part");
    last = t.wedge[0];
    if (!list.push_back(t)) return fail(Error::kOutOfMemory, "no memory for listed triangles");
    if ((i & 0xff) == 0 && io.overrun()) {
      return fail(Error::kTruncated, "the code stream ends inside the list of triangles");
    }
  }
  return {};
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_LEFTOVERS_H_
