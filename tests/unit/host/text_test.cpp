// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "host/text.h"

#include <gtest/gtest.h>

namespace mcc::gltf::test {
namespace {

TEST(Printable, KeepsTextsOfAllLanguages) {
  for (const std::string text :
       {"", "plain text, 100 %",
        "Gr\xc3\xb6\xc3\x9f"
        "e",
        "\xe4\xb8\xad\xe6\x96\x87", "\xf0\x9f\x98\x80", "\xc2\xa0", "\xef\xbf\xbd"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_TRUE(isUtf8(text)) << text;
  }
}

TEST(Printable, NothingThatATerminalObeys) {
  EXPECT_EQ(printable("\033[31mred\033[0m"), "?[31mred?[0m");
  EXPECT_EQ(printable("a\nb\tc\rd\be\a\x7f"), "a?b?c?d?e??");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "?31m");  // C1: CSI
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "gpj.exe"),
            "?gpj.exe");                                     // turns the direction
  EXPECT_EQ(printable("\xe2\x81\xa6x\xe2\x80\xa8"), "?x?");  // and a separator of lines
}

TEST(Printable, BytesThatAreNotUtf8) {
  const std::pair<const char*, const char*> cases[] = {
      {"\x9b", "?"},
      {"\xc0\x9b", "??"},  // overlong
      {"\xe0\x82\x9b", "???"},
      {"\xed\xa0\x80", "???"},       // a surrogate
      {"\xf4\x90\x80\x80", "????"},  // above the last character
      {"\xe4\xb8", "??"},            // cut
      {"\xe4\xb8z", "??z"}};
  for (const auto& [text, clean] : cases) {
    EXPECT_EQ(printable(text), clean);
    EXPECT_FALSE(isUtf8(text)) << clean;
  }
}

/// Whatever the bytes: the result is printable itself, and not longer.
TEST(Printable, IsIdempotent) {
  uint32_t seed = 7;
  for (int i = 0; i < 2000; ++i) {
    std::string text;
    for (int k = 0; k < 12; ++k) {
      seed = seed * 1664525 + 1013904223;
      text += static_cast<char>(seed >> 24);
    }
    const std::string once = printable(text);
    EXPECT_EQ(printable(once), once);
    EXPECT_LE(once.size(), text.size());
  }
}

TEST(Printable, IsCutBetweenCharacters) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc…");
  EXPECT_EQ(shortened("a\xe4\xb8\xad", 2), "a…");
}

}  // namespace
}  // namespace mcc::gltf::test
