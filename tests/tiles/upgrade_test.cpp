// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// b3dm as GLB: the values of the batch table, the ids of the vertices and the places of the nodes
// are those of the b3dm, and the rest of the glTF does not change.
#include "tiles/upgrade.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "gltf/made_up_codecs.h"
#include "gltf/scene_positions.h"
#include "tiles/batch_table.h"
#include "tiles/matrix.h"
#include "tiles/metadata_reader.h"
#include "tiles/structural_metadata.h"
#include "tiles/tile_file.h"
#include "tiles/tileset_builder.h"

namespace mcc::test {
namespace {

using gltf::test::Builder;

Json parsed(const std::string& text) {
  Json json;
  const gltf::Result result = gltf::parseJson(Bytes(text.begin(), text.end()), json);
  EXPECT_TRUE(result.ok()) << result.message() << " in " << text;
  return json;
}

/// A sheet with nine vertices, whose batch ids are `ids` as accessors of this type.
template <typename T>
Builder makeModel(const std::vector<T>& ids, int component_type,
                  const std::string& name = "_BATCHID") {
  Builder builder;
  Json primitive = gltf::test::Sheet(2).addTo(builder);
  primitive["attributes"][name] = builder.addAccessor(ids, component_type, "SCALAR", ids.size());
  builder.addMesh({primitive});
  return builder;
}

const std::vector<float> kIds = {0, 1, 2, 0, 1, 2, 0, 1, 2};

Builder makeModel() { return makeModel(kIds, gltf::test::kFloat); }

Tables tablesOf(const std::string& feature_json, const std::string& batch_json,
                const Bytes& batch_binary = {}) {
  Tables tables;
  tables.feature_json = paddedJson(feature_json, 28);
  if (!batch_json.empty()) tables.batch_json = paddedJson(batch_json, 0);
  tables.batch_binary = batch_binary;
  return tables;
}

Bytes upgraded(const Bytes& b3dm, const std::string& up_axis = "") {
  Bytes glb;
  std::string kept_because;
  const gltf::Result result = tiles::upgradeB3dm(b3dm, up_axis, glb, kept_because);
  EXPECT_TRUE(result.ok()) << result.message();
  EXPECT_EQ(kept_because, "");
  EXPECT_FALSE(glb.empty());
  return glb;
}

std::string keptBecause(const Bytes& b3dm, const std::string& up_axis = "") {
  Bytes glb;
  std::string kept_because;
  const gltf::Result result = tiles::upgradeB3dm(b3dm, up_axis, glb, kept_because);
  EXPECT_TRUE(result.ok()) << result.message();
  EXPECT_TRUE(glb.empty());
  EXPECT_EQ(kept_because.find('\n'), std::string::npos);
  return kept_because;
}

std::string keptFor(const std::string& feature_json, const std::string& batch_json) {
  return keptBecause(
      makeModelTile("b3dm", tablesOf(feature_json, batch_json), makeModel().toGlb()));
}

/// Returns the ids of a primitive as numbers, through its feature ids.
std::vector<double> featureIdsOf(const Bytes& glb, size_t primitive = 0) {
  gltf::Document document;
  const gltf::Result loaded = gltf::loadDocument(glb, nullptr, document);
  EXPECT_TRUE(loaded.ok()) << loaded.message();
  const Json& attributes = document.json["meshes"][0]["primitives"][primitive]["attributes"];
  EXPECT_FALSE(attributes.contains("_BATCHID"));
  EXPECT_TRUE(attributes.contains("_FEATURE_ID_0"));
  const auto index = attributes["_FEATURE_ID_0"].get<uint32_t>();
  const gltf::Accessor& accessor = document.accessors[index];
  const gltf::BufferView& view = document.views[accessor.view];
  const uint64_t stride = view.stride == 0 ? accessor.elementBytes() : view.stride;
  EXPECT_EQ(stride % 4, 0u);
  EXPECT_EQ((view.offset + accessor.offset) % 4, 0u);
  EXPECT_TRUE(accessor.component_type == ComponentType::kUint8 ||
              accessor.component_type == ComponentType::kUint16 ||
              accessor.component_type == ComponentType::kFloat32);
  return gltf::test::SceneReader::numbers(document, index);
}

constexpr char kThree[] = R"({"BATCH_LENGTH":3})";

/// Columns of JSON, and what they become: type, component type, and the two of arrays.
struct JsonColumn {
  const char* values;
  const char* type;
};

const JsonColumn kJsonColumns[] = {
    {R"(["a","","ä€😀"])", "STRING"},
    {R"(["","",""])", "STRING"},
    {R"(["a",null,"no data"])", "STRING"},
    {R"(["",null,"no data"])", "STRING"},
    {R"([null,null,null])", "STRING"},
    {R"([0,1,255])", "SCALAR UINT8"},
    {R"([0,-1,127])", "SCALAR INT8"},
    {R"([0,-1,128])", "SCALAR INT16"},
    {R"([0,256,65535])", "SCALAR UINT16"},
    {R"([-32768,32767,1])", "SCALAR INT16"},
    {R"([65536,4294967295,3])", "SCALAR UINT32"},
    {R"([-2147483648,2147483647,3])", "SCALAR INT32"},
    {R"([-1,4294967295,3])", "SCALAR FLOAT64"},
    {R"([9007199254740992,1,2])", "SCALAR FLOAT64"},
    {R"([9007199254740993,1,2])", "SCALAR UINT64"},
    {R"([18446744073709551615,1,2])", "SCALAR UINT64"},
    {R"([-9007199254740993,1,2])", "SCALAR INT64"},
    {R"([-9223372036854775808,9223372036854775807,2])", "SCALAR INT64"},
    {R"([0.1,1e-7,-2.5e300])", "SCALAR FLOAT64"},
    {R"([-0.0,0,1])", "SCALAR FLOAT64"},
    {R"([1e2,3.0,4])", "SCALAR UINT8"},
    {R"([1,null,2])", "SCALAR UINT8"},
    {R"([255,null,0])", "SCALAR UINT16"},
    {R"([-1.5,null,0])", "SCALAR FLOAT64"},
    {R"([true,false,true])", "BOOLEAN"},
    {R"([[1,2],[3,4],[5,-6]])", "SCALAR INT8 array 2"},
    {R"([[1],[3],[5]])", "SCALAR UINT8 array"},
    {R"([[],[3,4,5],[0.5]])", "SCALAR FLOAT64 array"},
    {R"([["a","bc"],[],["def"]])", "STRING array"},
    {R"([["a","bc"],["",""],["def","g"]])", "STRING array 2"},
    {R"([[true,false],[true],[]])", "BOOLEAN array"},
    {R"([[true,false,true],[true,true,true],[false,false,true]])", "BOOLEAN array 3"},
};

std::string typeOf(const Json& property) {
  std::string type = property["type"].get<std::string>();
  if (property.contains("componentType"))
    type += " " + property["componentType"].get<std::string>();
  if (property.value("array", false)) type += " array";
  if (property.contains("count")) type += " " + property["count"].dump();
  return type;
}

/// Compares values, and tells -0 from 0.
void expectSameValues(const Json& actual, const Json& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t i = 0; i < actual.size(); ++i) {
    if (expected[i].is_array()) {
      expectSameValues(actual[i], expected[i]);
      continue;
    }
    double number = 0;
    if (expected[i].is_binary() && gltf::asNumber(expected[i], number)) {
      EXPECT_EQ(actual[i], number);
      EXPECT_EQ(std::signbit(actual[i].get<double>()), std::signbit(number));
    } else {
      EXPECT_EQ(actual[i], expected[i]);
    }
  }
}

TEST(Upgrade, JsonColumnsKeepTheirValues) {
  std::string batch_json = "{";
  for (size_t i = 0; i < std::size(kJsonColumns); ++i) {
    batch_json += (i == 0 ? "\"c" : ",\"c") + std::to_string(i) + "\":" + kJsonColumns[i].values;
  }
  const Bytes glb =
      upgraded(makeModelTile("b3dm", tablesOf(kThree, batch_json + "}"), makeModel().toGlb()));
  const MetadataReader reader(glb);
  EXPECT_EQ(reader.table()["count"], 3);
  EXPECT_EQ(reader.classProperties().size(), std::size(kJsonColumns));
  for (size_t i = 0; i < std::size(kJsonColumns); ++i) {
    SCOPED_TRACE(kJsonColumns[i].values);
    const std::string id = "c" + std::to_string(i);
    EXPECT_EQ(typeOf(reader.classProperties()[id]), kJsonColumns[i].type);
    expectSameValues(reader.valuesOf(id), parsed(kJsonColumns[i].values));
  }
}

/// Numbers of all magnitudes come back as they were, whichever type is chosen.
TEST(Upgrade, RandomNumbersComeBack) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 300; ++round) {
    const uint64_t bits = random() % 65;
    std::string text = "[";
    for (int i = 0; i < 3; ++i) {
      const uint64_t magnitude = bits == 0 ? 0 : random() >> (64 - bits);
      if (i != 0) text += ",";
      if (random() % 5 == 0) {
        text += "null";
      } else if (bits < 64 && random() % 3 == 0) {
        text += std::to_string(-static_cast<int64_t>(magnitude));
      } else {
        text += std::to_string(magnitude);
      }
    }
    const Json values = parsed(text + "]");
    const Bytes b3dm =
        makeModelTile("b3dm", tablesOf(kThree, "{\"n\":" + text + "]}"), makeModel().toGlb());
    Bytes glb;
    std::string kept_because;
    ASSERT_TRUE(tiles::upgradeB3dm(b3dm, "", glb, kept_because).ok());
    if (glb.empty()) {
      EXPECT_GT(bits, 53u) << text << kept_because;
      continue;
    }
    SCOPED_TRACE(text);
    expectSameValues(MetadataReader(glb).valuesOf("n"), values);
  }
}

