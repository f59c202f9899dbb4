// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/layout.h"

#include <gtest/gtest.h>

#include "gltf/round_trip.h"

namespace mcc::gltf::test {
namespace {

Contents contentsOfGlb(const std::vector<uint8_t>& file) {
  Document document;
  const Result loaded = loadDocument(file, nullptr, document);
  EXPECT_TRUE(loaded.ok()) << loaded.message();
  const Contents contents = contentsOf(document);
  EXPECT_EQ(contents.geometry_bytes + contents.image_bytes + contents.animation_bytes +
                contents.other_bytes,
            file.size());
  return contents;
}

/// Adds an animation that moves node 0, of 12 + 36 bytes.
void addAnimation(Builder& builder) {
  const uint32_t times = builder.addFloats({0, 1, 2}, 1);
  const uint32_t places = builder.addFloats({0, 0, 0, 1, 0, 0, 2, 0, 0}, 3);
  builder.json["animations"].push_back(
      {{"samplers", {{{"input", times}, {"output", places}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
}

TEST(ContentsTest, TellsGeometryImagesAndAnimationsApart) {
  Builder builder;
  const Sheet sheet(20);
  builder.addMesh({sheet.addTo(builder)});
  addAnimation(builder);
  const uint32_t view = builder.addView(std::vector<uint8_t>(777, 7));
  builder.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  const Contents contents = contentsOfGlb(builder.toGlb());
  const uint64_t of_vertices = uint64_t{sheet.count()} * (12 + 12 + 8);
  EXPECT_EQ(contents.geometry_bytes, of_vertices + 2 * sheet.indices.size());
  EXPECT_EQ(contents.image_bytes, 777u);
  EXPECT_EQ(contents.animation_bytes, 12u + 36u);
  EXPECT_EQ(contents.image_count, 1u);
  EXPECT_EQ(contents.animation_count, 1u);
}

/// Positions and normals alternate in one view; both accessors reach over nearly the whole of it.
TEST(ContentsTest, CountsInterleavedAndSharedBytesOnce) {
  Builder builder;
  const uint32_t view = builder.addView(std::vector<uint8_t>(24 * 10, 0), 24);
  Json accessor = {
      {"bufferView", view}, {"componentType", kFloat}, {"count", 10}, {"type", "VEC3"}};
  const uint32_t positions = builder.addAccessor(accessor);
  accessor["byteOffset"] = 12;
  const uint32_t normals = builder.addAccessor(accessor);
  const uint32_t again = builder.addAccessor(accessor);
  builder.addMesh({{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}},
                   {{"attributes", {{"POSITION", positions}, {"NORMAL", again}}}}});
  EXPECT_EQ(contentsOfGlb(builder.toGlb()).geometry_bytes, 240u);
}

TEST(ContentsTest, CountsImagesInDataUrisAndInFiles) {
  Builder builder;
  builder.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}, {{"uri", "wood.jpg"}}};
  const Contents contents = contentsOfGlb(builder.toGlb());
  EXPECT_EQ(contents.image_bytes, 26u);
  EXPECT_EQ(contents.image_count, 1u);
  EXPECT_EQ(contents.image_file_count, 1u);
}

TEST(ContentsTest, ReferencesThatLeadNowhereAreNothing) {
  Builder builder;
  builder.json["images"] = {{{"bufferView", 99}}, {{"bufferView", -1}}};
  builder.json["animations"] = {{{"samplers", {{{"input", 99}, {"output", "x"}}}}}};
  builder.json["skins"] = {{{"inverseBindMatrices", 12}}};
  const Contents contents = contentsOfGlb(builder.toGlb());
  EXPECT_EQ(contents.image_bytes + contents.animation_bytes, 0u);
}

/// What convert() reports is what the two files hold; only the geometry has become smaller.
TEST(ContentsTest, IsReportedOfBothFiles) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  addAnimation(builder);
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  const Contents& before = trip.report.input_contents;
  const Contents& after = trip.report.output_contents;
  EXPECT_EQ(before.geometry_bytes, contentsOfGlb(builder.toGlb()).geometry_bytes);
  EXPECT_EQ(after.geometry_bytes, trip.report.payloads.at(0).payload_bytes);
  EXPECT_EQ(after.geometry_bytes, contentsOfGlb(trip.converted).geometry_bytes);
  EXPECT_EQ(after.animation_bytes, before.animation_bytes);
  EXPECT_EQ(after.geometry_bytes + after.animation_bytes + after.other_bytes,
            trip.report.output_bytes);
}

}  // namespace
}  // namespace mcc::gltf::test
