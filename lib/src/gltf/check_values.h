// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_CHECK_VALUES_H_
#define MCC_GLTF_CHECK_VALUES_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gltf/plan.h"
#include "mcc/reader.h"

namespace mcc::gltf {

/// How far a decoded value may be from its source.
struct Promise {
  enum class Kind : uint8_t { kExact, kLattice, kAngle };
  Kind kind = Kind::kExact;
  double step = 0;        ///< of kLattice: the lattice step
  double half_steps = 1;  ///< of kLattice: 1 for rounding, 2 for weights moved to a sum of one
  double origin[4] = {0, 0, 0, 0};
  double radians = 0;   ///< of kAngle
  double distance = 0;  ///< of positions: between two points; 0: none promised
};

/// Largest angle, in radians, between a unit vector and the nearest point of an octahedral grid, and between a tangent
/// and its coded angle around a normal of such a grid.
double octahedralBound(uint32_t bits);
double tangentBound(uint32_t bits, uint32_t normal_bits);

/// What the plan asked for, given what the payload says it did. Fails when that is coarser.
/// normal_bits   of the NORMAL of the piece: angles of tangents are angles around it.
Result promiseOf(const AttributePlan& plan, const AttributeInfo& coded, uint8_t normal_bits,
                 Promise& promise);

/// Largest deviation of a decoded value that the promise allows, by lattice rounding and the two
/// float32 roundings of decoding.
double latticeBound(const Promise& promise, uint32_t component, double decoded);

/// Compares decoded elements with source elements: decoded i belongs to source_of[i].
/// Fills in promised_error, max_error and is_angle of `report`, adds angles to `angles`.
Result compareValues(const AccessorData& source, const AccessorData& decoded,
                     std::span<const uint32_t> source_of, const AttributeFormat& format,
                     const Promise& promise, AttributeReport& report, std::vector<float>& angles);

using Triangle = std::array<uint32_t, 3>;

/// Triangles rotated to begin with their smallest vertex (of equal ones, to the smallest sequence)
/// and sorted; equal lists are equal multisets of oriented triangles. Vertex v becomes source_of[v]
/// when that is not empty.
std::vector<Triangle> canonicalTriangles(std::span<const uint32_t> indices,
                                         std::span<const uint32_t> source_of);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_CHECK_VALUES_H_
