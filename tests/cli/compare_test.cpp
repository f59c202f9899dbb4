// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The comparison with Draco: consistent numbers, formats and exit status, and a Draco file that
// others can read.
#include <algorithm>
#include <limits>
#include <vector>

#include "cli/run_tool.h"
#include "json/json.h"
#include "support/gltf_builder.h"

namespace mcc::test {
namespace {

using gltf::Json;

const std::vector<std::string> kCodecs = {"mcc", "draco_0", "draco_3", "draco_5"};

/// Checks what must hold for the figures of any file.
void expectConsistent(const Json& figures) {
  SCOPED_TRACE(figures.value("file", ""));
  for (const std::string& key : kCodecs) {
    const Json& codec = figures["codecs"][key];
    ASSERT_FALSE(codec.contains("failure")) << key << ": " << codec;
    double sum = 0;
    for (const Json& stream : figures["streams"]) sum += stream.value(key, 0.0);
    EXPECT_NEAR(sum, codec["bytes"].get<double>(), 1) << key;
    EXPECT_GT(codec["decode_seconds"].get<double>(), 0);
    EXPECT_GT(codec["encode_seconds"].get<double>(), 0);
    EXPECT_LE(codec["triangles"], figures["triangles"]) << key;
  }
  const Json& codecs = figures["codecs"];
  EXPECT_EQ(codecs["mcc"]["triangles"], figures["triangles"]);
  EXPECT_EQ(codecs["mcc"]["vertices"], figures["vertices"]);
  EXPECT_EQ(codecs["mcc"]["lost_vertices"], 0);
  const std::string best =
      codecs["draco_5"]["bytes"] < codecs["draco_0"]["bytes"] ? "draco_5" : "draco_0";
  EXPECT_EQ(figures["best"], best);
  EXPECT_NEAR(figures["ratio_to_best"].get<double>(),
              codecs["mcc"]["bytes"].get<double>() / codecs[best]["bytes"].get<double>(), 1e-9);
}

TEST(Compare, SamplesAddUp) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  std::string inputs;
  size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MCC_SAMPLES_DIR)) {
    if (entry.path().extension() != ".glb") continue;
    inputs += " '" + entry.path().string() + "'";
    ++count;
  }
  const ToolResult result = runTool(folder, "compare --format json --runs 1" + inputs);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json["files"].size(), count);
  for (const Json& figures : json["files"]) expectConsistent(figures);
}

TEST(Compare, ErrorsAreWithinTheLattice) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const ToolResult result = runTool(
      folder, "compare --format json --runs 1 --position-bits 10 " + samplePath("torus.glb"));
  ASSERT_EQ(result.status, 0) << result.err;
  const Json figures = Json::parse(result.out)["files"][0];
  expectConsistent(figures);
  for (const std::string& key : kCodecs) {
    const Json& errors = figures["codecs"][key]["errors"];
    if (key == "draco_3" || key == "draco_5") {
      EXPECT_EQ(errors, figures["codecs"]["draco_0"]["errors"]) << "the speed changes no value";
    }
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_EQ(errors[0]["name"], "POSITION");
    const double error = errors[0]["max"];
    EXPECT_GT(error, 0.0005) << key;
    EXPECT_LT(error, 0.005) << key;
    EXPECT_LE(errors[0]["median"], error);
    EXPECT_EQ(errors[1]["unit"], "degrees");
    EXPECT_LT(errors[1]["max"], 0.5) << key;
  }
}

TEST(Compare, MorphTargetsAreShownApart) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const ToolResult result =
      runTool(folder, "compare --format json --runs 1 " + samplePath("morphed.glb"));
  ASSERT_EQ(result.status, 0) << result.err;
  const Json figures = Json::parse(result.out)["files"][0];
  expectConsistent(figures);
  ASSERT_TRUE(figures.contains("left_out"));
  EXPECT_GT(figures["left_out"]["bytes_with"], figures["codecs"]["mcc"]["bytes"]);
  EXPECT_EQ(figures["left_out"]["streams"][0]["name"], "target 0 POSITION");
  for (const Json& stream : figures["streams"]) {
    EXPECT_EQ(stream["name"].get<std::string>().find("target"), std::string::npos);
  }
}

TEST(Compare, FormatsAreTables) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const std::string inputs = samplePath("torus.glb") + " " + samplePath("modes.glb");
  const ToolResult pretty = runTool(folder, "compare --runs 1 " + inputs);
  ASSERT_EQ(pretty.status, 0) << pretty.err;
  for (const char* word : {"connectivity", "POSITION", "draco 0", "mcc/best", "triangles kept",
                           "decode, ms", "error of", "geometric mean"}) {
    EXPECT_NE(pretty.out.find(word), std::string::npos) << word << "\n" << pretty.out;
  }
  const ToolResult markdown = runTool(folder, "compare --runs 1 --format md " + inputs);
  EXPECT_NE(markdown.out.find("| bytes of"), std::string::npos) << markdown.out;
  const ToolResult csv = runTool(folder, "compare --runs 1 --format csv " + inputs);
  EXPECT_EQ(csv.out.rfind("file,row,unit,mcc,draco_0,draco_3,draco_5,mcc_to_best\n", 0), 0u);
  size_t begin = 0;
  while (begin < csv.out.size()) {
    const size_t end = csv.out.find('\n', begin);
    const std::string line = csv.out.substr(begin, end - begin);
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 7) << line;
    begin = end + 1;
  }
  EXPECT_EQ(runTool(folder, "compare --runs 1 -q " + inputs).out, "");
}

