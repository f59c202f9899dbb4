// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The token row as compiled for machines without SIMD.
#ifndef MCC_TESTS_UNIT_ENTROPY_ENTROPY_SCALAR_H_
#define MCC_TESTS_UNIT_ENTROPY_ENTROPY_SCALAR_H_

#include <cstdint>

namespace mcc::test {

struct ScalarRow {
  uint16_t c[17];
  uint16_t uses;
};

struct ScalarResult {
  uint32_t symbol;
  uint32_t start;
  uint32_t frequency;
};

/// TokenRow::findAndAdapt() of the scalar code. `schedule` has 64 shifts.
ScalarResult scalarFindAndAdapt(ScalarRow& row, uint32_t slot, const uint8_t* schedule);
/// TokenRow::adapt() of the scalar code.
void scalarAdapt(ScalarRow& row, uint32_t symbol, const uint8_t* schedule);

}  // namespace mcc::test

#endif  // MCC_TESTS_UNIT_ENTROPY_ENTROPY_SCALAR_H_
