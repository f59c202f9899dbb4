// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Everything except mesh geometry is preserved: extras and unknown extensions on every object, odd
// numbers, images, animations, instances.
#include <gtest/gtest.h>

#include <functional>

#include "gltf/check/compare.h"
#include "gltf/round_trip.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

constexpr char kUnknown[] = "ACME_everything";

Json strangeThings() {
  Json strange;
  const Result parsed = parseJson(
      asBytes(
          R"({"big":12345678901234567890123,"tiny":1e-7,"neg":-0,"none":null,"empty":{},"no":[],)"
          R"("list":[[],{},null,[null]],"long":0.10000000000000000555,"int":-5000000000,)"
          R"("s":"\u0001\ud83d\ude00 \" \\","":"no key","true":true})"),
      strange);
  return parsed.ok() ? strange : Json();
}

/// A document that uses every object of glTF 2.0.
Builder fullDocument() {
  Builder builder;
  Json& json = builder.json;
  const Sheet sheet(20);
  Json primitive = sheet.addTo(builder);
  primitive["material"] = 0;
  primitive["targets"] = {{{"POSITION", builder.addPositions(sheet.positions)}}};
  builder.addMesh({primitive});
  json["meshes"][0]["weights"] = {0.5};
  json["meshes"][0]["name"] = "née \u00fc";
  json["nodes"].push_back({{"camera", 0}, {"name", ""}, {"children", {2}}});
  json["nodes"].push_back({{"name", "joint"}});
  json["scenes"][0]["nodes"].push_back(1);
  json["scene"] = 0;
  const uint32_t image = builder.addView({0x89, 'P', 'N', 'G', 1, 2, 3});
  json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}},
                    {{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
  json["samplers"] = {{{"magFilter", 9729}}};
  json["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
  json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"normalTexture", {{"index", 1}, {"scale", 0.5}}},
                        {"occlusionTexture", {{"index", 1}, {"strength", 0.5}}}}};
  json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.01}}}},
                     {{"type", "orthographic"},
                      {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 10}, {"znear", 0.1}}}}};
  const uint32_t matrices = builder.addAccessor(std::vector<float>(16, 1), kFloat, "MAT4", 1);
  json["skins"] = {{{"joints", {2}}, {"inverseBindMatrices", matrices}}};
  const uint32_t times = builder.addFloats({0, 1}, 1);
  const uint32_t places = builder.addFloats({0, 0, 0, 1, 1, 1}, 3);
  json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", places}}}}}};
  const uint32_t instances = builder.addFloats({0, 0, 0, 5, 5, 5}, 3);
  json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      instances;
  const uint32_t sparse_index = builder.addView({1, 0, 0, 0});
  const uint32_t sparse_value = builder.addView(bytesOf(std::vector<float>{9}));
  builder.addAccessor(
      {{"componentType", kFloat},
       {"count", 4},
       {"type", "SCALAR"},
       {"sparse",
        {{"count", 1},
         {"indices", {{"bufferView", sparse_index}, {"componentType", kUnsignedShort}}},
         {"values", {{"bufferView", sparse_value}}}}}});
  json["asset"]["generator"] = "a test";
  json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  json["buffers"] = {{{"byteLength", builder.bin.size()}, {"name", "all"}}};
  return builder;
}

/// Visits every object that may have extras, with its path.
void visitObjects(Json& json, const std::string& path,
                  const std::function<void(Json&, const std::string&)>& visit) {
  const bool is_map = path.ends_with("/attributes") ||
                      path.find("/targets/") != std::string::npos || path.ends_with("/extensions");
  for (size_t i = 0; i < json.size(); ++i) {
    visitObjects(json[i], json.is_array() ? at(path, i) : at(path, json.keyAt(i)), visit);
  }
  if (json.is_object() && !is_map) visit(json, path);
}

