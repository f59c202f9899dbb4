// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "host/text.h"

#include <cstdint>

#include "json/spelling.h"

namespace mcc::gltf {
namespace {

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
