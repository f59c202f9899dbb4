// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// `convert -o DIR`, and "-" for the standard streams.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include "cli/run_tool.h"
#include "json/json.h"
#include "support/gltf_builder.h"
#include "support/made_files.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;
using gltf::Json;

class Batch : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
    fs::create_directory(path("in"));
    for (const auto& entry : fs::directory_iterator(MCC_SAMPLES_DIR)) {
      if (entry.path().extension() != ".glb") continue;
      fs::copy_file(entry.path(), path("in") / entry.path().filename());
      names_.insert(entry.path().filename().string());
    }
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }
  ToolResult run(const std::string& arguments) const { return runTool(folder_, arguments); }

  void store(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
  }

  /// Returns the files of a folder with their contents, without the record.
  std::map<std::string, std::string> filesOf(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(path(name))) {
      const std::string file = entry.path().filename().string();
      if (file != ".gltf-mcc.json") files[file] = contentOf(entry.path());
    }
    return files;
  }

  static size_t countOf(const std::string& text, const std::string& word) {
    size_t count = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      ++count;
    return count;
  }

  /// Checks that `command` over the files of `input` writes the same files for each number of jobs,
  /// to OUTPUT1, OUTPUT2 and so on, that it reports each file and their sum, and that it writes the
  /// same for a file alone.
  void expectSameForAnyJobs(const std::string& command, const std::string& input,
                            const std::string& output, const std::vector<std::string>& job_counts) {
    std::map<std::string, std::string> first;
    for (const std::string& jobs : job_counts) {
      const ToolResult result =
          run(command + " -j " + jobs + " -o " + output + jobs + "/ " + input + "/*.glb");
      EXPECT_EQ(result.status, 0) << result.err;
      EXPECT_EQ(result.err, "");
      EXPECT_EQ(countOf(result.out, ".glb: "), names_.size()) << result.out;
      EXPECT_NE(result.out.find("\n" + command), std::string::npos) << result.out;
      const auto files = filesOf(output + jobs);
      EXPECT_EQ(files.size(), names_.size());
      if (first.empty()) first = files;
      EXPECT_TRUE(files == first) << jobs;
    }
    for (const auto& [name, content] : first) {
      ASSERT_EQ(run(command + " " + input + "/" + name + " one.glb -j 3").status, 0);
      EXPECT_TRUE(contentOf(path("one.glb")) == content) << name;
    }
  }

  ScratchFolder folder_;
  std::set<std::string> names_;
};

TEST_F(Batch, ResultsDoNotDependOnTheThreads) {
  expectSameForAnyJobs("convert", "in", "out", {"1", "2", "4"});
}

/// Payloads are coded, decoded for the check, and compared by several threads.
TEST_F(Batch, OneFileDoesNotDependOnTheThreads) {
  gltf::test::Builder builder;
  for (const uint32_t size : {20u, 31u, 12u, 25u, 16u}) {
    builder.addMesh({gltf::test::Sheet(size, 0.01f * static_cast<float>(size)).addTo(builder)});
  }
  const std::vector<uint8_t> file = builder.toGlb();
  store("many.glb", {file.begin(), file.end()});
  std::map<std::string, std::string> first;
  for (const std::string jobs : {"1", "2", "4"}) {
    ASSERT_EQ(run("convert many.glb a.glb --fallback -j " + jobs).status, 0);
    const ToolResult result = run("convert many.glb b.gltf --format json -j " + jobs);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(Json::parse(result.out)["payloads"].size(), 5u);
    for (const std::string& name :
         {std::string("a.glb"), std::string("b.gltf"),
          madeBeside(folder_.path(), "a", ".fallback.bin"), madeBeside(folder_.path(), "b")}) {
      const std::string content = contentOf(path(name));
      EXPECT_TRUE(first.try_emplace(name, content).first->second == content) << name << " " << jobs;
    }
  }
}