/// Members in which a file with compressed or decoded geometry may differ from its source.
bool mayDiffer(const std::string& path) {
  static const std::set<std::string> kOfAccessors = {"bufferView", "byteOffset", "min", "max"};
  static const std::set<std::string> kOfViews = {"buffer", "byteOffset", "byteLength"};
  const std::string key = path.substr(path.rfind('/') + 1);
  if (path.starts_with("/accessors/")) return kOfAccessors.count(key) != 0;
  if (path.starts_with("/bufferViews/")) return kOfViews.count(key) != 0;
  return path == "/buffers/0/byteLength" || path == "/extensionsUsed" ||
         (path.starts_with("/images/") && key == "bufferView") ||
         path.ends_with("/indices/bufferView") || path.ends_with("/values/bufferView");
}

/// Checks that everything in `a` is in `b`.
void expectKept(const Json& a, const Json& b, const std::string& path) {
  if (mayDiffer(path)) return;
  ASSERT_EQ(a.kind(), b.kind()) << path;
  if (a.is_array()) {
    ASSERT_LE(a.size(), b.size()) << path;
    for (size_t i = 0; i < a.size(); ++i) expectKept(a[i], b[i], at(path, i));
  } else if (a.is_object()) {
    for (const auto& [key, value] : a.items()) {
      const Json* other = findMember(b, key);
      if (mayDiffer(at(path, key))) continue;
      ASSERT_NE(other, nullptr) << at(path, key);
      expectKept(value, *other, at(path, key));
    }
  } else {
    EXPECT_TRUE(a == b) << path;
  }
}

void expectBytesKept(const RoundTrip& trip, const std::set<uint32_t>& compressed) {
  Document source;
  ASSERT_TRUE(loadDocument(trip.source, nullptr, source).ok());
  for (const auto* file : {&trip.converted, &trip.decoded}) {
    Document document;
    ASSERT_TRUE(loadDocument(*file, nullptr, document).ok());
    for (uint32_t i = 0; i < source.accessors.size(); ++i) {
      if (compressed.count(i) == 0) {
        EXPECT_EQ(elementsInOrder(trip.source, i), elementsInOrder(*file, i)) << i;
      }
    }
    const uint32_t view = document.json["images"][0]["bufferView"];
    const BufferView& range = document.views[view];
    const auto image = document.buffers[range.buffer].subspan(range.offset, range.length);
    EXPECT_EQ(std::vector<uint8_t>(image.begin(), image.end()),
              (std::vector<uint8_t>{0x89, 'P', 'N', 'G', 1, 2, 3}));
  }
}

void expectSurvival(const Builder& builder, bool keeps_views) {
  const RoundTrip trip = roundTrip(fileOf(builder));
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  Json source = jsonOf(trip.source);
  if (!keeps_views) source.erase("bufferViews");  // the views of the geometry are removed
  expectKept(source, jsonOf(trip.converted), "");
  Json decoded_source = source;
  expectKept(decoded_source, jsonOf(trip.decoded), "");
  expectBytesKept(trip, {0, 1, 2, 3, 4});
}

TEST(EverythingElse, ExtrasOnEveryObject) {
  Builder builder = fullDocument();
  size_t count = 0;
  visitObjects(builder.json, "", [&](Json& object, const std::string& path) {
    if (path.starts_with("/accessors/") && path.find("/sparse") != std::string::npos) return;
    object["extras"] = strangeThings();
    ++count;
  });
  EXPECT_GT(count, 40u);
  expectSurvival(builder, false);
}

/// Expects all of them, except on the accessors and views of the geometry, whose meaning may
/// change.
TEST(EverythingElse, UnknownExtensionsOnEveryObject) {
  Builder builder = fullDocument();
  size_t count = 0;
  visitObjects(builder.json, "", [&](Json& object, const std::string& path) {
    for (const char* list : {"/accessors/", "/bufferViews/"}) {
      for (const char number : {'0', '1', '2', '3', '4'}) {
        if (path == std::string(list) + number) return;
      }
    }
    object["extensions"][kUnknown] = strangeThings();
    ++count;
  });
  EXPECT_GT(count, 30u);
  builder.json["extensionsUsed"].push_back(kUnknown);
  expectSurvival(builder, true);
}

