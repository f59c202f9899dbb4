// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Awkward and hostile names of files: devices and links, one name in two roles, names with
// characters that a terminal obeys, and files that a model wants copied.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <map>

#include "cli/run_tool.h"
#include "json/json.h"
#include "support/gltf_builder.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;
using gltf::Json;

class Files : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#else
    tool_ = std::string("'") + MCC_TOOL_GLTF_MCC + "' ";
    fs::copy_file(fs::path(MCC_SAMPLES_DIR) / "torus.glb", path("in.glb"));
    ASSERT_EQ(run("convert in.glb small.glb -q").status, 0);
#endif
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }
  void store(const std::string& name, const std::string& content) const {
    fs::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << content;
  }
  ToolResult run(const std::string& arguments) const { return runTool(folder_, arguments); }
  ToolResult shell(const std::string& command) const {
    return runCommand(folder_, "( " + command + " )");
  }

  /// Returns everything in the folder and below, with the contents of files.
  std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      const std::string name = entry.path().lexically_relative(folder_.path()).string();
      if (name == ".stdout" || name == ".stderr") continue;
      // A link may lead out of the folder, such as to the log of the run, which others write to.
      if (entry.is_symlink()) {
        found[name] = fs::read_symlink(entry.path()).string();
      } else {
        found[name] = entry.is_regular_file() ? contentOf(entry.path()) : "";
      }
    }
    return found;
  }

  /// Expects this exit status and message, and that nothing changed.
  void expectRefused(const std::string& arguments, int status, const std::string& message) const {
    const auto before = everything();
    const ToolResult result = run(arguments);
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(everything() == before) << arguments;
  }

  /// A .gltf in m/ with its buffer, and these images.
  void storeModel(const std::vector<std::string>& images, const std::string& buffer = "mesh.bin") {
    gltf::test::Builder builder;
    builder.addMesh({gltf::test::Sheet(20).addTo(builder)});
    gltf::Json json = builder.json;
    json["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", buffer}}};
    for (const std::string& image : images) json["images"].push_back({{"uri", image}});
    store("m/a.gltf", json.dump());
    store("m/" + buffer, {builder.bin.begin(), builder.bin.end()});
  }

  ScratchFolder folder_;
  std::string tool_;
};

constexpr char kPng[] = "\x89PNG\r\n\x1a\n";

/// Uses links in the test's folder and devices made there, so that a faulty program cannot ruin
/// those of the system.
TEST_F(Files, StreamsAreWrittenThrough) {
  fs::create_symlink("/proc/self/fd/1", path("out"));
  fs::create_symlink("/dev/fd/3", path("three"));
  const std::string small = contentOf(path("small.glb"));
  for (const std::string& command : std::vector<std::string>{
           tool_ + "convert in.glb out > a.glb", tool_ + "convert in.glb out | cat > a.glb",
           tool_ + "convert in.glb three -q 3> a.glb",
           "{ " + tool_ + "convert in.glb /proc/self/fd/1; } > a.glb",
           "mkfifo pipe && { cat pipe > a.glb & " + tool_ +
               "convert in.glb pipe -q && wait; } && rm pipe"}) {
    fs::remove(path("a.glb"));
    const ToolResult result = shell(command);
    EXPECT_EQ(result.status, 0) << command << result.err;
    EXPECT_EQ(result.err, "") << command;
    EXPECT_TRUE(contentOf(path("a.glb")) == small) << command;
  }
  // Existing files must not be lost.
  ASSERT_EQ(shell("{ printf begin; " + tool_ + "convert in.glb out; } > a.glb").status, 0);
  EXPECT_TRUE(contentOf(path("a.glb")) == "begin" + small);
  const ToolResult tree = shell(tool_ + "tree in.glb out | head -c 4");
  EXPECT_EQ(tree.out, "<svg");
  ASSERT_EQ(mkfifo(path("pipe.gltf").c_str(), 0600), 0);
  expectRefused("convert in.glb pipe.gltf", 1, "a .gltf has its buffer in a file next to it");
  expectRefused("convert in.glb pipe.gltf --fallback", 1, "a .gltf has its buffer");
  EXPECT_TRUE(fs::is_fifo(path("pipe.gltf")));
}

