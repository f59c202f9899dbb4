// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The colours of a drawn mc-tree, and its legend.
#ifndef MCC_TOOL_TREE_LEGEND_H_
#define MCC_TOOL_TREE_LEGEND_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>

#include "svg.h"
#include "tree_drawing.h"

namespace mcc::tool {

inline constexpr Color kTrunkFirst = {27, 20, 100};
inline constexpr Color kTrunkMiddle = {18, 102, 168};
inline constexpr Color kTrunkLast = {20, 158, 150};
inline constexpr Color kBranches[] = {{229, 106, 19}, {200, 30, 90}, {130, 40, 150}};  // by depth

/// Returns the colour of the trunk. `share` is 0 at the first contraction, and 1 at the last.
inline Color trunkColor(double share) {
  return share < 0.5 ? between(kTrunkFirst, kTrunkMiddle, 2 * share)
                     : between(kTrunkMiddle, kTrunkLast, 2 * share - 1);
}

/// Returns the colour of branches. `depth` must be at least 1.
inline Color branchColor(uint32_t depth) {
  return kBranches[std::min<size_t>(depth, std::size(kBranches)) - 1];
}

/// What a position takes that is as dark as can be, in bits.
inline constexpr double kMostBits = 24;

/// Returns the colour of a position that takes so many bits.
Color costColor(double bits);

/// A title and a legend in an SVG. Items wrap to the next line where they do not fit.
class Legend {
 public:
  Legend(double width, double top);

  void addTitle(const std::string& text);
  /// Adds the items. `has_markers` says that branches have a ring where they start and a dot where
  /// they end.
  void addItems(std::span<const Branch> branches, bool has_markers);

  /// Adds what the colours of the positions' costs mean, and a title with what they sum up to.
  void addCosts(const std::string& name, std::span<const float> bits);

  /// Returns the gradient that the trunk's item refers to.
  std::string definition() const;
  std::string text() const;
  double bottom() const { return y_; }

 private:
  void add(const std::string& sign, double length, const std::string& text);
  std::string line(const std::string& color, double length) const;
  std::string circle(const std::string& fill, const std::string& more) const;

  const double width_;
  const double size_;  ///< font size
  const double left_;
  double x_;
  double y_;
  std::string items_;
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_TREE_LEGEND_H_
