// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_JSON_UTF8_H_
#define MCC_JSON_UTF8_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace mcc::gltf {

struct Character {
  uint32_t code = 0;
  size_t byte_count = 0;  ///< 0: the bytes are not UTF-8
};

/// Whether a byte is one of UTF-8 that is not the first of its character.
inline bool isContinuation(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// How many bytes a character of UTF-8 with this first byte has; 0: none begins so.
inline size_t bytesOfCharacter(char first) {
  const auto lead = static_cast<unsigned char>(first);
  if (lead < 0x80) return 1;
  return lead >= 0xf8 || lead < 0xc2 ? 0 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
}

/// Returns the first character of a text that is not empty.
inline Character firstCharacter(std::string_view text) {
  const size_t byte_count = bytesOfCharacter(text[0]);
  if (byte_count == 0 || byte_count > text.size()) return {};
  if (byte_count == 1) return {static_cast<unsigned char>(text[0]), 1};
  uint32_t code = static_cast<unsigned char>(text[0]) & (0x7fu >> byte_count);
  for (size_t i = 1; i < byte_count; ++i) {
    if (!isContinuation(text[i])) return {};
    code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3fu);
  }
  constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  if (code < kLeast[byte_count] || code > 0x10ffff || is_surrogate) return {};
  return {code, byte_count};
}

/// Adds the UTF-8 of a code point, which must be at most 0x10ffff.
inline void appendCharacter(uint32_t code, std::string& text) {
  const auto byte = [&](uint32_t bits) { text += static_cast<char>(bits); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xc0 | code >> 6);
  } else {
    if (code < 0x10000) {
      byte(0xe0 | code >> 12);
    } else {
      byte(0xf0 | code >> 18);
      byte(0x80 | (code >> 12 & 0x3f));
    }
    byte(0x80 | (code >> 6 & 0x3f));
  }
  byte(0x80 | (code & 0x3f));
}

}  // namespace mcc::gltf

#endif  // MCC_JSON_UTF8_H_
