// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Extensions that name vertices or triangles by number, or draw the same bytes another way. What
// they say of places in space is the same after compression, in whatever order vertices and
// triangles come.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "gltf/places.h"
#include "gltf/round_trip.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

/// Turns a triangle so that it begins with its least place.
Triangle turned(const Triangle& triangle) {
  return std::min(
      {triangle, {triangle[1], triangle[2], triangle[0]}, {triangle[2], triangle[0], triangle[1]}});
}

/// Returns the triangles of a strip, or of several that are divided by `restart`.
std::multiset<Triangle> trianglesOfStrips(const std::vector<uint32_t>& numbers, uint32_t restart,
                                          const std::vector<Place>& places) {
  std::multiset<Triangle> triangles;
  size_t first = 0;
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] == restart) first = i + 1;
    if (numbers[i] == restart || i < first + 2) continue;
    const bool is_odd = (i - first) % 2 != 0;
    const auto at = [&](size_t k) { return places.at(numbers[k]); };
    triangles.insert(turned({at(i - 2), at(is_odd ? i : i - 1), at(is_odd ? i - 1 : i)}));
  }
  return triangles;
}

bool keepsVertexOrder(const RoundTrip& trip, const Json& primitive) {
  const uint32_t positions = primitive["attributes"]["POSITION"];
  return placesOf(trip.source, positions) == placesOf(trip.decoded, positions);
}

// ---- EXT_mesh_primitive_restart

constexpr uint32_t kRestart = 65535;

/// The rows of a sheet as strips, one after the other.
struct Strips {
  std::vector<uint16_t> numbers;
  std::vector<std::pair<size_t, size_t>> ranges;  ///< the first number of each strip, and how many

  Strips() {
    for (uint32_t y = 0; y < kSize; ++y) {
      if (y != 0) numbers.push_back(kRestart);
      ranges.emplace_back(numbers.size(), 2 * kRow);
      for (uint32_t x = 0; x <= kSize; ++x) {
        numbers.push_back(static_cast<uint16_t>((y + 1) * kRow + x));
        numbers.push_back(static_cast<uint16_t>(y * kRow + x));
      }
    }
  }
};

/// A mesh of strips that can be drawn at once, a strip of its own, and a list of triangles.
struct RestartDocument {
  Builder builder;
  Json group_strip;  ///< one of the group
  Json list;         ///< the last primitive
  uint32_t all = 0;  ///< the accessor of the indices of the group
  uint32_t other = 0;

  RestartDocument() {
    const Strips strips;
    const Json attributes = Sheet(kSize).addTo(builder)["attributes"];
    const uint32_t view = builder.addView(bytesOf(strips.numbers), 0, kForIndices);
    std::vector<Json> primitives;
    Json numbers = Json::array();
    for (const auto& [first, count] : strips.ranges) {
      numbers.push_back(primitives.size());
      const uint32_t indices = builder.addAccessor({{"bufferView", view},
                                                    {"byteOffset", 2 * first},
                                                    {"componentType", kUnsignedShort},
                                                    {"count", count},
                                                    {"type", "SCALAR"}});
      group_strip = {{"attributes", attributes}, {"indices", indices}, {"mode", 5}};
      primitives.push_back(group_strip);
    }
    all = builder.addAccessor(view, kUnsignedShort, "SCALAR", strips.numbers.size());
    list = Sheet(kSize).addTo(builder);
    primitives.push_back(list);
    builder.addMesh(primitives);
    other = builder.addMesh({Sheet(24).addTo(builder)});
    builder.json["meshes"][0]["extensions"]["EXT_mesh_primitive_restart"]["primitiveGroups"] = {
        {{"primitives", numbers}, {"indices", all}}};
    builder.json["extensionsUsed"] = {"EXT_mesh_primitive_restart"};
  }
};

