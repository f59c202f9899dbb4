// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// ConvertOptions::quality: decodes what was written, and measures the errors by itself.
#include "gltf/compress/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "gltf/round_trip.h"
#include "support/made_images.h"

namespace mcc::gltf::test {
namespace {

ConvertOptions ofPixels(double pixels) {
  ConvertOptions options;
  options.quality = pixels;
  options.keep_vertex_order = true;
  options.allow_larger = true;
  return options;
}

const QualityChoice* choiceOf(const ConvertReport& report, const std::string& name) {
  for (const QualityChoice& choice : report.quality_choices) {
    if (choice.name == name) return &choice;
  }
  return nullptr;
}

/// Largest difference of two lists of numbers: of components, or of vectors of three.
double farthestComponent(const std::vector<float>& a, const std::vector<float>& b) {
  double farthest = 0;
  for (size_t i = 0; i < a.size(); ++i)
    farthest = std::max(farthest, std::abs(double{a[i]} - b[i]));
  return farthest;
}

double farthestPoint(const std::vector<float>& a, const std::vector<float>& b) {
  double farthest = 0;
  for (size_t i = 0; i < a.size(); i += 3) {
    farthest = std::max(farthest, std::hypot(double{a[i]} - b[i], double{a[i + 1]} - b[i + 1],
                                             double{a[i + 2]} - b[i + 2]));
  }
  return farthest;
}

/// Largest angle between vectors that begin every `stride` numbers.
double largestAngle(const std::vector<float>& a, const std::vector<float>& b, size_t stride) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); i += stride) {
    const double x[3] = {a[i], a[i + 1], a[i + 2]};
    const double y[3] = {b[i], b[i + 1], b[i + 2]};
    const double sine =
        std::hypot(x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]);
    largest = std::max(largest, std::atan2(sine, x[0] * y[0] + x[1] * y[1] + x[2] * y[2]));
  }
  return largest;
}

/// A curved sheet with everything that glTF defines for a vertex.
struct RichSheet {
  Sheet sheet{24};
  std::vector<float> tangents;
  std::vector<float> colors;
  std::vector<float> weights;
  std::vector<float> moves;
  std::vector<float> turns;

  RichSheet() {
    for (uint32_t i = 0; i < sheet.count(); ++i) {
      const float* n = &sheet.normals[3 * i];
      tangents.insert(tangents.end(), {n[2], 0, -n[0], i % 2 == 0 ? 1.0f : -1.0f});
      const float t = 0.5f + 0.5f * std::sin(0.7f * static_cast<float>(i));
      colors.insert(colors.end(), {t, 1 - t, t * t, 1});
      const float rest = 1 - t;
      weights.insert(weights.end(), {t, rest * t, rest * (1 - t), 0});
      moves.insert(moves.end(), {0, 0, i % 3 == 0 ? 0 : 0.1f * t});
      turns.insert(turns.end(), {0.3f * t, 0, -0.2f * t});
    }
  }

  /// Accessors are numbered in the order of this list.
  Json addTo(Builder& builder) const {
    Json primitive = sheet.addTo(builder);
    Json& attributes = primitive["attributes"];
    attributes["TANGENT"] = builder.addFloats(tangents, 4);
    attributes["COLOR_0"] = builder.addFloats(colors, 4);
    attributes["WEIGHTS_0"] = builder.addFloats(weights, 4);
    attributes["JOINTS_0"] = builder.addAccessor(std::vector<uint8_t>(4 * size_t{sheet.count()}, 1),
                                                 kUnsignedByte, "VEC4", sheet.count());
    primitive["targets"] = Json::array(
        {{{"POSITION", builder.addPositions(moves)}, {"NORMAL", builder.addFloats(turns, 3)}}});
    return primitive;
  }
};

/// Decoded floats of an attribute of the first primitive.
std::vector<float> decodedOf(const RoundTrip& trip, const char* name, bool of_target = false) {
  const Json json = jsonOf(trip.decoded);
  const Json& primitive = json["meshes"][0]["primitives"][0];
  const Json& map = of_target ? primitive["targets"][0] : primitive["attributes"];
  return floatsInOrder(trip.decoded, map[name].get<uint32_t>());
}

