// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tree_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "projection.h"
#include "svg.h"
#include "table.h"
#include "tree_faces.h"
#include "tree_legend.h"

namespace mcc::tool {
namespace {

constexpr Color kFront[] = {{196, 200, 212}, {246, 246, 249}};  // dark, light
constexpr Color kBack[] = {{206, 198, 188}, {240, 235, 228}};
constexpr uint32_t kShades = 12;
constexpr uint32_t kCostShades = 4;
constexpr uint32_t kTrunkColors = 48;

/// Returns for every vertex whether it lies on a visible triangle, or at the same place as one that
/// does.
std::vector<bool> onSeenTriangles(const McTree& tree, const DepthBuffer& depth) {
  const size_t count = tree.positions.size() / 3;
  std::vector<bool> is_on(count, false);
  for (size_t i = 0; i < tree.indices.size(); ++i) {
    if (depth.sees(static_cast<uint32_t>(i / 3))) is_on[tree.indices[i]] = true;
  }
  // Sort the vertices by position, so that copies of one place, which seams create, are adjacent.
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto compare = [&](uint32_t a, uint32_t b) {
    return std::memcmp(&tree.positions[size_t{3} * a], &tree.positions[size_t{3} * b],
                       3 * sizeof(float));
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return compare(a, b) < 0; });
  for (size_t begin = 0, end = 0; begin < count; begin = end) {
    bool is_any_on = false;
    for (; end < count && compare(order[begin], order[end]) == 0; ++end) {
      is_any_on = is_any_on || is_on[order[end]];
    }
    for (size_t i = begin; i < end; ++i) is_on[order[i]] = is_any_on;
  }
  return is_on;
}

class Drawing {
 public:
  Drawing(const McTree& tree, const DrawingOptions& options)
      : tree_(tree),
        options_(options),
        width_(options.width),
        branches_(branchesOf(tree)),
        page_(projectMesh(tree.positions, tree.indices, options.view, width_, 0.04 * width_)),
        depth_(page_, tree.indices),
        is_on_seen_(onSeenTriangles(tree, depth_)),
        line_(lineWidth()) {}

  std::string text() const;

 private:
  struct Line {
    uint32_t depth;
    std::string color;
    PathData path;
  };

  const PagePoint& point(uint32_t vertex) const { return page_.points[vertex]; }
  double lineWidth() const;
  Color colorOf(uint32_t triangle, const Lighting& light) const;
  std::string surface() const;
  std::vector<Line> lines() const;
  std::string trees() const;
  bool addPath(const Branch& branch, size_t first, size_t last, PathData& path) const;
  std::string markers() const;
  std::string describe(Legend& legend) const;
  bool isSeen(uint32_t vertex) const;
  bool hasRoomForMarkers() const { return line_ > 0.0016 * width_; }