/// Offsets have a type that holds the last of them.
TEST(Upgrade, LongStringsComeBack) {
  for (const size_t length : {254u, 255u, 256u, 65535u, 65536u}) {
    const std::string text = "[\"" + std::string(length, 'x') + "\",\"y\",\"\"]";
    const Bytes glb = upgraded(
        makeModelTile("b3dm", tablesOf(kThree, "{\"n\":" + text + "}"), makeModel().toGlb()));
    EXPECT_EQ(MetadataReader(glb).valuesOf("n"), parsed(text)) << length;
  }
}

TEST(Upgrade, BinaryColumnsKeepTheirBits) {
  Bytes binary;
  for (uint32_t i = 0; i < 200; ++i) binary.push_back(static_cast<uint8_t>(i % 64));
  const std::pair<const char*, const char*> kTypes[] = {
      {"BYTE", "INT8"},     {"UNSIGNED_BYTE", "UINT8"},
      {"SHORT", "INT16"},   {"UNSIGNED_SHORT", "UINT16"},
      {"INT", "INT32"},     {"UNSIGNED_INT", "UINT32"},
      {"FLOAT", "FLOAT32"}, {"DOUBLE", "FLOAT64"}};
  const size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  for (size_t t = 0; t < std::size(kTypes); ++t) {
    for (size_t components = 1; components <= 4; ++components) {
      const std::string type = components == 1 ? "SCALAR" : "VEC" + std::to_string(components);
      const std::string json = R"({"p":{"byteOffset":16,"componentType":")" +
                               std::string(kTypes[t].first) + R"(","type":")" + type + "\"}}";
      const Bytes glb =
          upgraded(makeModelTile("b3dm", tablesOf(kThree, json, binary), makeModel().toGlb()));
      const MetadataReader reader(glb);
      EXPECT_EQ(typeOf(reader.classProperties()["p"]), type + " " + kTypes[t].second);
      const size_t length = 3 * components * kBytes[t];
      EXPECT_EQ(reader.viewBytes(reader.table()["properties"]["p"]["values"].get<size_t>()),
                Bytes(binary.begin() + 16, binary.begin() + 16 + static_cast<ptrdiff_t>(length)));
    }
  }
}

