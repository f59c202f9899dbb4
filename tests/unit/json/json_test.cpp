// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "json/json.h"
#include "support/gltf_builder.h"

namespace mcc::gltf::test {
namespace {

std::string reprinted(const std::string& text) {
  Json json;
  const Result result = parseJson(asBytes(text), json);
  return result.ok() ? printJson(json) : "error: " + result.message();
}

TEST(Json, KeepsNumbersAsTheyWereWritten) {
  const std::string text =
      R"({"a":[1e-7,1E+5,-0,-0.0,0.10,1.0,100000000000000000000000,12345678901234567890,)"
      R"(-9223372036854775808,0.1000000000000000055511151231257827,1e308,5e-324,42,-7,2.5]})";
  EXPECT_EQ(reprinted(text), text);
}

TEST(Json, KeepsOrderNullsAndEmptyThings) {
  const std::string text =
      R"({"z":null,"a":{},"m":[],"b":[null,{},[]],"":"","t":true,"f":false,"k":{"y":1,"x":2}})";
  EXPECT_EQ(reprinted(text), text);
}

TEST(Json, NumbersInsideStringsAreNoNumbers) {
  const std::string text = R"({"1e-7":"-0 \"0.10\" \\","x":[1e-7,"2.50",3.50]})";
  EXPECT_EQ(reprinted(text), text);
}

TEST(Json, KeepsTextOfAllLanguages) {
  const std::string text = "{\"n\":\"\xc3\xa9\xe4\xb8\xad\xf0\x9f\x98\x80\\n\"}";
  EXPECT_EQ(reprinted(text), text);
}

TEST(Json, CopiesShareWhatNobodyChanges) {
  const std::string text = R"({"a":[{"x":1},{"y":[2,3]}],"b":{"c":{"d":4}},"e":5})";
  const Json source = Json::parse(text);
  const Json same = source;
  EXPECT_EQ(&same["a"][1], &source["a"][1]);
  Json edited = source;
  edited["a"][1]["y"].push_back(6);
  edited["b"]["c"].erase("d");
  edited.erase("e");
  EXPECT_EQ(edited.dump(), R"({"a":[{"x":1},{"y":[2,3,6]}],"b":{"c":{}}})");
  EXPECT_EQ(source.dump(), text);
  EXPECT_EQ(same.dump(), text);
  const Json& as_const = edited;
  EXPECT_EQ(&as_const["a"][0]["x"], &source["a"][0]["x"])
      << "was copied although nobody changed it";
}

TEST(Json, EveryChangeOfACopyLeavesTheSourceAlone) {
  Json source = Json::object();
  for (int i = 0; i < 40; ++i)
    source[std::to_string(i)] = Json::array({i, Json::object({{"n", i}})});
  const std::string text = source.dump();
  const std::function<void(Json&)> changes[] = {
      [](Json& json) { json["7"][1]["n"] = 8; },
      [](Json& json) { json.find("7")->push_back(1); },
      [](Json& json) { json.erase("7"); },
      [](Json& json) { json.append("new", nullptr); },
      [](Json& json) {
        json.update(Json::object({{"3", 4}}));
      },
      [](Json& json) { json.back() = 1; },
      [](Json& json) { json.erase(std::as_const(json).begin(), std::as_const(json).end()); },
      [](Json& json) { *json.begin() = "text"; },
      [](Json& json) {
        const Json& shared = json;
        json.erase(shared.begin() + 3, shared.begin() + 9);
      },
  };
  for (const auto& change : changes) {
    Json copy = source;
    change(copy);
    EXPECT_EQ(source.dump(), text);
    EXPECT_NE(copy.dump(), text);
    for (size_t i = 0; i < copy.size(); ++i) {
      EXPECT_EQ(std::as_const(copy).find(copy.keyAt(i)), &std::as_const(copy)[i]);
    }
  }
}

TEST(Json, ErrorsNameTheByte) {
  EXPECT_NE(reprinted("{\"a\":1,}").find("error: JSON byte 8"), std::string::npos);
  EXPECT_NE(reprinted("").find("error: JSON byte"), std::string::npos);
  EXPECT_NE(reprinted("{} x").find("error: JSON byte"), std::string::npos);
  EXPECT_NE(reprinted("{\"a\":\"\xff\"}").find("error: JSON byte"), std::string::npos);
}

