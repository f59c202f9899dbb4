// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "terminal.h"

#include <cstdlib>
#include <utility>

#include "console.h"

namespace mcc::tool {
namespace {

ColorMode color_mode = ColorMode::kAuto;  // for the whole process, see setColorMode()

Style styleOf(int stream) {
  switch (color_mode) {
    case ColorMode::kAlways: return Style(true);
    case ColorMode::kNever: return Style(false);
    case ColorMode::kAuto: break;
  }
  const char* no_color = std::getenv("NO_COLOR");
  const bool is_wanted = no_color == nullptr || *no_color == '\0';
  return Style(is_wanted && isColorTerminal(stream));
}

bool isContinuation(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

}  // namespace

std::string Style::in(std::string_view code, std::string_view text) const {
  if (!is_on_ || text.empty()) return std::string(text);
  return "\033[" + std::string(code) + "m" + std::string(text) + "\033[0m";
}

void setColorMode(ColorMode mode) { color_mode = mode; }

ColorMode colorModeOf(const std::vector<std::string>& words) {
  constexpr std::string_view kOption = "--color";
  ColorMode mode = ColorMode::kAuto;
  for (size_t i = 0; i < words.size(); ++i) {
    std::string_view word = words[i];
    if (word == "--") break;
    if (!word.starts_with(kOption)) continue;
    word.remove_prefix(kOption.size());
    if (word.starts_with('=')) {
      word.remove_prefix(1);
    } else if (word.empty() && i + 1 < words.size()) {
      word = words[i + 1];
    }
    mode = word == "always"  ? ColorMode::kAlways
           : word == "never" ? ColorMode::kNever
                             : ColorMode::kAuto;
  }
  return mode;
}

Style styleOfOutput() { return styleOf(kStandardOutput); }
Style styleOfErrors() { return styleOf(kStandardErrors); }

std::string inLocale(std::string text) {
  if (hasUtf8()) return text;
  for (const auto& [character, ascii] :
       {std::pair<std::string_view, std::string_view>{"…", "..."}, {"≤", "<="}, {"×", "x"}}) {
    for (size_t at = text.find(character); at != std::string::npos; at = text.find(character, at)) {
      text.replace(at, character.size(), ascii);
    }
  }
  return text;
}

size_t widthOf(std::string_view text) {
  size_t width = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\033') {
      i = std::min(text.find('m', i), text.size());
    } else {
      width += isContinuation(text[i]) ? 0 : 1;
    }
  }
  return width;
}

std::string_view cutToWidth(std::string_view text, size_t column_count) {
  size_t width = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (!isContinuation(text[i]) && width++ == column_count) return text.substr(0, i);
  }
  return text;
}

size_t columnsOfErrors() {
  const size_t columns = consoleColumns();
  return columns > 1 ? columns : 80;
}

}  // namespace mcc::tool
