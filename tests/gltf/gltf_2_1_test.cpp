// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the draft of glTF 2.1 adds: buffers in several chunks of a GLB, and component types.
#include <gtest/gtest.h>

#include <cstring>

#include "gltf/round_trip.h"
#include "mcc/files.h"

namespace mcc::gltf::test {
namespace {

/// A sheet whose positions, indices and the rest are in three buffers.
struct ThreeBuffers {
  Builder builder;
  std::vector<std::vector<uint8_t>> buffers = std::vector<std::vector<uint8_t>>(3);

  ThreeBuffers() {
    const Sheet sheet(12);
    builder.addMesh({sheet.addTo(builder)});
    Json& views = builder.json["bufferViews"];
    for (size_t i = 0; i < views.size(); ++i) {
      const auto offset = views[i]["byteOffset"].get<size_t>();
      const auto length = views[i]["byteLength"].get<size_t>();
      std::vector<uint8_t>& buffer = buffers[i % 3];
      buffer.resize((buffer.size() + 3) / 4 * 4);
      views[i]["buffer"] = i % 3;
      views[i]["byteOffset"] = buffer.size();
      const auto begin = builder.bin.begin() + static_cast<ptrdiff_t>(offset);
      buffer.insert(buffer.end(), begin, begin + static_cast<ptrdiff_t>(length));
    }
    for (const auto& buffer : buffers) {
      builder.json["buffers"].push_back({{"byteLength", buffer.size()}});
    }
  }

