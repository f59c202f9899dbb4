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

/// Returns the largest angle, in radians, between a tangent and its coded angle around a normal on
/// an octahedral grid; octahedralBound() is that of normals.
double tangentBound(uint32_t bits, uint32_t normal_bits);

/// Compares decoded elements of an attribute with source elements, bit for bit: decoded element i
/// belongs to source_of[i].
Result compareExact(const AccessorData& source, const AccessorData& decoded,
                    std::span<const uint32_t> source_of, const std::string& label);

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
