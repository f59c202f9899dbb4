// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Ctrl-C and other signals: the program ends by the signal, and leaves nothing new behind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <set>
#include <thread>
#include <vector>

#include "cli/run_tool.h"
#include "support/gltf_builder.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class Interrupt : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// Starts the tool in the folder. `before` runs in the new process.
  pid_t start(const std::vector<std::string>& arguments, void (*before)() = nullptr) const {
    const pid_t child = fork();
    if (child != 0) return child;
    const rlimit no_core = {0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
    if (before != nullptr) before();
    becomeTool(folder_, arguments);
  }

  /// Returns the number of the signal that ended the process, or 0 when it ended by itself, with
  /// `status`.
  static int signalOf(pid_t child, int& status) {
    int code = 0;
    waitpid(child, &code, 0);
    status = WIFEXITED(code) ? WEXITSTATUS(code) : -1;
    return WIFSIGNALED(code) ? WTERMSIG(code) : 0;
  }

  /// Returns the names of everything in the folder and below.
  std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      found.insert(entry.path().lexically_relative(folder_.path()).string());
    }
    return found;
  }

  bool hasTemporary() const {
    for (const std::string& name : names()) {
      if (name.find(".tmp-") != std::string::npos) return true;
    }
    return false;
  }

  /// Interrupts a conversion of in.glb while there is a temporary file.
  void expectRemovedBy(int signal_number) const {
    bool was_there = false;
    for (int attempt = 0; attempt < 20 && !was_there; ++attempt) {
      const pid_t child =
          start({"convert", "in.glb", "out.glb", "--fallback", "--compare", "none"});
      siginfo_t ended = {};
      while (!hasTemporary() && ended.si_pid == 0) {
        waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      kill(child, SIGSTOP);  // it may have finished already
      was_there = hasTemporary() && contentOf(path("out.glb")) == "older";
      kill(child, signal_number);
      kill(child, SIGCONT);
      int status = 0;
      const int number = signalOf(child, status);
      EXPECT_FALSE(hasTemporary());
      was_there = was_there && number != 0;
      if (number != 0) {
        EXPECT_EQ(number, signal_number);
      }
      if (was_there) continue;
      // It had replaced the output already, or even finished.
      std::ofstream(path("out.glb")) << "older";
      for (const std::string& name : names()) {
        if (name.ends_with(".fallback.bin")) fs::remove(path(name));
      }
    }
    EXPECT_TRUE(was_there);
    EXPECT_EQ(contentOf(path("out.glb")), "older");
    EXPECT_EQ(names(), (std::set<std::string>{"in.glb", "out.glb"}));
  }

  ScratchFolder folder_;
};

/// The signal comes while the input is read from a pipe that nobody writes to.
TEST_F(Interrupt, EndsBySignalWhileItWaits) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  std::vector<int> numbers = {SIGINT,  SIGTERM, SIGHUP,    SIGQUIT, SIGALRM, SIGUSR1,
                              SIGUSR2, SIGPROF, SIGVTALRM, SIGXCPU, SIGXFSZ, SIGPIPE};
  // Sanitizers have handlers of their own for faults.
  if (!MCC_IS_SANITIZED) numbers.insert(numbers.end(), {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL});
  numbers.insert(numbers.end(), {SIGSYS, SIGTRAP, SIGRTMIN, SIGRTMAX});
  for (const int number : numbers) {
    const pid_t child = start({"convert", "pipe", "out.glb", "--report", "report.json"});
    const int writer = open(path("pipe").c_str(), O_WRONLY);  // returns when the tool reads
    ASSERT_GE(writer, 0);
    kill(child, number);
    int status = 0;
    EXPECT_EQ(signalOf(child, status), number) << status;
    close(writer);
    EXPECT_EQ(names(), (std::set<std::string>{"pipe"}));
  }
}

TEST_F(Interrupt, WhatIsIgnoredStaysIgnored) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const pid_t child = start({"convert", "pipe", "out.glb"}, []() { signal(SIGINT, SIG_IGN); });
  const int writer = open(path("pipe").c_str(), O_WRONLY);
  ASSERT_GE(writer, 0);
  kill(child, SIGINT);
  close(writer);  // the tool reads an empty file
  int status = 0;
  EXPECT_EQ(signalOf(child, status), 0);
  EXPECT_EQ(status, 1);
}