  const McTree& tree_;
  const DrawingOptions& options_;
  const double width_;
  const std::vector<Branch> branches_;
  const Page page_;
  const DepthBuffer depth_;
  const std::vector<bool> is_on_seen_;
  const double line_;  ///< width of the trunk
};

/// Returns the width of lines, which are thinner where edges are short.
double Drawing::lineWidth() const {
  double sum = 0;
  uint64_t count = 0;
  for (const McTree::Edge& edge : tree_.edges) {
    const PagePoint& a = point(edge.parent);
    const PagePoint& b = point(edge.child);
    if (!a.is_finite || !b.is_finite) continue;
    sum += std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
    ++count;
  }
  const double mean = count == 0 ? 1 : sum / static_cast<double>(count);
  return std::clamp(0.22 * mean, 0.0007 * width_, 0.0042 * width_);
}

/// Returns a triangle's colour: what its corners take on average, if that is drawn.
Color Drawing::colorOf(uint32_t triangle, const Lighting& light) const {
  if (options_.bits.empty()) {
    const double level = std::floor(std::min(light.shade, 0.999) * kShades) / (kShades - 1);
    const Color* range = light.is_front ? kFront : kBack;
    return between(range[0], range[1], level);
  }
  double sum = 0;
  for (uint32_t k = 0; k < 3; ++k) sum += options_.bits[tree_.indices[size_t{3} * triangle + k]];
  const double level = std::floor(std::min(light.shade, 0.999) * kCostShades) / (kCostShades - 1);
  return between({0, 0, 0}, costColor(sum / 3), 0.76 + 0.24 * level);
}

/// Draws the triangles from back to front, without hidden ones.
std::string Drawing::surface() const {
  struct Face {
    double z;
    uint32_t triangle;
  };
  std::vector<Face> faces;
  const auto corner = [&](uint32_t t, uint32_t k) -> const PagePoint& {
    return point(tree_.indices[size_t{3} * t + k]);
  };
  for (uint32_t t = 0; t < tree_.indices.size() / 3; ++t) {
    if (depth_.sees(t)) faces.push_back({corner(t, 0).z + corner(t, 1).z + corner(t, 2).z, t});
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.z < b.z; });
  const bool has_wires = line_ > 0.0014 * width_ && options_.bits.empty();
  std::string out =
      fmt::format("<g stroke-width=\"{}\" stroke-linejoin=\"round\"{}>\n",
                  fmt::format("{:.2f}", 0.0007 * width_), has_wires ? " stroke=\"#aab0c0\"" : "");
  std::vector<FlatFace> flat;
  for (const Face& face : faces) {
    const PagePoint& a = corner(face.triangle, 0);
    const PagePoint& b = corner(face.triangle, 1);
    const PagePoint& c = corner(face.triangle, 2);
    const Lighting light = lightingOf(a, b, c);
    flat.push_back({{a.x, b.x, c.x}, {a.y, b.y, c.y}, nameOf(colorOf(face.triangle, light))});
  }
  for (const FaceGroup& group : groupsOf(flat)) {
    PathData path;
    for (const uint32_t f : group.faces) {
      path.moveTo(flat[f].x[0], flat[f].y[0]);
      path.lineTo(flat[f].x[1], flat[f].y[1]);
      path.lineTo(flat[f].x[2], flat[f].y[2]);
      path.close();
    }
    out += fmt::format("<path fill=\"{0}\"{1} d=\"{2}\"/>\n", group.color,
                       has_wires ? "" : " stroke=\"" + group.color + "\"", path.text());
  }
  return out + "</g>\n";
}

/// Adds the visible parts of the edges first … last - 1 of a branch. Returns whether there are any.
bool Drawing::addPath(const Branch& branch, size_t first, size_t last, PathData& path) const {
  constexpr double kSample = 1.5;  // distance of samples in pixels
  const size_t size_before = path.text().size();
  bool is_down = false;  // whether the pen is down
  for (size_t i = first; i < last; ++i) {
    const PagePoint& a = point(branch.vertices[i]);
    const PagePoint& b = point(branch.vertices[i + 1]);
    const bool may_be_seen = is_on_seen_[branch.vertices[i]] && is_on_seen_[branch.vertices[i + 1]];
    if (!may_be_seen || !a.is_finite || !b.is_finite) {
      is_down = false;
      continue;
    }
    const double length = std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
    const int count = std::clamp(static_cast<int>(length / kSample), 1, 400);
    double x = a.x;
    double y = a.y;
    for (int k = 1; k <= count; ++k) {
      const double end = static_cast<double>(k) / count;
      const double middle = end - 0.5 / count;
      const bool is_seen = depth_.sees(a.x + (b.x - a.x) * middle, a.y + (b.y - a.y) * middle,
                                       a.z + (b.z - a.z) * middle);
      if (is_seen && !is_down) path.moveTo(x, y);
      x = a.x + (b.x - a.x) * end;
      y = a.y + (b.y - a.y) * end;
      const bool ends_line = is_seen ? k == count : is_down;
      if (ends_line) {
        const double back = is_seen ? 0 : 1.0 / count;
        path.lineTo(x - (b.x - a.x) * back, y - (b.y - a.y) * back);
      }
      is_down = is_seen;
    }
  }
  return path.text().size() > size_before;
}

std::vector<Drawing::Line> Drawing::lines() const {
  std::vector<Line> lines;
  const auto add = [&](uint32_t depth, const Color& color, const Branch& branch, size_t first,
                       size_t last) {
    const std::string name = nameOf(color);
    if (!lines.empty() && lines.back().color == name) {
      addPath(branch, first, last, lines.back().path);
      return;
    }
    PathData path;
    if (addPath(branch, first, last, path)) lines.push_back({depth, name, std::move(path)});
  };
  const double all = static_cast<double>(std::max<size_t>(tree_.edges.size(), 2) - 1);
  for (const Branch& branch : branches_) {
    const size_t count = branch.vertices.size() - 1;
    if (branch.depth != 0) {
      add(branch.depth, branchColor(branch.depth), branch, 0, count);
      continue;
    }
    const auto colorAt = [&](size_t i) {
      return static_cast<uint32_t>(branch.order[i] / all * (kTrunkColors - 1) + 0.5);
    };
    for (size_t first = 0, last = 0; first < count; first = last) {
      while (last < count && colorAt(last) == colorAt(first)) ++last;
      add(0, trunkColor(colorAt(first) / double{kTrunkColors - 1}), branch, first, last);
    }
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return a.depth < b.depth; });
  return lines;
}

