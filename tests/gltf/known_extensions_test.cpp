// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Extensions of 3D Tiles: which of them cost the order of vertices and triangles, and that what
// they refer to stays what it was.
#include <gtest/gtest.h>

#include <algorithm>

#include "gltf/round_trip.h"
#include "support/document_compare.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

struct OrderCase {
  const char* extension;
  const char* object;
  bool keeps_order;
};

/// Feature ids and metadata move with the vertices, unless the number of a vertex is its id, or an
/// object has members of a version that we do not know.
const OrderCase kOrderCases[] = {
    {"EXT_mesh_features", R"({"featureIds":[{"featureCount":2,"attribute":0}]})", false},
    {"EXT_mesh_features",
     R"({"featureIds":[{"featureCount":2,"nullFeatureId":9,"label":"a","attribute":0,)"
     R"("propertyTable":0},{"featureCount":5,"texture":{"index":0,"channels":[0]}}]})",
     false},
    {"EXT_mesh_features", R"({"featureIds":[{"featureCount":441}]})", true},
    {"EXT_mesh_features", R"({"featureIds":[{"attribute":0},{"featureCount":441}]})", true},
    {"EXT_mesh_features", R"({"featureIds":[{"offset":0,"repeat":4}]})", true},
    {"EXT_mesh_features", R"({"featureIds":[{"attribute":0,"repeat":4}]})", true},
    {"EXT_mesh_features", R"({"featureIds":[{"attribute":0,"extensions":{"ACME_a":{}}}]})", true},
    {"EXT_mesh_features", R"({"featureIds":[]})", true},
    {"EXT_mesh_features", R"({"featureIds":{"attribute":0}})", true},
    {"EXT_mesh_features", R"({"featureIds":[{"attribute":0}],"propertyTables":[0]})", true},
    {"EXT_mesh_features", R"({})", true},
    {"EXT_mesh_features", R"([])", true},
    {"EXT_structural_metadata", R"({"propertyAttributes":[0],"propertyTextures":[0]})", false},
    {"EXT_structural_metadata", R"({"propertyTable":0,"index":3})", false},
    {"EXT_structural_metadata", R"({"propertyMappings":[0]})", true},
    {"EXT_structural_metadata", R"({"extras":{"a":0}})", true},
    {"KHR_materials_variants", R"({"mappings":[]})", false},
    {"CESIUM_primitive_outline", R"({})", true},
    {"CESIUM_primitive_outline", R"({"indices":7,"faces":1})", true},
    {"EXT_mesh_primitive_edge_visibility", R"({"visibility":7})", true},
    {"EXT_mesh_polygon", R"({"count":2})", true},
    {"BENTLEY_primitive_restart", R"({"primitiveGroups":[]})", true},
};

TEST(KnownExtensions, OnlyWhatNeedsTheOrderKeepsIt) {
  for (const OrderCase& one : kOrderCases) {
    SCOPED_TRACE(std::string(one.extension) + " " + one.object);
    Json object;
    ASSERT_TRUE(parseJson(asBytes(one.object), object).ok());
    Builder builder;
    const Sheet sheet(20);
    Json primitive = sheet.addTo(builder);
    primitive["attributes"]["_FEATURE_ID_0"] =
        builder.addFloats(std::vector<float>(sheet.count(), 1), 1);
    primitive["extensions"][one.extension] = object;
    builder.addMesh({primitive});
    builder.json["extensionsUsed"] = {one.extension};
    const RoundTrip trip = roundTrip(builder, lossless());
    ASSERT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_EQ(jsonOf(trip.decoded)["meshes"][0]["primitives"][0]["extensions"][one.extension],
              object);
    const uint32_t position = primitive["attributes"]["POSITION"];
    const bool is_kept =
        elementsInOrder(trip.source, position) == elementsInOrder(trip.decoded, position);
    EXPECT_EQ(is_kept, one.keeps_order);
    EXPECT_EQ(differenceOfPrimitives(trip.source, trip.decoded, one.keeps_order), "");
  }
}