TEST(Upgrade, WhatHasNoCounterpartIsKept) {
  const std::pair<const char*, const char*> kTables[] = {
      {R"({"a":[1,"b",2]})", "different types"},
      {R"({"a":[{},{},{}]})", "objects"},
      {R"({"a":[true,null,false]})", "null among"},
      {R"({"a":[[1],null,[2]]})", "null among"},
      {R"({"a":[[1],[null],[2]]})", "null among"},
      {R"({"a":[[[1]],[],[]]})", "arrays of arrays"},
      {R"({"a":[[],[],[]]})", "empty"},
      {R"({"a":[[1],["b"],[]]})", "different types"},
      {R"({"a":[[""],[],[]]})", "empty"},
      {R"({"a":[1,2]})", "2 values for 3 batches"},
      {R"({"a":[1,2,3,4]})", "4 values for 3 batches"},
      {R"({"a":[1,2,18446744073709551617]})", "64 bits"},
      {R"({"a":[1,2,1e999]})", "64 bits"},
      {R"({"a":[0.5,2,9007199254740993]})", "exactly"},
      {R"({"a":[-1,18446744073709551615,0]})", "exactly"},
      {R"({"a":[null,1,9007199254740993]})", "exactly"},
      {R"({"a":3})", "neither"},
      {R"({"a":{"byteOffset":0,"componentType":"BYTE","type":"SCALAR"}})", "reach beyond"},
      {R"({"a":{"byteOffset":0,"componentType":"LONG","type":"SCALAR"}})", "componentType"},
      {R"({"a":{"byteOffset":0,"componentType":"BYTE","type":"MAT2"}})", "its type"},
      {R"({"HIERARCHY":{"classes":[]}})", "hierarchy"},
      {R"({"extensions":{"3DTILES_batch_table_hierarchy":{}}})", "3DTILES_batch_table_hierarchy"},
      {R"({"a":[1,2,3],"a":[1,2,3]})", "twice"},
      {R"({"a":)", "damaged"},
      {R"([])", "not a JSON object"}};
  for (const auto& [table, reason] : kTables) {
    EXPECT_NE(keptFor(kThree, table).find(reason), std::string::npos)
        << table << ": " << keptFor(kThree, table);
  }
  EXPECT_NE(keptFor(R"({"BATCH_LENGTH":0})", R"({"a":[1]})"), "");
  EXPECT_NE(keptFor(R"({"BATCH_LENGTH":0})", R"({"extras":1})"), "");
  EXPECT_NE(keptFor(R"({"BATCH_LENGTH":2})", "").find("batch id"), std::string::npos);
  EXPECT_NE(keptFor(R"({"BATCH_LENGTH":-1})", ""), "");
  EXPECT_NE(keptFor(R"({"BATCH_LENGTH":3,"extensions":{}})", "").find("extensions"),
            std::string::npos);
}

