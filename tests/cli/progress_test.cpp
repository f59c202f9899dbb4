// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a terminal shows during long work, and that nothing else gets to see it. The work lasts
// until the test has seen what it waits for: the buffer of the document is a pipe, into which the
// test writes only then.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <regex>
#include <thread>
#include <vector>

#include "cli/run_tool.h"
#include "support/gltf_builder.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

/// Much longer than anything the test waits for; after that it fails.
constexpr std::chrono::seconds kPatience(60);

class Deadline {
 public:
  bool isOver() const { return std::chrono::steady_clock::now() - begin_ > kPatience; }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Runs the tool in a folder of its own with waiting.glb, a pipe whose bytes it must wait for.
class WaitingTool {
 public:
  enum class Errors : uint8_t { kTerminal, kPipe };

  WaitingTool(const std::vector<std::string>& arguments, Errors errors) {
    writeDocument();
    int ends[2] = {-1, -1};
    if (errors == Errors::kPipe) {
      if (pipe2(ends, O_CLOEXEC) != 0) return;
    } else {
      ends[0] = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
      if (ends[0] < 0 || grantpt(ends[0]) != 0 || unlockpt(ends[0]) != 0) return;
      ends[1] = open(ptsname(ends[0]), O_RDWR | O_NOCTTY | O_CLOEXEC);
    }
    errors_ = ends[0];
    child_ = fork();
    if (child_ == 0) run(arguments, ends[1]);
    close(ends[1]);
  }

