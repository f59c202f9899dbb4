// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which coder an attribute goes through, and the bits of its header byte `predictor`.        [A.2.4, A.8]
#ifndef MCC_MESH_ATTRIBUTE_METHOD_H_
#define MCC_MESH_ATTRIBUTE_METHOD_H_

#include <cstdint>

#include "base/decodes.h"
#include "mcc/reader.h"

namespace mcc {

/// AttributeInfo::grid: below kGridFraction 10^grid steps per unit, below kGridFractionEnd 2^(grid - 8) - 1 steps (what
/// integers of 2..16 bits count for as fractions), from kGridBinary steps of 2^(grid - kGridBinary - 149).
inline constexpr uint32_t kGridFraction = 10;
inline constexpr uint32_t kGridFractionEnd = 25;
inline constexpr uint32_t kGridBinary = 32;
inline constexpr int32_t kSmallestExponent = -149;  ///< of float32
inline constexpr int32_t kGridExponents = 246;      ///< up to 2^96: no integer overflows
inline constexpr uint32_t kGridCount = kGridBinary + kGridExponents;
inline constexpr uint32_t kGridComponents = 4;
inline constexpr uint32_t kGridBits = 26;  ///< of a grid's integers, without their sign

/// AttributeInfo::tails: how the bits below the step are coded.
enum class GridTails : uint8_t {
  kNoTails = 0,
  kPlain = 1,
  kCached = 2,  ///< those of equal integers tend to be equal
};

constexpr bool isBinaryGrid(uint32_t grid) { return grid >= kGridBinary; }
constexpr bool isKnownGrid(uint32_t grid) {
  return grid < kGridFractionEnd || (isBinaryGrid(grid) && grid < kGridCount);
}

/// The coder follows from what the header says; there is no field for it.
enum class AttributeMethod : uint8_t {
  kValues,        ///< attributes/values.h
  kNormal,        ///< attributes/normals.h
  kTexcoord,      ///< attributes/texcoords.h
  kTangent,       ///< attributes/tangents.h
  kTangentPoint,  ///< attributes/tangent_points.h
  kSkin,          ///< attributes/skin.h: JOINTS_n with its WEIGHTS_n
  kExactNormal,   ///< attributes/exact_normals.h
  kExactTangent,  ///< attributes/exact_tangents.h
  kExactValues,   ///< attributes/exact_values.h
  kWithAnother,   ///< coded with another attribute: WEIGHTS_n with its JOINTS_n, aliases
};

/// The attribute of a piece that gives tangents their plane: the first NORMAL on the octahedral grid; or kNone.
constexpr uint32_t normalOfTangents(const AttributeInfo* attributes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    const AttributeInfo& a = attributes[i];
    if (a.coding == AttributeCoding::kOctahedral && a.format.semantic != Semantic::kTangent &&
        a.format.morph_target == 0) {
      return i;
    }
  }
  return kNone;
}

/// The attribute of a piece that exact tangents are perpendicular to: the first NORMAL with exact floats; or kNone.
constexpr uint32_t exactNormalOf(const AttributeInfo* attributes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    const AttributeInfo& a = attributes[i];
    if (a.format.semantic == Semantic::kNormal && a.format.morph_target == 0 &&
        a.format.component_count == 3 &&
        (a.coding == AttributeCoding::kExactFloat || a.coding == AttributeCoding::kGrid)) {
      return i;
    }
  }
  return kNone;
}

/// Whether tangents on a grid have normals to be perpendicular to: exact ones, or else octahedral ones.
constexpr bool hasNormals(const AttributeInfo* attributes, uint32_t count) {
  return exactNormalOf(attributes, count) != kNone || normalOfTangents(attributes, count) != kNone;
}

/// The attribute of a piece that deltas of tangents move: the first TANGENT of unit vectors; or kNone.
constexpr uint32_t baseTangentOf(const AttributeInfo* attributes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    const AttributeInfo& a = attributes[i];
    if (a.format.semantic == Semantic::kTangent && a.format.morph_target == 0 &&
        a.format.component_count == 4 && a.coding != AttributeCoding::kLattice &&
        a.coding != AttributeCoding::kInteger && a.coding != AttributeCoding::kAlias) {
      return i;
    }
  }
  return kNone;
}

/// Deltas of a semantic in the morph target of attribute `index`, if they are the last ones before it; or kNone.
constexpr uint32_t deltasBefore(const AttributeInfo* attributes, uint32_t index,
                                Semantic semantic) {
  for (uint32_t i = index; i-- != 0;) {
    const AttributeFormat& f = attributes[i].format;
    if (f.semantic != semantic || f.morph_target == 0) continue;
    return f.morph_target == attributes[index].format.morph_target ? i : kNone;
  }
  return kNone;
}

