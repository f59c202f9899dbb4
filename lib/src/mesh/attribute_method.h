// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which coder an attribute goes through, and the bits of its header byte `predictor`.        [A.2.4, A.8]
#ifndef MCC_MESH_ATTRIBUTE_METHOD_H_
#define MCC_MESH_ATTRIBUTE_METHOD_H_

#include <cstdint>

#include "mcc/reader.h"

namespace mcc {

/// The coder follows from what the header says; there is no field for it.
enum class AttributeMethod : uint8_t {
  kValues,    ///< attributes/values.h
  kNormal,    ///< attributes/normals.h
  kTexcoord,  ///< attributes/texcoords.h
  kTangent,   ///< attributes/tangents.h
};

/// The attribute of a piece that gives tangents their plane: the first NORMAL on the octahedral grid; or kNone.
constexpr uint32_t normalOfTangents(const AttributeInfo* attributes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    if (attributes[i].coding == AttributeCoding::kOctahedral) return i;
  }
  return kNone;
}

/// The attribute of a piece that gives tangents their direction: the first TEXCOORD; or kNone.
constexpr uint32_t chartOfTangents(const AttributeInfo* attributes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    const AttributeFormat& f = attributes[i].format;
    if (f.semantic == Semantic::kTexcoord && f.morph_target == 0 && f.component_count == 2)
      return i;
  }
  return kNone;
}

/// Attributes are coded in the order of their phases, within a phase in that of the header. [A.8.1]
inline constexpr uint32_t kCodingPhases = 2;
constexpr uint32_t codingPhase(const AttributeInfo& a) {
  return a.coding == AttributeCoding::kTangentAngle ? 1 : 0;  // behind normals and charts
}

constexpr AttributeMethod methodOf(const AttributeInfo& a) {
  if (a.coding == AttributeCoding::kOctahedral) return AttributeMethod::kNormal;
  if (a.coding == AttributeCoding::kTangentAngle) return AttributeMethod::kTangent;
  const bool is_base = a.format.morph_target == 0;
  const bool is_float = a.coding == AttributeCoding::kExactFloat;
  if (a.format.semantic == Semantic::kTexcoord && is_base && !is_float &&
      a.format.component_count == 2) {
    return AttributeMethod::kTexcoord;
  }
  return AttributeMethod::kValues;
}

/// Bits of `predictor` of every method: consecutive wedges of a vertex may share a value.
inline constexpr uint8_t kHasEqualities = 0x80;

namespace normal_method {
inline constexpr uint8_t kWeightMask = 0x03;  ///< NormalWeight
inline constexpr uint8_t kBlendShift = 2;     ///< 0 none, 1 half, 2 whole
inline constexpr uint8_t kBlendMask = 0x0c;
}  // namespace normal_method

namespace texcoord_method {
inline constexpr uint8_t kPredictorMask = 0x07;  ///< TexcoordPredictor
inline constexpr uint8_t kRepeats = 0x08;
}  // namespace texcoord_method

constexpr bool isKnownPredictor(const AttributeInfo& a) {
  const uint8_t bits = a.predictor & static_cast<uint8_t>(~kHasEqualities);
  switch (methodOf(a)) {
    case AttributeMethod::kValues: return bits < 2;
    case AttributeMethod::kNormal:
      return (bits & ~0x0f) == 0 && (bits & normal_method::kWeightMask) != 3 &&
             (bits & normal_method::kBlendMask) != normal_method::kBlendMask;
    case AttributeMethod::kTangent: return bits == 0;
    case AttributeMethod::kTexcoord:
      return (bits & ~0x0f) == 0 && (bits & texcoord_method::kPredictorMask) < 5;
  }
  return false;
}

}  // namespace mcc

#endif  // MCC_MESH_ATTRIBUTE_METHOD_H_