/// Geometry in Draco is decoded first. Its bytes are not counted as gained, so the figures differ
/// from the source's by them.
TEST(Compare, CompressedInputsAreDecodedFirst) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  for (const std::string name : {"torus.glb", "textured.glb", "two_materials.glb"}) {
    SCOPED_TRACE(name);
    ASSERT_EQ(runTool(folder,
                      "convert -q --compare none " + samplePath(name) + " o.glb --emit-draco d.glb")
                  .status,
              0);
    const ToolResult source = runTool(folder, "compare --runs 1 --format json " + samplePath(name));
    const ToolResult coded =
        runTool(folder, "compare --runs 1 --format json --emit-draco again.glb d.glb");
    ASSERT_EQ(coded.status, 0) << coded.err;
    const Json figures = Json::parse(coded.out)["files"][0];
    expectConsistent(figures);
    EXPECT_EQ(figures["triangles"], Json::parse(source.out)["files"][0]["triangles"]);
    EXPECT_EQ(figures["notes"], Json::array());
    const ToolResult bench = runTool(folder, "bench --format csv -q d.glb");
    EXPECT_EQ(bench.status, 0) << bench.err;
    EXPECT_EQ(std::count(bench.out.begin(), bench.out.end(), '\n'), 6) << bench.out;
    const ToolResult inspect = runTool(folder, "inspect d.glb");
    EXPECT_EQ(inspect.status, 0) << inspect.err;
    EXPECT_NE(inspect.out.find("KHR_draco_mesh_compression"), std::string::npos);
    // Convert the Draco file again, which convert accepts, too.
    const ToolResult converted = runTool(folder, "convert -q --lossless d.glb a.glb");
    ASSERT_EQ(converted.status, 0) << converted.err;
    ASSERT_EQ(runTool(folder, "convert -q --lossless again.glb b.glb").status, 0);
    EXPECT_EQ(Json::parse(runTool(folder, "inspect --format json b.glb").out)["payloads"].size(),
              Json::parse(runTool(folder, "inspect --format json a.glb").out)["payloads"].size());
  }
}

TEST(Compare, ExitStatus) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const std::string torus = samplePath("torus.glb");
  EXPECT_EQ(runTool(folder, "compare").status, 2);
  EXPECT_EQ(runTool(folder, "compare --frobnicate " + torus).status, 2);
  EXPECT_EQ(runTool(folder, "compare --runs 0 " + torus).status, 2);
  EXPECT_EQ(runTool(folder, "compare --emit-draco o.glb " + torus + " " + torus).status, 2);
  EXPECT_EQ(runTool(folder, "compare --help").status, 0);
  const ToolResult mixed = runTool(folder, "compare --runs 1 none.glb " + torus);
  EXPECT_EQ(mixed.status, 1);
  EXPECT_EQ(mixed.err.rfind("gltf-mcc: none.glb: ", 0), 0u) << mixed.err;
  EXPECT_NE(mixed.out.find("POSITION"), std::string::npos) << "the other file is compared";
}

TEST(Compare, ConvertReportsTheComparison) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const std::string torus = samplePath("torus.glb");
  const ToolResult convert = runTool(folder, "convert " + torus + " o.glb --report r.json");
  ASSERT_EQ(convert.status, 0) << convert.err;
  EXPECT_NE(convert.out.find("\n  Draco "), std::string::npos) << convert.out;
  EXPECT_EQ(convert.out.find("draco 0"), std::string::npos) << convert.out;
  const ToolResult tables = runTool(folder, "convert -v " + torus + " o.glb");
  EXPECT_NE(tables.out.find("draco 0"), std::string::npos) << tables.out;
  const Json report = Json::parse(contentOf(folder.path() / "r.json"));
  expectConsistent(report["comparison"]);
  EXPECT_EQ(report["comparison"]["codecs"]["mcc"]["bytes"], report["payloads"][0]["bytes"]);
  const ToolResult without =
      runTool(folder, "convert " + torus + " o.glb --compare none --report r.json");
  ASSERT_EQ(without.status, 0) << without.err;
  EXPECT_EQ(without.out.find("draco"), std::string::npos) << without.out;
  EXPECT_FALSE(Json::parse(contentOf(folder.path() / "r.json")).contains("comparison"));
  EXPECT_EQ(runTool(folder, "convert " + torus + " o.glb --compare zip").status, 2);
}

