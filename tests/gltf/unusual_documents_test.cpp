// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Documents that are valid but unusual: nothing in them to compress, more in a mesh than a payload
// holds, accessors and keys used in unusual ways. convert() decodes and compares what it wrote, so
// success proves most.
#include <gtest/gtest.h>

#include <fstream>

#include "gltf/decompress/decompress.h"
#include "gltf/round_trip.h"
#include "mcc/files.h"
#include "support/scratch_folder.h"

namespace mcc::gltf::test {
namespace {

Builder oneTriangle() {
  Builder builder;
  builder.addMesh(
      {{{"attributes", {{"POSITION", builder.addPositions({0, 0, 0, 1, 0, 0, 0, 1, 0})}}},
        {"indices", builder.addIndices({0, 1, 2})}}});
  return builder;
}

Builder pointsOnly() {
  Builder builder;
  builder.addMesh(
      {{{"attributes", {{"POSITION", builder.addPositions({0, 0, 0, 1, 2, 3})}}}, {"mode", 0}}});
  return builder;
}

/// As a .gltf whose buffer is a data URI of zeros.
std::string embedded(const Builder& builder) {
  Json json = builder.json;
  json["buffers"] = {{{"byteLength", builder.bin.size()},
                      {"uri", "data:application/octet-stream;base64," +
                                  std::string((builder.bin.size() + 2) / 3 * 4, 'A')}}};
  return printJson(json);
}

TEST(NothingToCompress, BecomesTheOtherContainer) {
  const mcc::test::ScratchFolder folder;
  for (const Builder& builder : {oneTriangle(), pointsOnly(), Builder()}) {
    const std::vector<uint8_t> glb = builder.toGlb();
    const auto path = [&](const char* name) { return folder.path() / name; };
    std::ofstream(path("a.glb"), std::ios::binary)
        .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
    ConvertReport report;
    ASSERT_EQ(convertFile(path("a.glb"), path("b.gltf"), {}, report).message(), "");
    EXPECT_FALSE(report.copied);
    ASSERT_EQ(convertFile(path("b.gltf"), path("c.glb"), {}, report).message(), "");
    std::ifstream stream(path("c.glb"), std::ios::binary);
    const std::vector<uint8_t> back{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(jsonOf(back)["accessors"], jsonOf(glb)["accessors"]);
    if (builder.bin.empty()) continue;  // no accessors
    EXPECT_EQ(elementsInOrder(back, 0), elementsInOrder(glb, 0));
  }
}

TEST(NothingToCompress, TextInMemoryBecomesAGlb) {
  for (const Builder& builder : {oneTriangle(), pointsOnly()}) {
    std::vector<uint8_t> output;
    ConvertReport report;
    ASSERT_EQ(convertGlb(asBytes(embedded(builder)), {}, output, report).message(), "");
    EXPECT_TRUE(isGlb(output));
    EXPECT_EQ(jsonOf(output)["meshes"], builder.json["meshes"]);
  }
}

/// The payloads of a document, opened.
std::vector<DecodedPayload> payloadsOf(const std::vector<uint8_t>& file) {
  Document document;
  std::vector<ExtensionUse> uses;
  EXPECT_TRUE(loadDocument(file, nullptr, document).ok());
  EXPECT_EQ(findExtensionUses(document, uses).message(), "");
  std::set<uint32_t> views;
  for (const ExtensionUse& use : uses) views.insert(use.view);
  std::vector<DecodedPayload> payloads;
  for (const uint32_t view : views) {
    EXPECT_TRUE(decodePayload(payloadBytes(document, view), "", payloads.emplace_back()).ok());
  }
  return payloads;
}

TEST(ManyAttributes, AMeshOfManyPrimitivesBecomesSeveralPayloadsOnOneLattice) {
  Builder builder;
  std::vector<Json> primitives;
  for (uint32_t i = 0; i < 350; ++i) {  // 3 attributes each, of different size
    primitives.push_back(Sheet(2 + i % 3, 0.1f + 0.01f * static_cast<float>(i)).addTo(builder));
  }
  builder.addMesh(primitives);
  const RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  for (uint32_t i = 0; i < 350; ++i) EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, i)) << i;
  EXPECT_EQ(trip.report.payloads.size(), 2u);
  const std::vector<DecodedPayload> payloads = payloadsOf(trip.converted);
  ASSERT_EQ(payloads.size(), 2u);
  const Lattice lattice = payloads[0].payload.info().pieces[0].attributes[0].lattice;
  for (const DecodedPayload& payload : payloads) {
    for (const PieceInfo& piece : payload.payload.info().pieces) {
      EXPECT_EQ(piece.attributes[0].lattice, lattice);
    }
  }
}

/// Sheets with this many morph targets of positions and normals.
Json withTargets(Builder& builder, uint32_t n, uint32_t count) {
  const Sheet sheet(n);
  Json primitive = sheet.addTo(builder);
  primitive["targets"] = Json::array();
  for (uint32_t i = 0; i < count; ++i) {
    std::vector<float> deltas(sheet.positions.size(), 0.0f);
    deltas[i % deltas.size()] = 0.125f;
    primitive["targets"].push_back(
        {{"POSITION", builder.addPositions(deltas)}, {"NORMAL", builder.addFloats(deltas, 3)}});
  }
  return primitive;
}

TEST(ManyAttributes, BlendShapesOfManyPrimitives) {
  Builder builder;
  std::vector<Json> primitives;
  for (uint32_t i = 0; i < 11; ++i) primitives.push_back(withTargets(builder, 2, 57));
  builder.addMesh(primitives);
  const RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.payloads.size(), 2u);
  for (uint32_t i = 0; i < 11; ++i) EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, i));
}