TEST(QualityPlan, EveryErrorIsKept) {
  for (const double pixels : {16.0, 100.0, 1024.0, 4096.0, 50000.0, 1048576.0}) {
    Builder builder;
    builder.push("images", {{"bufferView", builder.addView(pngHeader(2048, 512))},
                            {"mimeType", "image/png"}});
    builder.push("textures", {{"source", 0}});
    builder.push("materials", {{"emissiveTexture", {{"index", 0}}}});
    RichSheet rich;
    for (float& x : rich.sheet.positions) x = 3 * x - 1;
    Json primitive = rich.addTo(builder);
    primitive["material"] = 0;
    builder.addMesh({primitive});
    const RoundTrip trip = roundTrip(builder, ofPixels(pixels));
    ASSERT_EQ(trip.error, "");
    const StatedErrors errors(pixels);
    const Sheet& sheet = rich.sheet;
    SCOPED_TRACE(pixels);
    const double move = farthestPoint(sheet.positions, decodedOf(trip, "POSITION"));
    EXPECT_LE(move, 3 / pixels);
    EXPECT_GT(move, 0.5 / pixels) << "finer than necessary";
    EXPECT_LE(farthestPoint(rich.moves, decodedOf(trip, "POSITION", true)), 3 / pixels);
    const double normal = largestAngle(sheet.normals, decodedOf(trip, "NORMAL"), 3);
    EXPECT_LE(normal, errors.radians);
    const double perpendicular = 0.0025;  // of the source, see tangentBound()
    EXPECT_LE(largestAngle(rich.tangents, decodedOf(trip, "TANGENT"), 4),
              2 * errors.radians + perpendicular);
    EXPECT_LE(farthestPoint(rich.turns, decodedOf(trip, "NORMAL", true)), errors.radians);
    const double texel = farthestComponent(sheet.texcoords, decodedOf(trip, "TEXCOORD_0"));
    EXPECT_LE(texel, std::max(0.25 / 2048, 0.25 / pixels));
    EXPECT_LE(farthestComponent(rich.colors, decodedOf(trip, "COLOR_0")), 0.5 / 255 + 1e-7);
    EXPECT_LE(farthestComponent(rich.weights, decodedOf(trip, "WEIGHTS_0")), 2 / pixels + 1e-7);
    for (size_t i = 0; i < rich.moves.size(); ++i) {
      if (rich.moves[i] == 0) {
        EXPECT_EQ(decodedOf(trip, "POSITION", true)[i], 0);
        break;
      }
    }
  }
}

TEST(QualityPlan, ChoicesSayWhy) {
  Builder builder;
  builder.push("images", {{"bufferView", builder.addView(pngHeader(2048, 512))}});
  builder.push("textures", {{"source", 0}});
  builder.push("materials", {{"emissiveTexture", {{"index", 0}}}});
  Json first = RichSheet().addTo(builder);
  first["material"] = 0;
  builder.addMesh({first});
  Sheet infinite(9);
  infinite.normals[5] = std::numeric_limits<float>::infinity();
  builder.addMesh({infinite.addTo(builder)});
  const RoundTrip trip = roundTrip(builder, ofPixels(4096));
  ASSERT_EQ(trip.error, "");
  std::vector<std::string> lines;
  for (const QualityChoice& choice : trip.report.quality_choices) {
    lines.push_back(choice.name + " " + std::to_string(choice.attribute_count) + " " +
                    std::to_string(choice.exact_count) + " " + std::to_string(choice.fewest_bits) +
                    " " + std::to_string(choice.most_bits) + " " + choice.why);
  }
  const std::vector<std::string> expected = {
      "POSITION 2 0 12 12 nothing moves farther than 1/4096 of the longest side of its mesh",
      "target POSITION 1 0 9 9 nothing moves farther than 1/4096 of the longest side of its mesh",
      "NORMAL 2 1 10 10 at most 0.25 degrees",
      "target NORMAL 1 0 6 6 at most 0.25 degrees",
      "TANGENT 1 0 10 10 at most 0.25 degrees around the normal",
      "TEXCOORD_0 2 0 13 14 a quarter of a texel of textures that count as 2048 to 4096 texels",
      "COLOR_0 1 0 8 8 half a step of 255",
      "WEIGHTS_0 1 0 12 12 at most 1/2048"};
  EXPECT_EQ(lines, expected);
  ConvertOptions usual;
  EXPECT_TRUE(roundTrip(builder, usual).report.quality_choices.empty());
}

