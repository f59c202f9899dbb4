// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What users of other glTF programs reported, rebuilt: valid documents that some program could not
// read, and faulty ones that exporters have written. All of them convert, and the result says the
// same as the source; convert() compares what it wrote.
#include <gtest/gtest.h>

#include <functional>

#include "gltf/round_trip.h"

namespace mcc::gltf::test {
namespace {

/// A sheet whose accessors can be changed, and a second one that is always compressed.
struct Document2 {
  Builder builder;
  Json sheet;
  uint32_t count = 0;

  Document2() {
    const Sheet first(20);
    count = first.count();
    sheet = first.addTo(builder);
    builder.addMesh({sheet});
    builder.addMesh({Sheet(22).addTo(builder)});
  }
  Json& primitive() { return builder.json["meshes"][0]["primitives"][0]; }
  Json& accessor(const char* name) {
    return builder.json["accessors"][sheet["attributes"][name].get<size_t>()];
  }
  Json& indices() { return builder.json["accessors"][sheet["indices"].get<size_t>()]; }
};

struct Outcome {
  bool is_compressed = false;
  RoundTrip trip;
};

Outcome outcomeOf(const std::function<void(Document2&)>& change) {
  Document2 document;
  change(document);
  Outcome outcome;
  outcome.trip = roundTrip(document.builder);
  EXPECT_EQ(outcome.trip.error, "");
  if (!outcome.trip.error.empty()) return outcome;
  const Json converted = jsonOf(outcome.trip.converted);
  EXPECT_TRUE(isCompressed(converted, 1, 0));
  outcome.is_compressed = isCompressed(converted, 0, 0);
  ValidationReport report;
  EXPECT_EQ(validateGlb(outcome.trip.converted, {}, report).message(), "");
  if (document.builder.json.value("faulty", false)) return outcome;
  for (const ValidationIssue& issue : report.issues) {
    EXPECT_NE(issue.severity, Severity::kError) << issue.pointer << ": " << issue.message;
  }
  return outcome;
}

void expectCompressed(const std::function<void(Document2&)>& change) {
  EXPECT_TRUE(outcomeOf(change).is_compressed);
}
void expectLeft(const std::function<void(Document2&)>& change, const std::string& note) {
  const Outcome outcome = outcomeOf([&](Document2& d) {
    change(d);
    d.builder.json["faulty"] = true;
  });
  EXPECT_FALSE(outcome.is_compressed) << note;
  ASSERT_FALSE(outcome.trip.report.primitives.empty());
  EXPECT_NE(outcome.trip.report.primitives[0].note.find(note), std::string::npos)
      << outcome.trip.report.primitives[0].note;
}

TEST(OtherPeoplesDocuments, EmptyThings) {
  expectCompressed([](Document2& d) {
    d.builder.json["meshes"].push_back({{"primitives", Json::array()}});
  });
  expectCompressed([](Document2& d) { d.builder.json["meshes"].push_back(Json::object()); });
  expectCompressed([](Document2& d) { d.builder.json["animations"] = Json::array(); });
  expectCompressed([](Document2& d) { d.builder.json["images"] = Json::array(); });
  expectCompressed([](Document2& d) { d.primitive()["targets"] = Json::array(); });
  expectCompressed([](Document2& d) { d.primitive()["extensions"] = Json::object(); });
  expectCompressed([](Document2& d) { d.primitive()["extras"] = nullptr; });
  expectCompressed([](Document2& d) { d.builder.json["extensionsUsed"] = Json::array(); });
  expectLeft([](Document2& d) { d.primitive()["attributes"] = Json::object(); }, "no POSITION");
  expectLeft([](Document2& d) { d.primitive() = Json::object(); }, "\"attributes\" is missing");
}

TEST(OtherPeoplesDocuments, NothingButCamerasAndNodes) {
  for (
      const char* text :
      {R"({"asset":{"version":"2.0"},"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],"nodes":[{"camera":0}]})",
       R"({"asset":{"version":"2.0"}})", R"({"asset":{"version":"2.0"},"meshes":[]})",
       R"({"asset":{"version":"2.0"},"scenes":[{},{}],"scene":1})"}) {
    for (const std::string before : {"", "\xef\xbb\xbf", " \r\n\t"}) {
      const std::string whole = before + text + " \n\n ";
      const RoundTrip trip = roundTrip(std::vector<uint8_t>(whole.begin(), whole.end()));
      EXPECT_EQ(trip.error, "") << text;
    }
  }
}

