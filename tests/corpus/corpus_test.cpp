// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Every model of the corpus: convert (which checks the result), decode, and Khronos' validator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gltf/gltf_builder.h"
#include "mcc/gltf.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> models(bool is_large) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(MCC_CORPUS_DIR, ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".glb" && name.starts_with("g_") == is_large) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

fs::path temporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "gltf-mcc-test-XXXXXX").string();
  return ::mkdtemp(pattern.data()) == nullptr ? fs::path() : fs::path(pattern);
}

/// Converts and decodes all models into a folder.
void convertAll(const std::vector<fs::path>& files, const ConvertOptions& options,
                const fs::path& folder) {
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    ConvertReport report;
    const fs::path converted = folder / file.filename();
    const Result result = convertFile(file, converted, options, report);
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_LE(report.output_bytes, report.input_bytes);
    double stream_bits = 0;
    uint64_t payload_bytes = 0;
    for (const PayloadReport& payload : report.payloads) {
      payload_bytes += payload.payload_bytes;
      for (const auto& stream : payload.streams) stream_bits += stream.bits;
      for (const auto& attribute : payload.attributes) {
        stream_bits += attribute.coded_bits;
        EXPECT_LE(attribute.max_error, attribute.promised_error) << attribute.name;
      }
    }
    const double bits = 8 * static_cast<double>(payload_bytes);
    EXPECT_NEAR(stream_bits, bits, 0.001 * bits + 1);
    std::printf("%-24s %9llu -> %9llu bytes\n", file.filename().c_str(),
                static_cast<unsigned long long>(report.input_bytes),
                static_cast<unsigned long long>(report.output_bytes));
    DecodeReport decode_report;
    const Result decoded =
        decodeFile(converted, folder / ("decoded_" + file.filename().string()), decode_report);
    ASSERT_TRUE(decoded.ok()) << decoded.message();
  }
}

class Corpus : public testing::Test {
 protected:
  void SetUp() override {
    if (models(false).empty()) GTEST_SKIP() << "no corpus in " << MCC_CORPUS_DIR;
    folder_ = temporaryFolder();
    ASSERT_FALSE(folder_.empty());
  }
  void TearDown() override {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }

  fs::path folder_;
};

TEST_F(Corpus, ConvertsAndDecodes) { convertAll(models(false), {}, folder_); }

TEST_F(Corpus, Lossless) {
  ConvertOptions options;
  options.lossless = true;
  convertAll(models(false), options, folder_);
}

TEST_F(Corpus, LargeModelsConvertAndDecode) { convertAll(models(true), {}, folder_); }

/// Khronos' validator on sources and results: no error the source does not have.
TEST_F(Corpus, ValidatorFindsNothingNew) {
  const fs::path modules = fs::path(MCC_SOURCE_DIR) / "tests/web/node_modules/gltf-validator";
  if (!fs::exists(modules)) GTEST_SKIP() << "no gltf-validator in tests/web/node_modules";
  if (std::system("node --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no node";
  const std::vector<fs::path> files = models(false);
  convertAll(files, {}, folder_);
  for (const fs::path& file : files) {
    std::ofstream(folder_ / "list", std::ios::app)
        << file.string() << "\n"
        << (folder_ / file.filename()).string() << "\n"
        << (folder_ / ("decoded_" + file.filename().string())).string() << "\n";
  }
  const std::string command = "node '" + std::string(MCC_SOURCE_DIR) +
                              "/tests/corpus/validate.mjs' '" + modules.string() + "' '" +
                              (folder_ / "list").string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << "the lines above name what is new";
}

}  // namespace
}  // namespace mcc::gltf::test
