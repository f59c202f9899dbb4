// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks reports against report.schema.json, which describes every member of them.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/run_tool.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class ReportSchema : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
    const fs::path modules = fs::path(MCC_SOURCE_DIR) / "tests/web/node_modules";
    const bool has_node = runCommand(folder_, "node --version").status == 0;
    if (!has_node || !fs::exists(modules / "ajv")) {
      GTEST_SKIP() << "no node, or no ajv in tests/web/node_modules (npm ci)";
    }
    validate_ = std::string("node '") + MCC_SOURCE_DIR + "/tests/cli/validate_report.mjs' '" +
                modules.string() + "' '" + MCC_SOURCE_DIR + "/tools/gltf-mcc/report.schema.json' ";
  }

  void expectValid(const std::string& arguments, int status = 0) const {
    ASSERT_EQ(runTool(folder_, arguments + " --report report.json -q").status, status) << arguments;
    const ToolResult result = runCommand(folder_, validate_ + "report.json");
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.out << result.err;
  }

  void store(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
  }

  ScratchFolder folder_;
  std::string validate_;
};

TEST_F(ReportSchema, DescribesConversions) {
  for (const char* name : {"textured", "skinned", "morphed", "modes", "two_materials"}) {
    expectValid("convert " + samplePath(std::string(name) + ".glb") + " out.glb");
  }
  const std::string torus = "convert " + samplePath("torus.glb") + " out.glb ";
  expectValid(torus + "--lossless");
  expectValid(torus + "--max-position-error 0.001 --fallback");
  expectValid(torus + "--step 2^-10");
  expectValid(torus + "--quality 2048px");
  expectValid(torus + "--block-triangles 500 --preview 5000 --allow-larger");
  expectValid(torus + "--position-lattice 0,0,0,0.001 --keep-vertex-order --keep-triangle-order");
  expectValid(torus + "--indices-only");
  store("triangle.gltf", R"({"asset": {"version": "2.0"}})");
  expectValid("convert triangle.gltf small.gltf");  // copied
}

TEST_F(ReportSchema, DescribesBatches) {
  store("broken.glb", "no model");
  const std::string batch =
      "convert -o out/ " + samplePath("torus.glb") + " " + samplePath("modes.glb") + " broken.glb";
  expectValid(batch, 1);
  expectValid(batch, 1);  // up to date
}

TEST_F(ReportSchema, RefusesOtherMembers) {
  ASSERT_EQ(
      runTool(folder_, "convert " + samplePath("torus.glb") + " out.glb -q --report report.json")
          .status,
      0);
  std::string text = contentOf(folder_.path() / "report.json");
  text.insert(text.find("\"copied\""), "\"surprise\": 1, ");
  store("report.json", text);
  const ToolResult result = runCommand(folder_, validate_ + "report.json");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.out.find("surprise"), std::string::npos) << result.out << result.err;
}

}  // namespace
}  // namespace mcc::test