TEST(EverythingElse, UnknownExtensionsOnGeometryLeaveItAlone) {
  for (const char* list : {"accessors", "bufferViews"}) {
    for (const size_t number : {0u, 3u}) {
      Builder builder = fullDocument();
      builder.json["extensionsUsed"].push_back(kUnknown);
      builder.json[list][number]["extensions"][kUnknown] = {{"cipher", "rot13"}};
      const RoundTrip trip = roundTrip(fileOf(builder));
      ASSERT_EQ(trip.error, "");
      EXPECT_TRUE(trip.report.copied);
      EXPECT_TRUE(hasNote(trip.report, "has the unknown extension ACME_everything"));
    }
  }
}

/// Things that count vertices or triangles keep their meaning.
TEST(EverythingElse, WhatNumbersVerticesKeepsTheOrder) {
  const auto keepsOrder = [](const std::function<void(Json&)>& change) {
    Builder builder;
    const Json sheet = Sheet(20).addTo(builder);
    builder.addMesh({sheet});
    change(builder.json);
    ConvertOptions options;
    options.lossless = true;
    const RoundTrip trip = roundTrip(builder, options);
    EXPECT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    const uint32_t position = sheet["attributes"]["POSITION"];
    return elementsInOrder(trip.source, position) == elementsInOrder(trip.decoded, position) &&
           elementsInOrder(trip.source, sheet["indices"]) ==
               elementsInOrder(trip.decoded, sheet["indices"]);
  };
  EXPECT_FALSE(keepsOrder([](Json&) {}));
  EXPECT_FALSE(keepsOrder([](Json& j) { j["meshes"][0]["extras"]["targetNames"] = {"a", "b"}; }));
  EXPECT_TRUE(keepsOrder([](Json& j) {
    j["meshes"][0]["extras"]["drawRanges"] = {{{"start", 0}, {"count", 300}}};
  }));
  EXPECT_TRUE(keepsOrder([](Json& j) {
    j["meshes"][0]["primitives"][0]["extras"]["editor"]["pinnedVertices"] = {1, 2};
  }));
  EXPECT_TRUE(keepsOrder([](Json& j) {
    j["extensionsUsed"] = {"EXT_mesh_features"};
    j["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_features"]["featureIds"] = {
        {{"featureCount", 441}}};  // the id of a vertex is its number
  }));
  EXPECT_TRUE(keepsOrder([](Json& j) {
    j["extensionsUsed"] = {"FB_ngon_encoding"};  // neighbouring triangles make polygons
    j["meshes"][0]["primitives"][0]["extensions"]["FB_ngon_encoding"] = Json::object();
  }));
}

/// Extensions whose objects count vertices, triangles or indices, according to their drafts.
std::vector<std::pair<const char*, Json>> countingExtensions() {
  return {
      {"EXT_mesh_features", {{"featureIds", {{{"featureCount", 441}}}}}},
      {"FB_ngon_encoding", Json::object()},
      {"KHR_draw_ranges",
       {{"ranges", {{{"first", 0}, {"count", 300}}, {{"first", 300}, {"count", 30}}}}}},
  };
}

/// The first of two meshes has such an object, on itself or on its primitive.
Builder countingDocument(const char* name, const Json& object, bool on_primitive) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  builder.addMesh({Sheet(24).addTo(builder)});
  builder.json["extensionsUsed"] = {name};
  Json& mesh = builder.json["meshes"][0];
  (on_primitive ? mesh["primitives"][0] : mesh)["extensions"][name] = object;
  return builder;
}

