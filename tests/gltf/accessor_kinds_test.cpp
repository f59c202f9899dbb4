// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Sends every kind of accessor of glTF 2.0 and KHR_mesh_quantization through writer, reader and
// validator.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "gltf/round_trip.h"
#include "support/document_compare.h"
#include "support/scratch_folder.h"
#include "support/validator.h"

namespace mcc::gltf::test {
namespace {

/// How the elements of an attribute are stored.
enum class Layout { kTight, kStrided, kInterleaved, kSparse, kSparseOverZeros, kZeros };
constexpr Layout kLayouts[] = {Layout::kTight,  Layout::kStrided,         Layout::kInterleaved,
                               Layout::kSparse, Layout::kSparseOverZeros, Layout::kZeros};

struct Kind {
  std::string name;  ///< name of the attribute
  int type = kFloat;
  bool normalized = false;
  uint32_t components = 3;
};

double lastOf(int type) {
  switch (type) {
    case kByte: return 127;
    case kUnsignedByte: return 255;
    case kShort: return 32767;
    case kUnsignedShort: return 65535;
    default: return 1;
  }
}

/// Returns values from 0 to 1 (normals of unit length, weights with the sum 1) as the kind stores
/// them, with elements padded to four bytes.
std::vector<uint8_t> store(const std::vector<float>& values, const Kind& kind) {
  const uint32_t bytes = widthOf(kind.type);
  std::vector<uint8_t> stored;
  for (size_t i = 0; i < values.size(); ++i) {
    if (kind.type == kFloat) {
      const auto* first = reinterpret_cast<const uint8_t*>(&values[i]);
      stored.insert(stored.end(), first, first + 4);
    } else {
      const double scale = kind.normalized ? lastOf(kind.type) : std::min(lastOf(kind.type), 100.0);
      const auto number = static_cast<int32_t>(std::lround(double{values[i]} * scale));
      append(stored, static_cast<uint32_t>(number), bytes);
    }
    if (i % kind.components == kind.components - 1)
      stored.resize((stored.size() + 3) & ~size_t{3}, 0);
  }
  return stored;
}

/// Smallest and largest stored component.
void addBounds(const std::vector<uint8_t>& file, uint32_t index, Json& accessor) {
  PlainDocument document;
  ASSERT_EQ(document.load({{"file", file}}, "file"), "");
  Builder::setBounds<double>(accessor, document.numbers(index), 3);
}

class Maker {
 public:
  Builder builder;
  const Sheet sheet{12};

  uint32_t add(const Kind& kind, const std::vector<float>& values, Layout layout) {
    Json accessor = {{"componentType", kind.type},
                     {"count", sheet.count()},
                     {"type", vectorType(kind.components)}};
    if (kind.normalized) accessor["normalized"] = true;
    const std::vector<uint8_t> stored = store(values, kind);
    const auto element = static_cast<uint32_t>(stored.size() / sheet.count());
    const bool is_padded = element != kind.components * widthOf(kind.type);
    switch (layout) {
      case Layout::kTight:
        accessor["bufferView"] = builder.addView(stored, is_padded ? element : 0);
        break;
      case Layout::kStrided:
        accessor["bufferView"] = addStrided(stored, element, element + 8, 0);
        break;
      case Layout::kInterleaved:
        accessor["bufferView"] = addStrided(stored, element, element + 12, 4);
        accessor["byteOffset"] = 4;
        break;
      case Layout::kSparse:
        accessor["bufferView"] =
            builder.addView(std::vector<uint8_t>(stored.size(), 0), is_padded ? element : 0);
        accessor["sparse"] = sparse(stored, element, kind, 1);
        break;
      case Layout::kSparseOverZeros: accessor["sparse"] = sparse(stored, element, kind, 2); break;
      case Layout::kZeros: break;
    }
    const uint32_t index = builder.addAccessor(accessor);
    if (kind.name == "POSITION")
      addBounds(builder.toGlb(), index, builder.json["accessors"][index]);
    return index;
  }

  std::vector<float> valuesOf(const Kind& kind) const {
    if (kind.name == "POSITION") {
      std::vector<float> values = sheet.positions;
      for (float& value : values) value = std::abs(value);
      return values;
    }
    if (kind.name == "NORMAL") return sheet.normals;
    std::vector<float> values;
    for (uint32_t i = 0; i < sheet.count(); ++i) {
      for (uint32_t c = 0; c < kind.components; ++c) {
        const float wave =
            0.5f + 0.5f * std::sin(static_cast<float>(i) * 0.05f + static_cast<float>(c));
        if (kind.name == "TANGENT") {
          values.push_back(c == 1 || c == 3 ? 1.0f : 0.0f);
        } else if (kind.name == "WEIGHTS_0") {
          values.push_back(c == i % 2 ? 1.0f : 0.0f);
        } else if (kind.name == "JOINTS_0") {
          values.push_back(c == i % 2 ? 0.01f : 0.0f);  // 1: not normalised, times 100
        } else {
          values.push_back(wave);
        }
      }
    }
    return values;
  }

