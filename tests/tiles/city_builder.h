// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A block of houses as the makers of 3D Tiles write it, and what tests compare of it: triangles as
// points of a grid with the ids of their corners.
#ifndef MCC_TESTS_TILES_CITY_BUILDER_H_
#define MCC_TESTS_TILES_CITY_BUILDER_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "foreign/decoders.h"
#include "support/plain_reader.h"
#include "support/triangles.h"
#include "tiles/convert_tile.h"
#include "tiles/tileset_builder.h"

namespace mcc::test {

inline constexpr double kPromisedError = 0.05;

/// Boxes of 24 vertices and 12 triangles on a grid. Walls of neighbours touch, so that vertices
/// with different ids have the same position.
struct City {
  uint32_t house_count = 0;
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> texcoords;
  std::vector<uint16_t> indices;
  std::vector<uint16_t> edges;   ///< pairs of vertices
  std::vector<uint32_t> houses;  ///< of each vertex
  std::vector<uint32_t> faces;   ///< of each vertex, over all houses

  /// spacing  of 20 metres: the walls of neighbours touch.
  explicit City(uint32_t side, double spacing = 20) : house_count(side * side) {
    for (uint32_t house = 0; house < house_count; ++house) {
      const double x = spacing * (house % side);
      const double z = spacing * (house / side);
      const double height = 4 + (house * 37 % 29) * 1.7;
      addHouse(house, x, z, house % 3 == 0 ? 20 : 13.37, height);
    }
  }

  uint32_t count() const { return static_cast<uint32_t>(positions.size() / 3); }

  /// Adds its accessors; returns a primitive that uses them.
  Json addTo(gltf::test::Builder& builder) const {
    return {{"attributes",
             {{"POSITION", builder.addPositions(positions)},
              {"NORMAL", builder.addFloats(normals, 3)},
              {"TEXCOORD_0", builder.addFloats(texcoords, 2)}}},
            {"indices", builder.addIndices(indices)}};
  }

 private:
  void addHouse(uint32_t house, double x, double z, double width, double height) {
    for (uint32_t face = 0; face < 6; ++face) {
      const uint32_t axis = face / 2;
      const double end = face % 2;
      const auto first = static_cast<uint16_t>(count());
      for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
        double corner[3];
        corner[axis] = end;
        corner[(axis + 1) % 3] = face % 2 == 0 ? v : u;
        corner[(axis + 2) % 3] = face % 2 == 0 ? u : v;
        positions.insert(positions.end(), {static_cast<float>(x + width * corner[0]),
                                           static_cast<float>(height * corner[1]),
                                           static_cast<float>(z + width * corner[2])});
        for (uint32_t c = 0; c < 3; ++c) {
          normals.push_back(c == axis ? static_cast<float>(2 * end - 1) : 0);
        }
        texcoords.insert(texcoords.end(), {static_cast<float>(u), static_cast<float>(v)});
        houses.push_back(house);
        faces.push_back(6 * house + face);
      }
      for (const int corner : {0, 1, 2, 0, 2, 3}) {
        indices.push_back(static_cast<uint16_t>(first + corner));
      }
      for (const int corner : {0, 1, 1, 2, 2, 3, 3, 0}) {
        edges.push_back(static_cast<uint16_t>(first + corner));
      }
    }
  }
};

/// Adds an attribute of one component, whose elements begin at multiples of 4.
inline uint32_t addIds(gltf::test::Builder& builder, const std::vector<uint32_t>& ids, int type) {
  Bytes bytes;
  for (const uint32_t id : ids) {
    const auto number = static_cast<float>(id);
    uint32_t stored = id;
    if (type == gltf::test::kFloat) std::memcpy(&stored, &number, 4);
    append(bytes, stored);
  }
  const uint32_t view = builder.addView(bytes, 4);
  return builder.addAccessor(
      {{"bufferView", view}, {"componentType", type}, {"count", ids.size()}, {"type", "SCALAR"}});
}

/// A model before and after.
struct ConvertedModel {
  Bytes source;
  Bytes converted;
  Bytes decoded;
  tiles::TileFigures figures;
};

