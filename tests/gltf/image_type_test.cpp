// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/package.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace mcc::gltf::test {
namespace {

std::string imageTypeOfText(const std::string& bytes) {
  return imageTypeOf({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

/// The fewest bytes that show what an image is.
TEST(ImageType, FirstBytesTell) {
  for (const auto& [bytes, type] : std::initializer_list<std::pair<std::string, const char*>>{
           {"\x89PNG", "image/png"},
           {"\xff\xd8\xff", "image/jpeg"},
           {"\xabKTX 20\xbb", "image/ktx2"},
           {"RIFF????WEBP", "image/webp"},
           {"DDS ", "image/vnd-ms.dds"},
           {"????ftypavif", "image/avif"},
           {"????ftypavis", "image/avif"},
           {std::string("sB??\x4d\0", 6), "image/basis"}}) {
    EXPECT_EQ(imageTypeOfText(bytes), type) << bytes;
    EXPECT_EQ(imageTypeOfText(bytes + "and what follows"), type) << bytes;
    EXPECT_EQ(imageTypeOfText(bytes.substr(0, bytes.size() - 1)), "") << bytes;
    EXPECT_EQ(imageTypeOfText("?" + bytes), "") << bytes;
  }
}

/// Every byte of a signature counts, not only some of them.
TEST(ImageType, OtherFilesHaveNone) {
  for (const std::string& bytes :
       {std::string(), std::string("????????????"), std::string(12, '\0'),
        std::string("sC??\x4d\0", 6), std::string("sB??\x4e\0", 6), std::string("sB??\x4d\1", 6),
        std::string("?????\0", 6), std::string("RIFF????WAVE"), std::string("RIFF"),
        std::string("RIFF???"), std::string("????ftypmp42")}) {
    EXPECT_EQ(imageTypeOfText(bytes), "") << bytes;
  }
}

}  // namespace
}  // namespace mcc::gltf::test
