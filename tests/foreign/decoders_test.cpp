// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Draco and meshoptimizer as decoders of glTF files: what they return, and what they refuse.
#if defined(MCC_HAS_FOREIGN)

#include <gtest/gtest.h>

#include <cstring>

#include "foreign/decoders.h"
#include "foreign/draco_codec.h"
#include "foreign/meshopt_codec.h"
#include "support/gltf_builder.h"

namespace mcc::foreign {
namespace {

/// A sheet with positions, normals and texture coordinates.
struct Model {
  gltf::test::Sheet sheet{20};
  std::vector<uint32_t> indices{sheet.indices.begin(), sheet.indices.end()};
  std::vector<AttributeView> attributes;
  PartView part{indices};

  Model() {
    add(Semantic::kPosition, 3, sheet.positions);
    add(Semantic::kNormal, 3, sheet.normals);
    add(Semantic::kTexcoord, 2, sheet.texcoords);
  }
  void add(Semantic semantic, uint8_t components, const std::vector<float>& values) {
    AttributeFormat format;
    format.semantic = semantic;
    format.component_count = components;
    attributes.push_back({format, values.data(), elementBytes(format), 12, nullptr});
  }
  PieceView piece() { return {sheet.count(), attributes, {&part, 1}}; }
};

class Draco : public testing::Test {
 protected:
  void SetUp() override {
    Model model;
    DracoInput input;
    ASSERT_TRUE(makeDracoInput(model.piece(), 0, input).ok());
    for (const DracoMethod method : {DracoMethod::kEdgebreaker, DracoMethod::kSequential}) {
      input.method = method;
      encoded_.emplace_back();
      ASSERT_TRUE(encodeDraco(input, 5, encoded_.back()).ok());
    }
    claim_.vertex_count = model.sheet.count();
    claim_.triangle_count = model.indices.size() / 3;
    for (const DracoAttribute& attribute : input.attributes) {
      claim_.attributes.push_back({static_cast<uint32_t>(claim_.attributes.size()),
                                   ComponentType::kFloat32, attribute.view.format.component_count});
    }
  }

  std::string errorOf(const gltf::CodedMesh& claim) {
    mesh_ = {};
    return foreignDecoders().mesh(claim, mesh_).what;
  }

