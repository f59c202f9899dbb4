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
  BitModel degenerate[2][3][2][2][2];  ///< see EdgeDegenerateCoder
  BitModel more_degenerates;
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
  const uint32_t* degenerates_of_edge = nullptr;  ///< two counts per half-edge 3f+k
  const uint32_t* degenerate_parts = nullptr;     ///< in coding order
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

/// Triangles (a, a, b) whose wedges a and b are the ends of a face's edge: two counts per edge, for (a, a, b) and
/// (b, b, a). An edge is asked at its first half-edge, and at the second one, too, if the wedges differ there. [A.9.3]
template <class Io>
class EdgeDegenerateCoder {
 public:
  EdgeDegenerateCoder(Io& io, LeftoverModels& models, const FaceView& faces, uint32_t face_count,
                      const Allocator& allocator, const LeftoverTruth& truth)
      : io_(io),
        models_(models),
        faces_(faces),
        face_count_(face_count),
        truth_(truth),
        roles_(allocator) {}

  /// Appends `limit` triangles to `list`.
  Status run(uint32_t wedge_count, uint32_t part_count, uint32_t limit,
             Array<ListedTriangle>& list) {
    if (!roles_.assign(wedge_count, Roles{}) || !list.reserve(list.size() + limit))
      return noMemory();
    uint32_t total = 0;
    for (uint32_t f = 0; f < face_count_; ++f) {
      for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t h = f * kFaceWords + k;
        if (!asksAt(faces_, h)) continue;
        const uint32_t* of_edge =
            Io::kEncoding ? truth_.degenerates_of_edge + 2 * (3 * size_t{f} + k) : nullptr;
        uint32_t first = 0;
        for (uint32_t side = 0; side < 2; ++side) {
          const uint32_t a = faces_.vertex(side == 0 ? h : nextHalfEdge(h));
          const uint32_t b = faces_.vertex(side == 0 ? nextHalfEdge(h) : h);
          const uint32_t count =
              codeCount(side, a, b, first, Io::kEncoding ? of_edge[side] : 0, limit - total);
          total += count;
          if (count > limit || total > limit) return tooMany();
          for (uint32_t i = 0; i < count; ++i) {
            if (!list.push_back({{a, a, b}, faces_.words[f * kFaceWords + kFaceWord]}))
              return noMemory();
          }
          first = count != 0 ? 1 : 0;
        }
      }
      if ((f & 0xfff) == 0 && io_.overrun()) return tooMany();
    }
    if (total != limit)
      return fail(Error::kBadAttribute, "fewer degenerate triangles than the header claims");
    return codePartsOf(part_count, limit, list);
  }

  static bool asksAt(const FaceView& faces, uint32_t h) {
    const uint32_t t = faces.twin(h);
    return t == kNone || t > h || faces.vertex(t) != faces.vertex(nextHalfEdge(h)) ||
           faces.vertex(nextHalfEdge(t)) != faces.vertex(h);
  }

 private:
  /// What a wedge has been in degenerate triangles so far, saturating.
  struct Roles {
    uint8_t doubled = 0;
    uint8_t single = 0;
  };

  static Status noMemory() {
    return fail(Error::kOutOfMemory, "no memory for degenerate triangles");
  }
  static Status tooMany() {
    return fail(Error::kBadAttribute, "more degenerate triangles than the header claims");
  }

  uint32_t codeCount(uint32_t side, uint32_t a, uint32_t b, uint32_t first, uint32_t truth,
                     uint32_t left) {
    BitModel& model =
        models_.degenerate[side][roles_[a].doubled][roles_[b].single][roles_[a].single][first];
    uint32_t count = io_.bit(model, truth != 0) ? 1 : 0;
    while (count != 0 && count < left && io_.bit(models_.more_degenerates, truth > count)) ++count;
    if (count != 0) {
      roles_[a].doubled = static_cast<uint8_t>(std::min(2, roles_[a].doubled + 1));
      roles_[b].single = 1;
    }
    return count;
  }

  /// The part is mostly that of the face.
  Status codePartsOf(uint32_t part_count, uint32_t limit, Array<ListedTriangle>& list) {
    for (size_t i = list.size() - limit; part_count > 1 && i < list.size(); ++i) {
      uint32_t part = 0;
      if constexpr (Io::kEncoding) part = truth_.degenerate_parts[i - (list.size() - limit)];
      const uint32_t guess = list[i].part;
      const uint32_t distance = codeGolomb(
          io_, models_.part, Io::kEncoding ? (part + part_count - guess) % part_count : 0);
      if (distance >= part_count) return fail(Error::kBadAttribute, "a triangle is in no part");
      list[i].part = (guess + distance) % part_count;
    }
    return {};
  }

  Io& io_;
  LeftoverModels& models_;
  const FaceView faces_;
  const uint32_t face_count_;
  const LeftoverTruth& truth_;
  Array<Roles> roles_;
};

/// Triangles one by one: first corner against the last triangle's, the others against the first. [A.9.4]
template <class Io>
Status codeList(Io& io, LeftoverModels& models, uint32_t wedge_count, uint32_t part_count,
                uint32_t count, const LeftoverTruth& truth, Array<ListedTriangle>& list) {
  if (!list.reserve(list.size() + size_t{count}))
    return fail(Error::kOutOfMemory, "no memory for listed triangles");
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