TEST(Upgrade, ValuesThatAreNotFiniteAreKept) {
  for (const double value : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    const Bytes binary = gltf::test::bytesOf(std::vector<double>{1, 2, value});
    const Bytes b3dm = makeModelTile(
        "b3dm",
        tablesOf(kThree, R"({"a":{"byteOffset":0,"componentType":"DOUBLE","type":"SCALAR"}})",
                 binary),
        makeModel().toGlb());
    EXPECT_NE(keptBecause(b3dm).find("not finite"), std::string::npos);
  }
}

/// Ids of all types become ids of the types that feature ids may have, each at a multiple of four.
TEST(Upgrade, BatchIdsKeepTheirValues) {
  const std::vector<double> expected(kIds.begin(), kIds.end());
  const auto expectIds = [&](const Builder& builder, const char* what) {
    SCOPED_TRACE(what);
    const Bytes glb = upgraded(makeModelTile("b3dm", tablesOf(kThree, ""), builder.toGlb()));
    EXPECT_EQ(featureIdsOf(glb), expected);
    const MetadataReader reader(glb);
    const Json& set =
        reader.root()["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_features"];
    EXPECT_EQ(set.dump(), R"({"featureIds":[{"featureCount":3,"attribute":0,"propertyTable":0}]})");
    EXPECT_EQ(reader.root()["extensionsUsed"].dump(),
              R"(["EXT_mesh_features","EXT_structural_metadata"])");
  };
  using namespace gltf::test;
  expectIds(makeModel<float>({0, 1, 2, 0, 1, 2, 0, 1, 2}, kFloat), "float");
  expectIds(makeModel<uint8_t>({0, 1, 2, 0, 1, 2, 0, 1, 2}, kUnsignedByte), "unsigned byte");
  expectIds(makeModel<int8_t>({0, 1, 2, 0, 1, 2, 0, 1, 2}, kByte), "byte");
  expectIds(makeModel<uint16_t>({0, 1, 2, 0, 1, 2, 0, 1, 2}, kUnsignedShort), "unsigned short");
  expectIds(makeModel<int16_t>({0, 1, 2, 0, 1, 2, 0, 1, 2}, kShort), "short");
  expectIds(makeModel<uint32_t>({0, 1, 2, 0, 1, 2, 0, 1, 2}, kUnsignedInt), "unsigned int");
  expectIds(makeModel<float>({0, 1, 2, 0, 1, 2, 0, 1, 2}, kFloat, "BATCHID"), "old name");
}

