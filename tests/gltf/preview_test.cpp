// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Previews of large primitives: what convert() puts in front, and what everyone else makes of it.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <set>

#include "gltf/check/check.h"
#include "gltf/check/prove.h"
#include "gltf/decompress/decompress.h"
#include "gltf/document/extension_uses.h"
#include "gltf/round_trip.h"

namespace mcc::gltf::test {
namespace {

constexpr char kPath[] = "/meshes/0/primitives/0/extensions/KHR_mesh_collapse_compression/preview";
constexpr uint32_t kLarge = 224;  // a sheet of this size has just enough triangles

/// Keeps triangles that are far from each other. Whoever looks at them does not matter here.
Result thinOut(const TriangleList& list, uint64_t triangle_count, std::vector<uint32_t>& thinned) {
  const size_t step = list.triangles.size() / 3 / triangle_count;
  thinned.clear();
  for (size_t i = 0; thinned.size() < 3 * triangle_count; i += step) {
    thinned.insert(thinned.end(), &list.triangles[3 * i], &list.triangles[3 * i] + 3);
  }
  return {};
}

ConvertOptions withPreview(uint32_t triangles = kPreviewsByShare, Simplify simplify = thinOut) {
  ConvertOptions options;
  options.preview_triangles = triangles;
  options.simplify = std::move(simplify);
  return options;
}

Json& extensionIn(Json& json, size_t mesh, size_t primitive) {
  return json["meshes"][mesh]["primitives"][primitive]["extensions"][kExtensionName];
}

DecodedPayload decodedView(const std::vector<uint8_t>& file, uint64_t view, Document& document) {
  DecodedPayload decoded;
  EXPECT_EQ(loadDocument(file, nullptr, document).message(), "");
  EXPECT_EQ(
      decodePayload(payloadBytes(document, static_cast<uint32_t>(view)), "", decoded).message(),
      "");
  return decoded;
}

std::set<std::string> elementsOf(const std::vector<uint8_t>& tight, size_t bytes) {
  std::set<std::string> elements;
  for (size_t i = 0; i < tight.size(); i += bytes) {
    elements.emplace(tight.begin() + static_cast<ptrdiff_t>(i),
                     tight.begin() + static_cast<ptrdiff_t>(i + bytes));
  }
  return elements;
}

/// A document with an image, a large primitive and a small one.
class PreviewInFront : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Builder builder;
    const uint32_t image = builder.addView({1, 2, 3, 4, 5, 6});
    builder.json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
    builder.addMesh({Sheet(kLarge).addTo(builder), Sheet(9).addTo(builder)});
    with_ = new RoundTrip(roundTrip(builder, withPreview()));
    without_ = new RoundTrip(roundTrip(builder));
  }
  static void TearDownTestSuite() {
    delete with_;
    delete without_;
  }
  static RoundTrip* with_;
  static RoundTrip* without_;
};
RoundTrip* PreviewInFront::with_ = nullptr;
RoundTrip* PreviewInFront::without_ = nullptr;

TEST_F(PreviewInFront, IsInFrontOfEverything) {
  ASSERT_EQ(with_->error, "");
  Json json = jsonOf(with_->converted);
  const Json& preview = extensionIn(json, 0, 0)["preview"];
  ASSERT_TRUE(preview.is_object());
  EXPECT_EQ(preview.size(), 1u) << "piece and part 0 are not spelled out";
  const Json& view = json["bufferViews"][preview["bufferView"].get<size_t>()];
  EXPECT_EQ(view["byteOffset"].get<uint64_t>(), 0u);
  EXPECT_EQ(view["byteLength"].get<uint64_t>(), with_->report.preview_bytes);
  EXPECT_FALSE(extensionIn(json, 0, 1).contains("preview")) << "is small";
  EXPECT_EQ(with_->report.primitives[0].preview_triangle_count, 2007u);
  EXPECT_EQ(with_->report.primitives[1].preview_triangle_count, 0u);
}

