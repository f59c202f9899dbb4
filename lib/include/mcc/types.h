// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TYPES_H_
#define MCC_TYPES_H_

#include <cstddef>
#include <cstdint>

namespace mcc {

/// Stands for "no index", and for "not set".
inline constexpr uint32_t kNone = 0xffffffffu;

/// Component types of glTF 2.0 accessors, in the order of their GL enumerants.
enum class ComponentType : uint8_t {
  kInt8 = 0,
  kUint8 = 1,
  kInt16 = 2,
  kUint16 = 3,
  kUint32 = 4,
  kFloat32 = 5,
  /// That of accessors of glTF 2.1 (5124). A payload has kUint32 for it, with the same bits.
  kInt32 = 6,
};

/// Bytes of one component.
constexpr uint32_t componentBytes(ComponentType type) {
  switch (type) {
    case ComponentType::kInt8:
    case ComponentType::kUint8: return 1;
    case ComponentType::kInt16:
    case ComponentType::kUint16: return 2;
    case ComponentType::kUint32:
    case ComponentType::kInt32:
    case ComponentType::kFloat32: return 4;
  }
  return 0;
}

/// What an attribute means. It decides how the attribute is predicted, but never whether it is
/// exact.
enum class Semantic : uint8_t {
  kPosition = 0,
  kNormal = 1,
  kTangent = 2,
  kTexcoord = 3,
  kColor = 4,
  kJoints = 5,
  kWeights = 6,
  kCustom = 7,
};

/// The type of one attribute of a piece. Elements have `component_count` components, tightly packed
/// (matrices too: the glTF layer removes and adds the column padding).
struct AttributeFormat {
  Semantic semantic = Semantic::kPosition;
  uint8_t set_index = 0;  ///< n of TEXCOORD_n; for kCustom the low 8 bits of the CRC-32 of the name
  ComponentType component_type = ComponentType::kFloat32;
  bool normalized = false;
  uint8_t component_count = 3;  ///< see isComponentCount()
  uint16_t morph_target = 0;    ///< 0: the base mesh; k: deltas of morph target k-1

  /// Equal in every member.
  bool operator==(const AttributeFormat&) const = default;
};

/// Whether an attribute may have this many components: 1 to 4, 9 or 16, as glTF's scalars, vectors
/// and matrices do.
constexpr bool isComponentCount(uint32_t count) {
  return (count >= 1 && count <= 4) || count == 9 || count == 16;
}

/// Bytes of one element with its components tightly packed.
constexpr uint32_t elementBytes(const AttributeFormat& format) {
  return componentBytes(format.component_type) * format.component_count;
}

/// Regular grid of a quantised float attribute: value = float(float(q * step) + origin), in the
/// units of the accessor.
struct Lattice {
  float origin[4] = {0, 0, 0, 0};
  float step = 0;

  /// Equal in every member.
  bool operator==(const Lattice&) const = default;
};

/// Whether the format can represent a lattice: its step is positive and finite, and the first
/// `component_count` origins are finite. Allocates nothing.
constexpr bool isValidLattice(const Lattice& lattice, uint32_t component_count) {
  constexpr float kLargest = 3.40282347e38f;
  bool valid = lattice.step > 0 && lattice.step <= kLargest;
  for (uint32_t c = 0; c < component_count && c < 4; ++c)
    valid = valid && lattice.origin[c] >= -kLargest && lattice.origin[c] <= kLargest;
  return valid;
}

/// Index types of the output of decode(). Their values are their sizes in bytes.
enum class IndexType : uint8_t {
  kUint8 = 1,
  kUint16 = 2,
  kUint32 = 4,
};

/// How a writer weighs fewer bytes against faster decoding: a slower method is taken only when it
/// saves enough.
enum class Preference : uint8_t {
  kBalanced = 0,  ///< 4 ns per vertex must save 1 % of a payload
  kSize = 1,      ///< 15 ns per vertex must save 1 %
  kSpeed = 2,     ///< 2.4 ns per vertex must save 1 %
};

/// Lets Preference decide whether surfaces are cut into blocks, see EncodeOptions::block_triangles.
inline constexpr uint32_t kBlocksByPreference = 0xffffffffu;

}  // namespace mcc

#endif  // MCC_TYPES_H_
