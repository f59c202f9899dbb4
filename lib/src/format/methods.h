// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which coder an attribute goes through, and the bits of its header byte `predictor`.  [A.2.4, A.8]
#ifndef MCC_FORMAT_METHODS_H_
#define MCC_FORMAT_METHODS_H_

#include <bit>
#include <cstdint>

#include "format/decodes.h"
#include "mcc/reader.h"

namespace mcc {

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

/// The coder of an attribute. It follows from the other fields of the header, which has no field
/// for it.
enum class AttributeMethod : uint8_t {
  kValues,        ///< values/values.h
  kNormal,        ///< vectors/normals.h
  kTexcoord,      ///< values/texcoords.h
  kTangent,       ///< vectors/tangents.h
  kTangentPoint,  ///< vectors/tangent_points.h
  kSkin,          ///< values/skin.h: JOINTS_n with its WEIGHTS_n
  kExactNormal,   ///< exact/normals.h
  kExactTangent,  ///< exact/tangents.h
  kSkinWeights,   ///< WEIGHTS_n that is coded with its JOINTS_n
  kAlias,         ///< equal to another attribute; nothing is coded
};
inline constexpr uint32_t kAttributeMethods = 10;

/// Whether an attribute is not coded by itself.
constexpr bool isWithAnother(AttributeMethod method) {
  return method >= AttributeMethod::kSkinWeights;
}

/// Returns the attribute of a piece that gives tangents their plane: the first NORMAL on the
/// octahedral grid, or kNone.
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

/// Returns the attribute of a piece that exact tangents are perpendicular to: the first NORMAL with
/// exact floats, or kNone.
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

/// Whether tangents on a grid have normals to be perpendicular to, exact or octahedral ones.
constexpr bool hasNormals(const AttributeInfo* attributes, uint32_t count) {
  return exactNormalOf(attributes, count) != kNone || normalOfTangents(attributes, count) != kNone;
}

/// Returns the attribute of a piece that gives tangents their direction: the first TEXCOORD, or
/// kNone.
constexpr uint32_t chartOfTangents(const AttributeInfo* attributes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    const AttributeFormat& f = attributes[i].format;
    if (attributes[i].coding == AttributeCoding::kAlias) continue;
    if (f.semantic == Semantic::kTexcoord && f.morph_target == 0 && f.component_count == 2)
      return i;
  }
  return kNone;
}

/// Attributes are coded in the order of their phases, and within a phase in the order of the
/// header. Tangents come after what they are predicted from. [A.8.1]
inline constexpr uint32_t kCodingPhases = 2;
constexpr uint32_t codingPhase(const AttributeInfo& a) {
  return a.format.semantic == Semantic::kTangent && a.format.morph_target == 0 ? 1 : 0;
}

/// JOINTS_n and WEIGHTS_n of four components are coded together. Returns the other attribute of the
/// pair, or kNone.
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
    case AttributeCoding::kAlias: return AttributeMethod::kAlias;
    default: break;
  }
  if (skinPartner(attributes, count, index) != kNone) {
    const bool is_joints = a.format.semantic == Semantic::kJoints;
    return is_joints ? AttributeMethod::kSkin : AttributeMethod::kSkinWeights;
  }
  if (a.format.morph_target != 0) return AttributeMethod::kValues;
  if (a.format.semantic == Semantic::kTexcoord && a.format.component_count == 2) {
    return AttributeMethod::kTexcoord;
  }
  if (!decodes::kExactFloats || a.coding != AttributeCoding::kExactFloat) {
    return AttributeMethod::kValues;
  }
  if (a.format.semantic == Semantic::kNormal && a.format.component_count == 3) {
    return AttributeMethod::kExactNormal;
  }
  if (a.format.semantic == Semantic::kTangent && a.format.component_count == 4) {
    return AttributeMethod::kExactTangent;
  }
  return AttributeMethod::kValues;
}

/// A bit of `predictor` in every method that codes an attribute by itself: consecutive wedges of a
/// vertex may share a value.
inline constexpr uint8_t kHasEqualities = 0x80;

/// AttributeInfo::predictor of a position selects what its coder does. Modes that are off cost the
/// coder nothing. [A.6.2]
namespace position_mode {
inline constexpr uint8_t kWeights = 1u << 0;  ///< weights of features, from the payload
inline constexpr uint8_t kSelect = 1u << 1;   ///< classes of tip selection; needs kWeights
inline constexpr uint8_t kShear = 1u << 2;    ///< excludes palette and planes
inline constexpr uint8_t kPalette = 1u << 3;
inline constexpr uint8_t kPlanes = 1u << 4;  ///< excludes the modes below
inline constexpr uint8_t kFold = 1u << 5;
inline constexpr uint8_t kOwnScale = 1u << 6;
inline constexpr uint8_t kSplit = 1u << 7;
inline constexpr uint8_t kKinds = kShear | kPalette | kPlanes;
inline constexpr uint8_t kWithPlanes = kWeights | kSelect;  ///< modes that planes may have as well
inline constexpr uint8_t kDecoded = static_cast<uint8_t>(~(decodes::kPlanes ? 0 : kPlanes));
inline constexpr uint8_t kMaxBitsOfPlanes = 17;  ///< most bits of the lattice

constexpr bool areKnown(uint32_t modes) {
  const uint32_t kinds = modes & kKinds;
  if ((kinds & (kinds - 1)) != 0) return false;
  if ((modes & kSelect) != 0 && (modes & kWeights) == 0) return false;
  return kinds != kPlanes || (modes & ~uint32_t{kPlanes | kWithPlanes}) == 0;
}
}  // namespace position_mode

