// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tests the reader with the conformance suite; the suite's own program `run` tests whole files.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "container/payload_header.h"
#include "format/codings.h"
#include "format/predictors.h"
#include "gltf/document/glb.h"
#include "json/json.h"
#include "mcc/glb.h"
#include "mcc/reader.h"
#include "robustness/damage.h"
#include "support/mesh_compare.h"
#include "support/sha256.h"

namespace mcc::test {
namespace {

using gltf::Json;

std::vector<uint8_t> contentOf(const std::string& name) {
  std::ifstream file(std::string(MCC_SOURCE_DIR "/tests/conformance/") + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

const Json& manifest() {
  static const Json kManifest = [] {
    Json json;
    const std::vector<uint8_t> text = contentOf("manifest.json");
    const gltf::Result result = gltf::parseJson(text, json);
    if (!result.ok()) ADD_FAILURE() << result.message();
    return json;
  }();
  return kManifest;
}

struct File {
  std::string name;
  std::vector<uint8_t> bytes;
  Json json;
  std::span<const uint8_t> payload;

  explicit File(const Json& asset) : name(asset["file"]), bytes(contentOf(name)) {
    gltf::GlbFile glb;
    EXPECT_TRUE(gltf::readGlb(bytes, glb).ok()) << name;
    EXPECT_TRUE(gltf::parseJson(glb.json, json).ok()) << name;
    const Json& view = json["bufferViews"][0];
    payload = glb.bin.subspan(view["byteOffset"], view["byteLength"]);
  }
};

std::string fieldName(const MethodInfo& method, const PredictorField& field, uint32_t value) {
  return std::string(method.name) + ", field " + std::to_string(field.mask) + ": " +
         std::to_string(value);
}

/// Decodes a payload alone, in memory of exactly its size.
Error errorOf(std::span<const uint8_t> payload, size_t size) {
  const std::vector<uint8_t> copy(payload.begin(),
                                  payload.begin() + static_cast<std::ptrdiff_t>(size));
  return decodeDamaged(copy).error;
}

void expectHash(const Json& expected, std::span<const uint8_t> bytes, const std::string& what) {
  EXPECT_EQ(sha256(bytes).substr(0, 32), expected["hash"].get<std::string>()) << what;
}

/// Returns the attributes that an extension object names.
void expectAttributes(const Json& ids, const Json& expected, const DecodedPiece& piece,
                      const std::string& where) {
  for (const auto& [name, id] : ids.items()) {
    const DecodedAttribute& a = piece.attributes.at(id.get<size_t>());
    EXPECT_EQ(piece.wedge_count, expected[name]["count"].get<uint32_t>()) << where << name;
    expectHash(expected[name], a.bytes, where + name);
  }
}

TEST(Sha256, ExamplesOfTheStandard) {
  const auto hash = [](const std::string& text) {
    return sha256({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(hash(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Conformance, AssetsDecodeToTheirHashes) {
  ASSERT_GT(manifest()["assets"].size(), 100u);
  for (const Json& asset : manifest()["assets"]) {
    const File file(asset);
    std::vector<DecodedPiece> pieces;
    ASSERT_EQ(decodePayload(file.payload, {}, pieces), "") << file.name;
    const Json& primitives = file.json["meshes"][0]["primitives"];
    ASSERT_EQ(primitives.size(), asset["primitives"].size()) << file.name;
    for (size_t i = 0; i < primitives.size(); ++i) {
      const Json& expected = asset["primitives"][i];
      const Json& extension = primitives[i]["extensions"][gltf::kExtensionName];
      const DecodedPiece& piece = pieces.at(extension.value("piece", size_t{0}));
      const std::vector<uint32_t>& indices = piece.parts.at(extension.value("part", size_t{0}));
      const std::string where = file.name + ", primitive " + std::to_string(i) + ", ";
      EXPECT_EQ(indices.size(), expected["indices"]["count"].get<size_t>()) << where;
      std::vector<uint8_t> bytes;
      for (const uint32_t index : indices) {
        for (uint32_t shift = 0; shift < 32; shift += 8)
          bytes.push_back(static_cast<uint8_t>(index >> shift));
      }
      expectHash(expected["indices"], bytes, where + "indices");
      expectAttributes(extension.value("attributes", Json::object()), expected["attributes"], piece,
                       where);
      const Json targets = extension.value("targets", Json::array());
      for (size_t t = 0; t < targets.size(); ++t)
        expectAttributes(targets[t], expected["targets"][t], piece, where + "target ");
    }
  }
}

/// What the manifest says of assets that are for a message of the decoder.
constexpr std::string_view kSaying = "The streams say that ";

TEST(Conformance, NegativeAssetsAreRefusedForTheirReason) {
  ASSERT_GT(manifest()["negative"].size(), 100u);
  std::vector<bool> seen(11, false);
  for (const Json& asset : manifest()["negative"]) {
    const File file(asset);
    std::vector<uint8_t> output;
    gltf::DecodeReport report;
    const gltf::Result result = gltf::decodeGlb(file.bytes, output, report);
    EXPECT_FALSE(result.ok()) << file.name;
    EXPECT_TRUE(output.empty()) << file.name;
    // Several checks refuse for the same kind of reason; this is the one that the asset is for.
    if (const std::string shows = asset["shows"]; shows.starts_with(kSaying)) {
      EXPECT_NE(result.message().find(shows.substr(kSaying.size())), std::string::npos)
          << file.name << ": " << result.message();
    }
    const uint32_t error = asset["error"];
    seen.at(error) = true;
    if (error == 0) continue;  // the document is wrong
    EXPECT_EQ(static_cast<uint32_t>(errorOf(file.payload, file.payload.size())), error)
        << file.name;
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0) << "not every kind of error is there";
}

std::string specification(const char* part) {
  std::ifstream file(MCC_SOURCE_DIR "/extension-spec/KHR_mesh_collapse_compression/" +
                     std::string(part));
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the bytes that a text of hexadecimal digits and spaces stands for.
std::vector<uint8_t> bytesOf(const std::string& text) {
  std::vector<uint8_t> bytes;
  std::istringstream words(text);
  for (std::string word; words >> word;)
    bytes.push_back(static_cast<uint8_t>(std::stoul(word, nullptr, 16)));
  return bytes;
}

/// The payload that Appendix C takes apart is that of an asset, and the rows of its table are all
/// of it.
TEST(Conformance, TheWorkedPayloadIsAnAsset) {
  std::string text = specification("methods.md");
  const size_t appendix = text.find("Appendix C. A payload byte by byte");
  ASSERT_NE(appendix, std::string::npos);
  text = text.substr(appendix);
  const size_t begin = text.find("```\n") + 4;
  const std::vector<uint8_t> payload =
      bytesOf(text.substr(begin, text.find("\n```", begin) - begin));
  std::vector<uint8_t> rows;
  std::istringstream lines(text.substr(text.find("| Bytes | Field | Value |")));
  for (std::string line; std::getline(lines, line) && line.starts_with("|");) {
    if (!line.starts_with("| `")) continue;
    const std::vector<uint8_t> field = bytesOf(line.substr(3, line.find("` |") - 3));
    rows.insert(rows.end(), field.begin(), field.end());
  }
  EXPECT_EQ(rows, payload);
  const auto& assets = manifest()["assets"];
  const auto asset = std::find_if(assets.begin(), assets.end(), [](const Json& a) {
    return a["file"].get<std::string>().find("appendix_c") != std::string::npos;
  });
  ASSERT_NE(asset, assets.end());
  const File file(*asset);
  EXPECT_TRUE(std::equal(payload.begin(), payload.end(), file.payload.begin(), file.payload.end()));
}

TEST(Conformance, ValidatorsReportInvalidDocuments) {
  ASSERT_GT(manifest()["invalid"].size(), 10u);
  for (const Json& document : manifest()["invalid"]) {
    const File file(document);
    gltf::ValidationReport report;
    ASSERT_TRUE(gltf::validateGlb(file.bytes, {}, report).ok()) << file.name;
    EXPECT_TRUE(std::any_of(report.issues.begin(), report.issues.end(), [&](const auto& issue) {
      return issue.code == document["code"];
    })) << file.name;
  }
}

TEST(Conformance, EveryTruncationIsAnError) {
  for (const Json& asset : manifest()["assets"]) {
    const File file(asset);
    for (size_t size = 0; size < file.payload.size(); ++size)
      ASSERT_NE(errorOf(file.payload, size), Error::kOk) << file.name << " cut to " << size;
  }
}

/// The same with the checksum left as it was.
TEST(Conformance, TenThousandMutationsAreErrors) {
  std::vector<File> files;
  for (const Json& asset : manifest()["assets"]) files.emplace_back(asset);
  for (uint64_t i = 0; i < 10000; ++i) {
    const File& file = files[i % files.size()];
    Random random(i);
    const size_t header_bytes = std::min<size_t>(file.payload.size(), 40);
    const std::vector<uint8_t> damaged = mutated(file.payload, header_bytes, random);
    if (std::equal(damaged.begin(), damaged.end(), file.payload.begin(), file.payload.end())) {
      continue;
    }
    ASSERT_NE(errorOf(damaged, damaged.size()), Error::kOk) << file.name << ", mutation " << i;
  }
}

/// What the headers of all assets say, or of those with blocks: a name for each value.
std::set<std::string> headerValues(bool only_blocks = false) {
  std::set<std::string> values;
  for (const Json& asset : manifest()["assets"]) {
    PayloadHeader header{Allocator{}};
    EXPECT_TRUE(parsePayload(File(asset).payload, {}, header).ok()) << asset["file"];
    if (only_blocks && !header.hasBlocks()) continue;
    if ((header.flags & payload_flag::kPadded) != 0) values.insert("PADDED");
    for (size_t i = 0; i < header.exceptions.size(); ++i)
      values.insert(header.exceptions[i].number == kNone ? "new wedge" : "earlier wedge");
    for (size_t i = 0; i < header.pieces.size(); ++i) {
      const PieceHeader& piece = header.pieces[i];
      values.insert(infoOf(piece.surface()).name);
      for (const PieceFlagInfo& flag : kPieceFlags)
        if (piece.has(flag.bit)) values.insert(flag.name);
      const AttributeInfos all = header.attributesOf(piece);
      for (uint32_t a = 0; a < piece.attribute_count; ++a) {
        const MethodInfo& method = infoOf(methodOf(all, a));
        values.insert(std::string("coding ") + infoOf(all[a].coding).name);
        values.insert(method.name);
        for (const PredictorField& field : method)
          values.insert(fieldName(method, field, field.valueOf(all[a].predictor)));
      }
    }
  }
  return values;
}

TEST(Conformance, EveryRowOfTheFormatsTablesHasAnAsset) {
  const std::set<std::string> seen = headerValues();
  const auto expect = [&](const std::string& name) { EXPECT_TRUE(seen.contains(name)) << name; };
  for (const SurfaceInfo& surface : kSurfaces) expect(surface.name);
  for (const PieceFlagInfo& flag : kPieceFlags) expect(flag.name);
  for (const CodingInfo& coding : kCodings) expect(std::string("coding ") + coding.name);
  for (const MethodInfo& method : kMethods) {
    expect(method.name);
    for (const PredictorField& field : method) {
      for (uint32_t value = 0; value < field.value_count; ++value)
        expect(fieldName(method, field, value));
    }
  }
}

/// Stages look at blocks in some way: what a copy of the models leaves out shows in none but these.
TEST(Conformance, EverythingThatBlocksMayHaveIsInOne) {
  const std::set<std::string> seen = headerValues(true);
  const auto expect = [&](const std::string& name) { EXPECT_TRUE(seen.contains(name)) << name; };
  for (const char* const name : {"PADDED", "new wedge", "earlier wedge"}) expect(name);
  for (const SurfaceInfo& surface : kSurfaces) {
    const bool is_allowed = surface.name != std::string(infoOf(SurfaceCoding::kPivots).name);
    EXPECT_EQ(seen.contains(surface.name), is_allowed) << surface.name;
  }
  for (const PieceFlagInfo& flag : kPieceFlags) {
    constexpr uint32_t kOfNoBlock =
        piece_flag::kTriangleOrder | piece_flag::kVertexOrder | piece_flag::kSinceMinor1;
    EXPECT_EQ(seen.contains(flag.name), (flag.bit & kOfNoBlock) == 0) << flag.name;
  }
  for (const CodingInfo& coding : kCodings) expect(std::string("coding ") + coding.name);
  for (const MethodInfo& method : kMethods) expect(method.name);
}

/// Every feature of the format that an asset can show is shown by one, as far as the sections tell.
TEST(Conformance, SectionsAreCovered) {
  std::set<std::string> covered;
  for (const char* const list : {"assets", "negative"}) {
    for (const Json& asset : manifest()[list]) {
      for (const Json& id : asset["spec"]) covered.insert(id);
    }
  }
  for (const char* const section :
       {"A.2.4",   "A.3.3",   "A.3.4",   "A.3.5",   "A.3.7",   "A.3.9",   "A.4.3",   "A.4.4",
        "A.4.5",   "A.4.6",   "A.4.7",   "A.5.2",   "A.5.3",   "A.6.9",   "A.6.10",  "A.6.11",
        "A.6.12",  "A.6.14",  "A.6.15",  "A.7.3",   "A.7.4",   "A.8.1",   "A.8.2",   "A.9.1",
        "A.9.2",   "A.9.3",   "A.10.3",  "A.10.4",  "A.10.5",  "A.10.8",  "A.10.10", "A.10.11",
        "A.10.12", "A.10.13", "A.10.14", "A.10.16", "A.10.17", "A.10.18", "A.10.19", "A.10.20",
        "A.11.1",  "A.11.2",  "A.11.3",  "A.11.4",  "A.11.5"}) {
    EXPECT_TRUE(covered.contains(section)) << section;
  }
}

}  // namespace
}  // namespace mcc::test