TEST(MeshExtensions, GroupsOfStripsAreDrawnAsBefore) {
  const RestartDocument d;
  for (const ConvertOptions& options : exactAndRounded()) {
    const RoundTrip trip = roundTrip(d.builder, options);
    ASSERT_EQ(trip.error, "");
    const Json converted = jsonOf(trip.converted);
    const uint32_t positions = d.group_strip["attributes"]["POSITION"];
    std::multiset<Triangle> separate;
    for (uint32_t i = 0; i < kSize; ++i) {
      EXPECT_FALSE(isCompressed(converted, 0, i)) << i;
      separate.merge(trianglesOfStrips(
          numbersOf(trip.decoded, converted["meshes"][0]["primitives"][i]["indices"]), kRestart,
          placesOf(trip.decoded, positions)));
    }
    EXPECT_TRUE(hasNote(trip.report, "belongs to a group of EXT_mesh_primitive_restart"));
    for (const auto* file : {&trip.source, &trip.converted, &trip.decoded}) {
      EXPECT_EQ(trianglesOfStrips(numbersOf(*file, d.all), kRestart, placesOf(*file, positions)),
                separate);
    }
    EXPECT_EQ(separate.size(), 2 * kSize * kSize);
    EXPECT_EQ(converted["meshes"][0]["extensions"], d.builder.json["meshes"][0]["extensions"]);
    // All others are compressed as if the extension were not there.
    EXPECT_TRUE(isCompressed(converted, 0, kSize));
    EXPECT_FALSE(keepsVertexOrder(trip, d.list));
    EXPECT_TRUE(isCompressed(converted, d.other, 0));
  }
}

/// Nobody else names the indices of a group as such, but another mesh may use them as its own.
TEST(MeshExtensions, IndicesOfAGroupAreNotChangedForAnotherMesh) {
  RestartDocument d;
  Json& meshes = d.builder.json["meshes"];
  Json& group = meshes[0]["extensions"]["EXT_mesh_primitive_restart"]["primitiveGroups"][0];
  group["primitives"] = {3};
  group["indices"] = meshes[1]["primitives"][0]["indices"];
  const RoundTrip trip = roundTrip(d.builder);
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 1, 0));
  for (const auto* file : {&trip.converted, &trip.decoded}) {
    EXPECT_EQ(numbersOf(*file, group["indices"]), numbersOf(trip.source, group["indices"]));
  }
}

/// Groups of some other version may mean anything.
TEST(MeshExtensions, UnknownGroupsKeepEveryOrder) {
  for (const char* object :
       {"{}", R"({"primitiveGroups":{}})", R"({"primitiveGroups":[7]})",
        R"({"primitiveGroups":[{"primitives":[0],"first":1}]})",
        R"({"primitiveGroups":[{"indices":1}]})", R"({"primitiveGroups":[{"primitives":["0"]}]})",
        R"({"primitiveGroups":[{"primitives":[-1]}]})", R"({"primitiveGroups":[],"faces":[]})"}) {
    SCOPED_TRACE(object);
    RestartDocument d;
    ASSERT_TRUE(parseJson(asBytes(object),
                          d.builder.json["meshes"][0]["extensions"]["EXT_mesh_primitive_restart"])
                    .ok());
    const RoundTrip trip = roundTrip(d.builder);
    ASSERT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, kSize));
    EXPECT_TRUE(keepsVertexOrder(trip, d.list));
  }
}

// ---- EXT_mesh_manifold

/// A pillow of two sheets, whose vertices differ along the rim because their normals do. The
/// extension says which of them are one, and that this closes the surface.
struct ManifoldDocument {
  Builder builder;
  uint32_t positions = 0;
  uint32_t indices = 0;  ///< of the whole surface
  uint32_t merge_indices = 0;
  uint32_t merge_values = 0;

  ManifoldDocument() {
    const Sheet sheet(kSize);
    std::vector<float> all_positions;
    std::vector<float> normals;
    std::vector<uint16_t> numbers;
    for (const bool is_back : {false, true}) {
      for (uint32_t i = 0; i < sheet.count(); ++i) {
        const float u = sheet.positions[3 * i];
        const float v = sheet.positions[3 * i + 1];
        const float height = u * (1 - u) * v * (1 - v);
        all_positions.insert(all_positions.end(), {u, v, is_back ? -height : height});
        normals.insert(normals.end(), {0, 0, is_back ? -1.0f : 1.0f});
      }
    }
    // The diagonals differ, so that none of them joins the same two vertices of the rim.
    for (const uint16_t number : sheet.indices) numbers.push_back(number);
    for (uint32_t i = 0; i + kRow < sheet.count(); ++i) {
      if (i % kRow == kSize) continue;
      const uint32_t a = sheet.count() + i;
      for (const uint32_t number : {a, a + kRow, a + 1, a + 1, a + kRow, a + kRow + 1}) {
        numbers.push_back(static_cast<uint16_t>(number));
      }
    }
    addIndices(numbers, sheet.count());
    positions = builder.addPositions(all_positions);
    const Json attributes = {{"POSITION", positions}, {"NORMAL", builder.addFloats(normals, 3)}};
    const uint32_t half = static_cast<uint32_t>(numbers.size() / 2);
    builder.addMesh({{{"attributes", attributes}, {"indices", addHalf(0, half)}},
                     {{"attributes", attributes}, {"indices", addHalf(half, half)}}});
    builder.addMesh({Sheet(24).addTo(builder)});
    builder.json["meshes"][0]["extensions"]["EXT_mesh_manifold"] = {
        {"manifoldPrimitive",
         {{"indices", indices}, {"mode", 4}, {"attributes", {{"POSITION", positions}}}}},
        {"mergeIndices", merge_indices},
        {"mergeValues", merge_values}};
    builder.json["extensionsUsed"] = {"EXT_mesh_manifold"};
  }

