// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a file as a whole may cost: decoded bytes, payloads that many primitives name, zeros, files
// that never end.
#include <gtest/gtest.h>

#include <fstream>

#include "gltf/files/file_io.h"
#include "gltf/round_trip.h"
#include "support/scratch_folder.h"
#if !defined(_WIN32)
#include <fcntl.h>
#include <unistd.h>
#endif

namespace mcc::gltf::test {
namespace {

// The limit is 256 MiB, more above that by 1024 for each byte, and never above 4 GiB unless the
// caller says so.
static_assert(decodedLimit(0, 0) == uint64_t{1} << 28);
static_assert(decodedLimit(0, (uint64_t{1} << 18) + 1) == (uint64_t{1} << 28) + 1024);
static_assert(decodedLimit(0, uint64_t{1} << 40) == uint64_t{1} << 32);
static_assert(decodedLimit(5, uint64_t{1} << 40) == 5);

constexpr uint32_t kSheet = 12;
constexpr uint64_t kVertices = (kSheet + 1) * (kSheet + 1);
/// POSITION, NORMAL, TEXCOORD_0, indices of 32 bits.
constexpr uint64_t kDecodedBytes = kVertices * 32 + 12 * (2 * kSheet * kSheet);

std::vector<uint8_t> compressedSheet() {
  Builder builder;
  builder.addMesh({Sheet(kSheet).addTo(builder)});
  return roundTrip(builder, evenIfLarger()).converted;
}

/// Repeats the primitive n times with accessors of its own; every other one names the payload by
/// another view of its bytes.
std::vector<uint8_t> multiplied(std::span<const uint8_t> file, size_t n) {
  Json json = jsonOf(file);
  const Json accessors = json["accessors"];
  Json& primitives = json["meshes"][0]["primitives"];
  const Json first = primitives[0];
  const Json view =
      json["bufferViews"][first["extensions"][kExtensionName]["bufferView"].get<size_t>()];
  json["bufferViews"].push_back(view);
  while (primitives.size() < n) {
    const size_t offset = json["accessors"].size();
    for (const Json& accessor : accessors) json["accessors"].push_back(accessor);
    Json primitive = first;
    primitive["indices"] = offset + first["indices"].get<size_t>();
    for (Json& number : primitive["attributes"]) number = offset + number.get<size_t>();
    if (primitives.size() % 2 == 1) {
      primitive["extensions"][kExtensionName]["bufferView"] = json["bufferViews"].size() - 1;
    }
    primitives.push_back(std::move(primitive));
  }
  return withJson(file, json);
}

std::string decodeError(std::span<const uint8_t> file, uint64_t max_decoded_bytes) {
  std::vector<uint8_t> output;
  DecodeReport report;
  DecodeOptions options;
  options.max_decoded_bytes = max_decoded_bytes;
  return decodeGlb(file, output, report, options).message();
}

TEST(FileLimits, APayloadIsDecodedOnceWhoeverNamesIt) {
  const std::vector<uint8_t> file = compressedSheet();
  const std::vector<uint8_t> many = multiplied(file, 40);
  std::vector<uint8_t> one_decoded;
  std::vector<uint8_t> many_decoded;
  DecodeReport report;
  ASSERT_EQ(decodeGlb(file, one_decoded, report).message(), "");
  ASSERT_EQ(decodeGlb(many, many_decoded, report).message(), "");
  EXPECT_EQ(report.payload_count, 1u);
  EXPECT_EQ(report.primitive_count, 40u);
  GlbFile one;
  GlbFile all;
  ASSERT_TRUE(readGlb(one_decoded, one).ok());
  ASSERT_TRUE(readGlb(many_decoded, all).ok());
  EXPECT_EQ(all.bin.size(), one.bin.size());
  const Json json = jsonOf(many_decoded);
  const size_t accessor_count = jsonOf(file)["accessors"].size();
  for (uint32_t i = 0; i < json["accessors"].size(); ++i) {
    EXPECT_EQ(elementsInOrder(many_decoded, i),
              elementsInOrder(one_decoded, static_cast<uint32_t>(i % accessor_count)));
  }
  for (const Json& view : json["bufferViews"]) {
    EXPECT_EQ(view.contains("byteStride"), view["target"] == 34962) << "glTF wants it if shared";
  }
  // As integers they may differ, so each accessor has its own.
  ASSERT_EQ(decodeGlb(many, many_decoded, report, {DecodeTo::kIntegers}).message(), "");
}

TEST(FileLimits, DecodedBytesAreLimitedForTheWholeFile) {
  const std::vector<uint8_t> file = compressedSheet();
  EXPECT_EQ(decodeError(file, kDecodedBytes), "");
  EXPECT_EQ(decodeError(file, kDecodedBytes - 1),
            "its " + std::to_string(file.size()) + " bytes ask for " +
                std::to_string(kDecodedBytes) + " bytes of decoded geometry; the limit is " +
                std::to_string(kDecodedBytes - 1) +
                ", which max_decoded_bytes (--max-decoded-bytes) raises");
  EXPECT_EQ(decodeError(multiplied(file, 30), kDecodedBytes), "") << "counted once";
  // Integers are stored for each accessor, and counted for each.
  std::vector<uint8_t> output;
  DecodeReport report;
  EXPECT_FALSE(
      decodeGlb(multiplied(file, 30), output, report, {DecodeTo::kIntegers, 1, kDecodedBytes})
          .ok());
}

TEST(FileLimits, OfConvertAndValidate) {
  const std::vector<uint8_t> file = compressedSheet();
  std::vector<uint8_t> output;
  ConvertReport report;
  ConvertOptions options;
  options.max_decoded_bytes = kDecodedBytes;
  EXPECT_EQ(convertGlb(file, options, output, report).message(), "");
  options.max_decoded_bytes = kDecodedBytes - 1;
  EXPECT_NE(convertGlb(file, options, output, report).message().find("--max-decoded-bytes"),
            std::string::npos);
  ValidateOptions validate_options;
  ValidationReport validation;
  validate_options.max_decoded_bytes = kDecodedBytes;
  ASSERT_TRUE(validateGlb(file, validate_options, validation).ok());
  EXPECT_TRUE(validation.isValid());
  validate_options.max_decoded_bytes = kDecodedBytes - 1;
  ASSERT_TRUE(validateGlb(file, validate_options, validation).ok());
  ASSERT_EQ(validation.issues.size(), 1u);
  EXPECT_EQ(validation.issues[0].code, "FILE_ABOVE_LIMIT");
}

/// A triangle, and a primitive whose accessors have no bytes in the file.
Builder withZeros(uint64_t count) {
  Builder builder;
  Json sheet = Sheet(kSheet).addTo(builder);
  const uint32_t zeros = builder.addAccessor({{"componentType", kFloat},
                                              {"count", count},
                                              {"type", "VEC3"},
                                              {"min", {0, 0, 0}},
                                              {"max", {0, 0, 0}}});
  builder.addMesh({sheet});
  builder.addMesh({{{"attributes", {{"POSITION", zeros}}}}});
  return builder;
}

TEST(FileLimits, LargeAccessorsWithoutBytesStayAsTheyAre) {
  const RoundTrip trip = roundTrip(withZeros(16777215), evenIfLarger());
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 1, 0));
  ASSERT_EQ(trip.report.primitives.size(), 2u);
  EXPECT_EQ(trip.report.primitives[1].note.substr(0, 64),
            "has accessors that have no bytes in the file and claim 201326580");
  EXPECT_EQ(roundTrip(withZeros(3), evenIfLarger()).report.primitives[1].note.find("no bytes"),
            std::string::npos);
}