/// Whether deltas are three floats that others can be predicted from.
constexpr bool areVectors(const AttributeInfo& a) {
  return a.format.component_count == 3 &&
         (a.coding == AttributeCoding::kLattice || a.coding == AttributeCoding::kExactFloat ||
          a.coding == AttributeCoding::kGrid);
}

/// The attribute of a piece that gives tangents their direction: the first TEXCOORD; or kNone.
constexpr uint32_t chartOfTangents(const AttributeInfo* attributes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    const AttributeFormat& f = attributes[i].format;
    if (attributes[i].coding == AttributeCoding::kAlias) continue;
    if (f.semantic == Semantic::kTexcoord && f.morph_target == 0 && f.component_count == 2)
      return i;
  }
  return kNone;
}

/// Attributes are coded in the order of their phases, within a phase in that of the header. [A.8.1]
inline constexpr uint32_t kCodingPhases = 3;
constexpr uint32_t codingPhase(const AttributeInfo& a) {
  if (a.format.morph_target != 0) return 2;                // behind what is moved
  return a.format.semantic == Semantic::kTangent ? 1 : 0;  // behind normals and charts
}

/// JOINTS_n and WEIGHTS_n of four components are coded as one: the other attribute of the pair, or kNone.
constexpr uint32_t skinPartner(const AttributeInfo* attributes, uint32_t count, uint32_t index) {
  const auto isHalf = [](const AttributeInfo& a) {
    return a.format.morph_target == 0 && a.format.component_count == 4 &&
           (a.format.semantic == Semantic::kJoints
                ? a.coding == AttributeCoding::kInteger
                : a.format.semantic == Semantic::kWeights &&
                      (a.coding <= AttributeCoding::kExactFloat ||
                       a.coding == AttributeCoding::kGrid));
  };
  const auto firstOf = [=](Semantic semantic, uint8_t set) {
    for (uint32_t i = 1; i < count; ++i) {
      const AttributeFormat& f = attributes[i].format;
      if (f.semantic == semantic && f.set_index == set && isHalf(attributes[i])) return i;
    }
    return kNone;
  };
  const AttributeFormat& f = attributes[index].format;
  if (!isHalf(attributes[index]) || firstOf(f.semantic, f.set_index) != index) return kNone;
  const bool is_joints = f.semantic == Semantic::kJoints;
  return firstOf(is_joints ? Semantic::kWeights : Semantic::kJoints, f.set_index);
}

constexpr AttributeMethod methodOf(const AttributeInfo* attributes, uint32_t count,
                                   uint32_t index) {
  const AttributeInfo& a = attributes[index];
  switch (a.coding) {
    case AttributeCoding::kOctahedral:
      return decodes::kTangentPoints && a.format.semantic == Semantic::kTangent
                 ? AttributeMethod::kTangentPoint
                 : AttributeMethod::kNormal;
    case AttributeCoding::kTangentAngle: return AttributeMethod::kTangent;
    case AttributeCoding::kAlias: return AttributeMethod::kWithAnother;
    default: break;
  }
  if (skinPartner(attributes, count, index) != kNone) {
    const bool is_joints = a.format.semantic == Semantic::kJoints;
    return is_joints ? AttributeMethod::kSkin : AttributeMethod::kWithAnother;
  }
  if (a.format.semantic == Semantic::kTexcoord && a.format.morph_target == 0 &&
      a.format.component_count == 2 && a.coding != AttributeCoding::kExactFloat) {
    return AttributeMethod::kTexcoord;
  }
  if (!decodes::kExactFloats) return AttributeMethod::kValues;
  if (a.coding == AttributeCoding::kExactFloat && a.format.semantic == Semantic::kNormal &&
      a.format.morph_target == 0 && a.format.component_count == 3) {
    return AttributeMethod::kExactNormal;
  }
  if (a.coding == AttributeCoding::kExactFloat && a.format.semantic == Semantic::kTangent &&
      a.format.morph_target == 0 && a.format.component_count == 4) {
    return AttributeMethod::kExactTangent;
  }
  if (a.coding == AttributeCoding::kExactFloat && a.format.morph_target == 0 &&
      a.format.component_count <= 4) {
    return AttributeMethod::kExactValues;
  }
  return AttributeMethod::kValues;
}

/// Bits of `predictor` of every method: consecutive wedges of a vertex may share a value.
inline constexpr uint8_t kHasEqualities = 0x80;

