// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Round trips of small documents. convertGlb() decodes and compares what it wrote, so that a call
// that succeeds already proves most; the tests look at the rest.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include <set>

#include "gltf/check/compare.h"
#include "gltf/document/references.h"
#include "gltf/files/file_io.h"
#include "gltf/round_trip.h"
#include "mcc/files.h"
#include "support/scratch_folder.h"

namespace mcc::gltf::test {
namespace {

TEST(Convert, SheetBecomesSmallerAndComesBack) {
  Builder builder;
  const Sheet sheet(30);
  builder.addMesh({sheet.addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_LT(trip.converted.size() * 4, trip.source.size());
  const Json json = jsonOf(trip.converted);
  ASSERT_TRUE(isCompressed(json, 0, 0));
  EXPECT_EQ(json["extensionsUsed"], Json::array({kExtensionName}));
  EXPECT_EQ(json["extensionsRequired"], Json::array({kExtensionName}));
  EXPECT_EQ(json["bufferViews"].size(), 1u);
  for (const Json& accessor : json["accessors"]) EXPECT_FALSE(accessor.contains("bufferView"));

  const Json decoded = jsonOf(trip.decoded);
  EXPECT_FALSE(decoded.contains("extensionsUsed"));
  EXPECT_FALSE(decoded["meshes"][0]["primitives"][0].contains("extensions"));
  EXPECT_EQ(decoded["accessors"][0]["count"], sheet.count());
  EXPECT_EQ(decoded["bufferViews"].back()["target"], 34963);
  ASSERT_EQ(trip.report.payloads.size(), 1u);
  EXPECT_EQ(trip.report.payloads[0].triangle_count, sheet.indices.size() / 3);
  for (const AttributeReport& attribute : trip.report.payloads[0].attributes) {
    EXPECT_LE(attribute.max_error, attribute.promised_error) << attribute.name;
    EXPECT_GT(attribute.promised_error, 0) << attribute.name;
  }
}

TEST(Convert, BoundsAreThoseOfTheDecodedData) {
  Builder builder;
  builder.addMesh({Sheet(20, 0.1234567f).addTo(builder)});
  builder.json["accessors"][1]["min"] = {-1, -1, -1};  // kept, and corrected
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.decoded);
  Document document;
  ASSERT_TRUE(loadDocument(trip.decoded, nullptr, document).ok());
  for (const uint32_t accessor : {0u, 1u}) {
    AccessorData data;
    ASSERT_TRUE(readAccessor(document, accessor, data).ok());
    for (uint32_t c = 0; c < 3; ++c) {
      double min = 1e9;
      for (uint64_t i = 0; i < data.count; ++i) {
        min =
            std::min(min, componentValue(data.element(i).data() + 4 * c, ComponentType::kFloat32));
      }
      const Json& spelt = json["accessors"][accessor]["min"][c];
      EXPECT_EQ(static_cast<float>(spelt.get<double>()), min);
      EXPECT_LE(printJson(spelt).size(), 13u) << "as few digits as a float needs";
    }
  }
  EXPECT_FALSE(json["accessors"][1].contains("max"));
}

TEST(Convert, LosslessKeepsEveryBit) {
  Builder builder;
  Sheet sheet(20);
  sheet.positions[4] = -0.0f;
  sheet.positions[5] = 1e-42f;
  const uint32_t nan_bits = 0x7fc12345;
  std::memcpy(&sheet.normals[7], &nan_bits, 4);
  builder.addMesh({sheet.addTo(builder)});
  ConvertOptions options = evenIfLarger();
  options.lossless = true;
  const RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  for (const uint32_t accessor : {0u, 1u, 2u}) {
    EXPECT_EQ(elementsOf(trip.source, accessor), elementsOf(trip.decoded, accessor));
  }
}

TEST(Convert, NanMakesAnAttributeExactWithANote) {
  Builder builder;
  Sheet sheet(20);
  sheet.texcoords[3] = std::numeric_limits<float>::quiet_NaN();
  builder.addMesh({sheet.addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(hasNote(trip.report, "TEXCOORD_0 has NaN"));
  EXPECT_EQ(elementsOf(trip.source, 2), elementsOf(trip.decoded, 2));
}

TEST(Convert, AnOutlierMakesAnAttributeExactWithANote) {
  Builder builder;
  Sheet sheet(20);
  sheet.texcoords[3] = 1e30f;
  builder.addMesh({sheet.addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(hasNote(trip.report, "TEXCOORD_0 has outliers"));
  EXPECT_EQ(elementsOf(trip.source, 2), elementsOf(trip.decoded, 2));
}

/// A document full of things that we do not know.
Builder strangeDocument() {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  const uint32_t image = builder.addView({0x89, 'P', 'N', 'G', 1, 2, 3});
  builder.json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}, {"name", "é"}}};
  Json strange;
  const Result parsed = parseJson(
      asBytes(
          R"({"big":12345678901234567890123,"tiny":1e-7,"neg":-0,"none":null,"empty":{},"list":[[],{},null],)"
          R"("long":0.10000000000000000555,"int":9007199254740993,"s":"\u0001\ud83d\ude00"})"),
      strange);
  if (!parsed.ok()) strange = nullptr;
  builder.json["extras"] = strange;
  for (const char* list : {"accessors", "bufferViews", "meshes", "nodes", "scenes", "images"}) {
    builder.json[list][0]["extras"] = strange;
    builder.json[list][0]["name"] = list;
  }
  builder.json["meshes"][0]["primitives"][0]["extras"] = strange;
  builder.json["meshes"][0]["weights"] = Json::array();
  builder.json["animations"] = {{{"channels", Json::array()}, {"samplers", Json::array()}}};
  return builder;
}

TEST(Convert, KeepsEverythingElse) {
  const Builder builder = strangeDocument();
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json source = jsonOf(trip.source);
  const Json converted = jsonOf(trip.converted);
  const Json decoded = jsonOf(trip.decoded);
  ASSERT_TRUE(isCompressed(converted, 0, 0));
  for (const Json* json : {&converted, &decoded}) {
    for (const char* key : {"asset", "extras", "nodes", "scenes", "animations"}) {
      EXPECT_EQ(firstDifference(source[key], (*json)[key]), "") << key;
    }
    EXPECT_EQ(firstDifference(source["accessors"][0]["extras"], (*json)["accessors"][0]["extras"]),
              "");
    EXPECT_EQ((*json)["accessors"][0]["name"], "accessors");
    EXPECT_EQ(firstDifference(source["meshes"][0]["weights"], (*json)["meshes"][0]["weights"]), "");
  }
  const std::string text = printJson(decoded);
  EXPECT_NE(text.find("12345678901234567890123"), std::string::npos);
  EXPECT_NE(text.find(":1e-7"), std::string::npos);
  EXPECT_NE(text.find(":-0"), std::string::npos);
  EXPECT_NE(text.find("0.10000000000000000555"), std::string::npos);
}

/// glTF forbids empty lists, but files have them. Empty lists of extensions are removed when
/// something is compressed.
TEST(Convert, EmptyListsOfExtensionsGo) {
  const auto convertWith = [](const std::vector<const char*>& lists) {
    Builder builder;
    builder.addMesh({Sheet(20).addTo(builder)});
    for (const char* list : lists) builder.json[list] = Json::array();
    return roundTrip(builder);
  };
  for (const auto& lists : std::vector<std::vector<const char*>>{
           {"extensionsUsed"}, {"extensionsRequired"}, {"extensionsUsed", "extensionsRequired"}}) {
    const RoundTrip trip = convertWith(lists);
    ASSERT_EQ(trip.error, "");
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      EXPECT_EQ(jsonOf(trip.converted)[list], Json::array({kExtensionName}));
      EXPECT_FALSE(jsonOf(trip.decoded).contains(list));
    }
  }
  const RoundTrip others = convertWith(
      {"animations", "cameras", "images", "materials", "samplers", "skins", "textures"});
  ASSERT_EQ(others.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(others.converted), 0, 0));
  EXPECT_EQ(jsonOf(others.decoded)["images"], Json::array()) << "what is no list of ours stays";
}

/// One of the lists is empty, the other has a name that stays.
TEST(Convert, AnEmptyListBesideOneWithNames) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  builder.json["extensionsUsed"] = {"KHR_materials_unlit"};
  builder.json["extensionsRequired"] = Json::array();
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(jsonOf(trip.converted)["extensionsUsed"],
            Json::array({"KHR_materials_unlit", kExtensionName}));
  EXPECT_EQ(jsonOf(trip.decoded)["extensionsUsed"], Json::array({"KHR_materials_unlit"}));
  EXPECT_FALSE(jsonOf(trip.decoded).contains("extensionsRequired"));
}

TEST(Convert, KnownExtensionsLetViewsBeRenumbered) {
  Builder builder = strangeDocument();
  builder.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(jsonOf(trip.converted)["bufferViews"].size(), 2u);  // the image and the payload
  EXPECT_EQ(jsonOf(trip.converted)["images"][0]["bufferView"], 0);
  EXPECT_EQ(jsonOf(trip.decoded)["extensionsUsed"].size(), 2u);
}

TEST(Convert, UnknownExtensionsKeepTheNumbersOfViews) {
  Builder builder = strangeDocument();
  const uint32_t table = builder.addView({7, 7, 7, 7, 7});
  builder.json["extensionsUsed"] = {"ACME_tables"};
  builder.json["extensions"]["ACME_tables"] = {{"values", table}};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json source = jsonOf(trip.source);
  for (const auto* file : {&trip.converted, &trip.decoded}) {
    const Json json = jsonOf(*file);
    EXPECT_GE(json["bufferViews"].size(), source["bufferViews"].size());
    EXPECT_EQ(json["images"][0]["bufferView"], source["images"][0]["bufferView"]);
    EXPECT_EQ(json["extensions"], source["extensions"]);
    Document document;
    ASSERT_TRUE(loadDocument(*file, nullptr, document).ok());
    const BufferView& view = document.views[table];
    EXPECT_EQ(view.length, 5u);
    EXPECT_EQ(document.buffers[0][view.offset + 4], 7);
  }
}

/// Views that nothing refers to.
size_t unusedViews(const std::vector<uint8_t>& file) {
  Json json = jsonOf(file);
  std::set<uint64_t> used;
  visitViewReferences(json,
                      [&](const Json& number, uint32_t) { used.insert(number.get<uint64_t>()); });
  return json["bufferViews"].size() - used.size();
}

/// Unused views keep the numbers in use before one that must stay. Decoding gives them to the
/// accessors again.
TEST(Convert, DecodingLeavesNoViewsThatOnlyHoldNumbers) {
  for (const bool is_image_last : {false, true}) {
    SCOPED_TRACE(is_image_last);
    Builder builder;
    if (!is_image_last) builder.addView({0x89, 'P', 'N', 'G', 1, 2, 3});
    builder.addMesh({Sheet(20).addTo(builder)});
    builder.bin.resize(builder.bin.size() + 4);  // then the first view does not begin at byte 0
    if (is_image_last) builder.addView({0x89, 'P', 'N', 'G', 1, 2, 3});
    const size_t image = is_image_last ? 4 : 0;
    builder.json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
    builder.json["extensionsUsed"] = {"ACME_tables"};
    builder.json["extensions"]["ACME_tables"] = Json::object();
    const RoundTrip trip = roundTrip(builder);
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_EQ(unusedViews(trip.converted), is_image_last ? 3u : 0u) << "none after the last";
    EXPECT_EQ(unusedViews(trip.decoded), 0u);
    EXPECT_EQ(jsonOf(trip.decoded)["bufferViews"].size(), 5u);
    EXPECT_EQ(jsonOf(trip.decoded)["images"][0]["bufferView"], image);
    // Converting a compressed file again neither removes nor adds such views.
    const RoundTrip again = roundTrip(trip.converted);
    ASSERT_EQ(again.error, "");
    EXPECT_EQ(unusedViews(again.decoded), 0u);
  }
}

/// Part of a document was already compressed; the views that kept its numbers are used for the
/// rest.
TEST(Convert, NumbersThatAreFreeAreTakenByTheNextConversion) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  const uint32_t image = builder.addView({0x89, 'P', 'N', 'G', 1, 2, 3});
  builder.json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
  builder.json["extensionsUsed"] = {"ACME_tables"};
  builder.json["extensions"]["ACME_tables"] = Json::object();
  const RoundTrip first = roundTrip(builder);
  ASSERT_EQ(first.error, "");
  ASSERT_EQ(unusedViews(first.converted), 3u);
  Builder second;
  GlbFile glb;
  ASSERT_TRUE(readGlb(first.converted, glb).ok());
  second.json = jsonOf(first.converted);
  second.bin.assign(glb.bin.begin(), glb.bin.end());
  second.addMesh({Sheet(24, 0.2f).addTo(second)});
  const RoundTrip trip = roundTrip(second);
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 1, 0));
  EXPECT_EQ(unusedViews(trip.converted), 2u);
  EXPECT_EQ(jsonOf(trip.converted)["bufferViews"].size(), 5u);
  EXPECT_EQ(jsonOf(trip.converted)["images"][0]["bufferView"], image);
  EXPECT_EQ(unusedViews(trip.decoded), 0u);
}

