// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mcc::tool {

std::string nameOf(const Color& color) {
  const auto byte = [](double value) {
    return static_cast<int>(std::clamp(value, 0., 255.) + 0.5);
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.red), byte(color.green), byte(color.blue));
}

Color between(const Color& a, const Color& b, double share) {
  return {a.red + (b.red - a.red) * share, a.green + (b.green - a.green) * share,
          a.blue + (b.blue - a.blue) * share};
}

std::string number(double value) {
  const auto tenths = static_cast<int64_t>(std::floor(value * 10 + 0.5));
  if (tenths % 10 == 0) return std::to_string(tenths / 10);
  const char* sign = tenths < 0 ? "-" : "";
  return fmt::format("{}{}.{}", sign, std::abs(tenths) / 10, std::abs(tenths) % 10);
}

std::string place(double x, double y) { return number(x) + " " + number(y); }

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) {
      result += c;
    }
  }
  return result;
}

double lengthOf(const std::string& text) {
  const std::string narrow = "fijlrt,.:;|'()- ";
  double length = 0;
  for (const char c : text) length += narrow.find(c) == std::string::npos ? 0.6 : 0.36;
  return length;
}

}  // namespace mcc::tool