/// Nobody writes to the pipe, so a program that opened it would wait for ever.
TEST_F(Files, PipesThatADocumentNamesAreNotOpened) {
  storeModel({});
  fs::remove(path("m/mesh.bin"));
  ASSERT_EQ(mkfifo(path("m/mesh.bin").c_str(), 0600), 0);
  for (const std::string arguments :
       {"convert --in-place m/a.gltf m/a.gltf", "convert m/a.gltf b.glb", "inspect m/a.gltf"}) {
    const ToolResult result = shell("timeout 20 " + tool_ + arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_NE(result.err.find("is not a regular file"), std::string::npos) << result.err;
  }
}

/// The author of a document chose its names, and must not get other files of this machine into it.
TEST_F(Files, BuffersAreReadFromTheFolderOfTheInputAlone) {
  storeModel({});
  fs::create_directory(path("elsewhere"));
  fs::rename(path("m/mesh.bin"), path("elsewhere/mesh.bin"));
  fs::create_symlink("../elsewhere/mesh.bin", path("m/mesh.bin"));
  for (const std::string arguments :
       {"convert m/a.gltf b.glb", "convert m/a.gltf o.gltf", "decode m/a.gltf b.glb",
        "inspect m/a.gltf", "validate m/a.gltf", "tree m/a.gltf x.svg",
        "convert --in-place m/a.gltf m/a.gltf"}) {
    const ToolResult result = run(arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_NE((result.err + result.out).find("\"mesh.bin\": is a symbolic link out of the folder"),
              std::string::npos)
        << arguments << result.err;
  }
  EXPECT_FALSE(fs::exists(path("b.glb")));
  EXPECT_FALSE(fs::exists(path("mesh.bin")));
}

/// The user may name the input by a link. Its files are then looked for next to the link, as other
/// programs do, and links that stay in that folder are followed.
TEST_F(Files, TheFolderOfAnInputIsThatOfItsName) {
  storeModel({});
  fs::create_directory(path("m/data"));
  fs::rename(path("m/mesh.bin"), path("m/data/mesh.bin"));
  fs::create_symlink("data/mesh.bin", path("m/mesh.bin"));
  EXPECT_EQ(run("convert m/a.gltf b.glb").status, 0);
  fs::create_symlink("m/a.gltf", path("link.gltf"));
  expectRefused("convert link.gltf c.glb", 1, "\"mesh.bin\": there is no such file");
  fs::copy_file(path("m/data/mesh.bin"), path("mesh.bin"));
  EXPECT_EQ(run("convert link.gltf c.glb").status, 0);
  EXPECT_TRUE(contentOf(path("b.glb")) == contentOf(path("c.glb")));
}

TEST_F(Files, DevicesAreWrittenTo) {
  const auto device = [&](const std::string& name, unsigned minor_number) {
    if (geteuid() != 0) return "/dev/" + name;  // only root could replace it
    const bool is_made = mknod(path(name).c_str(), S_IFCHR | 0666, makedev(1, minor_number)) == 0 &&
                         access(path(name).c_str(), W_OK) == 0 && shell(": > " + name).status == 0;
    return is_made ? name : std::string();
  };
  const std::string null = device("null", 3);
  const std::string full = device("full", 7);
  if (null.empty() || full.empty()) GTEST_SKIP() << "no devices can be made here";
  for (const std::string& arguments :
       {"convert in.glb " + null, "decode small.glb " + null, "tree in.glb " + null,
        "convert in.glb a.glb --report " + null}) {
    EXPECT_EQ(run(arguments + " -q").status, 0) << arguments;
    EXPECT_TRUE(fs::is_character_file(null == "null" ? path(null) : fs::path(null))) << arguments;
  }
  EXPECT_EQ(run("convert in.glb " + full).err,
            "gltf-mcc: " + full + ": cannot be written: No space left on device\n");
}

TEST_F(Files, InPlaceKeepsPermissionsAndLinks) {
  fs::create_directory(path("real"));
  fs::rename(path("in.glb"), path("real/model.glb"));
  fs::create_symlink("real/model.glb", path("link.glb"));
  ASSERT_EQ(chmod(path("real/model.glb").c_str(), 0600), 0);
  ASSERT_EQ(run("convert --in-place link.glb link.glb -q").status, 0);
  EXPECT_TRUE(fs::is_symlink(path("link.glb")));
  EXPECT_TRUE(contentOf(path("real/model.glb")) == contentOf(path("small.glb")));
  EXPECT_EQ(fs::status(path("real/model.glb")).permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(everything().size(), 4u);
}

TEST_F(Files, OneNameForTwoThingsIsRefused) {
  fs::create_symlink("in.glb", path("link"));
  fs::create_directory(path("d"));
  for (const std::string name : {"in.glb", "./in.glb", "d/../in.glb", "link"}) {
    expectRefused("convert in.glb out.glb --report " + name, 2, "is the input");
    expectRefused("tree in.glb " + name, 2, "is the input");
    expectRefused("convert -o d/ in.glb --report " + name, 2, "is an input");
  }
  fs::remove_all(path("d"));
  fs::create_directory(path("d"));
  expectRefused("convert in.glb out.glb --report out.glb", 2, "is the output");
  expectRefused("convert in.glb small.glb --report ./small.glb", 2, "is the output");
  expectRefused("convert --in-place in.glb in.glb --report in.glb", 2, "is the output");
  expectRefused("convert in.glb - --report /dev/stdout", 2, "is the output");
  EXPECT_EQ(run("convert in.glb out.glb --report -").status, 2);
  storeModel({"t.png"});
  store("m/t.png", kPng);
  for (const std::string name : {"m/mesh.bin", "m/t.png"}) {
    expectRefused("convert m/a.gltf " + name, 1, "is part of the input");
    expectRefused("decode m/a.gltf " + name, 1, "is part of the input");
    expectRefused("convert m/a.gltf out.glb --report " + name, 2, "is a file of the input");
    expectRefused("convert -o d m/a.gltf --report " + name, 2, "is a file of the input");
  }
  expectRefused("convert m/a.gltf d/b.gltf --report d/t.png", 2,
                "is a copy of a file of the input");
  expectRefused("convert -o d in.glb --report d/in.glb", 2, "is the output of in.glb");
  expectRefused("convert -o d in.glb --report d/.gltf-mcc.json", 2, "is the record of the folder");
  fs::create_hard_link(path("in.glb"), path("d/small.glb"));
  expectRefused("convert -o d small.glb in.glb", 2, "is an input");
#if defined(MCC_HAS_FOREIGN)
  expectRefused("convert in.glb out.glb --emit-draco in.glb", 2, "is the input");
  expectRefused("convert in.glb out.glb --emit-draco out.glb", 2, "is the output");
  expectRefused("convert in.glb out.glb --emit-draco x --report x", 2, "is --emit-draco");
  expectRefused("compare in.glb --emit-draco link", 2, "is the input");
  expectRefused("bench in.glb --sizes link", 2, "is the input");
#endif
}

TEST_F(Files, ARecordThatIsNoneIsIgnoredWithANote) {
  const auto expectNote = [&](const std::string& message) {
    const ToolResult result = run("convert -o d/ in.glb");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("note: d/.gltf-mcc.json: " + message), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("it is ignored"), std::string::npos) << result.err;
    EXPECT_TRUE(contentOf(path("d/in.glb")) == contentOf(path("small.glb")));
  };
  const std::string nested(100000, '[');
  const std::string closed = nested + std::string(nested.size(), ']');
  store("d/.gltf-mcc.json", nested);
  expectNote("is not a record of this program");
  store("d/.gltf-mcc.json", closed);
  expectNote("is not a record of this program");
  store("d/.gltf-mcc.json", R"({"files":{"in.glb":)" + closed + "}}");
  expectNote("is not a record of this program");
  EXPECT_EQ(run("convert -o d/ in.glb").err, "");                 // written anew
  fs::resize_file(path("d/.gltf-mcc.json"), uintmax_t{1} << 33);  // a sparse file
  expectNote("is too large for a record");
  fs::remove(path("d/.gltf-mcc.json"));
  ASSERT_EQ(mkfifo(path("d/.gltf-mcc.json").c_str(), 0600), 0);
  expectNote("is not a file");
  EXPECT_TRUE(fs::is_fifo(path("d/.gltf-mcc.json")));
  fs::remove(path("d/.gltf-mcc.json"));
  store("precious", "text");
  fs::create_symlink("../precious", path("d/.gltf-mcc.json"));
  expectNote("is not a file");
  EXPECT_EQ(contentOf(path("precious")), "text");
}

/// A record that names another file than the output, or has no sizes.
TEST_F(Files, ARecordThatLiesMakesNothingUpToDate) {
  ASSERT_EQ(run("convert -o d/ in.glb -q").status, 0);
  const std::string record = contentOf(path("d/.gltf-mcc.json"));
  const size_t begin = record.find("{\"file\"");
  ASSERT_NE(begin, std::string::npos);
  Json other = Json::parse(record.substr(begin));
  Json no_sizes = other;
  store("d/.gltf-mcc.json", record);
  EXPECT_NE(run("convert -o d/ in.glb").out.find("up to date"), std::string::npos);
  other["output"] = other["input"];
  no_sizes["made"]["output_bytes"] = "many";
  for (const Json& lie : {other, no_sizes}) {
    store("d/.gltf-mcc.json", record.substr(0, begin) + lie.dump() + "\n");
    const ToolResult result = run("convert -o d/ in.glb");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out.find("up to date"), std::string::npos) << lie.dump();
  }
}

TEST_F(Files, AnInputCalledLikeTheRecord) {
  store("m/.gltf-mcc.json", R"({"asset":{"version":"2.0"}})");
  expectRefused("convert -o d/ m/.gltf-mcc.json", 2, "its output would be the record");
  EXPECT_EQ(run("convert m/.gltf-mcc.json out.gltf").status, 0);
}

TEST_F(Files, OnlyImagesAreCopied) {
  const std::vector<std::pair<std::string, std::string>> images = {
      {"a.png", kPng},
      {"b.jpg", "\xff\xd8\xff\xe0"},
      {"tex/c.ktx2", "\xabKTX 20\xbb\r\n\x1a\n"},
      {"d.webp", std::string("RIFF\x10\0\0\0WEBPVP8 ", 16)},
      {"e.avif", std::string("\0\0\0\x1c"
                             "ftypavif",
                             12)},
      {"f.dds", "DDS |"},
      {"g.basis", std::string("sB\x13\0\x4d\0\0\0", 8)}};
  std::vector<std::string> names = {".bashrc",
                                    ".config/autostart/x.desktop",
                                    "tex/.hidden/a.png",
                                    "%2ebashrc2.png",
                                    "run.sh",
                                    "link.png",
                                    "tex/../.x.png",
                                    "folder/b.png"};
  for (const auto& [name, content] : images) {
    names.push_back(name);
    store("m/" + name, content);
  }
  for (const char* name :
       {".bashrc", ".config/autostart/x.desktop", "tex/.hidden/a.png", ".bashrc2.png", ".x.png"}) {
    store(std::string("m/") + name, kPng);
  }
  store("m/run.sh", "#!/bin/sh\n");
  store("secret/b.png", kPng);
  fs::create_symlink("../secret/b.png", path("m/link.png"));
  fs::create_symlink("../secret", path("m/folder"));
  storeModel(names);
  fs::create_directory(path("o"));
  for (const std::string command : {"convert m/a.gltf o/b.gltf", "decode m/a.gltf o/b.gltf"}) {
    const ToolResult result = run(command);
    EXPECT_EQ(result.status, 0) << result.err;
    std::map<std::string, std::string> copied;
    for (const auto& entry : fs::recursive_directory_iterator(path("o"))) {
      if (!entry.is_regular_file()) continue;
      copied[entry.path().lexically_relative(path("o")).string()] = contentOf(entry.path());
    }
    for (const auto& [name, content] : images) EXPECT_TRUE(copied[name] == content) << name;
    copied.erase("b.gltf");
    std::erase_if(copied, [](const auto& file) { return file.first.ends_with(".bin"); });
    EXPECT_EQ(copied.size(), images.size()) << command;
    for (const std::string word : {"\".bashrc\" is the name of a hidden file; it is not copied",
                                   "\"run.sh\" is not a known type of image",
                                   "\"link.png\": is a symbolic link out of the folder",
                                   "\"folder/b.png\": is a symbolic link"}) {
      EXPECT_NE(result.out.find(word), std::string::npos) << word << "\n" << result.out;
    }
    fs::remove_all(path("o"));
    fs::create_directory(path("o"));
  }
}

/// The type of an image is decided by its bytes, whatever its JSON says.
TEST_F(Files, OnlyImagesAreEmbedded) {
  storeModel({"run.sh"});
  store("m/run.sh", "secret");
  Json json = Json::parse(contentOf(path("m/a.gltf")));
  json["images"][0]["mimeType"] = "image/png";
  store("m/a.gltf", json.dump());
  const ToolResult result = run("convert m/a.gltf out.glb");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("/images/0: is not a known type of image"), std::string::npos)
      << result.out;
  EXPECT_EQ(contentOf(path("out.glb")).find("secret"), std::string::npos);
}

