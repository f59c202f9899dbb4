// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Documents of which one part is wrong or missing: what needs that part stays as it was, with a
// note, and the rest is compressed. What is wrong with the file as a whole is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "gltf/made_up_codecs.h"
#include "gltf/round_trip.h"

namespace mcc::gltf::test {
namespace {

/// A document with two meshes: the first is sound, the second gets a fault.
struct TwoMeshes {
  Builder builder;
  Json primitive;  ///< of the second mesh
  uint32_t position = 0, normal = 0, texcoord = 0, indices = 0;

  TwoMeshes() {
    builder.addMesh({Sheet(20).addTo(builder)});
    primitive = Sheet(21).addTo(builder);
    builder.addMesh({primitive});
    position = primitive["attributes"]["POSITION"];
    normal = primitive["attributes"]["NORMAL"];
    texcoord = primitive["attributes"]["TEXCOORD_0"];
    indices = primitive["indices"];
  }
  Json& accessor(uint32_t number) { return builder.json["accessors"][number]; }
  Json& view(uint32_t number) { return builder.json["bufferViews"][number]; }
  Json& faulty() { return builder.json["meshes"][1]["primitives"][0]; }
};

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<ValidationIssue> issuesOf(const std::vector<uint8_t>& file) {
  ValidationReport report;
  EXPECT_EQ(validateGlb(file, {}, report).message(), "");
  return report.issues;
}

/// Converts a document with a fault and decodes it again: the first mesh is compressed, the second
/// one is not, and a note says why.
RoundTrip expectLeftAlone(const Builder& builder, const std::string& note,
                          const ConvertOptions& options = {}) {
  SCOPED_TRACE(note);
  RoundTrip trip = roundTrip(builder, options);
  EXPECT_EQ(trip.error, "");
  if (!trip.error.empty()) return trip;
  const Json json = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(json, 0, 0));
  EXPECT_FALSE(isCompressed(json, 1, 0));
  EXPECT_EQ(trip.report.primitives.size(), builder.json["meshes"].size());
  EXPECT_TRUE(mentions(trip.report.primitives[1].note, note)) << trip.report.primitives[1].note;
  EXPECT_TRUE(trip.report.checked);
  EXPECT_EQ(jsonOf(trip.decoded)["meshes"][1]["primitives"][0].size(),
            builder.json["meshes"][1]["primitives"][0].size());
  return trip;
}

RoundTrip expectLeftAlone(const std::function<void(TwoMeshes&)>& damage, const std::string& note,
                          const ConvertOptions& options = {}) {
  TwoMeshes document;
  damage(document);
  return expectLeftAlone(document.builder, note, options);
}

TEST(Faults, OfReferences) {
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["attributes"]["COLOR_0"] = 77; },
                  "attributes/COLOR_0: there is no accessor 77; left as it was");
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["attributes"]["NORMAL"] = -1; },
                  "attributes/NORMAL: must be the number of an accessor");
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["attributes"]["NORMAL"] = "5"; },
                  "must be the number of an accessor");
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["indices"] = 8; },
                  "indices: there is no accessor 8");
  expectLeftAlone(
      [](TwoMeshes& d) {
        d.faulty()["targets"] = {{{"POSITION", 99}}};
      },
      "targets/0/POSITION: there is no accessor 99");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal)["bufferView"] = 8; },
                  "NORMAL cannot be read (/accessors/5/bufferView: there is no bufferView 8)");
}

