// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Damaged payloads must give an error or a valid shape, never anything else. MCC_MUTATIONS sets the
// number of mutations of a small payload; big ones get fewer. MCC_FIRST_MUTATION selects other
// ones.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "format/flags.h"
#include "robustness/damage.h"
#include "robustness/payloads.h"

namespace mcc::test {
namespace {

constexpr uint64_t kMutations = 2000;
constexpr size_t kSmallBytes = 1200;

size_t headerBytes(const NamedPayload& payload) {
  Payload opened;
  EXPECT_TRUE(opened.open(payload.bytes).ok());
  return static_cast<size_t>(opened.info().header_bytes);
}

TEST(Damage, IntactPayloadsDecode) {
  bool single = false;
  bool triple = false;
  for (const NamedPayload& payload : robustnessPayloads()) {
    const Outcome outcome = decodeDamaged(payload.bytes);
    EXPECT_EQ(outcome.error, Error::kOk) << payload.name;
    EXPECT_EQ(outcome.failure, "") << payload.name;
    EXPECT_TRUE(outcome.reached_decode) << payload.name;
    Payload opened;
    ASSERT_TRUE(opened.open(payload.bytes).ok());
    (opened.info().single_coder ? single : triple) = true;
  }
  EXPECT_TRUE(single && triple);
}

TEST(Damage, EveryTruncationIsAnError) {
  for (const NamedPayload& payload : robustnessPayloads()) {
    const size_t step = payload.bytes.size() > kSmallBytes ? 29 : 1;
    for (size_t size = 0; size < payload.bytes.size(); size += step) {
      // A copy of exactly its size, so that the sanitizer sees every read beyond it.
      const std::vector<uint8_t> cut(payload.bytes.begin(),
                                     payload.bytes.begin() + static_cast<std::ptrdiff_t>(size));
      Payload opened;
      const Error error = opened.open(cut).error;
      EXPECT_TRUE(error == (size == 0                 ? Error::kBadMagic
                            : size < kChecksummedFrom ? Error::kTruncated
                                                      : Error::kBadChecksum))
          << payload.name << " cut to " << size << ": " << static_cast<int>(error);
      EXPECT_EQ(opened.info().pieces.size(), 0u);
    }
  }
}

TEST(Damage, EveryFlippedBitIsAnError) {
  for (const NamedPayload& payload : robustnessPayloads()) {
    if (payload.bytes.size() > kSmallBytes) continue;
    std::vector<uint8_t> damaged = payload.bytes;
    for (size_t bit = 0; bit < 8 * damaged.size(); ++bit) {
      damaged[bit / 8] = static_cast<uint8_t>(damaged[bit / 8] ^ 1u << bit % 8);
      Payload opened;
      EXPECT_FALSE(opened.open(damaged).ok()) << payload.name << ", bit " << bit;
      damaged[bit / 8] = payload.bytes[bit / 8];
    }
  }
}

TEST(Damage, TruncationsWithAGoodChecksum) {
  Watchdog watchdog;
  for (size_t p = 0; p < robustnessPayloads().size(); ++p) {
    const NamedPayload& payload = robustnessPayloads()[p];
    const size_t step = payload.bytes.size() > kSmallBytes ? payload.bytes.size() / 200 : 1;
    uint64_t shapes = 0;
    for (size_t size = payload.bytes.size() - 1; size >= 8; size -= std::min(step, size)) {
      std::vector<uint8_t> cut(payload.bytes.begin(),
                               payload.bytes.begin() + static_cast<std::ptrdiff_t>(size));
      repairChecksum(cut);
      watchdog.step(p, size);
      const Outcome outcome = decodeDamaged(cut);
      EXPECT_EQ(outcome.failure, "") << payload.name << " cut to " << size;
      shapes += outcome.error == Error::kOk ? 1 : 0;
    }
    // The last words of a stream may change without being noticed, but no others.
    EXPECT_LE(shapes, 32u) << payload.name;
  }
}

TEST(Damage, TrailingBytesWithAGoodChecksum) {
  for (const NamedPayload& payload : robustnessPayloads()) {
    for (const int filler : {0, 0x55, 0xff}) {
      for (const size_t count : {9u, 16u, 1000u}) {
        std::vector<uint8_t> longer = payload.bytes;
        longer.resize(longer.size() + count, static_cast<uint8_t>(filler));
        repairChecksum(longer);
        const Outcome outcome = decodeDamaged(longer);
        EXPECT_EQ(outcome.failure, "") << payload.name;
        if (filler == 0) {
          EXPECT_EQ(outcome.error, Error::kTrailingBytes) << payload.name;
        }
      }
    }
  }
}

/// Every value of every byte of the header.
TEST(Damage, HeaderBytes) {
  Watchdog watchdog;
  for (size_t p = 0; p < robustnessPayloads().size(); ++p) {
    const NamedPayload& payload = robustnessPayloads()[p];
    if (payload.bytes.size() > 400) continue;
    const size_t header_bytes = headerBytes(payload);
    for (size_t i = kChecksummedFrom; i < header_bytes; ++i) {
      for (uint32_t value = 0; value < 256; ++value) {
        std::vector<uint8_t> damaged = payload.bytes;
        damaged[i] = static_cast<uint8_t>(value);
        repairChecksum(damaged);
        watchdog.step(p, i * 256 + value);
        const Outcome outcome = decodeDamaged(damaged);
        ASSERT_EQ(outcome.failure, "") << payload.name << ", byte " << i << " = " << value;
      }
    }
  }
}

TEST(Damage, Mutations) {
  const uint64_t count = fromEnvironment("MCC_MUTATIONS", kMutations);
  const uint64_t first = fromEnvironment("MCC_FIRST_MUTATION", 0);
  Watchdog watchdog;
  std::map<Error, uint64_t> errors;
  uint64_t reached_decode = 0;
  uint64_t all = 0;
  for (size_t p = 0; p < robustnessPayloads().size(); ++p) {
    const NamedPayload& payload = robustnessPayloads()[p];
    const size_t header_bytes = headerBytes(payload);
    const uint64_t size_factor = 1 + payload.bytes.size() / kSmallBytes;
    for (uint64_t i = first; i < first + (count + size_factor - 1) / size_factor; ++i) {
      Random random(i * 1000 + p);
      std::vector<uint8_t> damaged = mutated(payload.bytes, header_bytes, random);
      repairChecksum(damaged);
      watchdog.step(p, i);
      const Outcome outcome = decodeDamaged(damaged);
      ASSERT_EQ(outcome.failure, "") << payload.name << ", mutation " << i;
      ++errors[outcome.error];
      ++all;
      reached_decode += outcome.reached_decode ? 1 : 0;
    }
  }
  for (const auto& [error, times] : errors) {
    RecordProperty("error_" + std::to_string(static_cast<int>(error)), std::to_string(times));
  }
  // Make sure that the mutations are useful: most get past the header, and each stage refuses some.
  EXPECT_GT(reached_decode, all / 3);
  for (const Error error : {Error::kTruncated, Error::kBadHeader, Error::kBadConnectivity,
                            Error::kBadAttribute, Error::kTrailingBytes}) {
    EXPECT_GT(errors[error], 0u) << static_cast<int>(error);
  }
}

}  // namespace
}  // namespace mcc::test
