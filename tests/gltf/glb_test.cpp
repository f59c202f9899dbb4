// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/glb.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>

#include "support/gltf_builder.h"

namespace mcc::gltf::test {
namespace {

std::vector<uint8_t> sampleGlb() {
  Builder builder;
  builder.addView({1, 2, 3, 4, 5});
  return builder.toGlb();
}

void setU32(std::vector<uint8_t>& file, size_t offset, uint32_t value) {
  for (size_t i = 0; i < 4; ++i) file[offset + i] = static_cast<uint8_t>(value >> (8 * i));
}

std::string readError(const std::vector<uint8_t>& file) {
  GlbFile glb;
  return readGlb(file, glb).message();
}

TEST(Glb, WritesWhatItReads) {
  const std::vector<uint8_t> file = sampleGlb();
  GlbFile glb;
  ASSERT_TRUE(readGlb(file, glb).ok());
  EXPECT_EQ(file.size() % 4, 0u);
  EXPECT_EQ(glb.bin.size(), 8u);  // padded with zeros
  EXPECT_EQ(glb.bin[4], 5);
  EXPECT_EQ(glb.bin[5], 0);
  EXPECT_FALSE(glb.has_trailing_bytes);
}

TEST(Glb, KeepsUnknownChunks) {
  const std::vector<uint8_t> extra = {9, 8, 7, 6};
  const GlbChunk chunk = {0x12345678, extra};
  std::vector<uint8_t> file;
  ASSERT_TRUE(writeGlb("{}", {}, {&chunk, 1}, file).ok());
  GlbFile glb;
  ASSERT_TRUE(readGlb(file, glb).ok());
  const std::vector<GlbChunk> others = glb.otherChunks({});
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].type, 0x12345678u);
  EXPECT_EQ(others[0].bytes[0], 9);
  EXPECT_FALSE(glb.has_bin);
}

TEST(Glb, EveryTruncationIsAnError) {
  const std::vector<uint8_t> file = sampleGlb();
  for (size_t size = 0; size < file.size(); ++size) {
    const std::vector<uint8_t> part(file.begin(), file.begin() + static_cast<ptrdiff_t>(size));
    EXPECT_NE(readError(part), "") << size;
  }
}

TEST(Glb, TrailingBytesAreCounted) {
  std::vector<uint8_t> file = sampleGlb();
  file.push_back(1);
  GlbFile glb;
  ASSERT_TRUE(readGlb(file, glb).ok());
  EXPECT_TRUE(glb.has_trailing_bytes);
}

TEST(Glb, ErrorsNameTheByte) {
  struct Case {
    const char* expected;
    std::function<void(std::vector<uint8_t>&)> damage;
  };
  const std::vector<uint8_t> good = sampleGlb();
  const uint32_t json_bytes = static_cast<uint32_t>(good[12]) | static_cast<uint32_t>(good[13])
                                                                    << 8;
  const size_t second = 20 + json_bytes;
  const std::vector<Case> cases = {
      {"byte 0: ", [](auto& f) { f[0] = 'x'; }},
      {"byte 4: GLB version 1", [](auto& f) { setU32(f, 4, 1); }},
      {"byte 4: GLB version 4", [](auto& f) { setU32(f, 4, 4); }},
      {"byte 8: the header says 4294967292 bytes", [](auto& f) { setU32(f, 8, 0xfffffffc); }},
      {"byte 8: the length 16", [](auto& f) { setU32(f, 8, 16); }},
      {"byte 8: the length 21", [](auto& f) { setU32(f, 8, 21); }},
      {"byte 12: the chunk length 3 ", [](auto& f) { setU32(f, 12, 3); }},
      {"byte 12: the chunk of 4294967292", [](auto& f) { setU32(f, 12, 0xfffffffc); }},
      {"byte 12: the first chunk", [](auto& f) { setU32(f, 16, 7); }},
      {"second JSON chunk", [=](auto& f) { setU32(f, second + 4, 0x4e4f534a); }},
  };
  for (const Case& test : cases) {
    std::vector<uint8_t> file = good;
    test.damage(file);
    EXPECT_NE(readError(file).find(test.expected), std::string::npos) << readError(file);
  }
}

TEST(Glb, SecondBinChunkIsAnError) {
  std::vector<uint8_t> file = sampleGlb();
  const std::vector<uint8_t> chunk = {4, 0, 0, 0, 'B', 'I', 'N', 0, 1, 2, 3, 4};
  file.insert(file.end(), chunk.begin(), chunk.end());
  setU32(file, 8, static_cast<uint32_t>(file.size()));
  EXPECT_NE(readError(file).find("second BIN chunk"), std::string::npos);
}

