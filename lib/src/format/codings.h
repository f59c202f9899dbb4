// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// How an attribute's values become integers, and the numbers that the codings share with the
// header. [A.2.4]
#ifndef MCC_FORMAT_CODINGS_H_
#define MCC_FORMAT_CODINGS_H_

#include <cstdint>
#include <iterator>

#include "format/decodes.h"
#include "mcc/reader.h"

namespace mcc {

inline constexpr uint32_t kMaxLatticeBits = 24;
inline constexpr uint32_t kMaxLatticeComponents = 4;
inline constexpr uint32_t kMinUnitBits = 2;  ///< of octahedral coordinates and tangents' angles
inline constexpr uint32_t kMaxUnitBits = 16;

/// AttributeInfo::grid: values below kGridBinary mean 10^grid steps per unit, all others steps of
/// 2^(grid - kGridBinary - 149).
inline constexpr uint32_t kGridBinary = 10;
inline constexpr int32_t kSmallestExponent = -149;  ///< the smallest exponent of float32
inline constexpr int32_t kGridExponents = 246;      ///< up to 2^96, so that no integer overflows
inline constexpr uint32_t kGridCount = kGridBinary + kGridExponents;
static_assert(kGridCount == 256);  // the header has one byte for it
inline constexpr uint32_t kGridComponents = 4;
inline constexpr uint32_t kGridBits = 26;  ///< bits of a grid's integers, without their sign

/// AttributeInfo::tails: how the bits below the step are coded.
enum class GridTails : uint8_t {
  kNoTails = 0,
  kPlain = 1,
  kCached = 2,  ///< from a cache, because the tails of equal integers tend to be equal
};

constexpr bool isBinaryGrid(uint32_t grid) { return grid >= kGridBinary; }

struct CodingInfo {
  AttributeCoding coding;
  const char* name;      ///< in the specification and in the conformance suite
  const char* word;      ///< of `inspect`
  const char* sections;  ///< sections of the specification
  bool has_bits;         ///< the header states a number of bits, which `inspect` shows
  bool is_decoded;       ///< otherwise this decoder, which is the core alone, refuses the coding
};

/// The codings, in the order of AttributeCoding.
inline constexpr CodingInfo kCodings[] = {
    {AttributeCoding::kLattice, "lattice", "lattice", "A.2.4 A.10.18", true, true},
    {AttributeCoding::kInteger, "integer", "integer", "A.2.4 A.10.18", false, true},
    {AttributeCoding::kExactFloat, "exact float", "exact float", "A.2.4 A.10.18", false,
     decodes::kExactFloats},
    {AttributeCoding::kOctahedral, "octahedral", "octahedral", "A.2.4 A.10.6", true, true},
    {AttributeCoding::kTangentAngle, "tangent angle", "angle", "A.2.4 A.10.12", true,
     decodes::kTangents},
    {AttributeCoding::kAlias, "alias", "alias", "A.2.4", false, true},
    {AttributeCoding::kGrid, "grid", "exact grid", "A.2.4 A.10.5", false, decodes::kExactFloats},
};

constexpr const CodingInfo& infoOf(AttributeCoding coding) {
  return kCodings[static_cast<size_t>(coding)];
}

inline constexpr uint32_t kDecodedCodings = decodedMask(kCodings);

constexpr bool isDecoded(AttributeCoding coding) {
  return kWhole || (kDecodedCodings >> static_cast<uint32_t>(coding) & 1) != 0;
}

/// Whether all bits of a float are kept.
constexpr bool isExact(AttributeCoding coding) {
  return coding == AttributeCoding::kExactFloat || coding == AttributeCoding::kGrid;
}

}  // namespace mcc

#endif  // MCC_FORMAT_CODINGS_H_
