// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Implicit tilings: which contents the walk finds, and how accurate they become.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tiles/subtree.h"
#include "tiles/tiles_fixture.h"
#include "tiles/tileset_builder.h"
#include "tiles/tileset_walk.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;
using tiles::ImplicitPlace;

/// Bits of availability, as a subtree stores them.
Bytes bitsOf(const std::vector<bool>& available) {
  Bytes bits((available.size() + 7) / 8, 0);
  for (size_t i = 0; i < available.size(); ++i) {
    if (available[i]) bits[i / 8] |= static_cast<uint8_t>(1u << (i % 8));
  }
  return bits;
}

/// Collects the buffer views of a subtree.
struct SubtreeBuilder {
  Json json = {{"buffers", Json::array()}, {"bufferViews", Json::array()}};
  Bytes binary;

  size_t addView(const Bytes& bytes) {
    padTo8(binary);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
    append(binary, bytes);
    return json["bufferViews"].size() - 1;
  }
  Json addBits(const std::vector<bool>& available) {
    return {{"bitstream", addView(bitsOf(available))}};
  }
  Bytes finish() {
    padTo8(binary);
    json["buffers"] = {{{"byteLength", binary.size()}}};
    return test::makeSubtree(paddedJson(json.dump(), 24), binary);
  }
};

Json makeImplicit(const char* scheme, uint32_t subtree_levels, uint32_t available_levels) {
  const std::string z = std::string(scheme) == "OCTREE" ? "-{z}" : "";
  Json root = makeTile(64, "c/{level}/{x}-{y}" + z + ".glb");
  root["implicitTiling"] = {{"subdivisionScheme", scheme},
                            {"subtreeLevels", subtree_levels},
                            {"availableLevels", available_levels},
                            {"subtrees", {{"uri", "s/{level}-{x}-{y}" + z + ".subtree"}}}};
  return root;
}

std::string nameOf(const char* folder, const ImplicitPlace& place, bool has_z,
                   const char* separator, const char* ending) {
  std::string name = std::string(folder) + std::to_string(place.level) + separator +
                     std::to_string(place.x) + "-" + std::to_string(place.y);
  if (has_z) name += "-" + std::to_string(place.z);
  return name + ending;
}

/// Walks a tileset in a folder and returns the names of the contents with their geometric errors.
std::map<std::string, double> walk(const fs::path& folder, tiles::TilesetWalk& walked) {
  tiles::FileTable table;
  std::vector<std::string> notes;
  const auto never = [](std::string_view) { return false; };
  EXPECT_TRUE(table.read(folder, {}, never, notes).ok());
  const gltf::Result done = walked.run(folder, "tileset.json", table, {}, tiles::kMostTiles);
  EXPECT_TRUE(done.ok()) << done.message();
  std::map<std::string, double> found;
  for (uint32_t i = 0; i < table.size(); ++i) {
    const tiles::TileDemand* demand = walked.demandOf(i);
    if (demand != nullptr) found[std::string(table.name(i))] = demand->world_distance;
  }
  return found;
}

/// A random tree whose availability is kept as sets, and its subtrees.
class RandomTiling {
 public:
  RandomTiling(uint32_t dimensions, uint32_t seed) : dimensions_(dimensions), random_(seed) {}

  void store(const fs::path& folder, uint32_t subtree_levels, uint32_t available_levels) {
    std::vector<ImplicitPlace> pending = {{}};
    while (!pending.empty()) {
      const ImplicitPlace root = pending.back();
      pending.pop_back();
      SubtreeBuilder subtree;
      std::vector<bool> tiles_here;
      std::vector<bool> contents_here;
      for (uint32_t level = 0; level < subtree_levels; ++level) {
        for (uint64_t m = 0; m < uint64_t{1} << (level * dimensions_); ++m) {
          const ImplicitPlace place = root.below(level, m, dimensions_);
          const bool is_there = place.level < available_levels && random_() % 4 != 0;
          const bool has_content = is_there && random_() % 2 == 0;
          tiles_here.push_back(is_there);
          contents_here.push_back(has_content);
          if (is_there) ++tile_count;
          if (has_content) addContent(folder, place);
        }
      }
      std::vector<bool> children;
      for (uint64_t m = 0; m < uint64_t{1} << (subtree_levels * dimensions_); ++m) {
        const ImplicitPlace child = root.below(subtree_levels, m, dimensions_);
        children.push_back(child.level < available_levels && random_() % 8 == 0);
        if (children.back()) pending.push_back(child);
      }
      subtree.json["tileAvailability"] = subtree.addBits(tiles_here);
      subtree.json["contentAvailability"] = {subtree.addBits(contents_here)};
      subtree.json["childSubtreeAvailability"] = subtree.addBits(children);
      storeBytes(folder / nameOf("s/", root, dimensions_ == 3, "-", ".subtree"), subtree.finish());
    }
  }

  uint64_t tile_count = 0;
  std::map<std::string, double> contents;