  Json& buffer(size_t number) { return builder.json["buffers"][number]; }
};

/// The chunks in the order BIN 2, MORE, BIN 0, JSON, BIN 1.
std::vector<uint8_t> mixedGlb3(ThreeBuffers document = {}) {
  document.buffer(0)["chunk"] = 2;
  document.buffer(1)["chunk"] = 4;
  document.buffer(2)["chunk"] = 0;
  return glb3Of({binChunk(document.buffers[2]),
                 {"MORE", {1, 2, 3}, 0},
                 binChunk(document.buffers[0]),
                 jsonChunk(printJson(document.builder.json)),
                 binChunk(document.buffers[1])});
}

std::vector<uint8_t> plainGlb() {
  Builder builder;
  const Sheet sheet(12);
  builder.addMesh({sheet.addTo(builder)});
  return builder.toGlb();
}

uint32_t versionOf(const std::vector<uint8_t>& file) {
  GlbFile glb;
  return readGlb(file, glb).ok() ? glb.version : 0;
}

TEST(Gltf21, BuffersInAnyChunks) {
  const RoundTrip plain = roundTrip(plainGlb());
  const RoundTrip mixed = roundTrip(mixedGlb3());
  ASSERT_EQ(mixed.error, "");
  EXPECT_EQ(versionOf(mixed.converted), 2u);
  EXPECT_TRUE(isCompressed(jsonOf(mixed.converted), 0, 0));
  EXPECT_FALSE(jsonOf(mixed.converted)["buffers"][0].contains("chunk"));
  GlbFile glb;
  ASSERT_TRUE(readGlb(mixed.converted, glb).ok());
  ASSERT_EQ(glb.otherChunks({}).size(), 1u);
  EXPECT_EQ(glb.otherChunks({})[0].bytes[2], 3);
  for (const uint32_t accessor : {0u, 1u, 2u, 3u}) {
    EXPECT_EQ(elementsInOrder(mixed.decoded, accessor), elementsInOrder(plain.decoded, accessor));
  }
}

TEST(Gltf21, TheVersionThatIsAskedFor) {
  for (const std::vector<uint8_t>& source : {plainGlb(), mixedGlb3()}) {
    for (const GlbVersion version : {GlbVersion::k2, GlbVersion::k3}) {
      ConvertOptions options;
      options.glb_version = version;
      const RoundTrip trip = roundTrip(source, options);
      ASSERT_EQ(trip.error, "");
      EXPECT_EQ(versionOf(trip.converted), static_cast<uint32_t>(version));
      EXPECT_EQ(versionOf(trip.decoded), 2u);
      EXPECT_EQ(jsonOf(trip.converted), jsonOf(roundTrip(source).converted));
      DecodeOptions decoding;
      decoding.glb_version = version;
      std::vector<uint8_t> decoded;
      DecodeReport report;
      // What is not compressed is copied only where it has that version.
      for (const std::vector<uint8_t>& file : {trip.converted, source}) {
        ASSERT_TRUE(decodeGlb(file, decoded, report, decoding).ok());
        EXPECT_EQ(versionOf(decoded), static_cast<uint32_t>(version));
        EXPECT_EQ(report.copied, decoded == source);
      }
      EXPECT_EQ(elementsInOrder(decoded, 0), elementsInOrder(source, 0));
    }
  }
  ConvertOptions options;
  options.glb_version = static_cast<GlbVersion>(1);
  EXPECT_NE(roundTrip(plainGlb(), options).error.find("glb_version"), std::string::npos);
}

TEST(Gltf21, ChunksThatVersion2CannotHold) {
  const std::vector<uint8_t> source = glb3Of({jsonChunk(R"({"asset":{"version":"2.1"}})"),
                                              {"MORE", {1}, 0},
                                              jsonChunk("[]"),
                                              binChunk({1, 2, 3})});
  DecodeOptions options;
  std::vector<uint8_t> decoded;
  DecodeReport report;
  ASSERT_TRUE(decodeGlb(source, decoded, report, options).ok());
  EXPECT_EQ(decoded, source);
  options.glb_version = GlbVersion::k2;
  ASSERT_TRUE(decodeGlb(source, decoded, report, options).ok());
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_NE(report.notes[0].find("further JSON or BIN chunks"), std::string::npos);
  GlbFile glb;
  ASSERT_TRUE(readGlb(decoded, glb).ok());
  EXPECT_EQ(glb.chunks.size(), 2u);
}

TEST(Gltf21, WrongChunksAreErrors) {
  const auto errorOf = [](const char* member, const Json& value) {
    ThreeBuffers document;
    for (size_t i = 0; i < 3; ++i) document.buffer(i)["chunk"] = i + 1;
    document.buffer(1)[member] = value;
    return roundTrip(glb3Of({jsonChunk(printJson(document.builder.json)),
                             binChunk(document.buffers[0]),
                             binChunk(document.buffers[1]),
                             binChunk(document.buffers[2]),
                             {"MORE", {1}, 0}}))
        .error;
  };
  const std::string where = "/buffers/1/";
  EXPECT_EQ(errorOf("chunk", 2), "");
  EXPECT_EQ(errorOf("chunk", 5).find(where + "chunk: there is no chunk 5"), 0u);
  EXPECT_EQ(errorOf("chunk", 0).find(where + "chunk: chunk 0 is not a BIN chunk"), 0u);
  EXPECT_EQ(errorOf("chunk", 4).find(where + "chunk: chunk 4 is not a BIN chunk"), 0u);
  EXPECT_EQ(errorOf("chunk", -1).find(where + "chunk: "), 0u);
  EXPECT_EQ(errorOf("chunk", "2").find(where + "chunk: "), 0u);
  EXPECT_EQ(errorOf("uri", "a.bin").find(where + "chunk: the buffer has a URI, too"), 0u);
  EXPECT_EQ(errorOf("byteLength", 1000000).find(where + "byteLength: 1000000 bytes"), 0u);
  const std::string text = R"({"asset":{"version":"2.1"},"buffers":[{"byteLength":1,"chunk":1}]})";
  const std::string error = roundTrip(std::vector<uint8_t>(text.begin(), text.end())).error;
  EXPECT_EQ(error.find("/buffers/0/chunk: only a GLB has chunks"), 0u);
}

/// Adds an attribute of `components` values of `type` per vertex, with random bytes.
uint32_t addRandom(Builder& builder, int type, size_t width, size_t count) {
  std::vector<uint8_t> bytes(width * count);
  uint32_t state = 99;
  for (uint8_t& byte : bytes)
    byte = static_cast<uint8_t>((state = state * 1664525 + 1013904223) >> 24);
  builder.bin.resize((builder.bin.size() + 7) / 8 * 8);
  return builder.addAccessor(builder.addView(bytes), type, "SCALAR", count);
}

std::vector<uint8_t> viewBytesOf(const std::vector<uint8_t>& file, uint32_t accessor) {
  Document document;
  if (!loadDocument(file, nullptr, document).ok()) return {};
  const uint32_t view = document.accessors.at(accessor).view;
  if (view == kNone) return {};
  const BufferView& from = document.views.at(view);
  const auto bytes = document.buffers[from.buffer].subspan(from.offset, from.length);
  return {bytes.begin(), bytes.end()};
}

struct NewType {
  int number;
  size_t width;
};
constexpr NewType kNewTypes[] = {{5124, 4}, {5130, 8}, {5131, 2}, {5134, 8}, {5135, 8}};

/// Animations, skins and what nothing names keep the new types exactly, with their alignment.
TEST(Gltf21, NewTypesKeepTheirBytesAndAlignment) {
  for (const NewType type : kNewTypes) {
    for (const GlbVersion version : {GlbVersion::k2, GlbVersion::k3}) {
      Builder builder;
      builder.json["asset"]["version"] = "2.1";
      const Sheet sheet(12);
      builder.addMesh({sheet.addTo(builder)});
      const uint32_t input = addRandom(builder, type.number, type.width, 31);
      const uint32_t output = addRandom(builder, type.number, type.width, 31);
      addRandom(builder, type.number, type.width, 7);  // nothing names it
      builder.json["animations"] = {
          {{"samplers", {{{"input", input}, {"output", output}}}}, {"channels", Json::array()}}};
      ConvertOptions options;
      options.glb_version = version;
      const RoundTrip trip = roundTrip(builder, options);
      ASSERT_EQ(trip.error, "") << type.number;
      EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
      for (const auto* file : {&trip.converted, &trip.decoded}) {
        Document document;
        ASSERT_TRUE(loadDocument(*file, nullptr, document).ok());
        for (const uint32_t accessor : {input, output, output + 1}) {
          EXPECT_EQ(viewBytesOf(*file, accessor), viewBytesOf(trip.source, accessor));
          EXPECT_EQ(jsonOf(*file)["accessors"][accessor]["componentType"], type.number);
          const BufferView& view = document.views[document.accessors[accessor].view];
          EXPECT_EQ(view.offset % type.width, 0u);
          const uint8_t* first = document.buffers[view.buffer].data() + view.offset;
          EXPECT_EQ(static_cast<size_t>(first - file->data()) % type.width, 0u) << type.number;
        }
      }
    }
  }
}

/// Attributes that payloads cannot hold: the primitive stays as it was, and a note says why.
TEST(Gltf21, PrimitivesWithNewTypesStay) {
  for (const NewType type : kNewTypes) {
    for (const char* name : {"_ID", "COLOR_0"}) {
      if (type.number == 5124 && name[0] == '_') continue;  // see the next test
      Builder builder;
      const Sheet sheet(12);
      Json primitive = sheet.addTo(builder);
      primitive["attributes"][name] = addRandom(builder, type.number, type.width, sheet.count());
      builder.addMesh({primitive, sheet.addTo(builder)});
      builder.json["extensionsUsed"] = {"KHR_accessor_float16", "KHR_accessor_float64",
                                        "EXT_accessor_additional_types"};
      builder.json["extensionsRequired"] = builder.json["extensionsUsed"];
      const RoundTrip trip = roundTrip(builder, lossless());
      ASSERT_EQ(trip.error, "") << type.number;
      EXPECT_FALSE(isCompressed(jsonOf(trip.converted), 0, 0));
      EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 1));
      EXPECT_NE(trip.report.primitives[0].note.find(name), std::string::npos);
      for (uint32_t i = 0; i < 5; ++i) {
        EXPECT_EQ(viewBytesOf(trip.converted, i), viewBytesOf(trip.source, i)) << i;
        EXPECT_EQ(viewBytesOf(trip.decoded, i), viewBytesOf(trip.source, i)) << i;
      }
    }
  }
}

