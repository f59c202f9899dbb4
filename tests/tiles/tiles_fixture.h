// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the tests of `gltf-mcc tiles` share.
#ifndef MCC_TESTS_TILES_TILES_FIXTURE_H_
#define MCC_TESTS_TILES_TILES_FIXTURE_H_

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <map>

#include "cli/run_tool.h"
#include "gltf/scene_positions.h"
#include "mcc/glb.h"
#include "tiles/tile_file.h"
#include "tiles/tileset_builder.h"

namespace mcc::test {

using Position = std::array<float, 3>;
using Files = std::map<std::string, std::string>;

inline Bytes bytesOf(const std::filesystem::path& path) {
  const std::string content = contentOf(path);
  return {content.begin(), content.end()};
}

/// Returns the models of a tile as they are stored.
inline std::vector<Bytes> modelsOf(const Bytes& file) {
  tiles::TileFile tile;
  const gltf::Result read = tile.read(file);
  EXPECT_TRUE(read.ok()) << read.message();
  std::vector<Bytes> models;
  for (const tiles::TileModel& model : tile.models()) {
    models.emplace_back(file.begin() + static_cast<ptrdiff_t>(model.begin),
                        file.begin() + static_cast<ptrdiff_t>(model.end));
  }
  return models;
}

inline std::vector<Position> positionsOf(const Bytes& model) {
  Bytes decoded;
  gltf::DecodeReport report;
  gltf::Result result = gltf::decodeGlb(model, decoded, report);
  EXPECT_TRUE(result.ok()) << result.message();
  gltf::Document document;
  result = gltf::loadDocument(decoded, nullptr, document);
  EXPECT_TRUE(result.ok()) << result.message();
  if (!result.ok()) return {};
  const auto accessor =
      document.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<uint32_t>();
  const std::vector<double> numbers = gltf::test::SceneReader::numbers(document, accessor);
  std::vector<Position> positions;
  for (size_t i = 0; i + 2 < numbers.size(); i += 3) {
    positions.push_back({static_cast<float>(numbers[i]), static_cast<float>(numbers[i + 1]),
                         static_cast<float>(numbers[i + 2])});
  }
  return positions;
}

inline double distanceOf(const Position& a, const Position& b) {
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += (double{a[c]} - b[c]) * (double{a[c]} - b[c]);
  return std::sqrt(sum);
}

inline const Position& nearest(const Position& to, const std::vector<Position>& positions) {
  size_t best = 0;
  for (size_t i = 1; i < positions.size(); ++i) {
    if (distanceOf(to, positions[i]) < distanceOf(to, positions[best])) best = i;
  }
  return positions[best];
}

/// Runs `gltf-mcc tiles` on the terrain of storeTerrain(), which is in the folder `in`.
class TilesTest : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
    storeTerrain(path("in"));
  }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  ToolResult run(const std::string& arguments) const { return runTool(folder_, arguments); }

  /// Returns the files of a folder and below with their contents, without our record.
  Files filesOf(const std::string& name) const {
    Files files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path(name))) {
      if (entry.is_directory() || entry.path().filename().string().starts_with(".gltf-mcc-tiles."))
        continue;
      files[entry.path().lexically_relative(path(name)).generic_string()] = contentOf(entry.path());
    }
    return files;
  }

  /// Starts the tool without waiting for it.
  pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = fork();
    if (child != 0) return child;
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
    becomeTool(folder_, arguments);
  }

  /// Compares the positions of the models of one file with their sources.
  void expectWithin(const std::string& source, const std::string& name,
                    const std::vector<double>& promised_errors) const {
    const std::vector<Bytes> sources = modelsOf(bytesOf(path(source) / name));
    const std::vector<Bytes> models = modelsOf(bytesOf(path("out") / name));
    ASSERT_EQ(models.size(), sources.size()) << name;
    ASSERT_EQ(models.size(), promised_errors.size()) << name;
    for (size_t m = 0; m < models.size(); ++m) {
      EXPECT_LT(models[m].size(), sources[m].size() / 2) << name;
      const std::vector<Position> decoded = positionsOf(models[m]);
      const std::vector<Position> before = positionsOf(sources[m]);
      ASSERT_EQ(decoded.size(), before.size()) << name;
      double largest = 0;
      for (const Position& position : before) {
        largest = std::max(largest, distanceOf(position, nearest(position, decoded)));
      }
      EXPECT_LE(largest, promised_errors[m]) << name;
      // Much less would mean that the promise was not used.
      EXPECT_GT(largest, promised_errors[m] / 8) << name;
    }
  }

  /// Checks that positions which several tiles have in common decode to equal bits. Returns how
  /// many there are.
  size_t expectClosedBorders(const std::string& source,
                             const std::vector<std::string>& names) const {
    std::map<Position, Position> known;
    size_t shared_count = 0;
    for (const std::string& name : names) {
      const std::vector<Position> before = positionsOf(modelsOf(bytesOf(path(source) / name))[0]);
      const std::vector<Position> decoded = positionsOf(modelsOf(bytesOf(path("out") / name))[0]);
      for (const Position& position : before) {
        const auto [found, is_new] = known.try_emplace(position, nearest(position, decoded));
        if (is_new) continue;
        ++shared_count;
        EXPECT_EQ(found->second, nearest(position, decoded)) << name;
      }
    }
    return shared_count;
  }

  ScratchFolder folder_;
};

}  // namespace mcc::test

#endif  // MCC_TESTS_TILES_TILES_FIXTURE_H_
