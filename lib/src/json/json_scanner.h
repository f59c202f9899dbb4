// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_JSON_JSON_SCANNER_H_
#define MCC_JSON_JSON_SCANNER_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "mcc/result.h"

namespace mcc::gltf {

/// What a text of JSON (RFC 8259) is made of.
enum class JsonToken : uint8_t {
  kError,
  kEnd,  ///< of the text; nothing follows its value
  kObject,
  kObjectEnd,
  kArray,
  kArrayEnd,
  kKey,
  kString,
  kNumber,
  kBoolean,
  kNull,
};

/// Reads a text of JSON piece by piece, without a limit of depth. Its memory is that of the longest
/// text of a token and a bit for each level.
class JsonScanner {
 public:
  /// Returns the next bytes of the text, which stay until the next call; none at its end.
  using More = std::string_view (*)(void* source);

  /// The text, which must outlive the scanner.
  explicit JsonScanner(std::string_view text) : rest_(text) {}
  /// A text that comes in parts.
  JsonScanner(More more, void* source) : more_(more), source_(source) {}

  /// Returns the next token; kEnd and kError are the last one.
  JsonToken next();

  /// The content of the last kKey or kString, the spelling of the last kNumber or kBoolean.
  std::string& text() { return text_; }
  /// How many bytes are taken: those up to the end of the last token.
  uint64_t position() const { return position_; }
  /// Where and why the text is damaged, after kError.
  Result error() const;

 private:
  enum class Place : uint8_t { kValue, kFirst, kFirstKey, kColon, kNext, kDone };

  bool refill();
  /// The next byte, or -1 at the end.
  int peek() { return rest_.empty() && !refill() ? -1 : static_cast<unsigned char>(rest_[0]); }
  void take() {
    rest_.remove_prefix(1);
    ++position_;
  }
  bool takeIf(char c);
  void skipSpace();
  JsonToken fail(const char* why);
  JsonToken value();
  JsonToken open(JsonToken token);
  JsonToken close(JsonToken token);
  JsonToken key();
  JsonToken word(std::string_view rest, JsonToken token);
  JsonToken number();
  bool digits();
  bool string();
  bool escape();
  bool hexDigits(uint32_t& code);
  bool character();

  std::string_view rest_;
  More more_ = nullptr;
  void* source_ = nullptr;
  uint64_t position_ = 0;
  std::string text_;
  std::string open_;  ///< '{' or '[' for each level
  Place place_ = Place::kValue;
  bool has_begun_ = false;
  const char* why_ = "";
};

}  // namespace mcc::gltf

#endif  // MCC_JSON_JSON_SCANNER_H_
