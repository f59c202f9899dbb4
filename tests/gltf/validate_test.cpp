// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What validate() finds: everything in the negative assets of the conformance suite, nothing in the
// others or in files written here, and each rule of documents by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "gltf/round_trip.h"
#include "mcc/files.h"
#include "support/gltf_builder.h"

namespace mcc::gltf::test {
namespace {

constexpr char kExtensionPath[] = "/meshes/0/primitives/0/extensions/KHR_mesh_collapse_compression";

ValidationReport validated(std::span<const uint8_t> file, const ValidateOptions& options = {}) {
  ValidationReport report;
  const Result result = validateGlb(file, options, report);
  EXPECT_EQ(result.message(), "");
  return report;
}

/// "CODE pointer" of the issues, a line each.
std::string issuesOf(const ValidationReport& report) {
  std::string text;
  for (const ValidationIssue& issue : report.issues) {
    EXPECT_NE(issue.message, "");
    text += issue.code + " " + issue.pointer + "\n";
  }
  return text;
}

std::vector<uint8_t> contentOf(const std::string& name) {
  std::ifstream file(std::string(MCC_SOURCE_DIR "/tests/conformance/") + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Json manifest() {
  Json json;
  EXPECT_TRUE(parseJson(contentOf("manifest.json"), json).ok());
  return json;
}

TEST(ValidateConformance, AssetsHaveNoErrors) {
  const Json suite = manifest();
  for (const Json& asset : suite["assets"]) {
    const ValidationReport report = validated(contentOf(asset["file"]));
    EXPECT_TRUE(report.isValid()) << asset["file"] << "\n" << issuesOf(report);
    EXPECT_EQ(report.payload_count, 1u) << asset["file"];
  }
}

/// "BadHeader": "PAYLOAD_BAD_HEADER".
std::string codeOf(const std::string& kind) {
  if (kind == "Limit") return "PAYLOAD_ABOVE_LIMIT";
  std::string code = "PAYLOAD";
  for (const char c : kind) {
    if (std::isupper(static_cast<unsigned char>(c))) code += '_';
    code += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return code;
}

TEST(ValidateConformance, NegativeAssetsHaveErrorsWithTheirCodes) {
  const Json suite = manifest();
  for (const Json& asset : suite["negative"]) {
    SCOPED_TRACE(asset["file"].get<std::string>());
    const ValidationReport report = validated(contentOf(asset["file"]));
    EXPECT_FALSE(report.isValid());
    const std::string kind = asset["kind"];
    for (const ValidationIssue& issue : report.issues) {
      if (issue.severity != Severity::kError) continue;
      EXPECT_TRUE(issue.pointer.starts_with("/")) << issue.pointer;
      if (kind == "document") {
        EXPECT_FALSE(issue.code.starts_with("PAYLOAD_")) << issue.code;
      } else {
        EXPECT_EQ(issue.code, codeOf(kind));
        EXPECT_EQ(issue.pointer, std::string(kExtensionPath) + "/bufferView");
      }
    }
  }
}

TEST(ValidateSamples, WhatIsWrittenIsValid) {
  ConvertOptions lossless = evenIfLarger();
  lossless.lossless = true;
  ConvertOptions indices = evenIfLarger();
  indices.indices_only = true;
  ConvertOptions ordered = evenIfLarger();
  ordered.keep_vertex_order = ordered.keep_triangle_order = true;
  uint32_t file_count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MCC_SAMPLES_DIR)) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path().filename().string());
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::vector<uint8_t> source{std::istreambuf_iterator<char>(stream), {}};
    for (const ConvertOptions& options : {evenIfLarger(), lossless, indices, ordered}) {
      std::vector<uint8_t> converted;
      ConvertReport ignored;
      ASSERT_EQ(convertGlb(source, options, converted, ignored).message(), "");
      EXPECT_EQ(issuesOf(validated(converted)), "");
      ++file_count;
    }
  }
  EXPECT_GE(file_count, 20u);
}

class Validate : public testing::Test {
 protected:
  void SetUp() override {
    Builder builder;
    Json primitive = Sheet(12).addTo(builder);
    primitive["targets"] = {{{"POSITION", builder.addPositions(Sheet(12).positions)}}};
    builder.addMesh({primitive, Sheet(5).addTo(builder)});
    ConvertReport report;
    ASSERT_EQ(convertGlb(builder.toGlb(), evenIfLarger(), file_, report).message(), "");
  }