TEST(Upgrade, LargeIdsAreExactOrKept) {
  const auto tileOf = [](uint32_t id) {
    const Builder builder =
        makeModel<uint32_t>({0, 1, id, 0, 1, 2, 0, 1, 2}, gltf::test::kUnsignedInt);
    return makeModelTile("b3dm", tablesOf(R"({"BATCH_LENGTH":4294967295})", ""), builder.toGlb());
  };
  for (const uint32_t id : {255u, 256u, 65535u, 65536u, 16777215u}) {
    EXPECT_EQ(featureIdsOf(upgraded(tileOf(id)))[2], id);
  }
  EXPECT_NE(keptBecause(tileOf(16777216)).find("2^24"), std::string::npos);
  const Builder fraction = makeModel<float>({0, 1, 0.5f}, gltf::test::kFloat);
  EXPECT_NE(keptBecause(makeModelTile("b3dm", tablesOf(kThree, ""), fraction.toGlb())), "");
  const Builder negative = makeModel<float>({0, 1, -1}, gltf::test::kFloat);
  EXPECT_NE(keptBecause(makeModelTile("b3dm", tablesOf(kThree, ""), negative.toGlb())), "");
}

/// Two primitives with one accessor of ids keep sharing it.
TEST(Upgrade, SharedIdsStayShared) {
  Builder builder = makeModel<uint8_t>({0, 1, 2, 0, 1, 2, 0, 1, 2}, gltf::test::kUnsignedByte);
  Json& primitives = builder.json["meshes"][0]["primitives"];
  primitives.push_back(Json(primitives[0]));
  const Bytes glb = upgraded(makeModelTile("b3dm", tablesOf(kThree, ""), builder.toGlb()));
  const MetadataReader reader(glb);
  const Json& made = reader.root()["meshes"][0]["primitives"];
  EXPECT_EQ(made[0], made[1]);
  EXPECT_EQ(featureIdsOf(glb, 1), featureIdsOf(glb, 0));
}