 private:
  void addContent(const fs::path& folder, const ImplicitPlace& place) {
    const std::string name = nameOf("c/", place, dimensions_ == 3, "/", ".glb");
    contents[name] = 64.0 / static_cast<double>(uint64_t{1} << place.level);
    storeText(folder / name, "");
  }

  uint32_t dimensions_;
  std::mt19937 random_;
};

TEST(ImplicitTiling, TheWalkFindsWhatIsAvailable) {
  for (const char* scheme : {"QUADTREE", "OCTREE"}) {
    for (uint32_t seed = 1; seed <= 6; ++seed) {
      ScratchFolder scratch;
      const uint32_t dimensions = scheme[0] == 'O' ? 3 : 2;
      RandomTiling tiling(dimensions, seed);
      const uint32_t subtree_levels = 1 + seed % 3;
      tiling.store(scratch.path(), subtree_levels, 5);
      storeText(scratch.path() / "tileset.json",
                makeTileset(makeImplicit(scheme, subtree_levels, 5), 100).dump());
      tiles::TilesetWalk walked;
      EXPECT_EQ(walk(scratch.path(), walked), tiling.contents) << scheme << seed;
      EXPECT_EQ(walked.failureCount(), 0u);
      uint64_t tile_count = 0;
      for (const uint64_t count : walked.levelTiles()) tile_count += count;
      EXPECT_EQ(tile_count, tiling.tile_count);
    }
  }
}

/// Constants, JSON subtrees with a buffer next to them, and the names of the extension of 1.0.
TEST(ImplicitTiling, OldAndNewSpellings) {
  ScratchFolder scratch;
  Json root = makeTile(8, "c/{level}/{x}-{y}.glb");
  root["extensions"]["3DTILES_implicit_tiling"] = {{"subdivisionScheme", "QUADTREE"},
                                                   {"subtreeLevels", 2},
                                                   {"maximumLevel", 1},
                                                   {"subtrees", {{"uri", "s.json"}}}};
  storeText(scratch.path() / "tileset.json", makeTileset(root, 100).dump());
  const Json subtree = {{"buffers", {{{"uri", "bits.bin"}, {"byteLength", 1}}}},
                        {"bufferViews", {{{"buffer", 0}, {"byteLength", 1}}}},
                        {"tileAvailability", {{"constant", 1}}},
                        {"contentAvailability", {{"bufferView", 0}}},
                        {"childSubtreeAvailability", {{"constant", 0}}}};
  storeText(scratch.path() / "s.json", subtree.dump());
  storeBytes(scratch.path() / "bits.bin", bitsOf({true, false, true, false, true}));
  for (const char* name : {"c/0/0-0.glb", "c/1/1-0.glb", "c/1/1-1.glb", "c/1/0-0.glb"}) {
    storeText(scratch.path() / name, "");
  }
  tiles::TilesetWalk walked;
  const std::map<std::string, double> expected = {
      {"c/0/0-0.glb", 8}, {"c/1/1-0.glb", 4}, {"c/1/1-1.glb", 4}};
  EXPECT_EQ(walk(scratch.path(), walked), expected);
  EXPECT_EQ(walked.failureCount(), 0u);
}

/// Geometric errors in the metadata of tiles replace those that follow from the level.
TEST(ImplicitTiling, ErrorsFromMetadata) {
  ScratchFolder scratch;
  Json tileset = makeTileset(makeImplicit("QUADTREE", 2, 2), 100);
  tileset["schema"] = {{"classes",
                        {{"tile",
                          {{"properties",
                            {{"e",
                              {{"type", "SCALAR"},
                               {"componentType", "FLOAT64"},
                               {"semantic", "TILE_GEOMETRIC_ERROR"}}}}}}}}}};
  storeText(scratch.path() / "tileset.json", tileset.dump());
  SubtreeBuilder subtree;
  subtree.json["tileAvailability"] = subtree.addBits({true, false, true, false, true});
  subtree.json["contentAvailability"] = {{{"constant", 1}}};
  subtree.json["childSubtreeAvailability"] = {{"constant", 0}};
  const std::vector<double> errors = {50, 3, 0};
  Bytes bytes(24);
  std::memcpy(bytes.data(), errors.data(), 24);
  subtree.json["propertyTables"] = {
      {{"class", "tile"},
       {"count", 3},
       {"properties", {{"e", {{"values", subtree.addView(bytes)}}}}}}};
  subtree.json["tileMetadata"] = 0;
  storeBytes(scratch.path() / "s/0-0-0.subtree", subtree.finish());
  for (const char* name : {"c/0/0-0.glb", "c/1/1-0.glb", "c/1/1-1.glb"}) {
    storeText(scratch.path() / name, "");
  }
  tiles::TilesetWalk walked;
  const std::map<std::string, double> expected = {
      {"c/0/0-0.glb", 50}, {"c/1/1-0.glb", 3}, {"c/1/1-1.glb", 32}};
  EXPECT_EQ(walk(scratch.path(), walked), expected);
  EXPECT_EQ(walked.failureCount(), 0u);
  tileset["schema"]["classes"]["tile"]["properties"]["e"]["scale"] = 2;
  storeText(scratch.path() / "tileset.json", tileset.dump());
  EXPECT_TRUE(walk(scratch.path(), walked).empty());
  EXPECT_EQ(walked.failureCount(), 1u);
}

