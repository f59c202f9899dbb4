// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// .gltf files with their buffers and images next to them, and fallbacks.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "cli/run_tool.h"
#include "gltf/files/file_io.h"
#include "support/gltf_builder.h"
#include "support/made_files.h"
#include "support/plain_reader.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;
using mcc::test::contentOf;
using mcc::test::runTool;
using mcc::test::ScratchFolder;
using mcc::test::ToolResult;

class GltfOutput : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
    Builder builder;
    builder.addMesh({Sheet(20).addTo(builder)});
    json_ = builder.json;
    bin_ = {builder.bin.begin(), builder.bin.end()};
    const std::vector<uint8_t> glb = builder.toGlb();
    store("in.glb", {glb.begin(), glb.end()});
    json_["images"] = {{{"uri", "sub%20dir/a.png"}}, {{"uri", "data:image/png;base64,AAAA"}}};
    json_["buffers"] = {{{"byteLength", bin_.size()}, {"uri", "mesh.bin"}}};
    fs::create_directories(path("m/sub dir"));
    store("m/a.gltf", json_.dump(2));
    store("m/mesh.bin", bin_);
    store("m/sub dir/a.png", "\x89PNG image");
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }
  void store(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
  }
  ToolResult run(const std::string& arguments) const { return runTool(folder_, arguments); }

  /// Paths of all files below the folder, without those of run().
  std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      if (!entry.is_regular_file()) continue;
      const std::string name = entry.path().lexically_relative(folder_.path()).string();
      if (name != ".stdout" && name != ".stderr") found.insert(name);
    }
    return found;
  }

  void expectDone(const std::string& arguments) const {
    const ToolResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.err;
    EXPECT_EQ(result.err, "");
  }

  /// Expects status 1, a message, and that no file changed.
  void expectRefused(const std::string& arguments, const std::string& message) const {
    std::map<std::string, std::string> before;
    for (const std::string& name : names()) before[name] = contentOf(path(name));
    const ToolResult result = run(arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
    std::map<std::string, std::string> after;
    for (const std::string& name : names()) after[name] = contentOf(path(name));
    EXPECT_EQ(after, before) << arguments;
  }

  /// Returns the path of what was made beside x.gltf, with the folder of x.
  std::string made(const std::string& x, const std::string& end = ".bin") const {
    const fs::path folder = fs::path(x).parent_path();
    return folder / mcc::test::madeBeside(folder_.path() / folder, fs::path(x).filename(), end);
  }

  Json jsonAt(const std::string& name) const {
    Json json;
    EXPECT_TRUE(parseJson(asBytes(contentOf(path(name))), json).ok()) << name;
    return json;
  }

  ScratchFolder folder_;
  Json json_;
  std::string bin_;
};

TEST_F(GltfOutput, BufferLiesBesideIt) {
  const auto before = names();
  expectDone("convert in.glb 'out 1.gltf'");
  auto after = before;
  const std::string buffer = made("out 1");
  after.insert({"out 1.gltf", buffer});
  EXPECT_EQ(names(), after);
  const Json json = jsonAt("out 1.gltf");
  EXPECT_EQ(json["buffers"][0]["uri"], "out%201" + buffer.substr(5));
  EXPECT_EQ(json["buffers"][0]["byteLength"], fs::file_size(path(buffer)));
  EXPECT_EQ(json["extensionsRequired"], Json::array({"KHR_mesh_collapse_compression"}));

  // Both containers hold the same document.
  expectDone("decode 'out 1.gltf' a.glb");
  expectDone("convert in.glb out.glb");
  expectDone("decode out.glb b.glb");
  EXPECT_TRUE(contentOf(path("a.glb")) == contentOf(path("b.glb")));
  expectDone("decode 'out 1.gltf' back.gltf");
  expectDone("convert back.gltf c.glb");
  expectDone("convert b.glb d.glb");
  EXPECT_TRUE(contentOf(path("c.glb")) == contentOf(path("d.glb")));
}

