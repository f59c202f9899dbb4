// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Changes values of documents at random: they must convert, decode and be inspected, or be refused
// with one line. Meant to run with the sanitizers.
#include <gtest/gtest.h>

#include <random>

#include "gltf/made_up_codecs.h"
#include "mcc/files.h"

namespace mcc::gltf::test {
namespace {

using Random = std::mt19937;

uint32_t below(Random& random, size_t end) { return static_cast<uint32_t>(random() % end); }

/// Values that have a meaning somewhere, or nowhere.
Json strangeValue(Random& random) {
  static const std::vector<Json> kValues = {0,
                                            1,
                                            2,
                                            3,
                                            5,
                                            255,
                                            65535,
                                            65536,
                                            4294967295u,
                                            4294967296u,
                                            18446744073709551615u,
                                            -1,
                                            0.5,
                                            1e300,
                                            5120,
                                            5123,
                                            5125,
                                            5126,
                                            "",
                                            "VEC3",
                                            "SCALAR",
                                            "MAT4",
                                            "POSITION",
                                            nullptr,
                                            true,
                                            false,
                                            Json::array(),
                                            Json::object(),
                                            Json::array({0, 1}),
                                            Json::object({{"bufferView", 0}})};
  return kValues[below(random, kValues.size())];
}

/// Collects pointers to all values of a document.
void collect(Json& json, std::vector<Json*>& values) {
  values.push_back(&json);
  if (!json.is_structured()) return;
  for (Json& value : json) collect(value, values);
}

void change(Json& json, Random& random) {
  std::vector<Json*> values;
  collect(json, values);
  Json& value = *values[below(random, values.size())];
  if (value.is_object() && !value.empty() && random() % 2 == 0) {
    value.erase(&value[below(random, value.size())]);
  } else {
    value = strangeValue(random);
  }
}

Builder document() {
  Builder builder;
  Json sheet = Sheet(6).addTo(builder);
  sheet["targets"] = {{{"POSITION", builder.addPositions(Sheet(6).positions)}}};
  Json part = sheet;
  part["indices"] = builder.addIndices({0, 1, 2, 3, 4, 5});
  builder.addMesh({sheet, part, Sheet(5).addTo(builder)});
  const uint32_t indices = builder.addView(bytesOf(std::vector<uint16_t>{1, 3}));
  const uint32_t values = builder.addView(bytesOf(std::vector<float>{1, 2, 3, 4, 5, 6}));
  Json& accessor = builder.json["accessors"][1];
  accessor["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
                        {"values", {{"bufferView", values}}}};
  builder.json["images"] = {{{"bufferView", values}, {"mimeType", "image/png"}}};
  const uint32_t matrix = builder.addAccessor(std::vector<float>(16, 0.5f), kFloat, "MAT4", 1);
  builder.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", matrix}},
                           {{"joints", {0}}, {"inverseBindMatrices", 2}}};
  const Sheet sheet_of_skin(4);
  Json skinned = sheet_of_skin.addTo(builder);
  const std::vector<uint8_t> joints(size_t{4} * sheet_of_skin.count(), 0);
  const std::vector<float> weights(joints.size(), 0.25f);
  skinned["attributes"]["JOINTS_0"] =
      builder.addAccessor(joints, kUnsignedByte, "VEC4", sheet_of_skin.count());
  skinned["attributes"]["WEIGHTS_0"] = builder.addFloats(weights, 4);
  builder.addMesh({skinned});
  builder.json["nodes"][1]["skin"] = 0;
  builder.json["nodes"][0]["children"] = Json::array();
  builder.json["animations"] = {
      {{"samplers", {{{"input", 1}, {"output", 0}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  return builder;
}

void expectOneLine(const Result& result) {
  if (result.ok()) return;
  EXPECT_EQ(result.message().find('\n'), std::string::npos);
  EXPECT_EQ(result.message().find("internal error"), std::string::npos) << result.message();
  EXPECT_EQ(result.message().find("please report"), std::string::npos) << result.message();
}

void tryAll(std::span<const uint8_t> file) {
  ConvertOptions options = withDecoders();
  options.allow_larger = true;
  std::vector<uint8_t> output;
  ConvertReport convert_report;
  expectOneLine(convertGlb(file, options, output, convert_report));
  options.indices_only = true;
  expectOneLine(convertGlb(file, options, output, convert_report));
  DecodeReport decode_report;
  const Result decoded = decodeGlb(file, output, decode_report);
  expectOneLine(decoded);
  expectOneLine(decodeGlb(file, output, decode_report, {DecodeTo::kIntegers}));
  InspectReport inspect_report;
  expectOneLine(inspectGlb(file, true, inspect_report));
  ValidationReport validation;
  expectOneLine(validateGlb(file, {}, validation));
  EXPECT_TRUE(decoded.ok() || !validation.isValid()) << decoded.message();
}

/// Changes the JSON of a file in `count` ways and tries them all.
void tryChanges(std::span<const uint8_t> file, uint32_t count) {
  GlbFile glb;
  ASSERT_TRUE(readGlb(file, glb).ok());
  const Json good = jsonOf(file);
  for (uint32_t seed = 0; seed < count; ++seed) {
    Random random(seed);
    Json json = good;
    for (uint32_t i = 0; i <= seed % 3; ++i) change(json, random);
    std::vector<uint8_t> changed;
    ASSERT_TRUE(writeGlb(json.dump(), glb.bin, {}, changed).ok());
    SCOPED_TRACE("seed " + std::to_string(seed));
    tryAll(changed);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(DamagedDocuments, Values) { tryChanges(document().toGlb(), 1500); }

TEST(DamagedCompressed, Values) {
  ConvertOptions options;
  options.allow_larger = true;
  std::vector<uint8_t> compressed;
  ConvertReport report;
  const Result result = convertGlb(document().toGlb(), options, compressed, report);
  ASSERT_TRUE(result.ok()) << result.message();
  tryChanges(compressed, 1500);
}

/// What other codecs compressed, one mesh and the views of another.
TEST(DamagedCoded, Values) {
  Builder builder;
  builder.addMesh({Sheet(6).addTo(builder)});
  builder.addMesh({Sheet(5).addTo(builder)});
  codeMesh(builder, 0);
  codeViews(builder, {4, 5, 6, 7});
  tryChanges(fileOf(builder), 1500);
}

TEST(DamagedDocuments, Bytes) {
  const std::vector<uint8_t> good = document().toGlb();
  for (uint32_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    std::vector<uint8_t> file = good;
    for (uint32_t i = 0; i < 1 + seed % 4; ++i) {
      file[below(random, seed % 2 == 0 ? 2000 : file.size())] = static_cast<uint8_t>(random());
    }
    SCOPED_TRACE("seed " + std::to_string(seed));
    tryAll(file);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace mcc::gltf::test