/// A view of one byte that nothing refers to may still have a user, unless the byte begins another
/// view.
TEST(Convert, AViewOfOneByteMayBeInUse) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  const uint32_t byte = builder.addView({42});
  builder.json["extensionsUsed"] = {"ACME_tables"};
  builder.json["extensions"]["ACME_tables"] = {{"values", byte}};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  for (const auto* file : {&trip.converted, &trip.decoded}) {
    Document document;
    ASSERT_TRUE(loadDocument(*file, nullptr, document).ok());
    ASSERT_GT(document.views.size(), byte);
    EXPECT_EQ(document.views[byte].length, 1u);
    EXPECT_EQ(document.buffers[0][document.views[byte].offset], 42);
  }
}

TEST(Convert, AccessorsNamedByUnknownExtensionsStayReadable) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  builder.json["extensionsUsed"] = {"ACME_physics"};
  builder.json["nodes"][0]["extensions"]["ACME_physics"] = {{"hullAccessor", 0}};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(elementsOf(trip.source, 0), elementsOf(trip.converted, 0));
}

/// Compares decoded indices and positions in the source's order; exact values must have the same
/// bits.
TEST(Convert, OrdersAreKeptOnRequest) {
  Builder builder;
  const Json sheet = Sheet(20).addTo(builder);
  builder.addMesh({sheet});
  ConvertOptions options;
  options.lossless = true;
  const uint32_t position = sheet["attributes"]["POSITION"];
  const uint32_t indices = sheet["indices"];
  for (const uint32_t kept : {0u, 1u, 2u, 3u}) {
    options.keep_vertex_order = (kept & 1) != 0;
    options.keep_triangle_order = (kept & 2) != 0;
    const RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    EXPECT_EQ(elementsInOrder(trip.source, position) == elementsInOrder(trip.decoded, position),
              options.keep_vertex_order);
    EXPECT_EQ(elementsInOrder(trip.source, indices) == elementsInOrder(trip.decoded, indices),
              kept == 3);
  }
}

