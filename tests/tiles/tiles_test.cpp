// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// `gltf-mcc tiles` as a user sees it.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

#include "support/made_files.h"
#include "tiles/tiles_fixture.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class Tiles : public TilesTest {};

TEST_F(Tiles, EveryModelIsWithinThePromisedError) {
  const Files before = filesOf("in");
  const ToolResult result = run("tiles in/tileset.json out --report report.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(filesOf("in") == before);
  expectWithin("in", "0/root.glb", {4});
  expectWithin("in", "1/0-0.b3dm", {1});
  expectWithin("in", "1/1-1.b3dm", {1});
  expectWithin("in", "2/leaf 3-0.glb", {0.5});
  expectWithin("in", "2/leaf 3-3.glb", {0.5});
  expectWithin("in", "2/leaf 0-0.cmpt", {0.5, 0.5 / 0.01});  // the instances are smaller by 100
  expectWithin("in", "2/leaf 1-0.i3dm", {0.5 / 4});          // and larger by 4
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
  const std::string buffer = "2/" + madeBeside(path("out/2"), "leaf 2-0");
  EXPECT_LT(after.at(buffer).size(), before.at("2/patch.bin").size() / 4);
  after.erase(buffer);
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
  size_t shared_count = expectClosedBorders("in", {"1/0-0.b3dm", "1/1-0.b3dm", "1/0-1.b3dm"});
  shared_count += expectClosedBorders(
      "in", {"2/leaf 0-0.cmpt", "2/leaf 1-0.glb", "2/leaf 0-1.glb", "2/leaf 1-1.glb",
             "2/leaf 3-0.glb", "2/leaf 3-1.glb", "2/leaf 2-1.glb"});
  EXPECT_GT(shared_count, 200u);
}

/// A patch whose coordinates begin at its own centre, of which `center` becomes the place.
Bytes makeCentredPatch(uint32_t x, uint32_t y, bool is_b3dm, std::array<double, 3>& center) {
  // No two of them are a multiple of the step apart.
  center = {-375.3 + 250.37 * x + 0.21 * y, 375.7 - 250.41 * y, 0.3 + 0.4 * x};
  gltf::test::Builder builder = makePatch(2, x, y, is_b3dm);
  float positions[3] = {};
  const Json& accessor = builder.json["accessors"][0];
  const Json& view = builder.json["bufferViews"][accessor["bufferView"].get<size_t>()];
  const auto begin = view["byteOffset"].get<size_t>();
  for (size_t i = 0; i < accessor["count"].get<size_t>(); ++i) {
    uint8_t* const at = builder.bin.data() + begin + 12 * i;
    std::memcpy(positions, at, 12);
    positions[0] = static_cast<float>(positions[0] - center[0]);
    positions[1] = static_cast<float>(positions[1] - center[2]);
    positions[2] = static_cast<float>(positions[2] + center[1]);  // z points south
    std::memcpy(at, positions, 12);
  }
  for (const char* bound : {"min", "max"}) {
    Json& stated = builder.json["accessors"][0][bound];
    stated = {stated[0].get<double>() - center[0], stated[1].get<double>() - center[2],
              stated[2].get<double>() + center[1]};
    for (Json& one : stated) one = static_cast<float>(one.get<double>());
  }
  if (!is_b3dm) return builder.toGlb();
  Tables tables;
  tables.feature_json = paddedJson(
      Json({{"BATCH_LENGTH", 0}, {"RTC_CENTER", {center[0], center[1], center[2]}}}).dump(), 28);
  return makeModelTile("b3dm", tables, builder.toGlb());
}

/// Tiles whose coordinates begin at centres of their own (RTC_CENTER, or the tile's transform) have
/// one lattice all the same: common points come to the same place, apart from the rounding of
/// float32, which is far below the promised error.
TEST_F(Tiles, BordersOfTranslatedTilesStayClosed) {
  Json root = makeTile(64, "");
  root["transform"] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 6e6, 1e6, 2e6, 1};
  std::vector<std::pair<std::string, std::array<double, 3>>> tiles;
  for (uint32_t i = 0; i < 4; ++i) {
    const bool is_b3dm = i < 2;
    const std::string name = "centred" + std::to_string(i) + (is_b3dm ? ".b3dm" : ".glb");
    std::array<double, 3> center;
    storeBytes(path("in") / name, makeCentredPatch(i % 2, i / 2, is_b3dm, center));
    // The step is 1/8: no coordinate of the patches lies in the middle between two points of the
    // grid, where the rounding of float32 would decide.
    Json tile = makeTile(2, name);
    if (!is_b3dm) {
      tile["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, center[0], center[1], center[2], 1};
    }
    root["children"].push_back(tile);
    tiles.push_back({name, center});
  }
  storeText(path("in/centred.json"), makeTileset(root, 100).dump());
  const ToolResult result = run("tiles in/centred.json out");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.find("may open"), std::string::npos) << result.out;
  std::map<std::array<long, 2>, std::array<double, 3>> known;  // by the point in millimetres
  size_t shared_count = 0;
  double largest = 0;
  for (const auto& [name, center] : tiles) {
    expectWithin("in", name, {2.0 / 16});
    const std::vector<Position> before = positionsOf(modelsOf(bytesOf(path("in") / name))[0]);
    const std::vector<Position> decoded = positionsOf(modelsOf(bytesOf(path("out") / name))[0]);
    for (const Position& position : before) {
      const Position& moved = nearest(position, decoded);
      const std::array<double, 3> place = {moved[0] + center[0], moved[2] - center[1],
                                           moved[1] + center[2]};
      const std::array<long, 2> key = {std::lround(1000 * (position[0] + center[0])),
                                       std::lround(1000 * (position[2] - center[1]))};
      const auto [found, is_new] = known.try_emplace(key, place);
      if (is_new) continue;
      ++shared_count;
      for (size_t c = 0; c < 3; ++c) {
        largest = std::max(largest, std::abs(found->second[c] - place[c]));
      }
    }
  }
  EXPECT_GT(shared_count, 90u);
  EXPECT_LT(largest, 0.001);
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
  expectWithin("in", "1/1-0.b3dm", {1});
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

/// A tile's transform scales the promised error, and tiles that are turned or scaled differently
/// share no grid.
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
  EXPECT_NE(result.out.find("note: the tiles of level 1 have transforms of 2 kinds"),
            std::string::npos)
      << result.out;
  expectWithin("in", "1/0-0.b3dm", {1.0 / 4});
  expectWithin("in", "1/1-0.b3dm", {1.0 / 4});
  expectWithin("in", "2/leaf 3-3.glb", {1.0 / 2});
}

