// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "gltf/gltf_builder.h"
#include "json/json.h"

namespace mcc::gltf::test {
namespace {

std::string reprinted(const std::string& text) {
  Json json;
  const Result result = parseJson(asBytes(text), json);
  return result.ok() ? printJson(json) : "error: " + result.message();
}

TEST(GltfJson, KeepsNumbersAsTheyWereWritten) {
  const std::string text =
      R"({"a":[1e-7,1E+5,-0,-0.0,0.10,1.0,100000000000000000000000,12345678901234567890,)"
      R"(-9223372036854775808,0.1000000000000000055511151231257827,1e308,5e-324,42,-7,2.5]})";
  EXPECT_EQ(reprinted(text), text);
}

TEST(GltfJson, KeepsOrderNullsAndEmptyThings) {
  const std::string text =
      R"({"z":null,"a":{},"m":[],"b":[null,{},[]],"":"","t":true,"f":false,"k":{"y":1,"x":2}})";
  EXPECT_EQ(reprinted(text), text);
}

TEST(GltfJson, NumbersInsideStringsAreNoNumbers) {
  const std::string text = R"({"1e-7":"-0 \"0.10\" \\","x":[1e-7,"2.50",3.50]})";
  EXPECT_EQ(reprinted(text), text);
}

TEST(GltfJson, KeepsTextOfAllLanguages) {
  const std::string text = "{\"n\":\"\xc3\xa9\xe4\xb8\xad\xf0\x9f\x98\x80\\n\"}";
  EXPECT_EQ(reprinted(text), text);
}

TEST(GltfJson, ErrorsNameTheByte) {
  EXPECT_NE(reprinted("{\"a\":1,}").find("error: JSON byte 8"), std::string::npos);
  EXPECT_NE(reprinted("").find("error: JSON byte"), std::string::npos);
  EXPECT_NE(reprinted("{} x").find("error: JSON byte"), std::string::npos);
  EXPECT_NE(reprinted("{\"a\":\"\xff\"}").find("error: JSON byte"), std::string::npos);
}

TEST(GltfJson, RepeatedKeysAreAnErrorExceptInExtras) {
  const std::string kept =
      R"({"extras":{"a":1,"a":2,"n":[{"b":1,"b":[]}]},"z":{"extras":{"":0,"":0}}})";
  EXPECT_EQ(reprinted(kept), kept);
  EXPECT_EQ(reprinted(R"({"a":[{},{"b/c":1,"x":{"extras":{}},"b/c":1}]})"),
            "error: /a/1/b~1c: the key appears twice in one object, which glTF forbids");
  EXPECT_NE(reprinted(R"({"extras":{},"a":1,"a":2})"), R"({"extras":{},"a":1,"a":2})");
  EXPECT_NE(reprinted(R"({"extras":1,"extras":2})"), R"({"extras":1,"extras":2})");
}

TEST(GltfJson, KeysAreWholeTexts) {
  Json json;
  ASSERT_TRUE(parseJson(asBytes(R"({"a\u0000b":1,"a\u0000c":2,"b":3,"a":4})"), json).ok());
  for (const auto& [key, value] : json.items()) {
    EXPECT_EQ(findMember(json, key), &value);
  }
  EXPECT_EQ(findMember(json, "c"), nullptr);
  EXPECT_EQ(findMember(nullptr, "a"), nullptr);
}

TEST(GltfJson, ErrorsSayWhatIsWrong) {
  const std::pair<const char*, const char*> kDamaged[] = {
      {"{\"a: b", "7: the JSON is damaged (a string has no end)"},
      {"", "1: the JSON is damaged (it ends too early)"},
      {"[1 2]", "4: the JSON is damaged (a comma or the end of an array is missing)"},
      {"{\"a\" 1}", "6: the JSON is damaged (a colon is missing after a key)"},
      {"[01]", "3: the JSON is damaged (a comma or the end of an array is missing)"},
      {"[1.]", "4: the JSON is damaged (a number has no digits after its point)"},
      {"[tru]", "5: the JSON is damaged (a value is missing)"},
      {"\"\\x\"", "3: the JSON is damaged (an escape is unknown)"},
      {"\"\\ud800\"", "8: the JSON is damaged (half of a surrogate pair is missing)"},
      {"{} x", "4: the JSON is damaged (something follows the value)"}};
  for (const auto& [text, error] : kDamaged) {
    EXPECT_EQ(reprinted(text), std::string("error: JSON byte ") + error) << text;
  }
}

TEST(GltfJson, DeepNestingIsAnError) {
  const std::string deep(100000, '[');
  EXPECT_NE(reprinted(deep).find("nested deeper"), std::string::npos);
  const std::string fine = std::string(200, '[') + std::string(200, ']');
  EXPECT_EQ(reprinted(fine), fine);
}

TEST(GltfJson, ReadsWholeNumbersInAnySpelling) {
  Json json;
  ASSERT_TRUE(
      parseJson(asBytes(R"({"a":3,"b":3.0,"c":3e0,"d":-1,"e":3.5,"f":"3","g":1e99})"), json).ok());
  for (const char* key : {"a", "b", "c"}) {
    uint64_t value = 0;
    EXPECT_TRUE(readUnsigned(json, key, "", 10, value).ok()) << key;
    EXPECT_EQ(value, 3u);
  }
  for (const char* key : {"d", "e", "f", "g", "missing"}) {
    uint64_t value = 0;
    EXPECT_FALSE(readUnsigned(json, key, "/x", 10, value).ok()) << key;
  }
  uint64_t value = 7;
  EXPECT_TRUE(readOptionalUnsigned(json, "missing", "", 10, value).ok());
  EXPECT_EQ(value, 7u);
  EXPECT_NE(readUnsigned(json, "a", "/x", 2, value).message().find("/x/a: 3 is too large"),
            std::string::npos);
}

}  // namespace
}  // namespace mcc::gltf::test
