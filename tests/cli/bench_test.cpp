// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The benchmark command: consistent figures, formats, exit status. Times are not judged. Also the
// sizes of the samples, so that a change of size shows in review.
#include <algorithm>
#include <map>
#include <sstream>

#include "cli/run_tool.h"
#include "json/json.h"

namespace mcc::test {
namespace {

using gltf::Json;

TEST(Bench, FiguresAreConsistent) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const ToolResult result =
      runTool(folder, "bench --runs 5 --format json " + samplePath("modes.glb") + " " +
                          samplePath("two_materials.glb"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "") << "no progress where there is no terminal";
  const Json json = Json::parse(result.out);
  EXPECT_NE(json["compiler_flags"].get<std::string>().find("-ffp-contract=off"), std::string::npos);
  EXPECT_FALSE(json["versions"]["draco"].get<std::string>().empty());
  ASSERT_EQ(json["files"].size(), 2u);
  for (const Json& file : json["files"]) {
    SCOPED_TRACE(file["file"]);
    ASSERT_EQ(file["codecs"].size(), 5u);
    for (const auto& [name, codec] : file["codecs"].items()) {
      SCOPED_TRACE(name);
      double sum = 0;
      for (const auto& [stream, bytes] : codec["stream_bytes"].items()) sum += bytes.get<double>();
      EXPECT_NEAR(sum, codec["bytes"].get<double>(), 1);
      EXPECT_NEAR(codec["bits_per_vertex"].get<double>() * file["vertices"].get<double>(),
                  8 * codec["bytes"].get<double>(), 1e-3);
      EXPECT_GE(codec["decode_runs"], 5);
      EXPECT_GE(codec["encode_runs"], 1);
      EXPECT_GT(codec["decode_ns_per_vertex"], 0);
      EXPECT_GT(codec["peak_bytes_above_arrays"], 0);
      EXPECT_GE(codec["array_bytes"].get<uint64_t>(),
                12 * codec["triangles"].get<uint64_t>() + 12 * codec["vertices"].get<uint64_t>());
      EXPECT_GT(codec["acmr"], 0.3);
      EXPECT_LE(codec["acmr"], 3);
    }
    EXPECT_EQ(file["codecs"]["mcc"]["triangles"], file["triangles"]);
    EXPECT_EQ(file["category"], "all");
  }
  ASSERT_EQ(json["geometric_means"].size(), 1u);
  EXPECT_EQ(json["geometric_means"][0]["files"], 2);
}

TEST(Bench, MeasuresWhatIsPreferred) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const auto bytes = [&](const std::string& preference) {
    const ToolResult result = runTool(
        folder, "bench --format json --prefer " + preference + " " + samplePath("genus3.glb"));
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out)["files"][0]["codecs"]["mcc"]["bytes"].get<uint64_t>();
  };
  EXPECT_LT(bytes("size"), bytes("speed"));
}

/// Every feature that can be switched off is chosen by the encoder somewhere.
TEST(Bench, WithoutAFeatureTheBytesOfSomeSampleChange) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  std::map<std::string, bool> is_seen;
  for (const std::string how : {"", "--lossless "}) {
    std::string inputs;
    for (const char* name : {"modes", "morphed", "sheet_with_holes", "shared_vertices", "skinned",
                             "textured", "two_materials"}) {
      inputs += " " + samplePath(std::string(name) + ".glb");
    }
    const ToolResult result =
        runTool(folder, "bench --runs 5 --without all --format json " + how + inputs);
    ASSERT_EQ(result.status, 0) << result.err;
    for (const Json& file : Json::parse(result.out)) {
      for (const Json& row : file["ablations"]) {
        is_seen[row["without"]] |= row["bytes"] != file["bytes"];
        EXPECT_EQ(row.contains("decode_seconds"), row.contains("decode_seconds_with"));
      }
    }
  }
  // The samples are too regular for sheared residuals and hinges, and none of them is an isosurface
  // or has exact tangents, tangents of faces, equal attributes, edges with many faces or components
  // that repeat another.
  const std::map<std::string, bool> in_other_files = {
      {"aliases", true},       {"anchors", true},         {"perpendicular", true},
      {"pivots", true},        {"planes", true},          {"shear", true},
      {"tangent-faces", true}, {"tangent-repeats", true}, {"texcoord-hinge", true}};
  EXPECT_GT(is_seen.size(), 10u);
  for (const auto& [name, seen] : is_seen) {
    EXPECT_NE(seen, in_other_files.count(name) != 0) << name;
  }
}

