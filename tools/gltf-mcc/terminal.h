// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the terminal can show: colours, characters beyond ASCII, width.
#ifndef MCC_TOOL_TERMINAL_H_
#define MCC_TOOL_TERMINAL_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace mcc::tool {

enum class ColorMode : uint8_t { kAuto, kAlways, kNever };

/// Wraps text in escape sequences, or leaves it as it is.
class Style {
 public:
  explicit Style(bool is_on) : is_on_(is_on) {}

  bool isOn() const { return is_on_; }
  std::string bold(std::string_view text) const { return in("1", text); }
  std::string error(std::string_view text) const { return in("1;31", text); }
  std::string note(std::string_view text) const { return in("33", text); }
  std::string bar(std::string_view text) const { return in("36", text); }

 private:
  std::string in(std::string_view code, std::string_view text) const;

  bool is_on_;
};

/// Set once, before there are other threads. kAuto, the default: colours on a terminal, unless NO_COLOR is set or TERM
/// is "dumb".
void setColorMode(ColorMode mode);

/// The last --color on a command line, known before that is parsed: help and errors of usage have colours, too.
ColorMode colorModeOf(int argc, const char* const* argv);

Style styleOfOutput();
Style styleOfErrors();

/// Whether the locale of the environment has UTF-8 characters.
bool hasUtf8();

/// The text itself where the locale has UTF-8, else with ASCII for the few other characters that the tool prints.
std::string inLocale(std::string text);

/// Columns that a UTF-8 text takes: one per code point, none for the escape sequences of a Style.
size_t widthOf(std::string_view text);

/// As much of a UTF-8 text without escape sequences as fits into so many columns.
std::string_view cutToWidth(std::string_view text, size_t column_count);

/// Of the terminal on standard error; 80 where there is none.
size_t columnsOfErrors();

}  // namespace mcc::tool

#endif  // MCC_TOOL_TERMINAL_H_
