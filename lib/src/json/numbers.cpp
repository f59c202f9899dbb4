// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "json/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <limits>
#if !defined(__cpp_lib_to_chars)
#include <clocale>
#include <cstdlib>
#endif

namespace mcc::gltf {
namespace {

/// Whether a number of JSON that binary64 cannot hold is too large, instead of too small. Compares
/// the power of ten of its first digit with 0, because it is far from it.
bool isHuge(std::string_view number) {
  if (number.starts_with('-')) number.remove_prefix(1);
  const size_t end = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, end);
  const auto point = static_cast<int64_t>(std::min(digits.find('.'), digits.size()));
  const auto first =
      static_cast<int64_t>(std::min(digits.find_first_of("123456789"), digits.size()));
  int64_t power = point - first;
  if (end == number.size()) return power > 0;
  number.remove_prefix(end + 1);
  const bool is_negative = number.starts_with('-');
  if (is_negative || number.starts_with('+')) number.remove_prefix(1);
  int64_t exponent = std::numeric_limits<int64_t>::max() / 2;  // stays if it is even larger
  std::from_chars(number.data(), number.data() + number.size(), exponent);
  power += is_negative ? -exponent : exponent;
  return power > 0;
}

/// Reads a number that binary64 can hold.
bool readNumber(std::string_view spelling, double& value) {
#if defined(__cpp_lib_to_chars)
  return std::from_chars(spelling.data(), spelling.data() + spelling.size(), value).ec ==
         std::errc();
#else  // such as libc++ before version 20: the function wants the decimal point of the locale
  std::string text(spelling);
  const size_t point = text.find('.');
  if (point != std::string::npos) text.replace(point, 1, std::localeconv()->decimal_point);
  value = std::strtod(text.c_str(), nullptr);  // which is the one of the locale
  return std::isfinite(value);
#endif
}

/// A finite value as 0.DIGITS * 10^point.
struct Decimal {
  std::string digits;
  int point = 0;
};

Decimal decimalOf(const char* begin, const char* end) {
  Decimal decimal;
  const char* c = begin;
  for (; c != end && *c != 'e'; ++c) {
    if (*c != '.') decimal.digits += *c;
  }
  std::from_chars(c + (c[1] == '+' ? 2 : 1), end, decimal.point);
  ++decimal.point;
  return decimal;
}

template <std::floating_point T>
Decimal shortestDecimal(T value) {
  char text[128];
  constexpr auto kForm = std::chars_format::scientific;
  Decimal shortest = decimalOf(text, std::to_chars(text, text + sizeof text, value, kForm).ptr);
  // Of two that are as near, to_chars takes the even one.
  const size_t size = shortest.digits.size();
  constexpr int kMore = 25;
  const char* const end =
      std::to_chars(text, text + sizeof text, value, kForm, static_cast<int>(size) + kMore).ptr;
  const std::string more = decimalOf(text, end).digits;
  const bool is_half = more[size] == '5' && more.find_first_not_of('0', size + 1) == more.npos &&
                       more.starts_with(shortest.digits);
  if (is_half && shortest.digits.back() != '9') ++shortest.digits.back();
  return shortest;
}

template <std::floating_point T>
std::string shortestSpelling(T value) {
  if (value == 0) return std::signbit(value) ? "-0.0" : "0.0";
  const auto [digits, point] = shortestDecimal(std::abs(value));
  const auto size = static_cast<int>(digits.size());
  const std::string sign = value < 0 ? "-" : "";
  const auto zeros = [](int count) { return std::string(static_cast<size_t>(count), '0'); };
  constexpr int kMostDigits = 15;
  constexpr int kMostZeros = 4;
  if (size <= point && point <= kMostDigits) return sign + digits + zeros(point - size) + ".0";
  if (0 < point && point <= kMostDigits) {
    return sign + digits.substr(0, static_cast<size_t>(point)) + "." +
           digits.substr(static_cast<size_t>(point));
  }
  if (-kMostZeros < point && point <= 0) return sign + "0." + zeros(-point) + digits;
  const std::string exponent = std::to_string(std::abs(point - 1));
  return sign + digits.substr(0, 1) + (size == 1 ? "" : ".") + digits.substr(1) +
         (point < 1 ? "e-" : "e+") + (exponent.size() < 2 ? "0" : "") + exponent;
}

}  // namespace

double numberOf(std::string_view spelling) {
  double value = 0;
  if (readNumber(spelling, value)) return value;
  value = isHuge(spelling) ? std::numeric_limits<double>::infinity() : 0;
  return spelling.starts_with('-') ? -value : value;
}

bool readUnsigned(std::string_view spelling, uint64_t& value) {
  const char* const end = spelling.data() + spelling.size();
  const auto [read, code] = std::from_chars(spelling.data(), end, value);
  if (read == end && code == std::errc()) return true;
  const double number = numberOf(spelling);
  constexpr double kMost = 9007199254740992.0;
  if (!(number >= 0 && number <= kMost) || number != std::floor(number)) return false;
  value = static_cast<uint64_t>(number);
  return true;
}

uint64_t wholeNumberOf(std::string_view spelling) {
  uint64_t value = 0;
  if (readUnsigned(spelling, value)) return value;
  int64_t negative = 0;
  const char* const end = spelling.data() + spelling.size();
  if (std::from_chars(spelling.data(), end, negative).ptr == end) {
    return static_cast<uint64_t>(negative);
  }
  const double number = numberOf(spelling);
  constexpr double kMost = 9.2e18;
  return static_cast<uint64_t>(static_cast<int64_t>(std::clamp(number, -kMost, kMost)));
}

bool areEqualNumbers(std::string_view a, std::string_view b) {
  if (a == b) return true;
  const bool are_plain = a.find_first_of(".eE") == a.npos && b.find_first_of(".eE") == b.npos;
  return !are_plain && numberOf(a) == numberOf(b);
}

std::string spellingOf(double value) { return shortestSpelling(value); }

std::string spellingOf(float value) {
  std::string shortest = shortestSpelling(value);
  // Most readers go through binary64, which rounds twice.
  const bool is_read_back = static_cast<float>(numberOf(shortest)) == value;
  return is_read_back ? shortest : spellingOf(double{value});
}

}  // namespace mcc::gltf