TEST(Bench, MeshletsOfBothOrdersAndOfMeshoptimizer) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const std::string samples = samplePath("torus.glb") + " " + samplePath("two_materials.glb");
  const ToolResult result = runTool(folder, "bench --meshlets --format json " + samples);
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json.size(), 2u);
  for (const Json& file : json) {
    SCOPED_TRACE(file["file"]);
    EXPECT_GT(file["triangles"], 0);
    EXPECT_GT(file["triangles_decode_seconds"], 0);
    EXPECT_GT(file["decode_seconds"], 0);
    ASSERT_EQ(file["orders"].size(), 3u);
    for (const auto& [name, order] : file["orders"].items()) {
      SCOPED_TRACE(name);
      EXPECT_NEAR(order["triangles_per_meshlet"].get<double>() * order["meshlets"].get<double>(),
                  file["triangles"].get<double>(), 1e-6);
      EXPECT_LE(order["triangles_per_meshlet"], 124);
      EXPECT_GT(order["vertices_per_triangle"], 0.5);
      EXPECT_LE(order["vertices_per_triangle"], 3);
      EXPECT_GT(order["mean_radius"], 0);
      EXPECT_GE(order["mean_1_minus_cutoff"], 0);
      EXPECT_LE(order["mean_1_minus_cutoff"], 1);
      EXPECT_GT(order["seconds"], 0);
    }
    const Json& round = file["orders"]["round"];
    const Json& in_order = file["orders"]["in_order"];
    EXPECT_LT(round["mean_radius"].get<double>(), in_order["mean_radius"].get<double>());
  }
  const ToolResult csv = runTool(folder, "bench --meshlets --format csv " + samples);
  ASSERT_EQ(csv.status, 0) << csv.err;
  EXPECT_EQ(std::count(csv.out.begin(), csv.out.end(), '\n'), 7) << csv.out;
  EXPECT_EQ(runTool(folder, "bench --meshlets none.glb").status, 1);
}

TEST(Bench, WithoutAnUnknownFeatureNamesThoseThereAre) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const ToolResult result =
      runTool(folder, "bench --without fold,palette+nothing " + samplePath("torus.glb"));
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("there is no \"nothing\""), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("palette"), std::string::npos) << result.err;
}

TEST(Bench, LoadsWholeFilesWhenAsked) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const std::string sample = samplePath("two_materials.glb");
  const ToolResult result = runTool(folder, "bench --load --format json " + sample);
  if (result.err.find("this build has no tinygltf") != std::string::npos)
    GTEST_SKIP() << result.err;
  ASSERT_EQ(result.status, 0) << result.err;
  const Json load = Json::parse(result.out)["files"][0]["load"];
  EXPECT_EQ(load["payloads"], 1);
  for (const char* codec : {"mcc", "draco_0", "draco_5"}) {
    EXPECT_GT(load["cpu_seconds"][codec], 0) << codec;
  }
  for (const char* threads : {"threads_1", "threads_2"}) {
    EXPECT_GT(load["decode_wall_seconds"][threads], 0) << threads;
  }
  EXPECT_NE(runTool(folder, "bench --load " + sample).out.find("load with tinygltf"),
            std::string::npos);
}

/// Returns the cells of a line of CSV without quotes.
std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// Returns the rows of a table as CSV, by codec and column.
std::map<std::string, std::map<std::string, std::string>> rowsByCodec(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> header = cellsOf(line);
  std::map<std::string, std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cellsOf(line);
    EXPECT_EQ(cells.size(), header.size()) << line;
    if (cells.size() != header.size()) continue;
    for (size_t c = 0; c < cells.size(); ++c) rows[cells[2]][header[c]] = cells[c];
  }
  return rows;
}

