// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writes small tilesets of 3D Tiles for tests.
#ifndef MCC_TESTS_TILES_TILESET_BUILDER_H_
#define MCC_TESTS_TILES_TILESET_BUILDER_H_

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/gltf_builder.h"
#include "support/tile_builder.h"

namespace mcc::test {

inline Bytes makeB3dm(const Bytes& glb, uint32_t batch_count) {
  Tables tables;
  tables.feature_json = paddedJson("{\"BATCH_LENGTH\":" + std::to_string(batch_count) + "}", 28);
  std::string names;
  for (uint32_t i = 0; i < batch_count; ++i) {
    names += (i == 0 ? "\"" : ",\"") + ("patch " + std::to_string(i)) + "\"";
  }
  tables.batch_json = paddedJson("{\"name\":[" + names +
                                     "],\"height\":{\"byteOffset\":0,"
                                     "\"componentType\":\"DOUBLE\",\"type\":\"SCALAR\"}}",
                                 0);
  for (uint32_t i = 0; i < 8 * batch_count; ++i) {
    tables.batch_binary.push_back(static_cast<uint8_t>(i * 37));
  }
  return makeModelTile("b3dm", tables, glb);
}

/// An i3dm with two instances, of which the larger is `scale` times the model.
inline Bytes makeI3dm(const Bytes& glb, float scale) {
  Tables tables;
  tables.feature_json = paddedJson(
      "{\"INSTANCES_LENGTH\":2,\"POSITION\":{\"byteOffset\":0},\"SCALE\":{\"byteOffset\":24}}", 32);
  tables.feature_binary =
      gltf::test::bytesOf(std::vector<float>{0, 0, 0, 100, 0, 0, scale / 2, scale});
  return makeModelTile("i3dm", tables, glb);
}

inline Bytes makePnts() {
  Tables tables;
  tables.feature_json = paddedJson("{\"POINTS_LENGTH\":1,\"POSITION\":{\"byteOffset\":0}}", 28);
  tables.feature_binary = Bytes(16, 7);
  return makeModelTile("pnts", tables, {});
}

/// A patch of terrain: the square (x, y) of 2^level on each side of a world of 1000 m. Neighbours
/// of one level have equal positions on their borders.
inline gltf::test::Builder makePatch(uint32_t level, uint32_t x, uint32_t y, bool has_batches) {
  constexpr uint32_t kSize = 24;
  const double steps = static_cast<double>(kSize) * (1u << level);
  gltf::test::Sheet sheet(kSize);
  std::vector<float> batches;
  for (uint32_t j = 0; j <= kSize; ++j) {
    for (uint32_t i = 0; i <= kSize; ++i) {
      const double u = (x * kSize + i) / steps;
      const double v = (y * kSize + j) / steps;
      const double height = 40 * std::sin(9 * u) * std::cos(7 * v) + 3 * std::sin(90 * u + 60 * v);
      float* position = &sheet.positions[3 * (j * (kSize + 1) + i)];
      position[0] = static_cast<float>(1000 * u - 500);
      position[1] = static_cast<float>(height);
      position[2] = static_cast<float>(500 - 1000 * v);
      batches.push_back(static_cast<float>(i < kSize / 2 ? 0 : 1));
    }
  }
  gltf::test::Builder builder;
  Json primitive = sheet.addTo(builder);
  if (has_batches) primitive["attributes"]["_BATCHID"] = builder.addFloats(batches, 1);
  builder.addMesh({primitive});
  return builder;
}

inline Bytes makePatchGlb(uint32_t level, uint32_t x, uint32_t y, bool has_batches = false) {
  return makePatch(level, x, y, has_batches).toGlb();
}

inline void storeBytes(const std::filesystem::path& path, const Bytes& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

inline void storeText(const std::filesystem::path& path, const std::string& text) {
  storeBytes(path, Bytes(text.begin(), text.end()));
}

inline Json makeTile(double geometric_error, const std::string& uri) {
  Json tile = {{"boundingVolume", {{"sphere", {0, 0, 0, 900}}}},
               {"geometricError", geometric_error},
               {"refine", "REPLACE"}};
  if (!uri.empty()) tile["content"] = {{"uri", uri}};
  return tile;
}

inline Json makeTileset(const Json& root, double geometric_error) {
  return {{"asset", {{"version", "1.1"}, {"extras", {{"z", 1}, {"a", 2.50}}}}},
          {"geometricError", geometric_error},
          {"root", root},
          {"extras", {{"unknown member", true}}}};
}

/// The tile of a quadtree's leaf, with a content of a kind that depends on its place.
inline Json storeLeaf(const std::filesystem::path& folder, uint32_t x, uint32_t y) {
  const std::string name = "leaf " + std::to_string(x) + "-" + std::to_string(y);
  const std::string uri = "2/leaf%20" + std::to_string(x) + "-" + std::to_string(y);
  const std::filesystem::path file = folder / "2" / name;
  const Bytes glb = makePatchGlb(2, x, y);
  if (x == 0 && y == 0) {
    const Bytes b3dm = makeB3dm(makePatchGlb(2, x, y, true), 2);
    const Bytes i3dm = makeI3dm(makePatchGlb(0, 0, 0), 0.01f);
    storeBytes(file.string() + ".cmpt", makeCmpt({b3dm, makeCmpt({i3dm, makePnts()})}));
    return makeTile(0, uri + ".cmpt");
  }
  if (x == 1 && y == 0) {
    storeBytes(file.string() + ".glb", glb);
    storeBytes(file.string() + ".i3dm", makeI3dm(makePatchGlb(0, 0, 0), 4));
    Json tile = makeTile(0, "");
    tile["contents"] = {{{"uri", uri + ".glb"}}, {{"uri", uri + ".i3dm?v=1"}}};
    return tile;
  }
  if (x == 2 && y == 0) {
    gltf::test::Builder builder = makePatch(2, x, y, false);
    builder.json["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", "patch.bin"}}};
    storeText(file.string() + ".gltf", gltf::printJson(builder.json));
    storeBytes(folder / "2" / "patch.bin", builder.bin);
    return makeTile(0, uri + ".gltf");
  }
  storeBytes(file.string() + ".glb", glb);
  return makeTile(0, uri + ".glb");
}