/// The signal comes while a temporary file is written, which may not become as large as the result.
TEST_F(Interrupt, AFileThatIsTooLargeLeavesNothing) {
  std::ofstream(path("out.glb")) << "older";
  const std::string sample = std::string(MCC_SAMPLES_DIR) + "/torus.glb";
  for (const std::string output : {"out.glb", "new.glb", "new.gltf"}) {
    const pid_t child = start({"convert", sample, output, "--lossless"}, []() {
      const rlimit few = {512, 512};
      setrlimit(RLIMIT_FSIZE, &few);
    });
    int status = 0;
    EXPECT_EQ(signalOf(child, status), SIGXFSZ) << status;
    EXPECT_EQ(names(), (std::set<std::string>{"out.glb"}));
  }
  EXPECT_EQ(contentOf(path("out.glb")), "older");
}

/// Closes the reading end early, as `| head` does.
TEST_F(Interrupt, NobodyReadsStandardOutput) {
  const std::string sample = std::string(MCC_SAMPLES_DIR) + "/torus.glb";
  for (const char* command : {"convert", "decode"}) {
    const pid_t child = start({command, sample, "-"}, []() {
      int ends[2];
      if (pipe(ends) != 0) _exit(1);
      close(ends[0]);
      dup2(ends[1], 1);
    });
    int status = 0;
    EXPECT_EQ(signalOf(child, status), SIGPIPE) << status;
    EXPECT_EQ(names(), (std::set<std::string>{}));
  }
  const ToolResult piped =
      runCommand(folder_, std::string("'") + MCC_TOOL_GLTF_MCC + "' convert '" + sample +
                              "' - --lossless | head -c 4");
  EXPECT_EQ(piped.out, "glTF");
  EXPECT_EQ(piped.err, "");
}

/// The signal comes while the result, which has a temporary name, is checked.
TEST_F(Interrupt, TemporaryFilesAreRemoved) {
  gltf::test::Builder builder;
  for (uint32_t i = 0; i < 12; ++i) {
    builder.addMesh({gltf::test::Sheet(200, 0.01f * static_cast<float>(i + 1)).addTo(builder)});
  }
  const std::vector<uint8_t> file = builder.toGlb();
  std::ofstream(path("in.glb"), std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  std::ofstream(path("out.glb")) << "older";
  for (const int signal_number : {SIGTERM, SIGUSR1, MCC_IS_SANITIZED ? SIGALRM : SIGSEGV}) {
    expectRemovedBy(signal_number);
  }
}

#ifdef MCC_FAULTS
/// The signal comes while the files get their names together. They do so, also where the thread
/// that is at it is the one that receives the signal.
TEST_F(Interrupt, WhatHasBegunIsFinished) {
  ASSERT_EQ(
      runTool(folder_, "convert -q --fallback " + samplePath("torus.glb") + " out.glb").status, 0);
  const std::set<std::string> finished = names();
  for (const int signal_number : {SIGTERM, SIGUSR1, SIGSEGV, SIGPIPE}) {
    for (const std::string& name : finished) fs::remove(path(name));
    const std::string sample = std::string(MCC_SAMPLES_DIR) + "/torus.glb";
    const pid_t child = start({"convert", sample, "out.glb", "--fallback"}, []() {
      setenv("LD_PRELOAD", MCC_FAULTS, 1);
      setenv("MCC_FAULT", "stop:1:0", 1);
    });
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, WUNTRACED), child);
    ASSERT_TRUE(WIFSTOPPED(status));
    EXPECT_TRUE(hasTemporary());
    kill(child, signal_number);
    kill(child, SIGCONT);
    EXPECT_EQ(signalOf(child, status), signal_number) << status;
    std::set<std::string> left = names();
    for (const std::string stream : {".stdout", ".stderr"}) left.insert(stream);
    EXPECT_EQ(left, finished);
  }
}
#endif

}  // namespace
}  // namespace mcc::test
