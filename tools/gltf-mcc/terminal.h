// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the terminal can show: colours, characters beyond ASCII, and its width.
#ifndef MCC_TOOL_TERMINAL_H_
#define MCC_TOOL_TERMINAL_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mcc::tool {

enum class ColorMode : uint8_t { kAuto, kAlways, kNever };

/// Wraps text in escape sequences when it is on, and leaves it unchanged otherwise.
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

/// Sets whether output is coloured. Must be called before other threads are started. kAuto, the
/// default, uses colours on a terminal, unless NO_COLOR is set or TERM is "dumb".
void setColorMode(ColorMode mode);

/// Returns the last --color on a command line. It is read before parsing, so that help and usage
/// errors have the right colours, too.
ColorMode colorModeOf(const std::vector<std::string>& words);

Style styleOfOutput();
Style styleOfErrors();

/// Returns the text unchanged where the locale has UTF-8; otherwise replaces the few non-ASCII
/// characters that the tool prints.
std::string inLocale(std::string text);

/// Returns how many columns a UTF-8 text takes: one per code point, none for the escape sequences
/// of a Style.
size_t widthOf(std::string_view text);

/// Returns as much of a UTF-8 text without escape sequences as fits into this many columns.
std::string_view cutToWidth(std::string_view text, size_t column_count);

/// Returns the width of the terminal on standard error, or 80 where there is none.
size_t columnsOfErrors();

}  // namespace mcc::tool

#endif  // MCC_TOOL_TERMINAL_H_
