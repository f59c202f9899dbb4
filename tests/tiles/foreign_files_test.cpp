// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a tileset and its models name may be anything: links, pipes, files of other people. Nothing
// from outside of the folder is read, and nothing makes the program wait.
#include <sys/stat.h>

#include "support/made_files.h"
#include "tiles/tiles_fixture.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class ForeignFiles : public TilesTest {
 protected:
  void SetUp() override {
    TilesTest::SetUp();
    fs::create_directory(path("t"));
  }

  /// Stores a model in t/ that has its buffer in another file, and returns the bytes of that.
  Bytes storeModel(const std::string& name, const std::string& buffer) const {
    gltf::test::Builder builder = makePatch(1, 0, 0, false);
    builder.json["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", buffer}}};
    storeText(path("t") / name, gltf::printJson(builder.json));
    return builder.bin;
  }
  void storeTileset(const Json& root, const Json& more = Json::object()) const {
    Json json = makeTileset(root, 64);
    json.update(more);
    storeText(path("t/tileset.json"), json.dump());
  }
  Json implicitRoot() const {
    Json root = makeTile(8, "x.pnts");
    root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                              {"subtreeLevels", 1},
                              {"availableLevels", 1},
                              {"subtrees", {{"uri", "s.json"}}}};
    return root;
  }
  void storeSubtree(const std::string& name, const Json& more = Json::object()) const {
    Json json = {{"tileAvailability", {{"constant", 1}}},
                 {"contentAvailability", {{{"constant", 1}}}},
                 {"childSubtreeAvailability", {{"constant", 0}}}};
    json.update(more);
    storeText(path(name), json.dump());
  }
  /// Runs the command, which ends soon even if it would wait.
  ToolResult runTiles() const {
#ifdef MCC_TOOL_GLTF_MCC
    return runCommand(
        folder_, std::string("timeout 60 '") + MCC_TOOL_GLTF_MCC + "' tiles t/tileset.json out");
#else
    return {};
#endif
  }
};

TEST_F(ForeignFiles, BuffersOutsideOfTheFolderAreNotCopied) {
  const Bytes secret = storeModel("a.gltf", "b.bin");
  storeModel("c.gltf", "folder/b.bin");
  storeBytes(path("secret/b.bin"), secret);
  fs::create_symlink("../secret/b.bin", path("t/b.bin"));
  fs::create_directory_symlink("../secret", path("t/folder"));
  Json root = makeTile(64, "");
  root["children"] = {makeTile(16, "a.gltf"), makeTile(16, "c.gltf")};
  storeTileset(root);
  const ToolResult result = runTiles();
  EXPECT_EQ(result.status, 1);
  for (const char* part :
       {"a.gltf: /buffers/0/uri: \"b.bin\": is a symbolic link out of the folder",
        "c.gltf: /buffers/0/uri: \"folder/b.bin\": is a symbolic link out of the folder"}) {
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  }
  EXPECT_NE(result.out.find("its buffer \"b.bin\" is not copied"), std::string::npos) << result.out;
  const std::string bytes(secret.begin(), secret.end());
  for (const auto& [name, content] : filesOf("out")) {
    EXPECT_EQ(content.find(bytes.substr(0, 64)), std::string::npos) << name;
  }
  EXPECT_EQ(contentOf(path("out/a.gltf")), contentOf(path("t/a.gltf")));
}

TEST_F(ForeignFiles, LinksInsideOfTheFolderAreFollowed) {
  const Bytes bytes = storeModel("models/a.gltf", "b.bin");
  storeBytes(path("t/shared/b.bin"), bytes);
  fs::create_symlink("../shared/b.bin", path("t/models/b.bin"));
  storeTileset(makeTile(16, "models/a.gltf"));
  const ToolResult result = runTiles();
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_LT(fs::file_size(path("out/models/" + madeBeside(path("out/models"), "a"))),
            bytes.size() / 2);
}

TEST_F(ForeignFiles, SubtreesAndSchemasOutsideOfTheFolderAreNotRead) {
  storeText(path("t/x.pnts"), "");
  storeTileset(implicitRoot(), {{"schemaUri", "schema.json"}});
  storeSubtree("s.json");
  storeText(path("schema.json"), "{}");
  fs::create_symlink("../s.json", path("t/s.json"));
  fs::create_symlink("../schema.json", path("t/schema.json"));
  const ToolResult result = runTiles();
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("t/s.json: is a symbolic link out of the folder"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("t/schema.json: is a symbolic link out of the folder"),
            std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(path("out/s.json")));
}

/// Nobody writes to the pipes, so a program that opened one would wait for ever.
TEST_F(ForeignFiles, PipesAreNotOpened) {
  const auto expectRefused = [&](const std::string& name) {
    const ToolResult result = runTiles();
    EXPECT_EQ(result.status, 1) << name;
    EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("is not a regular file"), std::string::npos) << result.err;
    fs::remove_all(path("out"));
  };
  storeText(path("t/x.pnts"), "");
  storeTileset(implicitRoot());
  ASSERT_EQ(mkfifo(path("t/s.json").c_str(), 0600), 0);
  expectRefused("t/s.json");
  fs::remove(path("t/s.json"));
  storeSubtree("t/s.json", {{"buffers", {{{"byteLength", 1}, {"uri", "s.bin"}}}}});
  ASSERT_EQ(mkfifo(path("t/s.bin").c_str(), 0600), 0);
  expectRefused("t/s.bin");
  fs::remove(path("t/s.bin"));
  storeSubtree("t/s.json");
  storeTileset(implicitRoot(), {{"schemaUri", "schema"}});
  ASSERT_EQ(mkfifo(path("t/schema").c_str(), 0600), 0);
  expectRefused("t/schema");
  storeModel("a.gltf", "a.bin");
  ASSERT_EQ(mkfifo(path("t/a.bin").c_str(), 0600), 0);
  storeTileset(makeTile(16, "a.gltf"));
  expectRefused("\"a.bin\"");
}

/// The folder of the tileset may be reached through a link; the tileset itself lies in it.
TEST_F(ForeignFiles, TheFolderMayBeALink) {
  fs::create_directory_symlink("in", path("link"));
  EXPECT_EQ(run("tiles link/tileset.json out").status, 0);
  fs::create_symlink("../in/tileset.json", path("t/tileset.json"));
  const ToolResult result = runTiles();
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("a link to a tileset elsewhere is not followed"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace mcc::test