/// New accessors and views get the numbers after the last; those must not be what was named.
TEST(Faults, ReferencesToNothingStayReferencesToNothing) {
  TwoMeshes d;
  Json shared = d.builder.json["meshes"][0]["primitives"][0];
  shared["attributes"].erase("TEXCOORD_0");
  d.builder.addMesh({shared});  // its accessors are cloned
  d.faulty()["attributes"]["COLOR_0"] = 8;
  d.accessor(d.normal)["bufferView"] = 8;
  d.builder.json["images"] = {{{"bufferView", 9}, {"mimeType", "image/png"}}};
  d.builder.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", 9}}};
  d.builder.json["animations"] = {
      {{"samplers", {{{"input", 10}, {"output", 8}}}}, {"channels", Json::array()}}};
  const RoundTrip trip = expectLeftAlone(d.builder, "there is no accessor 8");
  for (const Json& json : {jsonOf(trip.converted), jsonOf(trip.decoded)}) {
    const size_t accessors = json["accessors"].size();
    const size_t views = json["bufferViews"].size();
    EXPECT_GT(accessors, 8u);
    EXPECT_GE(json["meshes"][1]["primitives"][0]["attributes"]["COLOR_0"], accessors);
    EXPECT_GE(json["accessors"][d.normal]["bufferView"], views);
    EXPECT_GE(json["images"][0]["bufferView"], views);
    EXPECT_GE(json["skins"][0]["inverseBindMatrices"], accessors);
    EXPECT_GE(json["animations"][0]["samplers"][0]["input"], accessors);
    EXPECT_GE(json["animations"][0]["samplers"][0]["output"], accessors);
  }
}

TEST(Faults, OfShapes) {
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["mode"] = -1; },
                  "mode: must be a whole number that is not negative");
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["mode"] = "4"; }, "mode: must be a whole number");
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["attributes"] = 1; },
                  "attributes: must be an object");
  expectLeftAlone([](TwoMeshes& d) { d.faulty().erase("attributes"); },
                  "\"attributes\" is missing");
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["targets"] = 1; }, "targets: must be an array");
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["targets"] = {1}; },
                  "targets/0: must be an object");
  expectLeftAlone([](TwoMeshes& d) { d.faulty()["extensions"] = 1; },
                  "extensions: must be an object");
}

TEST(Faults, OfIndices) {
  expectLeftAlone(
      [](TwoMeshes& d) {
        Sheet sheet(21);
        sheet.indices[17] = 60000;
        d.faulty()["indices"] = d.builder.addIndices(sheet.indices);
      },
      "index number 17 is 60000 but there are only 484 vertices; left as it was");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.indices)["componentType"] = kShort; },
                  "indices must be SCALAR of an unsigned type, not SCALAR of SHORT");
  expectLeftAlone(
      [](TwoMeshes& d) {
        d.accessor(d.indices)["type"] = "VEC2";
        d.accessor(d.indices)["count"] = 1323;
      },
      "indices must be SCALAR");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.indices)["componentType"] = kFloat; },
                  "needs 10584 bytes of bufferView 7, which has 5292");
}

/// A primitive whose indices fail does not keep others with the same attributes from being coded.
TEST(Faults, OfOneOfTwoPrimitivesWithTheSameAttributes) {
  TwoMeshes d;
  Json second = d.primitive;
  d.faulty()["indices"] = d.builder.addIndices({0, 1, 1000});
  d.builder.addMesh({second});
  const RoundTrip trip = expectLeftAlone(d.builder, "index number 2 is 1000");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 2, 0));
}

TEST(Faults, OfAccessors) {
  expectLeftAlone(
      [](TwoMeshes& d) { d.accessor(d.normal)["count"] = 485; },
      "NORMAL cannot be read (/accessors/5: needs 5820 bytes of bufferView 5, which has "
      "5808)");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal)["byteOffset"] = 4; },
                  "needs 5812 bytes of bufferView 5");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal)["byteOffset"] = -4; },
                  "/accessors/5/byteOffset: must be a whole number that is not negative");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal)["byteOffset"] = 9007199254740992u; },
                  "of bufferView 5, which has 5808");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal).erase("count"); },
                  "\"count\" is missing");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal)["count"] = 4294967296u; },
                  "4294967296 is too large");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal).erase("type"); },
                  "\"type\" is missing or not a string");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal).erase("componentType"); },
                  "\"componentType\" is missing");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal)["normalized"] = 1; },
                  "must be true or false");
  expectLeftAlone([](TwoMeshes& d) { d.view(5)["byteStride"] = 8; },
                  "elements of 12 bytes do not fit the stride 8");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.position)["bufferView"] = 0.5; },
                  "POSITION cannot be read");
}