/// One vertex that is far away costs bits, and no accuracy.
TEST(QualityPlan, OutliersDoNotSpoilTheRest) {
  Sheet sheet(24);
  sheet.positions[0] = 1000;
  sheet.texcoords[0] = 300;
  Builder builder;
  builder.addMesh({sheet.addTo(builder)});
  const RoundTrip trip = roundTrip(builder, ofPixels(4096));
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.notes, std::vector<std::string>{});
  EXPECT_LE(farthestPoint(sheet.positions, decodedOf(trip, "POSITION")), 4.0 / 4096);
  EXPECT_GE(choiceOf(trip.report, "POSITION")->most_bits, 19);
  std::vector<float> texcoords = decodedOf(trip, "TEXCOORD_0");
  EXPECT_NEAR(texcoords[0], 300, 0.25 / 4096 + std::ldexp(300, -23)) << "floats round it as well";
  texcoords[0] = 300;
  EXPECT_LE(farthestComponent(sheet.texcoords, texcoords), 0.25 / 4096);
  EXPECT_GE(choiceOf(trip.report, "TEXCOORD_0")->most_bits, 20);

  sheet.positions[0] = 1e7f;
  Builder farther;
  farther.addMesh({sheet.addTo(farther)});
  const RoundTrip exact = roundTrip(farther, ofPixels(4096));
  ASSERT_EQ(exact.error, "");
  EXPECT_EQ(farthestPoint(sheet.positions, decodedOf(exact, "POSITION")), 0);
  EXPECT_TRUE(hasNote(
      exact.report, "a lattice of more than 24 bits, or one finer than float32, for the quality"));
  EXPECT_EQ(choiceOf(exact.report, "POSITION")->exact_count, 1u);
}

/// Coordinates that are all far away keep the accuracy, as long as floats have it.
TEST(QualityPlan, FarTexcoords) {
  for (const float far : {10.0f, 100.0f, 10000.0f}) {
    Sheet sheet(24);
    for (float& x : sheet.texcoords) x += far;
    Builder builder;
    builder.addMesh({sheet.addTo(builder)});
    const RoundTrip trip = roundTrip(builder, ofPixels(4096));
    ASSERT_EQ(trip.error, "");
    EXPECT_LE(farthestComponent(sheet.texcoords, decodedOf(trip, "TEXCOORD_0")), 0.25 / 4096);
    EXPECT_EQ(choiceOf(trip.report, "TEXCOORD_0")->exact_count, far < 1000 ? 0u : 1u) << far;
  }
}

/// The longest side is a whole and even number of steps, so symmetric models stay symmetric.
TEST(QualityPlan, EndsAndMiddleArePoints) {
  for (const double pixels : {30.0, 1000.0, 4096.0, 70000.0}) {
    Builder builder;
    builder.addMesh({Sheet(24).addTo(builder)});
    const RoundTrip trip = roundTrip(builder, ofPixels(pixels));
    ASSERT_EQ(trip.error, "");
    const std::vector<float> positions = decodedOf(trip, "POSITION");
    for (const size_t column : {0u, 12u, 24u}) {
      EXPECT_NEAR(positions[3 * column], static_cast<double>(column) / 24, 1e-6) << pixels;
    }
  }
}

TEST(QualityPlan, LostTrianglesAreCounted) {
  Sheet sheet(20);
  for (size_t i = 0; i < sheet.positions.size(); i += 3) {
    if (sheet.positions[i + 1] > 0.96f) sheet.positions[i + 1] = 0.95001f;  // the last row is thin
  }
  Builder builder;
  builder.addMesh({sheet.addTo(builder)});
  const char* kLost = "/meshes/0/primitives/0: 40 of 800 triangles are so small";
  EXPECT_TRUE(hasNote(roundTrip(builder, ofPixels(4096)).report, kLost));
  EXPECT_FALSE(hasNote(roundTrip(builder, ofPixels(1 << 20)).report, "so small"));
  EXPECT_FALSE(hasNote(roundTrip(builder).report, "so small")) << "only where quality chose";
  // What has no area in the source loses none.
  for (size_t i = 0; i < sheet.positions.size(); i += 3) {
    if (sheet.positions[i + 1] > 0.9f) sheet.positions[i + 1] = 0.9f;
  }
  Builder flat;
  flat.addMesh({sheet.addTo(flat)});
  EXPECT_FALSE(hasNote(roundTrip(flat, ofPixels(4096)).report, "so small"));
}

