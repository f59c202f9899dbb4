// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "unit/entropy/entropy_scalar.h"

#include <bit>
#include <cstring>

// A second copy of the models without SIMD, in a namespace of its own.
#undef __SSE2__
#undef __ARM_NEON
#undef __wasm_simd128__
#define mcc mcc_scalar  // NOLINT(readability-identifier-naming)
#include "entropy/models.h"
#undef mcc

namespace mcc::test {
namespace {

mcc_scalar::TokenRow rowOf(const ScalarRow& row) {
  mcc_scalar::TokenRow copy;
  static_assert(sizeof copy.c == sizeof row.c);
  std::memcpy(copy.c, row.c, sizeof copy.c);
  copy.uses = row.uses;
  return copy;
}

void store(const mcc_scalar::TokenRow& from, ScalarRow& row) {
  std::memcpy(row.c, from.c, sizeof row.c);
  row.uses = from.uses;
}

mcc_scalar::TokenSchedule scheduleOf(const uint8_t* shifts) {
  mcc_scalar::TokenSchedule schedule;
  std::memcpy(schedule.shift, shifts, sizeof schedule.shift);
  return schedule;
}

}  // namespace

ScalarResult scalarFindAndAdapt(ScalarRow& row, uint32_t slot, const uint8_t* schedule) {
  mcc_scalar::TokenRow copy = rowOf(row);
  ScalarResult result{};
  result.symbol = copy.findAndAdapt(slot, scheduleOf(schedule), result.start, result.frequency);
  store(copy, row);
  return result;
}

void scalarAdapt(ScalarRow& row, uint32_t symbol, const uint8_t* schedule) {
  mcc_scalar::TokenRow copy = rowOf(row);
  copy.adapt(symbol, scheduleOf(schedule));
  store(copy, row);
}

}  // namespace mcc::test