/// Values whose bits mean other numbers, and finite ones, as floats and as unsigned integers.
TEST(Gltf21, BoundsOfSignedIntegersAreThoseOfTheirValues) {
  constexpr int32_t kFar = 1 << 30;
  Builder builder;
  builder.json["asset"]["version"] = "2.1";
  const Sheet sheet(12);
  Json primitive = sheet.addTo(builder);
  std::vector<int32_t> ids;
  for (uint32_t i = 0; i < sheet.count(); ++i) ids.push_back(i % 2 == 0 ? -kFar : kFar);
  const uint32_t accessor = builder.addAccessor(ids, 5124, "SCALAR", ids.size());
  primitive["attributes"]["_ID"] = accessor;
  builder.json["accessors"][accessor]["min"] = {-kFar};
  builder.json["accessors"][accessor]["max"] = {kFar};
  builder.addMesh({primitive});
  const RoundTrip trip = roundTrip(builder, lossless());
  ASSERT_EQ(trip.error, "");
  for (const auto& [bound, value] : {std::pair("min", -kFar), std::pair("max", kFar)}) {
    for (const int32_t off : {-1, 0, 1}) {
      Json json = jsonOf(trip.converted);
      json["accessors"][accessor][bound] = {value + off};
      ValidationReport validation;
      ASSERT_TRUE(validateGlb(withJson(trip.converted, json), {}, validation).ok());
      EXPECT_EQ(validation.issues.size(), off == 0 ? 0u : 1u) << bound << " " << off;
    }
  }
}

