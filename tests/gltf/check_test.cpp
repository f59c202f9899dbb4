// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The check of `convert` must notice errors: here the wrong data is compressed on purpose.
#include "gltf/check/check.h"

#include <gtest/gtest.h>

#include <functional>

#include "gltf/check/check_values.h"
#include "gltf/compress/quantize.h"
#include "gltf/document/rebuild.h"
#include "gltf/gltf_builder.h"

namespace mcc::gltf::test {
namespace {

class Check : public testing::Test {
 protected:
  void SetUp() override {
    Builder builder;
    builder.addMesh({Sheet(12).addTo(builder)});
    image_ = builder.addView({1, 2, 3, 4, 5, 6});
    builder.json["images"] = {{{"bufferView", image_}, {"mimeType", "image/png"}}};
    file_ = builder.toGlb();
    ASSERT_TRUE(loadDocument(file_, nullptr, source_).ok());
    ConvertOptions options;
    ASSERT_TRUE(compressDocument(source_, options, compressed_).ok());
    ASSERT_EQ(compressed_.payloads.size(), 1u);
  }

  /// Returns the check's verdict on a file that was compressed from other data than the source.
  std::string verdictOn(const std::function<void(PayloadPlan&)>& sabotage) {
    std::vector<PayloadPlan> plans;
    std::vector<LeftAlone> left_alone;
    std::vector<std::string> notes;
    const ConvertOptions options;
    EXPECT_TRUE(planPayloads(source_, plans, left_alone).ok());
    planQuantization(options, plans, notes);
    sabotage(plans[0]);
    std::vector<EncodedPayload> payloads;
    EXPECT_TRUE(encodePayloads(options, std::move(plans), payloads, left_alone).ok());
    Json json = compressed_.json;
    json["accessors"][3]["count"] = payloads[0].plan.pieces[0].parts[0].triangles.size();
    const uint64_t view =
        json["meshes"][0]["primitives"][0]["extensions"][kExtensionName]["bufferView"];
    std::vector<uint8_t> bin = compressed_.bin;
    bin.resize((bin.size() + 3) & ~size_t{3});
    json["bufferViews"][view]["byteOffset"] = bin.size();
    json["bufferViews"][view]["byteLength"] = payloads[0].result.payload.size();
    bin.insert(bin.end(), payloads[0].result.payload.begin(), payloads[0].result.payload.end());
    json["buffers"][0]["byteLength"] = bin.size();
    compressed_.payloads = std::move(payloads);
    return verdict(json, bin);
  }

  std::string verdict(const Json& json, const std::vector<uint8_t>& bin) {
    std::vector<uint8_t> written;
    EXPECT_TRUE(writeGlb(printJson(json), bin, {}, written).ok());
    CheckResult result;
    return checkConversion(source_, compressed_.payloads, {}, written, nullptr, 1, result)
        .message();
  }

