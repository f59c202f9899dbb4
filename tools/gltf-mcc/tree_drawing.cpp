// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tree_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "projection.h"
#include "table.h"

namespace mcc::tool {
namespace {

/// Children of every vertex, in the order of the edges to them.
struct Children {
  std::vector<uint32_t> first;  ///< of a vertex, in `edges`; one more at the end
  std::vector<uint32_t> edges;

  explicit Children(const gltf::McTree& tree) : first(tree.positions.size() / 3 + 1, 0) {
    for (const gltf::McTree::Edge& edge : tree.edges) ++first[edge.parent + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    edges.resize(tree.edges.size());
    std::vector<uint32_t> fill(first.begin(), first.end() - 1);
    for (uint32_t e = 0; e < tree.edges.size(); ++e) edges[fill[tree.edges[e].parent]++] = e;
  }
};

class Brancher {
 public:
  explicit Brancher(const gltf::McTree& tree)
      : tree_(tree), children_(tree), is_done_(tree.edges.size(), false) {}

  std::vector<Branch> run() {
    std::vector<bool> is_child(children_.first.size(), false);
    for (const gltf::McTree::Edge& edge : tree_.edges) is_child[edge.child] = true;
    // Roots first; then what only cycles lead to.
    for (const bool from_roots : {true, false}) {
      for (uint32_t e = 0; e < tree_.edges.size(); ++e) {
        if (is_done_[e] || (from_roots && is_child[tree_.edges[e].parent])) continue;
        follow(lastOpenEdge(tree_.edges[e].parent), 0);
        drainForks();
      }
    }
    return std::move(branches_);
  }

 private:
  uint32_t lastOpenEdge(uint32_t vertex) const {
    for (uint32_t i = children_.first[vertex + 1]; i-- != children_.first[vertex];) {
      if (!is_done_[children_.edges[i]]) return children_.edges[i];
    }
    return kNone;
  }

  /// A branch along the last edges, from one of them on; notes where others fork off.
  void follow(uint32_t edge, uint32_t depth) {
    Branch branch;
    branch.depth = depth;
    branch.vertices.push_back(tree_.edges[edge].parent);
    for (; edge != kNone; edge = lastOpenEdge(tree_.edges[edge].child)) {
      is_done_[edge] = true;
      if (lastOpenEdge(tree_.edges[edge].parent) != kNone) {
        forks_.push_back({tree_.edges[edge].parent, depth + 1});
      }
      branch.order.push_back(edge);
      branch.vertices.push_back(tree_.edges[edge].child);
    }
    branch.order.push_back(branch.order.back());
    branches_.push_back(std::move(branch));
  }

  void drainForks() {
    while (!forks_.empty()) {
      const Fork fork = forks_.back();
      forks_.pop_back();
      const uint32_t edge = lastOpenEdge(fork.vertex);
      if (edge != kNone) follow(edge, fork.depth);
    }
  }

