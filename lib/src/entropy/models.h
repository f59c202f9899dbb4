// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Adaptive models of both entropy coders. Reader and writer share all their updates.       [A.3.1]
#ifndef MCC_ENTROPY_MODELS_H_
#define MCC_ENTROPY_MODELS_H_

#include <bit>
#include <cstdint>

#include "base/host.h"

namespace mcc {

// --- binary decisions ----------------------------------------------------------

inline constexpr uint32_t kProbabilityBits = 22;
inline constexpr uint32_t kProbabilityOne = 1u << kProbabilityBits;
inline constexpr uint32_t kBitCountLimit = 255;

struct AdaptationRates {
  uint16_t of_count[kBitCountLimit + 1];
};

/// Computes round(65536 / (n + 1.6)): the first outcomes move a probability fast, later ones like a
/// mean.
constexpr AdaptationRates makeAdaptationRates() {
  AdaptationRates rates{};
  for (uint32_t n = 0; n <= kBitCountLimit; ++n) {
    const uint32_t divisor = 5 * n + 8;  // 5 * (n + 1.6)
    rates.of_count[n] = static_cast<uint16_t>((2 * 5 * 65536 + divisor) / (2 * divisor));
  }
  return rates;
}
using AdaptationTable = ConstantTable<makeAdaptationRates>;

/// The probability that the next bit is 0, in 22 bits, above a count of outcomes in 10 bits.
/// Compact code stores the difference to the first state, so that clearing memory initialises
/// models.
struct BitModel {
  static constexpr uint32_t kFirst = (kProbabilityOne / 2) << 10;
  static constexpr uint32_t kKeptFrom = kCompact ? kFirst : 0;
  uint32_t kept = kFirst ^ kKeptFrom;

  uint32_t state() const { return kept ^ kKeptFrom; }
  void set(uint32_t state) { kept = state ^ kKeptFrom; }
  uint32_t zeroProbability() const { return state() >> 10; }

  MCC_INLINE void update(bool bit) {
    const uint32_t count = state() & 1023;
    const uint32_t p = state() >> 10;
    const uint64_t rate = AdaptationTable::table.of_count[count];
    const uint32_t next = bit ? p - static_cast<uint32_t>((p * rate) >> 16)
                              : p + static_cast<uint32_t>(((kProbabilityOne - p) * rate) >> 16);
    set(next << 10 | (count + (count < kBitCountLimit ? 1 : 0)));
  }
};

// --- tokens: rows of 16 symbols ------------------------------------------------

inline constexpr uint32_t kTokenBits = 15;  ///< frequencies of a row are in units of 2^-15
inline constexpr uint32_t kTokenOne = 1u << kTokenBits;
inline constexpr uint32_t kTokenCount = 16;
inline constexpr uint32_t kTokenFloor = 4;  ///< units that every symbol keeps in the limit

/// The adaptation shift by the number of uses.
struct TokenSchedule {
  uint8_t shift[64];
};

struct TokenScheduleStep {
  uint32_t from_use;
  uint8_t shift;
};

template <uint32_t kSteps>
constexpr TokenSchedule makeTokenSchedule(const TokenScheduleStep (&steps)[kSteps]) {
  TokenSchedule schedule{};
  for (uint32_t use = 0; use < 64; ++use) {
    for (const TokenScheduleStep& step : steps) {
      if (use >= step.from_use) schedule.shift[use] = step.shift;
    }
  }
  return schedule;
}

inline constexpr TokenSchedule kPositionSchedule =
    makeTokenSchedule<6>({{0, 2}, {2, 3}, {5, 4}, {11, 5}, {30, 6}, {63, 7}});
inline constexpr TokenSchedule kAttributeSchedule =
    makeTokenSchedule<6>({{0, 1}, {1, 2}, {3, 3}, {7, 4}, {15, 5}, {31, 6}});

/// Cumulative frequencies of 16 symbols; symbol s owns [c[s], c[s+1]).
struct TokenRow {
  alignas(16) uint16_t c[kTokenCount + 1];
  uint16_t uses;
  /// Only for positions: the number of raw bits below the token, at each use. Stored here because
  /// there is room.
  uint16_t low_bits;