/// A building's table: texts with offsets, arrays with offsets, and numbers of 64 bits.
struct PropertyTable {
  std::vector<std::vector<uint8_t>> views = {
      {'w', 'e', 's', 't', 'e', 'a', 's', 't', 'x'},
      bytesOf(std::vector<uint32_t>{0, 4, 8, 9}),
      {1, 2, 3, 4, 5},
      bytesOf(std::vector<uint16_t>{0, 2, 2, 5}),
      bytesOf(std::vector<double>{1.5, 2.25, -3}),
  };

  /// Adds the table to a document; `is_draft`: with the names that a draft gave the views.
  void addTo(Builder& builder, bool is_draft = false) const {
    std::vector<uint32_t> numbers;
    for (const std::vector<uint8_t>& view : views) {
      builder.bin.resize((builder.bin.size() + 7) / 8 * 8, 0);
      numbers.push_back(builder.addView(view));
    }
    const char* values = is_draft ? "bufferView" : "values";
    Json properties = {{"name",
                        {{values, numbers[0]},
                         {is_draft ? "stringOffsetBufferView" : "stringOffsets", numbers[1]},
                         {"stringOffsetType", "UINT32"}}},
                       {"floors",
                        {{values, numbers[2]},
                         {is_draft ? "arrayOffsetBufferView" : "arrayOffsets", numbers[3]},
                         {"arrayOffsetType", "UINT16"}}},
                       {"height", {{values, numbers[4]}, {"min", -3}}}};
    // Ids that look like references are no references.
    const Json class_properties = {
        {"name", {{"type", "STRING"}}},
        {"floors", {{"type", "SCALAR"}, {"componentType", "UINT8"}, {"array", true}}},
        {"height", {{"type", "SCALAR"}, {"componentType", "FLOAT64"}}},
        {"bufferView", {{"type", "SCALAR"}, {"componentType", "UINT8"}}}};
    builder.json["extensions"]["EXT_structural_metadata"] = {
        {"schema", {{"id", "s"}, {"classes", {{"house", {{"properties", class_properties}}}}}}},
        {"propertyTables",
         {{{"class", "house"}, {"count", 3}, {"properties", std::move(properties)}}}}};
    builder.json["extensionsUsed"].push_back("EXT_structural_metadata");
  }

  /// Expects the bytes in a file, aligned to 8 bytes.
  void expectIn(const std::vector<uint8_t>& file) const {
    Document document;
    ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
    const Json json = jsonOf(file);
    const Json& properties =
        json["extensions"]["EXT_structural_metadata"]["propertyTables"][0]["properties"];
    size_t next = 0;
    for (const char* name : {"name", "floors", "height"}) {
      for (const auto& [key, value] : properties[name].items()) {
        if (!value.is_number() || value < 0) continue;
        const uint32_t view = value.get<uint32_t>();
        ASSERT_LT(view, document.views.size());
        const BufferView& range = document.views[view];
        const auto bytes = document.buffers[range.buffer].subspan(range.offset, range.length);
        EXPECT_EQ(std::vector<uint8_t>(bytes.begin(), bytes.end()), views[next]) << key;
        EXPECT_EQ((bytes.data() - document.buffers[0].data()) % 8, 0) << key;
        ++next;
      }
    }
    EXPECT_EQ(next, views.size());
  }
};

/// Returns the byte at which the BIN chunk of a GLB has its data.
size_t binOffset(const std::vector<uint8_t>& file) {
  GlbFile glb;
  EXPECT_TRUE(readGlb(file, glb).ok());
  return static_cast<size_t>(glb.bin.data() - file.data());
}

Builder buildingWithTable(bool is_draft, uint32_t odd_bytes) {
  Builder builder;
  builder.json["asset"]["generator"] = std::string(odd_bytes, 'x');
  builder.addView(std::vector<uint8_t>(odd_bytes, 7));
  const Sheet sheet(20);
  Json primitive = sheet.addTo(builder);
  std::vector<uint16_t> ids;
  for (uint32_t i = 0; i < sheet.count(); ++i) {
    ids.insert(ids.end(), {static_cast<uint16_t>(i / 147), 0});
  }
  const uint32_t view = builder.addView(bytesOf(ids), 4);
  primitive["attributes"]["_FEATURE_ID_0"] = builder.addAccessor({{"bufferView", view},
                                                                  {"componentType", kUnsignedShort},
                                                                  {"count", sheet.count()},
                                                                  {"type", "SCALAR"}});
  primitive["extensions"]["EXT_mesh_features"]["featureIds"] = {
      {{"featureCount", 3}, {"attribute", 0}, {"propertyTable", 0}}};
  builder.addMesh({primitive});
  builder.json["extensionsUsed"] = {"EXT_mesh_features"};
  PropertyTable().addTo(builder, is_draft);
  return builder;
}