 private:
  /// Adds a sparse accessor that merges the vertices of the rim, and accessors over its parts.
  void addIndices(const std::vector<uint16_t>& numbers, uint32_t count) {
    std::vector<uint16_t> merged;
    std::vector<uint16_t> values;
    for (size_t i = numbers.size() / 2; i < numbers.size(); ++i) {
      const uint32_t number = numbers[i] - count;
      const bool is_on_rim = number % kRow % kSize == 0 || number / kRow % kSize == 0;
      if (!is_on_rim) continue;
      merged.push_back(static_cast<uint16_t>(i));
      values.push_back(static_cast<uint16_t>(number));
    }
    const size_t value_offset = 2 * merged.size();
    const size_t merge_count = merged.size();
    merged.insert(merged.end(), values.begin(), values.end());
    const uint32_t merge_view = builder.addView(bytesOf(merged));
    const Json value_place = {{"bufferView", merge_view}, {"byteOffset", value_offset}};
    merge_indices = builder.addAccessor(merge_view, kUnsignedShort, "SCALAR", merge_count);
    Json value_accessor = {
        {"componentType", kUnsignedShort}, {"count", merge_count}, {"type", "SCALAR"}};
    value_accessor.update(value_place);
    merge_values = builder.addAccessor(value_accessor);
    index_view_ = builder.addView(bytesOf(numbers), 0, kForIndices);
    indices = builder.addAccessor(
        {{"bufferView", index_view_},
         {"componentType", kUnsignedShort},
         {"count", numbers.size()},
         {"type", "SCALAR"},
         {"sparse",
          {{"count", merge_count},
           {"indices", {{"bufferView", merge_view}, {"componentType", kUnsignedShort}}},
           {"values", value_place}}}});
  }

  uint32_t addHalf(uint32_t first, uint32_t count) {
    return builder.addAccessor({{"bufferView", index_view_},
                                {"byteOffset", 2 * first},
                                {"componentType", kUnsignedShort},
                                {"count", count},
                                {"type", "SCALAR"}});
  }

  uint32_t index_view_ = 0;
};

/// Expects that each directed edge of the surface is there once, and once the other way.
void expectClosed(const std::vector<uint32_t>& numbers) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> count_of;
  for (size_t i = 0; i < numbers.size(); ++i) {
    ++count_of[{numbers[i], numbers[i % 3 == 2 ? i - 2 : i + 1]}];
  }
  for (const auto& [edge, count] : count_of) {
    EXPECT_EQ(count, 1u);
    EXPECT_EQ(count_of.count({edge.second, edge.first}), 1u);
  }
}

/// Expects the surface in a file, closed and in its places, and its sparse values where the
/// extension says that they are.
void expectManifold(const ManifoldDocument& d, const std::vector<uint8_t>& file) {
  const std::vector<uint8_t> source = d.builder.toGlb();
  expectClosed(numbersOf(file, d.indices));
  for (const uint32_t accessor : {d.positions, d.indices, d.merge_indices, d.merge_values}) {
    EXPECT_EQ(elementsInOrder(file, accessor), elementsInOrder(source, accessor));
  }
  const Json json = jsonOf(file);
  const Json& accessors = json["accessors"];
  EXPECT_EQ(json["meshes"][0], d.builder.json["meshes"][0]);
  const Json& sparse = accessors[d.indices]["sparse"];
  const auto placeOf = [](const Json& object) {
    return std::pair(object["bufferView"].get<uint32_t>(),
                     object.contains("byteOffset") ? object["byteOffset"].get<uint32_t>() : 0);
  };
  EXPECT_EQ(placeOf(accessors[d.merge_indices]), placeOf(sparse["indices"]));
  EXPECT_EQ(placeOf(accessors[d.merge_values]), placeOf(sparse["values"]));
  for (const Json& primitive : json["meshes"][0]["primitives"]) {
    EXPECT_EQ(accessors[primitive["indices"].get<size_t>()]["bufferView"],
              accessors[d.indices]["bufferView"]);
  }
}