/// AttributeInfo::predictor of a position: what its coder does. What is off costs the coder nothing. [A.6.2]
namespace position_mode {
inline constexpr uint8_t kWeights = 1u << 0;  ///< of features, from the payload
inline constexpr uint8_t kSelect = 1u << 1;   ///< classes of tip selection; needs kWeights
inline constexpr uint8_t kShear = 1u << 2;    ///< of shear, palette and planes there is one at most
inline constexpr uint8_t kPalette = 1u << 3;
inline constexpr uint8_t kPlanes = 1u << 4;  ///< without the following
inline constexpr uint8_t kFold = 1u << 5;
inline constexpr uint8_t kOwnScale = 1u << 6;
inline constexpr uint8_t kSplit = 1u << 7;
inline constexpr uint8_t kKinds = kShear | kPalette | kPlanes;
inline constexpr uint8_t kDecoded = static_cast<uint8_t>(~(decodes::kPlanes ? 0 : kPlanes));
inline constexpr uint8_t kMaxBitsOfPlanes = 17;  ///< of the lattice

constexpr bool areKnown(uint32_t modes) {
  const uint32_t kinds = modes & kKinds;
  if ((kinds & (kinds - 1)) != 0) return false;
  if ((modes & kSelect) != 0 && (modes & kWeights) == 0) return false;
  return kinds != kPlanes || (modes & ~uint32_t{kWeights | kSelect | kPlanes}) == 0;
}
}  // namespace position_mode

namespace normal_method {
inline constexpr uint8_t kWeightMask = 0x03;  ///< NormalWeight
inline constexpr uint8_t kBlendShift = 2;     ///< 0 none, 1 half, 2 whole
inline constexpr uint8_t kBlendMask = 0x0c;
inline constexpr uint8_t kAll = kWeightMask | kBlendMask;
inline constexpr uint8_t kWeightCount = 3;
}  // namespace normal_method

namespace tangent_point_method {
inline constexpr uint8_t kPerpendicular = 0x01;  ///< to the normals, see hasNormals()
}  // namespace tangent_point_method

namespace exact_normal_method {
inline constexpr uint8_t kWeightMask = 0x03;  ///< ExactWeight
inline constexpr uint8_t kBlendShift = 2;     ///< 0 none, 1 half, 2 whole
inline constexpr uint8_t kBlendMask = 0x0c;
inline constexpr uint8_t kRemembers = 0x10;       ///< by predictions
inline constexpr uint8_t kRemembersEdges = 0x20;  ///< by the vectors of neighbours
inline constexpr uint8_t kAll = kWeightMask | kBlendMask | kRemembers | kRemembersEdges;
}  // namespace exact_normal_method

namespace exact_tangent_method {
inline constexpr uint8_t kWeightMask = 0x03;  ///< TangentWeight
inline constexpr uint8_t kPerpendicular = 0x04;
inline constexpr uint8_t kRemembers = 0x08;
inline constexpr uint8_t kAll = kWeightMask | kPerpendicular | kRemembers;
}  // namespace exact_tangent_method

namespace exact_value_method {
inline constexpr uint8_t kPredictorMask = 0x03;  ///< ExactPredictor
inline constexpr uint8_t kPredictorCount = 3;
inline constexpr uint8_t kRemembers = 0x04;
inline constexpr uint8_t kAll = kPredictorMask | kRemembers;
}  // namespace exact_value_method

namespace texcoord_method {
inline constexpr uint8_t kPredictorMask = 0x07;  ///< TexcoordPredictor
inline constexpr uint8_t kPredictorCount = 5;
inline constexpr uint8_t kRepeats = 0x08;
inline constexpr uint8_t kAll = kPredictorMask | kRepeats;
}  // namespace texcoord_method

namespace value_method {
inline constexpr uint8_t kPredictorMask = 0x03;  ///< ValuePredictor
inline constexpr uint8_t kSameFlags = 0x04;
inline constexpr uint8_t kZeroFlags = 0x08;
inline constexpr uint8_t kSmallTokens = 0x10;
inline constexpr uint8_t kIds =
    0x20;  ///< of one component of the mesh itself, see attributes/ids.h
inline constexpr uint8_t kBends = 0x20;          ///< of deltas, see attributes/unit_deltas.h
inline constexpr uint8_t kUnits = 0x40;          ///< of deltas, the same
inline constexpr uint8_t kBlend = 3;             ///< ValuePredictor::kBlend
inline constexpr uint32_t kBlendComponents = 4;  ///< that it can have
}  // namespace value_method

namespace skin_method {
inline constexpr uint8_t kIdleJoints =
    0x01;  ///< of JOINTS: slots of weight 0 may have any joint, else 0
inline constexpr uint8_t kAscending =
    0x02;  ///< of JOINTS: those with weight ascend from slot to slot
inline constexpr uint8_t kUnitSum = 0x01;   ///< of WEIGHTS: every tuple sums to unitSum()
inline constexpr uint8_t kUsualSum = 0x02;  ///< of WEIGHTS: most do
}  // namespace skin_method

