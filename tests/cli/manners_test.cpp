// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What users meet on a terminal: help, versions, suggestions, colours, the man page, completions.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "cli/run_tool.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class Manners : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#else
    tool_ = MCC_TOOL_GLTF_MCC;
    fs::copy_file(fs::path(MCC_SAMPLES_DIR) / "torus.glb", folder_.path() / "torus.glb");
#endif
  }

  ToolResult run(const std::string& arguments) const { return runTool(folder_, arguments); }

  /// Runs bash with this script; $tool is the program.
  ToolResult bash(const std::string& script) const { return shell("bash", script); }
  ToolResult shell(const std::string& shell, const std::string& script) const {
    std::ofstream(folder_.path() / "script") << script;
    return runCommand(folder_, "tool='" + tool_ + "' " + shell + " script");
  }
  bool has(const std::string& command) const {
    return runCommand(folder_, "command -v " + command).status == 0;
  }

  void expectUsageError(const std::string& arguments, const std::string& message) const {
    const ToolResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("gltf-mcc: " + message + "\n"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("--help\"."), std::string::npos) << result.err;
  }

  /// The first words of the lines of one section of a help text.
  static std::vector<std::string> wordsBelow(const std::string& help, const std::string& heading) {
    std::vector<std::string> words;
    size_t at = help.find("\n" + heading + ":\n");
    if (at == std::string::npos) return words;
    at += heading.size() + 3;
    while (help.compare(at, 2, "  ") == 0) {
      const size_t begin = at + 2;
      const size_t end = help.find_first_of(" \n", begin);
      if (help[begin] != ' ') words.push_back(help.substr(begin, end - begin));
      at = help.find('\n', at) + 1;
    }
    return words;
  }

  std::vector<std::string> commands() const { return wordsBelow(run("--help").out, "Commands"); }

  /// Returns the names of the options of a command ("" for the program itself) in its help.
  std::set<std::string> options(const std::string& command) const {
    std::set<std::string> names;
    for (const std::string& words : wordsBelow(run(command + " --help").out, "Options")) {
      size_t begin = 0;
      for (size_t comma = 0; comma != std::string::npos; begin = comma + 1) {
        comma = words.find(',', begin);
        names.insert(words.substr(begin, comma - begin));
      }
    }
    return names;
  }

  /// Returns what bash offers for the last of these words.
  std::set<std::string> offered(const std::vector<std::string>& words) const {
    std::string list;
    for (const std::string& word : words) list += " '" + word + "'";
    const ToolResult result = bash(
        "source <(\"$tool\" completion bash)\nCOMP_WORDS=(gltf-mcc" + list +
        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_gltf_mcc\nprintf '%s\\n' \"${COMPREPLY[@]}\"");
    EXPECT_EQ(result.err, "");
    std::set<std::string> found;
    for (size_t at = 0; at < result.out.size();) {
      const size_t end = result.out.find('\n', at);
      if (end != at) found.insert(result.out.substr(at, end - at));
      at = end + 1;
    }
    return found;
  }

  ScratchFolder folder_;
  std::string tool_;
};

using Words = std::set<std::string>;

bool isAscii(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

TEST_F(Manners, EveryCommandHasHelpWithExamples) {
  const std::vector<std::string> all = commands();
  for (const char* command : {"convert", "decode", "inspect", "help", "completion"}) {
    EXPECT_EQ(std::count(all.begin(), all.end(), command), 1) << command;
  }
  for (const std::string& command : all) {
    const ToolResult help = run(command + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.out.find("Usage: gltf-mcc " + command), std::string::npos) << help.out;
    EXPECT_NE(help.out.find("\nExamples:\n  gltf-mcc " + command), std::string::npos) << help.out;
    EXPECT_EQ(options(command).count("--help"), 1u) << help.out;
    EXPECT_EQ(help.out.find("\n\n\n"), std::string::npos) << help.out;
    EXPECT_EQ(run("help " + command).out, help.out);
    for (size_t at = 0; at < help.out.size(); at = help.out.find('\n', at) + 1) {
      EXPECT_LE(help.out.find('\n', at) - at, 110u) << help.out.substr(at, 120);
    }
  }
  EXPECT_EQ(run("help").out, run("--help").out);
  EXPECT_EQ(all.back(), "man");
  // Words of the format and its code: the points of positions are a lattice; --grid is an old name.
  for (const std::string& command : all) {
    EXPECT_EQ(run(command + " --help").out.find(" grid"), std::string::npos) << command;
  }
  // Without any word, the help in short.
  const ToolResult none = run("");
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.out, "");
  EXPECT_EQ(none.err.rfind("gltf-mcc: name a command\n\nUsage: gltf-mcc COMMAND ", 0), 0u)
      << none.err;
  EXPECT_EQ(wordsBelow(none.err, "Commands"), all);
  EXPECT_NE(none.err.find("\n\nRun \"gltf-mcc --help\".\n"), std::string::npos) << none.err;
  expectUsageError("help convrt", "help: there is no command convrt; did you mean convert?");
}