TEST_F(Batch, DecodesAsItConverts) {
  ASSERT_EQ(run("convert -o small/ in/*.glb").status, 0);
  expectSameForAnyJobs("decode", "small", "back", {"1", "3"});
  const ToolResult again = run("decode -o back1 small/*.glb");
  EXPECT_EQ(countOf(again.out, "up to date\n"), names_.size()) << again.out;
  const ToolResult integers = run("decode -o back1 small/*.glb --decode-to integers");
  EXPECT_EQ(countOf(integers.out, "up to date\n"), 0u) << integers.out;
  const ToolResult copies = run("decode -o copies/ in/torus.glb");
  EXPECT_NE(copies.out.find("copied, nothing in it is compressed"), std::string::npos)
      << copies.out;
  store("small/a_damaged.glb", contentOf(path("small/torus.glb")).substr(0, 1000));
  const ToolResult failed = run("decode --force -o back1 small/*.glb");
  EXPECT_EQ(failed.status, 1);
  EXPECT_EQ(failed.err.rfind("gltf-mcc: small/a_damaged.glb: byte 8", 0), 0u) << failed.err;
  EXPECT_TRUE(filesOf("back1").size() == names_.size());
}

TEST_F(Batch, OneFailureDoesNotStopTheRest) {
  std::string damaged = contentOf(path("in/torus.glb"));
  damaged.resize(damaged.size() / 2);
  store("in/a_damaged.glb", damaged);
  store("in/b_empty.glb", "");
  fs::create_symlink("nowhere.glb", path("in/c_dangling.glb"));
  fs::create_directory(path("in/d_folder.glb"));
  const ToolResult result = run("convert -j 2 -o out/ in/*.glb");
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(filesOf("out").size(), names_.size());
  for (const std::string& name : names_) EXPECT_EQ(filesOf("out").count(name), 1u) << name;
  // Expect a line per file, the summary, and the failures in the order of the arguments.
  for (const std::string& name : names_) {
    EXPECT_EQ(countOf(result.out, "] in/" + name + ": "), 1u) << result.out;
  }
  EXPECT_EQ(countOf(result.out, ": failed\n"), 4u) << result.out;
  EXPECT_NE(result.out.find("\nfailed      "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\nall         "), std::string::npos) << result.out;
  EXPECT_EQ(countOf(result.err, "\n"), 4u) << result.err;
  size_t at = 0;
  for (const std::string line :
       {"gltf-mcc: in/a_damaged.glb: byte 8: ", "gltf-mcc: in/b_empty.glb: the file is empty",
        "gltf-mcc: in/c_dangling.glb: there is no such file",
        "gltf-mcc: in/d_folder.glb: is a folder"}) {
    at = result.err.find(line, at);
    EXPECT_NE(at, std::string::npos) << line << "\n" << result.err;
  }
}

TEST_F(Batch, AFolderStandsForItsModels) {
  ASSERT_EQ(run("decode -q in/torus.glb in/B.GLTF").status,
            0);  // after the others in no order but bytes
  fs::rename(path("in/torus.glb"), path("in/C.GLB"));
  fs::create_directories(path("in/deeper.glb"));
  fs::copy_file(path("in/skinned.glb"), path("in/deeper.glb/d.glb"));
  store("in/notes.txt", "no model");
  fs::create_directory(path("empty"));
  std::string order;  // as --format csv lists files: as on the command line
  std::set<std::string> expected = names_;
  expected.erase("torus.glb");
  expected.insert({"B.GLTF", "C.GLB"});
  for (const std::string& name : expected) order += "in/" + name + ",converted,";
  const ToolResult result = run("convert -o out in --format csv");
  EXPECT_EQ(result.status, 0) << result.err;
  std::string found;
  for (size_t at = result.out.find("\nin/"); at != std::string::npos;
       at = result.out.find("\nin/", at + 1)) {
    found += result.out.substr(at + 1, result.out.find(',', result.out.find(',', at) + 1) - at);
  }
  EXPECT_EQ(found, order);
  std::set<std::string> written = expected;
  written.insert(madeBeside(path("out"), "B"));
  for (const auto& [name, content] : filesOf("out")) EXPECT_EQ(written.erase(name), 1u) << name;
  EXPECT_TRUE(written.empty());
  const ToolResult back = run("decode -j 2 -o back out/");
  EXPECT_EQ(back.status, 0) << back.err;
  EXPECT_EQ(countOf(back.out, "] out/"), expected.size()) << back.out;
  // Together with files, and with a folder that has none.
  const ToolResult mixed = run("convert -o mixed in/deeper.glb empty in/C.GLB");
  EXPECT_EQ(mixed.status, 1);
  EXPECT_EQ(filesOf("mixed").size(), 2u);
  EXPECT_EQ(mixed.err, "gltf-mcc: empty: is a folder; name a file in it\n");
  // Into the folder itself.
  const ToolResult onto = run("convert -o in in");
  EXPECT_EQ(onto.status, 2);
  EXPECT_NE(onto.err.find("would be replaced by its output"), std::string::npos) << onto.err;
}

TEST_F(Batch, WhatIsUpToDateIsLeft) {
  ASSERT_EQ(run("convert -o out/ in/*.glb").status, 0);
  const auto before = filesOf("out");
  const auto counted = [&](const std::string& options) {
    const ToolResult result = run("convert -o out " + options + " in/*.glb");
    EXPECT_EQ(result.status, 0) << result.err;
    return names_.size() - countOf(result.out, ": up to date\n");
  };
  EXPECT_EQ(counted(""), 0u);
  EXPECT_EQ(counted("--force"), names_.size());
  EXPECT_EQ(counted("-j 2"), 0u);
  EXPECT_EQ(counted("--position-bits 9"), names_.size());
  EXPECT_EQ(counted("--position-bits 9"), 0u);
  EXPECT_EQ(counted("--block-triangles 500"), names_.size());
  EXPECT_EQ(counted("--block-triangles 500 --allow-larger"), names_.size());
  EXPECT_EQ(counted(""), names_.size());
  EXPECT_TRUE(filesOf("out") == before);

  // The source changed, also to an older one; the output was removed or replaced.
  fs::last_write_time(path("in/torus.glb"),
                      fs::last_write_time(path("in/torus.glb")) - std::chrono::hours(1));
  EXPECT_EQ(counted(""), 1u);
  fs::remove(path("out/sphere.glb"));
  store("out/modes.glb", "else");
  EXPECT_EQ(counted(""), 2u);
  EXPECT_TRUE(filesOf("out") == before);
  EXPECT_EQ(counted(""), 0u);

  // The record may be missing or damaged.
  store("out/.gltf-mcc.json",
        "{\"tool\":\"gltf-mcc "
        "\"}\n{\"file\":\"torus.glb\",\"maker\":1,\"input\":[[1]],\"output\":{}}\n");
  EXPECT_EQ(counted(""), names_.size());
  store("out/.gltf-mcc.json", "[");
  EXPECT_EQ(counted(""), names_.size());
}

TEST_F(Batch, BuffersAndImagesCountForWhatIsUpToDate) {
  fs::create_directories(path("g"));
  ASSERT_EQ(run("decode in/textured.glb g/a.gltf").status, 0);
  Json json = Json::parse(contentOf(path("g/a.gltf")));
  json["images"] = {{{"uri", "a.png"}}};
  store("g/a.gltf", json.dump());
  store("g/a.png", "\x89PNG");
  const auto isUpToDate = [&]() {
    const ToolResult result = run("convert -o out/ g/a.gltf");
    EXPECT_EQ(result.status, 0) << result.err;
    return countOf(result.out, ": up to date\n") == 1;
  };
  EXPECT_FALSE(isUpToDate());
  EXPECT_TRUE(isUpToDate());
  EXPECT_EQ(filesOf("out").size(), 3u);
  store("g/a.png", "\x89PNG, another");
  EXPECT_FALSE(isUpToDate());
  EXPECT_EQ(contentOf(path("out/a.png")), "\x89PNG, another");
  fs::remove(path("out/a.png"));
  EXPECT_FALSE(isUpToDate());
  fs::remove(path("out/" + madeBeside(path("out"), "a")));
  EXPECT_FALSE(isUpToDate());
  EXPECT_TRUE(isUpToDate());
  const std::string buffer = "g/" + madeBeside(path("g"), "a");
  store(buffer, contentOf(path(buffer)) + "more");
  EXPECT_FALSE(isUpToDate());
  EXPECT_TRUE(isUpToDate());
}

TEST_F(Batch, FallbacksCountForWhatIsUpToDate) {
  const std::string command = "convert --fallback -o out/ in/torus.glb";
  ASSERT_EQ(run(command).status, 0);
  EXPECT_EQ(countOf(run(command).out, ": up to date\n"), 1u);
  const std::string fallback = "out/" + madeBeside(path("out"), "torus", ".fallback.bin");
  fs::remove(path(fallback));
  EXPECT_EQ(countOf(run(command).out, ": up to date\n"), 0u);
  EXPECT_TRUE(fs::exists(path(fallback)));
}

TEST_F(Batch, CollisionsAreRefused) {
  fs::create_directory(path("in2"));
  fs::copy_file(path("in/torus.glb"), path("in2/torus.glb"));
  for (const auto& [arguments, message] : std::map<std::string, std::string>{
           {"-o out/ in/sphere.glb in/torus.glb in2/torus.glb",
            "in2/torus.glb: writes \"out/torus.glb\", as \"in/torus.glb\" does; "},
           {"-o in in/torus.glb", "in/torus.glb: would be replaced by its output; "},
           {"-o out/ in/torus.glb -", "standard input cannot be one of several inputs"},
           {"-o out/ --compare draco in/torus.glb", "take one input"},
           {"in/torus.glb in/sphere.glb out", "several inputs need a folder: -o DIR"},
           {"-o out/", "IN is missing"}}) {
    const ToolResult result = run("convert " + arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_NE(result.err.find(message), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_FALSE(fs::exists(path("out"))) << arguments;
  }
  store("file", "");
  EXPECT_EQ(run("convert -o file in/torus.glb in/sphere.glb").status, 1);
  EXPECT_EQ(run("convert -o none/out in/torus.glb in/sphere.glb").status, 1);
}

/// One thread tells about files in the order of the command line, whatever their sizes.
TEST_F(Batch, OneThreadKeepsTheOrder) {
  for (const auto& [first, second] : {std::pair("torus", "sphere"), std::pair("sphere", "torus")}) {
    const ToolResult result =
        run(std::string("convert --force -o out/ in/") + first + ".glb in/" + second + ".glb");
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find(std::string("[1/2] in/") + first), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(std::string("[2/2] in/") + second), std::string::npos) << result.out;
  }
}

TEST_F(Batch, FormatsAndReport) {
  const std::string files = "in/torus.glb in/none.glb in/sphere.glb";
  const ToolResult csv = run("convert -o out/ --format csv --report r.json " + files);
  EXPECT_EQ(csv.status, 1);
  EXPECT_EQ(csv.out.rfind("file,outcome,bytes in,bytes out,ratio\nin/torus.glb,converted,", 0), 0u)
      << csv.out;
  EXPECT_EQ(countOf(csv.out, "\n"), 4u) << csv.out;
  const Json report = Json::parse(contentOf(path("r.json")));
  ASSERT_EQ(report["files"].size(), 3u);
  EXPECT_EQ(report["files"][0]["conversion"]["checked"], true);
  EXPECT_EQ(report["files"][1]["outcome"], "failed");
  EXPECT_EQ(report["files"][1]["message"], "in/none.glb: there is no such file");
  EXPECT_EQ(report["files"][2]["output"], "out/sphere.glb");
  const Json printed = Json::parse(run("convert -o out --format json " + files).out);
  EXPECT_EQ(printed["files"][0]["outcome"], "up to date");
  EXPECT_EQ(printed["files"][0]["output_bytes"], fs::file_size(path("out/torus.glb")));
  EXPECT_EQ(run("convert -o out --format md " + files).out.rfind("| file", 0), 0u);
  const ToolResult quiet = run("convert -q -o out " + files);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, "gltf-mcc: in/none.glb: there is no such file\n");
}

/// Runs the tool with a terminal as standard error, and returns what the terminal got.
std::string runWithTerminal(const ScratchFolder& folder, const std::string& arguments) {
#ifdef MCC_TOOL_GLTF_MCC
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) return "";
  const std::string command = "cd '" + folder.path().string() + "' && '" + MCC_TOOL_GLTF_MCC +
                              "' " + arguments + " >.stdout 2>'" + ::ptsname(terminal) + "'";
  const int other_end = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY);  // keeps the data alive
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  int code = 0;
  ::waitpid(child, &code, 0);
  EXPECT_EQ(code, 0);
  ::close(other_end);  // reading now ends after the data, which may take a moment to arrive
  std::string text;
  char part[4096];
  for (ssize_t count; (count = ::read(terminal, part, sizeof part)) > 0;)
    text.append(part, static_cast<size_t>(count));
  ::close(terminal);
  return text;
#else
  return "";
#endif
}

