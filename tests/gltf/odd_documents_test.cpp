// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Documents that tests/documents has found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gltf/files/file_io.h"
#include "gltf/made_up_codecs.h"
#include "gltf/round_trip.h"
#include "mcc/files.h"
#include "support/scratch_folder.h"

namespace mcc::gltf::test {
namespace {

Json spelt(const std::string& number) { return Json::number(number); }

TEST(OddDocuments, PrimitivesShareAccessorsHoweverTheirNumbersAreSpelt) {
  Builder builder;
  const Json sheet = Sheet(12).addTo(builder);
  Json other = sheet;
  other["attributes"]["NORMAL"] = spelt("1e0");
  other["indices"] = spelt(sheet["indices"].dump() + ".0");
  builder.addMesh({sheet, other});
  const RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 1));
}

/// They are valid JSON; what they mean is up to whoever reads them.
TEST(OddDocuments, NumbersThatAreTooLargeAreKeptAsTheyAreSpelt) {
  const std::string digits(400, '9');
  const std::string text =
      R"({"a":1e400,"b":-1.5E+999,"c":)" + digits + R"(,"d":"1e400","e":1e-400,"f":[0,1e9]})";
  Json json;
  ASSERT_EQ(parseJson(asBytes(text), json).message(), "");
  EXPECT_EQ(printJson(json), text);
  double value = 0;
  EXPECT_TRUE(asNumber(json["b"], value));
  EXPECT_TRUE(std::isinf(value) && value < 0);
  ASSERT_TRUE(asNumber(json["e"], value));
  EXPECT_EQ(value, 0);
  const std::string zeros = "0." + std::string(400, '0') + "1e";
  for (const auto& [number, is_huge] :
       {std::pair(zeros + "3", false), std::pair(zeros + "900", true),
        std::pair(digits + "e-90", true), std::pair(digits + "e-900", false),
        std::pair(std::string("1e99999999999999999999"), true),
        std::pair(std::string("1e-99999999999999999999"), false)}) {
    ASSERT_TRUE(asNumber(spelt(number), value));
    EXPECT_EQ(std::isinf(value), is_huge) << number;
    EXPECT_TRUE(is_huge || value == 0) << number;
  }
  uint64_t whole = 0;
  EXPECT_FALSE(asUnsigned(json["a"], whole));
  for (const char* damaged : {"1e400e", "01e400", "1.e400", ".1e400", "1e400.5", "--1e400", "1e"}) {
    EXPECT_FALSE(parseJson(asBytes("{\"a\":" + std::string(damaged) + "}"), json).ok()) << damaged;
  }
}

TEST(OddDocuments, DeltasThatAreAllAlikeKeepTheirBits) {
  Builder builder;
  const Sheet sheet(12);
  Json primitive = sheet.addTo(builder);
  const std::vector<float> deltas(size_t{2} * sheet.count(), 0.3f);
  primitive["targets"] = {{{"TEXCOORD_0", builder.addFloats(deltas, 2)}}};
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  for (const float delta : floatsInOrder(trip.decoded, 4))
    ASSERT_LT(std::abs(delta - 0.3f), 0.3f / 4095);
}

/// Its elements are stored once in the file.
TEST(OddDocuments, OneAccessorForTwoAttributesIsReorderedOnce) {
  Builder builder;
  Json sheet = Sheet(12).addTo(builder);
  sheet["attributes"]["_COPY"] = sheet["attributes"]["TEXCOORD_0"];
  builder.addMesh({sheet});
  ConvertOptions options = evenIfLarger();
  options.indices_only = true;
  const RoundTrip trip = roundTrip(builder, options);
  ASSERT_EQ(trip.error, "");
  // POSITION, NORMAL, TEXCOORD_0 and the payload or the indices.
  EXPECT_EQ(jsonOf(trip.converted)["bufferViews"].size(), 4u);
  EXPECT_EQ(jsonOf(trip.decoded)["bufferViews"].size(), 4u);
}

/// After the conversion its only remaining user draws lines; its values are still compared.
TEST(OddDocuments, SparseValuesInCodedViewsAreSharedWithLines) {
  Builder builder;
  const Sheet sheet(12);
  Json primitive = sheet.addTo(builder);
  std::vector<uint16_t> numbers;
  for (uint16_t i = 0; i < sheet.count(); ++i) numbers.push_back(i);
  while (numbers.size() % 2 != 0) numbers.push_back(0);
  const uint32_t indices = builder.addView(bytesOf(numbers));
  const uint32_t values = builder.addView(bytesOf(sheet.positions));
  primitive["attributes"]["POSITION"] = builder.addAccessor(
      {{"componentType", kFloat},
       {"count", sheet.count()},
       {"type", "VEC3"},
       {"min", builder.json["accessors"][0]["min"]},
       {"max", builder.json["accessors"][0]["max"]},
       {"sparse",
        {{"count", sheet.count()},
         {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
         {"values", {{"bufferView", values}}}}}});
  Json lines = primitive;
  lines["mode"] = 1;
  builder.addMesh({primitive, lines});
  codeViews(builder, {indices, values});
  ConvertOptions options = withDecoders();
  options.allow_larger = true;
  const RoundTrip trip = roundTrip(fileOf(builder), options);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
}

TEST(OddDocuments, ImagesWithoutAnyBufferMoveIntoAGlb) {
  const mcc::test::ScratchFolder folder;
  const std::string json =
      R"({"asset":{"version":"2.0"},"images":[{"uri":"a.png"}],"textures":[{"source":0}]})";
  const std::vector<uint8_t> image = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a, 1, 2};
  ASSERT_TRUE(writeFile(folder.path() / "in.gltf", asBytes(json)).ok());
  ASSERT_TRUE(writeFile(folder.path() / "a.png", image).ok());
  ConvertReport report;
  const std::filesystem::path path = folder.path() / "out.glb";
  ASSERT_EQ(convertFile(folder.path() / "in.gltf", path, {}, report).message(), "");
  std::vector<uint8_t> file;
  ASSERT_TRUE(readFile(path, file).ok());
  GlbFile glb;
  ASSERT_TRUE(readGlb(file, glb).ok());
  ASSERT_GE(glb.bin.size(), image.size());
  EXPECT_TRUE(std::equal(image.begin(), image.end(), glb.bin.begin()));
  EXPECT_EQ(jsonOf(file)["images"][0]["bufferView"], 0);
}

}  // namespace
}  // namespace mcc::gltf::test
