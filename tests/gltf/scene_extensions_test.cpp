// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Extensions that choose materials, animate, repeat or describe what meshes show. What they say of
// a place in space is the same after compression.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "gltf/places.h"
#include "gltf/round_trip.h"
#include "support/document_compare.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

std::vector<uint8_t> decodedToIntegers(const RoundTrip& trip) {
  DecodeOptions options;
  options.decode_to = DecodeTo::kIntegers;
  std::vector<uint8_t> decoded;
  DecodeReport report;
  EXPECT_EQ(decodeGlb(trip.converted, decoded, report, options).message(), "");
  return decoded;
}

// ---- KHR_materials_variants

/// Halves of a sheet with the same vertices; the variants give them different materials.
Builder withVariants() {
  Builder builder;
  const Sheet sheet(kSize);
  const Json primitive = sheet.addTo(builder);
  std::vector<Json> halves;
  for (const size_t half : {size_t{0}, size_t{1}}) {
    const auto middle =
        sheet.indices.begin() + static_cast<std::ptrdiff_t>(sheet.indices.size() / 2);
    const std::vector<uint16_t> indices = half == 0 ? std::vector(sheet.indices.begin(), middle)
                                                    : std::vector(middle, sheet.indices.end());
    Json own = primitive;
    own["indices"] = builder.addIndices(indices);
    own["material"] = half;
    own["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 2 + half}, {"variants", {0, 2}}}, {{"material", 0}, {"variants", {1}}}};
    halves.push_back(own);
  }
  builder.addMesh(halves);
  builder.json["materials"] = Json::array();
  for (const char* name : {"a", "b", "c", "d"}) {
    builder.json["materials"].push_back({{"name", name}});
  }
  builder.json["extensions"]["KHR_materials_variants"]["variants"] = {
      {{"name", "red"}}, {{"name", "green"}}, {{"name", "blue"}}, {{"name", "none"}}};
  builder.json["extensionsUsed"] = {"KHR_materials_variants"};
  return builder;
}

/// The material of each triangle, by its places in any order, in a variant.
std::map<std::set<Place>, std::string> materialsIn(const std::vector<uint8_t>& file,
                                                   uint32_t variant) {
  const Json json = jsonOf(file);
  std::map<std::set<Place>, std::string> materials;
  for (const Json& primitive : json["meshes"][0]["primitives"]) {
    uint32_t material = primitive["material"];
    for (const Json& mapping : primitive["extensions"]["KHR_materials_variants"]["mappings"]) {
      for (const Json& number : mapping["variants"]) {
        if (number == variant) material = mapping["material"];
      }
    }
    const std::vector<Place> places = placesOf(file, primitive["attributes"]["POSITION"]);
    const std::vector<uint32_t> corners = numbersOf(file, primitive["indices"]);
    for (size_t i = 0; i < corners.size(); i += 3) {
      const std::set<Place> triangle = {places.at(corners[i]), places.at(corners[i + 1]),
                                        places.at(corners[i + 2])};
      materials[triangle] = json["materials"][material]["name"].get<std::string>();
    }
  }
  return materials;
}

TEST(SceneExtensions, VariantsHaveTheSameMaterials) {
  for (const ConvertOptions& options : exactAndRounded()) {
    const RoundTrip trip = roundTrip(withVariants(), options);
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 1));
    for (uint32_t variant = 0; variant < 4; ++variant) {
      const auto source = materialsIn(trip.source, variant);
      EXPECT_EQ(source.size(), 2 * kSize * kSize);
      EXPECT_EQ(materialsIn(trip.decoded, variant), source);
    }
    EXPECT_FALSE(materialsIn(trip.source, 0) == materialsIn(trip.source, 1));
  }
}

// ---- KHR_animation_pointer

