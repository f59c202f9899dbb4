// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_SVG_H_
#define MCC_TOOL_SVG_H_

#include <string>

namespace mcc::tool {

struct Color {
  double red;
  double green;
  double blue;
};

/// Returns a colour as "#rrggbb".
std::string nameOf(const Color& color);

/// Returns the colour at `share` of the way from `a` to `b`.
Color between(const Color& a, const Color& b, double share);

/// Formats a number with one decimal, or with none where that is 0.
std::string number(double value);

/// Formats a point as "X Y".
std::string place(double x, double y);

/// Escapes text for an element, and removes control characters.
std::string escaped(const std::string& text);

/// Estimates the width of a text in a common sans-serif font of size 1.
double lengthOf(const std::string& text);

}  // namespace mcc::tool

#endif  // MCC_TOOL_SVG_H_
