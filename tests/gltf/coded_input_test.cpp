// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Sources that other codecs compressed. The codecs here are made up: views have their bits
// inverted, and meshes are lists of their arrays. Real ones are tested in tests/foreign and
// tests/cli.
#include <gtest/gtest.h>

#include <filesystem>

#include "gltf/files/file_io.h"
#include "gltf/made_up_codecs.h"
#include "mcc/files.h"
#include "support/scratch_folder.h"

namespace mcc::gltf::test {
namespace {

/// A sheet, and an animation of a node.
Builder plainDocument(Json& sheet) {
  Builder builder;
  sheet = Sheet(24).addTo(builder);
  builder.addMesh({sheet});
  const uint32_t times = builder.addFloats({0, 1}, 1);
  const uint32_t places = builder.addFloats({0, 0, 0, 1, 1, 1}, 3);
  builder.json["accessors"][times]["min"] = {0};
  builder.json["accessors"][times]["max"] = {1};
  builder.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", places}}}}}};
  return builder;
}

TEST(CodedViews, GeometryIsDecodedAndCompressedAgain) {
  Json sheet;
  Builder builder = plainDocument(sheet);
  const RoundTrip plain = roundTrip(builder);
  ASSERT_EQ(plain.error, "");
  codeViews(builder, {0, 1, 2, 3});
  const RoundTrip trip = roundTrip(fileOf(builder), withDecoders());
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.converted, plain.converted);
  EXPECT_EQ(trip.decoded, plain.decoded);
}

TEST(CodedViews, OthersStayCoded) {
  Json sheet;
  Builder builder = plainDocument(sheet);
  codeViews(builder, {0, 1, 2, 3, 4, 5});
  const RoundTrip trip = roundTrip(fileOf(builder), withDecoders());
  ASSERT_EQ(trip.error, "");
  for (const auto* file : {&trip.converted, &trip.decoded}) {
    const Json json = jsonOf(*file);
    EXPECT_EQ(json["extensionsRequired"][0], kViewName);
    ASSERT_EQ(json["buffers"].size(), 2u);
    EXPECT_EQ(json["buffers"][1]["extensions"][kViewName]["fallback"], true);
    Document document;
    ASSERT_TRUE(loadDocument(*file, nullptr, document).ok());
    for (const uint32_t accessor : {4u, 5u}) {
      const BufferView& view = document.views[document.accessors[accessor].view];
      ASSERT_TRUE(view.isCoded());
      const uint8_t* coded = document.buffers[view.buffer].data() + view.offset;
      const std::vector<uint8_t> bytes = inverted({coded, view.length});
      const size_t source =
          builder.json["bufferViews"][accessor]["extensions"][kViewName]["byteOffset"];
      const auto* first = builder.bin.data() + source;
      EXPECT_EQ(bytes, inverted({first, view.length}));
    }
  }
}

/// With only triangles compressed, the attributes stay in their coded views and the payload has the
/// order.
TEST(CodedViews, IndicesOnlyWorksBesideThem) {
  Json sheet;
  Builder builder = plainDocument(sheet);
  const std::vector<uint8_t> plain = builder.toGlb();
  codeViews(builder, {0, 1, 2, 3, 4, 5});
  ConvertOptions options = withDecoders();
  options.indices_only = true;
  options.keep_triangle_order = true;
  const RoundTrip trip = roundTrip(fileOf(builder), options);
  ASSERT_EQ(trip.error, "");
  EXPECT_FALSE(trip.report.copied);
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  EXPECT_EQ(elementsInOrder(plain, sheet["indices"]),
            elementsInOrder(trip.decoded, sheet["indices"]));
  Document document;
  ASSERT_TRUE(loadDocument(trip.converted, nullptr, document).ok());
  for (const uint32_t accessor : {0u, 1u, 2u, 4u, 5u}) {
    EXPECT_TRUE(document.views[document.accessors[accessor].view].isCoded()) << accessor;
  }
}

/// The fallback is then a third buffer, after the one that coded views claim to be in.
TEST(CodedViews, StayCodedBesideAFallback) {
  Json sheet;
  Builder builder = plainDocument(sheet);
  const std::vector<uint8_t> plain = builder.toGlb();
  codeViews(builder, {0, 1, 2, 3, 4, 5});
  const std::vector<uint8_t> source = fileOf(builder);
  const mcc::test::ScratchFolder folder;
  ConvertOptions options = withDecoders();
  options.fallback = true;
  for (const char* name : {"a.glb", "a.gltf"}) {
    SCOPED_TRACE(name);
    const std::filesystem::path path = folder.path() / name;
    ConvertReport report;
    const Result result = convert({"in.glb", source}, {path}, options, report);
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_GT(report.fallback_bytes, 0u);
    std::vector<uint8_t> file;
    ASSERT_TRUE(readFile(path, file).ok());
    Document document;
    ASSERT_TRUE(loadDocument(file, readerOf(folder.path()), document).ok());
    EXPECT_EQ(document.json["extensionsRequired"],
              Json::array({kViewName}));  // ours has a fallback
    ASSERT_EQ(document.json["buffers"].size(), 3u);
    EXPECT_EQ(document.json["buffers"][1]["extensions"][kViewName]["fallback"], true);
    const std::string fallback = document.json["buffers"][2]["uri"];
    EXPECT_TRUE(std::filesystem::exists(folder.path() / fallback)) << fallback;
    EXPECT_TRUE(isCompressed(document.json, 0, 0));
    for (const auto& [label, accessor] :
         sheet["attributes"].items()) {  // readable without the extension
      const BufferView& view = document.views[document.accessors[accessor].view];
      EXPECT_FALSE(view.isCoded()) << label;
      EXPECT_EQ(view.buffer, 2u) << label;
    }
    EXPECT_TRUE(document.views[document.accessors[4].view].isCoded());
    // The decoded result is the same with and without the fallback.
    std::vector<uint8_t> decoded[2];
    for (std::vector<uint8_t>& bytes : decoded) {
      DecodeReport decode_report;
      ASSERT_EQ(decode({path, {}}, {{}, &bytes}, decode_report).message(), "");
      std::filesystem::remove(folder.path() / fallback);
      EXPECT_EQ(elementsOf(plain, sheet["indices"]).size(),
                elementsOf(bytes, sheet["indices"]).size());
      Document back;
      ASSERT_TRUE(loadDocument(bytes, nullptr, back).ok());
      EXPECT_TRUE(back.views[back.accessors[4].view].isCoded());
    }
    EXPECT_EQ(decoded[0], decoded[1]);
  }
}

TEST(CodedViews, WithoutADecoderTheyStay) {
  Json sheet;
  Builder builder = plainDocument(sheet);
  const Json other = Sheet(20).addTo(builder);
  builder.addMesh({other});
  codeViews(builder, {0, 4, 5});
  const RoundTrip trip = roundTrip(fileOf(builder));
  ASSERT_EQ(trip.error, "");
  EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 0, 0));
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 1, 0));
  EXPECT_TRUE(hasNote(trip.report, "POSITION is coded with EXT_meshopt_compression"));
}