TEST(EverythingElse, WhatCountsIndicesKeepsThem) {
  ConvertOptions options;
  options.lossless = true;
  for (const auto& [name, object] : countingExtensions()) {
    for (const bool on_primitive : {false, true}) {
      SCOPED_TRACE(std::string(name) + (on_primitive ? " of a primitive" : " of a mesh"));
      const Builder builder = countingDocument(name, object, on_primitive);
      const RoundTrip trip = roundTrip(builder, options);
      ASSERT_EQ(trip.error, "");
      const Json json = jsonOf(trip.converted);
      EXPECT_TRUE(isCompressed(json, 0, 0));
      EXPECT_TRUE(isCompressed(json, 1, 0));
      const Json& mesh = json["meshes"][0];
      EXPECT_EQ((on_primitive ? mesh["primitives"][0] : mesh)["extensions"][name], object);
      const auto orderOf = [&](const std::vector<uint8_t>& file, uint32_t number) {
        const Json& primitive = builder.json["meshes"][number]["primitives"][0];
        return elementsInOrder(file, primitive["indices"]);
      };
      EXPECT_EQ(orderOf(trip.source, 0), orderOf(trip.decoded, 0));
      EXPECT_NE(orderOf(trip.source, 1), orderOf(trip.decoded, 1));
    }
  }
}

/// A strip becomes a list, in which the same numbers mean other triangles.
TEST(EverythingElse, WhatCountsTheIndicesOfAStripLeavesItAlone) {
  for (const auto& [name, object] : countingExtensions()) {
    for (const bool on_primitive : {false, true}) {
      for (const bool is_strip : {false, true}) {
        SCOPED_TRACE(name);
        Builder builder = countingDocument(name, object, on_primitive);
        Json& primitive = builder.json["meshes"][0]["primitives"][0];
        if (is_strip) primitive["mode"] = 5;
        if (!is_strip) primitive.erase("indices");
        const RoundTrip trip = roundTrip(builder);
        ASSERT_EQ(trip.error, "");
        EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 0, 0));
        EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 1, 0));
        EXPECT_TRUE(hasNote(trip.report, std::string("has ") + name + ", which may rely on"));
      }
    }
  }
}

TEST(EverythingElse, ValidatorHasNoObjectionToWhatCounts) {
  const std::string missing = mcc::test::Validator::whyNot();
  if (!missing.empty()) GTEST_SKIP() << missing;
  const mcc::test::ScratchFolder folder;
  mcc::test::Validator validator(folder.path());
  uint32_t number = 0;
  for (const auto& [name, object] : countingExtensions()) {
    for (const bool on_primitive : {false, true}) {
      const RoundTrip trip = roundTrip(countingDocument(name, object, on_primitive));
      ASSERT_EQ(trip.error, "");
      validator.add(std::to_string(number++), trip.source, trip.converted, trip.decoded);
    }
  }
  EXPECT_TRUE(validator.run()) << "the lines above name what is new";
}

/// Property tables lie in views that no accessor names.
TEST(EverythingElse, PropertyTablesKeepTheirViews) {
  Builder builder =
      countingDocument("EXT_structural_metadata", {{"propertyAttributes", {0}}}, true);
  const std::vector<uint8_t> table = {1, 2, 3, 4, 5, 6, 7, 8};
  const uint32_t view = builder.addView(table);
  builder.json["extensions"]["EXT_structural_metadata"] = {
      {"schema",
       {{"id", "s"}, {"classes", {{"c", {{"properties", {{"p", {{"type", "SCALAR"}}}}}}}}}}},
      {"propertyTables",
       {{{"class", "c"}, {"count", 8}, {"properties", {{"p", {{"values", view}}}}}}}}};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  for (const auto* file : {&trip.converted, &trip.decoded}) {
    Document document;
    ASSERT_TRUE(loadDocument(*file, nullptr, document).ok());
    const Json& root = document.json["extensions"]["EXT_structural_metadata"];
    const uint32_t values = root["propertyTables"][0]["properties"]["p"]["values"];
    const BufferView& kept = document.views[values];
    const auto bytes = document.buffers[kept.buffer].subspan(kept.offset, kept.length);
    EXPECT_EQ(std::vector<uint8_t>(bytes.begin(), bytes.end()), table);
  }
}

}  // namespace
}  // namespace mcc::gltf::test