  std::vector<uint8_t> file_;
  Document source_;
  Compressed compressed_;
  uint32_t image_ = 0;
};

TEST_F(Check, AcceptsWhatIsRight) {
  EXPECT_EQ(verdict(compressed_.json, compressed_.bin), "");
  EXPECT_EQ(verdictOn([](PayloadPlan&) {}), "");
}

TEST_F(Check, NoticesAMissingTriangle) {
  const std::string message = verdictOn([](PayloadPlan& plan) {
    plan.pieces[0].parts[0].triangles.resize(plan.pieces[0].parts[0].triangles.size() - 3);
  });
  EXPECT_NE(message.find("there are 287 triangles, the source has 288"), std::string::npos)
      << message;
}

TEST_F(Check, NoticesAFlippedTriangle) {
  const std::string message = verdictOn([](PayloadPlan& plan) {
    std::swap(plan.pieces[0].parts[0].triangles[0], plan.pieces[0].parts[0].triangles[1]);
  });
  EXPECT_NE(message.find("the triangles differ"), std::string::npos) << message;
}

TEST_F(Check, NoticesAMovedVertex) {
  std::vector<float> moved;
  const std::string message = verdictOn([&](PayloadPlan& plan) {
    AttributePlan& position = plan.pieces[0].attributes[0];
    moved.resize(size_t{3} * plan.pieces[0].wedge_count);
    std::memcpy(moved.data(), position.source.data, moved.size() * 4);
    moved[30] += 3 * position.lattice.step;
    position.source.data = reinterpret_cast<const uint8_t*>(moved.data());
  });
  EXPECT_NE(message.find("POSITION of decoded vertex"), std::string::npos) << message;
}

TEST_F(Check, NoticesACoarserGridThanPlanned) {
  compressed_.payloads[0].plan.pieces[0].attributes[0].lattice.step /= 2;
  EXPECT_NE(verdict(compressed_.json, compressed_.bin).find("coarser than asked for"),
            std::string::npos);
}

TEST_F(Check, NoticesWrongBounds) {
  Json json = compressed_.json;
  json["accessors"][0]["max"][1] = 17;
  EXPECT_NE(verdict(json, compressed_.bin).find("component 1 is 17"), std::string::npos);
  json = compressed_.json;
  json["accessors"][3]["min"] = {1};
  EXPECT_NE(verdict(json, compressed_.bin).find("component 0 is 1"), std::string::npos);
}

TEST_F(Check, NoticesAWrongPermutation) {
  std::vector<uint32_t>& source_of = compressed_.payloads[0].result.pieces[0].source_wedge;
  std::swap(source_of[3], source_of[4]);
  EXPECT_NE(verdict(compressed_.json, compressed_.bin), "");
  std::swap(source_of[3], source_of[4]);
  source_of[3] = source_of[4];
  EXPECT_NE(verdict(compressed_.json, compressed_.bin).find("not a permutation"),
            std::string::npos);
}

TEST_F(Check, NoticesADamagedImage) {
  std::vector<uint8_t> bin = compressed_.bin;
  const uint64_t view = compressed_.json["images"][0]["bufferView"];
  const uint64_t offset = compressed_.json["bufferViews"][view]["byteOffset"];
  bin[offset + 5] ^= 1;
  EXPECT_NE(verdict(compressed_.json, bin).find("/images/0: "), std::string::npos);
}

TEST_F(Check, NoticesLostJson) {
  Json json = compressed_.json;
  json["nodes"][0]["name"] = "new";
  EXPECT_NE(verdict(json, compressed_.bin).find("/nodes/0"), std::string::npos);
  json = compressed_.json;
  json.erase("scenes");
  EXPECT_NE(verdict(json, compressed_.bin), "");
}

/// Changes the decoded values that the check may take instead of decoding again.
void spoil(EncodedPayload& payload) {
  ASSERT_EQ(payload.decoded.size(), 1u);
  payload.decoded[0].attributes[0][3] ^= 0x40;
}

TEST_F(Check, DecodesNoPayloadThatWasDecodedBefore) {
  spoil(compressed_.payloads[0]);
  const std::string message = verdict(compressed_.json, compressed_.bin);
  EXPECT_NE(message.find("/accessors/0/m"), std::string::npos) << message;
  EXPECT_TRUE(compressed_.payloads[0].decoded.empty());
  EXPECT_EQ(verdict(compressed_.json, compressed_.bin), "");
}

TEST_F(Check, DecodesEveryPayloadThatIsNotStoredAsItWasEncoded) {
  const Compressed compressed = compressed_;
  const size_t size = compressed.payloads[0].result.payload.size();
  for (size_t i = 0; i < size; ++i) {
    compressed_.payloads = compressed.payloads;
    spoil(compressed_.payloads[0]);
    compressed_.payloads[0].result.payload[i] ^= 1;
    EXPECT_EQ(verdict(compressed.json, compressed.bin), "") << i;
  }
  for (const size_t other : {size - 1, size + 1, size_t{0}}) {
    compressed_.payloads = compressed.payloads;
    spoil(compressed_.payloads[0]);
    compressed_.payloads[0].result.payload.resize(other);
    EXPECT_EQ(verdict(compressed.json, compressed.bin), "") << other;
  }
}

TEST(DecodedPayloads, GivesEachPayloadOnceAlsoThoseOfTheSameBytes) {
  const std::vector<uint8_t> bytes = {1, 2, 0, 3};
  const std::vector<uint8_t> same = bytes;
  DecodedPayloads payloads;
  payloads.add(bytes, std::vector<DecodedPiece>(2));
  payloads.add(same, std::vector<DecodedPiece>(2));
  EXPECT_EQ(payloads.take(std::vector<uint8_t>{1, 2, 0, 4}).size(), 0u);
  EXPECT_EQ(payloads.take(std::vector<uint8_t>{1, 2}).size(), 0u);
  EXPECT_EQ(payloads.take(bytes).size(), 2u);
  EXPECT_EQ(payloads.take(bytes).size(), 2u);
  EXPECT_EQ(payloads.take(bytes).size(), 0u);
}

TEST(CanonicalTriangles, RotationsAreEqualReflectionsAreNot) {
  const std::vector<uint32_t> a = {5, 1, 3, 2, 2, 0};
  const std::vector<uint32_t> b = {0, 2, 2, 1, 3, 5};
  const std::vector<uint32_t> c = {0, 2, 2, 3, 1, 5};
  EXPECT_EQ(canonicalTriangles(a, {}), canonicalTriangles(b, {}));
  EXPECT_NE(canonicalTriangles(a, {}), canonicalTriangles(c, {}));
  const std::vector<uint32_t> names = {5, 4, 3, 2, 1, 0};
  EXPECT_EQ(canonicalTriangles(std::vector<uint32_t>{0, 4, 2}, names)[0], (Triangle{1, 3, 5}));
}

}  // namespace
}  // namespace mcc::gltf::test