/// Converting these gains nothing, so the source is copied with its buffers.
TEST_F(Files, BuffersAreCopiedUnderNamesOfBuffersOnly) {
  const std::string text =
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"NAME"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":4}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":1,)"
      R"("type":"SCALAR"}]})";
  for (const std::string name : {"x.bin", "x.glbin", ".bashrc", "Makefile", "x.sh", ".d/x.bin"}) {
    std::string model = text;
    model.replace(model.find("NAME"), 4, name);
    store("m/a.gltf", model);
    store("m/" + name, "data");
    fs::create_directory(path("o"));
    const ToolResult result = run("convert m/a.gltf o/b.gltf");
    EXPECT_EQ(result.status, 0) << name << result.err;
    const bool is_copied = name.starts_with("x.") && name != "x.sh";
    EXPECT_EQ(fs::exists(path("o/" + name)), is_copied) << name;
    const Json json = Json::parse(contentOf(path("o/b.gltf")));
    const std::string uri = json["buffers"][0]["uri"];
    EXPECT_EQ(contentOf(path("o/" + uri)), "data") << name;
    EXPECT_EQ(run("decode o/b.gltf back.glb").status, 0);
    fs::remove_all(path("o"));
  }
}

bool isClean(const std::string& text) {
  return std::none_of(text.begin(), text.end(),
                      [](char c) {
                        return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f;
                      }) &&
         text.find("\xc2\x9b") == std::string::npos &&
         text.find("\xe2\x80\xae") == std::string::npos;
}