  using Change = std::function<void(Json& json, Json& primitive, Json& extension)>;

  ValidationReport after(const Change& change, const ValidateOptions& options = {}) {
    Json json = jsonOf(file_);
    Json& primitive = json["meshes"][0]["primitives"][0];
    change(json, primitive, primitive["extensions"][kExtensionName]);
    return validated(withJson(file_, json), options);
  }

  /// Expects one issue of this code and place.
  void expectIssue(const std::string& code, const std::string& pointer, const Change& change) {
    EXPECT_EQ(issuesOf(after(change)), code + " " + pointer + "\n");
  }

  std::vector<uint8_t> file_;
};

TEST_F(Validate, UnchangedIsValid) {
  const ValidationReport report = after([](Json&, Json&, Json&) {});
  EXPECT_TRUE(report.isValid());
  EXPECT_TRUE(report.issues.empty()) << issuesOf(report);
  EXPECT_TRUE(report.is_glb);
  EXPECT_EQ(report.version, "2.0");
  EXPECT_EQ(report.primitive_count, 2u);
  EXPECT_EQ(report.compressed_primitive_count, 2u);
  EXPECT_EQ(report.triangle_count, 338u);
  EXPECT_EQ(report.wedge_count, 205u);
  EXPECT_EQ(report.extensions_required, std::vector<std::string>{kExtensionName});
}

TEST_F(Validate, ListsOfExtensions) {
  expectIssue("EXTENSION_NOT_LISTED_AS_USED", "/extensionsUsed",
              [](Json& j, Json&, Json&) { j.erase("extensionsUsed"); });
  expectIssue("EXTENSION_REQUIRED_MISMATCH", "/extensionsRequired",
              [](Json& j, Json&, Json&) { j["extensionsRequired"] = {"KHR_mesh_quantization"}; });
  expectIssue("UNUSED_EXTENSION", "/extensionsUsed", [](Json& j, Json&, Json&) {
    for (Json& primitive : j["meshes"][0]["primitives"]) primitive.erase("extensions");
  });
}

TEST_F(Validate, Schema) {
  const std::string path = kExtensionPath;
  expectIssue("SCHEMA_MISMATCH", path + "/targets",
              [](Json&, Json& p, Json& e) { e["targets"] = p["targets"] = Json::array(); });
  expectIssue("SCHEMA_MISMATCH", path + "/piece", [](Json&, Json&, Json& e) { e["piece"] = 0.5; });
  expectIssue("SCHEMA_MISMATCH", path + "/extensions",
              [](Json&, Json&, Json& e) { e["extensions"] = 1; });
  expectIssue("SCHEMA_MISMATCH", path + "/extensions/a~1b~0c",
              [](Json&, Json&, Json& e) { e["extensions"]["a/b~c"] = 1; });
}

TEST_F(Validate, PayloadView) {
  expectIssue("INVALID_PAYLOAD_BUFFER_VIEW", "/bufferViews/0/byteStride",
              [](Json& j, Json&, Json&) { j["bufferViews"][0]["byteStride"] = 4; });
  expectIssue("INVALID_PAYLOAD_BUFFER_VIEW", "/bufferViews/0/target",
              [](Json& j, Json&, Json&) { j["bufferViews"][0]["target"] = 34962; });
  expectIssue("PAYLOAD_BUFFER_VIEW_USED_ELSEWHERE", "/bufferViews/0", [](Json& j, Json&, Json&) {
    j["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
  });
}

TEST_F(Validate, AccessorsThatOthersReferTo) {
  expectIssue(
      "ACCESSOR_USED_ELSEWHERE", "/meshes/1/primitives/0/attributes/POSITION",
      [](Json& j, Json& p, Json&) {
        j["meshes"].push_back(
            {{"primitives", {{{"attributes", {{"POSITION", p["attributes"]["POSITION"]}}}}}}});
      });
  expectIssue(
      "ACCESSOR_USED_ELSEWHERE", "/meshes/1/primitives/0/indices", [](Json& j, Json& p, Json&) {
        j["accessors"].push_back({{"componentType", kFloat}, {"count", 9}, {"type", "VEC3"}});
        j["meshes"].push_back({{"primitives",
                                {{{"attributes", {{"POSITION", j["accessors"].size() - 1}}},
                                  {"indices", p["indices"]}}}}});
      });
  expectIssue("ACCESSOR_USED_ELSEWHERE", "/meshes/0/primitives/0/attributes/_COPY",
              [](Json&, Json& p, Json&) { p["attributes"]["_COPY"] = p["attributes"]["NORMAL"]; });
  expectIssue("ACCESSOR_USED_ELSEWHERE", "/meshes/0/primitives/0/targets/0/NORMAL",
              [](Json&, Json& p, Json&) { p["targets"][0]["NORMAL"] = p["attributes"]["NORMAL"]; });
  expectIssue("ACCESSOR_USED_ELSEWHERE", "/accessors/1", [](Json& j, Json& p, Json&) {
    j["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", p["attributes"]["NORMAL"]}}};
  });
  expectIssue("ACCESSOR_USED_ELSEWHERE", "/accessors/1", [](Json& j, Json& p, Json&) {
    j["animations"] = {{{"samplers", {{{"input", 0}, {"output", p["attributes"]["NORMAL"]}}}},
                        {"channels", Json::array()}}};
    j["animations"][0]["samplers"][0].erase("input");
  });
}

