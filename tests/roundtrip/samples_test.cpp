// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The committed samples are what the generator makes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& path, std::ios::openmode mode = std::ios::binary) {
  std::ifstream file(path, mode);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::set<std::string> modelsIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".glb") names.insert(entry.path().filename().string());
  }
  return names;
}

TEST(Samples, GeneratorMakesTheCommittedBytes) {
#ifndef MCC_TOOL_GENERATE_SAMPLES
  GTEST_SKIP() << "generate-samples is not part of this build";
#else
  const fs::path committed = MCC_SAMPLES_DIR;
  const fs::path folder = fs::path(testing::TempDir()) / "mcc_samples_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path table = folder / "table.md";
  const fs::path tool = fs::absolute(MCC_TOOL_GENERATE_SAMPLES).make_preferred();
  std::string command =
      "\"" + tool.string() + "\" \"" + folder.string() + "\" > \"" + table.string() + "\"";
#if defined(_WIN32)
  command = "\"" + command + "\"";  // the shell there removes the outermost quotes
#endif
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  EXPECT_EQ(modelsIn(folder), modelsIn(committed));
  uintmax_t bytes = 0;
  for (const std::string& name : modelsIn(committed)) {
    EXPECT_TRUE(contentOf(folder / name) == contentOf(committed / name)) << name << " differs";
    bytes += fs::file_size(committed / name);
  }
  EXPECT_LT(bytes, 1000000u);
  EXPECT_NE(contentOf(committed / "README.md", std::ios::in).find(contentOf(table, std::ios::in)),
            std::string::npos)
      << "the table of samples/README.md differs";
  fs::remove_all(folder);
#endif
}

}  // namespace
}  // namespace mcc::test
