// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Other projects' codecs as we measure them: known bytes, errors, damaged input.
#if defined(MCC_HAS_FOREIGN)

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "foreign/draco_codec.h"
#include "foreign/meshopt_codec.h"

#if __has_include("draco/compression/expert_encode.h")
#define MCC_HAS_DRACO_HEADERS 1
#include "draco/compression/expert_encode.h"
#include "support/plain_reader.h"
#include "support/triangles.h"
#endif

namespace mcc::foreign {
namespace {

/// A primitive of a GLB, read without code of this project.
struct Model {
  uint32_t wedge_count = 0;
  std::vector<uint32_t> indices;
  std::vector<std::vector<std::byte>> columns;
  std::vector<AttributeView> attributes;
  PartView part;

  PieceView piece() {
    part.indices = indices;
    return {wedge_count, attributes, {&part, 1}};
  }
  void add(const AttributeFormat& format, std::vector<std::byte> column, uint8_t bits) {
    columns.push_back(std::move(column));
    attributes.push_back({format, nullptr, elementBytes(format), bits, nullptr});
    for (size_t i = 0; i < columns.size(); ++i) attributes[i].data = columns[i].data();
  }
};

struct Bits {
  uint8_t position = 14;
  uint8_t normal = 10;
  uint8_t texcoord = 12;
  uint8_t color = 8;
  uint8_t generic = 12;
};

bool formatOf(const std::string& name, const gltf::Json& accessor, AttributeFormat& format) {
  const std::string type = accessor["type"];
  format.component_count = static_cast<uint8_t>(type == "SCALAR" ? 1 : type.back() - '0');
  format.normalized = accessor.value("normalized", false);
  switch (accessor["componentType"].get<int>()) {
    case 5120: format.component_type = ComponentType::kInt8; break;
    case 5121: format.component_type = ComponentType::kUint8; break;
    case 5122: format.component_type = ComponentType::kInt16; break;
    case 5123: format.component_type = ComponentType::kUint16; break;
    case 5125: format.component_type = ComponentType::kUint32; break;
    case 5126: format.component_type = ComponentType::kFloat32; break;
    default: return false;
  }
  const std::string stem = name.substr(0, name.find('_'));
  format.semantic = stem == "POSITION"   ? Semantic::kPosition
                    : stem == "NORMAL"   ? Semantic::kNormal
                    : stem == "TANGENT"  ? Semantic::kTangent
                    : stem == "TEXCOORD" ? Semantic::kTexcoord
                    : stem == "COLOR"    ? Semantic::kColor
                    : stem == "JOINTS"   ? Semantic::kJoints
                    : stem == "WEIGHTS"  ? Semantic::kWeights
                                         : Semantic::kCustom;
  return true;
}

/// Reads the first primitive of a corpus GLB; false when the corpus is absent.
bool loadModel(const std::string& name, const Bits& bits, Model& model) {
#if defined(MCC_CORPUS_DIR)
  const std::filesystem::path path = std::filesystem::path(MCC_CORPUS_DIR) / (name + ".glb");
#else
  const std::filesystem::path path = name;
#endif
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  const std::vector<uint8_t> glb((std::istreambuf_iterator<char>(file)),
                                 std::istreambuf_iterator<char>());
  gltf::test::PlainDocument document;
  EXPECT_EQ(document.load({{name, glb}}, name), "");
  const gltf::Json& primitive = document.json["meshes"][0]["primitives"][0];
  const std::vector<double> indices = document.numbers(primitive["indices"].get<uint64_t>());
  model.indices.assign(indices.begin(), indices.end());
  for (const auto& [semantic, accessor_index] : primitive["attributes"].items()) {
    const gltf::Json& accessor = document.json["accessors"][accessor_index.get<size_t>()];
    AttributeFormat format;
    if (!formatOf(semantic, accessor, format)) return false;
    model.wedge_count = accessor["count"];
    const uint8_t bits_here = format.semantic == Semantic::kPosition   ? bits.position
                              : format.semantic == Semantic::kNormal   ? bits.normal
                              : format.semantic == Semantic::kTexcoord ? bits.texcoord
                              : format.semantic == Semantic::kColor    ? bits.color
                                                                       : bits.generic;
    std::vector<std::byte> column;
    for (const std::string& element : document.elements(accessor_index.get<uint64_t>()).values) {
      for (const char byte : element) column.push_back(static_cast<std::byte>(byte));
    }
    model.add(format, std::move(column), bits_here);
  }
  return true;
}

template <typename T>
std::vector<std::byte> bytesOf(const std::vector<T>& values) {
  std::vector<std::byte> result(values.size() * sizeof(T));
  std::memcpy(result.data(), values.data(), result.size());
  return result;
}

/// An open grid of size x size wedges with normals, bent so that predictions are not exact.
Model makeGrid(uint32_t size, const Bits& bits) {
  Model model;
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<uint16_t> joints;
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      const float u = static_cast<float>(x) * 0.1f;
      const float v = static_cast<float>(y) * 0.13f;
      positions.insert(positions.end(), {u, v, std::sin(u) * std::cos(2 * v)});
      const float nx = -std::cos(u);
      const float ny = 0.5f * std::sin(v);
      const float length = std::sqrt(nx * nx + ny * ny + 1);
      normals.insert(normals.end(), {nx / length, ny / length, 1 / length});
      joints.insert(joints.end(),
                    {static_cast<uint16_t>(x % 3), static_cast<uint16_t>(y % 5), 7, 0});
    }
  }
  for (uint32_t y = 0; y + 1 < size; ++y) {
    for (uint32_t x = 0; x + 1 < size; ++x) {
      const uint32_t a = y * size + x;
      model.indices.insert(model.indices.end(),
                           {a, a + 1, a + size, a + size, a + 1, a + size + 1});
    }
  }
  model.wedge_count = size * size;
  model.add({Semantic::kNormal, 0, ComponentType::kFloat32, false, 3, 0}, bytesOf(normals),
            bits.normal);
  model.add({Semantic::kPosition, 0, ComponentType::kFloat32, false, 3, 0}, bytesOf(positions),
            bits.position);
  model.add({Semantic::kJoints, 0, ComponentType::kUint16, false, 4, 0}, bytesOf(joints), 0);
  return model;
}

