// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs the tool for tests that look at its output.
#ifndef MCC_TESTS_CLI_RUN_TOOL_H_
#define MCC_TESTS_CLI_RUN_TOOL_H_

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace mcc::test {

/// A folder that is gone after the test.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "gltf-mcc-XXXXXX").string();
    if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct ToolResult {
  int status = -1;
  std::string out;
  std::string err;
};

inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs a command of the shell in a folder.
inline ToolResult runCommand(const ScratchFolder& folder, const std::string& command) {
  const std::string line =
      "cd '" + folder.path().string() + "' && " + command + " >.stdout 2>.stderr </dev/null";
  const int code = std::system(line.c_str());
  return {WIFEXITED(code) ? WEXITSTATUS(code) : -1, contentOf(folder.path() / ".stdout"),
          contentOf(folder.path() / ".stderr")};
}

/// Runs the tool; arguments are shell words.
inline ToolResult runTool(const ScratchFolder& folder, const std::string& arguments) {
#ifdef MCC_TOOL_GLTF_MCC
  return runCommand(folder, std::string("'") + MCC_TOOL_GLTF_MCC + "' " + arguments);
#else
  return {};
#endif
}

inline std::string samplePath(const std::string& name) {
  return std::string("'") + MCC_SAMPLES_DIR + "/" + name + "'";
}

}  // namespace mcc::test

/// For the commands that need the other codecs.
#if defined(MCC_TOOL_GLTF_MCC) && defined(MCC_HAS_FOREIGN)
#define MCC_REQUIRE_COMPARISON() (void)0
#else
#define MCC_REQUIRE_COMPARISON() GTEST_SKIP() << "this build has no comparison"
#endif

#endif  // MCC_TESTS_CLI_RUN_TOOL_H_