TEST_F(Batch, ProgressOnATerminalOnly) {
  const std::string files = "in/torus.glb in/sphere.glb";
  const std::string seen = runWithTerminal(folder_, "convert -o out/ " + files);
  EXPECT_NE(seen.find("[############------------] 1 of 2 files"), std::string::npos) << seen;
  EXPECT_TRUE(seen.ends_with("\r\033[K")) << "the bar is left behind";
  EXPECT_EQ(runWithTerminal(folder_, "convert -q -o out/ " + files), "");
  EXPECT_EQ(run("convert -o out2/ " + files).err, "");
}

class Streams : public Batch {};

TEST_F(Streams, StandInForFiles) {
  ASSERT_EQ(run("convert in/textured.glb small.glb").status, 0);
  const ToolResult decoded = run("decode small.glb back.glb");
  ASSERT_EQ(decoded.status, 0);
  EXPECT_NE(decoded.out.find("\n1 primitive of 1 payload decoded: "), std::string::npos);
#ifdef MCC_TOOL_GLTF_MCC
  const std::string tool = std::string("'") + MCC_TOOL_GLTF_MCC + "' ";
  for (const std::string& command :
       {"cat in/textured.glb | " + tool + "convert - - --report r.json > a.glb",
        tool + "convert in/textured.glb - -v > a.glb",
        tool + "convert - a.glb -q < in/textured.glb",
        tool + "convert -i - -o - < in/textured.glb | cat > a.glb"}) {
    fs::remove(path("a.glb"));
    const ToolResult result = runCommand(folder_, "( " + command + " )");
    EXPECT_EQ(result.status, 0) << command << result.err;
    EXPECT_TRUE(contentOf(path("a.glb")) == contentOf(path("small.glb"))) << command;
  }
  EXPECT_EQ(Json::parse(contentOf(path("r.json")))["input"], "-");
  const ToolResult decode = runCommand(folder_, "( " + tool + "decode - - < small.glb > b.glb )");
  EXPECT_EQ(decode.status, 0) << decode.err;
  EXPECT_TRUE(contentOf(path("b.glb")) == contentOf(path("back.glb")));
  const ToolResult bad = runCommand(folder_, "( echo nothing | " + tool + "convert - - )");
  EXPECT_EQ(bad.status, 1);
  EXPECT_EQ(bad.out, "");
  EXPECT_EQ(bad.err,
            "gltf-mcc: standard input: byte 0: this is not a glTF file: neither a GLB nor JSON\n");
  const ToolResult inspect = runCommand(folder_, "( " + tool + "inspect - < small.glb )");
  EXPECT_EQ(inspect.status, 0) << inspect.err;
  EXPECT_EQ("small.glb" + inspect.out.substr(std::min<size_t>(1, inspect.out.size())),
            run("inspect small.glb").out);
  EXPECT_EQ(runCommand(folder_, "( echo nothing | " + tool + "inspect - )").err, bad.err);
  // Nobody reads the output: this must be reported as an error.
  const ToolResult full =
      runCommand(folder_, "( " + tool + "convert in/textured.glb - > /dev/full )");
  EXPECT_EQ(full.status, 1);
  EXPECT_EQ(full.err, "gltf-mcc: standard output: cannot be written\n");
#endif
}

