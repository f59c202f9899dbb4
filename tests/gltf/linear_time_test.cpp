// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Documents with very many of one thing. The work on them must be linear, up to a logarithm; at
// these sizes quadratic work would run into the timeout of the test. tools/check/growth documents
// measures such documents.
#include <gtest/gtest.h>

#include "gltf/check/compare.h"
#include "gltf/compress/savings.h"
#include "gltf/document/layout.h"
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
    dropLosers(document, payloads, left_alone);
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
    dropLosers(document, payloads, left_alone);
    return payloads.size();
  };
  EXPECT_EQ(kept(1), 2u);
  EXPECT_EQ(kept(0), 3u);
}

TEST(LinearTime, KeysOfOneObject) {
  Json a = Json::object();
  for (uint32_t i = 0; i < 200000; ++i) {
    a.append("key " + std::to_string(i), i);
  }
  Json b = Json::object();
  for (uint32_t i = 200000; i-- > 0;) {
    b.append("key " + std::to_string(i), i);
  }
  EXPECT_EQ(firstDifference(a, b), "");
  b[0] = 0;
  EXPECT_EQ(firstDifference(a, b), "/key 199999");
  Json parsed;
  EXPECT_TRUE(parseJson(asBytes(printJson(a)), parsed).ok());
}

TEST(LinearTime, AccessorsOfOneView) {
  const std::vector<uint8_t> file = accessorsInOneView(std::vector<uint32_t>(100000, 1)).toGlb();
  Document document;
  ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
  Json json = document.json;
  EXPECT_EQ(layOut(document, {}, json).byte_count, 100000u);
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

// ---- Documents that name the same bytes again and again

/// The members of the root come before all accessors, and are looked up no more often for those.
TEST(LinearTime, MembersOfTheRootLarge) {
  constexpr uint32_t kCount = 40000;
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  const std::string rest = printJson(builder.json);
  std::string text = "{";
  for (uint32_t i = 0; i < kCount; ++i) text += "\"" + std::to_string(100000000 + i) + "\":0,";
  text += "\"buffers\":[{\"byteLength\":" + std::to_string(builder.bin.size()) + "}],";
  text += rest.substr(1);
  std::string accessors = "\"accessors\":[";
  for (uint32_t i = 0; i < kCount; ++i) {
    accessors += R"({"bufferView":0,"componentType":5121,"count":1,"type":"SCALAR"},)";
  }
  // The ones of the mesh keep their numbers.
  const size_t end = text.find("],\"meshes\"");
  ASSERT_NE(end, std::string::npos);
  accessors.pop_back();
  text.insert(end, "," + accessors.substr(accessors.find('[') + 1));
  std::vector<uint8_t> file;
  ASSERT_TRUE(writeGlb(text, builder.bin, {}, file).ok());
  const RoundTrip trip = roundTrip(file);
  ASSERT_EQ(trip.error, "");
  ASSERT_EQ(trip.report.payloads.size(), 1u);
  ValidationReport report;
  ASSERT_EQ(validateGlb(trip.converted, {}, report).message(), "");
  EXPECT_TRUE(report.isValid());
}

/// Each of the primitives has almost all of the vertices.
TEST(LinearTime, PiecesOverTheSameBytesAreHeldSixteenTimes) {
  constexpr uint32_t kPieces = 2000;
  constexpr uint32_t kVertices = 90000;
  Builder builder;
  const uint32_t view =
      builder.addView(bytesOf(std::vector<float>(3 * (kVertices + kPieces), 1.0f)));
  std::vector<Json> primitives;
  for (uint32_t i = 0; i < kPieces; ++i) {
    primitives.push_back({{"attributes",
                           {{"POSITION", builder.addAccessor({{"bufferView", view},
                                                              {"byteOffset", 12 * i},
                                                              {"componentType", kFloat},
                                                              {"count", kVertices},
                                                              {"type", "VEC3"}})}}}});
  }
  builder.addMesh(primitives);
  const std::vector<uint8_t> file = builder.toGlb();
  Document document;
  ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
  document.decoded = DecodedBytes(0, document.source_bytes);
  std::vector<PayloadPlan> plans;
  std::vector<LeftAlone> left_alone;
  ASSERT_TRUE(planPayloads(document, plans, left_alone).ok());
  ASSERT_EQ(plans.size(), 1u);
  const uint64_t held = plans[0].pieces.size() * uint64_t{kVertices} * (12 + 4);
  EXPECT_LE(held, kMaxSharing * file.size() + document.decoded.zeroLimit());
  EXPECT_GE(plans[0].pieces.size(), 8u);
  EXPECT_EQ(left_alone.size() + plans[0].pieces.size(), kPieces);
  EXPECT_NE(left_alone[0].note.find("shares its bytes with so many others"), std::string::npos);
}

/// Each index accessor has almost all of the indices.
TEST(LinearTime, IndicesOverTheSameBytesAreHeldSixteenTimes) {
  constexpr uint32_t kParts = 5000;
  constexpr uint32_t kIndices = 300000;
  Builder builder;
  const uint32_t view = builder.addView(std::vector<uint8_t>(kIndices + 3 * kParts, 1));
  const Json attributes = {{"POSITION", builder.addPositions(Sheet(1).positions)}};
  std::vector<Json> primitives;
  for (uint32_t i = 0; i < kParts; ++i) {
    primitives.push_back({{"attributes", attributes},
                          {"indices", builder.addAccessor({{"bufferView", view},
                                                           {"byteOffset", 3 * i},
                                                           {"componentType", kUnsignedByte},
                                                           {"count", kIndices},
                                                           {"type", "SCALAR"}})}});
  }
  builder.addMesh(primitives);
  const std::vector<uint8_t> file = builder.toGlb();
  Document document;
  ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
  document.decoded = DecodedBytes(0, document.source_bytes);
  std::vector<PayloadPlan> plans;
  std::vector<LeftAlone> left_alone;
  ASSERT_TRUE(planPayloads(document, plans, left_alone).ok());
  const size_t parts = plans[0].pieces[0].parts.size();
  EXPECT_LE(parts * kIndices * 4, kMaxSharing * file.size() + document.decoded.zeroLimit());
  EXPECT_GE(parts, 8u);
}

/// Payload k frees the bytes of all later ones.
TEST(LinearTime, OwnersOfAPileOfPayloads) {
  constexpr uint32_t kCount = 40000;
  Builder builder;
  const uint32_t view = builder.addView(std::vector<uint8_t>(4 * kCount, 7));
  Json accessors = Json::array();
  for (uint32_t i = 0; i < kCount; ++i) {
    accessors.push_back({{"bufferView", view},
                         {"byteOffset", i},
                         {"componentType", kUnsignedByte},
                         {"count", 4 * kCount - 2 * i},
                         {"type", "SCALAR"}});
  }
  builder.json["accessors"] = std::move(accessors);
  const std::vector<uint8_t> file = builder.toGlb();
  Document document;
  ASSERT_TRUE(loadDocument(file, nullptr, document).ok());
  std::vector<EncodedPayload> payloads;
  for (uint32_t i = 0; i < kCount; ++i) payloads.push_back(payloadOver(i, i, i, 1));
  countFreedBytes(document, payloads);
  EXPECT_EQ(payloads[0].freed_bytes, 128u);  // at both ends there are at most 64 owners
  EXPECT_EQ(payloads[63].freed_bytes, 2u);
  EXPECT_EQ(payloads[64].freed_bytes, 0u);
}

TEST(LinearTime, BytesThatManyNameAreComparedOnce) {
  constexpr uint32_t kBytes = 20000000;
  std::vector<uint8_t> a(kBytes, 5);
  std::vector<uint8_t> b(kBytes + 8, 5);
  Document source, result;
  source.buffers = {a};
  result.buffers = {b};
  const auto difference = [&](uint64_t moved_by) {
    SameBytes bytes(source, result);
    for (uint32_t i = 0; i < 100000; ++i) {
      bytes.add({0, i, kBytes - i}, {0, i + moved_by, kBytes - i + moved_by}, 100000 - i);
    }
    return bytes.firstDifference();
  };
  EXPECT_EQ(difference(0), SameBytes::kNothing);
  EXPECT_EQ(difference(8), SameBytes::kNothing);
  b[60000] = 6;  // only in those that begin before it
  EXPECT_EQ(difference(0), 100000u - 60000u);
  EXPECT_EQ(difference(8), 100000u - 59992u);
  b[kBytes / 2] = 7;
  EXPECT_EQ(difference(0), 1u);
  b[60000] = 5;
  b[0] = 7;
  b[kBytes / 2] = 5;
  EXPECT_EQ(difference(0), 100000u);
  SameBytes lengths(source, result);
  lengths.add({0, 5, 9}, {0, 5, 8}, 3);
  lengths.add({0, 5, 5}, {0, 7, 7}, 2);
  EXPECT_EQ(lengths.firstDifference(), 3u);
}

TEST(LinearTime, AccessorsAndImagesOverTheSameBytes) {
  constexpr uint32_t kCount = 10000;
  constexpr uint32_t kBytes = 16000000;
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  const uint32_t view = builder.addView(std::vector<uint8_t>(kBytes, 0));
  const Json sparse = {{"count", 1},
                       {"indices", {{"bufferView", view}, {"componentType", kUnsignedByte}}},
                       {"values", {{"bufferView", view}}}};
  Json images = Json::array();
  for (uint32_t i = 0; i < kCount; ++i) {
    Json accessor = {{"bufferView", view},
                     {"byteOffset", i},
                     {"componentType", kUnsignedByte},
                     {"count", kBytes - kCount},
                     {"type", "SCALAR"}};
    if (i % 2 == 0) accessor["sparse"] = sparse;
    builder.json["accessors"].push_back(std::move(accessor));
    images.push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  }
  builder.json["images"] = std::move(images);
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
}

TEST(LinearTime, NotesDoNotRepeatLongNames) {
  constexpr uint32_t kCount = 2000;
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  Json primitive = {{"attributes", Sheet(3).addTo(builder)["attributes"]}};
  builder.addMesh(std::vector<Json>(kCount, primitive));
  const std::string name(1000000, 'N');
  builder.json["meshes"][1]["extensions"][name] = Json::object();
  builder.json["accessors"][4]["extensions"][name] = Json::object();
  builder.addMesh(std::vector<Json>(kCount, primitive));
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  size_t bytes = 0;
  for (const std::string& note : trip.report.notes) bytes += note.size();
  for (const PrimitiveReport& report : trip.report.primitives) bytes += report.note.size();
  EXPECT_GE(trip.report.notes.size(), 2 * kCount);
  EXPECT_LT(bytes, 1000u * kCount);
}

/// A long accessor that pieces share is not copied as a whole for each of them.
TEST(LinearTime, CopiesOfALongAccessor) {
  constexpr uint32_t kCount = 500;
  Builder builder;
  const Sheet sheet(10);
  Json primitive = sheet.addTo(builder);
  const uint32_t normal = primitive["attributes"]["NORMAL"];
  builder.json["accessors"][normal]["extras"] = {{"text", std::string(1000000, 'x')}};
  builder.json["accessors"][normal]["min"] = {-1, -1, -1};
  std::vector<Json> primitives;
  for (uint32_t i = 0; i < kCount; ++i) {
    primitive["attributes"]["POSITION"] =
        builder.addPositions(Sheet(10, 0.01f * static_cast<float>(i)).positions);
    primitives.push_back(primitive);
  }
  builder.addMesh(primitives);
  const RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(json, 0, kCount - 1));
  EXPECT_LT(trip.converted.size(), 2 * trip.source.size());
  EXPECT_EQ(json["accessors"][normal]["extras"]["text"].get<std::string>().size(), 1000000u);
  const size_t copy = json["meshes"][0]["primitives"][kCount - 1]["attributes"]["NORMAL"];
  EXPECT_NE(copy, normal);
  EXPECT_EQ(json["accessors"][copy]["min"].size(), 3u);
}