TEST_F(PreviewInFront, HasVerticesOfTheWhole) {
  ASSERT_EQ(with_->error, "");
  Json json = jsonOf(with_->converted);
  const Json& extension = extensionIn(json, 0, 0);
  Document document;
  const DecodedPayload whole =
      decodedView(with_->converted, extension["bufferView"].get<uint64_t>(), document);
  const DecodedPayload preview =
      decodedView(with_->converted, extension["preview"]["bufferView"].get<uint64_t>(), document);
  EXPECT_EQ(preview.pieces[0].parts[0].size(), 3u * 2007);
  EXPECT_EQ(preview.payload.info().pieces[0].blocks.size(), 0u);
  for (const char* name : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
    const auto id = extension["attributes"][name].get<size_t>();
    const AttributeInfo& a = whole.payload.info().pieces[0].attributes[id];
    const AttributeInfo& b = preview.payload.info().pieces[0].attributes[id];
    EXPECT_EQ(a.format, b.format) << name;
    EXPECT_EQ(a.bits, b.bits) << name;
    EXPECT_EQ(a.lattice, b.lattice) << name;
    const size_t bytes = elementBytes(a.format);
    const std::set<std::string> known = elementsOf(whole.pieces[0].attributes[id], bytes);
    for (const std::string& element : elementsOf(preview.pieces[0].attributes[id], bytes)) {
      ASSERT_TRUE(known.contains(element)) << name;
    }
  }
}

TEST_F(PreviewInFront, IsDroppedByDecoding) {
  ASSERT_EQ(with_->error, "");
  EXPECT_EQ(with_->decoded, without_->decoded);
  DecodeReport report;
  std::vector<uint8_t> decoded;
  ASSERT_TRUE(decodeGlb(with_->converted, decoded, report).ok());
  EXPECT_EQ(report.payload_count, with_->report.payloads.size());
  EXPECT_EQ(report.triangle_count, 2u * kLarge * kLarge + 2 * 9 * 9);
}

TEST_F(PreviewInFront, IsKnownToInspectAndValidate) {
  ASSERT_EQ(with_->error, "");
  InspectReport inspected;
  ASSERT_TRUE(inspectGlb(with_->converted, true, inspected).ok());
  size_t previews = 0;
  for (const InspectPayload& payload : inspected.payloads) {
    if (!payload.is_preview) continue;
    ++previews;
    EXPECT_EQ(payload.primitives, std::vector<std::string>{"/meshes/0/primitives/0"});
    EXPECT_EQ(payload.pieces[0].details[1].name, "NORMAL");
  }
  EXPECT_EQ(previews, 1u);
  ValidationReport report;
  ASSERT_TRUE(validateGlb(with_->converted, {}, report).ok());
  EXPECT_TRUE(report.issues.empty()) << report.issues[0].message;
  EXPECT_EQ(report.triangle_count, 2u * kLarge * kLarge + 2 * 9 * 9);
}

