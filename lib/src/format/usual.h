// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the header of an attribute does not state because it is usual.                       [A.2.4]
#ifndef MCC_FORMAT_USUAL_H_
#define MCC_FORMAT_USUAL_H_

#include <bit>
#include <cstddef>
#include <cstdint>

#include "format/methods.h"
#include "mcc/reader.h"

namespace mcc {

/// Bits of an attribute's first byte.
inline constexpr uint8_t kTypeStated = 0x40;
inline constexpr uint8_t kMoreStated = 0x80;  ///< a set or a morph target other than 0

/// The components that floats of a semantic have, unless the type is stated.
inline constexpr uint8_t kUsualComponents[] = {3, 3, 4, 2, 4, 4, 4, 1};

constexpr bool isUsualType(const AttributeFormat& f) {
  return f.component_type == ComponentType::kFloat32 && !f.normalized &&
         f.component_count == kUsualComponents[static_cast<size_t>(f.semantic)];
}

/// Returns the usual step of a lattice: that of the last lattice of the same semantic among the
/// attributes before it in its piece, or else that of a lattice from 0 to 1.
inline float usualStep(AttributeInfos before, const AttributeInfo& a) {
  for (size_t i = before.size(); i-- != 0;) {
    const bool is_alike = before[i].format.semantic == a.format.semantic &&
                          before[i].coding == AttributeCoding::kLattice;
    if (is_alike) return before[i].lattice.step;
  }
  return 1.0f / static_cast<float>((1u << a.bits) - 1);
}

/// The form of a step or an origin: how many of its low bytes are 0 and left out, at most 2, or
/// that it is usual and takes no bytes. A header has the largest form.
inline constexpr uint32_t kFormBits = 2;
inline constexpr uint32_t kUsualForm = 3;
/// The number of a lattice's bits, below its forms in one number.
inline constexpr uint32_t kLatticeBitsBits = 5;

constexpr uint32_t formOf(float value, float usual) {
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  if (bits == std::bit_cast<uint32_t>(usual)) return kUsualForm;
  return (bits & 0xffff) == 0 ? 2 : (bits & 0xff) == 0 ? 1 : 0;
}

}  // namespace mcc

#endif  // MCC_FORMAT_USUAL_H_