TEST(Convert, IndicesOnlyMovesTheAttributes) {
  Builder builder;
  const Json sheet = Sheet(30).addTo(builder);
  builder.addMesh({sheet});
  ConvertOptions options;
  options.indices_only = true;
  RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  EXPECT_FALSE(trip.report.copied);
  const Json extension =
      jsonOf(trip.converted)["meshes"][0]["primitives"][0]["extensions"][kExtensionName];
  EXPECT_FALSE(extension.contains("attributes"));
  for (const uint32_t accessor : {0u, 1u, 2u}) {
    EXPECT_EQ(elementsOf(trip.source, accessor), elementsOf(trip.decoded, accessor));
    EXPECT_EQ(elementsInOrder(trip.converted, accessor), elementsInOrder(trip.decoded, accessor));
    EXPECT_NE(elementsInOrder(trip.source, accessor), elementsInOrder(trip.decoded, accessor));
  }
  const uint64_t moved_bytes = trip.converted.size();

  options.keep_vertex_order = true;
  options.keep_triangle_order = true;
  trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  for (const uint32_t accessor : {0u, 1u, 2u, 3u}) {
    EXPECT_EQ(elementsInOrder(trip.source, accessor), elementsInOrder(trip.decoded, accessor));
  }
  EXPECT_GT(trip.converted.size(), moved_bytes);
}

/// An accessor that something else uses stays as it is, and the payload stores the order.
TEST(Convert, IndicesOnlyLeavesSharedAttributes) {
  Builder builder;
  const Json sheet = Sheet(30).addTo(builder);
  Json points = sheet;
  points.erase("indices");
  points["mode"] = 0;
  builder.addMesh({sheet});
  builder.addMesh({points});
  ConvertOptions options;
  options.indices_only = true;
  const RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  EXPECT_FALSE(trip.report.copied);
  for (const uint32_t accessor : {0u, 1u, 2u}) {
    EXPECT_EQ(elementsInOrder(trip.source, accessor), elementsInOrder(trip.converted, accessor));
  }
}

/// Vertices 0, 2, 4, … of the sheet are in use, with every attribute.
TEST(Convert, UnusedVerticesAreNotedAndDropped) {
  const Sheet sheet(30);
  Sheet sparse = sheet;
  const auto spread = [](std::vector<float>& values, size_t components, size_t count) {
    std::vector<float> all;
    for (size_t v = 0; v < count; ++v) {
      for (int copy = 0; copy < 2; ++copy)
        all.insert(all.end(), values.begin() + static_cast<std::ptrdiff_t>(v * components),
                   values.begin() + static_cast<std::ptrdiff_t>((v + 1) * components));
    }
    values = all;
  };
  const size_t count = sheet.positions.size() / 3;
  spread(sparse.positions, 3, count);
  spread(sparse.normals, 3, count);
  spread(sparse.texcoords, 2, count);
  for (auto& index : sparse.indices) index = static_cast<uint16_t>(2 * index);
  Builder builder;
  builder.addMesh({sparse.addTo(builder)});
  Builder dense;
  dense.addMesh({sheet.addTo(dense)});
  const std::string number = std::to_string(count) + " vertices";
  const RoundTrip kept = roundTrip(builder);
  ASSERT_EQ(kept.error, "");
  EXPECT_TRUE(hasNote(kept.report, number + " are in no triangle; --drop-unused"));
  EXPECT_EQ(jsonOf(kept.decoded)["accessors"][0]["count"], 2 * count);

  ConvertOptions options;
  options.drop_unused = true;
  const RoundTrip dropped = roundTrip(builder, options);
  ASSERT_EQ(dropped.error, "");
  EXPECT_TRUE(hasNote(dropped.report, number + " are in no triangle, and left out"));
  const RoundTrip expected = roundTrip(dense);
  for (const uint32_t accessor : {0u, 1u, 2u, 3u})
    EXPECT_EQ(elementsInOrder(dropped.decoded, accessor),
              elementsInOrder(expected.decoded, accessor));
  EXPECT_LT(dropped.converted.size(), kept.converted.size());

  options.keep_vertex_order = options.keep_triangle_order = true;
  const RoundTrip ordered = roundTrip(builder, options);
  ASSERT_EQ(ordered.error, "");
  EXPECT_EQ(elementsInOrder(ordered.decoded, 3), elementsInOrder(dense.toGlb(), 3));

  options.indices_only = true;
  EXPECT_NE(roundTrip(builder, options).error.find("only without indices_only"), std::string::npos);
}

/// Every number that is not one of bits is refused before the source is looked at, with any other
/// option that cannot be meant.
TEST(Convert, OptionsOutOfRangeAreRefused) {
  Builder builder;
  builder.addMesh({Sheet(4).addTo(builder)});
  const std::vector<uint8_t> glb = builder.toGlb();
  const auto refusalOf = [&](const ConvertOptions& options) {
    std::vector<uint8_t> output;
    ConvertReport report;
    const Result result = convertGlb(glb, options, output, report);
    EXPECT_EQ(result.ok(), !output.empty());
    EXPECT_EQ(convertGlb({}, options, output, report).what == result.what, !result.ok());
    return result.message();
  };
  using Bits = QuantizationBits;
  for (uint32_t bits = 0; bits < 256; ++bits) {
    for (uint8_t Bits::*field :
         {&Bits::position_bits, &Bits::texcoord_bits, &Bits::color_bits, &Bits::weight_bits}) {
      ConvertOptions options;
      options.*field = static_cast<uint8_t>(bits);
      EXPECT_EQ(refusalOf(options),
                bits <= 24 ? ""
                           : "the bits of positions, texture coordinates, colours and weights "
                             "are 0 to 24");
    }
    for (uint8_t Bits::*field : {&Bits::normal_bits, &Bits::tangent_bits}) {
      ConvertOptions options;
      options.*field = static_cast<uint8_t>(bits);
      EXPECT_EQ(refusalOf(options), bits == 0 || (bits >= 2 && bits <= 16)
                                        ? ""
                                        : "the bits of normals and tangents are 0, or 2 to 16");
    }
    if (bits <= 2) continue;
    ConvertOptions options;
    options.grid = static_cast<Grid>(bits);
    EXPECT_EQ(refusalOf(options), "grid is not one of the grids");
    options = {};
    options.prefer = static_cast<Preference>(bits);
    EXPECT_EQ(refusalOf(options), "prefer is not one of the preferences");
  }
  for (const double error : {-1.0, -0x1p-1000, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    ConvertOptions options;
    options.max_position_error = error;
    EXPECT_EQ(refusalOf(options), "max_position_error is negative or not a finite number") << error;
  }
}

/// What an unknown extension may refer to by number stays.
TEST(Convert, VerticesWithANumberAreNotDropped) {
  Builder builder;
  Sheet sheet(30);
  sheet.indices.resize(sheet.indices.size() / 2);
  Json primitive = sheet.addTo(builder);
  primitive["extensions"]["EXT_that_counts_vertices"] = Json::object();
  builder.addMesh({primitive});
  ConvertOptions options;
  options.drop_unused = true;
  const RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(hasNote(trip.report, "not all can be left out"));
  EXPECT_EQ(elementsInOrder(trip.decoded, 3), elementsInOrder(trip.source, 3));
}

/// Measures distances without the library's check, at a place where floats are coarse.
TEST(Convert, NoPositionIsFartherThanPromised) {
  for (const float offset : {0.0f, 1000.0f, -30000.0f}) {
    Builder builder;
    Sheet sheet(30);
    for (float& x : sheet.positions) x += offset;
    builder.addMesh({sheet.addTo(builder)});
    for (const double error : {0.3, 0.02, 0.004, 1e-6}) {
      ConvertOptions options;
      options.keep_vertex_order = true;
      options.max_position_error = error;
      const RoundTrip trip = roundTrip(builder, options);
      ASSERT_EQ(trip.error, "");
      const std::vector<float> positions = floatsInOrder(trip.decoded, 0);
      ASSERT_EQ(positions.size(), sheet.positions.size());
      double farthest = 0;
      for (size_t i = 0; i < positions.size(); i += 3) {
        double square = 0;
        for (size_t c = i; c < i + 3; ++c) {
          const double off = double{positions[c]} - double{sheet.positions[c]};
          square += off * off;
        }
        farthest = std::max(farthest, std::sqrt(square));
      }
      EXPECT_LE(farthest, error);
      const bool is_exact = farthest == 0;
      EXPECT_EQ(is_exact, hasNote(trip.report, "for the promised error"));
      EXPECT_TRUE(is_exact || farthest > error / 4) << "finer than need be";
    }
  }
}

TEST(Convert, ARelativeErrorIsOfTheLongestSide) {
  Builder builder;
  Sheet sheet(20);
  for (float& x : sheet.positions) x *= 50;
  builder.addMesh({sheet.addTo(builder)});
  ConvertOptions options;
  options.max_position_error = 0.01;
  options.is_error_relative = true;
  const RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  const AttributeReport& position = trip.report.payloads[0].attributes[0];
  EXPECT_DOUBLE_EQ(position.promised_distance, 0.5);
  EXPECT_GT(position.max_distance, 0.1);
}

/// Two tiles with a common border, converted separately.
TEST(Convert, AGivenLatticeMakesTilesMeet) {
  ConvertOptions options;
  options.keep_vertex_order = true;
  options.position_lattice = Lattice{{0, 0, 0, 0}, 0.01f};
  std::vector<float> borders[2];
  for (const uint32_t tile : {0u, 1u}) {
    Builder builder;
    Sheet sheet(20);
    for (size_t i = 0; i < sheet.positions.size(); i += 3) {
      if (tile == 1) sheet.positions[i] = 2 - sheet.positions[i];  // mirrored at x = 1
    }
    builder.addMesh({sheet.addTo(builder)});
    const RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    const std::vector<float> positions = floatsInOrder(trip.decoded, 0);
    for (size_t i = 0; i < positions.size(); i += 3) {
      if (sheet.positions[i] == 1)
        borders[tile].insert(borders[tile].end(), &positions[i], &positions[i] + 3);
    }
  }
  EXPECT_EQ(borders[0].size(), 63u);
  EXPECT_EQ(borders[0], borders[1]);
}

/// Two meshes that touch, of different extents and in files of their own, agree on nothing but the
/// step.
TEST(Convert, OneStepMakesBordersMeet) {
  ConvertOptions options;
  options.keep_vertex_order = true;
  options.step = 0x1p-7;
  std::vector<float> borders[2];
  for (const uint32_t part : {0u, 1u}) {
    Builder builder;
    Sheet sheet(20);
    for (size_t i = 0; i < sheet.positions.size(); i += 3) {
      float& x = sheet.positions[i];
      if (part == 1) x = 1 + 37.3f * (1 - x);
      sheet.positions[i + 1] -= 5.3f;
    }
    builder.addMesh({sheet.addTo(builder)});
    const RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    EXPECT_LE(trip.report.payloads[0].attributes[0].max_error, 0x1p-8);
    const std::vector<float> positions = floatsInOrder(trip.decoded, 0);
    for (size_t i = 0; i < positions.size(); i += 3) {
      for (size_t c = i; c < i + 3; ++c) EXPECT_EQ(std::remainder(positions[c], 0x1p-7f), 0);
      if (sheet.positions[i] == 1)
        borders[part].insert(borders[part].end(), &positions[i], &positions[i] + 3);
    }
  }
  EXPECT_EQ(borders[0].size(), 63u);
  EXPECT_EQ(borders[0], borders[1]);
}

TEST(Convert, PositionsBeyondTheStepsLatticeStayExact) {
  Builder builder;
  Sheet sheet(20);
  for (float& x : sheet.positions) x += 1e6f;
  builder.addMesh({sheet.addTo(builder)});
  ConvertOptions options;
  options.step = 0x1p-10;
  const RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.payloads[0].attributes[0].bits, 0);
  EXPECT_EQ(trip.report.payloads[0].attributes[0].max_error, 0);
  EXPECT_TRUE(hasNote(trip.report, "more than 2^24 steps from the origin of the given lattice"));
  options.step = 0x1p-3;
  const RoundTrip coarse = roundTrip(builder, options);
  ASSERT_EQ(coarse.error, "");
  EXPECT_EQ(coarse.report.payloads[0].attributes[0].bits, 23);
}

