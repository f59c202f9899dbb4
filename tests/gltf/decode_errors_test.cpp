// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Extension objects that contradict the document or the payload.
#include <gtest/gtest.h>

#include <functional>

#include "mcc/glb.h"
#include "support/gltf_builder.h"

namespace mcc::gltf::test {
namespace {

constexpr char kPath[] = "/meshes/0/primitives/0/extensions/KHR_mesh_collapse_compression";

class DecodeErrors : public testing::Test {
 protected:
  void SetUp() override {
    Builder builder;
    Json primitive = Sheet(12).addTo(builder);
    primitive["targets"] = {{{"POSITION", builder.addPositions(Sheet(12).positions)}}};
    builder.addMesh({primitive});
    ConvertOptions options;
    options.allow_larger = true;
    ConvertReport report;
    ASSERT_EQ(convertGlb(builder.toGlb(), options, file_, report).message(), "");
  }

  /// Returns the message of decoding after a change of the JSON. `change` gets the document and the
  /// extension.
  std::string errorAfter(const std::function<void(Json&, Json&)>& change) {
    Json json = jsonOf(file_);
    change(json, json["meshes"][0]["primitives"][0]["extensions"][kExtensionName]);
    std::vector<uint8_t> output;
    DecodeReport report;
    return decodeGlb(withJson(file_, json), output, report).message();
  }

