// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// gltf-mcc validate from outside: exit status, text, and JSON in the form of Khronos' validator.
#include "cli/run_tool.h"

namespace mcc::test {
namespace {

#ifndef MCC_TOOL_GLTF_MCC
#define MCC_REQUIRE_TOOL() GTEST_SKIP() << "this build has no gltf-mcc"
#else
#define MCC_REQUIRE_TOOL() (void)0
#endif

std::string assetPath(const std::string& name) {
  return std::string("'") + MCC_SOURCE_DIR + "/tests/conformance/" + name + "'";
}

TEST(ValidateCommand, GoldenJson) {
  MCC_REQUIRE_TOOL();
  const ScratchFolder folder;
  const std::string copy = "cp " + assetPath("negative/restrictions_fewer_elements.glb") +
                           " bad.glb && cp " + assetPath("assets/001_appendix_c.glb") + " good.glb";
  ASSERT_EQ(runCommand(folder, copy).status, 0);
  const ToolResult bad = runTool(folder, "validate --format json bad.glb");
  EXPECT_EQ(bad.status, 1);
  EXPECT_EQ(bad.err, "");
  std::string version = runTool(folder, "--version").out;  // "gltf-mcc 1.2.3", then the format's
  version = version.substr(0, version.find('\n'));
  version.erase(0, version.find(' ') + 1);
  const std::string expected = R"json({
  "uri": "bad.glb",
  "mimeType": "model/gltf-binary",
  "validatorVersion": ")json" + version +
                               R"json(",
  "issues": {
    "numErrors": 1,
    "numWarnings": 0,
    "numInfos": 0,
    "numHints": 0,
    "messages": [
      {
        "code": "COUNT_MISMATCH",
        "message": "47 does not match the payload, which has 48 vertices",
        "severity": 0,
        "pointer": "/accessors/0/count"
      }
    ],
    "truncated": false
  },
  "info": {
    "version": "2.0",
    "generator": "generate-conformance",
    "extensionsUsed": [
      "KHR_mesh_collapse_compression"
    ],
    "extensionsRequired": [
      "KHR_mesh_collapse_compression"
    ],
    "primitiveCount": 1,
    "compressedPrimitiveCount": 1,
    "payloadCount": 1,
    "payloadVertexCount": 48,
    "payloadTriangleCount": 70
  }
}
)json";
  EXPECT_EQ(bad.out, expected);
  const ToolResult good = runTool(folder, "validate good.glb");
  EXPECT_EQ(good.status, 0);
  EXPECT_EQ(good.out,
            "good.glb: valid; 1 of 1 primitives compressed, in 1 payload: 2 triangles, 4 "
            "vertices\n");
}

TEST(ValidateCommand, TextNamesCodePointerAndMessage) {
  MCC_REQUIRE_TOOL();
  const ScratchFolder folder;
  const ToolResult bad =
      runTool(folder, "validate " + assetPath("negative/restrictions_mode_5.glb"));
  EXPECT_EQ(bad.status, 1);
  EXPECT_NE(bad.out.find(": 1 error; 1 of 1 primitives"), std::string::npos) << bad.out;
  EXPECT_NE(bad.out.find("error     MODE_NOT_TRIANGLES  /meshes/0/primitives/0/mode  must be 4"),
            std::string::npos)
      << bad.out;
}

TEST(ValidateCommand, SeveralFilesAndStandardInput) {
  MCC_REQUIRE_TOOL();
  const ScratchFolder folder;
  const std::string good = assetPath("assets/001_appendix_c.glb");
  const std::string bad = assetPath("negative/restrictions_mode_5.glb");
  const ToolResult both = runTool(folder, "validate -q " + good + " " + bad);
  EXPECT_EQ(both.status, 1);
  EXPECT_EQ(both.out.find("appendix"), std::string::npos);
  EXPECT_NE(both.out.find("MODE_NOT_TRIANGLES"), std::string::npos);
  const ToolResult json = runTool(folder, "validate --format json " + good + " " + good);
  EXPECT_EQ(json.status, 0);
  EXPECT_EQ(json.out.substr(0, 2), "[\n");
  const ToolResult plain = runTool(folder, "validate " + samplePath("torus.glb"));
  EXPECT_EQ(plain.status, 0);
  EXPECT_NE(plain.out.find("valid; nothing in it is compressed with KHR_mesh_collapse_compression, "
                           "so there was nothing to check\n"),
            std::string::npos)
      << plain.out;
  const ToolResult missing = runTool(folder, "validate none.glb " + good);
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.err.find("none.glb"), std::string::npos);
  EXPECT_NE(missing.out.find("valid;"), std::string::npos);
#ifdef MCC_TOOL_GLTF_MCC
  const ToolResult piped =
      runCommand(folder, "cat " + bad + " | '" + MCC_TOOL_GLTF_MCC + "' validate --format csv -");
  EXPECT_EQ(piped.status, 1) << piped.err;
  EXPECT_NE(piped.out.find("-,error,MODE_NOT_TRIANGLES,/meshes/0/primitives/0/mode,"),
            std::string::npos)
      << piped.out;
#endif
}

TEST(ValidateCommand, WrongUsage) {
  MCC_REQUIRE_TOOL();
  const ScratchFolder folder;
  EXPECT_EQ(runTool(folder, "validate").status, 2);
  EXPECT_EQ(runTool(folder, "validate --max-issues many a.glb").status, 2);
}

}  // namespace
}  // namespace mcc::test
