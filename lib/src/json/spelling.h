// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What texts of JSON are made of: characters of UTF-8, numbers, and JSON pointers.
#ifndef MCC_JSON_SPELLING_H_
#define MCC_JSON_SPELLING_H_

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
size_t bytesOfCharacter(char first);

/// Returns the first character of a text that is not empty.
Character firstCharacter(std::string_view text);

/// Adds the UTF-8 of a code point, which must be at most 0x10ffff.
void appendCharacter(uint32_t code, std::string& text);

/// Characters that strings hold as a backslash and a letter, and these letters.
inline constexpr std::string_view kEscaped = "\"\\\b\f\n\r\t/";
inline constexpr std::string_view kEscapes = "\"\\bfnrt/";

/// Whether a character is printable ASCII that strings hold as it is.
inline constexpr auto isPlain = [](char c) {
  return c >= ' ' && c < '\x7f' && c != '"' && c != '\\';
};

/// Returns the value of a number as JSON spells it; one that is too large is infinite.
double numberOf(std::string_view spelling);

/// Reads a non-negative integer, however it is spelt (3, 3.0, 3e0); those that are no plain digits
/// up to 2^53. Returns false for anything else.
bool readUnsigned(std::string_view spelling, uint64_t& value);

/// Returns the bits of the integer that a number is, or becomes without its fraction.
uint64_t wholeNumberOf(std::string_view spelling);

/// Whether two numbers have the same value: of plain integers every digit counts, else binary64.
bool areEqualNumbers(std::string_view a, std::string_view b);

/// Returns the shortest spelling that reads back as a finite value, and of those the nearest; the
/// larger one if two are as near; of others, nothing. Its exponent and its point stand where people
/// expect them. That of binary32 is for readers that round to it, as glTF's do with `min` and `max`
/// of floats.
std::string spellingOf(double value);
std::string spellingOf(float value);

/// Returns the JSON pointer to an element or a member: at("/accessors", 3) is "/accessors/3".
std::string at(const std::string& path, uint64_t index);
std::string at(const std::string& path, const std::string& key);

}  // namespace mcc::gltf

#endif  // MCC_JSON_SPELLING_H_