  ~WaitingTool() {
    if (child_ > 0) {  // the test failed
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
    if (errors_ >= 0) close(errors_);
  }
  WaitingTool(const WaitingTool&) = delete;
  WaitingTool& operator=(const WaitingTool&) = delete;

  /// Waits until the input is being read, or the program ends.
  bool waitsForInput() {
    const Deadline deadline;
    while (!deadline.isOver() && !hasEnded()) {
      input_ = open(path("waiting.glb").c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      if (input_ >= 0) return true;  // there is a reader
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  /// Waits until this text was shown.
  bool shows(const std::regex& text) {
    const Deadline deadline;
    while (!deadline.isOver() && !std::regex_search(shown_, text)) {
      if (!readSome()) return false;
    }
    return std::regex_search(shown_, text);
  }

  /// Writes what the tool waits for, reads the rest of what it shows, and returns its exit status.
  int finish() {
    fcntl(input_, F_SETFL, 0);
    const bool is_written =
        write(input_, bytes_.data(), bytes_.size()) == static_cast<ssize_t>(bytes_.size());
    close(input_);
    EXPECT_TRUE(is_written);
    const Deadline deadline;
    while (!deadline.isOver() && readSome()) {
    }
    int code = 0;
    waitpid(child_, &code, 0);
    child_ = -1;
    return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
  }

  const std::string& shown() const { return shown_; }
  fs::path path(const std::string& name) const { return folder_.path() / name; }

 private:
  void writeDocument() {
    gltf::test::Builder builder;
    builder.addMesh({gltf::test::Sheet(12).addTo(builder)});
    bytes_ = builder.toGlb();
    EXPECT_EQ(mkfifo(path("waiting.glb").c_str(), 0600), 0);
  }

  [[noreturn]] void run(const std::vector<std::string>& arguments, int errors) const {
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(path("stdout").c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(errors, STDERR_FILENO);
    becomeTool(folder_, arguments);
  }

  bool hasEnded() const {
    siginfo_t ended = {};
    waitid(P_PID, static_cast<id_t>(child_), &ended, WEXITED | WNOHANG | WNOWAIT);
    return ended.si_pid != 0;
  }

  /// Returns false when the other end is closed. May return without having read anything.
  bool readSome() {
    pollfd ready = {errors_, POLLIN, 0};
    if (poll(&ready, 1, 1000) <= 0) return true;
    char text[4096];
    const ssize_t count = read(errors_, text, sizeof(text));
    if (count > 0) shown_.append(text, static_cast<size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
  }

  ScratchFolder folder_;
  std::vector<uint8_t> bytes_;
  std::string shown_;
  pid_t child_ = -1;
  int errors_ = -1;
  int input_ = -1;
};

using Errors = WaitingTool::Errors;

struct Work {
  std::vector<std::string> arguments;
  const char* shown;  ///< the text before the seconds
};

/// All commands that show how long they take.
std::vector<Work> longWork() {
  return {{{"convert", "waiting.glb", "-"}, "waiting.glb: reading"},
          {{"decode", "waiting.glb", "out.glb"}, "decoding waiting.glb"},
          {{"inspect", "waiting.glb"}, "reading waiting.glb"}};
}

class Progress : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
  }
};

/// The line begins at the left, is replaced by the next one, and is cleared at the end.
TEST_F(Progress, IsShownOnATerminal) {
  for (const Work& work : longWork()) {
    SCOPED_TRACE(work.shown);
    WaitingTool tool(work.arguments, Errors::kTerminal);
    ASSERT_TRUE(tool.waitsForInput());
    std::string lines = "^(\r\033\\[K";
    lines += work.shown;
    lines += ", [1-9][0-9]* s){2}";
    EXPECT_TRUE(tool.shows(std::regex(lines))) << tool.shown();
    EXPECT_EQ(tool.finish(), 0);
    EXPECT_TRUE(std::regex_search(tool.shown(), std::regex("s\r\033\\[K$"))) << tool.shown();
    EXPECT_EQ(tool.shown().find('\n'), std::string::npos) << tool.shown();
  }
}

/// The quiet ones work for longer than the one that shows it.
TEST_F(Progress, IsForTerminalsAloneAndNotForQuietOnes) {
  for (const Work& work : longWork()) {
    SCOPED_TRACE(work.shown);
    WaitingTool no_terminal(work.arguments, Errors::kPipe);
    ASSERT_TRUE(no_terminal.waitsForInput());
    std::vector<std::string> arguments = work.arguments;
    const bool has_quiet = arguments[0] != "inspect";
    if (has_quiet) arguments.push_back("--quiet");
    WaitingTool quiet(arguments, has_quiet ? Errors::kTerminal : Errors::kPipe);
    ASSERT_TRUE(quiet.waitsForInput());
    WaitingTool tool(work.arguments, Errors::kTerminal);
    ASSERT_TRUE(tool.waitsForInput());
    EXPECT_TRUE(tool.shows(std::regex(" s\r"))) << "once, and once more";
    EXPECT_EQ(tool.finish(), 0);
    EXPECT_EQ(no_terminal.finish(), 0);
    EXPECT_EQ(no_terminal.shown(), "");
    EXPECT_EQ(quiet.finish(), 0);
    EXPECT_EQ(quiet.shown(), "");
  }
}

/// With many files the bar is shown from the first finished one on, however long it takes.
TEST_F(Progress, OfManyFilesIsABar) {
  const std::string sample = std::string(MCC_SAMPLES_DIR) + "/torus.glb";
  const std::vector<std::string> arguments = {"convert", "-o", "out", sample, "waiting.glb"};
  WaitingTool tool(arguments, Errors::kTerminal);
  ASSERT_TRUE(tool.waitsForInput());
  EXPECT_TRUE(tool.shows(std::regex("\r\033\\[K\\[#+-+\\] 1 of 2 files"))) << tool.shown();
  EXPECT_EQ(tool.finish(), 0);
  EXPECT_TRUE(tool.shown().ends_with("\r\033[K")) << tool.shown();
  WaitingTool no_terminal(arguments, Errors::kPipe);
  ASSERT_TRUE(no_terminal.waitsForInput());
  EXPECT_EQ(no_terminal.finish(), 0);
  EXPECT_EQ(no_terminal.shown(), "");
}

}  // namespace
}  // namespace mcc::test