TEST(CodedViews, DamageIsAnErrorWithAPath) {
  const auto errorOf = [](const std::function<void(Json&)>& damage) {
    Json sheet;
    Builder builder = plainDocument(sheet);
    codeViews(builder, {0, 1});
    damage(builder.json["bufferViews"][1]["extensions"][kViewName]);
    return roundTrip(fileOf(builder), withDecoders()).error;
  };
  EXPECT_EQ(errorOf([](Json&) {}), "");
  EXPECT_EQ(errorOf([](Json& j) { j["filter"] = "COLOR"; }),
            "/bufferViews/1/extensions/EXT_meshopt_compression: has an unknown filter");
  EXPECT_EQ(errorOf([](Json& j) { j["byteLength"] = 20; }),
            "/bufferViews/1/extensions/EXT_meshopt_compression: 20 bytes cannot hold 7500 bytes");
  EXPECT_EQ(errorOf([](Json& j) { j["byteLength"] = 7000; }),
            "/bufferViews/1/extensions/EXT_meshopt_compression: decodes to another size");
  EXPECT_NE(errorOf([](Json& j) { j["count"] = 1; }).find("codes 2 bytes, but the view has 7500"),
            std::string::npos);
  EXPECT_NE(errorOf([](Json& j) { j["buffer"] = 7; }).find("there is no buffer 7"),
            std::string::npos);
  EXPECT_NE(errorOf([](Json& j) { j.erase("mode"); }).find("\"mode\" is missing"),
            std::string::npos);
}

TEST(CodedMeshes, AreDecodedAndCompressedAgain) {
  Json sheet;
  Builder builder = plainDocument(sheet);
  const RoundTrip plain = roundTrip(builder);
  codeMesh(builder, 0);
  for (size_t view = 0; view < 4; ++view) builder.json["bufferViews"][view]["byteLength"] = 1;
  const RoundTrip trip = roundTrip(builder, withDecoders());
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(json, 0, 0));
  EXPECT_EQ(json["extensionsRequired"], Json::array({kExtensionName}));
  EXPECT_FALSE(json["meshes"][0]["primitives"][0]["extensions"].contains(kMeshName));
  for (const uint32_t accessor : {0u, 1u, 2u, 3u}) {
    EXPECT_EQ(elementsInOrder(trip.decoded, accessor), elementsInOrder(plain.decoded, accessor));
  }
}

TEST(CodedMeshes, WhatGainsNothingStaysCoded) {
  Builder builder;
  builder.addMesh({Sheet(24).addTo(builder)});
  builder.addMesh({Sheet(1).addTo(builder)});
  codeMesh(builder, 0);
  codeMesh(builder, 1);
  const RoundTrip trip = roundTrip(builder, withDecoders());
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(json, 0, 0));
  EXPECT_FALSE(isCompressed(json, 1, 0));
  EXPECT_TRUE(json["meshes"][1]["primitives"][0]["extensions"].contains(kMeshName));
  EXPECT_EQ(json["extensionsRequired"], Json({kMeshName, kExtensionName}));
  const RoundTrip again = roundTrip(trip.converted, withDecoders());
  ASSERT_EQ(again.error, "");
  EXPECT_EQ(again.converted, trip.converted);
}

