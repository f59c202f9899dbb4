// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "city_tiles.h"

#include <algorithm>
#include <bit>

#include "city_pictures.h"
#include "support/tile_builder.h"

namespace mcc::samples {
namespace {

using test::append;
using test::appendText;
using test::makeModelTile;
using test::paddedJson;
using test::padTo8;
using test::Tables;

void putFloat(Bytes& to, double value) {
  append(to, std::bit_cast<uint32_t>(static_cast<float>(value)));
}

Json numbersOf(const Vec3& v) { return {v.x, v.y, v.z}; }

// ---- Models -------------------------------------------------------------------------------------

uint32_t addSurfaceMaterial(GlbBuilder& glb, Surface surface, const std::string& picture_folder) {
  constexpr float kRough = 0.9f;
  const Picture picture = pictureOf(surface);
  const uint32_t material =
      glb.addMaterial(picture.name, 1, 1, 1, 0, kRough, surface == Surface::kRoof);
  if (picture.png.empty()) return material;
  constexpr uint32_t kRepeat = 10497;
  uint32_t texture = 0;
  if (picture_folder.empty()) {
    texture = glb.addTexture(picture.name, picture.png);
    glb.json["samplers"][0]["wrapS"] = kRepeat;
    glb.json["samplers"][0]["wrapT"] = kRepeat;
  } else {
    texture = glb.addExternalTexture(picture.name, picture_folder + picture.name + ".png");
  }
  glb.json["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = {
      {"index", texture}};
  return material;
}

Json addPart(GlbBuilder& glb, const SurfacePart& part, uint32_t material,
             const ModelOptions& options) {
  Json attributes;
  attributes["POSITION"] = glb.addFloats(part.positions, 3);
  attributes["NORMAL"] = glb.addFloats(part.normals, 3);
  if (glb.json["materials"][material]["pbrMetallicRoughness"].contains("baseColorTexture")) {
    attributes["TEXCOORD_0"] = glb.addFloats(part.texcoords, 2);
  }
  attributes["COLOR_0"] = glb.addIntegers(part.colors, 4, ComponentType::kUint8, true);
  if (options.ids != Ids::kNone) {
    const bool is_batch = options.ids == Ids::kBatchTable;
    attributes[is_batch ? "_BATCHID" : "_FEATURE_ID_0"] =
        glb.addIntegers(part.ids, 1, ComponentType::kUint16, false);
  }
  Json result = primitive(attributes, glb.addIndices(part.indices), material);
  if (options.ids == Ids::kPropertyTable) {
    result["extensions"]["EXT_mesh_features"]["featureIds"] = Json::array(
        {{{"featureCount", options.features.size()}, {"attribute", 0}, {"propertyTable", 0}}});
  }
  return result;
}

Json schemaOfHouses() {
  return {
      {"id", "city"},
      {"classes",
       {{"building",
         {{"properties",
           {{"name", {{"type", "STRING"}, {"required", true}}},
            {"height", {{"type", "SCALAR"}, {"componentType", "FLOAT32"}, {"required", true}}},
            {"floors", {{"type", "SCALAR"}, {"componentType", "UINT8"}, {"required", true}}}}}}}}}};
}

void useExtension(GlbBuilder& glb, const char* name) { glb.json["extensionsUsed"].push_back(name); }

void addPropertyTable(GlbBuilder& glb, std::span<const Feature> features) {
  Bytes names;
  Bytes offsets;
  Bytes heights;
  Bytes floors;
  append(offsets, 0);
  for (const Feature& feature : features) {
    appendText(names, feature.name);
    append(offsets, names.size());
    putFloat(heights, feature.height_m);
    floors.push_back(static_cast<uint8_t>(feature.floor_count));
  }
  useExtension(glb, "EXT_mesh_features");
  useExtension(glb, "EXT_structural_metadata");
  Json properties;
  properties["name"]["values"] = glb.addBytes(names);
  properties["name"]["stringOffsets"] = glb.addBytes(offsets);
  properties["height"]["values"] = glb.addBytes(heights);
  properties["floors"]["values"] = glb.addBytes(floors);
  const Json table = {{"name", "buildings"},
                      {"class", "building"},
                      {"count", features.size()},
                      {"properties", properties}};
  glb.json["extensions"]["EXT_structural_metadata"] = {{"schema", schemaOfHouses()},
                                                       {"propertyTables", Json::array({table})}};
}

/// Adds the edges of the faces, as CESIUM_primitive_outline wants them: pairs of vertices.
void addOutline(GlbBuilder& glb, const SurfacePart& part, Json& result) {
  result["extensions"]["CESIUM_primitive_outline"]["indices"] = glb.addPlainIndices(part.outline);
}

// ---- Terrain ------------------------------------------------------------------------------------

uint32_t cellsOf(const CityPlan& plan, uint32_t level) {
  return plan.size().terrain_cells << level;
}

/// Whether a place is in the corner of the land that no tile shows: the last leaf in the
/// south-east.
bool isOutsideOfLand(const CityPlan& plan, double x, double y) {
  const double extent = plan.size().extent_m;
  const double leaf = extent / (1u << (plan.size().terrain_levels - 1));
  return x > extent / 2 - leaf && y < leaf - extent / 2;
}

/// Collects the vertices of a tile that its triangles use.
class TerrainMesh {
 public:
  TerrainMesh(const CityPlan& plan, const TerrainTile& tile) : plan_(plan), tile_(tile) {
    const uint32_t cells = plan.size().terrain_cells;
    known_.assign(size_t{cells + 1} * (cells + 1), kNone);
    for (uint32_t j = 0; j < cells; ++j) {
      for (uint32_t i = 0; i < cells; ++i) addCell(i, j);
    }
  }

