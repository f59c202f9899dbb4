// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Proves payloads before they are stored: each is decoded and compared with the source. The proof
// takes nothing from the encoder except its claim which decoded vertex is which source vertex, and
// it verifies that claim. What was decoded lives no longer than that takes.
#ifndef MCC_GLTF_CHECK_PROVE_H_
#define MCC_GLTF_CHECK_PROVE_H_

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf/compress/compress.h"
#include "mcc/glb.h"
#include "mcc/reader.h"

namespace mcc::gltf {

/// How far a decoded value may be from its source.
struct Promise {
  enum class Kind : uint8_t { kExact, kLattice, kAngle };
  Kind kind = Kind::kExact;
  double step = 0;        ///< for kLattice: the lattice step
  double half_steps = 1;  ///< for kLattice: 1 for rounding, 2 for weights moved to a sum of one
  double origin[4] = {0, 0, 0, 0};
  double radians = 0;   ///< for kAngle
  double distance = 0;  ///< for positions: between two points; 0: none promised
};

/// Returns the largest angle, in radians, between a tangent and its coded angle around a normal on
/// an octahedral grid; octahedralBound() is that of normals.
double tangentBound(uint32_t bits, uint32_t normal_bits);

/// Finds the promise that follows from the plan and from how the payload codes the attribute. Fails
/// when the coding is coarser than planned.
/// normal_bits  the bits of the piece's NORMAL, since the angles of tangents are angles around it.
Result promiseOf(const AttributePlan& plan, const AttributeInfo& coded, uint8_t normal_bits,
                 Promise& promise);

/// Returns the largest deviation of a decoded value that the promise allows, from lattice rounding
/// and the two float32 roundings of decoding.
double latticeBound(const Promise& promise, uint32_t component, double decoded);

/// Compares decoded elements with source elements: decoded element i belongs to source_of[i]. Sets
/// promised_error, max_error and is_angle of `report`, and adds angles to `angles`.
Result compareValues(const AccessorData& source, const AccessorData& decoded,
                     std::span<const uint32_t> source_of, const AttributeFormat& format,
                     const Promise& promise, AttributeReport& report, std::vector<float>& angles);

using Triangle = std::array<uint32_t, 3>;

/// Rotates triangles to begin with their smallest vertex (or to the smallest sequence, if vertices
/// are equal) and sorts them, so that equal lists are equal multisets of oriented triangles. Vertex
/// v is replaced by source_of[v], unless that is empty.
std::vector<Triangle> canonicalTriangles(std::span<const uint32_t> indices,
                                         std::span<const uint32_t> source_of);

/// What was measured on a payload.
struct PayloadProof {
  /// Attributes of a mesh with the same name, coding and bits share a row.
  std::vector<AttributeReport> attributes;
  /// The row of each attribute of each piece, in the order of the plan.
  std::vector<size_t> rows;
  double decode_seconds = 0;
};

/// Checks of each payload that
/// - its pieces have the source's vertices in a permuted order, and its parts the same multisets of
///   triangles as the source, up to rotation;
/// - every attribute value is within the promised distance of its source; exact ones are bit-equal.
/// Sets EncodedPayload::bounds. The result does not depend on thread_count. Errors name the first
/// difference.
Result provePayloads(const Document& source, uint32_t thread_count,
                     std::vector<EncodedPayload>& payloads, std::vector<PayloadProof>& proofs);

/// Words the failure of a check, which is always an error of this program.
Result checkFailed(Result result, const std::string& where);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_CHECK_PROVE_H_