TEST(CodedMeshes, StayWithANoteWhereTheyMust) {
  const auto noteOf = [](const std::function<void(Builder&)>& change, bool keep_bytes,
                         ConvertOptions options) {
    Builder builder;
    builder.addMesh({Sheet(24).addTo(builder)});
    codeMesh(builder, 0, keep_bytes);
    change(builder);
    const RoundTrip trip = roundTrip(builder, options);
    EXPECT_EQ(trip.error, "");
    EXPECT_TRUE(trip.report.copied);
    return trip.report.notes.empty() ? "" : trip.report.notes[0];
  };
  const auto nothing = [](Builder&) {};
  EXPECT_NE(noteOf(nothing, false, {}).find("is compressed with KHR_draco"), std::string::npos);
  ConvertOptions indices_only = withDecoders();
  indices_only.indices_only = true;
  EXPECT_NE(noteOf(nothing, false, indices_only).find("is compressed with KHR_draco"),
            std::string::npos);
  EXPECT_NE(noteOf(nothing, true, withDecoders()).find("have bytes of their own"),
            std::string::npos);
  EXPECT_NE(noteOf([](Builder& b) { b.json["accessors"][1]["count"] = 3; }, false, withDecoders())
                .find("different counts"),
            std::string::npos);
  EXPECT_NE(noteOf([](Builder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 5; }, false,
                   withDecoders())
                .find("not a triangle list"),
            std::string::npos);
  EXPECT_NE(noteOf([](Builder& b) { b.json["accessors"][3]["count"] = 3'000'000'000u; }, false,
                   withDecoders())
                .find("more vertices or triangles than its bytes can hold"),
            std::string::npos);
}

TEST(CodedMeshes, DamageIsAnErrorWithAPath) {
  const auto errorOf = [](const std::function<void(Json&)>& damage) {
    Builder builder;
    builder.addMesh({Sheet(24).addTo(builder)});
    codeMesh(builder, 0);
    damage(builder.json);
    return roundTrip(builder, withDecoders()).error;
  };
  const std::string path = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
  EXPECT_EQ(errorOf([](Json& j) { j["bufferViews"][4]["byteLength"] = 5000; }),
            path + ": is damaged");
  const auto extension = [](Json& j) -> Json& {
    return j["meshes"][0]["primitives"][0]["extensions"][kMeshName];
  };
  EXPECT_EQ(errorOf([&](Json& j) { extension(j)["bufferView"] = 99; }),
            path + "/bufferView: bufferView 99 does not exist or is itself compressed");
  EXPECT_EQ(errorOf([&](Json& j) { extension(j)["attributes"]["COLOR_0"] = 1; }),
            "/meshes/0/primitives/0/attributes/COLOR_0: must be the number of an accessor");
  EXPECT_EQ(errorOf([&](Json& j) { extension(j).erase("attributes"); }),
            path + ": \"attributes\" is missing or not an object");
  // Too few positions for the indices.
  EXPECT_EQ(errorOf([](Json& j) {
              for (size_t i = 0; i < 3; ++i) j["accessors"][i]["count"] = 9;
            }),
            path + ": has an index that its accessor cannot hold");
}

TEST(CodedViews, IndicesOnlyWorksBesideQuantization) {
  Builder builder;
  const Sheet sheet(30);
  std::vector<int16_t> positions;
  std::vector<int8_t> normals;
  for (size_t i = 0; i < sheet.positions.size(); ++i) {
    positions.push_back(static_cast<int16_t>(32767 * sheet.positions[i]));
    normals.push_back(static_cast<int8_t>(127 * sheet.normals[i]));
    if (i % 3 == 2) positions.push_back(0);
    if (i % 3 == 2) normals.push_back(0);
  }
  const auto add = [&](const auto& values, int type, uint32_t stride) {
    const uint32_t view = builder.addView(bytesOf(values), stride);
    return builder.addAccessor({{"bufferView", view},
                                {"componentType", type},
                                {"count", sheet.count()},
                                {"type", "VEC3"},
                                {"normalized", true}});
  };
  const uint32_t position = add(positions, kShort, 8);
  const uint32_t normal = add(normals, kByte, 4);
  builder.json["accessors"][position]["min"] = {0, 0, -32767};
  builder.json["accessors"][position]["max"] = {32767, 32767, 32767};
  builder.addMesh({{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                    {"indices", builder.addIndices(sheet.indices)}}});
  builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  for (const bool keeps_order : {false, true}) {
    ConvertOptions options;
    options.indices_only = true;
    options.keep_vertex_order = keeps_order;
    const RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_EQ(jsonOf(trip.decoded)["extensionsRequired"], Json::array({"KHR_mesh_quantization"}));
    for (const uint32_t accessor : {position, normal}) {
      EXPECT_EQ(elementsOf(trip.source, accessor), elementsOf(trip.decoded, accessor));
      EXPECT_EQ(elementsInOrder(trip.source, accessor) == elementsInOrder(trip.decoded, accessor),
                keeps_order);
    }
  }
}

}  // namespace
}  // namespace mcc::gltf::test