TEST(Upgrade, MetadataThatIsThereIsKept) {
  for (const char* name : {"EXT_structural_metadata", "EXT_mesh_features", "EXT_feature_metadata",
                           "EXT_instance_features", "KHR_techniques_webgl"}) {
    Builder listed = makeModel();
    listed.json["extensionsUsed"] = {name};
    Builder hidden = makeModel();
    hidden.json["meshes"][0]["primitives"][0]["extensions"][name] = Json::object();
    for (const Builder& builder : {listed, hidden}) {
      const Bytes b3dm = makeModelTile("b3dm", tablesOf(kThree, ""), builder.toGlb());
      EXPECT_NE(keptBecause(b3dm).find(name), std::string::npos) << name;
    }
  }
  Builder both = makeModel();
  Json& attributes = both.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["_FEATURE_ID_0"] = attributes["_BATCHID"];
  EXPECT_NE(keptBecause(makeModelTile("b3dm", tablesOf(kThree, ""), both.toGlb())), "");
}

TEST(Upgrade, OldGltfIsKept) {
  Bytes b3dm = makeB3dm(makeModel().toGlb(), 3);
  tiles::TileFile tile;
  ASSERT_TRUE(tile.read(b3dm).ok());
  b3dm[tile.models()[0].begin + 4] = 1;
  EXPECT_EQ(keptBecause(b3dm), "its model is glTF 1.0");
}

/// The JSON of the glTF stays as it was, but for what the tables add, and so do the bytes.
TEST(Upgrade, TheRestOfTheGltfStays) {
  Builder builder = makeModel();
  builder.json["materials"] = parsed(R"([{"z":1,"a":0.10,"extras":{"b":1e-7}}])");
  builder.json["extensionsUsed"] = {"KHR_materials_unlit"};
  const Bytes source = builder.toGlb();
  const Bytes glb = upgraded(
      makeModelTile("b3dm", tablesOf(kThree, R"({"a":["x","y","z"],"extras":{"k":[1]}})"), source));
  const MetadataReader reader(glb);
  const MetadataReader old(source);
  ASSERT_GE(reader.bin().size(), old.bin().size());
  EXPECT_TRUE(std::equal(old.bin().begin(), old.bin().end(), reader.bin().begin()));
  EXPECT_EQ(reader.extension()["extras"].dump(), R"({"k":[1]})");
  Json rest = reader.root();
  rest.erase("extensions");
  rest["extensionsUsed"] = {"KHR_materials_unlit"};
  rest["buffers"] = old.root()["buffers"];
  Json& views = rest["bufferViews"];
  while (views.size() > old.root()["bufferViews"].size()) views.erase(views.size() - 1);
  Json& primitive = rest["meshes"][0]["primitives"][0];
  primitive.erase("extensions");
  std::string text = gltf::printJson(rest);
  text.replace(text.find("_FEATURE_ID_0"), 13, "_BATCHID");
  EXPECT_EQ(text, gltf::printJson(old.root()));
  EXPECT_EQ(upgraded(makeModelTile("b3dm", tablesOf(R"({"BATCH_LENGTH":0})", ""), source)), source);
}

TEST(Upgrade, ExtrasOfTheFeatureTable) {
  const char* features = R"({"BATCH_LENGTH":0,"extras":{"v":2}})";
  Builder builder = makeModel();
  const Bytes glb = upgraded(makeModelTile("b3dm", tablesOf(features, "{}"), builder.toGlb()));
  EXPECT_EQ(MetadataReader(glb).root()["extras"].dump(), R"({"v":2})");
  builder.json["extras"] = 1;
  EXPECT_NE(keptBecause(makeModelTile("b3dm", tablesOf(features, "{}"), builder.toGlb())), "");
}