TEST(MeshExtensions, ManifoldMeshesStayClosed) {
  for (const ConvertOptions& options : exactAndRounded()) {
    const ManifoldDocument d;
    const RoundTrip trip = roundTrip(d.builder, options);
    ASSERT_EQ(trip.error, "");
    EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 0, 1));
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 1, 0));
    EXPECT_TRUE(hasNote(trip.report, "belongs to a mesh with EXT_mesh_manifold"));
    for (const auto* file : {&trip.source, &trip.converted, &trip.decoded}) {
      expectManifold(d, *file);
    }
  }
}

/// The extension may come after one that we do not know.
TEST(MeshExtensions, ManifoldMeshesStayClosedWhateverElseTheyHave) {
  ManifoldDocument d;
  Json& extensions = d.builder.json["meshes"][0]["extensions"];
  const Json manifold = extensions["EXT_mesh_manifold"];
  extensions = Json::object();
  extensions["ACME_mesh"] = {{"a", 1}};
  extensions["EXT_mesh_manifold"] = manifold;
  const RoundTrip trip = roundTrip(d.builder);
  ASSERT_EQ(trip.error, "");
  for (const auto* file : {&trip.converted, &trip.decoded}) expectManifold(d, *file);
}

/// A mesh may show the whole surface, with the accessors of the extension.
TEST(MeshExtensions, TheSurfaceOfAManifoldMeshIsNotChangedForAnotherMesh) {
  ManifoldDocument d;
  const uint32_t whole =
      d.builder.addMesh({{{"attributes", {{"POSITION", d.positions}}}, {"indices", d.indices}}});
  const RoundTrip trip = roundTrip(d.builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), whole, 0));
  for (const auto* file : {&trip.converted, &trip.decoded}) expectManifold(d, *file);
}

// ---- EXT_mesh_primitive_edge_visibility and CESIUM_primitive_outline

/// An edge without a direction.
using Edge = std::array<Place, 2>;
Edge edgeOf(const Place& a, const Place& b) { return {std::min(a, b), std::max(a, b)}; }

constexpr uint32_t kHidden = 0;
constexpr uint32_t kSilhouette = 1;
constexpr uint32_t kHard = 2;
constexpr uint32_t kHardAgain = 3;

/// What EXT_mesh_primitive_edge_visibility says of a primitive.
struct VisibleEdges {
  std::multiset<std::pair<Edge, uint32_t>> edges;  ///< those that are not hidden
  std::map<Edge, Place> mates;  ///< of silhouettes: the third vertex of the other triangle
  std::vector<std::vector<Place>> line_strings;  ///< a place of -1 divides them

  bool operator==(const VisibleEdges&) const = default;
};

VisibleEdges visibleEdgesIn(const std::vector<uint8_t>& file, const Json& primitive) {
  const Json& extension = primitive["extensions"]["EXT_mesh_primitive_edge_visibility"];
  const std::vector<Place> places = placesOf(file, primitive["attributes"]["POSITION"]);
  const std::vector<uint32_t> corners = numbersOf(file, primitive["indices"]);
  const std::vector<uint32_t> bits = numbersOf(file, extension["visibility"]);
  const std::vector<uint32_t> mates = numbersOf(file, extension["silhouetteMates"]);
  VisibleEdges visible;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Edge edge = edgeOf(places.at(corners[i]), places.at(corners[i % 3 == 2 ? i - 2 : i + 1]));
    const uint32_t value = bits.at(i / 4) >> (2 * (i % 4)) & 3;
    if (value == kSilhouette) visible.mates[edge] = places.at(mates.at(visible.mates.size()));
    if (value != kHidden) visible.edges.emplace(edge, value);
  }
  for (const Json& line_string : extension["lineStrings"]) {
    std::vector<Place>& string = visible.line_strings.emplace_back();
    for (const uint32_t number : numbersOf(file, line_string["indices"])) {
      string.push_back(number == kRestart ? Place{-1, -1} : places.at(number));
    }
  }
  return visible;
}

