// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// decode --decode-to integers: a renderer shows the same as with the decoded floats.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf/round_trip.h"
#include "gltf/scene_positions.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

struct BothDecodes {
  RoundTrip trip;
  std::vector<uint8_t> integers;
  Json json;  ///< the JSON of `integers`
  std::vector<std::string> notes;
};

/// Converts, decodes both ways, and compares what is shown.
BothDecodes decodeBoth(const Builder& builder, ConvertOptions options = {}) {
  BothDecodes both;
  options.allow_larger = true;
  both.trip = roundTrip(builder, options);
  EXPECT_EQ(both.trip.error, "");
  DecodeReport report;
  const Result result =
      decodeGlb(both.trip.converted, both.integers, report, {DecodeTo::kIntegers});
  EXPECT_TRUE(result.ok()) << result.message();
  both.notes = report.notes;
  both.json = jsonOf(both.integers);
  const SceneDifference difference = compareScenes(both.trip.decoded, both.integers);
  EXPECT_GE(difference.off, 0);
  EXPECT_LE(difference.off, 1e-6 * difference.largest);
  return both;
}

bool bothHaveNote(const BothDecodes& both, const std::string& text) {
  return std::any_of(both.notes.begin(), both.notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

const Json& accessorOf(const BothDecodes& both, const Json& number) {
  return both.json["accessors"][number.get<size_t>()];
}

std::vector<double> numbersOf(const std::vector<uint8_t>& file, uint32_t accessor) {
  Document document;
  if (!loadDocument(file, nullptr, document).ok()) return {};
  return SceneReader::numbers(document, accessor);
}

double largestDifference(const BothDecodes& both, uint32_t accessor) {
  const std::vector<double> a = numbersOf(both.trip.decoded, accessor);
  const std::vector<double> b = numbersOf(both.integers, accessor);
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

/// Joints and weights of 4 * set_count influences that add up to one.
void addSkin(Builder& builder, const Sheet& sheet, size_t set_count, Json& primitive) {
  for (size_t set = 0; set < set_count; ++set) {
    std::vector<float> weights;
    std::vector<uint8_t> joints;
    for (uint32_t i = 0; i < sheet.count(); ++i) {
      const float a =
          (0.37f + 0.0005f * static_cast<float>(i % 997)) / static_cast<float>(set_count);
      const float b = (1.0f / static_cast<float>(set_count) - a) * 0.61f;
      weights.insert(weights.end(), {a, b, 1.0f / static_cast<float>(set_count) - a - b, 0});
      joints.insert(joints.end(), {0, 1, static_cast<uint8_t>(2 * set / set_count), 0});
    }
    const std::string n = std::to_string(set);
    primitive["attributes"]["WEIGHTS_" + n] = builder.addFloats(weights, 4);
    primitive["attributes"]["JOINTS_" + n] =
        builder.addAccessor(joints, kUnsignedByte, "VEC4", sheet.count());
  }
}

/// Adds two joints, children of a rotated root, and a skin; returns its number.
uint32_t addJoints(Builder& builder, bool has_matrices) {
  Json& nodes = builder.json["nodes"];
  const size_t first = nodes.size();
  nodes.push_back({{"translation", {0.5, 1, -2}}, {"children", {first + 1}}});
  nodes.push_back({{"rotation", {0.6, 0, 0, 0.8}}, {"scale", {1.5, 2, 1}}});
  builder.json["scenes"][0]["nodes"].push_back(first);
  Json skin = {{"joints", {first, first + 1}}};
  if (has_matrices) {
    std::vector<float> matrices(32, 0.0f);
    for (size_t i = 0; i < 2; ++i) {
      for (size_t k = 0; k < 4; ++k) matrices[16 * i + 5 * k] = 1;
      matrices[16 * i + 4] = 0.25f;
      matrices[16 * i + 12] = -0.75f;
      matrices[16 * i + 14] = static_cast<float>(i);
    }
    skin["inverseBindMatrices"] = builder.addAccessor(matrices, kFloat, "MAT4", 2);
  }
  builder.json["skins"].push_back(skin);
  return static_cast<uint32_t>(builder.json["skins"].size() - 1);
}

TEST(Integers, AttributesGetTheSmallestTypeOfTheirGrid) {
  Builder builder;
  const Sheet sheet(20);
  Json primitive = sheet.addTo(builder);
  std::vector<float> colors, tangents;
  for (uint32_t i = 0; i < sheet.count(); ++i) {
    colors.insert(colors.end(), {0, 1, static_cast<float>(i % 256) / 255.0f});
    const float angle = 0.01f * static_cast<float>(i);
    tangents.insert(tangents.end(),
                    {std::cos(angle), std::sin(angle), 0, i % 3 == 0 ? -1.0f : 1.0f});
  }
  Json& attributes = primitive["attributes"];
  attributes["COLOR_0"] = builder.addFloats(colors, 3);
  attributes["TANGENT"] = builder.addFloats(tangents, 4);
  builder.addMesh({primitive});
  const BothDecodes both = decodeBoth(builder);
  EXPECT_EQ(both.notes, std::vector<std::string>{});
  const auto type = [&](const char* name) {
    const Json& accessor = accessorOf(both, attributes[name]);
    return std::pair(accessor["componentType"].get<int>(), accessor.contains("normalized"));
  };
  EXPECT_EQ(type("POSITION"), std::pair(kUnsignedShort, false));
  EXPECT_EQ(type("NORMAL"), std::pair(kShort, true));
  EXPECT_EQ(type("TANGENT"), std::pair(kShort, true));
  EXPECT_EQ(type("TEXCOORD_0"), std::pair(kUnsignedShort, true));
  EXPECT_EQ(type("COLOR_0"), std::pair(kUnsignedByte, true));
  EXPECT_LE(largestDifference(both, attributes["NORMAL"]), 0.5 / 32767 + 1e-6);
  EXPECT_LE(largestDifference(both, attributes["TANGENT"]), 0.5 / 32767 + 1e-6);
  EXPECT_LE(largestDifference(both, attributes["TEXCOORD_0"]), 0.5 / 65535 + 1e-6);
  EXPECT_LE(largestDifference(both, attributes["COLOR_0"]), 1e-7) << "colours lie on 1/255";
  EXPECT_EQ(both.json["extensionsRequired"], Json::array({"KHR_mesh_quantization"}));
  EXPECT_LT(both.integers.size() * 10, both.trip.decoded.size() * 7);

  ConvertOptions coarse;
  static_cast<QuantizationBits&>(coarse) = {.position_bits = 8,
                                            .normal_bits = 8,
                                            .texcoord_bits = 8,
                                            .color_bits = 8,
                                            .tangent_bits = 8,
                                            .weight_bits = 8};
  const BothDecodes small = decodeBoth(builder, coarse);
  EXPECT_EQ(accessorOf(small, attributes["POSITION"])["componentType"], kUnsignedByte);
  EXPECT_EQ(accessorOf(small, attributes["NORMAL"])["componentType"], kByte);
  EXPECT_EQ(accessorOf(small, attributes["TANGENT"])["componentType"], kByte);

  ConvertOptions fine;
  static_cast<QuantizationBits&>(fine) = {.position_bits = 17,
                                          .normal_bits = 16,
                                          .texcoord_bits = 17,
                                          .color_bits = 17,
                                          .tangent_bits = 16,
                                          .weight_bits = 17};
  const BothDecodes large = decodeBoth(builder, fine);
  EXPECT_EQ(accessorOf(large, attributes["POSITION"])["componentType"], kFloat);
  EXPECT_EQ(accessorOf(large, attributes["NORMAL"])["componentType"], kShort);
  EXPECT_EQ(accessorOf(large, attributes["TEXCOORD_0"])["componentType"], kFloat);
  EXPECT_EQ(accessorOf(large, attributes["COLOR_0"])["componentType"], kFloat);
  EXPECT_TRUE(bothHaveNote(large, "/meshes/0: its lattice has more than 16 bits"));
  EXPECT_TRUE(bothHaveNote(large, "TEXCOORD_0 has finer steps than 16 bits can hold"));

  ConvertOptions lossless;
  lossless.lossless = true;
  const BothDecodes exact = decodeBoth(builder, lossless);
  EXPECT_EQ(exact.integers, exact.trip.decoded);
}

TEST(Integers, BoundsAreThoseOfTheIntegers) {
  Builder builder;
  const Json primitive = Sheet(20).addTo(builder);
  builder.addMesh({primitive});
  const BothDecodes both = decodeBoth(builder);
  const uint32_t position = primitive["attributes"]["POSITION"];
  const std::vector<double> values = numbersOf(both.integers, position);
  std::vector<double> low(3, 1e9), high(3, -1e9);
  for (size_t i = 0; i < values.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], values[i]);
    high[i % 3] = std::max(high[i % 3], values[i]);
  }
  EXPECT_EQ(both.json["accessors"][position]["min"],
            Json(std::vector<int>(low.begin(), low.end())));
  EXPECT_EQ(both.json["accessors"][position]["max"],
            Json(std::vector<int>(high.begin(), high.end())));
}

/// Two nodes with one mesh, children, a matrix, animated morph weights.
Builder busyNodes() {
  Builder builder;
  const Sheet sheet(20);
  Sheet other(12, 0.3f);
  for (float& x : other.positions) x = 5 * x - 7;
  Json primitive = sheet.addTo(builder);
  Json second = other.addTo(builder);
  const auto deltas = [](const Sheet& of, float size) {
    std::vector<float> values(of.positions.size(), 0.0f);
    for (size_t i = 0; i < values.size(); i += 15)
      values[i] = size * static_cast<float>(i % 7) - 0.02f;
    return values;
  };
  primitive["targets"] = {{{"POSITION", builder.addPositions(deltas(sheet, 0.01f))}},
                          {{"NORMAL", builder.addFloats(deltas(sheet, 0.03f), 3)}}};
  second["targets"] = {{{"POSITION", builder.addPositions(deltas(other, 0.3f))}},
                       {{"NORMAL", builder.addFloats(deltas(other, 0.5f), 3)}}};
  builder.addMesh({primitive, second});
  Json& nodes = builder.json["nodes"];
  nodes[0]["translation"] = {1, 2, 3};
  nodes[0]["rotation"] = {0, 0.6, 0, 0.8};
  nodes[0]["scale"] = {2, 3, 0.5};
  nodes[0]["children"] = {1};
  nodes[0]["weights"] = {0.25, 0.5};
  nodes[0]["name"] = "first";
  nodes.push_back({{"mesh", 0}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 9, 8, 7, 1}}});
  const uint32_t times = builder.addFloats({0, 1}, 1);
  const uint32_t weights = builder.addFloats({0, 0, 1, 1}, 1);
  const uint32_t places = builder.addFloats({0, 0, 0, 1, 1, 1}, 3);
  builder.json["accessors"][times]["min"] = {0};
  builder.json["accessors"][times]["max"] = {1};
  builder.json["animations"] = {
      {{"channels",
        {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
         {{"sampler", 1}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
       {"samplers",
        {{{"input", times}, {"output", weights}}, {{"input", times}, {"output", places}}}}}};
  return builder;
}

TEST(Integers, NewChildrenCarryTheLattice) {
  const BothDecodes both = decodeBoth(busyNodes());
  const Json& nodes = both.json["nodes"];
  ASSERT_EQ(nodes.size(), 4u);
  EXPECT_FALSE(nodes[0].contains("mesh"));
  EXPECT_FALSE(nodes[0].contains("weights"));
  EXPECT_EQ(nodes[0]["children"], Json({1, 2}));
  EXPECT_EQ(nodes[2]["weights"], Json({0.25, 0.5}));
  EXPECT_EQ(nodes[1]["children"], Json::array({3}));
  const Json& channels = both.json["animations"][0]["channels"];
  EXPECT_EQ(channels[0]["target"]["node"], 2);
  EXPECT_EQ(channels[1]["target"]["node"], 0);
  const Json& target = both.json["meshes"][0]["primitives"][1]["targets"];
  EXPECT_EQ(accessorOf(both, target[0]["POSITION"])["componentType"], kShort);
  EXPECT_EQ(accessorOf(both, target[1]["NORMAL"])["componentType"], kFloat);  // up to 3
  EXPECT_TRUE(bothHaveNote(both, "target NORMAL has values outside -1 to 1"));
}

TEST(Integers, SkinsCarryTheLattice) {
  for (const size_t set_count : {1u, 2u}) {
    for (const bool has_matrices : {false, true}) {
      Builder builder;
      const Sheet sheet(20);
      Sheet large(20);
      for (float& x : large.positions) x = 3 * x + 1;
      for (const Sheet& one : {sheet, large, sheet}) {  // two lattices, and one mesh twice
        Json primitive = one.addTo(builder);
        addSkin(builder, one, set_count, primitive);
        builder.addMesh({primitive});
      }
      const uint32_t skin = addJoints(builder, has_matrices);
      for (size_t node = 0; node < 3; ++node) builder.json["nodes"][node]["skin"] = skin;
      const BothDecodes both = decodeBoth(builder);
      EXPECT_EQ(both.notes, std::vector<std::string>{});
      EXPECT_EQ(both.json["nodes"].size(), 5u) << "skinned nodes need no child";
      EXPECT_EQ(both.json["skins"].size(), 2u);
      EXPECT_EQ(both.json["nodes"][0]["skin"], both.json["nodes"][2]["skin"]);
      const Json& attributes = both.json["meshes"][0]["primitives"][0]["attributes"];
      std::vector<double> sums(sheet.count(), 0.0);
      for (size_t set = 0; set < set_count; ++set) {
        const uint32_t weights = attributes["WEIGHTS_" + std::to_string(set)];
        EXPECT_EQ(both.json["accessors"][weights]["componentType"], kUnsignedShort);
        EXPECT_LE(largestDifference(both, weights), 1.0 / 65535 + 1e-6);
        const std::vector<double> values = numbersOf(both.integers, weights);
        for (size_t i = 0; i < values.size(); ++i) sums[i / 4] += std::round(65535 * values[i]);
      }
      EXPECT_EQ(sums, std::vector<double>(sheet.count(), 65535.0));
    }
  }
}

/// Another mesh or skin that needs the old matrices keeps them.
TEST(Integers, MatricesOfOthersStay) {
  Builder builder;
  const Sheet sheet(20);
  for (size_t i = 0; i < 2; ++i) {
    Json primitive = sheet.addTo(builder);
    addSkin(builder, sheet, 1, primitive);
    builder.addMesh({primitive});
  }
  const float nan = std::nanf("");
  std::vector<float> broken = sheet.positions;
  broken[0] = nan;
  const uint32_t position = builder.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"];
  std::memcpy(&builder.bin[builder.json["bufferViews"][position]["byteOffset"]], broken.data(), 4);
  const uint32_t skin = addJoints(builder, true);
  builder.json["skins"].push_back(builder.json["skins"][skin]);
  builder.json["nodes"][0]["skin"] = 0;
  builder.json["nodes"][1]["skin"] = 1;
  const uint32_t matrices = builder.json["skins"][0]["inverseBindMatrices"];
  ConvertOptions options;
  options.allow_larger = true;
  const RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  std::vector<uint8_t> integers;
  DecodeReport report;
  ASSERT_TRUE(decodeGlb(trip.converted, integers, report, {DecodeTo::kIntegers}).ok());
  const Json json = jsonOf(integers);
  EXPECT_NE(json["skins"][0]["inverseBindMatrices"], matrices);
  EXPECT_EQ(json["skins"][1]["inverseBindMatrices"], matrices);
  EXPECT_EQ(elementsInOrder(trip.source, matrices), elementsInOrder(integers, matrices));
}

TEST(Integers, WhatCannotMoveStaysFloat) {
  const auto noteOf = [](const std::function<void(Builder&)>& change) {
    Builder builder;
    builder.addMesh({Sheet(20).addTo(builder), Sheet(12).addTo(builder)});
    change(builder);
    const BothDecodes both = decodeBoth(builder);
    const Json& primitive = both.json["meshes"][0]["primitives"][0];
    EXPECT_EQ(accessorOf(both, primitive["attributes"]["POSITION"])["componentType"], kFloat);
    EXPECT_EQ(accessorOf(both, primitive["attributes"]["NORMAL"])["componentType"], kShort);
    for (const std::string& note : both.notes) {
      if (note.starts_with("/meshes/0: ")) return note;
    }
    return std::string();
  };
  const auto extension = [](const char* name) {
    return [name](Builder& b) {
      b.json["extensionsUsed"] = {name};
      b.json["nodes"][0]["extensions"][name] = Json::object();
    };
  };
  EXPECT_NE(noteOf(extension("EXT_mesh_gpu_instancing")).find("has the extension EXT_mesh_gpu"),
            std::string::npos);
  for (const std::string name : {"ACME_clicks", "KHR_animation_pointer", "MSFT_lod", "VRM",
                                 "VRMC_node_constraint", "VRMC_springBone", "VRMC_vrm"}) {
    EXPECT_NE(noteOf(extension(name.c_str())).find(name + " may refer"), std::string::npos) << name;
  }
  EXPECT_NE(noteOf([](Builder& b) { b.json["nodes"][0].erase("mesh"); }).find("no node shows it"),
            std::string::npos);
  EXPECT_NE(
      noteOf([](Builder& b) {  // points that use them, too, and are not in a payload
        Json points = {{"attributes", {{"POSITION", b.addPositions({0, 0, 0})}}}, {"mode", 0}};
        b.json["meshes"][0]["primitives"].push_back(points);
      })
          .find("not all of its primitives are on a lattice"),
      std::string::npos);
  EXPECT_NE(noteOf([](Builder& b) {  // another mesh with the same positions, and points
              b.addMesh({b.json["meshes"][0]["primitives"][0],
                         {{"attributes", {{"POSITION", b.addPositions({0, 0, 0})}}}, {"mode", 0}}});
            })
                .find("shares positions with a mesh"),
            std::string::npos);
}

TEST(Integers, LightsAndNodesBesideStay) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const BothDecodes both = decodeBoth(builder);
  EXPECT_TRUE(both.json["nodes"][0]["extensions"].contains("KHR_lights_punctual"));
  EXPECT_EQ(both.json["nodes"][1]["mesh"], 0);
}

TEST(Integers, ValidatorHasNoObjection) {
  const std::string missing = mcc::test::Validator::whyNot();
  if (!missing.empty()) GTEST_SKIP() << missing;
  const mcc::test::ScratchFolder folder;
  mcc::test::Validator validator(folder.path());
  const auto add = [&](const std::string& name, const Builder& builder) {
    const BothDecodes both = decodeBoth(builder);
    validator.add(name, both.trip.source, both.trip.converted, both.integers);
  };
  add("nodes", busyNodes());
  Builder builder;
  const Sheet sheet(20);
  Json primitive = sheet.addTo(builder);
  addSkin(builder, sheet, 2, primitive);
  builder.addMesh({primitive});
  builder.json["nodes"][0]["skin"] = addJoints(builder, true);
  add("skin", builder);
  EXPECT_TRUE(validator.run()) << "the lines above name what is new";
}

}  // namespace
}  // namespace mcc::gltf::test