/// A pipe such as <(command) of a shell can be read only once.
TEST_F(Streams, PipesAreRead) {
#ifdef MCC_TOOL_GLTF_MCC
  ASSERT_EQ(run("convert -q in/torus.glb out.glb").status, 0);
  for (const char* command : {"convert -q --compare draco", "decode -q"}) {
    const std::string input = command[0] == 'c' ? "in/torus.glb" : "out.glb";
    ASSERT_EQ(run(std::string(command) + " " + input + " a.glb").status, 0);
    const ToolResult piped =
        runCommand(folder_, "mkfifo pipe && { cat " + input + " > pipe & '" + MCC_TOOL_GLTF_MCC +
                                "' " + command + " pipe b.glb; }");
    EXPECT_EQ(piped.status, 0) << piped.err;
    EXPECT_TRUE(contentOf(path("a.glb")) == contentOf(path("b.glb"))) << command;
    fs::remove(path("pipe"));
  }
#endif
}

TEST_F(Streams, BuffersMustBeInside) {
  ASSERT_EQ(run("decode in/torus.glb a.gltf").status, 0);
#ifdef MCC_TOOL_GLTF_MCC
  const ToolResult result =
      runCommand(folder_, std::string("( '") + MCC_TOOL_GLTF_MCC + "' convert - b.glb < a.gltf )");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("standard input: /buffers/0/uri: the file \"a."), std::string::npos)
      << result.err;