/// What the coded weights of a tuple sum to when they stand for 1; 0 when nothing does.
constexpr int32_t unitSum(const AttributeInfo& weights) {
  if (weights.coding == AttributeCoding::kLattice && weights.bits <= 24) {
    return static_cast<int32_t>((uint32_t{1} << weights.bits) - 1);
  }
  if (weights.format.component_type == ComponentType::kUint8) return 0xff;
  if (weights.format.component_type == ComponentType::kUint16) return 0xffff;
  return 0;
}

/// The bits of value_method that attribute `index` may have besides the predictor's and kHasEqualities.
constexpr uint8_t knownValueBits(const AttributeInfo* attributes, uint32_t count, uint32_t index) {
  constexpr uint8_t kAlways =
      value_method::kSameFlags | value_method::kZeroFlags | value_method::kSmallTokens;
  const AttributeInfo& a = attributes[index];
  const bool has_step = a.coding == AttributeCoding::kLattice || a.coding == AttributeCoding::kGrid;
  if (a.format.morph_target == 0 && a.format.component_count == 1) {
    return kAlways | value_method::kIds;
  }
  if (!decodes::kMorphTargets || a.format.morph_target == 0 || !areVectors(a) || !has_step)
    return kAlways;
  const auto vectorsBefore = [=](Semantic semantic) {
    const uint32_t i = deltasBefore(attributes, index, semantic);
    return i != kNone && areVectors(attributes[i]);
  };
  uint8_t bits = kAlways;
  if (a.format.semantic == Semantic::kNormal) {
    if (vectorsBefore(Semantic::kPosition)) bits |= value_method::kBends;
    if (hasNormals(attributes, count)) bits |= value_method::kUnits;
  } else if (a.format.semantic == Semantic::kTangent && hasNormals(attributes, count) &&
             baseTangentOf(attributes, count) != kNone && vectorsBefore(Semantic::kNormal)) {
    bits |= value_method::kUnits;
  }
  return bits;
}

constexpr bool isKnownPredictor(const AttributeInfo* attributes, uint32_t count, uint32_t index) {
  const AttributeInfo& a = attributes[index];
  const uint8_t bits = a.predictor & static_cast<uint8_t>(~kHasEqualities);
  switch (methodOf(attributes, count, index)) {
    case AttributeMethod::kValues:
      return (bits & ~(value_method::kPredictorMask | knownValueBits(attributes, count, index))) ==
                 0 &&
             ((bits & value_method::kPredictorMask) != value_method::kBlend ||
              a.format.component_count <= value_method::kBlendComponents);
    case AttributeMethod::kNormal:
      return (bits & ~normal_method::kAll) == 0 &&
             (bits & normal_method::kWeightMask) < normal_method::kWeightCount &&
             (bits & normal_method::kBlendMask) != normal_method::kBlendMask;
    case AttributeMethod::kExactNormal:
      return decodes::kExactFloats && (bits & ~exact_normal_method::kAll) == 0 &&
             (bits & exact_normal_method::kBlendMask) != exact_normal_method::kBlendMask;
    case AttributeMethod::kExactTangent:
      return decodes::kExactFloats && (bits & ~exact_tangent_method::kAll) == 0 &&
             ((bits & exact_tangent_method::kPerpendicular) == 0 ||
              exactNormalOf(attributes, count) != kNone);
    case AttributeMethod::kExactValues:
      return decodes::kExactFloats && (bits & ~exact_value_method::kAll) == 0 &&
             (bits & exact_value_method::kPredictorMask) < exact_value_method::kPredictorCount;
    case AttributeMethod::kTangent: return bits == 0;
    case AttributeMethod::kTangentPoint:
      return bits == 0 ||
             (bits == tangent_point_method::kPerpendicular && hasNormals(attributes, count));
    case AttributeMethod::kTexcoord:
      return (bits & ~texcoord_method::kAll) == 0 &&
             (bits & texcoord_method::kPredictorMask) < texcoord_method::kPredictorCount;
    case AttributeMethod::kSkin:
      return bits <= (skin_method::kIdleJoints | skin_method::kAscending);
    case AttributeMethod::kWithAnother:
      if (a.coding == AttributeCoding::kAlias) return a.predictor == 0;
      return a.predictor == 0 ||
             ((a.predictor == skin_method::kUnitSum || a.predictor == skin_method::kUsualSum) &&
              unitSum(a) != 0);
  }
  return false;
}

}  // namespace mcc

#endif  // MCC_MESH_ATTRIBUTE_METHOD_H_