TEST_F(PreviewInFront, StaysWhenTheRestIsCompressedLater) {
  ASSERT_EQ(with_->error, "");
  Document document;
  ASSERT_TRUE(loadDocument(with_->converted, nullptr, document).ok());
  Builder builder;
  builder.json = document.json;
  builder.bin.assign(document.buffers[0].begin(), document.buffers[0].end());
  builder.addMesh({Sheet(20).addTo(builder)});
  const RoundTrip again = roundTrip(builder);
  ASSERT_EQ(again.error, "");
  Json json = jsonOf(again.converted);
  ASSERT_TRUE(isCompressed(json, 1, 0));
  const auto bytesIn = [](const std::vector<uint8_t>& file, Json in) {
    Document loaded;
    EXPECT_TRUE(loadDocument(file, nullptr, loaded).ok());
    const std::span<const uint8_t> bytes =
        payloadBytes(loaded, extensionIn(in, 0, 0)["preview"]["bufferView"].get<uint32_t>());
    return std::vector<uint8_t>(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(bytesIn(again.converted, json), bytesIn(with_->converted, jsonOf(with_->converted)));
}

TEST(Preview, HasAsManyTrianglesAsAskedFor) {
  Builder builder;
  builder.addMesh({Sheet(kLarge).addTo(builder)});
  const RoundTrip trip = roundTrip(builder, withPreview(500));
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.primitives[0].preview_triangle_count, 500u);
}

TEST(Preview, IsLeftOutWithARemarkWhereItCannotBeMade) {
  Builder builder;
  builder.addMesh({Sheet(kLarge).addTo(builder)});
  const std::vector<uint8_t> source = builder.toGlb();
  const auto remarkOf = [&](const Simplify& simplify) {
    std::vector<uint8_t> output;
    ConvertReport report;
    const Result result =
        convertGlb(source, withPreview(kPreviewsByShare, simplify), output, report);
    if (!result.ok()) return result.message();
    EXPECT_EQ(report.preview_bytes, 0u);
    return report.remarks.empty() ? "" : report.remarks.back();
  };
  EXPECT_EQ(remarkOf([](const TriangleList&, uint64_t, std::vector<uint32_t>&) -> Result {
              return {"", "no such thing"};
            }),
            "/meshes/0/primitives/0: gets no preview: no such thing");
  EXPECT_EQ(remarkOf([](const TriangleList& list, uint64_t, std::vector<uint32_t>& triangles) {
              triangles.assign(list.triangles.begin(), list.triangles.end());
              return Result();
            }),
            "/meshes/0/primitives/0: gets no preview: its surface cannot be simplified");
  EXPECT_EQ(remarkOf([](const TriangleList& list, uint64_t, std::vector<uint32_t>& triangles) {
              triangles = {0, 1, static_cast<uint32_t>(list.positions.size() / 3)};
              return Result();
            }),
            "/meshes/0/primitives/0: `simplify` returns triangles that are none of the mesh");
}

TEST(Preview, IsMadeWithoutAFunction) {
  const Sheet sheet(kLarge);
  Builder shared;
  shared.addMesh({sheet.addTo(shared)});
  // With vertices of its own for each triangle, a surface is nothing but seams.
  std::vector<float> apart;
  for (const uint16_t vertex : sheet.indices) {
    apart.insert(apart.end(), &sheet.positions[size_t{3} * vertex],
                 &sheet.positions[size_t{3} * vertex] + 3);
  }
  Builder soup;
  soup.addMesh({{{"attributes", {{"POSITION", soup.addPositions(apart)}}}}});
  for (const Builder* builder : {&shared, &soup}) {
    const RoundTrip trip = roundTrip(*builder, withPreview(2000, nullptr));
    ASSERT_EQ(trip.error, "");
    const uint64_t count = trip.report.primitives[0].preview_triangle_count;
    EXPECT_LE(count, 2000u);
    EXPECT_GT(count, 1500u);
    Document document;
    const Json json = jsonOf(trip.converted);
    const Json* const extension =
        findMember(json["meshes"][0]["primitives"][0]["extensions"], kExtensionName);
    const DecodedPayload preview = decodedView(
        trip.converted, (*extension)["preview"]["bufferView"].get<uint64_t>(), document);
    // It covers the sheet, once: seen from above, its triangles have the area of a square.
    const std::vector<uint8_t>& bytes = preview.pieces[0].attributes[0];
    std::vector<float> positions(bytes.size() / sizeof(float));
    std::memcpy(positions.data(), bytes.data(), bytes.size());
    double area = 0;
    const auto& corners = preview.pieces[0].parts[0];
    for (size_t i = 0; i < corners.size(); i += 3) {
      const float* const a = &positions[size_t{3} * corners[i]];
      const float* const b = &positions[size_t{3} * corners[i + 1]];
      const float* const c = &positions[size_t{3} * corners[i + 2]];
      area += double{(b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])} / 2;
    }
    EXPECT_NEAR(area, 1, 0.1);
  }
}

