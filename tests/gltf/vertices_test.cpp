// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Accessors of vertex numbers (CESIUM_primitive_outline, CESIUM_tile_edges) name the same vertices
// after compression, in whatever order these come.
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "gltf/round_trip.h"
#include "support/plain_reader.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

constexpr uint32_t kSize = 20;
constexpr uint32_t kRow = kSize + 1;

/// The pairs of vertices along two sides of a sheet, and one that is far away.
std::vector<uint32_t> edgesOfSheet() {
  std::vector<uint32_t> numbers = {kRow * kRow - 1, 0};
  for (uint32_t i = 0; i < kSize; ++i) {
    numbers.insert(numbers.end(), {i, i + 1, i * kRow, (i + 1) * kRow});
  }
  return numbers;
}

uint32_t addNumbers(Builder& builder, const std::vector<uint32_t>& numbers, int type) {
  uint32_t accessor = 0;
  if (type == kUnsignedInt) {
    accessor = builder.addAccessor(numbers, type, "SCALAR", numbers.size());
  } else if (type == kUnsignedShort) {
    accessor = builder.addIndices({numbers.begin(), numbers.end()});
  } else {
    accessor = builder.addAccessor(std::vector<uint8_t>(numbers.begin(), numbers.end()), type,
                                   "SCALAR", numbers.size());
  }
  builder.json["accessors"][accessor]["min"] = {*std::min_element(numbers.begin(), numbers.end())};
  builder.json["accessors"][accessor]["max"] = {*std::max_element(numbers.begin(), numbers.end())};
  return accessor;
}

/// Gives a primitive an outline.
void outline(Builder& builder, Json& primitive, uint32_t accessor) {
  primitive["extensions"]["CESIUM_primitive_outline"]["indices"] = accessor;
  builder.json["extensionsUsed"] = {"CESIUM_primitive_outline"};
}

uint64_t numberAt(const std::string& element) {
  uint64_t number = 0;
  std::memcpy(&number, element.data(), element.size());
  return number;
}

/// Returns the vertices that an accessor names, each as the bytes of its attributes.
std::vector<std::string> namedVertices(const std::vector<uint8_t>& file, const Json& primitive,
                                       uint32_t accessor) {
  PlainDocument document;
  EXPECT_EQ(document.load({{"file", file}}, "file"), "");
  std::map<std::string, std::vector<std::string>> attributes;  // sorted by their names
  for (const auto& [name, number] : primitive["attributes"].items())
    attributes[name] = document.elements(number.get<uint64_t>()).values;
  std::vector<std::string> tuples(attributes.begin()->second.size());
  for (const auto& [name, values] : attributes) {
    for (size_t i = 0; i < tuples.size(); ++i) tuples[i] += values.at(i);
  }
  std::vector<std::string> named;
  for (const std::string& element : elementsInOrder(file, accessor)) {
    const uint64_t number = numberAt(element);
    named.push_back(number < tuples.size() ? tuples[number] : "none");
  }
  return named;
}

/// Expects that the accessor names the same vertices in the decoded file, of which no two are
/// equal, and that its bounds are those of its numbers. The codec is lossless.
void expectSameVertices(const RoundTrip& trip, const Json& primitive, uint32_t accessor) {
  const Json decoded = jsonOf(trip.decoded);
  EXPECT_EQ(namedVertices(trip.source, primitive, accessor),
            namedVertices(trip.decoded, decoded["meshes"][0]["primitives"][0], accessor));
  EXPECT_EQ(elementsInOrder(trip.converted, accessor), elementsInOrder(trip.decoded, accessor));
  const Json& json = decoded["accessors"][accessor];
  if (!json.contains("max")) return;
  uint64_t low = ~uint64_t{0};
  uint64_t high = 0;
  for (const std::string& element : elementsInOrder(trip.decoded, accessor)) {
    low = std::min(low, numberAt(element));
    high = std::max(high, numberAt(element));
  }
  EXPECT_EQ(json["min"][0], low);
  EXPECT_EQ(json["max"][0], high);
}

bool keepsVertexOrder(const RoundTrip& trip, const Json& primitive) {
  const uint32_t position = primitive["attributes"]["POSITION"];
  return elementsInOrder(trip.source, position) == elementsInOrder(trip.decoded, position);
}

TEST(VertexNumbers, OutlinesNameTheSameVertices) {
  for (const int type : {kUnsignedShort, kUnsignedInt}) {
    Builder builder;
    Json primitive = Sheet(kSize).addTo(builder);
    const uint32_t accessor = addNumbers(builder, edgesOfSheet(), type);
    outline(builder, primitive, accessor);
    builder.addMesh({primitive});
    builder.json["bufferViews"].back()["target"] = 34963;
    const RoundTrip trip = roundTrip(builder, lossless());
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_FALSE(keepsVertexOrder(trip, primitive));
    EXPECT_NE(elementsInOrder(trip.source, accessor), elementsInOrder(trip.decoded, accessor));
    expectSameVertices(trip, primitive, accessor);
    const Json json = jsonOf(trip.converted);
    EXPECT_EQ(json["accessors"][accessor]["componentType"], type);
    EXPECT_EQ(
        json["bufferViews"][json["accessors"][accessor]["bufferView"].get<size_t>()]["target"],
        34963);
    EXPECT_EQ(json["bufferViews"].size(), 2u);  // the payload and the numbers, no old ones
  }
}

