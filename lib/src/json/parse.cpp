// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <charconv>

#include "json/json.h"

namespace mcc::gltf {
namespace {

/// Takes a text apart. Its functions return false after an error.
class Scanner {
 public:
  Scanner(const JsonParts& parts, JsonListener& listener) : parts_(parts), listener_(listener) {}

  Result scan() {
    const bool is_cut = takeIf('\xef') && !(takeIf('\xbb') && takeIf('\xbf'));
    bool is_fine = is_cut ? fail("a byte order mark is cut off") : value();
    while (is_fine && !open_.empty()) is_fine = next();
    skipSpace();
    if (is_fine && peek() >= 0) fail("something follows the value");
    return result_;
  }

 private:
  bool fail(const char* why) {
    return tell({"JSON byte " + std::to_string(position_ + 1),
                 "the JSON is damaged (" + std::string(why) + ")"});
  }

  bool tell(Result result) {
    if (result.ok()) return true;
    result_ = std::move(result);
    return false;
  }

  /// The next byte, or -1 at the end.
  int peek() {
    if (rest_.empty()) rest_ = parts_();
    return rest_.empty() ? -1 : static_cast<unsigned char>(rest_[0]);
  }

  void take(size_t byte_count = 1) {
    rest_.remove_prefix(byte_count);
    position_ += byte_count;
  }

  bool takeIf(char c) {
    const bool is_there = peek() == static_cast<unsigned char>(c);
    if (is_there) take();
    return is_there;
  }

  void skipSpace() {
    for (int c = peek(); c == ' ' || c == '\n' || c == '\r' || c == '\t'; c = peek()) take();
  }

  /// Takes bytes of a kind, up to a number of them, as text; returns whether there was one.
  template <class Is>
  bool takeText(Is is, size_t most = std::string::npos) {
    const uint64_t begin = position_;
    while (position_ - begin < most && peek() >= 0 && is(rest_[0])) {
      const std::string_view part = rest_.substr(0, most - (position_ - begin));
      const auto end = std::find_if_not(part.begin(), part.end(), is);
      const auto count = static_cast<size_t>(end - part.begin());
      text_.append(part, 0, count);
      take(count);
    }
    return position_ != begin;
  }

  /// Takes one of some bytes as text, if it is there.
  bool takeAny(std::string_view any) {
    const int c = peek();
    if (c < 0 || any.find(static_cast<char>(c)) == any.npos) return false;
    text_ += static_cast<char>(c);
    take();
    return true;
  }

  /// Takes the next element or member of the innermost array or object, or its end.
  bool next() {
    skipSpace();
    const bool is_object = open_.back() == Json::Kind::kObject;
    if (takeIf(is_object ? '}' : ']')) {
      open_.pop_back();
      is_first_ = false;
      return tell(listener_.end(position_));
    }
    if (!is_first_ && !takeIf(',')) {
      return fail(is_object ? "a comma or the end of an object is missing"
                            : "a comma or the end of an array is missing");
    }
    is_first_ = false;
    if (!is_object) return value();
    skipSpace();
    if (!takeIf('"')) return fail("a key is missing");
    if (!string() || !tell(listener_.key(std::move(text_)))) return false;
    skipSpace();
    return takeIf(':') ? value() : fail("a colon is missing after a key");
  }

  bool value() {
    skipSpace();
    text_.clear();
    switch (peek()) {
      case '{': return open(Json::Kind::kObject);
      case '[': return open(Json::Kind::kArray);
      case '"': take(); return string() && tell(listener_.value(std::move(text_)));
      case 't': return word("true") && tell(listener_.value(true));
      case 'f': return word("false") && tell(listener_.value(false));
      case 'n': return word("null") && tell(listener_.value(nullptr));
      case -1: return fail("it ends too early");
      default: return number() && tell(listener_.value(Json::number(std::move(text_))));
    }
  }

  bool open(Json::Kind kind) {
    open_.push_back(kind);
    is_first_ = true;
    take();
    return tell(listener_.begin(kind, position_ - 1));
  }

  bool word(std::string_view whole) {
    const bool is_whole =
        std::all_of(whole.begin(), whole.end(), [&](char c) { return takeIf(c); });
    return is_whole || fail("a value is missing");
  }

  bool number() {
    const auto digits = [this] { return takeText([](char c) { return c >= '0' && c <= '9'; }); };
    const bool is_negative = takeAny("-");
    if (!takeAny("0") && !digits())
      return fail(is_negative ? "a number has no digits" : "a value is missing");
    if (takeAny(".") && !digits()) return fail("a number has no digits after its point");
    if (!takeAny("eE")) return true;
    takeAny("+-");
    return digits() || fail("a number has no digits in its exponent");
  }