  std::vector<uint8_t> file_;
};

TEST_F(DecodeErrors, UnchangedIsFine) {
  EXPECT_EQ(errorAfter([](Json&, Json&) {}), "");
}

/// validate() reports them; a loader loses nothing by them.
TEST_F(DecodeErrors, StrideAndTargetOfThePayloadsViewAreIgnored) {
  EXPECT_EQ(errorAfter([](Json& j, Json&) { j["bufferViews"][0]["byteStride"] = 4; }), "");
  EXPECT_EQ(errorAfter([](Json& j, Json&) { j["bufferViews"][0]["target"] = 34962; }), "");
}

TEST_F(DecodeErrors, BufferView) {
  const std::string path = std::string(kPath) + "/bufferView: ";
  EXPECT_EQ(errorAfter([](Json&, Json& e) { e["bufferView"] = 9; }),
            path + "there is no bufferView 9");
  EXPECT_NE(errorAfter([](Json&, Json& e) { e["bufferView"] = -1; }).find(path), std::string::npos);
  EXPECT_NE(errorAfter([](Json&, Json& e) { e["bufferView"] = "0"; }).find(path),
            std::string::npos);
  EXPECT_EQ(errorAfter([](Json&, Json& e) { e.erase("bufferView"); }),
            std::string(kPath) + ": \"bufferView\" is missing");
  EXPECT_NE(errorAfter([](Json& j, Json&) {
              auto& length = j["bufferViews"][0]["byteLength"];
              length = length.get<size_t>() - 1;
            }).find(path),
            std::string::npos);
}

TEST_F(DecodeErrors, PieceAndPart) {
  EXPECT_EQ(errorAfter([](Json&, Json& e) { e["piece"] = 1; }),
            std::string(kPath) + "/piece: there is no piece 1 in the payload, which has 1");
  EXPECT_EQ(errorAfter([](Json&, Json& e) { e["part"] = 1; }),
            std::string(kPath) + "/part: there is no part 1 in the piece, which has 1");
  EXPECT_NE(errorAfter([](Json&, Json& e) { e["piece"] = 0.5; }), "");
  EXPECT_EQ(errorAfter([](Json&, Json& e) { e["piece"] = 0; }), "");
}

TEST_F(DecodeErrors, AttributeIds) {
  EXPECT_NE(errorAfter([](Json&, Json& e) {
              e["attributes"]["NORMAL"] = 9;
            }).find(std::string(kPath) + "/attributes/NORMAL: there is no attribute 9"),
            std::string::npos);
  EXPECT_NE(errorAfter([](Json&, Json& e) {
              e["attributes"]["COLOR_0"] = 1;
            }).find("/attributes/COLOR_0: the primitive has no attribute"),
            std::string::npos);
  EXPECT_NE(errorAfter([](Json&, Json& e) { e["attributes"] = 1; }), "");
  EXPECT_NE(errorAfter([](Json&, Json& e) {  // the same type, another meaning
              e["attributes"]["NORMAL"] = e["attributes"]["POSITION"];
            })
                .find("of the payload is not "),
            std::string::npos);
  EXPECT_NE(errorAfter([](Json&, Json& e) {  // a morph target is not a base attribute
              e["targets"][0]["POSITION"] = 0;
            })
                .find("/targets/0/POSITION"),
            std::string::npos);
}

TEST_F(DecodeErrors, PositionIsTheFirstAttribute) {
  EXPECT_EQ(errorAfter([](Json&, Json& e) { e["attributes"]["POSITION"] = 1; }),
            std::string(kPath) +
                "/attributes/POSITION: must be attribute 0, which all others are predicted from");
}

TEST_F(DecodeErrors, Targets) {
  EXPECT_NE(errorAfter([](Json&, Json& e) {
              e["targets"].push_back(Json::object());
            }).find(std::string(kPath) + "/targets: has 2 targets, the primitive 1"),
            std::string::npos);
  EXPECT_NE(errorAfter([](Json&, Json& e) { e["targets"] = 1; }), "");
  EXPECT_NE(errorAfter([](Json&, Json& e) { e["targets"][0] = 1; }), "");
}

TEST_F(DecodeErrors, AccessorsMustMatchThePayload) {
  EXPECT_NE(errorAfter([](Json& j, Json&) {
              j["accessors"][0]["count"] = 170;
            }).find("/accessors/0/count: 170 does not match the payload, which has 169 vertices"),
            std::string::npos);
  EXPECT_NE(errorAfter([](Json& j, Json&) {
              j["accessors"][1]["componentType"] = kShort;
            }).find("/accessors/1: its type is VEC3 of SHORT"),
            std::string::npos);
  EXPECT_NE(errorAfter([](Json& j, Json&) { j["accessors"][2]["type"] = "VEC3"; }), "");
  EXPECT_NE(errorAfter([](Json& j, Json&) { j["accessors"][1]["normalized"] = true; }), "");
  EXPECT_NE(
      errorAfter([](Json& j, Json&) { j["accessors"][3]["count"] = 3; }).find("/accessors/3/count"),
      std::string::npos);
  EXPECT_NE(errorAfter([](Json& j, Json&) { j["accessors"][3]["componentType"] = kFloat; }), "");
  EXPECT_EQ(errorAfter([](Json& j, Json&) { j["accessors"][3]["componentType"] = kUnsignedByte; }),
            "");
}

TEST_F(DecodeErrors, Primitive) {
  EXPECT_NE(errorAfter([](Json& j, Json&) {
              j["meshes"][0]["primitives"][0]["mode"] = 5;
            }).find("/meshes/0/primitives/0/mode"),
            std::string::npos);
  EXPECT_NE(errorAfter([](Json& j, Json&) { j["meshes"][0]["primitives"][0].erase("indices"); }),
            "");
  EXPECT_NE(errorAfter([](Json& j, Json&) { j["meshes"][0]["primitives"][0]["indices"] = 99; }),
            "");
}

TEST_F(DecodeErrors, OrdinaryAttributesHaveAsManyElements) {
  const auto with = [this](uint32_t count, bool in_target) {
    return errorAfter([=](Json& j, Json& e) {
      Json accessor = {{"componentType", kFloat}, {"count", count}, {"type", "VEC3"}};
      j["accessors"].push_back(accessor);
      Json& primitive = j["meshes"][0]["primitives"][0];
      Json& attributes = in_target ? primitive["targets"][0] : primitive["attributes"];
      attributes["_EXTRA"] = j["accessors"].size() - 1;
      (void)e;
    });
  };
  for (const bool in_target : {false, true}) {
    EXPECT_EQ(with(169, in_target), "");
    EXPECT_NE(
        with(168, in_target).find("/_EXTRA: the accessor does not have the payload's 169 elements"),
        std::string::npos);
  }
}

TEST_F(DecodeErrors, TwoCompressions) {
  EXPECT_EQ(
      errorAfter([](Json& j, Json&) {
        j["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
            {"bufferView", 0}, {"attributes", Json::object()}};
      }),
      std::string(kPath) + ": the primitive is compressed with KHR_draco_mesh_compression, too");
}

/// A byte holds the indices 0 to 254; 255 is not a valid index.
TEST_F(DecodeErrors, IndexTypesHoldTheNumberOfVertices) {
  for (const uint32_t vertex_count : {225u, 256u}) {
    Builder builder;
    builder.addMesh({Sheet(vertex_count == 225 ? 14 : 15).addTo(builder)});
    ConvertOptions options;
    options.allow_larger = true;
    ConvertReport report;
    ASSERT_EQ(convertGlb(builder.toGlb(), options, file_, report).message(), "");
    const std::string message = errorAfter([](Json& j, Json&) {
      Json& indices = j["accessors"][j["meshes"][0]["primitives"][0]["indices"].get<size_t>()];
      indices["componentType"] = kUnsignedByte;
    });
    if (vertex_count == 225) {
      EXPECT_EQ(message, "");
    } else {
      EXPECT_NE(message.find("cannot hold indices of 256 vertices"), std::string::npos);
    }
  }
}

TEST_F(DecodeErrors, OneAccessorForTwoThings) {
  EXPECT_NE(errorAfter([](Json& j, Json& e) {
              j["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 0;
              (void)e;
            }).find("filled from two different places"),
            std::string::npos);
}

TEST_F(DecodeErrors, EveryByteOfThePayloadIsChecked) {
  GlbFile glb;
  ASSERT_TRUE(readGlb(file_, glb).ok());
  const Json json = jsonOf(file_);
  const size_t length = json["bufferViews"][0]["byteLength"];
  for (size_t i = 0; i < length; ++i) {
    std::vector<uint8_t> bin(glb.bin.begin(), glb.bin.end());
    bin[i] ^= 0x10;
    std::vector<uint8_t> output;
    DecodeReport report;
    const Result result = decodeGlb(glbOf(json, bin), output, report);
    ASSERT_FALSE(result.ok()) << i;
    ASSERT_EQ(result.where, std::string(kPath) + "/bufferView");
  }
}

TEST_F(DecodeErrors, InspectSaysTheSame) {
  InspectReport report;
  ASSERT_TRUE(inspectGlb(file_, true, report).ok());
  ASSERT_EQ(report.payloads.size(), 1u);
  EXPECT_EQ(report.payloads[0].pieces[0].wedge_count, 169u);
  EXPECT_EQ(report.payloads[0].pieces[0].triangle_count, 288u);
  EXPECT_TRUE(report.payloads[0].has_codes);
  std::vector<uint8_t> damaged = file_;
  damaged[damaged.size() - 8] ^= 1;
  EXPECT_FALSE(inspectGlb(damaged, false, report).ok());
}

}  // namespace
}  // namespace mcc::gltf::test
