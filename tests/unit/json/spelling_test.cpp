// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "json/spelling.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace mcc::gltf::test {
namespace {

/// The first and the last code point of each length, and those beside the surrogates.
TEST(Utf8, LengthsChangeWhereTheyShould) {
  for (const auto& [code, bytes] :
       std::initializer_list<std::pair<uint32_t, std::string>>{{0x7f, "\x7f"},
                                                               {0x80, "\xc2\x80"},
                                                               {0x7ff, "\xdf\xbf"},
                                                               {0x800, "\xe0\xa0\x80"},
                                                               {0x20ac, "\xe2\x82\xac"},
                                                               {0xd7ff, "\xed\x9f\xbf"},
                                                               {0xe000, "\xee\x80\x80"},
                                                               {0xffff, "\xef\xbf\xbf"},
                                                               {0x10000, "\xf0\x90\x80\x80"},
                                                               {0x10ffff, "\xf4\x8f\xbf\xbf"}}) {
    std::string text = "a";
    appendCharacter(code, text);
    EXPECT_EQ(text, "a" + bytes) << code;
  }
}

}  // namespace
}  // namespace mcc::gltf::test
