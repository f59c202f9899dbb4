// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// `gltf-mcc tiles --to-glb`: names, versions, and what stays.
#include <gtest/gtest.h>

#include "tiles/tiles_fixture.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

class TilesToGlb : public TilesTest {};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST_F(TilesToGlb, NamesChangeAndNothingElseInTheJson) {
  const std::string source = replaced(contentOf(path("in/tileset.json")), "\"1.1\"", "\"1.0\"");
  storeText(path("in/tileset.json"), source);
  const ToolResult result = run("tiles in/tileset.json out --to-glb");
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string expected = replaced(replaced(source, "\"1.0\"", "\"1.1\""), ".b3dm", ".glb");
  EXPECT_EQ(contentOf(path("out/tileset.json")), expected);
  const std::string part = contentOf(path("in/east side/part.json"));
  EXPECT_EQ(contentOf(path("out/east side/part.json")), replaced(part, ".b3dm", ".glb"));
  for (const char* name : {"1/0-0", "1/1-0", "1/0-1", "1/1-1"}) {
    EXPECT_FALSE(fs::exists(path("out") / (name + std::string(".b3dm")))) << name;
    const std::string glb = contentOf(path("out") / (name + std::string(".glb")));
    EXPECT_EQ(glb.substr(0, 4), "glTF") << name;
    EXPECT_NE(glb.find("EXT_mesh_features"), std::string::npos);
    EXPECT_NE(glb.find("EXT_structural_metadata"), std::string::npos);
    EXPECT_NE(glb.find("KHR_mesh_collapse_compression"), std::string::npos);
  }
  // Again, in two parts, and with everything up to date.
  EXPECT_EQ(run("tiles in/tileset.json parts --to-glb --part 1/2").status, 0);
  EXPECT_EQ(run("tiles in/tileset.json parts --to-glb --part 2/2").status, 0);
  EXPECT_TRUE(filesOf("parts") == filesOf("out"));
  const ToolResult again = run("tiles in/tileset.json out --to-glb --format json");
  const Json report = Json::parse(again.out);
  for (const Json& file : report["files"]) EXPECT_TRUE(file["up_to_date"]) << file;
}

TEST_F(TilesToGlb, NoFileLosesItsName) {
  storeBytes(path("in/1/0-0.glb"), makePatchGlb(1, 0, 0));
  const ToolResult result = run("tiles in/tileset.json out --to-glb");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("0-0.glb: is there already"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(path("out")));
}

/// What has no exact counterpart stays a b3dm, with a note.
TEST_F(TilesToGlb, WhatCannotBeTranslatedStays) {
  Tables tables;
  tables.feature_json = paddedJson("{\"BATCH_LENGTH\":2}", 28);
  tables.batch_json =
      paddedJson("{\"extensions\":{\"3DTILES_batch_table_hierarchy\":{\"classes\":[]}}}", 0);
  storeBytes(path("in/1/0-0.b3dm"), makeModelTile("b3dm", tables, makePatchGlb(1, 0, 0, true)));
  const ToolResult result = run("tiles in/tileset.json out --to-glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("1/0-0.b3dm: stays a b3dm: "), std::string::npos) << result.out;
  EXPECT_EQ(contentOf(path("out/1/0-0.glb")).substr(0, 4), "b3dm");
}

}  // namespace
}  // namespace mcc::test