TEST(Json, RepeatedKeysAreAnErrorExceptInExtras) {
  const std::string kept =
      R"({"extras":{"a":1,"a":2,"n":[{"b":1,"b":[]}]},"z":{"extras":{"":0,"":0}}})";
  EXPECT_EQ(reprinted(kept), kept);
  EXPECT_EQ(reprinted(R"({"a":[{},{"b/c":1,"x":{"extras":{}},"b/c":1}]})"),
            "error: /a/1/b~1c: the key appears twice in one object, which glTF forbids");
  EXPECT_NE(reprinted(R"({"extras":{},"a":1,"a":2})"), R"({"extras":{},"a":1,"a":2})");
  EXPECT_NE(reprinted(R"({"extras":1,"extras":2})"), R"({"extras":1,"extras":2})");
}

TEST(Json, KeysAreWholeTexts) {
  Json json;
  ASSERT_TRUE(parseJson(asBytes(R"({"a\u0000b":1,"a\u0000c":2,"b":3,"a":4})"), json).ok());
  for (const auto& [key, value] : json.items()) {
    EXPECT_EQ(findMember(json, key), &value);
  }
  EXPECT_EQ(findMember(json, "c"), nullptr);
  EXPECT_EQ(findMember(nullptr, "a"), nullptr);
}