/// Animates a node, a weight of a morph target, and a texture transform. The weights are those that
/// a sloppy exporter also gave the mesh as an attribute.
Builder withPointers() {
  Builder builder;
  const Sheet sheet(kSize);
  Json primitive = sheet.addTo(builder);
  const uint32_t times = builder.addFloats({0, 1, 2}, 1);
  builder.json["accessors"][times]["min"] = {0};
  builder.json["accessors"][times]["max"] = {2};
  const uint32_t weights = builder.addFloats(std::vector<float>(sheet.count(), 0.25f), 1);
  primitive["attributes"]["_WEIGHT"] = weights;
  std::vector<float> deltas(sheet.positions.size(), 0);
  for (size_t i = 2; i < deltas.size(); i += 3) deltas[i] = sheet.positions[i - 1];
  primitive["targets"] = {{{"POSITION", builder.addPositions(sheet.normals)}},
                          {{"POSITION", builder.addPositions(deltas)}}};
  primitive["material"] = 0;
  builder.addMesh({primitive});
  builder.json["meshes"][0]["weights"] = {0, 0.5};
  builder.json["nodes"][0]["translation"] = {1, 2, 3};
  builder.json["images"] = {{{"uri", "a.png"}}};
  builder.json["textures"] = {{{"source", 0}}};
  Json texture = {{"index", 0}};
  texture["extensions"]["KHR_texture_transform"] = {{"offset", {0, 0}}};
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", texture}}}}};
  const auto channel = [](uint32_t sampler, const char* pointer) {
    Json target = {{"path", "pointer"}};
    target["extensions"]["KHR_animation_pointer"]["pointer"] = pointer;
    return Json{{"sampler", sampler}, {"target", target}};
  };
  const auto sampler = [&](uint32_t output) { return Json{{"input", times}, {"output", output}}; };
  builder.json["animations"] = {
      {{"channels",
        {channel(0, "/nodes/0/translation"), channel(1, "/meshes/0/weights/1"),
         channel(2,
                 "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/"
                 "KHR_texture_transform/offset")}},
       {"samplers",
        {sampler(builder.addFloats({0, 0, 0, 1, 1, 1, 2, 2, 2}, 3)), sampler(weights),
         sampler(builder.addFloats({0, 0, 1, 0, 1, 1}, 2))}}}};
  builder.json["extensionsUsed"] = {"KHR_animation_pointer", "KHR_texture_transform"};
  return builder;
}

/// Each pointer finds the same thing, and its values are the same, also where positions of other
/// documents would go into nodes of their own.
TEST(SceneExtensions, PointersFindWhatTheyAnimate) {
  const Builder builder = withPointers();
  const Json& source = builder.json;
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  const std::vector<uint8_t> integers = decodedToIntegers(trip);
  for (const auto* file : {&trip.converted, &trip.decoded, &integers}) {
    const Json json = jsonOf(*file);
    for (const char* key : {"animations", "materials", "nodes", "scenes"}) {
      EXPECT_EQ(json[key], source[key]);
    }
    EXPECT_EQ(json["meshes"][0]["weights"], source["meshes"][0]["weights"]);
    for (const Json& sampler : source["animations"][0]["samplers"]) {
      for (const char* key : {"input", "output"}) {
        EXPECT_EQ(elementsInOrder(*file, sampler[key]), elementsInOrder(trip.source, sampler[key]));
      }
    }
  }
  // The deltas of the target that the pointer names, by place.
  const Json& primitive = source["meshes"][0]["primitives"][0];
  const std::vector<Place> places = placesOf(trip.decoded, primitive["attributes"]["POSITION"]);
  const std::vector<float> deltas =
      floatsInOrder(trip.decoded, primitive["targets"][1]["POSITION"]);
  ASSERT_EQ(deltas.size(), 3 * places.size());
  for (size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(deltas[3 * i + 2], static_cast<double>(places[i][1]) / kSize, 0.0001);
  }
}

// ---- EXT_mesh_gpu_instancing

/// As many instances as vertices, so that an accessor can serve both.
Builder withRotations(int type, bool is_also_tangent) {
  Builder builder;
  const Sheet sheet(kSize);
  Json primitive = sheet.addTo(builder);
  std::vector<float> turns;
  std::vector<uint16_t> ids;
  for (uint32_t i = 0; i < sheet.count(); ++i) {
    const float angle = 0.01f * static_cast<float>(i);
    turns.insert(turns.end(), {std::sin(angle), 0, 0, std::cos(angle)});
    ids.push_back(static_cast<uint16_t>(i * 7 % 100));
  }
  uint32_t rotations = 0;
  if (type == kFloat) {
    rotations = builder.addFloats(turns, 4);
  } else {
    const std::vector<uint8_t> bytes = withType(type, [&](auto zero) {
      std::vector<decltype(zero)> values;
      for (const float turn : turns) {
        values.push_back(static_cast<decltype(zero)>(
            turn * static_cast<float>(std::numeric_limits<decltype(zero)>::max())));
      }
      return bytesOf(values);
    });
    rotations = builder.addAccessor(builder.addView(bytes), type, "VEC4", sheet.count());
    builder.json["accessors"][rotations]["normalized"] = true;
  }
  if (is_also_tangent) primitive["attributes"]["TANGENT"] = rotations;
  builder.addMesh({primitive});
  Json& extensions = builder.json["nodes"][0]["extensions"];
  extensions["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"ROTATION", rotations},
      {"_FEATURE_ID_0", builder.addAccessor(ids, kUnsignedShort, "SCALAR", ids.size())}};
  extensions["EXT_instance_features"]["featureIds"] = {{{"featureCount", 100}, {"attribute", 0}}};
  builder.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "EXT_instance_features"};
  return builder;
}