/// Draws all lines first in white and somewhat wider, so that they stand out from the surface. The
/// coloured ones refer to the paths of the white ones.
std::string Drawing::trees() const {
  const std::vector<Line> all = lines();
  std::string out = fmt::format(
      "<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n"
      "<g stroke=\"#fff\" stroke-opacity=\"0.75\" stroke-width=\"{:.2f}\">\n",
      1.9 * line_);
  for (size_t i = 0; i < all.size(); ++i) {
    out += fmt::format("<path id=\"line{}\" d=\"{}\"/>\n", i, all[i].path.text());
  }
  out += "</g>\n";
  for (size_t i = 0; i < all.size(); ++i) {
    out += fmt::format("<use href=\"#line{}\" stroke=\"{}\" stroke-width=\"{:.2f}\"/>\n", i,
                       all[i].color, all[i].depth == 0 ? line_ : 0.85 * line_);
  }
  return out + "</g>\n";
}

bool Drawing::isSeen(uint32_t vertex) const {
  const PagePoint& p = point(vertex);
  return is_on_seen_[vertex] && p.is_finite && depth_.sees(p.x, p.y, p.z);
}

/// Draws markers where branches start and end, if there is room, and at the roots.
std::string Drawing::markers() const {
  std::string out;
  const auto circle = [&](uint32_t vertex, double radius, const std::string& style) {
    if (!isSeen(vertex)) return;
    out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{:.2f}\" {}/>\n", number(point(vertex).x),
                       number(point(vertex).y), radius, style);
  };
  const std::string white =
      fmt::format("fill=\"#fff\" stroke-width=\"{:.2f}\" stroke=", 0.5 * line_);
  for (const Branch& branch : branches_) {
    if (branch.depth == 0 || !hasRoomForMarkers()) continue;
    const std::string color = nameOf(branchColor(branch.depth));
    circle(branch.vertices[0], 1.25 * line_, white + "\"" + color + "\"");
    circle(branch.vertices.back(), 1.3 * line_, "fill=\"" + color + "\"");
  }
  const double radius = std::max(2.2 * line_, 0.005 * width_);
  for (const Branch& branch : branches_) {
    if (branch.depth != 0) continue;
    circle(branch.vertices[0], radius,
           fmt::format("fill=\"{}\" stroke=\"#fff\" stroke-width=\"{:.2f}\"", nameOf(kTrunkFirst),
                       0.35 * radius));
  }
  return out;
}

/// Fills the legend, and returns the title of the document.
std::string Drawing::describe(Legend& legend) const {
  const std::string name = options_.title.empty() ? "" : options_.title + ": ";
  if (!options_.bits.empty()) {
    legend.addCosts(name, options_.bits);
    return options_.title + ", costs of positions";
  }
  const auto branch_count = std::count_if(branches_.begin(), branches_.end(),
                                          [](const Branch& branch) { return branch.depth != 0; });
  legend.addTitle(fmt::format("{}mc-tree of {} edges, {} branches", name,
                              grouped(tree_.edges.size()),
                              grouped(static_cast<uint64_t>(branch_count))));
  legend.addItems(branches_, hasRoomForMarkers());
  return options_.title + ", mc-tree";
}

std::string Drawing::text() const {
  Legend legend(width_, page_.height);
  const std::string title = describe(legend);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\">\n",
      number(width_), number(legend.bottom() + 0.03 * width_));
  out += "<title>" + escaped(title) + "</title>\n<!-- Made by: gltf-mcc tree -->\n";
  out += "<defs>" + legend.definition() + "</defs>\n";
  out += "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  out += fmt::format("<g transform=\"translate({} 0)\">\n", number((width_ - page_.width) / 2));
  out += surface();
  if (options_.bits.empty()) out += trees() + markers();
  return out + "</g>\n" + legend.text() + "</svg>\n";
}

}  // namespace

std::string drawTree(const McTree& tree, const DrawingOptions& options) {
  return Drawing(tree, options).text();
}

}  // namespace mcc::tool