/// 2^28 itself is more than a payload holds, as for the codec.
TEST(FileLimits, PiecesHaveFewerThan2To28Vertices) {
  for (const uint64_t count : {uint64_t{1} << 28, (uint64_t{1} << 28) + 1, uint64_t{1} << 31}) {
    const RoundTrip trip = roundTrip(withZeros(count), evenIfLarger());
    ASSERT_EQ(trip.error, "");
    EXPECT_EQ(trip.report.primitives[1].note, "has 2^28 or more vertices; left as it was") << count;
  }
  const RoundTrip trip = roundTrip(withZeros((uint64_t{1} << 28) - 1), evenIfLarger());
  EXPECT_NE(trip.report.primitives[1].note.find("no bytes in the file"), std::string::npos);
}

TEST(FileLimits, AccessorsWithoutBytesCountTogether) {
  Builder builder = withZeros(300);
  Json zeros = builder.json["accessors"].back();
  zeros["count"] = 303;
  const uint32_t more = builder.addAccessor(zeros);
  builder.addMesh({{{"attributes", {{"POSITION", more}}}}});
  ConvertOptions options = evenIfLarger();
  options.max_decoded_bytes = 32 * 12 * 603;
  EXPECT_EQ(roundTrip(builder, options).report.primitives[2].note.find("no bytes in the"),
            std::string::npos);
  options.max_decoded_bytes -= 32;
  const ConvertReport report = roundTrip(builder, options).report;
  EXPECT_EQ(report.primitives[1].note.find("no bytes in the file"), std::string::npos);
  EXPECT_NE(report.primitives[2].note.find("no bytes in the file"), std::string::npos);
}

TEST(FileLimits, IndicesWithoutBytes) {
  Builder builder;
  Json sheet = Sheet(kSheet).addTo(builder);
  sheet["indices"] = builder.addAccessor(
      {{"componentType", kUnsignedInt}, {"count", 4294967295u}, {"type", "SCALAR"}});
  builder.addMesh({sheet});
  const RoundTrip trip = roundTrip(builder, evenIfLarger());
  ASSERT_EQ(trip.error, "");
  EXPECT_NE(trip.report.primitives[0].note.find("no bytes in the file"), std::string::npos);
}