TEST_F(GltfOutput, ImagesComeAlong) {
  fs::create_directory(path("o"));
  const auto before = names();
  expectDone("convert m/a.gltf o/b.gltf");
  auto after = before;
  after.insert({"o/b.gltf", made("o/b"), "o/sub dir/a.png"});
  EXPECT_EQ(names(), after);
  EXPECT_EQ(contentOf(path("o/sub dir/a.png")), "\x89PNG image");
  EXPECT_EQ(jsonAt("o/b.gltf")["images"], jsonAt("m/a.gltf")["images"]);

  // Convert again with another image: it may be replaced, because it belongs to the output. Next to
  // another output it may not.
  store("m/sub dir/a.png", "\x89PNG another");
  expectRefused("convert m/a.gltf o/other.gltf", "which is another file; choose another folder");
  expectDone("convert m/a.gltf o/b.gltf");
  EXPECT_EQ(contentOf(path("o/sub dir/a.png")), "\x89PNG another");
  expectDone("decode o/b.gltf m/c.gltf");
  EXPECT_EQ(jsonAt("m/c.gltf")["images"], json_["images"]);

  // A missing image is not our concern.
  fs::remove(path("m/sub dir/a.png"));
  fs::create_directory(path("p"));
  const ToolResult result = run("convert m/a.gltf p/b.gltf");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("a.png\": there is no such file; it is not copied"), std::string::npos)
      << result.out;
}

TEST_F(GltfOutput, ImagesBesideTheInputStayWhereTheyAre) {
  const auto before = names();
  expectDone("convert m/a.gltf m/b.gltf");
  auto after = before;
  after.insert({"m/b.gltf", made("m/b")});
  EXPECT_EQ(names(), after);
}

/// What was made with an older output goes with it; everything else stays.
TEST_F(GltfOutput, ForeignFilesStay) {
  store("out.bin", "precious");
  store("out.0123456789abcdef.bin", "precious");
  expectDone("convert in.glb out.gltf --lossless");
  const std::set<std::string> once = names();
  expectDone("convert in.glb out.gltf");
  EXPECT_EQ(names().size(), once.size());
  EXPECT_NE(names(), once);  // a buffer of another name
  expectDone("convert in.glb out.gltf --lossless");
  EXPECT_EQ(names(), once);
  for (const char* name : {"out.bin", "out.0123456789abcdef.bin"}) {
    EXPECT_EQ(contentOf(path(name)), "precious");
  }
  store("out.gltf", "{}");
  expectDone("convert in.glb out.gltf");
  EXPECT_EQ(contentOf(path("out.bin")), "precious");
  // The buffer of an older version belongs to its .gltf.
  store("out.gltf", R"({"buffers":[{"uri":"out.bin","byteLength":8}]})");
  expectDone("decode in.glb out.gltf");
  EXPECT_FALSE(fs::exists(path("out.bin")));

  // A buffer of our name with other bytes.
  const std::string buffer = jsonAt("out.gltf")["buffers"][0]["uri"];
  store(buffer, "damaged");
  expectRefused("decode in.glb out.gltf", buffer + ": another file appeared there");

  // The files of the input stay, even when the output that is replaced refers to them, too.
  store("m/mesh.gltf", R"({"buffers":[{"uri":"mesh.bin","byteLength":8}]})");
  expectDone("convert m/a.gltf m/mesh.gltf");
  EXPECT_EQ(contentOf(path("m/mesh.bin")), bin_);
  const std::string glb = contentOf(path("in.glb"));
  store("x.bin", glb);
  store("x.gltf", R"({"buffers":[{"uri":"x.bin","byteLength":8}]})");
  expectDone("convert x.bin x.gltf");
  EXPECT_TRUE(contentOf(path("x.bin")) == glb);
}

TEST_F(GltfOutput, InputMayBeOutput) {
  store("m/a.gltf", [&] {
    json_["buffers"][0]["uri"] = "a.bin";
    return json_.dump();
  }());
  fs::rename(path("m/mesh.bin"), path("m/a.bin"));
  auto expected = names();
  expectDone("convert --in-place m/a.gltf m/a.gltf");
  expected.erase("m/a.bin");
  const std::string buffer = made("m/a");
  expected.insert(buffer);
  EXPECT_EQ(names(), expected);
  EXPECT_LT(fs::file_size(path(buffer)) * 3, bin_.size());
  const std::string json = contentOf(path("m/a.gltf"));
  const std::string bin = contentOf(path(buffer));
  expectDone("convert --in-place m/a.gltf m/a.gltf");  // nothing is gained, so nothing changes
  EXPECT_EQ(contentOf(path("m/a.gltf")), json);
  EXPECT_EQ(contentOf(path(buffer)), bin);
  expectDone("decode --in-place m/a.gltf m/a.gltf");
  EXPECT_GT(fs::file_size(path(made("m/a"))) * 2, bin_.size());
}

