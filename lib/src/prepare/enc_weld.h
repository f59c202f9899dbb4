// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_PREPARE_ENC_WELD_H_
#define MCC_PREPARE_ENC_WELD_H_

#include <cstdint>
#include <vector>

#include "mcc/writer.h"

namespace mcc {

/// Classes of wedges with bit-equal positions, numbered by first occurrence. -0 equals +0 unless
/// `exact`; a position with a NaN is a class of its own. Expected time O(n).
struct PositionClasses {
  std::vector<uint32_t> class_of_wedge;
  uint32_t class_count = 0;
};

PositionClasses weldPositions(const AttributeView& positions, uint32_t wedge_count, bool exact);

}  // namespace mcc

#endif  // MCC_PREPARE_ENC_WELD_H_
