// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which coder an attribute goes through.  [A.2.4, A.10]
#ifndef MCC_FORMAT_METHODS_H_
#define MCC_FORMAT_METHODS_H_

#include <cstdint>
#include <span>

#include "format/codings.h"
#include "mcc/reader.h"

namespace mcc {

/// The coder of an attribute. It follows from the other fields of the header, which has no field
/// for it.
enum class AttributeMethod : uint8_t {
  kPosition,      ///< positions/positions.h: the first attribute of a piece
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
inline constexpr uint32_t kAttributeMethods = 11;

/// The attributes of a piece, its position first.
using AttributeInfos = std::span<const AttributeInfo>;

/// Whether an attribute is not coded by itself.
constexpr bool isWithAnother(AttributeMethod method) {
  return method >= AttributeMethod::kSkinWeights;
}

/// Returns the attribute of a piece that gives tangents their plane: the first NORMAL on the
/// octahedral grid, or kNone.
constexpr uint32_t normalOfTangents(AttributeInfos attributes) {
  for (uint32_t i = 0; i < attributes.size(); ++i) {
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
constexpr uint32_t exactNormalOf(AttributeInfos attributes) {
  for (uint32_t i = 0; i < attributes.size(); ++i) {
    const AttributeInfo& a = attributes[i];
    if (a.format.semantic == Semantic::kNormal && a.format.morph_target == 0 &&
        a.format.component_count == 3 && isExact(a.coding)) {
      return i;
    }
  }
  return kNone;
}

/// Whether tangents on a grid have normals to be perpendicular to, exact or octahedral ones.
constexpr bool hasNormals(AttributeInfos attributes) {
  return exactNormalOf(attributes) != kNone || normalOfTangents(attributes) != kNone;
}

/// Returns the attribute of a piece that gives tangents their direction: the first TEXCOORD, or
/// kNone.
constexpr uint32_t chartOfTangents(AttributeInfos attributes) {
  for (uint32_t i = 0; i < attributes.size(); ++i) {
    const AttributeFormat& f = attributes[i].format;
    if (attributes[i].coding == AttributeCoding::kAlias) continue;
    if (f.semantic == Semantic::kTexcoord && f.morph_target == 0 && f.component_count == 2)
      return i;
  }
  return kNone;
}

/// Attributes are coded in the order of their phases, and within a phase in the order of the
/// header. Tangents come after what they are predicted from. [A.10.1]
inline constexpr uint32_t kCodingPhases = 2;
constexpr uint32_t codingPhase(const AttributeInfo& a) {
  return a.format.semantic == Semantic::kTangent && a.format.morph_target == 0 ? 1 : 0;
}

/// JOINTS_n and WEIGHTS_n of four components are coded together. Returns the other attribute of the
/// pair, or kNone.
constexpr uint32_t skinPartner(AttributeInfos attributes, uint32_t index) {
  const auto isHalf = [](const AttributeInfo& a) {
    return a.format.morph_target == 0 && a.format.component_count == 4 &&
           (a.format.semantic == Semantic::kJoints
                ? a.coding == AttributeCoding::kInteger
                : a.format.semantic == Semantic::kWeights &&
                      (a.coding <= AttributeCoding::kExactFloat ||
                       a.coding == AttributeCoding::kGrid));
  };
  const auto firstOf = [=](Semantic semantic, uint8_t set) {
    for (uint32_t i = 1; i < attributes.size(); ++i) {
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

constexpr AttributeMethod methodOf(AttributeInfos attributes, uint32_t index) {
  if (index == 0) return AttributeMethod::kPosition;
  const AttributeInfo& a = attributes[index];
  switch (a.coding) {
    case AttributeCoding::kOctahedral:
      return a.format.semantic == Semantic::kTangent ? AttributeMethod::kTangentPoint
                                                     : AttributeMethod::kNormal;
    case AttributeCoding::kTangentAngle: return AttributeMethod::kTangent;
    case AttributeCoding::kAlias: return AttributeMethod::kAlias;
    default: break;
  }
  if (skinPartner(attributes, index) != kNone) {
    const bool is_joints = a.format.semantic == Semantic::kJoints;
    return is_joints ? AttributeMethod::kSkin : AttributeMethod::kSkinWeights;
  }
  if (a.format.morph_target != 0) return AttributeMethod::kValues;
  if (a.format.semantic == Semantic::kTexcoord && a.format.component_count == 2) {
    return AttributeMethod::kTexcoord;
  }
  if (a.coding != AttributeCoding::kExactFloat) {
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

/// Returns what the coded weights of a tuple sum to when they represent 1, or 0 when nothing does.
constexpr int32_t unitSum(const AttributeInfo& weights) {
  if (weights.coding == AttributeCoding::kLattice && weights.bits <= kMaxLatticeBits) {
    return static_cast<int32_t>((uint32_t{1} << weights.bits) - 1);
  }
  if (weights.format.component_type == ComponentType::kUint8) return 0xff;
  if (weights.format.component_type == ComponentType::kUint16) return 0xffff;
  return 0;
}

}  // namespace mcc

#endif  // MCC_FORMAT_METHODS_H_