TEST(Preview, WithoutAFunctionIsLeftOutWhereNothingWouldBeLeft) {
  Sheet sheet(kLarge);
  for (size_t i = 0; i < sheet.positions.size(); ++i) {  // no triangle has three places
    if (i % 3 != 0) sheet.positions[i] = 0;
  }
  Builder builder;
  builder.addMesh({sheet.addTo(builder)});
  std::vector<uint8_t> output;
  ConvertReport report;
  const ConvertOptions options = withPreview(1, nullptr);
  ASSERT_EQ(convertGlb(builder.toGlb(), options, output, report).message(), "");
  ASSERT_FALSE(report.remarks.empty());
  EXPECT_EQ(report.remarks.back(),
            "/meshes/0/primitives/0: gets no preview: its surface cannot be simplified");
}

TEST(Preview, GetsPositionsFromZeroToOne) {
  Builder builder;
  Sheet sheet(kLarge);
  for (size_t i = 0; i < sheet.positions.size(); ++i) {
    sheet.positions[i] = sheet.positions[i] * 1000 + 5e6f;
  }
  builder.addMesh({sheet.addTo(builder)});
  float low = 1;
  float high = 0;
  const auto look = [&](const TriangleList& list, uint64_t count, std::vector<uint32_t>& thinned) {
    for (const float x : list.positions) low = std::min(low, x), high = std::max(high, x);
    return thinOut(list, count, thinned);
  };
  ASSERT_EQ(roundTrip(builder, withPreview(kPreviewsByShare, look)).error, "");
  EXPECT_EQ(low, 0);
  EXPECT_EQ(high, 1);
}

TEST(Preview, OfPartsOfAPieceIsForLargeOnes) {
  Builder builder;
  Json large = Sheet(kLarge).addTo(builder);
  Json small = large;
  small["indices"] = builder.addIndices({0, 1, 2, 2, 1, 3});
  builder.addMesh({small, large});
  const RoundTrip trip = roundTrip(builder, withPreview());
  ASSERT_EQ(trip.error, "");
  Json json = jsonOf(trip.converted);
  EXPECT_FALSE(extensionIn(json, 0, 0).contains("preview"));
  const Json& extension = extensionIn(json, 0, 1);
  EXPECT_EQ(extension["part"].get<int>(), 1);
  ASSERT_TRUE(extension["preview"].is_object());
  EXPECT_FALSE(extension["preview"].contains("part")) << "it is the only part of its piece";
}

TEST(Preview, OptionsThatContradictAreRefused) {
  std::vector<uint8_t> output;
  ConvertReport report;
  Builder builder;
  builder.addMesh({Sheet(9).addTo(builder)});
  ConvertOptions options = withPreview();
  options.indices_only = true;
  EXPECT_EQ(convertGlb(builder.toGlb(), options, output, report).message(),
            "a preview holds attributes, too: it can be made only without indices_only");
}

TEST(Preview, IsProvedAndChecked) {
  Builder builder;
  builder.addMesh({Sheet(kLarge).addTo(builder)});
  const std::vector<uint8_t> file = builder.toGlb();
  Document source;
  ASSERT_TRUE(loadDocument(file, nullptr, source).ok());
  Compressed compressed;
  ASSERT_TRUE(compressDocument(source, withPreview(), compressed).ok());
  std::vector<PayloadProof> proofs;
  ASSERT_TRUE(provePayloads(source, 1, compressed.payloads, proofs).ok());
  ASSERT_TRUE(provePayloads(source, 1, compressed.previews, proofs).ok());
  storePayloads(source, compressed);
  const auto verdict = [&](const Json& json, size_t damaged) {
    std::vector<uint8_t> bin(compressed.layout.byte_count);
    compressed.layout.copyTo(bin);
    if (damaged != 0) bin[damaged] ^= 1;
    CheckResult result;
    return checkConversion(source, compressed, {}, glbOf(json, bin), nullptr, 1, result).message();
  };
  EXPECT_EQ(verdict(compressed.json, 0), "");
  Json without = compressed.json;
  extensionIn(without, 0, 0).erase("preview");
  EXPECT_NE(verdict(without, 0).find("has no preview"), std::string::npos);
  Json other = compressed.json;
  extensionIn(other, 0, 0)["preview"]["bufferView"] = extensionIn(other, 0, 0)["bufferView"];
  EXPECT_NE(verdict(other, 0).find("its preview is not the one"), std::string::npos);
  EXPECT_NE(verdict(compressed.json, 100), "") << "decoding notices it";
  std::swap(compressed.previews[0].plan.pieces[0].parts[0].triangles[0],
            compressed.previews[0].plan.pieces[0].parts[0].triangles[1]);
  EXPECT_NE(
      provePayloads(source, 1, compressed.previews, proofs).message().find("triangles differ"),
      std::string::npos);
}

