// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Positions of isolated wedges: any set of any coordinates comes back, in an order that takes no
// bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "entropy/decoder_io.h"
#include "entropy/enc_coder.h"
#include "positions/enc_isolated.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

using Position = std::array<int32_t, 3>;

/// Returns the cost in bits.
template <bool kSingle>
double expectSet(const std::vector<Position>& any_order) {
  std::vector<int32_t> coordinates;
  for (const Position& q : any_order) coordinates.insert(coordinates.end(), q.begin(), q.end());
  std::vector<Position> set;
  for (const uint32_t i : isolatedOrder(coordinates)) set.push_back(any_order[i]);
  const uint32_t count = static_cast<uint32_t>(set.size());
  std::vector<VertexRecord> written(count);
  EncoderIo encoder(kSingle);
  IsolatedModels models;
  EXPECT_TRUE(
      IsolatedCoder<EncoderIo>(encoder, models).run(count, written.data(), set[0].data()).ok());
  const double bits = static_cast<double>(encoder.cost()) / kCostOne;
  const EncoderIo::Streams streams = encoder.finish();
  DecoderIo<kSingle> decoder(streams.codes, streams.tokens, streams.raw);
  std::vector<VertexRecord> read(count);
  IsolatedModels fresh;
  EXPECT_TRUE(
      IsolatedCoder<DecoderIo<kSingle>>(decoder, fresh).run(count, read.data(), nullptr).ok());
  EXPECT_TRUE(decoder.finish().ok());
  for (uint32_t i = 0; i < count; ++i) {
    for (size_t s = 0; s < 3; ++s) {
      EXPECT_EQ(written[i].q[s], set[i][s]) << i;
      EXPECT_EQ(read[i].q[s], set[i][s]) << i;
    }
  }
  return bits;
}

std::vector<Position> randomSet(uint64_t seed, uint32_t count, uint32_t bits) {
  Random random(seed);
  std::vector<Position> set(count);
  for (Position& q : set) {
    for (int32_t& x : q) x = static_cast<int32_t>(random.next() >> (64 - bits));
  }
  return set;
}

TEST(Isolated, SetsComeBack) {
  constexpr int32_t kLeast = std::numeric_limits<int32_t>::min();
  constexpr int32_t kMost = std::numeric_limits<int32_t>::max();
  const std::vector<std::vector<Position>> sets = {
      {{0, 0, 0}},
      {{kLeast, kMost, -1}},
      {{kLeast, kLeast, kLeast}, {kMost, kMost, kMost}},
      {{kLeast, 5, 0}, {kMost, 5, 0}, {0, 5, 0}, {-1, 5, 0}},
      {{7, 7, 7}, {7, 7, 7}, {7, 7, 7}},
      {{1, 2, 3}, {1, 2, 3}, {1, 2, 4}, {0, 2, 3}},
  };
  for (const std::vector<Position>& set : sets) {
    expectSet<true>(set);
    expectSet<false>(set);
  }
  for (uint32_t seed = 0; seed < 200; ++seed) {
    std::vector<Position> set = randomSet(seed, 1 + seed % 70, 1 + seed % 32);
    for (size_t i = 0; i + 1 < set.size(); i += 3) set[i + 1] = set[i];
    expectSet<true>(set);
    expectSet<false>(std::move(set));
  }
}

/// All n! orders are equivalent, so log2(n) - 1.4 bits of each position need not be stored.
TEST(Isolated, OrderCostsNothing) {
  EXPECT_LT(expectSet<false>(randomSet(1, 1000, 12)), 1000 * 28.3);
  EXPECT_LT(expectSet<false>(randomSet(2, 30000, 14)), 30000 * 29.4);
  std::vector<Position> line(5000);
  for (int32_t i = 0; i < 5000; ++i) line[static_cast<size_t>(i)] = {i, 3 * i, -i};
  EXPECT_LT(expectSet<false>(std::move(line)), 5000 * 16);
}

TEST(Isolated, AnyBytesYieldPositions) {
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    std::vector<uint8_t> bytes(random.below(80));
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.below(256));
    DecoderIo<true> decoder(bytes, {}, {});
    std::vector<VertexRecord> records(1 + random.below(200));
    IsolatedModels models;
    const Status status = IsolatedCoder<DecoderIo<true>>(decoder, models)
                              .run(static_cast<uint32_t>(records.size()), records.data(), nullptr);
    EXPECT_TRUE(status.ok() || status.error == Error::kTruncated);
  }
}

}  // namespace
}  // namespace mcc::test