TEST(ManyAttributes, WhatAPayloadCannotHoldOfAPrimitiveStaysBesideIt) {
  Builder builder;
  builder.addMesh({withTargets(builder, 3, 520), Sheet(5).addTo(builder)});
  ConvertOptions options = evenIfLarger();
  const RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.payloads.size(), 2u);
  size_t in_payload = 0;
  const Json json = jsonOf(trip.converted);
  for (const Json& map :
       json["meshes"][0]["primitives"][0]["extensions"][kExtensionName]["targets"]) {
    in_payload += map.size();
  }
  EXPECT_EQ(in_payload, 1024u - 3);
  // The last target, which stays next to the payload, still belongs to its vertices.
  EXPECT_EQ(elementsInOrder(trip.decoded, 4 + 2 * 519), elementsInOrder(trip.source, 4 + 2 * 519));
  options.indices_only = true;
  EXPECT_EQ(roundTrip(builder, options).error, "");
}

TEST(ManyAttributes, MoreTargetsThanTheFormatHasLeaveThePrimitiveAlone) {
  Builder builder;
  Json primitive = Sheet(2).addTo(builder);
  primitive["targets"] = Json::array();
  for (uint32_t i = 0; i < 4097; ++i) primitive["targets"].push_back({{"POSITION", 0}});
  Json points = primitive;
  points["mode"] = 0;
  builder.addMesh({primitive, Sheet(20).addTo(builder), points});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(hasNote(trip.report, "/meshes/0/primitives/0: has 4097 morph targets"));
  EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 0, 0));
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 1));
}

TEST(IndexBounds, AreThoseOfTheNewNumbering) {
  Builder builder;
  const Sheet sheet(20);
  Json primitive = sheet.addTo(builder);
  const auto half = static_cast<ptrdiff_t>(sheet.indices.size() / 2);
  Json first = primitive;
  Json second = primitive;
  first["indices"] = builder.addIndices({sheet.indices.begin(), sheet.indices.begin() + half});
  second["indices"] = builder.addIndices({sheet.indices.begin() + half, sheet.indices.end()});
  builder.json["accessors"][4]["min"] = {0};
  builder.json["accessors"][4]["max"] = {230};
  builder.json["accessors"][5]["max"] = {440};
  builder.addMesh({first, second});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  for (const uint32_t accessor : {4u, 5u}) {
    uint32_t low = ~0u;
    uint32_t high = 0;
    for (const std::string& element : elementsInOrder(trip.decoded, accessor)) {
      const uint32_t index = static_cast<uint8_t>(element[0]) |
                             static_cast<uint32_t>(static_cast<uint8_t>(element[1])) << 8;
      low = std::min(low, index);
      high = std::max(high, index);
    }
    for (const auto* file : {&trip.converted, &trip.decoded}) {
      const Json json = jsonOf(*file)["accessors"][accessor];
      EXPECT_EQ(json["max"], Json::array({high}));
      if (accessor == 4) {
        EXPECT_EQ(json["min"], Json::array({low}));
      } else {
        EXPECT_FALSE(json.contains("min"));
      }
    }
  }
}

