// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Disks that are full or broken: every call that stores something fails once (tests/cli/faults.c).
// Nothing may be reported as stored that is not, and no good file may be lost.
#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <map>

#include "cli/run_tool.h"
#include "support/made_files.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

using Contents = std::map<std::string, std::string>;

class Faults : public testing::Test {
 protected:
  void SetUp() override {
#if !defined(MCC_TOOL_GLTF_MCC) || !defined(MCC_FAULTS)
    GTEST_SKIP() << "the tool is not part of this build, or no library can be put before it";
#else
    fs::copy_file(fs::path(MCC_SAMPLES_DIR) / "torus.glb", path("in.glb"));
    ASSERT_EQ(runTool(folder_, "convert -q in.glb small.glb").status, 0);
#endif
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }
  void store(const std::string& name, const std::string& content) const {
    fs::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << content;
  }
  bool wasHit() const { return fs::exists(path(".hit")); }

  /// Runs the tool with a fault, such as "fsync:1:28".
  ToolResult runWith([[maybe_unused]] const std::string& fault,
                     [[maybe_unused]] const std::string& arguments) const {
#if defined(MCC_TOOL_GLTF_MCC) && defined(MCC_FAULTS)
    fs::remove(path(".hit"));
    return runCommand(folder_, "MCC_FAULT=" + fault + " MCC_FAULT_HIT=.hit LD_PRELOAD='" +
                                   MCC_FAULTS + "' '" + MCC_TOOL_GLTF_MCC + "' " + arguments);
#else
    return {};
#endif
  }

  /// Returns the contents of files; those that are not there are left out.
  Contents contentsOf(const std::vector<std::string>& names) const {
    Contents files;
    for (const std::string& name : names) {
      if (fs::exists(path(name))) files[name] = contentOf(path(name));
    }
    return files;
  }
  void restore(const std::vector<std::string>& names, const Contents& old) const {
    for (const std::string& name : names) fs::remove(path(name));
    for (const auto& [name, content] : old) store(name, content);
  }

  void expectNoTemporaries() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      EXPECT_EQ(entry.path().filename().string().find(".tmp-"), std::string::npos) << entry.path();
    }
  }

  /// Lets each call of each kind fail, one per run, while a command replaces `old` files. Success
  /// means that all are new; failure says why, and leaves each file old or new, all alike if
  /// `together`.
  void expectSafe(const std::string& arguments, const std::vector<std::string>& names,
                  const Contents& old, bool together) const {
    restore(names, old);
    ASSERT_EQ(runTool(folder_, arguments).status, 0) << arguments;
    const Contents made = contentsOf(names);
    ASSERT_EQ(made.size(), names.size()) << arguments;
    size_t fault_count = 0;
    for (const std::string kind : {"open", "write", "short", "fsync", "close", "rename", "link"}) {
      for (int number = 1; number < 100; ++number) {
        restore(names, old);
        const std::string fault =
            kind + ":" + std::to_string(number) + ":" + std::to_string(number % 2 ? ENOSPC : EIO);
        const ToolResult result = runWith(fault, arguments);
        if (!wasHit()) break;
        ++fault_count;
        SCOPED_TRACE(fault + " in " + arguments + ": " + result.err);
        const Contents now = contentsOf(names);
        if (result.status == 0) {
          EXPECT_TRUE(now == made);
        } else {
          EXPECT_EQ(result.status, 1);
          EXPECT_NE(result.err.find("gltf-mcc: "), std::string::npos);
        }
        EXPECT_TRUE(kind != "short" || result.status == 0);
        for (const auto& [name, content] : now) {
          const auto before = old.find(name);
          EXPECT_TRUE(content == made.at(name) ||
                      (before != old.end() && content == before->second))
              << name;
        }
        EXPECT_TRUE(!together || now == old || now == made);
        expectNoTemporaries();
      }
    }
    EXPECT_GE(fault_count, 5u) << arguments;
  }

  ScratchFolder folder_;
};

constexpr char kOldFile[] = "a good file";

/// A file system may find out only when it stores that a disk or a quota is full.
TEST_F(Faults, AFileThatCannotBeStoredReplacesNothing) {
  for (const int failure : {ENOSPC, EDQUOT, EIO, EFBIG}) {
    store("out.glb", kOldFile);
    const ToolResult result =
        runWith("fsync:1:" + std::to_string(failure), "convert -q in.glb out.glb");
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(wasHit());
    EXPECT_EQ(result.err, "gltf-mcc: out.glb: cannot be written: " +
                              std::string(std::strerror(failure)) + "\n");
    EXPECT_EQ(contentOf(path("out.glb")), kOldFile);
    expectNoTemporaries();
  }
}