/// Gives a sheet visible edges: its rim and every fifth row are hard, its diagonals are
/// silhouettes, and two columns are strings.
void addVisibility(Builder& builder, Json& primitive) {
  const std::vector<uint16_t> corners = Sheet(kSize).indices;
  std::vector<uint8_t> bits((2 * corners.size() + 7) / 8, 0);
  std::vector<uint16_t> mates;
  std::set<std::pair<uint32_t, uint32_t>> is_known;
  for (size_t i = 0; i < corners.size(); ++i) {
    const auto [a, b] = std::minmax(corners[i], corners[i % 3 == 2 ? i - 2 : i + 1]);
    const bool is_again = !is_known.emplace(a, b).second;
    const bool is_hard = b == a + 1 && a / kRow % 5 == 0;
    const bool is_silhouette = b == a + kRow + 1;
    if (is_silhouette && !is_again) mates.push_back(static_cast<uint16_t>(a + kRow));
    const uint32_t value = is_hard                      ? (is_again ? kHardAgain : kHard)
                           : is_silhouette && !is_again ? kSilhouette
                                                        : kHidden;
    bits[i / 4] = static_cast<uint8_t>(bits[i / 4] | value << (2 * (i % 4)));
  }
  std::vector<uint16_t> strings;
  for (uint32_t y = 0; y <= kSize; ++y) strings.push_back(static_cast<uint16_t>(y * kRow + 3));
  strings.push_back(kRestart);
  for (uint32_t y = 0; y <= kSize; ++y) strings.push_back(static_cast<uint16_t>(y * kRow + 9));
  primitive["extensions"]["EXT_mesh_primitive_edge_visibility"] = {
      {"visibility", builder.addAccessor(bits, kUnsignedByte, "SCALAR", bits.size())},
      {"silhouetteMates", builder.addIndices(mates)},
      {"lineStrings", {{{"indices", builder.addIndices(strings)}}}}};
  builder.json["extensionsUsed"].push_back("EXT_mesh_primitive_edge_visibility");
}

Builder withVisibleEdges(Json& primitive) {
  Builder builder;
  primitive = Sheet(kSize).addTo(builder);
  addVisibility(builder, primitive);
  builder.addMesh({primitive});
  return builder;
}

TEST(MeshExtensions, TheSameEdgesAreVisible) {
  for (const ConvertOptions& options : exactAndRounded()) {
    Json primitive;
    const Builder builder = withVisibleEdges(primitive);
    const RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    const VisibleEdges source = visibleEdgesIn(trip.source, primitive);
    EXPECT_EQ(source.mates.size(), kSize * kSize);
    EXPECT_EQ(source.line_strings.at(0).size(), 2 * kRow + 1);
    EXPECT_TRUE(visibleEdgesIn(trip.decoded, primitive) == source);
    EXPECT_EQ(jsonOf(trip.decoded)["meshes"], builder.json["meshes"]);
  }
}

/// The triangles of strips and of vertices without indices have other numbers as lists.
TEST(MeshExtensions, VisibleEdgesOfStripsStayAsTheyWere) {
  for (const bool has_indices : {true, false}) {
    Builder builder;
    Json primitive = Sheet(kSize).addTo(builder);
    addVisibility(builder, primitive);
    primitive["mode"] = has_indices ? 5 : 4;
    if (!has_indices) primitive.erase("indices");
    builder.addMesh({primitive});
    builder.addMesh({Sheet(24).addTo(builder)});
    const RoundTrip trip = roundTrip(builder);
    ASSERT_EQ(trip.error, "");
    EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 0, 0));
    EXPECT_TRUE(hasNote(trip.report, "EXT_mesh_primitive_edge_visibility"));
    for (uint32_t i = 0; i < 7; ++i) {
      EXPECT_EQ(elementsInOrder(trip.decoded, i), elementsInOrder(trip.source, i));
    }
  }
}

std::vector<Edge> outlineIn(const std::vector<uint8_t>& file, const Json& primitive) {
  const std::vector<Place> places = placesOf(file, primitive["attributes"]["POSITION"]);
  const std::vector<uint32_t> ends =
      numbersOf(file, primitive["extensions"]["CESIUM_primitive_outline"]["indices"]);
  std::vector<Edge> edges;
  for (size_t i = 0; i < ends.size(); i += 2) {
    edges.push_back(edgeOf(places.at(ends[i]), places.at(ends[i + 1])));
  }
  return edges;
}