TEST(Matrices, OfSmallComponentsHaveAStrideWhenDecoded) {
  struct Kind {
    const char* type;
    int component_type;
    size_t bytes;
    uint32_t stride;  ///< 0: not needed
  };
  Builder builder;
  const Sheet sheet(20);
  Json primitive = sheet.addTo(builder);
  const Kind kinds[] = {{"MAT2", kUnsignedByte, 8, 8},    {"MAT3", kUnsignedByte, 12, 12},
                        {"MAT4", kUnsignedByte, 16, 0},   {"MAT2", kUnsignedShort, 8, 0},
                        {"MAT3", kUnsignedShort, 24, 24}, {"MAT3", kFloat, 36, 0}};
  for (const Kind& kind : kinds) {
    const std::vector<uint8_t> bytes(kind.bytes * sheet.count(), 0);
    const uint32_t view = builder.addView(bytes, static_cast<uint32_t>(kind.bytes));
    const uint32_t accessor = builder.addAccessor({{"bufferView", view},
                                                   {"componentType", kind.component_type},
                                                   {"count", sheet.count()},
                                                   {"type", kind.type}});
    primitive["attributes"]["_M" + std::to_string(accessor)] = accessor;
  }
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.decoded);
  for (size_t i = 0; i < std::size(kinds); ++i) {
    const Json& view = json["bufferViews"][json["accessors"][4 + i]["bufferView"].get<size_t>()];
    const uint32_t stride = view.contains("byteStride") ? view["byteStride"].get<uint32_t>() : 0;
    EXPECT_EQ(stride, kinds[i].stride) << kinds[i].type << kinds[i].component_type;
  }
}

TEST(OddJson, KeysWithZerosAndRepeatedOnesInExtrasAreKept) {
  Builder builder;
  const Sheet sheet(20);
  Json primitive = sheet.addTo(builder);
  const std::string key("_A\0B", 4);
  primitive["attributes"][key] = builder.addFloats(std::vector<float>(sheet.count(), 1.0f), 1);
  builder.addMesh({primitive});
  const std::string extras = R"({"a\u0000b":1,"a\u0000c":2,"a":3,"d":1,"d":{"e":2,"e":3}})";
  Json whole;
  ASSERT_TRUE(parseJson(asBytes("{\"extras\":" + extras + "}"), whole).ok());
  builder.json["extras"] = whole["extras"];
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(printJson(jsonOf(trip.decoded)["extras"]), printJson(builder.json["extras"]));
  EXPECT_TRUE(
      jsonOf(
          trip.converted)["meshes"][0]["primitives"][0]["extensions"][kExtensionName]["attributes"]
          .contains(key));
}

TEST(OddJson, ASparseAccessorOfNoElementsIsKept) {
  for (const char* count : {"0", "-0.0"}) {
    Builder builder;
    builder.addMesh({Sheet(20).addTo(builder)});
    const uint32_t indices = builder.addView({1, 2, 3, 4});
    const uint32_t values = builder.addView({5, 6, 7, 8});
    Json sparse = {{"count", 0},
                   {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
                   {"values", {{"bufferView", values}}}};
    ASSERT_TRUE(parseJson(asBytes(count), sparse["count"]).ok());
    builder.addAccessor(
        {{"componentType", kFloat}, {"count", 3}, {"type", "SCALAR"}, {"sparse", sparse}});
    const RoundTrip trip = roundTrip(builder);
    ASSERT_EQ(trip.error, "") << count;
    EXPECT_EQ(printJson(jsonOf(trip.decoded)["accessors"][4]["sparse"]["count"]), count);
  }
}

TEST(OddJson, AnAccessorMayBeIndicesAndAnAttribute) {
  std::vector<float> positions;
  std::vector<uint16_t> indices;
  for (uint16_t i = 0; i < 900; ++i) {
    positions.insert(positions.end(), {float(i), float(i * i % 7), float(i % 5)});
    indices.push_back(i);
  }
  for (const bool in_one_primitive : {true, false}) {
    for (const bool indices_only : {true, false}) {
      Builder builder;
      Json first = {{"attributes", {{"POSITION", builder.addPositions(positions)}}},
                    {"indices", builder.addIndices(indices)}};
      Json second = first;
      second.erase("indices");
      (in_one_primitive ? first : second)["attributes"]["NORMAL"] = 1;
      builder.addMesh({first, second});
      ConvertOptions options = evenIfLarger();
      options.indices_only = indices_only;
      const RoundTrip trip = roundTrip(builder, options);
      EXPECT_EQ(trip.error, "") << in_one_primitive << indices_only;
      EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 1));
    }
  }
}

}  // namespace
}  // namespace mcc::gltf::test