DracoInput inputOf(Model& model) {
  DracoInput input;
  const Outcome made = makeDracoInput(model.piece(), 0, input);
  EXPECT_TRUE(made.ok()) << made.message;
  return input;
}

size_t sumOf(const DracoStreams& streams) {
  size_t sum = streams.header_bytes + streams.connectivity_bytes;
  for (const size_t bytes : streams.attribute_bytes) sum += bytes;
  return sum;
}

/// What Draco 1.5.7's own encoder writes at 14/10/12/8/12 bits, measured independently of this
/// project.
struct Anchor {
  const char* file;
  int speed;
  size_t total;
  size_t connectivity;
  size_t position;
  size_t tolerance;
};

class DracoAnchors : public testing::TestWithParam<Anchor> {};

TEST_P(DracoAnchors, BytesAreThoseOfTheWrapper) {
  const Anchor& anchor = GetParam();
  Model model;
  if (!loadModel(anchor.file, Bits{}, model)) GTEST_SKIP() << "no corpus: " << anchor.file;
  const DracoInput input = inputOf(model);
  DracoEncoded encoded;
  const Outcome done = encodeDraco(input, anchor.speed, encoded);
  ASSERT_TRUE(done.ok()) << done.message;
  EXPECT_EQ(sumOf(encoded.streams), encoded.bytes.size());
  const auto far = [](size_t a, size_t b) { return a > b ? a - b : b - a; };
  EXPECT_LE(far(encoded.bytes.size(), anchor.total), anchor.tolerance) << encoded.bytes.size();
  EXPECT_EQ(encoded.streams.connectivity_bytes, anchor.connectivity);
  EXPECT_LE(far(encoded.streams.attribute_bytes[0], anchor.position), anchor.tolerance)
      << encoded.streams.attribute_bytes[0];

  DecodedMesh decoded;
  ASSERT_TRUE(decodeDraco(encoded.bytes, decoded).ok());
  EXPECT_EQ(decoded.triangle_count, model.indices.size() / 3);
  DracoErrors errors;
  const Outcome measured = measureDracoErrors(input, decoded, errors);
  ASSERT_TRUE(measured.ok()) << measured.message;
  EXPECT_EQ(errors.unmatched_vertex_count, 0u);
  EXPECT_EQ(errors.missing_wedge_count, 0u);
  const double step = double{input.attributes[0].lattice.step};
  EXPECT_LE(errors.attributes[0].maximum, step * 0.502);
  EXPECT_GE(errors.attributes[0].maximum, step * 0.49);
  for (size_t i = 0; i < input.attributes.size(); ++i) {
    if (errors.attributes[i].is_angle) {
      EXPECT_LT(errors.attributes[i].maximum, 0.5) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, DracoAnchors,
                         testing::Values(Anchor{"a_koala", 0, 144771, 13868, 130863, 16},
                                         Anchor{"a_koala", 3, 151517, 13868, 137609, 16},
                                         Anchor{"a_koala", 5, 163223, 25018, 138165, 16},
                                         Anchor{"a_bunny", 0, 75460, 5478, 69942, 16},
                                         Anchor{"a_bunny", 5, 96582, 17436, 79106, 16},
                                         Anchor{"b_skull", 0, 156247, 14274, 141933, 16},
                                         Anchor{"b_skull", 5, 173146, 25040, 148066, 16},
                                         Anchor{"c_human_uvn", 0, 54742, 2855, 23013, 64},
                                         Anchor{"c_human_uvn", 5, 67734, 6059, 25074, 64},
                                         Anchor{"f_greysnapper", 0, 16920, 643, 4453, 64},
                                         Anchor{"f_greysnapper", 5, 20323, 916, 4830, 64}),
                         [](const testing::TestParamInfo<Anchor>& anchor) {
                           return std::string(anchor.param.file) + "_speed" +
                                  std::to_string(anchor.param.speed);
                         });

TEST(DracoCodec, PositionComesFirstAndIntegersStayExact) {
  Model model = makeGrid(30, Bits{});
  const DracoInput input = inputOf(model);
  ASSERT_EQ(input.attributes.size(), 3u);
  EXPECT_EQ(input.attributes[0].piece_attribute, 1u);
  EXPECT_TRUE(input.attributes[1].is_octahedral);
  EXPECT_EQ(input.attributes[2].quantization_bits, 0);
  for (const int speed : {0, 3, 5}) {
    DracoEncoded encoded;
    ASSERT_TRUE(encodeDraco(input, speed, encoded).ok());
    EXPECT_EQ(sumOf(encoded.streams), encoded.bytes.size());
    DracoEncoded again;
    ASSERT_TRUE(encodeDraco(input, speed, again).ok());
    EXPECT_EQ(encoded.bytes, again.bytes);
    DecodedMesh decoded;
    ASSERT_TRUE(decodeDraco(encoded.bytes, decoded).ok());
    EXPECT_EQ(decoded.vertex_count, 900u);
    EXPECT_EQ(decoded.triangle_count, model.indices.size() / 3);
    EXPECT_GE(decoded.decode_ms, decoded.extract_ms);
    DracoErrors errors;
    ASSERT_TRUE(measureDracoErrors(input, decoded, errors).ok());
    EXPECT_EQ(errors.unmatched_vertex_count, 0u);
    EXPECT_EQ(errors.missing_wedge_count, 0u);
    EXPECT_EQ(errors.attributes[0].measured_count, 900u);
    EXPECT_GT(errors.attributes[0].median, 0.0);
    EXPECT_TRUE(errors.attributes[1].is_angle);
    EXPECT_GT(errors.attributes[1].maximum, 0.0);
    EXPECT_LT(errors.attributes[1].maximum, 0.5);
    EXPECT_EQ(errors.attributes[2].maximum, 0.0);
  }
}

TEST(DracoCodec, DecodesOnTheLatticeItWasGiven) {
  Model model = makeGrid(12, Bits{});
  Lattice lattice;
  lattice.origin[0] = -8;
  lattice.origin[1] = -8;
  lattice.origin[2] = -8;
  lattice.step = 0.0078125f;  // a power of two: every decoded value is a lattice point exactly
  model.attributes[1].lattice = &lattice;
  model.attributes[1].quantization_bits = 11;
  const DracoInput input = inputOf(model);
  EXPECT_EQ(input.attributes[0].range, 0.0078125f * 2047);
  DracoEncoded encoded;
  ASSERT_TRUE(encodeDraco(input, 0, encoded).ok());
  DecodedMesh decoded;
  ASSERT_TRUE(decodeDraco(encoded.bytes, decoded).ok());
  const DecodedAttribute* positions = decoded.find(0);
  ASSERT_NE(positions, nullptr);
  for (uint32_t i = 0; i < decoded.vertex_count * 3; ++i) {
    const float index = (positions->floats()[i] + 8) / lattice.step;
    EXPECT_EQ(index, std::round(index));
  }
}

/// Models of a millimetre, far from the origin: Draco's own setter would round the lattice to 1e-6.
TEST(DracoCodec, LatticeOfSmallModelsIsNotRounded) {
  Model model = makeGrid(12, Bits{});
  auto* positions = reinterpret_cast<float*>(model.columns[1].data());
  for (uint32_t i = 0; i < model.wedge_count * 3; ++i) positions[i] = positions[i] * 1e-5f + 1e-4f;
  const DracoInput input = inputOf(model);
  DracoEncoded encoded;
  ASSERT_TRUE(encodeDraco(input, 0, encoded).ok());
  DecodedMesh decoded;
  ASSERT_TRUE(decodeDraco(encoded.bytes, decoded).ok());
  DracoErrors errors;
  ASSERT_TRUE(measureDracoErrors(input, decoded, errors).ok());
  EXPECT_EQ(errors.unmatched_vertex_count, 0u);
  EXPECT_LE(errors.attributes[0].maximum, double{input.attributes[0].lattice.step} * 0.51);
}

#if defined(MCC_HAS_DRACO_HEADERS)
TEST(DracoCodec, BytesAreThoseOfDracosOwnEncoder) {
  Model model = makeGrid(30, Bits{});
  const DracoInput input = inputOf(model);
  draco::Mesh mesh;
  mesh.set_num_points(model.wedge_count);
  const std::array<size_t, 3> order = {1, 0, 2};
  const std::array<draco::GeometryAttribute::Type, 3> types = {draco::GeometryAttribute::POSITION,
                                                               draco::GeometryAttribute::NORMAL,
                                                               draco::GeometryAttribute::GENERIC};
  for (size_t i = 0; i < 3; ++i) {
    const AttributeFormat& format = model.attributes[order[i]].format;
    draco::GeometryAttribute description;
    description.Init(
        types[i], nullptr, format.component_count,
        format.component_type == ComponentType::kFloat32 ? draco::DT_FLOAT32 : draco::DT_UINT16,
        false, elementBytes(format), 0);
    const int id = mesh.AddAttribute(description, true, model.wedge_count);
    mesh.attribute(id)->buffer()->Write(0, model.columns[order[i]].data(),
                                        model.columns[order[i]].size());
  }
  for (size_t i = 0; i < model.indices.size(); i += 3) {
    draco::Mesh::Face face;
    for (size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(model.indices[i + k]);
    mesh.AddFace(face);
  }
  mesh.DeduplicateAttributeValues();
  mesh.DeduplicatePointIds();
  for (const int speed : {0, 3, 5, 10}) {
    for (const DracoMethod method : {DracoMethod::kEdgebreaker, DracoMethod::kSequential}) {
      draco::ExpertEncoder encoder(mesh);
      encoder.SetSpeedOptions(speed, speed);
      encoder.SetEncodingMethod(method == DracoMethod::kEdgebreaker
                                    ? draco::MESH_EDGEBREAKER_ENCODING
                                    : draco::MESH_SEQUENTIAL_ENCODING);
      encoder.SetAttributeQuantization(0, 14);
      encoder.SetAttributeQuantization(1, 10);
      draco::EncoderBuffer buffer;
      ASSERT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
      DracoInput other = input;
      other.method = method;
      DracoEncoded encoded;
      ASSERT_TRUE(encodeDraco(other, speed, encoded).ok());
      const auto* data = reinterpret_cast<const uint8_t*>(buffer.data());
      EXPECT_EQ(encoded.bytes, std::vector<uint8_t>(data, data + buffer.size())) << speed;
    }
  }
}
#endif

TEST(DracoCodec, ConnectivityAloneIsThatOfTheWeldedMesh) {
  Model model = makeGrid(40, Bits{});
  // A second copy of every wedge with another joint index: seams, but the same triangles when
  // welded.
  Model split = makeGrid(40, Bits{});
  const uint32_t count = split.wedge_count;
  for (size_t c = 0; c < split.columns.size(); ++c) {
    std::vector<std::byte> twice = split.columns[c];
    twice.insert(twice.end(), split.columns[c].begin(), split.columns[c].end());
    split.columns[c] = twice;
    split.attributes[c].data = split.columns[c].data();
  }
  for (uint32_t wedge = count; wedge < 2 * count; ++wedge)
    split.columns[2][wedge * 8] ^= std::byte{1};
  split.wedge_count = 2 * count;
  for (size_t i = split.indices.size() / 2; i < split.indices.size(); ++i)
    split.indices[i] += count;
  DracoConnectivity plain;
  DracoConnectivity seamed;
  ASSERT_TRUE(encodeDracoConnectivity(inputOf(model), 0, plain).ok());
  ASSERT_TRUE(encodeDracoConnectivity(inputOf(split), 0, seamed).ok());
  EXPECT_EQ(plain.connectivity_bytes, seamed.connectivity_bytes);
  DracoEncoded whole;
  ASSERT_TRUE(encodeDraco(inputOf(split), 0, whole).ok());
  EXPECT_GT(whole.streams.connectivity_bytes, seamed.connectivity_bytes);
  DecodedMesh decoded;
  ASSERT_TRUE(decodeDraco(seamed.positions_only.bytes, decoded).ok());
  EXPECT_EQ(decoded.triangle_count, model.indices.size() / 3);
}

TEST(DracoCodec, ReportsWedgesOfDroppedTriangles) {
  Model model = makeGrid(5, Bits{});
  // A wedge that only a degenerate triangle uses.
  model.wedge_count += 1;
  for (size_t c = 0; c < model.columns.size(); ++c) {
    model.columns[c].resize(model.wedge_count * elementBytes(model.attributes[c].format));
    model.attributes[c].data = model.columns[c].data();
  }
  model.columns[1][25 * 12 + 3] = std::byte{0x40};  // x = 2
  model.indices.insert(model.indices.end(), {25, 25, 3});
  const DracoInput input = inputOf(model);
  DracoEncoded encoded;
  ASSERT_TRUE(encodeDraco(input, 5, encoded).ok());
  DecodedMesh decoded;
  ASSERT_TRUE(decodeDraco(encoded.bytes, decoded).ok());
  EXPECT_EQ(decoded.triangle_count + 1, model.indices.size() / 3);
  DracoErrors errors;
  ASSERT_TRUE(measureDracoErrors(input, decoded, errors).ok());
  EXPECT_EQ(errors.unmatched_vertex_count, 0u);
  EXPECT_EQ(errors.missing_wedge_count, 1u);
}

TEST(DracoCodec, NanKeepsAnAttributeExact) {
  Model model = makeGrid(6, Bits{});
  const float nan = std::nanf("");
  std::memcpy(&model.columns[1][24], &nan, 4);
  const DracoInput input = inputOf(model);
  EXPECT_EQ(input.attributes[0].quantization_bits, 0);
  DracoEncoded encoded;
  ASSERT_TRUE(encodeDraco(input, 5, encoded).ok());
  DecodedMesh decoded;
  ASSERT_TRUE(decodeDraco(encoded.bytes, decoded).ok());
  DracoErrors errors;
  ASSERT_TRUE(measureDracoErrors(input, decoded, errors).ok());
  EXPECT_EQ(errors.attributes[0].maximum, 0.0);
  EXPECT_EQ(errors.attributes[0].undefined_count, 0u);
}

/// Draco subtracts, divides and converts to integers in float32, so its predictors see values that
/// may be off by one.
TEST(DracoCodec, RangesBeyondFloatStayExact) {
  const Model plain = makeGrid(6, Bits{});
  for (size_t attribute = 0; attribute < plain.attributes.size(); ++attribute) {
    for (const float far : {3e38f, 2e38f}) {
      for (const bool has_lattice : {false, true}) {
        Model model = makeGrid(6, Bits{});
        if (model.attributes[attribute].format.component_type != ComponentType::kFloat32) continue;
        const float ends[2] = {far, -far};
        const size_t stride = model.attributes[attribute].stride_bytes;
        for (size_t i = 0; i < 10; ++i)
          std::memcpy(&model.columns[attribute][stride * i], &ends[i % 2], 4);
        Lattice lattice;
        std::fill_n(lattice.origin, 4, -far);
        lattice.step = static_cast<float>(2.0 * double{far} / 4095);
        if (has_lattice) model.attributes[attribute].lattice = &lattice;
        for (const int speed : {0, 3, 5, 10}) {
          const DracoInput input = inputOf(model);
          DracoEncoded encoded;
          ASSERT_EQ(encodeDraco(input, speed, encoded).message, "");
          DecodedMesh decoded;
          ASSERT_EQ(decodeDraco(encoded.bytes, decoded).message, "");
          DracoErrors errors;
          ASSERT_EQ(measureDracoErrors(input, decoded, errors).message, "");
        }
      }
    }
  }
}

TEST(DracoCodec, DamagedBytesAreAnError) {
  Model model = makeGrid(6, Bits{});
  DracoEncoded encoded;
  ASSERT_TRUE(encodeDraco(inputOf(model), 0, encoded).ok());
  DecodedMesh decoded;
  for (size_t size = 0; size < encoded.bytes.size(); size += 7) {
    const std::vector<uint8_t> cut(encoded.bytes.begin(),
                                   encoded.bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(decodeDraco(cut, decoded).ok()) << size;
  }
  const std::vector<uint8_t> noise(100, 0x55);
  const Outcome outcome = decodeDraco(noise, decoded);
  EXPECT_NE(outcome.message.find("Draco"), std::string::npos);
}

TEST(DracoCodec, BadInputIsAnError) {
  Model model = makeGrid(4, Bits{});
  DracoInput input;
  EXPECT_FALSE(makeDracoInput(model.piece(), 1, input).ok());
  model.attributes[1].quantization_bits = 31;
  EXPECT_FALSE(makeDracoInput(model.piece(), 0, input).ok());
  model.attributes[1].quantization_bits = 14;
  model.indices[0] = 16;
  EXPECT_FALSE(makeDracoInput(model.piece(), 0, input).ok());
  model.indices.clear();
  EXPECT_FALSE(makeDracoInput(model.piece(), 0, input).ok());
  model.indices = {1, 1, 2};
  ASSERT_TRUE(makeDracoInput(model.piece(), 0, input).ok());
  DracoEncoded encoded;
  EXPECT_FALSE(encodeDraco(input, 0, encoded).ok());  // nothing but a degenerate triangle
}

TEST(DracoCodec, PrimitiveForGltf) {
  Model model = makeGrid(20, Bits{});
  DracoPrimitive primitive;
  ASSERT_TRUE(emitDracoPrimitive(model.piece(), 0, 0, primitive).ok());
  EXPECT_EQ(primitive.method, DracoMethod::kEdgebreaker);
  EXPECT_EQ(primitive.vertex_count, 400u);
  EXPECT_EQ(primitive.triangle_count, 19u * 19 * 2);
  ASSERT_EQ(primitive.attributes.size(), 3u);
  EXPECT_EQ(primitive.attributes[0].piece_attribute, 1u);
  EXPECT_EQ(primitive.attributes[0].unique_id, 0u);
  EXPECT_NEAR(primitive.attributes[0].minimum[0], 0.0, 1e-3);
  EXPECT_NEAR(primitive.attributes[0].maximum[0], 1.9, 1e-3);
  EXPECT_EQ(primitive.attributes[2].maximum[2], 7.0);
}

TEST(DracoCodec, MorphTargetsKeepTheOrder) {
  Model model = makeGrid(20, Bits{});
  model.add({Semantic::kPosition, 0, ComponentType::kFloat32, false, 3, 1}, model.columns[1], 14);
  DracoPrimitive primitive;
  ASSERT_TRUE(emitDracoPrimitive(model.piece(), 0, 5, primitive).ok());
  EXPECT_EQ(primitive.method, DracoMethod::kSequential);
  EXPECT_EQ(primitive.left_out, std::vector<uint32_t>{3});
  DecodedMesh decoded;
  ASSERT_TRUE(decodeDraco(primitive.bytes, decoded).ok());
  EXPECT_EQ(decoded.vertex_count, model.wedge_count);
  EXPECT_TRUE(std::equal(model.indices.begin(), model.indices.end(), decoded.indices.get()));
}

TEST(MeshoptCodec, LosslessIsExact) {
  Model model = makeGrid(25, Bits{});
  MeshoptOptions options;
  options.is_lossless = true;
  MeshoptEncoded encoded;
  ASSERT_TRUE(encodeMeshopt(model.piece(), 0, options, encoded).ok());
  DecodedMesh decoded;
  ASSERT_TRUE(decodeMeshopt(encoded, encoded.bytes, decoded).ok());
  EXPECT_EQ(decoded.vertex_count, model.wedge_count);
  EXPECT_EQ(decoded.triangle_count, model.indices.size() / 3);
  for (uint32_t a = 0; a < model.attributes.size(); ++a) {
    const DecodedAttribute* attribute = decoded.find(a);
    ASSERT_NE(attribute, nullptr);
    const size_t bytes = elementBytes(model.attributes[a].format);
    for (uint32_t wedge = 0; wedge < model.wedge_count; ++wedge) {
      ASSERT_EQ(std::memcmp(attribute->values.get() + encoded.wedge_vertex[wedge] * bytes,
                            &model.columns[a][wedge * bytes], bytes),
                0);
    }
  }
  // The triangles, as sets of rotated index triples.
  const auto triples = [](std::span<const uint32_t> indices, const std::vector<uint32_t>& map) {
    return test::sorted(
        test::trianglesOf(indices, [&](uint32_t i) { return map.empty() ? i : map[i]; }));
  };
  EXPECT_EQ(triples(decoded.indexSpan(), {}), triples(model.indices, encoded.wedge_vertex));
}

TEST(MeshoptCodec, QuantisedWithinHalfAStep) {
  for (const bool use_filters : {false, true}) {
    Model model = makeGrid(25, Bits{});
    MeshoptOptions options;
    options.use_filters = use_filters;
    MeshoptEncoded encoded;
    ASSERT_TRUE(encodeMeshopt(model.piece(), 0, options, encoded).ok());
    DecodedMesh plain;
    DecodedMesh decoded;
    ASSERT_TRUE(decodeMeshopt(encoded, encoded.bytes, plain).ok());
    ASSERT_TRUE(decodeMeshoptZstd(encoded, encoded.zstd_bytes, decoded).ok());
    EXPECT_TRUE(
        std::equal(plain.indexSpan().begin(), plain.indexSpan().end(), decoded.indices.get()));
    std::vector<AttributeError> errors;
    ASSERT_TRUE(measureMeshoptErrors(model.piece(), encoded, decoded, errors).ok());
    EXPECT_LE(errors[1].maximum, double{encoded.streams[1].lattice.step} * 0.501);
    EXPECT_LT(errors[0].maximum, 0.5);
    EXPECT_EQ(errors[2].maximum, 0.0);
    EXPECT_FALSE(decodeMeshopt(encoded, std::span(encoded.bytes).first(20), decoded).ok());
    EXPECT_FALSE(decodeMeshoptZstd(encoded, encoded.bytes, decoded).ok());
  }
}

TEST(MeshoptCodec, TangentsKeepTheirSign) {
  for (const bool use_filters : {false, true}) {
    Model model = makeGrid(10, Bits{});
    std::vector<float> tangents;
    for (uint32_t i = 0; i < model.wedge_count; ++i) {
      tangents.insert(tangents.end(), {0.6f, 0.0f, 0.8f, i % 2 == 0 ? 1.0f : -1.0f});
    }
    model.add({Semantic::kTangent, 0, ComponentType::kFloat32, false, 4, 0}, bytesOf(tangents), 12);
    MeshoptOptions options;
    options.use_filters = use_filters;
    MeshoptEncoded encoded;
    ASSERT_TRUE(encodeMeshopt(model.piece(), 0, options, encoded).ok());
    DecodedMesh decoded;
    ASSERT_TRUE(decodeMeshopt(encoded, encoded.bytes, decoded).ok());
    std::vector<AttributeError> errors;
    ASSERT_TRUE(measureMeshoptErrors(model.piece(), encoded, decoded, errors).ok());
    EXPECT_TRUE(errors[3].is_angle);
    EXPECT_EQ(errors[3].sign_flip_count, 0u);
    EXPECT_LT(errors[3].maximum, 0.1);
    EXPECT_NEAR(errors[3].maximum_component, 0, 1e-3);
  }
}

TEST(MeshoptCodec, CloseToGltfpackOnTheCorpus) {
  Model model;
  if (!loadModel("c_human_uvn", Bits{}, model)) GTEST_SKIP() << "no corpus";
  MeshoptEncoded encoded;
  ASSERT_TRUE(encodeMeshopt(model.piece(), 0, {}, encoded).ok());
  EXPECT_NEAR(static_cast<double>(encoded.bytes.size()), 137092.0, 137092.0 * 0.03);
  EXPECT_NEAR(static_cast<double>(encoded.zstd_bytes.size()), 117581.0, 117581.0 * 0.03);
}

TEST(MeasureError, AnglesAndMedians) {
  const std::vector<float> source = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0};
  const std::vector<float> decoded = {0, 0, 1, 0, 1, 1, 1, 0, 0, 0, 1, 0};
  AttributeView view;
  view.format = {Semantic::kNormal, 0, ComponentType::kFloat32, false, 3, 0};
  view.data = source.data();
  view.stride_bytes = 12;
  AttributeError error;
  ASSERT_TRUE(measureError(view, 4, ComponentType::kFloat32, decoded.data(),
                           std::vector<uint32_t>{0, 1, 2, 3}, error)
                  .ok());
  EXPECT_TRUE(error.is_angle);
  EXPECT_NEAR(error.maximum, 90, 1e-9);
  EXPECT_NEAR(error.median, 45, 1e-9);
  EXPECT_EQ(error.undefined_count, 1u);
  EXPECT_EQ(error.measured_count, 3u);
  EXPECT_FALSE(measureError(view, 4, ComponentType::kFloat32, decoded.data(),
                            std::vector<uint32_t>{4}, error)
                   .ok());
}

TEST(Foreign, CacheMissesAndVersions) {
  const std::vector<uint32_t> strip = {0, 1, 2, 2, 1, 3, 2, 3, 4};
  EXPECT_NEAR(averageCacheMissRatio(strip, 5), 5.0 / 3, 1e-6);
  EXPECT_EQ(averageCacheMissRatio({}, 0), 0.0);
  EXPECT_FALSE(dracoVersion().empty());
  EXPECT_FALSE(meshoptVersion().empty());
  EXPECT_FALSE(zstdVersion().empty());
}

}  // namespace
}  // namespace mcc::foreign

#endif  // MCC_HAS_FOREIGN