  void setUniform() {
    for (uint32_t i = 0; i <= kTokenCount; ++i) {
      c[i] = static_cast<uint16_t>(i * (kTokenOne / kTokenCount));
    }
    uses = 0;
    low_bits = 0;
  }

  uint32_t start(uint32_t symbol) const { return c[symbol]; }
  uint32_t frequency(uint32_t symbol) const { return uint32_t{c[symbol + 1]} - c[symbol]; }

  /// Finds the symbol whose range holds `slot`, and adapts. `start_out` and `frequency_out` are
  /// those before the adaptation.
  uint32_t findAndAdapt(uint32_t slot, const TokenSchedule& schedule, uint32_t& start_out,
                        uint32_t& frequency_out);
  void adapt(uint32_t symbol, const TokenSchedule& schedule);

 private:
  MCC_INLINE uint32_t nextShift(const TokenSchedule& schedule) {
    const uint32_t use = uses;
    uses = static_cast<uint16_t>(use + (use < 63 ? 1 : 0));
    return schedule.shift[use];
  }
};

#if defined(MCC_SSE2)

MCC_INLINE uint32_t TokenRow::findAndAdapt(uint32_t slot, const TokenSchedule& schedule,
                                           uint32_t& start_out, uint32_t& frequency_out) {
  __m128i* rows = reinterpret_cast<__m128i*>(c);
  const __m128i low = _mm_load_si128(rows);
  const __m128i high = _mm_load_si128(rows + 1);
  const __m128i slots = _mm_set1_epi16(static_cast<short>(slot));
  const __m128i low_above = _mm_cmpgt_epi16(low, slots);
  const __m128i high_above = _mm_cmpgt_epi16(high, slots);
  const uint32_t above =
      static_cast<uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(low_above, high_above)));
  const uint32_t symbol = static_cast<uint32_t>(std::countr_zero(above | 0x10000u)) - 1;
  start_out = c[symbol];
  frequency_out = uint32_t{c[symbol + 1]} - start_out;
  const __m128i shift = _mm_cvtsi32_si128(static_cast<int>(nextShift(schedule)));
  const __m128i span = _mm_set1_epi16(static_cast<short>(kTokenOne - kTokenFloor * kTokenCount));
  const __m128i low_floor = _mm_setr_epi16(0, 4, 8, 12, 16, 20, 24, 28);
  const __m128i high_floor = _mm_setr_epi16(32, 36, 40, 44, 48, 52, 56, 60);
  const __m128i low_target = _mm_add_epi16(low_floor, _mm_and_si128(low_above, span));
  const __m128i high_target = _mm_add_epi16(high_floor, _mm_and_si128(high_above, span));
  _mm_store_si128(rows, _mm_add_epi16(low, _mm_sra_epi16(_mm_sub_epi16(low_target, low), shift)));
  _mm_store_si128(rows + 1,
                  _mm_add_epi16(high, _mm_sra_epi16(_mm_sub_epi16(high_target, high), shift)));
  return symbol;
}

#elif defined(MCC_NEON)

MCC_INLINE uint32_t TokenRow::findAndAdapt(uint32_t slot, const TokenSchedule& schedule,
                                           uint32_t& start_out, uint32_t& frequency_out) {
  static constexpr int16_t kFloors[kTokenCount] = {0,  4,  8,  12, 16, 20, 24, 28,
                                                   32, 36, 40, 44, 48, 52, 56, 60};
  const int16x8_t low = vreinterpretq_s16_u16(vld1q_u16(c));
  const int16x8_t high = vreinterpretq_s16_u16(vld1q_u16(c + 8));
  const int16x8_t slots = vdupq_n_s16(static_cast<int16_t>(slot));
  const uint16x8_t low_above = vcgtq_s16(low, slots);
  const uint16x8_t high_above = vcgtq_s16(high, slots);
  // Each entry above the slot counts as -1. The entries that are not above it come first, up to the
  // symbol's.
  const int32_t above = vaddvq_s16(vreinterpretq_s16_u16(vaddq_u16(low_above, high_above)));
  const uint32_t symbol = static_cast<uint32_t>(static_cast<int32_t>(kTokenCount) + above - 1);
  start_out = c[symbol];
  frequency_out = uint32_t{c[symbol + 1]} - start_out;
  const int16x8_t shift =
      vdupq_n_s16(static_cast<int16_t>(-static_cast<int32_t>(nextShift(schedule))));
  const uint16x8_t span = vdupq_n_u16(kTokenOne - kTokenFloor * kTokenCount);
  const int16x8_t low_target =
      vaddq_s16(vld1q_s16(kFloors), vreinterpretq_s16_u16(vandq_u16(low_above, span)));
  const int16x8_t high_target =
      vaddq_s16(vld1q_s16(kFloors + 8), vreinterpretq_s16_u16(vandq_u16(high_above, span)));
  const int16x8_t new_low = vaddq_s16(low, vshlq_s16(vsubq_s16(low_target, low), shift));
  const int16x8_t new_high = vaddq_s16(high, vshlq_s16(vsubq_s16(high_target, high), shift));
  vst1q_u16(c, vreinterpretq_u16_s16(new_low));
  vst1q_u16(c + 8, vreinterpretq_u16_s16(new_high));
  return symbol;
}