TEST(Faults, OfSparseAccessors) {
  const auto sparse = [](TwoMeshes& d, std::vector<uint8_t> indices, size_t values) {
    const uint32_t index_view = d.builder.addView(indices);
    const uint32_t value_view = d.builder.addView(bytesOf(std::vector<float>(values, 1)));
    Json& accessor = d.accessor(d.normal);
    accessor["sparse"] = {
        {"count", indices.size()},
        {"indices", {{"bufferView", index_view}, {"componentType", kUnsignedByte}}},
        {"values", {{"bufferView", value_view}}}};
    return &accessor["sparse"];
  };
  expectLeftAlone(
      [&](TwoMeshes& d) {
        sparse(d, {1, 7}, 6);
        d.accessor(d.normal)["count"] = 7;
      },
      "elements of NORMAL");
  expectLeftAlone(
      [&](TwoMeshes& d) {
        sparse(d, {1, 2}, 5);
      },
      "/accessors/5/sparse/values: needs 24 bytes of bufferView 9, which has 20");
  expectLeftAlone(
      [&](TwoMeshes& d) {
        (*sparse(d, {1, 2}, 6))["count"] = 3;
      },
      "/accessors/5/sparse/indices: needs 3 bytes");
  expectLeftAlone(
      [&](TwoMeshes& d) {
        sparse(d, {1, 2}, 6)->erase("values");
      },
      "\"values\" is missing");
  expectLeftAlone(
      [&](TwoMeshes& d) {
        (*sparse(d, {1, 2}, 6))["count"] = 500;
      },
      "500 is too large (at most 484)");
  expectLeftAlone(
      [&](TwoMeshes& d) {
        (*sparse(d, {1, 2}, 6))["indices"]["componentType"] = kByte;
      },
      "5120 is not an index type");
  // The numbers are read only when the elements are.
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  Json primitive = Sheet(10).addTo(builder);
  builder.addMesh({primitive});
  const uint32_t indices = builder.addView(bytesOf(std::vector<uint8_t>{200}));
  const uint32_t values = builder.addView(bytesOf(std::vector<float>{1, 2, 3}));
  builder.json["accessors"][primitive["attributes"]["NORMAL"].get<size_t>()]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
      {"values", {{"bufferView", values}}}};
  expectLeftAlone(builder, "index 200 is outside the accessor of 121 elements");
}

TEST(Faults, OfCounts) {
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.normal)["count"] = 483; },
                  "has 484 positions but 483 elements of NORMAL");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.position)["count"] = 0; }, "has 0 vertices");
  expectLeftAlone([](TwoMeshes& d) { d.accessor(d.indices)["count"] = 0; }, "has 0 indices");
  expectLeftAlone(
      [](TwoMeshes& d) {
        d.faulty()["targets"] = {{{"NORMAL", d.builder.addFloats({1, 2, 3}, 3)}}};
      },
      "elements of target 0 NORMAL");
}

/// A view that ends after its buffer has the bytes up to that end.
TEST(Faults, OfViews) {
  TwoMeshes d;
  const uint32_t image = d.builder.addView({1, 2, 3, 4, 5, 6, 7, 8});
  d.builder.json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
  d.view(image)["byteLength"] = 100;
  d.view(4)["byteOffset"] = 10000000;
  const RoundTrip trip = expectLeftAlone(d.builder, "POSITION cannot be read (/accessors/4: needs");
  EXPECT_TRUE(std::any_of(trip.report.notes.begin(), trip.report.notes.end(), [](const auto& note) {
    return mentions(note, "are outside buffer 0") && mentions(note, "of which there are 2");
  }));
  const Json json = jsonOf(trip.decoded);
  const Json& view = json["bufferViews"][json["images"][0]["bufferView"].get<size_t>()];
  EXPECT_EQ(view["byteLength"], 8);
  GlbFile glb;
  ASSERT_TRUE(readGlb(trip.decoded, glb).ok());
  EXPECT_EQ(glb.bin[view["byteOffset"].get<size_t>() + 7], 8);
  EXPECT_EQ(issuesOf(d.builder.toGlb()).size(), 3u);
}