TEST(Bench, TablesForProgramsHaveTheLoads) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const std::string sample = samplePath("two_materials.glb");
  const auto is_positive = [](const std::string& cell) {
    return !cell.empty() && std::stod(cell) > 0;
  };
  auto without = rowsByCodec(runTool(folder, "bench --format csv " + sample).out);
  ASSERT_EQ(without.size(), 5u);
  const ToolResult result = runTool(folder, "bench --load --format csv " + sample);
  if (result.err.find("this build has no tinygltf") != std::string::npos)
    GTEST_SKIP() << result.err;
  ASSERT_EQ(result.status, 0) << result.err;
  auto rows = rowsByCodec(result.out);
  ASSERT_EQ(rows.size(), 5u);
  for (const auto& [codec, row] : rows) {
    SCOPED_TRACE(codec);
    const bool is_loaded = codec == "mcc" || codec == "draco_0" || codec == "draco_5";
    ASSERT_EQ(row.count("load_cpu_seconds"), 1u);
    EXPECT_EQ(is_positive(row.at("load_cpu_seconds")), is_loaded);
    for (const char* column : {"decode_wall_seconds_1_thread", "decode_wall_seconds_2_threads"}) {
      ASSERT_EQ(row.count(column), 1u);
      EXPECT_EQ(is_positive(row.at(column)), codec == "mcc") << column;
    }
    EXPECT_EQ(row.at("payloads"), codec == "mcc" ? "1" : "");
    EXPECT_EQ(row.size(), without[codec].size()) << "the columns are the same without --load";
    EXPECT_EQ(without[codec]["load_cpu_seconds"], "");
  }
}

TEST(Bench, CategoriesComeFromTheNames) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  for (const char* name : {"a_one.glb", "a_two.glb", "t_three.glb"}) {
    std::filesystem::copy_file(std::string(MCC_SAMPLES_DIR) + "/modes.glb", folder.path() / name);
  }
  const ToolResult result =
      runTool(folder, "bench --apart t --format json a_one.glb a_two.glb t_three.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  const Json means = Json::parse(result.out)["geometric_means"];
  ASSERT_EQ(means.size(), 3u);
  EXPECT_EQ(means[0]["category"], "a");
  EXPECT_EQ(means[0]["files"], 2);
  EXPECT_EQ(means[1]["category"], "t");
  EXPECT_EQ(means[2]["category"], "all");
  EXPECT_EQ(means[2]["files"], 2) << "without t";
}

TEST(Bench, FormatsAndExitStatus) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const std::string modes = samplePath("modes.glb");
  const ToolResult csv = runTool(folder, "bench --format csv " + modes);
  ASSERT_EQ(csv.status, 0) << csv.err;
  EXPECT_EQ(std::count(csv.out.begin(), csv.out.end(), '\n'), 6) << csv.out;
  EXPECT_EQ(csv.out.rfind("file,category,codec,", 0), 0u);
  const ToolResult markdown = runTool(folder, "bench --format md " + modes);
  EXPECT_NE(markdown.out.find("| geometric mean"), std::string::npos) << markdown.out;
  EXPECT_EQ(runTool(folder, "bench").status, 2);
  EXPECT_EQ(runTool(folder, "bench --runs 4 " + modes).status, 2);
  EXPECT_EQ(runTool(folder, "bench none.glb").status, 1);
  const ToolResult mixed = runTool(folder, "bench --format csv none.glb " + modes);
  EXPECT_EQ(mixed.status, 1);
  EXPECT_NE(mixed.out.find("modes,"), std::string::npos);
}

TEST(Sizes, SamplesHaveTheCommittedSizes) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const ToolResult result =
      runTool(folder, std::string("bench --sizes sizes.csv '") + MCC_SAMPLES_DIR + "'/*.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(contentOf(folder.path() / "sizes.csv"),
            contentOf(std::string(MCC_SOURCE_DIR) + "/tests/results/sizes.csv"))
      << "the sizes have changed. If that is meant, write them anew and say so in the CHANGELOG:\n"
         "  tools/run bench --sizes tests/results/sizes.csv samples/*.glb";
}

}  // namespace
}  // namespace mcc::test