  struct Fork {
    uint32_t vertex;
    uint32_t depth;
  };
  const gltf::McTree& tree_;
  const Children children_;
  std::vector<bool> is_done_;
  std::vector<Fork> forks_;
  std::vector<Branch> branches_;
};

// --- colours ---------------------------------------------------------------------------------------

struct Color {
  double red;
  double green;
  double blue;
};

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

constexpr Color kTrunkFirst = {27, 20, 100};
constexpr Color kTrunkMiddle = {18, 102, 168};
constexpr Color kTrunkLast = {20, 158, 150};
constexpr Color kBranches[] = {{229, 106, 19}, {200, 30, 90}, {130, 40, 150}};  // by depth
constexpr Color kFront[] = {{196, 200, 212}, {246, 246, 249}};                  // dark, light
constexpr Color kBack[] = {{206, 198, 188}, {240, 235, 228}};
constexpr uint32_t kShades = 12;
constexpr uint32_t kTrunkColors = 48;

Color trunkColor(double share) {
  return share < 0.5 ? between(kTrunkFirst, kTrunkMiddle, 2 * share)
                     : between(kTrunkMiddle, kTrunkLast, 2 * share - 1);
}

Color branchColor(uint32_t depth) {
  return kBranches[std::min<size_t>(depth, std::size(kBranches)) - 1];
}

// --- the drawing -----------------------------------------------------------------------------------

/// Vertices at the places where triangles are seen.
std::vector<bool> onSeenTriangles(const gltf::McTree& tree, const DepthBuffer& depth) {
  const size_t count = tree.positions.size() / 3;
  std::vector<bool> is_on(count, false);
  for (size_t i = 0; i < tree.indices.size(); ++i) {
    if (depth.sees(static_cast<uint32_t>(i / 3))) is_on[tree.indices[i]] = true;
  }
  // Vertices at one place, which seams tell apart, are in a row.
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

/// One decimal, none where it is 0.
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

/// About what a text takes in a usual sans-serif, in its size.
double lengthOf(const std::string& text) {
  const std::string narrow = "fijlrt,.:;|'()- ";
  double length = 0;
  for (const char c : text) length += narrow.find(c) == std::string::npos ? 0.6 : 0.36;
  return length;
}

class Drawing {
 public:
  Drawing(const gltf::McTree& tree, const DrawingOptions& options)
      : tree_(tree),
        options_(options),
        width_(options.width),
        branches_(branchesOf(tree)),
        page_(projectMesh(tree.positions, tree.indices, options.view, width_, 0.04 * width_)),
        depth_(page_, tree.indices),
        is_on_seen_(onSeenTriangles(tree, depth_)),
        line_(lineWidth()) {}

  std::string text();

 private:
  const PagePoint& point(uint32_t vertex) const { return page_.points[vertex]; }
  double lineWidth() const;
  std::string surface() const;
  std::string trees() const;
  std::string pathOf(const Branch& branch, size_t first, size_t last) const;
  std::string markers() const;
  std::string legend();
  bool isSeen(uint32_t vertex) const;
  bool hasRoomForMarkers() const { return line_ > 0.0016 * width_; }

  const gltf::McTree& tree_;
  const DrawingOptions& options_;
  const double width_;
  const std::vector<Branch> branches_;
  const Page page_;
  const DepthBuffer depth_;
  const std::vector<bool> is_on_seen_;
  const double line_;  ///< width of the trunk
  double height_ = 0;
};

/// Lines are thinner where edges are short.
double Drawing::lineWidth() const {
  double sum = 0;
  uint64_t count = 0;
  for (const gltf::McTree::Edge& edge : tree_.edges) {
    const PagePoint& a = point(edge.parent);
    const PagePoint& b = point(edge.child);
    if (!a.is_finite || !b.is_finite) continue;
    sum += std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
    ++count;
  }
  const double mean = count == 0 ? 1 : sum / static_cast<double>(count);
  return std::clamp(0.22 * mean, 0.0007 * width_, 0.0042 * width_);
}

/// From the back to the front; what is hidden is left out.
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
  const bool has_wires = line_ > 0.0014 * width_;
  std::string out =
      fmt::format("<g stroke-width=\"{}\" stroke-linejoin=\"round\"{}>\n",
                  fmt::format("{:.2f}", 0.0007 * width_), has_wires ? " stroke=\"#aab0c0\"" : "");
  std::string open;
  for (const Face& face : faces) {
    const uint32_t t = face.triangle;
    const Lighting light = lightingOf(corner(t, 0), corner(t, 1), corner(t, 2));
    const double level = std::floor(std::min(light.shade, 0.999) * kShades) / (kShades - 1);
    const Color* range = light.is_front ? kFront : kBack;
    const std::string color = nameOf(between(range[0], range[1], level));
    if (color != open) {
      if (!open.empty()) out += "\"/>\n";
      out += "<path fill=\"" + color + (has_wires ? "\"" : "\" stroke=\"" + color + "\"") + " d=\"";
      open = color;
    }
    out += "M" + place(corner(t, 0).x, corner(t, 0).y) + "L" +
           place(corner(t, 1).x, corner(t, 1).y) + " " + place(corner(t, 2).x, corner(t, 2).y) +
           "z";
  }
  return out + (open.empty() ? "" : "\"/>\n") + "</g>\n";
}

/// The seen parts of the edges first … last - 1 of a branch.
std::string Drawing::pathOf(const Branch& branch, size_t first, size_t last) const {
  constexpr double kSample = 1.5;  // pixels
  std::string path;
  bool is_down = false;  // the pen
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
      if (is_seen && !is_down) path += "M" + place(x, y);
      x = a.x + (b.x - a.x) * end;
      y = a.y + (b.y - a.y) * end;
      const bool ends_line = is_seen ? k == count : is_down;
      if (ends_line) {
        const double back = is_seen ? 0 : 1.0 / count;
        path += "L" + place(x - (b.x - a.x) * back, y - (b.y - a.y) * back);
      }
      is_down = is_seen;
    }
  }
  return path;
}

std::string Drawing::trees() const {
  struct Line {
    uint32_t depth;
    std::string color;
    std::string path;
  };
  std::vector<Line> lines;
  const auto add = [&](uint32_t depth, const Color& color, const Branch& branch, size_t first,
                       size_t last) {
    std::string path = pathOf(branch, first, last);
    if (path.empty()) return;
    const std::string name = nameOf(color);
    if (!lines.empty() && lines.back().color == name) {
      lines.back().path += path;
    } else {
      lines.push_back({depth, name, std::move(path)});
    }
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
  std::string out =
      "<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n"
      "<g stroke=\"#fff\" stroke-opacity=\"0.75\" stroke-width=\"" +
      fmt::format("{:.2f}", 1.9 * line_) + "\">\n";
  for (const Line& line : lines) out += "<path d=\"" + line.path + "\"/>\n";
  out += "</g>\n";
  for (const Line& line : lines) {
    out += fmt::format("<path stroke=\"{}\" stroke-width=\"{:.2f}\" d=\"{}\"/>\n", line.color,
                       line.depth == 0 ? line_ : 0.85 * line_, line.path);
  }
  return out + "</g>\n";
}

bool Drawing::isSeen(uint32_t vertex) const {
  const PagePoint& p = point(vertex);
  return is_on_seen_[vertex] && p.is_finite && depth_.sees(p.x, p.y, p.z);
}

/// Where branches start and end, if there is room, and the roots.
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

/// Below the picture; its items wrap.
std::string Drawing::legend() {
  const double size = std::clamp(0.0175 * width_, 9., 22.);
  const double step = 1.7 * size;
  const double left = 0.04 * width_;
  double x = left;
  double y = page_.height + size;
  std::string out;
  const auto room = [&](const std::string& text, double sign) {
    const double length = sign + size * lengthOf(text) + 1.6 * size;
    if (x > left && x + length > width_ - left + 1.6 * size) {
      x = left;
      y += step;
    }
    return length;
  };
  const auto add = [&](const std::string& drawing, double sign, const std::string& text) {
    const double length = room(text, sign);
    out += fmt::format("<g transform=\"translate({})\">{}<text x=\"{}\" y=\"{}\">{}</text></g>\n",
                       place(x, y), drawing, number(sign), number(0.35 * size), escaped(text));
    x += length;
  };
  const auto line = [&](const std::string& color, double length) {
    return fmt::format(
        "<path d=\"M0 0H{}\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\"/>",
        number(length), color, number(0.28 * size));
  };
  size_t branch_count = 0;
  size_t root_count = 0;
  size_t deepest = 0;
  for (const Branch& branch : branches_) {
    ++(branch.depth == 0 ? root_count : branch_count);
    deepest = std::max<size_t>(deepest, branch.depth);
  }
  out += fmt::format("<g font-family=\"sans-serif\" font-size=\"{}\" fill=\"#333a48\">\n",
                     number(size));
  std::string title = options_.title + (options_.title.empty() ? "" : ": ");
  title += fmt::format("mc-tree of {} edges, {} branches", grouped(tree_.edges.size()),
                       grouped(branch_count));
  out += fmt::format("<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text>\n", number(left),
                     number(y + 0.35 * size), escaped(title));
  y += step;
  const auto circle = [&](const std::string& fill, const std::string& more) {
    return fmt::format("<circle r=\"{0}\" cx=\"{0}\" fill=\"{1}\"{2}/>", number(0.4 * size), fill,
                       more);
  };
  const std::string color = nameOf(kBranches[0]);
  add(circle(nameOf(kTrunkFirst), ""), 1.2 * size,
      root_count == 1 ? "mc-vertex" : "mc-vertex, or behind a hole");
  add(line("url(#trunk)", 5 * size), 5.6 * size, "trunk, first to last contraction");
  if (branch_count != 0) add(line(color, 1.6 * size), 2.2 * size, "branch");
  if (deepest > 1) add(line(nameOf(kBranches[1]), 1.6 * size), 2.2 * size, "in a branch");
  if (deepest > 2) add(line(nameOf(kBranches[2]), 1.6 * size), 2.2 * size, "deeper");
  if (branch_count != 0 && hasRoomForMarkers()) {
    const std::string ring =
        fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", color, number(0.16 * size));
    add(circle("#fff", ring), 1.2 * size, "S");
    add(circle(color, ""), 1.2 * size, "E");
  }
  height_ = y + step;
  return out + "</g>\n";
}

std::string Drawing::text() {
  const std::string below = legend();
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\">\n",
      number(width_), number(height_));
  out += "<title>" + escaped(options_.title) + ", mc-tree</title>\n";
  out +=
      "<!-- Made by: gltf-mcc tree -->\n<defs><linearGradient id=\"trunk\" "
      "gradientUnits=\"userSpaceOnUse\" x2=\"" +
      number(5 * std::clamp(0.0175 * width_, 9., 22.)) + "\">";
  for (const double share : {0., 0.5, 1.}) {
    out += fmt::format("<stop offset=\"{}\" stop-color=\"{}\"/>", share, nameOf(trunkColor(share)));
  }
  out += "</linearGradient></defs>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  out += fmt::format("<g transform=\"translate({} 0)\">\n", number((width_ - page_.width) / 2));
  return out + surface() + trees() + markers() + "</g>\n" + below + "</svg>\n";
}

}  // namespace

std::vector<Branch> branchesOf(const gltf::McTree& tree) { return Brancher(tree).run(); }

std::string drawTree(const gltf::McTree& tree, const DrawingOptions& options) {
  return Drawing(tree, options).text();
}

}  // namespace mcc::tool
