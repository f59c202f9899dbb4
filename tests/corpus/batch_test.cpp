// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Uses the corpus as a user's library of models: one call converts it, and another decodes it,
// whatever the folder contains.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/run_tool.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

TEST(CorpusBatch, BadFilesDoNotStopTheRest) {
#ifndef MCC_TOOL_GLTF_MCC
  GTEST_SKIP() << "the tool is not part of this build";
#endif
  const ScratchFolder folder;
  fs::create_directory(folder.path() / "in");
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(MCC_CORPUS_DIR, ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".glb" || name.starts_with("g_")) continue;
    fs::create_symlink(entry.path(), folder.path() / "in" / name);
    names.push_back(name);
  }
  if (names.empty()) GTEST_SKIP() << "no corpus in " << MCC_CORPUS_DIR;
  std::sort(names.begin(), names.end());
  std::string damaged = contentOf(folder.path() / "in" / names[0]);
  damaged.resize(damaged.size() / 2);
  std::ofstream(folder.path() / "in/damaged.glb", std::ios::binary) << damaged;
  std::ofstream(folder.path() / "in/empty.glb");
  fs::create_symlink("nowhere", folder.path() / "in/unreadable.glb");

  const ToolResult converted = runTool(folder, "convert -j 2 -o out/ in/*.glb");
  EXPECT_EQ(converted.status, 1);
  EXPECT_NE(converted.out.find("\nfailed         3\n"), std::string::npos) << converted.out;
  size_t from = 0;  // the three lines, in the order of the command line
  for (const char* name : {"damaged", "empty", "unreadable"}) {
    const size_t at = converted.err.find("gltf-mcc: in/" + std::string(name) + ".glb: ", from);
    ASSERT_NE(at, std::string::npos) << converted.err;
    from = at + 1;
    EXPECT_FALSE(fs::exists(folder.path() / "out" / (std::string(name) + ".glb")));
  }
  EXPECT_EQ(std::count(converted.err.begin(), converted.err.end(), '\n'), 3) << converted.err;
  for (const std::string& name : names) {
    EXPECT_LE(fs::file_size(folder.path() / "out" / name),
              fs::file_size(folder.path() / "in" / name))
        << name;
  }

  const ToolResult decoded = runTool(folder, "decode -j 2 -o back/ out/*.glb");
  EXPECT_EQ(decoded.status, 0) << decoded.err;
  for (const std::string& name : names) {
    EXPECT_TRUE(fs::exists(folder.path() / "back" / name)) << name;
  }
  const ToolResult again = runTool(folder, "convert -j 2 -o out/ in/*.glb");
  EXPECT_EQ(again.status, 1);
  size_t up_to_date = 0;
  for (size_t at = 0; (at = again.out.find(": up to date\n", at)) != std::string::npos; ++at) {
    ++up_to_date;
  }
  EXPECT_EQ(up_to_date, names.size()) << again.out;
}

}  // namespace
}  // namespace mcc::test
