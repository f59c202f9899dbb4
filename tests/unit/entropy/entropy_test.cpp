// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "mcc/types.h"

#include "entropy/decoder_io.h"
#include "entropy/enc_coder.h"
#include "entropy/numbers.h"
#include "positions/tables.h"
#include "support/mesh_generators.h"
#include "unit/entropy/entropy_scalar.h"

namespace mcc::test {
namespace {

// ---- Binary model [A.3.1] -----------------------------------------------------------------------

TEST(BitModel, StartsUndecidedAndLearnsFast) {
  BitModel model;
  EXPECT_EQ(model.zeroProbability(), kProbabilityOne / 2);
  model.update(false);
  EXPECT_GT(model.zeroProbability(), kProbabilityOne * 3 / 4);  // the first outcome counts most
  BitModel other;
  other.update(true);
  EXPECT_EQ(other.zeroProbability(), kProbabilityOne - model.zeroProbability());
}

TEST(BitModel, StaysInsideItsBounds) {
  for (const bool bit : {false, true}) {
    BitModel model;
    uint32_t before = model.zeroProbability();
    for (int i = 0; i < 100000; ++i) {
      model.update(bit);
      const uint32_t p = model.zeroProbability();
      ASSERT_TRUE(bit ? p <= before : p >= before);
      ASSERT_GT(p, 0u);
      ASSERT_LT(p, kProbabilityOne);
      before = p;
    }
    const uint32_t unlikely = bit ? before : kProbabilityOne - before;
    EXPECT_LT(unlikely, kProbabilityOne / 10000);
    for (int i = 0; i < 1000; ++i) model.update(!bit);  // and comes back
    const uint32_t p = model.zeroProbability();
    EXPECT_TRUE(bit ? p > kProbabilityOne * 9ull / 10 : p < kProbabilityOne / 10);
  }
  Random random(1);
  BitModel model;
  for (int i = 0; i < 200000; ++i) {
    model.update(random.chance((i / 1000) % 2 == 0 ? 99 : 1));
    ASSERT_GT(model.zeroProbability(), 0u);
    ASSERT_LT(model.zeroProbability(), kProbabilityOne);
  }
}

TEST(BitModel, ConvergesToTheFrequency) {
  for (const uint32_t percent : {2u, 10u, 50u, 80u, 99u}) {
    Random random(percent);
    BitModel model;
    double mean = 0;
    for (int i = 0; i < 20000; ++i) {
      model.update(random.chance(percent));
      if (i >= 10000) mean += model.zeroProbability() / 10000.0 / kProbabilityOne;
    }
    EXPECT_NEAR(mean, 1 - percent / 100.0, 0.01);
  }
}

// ---- Range coder [A.3.2] ------------------------------------------------------------------------

struct CodedBits {
  std::vector<uint8_t> bits;
  std::vector<uint32_t> models;
  std::vector<uint8_t> bytes;
};

constexpr uint32_t kBitModels = 5;

CodedBits codeBits(uint64_t seed, uint32_t count, uint32_t percent) {
  CodedBits coded;
  Random random(seed);
  BitModel models[kBitModels];
  RangeEncoder encoder;
  for (uint32_t i = 0; i < count; ++i) {
    coded.models.push_back(random.below(kBitModels));
    const bool bit = random.chance(percent);
    coded.bits.push_back(bit ? 1 : 0);
    BitModel& model = models[coded.models.back()];
    encoder.bit(model, bit);
    model.update(bit);
  }
  coded.bytes = encoder.finish();
  return coded;
}

TEST(RangeCoder, RoundTripAtAllSkews) {
  for (const uint32_t percent : {0u, 1u, 5u, 50u, 77u, 99u, 100u}) {
    for (const uint32_t count : {0u, 1u, 2u, 10u, 31u, 32u, 33u, 100u, 1000u, 30000u}) {
      const CodedBits coded = codeBits(percent * 7 + count, count, percent);
      RangeDecoder decoder(coded.bytes);
      BitModel models[kBitModels];
      for (uint32_t i = 0; i < count; ++i) {
        ASSERT_EQ(decoder.bit(models[coded.models[i]]) ? 1 : 0, coded.bits[i])
            << percent << " %, bit " << i;
      }
      EXPECT_TRUE(decoder.finished()) << percent << " %, " << count;
      EXPECT_FALSE(decoder.overrun());
    }
  }
}

TEST(RangeCoder, SizeIsTheEntropy) {
  const CodedBits coded = codeBits(3, 100000, 5);
  const double expected_bits = 100000 * -(0.05 * std::log2(0.05) + 0.95 * std::log2(0.95));
  EXPECT_NEAR(8.0 * static_cast<double>(coded.bytes.size()), expected_bits, 0.05 * expected_bits);
}

TEST(RangeCoder, NothingTakesNoByte) {
  RangeEncoder encoder;
  EXPECT_TRUE(encoder.finish().empty());
  const RangeDecoder decoder({});
  EXPECT_TRUE(decoder.finished());
}

TEST(RangeCoder, TrailingZerosAreDropped) {
  // Only likely symbols at the low end: the whole stream is zero, and its last word is not written.
  BitModel model;
  RangeEncoder encoder;
  for (int i = 0; i < 20; ++i) {
    encoder.bit(model, false);
    model.update(false);
  }
  EXPECT_TRUE(encoder.finish().empty());
  uint64_t dropped = 0;
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    const std::vector<uint8_t> bytes = codeBits(seed, 40, 50).bytes;
    EXPECT_TRUE(bytes.empty() || bytes.back() != 0 || bytes.size() % 4 == 0);
    dropped += bytes.size() % 4 != 0 ? 1 : 0;
  }
  EXPECT_GT(dropped, 0u);
}

struct Symbol {
  uint32_t start;
  uint32_t frequency;
  uint32_t bits;
};

std::vector<uint8_t> encodeSymbols(const std::vector<Symbol>& symbols) {
  RangeEncoder encoder;
  for (const Symbol& s : symbols) encoder.symbol(s.start, s.frequency, s.bits);
  return encoder.finish();
}

void expectSymbols(std::span<const uint8_t> bytes, const std::vector<Symbol>& symbols) {
  RangeDecoder decoder(bytes);
  for (size_t i = 0; i < symbols.size(); ++i) {
    const Symbol& s = symbols[i];
    const uint32_t value = decoder.peek(s.bits);
    ASSERT_TRUE(value >= s.start && value - s.start < s.frequency) << "symbol " << i;
    decoder.consume(s.start, s.frequency, s.bits);
  }
  EXPECT_TRUE(decoder.finished());
}

/// Returns symbols that keep the middle of the number line inside the interval, so that all words
/// after the first are held back by a possible carry; the last symbol lies above (a carry through
/// all of them) or below.
std::vector<Symbol> straddlingSymbols(uint32_t count, bool carry) {
  std::vector<Symbol> symbols;
  uint64_t range = ~uint64_t{0};
  uint64_t gap = uint64_t{1} << 63;  // from the low end to the middle
  const auto take = [&](uint32_t start, uint32_t frequency, uint32_t bits) {
    symbols.push_back({start, frequency, bits});
    const uint64_t unit = range >> bits;
    gap -= unit * start;
    range = unit * frequency;
    if (range >= (uint64_t{1} << 32)) return;
    range <<= 32;
    gap <<= 32;
  };
  for (uint32_t i = 0; i < count; ++i) {
    const uint64_t quarter = gap / (range >> 2);
    take(static_cast<uint32_t>(std::clamp<uint64_t>(quarter, 1, 3) - 1), 2, 2);
  }
  const uint64_t place = gap / (range >> 16);
  take(static_cast<uint32_t>(carry ? place + 1 : place - 1), 1, 16);
  return symbols;
}

TEST(RangeCoder, LongCarryChains) {
  for (const uint32_t count : {10u, 31u, 33u, 64u, 65u, 1000u, 20000u}) {
    for (const bool carry : {false, true}) {
      const std::vector<Symbol> symbols = straddlingSymbols(count, carry);
      const std::vector<uint8_t> bytes = encodeSymbols(symbols);
      SCOPED_TRACE(std::to_string(count) + (carry ? " with carry" : ""));
      expectSymbols(bytes, symbols);
      ASSERT_GT(bytes.size() + 8, count / 8);
      const size_t words = count / 32;  // all held back until the last symbol
      for (size_t i = 0; i < 4 * words; ++i) {
        const uint8_t first = carry ? 0x80 : 0x7f;
        const uint8_t other = carry ? 0x00 : 0xff;
        ASSERT_EQ(bytes[i], i == 3 ? first : other) << i;  // words are little-endian
      }
    }
  }
}

TEST(RangeCoder, SymbolsOfAllWidths) {
  Random random(4);
  std::vector<Symbol> symbols;
  for (int i = 0; i < 20000; ++i) {
    const uint32_t bits = random.between(0, 16);
    const uint32_t total = 1u << bits;
    const uint32_t frequency = random.chance(50) ? 1 : random.between(1, total);
    symbols.push_back({random.below(total - frequency + 1), frequency, bits});
  }
  expectSymbols(encodeSymbols(symbols), symbols);
}

TEST(RangeCoder, ShortAndLongStreamsAreNoticed) {
  std::vector<Symbol> symbols;
  Random random(5);
  for (int i = 0; i < 400; ++i) symbols.push_back({random.below(1 << 16), 1, 16});
  const std::vector<uint8_t> bytes = encodeSymbols(symbols);
  const auto decoderAfterAll = [&](std::span<const uint8_t> stream) {
    RangeDecoder decoder(stream);
    for (size_t i = 0; i < symbols.size(); ++i) decoder.consume(decoder.peek(16), 1, 16);
    return decoder;
  };
  EXPECT_TRUE(decoderAfterAll(bytes).finished());
  for (size_t cut = 9; cut <= bytes.size(); ++cut) {
    const std::vector<uint8_t> stream(bytes.begin(),
                                      bytes.end() - static_cast<std::ptrdiff_t>(cut));
    const RangeDecoder decoder = decoderAfterAll(stream);
    EXPECT_TRUE(decoder.overrun()) << cut;
    EXPECT_FALSE(decoder.finished()) << cut;
  }
  for (const size_t more : {9u, 10u, 100u}) {
    std::vector<uint8_t> stream = bytes;
    stream.resize(bytes.size() + more);
    const RangeDecoder decoder = decoderAfterAll(stream);
    EXPECT_FALSE(decoder.finished()) << more;
    EXPECT_FALSE(decoder.overrun()) << more;
  }
}

// ---- Token rows ---------------------------------------------------------------------------------

void expectRow(const TokenRow& row) {
  ASSERT_EQ(row.c[0], 0);
  ASSERT_EQ(row.c[kTokenCount], kTokenOne);
  for (uint32_t s = 0; s < kTokenCount; ++s) {
    ASSERT_LT(row.c[s], row.c[s + 1]) << "symbol " << s << " has no room";
    ASSERT_EQ(row.frequency(s), uint32_t{row.c[s + 1]} - row.start(s));
  }
}

std::vector<TokenSchedule> schedules() {
  std::vector<TokenSchedule> all = {kPositionSchedule, kAttributeSchedule};
  for (uint8_t shift = 1; shift <= 8; ++shift) {
    TokenSchedule schedule;
    std::fill(schedule.shift, schedule.shift + 64, shift);
    all.push_back(schedule);
  }
  return all;
}

TEST(TokenRow, StaysValidUnderEverySequence) {
  for (const TokenSchedule& schedule : schedules()) {
    for (uint32_t symbol = 0; symbol < kTokenCount; ++symbol) {  // always the same one
      TokenRow row;
      row.setUniform();
      expectRow(row);
      for (int i = 0; i < 3000; ++i) row.adapt(symbol, schedule);
      expectRow(row);
      EXPECT_GT(row.frequency(symbol), kTokenOne * 9 / 10);
      for (uint32_t s = 0; s < kTokenCount; ++s) {  // then each other one
        TokenRow other = row;
        for (int i = 0; i < 100; ++i) {
          other.adapt(s, schedule);
          expectRow(other);
        }
      }
    }
    for (uint64_t seed = 0; seed < 40; ++seed) {
      Random random(seed);
      TokenRow row;
      row.setUniform();
      uint32_t symbol = 0;
      for (int i = 0; i < 1000; ++i) {
        if (random.chance(30)) symbol = random.below(kTokenCount);
        row.adapt(symbol, schedule);
        expectRow(row);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

TEST(TokenRow, TabledRowsAreValid) {
  for (const TokenRow& row : InitialRowTable::table.plain) expectRow(row);
  for (const TokenRow& row : InitialRowTable::table.folded) expectRow(row);
}

TEST(TokenRow, FindsTheSymbolOfEverySlot) {
  Random random(6);
  TokenRow row;
  row.setUniform();
  for (int i = 0; i < 50; ++i) row.adapt(random.below(5), kAttributeSchedule);
  for (uint32_t slot = 0; slot < kTokenOne; ++slot) {
    TokenRow copy = row;
    uint32_t start = 0;
    uint32_t frequency = 0;
    const uint32_t symbol = copy.findAndAdapt(slot, kAttributeSchedule, start, frequency);
    ASSERT_EQ(start, row.start(symbol));
    ASSERT_EQ(frequency, row.frequency(symbol));
    ASSERT_TRUE(slot >= start && slot - start < frequency);
  }
}

TEST(TokenRow, SimdAndScalarCodeAgree) {
  for (const TokenSchedule& schedule : schedules()) {
    Random random(schedule.shift[0] * 64u + schedule.shift[63]);
    TokenRow row;
    row.setUniform();
    ScalarRow scalar;
    std::memcpy(scalar.c, row.c, sizeof scalar.c);
    scalar.uses = row.uses;
    uint32_t favourite = 0;
    for (int i = 0; i < 20000; ++i) {
      if (random.chance(1)) favourite = random.below(kTokenCount);
      const uint32_t symbol = random.chance(80) ? favourite : random.below(kTokenCount);
      if (random.chance(50)) {
        row.adapt(symbol, schedule);
        scalarAdapt(scalar, symbol, schedule.shift);
      } else {
        const uint32_t slot = row.start(symbol) + random.below(row.frequency(symbol));
        uint32_t start = 0;
        uint32_t frequency = 0;
        const uint32_t found = row.findAndAdapt(slot, schedule, start, frequency);
        const ScalarResult result = scalarFindAndAdapt(scalar, slot, schedule.shift);
        ASSERT_EQ(found, symbol);
        ASSERT_EQ(result.symbol, symbol);
        ASSERT_EQ(result.start, start);
        ASSERT_EQ(result.frequency, frequency);
      }
      ASSERT_EQ(std::memcmp(row.c, scalar.c, sizeof scalar.c), 0) << i;
      ASSERT_EQ(row.uses, scalar.uses);
    }
  }
}

TEST(TokenRow, LaterUsesMoveItLess) {
  TokenRow fresh;
  fresh.setUniform();
  TokenRow used = fresh;
  used.uses = 63;
  fresh.adapt(3, kPositionSchedule);
  used.adapt(3, kPositionSchedule);
  EXPECT_GT(fresh.frequency(3), used.frequency(3));
  for (int i = 0; i < 100000; ++i) used.adapt(3, kPositionSchedule);
  EXPECT_EQ(used.uses, 63);  // no wrap
}

// ---- rANS ---------------------------------------------------------------------------------------

struct CodedTokens {
  std::vector<uint8_t> symbols;
  std::vector<uint8_t> bytes;
};

constexpr uint32_t kRows = 4;

CodedTokens codeTokens(uint64_t seed, uint32_t count, uint32_t favourite_percent) {
  CodedTokens coded;
  Random random(seed);
  TokenRow rows[kRows];
  for (TokenRow& row : rows) row.setUniform();
  RansEncoder encoder;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t symbol = random.chance(favourite_percent) ? 2 : random.below(kTokenCount);
    TokenRow& row = rows[i % kRows];
    encoder.token(i % 3, row.start(symbol), row.frequency(symbol));
    row.adapt(symbol, kAttributeSchedule);
    coded.symbols.push_back(static_cast<uint8_t>(symbol));
  }
  coded.bytes = encoder.finish();
  return coded;
}

RansDecoder decodeTokens(std::span<const uint8_t> bytes, std::vector<uint8_t>& symbols) {
  RansDecoder decoder(bytes);
  TokenRow rows[kRows];
  for (TokenRow& row : rows) row.setUniform();
  for (size_t i = 0; i < symbols.size(); ++i) {
    TokenRow& row = rows[i % kRows];
    const uint32_t symbol = decoder.token(static_cast<uint32_t>(i % 3), row, kAttributeSchedule);
    symbols[i] = static_cast<uint8_t>(symbol);
  }
  return decoder;
}

TEST(Rans, RoundTripWithThreeStates) {
  for (const uint32_t count : {0u, 1u, 2u, 3u, 4u, 50u, 1000u, 50000u}) {
    for (const uint32_t percent : {0u, 50u, 90u, 99u, 100u}) {
      const CodedTokens coded = codeTokens(count + percent, count, percent);
      std::vector<uint8_t> symbols(count);
      const RansDecoder decoder = decodeTokens(coded.bytes, symbols);
      ASSERT_EQ(symbols, coded.symbols) << count << ", " << percent << " %";
      EXPECT_TRUE(decoder.finished());
      EXPECT_FALSE(decoder.overrun());
    }
  }
}

TEST(Rans, ShortLongAndOtherStreamsAreNoticed) {
  const CodedTokens coded = codeTokens(8, 500, 50);
  std::vector<uint8_t> symbols(500);
  for (size_t cut = 1; cut <= coded.bytes.size(); ++cut) {
    const std::vector<uint8_t> stream(coded.bytes.begin(),
                                      coded.bytes.end() - static_cast<std::ptrdiff_t>(cut));
    EXPECT_FALSE(decodeTokens(stream, symbols).finished()) << cut;
  }
  for (const size_t more : {1u, 2u, 3u, 20u}) {
    std::vector<uint8_t> stream = coded.bytes;
    stream.resize(stream.size() + more);
    EXPECT_FALSE(decodeTokens(stream, symbols).finished()) << more;
  }
  // The states end where they began only for the right bytes: one changed bit is seen nearly
  // always.
  uint32_t unseen = 0;
  for (size_t bit = 0; bit < 8 * coded.bytes.size(); ++bit) {
    std::vector<uint8_t> stream = coded.bytes;
    stream[bit / 8] = static_cast<uint8_t>(stream[bit / 8] ^ 1u << bit % 8);
    unseen += decodeTokens(stream, symbols).finished() ? 1 : 0;
  }
  EXPECT_EQ(unseen, 0u);
  symbols.resize(499);  // a symbol less than the stream holds
  EXPECT_FALSE(decodeTokens(coded.bytes, symbols).finished());
}

TEST(Rans, StatesBelowTheirRangeAreNoticed) {
  std::vector<uint8_t> bytes = codeTokens(9, 0, 0).bytes;
  ASSERT_EQ(bytes.size(), 4u * kRansStateCount);
  EXPECT_TRUE(RansDecoder(bytes).finished());
  for (uint32_t state = 0; state < kRansStateCount; ++state) {
    std::vector<uint8_t> damaged = bytes;
    std::fill(damaged.begin() + 4 * state, damaged.begin() + 4 * state + 4, uint8_t{0});
    EXPECT_TRUE(RansDecoder(damaged).overrun());
    EXPECT_FALSE(RansDecoder(damaged).finished());
  }
}

// ---- Raw bits -----------------------------------------------------------------------------------

TEST(RawBits, RoundTripOfAllWidths) {
  Random random(10);
  std::vector<uint32_t> widths;
  std::vector<uint32_t> values;
  RawBitsEncoder encoder;
  for (int i = 0; i < 5000; ++i) {
    const uint32_t bits = i < 99 ? static_cast<uint32_t>(i) / 3 : random.below(33);
    const uint32_t mask = static_cast<uint32_t>((uint64_t{1} << bits) - 1);
    const uint32_t value = (i % 3 == 0 ? ~0u : static_cast<uint32_t>(random.next())) & mask;
    widths.push_back(bits);
    values.push_back(value);
    encoder.write(bits, value);
  }
  const std::vector<uint8_t> bytes = encoder.finish();
  const auto readAll = [&](std::span<const uint8_t> stream, bool compare) {
    RawBitsDecoder decoder(stream);
    for (size_t i = 0; i < widths.size(); ++i) {
      const uint32_t value = decoder.read(widths[i]);
      EXPECT_TRUE(!compare || value == values[i]) << i;
    }
    return decoder;
  };
  EXPECT_TRUE(readAll(bytes, true).finished());
  EXPECT_FALSE(readAll(bytes, false).overrun());
  for (const size_t cut : {1u, 2u, 9u, 100u}) {
    const std::vector<uint8_t> stream(bytes.begin(),
                                      bytes.end() - static_cast<std::ptrdiff_t>(cut));
    EXPECT_TRUE(readAll(stream, false).overrun()) << cut;
    EXPECT_FALSE(readAll(stream, false).finished()) << cut;
  }
  std::vector<uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_FALSE(readAll(longer, true).finished());
}

TEST(RawBits, NothingIsNothing) {
  RawBitsEncoder encoder;
  encoder.write(0, 0);
  EXPECT_TRUE(encoder.finish().empty());
  RawBitsDecoder decoder({});
  EXPECT_EQ(decoder.read(0), 0u);
  EXPECT_TRUE(decoder.finished());
  EXPECT_EQ(decoder.read(32), 0u);
  EXPECT_TRUE(decoder.overrun());
}

// ---- The interface of the stages ----------------------------------------------------------------

/// A random mixture of everything the stages code, the same for every Io.
struct Mixture {
  struct Models {
    BitModel bit[3];
    TokenRow row[3];
    GolombModel golomb;
    GolombModel signed_golomb;
    TreeModel<6> tree;
    Models() {
      for (TokenRow& r : row) r.setUniform();
    }
  };
  Models models;
  std::vector<int64_t> read;

  template <class Io>
  void run(Io& io, uint64_t seed, uint32_t count) {
    Random random(seed);
    for (uint32_t i = 0; i < count; ++i) {
      switch (random.below(6)) {
        case 0: {
          const uint32_t m = random.below(3);
          const bool truth = random.chance(10 + 40 * m);
          read.push_back(io.bit(models.bit[m], truth) ? 1 : 0);
          break;
        }
        case 1: {
          const uint32_t truth = random.chance(70) ? 1 : random.below(kTokenCount);
          const uint32_t state = random.below(3);
          TokenRow& row = models.row[state];
          const uint32_t symbol = state == 0 ? io.template token<0>(row, kPositionSchedule, truth)
                                  : state == 1
                                      ? io.template token<1>(row, kPositionSchedule, truth)
                                      : io.template token<2>(row, kAttributeSchedule, truth);
          read.push_back(symbol);
          break;
        }
        case 2: {
          const uint32_t bits = random.below(33);
          const uint64_t mask = (uint64_t{1} << bits) - 1;
          read.push_back(io.raw(bits, static_cast<uint32_t>(random.next() & mask)));
          break;
        }
        case 3: {
          const uint32_t truth = static_cast<uint32_t>(random.next()) >> random.between(1, 31);
          read.push_back(codeGolomb(io, models.golomb, truth));
          break;
        }
        case 4: {
          const int32_t truth = static_cast<int32_t>(random.next() >> 32) >> random.between(1, 31);
          read.push_back(codeSignedGolomb(io, models.signed_golomb, truth));
          break;
        }
        default: read.push_back(codeTree<Io, 6>(io, models.tree, random.below(64)));
      }
    }
  }

  bool sameModels(const Mixture& other) const {
    for (int i = 0; i < 3; ++i) {
      if (models.bit[i].state() != other.models.bit[i].state()) return false;
      if (std::memcmp(models.row[i].c, other.models.row[i].c, sizeof models.row[i].c) != 0)
        return false;
    }
    return std::memcmp(&models.golomb, &other.models.golomb, sizeof models.golomb) == 0 &&
           std::memcmp(&models.tree, &other.models.tree, sizeof models.tree) == 0;
  }
};

template <bool kSingle>
void expectMixture(uint64_t seed, uint32_t count) {
  Mixture encoded;
  EncoderIo encoder(kSingle);
  encoded.run(encoder, seed, count);
  const double cost_bits = static_cast<double>(encoder.cost()) / kCostOne;
  const EncoderIo::Streams streams = encoder.finish();
  if (kSingle) {
    EXPECT_TRUE(streams.tokens.empty());
    EXPECT_TRUE(streams.raw.empty());
  }
  const double spent_bits =
      8.0 * static_cast<double>(streams.codes.size() + streams.tokens.size() + streams.raw.size());
  EXPECT_NEAR(cost_bits, spent_bits, 250 + 0.01 * spent_bits);

  Mixture counted;
  CostIo counter;
  counted.run(counter, seed, count);
  EXPECT_EQ(static_cast<double>(counter.cost()) / kCostOne, cost_bits);

  Mixture decoded;
  DecoderIo<kSingle> decoder(streams.codes, streams.tokens, streams.raw);
  decoded.run(decoder, seed, count);
  EXPECT_EQ(decoded.read, encoded.read);
  EXPECT_TRUE(decoded.sameModels(encoded));
  EXPECT_TRUE(decoded.sameModels(counted));
  EXPECT_TRUE(decoder.finish().ok());
  EXPECT_FALSE(decoder.overrun());
}

TEST(CoderIo, BothModesDecodeWhatTheyEncode) {
  for (const uint32_t count : {0u, 1u, 5u, 100u, 20000u}) {
    for (uint64_t seed = 0; seed < 5; ++seed) {
      expectMixture<true>(seed, count);
      expectMixture<false>(seed, count);
    }
  }
}

TEST(CoderIo, StreamsOfTheWrongLengthAreErrors) {
  EncoderIo encoder(false);
  Mixture mixture;
  mixture.run(encoder, 1, 3000);
  const EncoderIo::Streams streams = encoder.finish();
  const auto finish = [](const EncoderIo::Streams& s) {
    DecoderIo<false> decoder(s.codes, s.tokens, s.raw);
    Mixture decoded;
    decoded.run(decoder, 1, 3000);
    return decoder.finish().error;
  };
  EXPECT_EQ(finish(streams), Error::kOk);
  for (const int which : {0, 1, 2}) {
    const auto stream = [which](EncoderIo::Streams& s) -> std::vector<uint8_t>& {
      return which == 0 ? s.codes : which == 1 ? s.tokens : s.raw;
    };
    EncoderIo::Streams longer = streams;
    stream(longer).resize(stream(longer).size() + 10, 0);
    EXPECT_EQ(finish(longer), Error::kTrailingBytes) << which;
    EncoderIo::Streams shorter = streams;
    stream(shorter).resize(stream(shorter).size() - 10);
    EXPECT_NE(finish(shorter), Error::kOk) << which;
    EncoderIo::Streams empty = streams;
    stream(empty).clear();
    EXPECT_EQ(finish(empty), Error::kTruncated) << which;
  }
}

// ---- Numbers ------------------------------------------------------------------------------------

TEST(Numbers, GolombAtItsExtremes) {
  std::vector<uint32_t> values = {0, 1, 2, 3, 4, 5, 6, 7, 0x7fffffffu, 0xfffffffdu, 0xfffffffeu};
  for (uint32_t shift = 2; shift < 32; ++shift) {
    for (const uint32_t delta : {~1u, ~0u, 0u, 1u}) values.push_back((1u << shift) + delta);
  }
  EncoderIo encoder(true);
  GolombModel model;
  for (const uint32_t value : values) EXPECT_EQ(codeGolomb(encoder, model, value), value);
  const EncoderIo::Streams streams = encoder.finish();
  DecoderIo<true> decoder(streams.codes, {}, {});
  GolombModel decoder_model;
  for (const uint32_t value : values) EXPECT_EQ(codeGolomb(decoder, decoder_model, 0), value);
  EXPECT_TRUE(decoder.finish().ok());
}

TEST(Numbers, SignedGolombAtItsExtremes) {
  constexpr int32_t kMax = std::numeric_limits<int32_t>::max();
  const std::vector<int32_t> values = {0, -1, 1, 100, -100, kMax, -kMax, kMax - 1, 1 - kMax};
  EncoderIo encoder(false);
  GolombModel model;
  for (const int32_t value : values) EXPECT_EQ(codeSignedGolomb(encoder, model, value), value);
  const EncoderIo::Streams streams = encoder.finish();
  DecoderIo<false> decoder(streams.codes, streams.tokens, streams.raw);
  GolombModel decoder_model;
  for (const int32_t value : values) EXPECT_EQ(codeSignedGolomb(decoder, decoder_model, 0), value);
  EXPECT_TRUE(decoder.finish().ok());
}

TEST(Numbers, TreeHoldsEveryValue) {
  EncoderIo encoder(true);
  TreeModel<6> model;
  for (uint32_t value = 0; value < 64; ++value)
    EXPECT_EQ((codeTree<EncoderIo, 6>(encoder, model, value)), value);
  const EncoderIo::Streams streams = encoder.finish();
  DecoderIo<true> decoder(streams.codes, {}, {});
  TreeModel<6> decoder_model;
  for (uint32_t value = 0; value < 64; ++value)
    EXPECT_EQ((codeTree<DecoderIo<true>, 6>(decoder, decoder_model, 0)), value);
}

TEST(Numbers, FrequentNumbersGetCheap) {
  GolombModel model;
  CostIo io;
  for (int i = 0; i < 1000; ++i) codeGolomb(io, model, 5);
  EXPECT_LT(io.cost(), uint64_t{kCostOne} * 150);
}

// ---- Cost ---------------------------------------------------------------------------------------

TEST(Cost, IsTheLogarithm) {
  for (const uint32_t bits : {kTokenBits, kProbabilityBits}) {
    for (uint32_t numerator = 1; numerator <= 1u << bits; numerator += 1 + numerator / 500) {
      const double exact = static_cast<double>(bits) - std::log2(static_cast<double>(numerator));
      EXPECT_NEAR(costOf(numerator, bits) / 65536.0, exact, 0.0015) << numerator;
    }
    for (uint32_t k = 0; k <= bits; ++k) EXPECT_EQ(costOf(1u << k, bits), (bits - k) * kCostOne);
  }
}

}  // namespace
}  // namespace mcc::test