  TestMesh mesh;
  std::vector<int32_t> ids;
  Bounds bounds;

 private:
  /// Returns a coordinate of a point of the lattice of the whole level, so that neighbours have
  /// the same bits on their border.
  double coordinateOf(uint32_t tile, uint32_t point) const {
    const uint32_t number = tile * plan_.size().terrain_cells + point;
    const double extent = plan_.size().extent_m;
    return number * (extent / cellsOf(plan_, tile_.level)) - extent / 2;
  }

  void addCell(uint32_t i, uint32_t j) {
    const double x = (coordinateOf(tile_.x, i) + coordinateOf(tile_.x, i + 1)) / 2;
    const double y = (coordinateOf(tile_.y, j) + coordinateOf(tile_.y, j + 1)) / 2;
    if (isOutsideOfLand(plan_, x, y)) return;
    const uint32_t a = vertexAt(i, j);
    const uint32_t b = vertexAt(i + 1, j);
    const uint32_t c = vertexAt(i + 1, j + 1);
    const uint32_t d = vertexAt(i, j + 1);
    pushQuad(mesh.indices, a, b, c, d);
  }

  uint32_t vertexAt(uint32_t i, uint32_t j) {
    uint32_t& known = known_[size_t{j} * (plan_.size().terrain_cells + 1) + i];
    if (known != kNone) return known;
    known = mesh.vertexCount();
    const double extent = plan_.size().extent_m;
    const Vec3 p = plan_.onGround(coordinateOf(tile_.x, i), coordinateOf(tile_.y, j));
    const Vec3 normal = plan_.normalAt(p.x, p.y);
    push(mesh.positions, {p.x, p.z, -p.y});
    push(mesh.normals, {normal.x, normal.z, -normal.y});
    mesh.texcoords.push_back(static_cast<float>(p.x / extent + 0.5));
    mesh.texcoords.push_back(static_cast<float>(0.5 - p.y / extent));
    ids.push_back(static_cast<int32_t>(plan_.groundAt(p.x, p.y)));
    bounds.add(p);
    return known;
  }