TEST(Convert, WrongStepsAreRefused) {
  const double kNaN = std::numeric_limits<double>::quiet_NaN();
  const double kInfinity = std::numeric_limits<double>::infinity();
  Builder builder;
  builder.addMesh({Sheet(5).addTo(builder)});
  const auto refusalOf = [&](const ConvertOptions& options) {
    return roundTrip(builder, options).error;
  };
  ConvertOptions options;
  for (const double step :
       {0.001, 3.0, -1.0, -0x1p-10, 0x1p-127, 0x1p128, 0x1.8p-10, 1e-320, kNaN, kInfinity}) {
    options.step = step;
    EXPECT_EQ(refusalOf(options), "step is not a power of two from 2^-126 to 2^127") << step;
  }
  for (const double step : {0x1p-126, 0x1p127}) {
    options.step = step;
    EXPECT_EQ(refusalOf(options), "") << step;
  }
  options.step = 1;
  for (const int other : {0, 1, 2}) {
    ConvertOptions both = options;
    both.lossless = other == 0;
    if (other == 1) both.max_position_error = 1;
    if (other == 2) both.position_lattice = Lattice{{0, 0, 0, 0}, 1};
    EXPECT_EQ(refusalOf(both), "step excludes lossless, max_position_error and position_lattice");
  }
}

TEST(Convert, ExtensionsThatMayNeedTheOrderKeepIt) {
  for (const bool on_mesh : {false, true}) {
    Builder builder;
    const Json sheet = Sheet(20).addTo(builder);
    builder.addMesh({sheet});
    Json& mesh = builder.json["meshes"][0];
    (on_mesh ? mesh : mesh["primitives"][0])["extensions"]["ACME_polygons"] = {{"a", 1}};
    ConvertOptions options;
    options.lossless = true;
    RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    const uint32_t position = sheet["attributes"]["POSITION"];
    EXPECT_EQ(elementsInOrder(trip.source, position), elementsInOrder(trip.decoded, position));
    EXPECT_EQ(elementsInOrder(trip.source, sheet["indices"]),
              elementsInOrder(trip.decoded, sheet["indices"]));
  }

  Builder strip;
  strip.addMesh({Sheet(20).addTo(strip)});
  Json& primitive = strip.json["meshes"][0]["primitives"][0];
  primitive["mode"] = 5;
  primitive["extensions"]["ACME_polygons"] = {{"a", 1}};
  RoundTrip trip = roundTrip(strip);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(trip.report.copied);
  EXPECT_TRUE(hasNote(trip.report, "ACME_polygons"));

  Builder harmless;
  harmless.addMesh({Sheet(20).addTo(harmless)});
  harmless.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] = {
      {"mappings", Json::array()}};
  trip = roundTrip(harmless);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
}

TEST(Convert, PrimitivesWithTheSameAttributesShareAPiece) {
  Builder builder;
  const Sheet sheet(24);
  Json first = sheet.addTo(builder);
  const auto half = static_cast<ptrdiff_t>(sheet.indices.size() / 6 * 3);
  first["indices"] = builder.addIndices({sheet.indices.begin(), sheet.indices.begin() + half});
  Json second = first;
  second["indices"] = builder.addIndices({sheet.indices.begin() + half, sheet.indices.end()});
  Json third = second;  // the same triangles again, say with another material
  third["extras"] = "third";
  builder.addMesh({first, second, third});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  for (size_t p = 0; p < 3; ++p) ASSERT_TRUE(isCompressed(json, 0, p)) << p;
  const auto extension = [&](size_t p) {
    return json["meshes"][0]["primitives"][p]["extensions"][kExtensionName];
  };
  EXPECT_EQ(extension(0)["attributes"], extension(1)["attributes"]);
  EXPECT_FALSE(extension(0).contains("part"));
  EXPECT_EQ(extension(1)["part"], 1);
  EXPECT_EQ(extension(2)["part"], 1);
  EXPECT_EQ(json["bufferViews"].size(), 2u);  // the payload, and the first indices nobody uses
  const Json decoded = jsonOf(trip.decoded);
  const auto& primitives = decoded["meshes"][0]["primitives"];
  EXPECT_EQ(primitives[0]["attributes"], primitives[1]["attributes"]);
  EXPECT_EQ(primitives[1]["indices"], primitives[2]["indices"]);
}