TEST(Gltf21, IdsOf32BitsAreCompressedExactly) {
  for (const int type : {5124, kUnsignedInt}) {
    Builder builder;
    builder.json["asset"]["version"] = "2.1";
    const Sheet sheet(12);
    Json primitive = sheet.addTo(builder);
    std::vector<int32_t> ids;
    for (uint32_t i = 0; i < sheet.count(); ++i) {
      ids.push_back(i % 5 == 0 ? -2147483647 - 1 : static_cast<int32_t>(i / 7) - 9);
    }
    ids[3] = 2147483647;
    const uint32_t accessor = builder.addAccessor(ids, type, "SCALAR", ids.size());
    primitive["attributes"]["_ID"] = accessor;
    if (type == 5124) {
      builder.json["accessors"][accessor]["min"] = {-2147483648LL};
      builder.json["accessors"][accessor]["max"] = {2147483647};
    }
    builder.addMesh({primitive});
    ConvertOptions options = lossless();
    options.keep_vertex_order = true;
    const RoundTrip trip = roundTrip(builder, options);
    ASSERT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    for (const auto* file : {&trip.converted, &trip.decoded}) {
      const Json json = jsonOf(*file)["accessors"][accessor];
      EXPECT_EQ(json["componentType"], type);
      if (type != 5124) continue;
      EXPECT_EQ(printJson(json["min"]), "[-2147483648]");
      EXPECT_EQ(printJson(json["max"]), "[2147483647]");
    }
    EXPECT_EQ(elementsInOrder(trip.decoded, accessor), elementsInOrder(trip.source, accessor));
    ValidationReport validation;
    ASSERT_TRUE(validateGlb(trip.converted, {}, validation).ok());
    EXPECT_TRUE(validation.issues.empty());
  }
}

}  // namespace
}  // namespace mcc::gltf::test
