// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// `gltf-mcc tiles` as a user sees it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <thread>

#include "cli/run_tool.h"
#include "gltf/scene_positions.h"
#include "tiles/tile_file.h"
#include "tiles/tileset_builder.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;
using Position = std::array<float, 3>;
using Files = std::map<std::string, std::string>;

constexpr char kRecord[] = ".gltf-mcc-tiles.jsonl";

Bytes bytesOf(const fs::path& path) {
  const std::string content = contentOf(path);
  return {content.begin(), content.end()};
}

/// Returns the models of a tile as they are stored.
std::vector<Bytes> modelsOf(const Bytes& file) {
  tiles::TileFile tile;
  const gltf::Result read = tile.read(file);
  EXPECT_TRUE(read.ok()) << read.message();
  std::vector<Bytes> models;
  for (const tiles::TileModel& model : tile.models()) {
    models.emplace_back(file.begin() + static_cast<ptrdiff_t>(model.begin),
                        file.begin() + static_cast<ptrdiff_t>(model.end));
  }
  return models;
}

std::vector<Position> positionsOf(const Bytes& model) {
  Bytes decoded;
  gltf::DecodeReport report;
  gltf::Result result = gltf::decodeGlb(model, decoded, report);
  EXPECT_TRUE(result.ok()) << result.message();
  gltf::Document document;
  result = gltf::loadDocument(decoded, nullptr, document);
  EXPECT_TRUE(result.ok()) << result.message();
  if (!result.ok()) return {};
  const auto accessor =
      document.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<uint32_t>();
  const std::vector<double> numbers = gltf::test::SceneReader::numbers(document, accessor);
  std::vector<Position> positions;
  for (size_t i = 0; i + 2 < numbers.size(); i += 3) {
    positions.push_back({static_cast<float>(numbers[i]), static_cast<float>(numbers[i + 1]),
                         static_cast<float>(numbers[i + 2])});
  }
  return positions;
}

double distanceOf(const Position& a, const Position& b) {
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += (double{a[c]} - b[c]) * (double{a[c]} - b[c]);
  return std::sqrt(sum);
}

const Position& nearest(const Position& to, const std::vector<Position>& positions) {
  size_t best = 0;
  for (size_t i = 1; i < positions.size(); ++i) {
    if (distanceOf(to, positions[i]) < distanceOf(to, positions[best])) best = i;
  }
  return positions[best];
}

class Tiles : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
    storeTerrain(path("in"));
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }
  ToolResult run(const std::string& arguments) const { return runTool(folder_, arguments); }

  /// Returns the files of a folder and below with their contents, without our record.
  Files filesOf(const std::string& name) const {
    Files files;
    for (const auto& entry : fs::recursive_directory_iterator(path(name))) {
      if (entry.is_directory() || entry.path().filename() == kRecord) continue;
      files[entry.path().lexically_relative(path(name)).generic_string()] = contentOf(entry.path());
    }
    return files;
  }

  /// Starts the tool without waiting for it.
  pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = fork();
    if (child != 0) return child;
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
    becomeTool(folder_, arguments);
  }

  /// Compares the positions of the models of one file with their sources.
  void expectWithin(const std::string& name, const std::vector<double>& promised_errors) const {
    const std::vector<Bytes> sources = modelsOf(bytesOf(path("in") / name));
    const std::vector<Bytes> models = modelsOf(bytesOf(path("out") / name));
    ASSERT_EQ(models.size(), sources.size()) << name;
    ASSERT_EQ(models.size(), promised_errors.size()) << name;
    for (size_t m = 0; m < models.size(); ++m) {
      EXPECT_LT(models[m].size(), sources[m].size() / 2) << name;
      const std::vector<Position> decoded = positionsOf(models[m]);
      const std::vector<Position> source = positionsOf(sources[m]);
      ASSERT_EQ(decoded.size(), source.size()) << name;
      double largest = 0;
      for (const Position& position : source) {
        largest = std::max(largest, distanceOf(position, nearest(position, decoded)));
      }
      EXPECT_LE(largest, promised_errors[m]) << name;
      // Much less would mean that the promise was not used.
      EXPECT_GT(largest, promised_errors[m] / 8) << name;
    }
  }

  ScratchFolder folder_;
};