TEST(Upgrade, BatchLengthInTheBinaryPart) {
  Tables tables = tablesOf(R"({"BATCH_LENGTH":{"byteOffset":4}})", R"({"a":[7,8,9]})");
  tables.feature_binary = {9, 9, 9, 9, 3, 0, 0, 0};
  const Bytes glb = upgraded(makeModelTile("b3dm", tables, makeModel().toGlb()));
  EXPECT_EQ(MetadataReader(glb).valuesOf("a").dump(), "[7,8,9]");
  tables.feature_json = paddedJson(R"({"BATCH_LENGTH":{"byteOffset":5}})", 28);
  EXPECT_NE(keptBecause(makeModelTile("b3dm", tables, makeModel().toGlb())), "");
}

TEST(Upgrade, IdsOfProperties) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(tiles::propertyIds({"a b", "a_b", "a-b", "Höhe", "1st", "", "_", "€"}),
            (Names{"a_b_2", "a_b", "a_b_3", "H_he", "_1st", "__2", "_", "__3"}));
  const Bytes glb = upgraded(makeModelTile(
      "b3dm", tablesOf(kThree, R"({"a b":[1,2,3],"a_b":[4,5,6]})"), makeModel().toGlb()));
  const MetadataReader reader(glb);
  EXPECT_EQ(reader.valuesOf("a_b_2").dump(), "[1,2,3]");
  EXPECT_EQ(reader.classProperties()["a_b_2"]["name"], "a b");
  EXPECT_EQ(reader.valuesOf("a_b").dump(), "[4,5,6]");
}

/// What a loader of 3D Tiles shows at the point (1, 2, 3) of the model. In 1.0 it turns the up axis
/// of the tileset to z and moves by RTC_CENTER; in 1.1 it turns y to z.
using Point = std::array<double, 3>;

Point placedByB3dm(const std::string& up_axis, const Point& center, const Point& p) {
  Point turned = {p[0], -p[2], p[1]};
  if (up_axis == "X") turned = {-p[2], p[1], p[0]};
  if (up_axis == "Z") turned = p;
  return {turned[0] + center[0], turned[1] + center[1], turned[2] + center[2]};
}

Point placedByGlb(const Json& root, const Point& p) {
  const Json& scene_nodes = root["scenes"][0]["nodes"];
  const Json& node = root["nodes"][scene_nodes[0].get<size_t>()];
  Point q = p;
  if (node.contains("matrix")) {
    for (size_t row = 0; row < 3; ++row) {
      q[row] = node["matrix"][12 + row].get<double>();
      for (size_t c = 0; c < 3; ++c) q[row] += node["matrix"][4 * c + row].get<double>() * p[c];
    }
  } else if (node.contains("translation")) {
    for (size_t c = 0; c < 3; ++c) q[c] += node["translation"][c].get<double>();
  }
  return {q[0], -q[2], q[1]};
}

TEST(Upgrade, ModelsStayWhereTheyAre) {
  const Point kPoint = {1, 2, 3};
  for (const std::string up_axis : {"", "X", "Y", "Z"}) {
    for (const Point& center :
         {Point{0, 0, 0}, Point{1215107.7612304366, -4736682.902037748, 0.1}}) {
      SCOPED_TRACE(up_axis);
      Json features = {{"BATCH_LENGTH", 0}};
      features["RTC_CENTER"] = center;
      const Bytes glb = upgraded(
          makeModelTile("b3dm", tablesOf(features.dump(), ""), makeModel().toGlb()), up_axis);
      const MetadataReader reader(glb);
      EXPECT_EQ(placedByGlb(reader.root(), kPoint), placedByB3dm(up_axis, center, kPoint));
      const bool is_moved = center[0] != 0 || up_axis == "X" || up_axis == "Z";
      EXPECT_EQ(reader.root()["nodes"].size(), is_moved ? 2u : 1u);
      EXPECT_EQ(reader.root()["scenes"].dump(),
                is_moved ? R"([{"nodes":[1]}])" : R"([{"nodes":[0]}])");
    }
  }
  EXPECT_NE(keptBecause(makeB3dm(makeModel().toGlb(), 3), "y"), "");
}

