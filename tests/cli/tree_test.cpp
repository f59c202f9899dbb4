// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// `gltf-mcc tree`: a picture of the same tree for the file before and after its compression.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <set>
#include <utility>
#include <vector>

#include "cli/run_tool.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class Tree : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
  }

  ToolResult run(const std::string& arguments) const { return runTool(folder_, arguments); }

  std::string draw(const std::string& arguments) const {
    const ToolResult result = run("tree " + arguments + " -");
    EXPECT_EQ(result.status, 0) << arguments << result.err;
    return result.out;
  }

  static size_t countOf(const std::string& text, const std::string& word) {
    size_t count = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      ++count;
    return count;
  }

  /// Returns the numbers of edges and branches in the title.
  static std::pair<int, int> countsOf(const std::string& svg) {
    std::smatch found;
    const std::regex title("mc-tree of ([0-9,]+) edges, ([0-9,]+) branches");
    if (!std::regex_search(svg, found, title)) return {-1, -1};
    const auto number = [](std::string text) {
      text.erase(std::remove(text.begin(), text.end(), ','), text.end());
      return std::stoi(text);
    };
    return {number(found[1]), number(found[2])};
  }

  using Tenths = std::pair<long, long>;

  /// Returns the points of the triangles' paths, whose numbers are relative to the points before.
  static std::vector<Tenths> cornersOf(const std::string& svg) {
    std::vector<Tenths> corners;
    const std::regex path("<path fill=[^>]* d=\"([^\"]*)\"");
    const std::regex triangle("m([^ml]+)");
    const std::regex number("-?[0-9]*\\.?[0-9]+");
    const auto each = [](const std::string& text, const std::regex& what, const auto& visit) {
      for (std::sregex_iterator i(text.begin(), text.end(), what), end; i != end; ++i) visit(*i);
    };
    each(svg, path, [&](const std::smatch& data) {
      Tenths start = {0, 0};
      each(data[1], triangle, [&](const std::smatch& steps) {
        std::vector<long> tenths;
        each(steps[1], number, [&](const std::smatch& step) {
          tenths.push_back(std::lround(10 * std::stod(step.str())));
        });
        ASSERT_EQ(tenths.size(), 6u) << steps.str();
        start = {start.first + tenths[0], start.second + tenths[1]};
        Tenths point = start;
        corners.push_back(point);
        for (size_t i = 2; i < 6; i += 2) {
          point = {point.first + tenths[i], point.second + tenths[i + 1]};
          corners.push_back(point);
        }
      });
    });
    return corners;
  }

  ScratchFolder folder_;
};

TEST_F(Tree, SpansTheVerticesOfASphere) {
  const std::string svg = draw(samplePath("sphere.glb"));
  EXPECT_EQ(svg.rfind("<svg xmlns=", 0), 0u);
  EXPECT_NE(svg.find("</svg>\n"), std::string::npos);
  EXPECT_EQ(countOf(svg, "<g"), countOf(svg, "</g>"));
  EXPECT_NE(svg.find("sphere.glb: mc-tree"), std::string::npos);
  EXPECT_EQ(svg, draw(samplePath("sphere.glb"))) << "not the same picture twice";
  const std::string report =
      run("convert " + samplePath("sphere.glb") + " s.glb --format json").out;
  std::smatch positions;
  ASSERT_TRUE(std::regex_search(report, positions, std::regex("\"positions\": ([0-9]+)")));
  EXPECT_EQ(countsOf(svg).first, std::stoi(positions[1]) - 1);
}

TEST_F(Tree, OfACompressedFileIsTheTreeItHas) {
  for (const std::string name : {"sphere.glb", "genus3.glb", "sheet_with_holes.glb"}) {
    ASSERT_EQ(run("convert -q --lossless " + samplePath(name) + " small.glb").status, 0);
    ASSERT_EQ(run("convert -q " + samplePath(name) + " smaller.glb").status, 0);
    const auto before = countsOf(draw(samplePath(name)));
    EXPECT_GT(before.first, 100);
    EXPECT_EQ(countsOf(draw("small.glb")), before) << name;
    EXPECT_EQ(countsOf(draw("smaller.glb")), before) << name;
  }
}

TEST_F(Tree, DrawsWhatIsAskedFor) {
  const std::string first = draw(samplePath("two_materials.glb"));
  EXPECT_NE(first, draw(samplePath("two_materials.glb") + " --primitive 1"));
  EXPECT_NE(first, draw(samplePath("two_materials.glb") + " --view=-1,0,0"));
  EXPECT_NE(first.find("width=\"800\""), std::string::npos);
  EXPECT_NE(draw(samplePath("two_materials.glb") + " --size 300").find("width=\"300\""),
            std::string::npos);
  for (const char* view : {"0,1,0", "0,-1,0", "0,0,1", "1,0,0"}) {
    EXPECT_GT(draw(samplePath("torus.glb") + " --view " + view).size(), 20000u) << view;
  }
  EXPECT_EQ(run("tree " + samplePath("torus.glb") + " tree.svg -q").out, "");
  EXPECT_EQ(contentOf(folder_.path() / "tree.svg"), draw(samplePath("torus.glb")));
}