/// Where the only view lies outside of its buffer, there are no bytes to keep, and the buffer that
/// the view names is still there.
TEST(Faults, OfTheOnlyView) {
  const std::string json =
      R"({"asset":{"version":"2.0"},"images":[{"bufferView":0,"mimeType":"image/png"}],)"
      R"("bufferViews":[{"buffer":0,"byteOffset":65535,"byteLength":4}],)"
      R"("buffers":[{"byteLength":4,"uri":"data:;base64,AAAAAA=="}]})";
  ConvertReport report;
  std::vector<uint8_t> output;
  ASSERT_EQ(convertGlb(asBytes(json), {}, output, report).message(), "");
  EXPECT_TRUE(hasNote(report, "bytes 65535 to 65539 are outside buffer 0 of 4 bytes"));
  EXPECT_EQ(jsonOf(output)["bufferViews"][0]["byteLength"], 0);
  EXPECT_EQ(jsonOf(output)["buffers"][0]["byteLength"], 0);
}

/// What is wrong with one accessor is an error of the file, which validate() reports at its place.
TEST(Faults, AreErrorsForValidate) {
  TwoMeshes d;
  d.accessor(d.normal)["count"] = 485;
  d.accessor(d.texcoord)["bufferView"] = 99;
  const std::vector<ValidationIssue> issues = issuesOf(d.builder.toGlb());
  ASSERT_EQ(issues.size(), 2u);
  EXPECT_EQ(issues[0].severity, Severity::kError);
  EXPECT_EQ(issues[0].code, "INVALID_DOCUMENT");
  EXPECT_EQ(issues[0].pointer, "/accessors/5");
  EXPECT_EQ(issues[1].pointer, "/accessors/6/bufferView");
}

/// The rest is compressed; a file without any rest is refused (tests/gltf/coded_input_test.cpp).
TEST(Faults, OfWhatOtherCodecsCompressed) {
  const auto expectNote = [](const TwoMeshes& d, const std::string& note) {
    const RoundTrip trip = roundTrip(
        d.builder.json.contains("buffers") ? fileOf(d.builder) : d.builder.toGlb(), withDecoders());
    ASSERT_EQ(trip.error, "") << note;
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 1, 0));
    EXPECT_TRUE(hasNote(trip.report, note)) << note;
  };
  const auto view = [&](const std::function<void(Json&)>& damage, const std::string& note) {
    TwoMeshes d;
    codeViews(d.builder, {4, 5});
    damage(d.view(5)["extensions"][kViewName]);
    expectNote(d, note);
  };
  view([](Json& j) { j["filter"] = "COLOR"; }, "has an unknown filter");
  view([](Json& j) { j["byteLength"] = 20; }, "20 bytes cannot hold");
  view([](Json& j) { j["byteLength"] = 10000000; }, "are outside buffer");
  view([](Json& j) { j["count"] = 1; }, "codes 2 bytes, but the view has 5808");
  const auto mesh = [&](const std::function<void(TwoMeshes&)>& damage, const std::string& note) {
    TwoMeshes d;
    codeMesh(d.builder, 1);
    damage(d);
    expectNote(d, note);
  };
  mesh([](TwoMeshes& d) { d.builder.json["bufferViews"].back()["byteLength"] = 5000; },
       "is damaged");
  mesh([](TwoMeshes& d) { d.faulty()["extensions"][kMeshName]["bufferView"] = 99; },
       "bufferView 99 does not exist");
  mesh([](TwoMeshes& d) { d.faulty()["extensions"][kMeshName].erase("attributes"); },
       "\"attributes\" is missing");
  mesh([](TwoMeshes& d) { d.faulty()["extensions"][kMeshName]["attributes"]["NORMAL"] = -1; },
       "attributes/NORMAL: must be a whole number that is not negative");
  mesh(
      [](TwoMeshes& d) {
        for (const uint32_t accessor : {d.position, d.normal, d.texcoord})
          d.accessor(accessor)["count"] = 9;
      },
      "has an index that its accessor cannot hold");
}