// ---- Small documents, whose previews are made by hand

/// A compressed sheet with a coarser one as its preview.
struct Made {
  Builder builder;
  uint32_t preview = 0;  ///< its view

  Made() {
    const std::vector<uint8_t> coarse = converted(4, {});
    const std::vector<uint8_t> fine = converted(12, {});
    Document document;
    EXPECT_TRUE(loadDocument(fine, nullptr, document).ok());
    builder.json = document.json;
    builder.bin.assign(document.buffers[0].begin(), document.buffers[0].end());
    preview = builder.addView(payloadOf(coarse));
    extension()["preview"] = {{"bufferView", preview}};
  }

  static std::vector<uint8_t> converted(uint32_t size, const std::function<void(Json&)>& change) {
    Builder plain;
    Json primitive = Sheet(size).addTo(plain);
    if (change) change(primitive);
    plain.addMesh({primitive});
    return roundTrip(plain, evenIfLarger()).converted;
  }
  static std::vector<uint8_t> payloadOf(const std::vector<uint8_t>& file) {
    Document document;
    EXPECT_TRUE(loadDocument(file, nullptr, document).ok());
    Json json = document.json;
    const std::span<const uint8_t> bytes =
        payloadBytes(document, extensionIn(json, 0, 0)["bufferView"].get<uint32_t>());
    return {bytes.begin(), bytes.end()};
  }
  Json& extension() { return extensionIn(builder.json, 0, 0); }
  uint8_t& byte(size_t offset) {
    return builder.bin[builder.json["bufferViews"][preview]["byteOffset"].get<size_t>() + offset];
  }
};

/// Expects that everybody refuses a file for the same reason, in one line.
void expectRefused(const Builder& builder, const std::string& where, const std::string& what,
                   const std::string& code) {
  const std::vector<uint8_t> file = builder.toGlb();
  std::vector<uint8_t> output;
  DecodeReport decoded;
  ConvertReport converted;
  InspectReport inspected;
  const std::string expected = where + ": " + what;
  EXPECT_EQ(decodeGlb(file, output, decoded).message().substr(0, expected.size()), expected);
  EXPECT_EQ(convertGlb(file, {}, output, converted).message().substr(0, expected.size()), expected);
  EXPECT_EQ(inspectGlb(file, true, inspected).message().substr(0, expected.size()), expected);
  ValidationReport report;
  ASSERT_TRUE(validateGlb(file, {}, report).ok());
  ASSERT_EQ(report.issues.size(), 1u) << expected;
  EXPECT_EQ(report.issues[0].code, code);
  EXPECT_EQ(report.issues[0].pointer, where);
  EXPECT_EQ(report.issues[0].message.find('\n'), std::string::npos);
}

TEST(DamagedPreview, IsAcceptedWhenItIsNot) {
  Made made;
  std::vector<uint8_t> output;
  DecodeReport decoded;
  EXPECT_EQ(decodeGlb(made.builder.toGlb(), output, decoded).message(), "");
  ValidationReport report;
  ASSERT_TRUE(validateGlb(made.builder.toGlb(), {}, report).ok());
  EXPECT_TRUE(report.issues.empty()) << report.issues[0].message;
  EXPECT_FALSE(jsonOf(output)["meshes"][0]["primitives"][0].contains("extensions"));
}

