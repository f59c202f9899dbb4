// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tree_legend.h"

#include <fmt/format.h>

#include <cmath>

#include "table.h"

namespace mcc::tool {
namespace {

constexpr double kTrunkLength = 5;  // length of the trunk's line in the legend, in font sizes
constexpr double kLine = 1.7;       // distance of two lines of text, in font sizes
constexpr uint32_t kCostColors = 7;

}  // namespace

/// Colours are few, so that many triangles share one. The first is close to that of an empty page,
/// and only for what takes next to nothing.
Color costColor(double bits) {
  constexpr Color kFree = {222, 229, 240};
  constexpr Color kLittle = {252, 233, 184};
  constexpr Color kMuch = {208, 28, 60};
  const double share = std::min(bits / kMostBits, 1.0);
  const double step = std::floor(share * (kCostColors - 1) + 0.5);
  if (step == 0) return kFree;
  return between(kLittle, kMuch, (step - 1) / (kCostColors - 2));
}

Legend::Legend(double width, double top)
    : width_(width),
      size_(std::clamp(0.0175 * width, 9., 22.)),
      left_(0.04 * width),
      x_(left_),
      y_(top + size_) {}

void Legend::addTitle(const std::string& text) {
  items_ += fmt::format("<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text>\n", number(left_),
                        number(y_ + 0.35 * size_), escaped(text));
  y_ += kLine * size_;
}

void Legend::add(const std::string& sign, double length, const std::string& text) {
  const double gap = 1.6 * size_;
  const double whole = length + size_ * lengthOf(text) + gap;
  if (x_ > left_ && x_ + whole > width_ - left_ + gap) {
    x_ = left_;
    y_ += kLine * size_;
  }
  items_ += fmt::format("<g transform=\"translate({})\">{}<text x=\"{}\" y=\"{}\">{}</text></g>\n",
                        place(x_, y_), sign, number(length), number(0.35 * size_), escaped(text));
  x_ += whole;
}

std::string Legend::line(const std::string& color, double length) const {
  return fmt::format(
      "<path d=\"M0 0H{}\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\"/>",
      number(length), color, number(0.28 * size_));
}

std::string Legend::circle(const std::string& fill, const std::string& more) const {
  return fmt::format("<circle r=\"{0}\" cx=\"{0}\" fill=\"{1}\"{2}/>", number(0.4 * size_), fill,
                     more);
}

void Legend::addItems(std::span<const Branch> branches, bool has_markers) {
  uint32_t deepest = 0;
  size_t root_count = 0;
  for (const Branch& branch : branches) {
    deepest = std::max(deepest, branch.depth);
    root_count += branch.depth == 0 ? 1 : 0;
  }
  const std::string color = nameOf(kBranches[0]);
  add(circle(nameOf(kTrunkFirst), ""), 1.2 * size_,
      root_count == 1 ? "mc-vertex" : "mc-vertex, or across a hole");
  add(line("url(#trunk)", kTrunkLength * size_), (kTrunkLength + 0.6) * size_,
      "trunk, first to last contraction");
  constexpr const char* kNames[] = {"branch", "in a branch", "deeper"};
  static_assert(std::size(kNames) == std::size(kBranches));
  for (size_t i = 0; i < std::min<size_t>(deepest, std::size(kBranches)); ++i) {
    add(line(nameOf(kBranches[i]), 1.6 * size_), 2.2 * size_, kNames[i]);
  }
  if (deepest == 0 || !has_markers) return;
  const std::string ring =
      fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", color, number(0.16 * size_));
  add(circle("#fff", ring), 1.2 * size_, "S");
  add(circle(color, ""), 1.2 * size_, "E");
}

void Legend::addCosts(const std::string& name, std::span<const float> bits) {
  double all = 0;
  uint64_t cheap = 0;
  for (const float b : bits) {
    all += double{b};
    cheap += b < 1 ? 1 : 0;
  }
  addTitle(fmt::format("{}{:.1f} bits for the position of each of {} vertices, less than 1 for {}",
                       name, all / static_cast<double>(std::max<size_t>(bits.size(), 1)),
                       grouped(bits.size()), grouped(cheap)));
  constexpr double kWidth = 2;  // of a colour, in font sizes
  for (uint32_t i = 0; i < kCostColors; ++i) {
    const double least = i * kMostBits / (kCostColors - 1);
    add(fmt::format("<path d=\"M0 0H{0}\" stroke=\"{1}\" stroke-width=\"{2}\"/>",
                    number(kWidth * size_), nameOf(costColor(least)), number(size_)),
        (kWidth + 0.4) * size_,
        i == 0 ? "under 2 bits" : number(least) + (i + 1 == kCostColors ? " and more" : ""));
  }
}

std::string Legend::definition() const {
  std::string out = "<linearGradient id=\"trunk\" gradientUnits=\"userSpaceOnUse\" x2=\"" +
                    number(kTrunkLength * size_) + "\">";
  for (const double share : {0., 0.5, 1.}) {
    out += fmt::format("<stop offset=\"{}\" stop-color=\"{}\"/>", share, nameOf(trunkColor(share)));
  }
  return out + "</linearGradient>";
}

std::string Legend::text() const {
  return fmt::format("<g font-family=\"sans-serif\" font-size=\"{}\" fill=\"#333a48\">\n",
                     number(size_)) +
         items_ + "</g>\n";
}

}  // namespace mcc::tool