/// Small meshes may have numbers of one byte.
TEST(VertexNumbers, BytesAreEnoughForSmallMeshes) {
  Builder builder;
  Json primitive = Sheet(12).addTo(builder);
  const uint32_t accessor = addNumbers(builder, {0, 168, 12, 13, 5, 6, 90}, kUnsignedByte);
  outline(builder, primitive, accessor);
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder, lossless());
  ASSERT_EQ(trip.error, "");
  EXPECT_FALSE(keepsVertexOrder(trip, primitive));
  expectSameVertices(trip, primitive, accessor);
}

TEST(VertexNumbers, FourSidesOfATile) {
  Builder builder;
  Json primitive = Sheet(kSize).addTo(builder);
  Json& edges = primitive["extensions"]["CESIUM_tile_edges"];
  std::vector<uint32_t> accessors;
  for (const char* side : {"left", "bottom", "right", "top"}) {
    std::vector<uint32_t> numbers;
    for (uint32_t i = 0; i <= kSize; ++i) {
      const uint32_t first = side[0] == 'l' || side[0] == 'b' ? 0
                             : side[0] == 'r'                 ? kSize
                                                              : kSize * kRow;
      numbers.push_back(first + i * (side[0] == 'l' || side[0] == 'r' ? kRow : 1));
    }
    accessors.push_back(addNumbers(builder, numbers, kUnsignedShort));
    edges[side] = accessors.back();
  }
  builder.addMesh({primitive});
  builder.json["extensionsUsed"] = {"CESIUM_tile_edges"};
  const RoundTrip trip = roundTrip(builder, lossless());
  ASSERT_EQ(trip.error, "");
  EXPECT_FALSE(keepsVertexOrder(trip, primitive));
  for (const uint32_t accessor : accessors) expectSameVertices(trip, primitive, accessor);
}

/// Options that decide about the orders themselves.
TEST(VertexNumbers, EveryKindOfPayload) {
  const std::vector<std::function<void(ConvertOptions&)>> kinds = {
      [](ConvertOptions& options) { options.indices_only = true; },
      [](ConvertOptions& options) { options.drop_unused = true; },
      [](ConvertOptions& options) { options.keep_vertex_order = true; },
      [](ConvertOptions& options) { options.keep_triangle_order = true; },
      [](ConvertOptions& options) { options.block_triangles = 200; },
      [](ConvertOptions& options) { options.prefer = Preference::kSize; },
  };
  for (size_t kind = 0; kind < kinds.size(); ++kind) {
    SCOPED_TRACE(kind);
    Builder builder;
    Sheet sheet(kSize);
    sheet.indices.resize(sheet.indices.size() - 60);  // some vertices are in no triangle
    Json primitive = sheet.addTo(builder);
    const uint32_t accessor = addNumbers(builder, edgesOfSheet(), kUnsignedShort);
    outline(builder, primitive, accessor);
    builder.addMesh({primitive});
    ConvertOptions options = lossless();
    kinds[kind](options);
    const RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_EQ(keepsVertexOrder(trip, primitive), options.keep_vertex_order);
    expectSameVertices(trip, primitive, accessor);
  }
}