TEST(SceneExtensions, RotatedInstancesKeepTheirIds) {
  for (const int type : {kFloat, kShort, kByte}) {
    for (const bool is_also_tangent : {false, type == kFloat}) {
      const Builder builder = withRotations(type, is_also_tangent);
      const RoundTrip trip = roundTrip(builder);
      ASSERT_EQ(trip.error, "");
      ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
      const std::vector<uint8_t> integers = decodedToIntegers(trip);
      const Json& attributes =
          builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
      for (const auto* file : {&trip.converted, &trip.decoded, &integers}) {
        EXPECT_EQ(jsonOf(*file)["nodes"], builder.json["nodes"]);
        for (const auto& [name, accessor] : attributes.items()) {
          EXPECT_EQ(elementsInOrder(*file, accessor), elementsInOrder(trip.source, accessor))
              << name;
        }
      }
      EXPECT_EQ(differenceOfPrimitives(trip.source, roundTrip(builder, lossless()).decoded, false),
                "");
    }
  }
}

// ---- EXT_structural_metadata and EXT_mesh_features

constexpr uint32_t kRowCount = 5;

/// A column of a property table, of numbers of 64 bits.
template <typename T>
std::vector<T> column(T first, T step) {
  std::vector<T> values;
  for (uint32_t i = 0; i < kRowCount; ++i) values.push_back(static_cast<T>(first + step * T(i)));
  return values;
}
const std::vector<uint64_t> kIds = column<uint64_t>(0xffffffffffffff00u, 1);
const std::vector<int64_t> kTimes =
    column<int64_t>(std::numeric_limits<int64_t>::min(), int64_t{1} << 33);
const std::vector<double> kHeights = column<double>(0.1, 1e-300);

/// A sheet with values at its vertices, which property attributes describe, and ids of the rows of
/// a table. Values are special floats as well.
Builder withMetadata() {
  Builder builder;
  const Sheet sheet(kSize);
  Json primitive = sheet.addTo(builder);
  std::vector<float> heat;
  std::vector<uint16_t> counts;
  std::vector<float> ids;
  constexpr float kSpecial[] = {std::numeric_limits<float>::quiet_NaN(),
                                -std::numeric_limits<float>::infinity(), -0.0f,
                                std::numeric_limits<float>::denorm_min()};
  for (uint32_t i = 0; i < sheet.count(); ++i) {
    heat.push_back(i % 50 < 4 ? kSpecial[i % 50] : 1.0f / static_cast<float>(i + 1));
    counts.insert(counts.end(), {static_cast<uint16_t>(i * 149), static_cast<uint16_t>(i)});
    ids.push_back(static_cast<float>(i * i % kRowCount));
  }
  primitive["attributes"]["_HEAT"] = builder.addFloats(heat, 1);
  primitive["attributes"]["_COUNTS"] =
      builder.addAccessor(counts, kUnsignedShort, "VEC2", sheet.count());
  primitive["attributes"]["_FEATURE_ID_0"] = builder.addFloats(ids, 1);
  primitive["extensions"]["EXT_structural_metadata"]["propertyAttributes"] = {0};
  primitive["extensions"]["EXT_mesh_features"]["featureIds"] = {
      {{"featureCount", kRowCount}, {"attribute", 0}, {"propertyTable", 0}}};
  builder.addMesh({primitive});
  const auto addColumn = [&](const std::vector<uint8_t>& bytes) {
    builder.bin.resize((builder.bin.size() + 7) / 8 * 8, 0);
    return builder.addView(bytes);
  };
  const auto property = [](const char* type, const char* component) {
    return Json{{"type", type}, {"componentType", component}};
  };
  Json id_property = {{"values", addColumn(bytesOf(kIds))}};
  id_property["min"] = Json::number("18446744073709551360");
  id_property["max"] = Json::number("18446744073709551364");
  builder.json["extensions"]["EXT_structural_metadata"] = {
      {"schema",
       {{"id", "s"},
        {"classes",
         {{"vertex",
           {{"properties",
             {{"heat", property("SCALAR", "FLOAT32")}, {"counts", property("VEC2", "UINT16")}}}}},
          {"thing",
           {{"properties",
             {{"id", property("SCALAR", "UINT64")},
              {"time", property("SCALAR", "INT64")},
              {"height", property("SCALAR", "FLOAT64")}}}}}}}}},
      {"propertyAttributes",
       {{{"class", "vertex"},
         {"properties",
          {{"heat", {{"attribute", "_HEAT"}}}, {"counts", {{"attribute", "_COUNTS"}}}}}}}},
      {"propertyTables",
       {{{"class", "thing"},
         {"count", kRowCount},
         {"properties",
          {{"id", id_property},
           {"time", {{"values", addColumn(bytesOf(kTimes))}}},
           {"height", {{"values", addColumn(bytesOf(kHeights))}}}}}}}}};
  builder.json["extensionsUsed"] = {"EXT_structural_metadata", "EXT_mesh_features"};
  return builder;
}

