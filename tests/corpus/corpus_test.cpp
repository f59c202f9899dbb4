// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Every model of the corpus: convert (which checks the result), decode, and Khronos' validator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "gltf/files/file_io.h"
#include "gltf/scene_positions.h"
#include "mcc/files.h"
#include "support/document_compare.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

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
  }

  const mcc::test::ScratchFolder scratch_;
  const fs::path folder_ = scratch_.path();
};

TEST_F(Corpus, ConvertsAndDecodes) { convertAll(models(false), {}, folder_); }

void compareFiles(const fs::path& source_path, const fs::path& decoded_path, bool keeps_order) {
  std::vector<uint8_t> source, decoded;
  ASSERT_TRUE(readFile(source_path, source).ok());
  ASSERT_TRUE(readFile(decoded_path, decoded).ok());
  EXPECT_EQ(differenceOfPrimitives(source, decoded, keeps_order), "");
}

/// Lossless: the number of vertices stays, and so do the triangles over bit-equal attributes; with
/// both orders kept, also all bytes and the expanded indices. Only reading is shared with the
/// library's own check.
void compareLossless(const std::vector<fs::path>& files, const fs::path& folder) {
  for (const bool keeps_order : {false, true}) {
    ConvertOptions options;
    options.lossless = true;
    options.keep_vertex_order = options.keep_triangle_order = keeps_order;
    convertAll(files, options, folder);
    for (const fs::path& file : files) {
      SCOPED_TRACE(file.filename().string());
      compareFiles(file, folder / ("decoded_" + file.filename().string()), keeps_order);
    }
  }
}

TEST_F(Corpus, Lossless) { compareLossless(models(false), folder_); }

TEST_F(Corpus, LargeModelsLossless) { compareLossless(models(true), folder_); }

/// Integers show the same as floats, and the validator has no objection.
TEST_F(Corpus, DecodesToIntegers) {
  const std::vector<fs::path> files = models(false);
  convertAll(files, {}, folder_);
  mcc::test::Validator validator(folder_);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    const fs::path floats = folder_ / ("decoded_" + file.filename().string());
    const fs::path integers = folder_ / ("integers_" + file.filename().string());
    DecodeReport report;
    const Result result =
        decodeFile(folder_ / file.filename(), integers, report, {DecodeTo::kIntegers});
    ASSERT_TRUE(result.ok()) << result.message();
    std::vector<uint8_t> float_bytes, integer_bytes;
    ASSERT_TRUE(readFile(floats, float_bytes).ok());
    ASSERT_TRUE(readFile(integers, integer_bytes).ok());
    EXPECT_LE(integer_bytes.size(), float_bytes.size() + 1000);
    const SceneDifference difference = compareScenes(float_bytes, integer_bytes);
    EXPECT_GE(difference.off, 0);
    EXPECT_LE(difference.off, 2e-6 * difference.largest);
    validator.add(file, folder_ / file.filename(), integers);
  }
  if (mcc::test::Validator::whyNot().empty()) {
    EXPECT_TRUE(validator.run()) << "the lines above name what is new";
  }
}

TEST_F(Corpus, LargeModelsConvertAndDecode) { convertAll(models(true), {}, folder_); }

/// Runs Khronos' validator on sources and results: no error or warning that the source does not
/// have.
TEST_F(Corpus, ValidatorFindsNothingNew) {
  const std::string missing = mcc::test::Validator::whyNot();
  if (!missing.empty()) GTEST_SKIP() << missing;
  const std::vector<fs::path> files = models(false);
  convertAll(files, {}, folder_);
  mcc::test::Validator validator(folder_);
  for (const fs::path& file : files) {
    validator.add(file, folder_ / file.filename(),
                  folder_ / ("decoded_" + file.filename().string()));
  }
  EXPECT_TRUE(validator.run()) << "the lines above name what is new";
}

}  // namespace
}  // namespace mcc::gltf::test