/// What fsync() says where there is nothing to wait for.
TEST_F(Faults, FileSystemsThatCannotWaitAreWrittenTo) {
  for (const int failure : {EINVAL, ENOTSUP, EROFS}) {
    store("out.glb", kOldFile);
    const ToolResult result =
        runWith("fsync:1:" + std::to_string(failure), "convert -q in.glb out.glb");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(wasHit());
    EXPECT_TRUE(contentOf(path("out.glb")) == contentOf(path("small.glb")));
  }
}

TEST_F(Faults, AFolderThatCannotBeStoredIsReported) {
  store("out.glb", kOldFile);
  const ToolResult result = runWith("fsync:2:" + std::to_string(EIO), "convert -q in.glb out.glb");
  EXPECT_TRUE(wasHit());
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.err,
            "gltf-mcc: out.glb: was replaced, but its folder cannot be stored: Input/output error; "
            "check the disk and write it again\n");
  EXPECT_TRUE(contentOf(path("out.glb")) == contentOf(path("small.glb")));
}

TEST_F(Faults, CallsAreRepeatedThatASignalInterrupted) {
  for (const char* kind : {"write", "fsync"}) {
    store("out.glb", kOldFile);
    const ToolResult result =
        runWith(std::string(kind) + ":1:" + std::to_string(EINTR), "convert -q in.glb out.glb");
    EXPECT_TRUE(wasHit());
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contentOf(path("out.glb")) == contentOf(path("small.glb")));
  }
}

TEST_F(Faults, OneFileIsStoredOrRefused) {
  for (const Contents& old : {Contents{}, Contents{{"out.glb", kOldFile}}}) {
    expectSafe("convert -q in.glb out.glb", {"out.glb"}, old, true);
    expectSafe("decode -q small.glb out.glb", {"out.glb"}, old, true);
  }
  expectSafe("tree small.glb out.svg", {"out.svg"}, {{"out.svg", kOldFile}}, true);
}

/// A .gltf and its buffer belong together, and the old pair goes only when the new one is stored.
TEST_F(Faults, ADocumentAndItsBufferAreStoredOrRefused) {
  const auto pair = [&](const std::string& options) {
    EXPECT_EQ(runTool(folder_, "convert -q in.glb out.gltf " + options).status, 0);
    return contentsOf({"out.gltf", madeBeside(folder_.path(), "out")});
  };
  const Contents made = pair("");
  const Contents old = pair("--lossless");
  size_t fault_count = 0;
  for (const std::string kind : {"open", "write", "short", "fsync", "close", "rename", "link"}) {
    for (int number = 1; number < 100; ++number) {
      for (const Contents* files : {&made, &old}) {
        for (const auto& [name, content] : *files) fs::remove(path(name));
      }
      for (const auto& [name, content] : old) store(name, content);
      const std::string fault =
          kind + ":" + std::to_string(number) + ":" + std::to_string(number % 2 ? ENOSPC : EIO);
      const ToolResult result = runWith(fault, "convert -q in.glb out.gltf");
      if (!wasHit()) break;
      ++fault_count;
      SCOPED_TRACE(fault + ": " + result.err);
      Contents now;
      for (const auto& entry : fs::directory_iterator(folder_.path())) {
        const std::string name = entry.path().filename();
        if (name.starts_with("out.")) now[name] = contentOf(entry.path());
      }
      // The new pair may have the old buffer beside it, as long as a crash could bring its .gltf
      // back.
      Contents both = old;
      for (const auto& [name, content] : made) both[name] = content;
      EXPECT_TRUE(now == made || (result.status == 1 && (now == old || now == both)));
      EXPECT_TRUE(result.status == 0 || result.err.find("gltf-mcc: ") != std::string::npos);
      EXPECT_TRUE(kind != "short" || result.status == 0);
      expectNoTemporaries();
    }
  }
  EXPECT_GE(fault_count, 8u);
}

TEST_F(Faults, ReportsAreStoredOrRefused) {
  // The report has times in it, so it is only known to be whole.
  store("out.glb", kOldFile);
  for (const std::string kind : {"write", "fsync", "close", "rename", "open"}) {
    for (int number = 1; number < 20; ++number) {
      store("r.json", kOldFile);
      const ToolResult result = runWith(kind + ":" + std::to_string(number) + ":28",
                                        "convert -q in.glb out.glb --report r.json");
      if (!wasHit()) break;
      const std::string report = contentOf(path("r.json"));
      const bool is_old = report == kOldFile;
      EXPECT_TRUE(is_old || report.ends_with("}\n")) << kind << number << report;
      EXPECT_TRUE(!is_old || result.status == 1) << kind << number << result.err;
    }
  }
}