/// Stores a quadtree of terrain with three levels: a GLB, four b3dm of which one is the root of an
/// external tileset, and sixteen leaves of all kinds. Also files that no tile shows.
inline void storeTerrain(const std::filesystem::path& folder) {
  storeBytes(folder / "0" / "root.glb", makePatchGlb(0, 0, 0));
  Json root = makeTile(64, "0/root.glb");
  for (uint32_t y = 0; y < 2; ++y) {
    for (uint32_t x = 0; x < 2; ++x) {
      const std::string name = std::to_string(x) + "-" + std::to_string(y) + ".b3dm";
      storeBytes(folder / "1" / name, makeB3dm(makePatchGlb(1, x, y, true), 2));
      Json tile = makeTile(16, "1/" + name);
      for (uint32_t child = 0; child < 4; ++child) {
        tile["children"].push_back(storeLeaf(folder, 2 * x + child % 2, 2 * y + child / 2));
      }
      if (x == 1 && y == 1) {
        for (Json& leaf : tile["children"]) {
          leaf["content"]["uri"] = "../" + leaf["content"]["uri"].get<std::string>();
        }
        tile["content"]["uri"] = "../1/" + name;
        storeText(folder / "east side" / "part.json", makeTileset(tile, 16).dump(1));
        // The root of the external tileset is one level below the tile that names it.
        tile = makeTile(16, "east%20side/part.json");
      }
      root["children"].push_back(tile);
    }
  }
  storeBytes(folder / "points.pnts", makePnts());
  root["children"].push_back(makeTile(0, "points.pnts"));
  storeText(folder / "tileset.json", makeTileset(root, 100).dump(3) + "\n");
  storeText(folder / "style.json", "{\"color\": \"red\"}");
  storeText(folder / "notes" / "read me.txt", "not part of any tile");
}

}  // namespace mcc::test

#endif  // MCC_TESTS_TILES_TILESET_BUILDER_H_