namespace normal_method {                     // also for exact normals
inline constexpr uint8_t kWeightMask = 0x03;  ///< NormalWeight
inline constexpr uint8_t kBlend = 0x04;  ///< corrects by the errors of the neighbours' predictions
}  // namespace normal_method

namespace exact_normal_method {
inline constexpr uint8_t kRemembers = 0x08;
}  // namespace exact_normal_method

namespace exact_tangent_method {
inline constexpr uint8_t kPerpendicular = 0x01;  ///< perpendicular to the exact normal
}  // namespace exact_tangent_method

namespace texcoord_method {
inline constexpr uint8_t kHinge = 0x01;  ///< otherwise the diagonal
inline constexpr uint8_t kRemembers = 0x02;
}  // namespace texcoord_method

namespace value_method {
inline constexpr uint8_t kFlags = 0x01;  ///< flags for values that are 0 or a neighbour's
}  // namespace value_method

/// What is known about the sums of WEIGHTS that are coded with their JOINTS, see unitSum().
enum class SkinSums : uint8_t {
  kUnknown = 0,
  kUnit = 1,   ///< every tuple sums to the unit
  kUsual = 2,  ///< most tuples do
};

/// A field of the byte `predictor`.
struct PredictorField {
  uint8_t mask;
  uint8_t value_count;   ///< 0 .. value_count - 1 are valid
  const char* words[3];  ///< the words of `inspect` for each value; "" for none

  constexpr uint8_t shift() const { return static_cast<uint8_t>(std::countr_zero(mask)); }
  constexpr uint32_t valueOf(uint8_t predictor) const {
    return static_cast<uint32_t>(predictor & mask) >> shift();
  }
  constexpr uint8_t with(uint8_t predictor, uint32_t value) const {
    return static_cast<uint8_t>((predictor & ~mask) | (value << shift()));
  }
};

/// The fields of a method in the byte `predictor`. This is the only table of them. [A.2.4]
struct PredictorFields {
  const char* name;  ///< the word of `inspect` for the method itself; "" for none
  uint8_t count;
  PredictorField field[3];

  constexpr const PredictorField* begin() const { return field; }
  constexpr const PredictorField* end() const { return field + count; }
};

constexpr PredictorFields fieldsOf(AttributeMethod method) {
  constexpr PredictorField kWeight = {normal_method::kWeightMask, 3, {"area", "angle", "sine"}};
  constexpr PredictorField kBlend = {normal_method::kBlend, 2, {"", "blend"}};
  switch (method) {
    case AttributeMethod::kValues:
      return {"diagonal", 1, {{value_method::kFlags, 2, {"", "flags"}}}};
    case AttributeMethod::kNormal: return {"", 2, {kWeight, kBlend}};
    case AttributeMethod::kTexcoord:
      return {"",
              2,
              {{texcoord_method::kHinge, 2, {"diagonal", "hinge"}},
               {texcoord_method::kRemembers, 2, {"", "remembers"}}}};
    case AttributeMethod::kExactNormal:
      return {"", 3, {kWeight, {exact_normal_method::kRemembers, 2, {"", "remembers"}}, kBlend}};
    case AttributeMethod::kExactTangent:
      return {"chart", 1, {{exact_tangent_method::kPerpendicular, 2, {"", "perpendicular"}}}};
    case AttributeMethod::kSkinWeights:
      return {"with joints", 1, {{0x03, 3, {"", "unit sum", "usual sum"}}}};
    case AttributeMethod::kTangent:
    case AttributeMethod::kTangentPoint: return {"chart", 0, {}};
    case AttributeMethod::kSkin: return {"skin", 0, {}};
    case AttributeMethod::kAlias: break;
  }
  return {"", 0, {}};
}

constexpr bool isValidPredictor(AttributeMethod method, uint8_t predictor) {
  uint32_t rest = predictor;
  if (!isWithAnother(method)) rest &= ~uint32_t{kHasEqualities};
  for (const PredictorField& field : fieldsOf(method)) {
    if (field.valueOf(predictor) >= field.value_count) return false;
    rest &= ~uint32_t{field.mask};
  }
  return rest == 0;
}

/// The valid bytes from the table above, as a table of bits without the words.
struct ValidPredictors {
  uint8_t bytes[kAttributeMethods][32] = {};

  constexpr ValidPredictors() {
    for (uint32_t m = 0; m < kAttributeMethods; ++m) {
      for (uint32_t p = 0; p < 256; ++p) {
        const bool valid =
            isValidPredictor(static_cast<AttributeMethod>(m), static_cast<uint8_t>(p));
        bytes[m][p / 8] = static_cast<uint8_t>(bytes[m][p / 8] | (valid ? 1u << p % 8 : 0u));
      }
    }
  }
};
inline constexpr ValidPredictors kValidPredictors;

/// Whether the byte `predictor` of attribute `index`, which is not the position, is valid.
constexpr bool isKnownPredictor(const AttributeInfo* attributes, uint32_t count, uint32_t index) {
  const uint8_t p = attributes[index].predictor;
  const uint32_t method = static_cast<uint32_t>(methodOf(attributes, count, index));
  return (kValidPredictors.bytes[method][p / 8] >> p % 8 & 1) != 0;
}

/// Returns what the coded weights of a tuple sum to when they represent 1, or 0 when nothing does.
constexpr int32_t unitSum(const AttributeInfo& weights) {
  if (weights.coding == AttributeCoding::kLattice && weights.bits <= 24) {
    return static_cast<int32_t>((uint32_t{1} << weights.bits) - 1);
  }
  if (weights.format.component_type == ComponentType::kUint8) return 0xff;
  if (weights.format.component_type == ComponentType::kUint16) return 0xffff;
  return 0;
}

}  // namespace mcc

#endif  // MCC_FORMAT_METHODS_H_
