// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/crc32.h"
#include "base/enc_bytes.h"
#include "base/lazy.h"
#include "base/memory.h"
#include "base/working_memory.h"
#include "support/mesh_generators.h"
#include "unit/failing_allocator.h"

namespace mcc::test {
namespace {

// ---- Bytes --------------------------------------------------------------------------------------

std::vector<uint8_t> varintOf(uint32_t value) {
  ByteWriter out;
  out.writeVarint(value);
  return out.bytes();
}

TEST(Varint, RoundTripAtEveryLength) {
  std::vector<uint32_t> values = {0, 1, 0xfffffffeu, 0xffffffffu};
  for (uint32_t shift = 1; shift < 32; ++shift) {
    for (const uint32_t delta : {~0u, 0u, 1u}) values.push_back((1u << shift) + delta);
  }
  for (const uint32_t value : values) {
    const std::vector<uint8_t> bytes = varintOf(value);
    size_t expected_bytes = 1;
    for (uint32_t rest = value >> 7; rest != 0; rest >>= 7) ++expected_bytes;
    EXPECT_EQ(bytes.size(), expected_bytes) << value;
    ByteReader in(bytes);
    uint32_t read = ~value;
    ASSERT_TRUE(in.readVarint(read).ok()) << value;
    EXPECT_EQ(read, value);
    EXPECT_EQ(in.remaining(), 0u);
    for (size_t size = 0; size < bytes.size(); ++size) {
      const std::vector<uint8_t> cut(bytes.begin(),
                                     bytes.begin() + static_cast<std::ptrdiff_t>(size));
      ByteReader short_in(cut);
      EXPECT_EQ(short_in.readVarint(read).error, Error::kTruncated) << value;
    }
  }
}

TEST(Varint, LeastSignificantFirst) {
  EXPECT_EQ(varintOf(300), (std::vector<uint8_t>{0xac, 0x02}));
  EXPECT_EQ(varintOf(0xffffffffu), (std::vector<uint8_t>{0xff, 0xff, 0xff, 0xff, 0x0f}));
}

TEST(Varint, RefusesWhatNoWriterMakes) {
  const std::vector<std::vector<uint8_t>> malformed = {
      {0x80, 0x00},                                // zero in two bytes
      {0xff, 0x80, 0x00},                          // a redundant last byte
      {0xff, 0xff, 0xff, 0xff, 0x10},              // bit 32
      {0xff, 0xff, 0xff, 0xff, 0x7f},              // bits 32..34
      {0xff, 0xff, 0xff, 0xff, 0x8f, 0x00},        // a sixth byte
      {0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x01},  // endless
      {0x80, 0x80, 0x80, 0x80, 0x00},
  };
  for (const std::vector<uint8_t>& bytes : malformed) {
    ByteReader in(bytes);
    uint32_t value = 77;
    const Status status = in.readVarint(value);
    EXPECT_EQ(status.error, Error::kBadHeader);
    EXPECT_EQ(status.offset_bytes, 0u);
    EXPECT_EQ(value, 77u);
  }
}

TEST(ByteReader, FieldsAndOffsets) {
  ByteWriter out;
  out.writeU8(0xab);
  out.writeU32(0x01020304);
  out.writeHighBytes(0xbfc00001, 2);
  out.writeBytes(std::vector<uint8_t>{7, 8, 9});
  EXPECT_EQ(out.size(), 10u);
  EXPECT_EQ(out.bytes()[1], 4);  // little-endian

  ByteReader in(out.bytes());
  uint8_t u8 = 0;
  uint32_t u32 = 0;
  std::span<const uint8_t> rest;
  ASSERT_TRUE(in.readU8(u8).ok());
  ASSERT_TRUE(in.readU32(u32).ok());
  EXPECT_EQ(in.offset(), 5u);
  uint32_t high = 0;
  ASSERT_TRUE(in.readHighBytes(high, 2).ok());
  ASSERT_TRUE(in.readBytes(2, rest).ok());
  EXPECT_EQ(u8, 0xab);
  EXPECT_EQ(u32, 0x01020304u);
  EXPECT_EQ(high, 0xbfc00000u);
  EXPECT_EQ(rest[0], 7);
  EXPECT_EQ(in.remaining(), 1u);
  const Status status = in.readU32(u32);
  EXPECT_EQ(status.error, Error::kTruncated);
  EXPECT_EQ(status.offset_bytes, 9u);
  EXPECT_EQ(in.readBytes(2, rest).error, Error::kTruncated);
  EXPECT_EQ(in.readBytes(std::numeric_limits<size_t>::max(), rest).error, Error::kTruncated);
  EXPECT_EQ(in.remaining(), 1u);  // a failed read takes nothing
  ASSERT_TRUE(in.readU8(u8).ok());
  EXPECT_EQ(in.readU8(u8).error, Error::kTruncated);
}

TEST(Zigzag, IsABijection) {
  constexpr int32_t kMin = std::numeric_limits<int32_t>::min();
  constexpr int32_t kMax = std::numeric_limits<int32_t>::max();
  const int32_t ordered[] = {0, -1, 1, -2, 2, -3, 3};
  for (uint32_t i = 0; i < 7; ++i) EXPECT_EQ(zigzag(ordered[i]), i);
  EXPECT_EQ(zigzag(kMax), 0xfffffffeu);
  EXPECT_EQ(zigzag(kMin), 0xffffffffu);
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const uint32_t value = static_cast<uint32_t>(random.next()) >> random.below(32);
    EXPECT_EQ(zigzag(unzigzag(value)), value);
    EXPECT_EQ(zigzag(unzigzag(~value)), ~value);
  }
}

// ---- Checksum -----------------------------------------------------------------------------------

uint32_t crcOf(std::string_view text) {
  return crc32({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

/// Bit by bit, from the definition.
uint32_t plainCrc(std::span<const uint8_t> bytes) {
  uint32_t crc = ~0u;
  for (const uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
  }
  return ~crc;
}

TEST(Crc32, KnownVectors) {
  EXPECT_EQ(crcOf(""), 0u);
  EXPECT_EQ(crcOf("a"), 0xe8b7be43u);
  EXPECT_EQ(crcOf("123456789"), 0xcbf43926u);
  EXPECT_EQ(crcOf("The quick brown fox jumps over the lazy dog"), 0x414fa339u);
  EXPECT_EQ(crc32(std::vector<uint8_t>(32, 0)), 0x190a55adu);
  EXPECT_EQ(crc32(std::vector<uint8_t>(32, 0xff)), 0xff6cab0bu);
}

TEST(Crc32, LongInputsAndContinuation) {
  Random random(2);
  std::vector<uint8_t> bytes(5000);
  for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.below(256));
  const std::span<const uint8_t> all(bytes);
  for (const size_t size : {1u, 7u, 8u, 1023u, 1024u, 1025u, 1031u, 1032u, 2048u, 4999u}) {
    EXPECT_EQ(crc32(all.first(size)), plainCrc(all.first(size))) << size;
    EXPECT_EQ(crc32(all.subspan(1, size)), plainCrc(all.subspan(1, size))) << size;  // unaligned
  }
  const uint32_t whole = plainCrc(all);
  for (const size_t split : {0u, 1u, 8u, 9u, 1024u, 2500u, 3976u, 3977u, 4999u, 5000u}) {
    EXPECT_EQ(crc32(all.subspan(split), crc32(all.first(split))), whole) << split;
  }
}

// ---- Memory -------------------------------------------------------------------------------------

TEST(Array, GrowsAndKeepsItsElements) {
  FailingAllocator memory;
  {
    Array<uint32_t> array(memory.allocator());
    EXPECT_TRUE(array.empty());
    for (uint32_t i = 0; i < 1000; ++i) ASSERT_TRUE(array.push_back(i));
    for (uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(array[i], i);
    EXPECT_EQ(array.back(), 999u);
    EXPECT_LT(memory.allocations(), 20u);
    EXPECT_EQ(memory.liveBlocks(), 1u);
    array.pop_back();
    EXPECT_EQ(array.size(), 999u);
    ASSERT_TRUE(array.assign(5, 7));
    EXPECT_EQ(array[4], 7u);
    EXPECT_EQ(array.size(), 5u);

    const uint64_t before = memory.allocations();
    array.clear();
    ASSERT_TRUE(array.resize(900));
    EXPECT_EQ(memory.allocations(), before);  // the capacity stays
    Array<uint32_t> moved(std::move(array));
    EXPECT_EQ(moved.size(), 900u);
    Array<uint32_t> assigned(memory.allocator());
    ASSERT_TRUE(assigned.push_back(1));
    assigned = std::move(moved);
    EXPECT_EQ(assigned.size(), 900u);
    assigned.reset();
    EXPECT_TRUE(assigned.empty());
  }
  EXPECT_EQ(memory.liveBlocks(), 0u);
  EXPECT_TRUE(memory.booksBalance());
}

TEST(Array, IsAsItWasWhenMemoryRunsOut) {
  for (uint64_t allocations = 0; allocations < 6; ++allocations) {
    FailingAllocator memory(allocations);
    {
      Array<uint64_t> array(memory.allocator());
      uint64_t count = 0;
      while (array.push_back(count)) ++count;
      EXPECT_EQ(count == 0, allocations == 0);
      EXPECT_EQ(array.size(), count);
      for (uint64_t i = 0; i < count; ++i) ASSERT_EQ(array[i], i);
      EXPECT_FALSE(array.reserve(count + 1));
      EXPECT_FALSE(array.resize(count + 1));
      EXPECT_FALSE(array.assign(count + 1, 9));
      EXPECT_EQ(array.size(), count);
      for (uint64_t i = 0; i < count; ++i) ASSERT_EQ(array[i], i);
      EXPECT_TRUE(array.resize(count));
    }
    EXPECT_EQ(memory.liveBlocks(), 0u);
    EXPECT_TRUE(memory.booksBalance());
  }
}

TEST(Array, RefusesSizesThatWrap) {
  FailingAllocator memory;
  Array<uint64_t> array(memory.allocator());
  EXPECT_FALSE(array.reserve(std::numeric_limits<size_t>::max() / 8 + 1));
  EXPECT_FALSE(array.resize(std::numeric_limits<size_t>::max() / 4));
  EXPECT_EQ(memory.allocations(), 0u);
}

TEST(Array, DefaultAllocatorIsTheHeap) {
  Array<uint8_t> array;
  ASSERT_TRUE(array.assign(100, 3));
  EXPECT_EQ(array[99], 3);
}

// ---- WorkingMemory ------------------------------------------------------------------------------

struct Block {
  uint8_t* memory;
  size_t bytes;
  uint8_t filling;

  bool isUnharmed() const {
    return std::all_of(memory, memory + bytes, [this](uint8_t x) { return x == filling; });
  }
};

TEST(WorkingMemory, BlocksAreDisjointAligned) {
  WorkingMemory memory(1000);
  const Allocator allocator = memory.allocator();
  std::vector<Block> blocks;
  Random random(5);
  const auto releaseOne = [&](size_t i) {
    ASSERT_TRUE(blocks[i].isUnharmed());
    releaseBytes(allocator, blocks[i].memory, blocks[i].bytes);
    blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(i));
  };
  for (uint32_t step = 0; step < 400; ++step) {
    static_assert(WorkingMemory::kLargeBytes < 1u << 24);
    if (blocks.size() > 6 || (!blocks.empty() && random.below(3) == 0)) {
      releaseOne(random.below(static_cast<uint32_t>(blocks.size())));
      continue;
    }
    const size_t bytes = size_t{1} + random.below(1u << (8 + step % 17));
    void* block = allocateBytes(allocator, bytes);
    ASSERT_NE(block, nullptr);
    if (bytes >= WorkingMemory::kSmallBytes) {
      EXPECT_EQ(reinterpret_cast<uintptr_t>(block) % 64, 0u);
    }
    blocks.push_back({static_cast<uint8_t*>(block), bytes, static_cast<uint8_t>(step)});
    std::memset(block, blocks.back().filling, bytes);
  }
  while (!blocks.empty()) releaseOne(blocks.size() - 1);
}

TEST(WorkingMemory, WhatWasReleasedIsJoinedAndUsedAgain) {
  constexpr size_t kBytes = WorkingMemory::kPageBytes / 4;
  WorkingMemory memory(4 * kBytes);
  void* first[4];
  for (void*& block : first) block = memory.allocate(kBytes);
  for (const int i : {2, 0, 3, 1}) memory.release(first[i], kBytes);
  EXPECT_EQ(memory.allocate(4 * kBytes), first[0]);
  memory.release(first[0], 4 * kBytes);
}

TEST(WorkingMemory, RefusesWhatNoMachineHas) {
  WorkingMemory memory(std::numeric_limits<uint64_t>::max());
  EXPECT_EQ(memory.allocate(std::numeric_limits<size_t>::max() - 10), nullptr);
  void* block = memory.allocate(100000);  // more was expected than there is, but this much is there
  ASSERT_NE(block, nullptr);
  memory.release(block, 100000);
}

// ---- Lazy ---------------------------------------------------------------------------------------

TEST(Lazy, MadeOnceAndCopiedAsItIs) {
  struct Counter {
    uint32_t count = 7;
  };
  Lazy<Counter> lazy[2];
  ASSERT_NE(lazy[0].get({}), nullptr);
  EXPECT_EQ(lazy[0].get({})->count, 7u);
  ++lazy[0].get({})->count;
  EXPECT_EQ(lazy[0].get({})->count, 8u);
  Lazy<Counter> copy[2];
  ++copy[1].get({})->count;
  ASSERT_TRUE(copyLazy(copy, lazy, {}));
  EXPECT_EQ(copy[0].get({})->count, 8u);
  EXPECT_EQ(copy[1].get({})->count, 7u);  // as before its first use
}

TEST(Lazy, NullWithoutMemory) {
  Allocator none;
  none.allocate = [](void*, size_t) -> void* { return nullptr; };
  Lazy<int> lazy;
  EXPECT_EQ(lazy.get(none), nullptr);
  Lazy<int> made;
  EXPECT_NE(made.get({}), nullptr);
  EXPECT_FALSE(lazy.copyFrom(made, none));
  EXPECT_TRUE(made.copyFrom(lazy, {}));  // neither is made now
}

}  // namespace
}  // namespace mcc::test