/// Vertices get other numbers, and the outline is the same. Not so where edges of triangles are
/// visible, too: they need every order.
TEST(MeshExtensions, OutlinesAreDrawnAsBefore) {
  for (const bool has_visible_edges : {false, true}) {
    for (const ConvertOptions& options : exactAndRounded()) {
      Builder builder;
      Json primitive = Sheet(kSize).addTo(builder);
      std::vector<uint16_t> ends;
      for (uint16_t i = 0; i < kSize; ++i) {
        ends.insert(ends.end(), {i, static_cast<uint16_t>(i + 1), static_cast<uint16_t>(i * kRow),
                                 static_cast<uint16_t>((i + 1) * kRow)});
      }
      primitive["extensions"]["CESIUM_primitive_outline"]["indices"] = builder.addIndices(ends);
      builder.json["extensionsUsed"] = {"CESIUM_primitive_outline"};
      if (has_visible_edges) addVisibility(builder, primitive);
      builder.addMesh({primitive});
      const RoundTrip trip = roundTrip(builder, options);
      ASSERT_EQ(trip.error, "");
      ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
      EXPECT_EQ(keepsVertexOrder(trip, primitive), has_visible_edges);
      EXPECT_EQ(outlineIn(trip.decoded, primitive), outlineIn(trip.source, primitive));
      if (!has_visible_edges) continue;
      EXPECT_TRUE(visibleEdgesIn(trip.decoded, primitive) ==
                  visibleEdgesIn(trip.source, primitive));
    }
  }
}

// ---- All of them

/// Whatever stands where objects and numbers of accessors should, it converts, and the result says
/// the same.
TEST(MeshExtensions, StrangeObjectsStayAsTheyWere) {
  for (const char* name : {"EXT_mesh_manifold", "EXT_mesh_primitive_restart"}) {
    for (const char* object :
         {"null", "7", "[]", R"("x")", R"({"manifoldPrimitive":7,"primitiveGroups":7})",
          R"({"manifoldPrimitive":{"attributes":[1],"indices":-1},"mergeIndices":1e99})",
          R"({"manifoldPrimitive":{"attributes":{"POSITION":"0"},"indices":99}})",
          R"({"manifoldPrimitive":{"attributes":{"POSITION":{}},"indices":[]}})",
          R"({"primitiveGroups":[{"primitives":[0,0,4294967296,1e99],"indices":{}}]})",
          R"({"primitiveGroups":[null,{"primitives":{"0":0},"indices":99}]})"}) {
      SCOPED_TRACE(std::string(name) + " " + object);
      Builder builder;
      builder.addMesh({Sheet(kSize).addTo(builder)});
      builder.addMesh({Sheet(24).addTo(builder)});
      Json& extension = builder.json["meshes"][0]["extensions"][name];
      ASSERT_TRUE(parseJson(asBytes(object), extension).ok());
      builder.json["extensionsUsed"] = {name};
      const RoundTrip trip = roundTrip(builder);
      ASSERT_EQ(trip.error, "");
      EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 1, 0));
      EXPECT_EQ(jsonOf(trip.decoded)["meshes"][0]["extensions"],
                builder.json["meshes"][0]["extensions"]);
    }
  }
}

TEST(MeshExtensions, ValidatorHasNoObjection) {
  const std::string missing = mcc::test::Validator::whyNot();
  if (!missing.empty()) GTEST_SKIP() << missing;
  const mcc::test::ScratchFolder folder;
  mcc::test::Validator validator(folder.path());
  const RoundTrip restart = roundTrip(RestartDocument().builder);
  const RoundTrip manifold = roundTrip(ManifoldDocument().builder);
  validator.add("manifold", manifold.source, manifold.converted, manifold.decoded);
  Json primitive;
  const RoundTrip edges = roundTrip(withVisibleEdges(primitive));
  validator.add("edges", edges.source, edges.converted, edges.decoded);
  validator.add("restart", restart.source, restart.converted, restart.decoded);
  EXPECT_TRUE(validator.run()) << "the lines above name what is new";
}

}  // namespace
}  // namespace mcc::gltf::test