TEST_F(Validate, Bounds) {
  expectIssue("BOUNDS_MISMATCH", "/accessors/0",
              [](Json& j, Json&, Json&) { j["accessors"][0].erase("max"); });
  expectIssue("BOUNDS_MISMATCH", "/accessors/0/min",
              [](Json& j, Json&, Json&) { j["accessors"][0]["min"][1] = -0.5; });
  expectIssue("BOUNDS_MISMATCH", "/accessors/0/max", [](Json& j, Json&, Json&) {
    j["accessors"][0]["max"] = {1, 1};
  });
  expectIssue("BOUNDS_MISMATCH", "/accessors/3/max",
              [](Json& j, Json&, Json&) { j["accessors"][3]["max"] = {167}; });
  const Change right = [](Json& j, Json&, Json&) { j["accessors"][3]["max"] = {168}; };
  EXPECT_TRUE(after(right).issues.empty());
}

TEST_F(Validate, Manifolds) {
  const Change manifold = [](Json& j, Json&, Json&) {
    j["meshes"][0]["extensions"]["EXT_mesh_manifold"] = Json::object();
  };
  EXPECT_EQ(after(manifold).issue_counts[0], 2u);  // of both primitives
  EXPECT_EQ(after(manifold).issues[0].code, "MANIFOLD_WITHOUT_ORDER");
  Builder builder;
  builder.addMesh({Sheet(6).addTo(builder)});
  ConvertOptions options = evenIfLarger();
  options.keep_vertex_order = options.keep_triangle_order = true;
  ConvertReport report;
  ASSERT_EQ(convertGlb(builder.toGlb(), options, file_, report).message(), "");
  EXPECT_TRUE(after(manifold).isValid());
}

TEST_F(Validate, UnusedPartsOfPayloads) {
  expectIssue("UNUSED_ATTRIBUTE", std::string(kExtensionPath) + "/bufferView",
              [](Json&, Json& p, Json& e) {
                e["attributes"].erase("NORMAL");
                p["attributes"].erase("NORMAL");
              });
  const ValidationReport report = after([](Json&, Json& p, Json& e) {
    e["attributes"].erase("NORMAL");
    p["attributes"].erase("NORMAL");
  });
  EXPECT_EQ(report.issues[0].severity, Severity::kWarning);
  EXPECT_TRUE(report.isValid());
}

TEST_F(Validate, AllIssuesAreReported) {
  const Change change = [](Json& j, Json& p, Json& e) {
    e["attributes"]["NORMAL"] = 9;
    e["attributes"]["COLOR_0"] = 1;
    p["mode"] = 5;  // moves `e`
    j["accessors"][0]["count"] = 3;
    j["accessors"][3]["componentType"] = kFloat;
    j["meshes"][0]["primitives"][1]["extensions"][kExtensionName]["part"] = 7;
    j.erase("extensionsUsed");
  };
  const ValidationReport report = after(change);
  for (const char* code :
       {"EXTENSION_NOT_LISTED_AS_USED", "MODE_NOT_TRIANGLES", "INVALID_ATTRIBUTE_NUMBER",
        "ATTRIBUTE_NOT_IN_PRIMITIVE", "COUNT_MISMATCH", "INVALID_INDICES", "INVALID_PART"}) {
    EXPECT_NE(issuesOf(report).find(code), std::string::npos) << code;
  }
  EXPECT_FALSE(report.is_truncated);
  ValidateOptions options;
  options.max_issues = 3;
  const ValidationReport few = after(change, options);
  EXPECT_EQ(few.issues.size(), 3u);
  EXPECT_TRUE(few.is_truncated);
  EXPECT_EQ(few.issue_counts[0], report.issue_counts[0]);
  options.max_issues = 0;
  EXPECT_EQ(after(change, options).issues.size(), report.issues.size());
}

