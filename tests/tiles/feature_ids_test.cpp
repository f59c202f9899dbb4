// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Feature ids and what they lead to, in models that are compressed as tiles: each vertex keeps its
// ids, and each triangle its vertices.
#include "cli/run_tool.h"
#include "tiles/city_builder.h"

namespace mcc::test {
namespace {

using gltf::test::Builder;
using gltf::test::kFloat;
using gltf::test::kUnsignedByte;
using gltf::test::kUnsignedShort;

/// Ids of houses in an order without a pattern, as databases give them.
std::vector<uint32_t> scattered(const std::vector<uint32_t>& ids, uint32_t count) {
  std::vector<uint32_t> result;
  for (const uint32_t id : ids) result.push_back((id * 7919 + 13) % count);
  return result;
}

/// Adds the extension object for `_FEATURE_ID_0` to `_FEATURE_ID_(count - 1)`.
void describeIds(uint32_t set_count, uint32_t feature_count, Json& primitive) {
  for (uint32_t set = 0; set < set_count; ++set) {
    primitive["extensions"]["EXT_mesh_features"]["featureIds"].push_back(
        {{"featureCount", feature_count}, {"attribute", set}});
  }
}

TEST(FeatureIds, EveryVertexKeepsItsIds) {
  const City city(7);
  for (const int type : {kUnsignedByte, kUnsignedShort, kFloat}) {
    for (const std::string& name : {std::string("_FEATURE_ID_0"), std::string("_BATCHID")}) {
      SCOPED_TRACE(name + " " + std::to_string(type));
      Builder builder;
      Json primitive = city.addTo(builder);
      primitive["attributes"][name] =
          addIds(builder, scattered(city.houses, city.house_count), type);
      if (name != "_BATCHID") {
        describeIds(1, city.house_count, primitive);
        builder.json["extensionsUsed"] = {"EXT_mesh_features"};
      }
      builder.addMesh({primitive});
      const ConvertedModel model = convertAsTile(builder.toGlb());
      ASSERT_TRUE(isCompressed(model.converted));
      expectSameTriangles(model.source, model.decoded, {name});
    }
  }
}

/// One id for each house, one for each face, one for each vertex, and the largest of its type.
TEST(FeatureIds, SeveralSetsStayTogether) {
  const City city(7);
  for (const int type : {kUnsignedShort, kFloat}) {
    Builder builder;
    Json primitive = city.addTo(builder);
    std::vector<uint32_t> own(city.count());
    for (uint32_t i = 0; i < city.count(); ++i) own[i] = i * 31 % city.count();
    std::vector<uint32_t> largest = city.houses;
    for (uint32_t& id : largest) id = (type == kFloat ? 16777216u : 65535u) - id;
    Json& attributes = primitive["attributes"];
    attributes["_FEATURE_ID_0"] = addIds(builder, city.houses, type);
    attributes["_FEATURE_ID_1"] = addIds(builder, city.faces, type);
    attributes["_FEATURE_ID_2"] = addIds(builder, own, type);
    attributes["_FEATURE_ID_3"] = addIds(builder, largest, type);
    describeIds(4, city.count(), primitive);
    builder.json["extensionsUsed"] = {"EXT_mesh_features"};
    builder.addMesh({primitive});
    const ConvertedModel model = convertAsTile(builder.toGlb());
    const std::vector<std::string> names = {"_FEATURE_ID_0", "_FEATURE_ID_1", "_FEATURE_ID_2",
                                            "_FEATURE_ID_3"};
    expectSameTriangles(model.source, model.decoded, names);
  }
}

/// Without an attribute or a texture, the id of a vertex is its number.
TEST(FeatureIds, ImplicitIdsKeepTheOrder) {
  const City city(7);
  Builder builder;
  Json primitive = city.addTo(builder);
  primitive["extensions"]["EXT_mesh_features"]["featureIds"] = {{{"featureCount", city.count()}}};
  builder.json["extensionsUsed"] = {"EXT_mesh_features"};
  builder.addMesh({primitive});
  const ConvertedModel model = convertAsTile(builder.toGlb());
  ASSERT_TRUE(isCompressed(model.converted));
  EXPECT_TRUE(cornersOf(model.source, {}) == cornersOf(model.decoded, {}));
}

/// Values of a property attribute are found by its name, and are exact.
TEST(FeatureIds, PropertyAttributesAreExact) {
  const City city(7);
  Builder builder;
  Json primitive = city.addTo(builder);
  std::vector<float> heat;
  std::vector<float> wind;
  for (uint32_t i = 0; i < city.count(); ++i) {
    heat.push_back(std::sin(static_cast<float>(i)) * 1e-3f);
    wind.insert(wind.end(), {std::cos(static_cast<float>(i)), 0.1f, static_cast<float>(i) / 3});
  }
  primitive["attributes"]["_HEAT"] = builder.addFloats(heat, 1);
  primitive["attributes"]["_WIND"] = builder.addFloats(wind, 3);
  primitive["extensions"]["EXT_structural_metadata"] = {{"propertyAttributes", {0}}};
  builder.json["extensions"]["EXT_structural_metadata"] = {
      {"schema", {{"id", "s"}, {"classes", {{"air", {{"properties", Json::object()}}}}}}},
      {"propertyAttributes",
       {{{"class", "air"},
         {"properties",
          {{"heat", {{"attribute", "_HEAT"}}}, {"wind", {{"attribute", "_WIND"}}}}}}}}};
  builder.json["extensionsUsed"] = {"EXT_structural_metadata"};
  builder.addMesh({primitive});
  const ConvertedModel model = convertAsTile(builder.toGlb());
  expectSameTriangles(model.source, model.decoded, {"_HEAT", "_WIND"});
  EXPECT_EQ(gltf::test::jsonOf(model.decoded)["extensions"], builder.json["extensions"]);
}

/// Returns the bytes of the first image.
Bytes imageOf(const Bytes& file) {
  gltf::test::PlainDocument document;
  EXPECT_EQ(document.load({{"file", file}}, "file"), "");
  return document.imageBytes(0);
}

/// Textures keep their bytes, and texture coordinates are as accurate as --texcoord-bits says:
/// corners of texels of a texture of 2^k texels stay where they are to within half a step.
TEST(FeatureIds, TexturesOfIdsAndProperties) {
  const City city(7);
  Builder builder;
  Json primitive = city.addTo(builder);
  primitive["extensions"]["EXT_mesh_features"]["featureIds"] = {
      {{"featureCount", 4}, {"texture", {{"index", 0}, {"texCoord", 0}, {"channels", {0}}}}}};
  primitive["extensions"]["EXT_structural_metadata"] = {{"propertyTextures", {0}}};
  builder.json["extensions"]["EXT_structural_metadata"] = {
      {"schema", {{"id", "s"}, {"classes", {{"wall", {{"properties", Json::object()}}}}}}},
      {"propertyTextures",
       {{{"class", "wall"},
         {"properties", {{"heat", {{"index", 0}, {"texCoord", 0}, {"channels", {1}}}}}}}}}};
  builder.json["extensionsUsed"] = {"EXT_mesh_features", "EXT_structural_metadata"};
  builder.addMesh({primitive});
  const Bytes png = {0x89, 'P', 'N', 'G', 1, 2, 3, 4, 5};
  builder.json["images"] = {{{"bufferView", builder.addView(png)}, {"mimeType", "image/png"}}};
  builder.json["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9728}}};
  builder.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  const ConvertedModel model = convertAsTile(builder.toGlb());
  ASSERT_TRUE(isCompressed(model.converted));
  for (const Bytes* file : {&model.converted, &model.decoded}) {
    const Json json = gltf::test::jsonOf(*file);
    for (const char* member : {"extensions", "textures", "samplers"}) {
      EXPECT_EQ(json[member], builder.json[member]);
    }
    EXPECT_EQ(imageOf(*file), png);
  }
  // These coordinates are 0 and 1, which are points of the grid.
  expectSameTriangles(model.source, model.decoded, {"TEXCOORD_0"});
}

/// The lines of an outline connect the same corners of the same houses, in the same order.
TEST(FeatureIds, OutlinesConnectTheSameCorners) {
  const City city(7);
  for (const bool is_in_view_of_indices : {false, true}) {
    Builder builder;
    Json primitive = city.addTo(builder);
    primitive["attributes"]["_FEATURE_ID_0"] = addIds(builder, city.faces, kUnsignedShort);
    describeIds(1, 6 * city.house_count, primitive);
    uint32_t outline = 0;
    if (is_in_view_of_indices) {
      std::vector<uint16_t> both = city.indices;
      both.insert(both.end(), city.edges.begin(), city.edges.end());
      const uint32_t all = builder.addIndices(both);
      Json edges = builder.json["accessors"][all];
      builder.json["accessors"][all]["count"] = city.indices.size();
      edges["count"] = city.edges.size();
      edges["byteOffset"] = 2 * city.indices.size();
      outline = builder.addAccessor(edges);
      primitive["indices"] = all;
    } else {
      outline = builder.addIndices(city.edges);
    }
    primitive["extensions"]["CESIUM_primitive_outline"]["indices"] = outline;
    builder.json["extensionsUsed"] = {"EXT_mesh_features", "CESIUM_primitive_outline"};
    builder.addMesh({primitive});
    const ConvertedModel model = convertAsTile(builder.toGlb());
    ASSERT_TRUE(isCompressed(model.converted));
    const std::vector<Corner> source = cornersOf(model.source, {"_FEATURE_ID_0"});
    const std::vector<Corner> decoded = cornersOf(model.decoded, {"_FEATURE_ID_0"});
    EXPECT_FALSE(source == decoded) << "the order is kept, which is not needed";
    const std::vector<uint32_t> edges = indicesOf(model.decoded, outline);
    ASSERT_EQ(edges.size(), city.edges.size());
    for (size_t i = 0; i < edges.size(); ++i) {
      EXPECT_EQ(source[city.edges[i]], decoded.at(edges[i])) << i;
    }
    // The numbers are all that is not compressed.
    EXPECT_LT(model.converted.size(), 2 * city.edges.size() + 6 * city.count());
  }
}

double idBits(const City& city, const std::vector<uint32_t>& ids, int type) {
  Builder builder;
  Json primitive = city.addTo(builder);
  primitive["attributes"]["_FEATURE_ID_0"] = addIds(builder, ids, type);
  builder.addMesh({primitive});
  std::vector<uint8_t> converted;
  gltf::ConvertReport report;
  EXPECT_TRUE(gltf::convertGlb(builder.toGlb(), {}, converted, report).ok());
  for (const gltf::AttributeReport& attribute : report.payloads.at(0).attributes) {
    if (attribute.name == "_FEATURE_ID_0") return attribute.coded_bits;
  }
  return 1e9;
}

/// Ids that are constant over a house cost little more than their information: eight bits for each
/// of 256 houses in random order, next to nothing in the order of the file.
TEST(FeatureIds, ConstantIdsAreNearlyFree) {
  const City apart(16, 40);
  const City touching(16);
  for (const int type : {kUnsignedShort, kFloat}) {
    EXPECT_LT(idBits(apart, apart.houses, type), 2 * apart.house_count);
    EXPECT_LT(idBits(apart, scattered(apart.houses, 256), type), 10 * apart.house_count);
    // The corners that houses share belong to several features.
    EXPECT_LT(idBits(touching, touching.houses, type), 13 * touching.house_count);
    EXPECT_LT(idBits(touching, scattered(touching.houses, 256), type), 18 * touching.house_count);
  }
}

/// The program does the same to a tile of a tileset, with its property table.
TEST(FeatureIds, InATileset) {
#ifndef MCC_TOOL_GLTF_MCC
  GTEST_SKIP() << "the tool is not part of this build";
#endif
  const ScratchFolder folder;
  const City city(7);
  Builder builder;
  Json primitive = city.addTo(builder);
  primitive["attributes"]["_FEATURE_ID_0"] = addIds(builder, city.houses, kUnsignedShort);
  describeIds(1, city.house_count, primitive);
  primitive["extensions"]["CESIUM_primitive_outline"]["indices"] = builder.addIndices(city.edges);
  builder.addMesh({primitive});
  const Bytes values(city.house_count, 'h');
  const uint32_t view = builder.addView(values);
  builder.json["extensions"]["EXT_structural_metadata"] = {
      {"schema", {{"id", "s"}, {"classes", {{"house", {{"properties", Json::object()}}}}}}},
      {"propertyTables",
       {{{"class", "house"},
         {"count", city.house_count},
         {"properties", {{"kind", {{"values", view}}}}}}}}};
  builder.json["extensionsUsed"] = {"EXT_mesh_features", "EXT_structural_metadata",
                                    "CESIUM_primitive_outline"};
  const Bytes source = builder.toGlb();
  storeBytes(folder.path() / "in" / "city.glb", source);
  storeText(folder.path() / "in" / "tileset.json",
            makeTileset(makeTile(0, "city.glb"), 16 * kPromisedError * 2).dump());
  const ToolResult result = runTool(folder, "tiles in/tileset.json out");
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string content = contentOf(folder.path() / "out" / "city.glb");
  const Bytes converted(content.begin(), content.end());
  ASSERT_TRUE(isCompressed(converted));
  Bytes decoded;
  gltf::DecodeReport report;
  ASSERT_TRUE(gltf::decodeGlb(converted, decoded, report).ok());
  expectSameTriangles(source, decoded, {"_FEATURE_ID_0"});
  gltf::test::PlainDocument document;
  ASSERT_EQ(document.load({{"file", converted}}, "file"), "");
  const Json& table = document.json["extensions"]["EXT_structural_metadata"]["propertyTables"][0];
  EXPECT_EQ(document.viewBytes(table["properties"]["kind"]["values"].get<uint64_t>()), values);
}

}  // namespace
}  // namespace mcc::test