#endif
}

TEST_F(Batch, WholeFileSizes) {
  const Json json = Json::parse(run("convert in/textured.glb out.glb --format json").out);
  const Json& files = json["files"];
  EXPECT_EQ(files["input"]["bytes"], fs::file_size(path("in/textured.glb")));
  EXPECT_EQ(files["output"]["bytes"], fs::file_size(path("out.glb")));
  for (const char* name : {"input", "output"}) {
    EXPECT_GT(files[name]["brotli_bytes"], 100) << name;
    EXPECT_LE(files[name]["brotli_bytes"], files[name]["bytes"].get<uint64_t>() + 64) << name;
  }
#if defined(MCC_HAS_FOREIGN)
  ASSERT_EQ(run("convert in/textured.glb out.glb --emit-draco draco.glb").status, 0);
  EXPECT_EQ(files["draco"]["bytes"], fs::file_size(path("draco.glb")));
#endif
  const std::string text = run("convert -v in/textured.glb out.glb").out;
  EXPECT_NE(text.find("whole file"), std::string::npos) << text;
  EXPECT_NE(text.find("after brotli 5"), std::string::npos) << text;
  const std::string csv = run("convert in/textured.glb out.glb --format csv").out;
  EXPECT_NE(csv.find("\noutput file after brotli,"), std::string::npos) << csv;
  // Convert in place, and with files next to the model.
  const auto size = fs::file_size(path("in/textured.glb"));
  const Json in_place =
      Json::parse(run("convert --in-place in/textured.glb in/textured.glb --format json").out);
  EXPECT_EQ(in_place["files"]["input"]["bytes"], size);
  const Json gltf = Json::parse(run("convert in/torus.glb o.gltf --format json").out);
  EXPECT_EQ(gltf["files"]["output"]["bytes"],
            fs::file_size(path("o.gltf")) + fs::file_size(path(madeBeside(folder_.path(), "o"))));
  EXPECT_EQ(gltf["output_bytes"], gltf["files"]["output"]["bytes"]);
}

TEST_F(Batch, HelpIsShort) {
  for (const std::string command : {"", "convert", "decode", "inspect", "compare", "bench"}) {
    const ToolResult result = run(command + " --help");
    if (result.status != 0) continue;  // not part of this build
    EXPECT_EQ(result.out.find("Excludes"), std::string::npos) << result.out;
    EXPECT_EQ(result.out.find("REQUIRED"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("Usage: gltf-mcc "), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("\nExamples:\n  gltf-mcc "), std::string::npos) << result.out;
    EXPECT_LE(countOf(result.out, "\n"), 60u) << command;
    size_t begin = 0;
    while (begin < result.out.size()) {
      const size_t end = std::min(result.out.find('\n', begin), result.out.size());
      EXPECT_LE(end - begin, 100u) << result.out.substr(begin, end - begin);
      begin = end + 1;
    }
  }
}

}  // namespace
}  // namespace mcc::test