TEST(QualityPlan, SizesAreThoseOfWhatSharesTheLattice) {
  Builder builder;
  Sheet large(20);
  for (float& x : large.positions) x *= 100;
  builder.addMesh({Sheet(20).addTo(builder)});
  builder.addMesh({large.addTo(builder)});
  ConvertOptions options = ofPixels(4096);
  EXPECT_EQ(choiceOf(roundTrip(builder, options).report, "POSITION")->fewest_bits, 12);
  const auto errorOfSmall = [&]() {
    return farthestPoint(Sheet(20).positions, decodedOf(roundTrip(builder, options), "POSITION"));
  };
  EXPECT_LT(errorOfSmall(), 1.0 / 4096);
  options.grid = Grid::kScene;
  EXPECT_GT(errorOfSmall(), 1.0 / 4096);
  EXPECT_LT(errorOfSmall(), 100.0 / 4096);
  EXPECT_NE(choiceOf(roundTrip(builder, options).report, "POSITION")->why.find("of all meshes"),
            std::string::npos);
}

/// Normals of other lengths keep their angles, too; those that are zero have none.
TEST(QualityPlan, NormalsOfAnyLength) {
  for (const float length : {1.0f, 0.25f, 7.0f}) {
    Sheet sheet(24);
    for (float& x : sheet.normals) x *= length;
    std::fill_n(sheet.normals.begin() + 30, 3, 0.0f);
    Builder builder;
    builder.addMesh({sheet.addTo(builder)});
    const RoundTrip trip = roundTrip(builder, ofPixels(4096));
    ASSERT_EQ(trip.error, "");
    EXPECT_EQ(choiceOf(trip.report, "NORMAL")->exact_count, 0u);
    std::vector<float> decoded = decodedOf(trip, "NORMAL");
    std::copy_n(sheet.normals.begin() + 30, 3, decoded.begin() + 30);
    EXPECT_LE(largestAngle(sheet.normals, decoded, 3), StatedErrors(4096).radians);
  }
  Sheet sheet(24);
  sheet.normals[30] = sheet.normals[31] = 0;
  sheet.normals[32] = 1e-6f;
  Builder builder;
  builder.addMesh({sheet.addTo(builder)});
  const RoundTrip trip = roundTrip(builder, ofPixels(4096));
  EXPECT_EQ(farthestPoint(sheet.normals, decodedOf(trip, "NORMAL")), 0);
  EXPECT_TRUE(hasNote(trip.report, "NORMAL is not of unit length and stays exact"));
}

TEST(QualityPlan, PositionsThatAreOnePoint) {
  Sheet sheet(5);
  std::fill(sheet.positions.begin(), sheet.positions.end(), 0.3f);
  Builder builder;
  builder.addMesh({sheet.addTo(builder)});
  const RoundTrip trip = roundTrip(builder, ofPixels(4096));
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(farthestPoint(sheet.positions, decodedOf(trip, "POSITION")), 0);
}

TEST(QualityPlan, WrongQualitiesAreRefused) {
  Builder builder;
  builder.addMesh({Sheet(5).addTo(builder)});
  const auto refusalOf = [&](const ConvertOptions& options) {
    return roundTrip(builder, options).error;
  };
  for (const double pixels :
       {-1.0, 1.0, 15.999, 1048577.0, 1e300, std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::quiet_NaN(), 1e-320}) {
    EXPECT_EQ(refusalOf(ofPixels(pixels)), "quality is not from 16 to 1048576 pixels") << pixels;
  }
  for (const int other : {0, 1, 2, 3}) {
    ConvertOptions both = ofPixels(4096);
    both.lossless = other == 0;
    if (other == 1) both.max_position_error = 1;
    if (other == 2) both.position_lattice = Lattice{{0, 0, 0, 0}, 1};
    if (other == 3) both.step = 1;
    EXPECT_EQ(refusalOf(both),
              "quality excludes lossless, max_position_error, position_lattice and step");
  }
}

}  // namespace
}  // namespace mcc::gltf::test
