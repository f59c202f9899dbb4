// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/package.h"

#include <gtest/gtest.h>

namespace mcc::gltf::test {
namespace {

TEST(Uri, AcceptsFilesBesideTheModel) {
  const std::pair<const char*, const char*> cases[] = {
      {"a.bin", "a.bin"},           {"sub/a.bin", "sub/a.bin"},
      {"./a%20b.bin", "./a b.bin"}, {"sub/../a.bin", "sub/../a.bin"},
      {"..a.bin", "..a.bin"},       {"%C3%A9.bin", "\xc3\xa9.bin"}};
  for (const auto& [uri, expected] : cases) {
    std::string path;
    EXPECT_TRUE(relativePathOf(uri, "", path).ok()) << uri;
    EXPECT_EQ(path, expected);
  }
}

TEST(Uri, RefusesEverythingElse) {
  for (const char* uri : {"",
                          "/etc/passwd",
                          "//host/a",
                          "\\\\host\\a",
                          "\\a",
                          "file:///a",
                          "file:a",
                          "FILE:a",
                          "http://a/b",
                          "https://a",
                          "C:\\a",
                          "c:a",
                          "../a",
                          "..\\a",
                          "sub/../../a",
                          "a/b/../../../c",
                          "%2e%2e/a",
                          "%2E%2E%2Fa",
                          "..%5ca",
                          "%2fetc/passwd",
                          "%66ile:///a",
                          "a%00b",
                          "a\nb",
                          "%zz",
                          "%4",
                          "..",
                          "mailto:x"}) {
    std::string path;
    const Result result = relativePathOf(uri, "/buffers/0/uri", path);
    EXPECT_FALSE(result.ok()) << uri;
    EXPECT_EQ(result.where, "/buffers/0/uri");
    EXPECT_EQ(result.what.find('\n'), std::string::npos);
  }
}

TEST(Uri, DecodesData) {
  const std::pair<const char*, std::vector<uint8_t>> cases[] = {
      {"data:application/octet-stream;base64,AQID", {1, 2, 3}},
      {"data:application/gltf-buffer;base64,AQI=", {1, 2}},
      {"data:;base64,AQ==", {1}},
      {"data:;base64,AQ", {1}},
      {"data:;base64,", {}},
      {"data:;base64,-_8", {0xfb, 0xff}},
      {"data:text/plain,a%20b", {'a', ' ', 'b'}}};
  for (const auto& [uri, expected] : cases) {
    std::vector<uint8_t> bytes;
    EXPECT_TRUE(decodeDataUri(uri, "", bytes).ok()) << uri;
    EXPECT_EQ(bytes, expected) << uri;
  }
}

TEST(Uri, DamagedDataIsAnError) {
  for (const char* uri : {"data:;base64", "data:;base64,A",
                          "data:;base64,A*==", "data:;base64,AQ=I", "data:text/plain,%x"}) {
    std::vector<uint8_t> bytes;
    EXPECT_FALSE(decodeDataUri(uri, "/x", bytes).ok()) << uri;
  }
}

/// Names that Windows takes for devices, for streams of other files, or for other names.
TEST(Uri, PathsOnWindows) {
  for (const char* path :
       {"a.bin", "textures/a b.png", "../a", "./a", "a/./b", "CONE", "com", "com10", "lpt.d/x",
        "nu.l", "Größe ☃.bin", ".hidden", "a..b", "con1", ""}) {
    EXPECT_TRUE(isPathOnWindows(path)) << path;
  }
  for (const char* path :
       {"NUL",          "nul",  "a/Con",   "aux/b",  "prn.png",  "NUL .txt",  "com1",
        "COM9.bin",     "LPT0", "lpt².x",  "conin$", "CONOUT$",  "a b:c",     "C:a",
        "a.bin::$DATA", "a.",   "b/.. /c", "b/a ",   "...",      "what?.bin", "a*",
        "<a>",          "a|b",  "a\"b",    "a\\b",   "\xff.bin", "a/\xe9",    "b\xe4\xb8"}) {
    EXPECT_FALSE(isPathOnWindows(path)) << path;
  }
}

}  // namespace
}  // namespace mcc::gltf::test