  /// Takes a string after its first quote.
  bool string() {
    text_.clear();
    while (true) {
      takeText(isPlain);
      if (takeIf('"')) return true;
      if (peek() < 0) return fail("a string has no end");
      if (peek() < ' ') return fail("a control character is not escaped");
      if (!(takeIf('\\') ? escape() : character())) return false;
    }
  }

  bool character() {
    const size_t begin = text_.size();
    const size_t byte_count = bytesOfCharacter(rest_[0]);
    if (byte_count != 0 && takeText([](char) { return true; }, 1))
      takeText(isContinuation, byte_count - 1);
    const std::string_view taken = std::string_view(text_).substr(begin);
    return (!taken.empty() && firstCharacter(taken).byte_count != 0) ||
           fail("a string is not UTF-8");
  }

  bool hexDigits(uint32_t& code) {
    const size_t begin = text_.size();
    takeText([](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }, 4);
    if (text_.size() - begin != 4) return fail("\\u is not followed by four hexadecimal digits");
    std::from_chars(&text_[begin], &text_[begin] + 4, code, 16);
    text_.resize(begin);
    return true;
  }

  /// Takes what follows a backslash.
  bool escape() {
    if (takeAny(kEscapes)) {
      text_.back() = kEscaped[kEscapes.find(text_.back())];
      return true;
    }
    if (!takeIf('u')) return fail("an escape is unknown");
    uint32_t code = 0;
    if (!hexDigits(code)) return false;
    if (code >= 0xd800 && code < 0xe000) {
      constexpr const char* kHalf = "half of a surrogate pair is missing";
      uint32_t second = 0;
      if (code >= 0xdc00 || !takeIf('\\') || !takeIf('u')) return fail(kHalf);
      if (!hexDigits(second)) return false;
      if (second < 0xdc00 || second > 0xdfff) return fail(kHalf);
      code = 0x10000 + ((code & 0x3ff) << 10 | (second & 0x3ff));
    }
    appendCharacter(code, text_);
    return true;
  }

  const JsonParts& parts_;
  JsonListener& listener_;
  std::string_view rest_;
  uint64_t position_ = 0;
  std::string text_;
  std::vector<Json::Kind> open_;
  bool is_first_ = false;  ///< nothing is taken of the innermost array or object
  Result result_;
};

class Builder : public JsonListener {
 public:
  explicit Builder(Json& root) : root_(root) {}

  Result begin(Json::Kind kind, uint64_t) override {
    open_.push_back({kind == Json::Kind::kObject ? Json::object() : Json::array(), ""});
    if (open_.size() <= kMaxJsonDepth) return {};
    return {"JSON", "objects and arrays are nested deeper than " + std::to_string(kMaxJsonDepth) +
                        " levels"};
  }

  Result key(std::string key) override {
    open_.back().key = std::move(key);
    return {};
  }

  Result value(Json value) override {
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (auto& [json, key] = open_.back(); json.is_object()) {
      json.append(std::move(key), std::move(value));
    } else {
      json.push_back(std::move(value));
    }
    return {};
  }

  /// Each key of an object must be found where it stands, except in `extras`.
  Result end(uint64_t) override {
    Json json = std::move(open_.back().json);
    open_.pop_back();
    for (size_t i = 0; json.is_object() && i < json.size(); ++i) {
      if (json.find(json.keyAt(i)) == &std::as_const(json)[i]) continue;
      std::string path;
      for (const auto& [outer, key] : open_) {
        if (key == "extras") return value(std::move(json));
        path = outer.is_object() ? at(path, key) : at(path, outer.size());
      }
      return {at(path, json.keyAt(i)), "the key appears twice in one object, which glTF forbids"};
    }
    return value(std::move(json));
  }

 private:
  /// An array or object that is open, and the key of its next member.
  struct Level {
    Json json;
    std::string key;
  };
  Json& root_;
  std::vector<Level> open_;
};

}  // namespace

Result scanJson(const JsonParts& parts, JsonListener& listener) {
  return Scanner(parts, listener).scan();
}

Result parseJson(std::span<const uint8_t> text, Json& json) {
  json = Json();
  std::string_view view(reinterpret_cast<const char*>(text.data()), text.size());
  while (view.ends_with('\0')) view.remove_suffix(1);  // what old exporters pad a GLB with
  Builder builder(json);
  return scanJson([&] { return std::exchange(view, {}); }, builder);
}

}  // namespace mcc::gltf