TEST_F(Manners, VersionNamesTheFormat) {
  const ToolResult version = run("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(std::regex_search(
      version.out,
      std::regex("^gltf-mcc \\d+\\.\\d+\\.\\d+(-rc\\.\\d+)?\nKHR_mesh_collapse_compression: writes "
                 "and reads "
                 "format 1\\.\\d+\n")))
      << version.out;
}

TEST_F(Manners, WrongWordsGetSuggestions) {
  expectUsageError("--colour always", "there is no option --colour; did you mean --color?");
  EXPECT_NE(run("covnert a.glb b.glb").err.find("; did you mean convert?"), std::string::npos);
  EXPECT_NE(run("insp torus.glb").err.find("; did you mean inspect?"), std::string::npos);
  EXPECT_EQ(run("xylophone").err.find("did you mean"), std::string::npos);
  EXPECT_NE(run("torus.glb small.glb").err.find("name a command before torus.glb: convert, "),
            std::string::npos);
  EXPECT_NE(
      run("torus.glb small.glb").err.find("; did you mean: gltf-mcc convert torus.glb small.glb\n"),
      std::string::npos);
  EXPECT_NE(run("torus.glb").err.find("; did you mean: gltf-mcc inspect torus.glb\n"),
            std::string::npos);
  expectUsageError("-i torus.glb -o 'my model.glb'",
                   "name a command before -i; did you mean: gltf-mcc convert -i torus.glb -o "
                   "'my model.glb'");
  expectUsageError("--lossless \"it's.glb\" b.glb",
                   "name a command before --lossless; did you mean: gltf-mcc convert --lossless "
                   "'it'\\''s.glb' b.glb");
  for (const auto& [word, meant] : std::map<std::string, std::string>{{"compress", "convert"},
                                                                      {"decompress", "decode"},
                                                                      {"info", "inspect"},
                                                                      {"check", "validate"},
                                                                      {"benchmark", "bench"},
                                                                      {"version", "--version"}}) {
    EXPECT_NE(run(word + " a.glb b.glb").err.find("; did you mean " + meant + "?\n"),
              std::string::npos)
        << word;
  }
  expectUsageError("convert torus.glb s.glb --lossles",
                   "convert: there is no option --lossles; did you mean --lossless?");
  expectUsageError("convert torus.glb s.glb --positon-bits=12",
                   "convert: there is no option --positon-bits; did you mean "
                   "--position-bits?");
  expectUsageError("convert torus.glb s.glb --frobnicate",
                   "convert: there is no option --frobnicate");
  expectUsageError("convert torus.glb s.glb -z", "convert: there is no option -z");
  expectUsageError("convert torus.glb s.glb --grid scen",
                   "--grid: scen is not one of mesh, scene, primitive; did you mean scene?");
  expectUsageError("inspect torus.glb --format xml",
                   "--format: xml is not one of pretty, md, csv, json");
  expectUsageError("completion fish", "completion: supports bash and zsh, not fish");
  EXPECT_NE(run("convert torus.glb s.glb --grid=x").err.find("Run \"gltf-mcc convert --help\"."),
            std::string::npos);
}