TEST(OtherPeoplesDocuments, AccessorsOfOneElementOrNone) {
  expectCompressed([](Document2& d) {  // an animation of one key, shared by all channels
    const uint32_t time = d.builder.addFloats({0}, 1);
    const uint32_t value = d.builder.addFloats({1, 2, 3}, 3);
    d.builder.json["animations"] = {
        {{"samplers", {{{"input", time}, {"output", value}}, {{"input", time}, {"output", value}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  });
  expectCompressed([](Document2& d) {  // zero elements, which glTF forbids, of nothing that counts
    d.builder.addAccessor({{"componentType", kFloat}, {"count", 0}, {"type", "VEC3"}});
    d.builder.addAccessor(
        {{"bufferView", 0}, {"componentType", kFloat}, {"count", 0}, {"type", "VEC3"}});
  });
}

TEST(OtherPeoplesDocuments, AccessorsWithoutViewsAreZero) {
  expectCompressed([](Document2& d) {  // a morph target that moves nothing
    d.primitive()["targets"] = {{{"POSITION", d.builder.addAccessor({{"componentType", kFloat},
                                                                     {"count", d.count},
                                                                     {"type", "VEC3"},
                                                                     {"min", {0, 0, 0}},
                                                                     {"max", {0, 0, 0}}})}}};
  });
  expectCompressed([](Document2& d) {
    d.primitive()["attributes"]["COLOR_0"] =
        d.builder.addAccessor({{"componentType", kUnsignedByte},
                               {"normalized", true},
                               {"count", d.count},
                               {"type", "VEC4"}});
  });
}

Json sparseOf(Document2& d, const std::vector<uint16_t>& indices) {
  std::vector<float> values;
  for (size_t i = 0; i < 3 * indices.size(); ++i) values.push_back(static_cast<float>(i));
  const uint32_t index_view = d.builder.addView(bytesOf(indices));
  const uint32_t value_view = d.builder.addView(bytesOf(values));
  return {{"count", indices.size()},
          {"indices", {{"bufferView", index_view}, {"componentType", kUnsignedShort}}},
          {"values", {{"bufferView", value_view}}}};
}

TEST(OtherPeoplesDocuments, SparseTargetsWithoutABase) {
  expectCompressed([](Document2& d) {
    d.primitive()["targets"] = {
        {{"POSITION", d.builder.addAccessor({{"componentType", kFloat},
                                             {"count", d.count},
                                             {"type", "VEC3"},
                                             {"min", {0, 0, 0}},
                                             {"max", {3, 4, 5}},
                                             {"sparse", sparseOf(d, {3, 9})}})}}};
  });
}

/// A stride belongs to the elements of the view, not to the packed values of a sparse accessor.
TEST(OtherPeoplesDocuments, SparseOverInterleavedElements) {
  Document2 d;
  std::vector<float> interleaved(size_t{6} * d.count, 7.0f);
  const uint32_t view = d.builder.addView(bytesOf(interleaved), 24);
  const uint32_t accessor = d.builder.addAccessor({{"bufferView", view},
                                                   {"byteOffset", 12},
                                                   {"componentType", kFloat},
                                                   {"count", d.count},
                                                   {"type", "VEC3"},
                                                   {"sparse", sparseOf(d, {0, 440})}});
  d.primitive()["attributes"]["_FORCE"] = accessor;
  const RoundTrip trip = roundTrip(d.builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
  EXPECT_EQ(elementsOf(trip.source, accessor), elementsOf(trip.decoded, accessor));
}

TEST(OtherPeoplesDocuments, SparseNumbersThatRepeatOrDescend) {
  expectCompressed([](Document2& d) { d.accessor("NORMAL")["sparse"] = sparseOf(d, {9, 9, 3}); });
}

TEST(OtherPeoplesDocuments, StridesWhereTheyDoNotBelong) {
  expectCompressed([](Document2& d) {  // on indices, which must be packed
    d.builder.json["bufferViews"][d.indices()["bufferView"].get<size_t>()]["byteStride"] = 2;
  });
  expectCompressed([](Document2& d) {  // normals of three bytes that start at every fourth
    std::vector<int8_t> normals(size_t{4} * d.count, 0);
    for (size_t i = 2; i < normals.size(); i += 4) normals[i] = 127;
    const uint32_t view = d.builder.addView(bytesOf(normals), 4);
    d.primitive()["attributes"]["NORMAL"] = d.builder.addAccessor({{"bufferView", view},
                                                                   {"componentType", kByte},
                                                                   {"normalized", true},
                                                                   {"count", d.count},
                                                                   {"type", "VEC3"}});
    d.builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    d.builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  });
}

/// Texture coordinates of whole numbers are undone by a transform of the texture.
TEST(OtherPeoplesDocuments, QuantizedTypes) {
  for (const bool is_normalized : {false, true}) {
    expectCompressed([&](Document2& d) {
      std::vector<int16_t> values;
      for (uint32_t i = 0; i < 2 * d.count; ++i) values.push_back(static_cast<int16_t>(31 * i));
      d.primitive()["attributes"]["TEXCOORD_0"] =
          d.builder.addAccessor(values, kShort, "VEC2", d.count);
      d.builder.json["accessors"].back()["normalized"] = is_normalized;
      d.builder.json["extensionsUsed"] = {"KHR_mesh_quantization", "KHR_texture_transform"};
      d.builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
      d.builder.json["materials"] = {
          {{"normalTexture",
            {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}}}};
    });
  }
}

TEST(OtherPeoplesDocuments, TheLargestIndexOfAType) {
  expectLeft(
      [](Document2& d) {
        std::vector<uint16_t> indices = Sheet(20).indices;
        indices[5] = 65535;  // restarts strips
        d.primitive()["indices"] = d.builder.addIndices(indices);
      },
      "index number 5 is 65535");
  expectLeft(
      [](Document2& d) {
        std::vector<uint32_t> indices(600, 0);
        indices[7] = 0xffffffff;
        d.primitive()["indices"] = d.builder.addAccessor(indices, kUnsignedInt, "SCALAR", 600);
      },
      "index number 7 is 4294967295");
}

TEST(OtherPeoplesDocuments, TrianglesWithoutArea) {
  expectCompressed([](Document2& d) {
    std::vector<uint16_t> indices = Sheet(20).indices;
    for (size_t i = 0; i < indices.size(); i += 9) indices[i] = indices[i + 1];
    d.primitive()["indices"] = d.builder.addIndices(indices);
  });
  const Outcome all_alike = outcomeOf([](Document2& d) {
    d.primitive()["indices"] = d.builder.addIndices(std::vector<uint16_t>(300, 4));
  });
  EXPECT_EQ(all_alike.trip.report.primitives.size(), 2u);
}

TEST(OtherPeoplesDocuments, NamesOfAttributes) {
  expectCompressed([](Document2& d) {
    for (const char* name :
         {"TEXCOORD_00", "TEXCOORD", "COLOR", "_", "position", "TEXCOORD_1000000", "JOINTS_0",
          "_\t\x01 \u00fc/~", "NORMAL_0", "TANGENT_1"}) {
      d.primitive()["attributes"][name] = d.sheet["attributes"]["TEXCOORD_0"];
    }
  });
}

TEST(OtherPeoplesDocuments, TargetsOfNormalsOnlyAndOfDifferentAttributes) {
  expectCompressed([](Document2& d) {
    const Json normal = d.sheet["attributes"]["NORMAL"];
    d.primitive()["targets"] = {{{"NORMAL", normal}}, {{"POSITION", normal}, {"NORMAL", normal}}};
    d.builder.json["meshes"][0]["extras"] = {{"targetNames", {"a", "\u00e4 b"}}};
    d.builder.json["meshes"][0]["weights"] = {0, 1};
  });
  expectCompressed([](Document2& d) { d.primitive()["targets"] = Json::array({Json::object()}); });
  expectLeft(  // a target of another mesh
      [](Document2& d) {
        d.primitive()["targets"] = {{{"POSITION", d.builder.addPositions(Sheet(3).positions)}}};
      },
      "elements of target 0 POSITION");
}

TEST(OtherPeoplesDocuments, InstancesAndVariants) {
  expectCompressed([](Document2& d) {
    const uint32_t moves = d.builder.addFloats({1, 2, 3, 4, 5, 6}, 3);
    d.builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {
        {"attributes", {{"TRANSLATION", moves}}}};
    d.primitive()["extensions"]["KHR_materials_variants"] = {
        {"mappings", {{{"material", 0}, {"variants", {0}}}}}};
    d.builder.json["materials"] = Json::array({Json::object()});
    d.builder.json["extensions"]["KHR_materials_variants"] = {{"variants", {{{"name", "red"}}}}};
    d.builder.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_materials_variants"};
  });
}

/// A number may be spelt in any way that JSON allows.
TEST(OtherPeoplesDocuments, NumbersInOtherSpellings) {
  const auto spelt = [](const std::string& number) { return Json::number(number); };
  expectCompressed([&](Document2& d) {
    d.accessor("NORMAL")["count"] = spelt("4.41E2");
    d.accessor("NORMAL")["byteOffset"] = spelt("-0");
    d.indices()["componentType"] = spelt("5123.0");
    d.primitive()["mode"] = spelt("4e0");
  });
  expectLeft([&](Document2& d) { d.primitive()["indices"] = spelt("1e2"); },
             "indices: there is no accessor");
  expectLeft([&](Document2& d) { d.primitive()["indices"] = spelt("1e99"); },
             "indices: must be the number of an accessor");
  expectLeft([&](Document2& d) { d.accessor("NORMAL")["count"] = spelt("1e999"); },
             "must be a whole number that is not negative");
}

TEST(OtherPeoplesDocuments, MeshesThatNoNodeShows) {
  expectCompressed([](Document2& d) {
    d.builder.json.erase("nodes");
    d.builder.json.erase("scenes");
  });
  expectCompressed([](Document2& d) {
    d.builder.json["scenes"].push_back(d.builder.json["scenes"][0]);
    d.builder.json["scene"] = 1;
  });
}

/// Chunks after BIN, and JSON that is padded with zeros as old exporters did.
TEST(OtherPeoplesDocuments, ChunksOfAGlb) {
  const Document2 d;
  Json json = d.builder.json;
  json["buffers"] = {{{"byteLength", d.builder.bin.size()}}};
  std::string text = printJson(json);
  while (text.size() % 4 != 0) text += ' ';
  for (const std::string& padding :
       {std::string(4, '\0'), std::string(8, ' '), std::string("\n\r\t ")}) {
    std::vector<uint8_t> bin = d.builder.bin;
    bin.resize(bin.size() + 8, 0);  // longer than the buffer
    std::vector<uint8_t> file;
    const std::vector<uint8_t> extra = {1, 2, 3, 4};
    const GlbChunk chunk = {0x12345678, extra};
    ASSERT_TRUE(writeGlb(text + padding, bin, {&chunk, 1}, file).ok());
    const RoundTrip trip = roundTrip(file);
    ASSERT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    GlbFile glb;
    ASSERT_TRUE(readGlb(trip.decoded, glb).ok());
    EXPECT_EQ(glb.otherChunks({}).size(), 1u);
  }
}

TEST(OtherPeoplesDocuments, DataUrisOfAnyMediaType) {
  const Document2 d;
  for (const char* type :
       {"", "application/gltf-buffer;base64", "text/plain;charset=US-ASCII;base64",
        "application/octet-stream;base64", ";base64"}) {
    Json json = d.builder.json;
    const bool is_base64 = std::string(type).ends_with("base64");
    std::string data;
    if (is_base64) {
      static constexpr char kDigits[] =
          "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      for (size_t i = 0; i < d.builder.bin.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = i; k < i + 3; ++k) {
          word = word << 8 | (k < d.builder.bin.size() ? d.builder.bin[k] : 0u);
        }
        for (const int shift : {18, 12, 6, 0}) data += kDigits[word >> shift & 63];
      }
    } else {
      static constexpr char kDigits[] = "0123456789ABCDEF";
      for (const uint8_t byte : d.builder.bin)
        data += {'%', kDigits[byte / 16], kDigits[byte % 16]};
    }
    json["buffers"] = {
        {{"byteLength", d.builder.bin.size()}, {"uri", "data:" + std::string(type) + "," + data}}};
    const std::string text = json.dump();
    const RoundTrip trip = roundTrip(std::vector<uint8_t>(text.begin(), text.end()));
    EXPECT_EQ(trip.error, "") << type;
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0)) << type;
  }
}

// ---- Matrices

/// The bytes of matrices with padded columns; the last element ends with its last component.
std::vector<uint8_t> matrices(uint32_t size, uint32_t bytes_each, uint32_t count) {
  const uint32_t column = (size * bytes_each + 3) & ~3u;
  std::vector<uint8_t> bytes(size_t{count} * size * column, 0xee);
  for (uint32_t i = 0; i < count; ++i) {
    for (uint32_t k = 0; k < size * size; ++k) {
      for (uint32_t b = 0; b < bytes_each; ++b) {
        bytes[size_t{i} * size * column + k / size * column + k % size * bytes_each + b] =
            static_cast<uint8_t>(i * 7 + k * 3 + b);
      }
    }
  }
  bytes.resize(bytes.size() - (column - size * bytes_each));
  return bytes;
}

struct MatrixKind {
  uint32_t size;
  int component_type;
  uint32_t bytes;
};
constexpr MatrixKind kMatrixKinds[] = {
    {2, kByte, 1},  {2, kUnsignedByte, 1}, {3, kByte, 1},  {3, kUnsignedByte, 1},
    {4, kByte, 1},  {2, kShort, 2},        {3, kShort, 2}, {3, kUnsignedShort, 2},
    {4, kShort, 2}, {3, kUnsignedInt, 4},  {2, kFloat, 4}, {3, kFloat, 4}};

/// The last column of the last element need not be padded (glTF 2.0, 3.6.2.4).
TEST(OtherPeoplesDocuments, MatricesAsAttributes) {
  for (const bool has_stride : {true, false}) {
    for (const MatrixKind& kind : kMatrixKinds) {
      SCOPED_TRACE("MAT" + std::to_string(kind.size) + " of " +
                   std::to_string(kind.component_type));
      Document2 d;
      const uint32_t stride = kind.size * ((kind.size * kind.bytes + 3) & ~3u);
      const uint32_t view =
          d.builder.addView(matrices(kind.size, kind.bytes, d.count), has_stride ? stride : 0);
      const uint32_t accessor =
          d.builder.addAccessor({{"bufferView", view},
                                 {"componentType", kind.component_type},
                                 {"count", d.count},
                                 {"type", "MAT" + std::to_string(kind.size)}});
      d.primitive()["attributes"]["_MAT"] = accessor;
      for (const bool indices_only : {false, true}) {
        ConvertOptions options;
        options.indices_only = indices_only;
        const RoundTrip trip = roundTrip(d.builder, options);
        ASSERT_EQ(trip.error, "");
        EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
        ASSERT_EQ(elementsInOrder(trip.source, accessor).size(), d.count);
        EXPECT_EQ(elementsOf(trip.source, accessor), elementsOf(trip.decoded, accessor));
        std::vector<uint8_t> integers;
        DecodeReport report;
        ASSERT_EQ(decodeGlb(trip.converted, integers, report, {DecodeTo::kIntegers}).message(), "");
        EXPECT_EQ(elementsOf(trip.source, accessor), elementsOf(integers, accessor));
        ValidationReport validation;
        ASSERT_EQ(validateGlb(trip.converted, {}, validation).message(), "");
        EXPECT_TRUE(validation.isValid());
      }
    }
  }
}

/// The same beside the geometry, at the end of the file, and as values of sparse accessors.
TEST(OtherPeoplesDocuments, MatricesBesideTheGeometry) {
  for (const MatrixKind& kind : kMatrixKinds) {
    SCOPED_TRACE("MAT" + std::to_string(kind.size) + " of " + std::to_string(kind.component_type));
    Document2 d;
    const Json accessor = {{"componentType", kind.component_type},
                           {"count", 5},
                           {"type", "MAT" + std::to_string(kind.size)}};
    Json sparse = accessor;
    sparse["count"] = 900;
    sparse["sparse"] = {
        {"count", 2},
        {"indices",
         {{"bufferView", d.builder.addView(bytesOf(std::vector<uint16_t>{4, 800}))},
          {"componentType", kUnsignedShort}}},
        {"values", {{"bufferView", d.builder.addView(matrices(kind.size, kind.bytes, 2))}}}};
    const uint32_t sparse_number = d.builder.addAccessor(sparse);
    Json whole = accessor;
    whole["bufferView"] = d.builder.addView(matrices(kind.size, kind.bytes, 5));
    const uint32_t whole_number = d.builder.addAccessor(whole);
    d.builder.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", whole_number}}};
    const RoundTrip trip = roundTrip(d.builder);
    ASSERT_EQ(trip.error, "");
    EXPECT_TRUE(isCompressed(jsonOf(trip.converted), 0, 0));
    for (const uint32_t number : {sparse_number, whole_number}) {
      const std::vector<std::string> elements = elementsInOrder(trip.source, number);
      EXPECT_EQ(elements.size(), number == whole_number ? 5u : 900u);
      EXPECT_EQ(elements, elementsInOrder(trip.converted, number));
      EXPECT_EQ(elements, elementsInOrder(trip.decoded, number));
    }
  }
}

}  // namespace
}  // namespace mcc::gltf::test