/// Control characters in names of files, attributes, extensions, meshes and images, and in damaged
/// JSON.
TEST_F(Files, NothingThatATerminalObeysIsPrinted) {
  const std::string evil =
      "\033[31m\xc2\x9b"
      "5m\xe2\x80\xae\a\x7f";
  gltf::test::Builder builder;
  const gltf::test::Sheet sheet(20);
  gltf::Json primitive = sheet.addTo(builder);
  primitive["attributes"]["_" + evil] =
      builder.addFloats(std::vector<float>(sheet.count(), 0.5f), 1);
  primitive["extensions"][evil] = gltf::Json::object();
  gltf::Json points = primitive;
  points["mode"] = 0;
  builder.addMesh({primitive, points});
  builder.json["meshes"][0]["name"] = evil;
  builder.json["extensionsUsed"] = {evil};
  builder.json["asset"]["generator"] = evil;
  const std::vector<uint8_t> glb = builder.toGlb();
  const std::string name = "in" + evil + ".glb";
  store(name, {glb.begin(), glb.end()});
  gltf::Json json = builder.json;
  json["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", "m" + evil + ".bin"}}};
  json["buffers"][0]["uri"] = gltf::Json("m%1b%c2%9b.bin");
  store("uri" + evil + ".gltf", json.dump());
  store("broken" + evil + ".gltf", "{\"" + evil + "\" 1}");
  json["buffers"][0]["uri"] = "m.bin";
  json["images"] = {{{"uri", evil + "%c2%9b.png"}}, {{"uri", "%c2%9b.png"}}};
  store("m/image.gltf", json.dump());
  store("m/m.bin", {builder.bin.begin(), builder.bin.end()});
  const std::string quoted = "'" + name + "' ";
  const std::string out = "'out" + evil + ".glb' ";
  for (const std::string& command :
       std::vector<std::string>{"convert " + quoted + out + "-v",
                                "convert " + quoted + out + "--max-position-error 0.1",
                                "convert " + quoted + out + "--format json",
                                "convert " + quoted + out + "--format csv",
                                "convert " + quoted + out + "--format md -v",
                                "convert -o d/ " + quoted,
                                "convert -o d/ --force --format json " + quoted,
                                "decode -o e/ " + out,
                                "decode " + out + "x.glb",
                                "inspect " + out,
                                "inspect --format json " + out,
                                "inspect --format csv " + out,
                                "validate " + out,
                                "validate --format json " + out,
                                "validate --format csv " + out,
                                "tree " + quoted + "'tree" + evil + ".svg'",
                                "convert 'none" + evil + ".glb' x.glb",
                                "convert 'uri" + evil + ".gltf' x.glb",
                                "convert 'broken" + evil + ".gltf' x.glb",
                                "validate 'broken" + evil + ".gltf'",
                                "convert m/image.gltf x.gltf",
                                "validate --format json 'broken" + evil + ".gltf'",
                                "convert m/image.gltf d/x.gltf --format json",
                                "convert '--" + evil + "' x",
                                "'" + evil + "'",
                                "convert in.glb 'x" + evil + "'",
                                "convert in.glb x.glb --grid '" + evil + "'",
                                "help '" + evil + "'",
                                "compare " + quoted,
                                "compare --format json " + quoted,
                                "compare --format csv " + quoted}) {
    const ToolResult result = run(command);
    EXPECT_NE(result.out + result.err, "") << command;
    EXPECT_TRUE(isClean(result.out)) << command << "\n" << result.out;
    EXPECT_TRUE(isClean(result.err)) << command << "\n" << result.err;
  }
  // Names in the JSON are unchanged, and messages are clean.
  const Json inspected = Json::parse(run("inspect --format json " + out).out);
  EXPECT_EQ(inspected["extensionsUsed"][0], evil);
  ASSERT_EQ(run("convert " + quoted + out + "--report r.json -q").status, 0);
  const Json report = Json::parse(contentOf(path("r.json")));
  for (const auto& note : report["notes"]) EXPECT_TRUE(isClean(note)) << note;
  for (const auto& one : report["primitives"]) EXPECT_TRUE(isClean(one.value("note", "")));
  EXPECT_EQ(report["input"], name);
}

/// A name of the greatest possible length leaves no room for a temporary name made from it.
TEST_F(Files, LongNamesAreWritten) {
  const std::string name(250, 'x');
  EXPECT_EQ(run("convert in.glb " + name + ".glb").status, 0);
  EXPECT_TRUE(contentOf(path(name + ".glb")) == contentOf(path("small.glb")));
}

}  // namespace
}  // namespace mcc::test