 private:
  uint32_t addStrided(const std::vector<uint8_t>& stored, uint32_t element, uint32_t stride,
                      uint32_t offset) {
    std::vector<uint8_t> bytes(size_t{stride} * sheet.count(), 0xa5);
    for (uint32_t i = 0; i < sheet.count(); ++i) {
      std::copy_n(stored.begin() + static_cast<ptrdiff_t>(i * element), element,
                  bytes.begin() + static_cast<ptrdiff_t>(i * stride + offset));
    }
    return builder.addView(bytes, stride);
  }

  /// Every step-th element; values of sparse accessors are tight.
  Json sparse(const std::vector<uint8_t>& stored, uint32_t element, const Kind& kind,
              uint32_t step) {
    const uint32_t tight = kind.components * widthOf(kind.type);
    std::vector<uint8_t> values;
    std::vector<uint16_t> indices;
    for (uint32_t i = 0; i < sheet.count(); i += step) {
      const auto first = stored.begin() + static_cast<ptrdiff_t>(i * element);
      values.insert(values.end(), first, first + tight);
      indices.push_back(static_cast<uint16_t>(i));
    }
    const uint32_t index_view = builder.addView(bytesOf(indices));
    const uint32_t value_view = builder.addView(values);
    return {{"count", indices.size()},
            {"indices", {{"bufferView", index_view}, {"componentType", kUnsignedShort}}},
            {"values", {{"bufferView", value_view}}}};
  }
};

/// Converts losslessly and with default options, decodes, and compares.
class AccessorKinds : public testing::Test {
 protected:
  void check(const std::string& name, const Maker& maker) {
    SCOPED_TRACE(name);
    const std::vector<uint8_t> source = maker.builder.toGlb();
    for (const bool keeps_order : {false, true}) {
      ConvertOptions options = evenIfLarger();
      options.lossless = true;
      options.keep_vertex_order = options.keep_triangle_order = keeps_order;
      const RoundTrip trip = roundTrip(source, options);
      ASSERT_EQ(trip.error, "");
      const Json json = jsonOf(trip.converted);
      EXPECT_TRUE(isCompressed(json, 0, 0));
      EXPECT_EQ(differenceOfPrimitives(source, trip.decoded, keeps_order), "");
    }
    const RoundTrip trip = roundTrip(source, evenIfLarger());
    ASSERT_EQ(trip.error, "");
    validator_.add(name, source, trip.converted, trip.decoded);
  }

  void TearDown() override {
    if (mcc::test::Validator::whyNot().empty()) {
      EXPECT_TRUE(validator_.run()) << "the lines above name what is new";
    }
  }

