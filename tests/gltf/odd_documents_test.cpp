// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Documents that tests/documents came upon.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf/round_trip.h"

namespace mcc::gltf::test {
namespace {

Json spelt(const std::string& number) { return Json::binary({number.begin(), number.end()}); }

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

TEST(OddDocuments, NumbersThatAreTooLargeAreRefusedInPlainWords) {
  Json json;
  const Result result = parseJson(asBytes(R"({"extras": 1e400})"), json);
  EXPECT_EQ(result.message(),
            "JSON byte 16: the JSON is damaged (number overflow parsing '1e400')");
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

/// Its elements are in the file once.
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

}  // namespace
}  // namespace mcc::gltf::test