TEST(Convert, PiecesOfAMeshShareAPayload) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder), Sheet(24, 0.3f).addTo(builder)});
  builder.addMesh({Sheet(18).addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.payloads.size(), 2u);
  const Json json = jsonOf(trip.converted);
  const auto& primitives = json["meshes"][0]["primitives"];
  EXPECT_EQ(primitives[1]["extensions"][kExtensionName]["piece"], 1);
  EXPECT_EQ(primitives[0]["extensions"][kExtensionName]["bufferView"],
            primitives[1]["extensions"][kExtensionName]["bufferView"]);
}

TEST(Convert, SmallMeshesShareAPayload) {
  Builder builder;
  builder.addMesh({Sheet(6).addTo(builder)});
  builder.addMesh({Sheet(20).addTo(builder)});  // too large
  builder.addMesh({Sheet(7).addTo(builder), Sheet(8, 0.3f).addTo(builder)});
  for (int i = 0; i < 2; ++i) builder.addMesh({Sheet(9).addTo(builder)});  // equal
  builder.addMesh({Sheet(5).addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.payloads.size(), 4u);
  const Json json = jsonOf(trip.converted);
  const auto placeOf = [&](size_t mesh, size_t primitive) {
    const Json& extension =
        json["meshes"][mesh]["primitives"][primitive]["extensions"][kExtensionName];
    const uint64_t piece = extension.contains("piece") ? extension["piece"].get<uint64_t>() : 0;
    return std::pair{extension["bufferView"].get<uint64_t>(), piece};
  };
  const uint64_t shared = placeOf(0, 0).first;
  EXPECT_EQ(placeOf(0, 0), (std::pair{shared, uint64_t{0}}));
  EXPECT_EQ(placeOf(2, 0), (std::pair{shared, uint64_t{1}}));
  EXPECT_EQ(placeOf(2, 1), (std::pair{shared, uint64_t{2}}));
  EXPECT_EQ(placeOf(5, 0), (std::pair{shared, uint64_t{3}}));
  EXPECT_NE(placeOf(1, 0).first, shared);
  // Equal meshes have a payload of their own.
  EXPECT_NE(placeOf(3, 0).first, shared);
  EXPECT_EQ(placeOf(3, 0), placeOf(4, 0));
}

/// Meshes that the source has twice, in different accessors, share the bytes of a payload. Their
/// accessors stay apart, and their materials and the numbers of a mesh between them do not matter.
TEST(Convert, TwinsShareAPayload) {
  Builder builder;
  for (const uint32_t size : {20u, 16u, 20u, 20u}) {
    Json primitive = Sheet(size).addTo(builder);
    primitive["material"] = builder.json["meshes"].size();
    builder.addMesh({primitive});
  }
  builder.json["materials"] = Json::array();
  for (int i = 0; i < 4; ++i) builder.json["materials"].push_back(Json::object());
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  const auto primitiveOf = [&](const Json& document, size_t mesh) {
    return document["meshes"][mesh]["primitives"][0];
  };
  const auto viewOf = [&](size_t mesh) {
    return primitiveOf(json, mesh)["extensions"][kExtensionName]["bufferView"].get<uint64_t>();
  };
  EXPECT_EQ(json["bufferViews"].size(), 2u);
  EXPECT_EQ(viewOf(0), viewOf(2));
  EXPECT_EQ(viewOf(0), viewOf(3));
  EXPECT_NE(viewOf(0), viewOf(1));
  ASSERT_EQ(trip.report.payloads.size(), 4u);
  EXPECT_EQ(trip.report.payloads[2].same_as, 0u);
  EXPECT_EQ(trip.report.payloads[3].same_as, 0u);
  EXPECT_EQ(trip.report.payloads[3].payload_bytes, 0u);
  EXPECT_EQ(trip.report.payloads[0].same_as, kNone);
  const Json source = jsonOf(trip.source);
  const Json decoded = jsonOf(trip.decoded);
  for (size_t mesh = 0; mesh < 4; ++mesh) {
    EXPECT_EQ(primitiveOf(decoded, mesh), primitiveOf(source, mesh)) << "accessors of " << mesh;
  }
  for (uint32_t accessor = 0; accessor < source["accessors"].size(); ++accessor) {
    const size_t count = elementsInOrder(trip.source, accessor).size();
    EXPECT_EQ(elementsInOrder(trip.decoded, accessor).size(), count) << accessor;
  }
}

/// Each mesh keeps its lattice and its order, whatever the others of the payload have.
TEST(Convert, SmallMeshesKeepLatticesAndOrders) {
  Builder builder;
  Sheet far(6);
  for (float& x : far.positions) x = x * 1000 + 5000;
  builder.addMesh({Sheet(7).addTo(builder)});
  builder.addMesh({far.addTo(builder)});
  Json ordered = Sheet(8).addTo(builder);
  ordered["extensions"]["VENDOR_order"] = Json::object();
  builder.addMesh({ordered});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  ASSERT_EQ(trip.report.payloads.size(), 2u) << "the order of one mesh must not cost the others";
  EXPECT_EQ(trip.report.payloads[0].piece_count, 2u);
  const Json json = jsonOf(trip.decoded);
  const double near_low = json["accessors"][0]["min"][0].get<double>();
  EXPECT_NEAR(near_low, 0, 1e-3);
}

TEST(Convert, PrimitivesOfAMeshShareTheirGrid) {
  // Two sheets side by side; the vertices of the common edge must stay together.
  Builder builder;
  const Sheet left(20, 0.37f);
  Sheet right(20, 0.37f);
  for (size_t i = 0; i < right.positions.size(); i += 3) right.positions[i + 1] += 1;
  builder.addMesh({left.addTo(builder), right.addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  ASSERT_EQ(trip.report.payloads.size(), 1u);
  const auto a = elementsOf(trip.decoded, 0);
  const auto b = elementsOf(trip.decoded, 4);
  size_t common = 0;
  for (const std::string& element : a) common += b.count(element);
  EXPECT_EQ(common, 21u);
}

/// The border of two sheets is bit-identical where they share a grid: in a mesh, in a scene, with a
/// promised error.
TEST(Convert, BordersMeetWhereTheGridIsShared) {
  const auto commonPoints = [](bool in_one_mesh, const ConvertOptions& options) {
    Builder builder;
    const Sheet left(20, 0.37f);
    Sheet right(20, 0.37f);
    for (size_t i = 0; i < right.positions.size(); i += 3) {
      right.positions[i + 1] = 1 + 1.7f * right.positions[i + 1];
    }
    const Json first = left.addTo(builder);
    const Json second = right.addTo(builder);
    if (in_one_mesh) {
      builder.addMesh({first, second});
    } else {
      builder.addMesh({first});
      builder.addMesh({second});
    }
    const RoundTrip trip = roundTrip(builder, options);
    EXPECT_EQ(trip.error, "");
    const auto a = elementsOf(trip.decoded, 0);
    const auto b = elementsOf(trip.decoded, 4);
    size_t common = 0;
    for (const std::string& element : a) common += b.count(element);
    return common;
  };
  ConvertOptions options;
  EXPECT_EQ(commonPoints(true, options), 21u);
  EXPECT_LT(commonPoints(false, options), 21u);
  options.grid = Grid::kScene;
  EXPECT_EQ(commonPoints(false, options), 21u);
  options.max_position_error = 0.01;
  EXPECT_EQ(commonPoints(false, options), 21u);
  options.grid = Grid::kPrimitive;
  options.max_position_error = 0;
  EXPECT_LT(commonPoints(true, options), 21u);
}

/// Values for which a lattice would be too coarse make their attribute exact; the others keep
/// theirs.
TEST(Convert, OutliersAndNoNumbersMakeAnAttributeExact) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value : {1e38f, -1e38f, 1e6f, infinity, -infinity, nan}) {
    for (const uint32_t accessor : {0u, 2u}) {
      Builder builder;
      Sheet sheet(20);
      std::vector<float>& values = accessor == 0 ? sheet.positions : sheet.texcoords;
      values[7] = value;
      if (accessor == 0) sheet.indices.erase(sheet.indices.begin(), sheet.indices.begin() + 30);
      builder.addMesh({sheet.addTo(builder)});
      for (const char* bound : {"min", "max"}) builder.json["accessors"][0][bound] = {0, 0, 0};
      const RoundTrip trip = roundTrip(builder);
      ASSERT_EQ(trip.error, "") << value;
      EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
      EXPECT_EQ(elementsOf(trip.source, accessor), elementsOf(trip.decoded, accessor)) << value;
      EXPECT_NE(elementsOf(trip.source, 2 - accessor), elementsOf(trip.decoded, 2 - accessor));
      const char* name = accessor == 0 ? "POSITION has " : "TEXCOORD_0 has ";
      EXPECT_TRUE(hasNote(trip.report, name)) << value;
    }
  }
}

TEST(Convert, AccessorsSharedBetweenPiecesAreCloned) {
  Builder builder;
  const Sheet sheet(24);
  const Json first = sheet.addTo(builder);
  Json second = first;
  second["attributes"]["TEXCOORD_0"] = builder.addFloats(sheet.texcoords, 2);
  builder.addMesh({first});
  builder.addMesh({second});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  ASSERT_TRUE(isCompressed(json, 0, 0));
  ASSERT_TRUE(isCompressed(json, 1, 0));
  EXPECT_NE(json["meshes"][0]["primitives"][0]["attributes"]["POSITION"],
            json["meshes"][1]["primitives"][0]["attributes"]["POSITION"]);
  EXPECT_TRUE(hasNote(trip.report, "shares accessor"));
}

TEST(Convert, MeshesWithTheSameGeometryShareOnePayload) {
  Builder builder;
  const Json primitive = Sheet(24).addTo(builder);
  builder.addMesh({primitive});
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.payloads.size(), 1u);
  const Json json = jsonOf(trip.decoded);
  EXPECT_EQ(json["meshes"][0]["primitives"][0], json["meshes"][1]["primitives"][0]);
}

