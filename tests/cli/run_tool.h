// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs the tool for tests that look at its output.
#ifndef MCC_TESTS_CLI_RUN_TOOL_H_
#define MCC_TESTS_CLI_RUN_TOOL_H_

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace mcc::test {

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
      "cd '" + folder.path().string() + "' && { " + command + "; } >.stdout 2>.stderr </dev/null";
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

/// Replaces the calling process by the tool, in a folder; arguments are passed as they are. Exits
/// with status 127 on failure.
[[noreturn]] inline void becomeTool([[maybe_unused]] const ScratchFolder& folder,
                                    [[maybe_unused]] const std::vector<std::string>& arguments) {
#ifdef MCC_TOOL_GLTF_MCC
  std::string program = MCC_TOOL_GLTF_MCC;
  std::vector<char*> words = {program.data()};
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  if (chdir(folder.path().c_str()) == 0) execv(program.c_str(), words.data());
#endif
  _exit(127);
}

/// Runs the tool and returns the most memory it took, in MB.
inline double memoryOf(const ScratchFolder& folder, const std::vector<std::string>& arguments) {
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int stream : {0, 1}) dup2(nowhere, stream);
    becomeTool(folder, arguments);
  }
  int code = 0;
  struct rusage usage = {};
  wait4(child, &code, 0, &usage);
  EXPECT_TRUE(WIFEXITED(code) && WEXITSTATUS(code) == 0);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

inline std::string samplePath(const std::string& name) {
  return std::string("'") + MCC_SAMPLES_DIR + "/" + name + "'";
}

}  // namespace mcc::test

/// For the commands that need other codecs.
#if defined(MCC_TOOL_GLTF_MCC) && defined(MCC_HAS_FOREIGN)
#define MCC_REQUIRE_COMPARISON() (void)0
#else
#define MCC_REQUIRE_COMPARISON() GTEST_SKIP() << "this build has no comparison"
#endif

#endif  // MCC_TESTS_CLI_RUN_TOOL_H_
