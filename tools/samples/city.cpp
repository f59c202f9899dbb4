// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "city.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "city_pictures.h"
#include "city_tiles.h"
#include "support/tile_builder.h"

namespace mcc::samples {
namespace {

namespace fs = std::filesystem;

constexpr double kRootError = 64;  // metres; the errors of the levels below it follow
constexpr double kTerrainError = 16;
constexpr double kTownError = 64;
constexpr double kRowError = 4;
constexpr double kLandmarkError = 1;  // they have no level below, and stand beside the districts
constexpr uint64_t kTreeSeed = 77;
constexpr const char* kPictures = "../textures/";

Json boxOf(const Bounds& bounds) {
  const Vec3 middle = (bounds.low + bounds.high) * 0.5;
  const Vec3 half = (bounds.high - bounds.low) * 0.5;
  return {{"box", {middle.x, middle.y, middle.z, half.x, 0, 0, 0, half.y, 0, 0, 0, half.z}}};
}

/// Returns whole metres around `bounds`, so that what contains them contains these too.
Bounds rounded(const Bounds& bounds) {
  constexpr double kMargin = 0.5;
  const auto down = [](double x) { return std::floor(x - kMargin); };
  const auto up = [](double x) { return std::ceil(x + kMargin); };
  return {{down(bounds.low.x), down(bounds.low.y), down(bounds.low.z)},
          {up(bounds.high.x), up(bounds.high.y), up(bounds.high.z)}};
}

Bounds moved(Bounds bounds, const Vec3& by) {
  bounds.low = bounds.low + by;
  bounds.high = bounds.high + by;
  return bounds;
}

/// Returns the matrix from east, north and up at a place on the globe to the coordinates that
/// globes use (WGS 84).
Json placeOnGlobe() {
  constexpr double kMajor = 6378137;
  constexpr double kSquaredEccentricity = 0.00669437999014;
  constexpr double kHeight = 430;
  const test::CosSin lon = test::turn(8.05 / 360);
  const test::CosSin lat = test::turn(47.4 / 360);
  const double normal = kMajor / std::sqrt(1 - kSquaredEccentricity * lat.sin * lat.sin);
  const double out = (normal + kHeight) * lat.cos;
  return {-lon.sin,
          lon.cos,
          0,
          0,  //
          -lat.sin * lon.cos,
          -lat.sin * lon.sin,
          lat.cos,
          0,  //
          lat.cos * lon.cos,
          lat.cos * lon.sin,
          lat.sin,
          0,  //
          out * lon.cos,
          out * lon.sin,
          (normal * (1 - kSquaredEccentricity) + kHeight) * lat.sin,
          1};
}

Json tilesetOf(Json root, double error) {
  return {{"asset", {{"version", "1.1"}, {"generator", "gltf-mcc generate-samples"}}},
          {"geometricError", error},
          {"root", std::move(root)}};
}

/// A tile and the whole metres around it and everything below it.
struct Tile {
  Json json;
  Bounds bounds;
};

class CityWriter {
 public:
  CityWriter(fs::path folder, const CitySize& size) : folder_(std::move(folder)), plan_(size) {}

  void run() {
    for (const Surface surface : {Surface::kWall, Surface::kRoof, Surface::kStone}) {
      storePicture(pictureOf(surface));
    }
    storePicture(pictureOfGround(plan_));
    const Tile terrain = writeTerrain();
    const Tile town = writeTown();
    Bounds bounds = terrain.bounds;
    bounds.add(town.bounds);
    Json root = {{"transform", placeOnGlobe()},
                 {"boundingVolume", boxOf(bounds)},
                 {"geometricError", kRootError},
                 {"refine", "ADD"},
                 {"children", {terrain.json, town.json}}};
    storeJson("tileset.json", tilesetOf(std::move(root), 4 * kRootError));
  }

