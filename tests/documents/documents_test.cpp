// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Sends random documents through convert() and decode(), and compares them by independent code and
// by Khronos' validator. MCC_DOCUMENTS is their number (300 by default), MCC_FIRST_SEED the first
// seed (1). The message of a failure has its seed: MCC_FIRST_SEED=4711 MCC_DOCUMENTS=1
// test_documents. With MCC_DOCUMENTS_LOG each seed is printed before it runs; MCC_DOCUMENTS_KEEP
// names a folder for the files.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "documents/random_document.h"
#include "foreign/decoders.h"
#include "gltf/files/file_io.h"
#include "mcc/files.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;

uint64_t environmentNumber(const char* name, uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

struct Seeds {
  uint64_t first = environmentNumber("MCC_FIRST_SEED", 1);
  uint64_t count = environmentNumber("MCC_DOCUMENTS", 300);

  template <typename Run>
  void forEach(const char* what, const Run& run) const {
    std::printf("%s of seeds %llu to %llu\n", what, static_cast<unsigned long long>(first),
                static_cast<unsigned long long>(first + count - 1));
    const bool is_logged = std::getenv("MCC_DOCUMENTS_LOG") != nullptr;
    for (uint64_t seed = first; seed < first + count; ++seed) {
      if (is_logged) std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
      std::fflush(stdout);
      SCOPED_TRACE("seed " + std::to_string(seed));
      run(seed);
    }
  }
};

/// The document of a seed. Those that were made last are kept, since each test wants them.
const RandomDocument& documentOf(uint64_t seed) {
  constexpr size_t kMostKept = 300;
  static std::map<uint64_t, RandomDocument> kept;
  const auto found = kept.find(seed);
  if (found != kept.end()) return found->second;
  if (kept.size() == kMostKept) kept.clear();
  return kept[seed] = randomDocument(seed);
}

/// Returns the files of a folder, without those in subfolders.
Files filesIn(const fs::path& folder) {
  Files files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const Result result = readFile(entry.path(), files[entry.path().filename().string()]);
    EXPECT_TRUE(result.ok()) << result.message();
  }
  return files;
}

/// Whether a file is a GLB of the version that Khronos' validator does not read.
bool isGlb3(const Files& files, const std::string& name) {
  const auto file = files.find(name);
  return file != files.end() && isGlb(file->second) && glbVersion(file->second) == 3;
}

void writeFiles(const fs::path& folder, const Files& files) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const auto& [name, bytes] : files) EXPECT_TRUE(writeFile(folder / name, bytes).ok());
}

