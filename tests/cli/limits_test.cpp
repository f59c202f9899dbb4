// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Files that never end, and files that ask for more than the limits.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/run_tool.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class CliLimits : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#else
    fs::copy_file(fs::path(MCC_SAMPLES_DIR) / "torus.glb", folder_.path() / "torus.glb");
#endif
  }

  ScratchFolder folder_;
};

// Without a bound on reading, these would take all memory.
TEST_F(CliLimits, EndlessInput) {
  for (const char* arguments :
       {"convert - - < /dev/zero", "decode - - < /dev/zero", "convert /dev/zero out.glb",
        "inspect /dev/zero", "validate /dev/zero"}) {
    const ToolResult result = runTool(folder_, arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    const std::string text = result.out + result.err;
    EXPECT_NE(text.find("this is not a glTF file"), std::string::npos) << arguments << text;
  }
  EXPECT_FALSE(fs::exists(folder_.path() / "out.glb"));
}

TEST_F(CliLimits, WhatComesAfterAGlbInAPipeIsNotWaitedFor) {
#ifdef MCC_TOOL_GLTF_MCC
  const std::string tool = std::string("'") + MCC_TOOL_GLTF_MCC + "' ";
  // `yes` never ends by itself.
  const ToolResult result =
      runCommand(folder_, "{ cat torus.glb; yes; } 2>/dev/null | " + tool + "convert - small.glb");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("bytes after the end of the GLB were ignored"), std::string::npos)
      << result.out;
#endif
}

TEST_F(CliLimits, DecodedBytes) {
  ASSERT_EQ(runTool(folder_, "convert torus.glb small.glb").status, 0);
  for (const char* command : {"decode small.glb out.glb", "convert small.glb out.glb"}) {
    const std::string line = command;
    const ToolResult refused = runTool(folder_, line + " --max-decoded-bytes 1000");
    EXPECT_EQ(refused.status, 1) << line;
    EXPECT_NE(refused.err.find("bytes of decoded geometry; the limit is 1000, which "
                               "max_decoded_bytes (--max-decoded-bytes) raises"),
              std::string::npos)
        << refused.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "out.glb"));
  }
  EXPECT_EQ(runTool(folder_, "validate small.glb --max-decoded-bytes 1000").status, 1);
  EXPECT_EQ(runTool(folder_, "decode small.glb out.glb --max-decoded-bytes 98304").status, 0);
  EXPECT_EQ(runTool(folder_, "decode small.glb out.glb --max-decoded-bytes 0").status, 2);
}

}  // namespace
}  // namespace mcc::test