TEST(Convert, PointsKeepTheAccessorsTheyShare) {
  Builder builder;
  const Json primitive = Sheet(24).addTo(builder);
  Json points = {{"attributes", primitive["attributes"]}, {"mode", 0}};
  builder.addMesh({primitive, points});
  const RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(json, 0, 0));
  EXPECT_FALSE(isCompressed(json, 0, 1));
  EXPECT_EQ(elementsOf(trip.source, 0), elementsOf(trip.converted, 0));
  EXPECT_EQ(elementsOf(trip.source, 0), elementsOf(trip.decoded, 0));
}

TEST(Convert, AnAccessorUsedTwiceInAPieceIsCloned) {
  Builder builder;
  Json primitive = Sheet(24).addTo(builder);
  primitive["attributes"]["TEXCOORD_1"] = primitive["attributes"]["TEXCOORD_0"];
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
}

TEST(Convert, StripsFansAndUnindexedBecomeTriangles) {
  for (const int mode : {4, 5, 6}) {
    for (const bool is_indexed : {false, true}) {
      Builder builder;
      const Sheet sheet(11);  // 144 vertices: a multiple of three
      Json primitive = {{"attributes", {{"POSITION", builder.addPositions(sheet.positions)}}},
                        {"mode", mode}};
      if (is_indexed) {
        std::vector<uint16_t> indices;
        for (uint16_t i = 0; i < sheet.count(); ++i) indices.push_back(i);
        primitive["indices"] = builder.addIndices(indices);
      }
      builder.addMesh({primitive});
      const RoundTrip trip = roundTrip(builder, evenIfLarger());
      ASSERT_EQ(trip.error, "") << mode;
      const Json json = jsonOf(trip.decoded);
      const Json& decoded = json["meshes"][0]["primitives"][0];
      EXPECT_EQ(decoded["mode"], 4);
      const size_t triangles = mode == 4 ? sheet.count() / 3 : sheet.count() - 2;
      EXPECT_EQ(json["accessors"][decoded["indices"].get<size_t>()]["count"], 3 * triangles);
    }
  }
}

TEST(Convert, MorphTargetsAreCompressedWithTheMesh) {
  Builder builder;
  const Sheet sheet(24);
  Json primitive = sheet.addTo(builder);
  std::vector<float> deltas(sheet.positions.size(), 0.0f);
  for (size_t i = 0; i < deltas.size(); i += 15) deltas[i] = 0.01f * static_cast<float>(i % 7);
  const std::vector<float> normal_deltas(sheet.normals.size(), 0.125f);
  primitive["targets"] = {
      {{"POSITION", builder.addPositions(deltas)}, {"NORMAL", builder.addFloats(normal_deltas, 3)}},
      {{"POSITION", builder.addPositions(sheet.positions)}}};
  builder.addMesh({primitive});
  builder.json["meshes"][0]["weights"] = {0.5, 0.25};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  ASSERT_TRUE(isCompressed(json, 0, 0));
  const Json& extension = json["meshes"][0]["primitives"][0]["extensions"][kExtensionName];
  ASSERT_EQ(extension["targets"].size(), 2u);
  EXPECT_TRUE(extension["targets"][0].contains("NORMAL"));
  // Vertices that did not move do not move.
  const std::string zero(12, '\0');
  const uint32_t accessor = primitive["targets"][0]["POSITION"];
  EXPECT_EQ(elementsOf(trip.source, accessor).count(zero),
            elementsOf(trip.decoded, accessor).count(zero));
}

TEST(Convert, WeightsStillAddUpToOne) {
  Builder builder;
  const Sheet sheet(24);
  Json primitive = sheet.addTo(builder);
  std::vector<float> weights;
  std::vector<uint8_t> joints;
  for (uint32_t i = 0; i < sheet.count(); ++i) {
    const float a = 0.37f + 0.0005f * static_cast<float>(i % 997);
    const float b = (1 - a) * 0.61f;
    weights.insert(weights.end(), {a, b, 1 - a - b, 0});
    joints.insert(joints.end(), {0, 1, 2, 0});
  }
  primitive["attributes"]["WEIGHTS_0"] = builder.addFloats(weights, 4);
  primitive["attributes"]["JOINTS_0"] =
      builder.addAccessor(joints, kUnsignedByte, "VEC4", sheet.count());
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  Document document;
  ASSERT_TRUE(loadDocument(trip.decoded, nullptr, document).ok());
  AccessorData data;
  ASSERT_TRUE(readAccessor(document, primitive["attributes"]["WEIGHTS_0"], data).ok());
  for (uint64_t i = 0; i < data.count; ++i) {
    double sum = 0;
    for (uint32_t c = 0; c < 4; ++c) {
      sum += componentValue(data.element(i).data() + 4 * c, ComponentType::kFloat32);
    }
    ASSERT_NEAR(sum, 1, 3e-7);
    ASSERT_EQ(componentValue(data.element(i).data() + 12, ComponentType::kFloat32), 0);
  }
}

TEST(Convert, TangentSignsStay) {
  Builder builder;
  const Sheet sheet(24);
  Json primitive = sheet.addTo(builder);
  std::vector<float> tangents;
  for (uint32_t i = 0; i < sheet.count(); ++i) {
    const float angle = 0.01f * static_cast<float>(i);
    tangents.insert(tangents.end(),
                    {std::cos(angle), std::sin(angle), 0, i % 3 == 0 ? -1.0f : 1.0f});
  }
  primitive["attributes"]["TANGENT"] = builder.addFloats(tangents, 4);
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  size_t negative = 0;
  for (const std::string& element : elementsOf(trip.decoded, primitive["attributes"]["TANGENT"])) {
    float sign = 0;
    std::memcpy(&sign, element.data() + 12, 4);
    ASSERT_EQ(std::abs(sign), 1.0f);
    negative += sign < 0 ? 1 : 0;
  }
  EXPECT_EQ(negative, (sheet.count() + 2) / 3);
}

