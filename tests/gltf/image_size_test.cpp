// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quality.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace mcc::gltf::test {
namespace {

using Size = std::pair<uint32_t, uint32_t>;

/// Copies the bytes to the end of a block of memory, where sanitizers see every byte too many.
Size sizeOf(const std::string& text) {
  const std::vector<uint8_t> bytes(text.begin(), text.end());
  const ImageSize size = imageSizeOf(bytes);
  return {size.width, size.height};
}

std::string textFrom(std::initializer_list<int> numbers) {
  std::string bytes;
  for (const int number : numbers) bytes += static_cast<char>(number);
  return bytes;
}

const std::string kPng =
    "\x89PNG\r\n\x1a\n" + textFrom({0, 0, 0, 13}) + "IHDR" + textFrom({0, 1, 0, 2, 0, 0, 3, 4});
/// An application segment of four bytes, a table, and a progressive frame.
const std::string kJpeg = textFrom({0xff, 0xd8, 0xff, 0xe0, 0, 4,  1, 2, 0xff, 0xff, 0xc4, 0,
                                    3,    9,    0xff, 0xc2, 0, 17, 8, 2, 1,    4,    3});
const std::string kLossyWebp = "RIFF????WEBPVP8 ????" + textFrom({0, 0, 0, 0x9d, 1, 0x2a}) +
                               textFrom({1, 0x42, 3, 0x84});  // the upper two bits are a scale
/// 300 x 200: 299 + (199 << 14), little-endian.
const std::string kLosslessWebp = "RIFF????WEBPVP8L????\x2f" + textFrom({0x2b, 0xc1, 0x31, 0});
const std::string kExtendedWebp = "RIFF????WEBPVP8X????????" + textFrom({0xff, 0xff, 0, 1, 0, 1});
const std::string kKtx = "\xabKTX 20\xbb\r\n\x1a\n" + textFrom({0, 0, 0, 0, 1, 0, 0, 0}) +
                         textFrom({0, 8, 0, 0, 0, 4, 0, 0});

TEST(ImageSize, IsInTheHeader) {
  EXPECT_EQ(sizeOf(kPng), Size(65538, 772));
  EXPECT_EQ(sizeOf(kJpeg), Size(1027, 513));
  EXPECT_EQ(sizeOf(kLossyWebp), Size(0x201, 0x403));
  EXPECT_EQ(sizeOf(kLosslessWebp), Size(300, 200));
  EXPECT_EQ(sizeOf(kExtendedWebp), Size(65536, 65538));
  EXPECT_EQ(sizeOf(kKtx), Size(2048, 1024));
}

TEST(ImageSize, OfOtherBytesIsUnknown) {
  EXPECT_EQ(sizeOf(""), Size());
  EXPECT_EQ(sizeOf("DDS and what follows, at length"), Size());
  EXPECT_EQ(sizeOf("RIFF????WEBPALPH????????????????"), Size());
  // Segments that are shorter than their own length, and none at all.
  EXPECT_EQ(sizeOf(textFrom({0xff, 0xd8, 0xff, 0xe0, 0, 1}) + kJpeg.substr(2)), Size());
  EXPECT_EQ(sizeOf(textFrom({0xff, 0xd8, 0xff}) + std::string(5000, '\xff')), Size());
}

TEST(ImageSize, OfAPartIsNotMadeUp) {
  for (const std::string& whole : {kPng, kJpeg, kLossyWebp, kLosslessWebp, kExtendedWebp, kKtx}) {
    const Size size = sizeOf(whole);
    EXPECT_EQ(sizeOf(whole + "and what follows"), size);
    for (size_t bytes = 0; bytes < whole.size(); ++bytes) {
      const Size part = sizeOf(whole.substr(0, bytes));
      EXPECT_TRUE(part.first == 0 || part.first == size.first) << whole << bytes;
      EXPECT_TRUE(part.second == 0 || part.second == size.second) << whole << bytes;
      EXPECT_NE(part, size) << whole << bytes;
    }
  }
}

/// A thousand segments take no time; what comes behind them is not looked at.
TEST(ImageSize, SegmentsAreCounted) {
  std::string many = textFrom({0xff, 0xd8});
  for (int i = 0; i < 999; ++i) many += textFrom({0xff, 0xe1, 0, 2});
  const std::string frame = kJpeg.substr(14);
  EXPECT_EQ(sizeOf(many + frame), Size(1027, 513));
  EXPECT_EQ(sizeOf(many + textFrom({0xff, 0xe1, 0, 2}) + frame), Size());
}

}  // namespace
}  // namespace mcc::gltf::test
