// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_SVG_H_
#define MCC_TOOL_SVG_H_

#include <cstdint>
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

/// The data of a path. It has tenths, as number() does, relative to the point before, which takes
/// about half the space of absolute ones. Differences are between rounded points, so that no error
/// adds up.
class PathData {
 public:
  void moveTo(double x, double y);
  void lineTo(double x, double y);
  void close();  ///< leads back to where the last moveTo() was
  const std::string& text() const { return text_; }

 private:
  struct Point {  // in tenths
    int64_t x = 0;
    int64_t y = 0;
  };

  void add(char command, double x, double y);
  void addTenths(int64_t tenths);

  std::string text_;
  char last_ = 0;  ///< the command that numbers without a letter belong to, or 0
  Point point_;
  Point start_;
};

/// Escapes text for an element, and removes control characters.
std::string escaped(const std::string& text);

/// Estimates the width of a text in a common sans-serif font of size 1.
double lengthOf(const std::string& text);

}  // namespace mcc::tool

#endif  // MCC_TOOL_SVG_H_