/// Numbers beyond binary64 are JSON, though no numbers of glTF.
TEST(Faults, BoundsThatAreInfiniteAreReplaced) {
  const auto spelt = [](const std::string& number) { return Json::number(number); };
  const std::vector<Json> bounds = {{spelt("1e999"), spelt("1e999"), spelt("-1E+400")},
                                    {nullptr, nullptr, nullptr},
                                    {"NaN", "Infinity", "-Infinity"},
                                    {1, 2},
                                    "none",
                                    {1e300, 1e300, 1e300}};
  for (const Json& bound : bounds) {
    SCOPED_TRACE(printJson(bound));
    TwoMeshes d;
    const Json low = d.accessor(0)["min"];
    const Json high = d.accessor(0)["max"];
    d.accessor(0)["min"] = bound;
    d.accessor(0)["max"] = bound;
    d.builder.json["extras"] = {{"huge", spelt("1e999")}};
    const RoundTrip trip = roundTrip(d.builder);
    ASSERT_EQ(trip.error, "");
    const Json json = jsonOf(trip.decoded);
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(json["accessors"][0]["min"][c].get<double>(), low[c].get<double>(), 1e-3);
      EXPECT_NEAR(json["accessors"][0]["max"][c].get<double>(), high[c].get<double>(), 1e-3);
    }
    EXPECT_EQ(printJson(json["extras"]), R"({"huge":1e999})");
  }
}

TEST(Faults, PositionsWithoutNumbersStayExact) {
  for (const float value :
       {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    Builder builder;
    Sheet sheet(20);
    sheet.positions[100] = value;
    Json primitive = sheet.addTo(builder);
    builder.json["accessors"][0]["max"][1] = nullptr;
    builder.addMesh({primitive});
    const RoundTrip trip = roundTrip(builder);
    ASSERT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_EQ(elementsInOrder(trip.decoded, 0).size(), sheet.count());
  }
}

// ---- Buffers without bytes

/// Moves everything of the second mesh to a buffer without a URI.
Builder withMissingBuffer(TwoMeshes& d) {
  for (uint32_t view = 4; view < 8; ++view) {
    d.view(view)["buffer"] = 1;
    d.view(view)["byteOffset"] = 10000 * (view - 4);
  }
  return d.builder;
}

std::vector<uint8_t> glbWith(const Builder& builder, const Json& buffers) {
  Json json = builder.json;
  json["buffers"] = buffers;
  return glbOf(json, builder.bin);
}

TEST(MissingBuffers, StayAsTheyWere) {
  TwoMeshes d;
  const Builder builder = withMissingBuffer(d);
  const Json missing = {{"byteLength", 40000}, {"name", "elsewhere"}};
  const Json buffers = {{{"byteLength", builder.bin.size()}}, missing};
  const RoundTrip trip = roundTrip(glbWith(builder, buffers));
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(
      mentions(trip.report.primitives[1].note, "buffer 1 has neither a URI nor a BIN chunk"));
  for (const auto& file : {trip.converted, trip.decoded}) {
    const Json json = jsonOf(file);
    ASSERT_EQ(json["buffers"].size(), 2u);
    EXPECT_EQ(json["buffers"][1], missing);
    for (const uint32_t accessor : {d.position, d.normal, d.texcoord, d.indices}) {
      const Json& view =
          json["bufferViews"][json["accessors"][accessor]["bufferView"].get<size_t>()];
      EXPECT_EQ(view["buffer"], 1);
      EXPECT_EQ(view["byteOffset"], 10000 * (accessor - 4));
      EXPECT_EQ(view["byteLength"], builder.json["bufferViews"][accessor]["byteLength"]);
    }
  }
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  EXPECT_EQ(jsonOf(trip.converted)["bufferViews"].size(), 5u);
  EXPECT_EQ(issuesOf(trip.source).size(), 0u);  // extensions may provide the bytes
  // Once more: nothing is left to compress.
  EXPECT_EQ(roundTrip(trip.converted).converted, trip.converted);
}

/// The first buffer of a .gltf is missing, the second has a data URI. In a GLB, the first is BIN.
TEST(MissingBuffers, MoveBehindTheBuffersWithBytes) {
  TwoMeshes d;
  for (uint32_t view = 0; view < 8; ++view) d.view(view)["buffer"] = view < 4 ? 1 : 0;
  std::string uri = "data:application/octet-stream,";
  for (const uint8_t byte : d.builder.bin) {
    static constexpr char kDigits[] = "0123456789abcdef";
    uri += {'%', kDigits[byte / 16], kDigits[byte % 16]};
  }
  Json json = d.builder.json;
  json["buffers"] = {{{"byteLength", 100000}, {"name", "missing"}},
                     {{"byteLength", d.builder.bin.size()}, {"uri", uri}, {"name", "there"}}};
  const std::string text = json.dump();
  const RoundTrip trip = roundTrip(std::vector<uint8_t>(text.begin(), text.end()));
  ASSERT_EQ(trip.error, "");
  const Json converted = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(converted, 0, 0));
  EXPECT_EQ(converted["buffers"][0]["name"], "there");
  EXPECT_EQ(converted["buffers"][1]["name"], "missing");
  const size_t view = converted["accessors"][d.normal]["bufferView"];
  EXPECT_EQ(converted["bufferViews"][view]["buffer"], 1);
}