  const CityPlan& plan_;
  const TerrainTile tile_;
  std::vector<uint32_t> known_;
};

// ---- Containers ---------------------------------------------------------------------------------

/// Appends a bitstream to the binary part of a subtree, or says that all its bits are equal.
Json addAvailability(const std::vector<bool>& bits, Json& views, Bytes& binary) {
  const auto count = static_cast<size_t>(std::count(bits.begin(), bits.end(), true));
  if (count == 0 || count == bits.size()) return {{"constant", count == 0 ? 0 : 1}};
  Bytes bytes((bits.size() + 7) / 8, 0);
  for (size_t i = 0; i < bits.size(); ++i) {
    if (bits[i]) bytes[i / 8] = static_cast<uint8_t>(bytes[i / 8] | 1u << (i % 8));
  }
  views.push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
  append(binary, bytes);
  padTo8(binary);
  return {{"bitstream", views.size() - 1}, {"availableCount", count}};
}

/// Returns the tile at a number in Morton's order, `levels` below `root`.
TerrainTile tileBelow(const TerrainTile& root, uint32_t levels, uint32_t number) {
  TerrainTile tile = {root.level + levels, root.x << levels, root.y << levels};
  for (uint32_t bit = 0; bit < levels; ++bit) {
    tile.x += (number >> (2 * bit) & 1) << bit;
    tile.y += (number >> (2 * bit + 1) & 1) << bit;
  }
  return tile;
}

}  // namespace

Bytes makeModel(const CityMesh& mesh, const ModelOptions& options) {
  GlbBuilder glb(options.title);
  Json primitives = Json::array();
  bool has_outline = false;
  for (size_t s = 0; s < kSurfaceCount; ++s) {
    const SurfacePart& part = mesh.parts()[s];
    if (part.indices.empty()) continue;
    const auto surface = static_cast<Surface>(s);
    const uint32_t material = addSurfaceMaterial(glb, surface, options.picture_folder);
    Json result = addPart(glb, part, material, options);
    if (options.has_outline && surface == Surface::kStone) {
      addOutline(glb, part, result);
      has_outline = true;
    }
    primitives.push_back(std::move(result));
  }
  if (has_outline) useExtension(glb, "CESIUM_primitive_outline");
  if (options.ids == Ids::kPropertyTable) addPropertyTable(glb, options.features);
  Json node = {{"name", options.title}, {"mesh", glb.addMesh(options.title, primitives)}};
  if (!options.instances.empty()) {
    std::vector<float> places;
    for (const Vec3& p : options.instances) push(places, {p.x, p.z, -p.y});
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        glb.addPlainFloats(places, 3);
    useExtension(glb, "EXT_mesh_gpu_instancing");
    glb.json["extensionsRequired"].push_back("EXT_mesh_gpu_instancing");
  }
  glb.addNode(node);
  return glb.finish();
}

bool hasTerrain(const CityPlan& plan, const TerrainTile& tile) {
  const uint32_t last = plan.size().terrain_levels - 1;
  if (tile.level > last) return false;
  if (tile.level == last && tile.x == (1u << last) - 1 && tile.y == 0) return false;
  // Some tiles are leaves already: a quarter in the north-west, and on large land others too.
  for (uint32_t level = 1; level < tile.level; ++level) {
    const uint32_t up = tile.level - level;
    const uint32_t x = tile.x >> up;
    const uint32_t y = tile.y >> up;
    if (level + 1 == last && x == 0 && y == (1u << level) - 1) return false;
    if (level > 1 && test::Random(uint64_t{level} << 32 | y << 16 | x).below(16) == 0) return false;
  }
  return true;
}

Bytes makeTerrain(const CityPlan& plan, const TerrainTile& tile, const std::string& picture_folder,
                  Bounds& bounds) {
  const TerrainMesh terrain(plan, tile);
  bounds.add(terrain.bounds);
  GlbBuilder glb("terrain");
  const uint32_t material = glb.addMaterial("ground", 1, 1, 1, 0, 1);
  const uint32_t texture = glb.addExternalTexture("ground", picture_folder + "ground.png");
  constexpr uint32_t kClampToEdge = 33071;
  glb.json["samplers"][0]["wrapS"] = kClampToEdge;
  glb.json["samplers"][0]["wrapT"] = kClampToEdge;
  glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
  Json attributes = addAttributes(glb, terrain.mesh);
  if (plan.size().has_ground_ids) {
    attributes["_FEATURE_ID_0"] = glb.addIntegers(terrain.ids, 1, ComponentType::kUint16, false);
    useExtension(glb, "EXT_mesh_features");
  }
  Json result = primitive(attributes, glb.addIndices(terrain.mesh.indices), material);
  if (plan.size().has_ground_ids) {
    constexpr uint32_t kKindCount = static_cast<uint32_t>(Ground::kGarden) + 1;
    result["extensions"]["EXT_mesh_features"]["featureIds"] =
        Json::array({{{"featureCount", kKindCount}, {"attribute", 0}}});
  }
  glb.addNode({{"name", "terrain"}, {"mesh", glb.addMesh("terrain", Json::array({result}))}});
  return glb.finish();
}

Bytes makeB3dm(const Bytes& glb, std::span<const Feature> features, const Vec3& center) {
  Tables tables;
  const Json table = {{"BATCH_LENGTH", features.size()}, {"RTC_CENTER", numbersOf(center)}};
  tables.feature_json = paddedJson(table.dump(), 28);
  Json names = Json::array();
  Bytes floors;
  for (const Feature& feature : features) {
    names.push_back(feature.name);
    putFloat(tables.batch_binary, feature.height_m);
    floors.push_back(static_cast<uint8_t>(feature.floor_count));
  }
  const Json batches = {
      {"name", names},
      {"height", {{"byteOffset", 0}, {"componentType", "FLOAT"}, {"type", "SCALAR"}}},
      {"floors",
       {{"byteOffset", 4 * features.size()},
        {"componentType", "UNSIGNED_BYTE"},
        {"type", "SCALAR"}}}};
  tables.batch_json = paddedJson(batches.dump(), 0);
  append(tables.batch_binary, floors);
  padTo8(tables.batch_binary);
  return makeModelTile("b3dm", tables, glb);
}

Bytes makeI3dm(const Bytes& glb, std::span<const Vec3> places, uint64_t seed) {
  constexpr double kModelHeight = 8;
  test::Random random(seed);
  Tables tables;
  Bytes scales;
  for (const Vec3& p : places) {
    for (const double c : {p.x, p.y, p.z}) putFloat(tables.feature_binary, c);
    const double scale = random.between(70, 130) / 100.0;
    putFloat(scales, scale);
    putFloat(tables.batch_binary, scale * kModelHeight);
  }
  const Json table = {{"INSTANCES_LENGTH", places.size()},
                      {"POSITION", {{"byteOffset", 0}}},
                      {"SCALE", {{"byteOffset", tables.feature_binary.size()}}}};
  tables.feature_json = paddedJson(table.dump(), 32);
  append(tables.feature_binary, scales);
  padTo8(tables.feature_binary);
  const Json batches = {
      {"height", {{"byteOffset", 0}, {"componentType", "FLOAT"}, {"type", "SCALAR"}}}};
  tables.batch_json = paddedJson(batches.dump(), 0);
  padTo8(tables.batch_binary);
  return makeModelTile("i3dm", tables, glb);
}

Bytes makeSubtree(const CityPlan& plan, const TerrainTile& root) {
  const uint32_t levels = plan.size().subtree_levels;
  std::vector<bool> tiles;
  std::vector<bool> children;
  for (uint32_t level = 0; level <= levels; ++level) {
    for (uint32_t i = 0; i < 1u << (2 * level); ++i) {
      (level < levels ? tiles : children).push_back(hasTerrain(plan, tileBelow(root, level, i)));
    }
  }
  Json views = Json::array();
  Bytes binary;
  Json json;
  json["tileAvailability"] = addAvailability(tiles, views, binary);
  json["contentAvailability"] = Json::array({json["tileAvailability"]});  // each has its content
  json["childSubtreeAvailability"] = addAvailability(children, views, binary);
  if (!binary.empty()) {
    json["buffers"] = Json::array({{{"byteLength", binary.size()}}});
    json["bufferViews"] = views;
  }
  return test::makeSubtree(paddedJson(json.dump(), 0), binary);
}

}  // namespace mcc::samples