TEST(Convert, IntegersAndCustomAttributesStayExact) {
  Builder builder;
  const Sheet sheet(24);
  Json primitive = sheet.addTo(builder);
  std::vector<uint8_t> bytes;
  std::vector<uint16_t> shorts;
  std::vector<float> matrices;
  for (uint32_t i = 0; i < sheet.count(); ++i) {
    bytes.insert(bytes.end(), {static_cast<uint8_t>(i), 7, static_cast<uint8_t>(i / 3), 255});
    shorts.push_back(static_cast<uint16_t>(65535 - i));
    shorts.push_back(static_cast<uint16_t>(i));
    for (int c = 0; c < 9; ++c) matrices.push_back(static_cast<float>(c) + 0.1f);
  }
  Json& attributes = primitive["attributes"];
  attributes["COLOR_0"] = builder.addAccessor(bytes, kUnsignedByte, "VEC4", sheet.count());
  builder.json["accessors"].back()["normalized"] = true;
  attributes["_ID"] = builder.addAccessor(shorts, kUnsignedShort, "VEC2", sheet.count());
  attributes["_FRAME"] = builder.addAccessor(matrices, kFloat, "MAT3", sheet.count());
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  for (const char* name : {"COLOR_0", "_ID", "_FRAME"}) {
    EXPECT_EQ(elementsOf(trip.source, attributes[name]), elementsOf(trip.decoded, attributes[name]))
        << name;
  }
  EXPECT_EQ(jsonOf(trip.decoded)["accessors"][attributes["COLOR_0"].get<size_t>()]["normalized"],
            true);
}