TEST(DamagedPreview, IsRefusedForItsJson) {
  const auto refuses = [](const Json& preview, const std::string& where, const std::string& what,
                          const std::string& code) {
    Made made;
    made.extension()["preview"] = preview;
    // The view of the preview is left to nobody then, which is allowed.
    expectRefused(made.builder, kPath + where, what, code);
  };
  refuses(7, "", "must be an object", "SCHEMA_MISMATCH");
  refuses(Json::array(), "", "must be an object", "SCHEMA_MISMATCH");
  refuses(Json::object(), "", "\"bufferView\" is missing", "SCHEMA_MISMATCH");
  refuses({{"bufferView", 99}}, "/bufferView", "there is no bufferView 99", "UNRESOLVED_REFERENCE");
  refuses({{"bufferView", 1}, {"piece", -1}}, "/piece", "must be a whole number",
          "SCHEMA_MISMATCH");
  refuses({{"bufferView", 1}, {"piece", 1}}, "/piece", "there is no piece 1", "INVALID_PIECE");
  refuses({{"bufferView", 1}, {"part", 1}}, "/part", "there is no part 1", "INVALID_PART");
}

TEST(DamagedPreview, IsRefusedForItsBytes) {
  Made made;
  const size_t length = made.builder.json["bufferViews"][made.preview]["byteLength"].get<size_t>();
  for (const size_t at : {size_t{0}, size_t{1}, size_t{9}, length / 2, length - 1}) {
    Made damaged;
    damaged.byte(at) ^= 0x55;
    const std::vector<uint8_t> file = damaged.builder.toGlb();
    std::vector<uint8_t> output;
    DecodeReport decoded;
    ConvertReport converted;
    ValidationReport report;
    const std::string where = std::string(kPath) + "/bufferView: ";
    EXPECT_TRUE(decodeGlb(file, output, decoded).message().starts_with(where)) << at;
    EXPECT_TRUE(convertGlb(file, {}, output, converted).message().starts_with(where)) << at;
    ASSERT_TRUE(validateGlb(file, {}, report).ok());
    ASSERT_FALSE(report.isValid()) << at;
    EXPECT_EQ(report.issues[0].pointer + ": ", where) << at;
  }
}

TEST(DamagedPreview, IsRefusedForOtherAttributes) {
  Made made;
  Builder& builder = made.builder;
  const std::vector<uint8_t> other = Made::converted(4, [](Json& primitive) {
    primitive["attributes"]["_CUSTOM"] = primitive["attributes"]["NORMAL"];
    primitive["attributes"].erase("NORMAL");
    primitive["attributes"].erase("TEXCOORD_0");
  });
  made.extension()["preview"]["bufferView"] = builder.addView(Made::payloadOf(other));
  std::vector<uint8_t> output;
  DecodeReport decoded;
  EXPECT_TRUE(decodeGlb(builder.toGlb(), output, decoded).message().starts_with(kPath));
  ValidationReport report;
  ASSERT_TRUE(validateGlb(builder.toGlb(), {}, report).ok());
  EXPECT_FALSE(report.isValid());
}

TEST(DamagedPreview, BytesAreForPreviewsAlone) {
  Made made;
  made.builder.json["images"] = {{{"bufferView", made.preview}, {"mimeType", "image/png"}}};
  ValidationReport report;
  ASSERT_TRUE(validateGlb(made.builder.toGlb(), {}, report).ok());
  ASSERT_EQ(report.issues.size(), 1u);
  EXPECT_EQ(report.issues[0].code, "PAYLOAD_BUFFER_VIEW_USED_ELSEWHERE");
}

TEST(DamagedPreview, CountsAsDecodedBytes) {
  Made made;
  DecodeOptions options;
  options.max_decoded_bytes = 13 * 13 * 32 + 12 * 12 * 2 * 12;  // of the sheet alone
  std::vector<uint8_t> output;
  DecodeReport decoded;
  EXPECT_NE(decodeGlb(made.builder.toGlb(), output, decoded, options).message(), "");
  made.extension().erase("preview");
  EXPECT_EQ(decodeGlb(made.builder.toGlb(), output, decoded, options).message(), "");
}

}  // namespace
}  // namespace mcc::gltf::test
