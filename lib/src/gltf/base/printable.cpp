// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/base/printable.h"

#include <cstdint>

namespace mcc::gltf {
namespace {

struct Character {
  uint32_t code = 0;
  size_t byte_count = 0;  ///< 0: not UTF-8
};

bool isContinuation(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// Returns the first character of a text that is not empty.
Character firstCharacter(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return {lead, 1};
  const size_t byte_count = lead >= 0xf8   ? 0
                            : lead >= 0xf0 ? 4
                            : lead >= 0xe0 ? 3
                            : lead >= 0xc2 ? 2
                                           : 0;
  if (byte_count == 0 || byte_count > text.size()) return {};
  uint32_t code = lead & (0x7fu >> byte_count);
  for (size_t i = 1; i < byte_count; ++i) {
    if (!isContinuation(text[i])) return {};
    code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3fu);
  }
  constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  if (code < kLeast[byte_count] || code > 0x10ffff || is_surrogate) return {};
  return {code, byte_count};
}

bool isPrintable(uint32_t code) {
  if (code < 0x20 || (code >= 0x7f && code < 0xa0)) return false;
  if (code == 0x2028 || code == 0x2029) return false;  // line and paragraph separators
  const bool turns = code == 0x061c || code == 0x200e || code == 0x200f ||
                     (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return !turns;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const Character first = firstCharacter(text);
    const size_t byte_count = first.byte_count == 0 ? 1 : first.byte_count;
    if (first.byte_count != 0 && isPrintable(first.code)) {
      clean += text.substr(0, byte_count);
    } else {
      clean += '?';
    }
    text.remove_prefix(byte_count);
  }
  return clean;
}

Result printable(Result result) {
  result.where = printable(result.where);
  result.what = printable(result.what);
  return result;
}

bool isUtf8(std::string_view text) {
  while (!text.empty()) {
    const Character first = firstCharacter(text);
    if (first.byte_count == 0) return false;
    text.remove_prefix(first.byte_count);
  }
  return true;
}

std::string shortened(const std::string& text, size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  size_t end = max_bytes;
  while (end != 0 && isContinuation(text[end])) --end;
  return text.substr(0, end) + "…";
}

}  // namespace mcc::gltf
