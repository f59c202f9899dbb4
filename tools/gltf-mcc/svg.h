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

/// "#rrggbb".
std::string nameOf(const Color& color);

/// `share` of the way from one to the other.
Color between(const Color& a, const Color& b, double share);

/// A number with one decimal, with none where that is 0.
std::string number(double value);

/// "X Y".
std::string place(double x, double y);

/// Text for an element, without control characters.
std::string escaped(const std::string& text);

/// About what a text takes in a usual sans-serif of size 1.
double lengthOf(const std::string& text);

}  // namespace mcc::tool

#endif  // MCC_TOOL_SVG_H_