TEST_F(Manners, FilesGetSuggestions) {
  const auto expectSays = [&](const std::string& arguments, const std::string& message) {
    const ToolResult result = run(arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_EQ(result.err, "gltf-mcc: " + message + "\n");
  };
  expectSays("convert torus s.glb", "torus: there is no such file; did you mean torus.glb?");
  expectSays("decode tours.glb s.glb", "tours.glb: there is no such file; did you mean torus.glb?");
  expectSays("inspect ./toruss.glb",
             "./toruss.glb: there is no such file; did you mean ./torus.glb?");
  expectSays("inspect violin.glb", "violin.glb: there is no such file");
  fs::create_directory(folder_.path() / "folder");
  expectSays("convert torus.glb folder",
             "folder: is a folder; name the file to write, or write into it with -o folder");
  expectUsageError("convert torus.glb small",
                   "convert: small: has no extension; name it small.glb or small.gltf");
  std::ofstream(folder_.path() / "model") << "older";
  EXPECT_EQ(run("convert torus.glb model").status, 0);  // an existing path may be anything
}

TEST_F(Manners, OtherFormatsGetAdvice) {
  const std::string neither = ": byte 0: this is not a glTF file: neither a GLB nor JSON";
  for (const std::string name : {"m.obj", "m.STL", "m.ply"}) {
    std::ofstream(folder_.path() / name) << "o a model\n";
    for (const std::string& command :
         {"convert " + name + " out.glb", "decode " + name + " out.glb", "inspect " + name,
          "tree " + name + " out.svg"}) {
      const ToolResult result = run(command);
      EXPECT_EQ(result.status, 1) << command;
      EXPECT_EQ(result.err,
                "gltf-mcc: " + name + neither +
                    "; turn it into a .glb first, with Blender or with: assimp export " + name +
                    " m.glb -fglb2\n");
    }
  }
  EXPECT_EQ(
      run("validate m.obj torus.glb").err,
      "gltf-mcc: m.obj: is no glTF file; turn it into a .glb first, with Blender or with: assimp "
      "export m.obj m.glb -fglb2\n");
  EXPECT_NE(run("convert -o out m.obj torus.glb").err.find("assimp export m.obj"),
            std::string::npos);
  std::ofstream(folder_.path() / "a b.obj") << "o a model\n";
  EXPECT_NE(run("inspect 'a b.obj'").err.find("assimp export 'a b.obj' 'a b.glb'"),
            std::string::npos);
  std::ofstream(folder_.path() / "m.glb") << "o a model\n";
  EXPECT_EQ(run("inspect m.glb").err, "gltf-mcc: m.glb" + neither + "\n");
}

TEST_F(Manners, InspectListsWhatIsInAPlainFile) {
  const ToolResult torus = run("inspect torus.glb");
  EXPECT_EQ(torus.status, 0);
  EXPECT_EQ(torus.out,
            "torus.glb: 74,844 bytes, 1 mesh, 1 primitive; extensions: none\n"
            "nothing in it is compressed with KHR_mesh_collapse_compression\n\n"
            "           bytes  what\n"
            "--------  ------  -------------------------------\n"
            "geometry  73,728  4,096 triangles, 2,048 vertices\n"
            "the rest   1,116  JSON, nodes, materials\n\n"
            "To compress the geometry: gltf-mcc convert torus.glb OUT.glb\n");
  const std::string skinned = run("inspect " + samplePath("skinned.glb")).out;
  EXPECT_TRUE(std::regex_search(skinned, std::regex("\nanimations +1,208  1 animation\n")))
      << skinned;
  const std::string textured = run("inspect " + samplePath("textured.glb") + " --format md").out;
  EXPECT_TRUE(std::regex_search(textured, std::regex("\n\\| images +\\| +30,952 \\| 2 images ")))
      << textured;
  std::ofstream(folder_.path() / "none.gltf")
      << R"({"asset": {"version": "2.0"}, "images": [{"uri": "a.png"}]})";
  const std::string none = run("inspect none.gltf").out;
  EXPECT_TRUE(std::regex_search(none, std::regex("\nimages +0  0 images, and 1 file beside it\n")))
      << none;
  EXPECT_NE(none.find("There are no triangles that could be compressed.\n"), std::string::npos)
      << none;
  std::ofstream(folder_.path() / "draco.gltf")
      << R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_draco_mesh_compression"],
             "accessors": [{"count": 7, "componentType": 5126, "type": "VEC3"}, {"count": 5, "componentType": 5126, "type": "VEC3"}],
             "meshes": [{"primitives": [{"mode": 5, "attributes": {"POSITION": 0}},
                                        {"mode": 6, "attributes": {"POSITION": 0}},
                                        {"mode": 0, "attributes": {"POSITION": 1}}]}]})";
  const std::string draco = run("inspect draco.gltf").out;
  EXPECT_NE(draco.find("10 triangles, 12 vertices\n"), std::string::npos) << draco;
  EXPECT_NE(draco.find("It uses KHR_draco_mesh_compression, which convert reads. To compress"),
            std::string::npos)
      << draco;
}