std::vector<uint8_t> copyOf(std::span<const uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

void setU64(std::vector<uint8_t>& file, size_t offset, uint64_t value) {
  setU32(file, offset, static_cast<uint32_t>(value));
  setU32(file, offset + 4, static_cast<uint32_t>(value >> 32));
}

TEST(Glb3, ReadsChunksOfAnyNumberOrderAndLength) {
  std::mt19937 random(7);
  for (int round = 0; round < 500; ++round) {
    const size_t before = random() % 3;  // chunks in front of the document
    std::vector<Chunk3> chunks;
    for (size_t i = 0; i < before + 1 + random() % 4; ++i) {
      const std::string types[] = {std::string("BIN\0", 4), "MORE", i > before ? "JSON" : "LESS"};
      Chunk3 chunk = i == before ? jsonChunk("{}") : Chunk3{types[random() % 3], {}, 0};
      if (i != before) chunk.bytes.assign(random() % 20, static_cast<uint8_t>(i + 1));
      chunks.push_back(chunk);
    }
    const std::vector<uint8_t> file = glb3Of(chunks);
    GlbFile glb;
    const Result read = readGlb(file, glb);
    ASSERT_TRUE(read.ok()) << read.message();
    EXPECT_EQ(glb.version, 3u);
    EXPECT_EQ(glb.json_chunk, before);
    EXPECT_EQ(copyOf(glb.json), chunks[before].bytes);
    ASSERT_EQ(glb.chunks.size(), chunks.size());
    for (size_t i = 0; i < chunks.size(); ++i) {
      EXPECT_EQ(copyOf(glb.chunks[i].bytes), chunks[i].bytes) << i;
    }
    const bool has_bin = before == 0 && chunks.size() > 1 && chunks[1].type[0] == 'B';
    EXPECT_EQ(glb.has_bin, has_bin);
    EXPECT_EQ(glb.otherChunks({}).size(), chunks.size() - 1);
    const std::set<size_t> used = {0, chunks.size() - 1};
    EXPECT_EQ(glb.otherChunks(used).size(),
              chunks.size() - used.size() - (used.contains(before) ? 0 : 1));
  }
}

TEST(Glb3, EveryTruncationIsAnError) {
  const std::vector<uint8_t> file = glb3Of({jsonChunk("{ }"), binChunk({1, 2, 3})});
  for (size_t size = 0; size < file.size(); ++size) {
    std::vector<uint8_t> part(file.begin(), file.begin() + static_cast<ptrdiff_t>(size));
    EXPECT_NE(readError(part), "") << size;
    if (size < 16) continue;
    // With a length that fits, what is left may be whole: the document ends at 35, the buffer at
    // 59, and padding need not be there.
    setU64(part, 8, size);
    EXPECT_EQ(readError(part) == "", (size >= 35 && size <= 40) || size >= 59) << size;
  }
}

TEST(Glb3, ErrorsNameTheByte) {
  struct Case {
    const char* expected;
    std::function<void(std::vector<uint8_t>&)> damage;
  };
  const std::vector<uint8_t> good = glb3Of({jsonChunk("{     }"), binChunk({1, 2, 3})});
  const uint64_t kMost = ~uint64_t{0};
  const std::vector<Case> cases = {
      {"byte 8: the header says 18446744073709551615 bytes", [=](auto& f) { setU64(f, 8, kMost); }},
      {"byte 8: the header says 9223372036854775808 b", [](auto& f) { setU64(f, 8, 1ull << 63); }},
      {"byte 8: the header says 4294967360 bytes", [](auto& f) { setU32(f, 12, 1); }},
      {"byte 8: the length 31", [](auto& f) { setU64(f, 8, 31); }},
      {"byte 16: the chunk of 18446744073709551615", [=](auto& f) { setU64(f, 24, kMost); }},
      // With its header and its padding it would end at 0.
      {"byte 16: the chunk of 18446744073709551584", [=](auto& f) { setU64(f, 24, kMost - 31); }},
      {"byte 16: the chunk of 4294967303", [](auto& f) { setU32(f, 28, 1); }},
      {"byte 20: the chunk has the encoding 1;", [](auto& f) { setU32(f, 20, 1); }},
      {"byte 44: the chunk has the encoding 4294967295", [](auto& f) { setU32(f, 44, ~0u); }},
      {"byte 40: the chunk of 9 bytes", [](auto& f) { setU64(f, 48, 9); }},
      {"byte 16: there is no JSON chunk", [](auto& f) { setU32(f, 16, 7); }},
      {"the file ends inside a chunk header", [](auto& f) { setU64(f, 8, 55); }},
  };
  for (const Case& test : cases) {
    std::vector<uint8_t> file = good;
    test.damage(file);
    EXPECT_NE(readError(file).find(test.expected), std::string::npos)
        << test.expected << " / " << readError(file);
  }
}

TEST(Glb3, WritesWhatTheDraftSays) {
  const std::vector<uint8_t> extra = {9, 8, 7};
  const std::vector<uint8_t> more = {'[', ']'};
  const GlbChunk others[] = {{0x45524f4d, extra}, {kJsonChunk, more}, {kBinChunk, extra}};
  const std::vector<uint8_t> bin = {1, 2, 3, 4, 5};
  std::vector<uint8_t> file;
  ASSERT_TRUE(writeGlb("{}", bin, others, file, 3).ok());
  // The document and its buffer are padded inside of their chunks.
  EXPECT_EQ(file, glb3Of({jsonChunk("{}      "),
                          binChunk({1, 2, 3, 4, 5, 0, 0, 0}),
                          {"MORE", extra, 0},
                          {"JSON", more, 0},
                          binChunk(extra)}));
  ASSERT_TRUE(writeGlb("{}", bin, others, file, 2).ok());
  GlbFile glb;
  ASSERT_TRUE(readGlb(file, glb).ok());
  EXPECT_EQ(glb.version, 2u);
  EXPECT_EQ(glb.chunks.size(), 3u);  // version 2 has no place for the others
  std::vector<uint8_t> smallest;
  ASSERT_TRUE(writeGlb("{}", bin, others, smallest).ok());
  EXPECT_EQ(smallest, file);
  EXPECT_FALSE(writeGlb("{}", bin, others, file, 1).ok());
}

}  // namespace
}  // namespace mcc::gltf::test