TEST_F(Tiles, EveryModelIsWithinThePromisedError) {
  const Files before = filesOf("in");
  const ToolResult result = run("tiles in/tileset.json out --report report.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(filesOf("in") == before);
  expectWithin("0/root.glb", {4});
  expectWithin("1/0-0.b3dm", {1});
  expectWithin("1/1-1.b3dm", {1});
  expectWithin("2/leaf 3-0.glb", {0.5});
  expectWithin("2/leaf 3-3.glb", {0.5});
  expectWithin("2/leaf 0-0.cmpt", {0.5, 0.5 / 0.01});  // the instances are smaller by 100
  expectWithin("2/leaf 1-0.i3dm", {0.5 / 4});          // and larger by 4
  const Json report = Json::parse(contentOf(path("report.json")));
  EXPECT_EQ(report["levels"].size(), 4u);
  EXPECT_EQ(report["levels"][0]["tiles"], 1);
  EXPECT_EQ(report["levels"][1]["tiles"], 5);
  for (const Json& level : report["levels"]) {
    EXPECT_LE(level["largest_error"].get<double>(), level["promised_error"].get<double>());
    EXPECT_GT(level["largest_error"].get<double>(), 0);
  }
  EXPECT_LT(report["all"]["output_bytes"].get<uint64_t>(),
            report["all"]["input_bytes"].get<uint64_t>() / 4);
}

TEST_F(Tiles, EverythingElseIsCopied) {
  ASSERT_EQ(run("tiles in/tileset.json out").status, 0);
  const Files before = filesOf("in");
  Files after = filesOf("out");
  for (const char* name :
       {"tileset.json", "east side/part.json", "points.pnts", "style.json", "notes/read me.txt"}) {
    EXPECT_TRUE(after.at(name) == before.at(name)) << name;
  }
  // The .gltf has its buffer under another name now.
  EXPECT_EQ(after.size(), before.size());
  EXPECT_EQ(after.count("2/patch.bin"), 0u);
  EXPECT_EQ(after.count("2/leaf 2-0.bin"), 1u);
  EXPECT_LT(after.at("2/leaf 2-0.bin").size(), before.at("2/patch.bin").size() / 4);
  after.erase("2/leaf 2-0.bin");
  for (const auto& [name, content] : after) EXPECT_EQ(before.count(name), 1u) << name;
}

/// Everything before the GLB stays, apart from the length of the tile, and so does what its
/// vertices say about the tables.
TEST_F(Tiles, TablesAreKept) {
  ASSERT_EQ(run("tiles in/tileset.json out").status, 0);
  for (const char* name : {"1/0-0.b3dm", "1/1-0.b3dm", "2/leaf 1-0.i3dm"}) {
    const std::string before = contentOf(path("in") / name);
    const std::string after = contentOf(path("out") / name);
    const size_t glb = before.find("glTF");
    EXPECT_EQ(after.find("glTF"), glb);
    EXPECT_EQ(after.substr(12, glb - 12), before.substr(12, glb - 12));
    EXPECT_EQ(after.size() % 8, 0u);
    uint32_t length = 0;
    std::memcpy(&length, after.data() + 8, 4);
    EXPECT_EQ(length, after.size());
    EXPECT_LT(after.size(), before.size() / 2);
  }
  const std::string cmpt = contentOf(path("out") / "2/leaf 0-0.cmpt");
  const Bytes points = makePnts();
  EXPECT_NE(cmpt.find(std::string(points.begin(), points.end())), std::string::npos);
}

/// Positions that two tiles of a level have in common decode to equal bits.
TEST_F(Tiles, BordersStayClosed) {
  ASSERT_EQ(run("tiles in/tileset.json out").status, 0);
  std::map<Position, Position> seen[2];
  size_t shared_count = 0;
  const auto add = [&](const std::string& name, std::map<Position, Position>& known) {
    const std::vector<Position> source = positionsOf(modelsOf(bytesOf(path("in") / name))[0]);
    const std::vector<Position> decoded = positionsOf(modelsOf(bytesOf(path("out") / name))[0]);
    for (const Position& position : source) {
      const auto [found, is_new] = known.try_emplace(position, nearest(position, decoded));
      if (is_new) continue;
      ++shared_count;
      EXPECT_EQ(found->second, nearest(position, decoded)) << name;
    }
  };
  for (const char* name : {"1/0-0.b3dm", "1/1-0.b3dm", "1/0-1.b3dm"}) add(name, seen[0]);
  for (const char* name : {"2/leaf 0-0.cmpt", "2/leaf 1-0.glb", "2/leaf 0-1.glb", "2/leaf 1-1.glb",
                           "2/leaf 3-0.glb", "2/leaf 3-1.glb", "2/leaf 2-1.glb"}) {
    add(name, seen[1]);
  }
  EXPECT_GT(shared_count, 200u);
}

TEST_F(Tiles, ResultsDoNotDependOnTheJobs) {
  ASSERT_EQ(run("tiles in/tileset.json out").status, 0);
  ASSERT_EQ(run("tiles in/tileset.json two -j 2").status, 0);
  EXPECT_TRUE(filesOf("out") == filesOf("two"));
}

TEST_F(Tiles, WhatHasNotChangedIsLeftAlone) {
  ASSERT_EQ(run("tiles in/tileset.json out").status, 0);
  std::map<std::string, fs::file_time_type> times;
  for (const auto& [name, content] : filesOf("out")) {
    times[name] = fs::last_write_time(path("out") / name);
  }
  const ToolResult again = run("tiles in/tileset.json out --format json");
  ASSERT_EQ(again.status, 0) << again.err;
  const Json report = Json::parse(again.out);
  for (const Json& file : report["files"]) EXPECT_TRUE(file["up_to_date"]) << file;
  for (const auto& [name, time] : times) {
    EXPECT_EQ(fs::last_write_time(path("out") / name), time) << name;
  }
  // One tile changes.
  storeBytes(path("in/1/0-0.b3dm"), makeB3dm(makePatchGlb(1, 1, 0, true), 2));
  ASSERT_EQ(run("tiles in/tileset.json out").status, 0);
  ASSERT_EQ(run("tiles in/tileset.json anew").status, 0);
  EXPECT_TRUE(filesOf("out") == filesOf("anew"));
  EXPECT_EQ(fs::last_write_time(path("out/1/1-0.b3dm")), times.at("1/1-0.b3dm"));
  // Other options make all tiles again.
  ASSERT_EQ(run("tiles in/tileset.json out --error-share 0.01").status, 0);
  EXPECT_GT(contentOf(path("out/1/1-0.b3dm")).size(), contentOf(path("anew/1/1-0.b3dm")).size());
}

/// Killed again and again at other moments, until a run gets to its end.
TEST_F(Tiles, ContinuesAfterItWasKilled) {
  ASSERT_EQ(run("tiles in/tileset.json out").status, 0);
  const Files expected = filesOf("out");
  size_t killed_count = 0;
  for (int delay_ms = 5; delay_ms <= 200; delay_ms += 12) {
    const pid_t child = start({"tiles", "in/tileset.json", "killed", "-j", "2"});
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    kill(child, SIGKILL);
    int code = 0;
    waitpid(child, &code, 0);
    killed_count += WIFSIGNALED(code) ? 1 : 0;
    // Whatever is there under its own name is complete.
    if (!fs::exists(path("killed"))) continue;
    for (const auto& [name, content] : filesOf("killed")) {
      if (name.find(".tmp-") != std::string::npos) continue;
      EXPECT_TRUE(expected.contains(name) && expected.at(name) == content) << name;
    }
  }
  EXPECT_GT(killed_count, 0u);
  const ToolResult last = run("tiles in/tileset.json killed");
  ASSERT_EQ(last.status, 0) << last.err;
  EXPECT_TRUE(filesOf("killed") == expected);
}

TEST_F(Tiles, FilesOfOthersAreKept) {
  storeText(path("out/1/0-0.b3dm"), "mine");
  storeText(path("out/else.txt"), "mine, too");
  fs::create_directory(path("elsewhere"));
  fs::create_directory_symlink(path("elsewhere"), path("out/2"));
  const ToolResult result = run("tiles in/tileset.json out");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("0-0.b3dm: is there and was not written by this command"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(contentOf(path("out/1/0-0.b3dm")), "mine");
  EXPECT_EQ(contentOf(path("out/else.txt")), "mine, too");
  EXPECT_TRUE(fs::is_empty(path("elsewhere")));
  EXPECT_TRUE(fs::exists(path("out/1/1-0.b3dm")));
}

TEST_F(Tiles, OneBadTileDoesNotStopTheOthers) {
  storeText(path("in/1/0-0.b3dm"), "b3dm is all there is");
  storeText(path("in/2/leaf 3-3.glb"), std::string("glTF\2\0\0\0\377\377\377\377JSON", 16));
  fs::remove(path("in/2/leaf 3-2.glb"));
  const ToolResult result = run("tiles in/tileset.json out");
  EXPECT_EQ(result.status, 1);
  for (const char* part : {"0-0.b3dm: byte 4: ", "leaf 3-3.glb: ",
                           "part.json: /root/children/1/content/uri: names no file"}) {
    EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
  }
  EXPECT_EQ(contentOf(path("out/1/0-0.b3dm")), "b3dm is all there is");
  EXPECT_EQ(contentOf(path("out/2/leaf 3-3.glb")), contentOf(path("in/2/leaf 3-3.glb")));
  expectWithin("1/1-0.b3dm", {1});
  EXPECT_EQ(run("tiles in/tileset.json out").status, 1);  // it stays bad
}

TEST_F(Tiles, WrongUse) {
  const auto expectRefused = [&](const std::string& arguments, const std::string& message) {
    const Files before = filesOf("in");
    const ToolResult result = run("tiles " + arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(filesOf("in") == before);
  };
  expectRefused("in/tileset.json in", "is the folder of the tileset or inside of it");
  expectRefused("in/tileset.json in/", "is the folder of the tileset or inside of it");
  expectRefused("in/tileset.json in/out", "is the folder of the tileset or inside of it");
  expectRefused("in/tileset.json .", "contains the tileset");
  expectRefused("in/none.json out", "does not exist");
  expectRefused("in out", "is a folder; name the tileset in it");
  expectRefused("in/style.json out", "is not a tileset: it has no root");
  storeText(path("in/bad.json"), "{\"root\": ");
  expectRefused("in/bad.json out", "bad.json: JSON byte ");
  storeText(path("in/loop.json"), makeTileset(makeTile(1, "other.json"), 1).dump());
  storeText(path("in/other.json"), makeTileset(makeTile(1, "./loop.json"), 1).dump());
  expectRefused("in/loop.json out", "\"loop.json\" contains itself");
  EXPECT_FALSE(fs::exists(path("out")));
}

/// A tile's transform scales the promised error, and tiles with different transforms share no grid.
TEST_F(Tiles, TransformsCount) {
  Json root = makeTile(64, "");
  for (const char* name : {"1/0-0.b3dm", "1/1-0.b3dm", "2/leaf 3-3.glb"}) {
    root["children"].push_back(makeTile(16, name));
  }
  root["transform"] = {0, 4, 0, 0, -4, 0, 0, 0, 0, 0, 4, 0, 6e6, 1e6, 2e6, 1};
  root["children"][1]["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1};
  root["children"][2]["transform"] = {0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1};
  storeText(path("in/placed.json"), makeTileset(root, 100).dump());
  const ToolResult result = run("tiles in/placed.json out");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("note: the tiles of level 1 have 3 different transforms"),
            std::string::npos)
      << result.out;
  expectWithin("1/0-0.b3dm", {1.0 / 4});
  expectWithin("1/1-0.b3dm", {1.0 / 4});
  expectWithin("2/leaf 3-3.glb", {1.0 / 2});
}

/// A grid of more than 24 bits is not possible, and the tiles are told apart.
TEST_F(Tiles, GridsThatAreTooFineAreNoted) {
  const ToolResult result = run("tiles in/tileset.json out --error-share 0.000001");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("needs more than 24 bits for one grid of positions"), std::string::npos)
      << result.out;
}

TEST_F(Tiles, BitsReplaceTheErrorShare) {
  ASSERT_EQ(run("tiles in/tileset.json out --quantize-position 11 --report r.json").status, 0);
  const Json level = Json::parse(contentOf(path("r.json")))["levels"][1];
  EXPECT_EQ(level["position_bits"], Json({11, 11}));
  EXPECT_FALSE(level.contains("promised_error"));
  EXPECT_EQ(run("tiles in/tileset.json out --quantize-position 11 --error-share 0.1").status, 2);
}

TEST_F(Tiles, ImplicitTilesAreCopiedAndNoted) {
  Json root = makeTile(64, "1/{x}-{y}.b3dm");
  root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"}};
  storeText(path("in/implicit.json"), makeTileset(root, 100).dump());
  const ToolResult result = run("tiles in/implicit.json out");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("note: 1 tile with implicit tiling"), std::string::npos) << result.out;
  EXPECT_TRUE(filesOf("out") == filesOf("in"));
}

TEST_F(Tiles, DeepTreesAreRead) {
  std::string text = "{\"asset\":{\"version\":\"1.0\"},\"geometricError\":9,\"root\":";
  constexpr int kDepth = 20000;
  for (int i = 0; i < kDepth; ++i) text += "{\"geometricError\":8,\"children\":[";
  text += "{\"geometricError\":0,\"content\":{\"uri\":\"0/root.glb\"}}";
  for (int i = 0; i < kDepth; ++i) text += "]}";
  storeText(path("in/deep.json"), text + "}");
  const ToolResult result = run("tiles in/deep.json out -q --report report.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(Json::parse(contentOf(path("report.json")))["levels"].size(), kDepth + 1);
  expectWithin("0/root.glb", {0.25});
}

}  // namespace
}  // namespace mcc::test
