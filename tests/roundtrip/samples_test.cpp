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

std::set<std::string> filesIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.insert(fs::relative(entry, folder).generic_string());
  }
  return names;
}

#ifdef MCC_TOOL_GENERATE_SAMPLES
/// Runs generate-samples with arguments that the shell leaves as they are, and returns its status.
int generate(const std::string& option, const fs::path& folder, const fs::path& standard_output) {
  const fs::path tool = fs::absolute(MCC_TOOL_GENERATE_SAMPLES).make_preferred();
  std::string command = "\"" + tool.string() + "\" " + option + " \"" + folder.string() +
                        "\" > \"" + standard_output.string() + "\"";
#if defined(_WIN32)
  command = "\"" + command + "\"";  // the shell there removes the outermost quotes
#endif
  return std::system(command.c_str());
}
#endif

TEST(Samples, GeneratorMakesTheCommittedBytes) {
#ifndef MCC_TOOL_GENERATE_SAMPLES
  GTEST_SKIP() << "generate-samples is not part of this build";
#else
  const fs::path committed = MCC_SAMPLES_DIR;
  const fs::path folder = fs::path(testing::TempDir()) / "mcc_samples_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path table = folder / "table.md";
  ASSERT_EQ(generate("", folder, table), 0);
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

TEST(Samples, GeneratorMakesTheCommittedCity) {
#ifndef MCC_TOOL_GENERATE_SAMPLES
  GTEST_SKIP() << "generate-samples is not part of this build";
#else
  const fs::path committed = fs::path(MCC_SAMPLES_DIR) / "city";
  const fs::path folder = fs::path(testing::TempDir()) / "mcc_city_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  ASSERT_EQ(generate("--city", folder / "city", folder / "output.txt"), 0);
  std::set<std::string> expected = filesIn(committed);
  EXPECT_EQ(expected.erase("city.png"), 1u) << "a picture of it, for the README";
  EXPECT_EQ(filesIn(folder / "city"), expected);
  uintmax_t bytes = fs::file_size(committed / "city.png");
  for (const std::string& name : expected) {
    EXPECT_TRUE(contentOf(folder / "city" / name) == contentOf(committed / name))
        << name << " differs";
    bytes += fs::file_size(committed / name);
  }
  EXPECT_LE(bytes, 600000u);
  fs::remove_all(folder);
#endif
}

}  // namespace
}  // namespace mcc::test
