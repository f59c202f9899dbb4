// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the deltas of a morph target make of the mesh, for those predicted from it.           [B.8]
#ifndef MCC_ATTRIBUTES_MOVED_H_
#define MCC_ATTRIBUTES_MOVED_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "attributes/normals.h"
#include "attributes/unit_deltas.h"
#include "attributes/wedges.h"
#include "base/memory.h"

namespace mcc {

/// A decoded delta as a float; what is not finite counts as 0.
inline float deltaValue(const AttributeInfo& info, int32_t value) {
  return info.coding == AttributeCoding::kLattice ? latticeValue(value, info.lattice.step, 0.0f)
                                                  : static_cast<float>(finiteValue(value));
}

struct MovedVectors {
  explicit MovedVectors(const Allocator& allocator)
      : positions(allocator),
        normals(allocator),
        tangents(allocator),
        bends(allocator),
        ordered_(allocator),
        rest_(allocator),
        sums_(allocator),
        smooth_first_(allocator) {}

  Array<float> positions;  ///< of the last target: 4 per wedge, see wedges.h
  Array<float> normals;    ///< of the last target: 3 per wedge, of length 1 or 0
  Array<float> tangents;   ///< of the mesh: 3 per wedge
  Array<int32_t> bends;    ///< of the last target: 3 per wedge, see unit_deltas.h

  /// `from`: 3 finite floats per wedge; `deltas` of 3 components.
  Status keepPositions(uint32_t count, const float* from, const AttributeInfo& info,
                       const int32_t* deltas) {
    if (!ordered_.resize(3 * size_t{count})) return noMemory();
    for (size_t i = 0; i < ordered_.size(); ++i)
      ordered_[i] = orderedFromFloat(from[i] + deltaValue(info, deltas[i]));
    return floatPredictionPositions(
        count, [this](uint32_t w) { return &ordered_[3 * size_t{w}]; }, positions);
  }

  /// `from`: 3 finite floats per wedge; `deltas` of 3 components.
  Status keepNormals(uint32_t count, const float* from, const AttributeInfo& info,
                     const int32_t* deltas) {
    if (!normals.resize(3 * size_t{count})) return noMemory();
    for (size_t w = 0; w < count; ++w) {
      double moved[3];
      for (size_t s = 0; s < 3; ++s) {
        moved[s] = static_cast<double>(from[3 * w + s]) +
                   static_cast<double>(deltaValue(info, deltas[3 * w + s]));
      }
      makeUnit(moved);
      for (size_t s = 0; s < 3; ++s) normals[3 * w + s] = static_cast<float>(moved[s]);
    }
    return {};
  }

  /// How far, in steps, the target's positions turn the normals of the faces around every wedge and those with its normal.
  /// `rest`: positions of the mesh; `unit_normals`: 3 per wedge, or null. [B.8.1]
  Status findBends(const WedgeMesh& wedges, const float* rest, const float* unit_normals,
                   NormalWeight weight, double step) {
    MCC_TRY(findSmooth(wedges, unit_normals));
    if (rest_.empty()) MCC_TRY(findDirections(wedges, rest, weight, rest_));
    MCC_TRY(findDirections(wedges, positions.data(), weight, sums_));
    if (!bends.resize(3 * size_t{wedges.count})) return noMemory();
    for (size_t w = 0; w < wedges.count; ++w) {
      for (size_t s = 0; s < 3; ++s) {
        const double turned =
            static_cast<double>(sums_[4 * w + s]) - static_cast<double>(rest_[4 * w + s]);
        bends[3 * w + s] = nearestInteger(turned / step);
      }
    }
    return {};
  }

 private:
  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for morph targets"); }

  /// The first wedge of the vertex that has the same normal.
  Status findSmooth(const WedgeMesh& wedges, const float* unit_normals) {
    if (!smooth_first_.empty()) return {};
    if (!smooth_first_.resize(wedges.count)) return noMemory();
    const auto isEqual = [=](uint32_t a, uint32_t b) {
      return unit_normals != nullptr &&
             std::memcmp(unit_normals + 3 * size_t{a}, unit_normals + 3 * size_t{b}, 12) == 0;
    };
    uint32_t vertex_first = 0;
    for (uint32_t w = 0; w < wedges.count; ++w) {
      smooth_first_[w] = w;
      if (!wedges.continuesVertex(w)) {
        vertex_first = w;
      } else if (isEqual(w - 1, w)) {
        smooth_first_[w] = smooth_first_[w - 1];
      } else if (isEqual(vertex_first, w)) {
        smooth_first_[w] = vertex_first;
      }
    }
    return {};
  }

  /// Vectors of length 1, or 0, in the first three of 4 floats per wedge.
  Status findDirections(const WedgeMesh& wedges, const float* from, NormalWeight weight,
                        Array<float>& to) {
    if (!to.assign(4 * size_t{wedges.count}, 0.0f)) return noMemory();
    addFaceNormals(weight, wedges, from, to.data());
    for (uint32_t w = 0; w < wedges.count; ++w) {
      const uint32_t first = smooth_first_[w];
      if (first == w) continue;
      storeFloat4(&to[4 * size_t{first}],
                  loadFloat4(&to[4 * size_t{first}]) + loadFloat4(&to[4 * size_t{w}]));
    }
    for (uint32_t w = 0; w < wedges.count; ++w) {
      float* v = &to[4 * size_t{w}];
      if (smooth_first_[w] != w) {
        std::copy_n(&to[4 * size_t{smooth_first_[w]}], 4, v);
        continue;
      }
      const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      const bool has_direction = length > kShortest && length < 1e30f;
      for (int s = 0; s < 3; ++s) v[s] = has_direction ? v[s] / length : 0.0f;
    }
    return {};
  }

  Array<int32_t> ordered_;
  Array<float> rest_;
  Array<float> sums_;
  Array<uint32_t> smooth_first_;
};

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_MOVED_H_