#elif defined(MCC_WASM_SIMD)

MCC_INLINE uint32_t TokenRow::findAndAdapt(uint32_t slot, const TokenSchedule& schedule,
                                           uint32_t& start_out, uint32_t& frequency_out) {
  const v128_t low = wasm_v128_load(c);
  const v128_t high = wasm_v128_load(c + 8);
  const v128_t slots = wasm_i16x8_splat(static_cast<int16_t>(slot));
  const v128_t low_above = wasm_i16x8_gt(low, slots);
  const v128_t high_above = wasm_i16x8_gt(high, slots);
  const uint32_t above =
      static_cast<uint32_t>(wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(low_above, high_above)));
  const uint32_t symbol = static_cast<uint32_t>(std::countr_zero(above | 0x10000u)) - 1;
  start_out = c[symbol];
  frequency_out = uint32_t{c[symbol + 1]} - start_out;
  const uint32_t shift = nextShift(schedule);
  const v128_t span = wasm_i16x8_splat(static_cast<int16_t>(kTokenOne - kTokenFloor * kTokenCount));
  const v128_t low_target =
      wasm_i16x8_add(wasm_i16x8_make(0, 4, 8, 12, 16, 20, 24, 28), wasm_v128_and(low_above, span));
  const v128_t high_target = wasm_i16x8_add(wasm_i16x8_make(32, 36, 40, 44, 48, 52, 56, 60),
                                            wasm_v128_and(high_above, span));
  wasm_v128_store(c, wasm_i16x8_add(low, wasm_i16x8_shr(wasm_i16x8_sub(low_target, low), shift)));
  wasm_v128_store(c + 8,
                  wasm_i16x8_add(high, wasm_i16x8_shr(wasm_i16x8_sub(high_target, high), shift)));
  return symbol;
}

#else

inline uint32_t TokenRow::findAndAdapt(uint32_t slot, const TokenSchedule& schedule,
                                       uint32_t& start_out, uint32_t& frequency_out) {
  uint32_t symbol = 0;
  for (uint32_t i = 1; i < kTokenCount; ++i) symbol += c[i] <= slot ? 1 : 0;
  start_out = c[symbol];
  frequency_out = uint32_t{c[symbol + 1]} - start_out;
  const uint32_t shift = nextShift(schedule);
  for (uint32_t i = 0; i < kTokenCount; ++i) {
    const uint32_t above = i > symbol ? kTokenOne - kTokenFloor * kTokenCount : 0;
    const int32_t target = static_cast<int32_t>(kTokenFloor * i + above);
    c[i] = static_cast<uint16_t>(c[i] + ((target - static_cast<int32_t>(c[i])) >> shift));
  }
  return symbol;
}

#endif

inline void TokenRow::adapt(uint32_t symbol, const TokenSchedule& schedule) {
  uint32_t start = 0;
  uint32_t frequency = 0;
  findAndAdapt(c[symbol], schedule, start, frequency);
}

// --- rANS constants ------------------------------------------------------------

inline constexpr uint32_t kRansStateCount = 3;
inline constexpr uint32_t kRansLow = 1u << 16;  ///< states are in [2^16, 2^32); words have 16 bits

}  // namespace mcc

#endif  // MCC_ENTROPY_MODELS_H_
