// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tiles that others have already quantised or compressed, and extensions that only pass through.
#include <functional>

#include "cli/run_tool.h"
#include "foreign/draco_codec.h"
#include "foreign/meshopt_codec.h"
#include "tiles/city_builder.h"

namespace mcc::test {
namespace {

using gltf::test::Builder;
using gltf::test::kFloat;
using gltf::test::kShort;
using gltf::test::kUnsignedByte;
using gltf::test::kUnsignedShort;

std::vector<uint32_t> wide(const std::vector<uint16_t>& indices) {
  return {indices.begin(), indices.end()};
}

/// A patch of terrain with positions of 16 bits, as gltfpack writes it: `column` and its eastern
/// neighbour have the same places on their common border. Of a node with a scale and a translation.
Builder quantizedPatch(uint32_t column, int type, bool normalized) {
  constexpr int kSize = 32;
  const gltf::test::Sheet sheet(kSize);
  std::vector<uint16_t> positions;
  for (int row = 0; row <= kSize; ++row) {
    for (int i = 0; i <= kSize; ++i) {
      const int x = static_cast<int>(column) * kSize + i;
      const int height = (x * 53 + row * 97) % 601 + 7 * x;
      for (const int value : {i * 900, height, row * 900, 0}) {
        positions.push_back(static_cast<uint16_t>(value));
      }
    }
  }
  Builder builder;
  const uint32_t view = builder.addView(gltf::test::bytesOf(positions), 8);
  Json accessor = {{"bufferView", view}, {"componentType", type}, {"count", sheet.count()},
                   {"type", "VEC3"},     {"min", {0, 0, 0}},      {"max", {28800, 28800, 28800}}};
  if (normalized) accessor["normalized"] = true;
  Json primitive = {{"attributes", {{"POSITION", builder.addAccessor(accessor)}}},
                    {"indices", builder.addIndices(sheet.indices)}};
  builder.addMesh({primitive});
  builder.json["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
  builder.json["nodes"][0]["translation"] = {288.0 * column, 0, 0};
  builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  return builder;
}

/// Integers are not quantised again, whatever error was promised.
TEST(ForeignInput, QuantizedPositionsStayExact) {
  for (const auto& [type, normalized] :
       {std::pair(kUnsignedShort, false), {kShort, false}, {kUnsignedShort, true}}) {
    const ConvertedModel model = convertAsTile(quantizedPatch(0, type, normalized).toGlb());
    ASSERT_TRUE(isCompressed(model.converted));
    EXPECT_EQ(model.figures.bits_high, 0);
    EXPECT_EQ(model.figures.measured_error, 0);
    expectSameTriangles(model.source, model.decoded, {});
    const Json json = gltf::test::jsonOf(model.decoded);
    EXPECT_EQ(json["accessors"][0]["componentType"], type);
    EXPECT_EQ(json["nodes"], gltf::test::jsonOf(model.source)["nodes"]);
  }
}

/// Returns the corners with the largest or the smallest x.
std::vector<Corner> border(const std::vector<Corner>& corners, double x) {
  std::vector<Corner> result;
  for (const Corner& corner : corners) {
    if (corner[0] == x) result.push_back({corner[1], corner[2]});
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// A promise of half a metre is kept, and borders stay closed: nothing moves.
TEST(ForeignInput, QuantizedTilesStillMeet) {
#ifndef MCC_TOOL_GLTF_MCC
  GTEST_SKIP() << "the tool is not part of this build";
#endif
  const ScratchFolder folder;
  Json root = makeTile(16, "");
  for (const uint32_t column : {0u, 1u}) {
    const std::string name = "patch" + std::to_string(column) + ".glb";
    storeBytes(folder.path() / "in" / name, quantizedPatch(column, kUnsignedShort, false).toGlb());
    root["children"].push_back(makeTile(0, name));
  }
  storeText(folder.path() / "in" / "tileset.json", makeTileset(root, 100).dump());
  const ToolResult result = runTool(folder, "tiles in/tileset.json out --report report.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const Json report = Json::parse(contentOf(folder.path() / "report.json"));
  EXPECT_EQ(report["levels"][1]["position_bits"], Json({0, 0}));
  std::vector<Corner> borders[2];
  for (const uint32_t column : {0u, 1u}) {
    const std::string content =
        contentOf(folder.path() / "out" / ("patch" + std::to_string(column) + ".glb"));
    Bytes decoded;
    gltf::DecodeReport ignored;
    const Bytes converted(content.begin(), content.end());
    ASSERT_TRUE(isCompressed(converted));
    ASSERT_TRUE(gltf::decodeGlb(converted, decoded, ignored).ok());
    borders[column] = border(cornersOf(decoded, {}), column == 0 ? 32 * 900 : 0);
  }
  EXPECT_EQ(borders[0].size(), 33u);
  EXPECT_EQ(borders[0], borders[1]);
}

#if defined(MCC_HAS_FOREIGN)

/// Stores a view in the way of EXT_meshopt_compression. The coded bytes are in buffer 0, the place
/// of the others in a buffer without bytes.
void encodeView(const std::string& extension, uint32_t view, const std::string& mode,
                uint32_t stride, uint64_t& placeholder_bytes, Builder& builder) {
  Json& json = builder.json["bufferViews"][view];
  const size_t offset = json["byteOffset"];
  const size_t length = json["byteLength"];
  const Bytes elements(builder.bin.begin() + static_cast<ptrdiff_t>(offset),
                       builder.bin.begin() + static_cast<ptrdiff_t>(offset + length));
  Bytes coded;
  const foreign::Outcome done =
      foreign::encodeMeshoptView(elements, length / stride, stride, mode, coded);
  ASSERT_TRUE(done.ok()) << done.message;
  builder.bin.resize((builder.bin.size() + 3) / 4 * 4, 0);
  Json& object = builder.json["bufferViews"][view]["extensions"][extension];
  object = {
      {"buffer", 0},          {"byteOffset", builder.bin.size()}, {"byteLength", coded.size()},
      {"byteStride", stride}, {"count", length / stride},         {"mode", mode}};
  builder.bin.insert(builder.bin.end(), coded.begin(), coded.end());
  json["buffer"] = 1;
  json["byteOffset"] = placeholder_bytes;
  placeholder_bytes += (length + 3) / 4 * 4;
}

/// The city with all of its views coded, and with ids and an outline.
Bytes meshoptCity(const City& city, const std::string& extension) {
  Builder builder;
  Json primitive = city.addTo(builder);
  primitive["attributes"]["_FEATURE_ID_0"] = addIds(builder, city.houses, kUnsignedShort);
  primitive["attributes"]["_FEATURE_ID_1"] = addIds(builder, city.faces, kFloat);
  primitive["extensions"]["EXT_mesh_features"]["featureIds"] = {
      {{"featureCount", city.house_count}, {"attribute", 0}},
      {{"featureCount", 6 * city.house_count}, {"attribute", 1}}};
  builder.addMesh({primitive});
  uint64_t placeholder_bytes = 0;
  const std::vector<std::pair<std::string, uint32_t>> codings = {
      {"ATTRIBUTES", 12}, {"ATTRIBUTES", 12}, {"ATTRIBUTES", 8},
      {"TRIANGLES", 2},   {"ATTRIBUTES", 4},  {"ATTRIBUTES", 4}};
  for (uint32_t view = 0; view < codings.size(); ++view) {
    encodeView(extension, view, codings[view].first, codings[view].second, placeholder_bytes,
               builder);
  }
  builder.json["extensionsUsed"] = {"EXT_mesh_features", extension};
  builder.json["extensionsRequired"] = {extension};
  builder.json["buffers"] = {
      {{"byteLength", builder.bin.size()}},
      {{"byteLength", placeholder_bytes}, {"extensions", {{extension, {{"fallback", true}}}}}}};
  return gltf::test::glbOf(builder.json, builder.bin);
}

/// The same without compression.
Bytes plainCity(const City& city) {
  Builder builder;
  Json primitive = city.addTo(builder);
  primitive["attributes"]["_FEATURE_ID_0"] = addIds(builder, city.houses, kUnsignedShort);
  primitive["attributes"]["_FEATURE_ID_1"] = addIds(builder, city.faces, kFloat);
  builder.addMesh({primitive});
  return builder.toGlb();
}

TEST(ForeignInput, MeshoptTilesKeepTheirIds) {
  const City city(7);
  const std::vector<std::string> names = {"_FEATURE_ID_0", "_FEATURE_ID_1"};
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    SCOPED_TRACE(extension);
    const ConvertedModel model = convertAsTile(meshoptCity(city, extension));
    ASSERT_TRUE(isCompressed(model.converted));
    expectSameTriangles(plainCity(city), model.decoded, names);
    const Json json = gltf::test::jsonOf(model.converted);
    EXPECT_EQ(json["extensionsUsed"], Json({"EXT_mesh_features", gltf::kExtensionName}));
  }
}

/// The city in Draco's code, with positions in exact floats and all ids inside.
Bytes dracoCity(const City& city, int type, foreign::DracoPrimitive& coded) {
  Builder ids;
  addIds(ids, city.houses, type);
  const std::vector<uint32_t> indices = wide(city.indices);
  std::vector<AttributeView> attributes;
  const auto add = [&](Semantic semantic, uint8_t components, ComponentType component_type,
                       const void* data, size_t stride) {
    AttributeFormat format;
    format.semantic = semantic;
    format.component_count = components;
    format.component_type = component_type;
    attributes.push_back({format, data, stride, 0, nullptr});
  };
  add(Semantic::kPosition, 3, ComponentType::kFloat32, city.positions.data(), 12);
  add(Semantic::kNormal, 3, ComponentType::kFloat32, city.normals.data(), 12);
  add(Semantic::kCustom, 1,
      type == kFloat          ? ComponentType::kFloat32
      : type == kUnsignedByte ? ComponentType::kUint8
                              : ComponentType::kUint16,
      ids.bin.data(), 4);
  const PartView part{indices};
  const foreign::Outcome done =
      foreign::emitDracoPrimitive({city.count(), attributes, {&part, 1}}, 0, 5, coded);
  EXPECT_TRUE(done.ok()) << done.message;
  Builder builder;
  const char* names[] = {"POSITION", "NORMAL", "_BATCHID"};
  Json primitive;
  Json extension;
  extension["bufferView"] = builder.addView(coded.bytes);
  for (const foreign::DracoPrimitiveAttribute& attribute : coded.attributes) {
    const char* name = names[attribute.piece_attribute];
    extension["attributes"][name] = attribute.unique_id;
    primitive["attributes"][name] =
        builder.addAccessor({{"componentType", attribute.piece_attribute == 2 ? type : kFloat},
                             {"count", coded.vertex_count},
                             {"type", attribute.piece_attribute == 2 ? "SCALAR" : "VEC3"}});
  }
  primitive["extensions"]["KHR_draco_mesh_compression"] = extension;
  primitive["indices"] = builder.addAccessor(
      {{"componentType", kUnsignedShort}, {"count", 3 * coded.triangle_count}, {"type", "SCALAR"}});
  builder.addMesh({primitive});
  builder.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return builder.toGlb();
}

TEST(ForeignInput, DracoTilesKeepTheirIds) {
  const City city(7);
  for (const int type : {kUnsignedByte, kUnsignedShort, kFloat}) {
    SCOPED_TRACE(type);
    foreign::DracoPrimitive coded;
    const Bytes source = dracoCity(city, type, coded);
    // Draco joins vertices that are equal in all attributes, so only triangles can be compared.
    const ConvertedModel model = convertAsTile(source);
    ASSERT_TRUE(isCompressed(model.converted));
    Builder plain;
    Json primitive = city.addTo(plain);
    primitive["attributes"]["_BATCHID"] = addIds(plain, city.houses, type);
    plain.addMesh({primitive});
    EXPECT_TRUE(trianglesIn(model.decoded, {"_BATCHID"}) ==
                trianglesIn(plain.toGlb(), {"_BATCHID"}));
    const Json json = gltf::test::jsonOf(model.converted);
    EXPECT_EQ(json["extensionsUsed"], Json::array({gltf::kExtensionName}));
  }
}

#endif

/// Images, materials and whole extensions that have nothing to do with the geometry.
TEST(ForeignInput, WhatIsNoGeometryPassesThrough) {
  const City city(7);
  Builder builder;
  Json primitive = city.addTo(builder);
  primitive["material"] = 0;
  builder.addMesh({primitive});
  const std::vector<Bytes> images = {{'R', 'I', 'F', 'F', 4, 0, 0, 0, 'W', 'E', 'B', 'P', 9},
                                     {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, 1, 2, 3}};
  Json& json = builder.json;
  for (const Bytes& image : images) {
    const bool is_webp = image[0] == 'R';
    json["images"].push_back({{"bufferView", builder.addView(image)},
                              {"mimeType", is_webp ? "image/webp" : "image/ktx2"}});
    const char* extension = is_webp ? "EXT_texture_webp" : "KHR_texture_basisu";
    json["textures"].push_back(
        {{"extensions", {{extension, {{"source", json["images"].size() - 1}}}}}});
  }
  json["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.25, 0.5}}}}}}}}}},
       {"emissiveTexture", {{"index", 1}}},
       {"extensions",
        {{"KHR_materials_unlit", Json::object()},
         {"BENTLEY_materials_planar_fill", {{"wireframeFill", 2}}}}}}};
  json["extensions"] = {{"CESIUM_RTC", {{"center", {1234567.25, -7654321.5, 4000000.125}}}},
                        {"MAXAR_extent", {{"uri", "extent.json"}}}};
  json["extensionsUsed"] = {"EXT_texture_webp",
                            "KHR_texture_basisu",
                            "KHR_texture_transform",
                            "KHR_materials_unlit",
                            "BENTLEY_materials_planar_fill",
                            "CESIUM_RTC",
                            "MAXAR_extent"};
  const ConvertedModel model = convertAsTile(builder.toGlb());
  ASSERT_TRUE(isCompressed(model.converted));
  for (const Bytes* file : {&model.converted, &model.decoded}) {
    const Json result = gltf::test::jsonOf(*file);
    for (const char* member : {"materials", "textures", "extensions", "nodes"}) {
      EXPECT_EQ(result[member], json[member]) << member;
    }
    gltf::test::PlainDocument document;
    ASSERT_EQ(document.load({{"file", *file}}, "file"), "");
    for (size_t i = 0; i < images.size(); ++i) {
      EXPECT_EQ(document.viewBytes(result["images"][i]["bufferView"].get<uint32_t>()), images[i]);
    }
  }
}

}  // namespace
}  // namespace mcc::test
