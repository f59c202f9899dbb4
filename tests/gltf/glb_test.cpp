// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/glb.h"

#include <gtest/gtest.h>

#include <functional>

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
  ASSERT_EQ(glb.other_chunks.size(), 1u);
  EXPECT_EQ(glb.other_chunks[0].type, 0x12345678u);
  EXPECT_EQ(glb.other_chunks[0].bytes[0], 9);
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

}  // namespace
}  // namespace mcc::gltf::test