TEST_F(Manners, ColoursOnATerminalOnly) {
  const std::string escape = "\033[";
  const std::string bold = "\033[1m";
  for (const char* arguments : {"--help", "convert --help", "inspect torus.glb", "frobnicate"}) {
    const ToolResult plain = run(arguments);
    EXPECT_EQ((plain.out + plain.err).find('\033'), std::string::npos) << arguments;
  }
  EXPECT_NE(run("--help --color always").out.find(escape), std::string::npos);
  EXPECT_NE(run("--color=always frobnicate").err.find(escape), std::string::npos);
  ASSERT_EQ(run("convert torus.glb small.glb -q").status, 0);
  EXPECT_NE(run("inspect small.glb --color always").out.find(escape), std::string::npos);
  EXPECT_EQ(run("inspect small.glb --color always --format json").out.find(escape),
            std::string::npos);
  EXPECT_EQ(run("inspect small.glb --color always --format csv").out.find(escape),
            std::string::npos);
  expectUsageError("inspect small.glb --color sometimes",
                   "--color: sometimes is not one of auto, always, never");
  if (!has("script")) GTEST_SKIP() << "no script(1), which makes a terminal";
  const auto onTerminal = [&](const std::string& setting, const std::string& arguments) {
    return bash("export TERM=xterm; unset NO_COLOR; " + setting + "\nscript -qec \"'$tool' " +
                arguments + "\" /dev/null")
        .out;
  };
  EXPECT_NE(onTerminal("", "inspect small.glb").find(bold), std::string::npos);
  EXPECT_EQ(onTerminal("export NO_COLOR=1", "inspect small.glb").find(bold), std::string::npos);
  EXPECT_EQ(onTerminal("export TERM=dumb", "inspect small.glb").find(bold), std::string::npos);
  EXPECT_EQ(onTerminal("", "inspect small.glb --color never").find(bold), std::string::npos);
  EXPECT_NE(onTerminal("export NO_COLOR=", "inspect small.glb").find(bold), std::string::npos);
}

TEST_F(Manners, AsciiWhereTheLocaleHasNoMore) {
  ASSERT_EQ(run("convert torus.glb small.glb -q").status, 0);
  for (const std::string arguments :
       {"--help", "convert --help", "decode --help", "inspect small.glb", "frobnicate"}) {
    const ToolResult ascii = bash("LC_ALL=C \"$tool\" " + arguments);
    EXPECT_TRUE(isAscii(ascii.out + ascii.err)) << arguments << ascii.out << ascii.err;
  }
  EXPECT_FALSE(isAscii(bash("LC_ALL=C.UTF-8 \"$tool\" inspect small.glb").out));
  EXPECT_FALSE(isAscii(bash("LC_ALL= LC_CTYPE= LANG=en_US.utf8 \"$tool\" convert --help").out));
  EXPECT_TRUE(isAscii(bash("LC_ALL=C LANG=en_US.utf8 \"$tool\" convert --help").out));
}

TEST_F(Manners, ManPageHasEveryCommandAndOption) {
  const std::string page = run("man").out;
  EXPECT_TRUE(isAscii(page));
  const auto contains = [&](const std::string& text) {
    return page.find(std::regex_replace(text, std::regex("-"), "\\-")) != std::string::npos;
  };
  for (std::string command : commands()) {
    EXPECT_NE(page.find("\n.SS " + command + "\n"), std::string::npos);
    for (const std::string& option : options(command)) EXPECT_TRUE(contains(option)) << option;
  }
  for (const std::string& option : options("")) EXPECT_TRUE(contains(option)) << option;
  std::ofstream(folder_.path() / "gltf-mcc.1") << page;
  if (!has("groff")) GTEST_SKIP() << "no groff";
  const ToolResult formatted = runCommand(folder_, "groff -man -Tascii -ww -rLL=100n gltf-mcc.1");
  EXPECT_EQ(formatted.status, 0);
  EXPECT_EQ(formatted.err, "");
  EXPECT_NE(formatted.out.find("Wrong usage."), std::string::npos);
}

TEST_F(Manners, BashCompletesEverythingThatHelpLists) {
  const std::vector<std::string> all = commands();
  EXPECT_EQ(offered({""}), Words(all.begin(), all.end()));
  EXPECT_EQ(offered({"--"}).count("--version"), 1u);
  EXPECT_EQ(offered({"con"}), Words{"convert"});
  for (const std::string& command : all) {
    EXPECT_EQ(offered({command, "-"}), options(command)) << command;
  }
  EXPECT_EQ(offered({"convert", "torus.glb", "x.glb", "--grid", ""}),
            (Words{"mesh", "scene", "primitive"}));
  EXPECT_EQ(offered({"convert", "--grid", "=", "s"}), Words{"scene"});
  EXPECT_EQ(offered({"convert", "--grid", "="}), (Words{"mesh", "scene", "primitive"}));
  EXPECT_EQ(offered({"convert", "--position-bits", ""}), Words{});
  EXPECT_EQ(offered({"completion", ""}), (Words{"bash", "zsh"}));
  EXPECT_EQ(offered({"help", "insp"}), Words{"inspect"});
  fs::create_directory(folder_.path() / "my models");
  std::ofstream(folder_.path() / "notes.txt") << "";
  EXPECT_EQ(offered({"inspect", ""}), (Words{"my models", "torus.glb"}));
  EXPECT_EQ(offered({"convert", "-o", "my"}), Words{"my models"});
  EXPECT_EQ(offered({"convert", "--report", "no"}), Words{"notes.txt"});
}