TEST(LinearTime, NumbersBelowManyKeysOfViews) {
  Json numbers = Json::array();
  for (uint32_t i = 0; i < 300000; ++i) numbers.push_back(i);
  for (uint32_t i = 0; i < 200; ++i) {
    numbers = Json::object({{i % 2 == 0 ? "bufferView" : "accessor", std::move(numbers)}});
  }
  const Json root = {{"extras", std::move(numbers)}};
  const ForeignReferences foreign = findForeignReferences(root);
  EXPECT_EQ(foreign.views.size(), 300000u);
  EXPECT_EQ(foreign.accessors.size(), 300000u);
}

TEST(LinearTime, AttributesOfOnePrimitive) {
  Builder builder;
  Json primitive = Sheet(3).addTo(builder);
  const Json normal = primitive["attributes"]["NORMAL"];
  Json& attributes = primitive["attributes"];
  for (uint32_t i = 0; i < 30000; ++i) attributes.append("_A" + std::to_string(i), normal);
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
}

TEST(LinearTime, PayloadsThatOverlapAreNotRead) {
  Builder builder;
  builder.addMesh({Sheet(10).addTo(builder)});
  RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  Json json = jsonOf(trip.converted);
  const auto decode = [&] {
    const std::vector<uint8_t> file = withJson(trip.converted, json);
    ValidationReport validation;
    EXPECT_EQ(validateGlb(file, {}, validation).message(), "");
    std::vector<uint8_t> output;
    DecodeReport report;
    const std::string message = decodeGlb(file, output, report).message();
    EXPECT_EQ(validation.isValid(), message.empty());
    return message;
  };
  EXPECT_EQ(decode(), "");
  // Adds a primitive with accessors of its own and a view that is shorter than the last one.
  const auto addPrimitive = [&](size_t shorter_by) {
    Json primitive = json["meshes"][0]["primitives"][0];
    const auto copyAccessor = [&](Json& number) {
      const Json accessor = json["accessors"][number.get<size_t>()];
      number = json["accessors"].size();
      json["accessors"].push_back(accessor);
    };
    for (Json& number : primitive["attributes"]) copyAccessor(number);
    copyAccessor(primitive["indices"]);
    primitive["extensions"][kExtensionName]["bufferView"] = json["bufferViews"].size();
    Json view = json["bufferViews"].back();
    view["byteLength"] = view["byteLength"].get<size_t>() - shorter_by;
    json["bufferViews"].push_back(view);
    json["meshes"][0]["primitives"].push_back(primitive);
  };
  addPrimitive(0);
  EXPECT_EQ(decode(), "") << "the same payload in two views";
  addPrimitive(1);
  EXPECT_NE(decode().find("overlaps other payloads"), std::string::npos);
}

}  // namespace
}  // namespace mcc::gltf::test
