// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A program with another decimal point than JSON's: what the library reads and writes stays the
// same.
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "gltf/round_trip.h"
#include "support/scratch_folder.h"

namespace mcc::gltf::test {
namespace {

/// Gives the program the decimal point of a language, made by localedef if the system does not have
/// it, as long as this object exists.
class DecimalPoint {
 public:
  DecimalPoint(const std::string& language, const std::string& point) {
    const std::string name = language + ".UTF-8";
    if (std::setlocale(LC_ALL, name.c_str()) == nullptr) {
#if !defined(_WIN32)
      const std::string made = (folder_.path() / name).string();
      const std::string command = "localedef -i " + language + " -f UTF-8 '" + made + "' 2>&1";
      if (std::system((command + " > /dev/null").c_str()) == -1) return;
      ::setenv("LOCPATH", folder_.path().c_str(), 1);
      (void)std::setlocale(LC_ALL, name.c_str());
      ::unsetenv("LOCPATH");
#endif
    }
    is_set_ = std::localeconv()->decimal_point == point;
  }
  ~DecimalPoint() { (void)std::setlocale(LC_ALL, "C"); }
  DecimalPoint(const DecimalPoint&) = delete;
  DecimalPoint& operator=(const DecimalPoint&) = delete;

  bool isSet() const { return is_set_; }

 private:
  mcc::test::ScratchFolder folder_;
  bool is_set_ = false;
};

struct Number {
  const char* spelling;
  double value;
};

/// Some are kept as texts, because printing would spell them otherwise.
constexpr Number kNumbers[] = {{"0.10", 0.1},
                               {"0.5", 0.5},
                               {"-2.50", -2.5},
                               {"1.25e-7", 1.25e-7},
                               {"1.5E+3", 1500},
                               {"-0.0", -0.0},
                               {"-0", -0.0},
                               {"1e-400", 0},
                               {"-1.5e-400", -0.0},
                               {"5e-324", 5e-324},
                               {"0.1000000000000000055511151231257827", 0.1},
                               {"1000000000000000000000.50", 1e21},
                               {"18446744073709551616", 18446744073709551616.0},
                               {"1.7976931348623157e308", std::numeric_limits<double>::max()}};

void expectNumbers() {
  for (const Number& number : kNumbers) {
    const std::string text = std::string("[") + number.spelling + "]";
    Json json;
    ASSERT_TRUE(parseJson(asBytes(text), json).ok()) << text;
    double value = 7;
    ASSERT_TRUE(asNumber(json[0], value)) << text;
    EXPECT_EQ(value, number.value) << text;
    EXPECT_EQ(std::signbit(value), std::signbit(number.value)) << text;
    EXPECT_EQ(printJson(json), text);
  }
  Json json;
  EXPECT_FALSE(parseJson(asBytes("[0,5]x"), json).ok());
  EXPECT_EQ(Json(0.5).dump(), "0.5");
}

/// A document with bounds that are spelt as no printer spells them.
std::vector<uint8_t> documentWithBounds() {
  Builder builder;
  builder.addMesh({Sheet(12).addTo(builder)});
  for (Json& accessor : builder.json["accessors"]) {
    for (const char* bound : {"min", "max"}) {
      if (!accessor.contains(bound)) continue;
      for (Json& value : accessor[bound]) {
        const std::string spelling =
            value.dump() + (value.text().find('.') != std::string::npos ? "0" : ".0");
        value = Json::number(spelling);
      }
    }
  }
  return builder.toGlb();
}

std::vector<std::string> messagesOf(std::span<const uint8_t> file) {
  ValidationReport report;
  EXPECT_TRUE(validateGlb(file, {}, report).ok());
  std::vector<std::string> issues;
  for (const ValidationIssue& issue : report.issues) issues.push_back(issue.message);
  return issues;
}

TEST(Locale, NumbersHaveTheValuesOfJson) { expectNumbers(); }

class Language : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(Language, ChangesNoNumberAndNoByte) {
  const std::vector<uint8_t> source = documentWithBounds();
  const RoundTrip usual = roundTrip(source);
  ASSERT_EQ(usual.error, "");
  const std::vector<std::string> usual_issues = messagesOf(usual.converted);
  const DecimalPoint point(GetParam().first, GetParam().second);
  if (!point.isSet()) GTEST_SKIP() << "there is no locale " << GetParam().first << ".UTF-8";
  expectNumbers();
  const RoundTrip trip = roundTrip(source);
  EXPECT_EQ(trip.error, "");
  EXPECT_TRUE(trip.converted == usual.converted);
  EXPECT_TRUE(trip.decoded == usual.decoded);
  EXPECT_EQ(messagesOf(trip.converted), usual_issues);
}

INSTANTIATE_TEST_SUITE_P(Locale, Language,
                         testing::Values(std::pair("de_DE", ","), std::pair("ps_AF", "\xd9\xab")),
                         [](const auto& language) { return std::string(language.param.first); });

}  // namespace
}  // namespace mcc::gltf::test