TEST(Upgrade, EachSceneIsMoved) {
  const auto tileOf = [](const Json& scenes) {
    Builder builder = makeModel();
    builder.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}}};
    builder.json["scenes"] = scenes;
    return makeModelTile("b3dm", tablesOf(R"({"BATCH_LENGTH":0,"RTC_CENTER":[1,2,3]})", ""),
                         builder.toGlb());
  };
  const MetadataReader reader(
      upgraded(tileOf(parsed(R"([{"nodes":[0,2]},{"name":"n","nodes":[1]},{},{"nodes":[0,2]}])"))));
  EXPECT_EQ(reader.root()["scenes"].dump(),
            R"([{"nodes":[3]},{"name":"n","nodes":[4]},{},{"nodes":[3]}])");
  EXPECT_EQ(reader.root()["nodes"][3]["children"].dump(), "[0,2]");
  EXPECT_EQ(reader.root()["nodes"][4]["children"].dump(), "[1]");
  EXPECT_NE(keptBecause(tileOf(parsed(R"([{"nodes":[0,2]},{"nodes":[2]}])"))), "");
  EXPECT_NE(keptBecause(tileOf(parsed(R"([{"nodes":[9]}])"))), "");
  EXPECT_NE(keptBecause(tileOf(parsed("[]"))), "");
}

/// A primitive that another codec holds: its ids have their name in two places.
TEST(Upgrade, CodedPrimitives) {
  for (const int type : {gltf::test::kFloat, gltf::test::kUnsignedInt}) {
    Builder builder;
    gltf::test::Sheet sheet(2);
    Bytes coded;
    for (const uint16_t index : sheet.indices) appendNumber(coded, index);
    const Bytes positions = gltf::test::bytesOf(sheet.positions);
    coded.insert(coded.end(), positions.begin(), positions.end());
    const Bytes ids = type == gltf::test::kFloat
                          ? gltf::test::bytesOf(kIds)
                          : gltf::test::bytesOf(std::vector<uint32_t>{0, 1, 2, 0, 1, 2, 0, 1, 2});
    coded.insert(coded.end(), ids.begin(), ids.end());
    const uint32_t view = builder.addView(coded);
    builder.addAccessor({{"componentType", gltf::test::kFloat},
                         {"count", 9},
                         {"type", "VEC3"},
                         {"min", {0, -1, 0}},
                         {"max", {1, 1, 1}}});
    builder.addAccessor({{"componentType", type}, {"count", 9}, {"type", "SCALAR"}});
    builder.addAccessor({{"componentType", gltf::test::kUnsignedShort},
                         {"count", sheet.indices.size()},
                         {"type", "SCALAR"}});
    Json primitive = {{"attributes", {{"POSITION", 0}, {"_BATCHID", 1}}}, {"indices", 2}};
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"_BATCHID", 1}}}};
    builder.addMesh({primitive});
    builder.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    const Bytes b3dm = makeModelTile("b3dm", tablesOf(kThree, ""), builder.toGlb());
    EXPECT_NE(keptBecause(b3dm).find("cannot be read"), std::string::npos);
    Bytes glb;
    std::string kept_because;
    ASSERT_TRUE(tiles::upgradeB3dm(b3dm, "", glb, kept_because, gltf::test::madeUpDecoders()).ok());
    if (type == gltf::test::kUnsignedInt) {
      EXPECT_NE(kept_because, "");
      continue;
    }
    ASSERT_EQ(kept_because, "");
    const MetadataReader reader(glb);
    const Json& made = reader.root()["meshes"][0]["primitives"][0];
    EXPECT_EQ(made["attributes"].dump(), R"({"POSITION":0,"_FEATURE_ID_0":1})");
    EXPECT_EQ(made["extensions"]["KHR_draco_mesh_compression"]["attributes"].dump(),
              R"({"POSITION":0,"_FEATURE_ID_0":1})");
    EXPECT_EQ(made["extensions"]["EXT_mesh_features"]["featureIds"][0]["featureCount"], 3);
  }
}

}  // namespace
}  // namespace mcc::test