/// Returns the bytes of all values that the metadata gives to each place.
std::map<Place, std::string> metadataIn(const std::vector<uint8_t>& file) {
  Document document;
  EXPECT_TRUE(loadDocument(file, nullptr, document).ok());
  const Json& root = document.json["extensions"]["EXT_structural_metadata"];
  const Json& primitive = document.json["meshes"][0]["primitives"][0];
  const std::vector<Place> places = placesOf(file, primitive["attributes"]["POSITION"]);
  std::vector<std::string> values(places.size());
  const Json& property_attribute =
      root["propertyAttributes"]
          [primitive["extensions"]["EXT_structural_metadata"]["propertyAttributes"][0]
               .get<size_t>()];
  for (const Json& property : property_attribute["properties"]) {
    const Json& number = primitive["attributes"][property["attribute"].get<std::string>()];
    const std::vector<std::string> elements = elementsInOrder(file, number);
    for (size_t i = 0; i < values.size(); ++i) values[i] += elements.at(i);
  }
  const std::vector<float> ids = floatsInOrder(file, primitive["attributes"]["_FEATURE_ID_0"]);
  for (const Json& property : root["propertyTables"][0]["properties"]) {
    const BufferView& view = document.views.at(property["values"].get<size_t>());
    const uint8_t* bytes = document.buffers[view.buffer].data() + view.offset;
    EXPECT_EQ((bytes - document.buffers[0].data()) % 8, 0);
    EXPECT_EQ(view.length, 8 * kRowCount);
    for (size_t i = 0; i < values.size(); ++i) {
      values[i].append(reinterpret_cast<const char*>(bytes) + 8 * static_cast<size_t>(ids.at(i)),
                       8);
    }
  }
  std::map<Place, std::string> at_place;
  for (size_t i = 0; i < places.size(); ++i) at_place[places[i]] = values[i];
  return at_place;
}

TEST(SceneExtensions, MetadataStayAtTheirPlaces) {
  const Builder builder = withMetadata();
  for (const ConvertOptions& options : exactAndRounded()) {
    const RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    const auto source = metadataIn(trip.source);
    ASSERT_EQ(source.size(), kRow * kRow);
    EXPECT_EQ(source.begin()->second.size(), 4u + 4 + 3 * 8);
    EXPECT_TRUE(metadataIn(trip.decoded) == source);
    // Vertices did not keep their order for it.
    const uint32_t heat =
        builder.json["meshes"][0]["primitives"][0]["attributes"]["_HEAT"].get<uint32_t>();
    EXPECT_NE(elementsInOrder(trip.decoded, heat), elementsInOrder(trip.source, heat));
    for (const auto* file : {&trip.converted, &trip.decoded}) {
      const Json table = jsonOf(*file)["extensions"]["EXT_structural_metadata"]["propertyTables"];
      const std::string text = printJson(table);
      EXPECT_NE(text.find("18446744073709551360"), std::string::npos) << text;
      EXPECT_NE(text.find("18446744073709551364"), std::string::npos) << text;
      GlbFile glb;
      ASSERT_TRUE(readGlb(*file, glb).ok());
      EXPECT_EQ((glb.bin.data() - file->data()) % 8, 0);
      EXPECT_EQ(glb.bin.size() % 8, 0u);
    }
  }
}

// ---- KHR_gaussian_splatting