/// Where numbers cannot be changed, the order of the vertices is kept and they stay what they were.
TEST(VertexNumbers, SharedOrStrangeNumbersKeepTheOrder) {
  using Change = std::function<void(Builder&, uint32_t accessor)>;
  const std::vector<std::pair<const char*, Change>> changes = {
      {"another piece has the same outline",
       [](Builder& builder, uint32_t accessor) {
         Json other = Sheet(kSize, 0.3f).addTo(builder);
         outline(builder, other, accessor);
         builder.json["meshes"][0]["primitives"].push_back(other);
       }},
      {"lines are drawn with the same numbers",
       [](Builder& builder, uint32_t accessor) {
         Json lines = builder.json["meshes"][0]["primitives"][0];
         lines.erase("extensions");
         lines["mode"] = 1;
         lines["indices"] = accessor;
         builder.json["meshes"][0]["primitives"].push_back(lines);
       }},
      {"an extension names the accessor",
       [](Builder& builder, uint32_t accessor) {
         builder.json["extensions"]["ACME_lines"]["accessor"] = accessor;
       }},
      {"an instance has the same numbers",
       [](Builder& builder, uint32_t accessor) {
         builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
                     ["_FEATURE_ID_0"] = accessor;
       }},
      {"the accessor has an unknown extension",
       [](Builder& builder, uint32_t accessor) {
         builder.json["accessors"][accessor]["extensions"]["ACME_lines"]["a"] = 1;
       }},
      {"sparse",
       [](Builder& builder, uint32_t accessor) {
         const uint32_t index = builder.addView({1, 0, 0, 0});
         const uint32_t value = builder.addView({9, 0, 0, 0});
         builder.json["accessors"][accessor]["sparse"] = {
             {"count", 1},
             {"indices", {{"bufferView", index}, {"componentType", kUnsignedShort}}},
             {"values", {{"bufferView", value}}}};
       }},
      {"a number is too large",
       [](Builder& builder, uint32_t accessor) {
         const size_t view = builder.json["accessors"][accessor]["bufferView"];
         const size_t offset = builder.json["bufferViews"][view]["byteOffset"];
         builder.bin[offset + 1] = 0xff;
       }},
  };
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    Builder builder;
    Json primitive = Sheet(kSize).addTo(builder);
    const uint32_t accessor = addNumbers(builder, edgesOfSheet(), kUnsignedShort);
    outline(builder, primitive, accessor);
    builder.addMesh({primitive});
    change(builder, accessor);
    const RoundTrip trip = roundTrip(builder, lossless());
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_TRUE(keepsVertexOrder(trip, primitive));
    EXPECT_EQ(elementsInOrder(trip.source, accessor), elementsInOrder(trip.decoded, accessor));
  }
}

/// Primitives that share their vertices may share an outline or have several.
TEST(VertexNumbers, PrimitivesOfOnePiece) {
  Builder builder;
  const Sheet sheet(kSize);
  Json first = sheet.addTo(builder);
  const auto half = static_cast<ptrdiff_t>(sheet.indices.size() / 6 * 3);
  first["indices"] = builder.addIndices({sheet.indices.begin(), sheet.indices.begin() + half});
  Json second = first;
  second["indices"] = builder.addIndices({sheet.indices.begin() + half, sheet.indices.end()});
  Json third = second;
  const uint32_t common = addNumbers(builder, edgesOfSheet(), kUnsignedShort);
  const uint32_t own = addNumbers(builder, {1, 2, 23, 44, 99, 100}, kUnsignedShort);
  outline(builder, first, common);
  outline(builder, second, common);
  outline(builder, third, own);
  builder.addMesh({first, second, third});
  const RoundTrip trip = roundTrip(builder, lossless());
  ASSERT_EQ(trip.error, "");
  EXPECT_FALSE(keepsVertexOrder(trip, first));
  expectSameVertices(trip, first, common);
  expectSameVertices(trip, first, own);
}

/// A primitive that is left as it was needs the old numbers.
TEST(VertexNumbers, APrimitiveThatIsLeftAloneKeepsTheOrder) {
  Builder builder;
  Json first = Sheet(kSize).addTo(builder);
  const uint32_t accessor = addNumbers(builder, edgesOfSheet(), kUnsignedShort);
  outline(builder, first, accessor);
  Json second = first;
  second["mode"] = 5;
  second["extensions"]["ACME_polygons"] = {{"a", 1}};
  builder.addMesh({first, second});
  builder.json["extensionsUsed"].push_back("ACME_polygons");
  const RoundTrip trip = roundTrip(builder, [] {
    ConvertOptions options = lossless();
    options.allow_larger = true;
    return options;
  }());
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  ASSERT_FALSE(isCompressed(jsonOf(trip.converted), 0, 1));
  EXPECT_EQ(elementsInOrder(trip.source, accessor), elementsInOrder(trip.decoded, accessor));
  EXPECT_TRUE(keepsVertexOrder(trip, first));
}

/// The triangles and their edges have the same accessor.
TEST(VertexNumbers, IndicesThatAreAlsoEdges) {
  Builder builder;
  Json primitive = Sheet(kSize).addTo(builder);
  const uint32_t accessor = primitive["indices"];
  outline(builder, primitive, accessor);
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder, [] {
    ConvertOptions options = lossless();
    options.allow_larger = true;
    return options;
  }());
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  expectSameVertices(trip, primitive, accessor);
}

TEST(VertexNumbers, ValidatorHasNoObjection) {
  const std::string missing = mcc::test::Validator::whyNot();
  if (!missing.empty()) GTEST_SKIP() << missing;
  const mcc::test::ScratchFolder folder;
  mcc::test::Validator validator(folder.path());
  Builder builder;
  Json primitive = Sheet(kSize).addTo(builder);
  outline(builder, primitive, addNumbers(builder, edgesOfSheet(), kUnsignedShort));
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder);
  validator.add("outline", trip.source, trip.converted, trip.decoded);
  EXPECT_TRUE(validator.run()) << "the lines above name what is new";
}

}  // namespace
}  // namespace mcc::gltf::test
