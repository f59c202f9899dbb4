// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tilesets whose files ask for far more work than they have bytes. What is counted here must not
// depend on how often a file, a schema or a place is named. tools/check/growth tilesets measures
// time and memory of the same tilesets.
#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "support/scratch_folder.h"
#include "tiles/tileset_builder.h"
#include "tiles/tileset_json.h"
#include "tiles/tileset_walk.h"

namespace mcc::test {
namespace {

using TextFiles = std::map<std::string, std::string>;

struct Walked {
  gltf::Result result;
  tiles::TilesetWalk walk;

  const tiles::WalkWork& work() const { return walk.work(); }
  size_t failureBytes() const {
    size_t bytes = 0;
    for (const gltf::Result& failure : walk.failures()) bytes += failure.message().size();
    return bytes;
  }
};

Walked walkFiles(const TextFiles& files, uint64_t max_tiles = tiles::kMostTiles) {
  const ScratchFolder folder;
  for (const auto& [name, content] : files) storeText(folder.path() / name, content);
  tiles::FileTable table;
  std::vector<std::string> notes;
  const auto never = [](std::string_view) { return false; };
  EXPECT_TRUE(table.read(folder.path(), {}, never, notes).ok());
  Walked walked;
  walked.result = walked.walk.run(folder.path(), "tileset.json", table, {}, max_tiles);
  return walked;
}

std::string textOf(const Json& root, const Json& more = Json::object()) {
  Json json = makeTileset(root, 100);
  json.update(more);
  return json.dump();
}

Json withChildren(size_t count, const Json& child) {
  Json root = makeTile(64, "");
  root["children"] = std::vector<Json>(count, child);
  return root;
}

Json movedBy(double x, Json tile) {
  tile["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1};
  return tile;
}

Json turnedBy(double angle, Json tile) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  tile["transform"] = {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return tile;
}

Json tiling(const std::string& subtree) {
  Json tile = makeTile(8, "x.pnts");
  tile["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                            {"subtreeLevels", 1},
                            {"availableLevels", 1},
                            {"subtrees", {{"uri", subtree}}}};
  return tile;
}

std::string subtreeText() {
  return Json({{"tileAvailability", {{"constant", 1}}},
               {"contentAvailability", {{{"constant", 1}}}},
               {"childSubtreeAvailability", {{"constant", 0}}}})
      .dump();
}

const Json kSchema = {{"classes", {{"a", {{"properties", Json::object()}}}}}};

TEST(TilesetGrowth, SchemasAndSubtreesAreParsedOnce) {
  TextFiles files = {{"s.json", subtreeText()}, {"x.pnts", ""}, {"schema.json", kSchema.dump()}};
  for (const Json& schema : {Json({{"schema", kSchema}}), Json({{"schemaUri", "schema.json"}})}) {
    for (const size_t n : {1u, 100u}) {
      files["tileset.json"] = textOf(withChildren(n, tiling("s.json")), schema);
      const Walked walked = walkFiles(files);
      EXPECT_TRUE(walked.result.ok()) << walked.result.message();
      EXPECT_EQ(walked.walk.failureCount(), 0u);
      EXPECT_EQ(walked.work().parse_count, 3u) << n;  // of the tileset, the schema and the subtree
      EXPECT_EQ(walked.work().file_count, 3u) << n;
      EXPECT_EQ(walked.walk.levelTiles()[1], n);
    }
  }
}

TEST(TilesetGrowth, DamagedSchemasAndSubtreesAreParsedOnce) {
  const TextFiles files = {{"s.json", "{"},
                           {"x.pnts", ""},
                           {"schema.json", "{"},
                           {"tileset.json", textOf(withChildren(100, tiling("s.json")),
                                                   {{"schemaUri", "schema.json"}})}};
  const Walked walked = walkFiles(files);
  EXPECT_EQ(walked.work().parse_count, 3u);
  EXPECT_EQ(walked.walk.failureCount(), 101u);  // the schema once, and each tiling
}

/// A schema that many tilesets name.
TEST(TilesetGrowth, ASchemaOfManyTilesetsIsParsedOnce) {
  TextFiles files = {{"s.json", subtreeText()}, {"x.pnts", ""}, {"schema.json", kSchema.dump()}};
  Json root = makeTile(64, "");
  for (int i = 0; i < 20; ++i) {
    const std::string name = "e" + std::to_string(i) + ".json";
    root["children"].push_back(makeTile(8, name));
    files[name] = textOf(makeTile(8, "x.pnts"), {{"schemaUri", "schema.json"}});
    Json json = Json::parse(files[name]);
    json["root"] = tiling("s.json");
    files[name] = json.dump();
  }
  files["tileset.json"] = textOf(root);
  const Walked walked = walkFiles(files);
  EXPECT_TRUE(walked.result.ok()) << walked.result.message();
  EXPECT_EQ(walked.work().parse_count, 1u + 20 + 1 + 20);  // a subtree for each schema's tileset
}

/// Tiles with the same external tileset at the same place: it is visited once, and its tiles are
/// counted for each.
TEST(TilesetGrowth, APlaceIsVisitedOnce) {
  for (const size_t n : {1u, 50u, 100u}) {
    const Walked walked =
        walkFiles({{"x.pnts", ""},
                   {"tileset.json", textOf(withChildren(n, makeTile(8, "e.json")))},
                   {"e.json", textOf(withChildren(10, makeTile(4, "x.pnts")))}});
    EXPECT_TRUE(walked.result.ok()) << walked.result.message();
    EXPECT_EQ(walked.work().parse_count, 2u);
    EXPECT_EQ(walked.work().tile_count, 1 + n + 11);
    EXPECT_EQ(walked.walk.levelTiles(), (std::vector<uint64_t>{1, n, n, 10 * n}));
  }
}

/// Each at a place of its own: the file is read once, and the tiles are visited for each.
TEST(TilesetGrowth, AFileIsReadOnceForAllPlaces) {
  constexpr size_t kPlaces = 100;
  Json root = makeTile(64, "");
  for (size_t i = 0; i < kPlaces; ++i) {
    root["children"].push_back(movedBy(static_cast<double>(i), makeTile(8, "e.json")));
  }
  const Walked walked = walkFiles({{"x.pnts", ""},
                                   {"tileset.json", textOf(root)},
                                   {"e.json", textOf(withChildren(10, makeTile(-1, "x.pnts")))}});
  EXPECT_TRUE(walked.result.ok()) << walked.result.message();
  EXPECT_EQ(walked.work().file_count, 3u);  // e.json also to see what it is
  EXPECT_EQ(walked.work().parse_count, 2u);
  EXPECT_EQ(walked.work().tile_count, 1 + kPlaces * 12);
  EXPECT_EQ(walked.walk.levelTiles()[3], 10 * kPlaces);
  EXPECT_EQ(walked.walk.failureCount(), 10u) << "what is wrong in a file is listed once";
}

/// Tilesets that each name the next one twice.
TextFiles doublingChain(size_t length, bool at_own_places) {
  TextFiles files = {{"x.pnts", ""}};
  double offset = 1;
  for (size_t i = 0; i < length; ++i, offset /= 2) {
    const std::string next = i + 1 < length ? std::to_string(i + 1) + ".json" : "x.pnts";
    Json root = withChildren(2, makeTile(8, next));
    if (at_own_places) root["children"][1] = movedBy(offset, makeTile(8, next));
    files[i == 0 ? "tileset.json" : std::to_string(i) + ".json"] = textOf(root);
  }
  return files;
}

TEST(TilesetGrowth, ChainsThatDoubleAtOnePlace) {
  const Walked walked = walkFiles(doublingChain(20, false));
  EXPECT_TRUE(walked.result.ok()) << walked.result.message();
  EXPECT_EQ(walked.work().tile_count, 60u);
  EXPECT_EQ(walked.work().parse_count, 20u);
  const std::vector<uint64_t>& tiles = walked.walk.levelTiles();
  EXPECT_EQ(std::accumulate(tiles.begin(), tiles.end(), uint64_t{0}), 3 * ((1u << 20) - 1));
  for (const size_t length : {25u, 100u}) {  // the second has more tiles than 64 bits can count
    const Walked more = walkFiles(doublingChain(length, false));
    EXPECT_EQ(more.result.message(),
              "the tilesets have more than 16777216 tiles; --max-tiles allows more");
    EXPECT_EQ(more.work().tile_count, 3 * length);
  }
}

TEST(TilesetGrowth, ChainsThatDoubleTheirPlaces) {
  const Walked few = walkFiles(doublingChain(8, true));
  EXPECT_TRUE(few.result.ok()) << few.result.message();
  EXPECT_EQ(few.work().tile_count, 3u * 255);
  for (const size_t length : {25u, 50u}) {
    const Walked walked = walkFiles(doublingChain(length, true), 1 << 18);
    EXPECT_NE(walked.result.message().find("repeated more than"), std::string::npos)
        << walked.result.message();
    EXPECT_LE(walked.work().naming_count, (1u << 10) + length * 1000 / 8);
    EXPECT_LE(walked.work().parse_count, length);
  }
}

/// Groups take memory, so further places of a tileset may not add any number of them.
TEST(TilesetGrowth, GroupsOfFurtherPlacesCountAsTiles) {
  Json root = makeTile(64, "");
  for (int i = 0; i < 100; ++i) root["children"].push_back(turnedBy(i, makeTile(8, "e.json")));
  const TextFiles files = {
      {"x.pnts", ""}, {"tileset.json", textOf(root)}, {"e.json", textOf(makeTile(4, "x.pnts"))}};
  EXPECT_FALSE(walkFiles(files, 1000).result.ok());
  EXPECT_TRUE(walkFiles(files, 1000 + 99 * 16).result.ok());
}

/// Tiles inside of each other that all fail: the texts of messages are bounded.
TEST(TilesetGrowth, FailuresAreBounded) {
  for (const size_t depth : {5000u, 20000u}) {
    std::string text = R"({"asset":{"version":"1.1"},"geometricError":9,"root":)";
    for (size_t i = 0; i < depth; ++i) {
      text += R"({"geometricError":-1,"content":{"uri":"gone.glb"},"children":[)";
    }
    text += R"({"geometricError":0})";
    for (size_t i = 0; i < depth; ++i) text += "]}";
    const Walked walked = walkFiles({{"tileset.json", text + "}"}});
    EXPECT_TRUE(walked.result.ok()) << walked.result.message();
    EXPECT_EQ(walked.walk.failureCount(), 2 * depth);
    EXPECT_EQ(walked.walk.failures().size(), 1000u);
    EXPECT_LT(walked.failureBytes(), 1000u * 700);
  }
  const Walked named = walkFiles(
      {{"tileset.json", textOf(withChildren(100, makeTile(1, std::string(50000, 'a') + ".glb")))}});
  EXPECT_EQ(named.walk.failures().size(), 100u);
  EXPECT_LT(named.failureBytes(), 100u * 2100);
}

TEST(TilesetGrowth, PathsOfDeepTilesShowBothEnds) {
  tiles::TilesetJson json;
  for (uint32_t i = 0; i < 40; ++i) {
    json.tiles.push_back({i == 0 ? kNone : i - 1, i, kNone, false, 1});
  }
  std::string all = "/root";
  for (uint32_t i = 1; i <= 32; ++i) all += "/children/" + std::to_string(i);
  EXPECT_EQ(json.pathOfTile(0), "/root");
  EXPECT_EQ(json.pathOfTile(32), all);
  const std::string deep = json.pathOfTile(39);
  EXPECT_NE(deep.find("/children/16/… 7 levels …/children/24/"), std::string::npos) << deep;
  EXPECT_TRUE(deep.ends_with("/children/39"));
}

TEST(TilesetGrowth, WrongPlacesAreAllCounted) {
  Json root = makeTile(64, "");
  root["children"] = std::vector<Json>(3000, 7);
  const Walked walked = walkFiles({{"tileset.json", textOf(root)}});
  EXPECT_EQ(walked.walk.failureCount(), 3000u);
}

}  // namespace
}  // namespace mcc::test
