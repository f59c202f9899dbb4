// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quality.h"

#include <gtest/gtest.h>

#include "gltf/round_trip.h"
#include "support/made_images.h"

namespace mcc::gltf::test {
namespace {

/// Loads a document whose only primitive is this, and asks for the textures of its sets.
double texelsOf(Builder builder, const Json& primitive, uint32_t set = 0) {
  Json all = Sheet(2).addTo(builder);
  all.update(primitive);
  builder.addMesh({all});
  const std::vector<uint8_t> file = builder.toGlb();
  Document document;
  EXPECT_EQ(loadDocument(file, nullptr, document).message(), "");
  return TextureUses(document).texels({0, 0}, set);
}

/// Textures 0 to 2 have 64 x 32, 512 x 2,048 and 300 x 300 texels; texture 3 has an image of a
/// file.
Builder texturedBuilder() {
  Builder builder;
  builder.push("images",
               {{"bufferView", builder.addView(pngHeader(64, 32))}, {"mimeType", "image/png"}});
  builder.push("images", {{"uri", "data:image/png;base64," + base64Of(pngHeader(512, 2048))}});
  builder.push("images",
               {{"bufferView", builder.addView(pngHeader(300, 300))}, {"mimeType", "image/png"}});
  builder.push("images", {{"uri", "a.png"}});
  builder.push("textures", {{"source", 0}});
  builder.push("textures", {{"source", 1}});
  builder.push("textures", {{"extensions", {{"EXT_texture_webp", {{"source", 2}}}}}});
  builder.push("textures", {{"source", 3}});
  return builder;
}

TEST(TextureUses, TheLargestOfAMaterialCounts) {
  Builder builder = texturedBuilder();
  builder.push(
      "materials",
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}},
         {"metallicRoughnessTexture", {{"index", 1}, {"texCoord", 1}}}}},
       {"normalTexture", {{"index", 2}, {"scale", 3}}},
       {"extensions",
        {{"KHR_materials_sheen", {{"sheenColorTexture", {{"index", 3}, {"texCoord", 2}}}}}}}});
  EXPECT_EQ(texelsOf(builder, {{"material", 0}}, 0), 300);
  EXPECT_EQ(texelsOf(builder, {{"material", 0}}, 1), 2048);
  EXPECT_EQ(texelsOf(builder, {{"material", 0}}, 2), TextureUses::kUsualTexels);
  EXPECT_EQ(texelsOf(builder, {{"material", 0}}, 3), 0);
  EXPECT_EQ(texelsOf(builder, Json::object()), 0);
}

TEST(TextureUses, ATransformScalesAndChoosesTheSet) {
  Builder builder = texturedBuilder();
  builder.push(
      "materials",
      {{"emissiveTexture",
        {{"index", 0},
         {"extensions", {{"KHR_texture_transform", {{"scale", {2, -5}}, {"texCoord", 4}}}}}}}});
  EXPECT_EQ(texelsOf(builder, {{"material", 0}}, 4), 320);
  EXPECT_EQ(texelsOf(builder, {{"material", 0}}, 0), 0);
}

TEST(TextureUses, VariantsHaveMaterials) {
  Builder builder = texturedBuilder();
  for (const int texture : {0, 1, 2})
    builder.push("materials", {{"emissiveTexture", {{"index", texture}}}});
  const Json variants = {{"mappings", Json::array({{{"material", 1}, {"variants", {0}}}})}};
  EXPECT_EQ(texelsOf(builder, {{"material", 0}}), 64);
  EXPECT_EQ(
      texelsOf(builder, {{"material", 2}, {"extensions", {{"KHR_materials_variants", variants}}}}),
      2048);
}

/// What contradicts itself counts as unknown or as nothing, but never does harm.
TEST(TextureUses, OddDocuments) {
  for (const Json& texture :
       {Json{{"index", 99}}, Json{{"index", 4294967295}}, Json{{"index", 0}, {"texCoord", -1}},
        Json{{"index", 0}, {"extensions", {{"KHR_texture_transform", 5}}}},
        Json{{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", "x"}}}}}}}) {
    Builder builder = texturedBuilder();
    builder.push("materials", {{"emissiveTexture", texture}});
    const double texels = texelsOf(builder, {{"material", 0}});
    EXPECT_TRUE(texels == 64 || texels == TextureUses::kUsualTexels) << texture.dump();
    EXPECT_EQ(texelsOf(builder, {{"material", 1}}), 0);
    EXPECT_EQ(texelsOf(builder, {{"material", "x"}}), 0);
  }
  Builder builder;
  builder.push("images", {{"bufferView", 12345}});
  builder.push("images", {{"uri", "data:image/png;base64,?"}});
  builder.push("images", Json::object());
  for (const int image : {0, 1, 2, 99}) builder.push("textures", {{"source", image}});
  for (const int texture : {0, 1, 2, 3})
    builder.push("materials", {{"emissiveTexture", {{"index", texture}}}});
  for (const int material : {0, 1, 2, 3})
    EXPECT_EQ(texelsOf(builder, {{"material", material}}), TextureUses::kUsualTexels);
}

}  // namespace
}  // namespace mcc::gltf::test