  std::vector<DracoEncoded> encoded_;
  gltf::CodedMesh claim_;
  gltf::DecodedMesh mesh_;
};

TEST_F(Draco, GivesWhatTheAccessorsClaim) {
  for (const DracoEncoded& encoded : encoded_) {
    DracoCounts counts;
    ASSERT_TRUE(readDracoCounts(encoded.bytes, counts).ok());
    EXPECT_EQ(counts.triangle_count, claim_.triangle_count);
    EXPECT_LE(counts.vertex_count, claim_.vertex_count);
    claim_.bytes = encoded.bytes;
    ASSERT_EQ(errorOf(claim_), "");
    EXPECT_EQ(mesh_.indices.size(), 3 * claim_.triangle_count);
    DecodedMesh expected;
    ASSERT_TRUE(decodeDraco(encoded.bytes, expected).ok());
    for (size_t i = 0; i < 3; ++i) {
      const DecodedAttribute* attribute = expected.find(static_cast<uint32_t>(i));
      ASSERT_NE(attribute, nullptr);
      const size_t bytes = claim_.vertex_count * attribute->elementBytes();
      ASSERT_EQ(mesh_.attributes[i].size(), bytes);
      EXPECT_EQ(std::memcmp(mesh_.attributes[i].data(), attribute->values.get(), bytes), 0);
    }
  }
}

TEST_F(Draco, OtherClaimsAreErrors) {
  for (const DracoEncoded& encoded : encoded_) {
    claim_.bytes = encoded.bytes;
    gltf::CodedMesh other = claim_;
    other.triangle_count -= 1;
    EXPECT_NE(errorOf(other).find("holds 800 triangles"), std::string::npos) << errorOf(other);
    other = claim_;
    other.vertex_count += 1;
    EXPECT_NE(errorOf(other), "");
    other = claim_;
    other.vertex_count = 5;
    EXPECT_NE(errorOf(other).find("the accessors 800 and 5"), std::string::npos) << errorOf(other);
    other = claim_;
    other.attributes[1].id = 9;
    EXPECT_EQ(errorOf(other), "has no attribute 9");
    other = claim_;
    other.attributes[1].component_type = ComponentType::kInt16;
    EXPECT_EQ(errorOf(other), "attribute 1 has another type than its accessor");
  }
}

TEST_F(Draco, DamagedBytesAreErrors) {
  for (const DracoEncoded& encoded : encoded_) {
    for (size_t length = 0; length < encoded.bytes.size(); length += length < 64 ? 1 : 37) {
      claim_.bytes = std::span(encoded.bytes).first(length);
      EXPECT_NE(errorOf(claim_), "") << length;
    }
  }
  // Counts of about four billion are refused before memory is taken.
  std::vector<uint8_t> bytes = encoded_[0].bytes;
  const std::vector<uint8_t> huge = {0xff, 0xff, 0xff, 0xff, 0x0f};
  std::copy(huge.begin(), huge.end(), bytes.begin() + 12);
  std::copy(huge.begin(), huge.end(), bytes.begin() + 17);
  claim_.bytes = bytes;
  EXPECT_NE(errorOf(claim_).find("holds 4294967295 triangles"), std::string::npos)
      << errorOf(claim_);
}

/// A stream as a buffer view, and its elements.
std::string decodeView(const gltf::CodedView& view, std::vector<uint8_t>& elements) {
  return foreignDecoders().view(view, elements).what;
}

TEST(Meshopt, ViewsGiveTheirElements) {
  Model model;
  MeshoptOptions options;
  options.is_lossless = true;
  MeshoptEncoded encoded;
  ASSERT_TRUE(encodeMeshopt(model.piece(), 0, options, encoded).ok());
  DecodedMesh expected;
  ASSERT_TRUE(decodeMeshopt(encoded, encoded.bytes, expected).ok());
  const std::span<const uint8_t> all = encoded.bytes;
  gltf::CodedView view = {all.first(encoded.index_bytes), 3 * encoded.triangle_count, 4,
                          "TRIANGLES", "NONE"};
  std::vector<uint8_t> elements;
  ASSERT_EQ(decodeView(view, elements), "");
  EXPECT_EQ(std::memcmp(elements.data(), expected.indices.get(), elements.size()), 0);
  size_t begin = encoded.index_bytes;
  for (size_t i = 0; i < encoded.streams.size(); ++i) {
    const MeshoptStream& stream = encoded.streams[i];
    view = {all.subspan(begin, stream.bytes), encoded.vertex_count, stream.stride_bytes,
            "ATTRIBUTES", "NONE"};
    begin += stream.bytes;
    ASSERT_EQ(decodeView(view, elements), "");
    EXPECT_EQ(std::memcmp(elements.data(), expected.attributes[i].values.get(), elements.size()),
              0);
    gltf::CodedView damaged = view;
    for (size_t length = 0; length < view.bytes.size(); length += 7) {
      damaged.bytes = view.bytes.first(length);
      EXPECT_EQ(decodeView(damaged, elements), "is damaged") << length;
    }
  }
}

TEST(Meshopt, UnknownKindsAreClearErrors) {
  const std::vector<uint8_t> newer(200, 0xa1);
  std::vector<uint8_t> elements;
  gltf::CodedView view = {newer, 16, 8, "ATTRIBUTES", "NONE"};
  EXPECT_EQ(decodeView(view, elements),
            "has version 1 of its codec, which meshoptimizer " + meshoptVersion() +
                " cannot read; encodeGlb() of the npm package gltf-mcc reads it with the option "
                "meshoptDecoder, and gltfpack -noq decompresses it");
  view.mode = "POINTS";
  EXPECT_EQ(decodeView(view, elements), "has the unknown mode \"POINTS\"");
  view.mode = "ATTRIBUTES";
  for (const uint32_t stride : {0u, 3u, 260u}) {
    view.stride_bytes = stride;
    EXPECT_EQ(decodeView(view, elements), "has a stride or count its mode does not allow");
  }
  view = {newer, 16, 4, "TRIANGLES", "NONE"};
  EXPECT_EQ(decodeView(view, elements), "has a stride or count its mode does not allow");

  Model model;
  MeshoptEncoded encoded;
  ASSERT_TRUE(encodeMeshopt(model.piece(), 0, {}, encoded).ok());
  const std::span<const uint8_t> all = encoded.bytes;
  view = {all.subspan(encoded.index_bytes, encoded.streams[0].bytes), encoded.vertex_count,
          encoded.streams[0].stride_bytes, "ATTRIBUTES", "COLOR"};
  EXPECT_NE(decodeView(view, elements).find("the filter \"COLOR\""), std::string::npos);
  view.filter = "QUATERNION";
  view.stride_bytes = 4;
  EXPECT_NE(decodeView(view, elements), "");
}

}  // namespace
}  // namespace mcc::foreign

#endif  // MCC_HAS_FOREIGN