  const mcc::test::ScratchFolder folder_;
  mcc::test::Validator validator_{folder_.path()};
};

std::string nameOf(const Kind& kind) {
  return kind.name + "_" + std::to_string(kind.components) + "_" + std::to_string(kind.type) +
         (kind.normalized ? "n" : "");
}

TEST_F(AccessorKinds, AttributesOfAllTypes) {
  std::vector<Kind> kinds;
  for (const int type : {kByte, kUnsignedByte, kShort, kUnsignedShort}) {
    for (const bool normalized : {false, true}) {
      kinds.push_back({"POSITION", type, normalized, 3});
      kinds.push_back({"TEXCOORD_0", type, normalized, 2});
      for (const uint32_t components : {1u, 2u, 3u, 4u}) {
        kinds.push_back({"_CUSTOM", type, normalized, components});
      }
    }
  }
  kinds.push_back({"NORMAL", kByte, true, 3});
  kinds.push_back({"NORMAL", kShort, true, 3});
  kinds.push_back({"TANGENT", kByte, true, 4});
  kinds.push_back({"TANGENT", kShort, true, 4});
  for (const uint32_t components : {3u, 4u}) {
    kinds.push_back({"COLOR_0", kUnsignedByte, true, components});
    kinds.push_back({"COLOR_0", kUnsignedShort, true, components});
    kinds.push_back({"COLOR_0", kFloat, false, components});
  }
  for (const Kind& kind : kinds) {
    Maker maker;
    const Kind position = kind.name == "POSITION" ? kind : Kind{"POSITION", kFloat, false, 3};
    Json attributes = {{"POSITION", maker.add(position, maker.valuesOf(position), Layout::kTight)}};
    if (kind.name == "TANGENT")
      attributes["NORMAL"] = maker.builder.addFloats(maker.sheet.normals, 3);
    if (kind.name != "POSITION")
      attributes[kind.name] = maker.add(kind, maker.valuesOf(kind), Layout::kTight);
    maker.builder.addMesh(
        {{{"attributes", attributes}, {"indices", maker.builder.addIndices(maker.sheet.indices)}}});
    maker.builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    maker.builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    check(nameOf(kind), maker);
  }
}

TEST_F(AccessorKinds, SkinsOfAllTypes) {
  for (const int joint_type : {kUnsignedByte, kUnsignedShort}) {
    for (const int weight_type : {kUnsignedByte, kUnsignedShort, kFloat}) {
      Maker maker;
      const Kind joints = {"JOINTS_0", joint_type, false, 4};
      const Kind weights = {"WEIGHTS_0", weight_type, weight_type != kFloat, 4};
      const Json attributes = {
          {"POSITION", maker.builder.addPositions(maker.sheet.positions)},
          {"JOINTS_0", maker.add(joints, maker.valuesOf(joints), Layout::kTight)},
          {"WEIGHTS_0", maker.add(weights, maker.valuesOf(weights), Layout::kTight)}};
      maker.builder.addMesh({{{"attributes", attributes},
                              {"indices", maker.builder.addIndices(maker.sheet.indices)}}});
      Json& json = maker.builder.json;
      json["nodes"].push_back({{"children", {2}}});
      json["nodes"].push_back({{"name", "tip"}});
      json["scenes"][0]["nodes"].push_back(1);
      json["skins"] = {{{"joints", {1, 2}}}};
      json["nodes"][0]["skin"] = 0;
      check(nameOf(joints) + nameOf(weights), maker);
    }
  }
}

TEST_F(AccessorKinds, LayoutsOfAllKinds) {
  const Kind kinds[] = {{"POSITION", kFloat, false, 3},
                        {"POSITION", kShort, true, 3},
                        {"NORMAL", kFloat, false, 3},
                        {"TEXCOORD_0", kUnsignedByte, true, 2},
                        {"_CUSTOM", kUnsignedShort, false, 1}};
  for (const Kind& kind : kinds) {
    for (const Layout layout : kLayouts) {
      const bool is_zero = layout == Layout::kZeros || layout == Layout::kSparseOverZeros;
      if (kind.name == "NORMAL" && is_zero) continue;  // no unit vectors
      Maker maker;
      const Kind position = {"POSITION", kFloat, false, 3};
      Json attributes = {
          {"POSITION", maker.add(position, maker.valuesOf(position), Layout::kTight)}};
      attributes[kind.name] = maker.add(kind, maker.valuesOf(kind), layout);
      maker.builder.addMesh({{{"attributes", attributes},
                              {"indices", maker.builder.addIndices(maker.sheet.indices)}}});
      maker.builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
      maker.builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
      check(nameOf(kind) + "_layout" + std::to_string(static_cast<int>(layout)), maker);
    }
  }
}

TEST_F(AccessorKinds, IndicesAndModes) {
  for (const int mode : {4, 5, 6}) {
    for (const int type : {0, kUnsignedByte, kUnsignedShort, kUnsignedInt}) {
      Maker maker;
      Json primitive = {
          {"attributes", {{"POSITION", maker.builder.addPositions(maker.sheet.positions)}}},
          {"mode", mode}};
      std::vector<uint16_t> indices = maker.sheet.indices;
      if (mode != 4) {  // a strip along the rows
        indices.clear();
        for (uint16_t i = 0; i + 13u < maker.sheet.count(); ++i) {
          indices.push_back(i);
          indices.push_back(static_cast<uint16_t>(i + 13));
        }
      }
      const std::vector<uint8_t> narrow(indices.begin(), indices.end());
      const std::vector<uint32_t> wide(indices.begin(), indices.end());
      if (type == kUnsignedByte)
        primitive["indices"] = maker.builder.addAccessor(narrow, type, "SCALAR", narrow.size());
      if (type == kUnsignedShort) primitive["indices"] = maker.builder.addIndices(indices);
      if (type == kUnsignedInt)
        primitive["indices"] = maker.builder.addAccessor(wide, type, "SCALAR", wide.size());
      if (type == 0 && mode == 4) {  // a count of three per triangle
        const auto first = maker.sheet.positions.begin();
        primitive["attributes"]["POSITION"] = maker.builder.addPositions({first, first + 3 * 168});
      }
      maker.builder.addMesh({primitive});
      check("mode" + std::to_string(mode) + "_" + std::to_string(type), maker);
    }
  }
}

/// One accessor of a triangle primitive and of points, of lines, of a morph target, of an
/// animation.
TEST_F(AccessorKinds, InOtherUse) {
  Maker maker;
  Builder& builder = maker.builder;
  Json primitive = maker.sheet.addTo(builder);
  const Json position = primitive["attributes"]["POSITION"];
  const Json points = {{"attributes", {{"POSITION", position}}}, {"mode", 0}};
  const Json lines = {
      {"attributes", {{"POSITION", position}}}, {"indices", primitive["indices"]}, {"mode", 1}};
  builder.addMesh({primitive, points, lines});
  Json morphed = maker.sheet.addTo(builder);
  morphed["targets"] = {{{"POSITION", position}}};
  builder.addMesh({morphed});
  std::vector<float> ascending(maker.sheet.count());
  for (size_t i = 0; i < ascending.size(); ++i) ascending[i] = static_cast<float>(i);
  const uint32_t times = builder.addFloats(ascending, 1);
  builder.json["accessors"][times]["min"] = {0};
  builder.json["accessors"][times]["max"] = {ascending.back()};
  builder.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", position}}}}}};
  check("shared", maker);
}

}  // namespace
}  // namespace mcc::gltf::test
