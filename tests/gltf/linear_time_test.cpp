// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Documents with very many of one thing. The work on them must be linear, up to a logarithm; at
// these sizes quadratic work would run into the timeout of the test.
#include <gtest/gtest.h>

#include "gltf/check/check_json.h"
#include "gltf/compress/compress.h"
#include "gltf/document/rebuild.h"
#include "gltf/round_trip.h"

namespace mcc::gltf::test {
namespace {

/// Accessors in a row in one view, each of as many bytes as `counts` says.
Builder accessorsInOneView(const std::vector<uint32_t>& counts) {
  Builder builder;
  uint32_t end = 0;
  Json accessors = Json::array();
  for (const uint32_t count : counts) {
    accessors.push_back({{"bufferView", 0},
                         {"byteOffset", end},
                         {"componentType", kUnsignedByte},
                         {"count", count},
                         {"type", "SCALAR"}});
    end += count;
  }
  builder.addView(std::vector<uint8_t>(end, 7));
  builder.json["accessors"] = std::move(accessors);
  return builder;
}

/// A payload that frees two accessors.
EncodedPayload payloadOver(uint32_t mesh, uint32_t a, uint32_t b, size_t bytes) {
  EncodedPayload payload;
  payload.plan.mesh = mesh;
  PiecePlan& piece = payload.plan.pieces.emplace_back();
  piece.parts.emplace_back().users.push_back({mesh, 0});
  for (const uint32_t accessor : {a, b}) {
    piece.attributes.emplace_back().name = accessor == a ? "POSITION" : "_B";
    piece.attributes.back().accessor = accessor;
  }
  payload.result.payload.resize(bytes);
  return payload;
}

TEST(LinearTime, LosersOfAChainOfPayloads) {
  // Each frees 600 bytes and costs more than 300, so it loses as soon as a neighbour does. The last
  // one gains what all others lose together.
  constexpr uint32_t kCount = 30000;
  std::vector<uint32_t> counts(kCount + 1, 300);
  counts.insert(counts.end(), {20000000, 1});
  const std::vector<uint8_t> file = accessorsInOneView(counts).toGlb();
  Document document;
  ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
  for (const bool first_loses : {true, false}) {
    std::vector<EncodedPayload> payloads;
    for (uint32_t i = 0; i < kCount; ++i) {
      payloads.push_back(payloadOver(i, i, i + 1, i == 0 && first_loses ? 700 : 300));
    }
    payloads.push_back(payloadOver(kCount, kCount + 1, kCount + 2, 300));
    std::vector<LeftAlone> left_alone;
    dropLosers(document, ForeignReferences{}, payloads, left_alone);
    EXPECT_EQ(payloads.size(), first_loses ? 1u : kCount + 1);
    EXPECT_EQ(left_alone.size(), first_loses ? kCount : 0u);
  }
}

TEST(LinearTime, PayloadsOfAMeshStayOrGoTogether) {
  Document document;
  const std::vector<uint8_t> file = accessorsInOneView({900, 900, 200, 200, 5000, 5000}).toGlb();
  ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
  const auto kept = [&](uint32_t second_mesh) {
    std::vector<EncodedPayload> payloads;
    payloads.push_back(payloadOver(0, 0, 1, 100));
    payloads.push_back(payloadOver(second_mesh, 2, 3, 800));
    payloads.push_back(payloadOver(2, 4, 5, 100));
    std::vector<LeftAlone> left_alone;
    dropLosers(document, ForeignReferences{}, payloads, left_alone);
    return payloads.size();
  };
  EXPECT_EQ(kept(1), 2u);
  EXPECT_EQ(kept(0), 3u);
}

TEST(LinearTime, KeysOfOneObject) {
  Json a = Json::object();
  for (uint32_t i = 0; i < 200000; ++i) {
    a.get_ref<Json::object_t&>().emplace_back("key " + std::to_string(i), i);
  }
  Json b = Json::object();
  for (uint32_t i = 200000; i-- > 0;) {
    b.get_ref<Json::object_t&>().emplace_back("key " + std::to_string(i), i);
  }
  EXPECT_EQ(firstDifference(a, b), "");
  b.get_ref<Json::object_t&>().front().second = 0;
  EXPECT_EQ(firstDifference(a, b), "/key 199999");
  Json parsed;
  EXPECT_TRUE(parseJson(asBytes(printJson(a)), parsed).ok());
}

TEST(LinearTime, AccessorsOfOneView) {
  const std::vector<uint8_t> file = accessorsInOneView(std::vector<uint32_t>(100000, 1)).toGlb();
  Document document;
  ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
  Json json = document.json;
  std::vector<NewView> no_views;
  std::vector<uint8_t> bin;
  ASSERT_TRUE(rebuildBuffers(document, {}, no_views, json, bin).ok());
  EXPECT_EQ(bin.size(), 100000u);
  EXPECT_EQ(json["accessors"][99999]["byteOffset"], 99999);
}

TEST(LinearTime, PrimitivesThatDrawOnePart) {
  Builder builder;
  const Sheet sheet(100);
  builder.addMesh(std::vector<Json>(30000, sheet.addTo(builder)));
  const std::vector<uint8_t> file = builder.toGlb();
  Document document;
  ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
  std::vector<PayloadPlan> plans;
  std::vector<LeftAlone> left_alone;
  ASSERT_TRUE(planPayloads(document, plans, left_alone).ok());
  ASSERT_EQ(plans.size(), 1u);
  ASSERT_EQ(plans[0].pieces.size(), 1u);
  ASSERT_EQ(plans[0].pieces[0].parts.size(), 1u);
  EXPECT_EQ(plans[0].pieces[0].parts[0].users.size(), 30000u);
}

TEST(LinearTime, TinyPrimitivesBesideALargeOne) {
  Builder builder;
  std::vector<Json> primitives = {Sheet(250).addTo(builder)};
  for (uint32_t i = 0; i < 1000; ++i) {
    const float x = 2 + static_cast<float>(i);
    const float y = i == 500 ? 1 : 0.5f;
    primitives.push_back(
        {{"attributes",
          {{"POSITION", builder.addPositions({x, 0, 0, x + .25f, y, 0, x, .5f, 1})}}}});
  }
  primitives[1]["attributes"]["POSITION"] = builder.addPositions({0, 0, 0, 2, 2, 2, 3, 2, 2});
  builder.addMesh(primitives);
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(json, 0, 0));
  EXPECT_TRUE(isCompressed(json, 0, 1)) << "it has a corner of the large one";
  for (uint32_t i = 2; i <= 1000; ++i) EXPECT_FALSE(isCompressed(json, 0, i)) << i;
}

/// Decoding to integers gives every node a child, skins of their own and other targets of
/// animations.
TEST(LinearTime, NodesOfAnAnimatedMeshBecomeIntegers) {
  constexpr uint32_t kCount = 20000;
  Builder builder;
  const Sheet sheet(20);
  Json primitive = sheet.addTo(builder);
  primitive["targets"] = {{{"POSITION", builder.addPositions(sheet.positions)}}};
  builder.addMesh({primitive});
  Json nodes = Json::array();
  Json channels = Json::array();
  Json scene = Json::array();
  for (uint32_t i = 0; i < kCount; ++i) {
    nodes.push_back({{"mesh", 0}});
    channels.push_back({{"sampler", 0}, {"target", {{"node", i}, {"path", "weights"}}}});
    scene.push_back(i);
  }
  builder.json["nodes"] = std::move(nodes);
  builder.json["scenes"] = {{{"nodes", std::move(scene)}}};
  const Json sampler = {{"input", builder.addFloats({0, 1}, 1)},
                        {"output", builder.addFloats({0, 1}, 1)}};
  builder.json["animations"] = {{{"channels", std::move(channels)}, {"samplers", {sampler}}}};
  ConvertOptions options;
  options.allow_larger = true;
  std::vector<uint8_t> converted;
  ConvertReport converted_report;
  ASSERT_TRUE(convertGlb(builder.toGlb(), options, converted, converted_report).ok());
  std::vector<uint8_t> integers;
  DecodeReport report;
  ASSERT_TRUE(decodeGlb(converted, integers, report, {DecodeTo::kIntegers}).ok());
  const Json json = jsonOf(integers);
  ASSERT_EQ(json["nodes"].size(), 2 * kCount);
  for (uint32_t i = 0; i < kCount; ++i) {
    const Json& node = json["animations"][0]["channels"][i]["target"]["node"];
    ASSERT_EQ(json["nodes"][i]["children"][0], node);
    ASSERT_EQ(json["nodes"][node.get<size_t>()]["mesh"], 0);
  }
}

}  // namespace
}  // namespace mcc::gltf::test