/// Every truncation and many wrong bytes of a subtree: errors, and no crash.
TEST(ImplicitTiling, DamagedSubtrees) {
  SubtreeBuilder subtree;
  subtree.json["tileAvailability"] = subtree.addBits(std::vector<bool>(21, true));
  subtree.json["contentAvailability"] = {subtree.addBits(std::vector<bool>(21, true))};
  subtree.json["childSubtreeAvailability"] = subtree.addBits(std::vector<bool>(64, false));
  const Bytes file = subtree.finish();
  const auto read = [](const Bytes& bytes, uint32_t levels) {
    tiles::Subtree result;
    const auto no_buffer = [](const std::string&, Bytes&) { return gltf::Result{"", "none"}; };
    const bool is_read = result.read(bytes, 2, levels, {}, no_buffer).ok();
    for (uint64_t bit = 0; is_read && bit < 21; ++bit) (void)result.tiles()[bit];
    return is_read;
  };
  EXPECT_TRUE(read(file, 3));
  EXPECT_FALSE(read(file, 4)) << "there are too few bits";
  for (size_t length = 0; length < file.size(); ++length) {
    EXPECT_FALSE(read(Bytes(file.begin(), file.begin() + static_cast<ptrdiff_t>(length)), 3))
        << length;
  }
  std::mt19937 random(7);
  for (int i = 0; i < 3000; ++i) {
    Bytes damaged = file;
    damaged[random() % damaged.size()] = static_cast<uint8_t>(random());
    read(damaged, 3);
  }
}

/// A subtree that names itself again and again is not followed forever.
TEST(ImplicitTiling, WorkIsBounded) {
  ScratchFolder scratch;
  Json root = makeImplicit("OCTREE", 8, 32);
  root["implicitTiling"]["subtrees"]["uri"] = "s.json";
  storeText(scratch.path() / "tileset.json", makeTileset(root, 1).dump());
  for (const int tile : {0, 1}) {
    const Json subtree = {{"tileAvailability", {{"constant", tile}}},
                          {"contentAvailability", {{{"constant", 0}}}},
                          {"childSubtreeAvailability", {{"constant", 1}}}};
    storeText(scratch.path() / "s.json", subtree.dump());
    tiles::FileTable table;
    std::vector<std::string> notes;
    const auto never = [](std::string_view) { return false; };
    ASSERT_TRUE(table.read(scratch.path(), {}, never, notes).ok());
    tiles::TilesetWalk walked;
    const gltf::Result done = walked.run(scratch.path(), "tileset.json", table, {}, 1 << 20);
    EXPECT_NE(done.what.find("--max-tiles allows more"), std::string::npos) << done.message();
  }
}

class ImplicitTiles : public TilesTest {};

/// The whole command on a terrain: each level within its own promise, with closed borders.
TEST_F(ImplicitTiles, AreCompressed) {
  SubtreeBuilder subtree;
  subtree.json["tileAvailability"] = {{"constant", 1}};
  subtree.json["contentAvailability"] = {{{"constant", 1}}};
  subtree.json["childSubtreeAvailability"] = {{"constant", 0}};
  const fs::path in = path("implicit");
  storeBytes(in / "s/0-0-0.subtree", subtree.finish());
  for (uint32_t level = 0; level < 3; ++level) {
    for (uint32_t y = 0; y < 1u << level; ++y) {
      for (uint32_t x = 0; x < 1u << level; ++x) {
        storeBytes(in / nameOf("c/", {level, x, y}, false, "/", ".glb"), makePatchGlb(level, x, y));
      }
    }
  }
  storeText(in / "tileset.json", makeTileset(makeImplicit("QUADTREE", 3, 3), 100).dump());
  const ToolResult result = run("tiles implicit/tileset.json out --report report.json");
  ASSERT_EQ(result.status, 0) << result.err;
  expectWithin("implicit", "c/0/0-0.glb", {4});
  expectWithin("implicit", "c/1/1-0.glb", {2});
  expectWithin("implicit", "c/2/3-2.glb", {1});
  const Json report = Json::parse(contentOf(path("report.json")));
  EXPECT_EQ(report["levels"][2]["tiles"], 16);
  EXPECT_EQ(report["levels"][2]["files"], 16);
  EXPECT_EQ(contentOf(path("out/s/0-0-0.subtree")), contentOf(in / "s/0-0-0.subtree"));
  EXPECT_GT(expectClosedBorders("implicit", {"c/2/0-0.glb", "c/2/1-0.glb", "c/2/0-1.glb"}), 40u);
  // A subtree that is missing is named, and the others are made.
  fs::remove(in / "s/0-0-0.subtree");
  const ToolResult without = run("tiles implicit/tileset.json other");
  EXPECT_EQ(without.status, 1);
  EXPECT_NE(without.err.find("0-0-0.subtree"), std::string::npos) << without.err;
}

}  // namespace
}  // namespace mcc::test