TEST(Json, ErrorsSayWhatIsWrong) {
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

TEST(Json, DeepNestingIsAnError) {
  const std::string deep(100000, '[');
  EXPECT_NE(reprinted(deep).find("nested deeper"), std::string::npos);
  const std::string fine = std::string(200, '[') + std::string(200, ']');
  EXPECT_EQ(reprinted(fine), fine);
}

TEST(Json, ReadsWholeNumbersInAnySpelling) {
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

/// What is no integer of 64 bits is cut or clamped, as the bounds of accessors may be.
TEST(Json, WholeNumbersOfAnySpelling) {
  const std::pair<const char*, uint64_t> kNumbers[] = {
      {"0", 0},
      {"-0", 0},
      {"-1", ~uint64_t{0}},
      {"-9223372036854775808", uint64_t{1} << 63},
      {"18446744073709551615", ~uint64_t{0}},
      {"9007199254740992.0", uint64_t{1} << 53},
      {"1.8e16", 18000000000000000},
      {"-3.0", static_cast<uint64_t>(int64_t{-3})},
      {"-3.9", static_cast<uint64_t>(int64_t{-3})},
      {"3.9", 3},
      {"1e300", 9200000000000000000},
      {"-1e300", static_cast<uint64_t>(int64_t{-9200000000000000000})},
      {"-1e19", static_cast<uint64_t>(int64_t{-9200000000000000000})}};
  for (const auto& [spelling, value] : kNumbers)
    EXPECT_EQ(wholeNumberOf(spelling), value) << spelling;
  uint64_t value = 0;
  EXPECT_TRUE(readUnsigned("9007199254740992.0", value));
  EXPECT_FALSE(readUnsigned("9007199254740994.0", value));
  EXPECT_FALSE(readUnsigned("0.5", value));
  EXPECT_FALSE(readUnsigned("-1.0", value));
}

/// Texts in the manner of nst's JSONTestSuite, https://github.com/nst/JSONTestSuite: whether each
/// is JSON.
TEST(Json, TakesJsonAndNothingElse) {
  const std::vector<std::string> good = {"[]",
                                         "[[]]",
                                         " [ ] ",
                                         "{}",
                                         "null",
                                         "true",
                                         "false",
                                         "\"\"",
                                         "0",
                                         "-0",
                                         "-1",
                                         "1.5",
                                         "1e1",
                                         "1E+2",
                                         "0e1",
                                         "[1e-2]",
                                         "[123.456e78]",
                                         "[0.4e006999999999999999999]",
                                         "[-237462374673276894279832749832423479823246327846]",
                                         "[1,null]",
                                         "{\"\":0}",
                                         "{\"a\":[]}",
                                         "{\"\\u0000\":1}",
                                         "[\"\\ud83d\\ude39\"]",
                                         "[\"\\\"\\\\\\/\\b\\f\\n\\r\\t\"]",
                                         "[\"\x7f\"]",
                                         "[\"\xf4\x8f\xbf\xbf\"]",
                                         "[\"\xe2\x80\xa8\"]",
                                         "[\"\\uDBFF\\uDFFE\"]",
                                         "\xef\xbb\xbf{}",
                                         "\r\n\t []\n",
                                         "[\"a/*b*/c\"]"};
  const std::vector<std::string> bad = {"",
                                        " ",
                                        "[",
                                        "]",
                                        "[1",
                                        "[1,",
                                        "[1,]",
                                        "[,1]",
                                        "[1,,2]",
                                        "[1 true]",
                                        "[a]",
                                        "{",
                                        "}",
                                        "{\"a\"",
                                        "{\"a\":",
                                        "{\"a\":1",
                                        "{\"a\":1,}",
                                        "{,}",
                                        "{a:1}",
                                        "{'a':1}",
                                        "{1:1}",
                                        "{\"a\" 1}",
                                        "{\"a\"::1}",
                                        "{\"a\":1 \"b\":2}",
                                        "[1:2]",
                                        "[}",
                                        "{]",
                                        "nul",
                                        "nulll",
                                        "True",
                                        "[tru]",
                                        "[-]",
                                        "[+1]",
                                        "[.5]",
                                        "[1.]",
                                        "[1.e1]",
                                        "[01]",
                                        "[-01]",
                                        "[1e]",
                                        "[1e+]",
                                        "[0x1]",
                                        "[1_0]",
                                        "[NaN]",
                                        "[Infinity]",
                                        "[-Infinity]",
                                        "[1a]",
                                        "[\"a]",
                                        "\"",
                                        "[\"\\\"]",
                                        "[\"\\x00\"]",
                                        "[\"\\u\"]",
                                        "[\"\\u00g0\"]",
                                        "[\"\\u123\"]",
                                        "[\"\\ud800\"]",
                                        "[\"\\ud800\\u0041\"]",
                                        "[\"\\udc00\"]",
                                        "[\"\\ud800x\"]",
                                        "[\"\t\"]",
                                        "[\"\n\"]",
                                        std::string("[\"\0\"]", 5),
                                        "[\"\xff\"]",
                                        "[\"\xc3\"]",
                                        "[\"\xc0\xaf\"]",
                                        "[\"\xed\xa0\x80\"]",
                                        "[\"\xf4\x90\x80\x80\"]",
                                        "[\"\xe0\x80\x80\"]",
                                        "[]]",
                                        "[] []",
                                        "{}x",
                                        "[/*a*/]",
                                        "[//a\n]",
                                        "\xef\xbb",
                                        "\xef\xbb[]",
                                        std::string("[\0]", 3),
                                        "\v[]",
                                        "\xc2\xa0[]"};
  for (const std::string& text : good) EXPECT_FALSE(reprinted(text).starts_with("error")) << text;
  for (const std::string& text : bad) EXPECT_TRUE(reprinted(text).starts_with("error")) << text;
}

/// The first and the last of what each kind of escape stands for.
TEST(Json, EscapesOfStringsAndKeys) {
  for (const auto& [written, text] : std::initializer_list<std::pair<std::string, std::string>>{
           {"\\\"\\\\\\/\\b\\f\\n\\r\\t", "\"\\/\b\f\n\r\t"},
           {"\\u0000", std::string(1, '\0')},
           {"\\u20aC", "\xe2\x82\xac"},
           {"\\ud7ff\\ue000", "\xed\x9f\xbf\xee\x80\x80"},
           {"\\ud800\\udc00", "\xf0\x90\x80\x80"},
           {"\\ud83d\\ude39", "\xf0\x9f\x98\xb9"},
           {"\\uDBFF\\uDFFF", "\xf4\x8f\xbf\xbf"}}) {
    EXPECT_EQ(Json::parse("\"" + written + "\"").get<std::string>(), text) << written;
    const Json object = Json::parse("{\"" + written + "\":1}");
    EXPECT_TRUE(object.contains(text)) << written;
  }
}

/// What a text is made of does not depend on where its parts end.
TEST(Json, PartsOfATextAreOneText) {
  const std::string text =
      "\xef\xbb\xbf{\"k\\u00e9\xe4\xb8\xad\":[1.5e-3,\"\\ud83d\\ude39\xf0\x9f\x98\x80\",true,null],"
      "\"\":{}} ";
  struct Told : JsonListener {
    std::string all;
    Result add(const std::string& what) {
      all += what + ";";
      return {};
    }
    Result begin(Json::Kind kind, uint64_t byte) override {
      return add((kind == Json::Kind::kObject ? "{" : "[") + std::to_string(byte));
    }
    Result end(uint64_t byte) override { return add("end" + std::to_string(byte)); }
    Result key(std::string key) override { return add("key " + key); }
    Result value(Json value) override { return add(value.dump()); }
  };
  const auto told = [](std::string_view rest, size_t byte_count) {
    Told listener;
    const Result result = scanJson(
        [&] {
          const std::string_view part = rest.substr(0, byte_count);
          rest.remove_prefix(part.size());
          return part;
        },
        listener);
    return listener.all + result.message();
  };
  for (size_t end = 0; end <= text.size(); ++end) {
    const std::string_view whole = std::string_view(text).substr(0, end);
    for (size_t byte_count = 1; byte_count < 8; ++byte_count) {
      ASSERT_EQ(told(whole, byte_count), told(whole, end)) << end << " " << byte_count;
    }
  }
}

TEST(Json, MembersAreFoundHoweverManyThereAre) {
  std::mt19937 random(1);
  Json json = Json::object();
  std::vector<std::pair<std::string, uint32_t>> model;
  for (uint32_t step = 0; step < 4000; ++step) {
    const std::string key = "k" + std::to_string(random() % 60);
    const auto known =
        std::find_if(model.begin(), model.end(), [&](const auto& m) { return m.first == key; });
    const uint32_t what = random() % 8;
    if (what < 5) {
      json[key] = step;
      if (known != model.end()) {
        known->second = step;
      } else {
        model.emplace_back(key, step);
      }
    } else {
      json.erase(key);
      if (known != model.end()) model.erase(known);
    }
    if (step % 50 == 0) json = Json(json);
    ASSERT_EQ(json.size(), model.size());
    for (size_t i = 0; i < model.size(); ++i) {
      ASSERT_EQ(json.keyAt(i), model[i].first);
      ASSERT_EQ(json.find(model[i].first), &json[i]);
      ASSERT_EQ(json[i], model[i].second);
    }
    ASSERT_FALSE(json.contains("none"));
  }
}

/// A member may be given the value of another one of the same object.
TEST(Json, MembersAreCopiedWithinAnObject) {
  Json json = {{"a", "text"}};
  for (int i = 0; i < 40; ++i) json["b" + std::to_string(i)] = json["a"];
  for (const Json& value : json) EXPECT_EQ(value, "text");
}

TEST(Json, NumbersAreSpeltAsShortAsTheyCanBe) {
  const std::pair<double, const char*> kSpellings[] = {{0.5, "0.5"},
                                                       {-0.0, "-0.0"},
                                                       {3, "3.0"},
                                                       {1e15, "1e+15"},
                                                       {123456789012345, "123456789012345.0"},
                                                       {1e-7, "1e-07"},
                                                       {0.0001, "0.0001"},
                                                       {0.00001, "1e-05"},
                                                       {1.5e300, "1.5e+300"},
                                                       {-2.5e-10, "-2.5e-10"},
                                                       {3.28751373291015625, "3.2875137329101563"}};
  for (const auto& [value, spelling] : kSpellings) EXPECT_EQ(Json(value).dump(), spelling);
  EXPECT_TRUE(Json(std::numeric_limits<double>::infinity()).is_null());
  std::mt19937_64 random(2);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(Json::parse(Json(value).dump()).get<double>(), value);
  }
}

/// Readers round the numbers of `min` and `max` to binary32, most of them by way of binary64.
TEST(Json, FloatsAreSpeltAsShortAsFloatsCanBe) {
  const std::pair<float, const char*> kSpellings[] = {{0.1f, "0.1"},
                                                      {-0.0f, "-0.0"},
                                                      {3, "3.0"},
                                                      {0.44999998807907104f, "0.45"},
                                                      {-73.14839935302734f, "-73.1484"},
                                                      {16777216, "16777216.0"},
                                                      {1e-45f, "1e-45"},
                                                      {3.4028234663852886e38f, "3.4028235e+38"}};
  for (const auto& [value, spelling] : kSpellings) EXPECT_EQ(spellingOf(value), spelling);
  std::mt19937 random(3);
  for (int i = 0; i < 200000; ++i) {
    const auto value = std::bit_cast<float>(static_cast<uint32_t>(random()));
    if (!std::isfinite(value)) continue;
    const std::string spelling = spellingOf(value);
    ASSERT_EQ(static_cast<float>(numberOf(spelling)), value) << spelling;
    ASSERT_LE(spelling.size(), spellingOf(double{value}).size());
  }
}

TEST(Json, NumbersOfAnySizeHaveAValue) {
  const auto valueOf = [](const std::string& spelling) {
    return Json::parse(spelling).get<double>();
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(valueOf("1e400"), kInfinity);
  EXPECT_EQ(valueOf("-1e99999999999999999999"), -kInfinity);
  EXPECT_EQ(valueOf("1e-99999999999999999999"), 0);
  EXPECT_EQ(valueOf("0." + std::string(400, '0') + "1e401"), 1);
  EXPECT_EQ(valueOf("1" + std::string(400, '0') + "e-400"), 1);
  EXPECT_EQ(valueOf("1" + std::string(400, '0')), kInfinity);
  const std::pair<const char*, int64_t> kWhole[] = {{"-9223372036854775808", INT64_MIN},
                                                    {"-5.0", -5},
                                                    {"-2.5", -2},
                                                    {"2.5", 2},
                                                    {"1e30", 9200000000000000000},
                                                    {"780181660808542531203", 9200000000000000000},
                                                    {"-1e30", -9200000000000000000}};
  for (const auto& [spelling, value] : kWhole)
    EXPECT_EQ(Json::parse(spelling).get<int64_t>(), value) << spelling;
}

/// What is JSON is JSON wherever a value may stand, and what begins it is not.
TEST(Json, ValuesMayStandAnywhere) {
  const char* const kGood[] = {"[]",
                               "{}",
                               "null",
                               "-0",
                               "1E+2",
                               "\"\"",
                               "0e1",
                               "true",
                               "[1,[]]",
                               "{\"\":[{}]}",
                               "\"\\ud83d\\ude39\""};
  const char* const kBad[] = {"nul", "01",  "-",      "1.",          "1e",       "\"\\x\"",
                              "[1",  "{1}", "\"\t\"", "\"\\udc00\"", "\"\xff\"", "[1 2]"};
  const std::pair<const char*, const char*> kAround[] = {{"", ""},          {" \n", "\t"},
                                                         {"[", "]"},        {"[0 , ", "\n,1]"},
                                                         {"{\"k\" :", "}"}, {"[{\"k\":", "}]"}};
  for (const auto& [before, after] : kAround) {
    for (const std::string text : kBad)
      EXPECT_TRUE(reprinted(before + text + after).starts_with("error")) << before + text + after;
    for (const std::string text : kGood) {
      const std::string whole = before + text + after;
      const std::string printed = reprinted(whole);
      EXPECT_EQ(reprinted(printed), printed) << whole;
      EXPECT_FALSE(printed.starts_with("error")) << whole;
      if (*before != '[' && *before != '{') continue;
      for (size_t end = 0; end + 1 < whole.size(); ++end)
        EXPECT_TRUE(reprinted(whole.substr(0, end)).starts_with("error")) << whole << " " << end;
    }
  }
}

TEST(Json, PrintsForPeopleAndForTerminals) {
  const Json json = {
      {"a", {1, "\x1b\xc3\xa9\xf0\x9f\x98\x80\xff"}}, {"b", Json::array()}, {"c", Json::object()}};
  EXPECT_EQ(json.dump(2, true),
            "{\n  \"a\": [\n    1,\n    \"\\u001b\\u00e9\\ud83d\\ude00\\ufffd\"\n  ],\n  \"b\": "
            "[],\n  \"c\": {}\n}");
}

}  // namespace
}  // namespace mcc::gltf::test
