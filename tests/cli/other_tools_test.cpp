// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Models made by common tools are inputs like any other: glTF-Transform, gltfpack, gltf-pipeline.
#include <gtest/gtest.h>

#include "cli/run_tool.h"
#include "support/validator.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class OtherTools : public testing::TestWithParam<const char*> {};

TEST_P(OtherTools, OutputsAreConverted) {
  MCC_REQUIRE_COMPARISON();
  const ScratchFolder folder;
  const fs::path modules = fs::path(MCC_SOURCE_DIR) / "tests/web/node_modules";
  const bool has_node = runCommand(folder, "node --version").status == 0;
  if (!has_node || !fs::exists(modules / "gltf-pipeline")) {
    GTEST_SKIP() << "no node, or no gltf-pipeline in tests/web/node_modules (npm ci)";
  }
  const std::string script = std::string("node '") + MCC_SOURCE_DIR +
                             "/tests/cli/other_tools.mjs' '" + modules.string() + "' ";
  fs::create_directory(folder.path() / "in");
  const ToolResult made =
      runCommand(folder, script + "make " + samplePath(std::string(GetParam()) + ".glb") + " in");
  ASSERT_EQ(made.status, 0) << made.out << made.err;
  Validator validator(folder.path());
  std::string pairs;
  size_t smaller_count = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "in")) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    if (entry.path().extension() != ".glb") continue;
    if (name.starts_with("newer_")) {
      const ToolResult refused = runTool(folder, "convert in/" + name + " refused.glb");
      EXPECT_EQ(refused.status, 1);
      EXPECT_NE(refused.err.find("/extensions/KHR_meshopt_compression: has version 1 of its codec"),
                std::string::npos)
          << refused.err;
      EXPECT_FALSE(fs::exists(folder.path() / "refused.glb"));
      continue;
    }
    const ToolResult converted =
        runTool(folder, "convert --compare none in/" + name + " out_" + name);
    ASSERT_EQ(converted.status, 0) << converted.err;
    for (const std::string command : {"compare --runs 1 -q ", "inspect "}) {  // read it alike
      const ToolResult others = runTool(folder, command + "in/" + name);
      EXPECT_EQ(others.status, 0) << others.err;
    }
    const bool is_smaller =
        fs::file_size(folder.path() / ("out_" + name)) < fs::file_size(entry.path());
    if (!is_smaller) {
      EXPECT_EQ(contentOf(folder.path() / ("out_" + name)), contentOf(entry.path()));
    }
    smaller_count += is_smaller ? 1 : 0;
    const ToolResult decoded = runTool(folder, "decode -q out_" + name + " back_" + name);
    ASSERT_EQ(decoded.status, 0) << decoded.err;
    const ToolResult again =
        runTool(folder, "convert -q --compare none out_" + name + " again.glb");
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(contentOf(folder.path() / "again.glb"), contentOf(folder.path() / ("out_" + name)));
    pairs += " in/" + name + " back_" + name;
    if (name.starts_with("gltfpack")) {  // the attributes stay quantised, or coded by meshoptimizer
      const ToolResult indices =
          runTool(folder, "convert -q --compare none --indices-only in/" + name + " io_" + name);
      ASSERT_EQ(indices.status, 0) << indices.err;
      EXPECT_LT(fs::file_size(folder.path() / ("io_" + name)), fs::file_size(entry.path()));
      ASSERT_EQ(runTool(folder, "decode -q io_" + name + " ib_" + name).status, 0);
      pairs += " in/" + name + " ib_" + name;
      validator.add(entry.path(), folder.path() / ("io_" + name), folder.path() / ("ib_" + name));
    }
    // Only where the validator understands the contents.
    validator.add(folder.path() / "in/plain" / name, folder.path() / ("out_" + name),
                  folder.path() / ("back_" + name));
  }
  EXPECT_GE(smaller_count, 7u);
  const ToolResult compared = runCommand(folder, script + "compare" + pairs);
  EXPECT_EQ(compared.status, 0) << compared.out << compared.err;
  EXPECT_TRUE(validator.run()) << "the lines above name what is new";
}

INSTANTIATE_TEST_SUITE_P(Samples, OtherTools,
                         testing::Values("textured", "skinned", "two_materials", "morphed"));

}  // namespace
}  // namespace mcc::test