 private:
  void store(const std::string& name, const Bytes& bytes) {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
  }
  void storeJson(const std::string& name, const Json& json) {
    const std::string text = json.dump(1) + '\n';
    store(name, Bytes(text.begin(), text.end()));
  }
  void storePicture(const Picture& picture) {
    store("textures/" + picture.name + ".png", picture.png);
  }

  // ---- Terrain ------------------------------------------------------------------------------

  static std::string nameOf(const TerrainTile& tile) {
    return std::to_string(tile.level) + "-" + std::to_string(tile.x) + "-" + std::to_string(tile.y);
  }

  /// Writes the terrain, and returns the tile that names its tileset.
  Tile writeTerrain() {
    const CitySize& size = plan_.size();
    Bounds bounds;
    for (uint32_t level = 0; level < size.terrain_levels; ++level) {
      for (uint32_t y = 0; y < 1u << level; ++y) {
        for (uint32_t x = 0; x < 1u << level; ++x) writeTerrainTile({level, x, y}, bounds);
      }
    }
    // The box is halved exactly, so only its height may be rounded.
    const double half = size.extent_m / 2;
    bounds = rounded(bounds);
    bounds.low.x = bounds.low.y = -half;
    bounds.high.x = bounds.high.y = half;
    const Json root = {{"boundingVolume", boxOf(bounds)},
                       {"geometricError", kTerrainError},
                       {"refine", "REPLACE"},
                       {"content", {{"uri", "{level}-{x}-{y}.glb"}}},
                       {"implicitTiling",
                        {{"subdivisionScheme", "QUADTREE"},
                         {"subtreeLevels", size.subtree_levels},
                         {"availableLevels", size.terrain_levels},
                         {"subtrees", {{"uri", "subtrees/{level}-{x}-{y}.subtree"}}}}}};
    storeJson("terrain/tileset.json", tilesetOf(root, kRootError));
    return {externalTile(bounds, "terrain/tileset.json"), bounds};
  }

  void writeTerrainTile(const TerrainTile& tile, Bounds& bounds) {
    if (!hasTerrain(plan_, tile)) return;
    store("terrain/" + nameOf(tile) + ".glb", makeTerrain(plan_, tile, kPictures, bounds));
    if (tile.level % plan_.size().subtree_levels == 0) {
      store("terrain/subtrees/" + nameOf(tile) + ".subtree", makeSubtree(plan_, tile));
    }
  }

  static Json externalTile(const Bounds& bounds, const char* uri) {
    return {{"boundingVolume", boxOf(bounds)},
            {"geometricError", kRootError},
            {"content", {{"uri", uri}}}};
  }

  // ---- Town ---------------------------------------------------------------------------------

  Tile writeTown() {
    Tile town;
    Json children = Json::array();
    const auto add = [&](const Tile& tile) {
      children.push_back(tile.json);
      town.bounds.add(tile.bounds);
    };
    for (const Tile& group : writeDistricts()) add(group);
    add(writeLandmark("market", addMarket, false));
    add(writeLandmark("castle", addCastle, true));
    add(writeLandmark("bridge", addBridges, false));
    add(writeTrees("avenues", addBroadleaf, avenueTrees()));
    add(writeTrees("forest", addConifer, plan_.forest()));
    const Json root = {{"boundingVolume", boxOf(town.bounds)},
                       {"geometricError", kTownError},
                       {"refine", "ADD"},
                       {"children", children}};
    storeJson("town/tileset.json", tilesetOf(root, kRootError));
    town.json = externalTile(town.bounds, "town/tileset.json");
    return town;
  }

