// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "json/spelling.h"

#include <algorithm>
#include <charconv>
#include <clocale>
#include <cmath>
#include <concepts>
#include <cstdlib>
#include <iterator>

namespace mcc::gltf {
namespace {

constexpr size_t byteCountOf(uint32_t code) {
  return code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
}

/// Returns the shortest digits of a finite value, as in -1.5e-07.
template <std::floating_point T>
std::string shortestDigits(T value) {
  char text[128];
  const auto digits = [&](auto... precision) {
    constexpr auto kForm = std::chars_format::scientific;
    return std::string(text, std::to_chars(text, std::end(text), value, kForm, precision...).ptr);
  };
  std::string shortest = digits();
  const size_t end = shortest.find('e');
  // Where two spellings are equally near, to_chars takes the even one. We take the larger one, so
  // that files stay what earlier versions have written.
  constexpr int kMore = 25;
  const std::string half = shortest.substr(0, end) + '5' + std::string(kMore - 1, '0');
  char& last = shortest[end - 1];
  if (last != '9' && digits(static_cast<int>(end) + kMore).starts_with(half)) ++last;
  return shortest;
}

}  // namespace

size_t bytesOfCharacter(char first) {
  const auto lead = static_cast<unsigned char>(first);
  if (lead < 0x80) return 1;
  return lead >= 0xf8 || lead < 0xc2 ? 0 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
}

Character firstCharacter(std::string_view text) {
  const size_t byte_count = bytesOfCharacter(text[0]);
  if (byte_count == 0 || byte_count > text.size()) return {};
  uint32_t code =
      static_cast<unsigned char>(text[0]) & (byte_count == 1 ? 0x7f : 0x7f >> byte_count);
  for (const char c : text.substr(1, byte_count - 1)) {
    if (!isContinuation(c)) return {};
    code = code << 6 | (static_cast<unsigned char>(c) & 0x3f);
  }
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  if (byte_count != byteCountOf(code) || code > 0x10ffff || is_surrogate) return {};
  return {code, byte_count};
}

void appendCharacter(uint32_t code, std::string& text) {
  constexpr uint32_t kLeads[] = {0, 0, 0xc0, 0xe0, 0xf0};
  size_t left = byteCountOf(code);
  text += static_cast<char>(kLeads[left] | code >> (6 * (left - 1)));
  while (--left != 0) text += static_cast<char>(0x80 | (code >> (6 * (left - 1)) & 0x3f));
}

double numberOf(std::string_view spelling) {
#if defined(__cpp_lib_to_chars)  // unlike in libc++ before version 20
  double value = 0;
  const char* const end = spelling.data() + spelling.size();
  if (std::from_chars(spelling.data(), end, value).ec == std::errc()) return value;
#endif
  // It may be too large or too small, which this function tells apart. It wants a decimal
  // point.
  std::string text(spelling);
  const size_t point = text.find('.');
  if (point != std::string::npos) text.replace(point, 1, std::localeconv()->decimal_point);
  return std::strtod(text.c_str(), nullptr);  // which is the one of the locale
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
  if (spelling.starts_with('-')) return -wholeNumberOf(spelling.substr(1));
  constexpr double kMost = 9.2e18;
  return static_cast<uint64_t>(std::min(numberOf(spelling), kMost));
}

bool areEqualNumbers(std::string_view a, std::string_view b) {
  if (a == b) return true;
  const bool are_plain = a.find_first_of(".eE") == a.npos && b.find_first_of(".eE") == b.npos;
  return !are_plain && numberOf(a) == numberOf(b);
}

std::string spellingOf(double value) {
  if (!std::isfinite(value)) return "";
  std::string text = shortestDigits(std::abs(value));
  const size_t end = text.find('e');
  int exponent = 0;
  std::from_chars(&text[end + (text[end + 1] == '+' ? 2 : 1)], text.data() + text.size(), exponent);
  constexpr int kLeast = -4;
  constexpr int kMost = 14;
  if (exponent >= kLeast && exponent <= kMost) {
    text.resize(end);
    if (end > 1) text.erase(1, 1);  // the point
    text.insert(0, static_cast<size_t>(std::max(-exponent, 0)), '0');
    const auto point = static_cast<size_t>(std::max(exponent, 0)) + 1;
    text.resize(std::max(text.size(), point + 1), '0');
    text.insert(point, 1, '.');
  }
  return (std::signbit(value) ? "-" : "") + text;
}

std::string spellingOf(float value) {
  // Most readers go through binary64, which rounds twice.
  const double number = numberOf(shortestDigits(value));
  return spellingOf(static_cast<float>(number) == value ? number : double{value});
}

std::string at(const std::string& path, uint64_t index) {
  return path + "/" + std::to_string(index);
}

std::string at(const std::string& path, const std::string& key) {
  std::string pointer = path + "/";  // RFC 6901
  for (const char c : key) pointer += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return pointer;
}

}  // namespace mcc::gltf
