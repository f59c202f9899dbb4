// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The recipe of docs/cli.md for GNU Parallel, verbatim, with two workers on this machine and one
// broken model.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "cli/run_tool.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

/// Returns the indented lines of docs/cli.md, from one with this beginning to an empty line.
std::string snippetOf(const std::string& begin) {
  const std::string text = contentOf(fs::path(MCC_SOURCE_DIR) / "docs" / "cli.md");
  const size_t at = text.find("\n    " + begin);
  if (at == std::string::npos) return "";
  return text.substr(at + 1, text.find("\n\n", at) - at);
}

TEST(Recipes, ParallelConvertsALibraryAndTriesAgainWhatFailed) {
#ifndef MCC_TOOL_GLTF_MCC
  GTEST_SKIP() << "the tool is not part of this build";
#else
  const ScratchFolder folder;
  if (runCommand(folder, "parallel --minversion 20160222").status != 0) {
    GTEST_SKIP() << "no GNU Parallel (tools/setup --for test)";
  }
  const fs::path root = folder.path();
  const std::string recipe = snippetOf("find models");
  ASSERT_NE(recipe.find("parallel --sshloginfile machines"), std::string::npos) << recipe;
  std::ofstream(root / "recipe") << recipe;
  std::ofstream(root / "machines") << "2/:\n";  // two workers, here
  for (const char* name : {"bin", "home", "models", "models/old ones"}) {
    fs::create_directory(root / name);
  }
  fs::create_symlink(MCC_TOOL_GLTF_MCC, root / "bin" / "gltf-mcc");
  const fs::path samples = MCC_SAMPLES_DIR;
  const std::string whole = contentOf(samples / "torus.glb");
  fs::copy_file(samples / "modes.glb", root / "models" / "modes.glb");
  fs::copy_file(samples / "sphere.glb", root / "models" / "old ones" / "a sphere.glb");
  std::ofstream(root / "models" / "torus.glb", std::ios::binary) << whole.substr(0, 5000);

  const std::string command = "env HOME=\"$PWD/home\" PATH=\"$PWD/bin:$PATH\" bash recipe";
  const auto linesOfLog = [&]() {
    const std::string log = contentOf(root / "convert.log");
    return std::count(log.begin(), log.end(), '\n');
  };
  const ToolResult first = runCommand(folder, command);
  EXPECT_EQ(first.status, 1) << "the number of models that failed\n" << first.err;
  EXPECT_NE(first.err.find("models/torus.glb: "), std::string::npos) << first.err;
  EXPECT_EQ(linesOfLog(), 4) << "a title and three jobs";
  EXPECT_FALSE(fs::exists(root / "small" / "models" / "torus.glb"));
  for (const std::string name : {"modes.glb", "old ones/a sphere.glb"}) {
    ASSERT_EQ(runTool(folder, "convert -q 'models/" + name + "' alone.glb").status, 0);
    EXPECT_EQ(contentOf(root / "small" / "models" / name), contentOf(root / "alone.glb")) << name;
  }
  const auto before = fs::last_write_time(root / "small" / "models" / "modes.glb");

  std::ofstream(root / "models" / "torus.glb", std::ios::binary) << whole;
  fs::copy_file(samples / "moebius.glb", root / "models" / "a new one, before all others.glb");
  EXPECT_EQ(runCommand(folder, command).status, 0);
  EXPECT_EQ(linesOfLog(), 3) << "only these two are made";
  EXPECT_TRUE(fs::exists(root / "small" / "models" / "a new one, before all others.glb"));
  EXPECT_EQ(runTool(folder, "decode -q small/models/torus.glb back.glb").status, 0);
  EXPECT_EQ(fs::last_write_time(root / "small" / "models" / "modes.glb"), before);
  EXPECT_EQ(runCommand(folder, command).status, 0);
  EXPECT_LE(linesOfLog(), 1);
#endif
}

}  // namespace
}  // namespace mcc::test