/// The third tile that shows a file must not cost the other two their promise, however it scales.
TEST_F(Tiles, AnEnormousScaleKeepsThePromiseOfOtherTiles) {
  const auto scaledBy = [](double s, Json tile) {
    tile["transform"] = {s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, 0, 0, 0, 1};
    return tile;
  };
  const Json plain = makeTile(16, "1/0-0.b3dm");
  Json root = makeTile(64, "");
  root["children"] = {plain, plain, scaledBy(1e308, plain)};
  storeText(path("in/large.json"), makeTileset(root, 100).dump());
  ToolResult result = run("tiles in/large.json out --report report.json");
  EXPECT_EQ(result.status, 0) << result.err;
  Json report = Json::parse(contentOf(path("report.json")));
  EXPECT_EQ(report["levels"][1]["promised_error"], 1.0);
  EXPECT_EQ(report["levels"][1]["position_bits"], Json({0, 0})) << "only exact ones are so near";
  EXPECT_EQ(result.out.find("inf"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("no tile above it has a geometric error"), std::string::npos);
  // Beyond the numbers of 64 bits a transform has no meaning, and only that tile is left out.
  Json beyond = makeTile(16, "");
  beyond["children"] = Json::array({scaledBy(1e200, plain)});
  root["children"] = {plain, plain, scaledBy(1e200, beyond)};
  storeText(path("in/large.json"), makeTileset(root, 100).dump());
  result = run("tiles in/large.json out");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("large.json: /root/children/2/children/0/transform: with those above "
                            "it reaches beyond the numbers of 64 bits"),
            std::string::npos)
      << result.err;
  expectWithin("in", "1/0-0.b3dm", {1});
}

/// A grid of more than 24 bits is not possible, and the tiles are told apart.
TEST_F(Tiles, GridsThatAreTooFineAreNoted) {
  const ToolResult result = run("tiles in/tileset.json out --error-share 0.000001");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("needs more than 24 bits for one lattice of positions"),
            std::string::npos)
      << result.out;
}

TEST_F(Tiles, BitsReplaceTheErrorShare) {
  ASSERT_EQ(run("tiles in/tileset.json out --position-bits 11 --report r.json").status, 0);
  const Json level = Json::parse(contentOf(path("r.json")))["levels"][1];
  EXPECT_EQ(level["position_bits"], Json({11, 11}));
  EXPECT_FALSE(level.contains("promised_error"));
  EXPECT_EQ(run("tiles in/tileset.json out --position-bits 11 --error-share 0.1").status, 2);
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
  expectWithin("in", "0/root.glb", {0.25});
}

}  // namespace
}  // namespace mcc::test
