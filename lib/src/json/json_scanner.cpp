// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "json/json_scanner.h"

#include "json/utf8.h"

namespace mcc::gltf {

bool JsonScanner::refill() {
  if (more_ != nullptr) rest_ = more_(source_);
  return !rest_.empty();
}

bool JsonScanner::takeIf(char c) {
  if (peek() != static_cast<unsigned char>(c)) return false;
  take();
  return true;
}

void JsonScanner::skipSpace() {
  for (int c = peek(); c == ' ' || c == '\n' || c == '\r' || c == '\t'; c = peek()) take();
}

JsonToken JsonScanner::fail(const char* why) {
  why_ = why;
  place_ = Place::kDone;
  return JsonToken::kError;
}

Result JsonScanner::error() const {
  return {"JSON byte " + std::to_string(position_ + 1),
          "the JSON is damaged (" + std::string(why_) + ")"};
}

JsonToken JsonScanner::next() {
  if (*why_ != 0) return JsonToken::kError;
  if (!has_begun_ && takeIf('\xef') && !(takeIf('\xbb') && takeIf('\xbf')))
    return fail("a byte order mark is cut off");
  has_begun_ = true;
  skipSpace();
  switch (place_) {
    case Place::kFirst:
      if (takeIf(']')) return close(JsonToken::kArrayEnd);
      return value();
    case Place::kFirstKey:
      if (takeIf('}')) return close(JsonToken::kObjectEnd);
      return key();
    case Place::kColon:
      if (!takeIf(':')) return fail("a colon is missing after a key");
      skipSpace();
      return value();
    case Place::kNext:
      if (open_.back() == '{') {
        if (takeIf('}')) return close(JsonToken::kObjectEnd);
        if (!takeIf(',')) return fail("a comma or the end of an object is missing");
        skipSpace();
        return key();
      }
      if (takeIf(']')) return close(JsonToken::kArrayEnd);
      if (!takeIf(',')) return fail("a comma or the end of an array is missing");
      skipSpace();
      return value();
    case Place::kDone:
      if (peek() >= 0) return fail("something follows the value");
      return JsonToken::kEnd;
    case Place::kValue: break;
  }
  return value();
}

JsonToken JsonScanner::open(JsonToken token) {
  open_ += token == JsonToken::kObject ? '{' : '[';
  place_ = token == JsonToken::kObject ? Place::kFirstKey : Place::kFirst;
  return token;
}

JsonToken JsonScanner::close(JsonToken token) {
  open_.pop_back();
  place_ = open_.empty() ? Place::kDone : Place::kNext;
  return token;
}

JsonToken JsonScanner::key() {
  if (!takeIf('"')) return fail("a key is missing");
  place_ = Place::kColon;
  return string() ? JsonToken::kKey : JsonToken::kError;
}

JsonToken JsonScanner::value() {
  if (takeIf('{')) return open(JsonToken::kObject);
  if (takeIf('[')) return open(JsonToken::kArray);
  place_ = open_.empty() ? Place::kDone : Place::kNext;
  text_.clear();
  switch (peek()) {
    case '"': take(); return string() ? JsonToken::kString : JsonToken::kError;
    case 't': return word("true", JsonToken::kBoolean);
    case 'f': return word("false", JsonToken::kBoolean);
    case 'n': return word("null", JsonToken::kNull);
    case -1: return fail("it ends too early");
    default: return number();
  }
}

JsonToken JsonScanner::word(std::string_view whole, JsonToken token) {
  for (const char c : whole) {
    if (!takeIf(c)) return fail("a value is missing");
  }
  text_ = whole;
  return token;
}

/// Takes digits; returns whether there was one.
bool JsonScanner::digits() {
  const size_t before = text_.size();
  for (int c = peek(); c >= '0' && c <= '9'; c = peek()) {
    text_ += static_cast<char>(c);
    take();
  }
  return text_.size() != before;
}

JsonToken JsonScanner::number() {
  const auto takeAny = [&](std::string_view any) {
    const int c = peek();
    if (c < 0 || any.find(static_cast<char>(c)) == std::string_view::npos) return false;
    text_ += static_cast<char>(c);
    take();
    return true;
  };
  const bool is_negative = takeAny("-");
  if (!takeAny("0") && !digits()) {
    return fail(is_negative ? "a number has no digits" : "a value is missing");
  }
  if (takeAny(".") && !digits()) return fail("a number has no digits after its point");
  if (takeAny("eE")) {
    takeAny("+-");
    if (!digits()) return fail("a number has no digits in its exponent");
  }
  return JsonToken::kNumber;
}

/// Takes a string after its first quote.
bool JsonScanner::string() {
  text_.clear();
  while (true) {
    const int c = peek();
    if (c < 0) return fail("a string has no end"), false;
    if (c < 0x20) return fail("a control character is not escaped"), false;
    if (c == '"') return take(), true;
    if (c == '\\') {
      take();
      if (!escape()) return false;
    } else if (c < 0x80) {
      // Texts are mostly ASCII, which is taken at once.
      size_t count = 1;
      const auto isPlain = [](char one) {
        return static_cast<signed char>(one) >= 0x20 && one != '"' && one != '\\';
      };
      while (count < rest_.size() && isPlain(rest_[count])) ++count;
      text_.append(rest_, 0, count);
      rest_.remove_prefix(count);
      position_ += count;
    } else if (!character()) {
      return false;
    }
  }
}

/// Takes a character of several bytes, which may lie in two parts of the text.
bool JsonScanner::character() {
  const size_t begin = text_.size();
  for (size_t count = bytesOfCharacter(rest_[0]); count != 0; --count) {
    if (peek() < 0) break;
    text_ += rest_[0];
    if (text_.size() - begin > 1 && !isContinuation(text_.back())) break;
    take();
  }
  const std::string_view taken = std::string_view(text_).substr(begin);
  if (!taken.empty() && firstCharacter(taken).byte_count == taken.size()) return true;
  return fail("a string is not UTF-8"), false;
}

bool JsonScanner::hexDigits(uint32_t& code) {
  code = 0;
  for (int i = 0; i < 4; ++i) {
    const int c = peek();
    const bool is_letter = (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
    if (!is_letter && (c < '0' || c > '9'))
      return fail("\\u is not followed by four hexadecimal digits"), false;
    code = code << 4 | static_cast<uint32_t>(is_letter ? (c & 0xf) + 9 : c - '0');
    take();
  }
  return true;
}

/// Takes what follows a backslash.
bool JsonScanner::escape() {
  constexpr std::string_view kLetters = "\"\\/bfnrtu";
  constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
  const int c = peek();
  const size_t found = c < 0 ? std::string_view::npos : kLetters.find(static_cast<char>(c));
  if (found == std::string_view::npos) return fail("an escape is unknown"), false;
  take();
  if (found < kMeanings.size()) return text_ += kMeanings[found], true;
  uint32_t code = 0;
  if (!hexDigits(code)) return false;
  const bool is_first = code >= 0xd800 && code < 0xdc00;
  if (is_first) {
    uint32_t second = 0;
    if (!takeIf('\\') || !takeIf('u')) return fail("half of a surrogate pair is missing"), false;
    if (!hexDigits(second)) return false;
    if (second < 0xdc00 || second > 0xdfff)
      return fail("half of a surrogate pair is missing"), false;
    code = 0x10000 + ((code & 0x3ff) << 10 | (second & 0x3ff));
  } else if (code >= 0xdc00 && code < 0xe000) {
    return fail("half of a surrogate pair is missing"), false;
  }
  appendCharacter(code, text_);
  return true;
}

}  // namespace mcc::gltf