TEST_F(Faults, ABatchIsStoredOrRefused) {
  fs::copy_file(path("in.glb"), path("other.glb"));
  const std::vector<std::string> names = {"many/in.glb", "many/other.glb"};
  expectSafe("convert -q --force -j 1 -o many in.glb other.glb", names,
             {{"many/in.glb", kOldFile}, {"many/other.glb", kOldFile}}, false);
  // A record that could not be written costs the next run its time, but no file.
  store("many/.gltf-mcc.json", "{}");
  restore(names, {});
  const ToolResult again = runTool(folder_, "convert -o many in.glb other.glb");
  EXPECT_EQ(again.status, 0) << again.err;
}

TEST_F(Faults, TilesAreStoredOrRefused) {
  store("city/tileset.json",
        R"({"asset":{"version":"1.1"},"geometricError":1,"root":{"refine":"REPLACE",)"
        R"("boundingVolume":{"sphere":[0,0,0,9]},"geometricError":0,"content":{"uri":"a.glb"}}})");
  fs::copy_file(path("in.glb"), path("city/a.glb"));
  const std::vector<std::string> names = {"small/a.glb", "small/tileset.json"};
  const std::vector<std::string> with_record = {names[0], names[1], "small/.gltf-mcc-tiles.jsonl"};
  ASSERT_EQ(runTool(folder_, "tiles -q city/tileset.json small").status, 0);
  const Contents made = contentsOf(names);
  ASSERT_EQ(made.size(), 2u);
  for (const std::string kind : {"open", "write", "fsync", "close", "rename", "link"}) {
    for (int number = 1; number < 100; ++number) {
      restore(with_record, {});
      const std::string fault = kind + ":" + std::to_string(number) + ":28";
      const ToolResult result = runWith(fault, "tiles -q -j 1 city/tileset.json small");
      if (!wasHit()) break;
      SCOPED_TRACE(fault + ": " + result.err);
      EXPECT_EQ(result.status == 0, result.err.empty());
      // A tile that cannot be converted is copied, so that the tileset stays whole.
      const std::string source = contentOf(path("in.glb"));
      for (const auto& [name, content] : contentsOf(names))
        EXPECT_TRUE(content == made.at(name) || (result.status == 1 && content == source)) << name;
      if (result.status != 0) {  // the same command completes what is missing
        ASSERT_EQ(runTool(folder_, "tiles -q city/tileset.json small").status, 0);
      }
      EXPECT_TRUE(contentsOf(names) == made);
      // A record is complete, or the run has said that it is not.
      if (result.status == 0) {
        EXPECT_NE(contentOf(path(with_record[2])).find("\"maker\""), std::string::npos);
      }
    }
  }
}

/// Everything on standard output is checked, whatever command prints it.
TEST_F(Faults, StandardOutputIsChecked) {
#ifdef MCC_TOOL_GLTF_MCC
  const std::string tool = std::string("'") + MCC_TOOL_GLTF_MCC + "' ";
  for (const char* arguments :
       {"--help", "--version", "convert --help", "tiles --help", "help", "help decode",
        "completion bash", "completion zsh", "man", "inspect small.glb",
        "inspect small.glb --format json", "validate small.glb", "validate small.glb --format json",
        "convert in.glb out.glb --compare none", "decode small.glb out.glb", "convert -q in.glb -",
        "decode -q small.glb -", "tree small.glb -", "tree small.glb out.svg"}) {
    const ToolResult whole = runCommand(folder_, "( " + tool + arguments + " )");
    EXPECT_EQ(whole.status, 0) << arguments << whole.err;
    EXPECT_FALSE(whole.out.empty()) << arguments;
    for (const char* to : {"> /dev/full", ">&-"}) {
      const ToolResult result = runCommand(folder_, "( " + tool + arguments + " " + to + " )");
      EXPECT_EQ(result.status, 1) << arguments << to;
      EXPECT_EQ(result.err, "gltf-mcc: standard output: cannot be written\n") << arguments << to;
    }
    // A file system may find out only at the end.
    const std::string late = "close:1:" + std::to_string(EDQUOT);
    if (std::string(arguments) == "--help") {
      EXPECT_EQ(runWith(late, arguments).status, 1) << arguments;
    }
  }
#endif
}

}  // namespace
}  // namespace mcc::test