/// Splats beside a sheet; one of their attributes has the same accessor as the sheet's positions.
Builder withSplats() {
  Builder builder;
  const Sheet sheet(kSize);
  const Json primitive = sheet.addTo(builder);
  const auto values = [&](uint32_t components) {
    std::vector<float> floats(size_t{components} * sheet.count());
    for (size_t i = 0; i < floats.size(); ++i) floats[i] = std::sin(static_cast<float>(i));
    return builder.addFloats(floats, components);
  };
  Json splats = {{"attributes",
                  {{"POSITION", primitive["attributes"]["POSITION"]},
                   {"KHR_gaussian_splatting:SCALE", primitive["attributes"]["NORMAL"]},
                   {"KHR_gaussian_splatting:ROTATION", values(4)},
                   {"KHR_gaussian_splatting:OPACITY", values(1)},
                   {"KHR_gaussian_splatting:SH_DEGREE_0_COEF_0", values(3)}}},
                 {"mode", 0}};
  splats["extensions"]["KHR_gaussian_splatting"] = {{"kernel", "ellipse"},
                                                    {"colorSpace", "srgb_rec709_display"},
                                                    {"sortingMethod", "cameraDistance"},
                                                    {"projection", "perspective"}};
  builder.addMesh({primitive});
  builder.addMesh({splats});
  builder.json["extensionsUsed"] = {"KHR_gaussian_splatting"};
  return builder;
}

TEST(SceneExtensions, SplatsStayAsTheyWere) {
  for (const bool is_coded : {false, true}) {
    Builder builder = withSplats();
    std::vector<uint8_t> coded = {3, 1, 4, 1, 5};
    uint32_t view = 0;
    if (is_coded) {  // by an extension that we do not know, inside of the other one
      view = builder.addView(coded);
      builder.json["meshes"][1]["primitives"][0]["extensions"]["KHR_gaussian_splatting"]
                  ["extensions"]["ACME_splat_compression"]["bufferView"] = view;
      builder.json["extensionsUsed"].push_back("ACME_splat_compression");
    }
    const RoundTrip trip = roundTrip(builder, evenIfLarger());
    ASSERT_EQ(trip.error, "");
    ASSERT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    const std::vector<uint8_t> integers = decodedToIntegers(trip);
    for (const auto* file : {&trip.converted, &trip.decoded, &integers}) {
      const Json json = jsonOf(*file);
      EXPECT_EQ(json["meshes"][1], builder.json["meshes"][1]);
      for (const auto& [name, accessor] :
           builder.json["meshes"][1]["primitives"][0]["attributes"].items()) {
        EXPECT_EQ(elementsInOrder(*file, accessor), elementsInOrder(trip.source, accessor)) << name;
        Json written = json["accessors"][accessor.get<size_t>()];
        Json read = builder.json["accessors"][accessor.get<size_t>()];
        for (Json* object : {&written, &read}) object->erase("bufferView");
        EXPECT_EQ(written, read) << name;
      }
      if (is_coded) {
        Document document;
        ASSERT_TRUE(loadDocument(*file, nullptr, document).ok());
        const BufferView& kept = document.views.at(view);
        const auto bytes = document.buffers[kept.buffer].subspan(kept.offset, kept.length);
        EXPECT_EQ(std::vector<uint8_t>(bytes.begin(), bytes.end()), coded);
      }
    }
    // Texture coordinates and indices of the sheet are gone, five accessors stay.
    if (!is_coded) {
      EXPECT_EQ(jsonOf(trip.converted)["bufferViews"].size(), 6u);
    }
  }
}

TEST(SceneExtensions, ValidatorHasNoObjection) {
  const std::string missing = mcc::test::Validator::whyNot();
  if (!missing.empty()) GTEST_SKIP() << missing;
  const mcc::test::ScratchFolder folder;
  mcc::test::Validator validator(folder.path());
  const std::pair<const char*, Builder> documents[] = {{"variants", withVariants()},
                                                       {"pointers", withPointers()},
                                                       {"rotations", withRotations(kByte, false)},
                                                       {"metadata", withMetadata()},
                                                       {"splats", withSplats()}};
  for (const auto& [name, builder] : documents) {
    const RoundTrip trip = roundTrip(builder);
    ASSERT_EQ(trip.error, "") << name;
    validator.add(name, trip.source, trip.converted, trip.decoded);
  }
  EXPECT_TRUE(validator.run()) << "the lines above name what is new";
}

}  // namespace
}  // namespace mcc::gltf::test