TEST(MissingBuffers, ADocumentOfNothingElseIsCopied) {
  TwoMeshes d;
  Json json = d.builder.json;
  json["buffers"] = {{{"byteLength", d.builder.bin.size()}}};
  const std::vector<uint8_t> file = glbOf(json, {});
  const RoundTrip trip = roundTrip(file);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.converted, file);
  EXPECT_EQ(trip.decoded, file);
  InspectReport inspected;
  EXPECT_EQ(inspectGlb(file, true, inspected).message(), "");
  const std::vector<ValidationIssue> issues = issuesOf(file);
  ASSERT_EQ(issues.size(), 1u);  // in a GLB, the first buffer is its BIN chunk
  EXPECT_EQ(issues[0].pointer, "/buffers/0");
  // As a .gltf in memory it becomes a GLB without a BIN chunk, and still has all views.
  const std::string text = json.dump();
  const RoundTrip from_text = roundTrip(std::vector<uint8_t>(text.begin(), text.end()));
  ASSERT_EQ(from_text.error, "");
  EXPECT_EQ(jsonOf(from_text.converted)["bufferViews"], json["bufferViews"]);
  EXPECT_EQ(jsonOf(from_text.converted)["buffers"], json["buffers"]);
}

TEST(MissingBuffers, APayloadInThemIsAnError) {
  const RoundTrip trip = roundTrip([] {
    Builder builder;
    builder.addMesh({Sheet(20).addTo(builder)});
    return builder;
  }());
  ASSERT_EQ(trip.error, "");
  const std::vector<uint8_t> file = glbOf(jsonOf(trip.converted), {});
  std::vector<uint8_t> decoded;
  DecodeReport report;
  EXPECT_TRUE(mentions(decodeGlb(file, decoded, report).message(),
                       "buffer 0 has neither a URI nor a BIN chunk"));
  EXPECT_FALSE(issuesOf(file).empty());
}

TEST(MissingBuffers, CodedViewsInThemStayCoded) {
  TwoMeshes d;
  codeViews(d.builder, {4, 5, 6, 7});
  for (uint32_t view = 4; view < 8; ++view) {
    d.view(view)["extensions"][kViewName]["buffer"] = 2;
  }
  Json json = jsonOf(fileOf(d.builder));
  json["buffers"].push_back({{"byteLength", 1000000}});
  const RoundTrip trip = roundTrip(glbWith(
                                       [&] {
                                         Builder copy = d.builder;
                                         copy.json = json;
                                         return copy;
                                       }(),
                                       json["buffers"]),
                                   withDecoders());
  ASSERT_EQ(trip.error, "");
  const Json converted = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(converted, 0, 0));
  EXPECT_FALSE(isCompressed(converted, 1, 0));
  ASSERT_EQ(converted["buffers"].size(), 3u);
  const size_t view = converted["accessors"][d.normal]["bufferView"];
  EXPECT_EQ(converted["bufferViews"][view]["extensions"][kViewName]["buffer"], 2);
  EXPECT_EQ(converted["bufferViews"][view]["buffer"], 1);
}

}  // namespace
}  // namespace mcc::gltf::test