TEST(KnownExtensions, PropertyTablesKeepTheirBytesAndAlignment) {
  for (uint32_t odd_bytes = 1; odd_bytes <= 8; ++odd_bytes) {
    const RoundTrip trip = roundTrip(buildingWithTable(false, odd_bytes));
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    for (const auto* file : {&trip.converted, &trip.decoded}) {
      PropertyTable().expectIn(*file);
      EXPECT_EQ(binOffset(*file) % 8, 0u);
    }
    // The view without a user, the payload and the table; nothing that only keeps a number in use.
    EXPECT_EQ(jsonOf(trip.converted)["bufferViews"].size(), 7u);
  }
}

/// The accessors of a document that uses these extensions become integers, too.
TEST(KnownExtensions, PropertyTablesSurviveIntegers) {
  const RoundTrip trip = roundTrip(buildingWithTable(false, 4));
  ASSERT_EQ(trip.error, "");
  DecodeOptions options;
  options.decode_to = DecodeTo::kIntegers;
  std::vector<uint8_t> decoded;
  DecodeReport report;
  ASSERT_TRUE(decodeGlb(trip.converted, decoded, report, options).ok());
  EXPECT_TRUE(report.notes.empty());
  PropertyTable().expectIn(decoded);
}

/// A draft's views keep their numbers, because we do not know where else it refers to views.
TEST(KnownExtensions, TablesOfDraftsKeepTheNumbersOfTheirViews) {
  const Builder builder = buildingWithTable(true, 4);
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  for (const auto* file : {&trip.converted, &trip.decoded}) {
    EXPECT_EQ(jsonOf(*file)["extensions"], builder.json["extensions"]);
    PropertyTable().expectIn(*file);
  }
}

/// Feature ids of instances, by an attribute and by number.
TEST(KnownExtensions, InstancesKeepTheirIds) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  const uint32_t places = builder.addFloats({0, 0, 0, 5, 5, 5, 9, 0, 2}, 3);
  const uint32_t ids =
      builder.addAccessor(std::vector<uint16_t>{7, 3, 7}, kUnsignedShort, "SCALAR", 3);
  Json& extensions = builder.json["nodes"][0]["extensions"];
  extensions["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places},
                                                         {"_FEATURE_ID_0", ids}};
  extensions["EXT_instance_features"]["featureIds"] = {{{"featureCount", 2}, {"attribute", 0}},
                                                       {{"featureCount", 3}}};
  builder.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "EXT_instance_features"};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  for (const auto* file : {&trip.converted, &trip.decoded}) {
    EXPECT_EQ(jsonOf(*file)["nodes"], builder.json["nodes"]);
    EXPECT_EQ(elementsInOrder(*file, places), elementsInOrder(trip.source, places));
    EXPECT_EQ(elementsInOrder(*file, ids), elementsInOrder(trip.source, ids));
  }
  // The node would not show its instances if its mesh moved into a child.
  DecodeOptions options;
  options.decode_to = DecodeTo::kIntegers;
  std::vector<uint8_t> decoded;
  DecodeReport report;
  ASSERT_TRUE(decodeGlb(trip.converted, decoded, report, options).ok());
  EXPECT_EQ(jsonOf(decoded)["nodes"], builder.json["nodes"]);
}

TEST(KnownExtensions, ValidatorHasNoObjection) {
  const std::string missing = mcc::test::Validator::whyNot();
  if (!missing.empty()) GTEST_SKIP() << missing;
  const mcc::test::ScratchFolder folder;
  mcc::test::Validator validator(folder.path());
  const RoundTrip table = roundTrip(buildingWithTable(false, 5));
  validator.add("table", table.source, table.converted, table.decoded);
  EXPECT_TRUE(validator.run()) << "the lines above name what is new";
}

}  // namespace
}  // namespace mcc::gltf::test
