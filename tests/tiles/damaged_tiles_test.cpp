// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Headers that lie: every field of b3dm, i3dm and cmpt set to extremes.
#include <gtest/gtest.h>

#include "gltf/document/document.h"
#include "tiles/convert_tile.h"
#include "tiles/matrix.h"
#include "tiles/tileset_builder.h"

namespace mcc::test {
namespace {

/// Converts a tile as far as it can be; a crash or a sanitizer's finding is the failure.
bool convertAny(const Bytes& file) {
  tiles::TileFile tile;
  if (!tile.read(file).ok()) return false;
  Bytes output;
  tiles::TileFigures figures;
  std::vector<std::string> notes;
  gltf::ConvertOptions options;
  options.prefer = Preference::kSpeed;
  const auto choose = [](std::span<const uint8_t>, const tiles::TileModel&, tiles::Accuracy&) {
    return gltf::Result();
  };
  if (!tiles::convertTile(file, choose, options, output, figures, notes).ok()) return false;
  if (output.empty()) return true;
  tiles::TileFile again;
  const gltf::Result read = again.read(output);
  EXPECT_TRUE(read.ok()) << read.message();
  EXPECT_EQ(again.models().size(), tile.models().size());
  EXPECT_EQ(output.size() % 8, 0u);
  return true;
}

Bytes smallGlb() {
  gltf::test::Builder builder;
  builder.addMesh({gltf::test::Sheet(6).addTo(builder)});
  return builder.toGlb();
}

void expectSafe(const Bytes& tile, size_t header_bytes, size_t start = 0) {
  ASSERT_TRUE(convertAny(tile));
  const auto size = static_cast<uint32_t>(tile.size());
  for (size_t field = start + 4; field < start + header_bytes; field += 4) {
    uint32_t old = 0;
    std::memcpy(&old, tile.data() + field, 4);
    for (const uint32_t value :
         {0u,          1u,          2u,          7u,          8u,       12u,       28u,
          0x7fffffffu, 0x80000000u, 0xffffffffu, 0xfffffff8u, old - 1,  old + 1,   old + 7,
          old + 8,     old - 8,     size,        size - 1,    size + 1, size - 28, ~old + 1}) {
      Bytes damaged = tile;
      std::memcpy(damaged.data() + field, &value, 4);
      convertAny(damaged);
    }
  }
  for (size_t length = 0; length < std::min<size_t>(tile.size(), start + header_bytes + 40);
       ++length) {
    EXPECT_FALSE(convertAny(Bytes(tile.begin(), tile.begin() + static_cast<ptrdiff_t>(length))) &&
                 length > 4);
  }
}

TEST(DamagedTiles, FieldsOfB3dm) { expectSafe(makeB3dm(smallGlb(), 2), 28); }
TEST(DamagedTiles, FieldsOfI3dm) { expectSafe(makeI3dm(smallGlb(), 2), 32); }
TEST(DamagedTiles, FieldsOfCmpt) {
  const Bytes b3dm = makeB3dm(smallGlb(), 2);
  const Bytes cmpt = makeCmpt({b3dm, makeCmpt({makeI3dm(smallGlb(), 1)}), makePnts()});
  expectSafe(cmpt, 16);
  expectSafe(cmpt, 28, 16);
  expectSafe(cmpt, 16, 16 + b3dm.size());
  expectSafe(cmpt, 32, 32 + b3dm.size());
}

TEST(DamagedTiles, NestingIsBounded) {
  Bytes tile = makePnts();
  for (int i = 0; i < 5000; ++i) tile = makeCmpt({tile});
  tiles::TileFile file;
  const gltf::Result read = file.read(tile);
  EXPECT_NE(read.what.find("nested deeper than 64"), std::string::npos) << read.message();
}

TEST(DamagedTiles, FeatureTablesThatLie) {
  for (const char* json :
       {"{", "[]", "{\"RTC_CENTER\":3}", "{\"RTC_CENTER\":{\"byteOffset\":4294967290}}",
        "{\"RTC_CENTER\":[1,2]}", "{\"INSTANCES_LENGTH\":99999999,\"SCALE\":{\"byteOffset\":0}}",
        "{\"INSTANCES_LENGTH\":1e30,\"SCALE\":{\"byteOffset\":0}}", "{\"SCALE\":{}}",
        "{\"INSTANCES_LENGTH\":1,\"SCALE\":{\"byteOffset\":18446744073709551615}}",
        "{\"INSTANCES_LENGTH\":1,\"SCALE_NON_UNIFORM\":{\"byteOffset\":8}}"}) {
    Tables tables;
    tables.feature_json = paddedJson(json, 32);
    tables.feature_binary = Bytes(16, 0);
    tiles::TileFile file;
    const Bytes tile = makeModelTile("i3dm", tables, smallGlb());
    EXPECT_FALSE(file.read(tile).ok()) << json;
  }
}

/// Tables of a length that is not a multiple of 8 are padded, and keep their contents.
TEST(DamagedTiles, AlignmentIsRepaired) {
  Tables tables;
  tables.feature_json = "{\"BATCH_LENGTH\":1}";
  tables.batch_json = "{\"a\":[1]}";
  const Bytes tile = makeModelTile("b3dm", tables, smallGlb());
  tiles::TileFile file;
  ASSERT_TRUE(file.read(tile).ok());
  Bytes output;
  ASSERT_TRUE(file.rebuild({{}}, output).ok());
  tiles::TileFile again;
  ASSERT_TRUE(again.read(output).ok());
  EXPECT_EQ(again.models()[0].begin % 8, 0u);
  EXPECT_EQ(output.size() % 8, 0u);
  const std::string text(output.begin(), output.end());
  EXPECT_NE(text.find("{\"BATCH_LENGTH\":1} "), std::string::npos);
  EXPECT_NE(text.find("{\"a\":[1]} "), std::string::npos);
}

TEST(Matrix, LargestScale) {
  EXPECT_NEAR(tiles::largestScale(tiles::kIdentity), 1, 1e-9);
  EXPECT_EQ(tiles::largestScale({}), 0);
  // A rotation by 30 degrees of a stretch by 5 along one axis, and a shear.
  EXPECT_NEAR(tiles::largestScale({5 * 0.8660254037844386, 2.5, 0, 0, -0.5, 0.8660254037844386, 0,
                                   0, 0, 0, 2, 0, 9, 9, 9, 1}),
              5, 1e-8);
  EXPECT_NEAR(tiles::largestScale({1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
              (1 + std::sqrt(5.0)) / 2, 1e-8);
  for (const double s : {1e-308, 1e-200, 1e200, 1e308}) {
    EXPECT_NEAR(tiles::largestScale({0, s, 0, 0, s, 0, 0, 0, 0, 0, s, 0, 0, 0, 0, 1}) / s, 1, 1e-9);
  }
  constexpr double kMost = std::numeric_limits<double>::max();
  EXPECT_TRUE(std::isinf(tiles::largestScale(
      {kMost, kMost, kMost, 0, kMost, kMost, kMost, 0, kMost, kMost, kMost, 0, 0, 0, 0, 1})));
}

TEST(Accuracy, StepsAreLargeButNotTooLarge) {
  for (const double distance : {1e-9, 0.3, 0.5, 1.0, std::sqrt(3.0) / 2, 123.0, 1e9}) {
    const double step = tiles::stepFor(distance);
    EXPECT_LE(step * std::sqrt(3.0) / 2, distance);
    EXPECT_GT(step * std::sqrt(3.0), distance);
    int exponent = 0;
    EXPECT_EQ(std::frexp(step, &exponent), 0.5);
  }
}

}  // namespace
}  // namespace mcc::test