TEST(Convert, TinyMeshesStayAsTheyWere) {
  Builder builder;
  builder.addMesh({Sheet(1).addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(trip.report.copied);
  EXPECT_EQ(trip.converted, trip.source);
  EXPECT_TRUE(hasNote(trip.report, "would not become smaller"));
}

TEST(Convert, TinyMeshesBesideLargeOnesStayAndKeepTheirBytes) {
  Builder builder;
  builder.addMesh({Sheet(1).addTo(builder)});
  builder.addMesh({Sheet(24).addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_FALSE(isCompressed(json, 0, 0));
  EXPECT_TRUE(isCompressed(json, 1, 0));
  EXPECT_EQ(elementsOf(trip.source, 0), elementsOf(trip.converted, 0));
}

/// Files never grow per primitive: the loss of a tiny one is not hidden by the gain of a large one
/// in the same mesh.
TEST(Convert, TinyPrimitivesOfALargeMeshStayAsTheyWere) {
  Builder builder;
  Sheet apart(1);
  for (float& x : apart.positions) x += 5;
  builder.addMesh({Sheet(24).addTo(builder), apart.addTo(builder), Sheet(1).addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(json, 0, 0));
  EXPECT_FALSE(isCompressed(json, 0, 1));
  EXPECT_TRUE(isCompressed(json, 0, 2)) << "its corners are also the first one's";
  EXPECT_TRUE(hasNote(trip.report, "/meshes/0/primitives/1: would not become smaller"));
}

/// Primitives of different meshes may have equal positions, and do not meet there.
TEST(Convert, TinyMeshesDoNotTouchEachOther) {
  Builder builder;
  for (const uint32_t size : {6u, 7u}) builder.addMesh({Sheet(size).addTo(builder)});
  const Sheet tiny(1);  // it has the corners of the others
  builder.addMesh({{{"attributes", {{"POSITION", builder.addPositions(tiny.positions)}}},
                    {"indices", builder.addIndices(tiny.indices)}}});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_TRUE(isCompressed(json, 0, 0));
  EXPECT_TRUE(isCompressed(json, 1, 0));
  EXPECT_FALSE(isCompressed(json, 2, 0));
}

TEST(Convert, OneViewForAllIsTrimmed) {
  // As many exporters do: all accessors one after the other in one view.
  Builder builder;
  builder.addMesh({Sheet(1).addTo(builder)});
  builder.addMesh({Sheet(24).addTo(builder)});
  for (Json& accessor : builder.json["accessors"]) {
    const size_t view = accessor["bufferView"];
    accessor["byteOffset"] = builder.json["bufferViews"][view]["byteOffset"];
    accessor["bufferView"] = 0;
  }
  builder.json["bufferViews"] = {{{"buffer", 0}, {"byteLength", builder.bin.size()}}};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_LT(trip.converted.size() * 3, trip.source.size());
  EXPECT_EQ(elementsOf(trip.source, 0), elementsOf(trip.converted, 0));
  EXPECT_EQ(elementsOf(trip.source, 3), elementsOf(trip.converted, 3));
}

TEST(Convert, InterleavedAttributes) {
  Builder builder;
  const Sheet sheet(24);
  std::vector<float> vertices;
  for (uint32_t i = 0; i < sheet.count(); ++i) {
    vertices.insert(vertices.end(), &sheet.positions[3 * i], &sheet.positions[3 * i] + 3);
    vertices.insert(vertices.end(), &sheet.texcoords[2 * i], &sheet.texcoords[2 * i] + 2);
  }
  const uint32_t view = builder.addView(bytesOf(vertices), 20);
  const Json position = {
      {"bufferView", view}, {"componentType", kFloat}, {"count", sheet.count()}, {"type", "VEC3"}};
  Json texcoord = position;
  texcoord["byteOffset"] = 12;
  texcoord["type"] = "VEC2";
  const Json primitive = {{"attributes",
                           {{"POSITION", builder.addAccessor(position)},
                            {"TEXCOORD_0", builder.addAccessor(texcoord)}}},
                          {"indices", builder.addIndices(sheet.indices)}};
  builder.addMesh({primitive});
  RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(jsonOf(trip.converted)["bufferViews"].size(), 1u);

  // If something else uses the texture coordinates, the vertices stay and are readable.
  const Json points = {{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"mode", 0}};
  builder.addMesh({points});
  trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(elementsOf(trip.source, 1), elementsOf(trip.converted, 1));
}

TEST(Convert, OverlappingViewsAreNotDoubled) {
  Builder builder;
  builder.addMesh({Sheet(24).addTo(builder)});
  const std::vector<uint8_t> image(5000, 'x');
  const uint32_t first = builder.addView(image);
  builder.json["bufferViews"].push_back(builder.json["bufferViews"][first]);
  builder.json["images"] = {{{"bufferView", first}, {"mimeType", "image/png"}},
                            {{"bufferView", first + 1}, {"mimeType", "image/png"}}};
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Json json = jsonOf(trip.converted);
  EXPECT_LT(json["buffers"][0]["byteLength"].get<size_t>(), 10000u);
  EXPECT_EQ(json["bufferViews"][0]["byteLength"], 5000);
  EXPECT_EQ(json["bufferViews"][1]["byteLength"], 5000);
}

TEST(Convert, UnknownChunksSurvive) {
  Builder builder;
  builder.addMesh({Sheet(24).addTo(builder)});
  const std::vector<uint8_t> extra = {1, 2, 3, 4};
  const GlbChunk chunk = {0x31415926, extra};
  std::vector<uint8_t> file;
  Json json = builder.json;
  json["buffers"] = {{{"byteLength", builder.bin.size()}}};
  ASSERT_TRUE(writeGlb(printJson(json), builder.bin, {&chunk, 1}, file).ok());
  const RoundTrip trip = roundTrip(file);
  ASSERT_EQ(trip.error, "");
  for (const auto* bytes : {&trip.converted, &trip.decoded}) {
    GlbFile glb;
    ASSERT_TRUE(readGlb(*bytes, glb).ok());
    ASSERT_EQ(glb.otherChunks({}).size(), 1u);
    EXPECT_EQ(glb.otherChunks({})[0].type, 0x31415926u);
    EXPECT_EQ(glb.otherChunks({})[0].bytes[3], 4);
  }
}

TEST(Convert, ElementsStayAligned) {
  Builder builder;
  builder.addMesh({Sheet(1).addTo(builder)});
  builder.addMesh({Sheet(24).addTo(builder)});
  builder.addMesh({Sheet(2).addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  for (const auto* bytes : {&trip.converted, &trip.decoded}) {
    Document document;
    ASSERT_TRUE(loadDocument(*bytes, nullptr, document).ok());
    for (const Accessor& accessor : document.accessors) {
      if (accessor.view == kNone) continue;
      const uint64_t offset = document.views[accessor.view].offset + accessor.offset;
      EXPECT_EQ(offset % componentBytes(accessor.component_type), 0u);
    }
  }
}

TEST(Convert, ConvertingAgainChangesNothing) {
  Builder builder;
  builder.addMesh({Sheet(24).addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const RoundTrip again = roundTrip(trip.converted);
  ASSERT_EQ(again.error, "");
  EXPECT_EQ(again.converted, trip.converted);
  EXPECT_TRUE(again.report.copied);
}

TEST(Convert, SecondRoundIsStable) {
  // Decoded data lie on the lattice, so compressing them again loses nothing more.
  Builder builder;
  builder.addMesh({Sheet(24, 0.123f).addTo(builder)});
  const RoundTrip first = roundTrip(builder);
  ASSERT_EQ(first.error, "");
  const RoundTrip second = roundTrip(first.decoded);
  ASSERT_EQ(second.error, "");
  EXPECT_EQ(elementsOf(first.decoded, 0), elementsOf(second.decoded, 0));
}

TEST(Convert, ThreadsDoNotChangeTheResult) {
  Builder builder;
  for (uint32_t n = 10; n < 30; n += 2) builder.addMesh({Sheet(n).addTo(builder)});
  std::vector<Json> primitives;  // of one payload, some too small for it
  for (uint32_t n = 2; n < 20; n += 3)
    primitives.push_back(Sheet(n, 2.0f * static_cast<float>(n)).addTo(builder));
  builder.addMesh(primitives);
  ConvertOptions options;
  const RoundTrip one = roundTrip(builder, options);
  ASSERT_EQ(one.error, "");
  for (const uint32_t thread_count : {2u, 4u, 64u}) {
    options.thread_count = thread_count;
    const RoundTrip many = roundTrip(builder, options);
    EXPECT_EQ(one.converted, many.converted) << thread_count;
    EXPECT_EQ(one.report.notes, many.report.notes) << thread_count;
  }
}

TEST(Convert, TextWithDataUrisIsRead) {
  Builder builder;
  builder.addMesh({Sheet(12).addTo(builder)});
  Json json = builder.json;
  std::string uri = "data:application/octet-stream,";
  for (const uint8_t byte : builder.bin) {
    static constexpr char kDigits[] = "0123456789abcdef";
    uri += {'%', kDigits[byte / 16], kDigits[byte % 16]};
  }
  json["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", uri}}};
  const std::string text = json.dump(2);
  std::vector<uint8_t> output;
  ConvertReport report;
  const Result result = convertGlb(asBytes(text), {}, output, report);
  ASSERT_TRUE(result.ok()) << result.message();
  EXPECT_TRUE(isCompressed(jsonOf(output), 0, 0));
  EXPECT_FALSE(jsonOf(output)["buffers"][0].contains("uri"));
}

std::string convertError(const Builder& builder) { return roundTrip(builder).error; }

TEST(ConvertErrors, WrongKinds) {
  const auto with = [](const std::function<void(Json&)>& damage) {
    Builder builder;
    builder.addMesh({Sheet(4).addTo(builder)});
    damage(builder.json);
    return convertError(builder);
  };
  EXPECT_NE(with([](Json& j) { j["asset"]["version"] = "1.0"; }).find("glTF 1.0"),
            std::string::npos);
  EXPECT_NE(with([](Json& j) { j.erase("asset"); }).find("not a glTF"), std::string::npos);
  EXPECT_NE(with([](Json& j) { j["meshes"] = 3; }).find("/meshes: must be an array"),
            std::string::npos);
  EXPECT_NE(with([](Json& j) { j["extensionsUsed"] = "all"; }).find("/extensionsUsed"),
            std::string::npos);
  EXPECT_NE(with([](Json& j) { j["meshes"][0] = nullptr; }), "");
  EXPECT_NE(with([](Json& j) { j["meshes"][0]["primitives"][0] = 1; }), "");
  EXPECT_NE(with([](Json& j) { j["accessors"][0] = 1; }), "");
  EXPECT_NE(with([](Json& j) { j["bufferViews"][0]["buffer"] = 1; }), "");
  EXPECT_NE(with([](Json& j) { j["bufferViews"][0]["byteLength"] = "all"; }), "");
}

TEST(ConvertErrors, WhatCannotBeCodedIsLeftAlone) {
  const auto noteOf = [](const std::function<void(Json&)>& change) {
    Builder builder;
    builder.addMesh({Sheet(20).addTo(builder)});
    change(builder.json);
    const RoundTrip trip = roundTrip(builder);
    EXPECT_EQ(trip.error, "");
    EXPECT_TRUE(trip.report.copied);
    return trip.report.notes.empty() ? "" : trip.report.notes[0];
  };
  EXPECT_NE(noteOf([](Json& j) {
              j["meshes"][0]["primitives"][0]["attributes"].erase("POSITION");
            }).find("no POSITION"),
            std::string::npos);
  EXPECT_NE(noteOf([](Json& j) { j["accessors"][1]["count"] = 440; }).find("elements of NORMAL"),
            std::string::npos);
  EXPECT_NE(noteOf([](Json& j) { j["accessors"][3]["count"] = 2399; }).find("no triangles"),
            std::string::npos);
  EXPECT_NE(noteOf([](Json& j) {
              j["accessors"][1]["componentType"] = 5130;
            }).find("type that payloads cannot hold"),
            std::string::npos);
  EXPECT_NE(noteOf([](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 9; }).find("mode 9"),
            std::string::npos);
  EXPECT_NE(noteOf([](Json& j) { j["accessors"][3]["normalized"] = true; }).find("is normalized"),
            std::string::npos);
  EXPECT_NE(noteOf([](Json& j) {
              j["accessors"].push_back(
                  {{"componentType", 5123}, {"count", 30000000}, {"type", "SCALAR"}});
              j["meshes"][0]["primitives"][0]["indices"] = 4;
            }).find("no bytes in the file"),
            std::string::npos);
}

/// The files next to it are read as if the path alone had been given, and the file itself is not.
TEST(Convert, BytesOfAFileStandForIt) {
  Builder builder;
  builder.addMesh({Sheet(30).addTo(builder)});
  const std::vector<uint8_t> source = builder.toGlb();
  const mcc::test::ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "a.gltf";
  ConvertReport report;
  ASSERT_EQ(convert({"in.glb", source}, {path}, {}, report).message(), "");
  std::vector<uint8_t> expected;
  FilesInUse expected_files;
  DecodeReport decoded;
  ASSERT_EQ(decode({path, {}}, {{}, &expected}, decoded, {}, &expected_files).message(), "");
  ASSERT_EQ(expected_files.input.size(), 2u);

  std::vector<uint8_t> bytes;
  ASSERT_TRUE(readFile(path, bytes).ok());
  std::filesystem::remove(path);
  std::vector<uint8_t> output;
  FilesInUse files;
  EXPECT_FALSE(decode({path, bytes}, {{}, &output}, decoded).ok());
  ASSERT_EQ(decode({path, bytes, true}, {{}, &output}, decoded, {}, &files).message(), "");
  EXPECT_EQ(output, expected);
  EXPECT_EQ(files.input, expected_files.input);
  ASSERT_EQ(convert({path, bytes, true}, {{}, &output}, {}, report, &files).message(), "");
  EXPECT_EQ(files.input, expected_files.input);
  ValidationReport validation;
  ASSERT_EQ(validate({path, bytes, true}, {}, validation).message(), "");
  EXPECT_TRUE(validation.isValid());
}

}  // namespace
}  // namespace mcc::gltf::test