TEST_F(GltfOutput, WhatGainsNothingIsCopiedWithItsFiles) {
  expectDone("convert m/a.gltf m/small.gltf");
  fs::create_directory(path("o"));
  const auto before = names();
  const ToolResult result = run("convert m/small.gltf o/small.gltf");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("the output is a copy of the input"), std::string::npos) << result.out;
  auto after = before;
  after.insert({"o/small.gltf", made("o/small"), "o/sub dir/a.png"});
  EXPECT_EQ(names(), after);
  EXPECT_EQ(contentOf(path("o/small.gltf")), contentOf(path("m/small.gltf")));
  EXPECT_EQ(contentOf(path(made("o/small"))), contentOf(path(made("m/small"))));
  expectDone("decode o/small.gltf o/back.gltf");
}

TEST_F(GltfOutput, DataUrisAndSeveralBuffersAreRead) {
  // Move the second half of the buffer views to another buffer, and the first to a data URI.
  Json json = json_;
  json.erase("images");
  uint64_t split = 0;
  for (size_t i = 0; i < json["bufferViews"].size(); ++i) {
    Json& view = json["bufferViews"][i];
    if (i == 2) split = view["byteOffset"];
    if (i < 2) continue;
    view["byteOffset"] = view["byteOffset"].get<uint64_t>() - split;
    view["buffer"] = 1;
  }
  const std::string base64 = base64Of({reinterpret_cast<const uint8_t*>(bin_.data()), split});
  json["buffers"] = {
      {{"byteLength", split}, {"uri", "data:application/octet-stream;base64," + base64}},
      {{"byteLength", bin_.size() - split}, {"uri", "m%2dx/second.bin"}}};
  fs::create_directory(path("m-x"));
  store("m-x/second.bin", bin_.substr(split));
  store("two.gltf", json.dump());
  expectDone("convert two.gltf two_out.gltf");
  expectDone("convert in.glb one_out.gltf");
  EXPECT_EQ(contentOf(path(made("two_out"))), contentOf(path(made("one_out"))));
}

TEST_F(GltfOutput, UnsafeUrisAreRefused) {
  store("secret.png", "secret");
  fs::create_directory(path("o"));
  for (const std::string& uri :
       {path("secret.png").string(), "file://" + path("secret.png").string(),
        std::string("../secret.png"), std::string("..%2Fsecret.png"),
        std::string("sub dir/../../secret.png")}) {
    json_["images"] = {{{"uri", uri}}};
    store("m/a.gltf", json_.dump());
    expectRefused("convert m/a.gltf o/b.gltf", "/images/0/uri: the URI ");
    expectRefused("decode m/a.gltf o/b.gltf", "/images/0/uri: the URI ");
  }
}

TEST_F(GltfOutput, NamesThatUrisCannotHave) {
  expectDone("convert in.glb 'a:b.gltf'");
  EXPECT_EQ(jsonAt("a:b.gltf")["buffers"][0]["uri"], "./a%3Ab" + made("a:b").substr(3));
  expectDone("decode 'a:b.gltf' back.glb");
  expectDone("convert in.glb '100%.gltf'");
  EXPECT_EQ(jsonAt("100%.gltf")["buffers"][0]["uri"], "100%25" + made("100%").substr(4));
  expectDone("decode '100%.gltf' back.glb");
  expectRefused(R"(convert in.glb 'a\b.gltf')", "no URI can name a file");
}

TEST_F(GltfOutput, ReplacementLeavesNoTemporaryFiles) {
  {
    ReplacementFile file(path("m/mesh.bin"));
    ASSERT_TRUE(file.write(asBytes("new")).ok());
    ASSERT_TRUE(file.commit().ok());
  }
  EXPECT_EQ(contentOf(path("m/mesh.bin")), "new");
  EXPECT_EQ(names(),
            (std::set<std::string>{"in.glb", "m/a.gltf", "m/mesh.bin", "m/sub dir/a.png"}));
  ReplacementFile late(path("m/mesh.bin"));
  ASSERT_TRUE(late.write(asBytes("other")).ok());
  EXPECT_FALSE(late.commitNew().ok());
  EXPECT_EQ(contentOf(path("m/mesh.bin")), "new");
}