  /// Writes the districts. A large town has tiles that hold 6 x 6 of them together.
  std::vector<Tile> writeDistricts() {
    constexpr uint32_t kGroup = 6;
    const uint32_t side = plan_.size().district_count;
    std::vector<Tile> tiles;
    if (side <= kGroup) {
      for (size_t i = 0; i < plan_.districts().size(); ++i) tiles.push_back(writeDistrict(i));
      return tiles;
    }
    const uint32_t group_count = (side + kGroup - 1) / kGroup;
    tiles.resize(size_t{group_count} * group_count);
    for (uint32_t i = 0; i < side * side; ++i) {
      const Tile district = writeDistrict(i);
      Tile& group = tiles[i / side / kGroup * group_count + i % side / kGroup];
      group.bounds.add(district.bounds);
      group.json["boundingVolume"] = boxOf(group.bounds);
      group.json["geometricError"] = kTownError / 4;
      group.json["refine"] = "ADD";
      group.json["children"].push_back(district.json);
    }
    return tiles;
  }

  static std::vector<Feature> addHouses(CityMesh& mesh, const std::vector<House>& houses) {
    std::vector<Feature> features;
    for (const House& house : houses) {
      addHouse(mesh, house, static_cast<uint32_t>(features.size()));
      features.push_back({house.name, house.height(), house.floor_count});
    }
    return features;
  }