/// Triangles are grouped by their colours: each shade has a few paths, although the order from back
/// to front changes between shades at almost every triangle.
TEST_F(Tree, HasFewPaths) {
  const std::string svg = draw(samplePath("torus.glb"));
  EXPECT_GT(cornersOf(svg).size(), 4000u);
  EXPECT_LT(countOf(svg, "<path fill="), 150u);
}

/// Triangles meet in the same tenths wherever their paths have begun: a rounding that added up
/// would draw a vertex at another place for each of its about six triangles.
TEST_F(Tree, RelativePointsDoNotDrift) {
  for (const char* view : {"", " --view 0,0,1", " --size 333"}) {
    const std::vector<Tenths> corners = cornersOf(draw(samplePath("torus.glb") + view));
    EXPECT_GT(corners.size(), 3000u) << view;
    EXPECT_LE(std::set<Tenths>(corners.begin(), corners.end()).size(), 2048u) << view;
  }
}

TEST_F(Tree, SaysWhatCannotBeDrawn) {
  const auto expectSays = [&](const std::string& arguments, int status, const std::string& text) {
    const ToolResult result = run("tree " + arguments);
    EXPECT_EQ(result.status, status) << arguments;
    EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(fs::exists(folder_.path() / "x.svg"));
  };
  const std::string torus = samplePath("torus.glb");
  expectSays("none.glb x.svg", 1, "none.glb: there is no such file");
  expectSays(torus + " x.svg --mesh 7", 1, "torus.glb: there is no mesh 7; the last is 0");
  expectSays(torus + " x.svg --primitive 3", 1, "/meshes/0: there is no primitive 3; there are 1");
  expectSays(torus + " x.svg --view 0,0,0", 2, "--view: 0,0,0 is not a direction");
  expectSays(torus + " x.svg --view 1,2", 2, "--view");
  expectSays(torus + " none/x.svg", 1, "none");
  expectSays(torus, 2, "OUT");
  std::ofstream(folder_.path() / "empty.gltf") << R"({"asset": {"version": "2.0"}})";
  expectSays("empty.gltf x.svg", 1, "empty.gltf: the file has no meshes");
}

/// Returns the mean and the number of vertices in the title of a drawing of costs, or zeros.
std::pair<double, double> costsOf(const std::string& svg) {
  std::smatch found;
  const std::regex title("([0-9.]+) bits for the position of each of ([0-9]+),?([0-9]*) vertices");
  if (!std::regex_search(svg, found, title)) return {0, 0};
  return {std::stod(found[1]), std::stod(found[2].str() + found[3].str())};
}

TEST_F(Tree, CostsAreTheBytesOfThePositions) {
  for (const char* name : {"sphere", "genus3", "moebius", "sheet_with_holes", "non_manifold"}) {
    ASSERT_EQ(run("convert -q " + samplePath(std::string(name) + ".glb") + " small.glb").status, 0);
    const std::string svg = draw("--costs small.glb");
    const std::string report = run("inspect small.glb").out;
    std::smatch found;
    const std::regex positions("POSITION +([0-9]+),?([0-9]*) ");
    ASSERT_TRUE(std::regex_search(report, found, positions)) << report;
    const double bits = 8 * std::stod(found[1].str() + found[2].str());
    const auto [mean, count] = costsOf(svg);
    // Tables count for no vertex, and the last two have large ones. The mean has one decimal.
    EXPECT_LT(mean * count, 1.01 * bits + 0.05 * count) << name;
    const bool has_tables = std::string(name).find("_") != std::string::npos;
    EXPECT_GT(mean * count, has_tables ? 0 : 0.95 * bits - 0.05 * count) << name;
    EXPECT_EQ(svg.find("mc-tree of"), std::string::npos) << "a tree on it";
  }
}

TEST_F(Tree, CostsNeedAPayload) {
  const ToolResult result = run("tree --costs " + samplePath("torus.glb") + " costs.svg");
  EXPECT_NE(result.status, 0);
  EXPECT_NE(result.err.find("is not compressed"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "costs.svg"));
}

TEST_F(Tree, OfTheReadmeIsUpToDate) {
  const std::string figure = "extension-spec/KHR_mesh_collapse_compression/figures/mc_tree.svg";
  EXPECT_TRUE(contentOf(fs::path(MCC_SOURCE_DIR) / figure) ==
              draw(samplePath("sphere.glb") + " --size 520"))
      << "gltf-mcc tree samples/sphere.glb " << figure << " --size 520";
}

/// Every kind of primitive gets a picture or a reason why not; none ends the program.
TEST_F(Tree, OfEverySample) {
  for (const auto& entry : fs::directory_iterator(MCC_SAMPLES_DIR)) {
    if (entry.path().extension() != ".glb") continue;
    for (int primitive = 0; primitive < 8; ++primitive) {
      const ToolResult result =
          run("tree '" + entry.path().string() + "' - --primitive " + std::to_string(primitive));
      EXPECT_TRUE(result.status == 0 || result.status == 1) << entry.path() << primitive;
      EXPECT_EQ(result.status == 0, result.err.empty()) << result.err;
      EXPECT_EQ(result.out.find("nan"), std::string::npos) << entry.path();
    }
  }
}

}  // namespace
}  // namespace mcc::test