TEST_F(Manners, ZshCompletesEverythingThatHelpLists) {
  const std::string script = run("completion zsh").out;
  EXPECT_EQ(script.rfind("#compdef gltf-mcc\n", 0), 0u);
  for (const std::string& command : commands()) {
    const size_t begin = script.find("\n    " + command + ")\n");
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string part = script.substr(begin, script.find(";;", begin) - begin);
    for (const std::string& option : options(command)) {
      EXPECT_NE(part.find(option), std::string::npos) << command << " " << option;
    }
  }
  if (!has("zsh")) GTEST_SKIP() << "no zsh";
  EXPECT_EQ(shell("zsh -f", "\"$tool\" completion zsh > _gltf-mcc && zsh -n _gltf-mcc").err, "");
  // These are the calls of the script to zsh's own functions.
  const ToolResult asked = shell("zsh -f", R"(
compdef() { : }
_arguments() { print -rl -- "$@" }
_describe() { print -rl -- ${(P)2} }
source _gltf-mcc
words=(gltf-mcc con) CURRENT=2; _gltf_mcc
words=(gltf-mcc convert --qu) CURRENT=3; _gltf_mcc; print $words[1] $CURRENT
)");
  EXPECT_EQ(asked.err, "");
  EXPECT_NE(asked.out.find("convert:Compress"), std::string::npos) << asked.out;
  EXPECT_NE(asked.out.find("--grid[What shares a lattice"), std::string::npos) << asked.out;
  EXPECT_NE(asked.out.find(":(mesh scene primitive)"), std::string::npos) << asked.out;
  EXPECT_NE(asked.out.find("(-o --output)-o["), std::string::npos) << asked.out;
  EXPECT_NE(asked.out.find("\nconvert 2\n"), std::string::npos) << asked.out;
}

TEST_F(Manners, OtherProgramsAreFoundBesideThisOneOrInThePath) {
  const fs::path root = folder_.path();
  for (const char* name : {"alone", "others"}) fs::create_directory(root / name);
  fs::copy_file(tool_, root / "alone/gltf-mcc");
  const std::string line = "--color never tree torus.glb 'a b.svg'";
  const ToolResult lacking = runCommand(folder_, "alone/gltf-mcc " + line);
  EXPECT_EQ(lacking.status, 1);
  EXPECT_EQ(lacking.out, "");
  EXPECT_NE(lacking.err.find("gltf-mcc: gltf-mcc-tree: is a program of its own, "),
            std::string::npos);
  EXPECT_NE(lacking.err.find(" tools/run tree\n"), std::string::npos) << lacking.err;
  EXPECT_EQ(runCommand(folder_, "alone/gltf-mcc tree --help").out, run("tree --help").out);
  EXPECT_EQ(runCommand(folder_, "alone/gltf-mcc tree --siz 3").err, run("tree --siz 3").err);
  // A stand-in shows what it gets, and its status is that of the whole.
  std::ofstream(root / "others/gltf-mcc-tree") << "#!/bin/bash\nprintf '<%s>' \"$@\"\nexit 7\n";
  fs::permissions(root / "others/gltf-mcc-tree", fs::perms::owner_all);
  const ToolResult found = runCommand(folder_, "PATH=$PWD/others:$PATH alone/gltf-mcc " + line);
  EXPECT_EQ(found.status, 7);
  EXPECT_EQ(found.out, "<--color><never><torus.glb><a b.svg>");
  fs::copy_file(tool_ + "-tree", root / "alone/gltf-mcc-tree");
  const ToolResult beside = runCommand(folder_, "PATH=$PWD/others:$PATH alone/gltf-mcc " + line);
  EXPECT_EQ(beside.status, 0) << beside.err;
  EXPECT_TRUE(fs::exists(root / "a b.svg"));
  EXPECT_EQ(runCommand(folder_, "alone/gltf-mcc-tree torus.glb").err, run("tree torus.glb").err);
}

}  // namespace
}  // namespace mcc::test
