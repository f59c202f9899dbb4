// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Files above 4 GiB, which only a GLB of version 3 can be. They are sparse: almost all of their
// bytes are zeros that take no room on the disk.
#include <gtest/gtest.h>

#include <fstream>

#include "gltf/round_trip.h"
#include "mcc/files.h"
#include "support/scratch_folder.h"

namespace mcc::gltf::test {
namespace {

constexpr uint64_t kGibibyte = uint64_t{1} << 30;
constexpr uint64_t kMeshAt = 5 * kGibibyte;  // in the BIN chunk

/// Returns the bytes of memory that are free; 0 where nobody tells.
uint64_t freeMemoryBytes() {
  std::ifstream lines("/proc/meminfo");
  for (std::string name; lines >> name;) {
    uint64_t kibibytes = 0;
    if (name == "MemAvailable:" && lines >> kibibytes) return kibibytes << 10;
  }
  return 0;
}

bool isSparse(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "hole";
  const auto before = std::filesystem::space(folder).free;
  std::ofstream(path).put(1);
  std::filesystem::resize_file(path, kMeshAt);
  const auto after = std::filesystem::space(folder).free;
  std::filesystem::remove(path);
  return after + kGibibyte > before;
}

/// Writes a GLB whose mesh begins after 5 GiB. `has_view`: a buffer view needs the zeros before it.
void writeLarge(const std::filesystem::path& path, bool has_view) {
  Builder builder;
  builder.addMesh({Sheet(12).addTo(builder)});
  for (Json& view : builder.json["bufferViews"]) {
    view["byteOffset"] = view["byteOffset"].get<uint64_t>() + kMeshAt;
  }
  if (has_view) {
    const uint32_t view =
        builder.push("bufferViews", {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", kMeshAt}});
    builder.push("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  }
  builder.json["buffers"] = {{{"byteLength", kMeshAt + builder.bin.size()}, {"chunk", 1}}};
  // Both lengths count the zeros, too.
  std::vector<uint8_t> start = glb3Of({jsonChunk(printJson(builder.json)), binChunk({})});
  const uint64_t bin_at = start.size();
  std::vector<uint8_t> length;
  append(length, bin_at + kMeshAt + builder.bin.size(), 8);
  append(length, kMeshAt + builder.bin.size(), 8);
  std::copy(length.begin(), length.begin() + 8, start.begin() + 8);
  std::copy(length.begin() + 8, length.end(), start.end() - 8);
  std::ofstream file(path, std::ios::binary);
  const auto put = [&](const std::vector<uint8_t>& bytes) {
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  };
  put(start);
  file.seekp(static_cast<std::streamoff>(bin_at + kMeshAt));
  put(builder.bin);
}

std::string whySkipped(const std::filesystem::path& folder, uint64_t needed_bytes) {
  if (!isSparse(folder)) return "the file system has no sparse files";
  return freeMemoryBytes() >= needed_bytes ? "" : "there is too little free memory";
}

TEST(LargeGlb, LargeSourceOfASmallResult) {
  const mcc::test::ScratchFolder folder;
  const std::string reason = whySkipped(folder.path(), 7 * kGibibyte);
  if (!reason.empty()) GTEST_SKIP() << reason;
  writeLarge(folder.path() / "large.glb", false);
  ConvertReport report;
  const Result result =
      convertFile(folder.path() / "large.glb", folder.path() / "small.glb", {}, report);
  ASSERT_TRUE(result.ok()) << result.message();
  EXPECT_GT(report.input_bytes, 5 * kGibibyte);
  EXPECT_LT(report.output_bytes, 20000u);
  EXPECT_EQ(report.primitives.at(0).note, "");
}

TEST(LargeGlb, LargeResult) {
  const mcc::test::ScratchFolder folder;
  const std::string reason = whySkipped(folder.path(), 16 * kGibibyte);
  if (!reason.empty()) GTEST_SKIP() << reason;
  writeLarge(folder.path() / "large.glb", true);
  ConvertReport report;
  ConvertOptions options;
  options.glb_version = GlbVersion::k2;
  Result result =
      convertFile(folder.path() / "large.glb", folder.path() / "out.glb", options, report);
  EXPECT_NE(result.message().find("a GLB of version 2 cannot be larger than 4 GiB"),
            std::string::npos)
      << result.message();
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out.glb"));
  result = convertFile(folder.path() / "large.glb", folder.path() / "out.glb", {}, report);
  ASSERT_TRUE(result.ok()) << result.message();
  EXPECT_GT(report.output_bytes, 5 * kGibibyte);
  std::ifstream written(folder.path() / "out.glb", std::ios::binary);
  std::vector<uint8_t> header(16);
  written.read(reinterpret_cast<char*>(header.data()), 16);
  EXPECT_EQ(header[4], 3);
  EXPECT_EQ(glbLength(header), std::filesystem::file_size(folder.path() / "out.glb"));
}

}  // namespace
}  // namespace mcc::gltf::test