/// A message is one line, and never reports an internal error.
void expectClean(const std::string& message) {
  for (const char* ours : {"please report", "internal error", "exception"}) {
    EXPECT_EQ(message.find(ours), std::string::npos) << message;
  }
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

/// A document during a test: in memory, or from folder to folder.
class Way {
 public:
  explicit Way(const fs::path& folder)
      : in_(folder / "in"),
        out_(folder / "out"),
        back_(folder / "back"),
        again_(folder / "again") {}

  Result convertDocument(RandomDocument& document) {
    document.options.decoders = foreign::foreignDecoders();
    writeFiles(in_, document.files);
    converted_name = document.writes_gltf ? "out.gltf" : "out.glb";
    return convertFrom(in_ / document.main, document.files.at(document.main), document, out_,
                       converted, report);
  }

  Result decodeConverted(const RandomDocument& document, DecodeTo to) {
    return decodeFrom(out_ / converted_name, converted[converted_name], document, back_, to,
                      decoded);
  }

  /// Decodes and converts the results again.
  Result decodeAgain(const RandomDocument& document, Files& files) {
    return decodeFrom(back_ / converted_name, decoded[converted_name], document, again_,
                      DecodeTo::kFloats, files);
  }
  Result convertAgain(const RandomDocument& document, Files& files, ConvertReport& other) {
    return convertFrom(out_ / converted_name, converted[converted_name], document, again_, files,
                       other);
  }

  Result validateConverted(const RandomDocument& document, ValidationReport& validation) {
    if (document.to_memory) return validateGlb(converted[converted_name], {}, validation);
    return validate({out_ / converted_name, {}}, {}, validation);
  }

  std::string converted_name;
  Files converted;
  Files decoded;
  ConvertReport report;
  DecodeReport decode_report;

 private:
  Result convertFrom(const fs::path& path, const Bytes& bytes, const RandomDocument& document,
                     const fs::path& folder, Files& files, ConvertReport& to_report) {
    files.clear();
    fs::remove_all(folder);
    fs::create_directories(folder);
    if (document.to_memory) {
      return convert({path.filename(), bytes}, {{}, &files[converted_name]}, document.options,
                     to_report);
    }
    const Result result =
        convert({path, {}}, {folder / converted_name}, document.options, to_report);
    files = filesIn(folder);
    return result;
  }

  Result decodeFrom(const fs::path& path, const Bytes& bytes, const RandomDocument& document,
                    const fs::path& folder, DecodeTo to, Files& files) {
    DecodeOptions options;
    options.decode_to = to;
    files.clear();
    fs::remove_all(folder);
    fs::create_directories(folder);
    if (document.to_memory)
      return decode({path.filename(), bytes}, {{}, &files[converted_name]}, decode_report, options);
    const Result result = decode({path, {}}, {folder / converted_name}, decode_report, options);
    files = filesIn(folder);
    return result;
  }

  fs::path in_, out_, back_, again_;
};

void keepForPeople(uint64_t seed, const RandomDocument& document, const Way& way) {
  const char* folder = std::getenv("MCC_DOCUMENTS_KEEP");
  if (folder == nullptr) return;
  const fs::path path = fs::path(folder) / std::to_string(seed);
  writeFiles(path / "source", document.files);
  writeFiles(path / "converted", way.converted);
  writeFiles(path / "decoded", way.decoded);
}

class Documents : public ::testing::Test {
 protected:
  /// Puts everything into a folder of its own, for the validator.
  fs::path keep(const std::string& name, const Files& files, const std::string& main) {
    writeFiles(folder_.path() / name, files);
    return folder_.path() / name / main;
  }

  mcc::test::ScratchFolder folder_;
};

void expectEqualDocuments(const RandomDocument& document, const Way& way, const Files& decoded) {
  PlainDocument source, converted, back;
  ASSERT_EQ(source.load(document.files, document.main), "") << "the source";
  ASSERT_EQ(converted.load(way.converted, way.converted_name), "") << "the converted file";
  ASSERT_EQ(back.load(decoded, way.converted_name), "") << "the decoded file";
  ASSERT_EQ(differenceOf(source, converted, back, document.options, document.kept, way.report), "")
      << describe(document.options);
}

/// A converted document can be converted again, or there is nothing left to do.
void expectSameAgain(const RandomDocument& document, Way& way) {
  Files again;
  ASSERT_EQ(way.decodeAgain(document, again).message(), "") << "decoded again";
  ASSERT_EQ(again, way.decoded) << "decoded again";
  ConvertReport report;
  ASSERT_EQ(way.convertAgain(document, again, report).message(), "") << "converted again";
  if (report.copied) {
    ASSERT_EQ(again[way.converted_name], way.converted[way.converted_name]) << "converted again";
  }
}

TEST_F(Documents, ComeBackAsTheyWere) {
  const std::string no_validator = mcc::test::Validator::whyNot();
  mcc::test::Validator validator(folder_.path());
  uint64_t compressed_count = 0;
  uint64_t primitive_count = 0;
  uint64_t validated_count = 0;
  const auto runValidator = [&] {
    EXPECT_TRUE(!no_validator.empty() || validated_count % 500 == 0 || validator.run(true));
  };
  Seeds().forEach("documents", [&](uint64_t seed) {
    RandomDocument document = documentOf(seed);
    Way way(folder_.path());
    const Result result = way.convertDocument(document);
    expectClean(result.message());
    for (const std::string& note : way.report.notes) expectClean(note);
    keepForPeople(seed, document, way);
    ASSERT_EQ(result.message(), "") << describe(document.options);
    ASSERT_EQ(way.decodeConverted(document, DecodeTo::kFloats).message(), "")
        << describe(document.options);
    keepForPeople(seed, document, way);
    for (const PrimitiveReport& primitive : way.report.primitives) {
      primitive_count += 1;
      if (primitive.compressed) compressed_count += 1;
    }
    expectEqualDocuments(document, way, way.decoded);
    ValidationReport validation;
    ASSERT_EQ(way.validateConverted(document, validation).message(), "");
    for (const ValidationIssue& issue : validation.issues) {
      if (issue.message == "POSITION needs min and max") continue;  // as the source does
      EXPECT_TRUE(issue.severity != Severity::kError)
          << issue.code << " " << issue.message << " " << issue.pointer;
    }
    expectSameAgain(document, way);
    const bool can_validate = no_validator.empty() && !isGlb3(document.files, document.main) &&
                              !isGlb3(way.converted, way.converted_name) &&
                              !isGlb3(way.decoded, way.converted_name);
    if (!can_validate) return;
    const std::string name = std::to_string(seed);
    const fs::path source = keep("validated/" + name + "_source", document.files, document.main);
    const fs::path converted =
        keep("validated/" + name + "_converted", way.converted, way.converted_name);
    const fs::path decoded =
        keep("validated/" + name + "_decoded", way.decoded, way.converted_name);
    validator.add(source, converted, decoded);
    if (seed % 2 == 0) {
      const Files floats = way.decoded;
      ASSERT_EQ(way.decodeConverted(document, DecodeTo::kIntegers).message(), "")
          << describe(document.options);
      validator.add(source, converted,
                    keep("validated/" + name + "_integers", way.decoded, way.converted_name));
      way.decoded = floats;
    }
    if (++validated_count % 500 == 0) {
      EXPECT_TRUE(validator.run(true));
      fs::remove_all(folder_.path() / "validated");
      fs::remove(folder_.path() / "list");
    }
  });
  runValidator();
  std::printf("%llu of %llu primitives were compressed; validator: %s\n",
              static_cast<unsigned long long>(compressed_count),
              static_cast<unsigned long long>(primitive_count),
              no_validator.empty() ? "yes" : no_validator.c_str());
}

/// Either one line and nothing written, or a document that works.
TEST_F(Documents, DamagedOnesAreRefusedInOneLine) {
  uint64_t refused_count = 0;
  Seeds().forEach("damaged documents", [&](uint64_t seed) {
    RandomDocument document = documentOf(seed);
    damage(seed, document);
    Way way(folder_.path());
    const Result result = way.convertDocument(document);
    expectClean(result.message());
    for (const std::string& note : way.report.notes) expectClean(note);
    if (!result.ok()) {
      ++refused_count;
      EXPECT_TRUE(document.to_memory || way.converted.empty()) << "something was written";
      return;
    }
    ASSERT_EQ(way.decodeConverted(document, DecodeTo::kFloats).message(), "")
        << describe(document.options);
  });
  std::printf("%llu were refused\n", static_cast<unsigned long long>(refused_count));
}

TEST_F(Documents, DamagedCompressedOnesAreRefusedInOneLine) {
  Seeds().forEach("damaged compressed documents", [&](uint64_t seed) {
    RandomDocument document = documentOf(seed);
    document.options.allow_larger = true;
    Way way(folder_.path());
    if (!way.convertDocument(document).ok()) return;  // the test above reports this
    for (uint64_t k = 0; k < 3; ++k) {
      const Bytes undamaged = way.converted[way.converted_name];
      damageGlb(3 * seed + k, way.converted[way.converted_name]);
      writeFiles(folder_.path() / "out", way.converted);
      for (const DecodeTo to : {DecodeTo::kFloats, DecodeTo::kIntegers}) {
        const Result result = way.decodeConverted(document, to);
        expectClean(result.message());
        EXPECT_TRUE(result.ok() || document.to_memory || way.decoded.empty())
            << "something was written";
      }
      ValidationReport validation;
      expectClean(way.validateConverted(document, validation).message());
      for (const ValidationIssue& issue : validation.issues) expectClean(issue.message);
      Files again;
      ConvertReport report;
      expectClean(way.convertAgain(document, again, report).message());
      way.converted[way.converted_name] = undamaged;
    }
  });
}

TEST_F(Documents, AreReproducible) {
  for (uint64_t seed = 1; seed <= 7; ++seed) {
    const RandomDocument a = randomDocument(seed);
    const RandomDocument b = randomDocument(seed);
    EXPECT_TRUE(a.files == b.files && describe(a.options) == describe(b.options)) << seed;
  }
}

}  // namespace
}  // namespace mcc::gltf::test