class Fallback : public GltfOutput {
 protected:
  /// Loads a file of the folder as a program that does not know the extension.
  PlainDocument load(const std::string& name) {
    Files files;
    for (const std::string& file : names()) {
      const std::string content = contentOf(path(file));
      files[file] = {content.begin(), content.end()};
    }
    PlainDocument document;
    EXPECT_EQ(document.load(files, name), "");
    return document;
  }
};

TEST_F(Fallback, HoldsWhatThePayloadHolds) {
  for (const std::string name : {"out.glb", "out.gltf"}) {
    expectDone("convert in.glb " + name + " --fallback");
    expectDone("convert in.glb plain.glb");
    expectDone("decode plain.glb decoded.glb");
    const Json json = load(name).json;
    EXPECT_EQ(json["extensionsUsed"], Json::array({"KHR_mesh_collapse_compression"}));
    EXPECT_FALSE(json.contains("extensionsRequired"));
    ASSERT_EQ(json["buffers"].size(), 2u);
    const std::string fallback_name = made("out", ".fallback.bin");
    EXPECT_EQ(json["buffers"][1]["uri"], fallback_name);

    // A loader that does not know the extension reads the accessors as they stand.
    const PlainDocument fallback = load(name);
    const PlainDocument decoded = load("decoded.glb");
    ASSERT_EQ(json["accessors"].size(), decoded.json["accessors"].size());
    for (uint32_t i = 0; i < json["accessors"].size(); ++i) {
      EXPECT_TRUE(json["accessors"][i].contains("bufferView"));
      ASSERT_EQ(json["accessors"][i].value("min", Json()),
                decoded.json["accessors"][i].value("min", Json()));
      EXPECT_TRUE(fallback.elements(i).values == decoded.elements(i).values) << i;
    }
    // A loader that knows it does not need the second file.
    expectDone("decode " + name + " back.glb");
    EXPECT_EQ(fs::file_size(path("back.glb")), fs::file_size(path("decoded.glb")));
    fs::remove(path(fallback_name));
    const ToolResult result = run("decode " + name + " back.glb");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("this fallback is not needed"), std::string::npos) << result.out;
    EXPECT_EQ(fs::file_size(path("back.glb")), fs::file_size(path("decoded.glb")));
  }
}

TEST_F(Fallback, IsReplacedWithItsFileOnly) {
  store("out.fallback.bin", "precious");
  expectDone("convert in.glb out.glb --fallback");
  const std::string first = made("out", ".fallback.bin");
  expectDone("convert in.glb out.glb --fallback --lossless");
  EXPECT_NE(made("out", ".fallback.bin"), first);
  EXPECT_EQ(contentOf(path("out.fallback.bin")), "precious");
  expectRefused("convert in.glb - --fallback", "a fallback is a second file");
}

TEST_F(Fallback, AMissingBufferOfAnythingElseIsAnError) {
  expectDone("convert in.glb out.gltf --fallback");
  Json json = jsonAt("out.gltf");
  const Json view = json["accessors"][0]["bufferView"];
  json["accessors"].push_back(
      {{"bufferView", view}, {"componentType", 5126}, {"count", 1}, {"type", "VEC3"}});
  store("out.gltf", json.dump());
  expectDone("decode out.gltf back.glb");
  const std::string fallback = made("out", ".fallback.bin");
  fs::remove(path(fallback));
  expectRefused("decode out.gltf back.glb", fallback + "\": there is no such file");
}

TEST_F(Fallback, SurvivesACopy) {
  expectDone("convert in.glb out.glb --fallback");
  fs::create_directory(path("o"));
  expectDone("convert out.glb o/again.glb");
  EXPECT_EQ(contentOf(path("o/again.glb")), contentOf(path("out.glb")));
  EXPECT_EQ(contentOf(path(made("o/out", ".fallback.bin"))),
            contentOf(path(made("out", ".fallback.bin"))));
}

}  // namespace
}  // namespace mcc::gltf::test