  /// Writes the blocks of a district and the houses that replace them. A b3dm says itself where it
  /// is; other districts are moved by the transform of their tile.
  Tile writeDistrict(size_t number) {
    const District& district = plan_.districts()[number];
    const std::string stem = "district-" + std::to_string(number);
    const bool is_b3dm =
        district.kind == DistrictKind::kB3dm || district.kind == DistrictKind::kComposite;
    const Vec3 origin = is_b3dm ? Vec3{} : district.frame.origin;
    CityMesh rows(origin);
    ModelOptions options = {district.name, kPictures, Ids::kPropertyTable, {}, false, {}};
    options.features = addHouses(rows, district.rows);
    store("town/" + stem + "-blocks.glb", makeModel(rows, options));
    Bounds bounds = rows.bounds();
    const Json contents =
        is_b3dm ? writeBatches(district, stem, bounds) : writeHouses(district, stem, bounds);
    bounds = rounded(bounds);
    Json leaf = {{"boundingVolume", boxOf(moved(bounds, origin * -1))}, {"geometricError", 0}};
    if (contents.size() == 1) leaf["content"] = contents[0];
    if (contents.size() > 1) leaf["contents"] = contents;
    Json tile;
    if (!is_b3dm) {
      tile["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, origin.x, origin.y, origin.z, 1};
    }
    tile["boundingVolume"] = leaf["boundingVolume"];
    tile["geometricError"] = kRowError;
    tile["refine"] = "REPLACE";
    tile["content"] = {{"uri", stem + "-blocks.glb"}};
    tile["children"] = Json::array({leaf});
    return {tile, bounds};
  }

  /// Writes the houses as GLB, and for some districts street lamps. Returns the contents.
  Json writeHouses(const District& district, const std::string& stem, Bounds& bounds) {
    const Vec3& origin = district.frame.origin;
    CityMesh houses(origin);
    ModelOptions options = {district.name, kPictures, Ids::kPropertyTable, {}, false, {}};
    options.features = addHouses(houses, district.houses);
    bounds.add(houses.bounds());
    store("town/" + stem + ".glb", makeModel(houses, options));
    Json contents = Json::array({{{"uri", stem + ".glb"}}});
    if (district.kind != DistrictKind::kInstanced) return contents;
    CityMesh lamp;
    addLamp(lamp);
    ModelOptions lamp_options;
    lamp_options.title = "Street lamps";
    for (const Vec3& place : district.lamps) {
      lamp_options.instances.push_back(place - origin);
      bounds.add(moved(lamp.bounds(), place));
    }
    store("town/" + stem + "-lamps.glb", makeModel(lamp, lamp_options));
    contents.push_back({{"uri", stem + "-lamps.glb"}});
    return contents;
  }

  /// Writes the houses as b3dm, alone or in a cmpt with the trees of the district.
  Json writeBatches(const District& district, const std::string& stem, Bounds& bounds) {
    const Vec3& center = district.frame.origin;
    CityMesh houses(center);
    ModelOptions options = {district.name, kPictures, Ids::kBatchTable, {}, false, {}};
    options.features = addHouses(houses, district.houses);
    bounds.add(houses.bounds());
    const Bytes b3dm = makeB3dm(makeModel(houses, options), options.features, center);
    if (district.kind == DistrictKind::kB3dm) {
      store("town/" + stem + ".b3dm", b3dm);
      return Json::array({{{"uri", stem + ".b3dm"}}});
    }
    bounds.add(boundsOfTrees(district.trees));
    const Bytes trees = makeI3dm(makeTree(addBroadleaf), district.trees, kTreeSeed + 1);
    store("town/" + stem + ".cmpt", test::makeCmpt({b3dm, trees}));
    return Json::array({{{"uri", stem + ".cmpt"}}});
  }

  // ---- Landmarks and trees ------------------------------------------------------------------

  using Landmark = std::vector<Feature> (*)(CityMesh&, const CityPlan&);

  /// Writes a model that has its pictures inside of it.
  Tile writeLandmark(const std::string& name, Landmark add, bool has_outline) {
    CityMesh mesh;
    ModelOptions options = {name, "", Ids::kPropertyTable, {}, has_outline, {}};
    options.features = add(mesh, plan_);
    store("town/" + name + ".glb", makeModel(mesh, options));
    return leafOf(mesh.bounds(), name + ".glb");
  }

  static Tile leafOf(const Bounds& exact, const std::string& uri) {
    const Bounds bounds = rounded(exact);
    return {{{"boundingVolume", boxOf(bounds)},
             {"geometricError", kLandmarkError},
             {"content", {{"uri", uri}}}},
            bounds};
  }

  static Bytes makeTree(void (*add)(CityMesh&)) {
    CityMesh mesh;
    add(mesh);
    ModelOptions options;
    options.title = "tree";
    return makeModel(mesh, options);
  }

  static Bounds boundsOfTrees(const std::vector<Vec3>& places) {
    constexpr double kRadius = 4;
    constexpr double kHeight = 12;
    Bounds bounds;
    for (const Vec3& p : places) {
      bounds.add(p - Vec3{kRadius, kRadius, 2});
      bounds.add(p + Vec3{kRadius, kRadius, kHeight});
    }
    return bounds;
  }

  Tile writeTrees(const std::string& name, void (*add)(CityMesh&),
                  const std::vector<Vec3>& places) {
    store("town/" + name + ".i3dm", makeI3dm(makeTree(add), places, kTreeSeed));
    return leafOf(boundsOfTrees(places), name + ".i3dm");
  }

  /// The trees of the avenues and of all districts whose own files have none.
  std::vector<Vec3> avenueTrees() const {
    std::vector<Vec3> trees = plan_.avenueTrees();
    for (const District& district : plan_.districts()) {
      if (district.kind == DistrictKind::kComposite) continue;
      trees.insert(trees.end(), district.trees.begin(), district.trees.end());
    }
    return trees;
  }

  const fs::path folder_;
  const CityPlan plan_;
};

}  // namespace

CitySize smallCity() {
  CitySize size;
  size.chimney_share = 0.1;
  size.forest_attempts = 2000;
  return size;
}

CitySize largeCity() {
  CitySize size;
  size.extent_m = 8192;
  size.town_radius_m = 2000;
  size.terrain_levels = 5;
  size.subtree_levels = 3;
  size.terrain_cells = 64;
  size.has_ground_ids = true;
  size.district_count = 18;
  size.block_count = 3;
  size.chimney_share = 0.8;
  size.map_pixels = 1024;
  size.forest_attempts = 40000;
  return size;
}

void writeCity(const fs::path& folder, const CitySize& size) { CityWriter(folder, size).run(); }

}  // namespace mcc::samples
