// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The check of `convert` must notice errors: here the wrong data is compressed on purpose.
#include "gltf/check/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "gltf/check/prove.h"
#include "gltf/compress/compress.h"
#include "gltf/compress/quantize.h"
#include "support/gltf_builder.h"

namespace mcc::gltf::test {
namespace {

class Check : public testing::Test {
 protected:
  void SetUp() override {
    Builder builder;
    builder.addMesh({Sheet(12).addTo(builder), Sheet(9).addTo(builder)});
    image_ = builder.addView({1, 2, 3, 4, 5, 6});
    builder.json["images"] = {{{"bufferView", image_}, {"mimeType", "image/png"}}};
    file_ = builder.toGlb();
    ASSERT_TRUE(loadDocument(file_, nullptr, source_).ok());
    ASSERT_TRUE(compressDocument(source_, {}, compressed_).ok());
    ASSERT_EQ(compressed_.payloads.size(), 1u);
    ASSERT_TRUE(provePayloads(source_, 1, compressed_.payloads, proofs_).ok());
    storePayloads(source_, compressed_);
    bin_.resize(compressed_.layout.byte_count);
    compressed_.layout.copyTo(bin_);
  }

  /// Returns the verdict on payloads that were made from other data than the source.
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
    return provePayloads(source_, 1, payloads, proofs_).message();
  }
  std::string verdictOnPayloads() {
    return provePayloads(source_, 1, compressed_.payloads, proofs_).message();
  }

  /// Returns the verdict on a file.
  std::string verdict(const Json& json, const std::vector<uint8_t>& bin) {
    CheckResult result;
    return checkConversion(source_, compressed_, {}, glbOf(json, bin), nullptr, 1, result)
        .message();
  }
  void expectVerdict(const std::string& words, const Json& json) {
    const std::string message = verdict(json, bin_);
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }

  std::vector<uint8_t> file_;
  Document source_;
  Compressed compressed_;
  std::vector<PayloadProof> proofs_;
  std::vector<uint8_t> bin_;
  uint32_t image_ = 0;
};

Json& extensionIn(Json& json, size_t primitive) {
  return json["meshes"][0]["primitives"][primitive]["extensions"][kExtensionName];
}

TEST_F(Check, AcceptsWhatIsRight) {
  EXPECT_EQ(verdict(compressed_.json, bin_), "");
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
  EXPECT_NE(verdictOnPayloads().find("coarser than asked for"), std::string::npos);
}

TEST_F(Check, NoticesAWrongPermutation) {
  std::vector<uint32_t>& source_of = compressed_.payloads[0].result.pieces[0].source_wedge;
  std::swap(source_of[3], source_of[4]);
  EXPECT_NE(verdictOnPayloads(), "");
  std::swap(source_of[3], source_of[4]);
  source_of[3] = source_of[4];
  EXPECT_NE(verdictOnPayloads().find("not a permutation"), std::string::npos);
}

TEST_F(Check, NoticesAPayloadThatCannotBeDecoded) {
  compressed_.payloads[0].result.payload.back() ^= 1;
  EXPECT_NE(verdictOnPayloads().find("cannot be decoded again"), std::string::npos);
}

TEST_F(Check, NoticesAPayloadThatIsNotStoredAsItWasProved) {
  const std::vector<uint8_t> payload = compressed_.payloads[0].result.payload;
  const auto stored = std::search(bin_.begin(), bin_.end(), payload.begin(), payload.end());
  for (auto byte = stored; byte != stored + static_cast<ptrdiff_t>(payload.size()); ++byte) {
    *byte ^= 1;
    EXPECT_NE(verdict(compressed_.json, bin_), "");
    *byte ^= 1;
  }
  for (uint8_t& byte : compressed_.payloads[0].result.payload) {
    byte ^= 1;
    expectVerdict("not those that were compared", compressed_.json);
    byte ^= 1;
  }
  compressed_.payloads[0].result.payload.pop_back();
  expectVerdict("not those that were compared", compressed_.json);
}

TEST_F(Check, NoticesPrimitivesThatReadSomethingElse) {
  Json json = compressed_.json;
  std::swap(extensionIn(json, 0), extensionIn(json, 1));
  EXPECT_NE(verdict(json, bin_), "");
  json = compressed_.json;
  extensionIn(json, 0)["attributes"].erase("POSITION");
  EXPECT_NE(verdict(json, bin_), "");
  json = compressed_.json;
  Json& primitive = json["meshes"][0]["primitives"][1];
  primitive["extensions"].erase(kExtensionName);
  expectVerdict("is not compressed, as it should be", json);
}

TEST_F(Check, NoticesASourceThatIsNotAsPlanned) {
  PiecePlan& piece = compressed_.payloads[0].plan.pieces[1];
  ++piece.target_count;
  expectVerdict("does not share the accessors of its piece", compressed_.json);
  --piece.target_count;
  piece.parts[0].indices_accessor = 0;
  expectVerdict("does not share the accessors of its piece", compressed_.json);
}

TEST_F(Check, NoticesWrongBounds) {
  Json json = compressed_.json;
  json["accessors"][0]["max"][1] = 17;
  expectVerdict("component 1 is 17", json);
  json = compressed_.json;
  json["accessors"][3]["min"] = {1};
  expectVerdict("component 0 is 1", json);
}

TEST_F(Check, NoticesADamagedImage) {
  std::vector<uint8_t> bin = bin_;
  const uint64_t view = compressed_.json["images"][0]["bufferView"];
  const uint64_t offset = compressed_.json["bufferViews"][view].value("byteOffset", uint64_t{0});
  bin[offset + 5] ^= 1;
  EXPECT_NE(verdict(compressed_.json, bin).find("/images/0: "), std::string::npos);
}

TEST_F(Check, NoticesLostJson) {
  Json json = compressed_.json;
  json["nodes"][0]["name"] = "new";
  expectVerdict("/nodes/0", json);
  json = compressed_.json;
  json.erase("scenes");
  EXPECT_NE(verdict(json, bin_), "");
  json = compressed_.json;
  json["accessors"][0]["name"] = "new";
  expectVerdict("/accessors/0", json);
  json = compressed_.json;
  json["meshes"][0]["primitives"][0]["material"] = 0;
  expectVerdict("/meshes/0/primitives/0", json);
}

TEST_F(Check, NoticesAnotherPayloadInPlaceOfAnOldOne) {
  const std::vector<uint8_t> old_file = glbOf(compressed_.json, bin_);
  ASSERT_TRUE(loadDocument(old_file, nullptr, source_).ok());
  std::vector<EncodedPayload> payloads = std::move(compressed_.payloads);
  compressed_.payloads.clear();
  EXPECT_EQ(verdict(compressed_.json, bin_), "");
  // The same triangles with other bits: a payload that fits the JSON in every count.
  ConvertOptions options;
  options.position_bits = 9;
  Compressed other;
  Document document;
  ASSERT_TRUE(loadDocument(file_, nullptr, document).ok());
  ASSERT_TRUE(compressDocument(document, options, other).ok());
  const std::vector<uint8_t>& payload = other.payloads[0].result.payload;
  std::vector<uint8_t> bin = bin_;
  Json json = compressed_.json;
  Json& view = json["bufferViews"][extensionIn(json, 0)["bufferView"].get<size_t>()];
  view["byteOffset"] = bin.size();
  view["byteLength"] = payload.size();
  bin.insert(bin.end(), payload.begin(), payload.end());
  json["buffers"][0]["byteLength"] = bin.size();
  const std::string message = verdict(json, bin);
  EXPECT_NE(message.find("has another payload"), std::string::npos) << message;
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