TEST(Compare, ConvertInPlaceComparesTheSource) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  std::filesystem::copy_file(std::string(MCC_SAMPLES_DIR) + "/torus.glb", folder.path() / "a.glb");
  const ToolResult result = runTool(folder, "convert --in-place a.glb a.glb --format json");
  ASSERT_EQ(result.status, 0) << result.err;
  expectConsistent(Json::parse(result.out)["comparison"]);
}

TEST(Compare, DracoFileThatCannotBeWritten) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const ToolResult result =
      runTool(folder, "convert " + samplePath("torus.glb") + " o.glb --emit-draco none/d.glb");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("none"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "o.glb"));
}

/// The file is read by Draco's own JavaScript decoder and by the Khronos validator.
TEST(Compare, DracoFileIsReadByOthers) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const std::string modules = std::string(MCC_SOURCE_DIR) + "/tests/web/node_modules";
  const bool has_node = runCommand(folder, "node --version").status == 0;
  if (!has_node || !std::filesystem::exists(modules + "/draco3dgltf")) {
    GTEST_SKIP() << "no node, or no draco3dgltf in tests/web/node_modules (npm ci)";
  }
  std::string pairs;
  for (const auto& entry : std::filesystem::directory_iterator(MCC_SAMPLES_DIR)) {
    if (entry.path().extension() != ".glb") continue;
    const std::string source = "'" + entry.path().string() + "'";
    const std::string name = entry.path().filename().string();
    const ToolResult emitted =
        runTool(folder, "convert -q --compare none " + source + " x.glb --emit-draco " + name);
    ASSERT_EQ(emitted.status, 0) << emitted.err;
    pairs += " " + source + " " + name;
  }
  const ToolResult read =
      runCommand(folder, std::string("node '") + MCC_SOURCE_DIR + "/tests/cli/read_draco.mjs' '" +
                             modules + "'" + pairs);
  EXPECT_EQ(read.status, 0) << read.out << read.err;
}

/// What other codecs cannot hold is a line of the report and never ends the program.
TEST(Compare, WildValuesEndNothing) {
  using gltf::test::Builder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const ScratchFolder folder;
  for (const auto& [first, second] :
       {std::pair(3e38f, -3e38f), {nan, infinity}, {1e-45f, -1e-45f}}) {
    for (const char* name : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
      SCOPED_TRACE(std::to_string(first) + " in " + name);
      Builder builder;
      gltf::test::Sheet sheet(12);
      std::vector<float>& values = name[0] == 'P'   ? sheet.positions
                                   : name[0] == 'N' ? sheet.normals
                                                    : sheet.texcoords;
      for (size_t i = 0; i < values.size() / 2; ++i) values[2 * i] = i % 2 == 0 ? first : second;
      const auto primitive = sheet.addTo(builder);
      builder.addMesh({primitive});
      builder.json["accessors"][0].erase("min");
      builder.json["accessors"][0].erase("max");
      const std::vector<uint8_t> file = builder.toGlb();
      std::ofstream(folder.path() / "in.glb", std::ios::binary)
          .write(reinterpret_cast<const char*>(file.data()),
                 static_cast<std::streamsize>(file.size()));
      for (const char* command :
           {"convert in.glb out.glb",
            "convert in.glb out.glb --lossless --compare none --emit-draco draco.glb",
            "compare in.glb --runs 1", "convert in.glb out.glb --emit-draco draco.glb",
            "bench in.glb --runs 5"}) {
        const ToolResult result = runTool(folder, command);
        EXPECT_TRUE(result.status == 0 || result.status == 1)
            << command << ": " << result.status << " " << result.err;
        EXPECT_EQ((result.out + result.err).find("please report"), std::string::npos)
            << command << result.err;
      }
    }
  }
}

/// Triangles that Draco drops: here it drops all of them.
TEST(Compare, MeshesThatDracoRefusesAreALine) {
  using gltf::test::Builder;
  const ScratchFolder folder;
  Builder builder;
  gltf::test::Sheet sheet(12);
  for (size_t i = 0; i < sheet.indices.size(); i += 3) sheet.indices[i + 1] = sheet.indices[i];
  builder.addMesh({sheet.addTo(builder)});
  const std::vector<uint8_t> file = builder.toGlb();
  std::ofstream(folder.path() / "in.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  EXPECT_EQ(runTool(folder, "convert in.glb out.glb").status, 0);
  for (const char* command : {"compare in.glb --runs 1", "bench in.glb --runs 5",
                              "convert in.glb out.glb --emit-draco draco.glb"}) {
    const ToolResult result = runTool(folder, command);
    EXPECT_TRUE(result.status == 0 || result.status == 1)
        << command << ": " << result.status << " " << result.err;
  }
}

}  // namespace
}  // namespace mcc::test