/// Converts a GLB as a tile of a level that promises kPromisedError, and decodes it.
inline ConvertedModel convertAsTile(const Bytes& source) {
  ConvertedModel model;
  model.source = source;
  const auto choose = [](std::span<const uint8_t>, const tiles::TileModel&,
                         tiles::Accuracy& accuracy) {
    accuracy.promised_error = kPromisedError;
    accuracy.lattice.step = static_cast<float>(tiles::stepFor(kPromisedError));
    return gltf::Result();
  };
  std::vector<std::string> notes;
  gltf::ConvertOptions options;
  options.decoders = foreign::foreignDecoders();
  gltf::Result result =
      tiles::convertTile(source, choose, options, model.converted, model.figures, notes);
  EXPECT_TRUE(result.ok()) << result.message();
  EXPECT_FALSE(model.converted.empty()) << "the tile does not become smaller";
  if (model.converted.empty()) return model;
  EXPECT_LE(model.figures.measured_error, kPromisedError);
  gltf::DecodeReport report;
  result = gltf::decodeGlb(model.converted, model.decoded, report);
  EXPECT_TRUE(result.ok()) << result.message();
  return model;
}

/// A vertex as tests see it: a point of the grid, and the values of other attributes.
using Corner = std::vector<double>;

/// Reads the vertices of the first primitive, without the library. `names` are the attributes that
/// must be exact.
inline std::vector<Corner> cornersOf(const Bytes& file, const std::vector<std::string>& names) {
  gltf::test::PlainDocument document;
  EXPECT_EQ(document.load({{"file", file}}, "file"), "");
  const double step = tiles::stepFor(kPromisedError);
  std::vector<Corner> corners;
  std::vector<std::string> all = {"POSITION"};
  all.insert(all.end(), names.begin(), names.end());
  for (const std::string& name : all) {
    const gltf::test::Elements elements = document.elements(
        document.json["meshes"][0]["primitives"][0]["attributes"][name].get<uint64_t>());
    const bool is_on_grid =
        name == "POSITION" && elements.component_type == uint64_t{gltf::test::kFloat};
    corners.resize(elements.values.size());
    for (size_t i = 0; i < corners.size(); ++i) {
      for (uint32_t c = 0; c < elements.component_count; ++c) {
        const double value = component(elements, i, c);
        corners[i].push_back(is_on_grid ? std::floor(value / step + 0.5) : value);
      }
    }
  }
  return corners;
}

inline std::vector<uint32_t> indicesOf(const Bytes& file, uint32_t accessor) {
  gltf::test::PlainDocument document;
  EXPECT_EQ(document.load({{"file", file}}, "file"), "");
  const std::vector<double> numbers = document.numbers(accessor);
  return {numbers.begin(), numbers.end()};
}

/// The triangles of the first primitive, in an order that depends on their corners alone.
inline std::vector<TriangleOf<Corner>> trianglesIn(const Bytes& file,
                                                   const std::vector<std::string>& names) {
  const std::vector<Corner> corners = cornersOf(file, names);
  const Json json = gltf::test::jsonOf(file);
  const auto indices = json["meshes"][0]["primitives"][0]["indices"].get<uint32_t>();
  return sorted(trianglesOf(indicesOf(file, indices), [&](uint32_t i) { return corners.at(i); }));
}

/// Expects the same triangles, up to order, with the same points of the grid and equal `names`.
inline void expectSameTriangles(const Bytes& source, const Bytes& decoded,
                                const std::vector<std::string>& names) {
  EXPECT_EQ(cornersOf(source, names).size(), cornersOf(decoded, names).size());
  EXPECT_TRUE(trianglesIn(source, names) == trianglesIn(decoded, names));
}

inline bool isCompressed(const Bytes& file) {
  const Json primitive = gltf::test::jsonOf(file)["meshes"][0]["primitives"][0];
  return primitive.contains("extensions") && primitive["extensions"].contains(gltf::kExtensionName);
}

}  // namespace mcc::test

#endif  // MCC_TESTS_TILES_CITY_BUILDER_H_