TEST(FileLimits, AFileThatManyBuffersNameIsReadOnce) {
  Json json = {{"asset", {{"version", "2.0"}}}};
  for (uint64_t i = 0; i < 200; ++i) {
    json["buffers"].push_back({{"uri", "a.bin"}, {"byteLength", 100 + i % 50}});
    json["bufferViews"].push_back({{"buffer", i}, {"byteOffset", i % 50}, {"byteLength", 100}});
    json["images"].push_back({{"uri", "a.png"}});
  }
  size_t calls = 0;
  const FileReader reader = [&](const std::string& path, const std::string&,
                                std::vector<uint8_t>& bytes) {
    ++calls;
    bytes.assign(150, 7);
    if (path == "a.png") std::memcpy(bytes.data(), "\x89PNG", 4);
    return Result{};
  };
  const std::string text = printJson(json);
  Document document;
  ASSERT_EQ(loadDocument(asBytes(text), reader, document).message(), "");
  EXPECT_EQ(calls, 1u);
  EXPECT_EQ(document.source_bytes, text.size() + 150);
  for (const BufferView& view : document.views) {
    EXPECT_EQ(view.buffer, document.views[0].buffer) << "their bytes are the same";
    EXPECT_EQ(document.buffers[view.buffer].size(), 149u) << "of the longest";
  }
  ASSERT_EQ(embedImages(reader, document).message(), "");
  EXPECT_EQ(calls, 2u);
  EXPECT_EQ(document.views.size(), 201u);
  for (const Json& image : document.json["images"]) EXPECT_EQ(image["bufferView"], 200);
  // Each buffer ends where it says.
  json["bufferViews"][0]["byteOffset"] = 1;
  const std::string longer = printJson(json);
  ASSERT_EQ(loadDocument(asBytes(longer), reader, document).message(), "");
  EXPECT_NE(document.views[0].fault.message().find("outside buffer 0"), std::string::npos);
}

#if !defined(_WIN32)

TEST(FileLimits, ADeviceIsReadNoFartherThanItTellsWhatItIs) {
  std::vector<uint8_t> bytes;
  ASSERT_EQ(readFile("/dev/zero", bytes).message(), "");
  EXPECT_LE(bytes.size(), 1u << 20);
  Document document;
  EXPECT_NE(loadDocument(bytes, nullptr, document).message().find("neither a GLB nor JSON"),
            std::string::npos);
}

TEST(FileLimits, OfAStreamAGlbIsReadToItsEnd) {
  const std::vector<uint8_t> file = compressedSheet();
  int ends[2] = {};
  ASSERT_EQ(::pipe2(ends, O_NONBLOCK), 0);
  std::vector<uint8_t> sent = file;
  sent.resize(file.size() + 1000);
  ASSERT_EQ(::write(ends[1], sent.data(), sent.size()), static_cast<ssize_t>(sent.size()));
  // The writer continues, so the stream has no end; reading on would be an error here.
  std::vector<uint8_t> bytes;
  EXPECT_EQ(readStream(ends[0], "pipe", bytes).message(), "");
  ::close(ends[0]);
  ::close(ends[1]);
  EXPECT_GE(bytes.size(), file.size());
  Document document;
  ASSERT_EQ(loadDocument(bytes, nullptr, document).message(), "");
  ASSERT_EQ(document.notes.size(), 1u);
  EXPECT_EQ(document.notes[0], "bytes after the end of the GLB were ignored");
}

TEST(FileLimits, ABufferIsARegularFile) {
  std::vector<uint8_t> bytes;
  EXPECT_EQ(readerOf("/dev")("zero", "/buffers/0/uri", bytes).message(),
            "/buffers/0/uri: \"zero\": is not a regular file");
}

#endif

TEST(FileLimits, AFileAbove64GiBIsNotRead) {
  const mcc::test::ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "large.glb";
  std::ofstream(path).put('{');
  std::filesystem::resize_file(path, kMaxFileBytes + 1);
  std::vector<uint8_t> bytes;
  EXPECT_NE(readFile(path, bytes).message().find("has more than the 68719476736 bytes"),
            std::string::npos);
  EXPECT_TRUE(bytes.empty());
}

/// However a document spells the name of a file, the file is read once.
TEST(FileLimits, OneFileIsReadOnceUnderAllItsNames) {
  Json json = {{"asset", {{"version", "2.0"}}}};
  for (const char* uri : {"a.bin", "./a.bin", "././a.bin", "b/../a.bin", ".//a.bin", "%61.bin"}) {
    json["buffers"].push_back({{"uri", uri}, {"byteLength", 1000}});
  }
  const std::string text = json.dump();
  size_t read_count = 0;
  Document document;
  const Result loaded = loadDocument(
      asBytes(text),
      [&](const std::string&, const std::string&, std::vector<uint8_t>& bytes) -> Result {
        ++read_count;
        bytes.assign(1000, 1);
        return {};
      },
      document);
  ASSERT_TRUE(loaded.ok()) << loaded.message();
  EXPECT_EQ(read_count, 1u);
  EXPECT_EQ(document.source_bytes, text.size() + 1000);
  ASSERT_EQ(document.buffers.size(), 6u);
  for (const auto& buffer : document.buffers) EXPECT_EQ(buffer.size(), 1000u);
}

}  // namespace
}  // namespace mcc::gltf::test