TEST_F(Validate, Limits) {
  ValidateOptions options;
  options.limits.max_triangles = 100;
  EXPECT_EQ(issuesOf(after([](Json&, Json&, Json&) {}, options)).substr(0, 19),
            "PAYLOAD_ABOVE_LIMIT");
}

TEST_F(Validate, WhatIsNoGltf) {
  const ValidationReport none = validated(asBytes("solid cube"));
  EXPECT_EQ(issuesOf(none), "INVALID_DOCUMENT \n");
  const ValidationReport empty = validated({});
  EXPECT_FALSE(empty.isValid());
  ValidationReport report;
  EXPECT_FALSE(validate({"/no/such/file.glb", {}}, {}, report).ok());
  EXPECT_TRUE(report.issues.empty());
}

TEST_F(Validate, UncompressedFilesAreValid) {
  Builder builder;
  builder.addMesh({Sheet(2).addTo(builder)});
  const ValidationReport report = validated(builder.toGlb());
  EXPECT_TRUE(report.issues.empty()) << issuesOf(report);
  EXPECT_EQ(report.payload_count, 0u);
}

/// A file whose accessors all have their elements in the BIN chunk, after the payload.
class ValidateFallback : public Validate {
 protected:
  void SetUp() override {
    Validate::SetUp();
    std::vector<uint8_t> decoded;
    DecodeReport report;
    ASSERT_TRUE(decodeGlb(file_, decoded, report).ok());
    GlbFile compressed, plain;
    ASSERT_TRUE(readGlb(file_, compressed).ok());
    ASSERT_TRUE(readGlb(decoded, plain).ok());
    Json json = jsonOf(file_);
    const Json plain_json = jsonOf(decoded);
    std::vector<uint8_t> bin(compressed.bin.begin(), compressed.bin.end());
    const size_t offset = bin.size();
    bin.insert(bin.end(), plain.bin.begin(), plain.bin.end());
    const size_t first_view = json["bufferViews"].size();
    for (Json view : plain_json["bufferViews"]) {
      view["byteOffset"] = view.value("byteOffset", size_t{0}) + offset;
      json["bufferViews"].push_back(view);
    }
    for (size_t i = 0; i < json["accessors"].size(); ++i) {
      json["accessors"][i]["bufferView"] =
          plain_json["accessors"][i]["bufferView"].get<size_t>() + first_view;
    }
    json["buffers"][0]["byteLength"] = bin.size();
    json.erase("extensionsRequired");
    file_ = glbOf(json, bin);
  }

  /// Issues apart from the warnings that the buffer is that of the payloads.
  std::string errorsAfter(const Change& change) {
    const ValidationReport report = after(change);
    std::string text;
    for (const ValidationIssue& issue : report.issues) {
      if (issue.code != "FALLBACK_IN_SHARED_BUFFER")
        text += issue.code + " " + issue.pointer + "\n";
    }
    return text;
  }
};

TEST_F(ValidateFallback, MustBeWhole) {
  const ValidationReport report = after([](Json&, Json&, Json&) {});
  EXPECT_TRUE(report.isValid()) << issuesOf(report);
  EXPECT_EQ(report.issue_counts[1], 9u);
  EXPECT_EQ(report.issues[0].code, "FALLBACK_IN_SHARED_BUFFER");
  EXPECT_EQ(errorsAfter([](Json& j, Json&, Json&) { j["extensionsRequired"] = {kExtensionName}; }),
            "EXTENSION_REQUIRED_MISMATCH /extensionsRequired\n");
  EXPECT_EQ(errorsAfter([](Json& j, Json&, Json&) { j["accessors"][1].erase("bufferView"); }),
            "FALLBACK_INCOMPLETE /accessors/1\n");
}

TEST_F(ValidateFallback, MustBeWhatIsDecoded) {
  EXPECT_EQ(errorsAfter([](Json& j, Json&, Json&) {
              std::swap(j["accessors"][0]["bufferView"], j["accessors"][1]["bufferView"]);
            }),
            "FALLBACK_MISMATCH /accessors/0\nFALLBACK_MISMATCH /accessors/1\n");
}

}  // namespace
}  // namespace mcc::gltf::test
