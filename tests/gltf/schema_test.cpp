// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks extension objects, of files written here and of the conformance suite, against the JSON
// Schema (npm's ajv).
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gltf/files/file_io.h"
#include "gltf/round_trip.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = MCC_SOURCE_DIR;

/// Files that together have every kind of extension object.
class SchemaList {
 public:
  explicit SchemaList(fs::path folder) : folder_(std::move(folder)) {}

  void add(const char* verdict, const fs::path& file) {
    std::ofstream(list(), std::ios::app) << verdict << " " << file.string() << "\n";
  }
  void add(const std::vector<uint8_t>& file) {
    const fs::path path = folder_ / (std::to_string(count_++) + ".glb");
    ASSERT_TRUE(writeFile(path, file).ok());
    add("valid", path);
  }
  bool check() const {
    const auto quoted = [](const fs::path& path) { return " '" + path.string() + "'"; };
    const std::string command =
        "node" + quoted(kRoot / "tests/support/check_schema.mjs") +
        quoted(kRoot / "tests/web/node_modules") +
        quoted(kRoot / "extension-spec/KHR_mesh_collapse_compression/schema" /
               "mesh.primitive.KHR_mesh_collapse_compression.schema.json") +
        quoted(list());
    return std::system(command.c_str()) == 0;
  }

 private:
  fs::path list() const { return folder_ / "list"; }

  fs::path folder_;
  uint32_t count_ = 0;
};

/// All options that change what extension objects look like.
std::vector<ConvertOptions> manyOptions() {
  std::vector<ConvertOptions> all(7, evenIfLarger());
  all[1].lossless = true;
  all[2].indices_only = true;
  all[3].keep_vertex_order = all[3].keep_triangle_order = true;
  all[4].grid = Grid::kPrimitive;
  all[5].grid = Grid::kScene;
  all[6].indices_only = all[6].keep_vertex_order = true;
  return all;
}

TEST(Schema, ExtensionObjectsAreValid) {
  if (!fs::exists(kRoot / "tests/web/node_modules/ajv")) {
    GTEST_SKIP() << "no ajv in tests/web/node_modules (npm ci)";
  }
  if (!mcc::test::hasNode()) GTEST_SKIP() << "no node";
  const mcc::test::ScratchFolder scratch;
  SchemaList list(scratch.path());
  for (const auto& entry : fs::directory_iterator(MCC_SAMPLES_DIR)) {
    if (entry.path().extension() != ".glb") continue;
    std::vector<uint8_t> source;
    ASSERT_TRUE(readFile(entry.path(), source).ok());
    for (const ConvertOptions& options : manyOptions()) {
      std::vector<uint8_t> converted;
      ConvertReport report;
      ASSERT_EQ(convertGlb(source, options, converted, report).message(), "") << entry.path();
      if (!report.payloads.empty()) list.add(converted);
    }
  }
  const fs::path suite = kRoot / "tests/conformance";
  for (const auto& entry : fs::directory_iterator(suite / "assets"))
    list.add("valid", entry.path());
  for (const char* name : {"attributes_no_object", "buffer_view_no_integer", "extension_no_object",
                           "negative_part", "no_buffer_view"}) {
    list.add("invalid", suite / "negative" / ("restrictions_" + std::string(name) + ".glb"));
  }
  EXPECT_TRUE(list.check()) << "the lines above say what is wrong";
}

}  // namespace
}  // namespace mcc::gltf::test
