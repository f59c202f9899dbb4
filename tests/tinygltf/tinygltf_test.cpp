// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compares the adapter for tinygltf with the functions that work on files, with the system's
// tinygltf.
#include <gtest/gtest.h>
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "mcc/files.h"
#include "mcc/tinygltf.h"
#include "support/scratch_folder.h"

namespace mcc::test {
namespace {

using ::tinygltf::Model;
using Bytes = std::vector<uint8_t>;

bool keepImage(::tinygltf::Image* image, const int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

::tinygltf::TinyGLTF makeLoader() {
  ::tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keepImage, nullptr);
  return loader;
}

Bytes readFile(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeFile(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

/// Returns what tinygltf itself makes of a file.
Model loadPlain(const Bytes& glb) {
  ::tinygltf::TinyGLTF loader = makeLoader();
  Model model;
  std::string error;
  std::string warning;
  EXPECT_TRUE(loader.LoadBinaryFromMemory(&model, &error, &warning, glb.data(),
                                          static_cast<unsigned>(glb.size())))
      << error;
  return model;
}

/// A compressed file, not decoded.
Model loadCompressed(const Bytes& glb) {
  ::tinygltf::TinyGLTF loader = makeLoader();
  Model model;
  std::string error;
  std::string warning;
  EXPECT_TRUE(tinygltf::detail::loadCompressed(loader, model, &error, &warning,
                                               std::string(glb.begin(), glb.end())))
      << error;
  return model;
}

Bytes convertGlb(const Bytes& glb, const gltf::ConvertOptions& options) {
  Bytes output;
  gltf::ConvertReport report;
  const gltf::Result result = gltf::convertGlb(glb, options, output, report);
  EXPECT_TRUE(result.ok()) << result.message();
  return output;
}

/// Returns the elements of an accessor, one after the other.
Bytes elementsOf(const Model& model, int index) {
  const ::tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(index));
  if (accessor.bufferView < 0) return {};
  const ::tinygltf::BufferView& view =
      model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
  const Bytes& data = model.buffers.at(static_cast<size_t>(view.buffer)).data;
  const auto stride = static_cast<size_t>(accessor.ByteStride(view));
  const auto element = static_cast<size_t>(
      ::tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)) *
      ::tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
  Bytes elements;
  for (size_t i = 0; i < accessor.count; ++i) {
    const size_t offset = view.byteOffset + accessor.byteOffset + i * stride;
    EXPECT_LE(offset + element, view.byteOffset + view.byteLength);
    const auto begin = data.begin() + static_cast<ptrdiff_t>(offset);
    elements.insert(elements.end(), begin, begin + static_cast<ptrdiff_t>(element));
  }
  return elements;
}

void expectSameAccessor(const Model& a, int index_a, const Model& b, int index_b,
                        const std::string& what) {
  const ::tinygltf::Accessor& accessor_a = a.accessors.at(static_cast<size_t>(index_a));
  const ::tinygltf::Accessor& accessor_b = b.accessors.at(static_cast<size_t>(index_b));
  EXPECT_EQ(accessor_a.count, accessor_b.count) << what;
  EXPECT_EQ(accessor_a.componentType, accessor_b.componentType) << what;
  EXPECT_EQ(accessor_a.minValues, accessor_b.minValues) << what;
  EXPECT_EQ(accessor_a.maxValues, accessor_b.maxValues) << what;
  EXPECT_EQ(elementsOf(a, index_a), elementsOf(b, index_b)) << what;
}

void expectSameMaps(const Model& a, const std::map<std::string, int>& map_a, const Model& b,
                    const std::map<std::string, int>& map_b, const std::string& what) {
  ASSERT_EQ(map_a.size(), map_b.size()) << what;
  for (const auto& [name, index] : map_a) {
    ASSERT_EQ(map_b.count(name), 1u) << what << name;
    expectSameAccessor(a, index, b, map_b.at(name), what + name);
  }
}

/// Geometry, images and lists of extensions.
void expectSameModel(const Model& a, const Model& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (size_t m = 0; m < a.meshes.size(); ++m) {
    ASSERT_EQ(a.meshes[m].primitives.size(), b.meshes[m].primitives.size());
    for (size_t p = 0; p < a.meshes[m].primitives.size(); ++p) {
      const ::tinygltf::Primitive& from_a = a.meshes[m].primitives[p];
      const ::tinygltf::Primitive& from_b = b.meshes[m].primitives[p];
      const std::string what = std::to_string(m) + "/" + std::to_string(p) + " ";
      EXPECT_EQ(from_a.mode, from_b.mode);
      EXPECT_EQ(from_a.extensions, from_b.extensions) << what;
      expectSameMaps(a, from_a.attributes, b, from_b.attributes, what);
      if (from_a.indices >= 0) {
        expectSameAccessor(a, from_a.indices, b, from_b.indices, what + "indices");
      }
      ASSERT_EQ(from_a.targets.size(), from_b.targets.size());
      for (size_t t = 0; t < from_a.targets.size(); ++t) {
        expectSameMaps(a, from_a.targets[t], b, from_b.targets[t], what + "target ");
      }
    }
  }
  ASSERT_EQ(a.images.size(), b.images.size());
  for (size_t i = 0; i < a.images.size(); ++i) EXPECT_EQ(a.images[i].image, b.images[i].image);
  EXPECT_EQ(a.extensionsUsed, b.extensionsUsed);
  EXPECT_EQ(a.extensionsRequired, b.extensionsRequired);
  ASSERT_EQ(a.animations.size(), b.animations.size());
  for (size_t i = 0; i < a.animations.size(); ++i) {
    for (size_t s = 0; s < a.animations[i].samplers.size(); ++s) {
      EXPECT_EQ(elementsOf(a, a.animations[i].samplers[s].output),
                elementsOf(b, b.animations[i].samplers[s].output));
    }
  }
}

/// The payloads of a compressed model.
std::set<Bytes> payloadsOf(const Model& model) {
  std::set<Bytes> payloads;
  for (const ::tinygltf::Mesh& mesh : model.meshes) {
    for (const ::tinygltf::Primitive& primitive : mesh.primitives) {
      const auto found = primitive.extensions.find(tinygltf::kExtension);
      if (found == primitive.extensions.end()) continue;
      const int number = found->second.Get("bufferView").GetNumberAsInt();
      const ::tinygltf::BufferView& view = model.bufferViews.at(static_cast<size_t>(number));
      const Bytes& data = model.buffers.at(static_cast<size_t>(view.buffer)).data;
      const auto begin = data.begin() + static_cast<ptrdiff_t>(view.byteOffset);
      payloads.emplace(begin, begin + static_cast<ptrdiff_t>(view.byteLength));
    }
  }
  return payloads;
}

/// Compares every way through the adapter with the functions for files.
void compareWithFiles(const Bytes& source, const gltf::ConvertOptions& options) {
  const Bytes coded = convertGlb(source, options);
  Bytes decoded;
  gltf::DecodeReport report;
  ASSERT_TRUE(gltf::decodeGlb(coded, decoded, report).ok());
  const Model expected = loadPlain(decoded);
  Model model = loadCompressed(coded);
  ASSERT_TRUE(tinygltf::decode(model).ok());
  expectSameModel(expected, model);
  Model parallel = loadCompressed(coded);
  tinygltf::DecodeOptions threads;
  threads.thread_count = 4;
  ASSERT_TRUE(tinygltf::decode(parallel, threads).ok());
  EXPECT_TRUE(parallel == model);

  Model encoded = loadPlain(source);
  ASSERT_TRUE(tinygltf::encode(encoded, options).ok());
  EXPECT_EQ(payloadsOf(encoded), payloadsOf(loadCompressed(coded)));
  ASSERT_TRUE(tinygltf::decode(encoded).ok());
  expectSameModel(expected, encoded);
}

const char* const kSamples[] = {"textured.glb",        "skinned.glb",      "morphed.glb",
                                "two_materials.glb",   "quantized.glb",    "modes.glb",
                                "shared_vertices.glb", "non_manifold.glb", "genus3.glb"};

TEST(TinyGltf, AgreesWithFilesOnSamples) {
  for (const char* sample : kSamples) {
    SCOPED_TRACE(sample);
    const Bytes source = readFile(std::filesystem::path(MCC_SAMPLES_DIR) / sample);
    gltf::ConvertOptions options;
    compareWithFiles(source, options);
    options.lossless = true;
    options.grid = gltf::Grid::kPrimitive;
    compareWithFiles(source, options);
    options.indices_only = true;
    compareWithFiles(source, options);
  }
}

TEST(TinyGltf, AgreesWithFilesOnCorpusLarge) {
  const std::filesystem::path folder = MCC_CORPUS_DIR;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no corpus";
  constexpr uintmax_t kMostBytes = 3000000;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".glb" || entry.file_size() > kMostBytes) continue;
    SCOPED_TRACE(entry.path().filename().string());
    compareWithFiles(readFile(entry.path()), {});
  }
}

TEST(TinyGltf, ReadsBothKindsOfFiles) {
  const ScratchFolder folder;
  const Bytes source = readFile(std::filesystem::path(MCC_SAMPLES_DIR) / "textured.glb");
  writeFile(folder.path() / "in.glb", source);
  gltf::ConvertReport report;
  Bytes decoded;
  gltf::DecodeReport decode_report;
  ASSERT_TRUE(gltf::decodeGlb(convertGlb(source, {}), decoded, decode_report).ok());
  for (const char* name : {"out.glb", "out.gltf"}) {
    const std::filesystem::path path = folder.path() / name;
    ASSERT_TRUE(gltf::convertFile(folder.path() / "in.glb", path, {}, report).ok());
    ::tinygltf::TinyGLTF loader = makeLoader();
    Model model;
    std::string error;
    ASSERT_TRUE(tinygltf::load(loader, &model, &error, nullptr, path.string())) << error;
    expectSameModel(loadPlain(decoded), model);
    // What was decoded is an ordinary model for tinygltf.
    const std::filesystem::path again = folder.path() / "again.glb";
    loader.SetImageWriter(nullptr, nullptr);
    ASSERT_TRUE(loader.WriteGltfSceneToFile(&model, again.string(), false, true, false, true));
    expectSameModel(loadPlain(readFile(again)), model);
  }
  ::tinygltf::TinyGLTF loader;
  Model model;
  std::string error;
  EXPECT_FALSE(tinygltf::load(loader, &model, &error, nullptr, (folder.path() / "none").string()));
  EXPECT_NE(error.find("none: there is no such file"), std::string::npos);
}

TEST(TinyGltf, DecodesFilesWithAFallback) {
  const ScratchFolder folder;
  const std::filesystem::path sample = std::filesystem::path(MCC_SAMPLES_DIR) / "skinned.glb";
  gltf::ConvertOptions options;
  options.fallback = true;
  gltf::ConvertReport report;
  ASSERT_TRUE(gltf::convertFile(sample, folder.path() / "out.gltf", options, report).ok());
  ::tinygltf::TinyGLTF loader = makeLoader();
  Model fallback;
  std::string error;
  std::string warning;
  ASSERT_TRUE(
      loader.LoadASCIIFromFile(&fallback, &error, &warning, (folder.path() / "out.gltf").string()))
      << error;
  Model model = fallback;
  ASSERT_TRUE(tinygltf::decode(model).ok());
  EXPECT_FALSE(model == fallback);
  fallback.extensionsUsed = fallback.extensionsRequired = {};
  for (::tinygltf::Mesh& mesh : fallback.meshes) {
    for (::tinygltf::Primitive& primitive : mesh.primitives) primitive.extensions = {};
  }
  expectSameModel(fallback, model);
}

/// Files are saved with the model's own writer, and what tinygltf cannot tell apart is not lost
/// either.
TEST(TinyGltf, SavesWhatItEncoded) {
  const ScratchFolder folder;
  const Bytes source = readFile(std::filesystem::path(MCC_SAMPLES_DIR) / "textured.glb");
  Model model = loadPlain(source);
  ::tinygltf::Buffer extra;  // programs may have several
  extra.data = {1, 2, 3, 4};
  model.buffers.push_back(extra);
  gltf::ConvertReport report;
  ASSERT_TRUE(tinygltf::encode(model, {}, report).ok());
  EXPECT_FALSE(report.copied);
  EXPECT_EQ(model.buffers.size(), 1u);
  ::tinygltf::TinyGLTF writer;
  writer.SetImageWriter(nullptr, nullptr);
  const std::filesystem::path path = folder.path() / "out.glb";
  ASSERT_TRUE(writer.WriteGltfSceneToFile(&model, path.string(), false, true, false, true));
  EXPECT_LT(std::filesystem::file_size(path), source.size() / 2);
  Bytes decoded;
  gltf::DecodeReport decode_report;
  ASSERT_TRUE(gltf::decodeGlb(readFile(path), decoded, decode_report).ok());
  EXPECT_EQ(decode_report.payload_count, 1u);
}

/// A payload that already exists stays as it is; only its buffer view gets another number.
TEST(TinyGltf, EncodesAPartOfAModel) {
  const Bytes source = readFile(std::filesystem::path(MCC_SAMPLES_DIR) / "two_materials.glb");
  const Model coded = loadCompressed(convertGlb(source, {}));
  Model model = loadPlain(source);
  // A second, uncompressed mesh after the compressed one.
  Model both = coded;
  const auto view_count = static_cast<int>(both.bufferViews.size());
  const auto accessor_count = static_cast<int>(both.accessors.size());
  for (::tinygltf::BufferView view : model.bufferViews) {
    view.buffer = 1;
    both.bufferViews.push_back(view);
  }
  both.buffers.push_back(model.buffers[0]);
  for (::tinygltf::Accessor accessor : model.accessors) {
    accessor.bufferView += view_count;
    both.accessors.push_back(accessor);
  }
  both.meshes.push_back(model.meshes[0]);
  for (::tinygltf::Primitive& primitive : both.meshes[1].primitives) {
    primitive.indices += accessor_count;
    for (auto& [name, index] : primitive.attributes) index += accessor_count;
  }
  ASSERT_TRUE(tinygltf::encode(both).ok());
  EXPECT_EQ(payloadsOf(both), payloadsOf(coded));
  ASSERT_TRUE(tinygltf::decode(both).ok());
  const Model expected = [&] {
    Model decoded = coded;
    EXPECT_TRUE(tinygltf::decode(decoded).ok());
    return decoded;
  }();
  both.meshes.erase(both.meshes.begin() + 1);
  expectSameModel(expected, both);
}

TEST(TinyGltf, LeavesModelsWithoutTheExtensionAlone) {
  const Bytes source = readFile(std::filesystem::path(MCC_SAMPLES_DIR) / "torus.glb");
  const Model expected = loadPlain(source);
  Model model = expected;
  ASSERT_TRUE(tinygltf::decode(model).ok());
  EXPECT_TRUE(model == expected);
}

TEST(TinyGltf, RefusesWhatContradictsItself) {
  const Bytes source = readFile(std::filesystem::path(MCC_SAMPLES_DIR) / "two_materials.glb");
  const Model good = loadCompressed(convertGlb(source, {}));
  const auto refused = [&](const char* words, const auto& damage) {
    Model model = good;
    damage(model, model.meshes[0].primitives[1]);
    const Model before = model;
    const tinygltf::Result result = tinygltf::decode(model);
    EXPECT_NE(result.what.find(words), std::string::npos) << words << ": " << result.what;
    EXPECT_TRUE(model == before) << words;
  };
  const auto set = [](::tinygltf::Primitive& primitive, const char* key, ::tinygltf::Value value) {
    primitive.extensions[tinygltf::kExtension].Get<::tinygltf::Value::Object>()[key] =
        std::move(value);
  };
  using ::tinygltf::Value;
  refused("there is no bufferView 1000",
          [&](Model&, auto& p) { set(p, "bufferView", Value(1000)); });
  refused("must be a whole number", [&](Model&, auto& p) { set(p, "bufferView", Value(-1)); });
  refused("must be a whole number",
          [&](Model&, auto& p) { set(p, "piece", Value(std::string("1"))); });
  refused("there is no piece 7", [&](Model&, auto& p) { set(p, "piece", Value(7)); });
  refused("there is no part 7", [&](Model&, auto& p) { set(p, "part", Value(7)); });
  refused("must be an object", [&](Model&, auto& p) { set(p, "attributes", Value(7)); });
  refused("must be an array", [&](Model&, auto& p) { set(p, "targets", Value(7)); });
  refused("must be 4", [](Model&, auto& p) { p.mode = TINYGLTF_MODE_POINTS; });
  refused("\"indices\" is missing", [](Model&, auto& p) { p.indices = -1; });
  refused("no attribute of this name", [](Model&, auto& p) { p.attributes.erase("NORMAL"); });
  refused("does not match the payload",
          [](Model& m, auto& p) { ++m.accessors[size_t(p.indices)].count; });
  refused("cannot hold indices", [](Model& m, auto& p) {
    m.accessors[size_t(p.indices)].componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
  });
  refused("its type is VEC4", [](Model& m, auto& p) {
    m.accessors[size_t(p.attributes.at("NORMAL"))].type = TINYGLTF_TYPE_VEC4;
  });
  refused("the type is unknown",
          [](Model& m, auto& p) { m.accessors[size_t(p.attributes.at("NORMAL"))].type = 77; });
  refused("two different places",
          [](Model&, auto& p) { p.attributes["NORMAL"] = p.attributes["POSITION"]; });
  refused("are outside buffer 0", [](Model& m, auto&) { m.buffers[0].data.resize(100); });
  refused("has no buffer", [](Model& m, auto&) {
    for (auto& view : m.bufferViews) view.buffer = 5;
  });
  refused("checksum", [](Model& m, auto&) { m.buffers[0].data[40] ^= 1; });
  const auto set_meshopt = [](Model& m, auto&) {
    m.bufferViews[0].extensions["EXT_meshopt_compression"] = Value(Value::Object());
  };
  refused("tinygltf would lose", set_meshopt);
}

TEST(TinyGltf, DecodedBytesAreLimitedForTheWholeModel) {
  const Model coded = loadCompressed(
      convertGlb(readFile(std::filesystem::path(MCC_SAMPLES_DIR) / "torus.glb"), {}));
  constexpr uint64_t kDecodedBytes = 98304;
  tinygltf::DecodeOptions options;
  options.max_decoded_bytes = kDecodedBytes - 1;
  Model model = coded;
  const std::string what = tinygltf::decode(model, options).what;
  EXPECT_NE(what.find("ask for 98304 bytes of decoded geometry; the limit is 98303, which "
                      "max_decoded_bytes (--max-decoded-bytes) raises"),
            std::string::npos)
      << what;
  EXPECT_TRUE(model == coded);
  options.max_decoded_bytes = kDecodedBytes;
  EXPECT_TRUE(tinygltf::decode(model, options).ok());
}

/// A model of n meshes. Each has accessors of its own, and the payload in buffer view viewOf(i), of
/// which there are `payload_count` with the same content.
Model multiplied(const Model& coded, int n, size_t payload_count,
                 const std::function<size_t(size_t)>& viewOf) {
  Model model = coded;
  const ::tinygltf::Mesh mesh = coded.meshes[0];
  auto payload = static_cast<size_t>(
      mesh.primitives[0].extensions.at(tinygltf::kExtension).Get("bufferView").GetNumberAsInt());
  const ::tinygltf::BufferView view = coded.bufferViews[payload];
  const auto begin = coded.buffers[0].data.begin() + static_cast<ptrdiff_t>(view.byteOffset);
  const Bytes bytes(begin, begin + static_cast<ptrdiff_t>(view.byteLength));
  model.buffers[0].data.clear();
  model.bufferViews.clear();
  model.accessors.clear();
  model.meshes.clear();
  for (size_t i = 0; i < payload_count; ++i) {
    auto& data = model.buffers[0].data;
    data.resize((data.size() + 3) & ~size_t{3});
    model.bufferViews.push_back(view);
    model.bufferViews.back().byteOffset = data.size();
    data.insert(data.end(), bytes.begin(), bytes.end());
  }
  for (int i = 0; i < n; ++i) {
    const auto offset = static_cast<int>(model.accessors.size());
    model.accessors.insert(model.accessors.end(), coded.accessors.begin(), coded.accessors.end());
    ::tinygltf::Primitive primitive = mesh.primitives[0];
    primitive.indices += offset;
    for (auto& [name, index] : primitive.attributes) index += offset;
    auto& extension = primitive.extensions[tinygltf::kExtension].Get<::tinygltf::Value::Object>();
    extension["bufferView"] = ::tinygltf::Value(static_cast<int>(viewOf(static_cast<size_t>(i))));
    model.meshes.emplace_back();
    model.meshes.back().primitives.push_back(primitive);
  }
  return model;
}

Model codedTorus() {
  return loadCompressed(
      convertGlb(readFile(std::filesystem::path(MCC_SAMPLES_DIR) / "torus.glb"), {}));
}

TEST(TinyGltf, APayloadIsDecodedOnceWhoeverNamesItsBytes) {
  Model one = codedTorus();
  Model model = multiplied(one, 100, 1, [](size_t i) { return i % 2; });
  model.bufferViews.push_back(model.bufferViews[0]);
  ASSERT_EQ(tinygltf::decode(one).what, "");
  ASSERT_EQ(tinygltf::decode(model).what, "");
  EXPECT_EQ(model.buffers[0].data, one.buffers[0].data);
  for (size_t i = 0; i < model.accessors.size(); ++i) {
    const auto& view = model.bufferViews[static_cast<size_t>(model.accessors[i].bufferView)];
    const auto& expected =
        one.bufferViews[static_cast<size_t>(one.accessors[i % one.accessors.size()].bufferView)];
    EXPECT_EQ(view.byteOffset, expected.byteOffset);
    EXPECT_EQ(view.byteLength, expected.byteLength);
    const bool is_attribute = view.target == TINYGLTF_TARGET_ARRAY_BUFFER;
    EXPECT_EQ(view.byteStride != 0, is_attribute) << "glTF wants it of views that are shared";
  }
}

/// A triangle, compressed.
Model codedTriangle() {
  Model model;
  model.asset.version = "2.0";
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const uint16_t indices[] = {0, 1, 2, 0};
  model.buffers.emplace_back();
  auto& data = model.buffers[0].data;
  data.resize(sizeof(positions) + sizeof(indices));
  std::memcpy(data.data(), positions, sizeof(positions));
  std::memcpy(data.data() + sizeof(positions), indices, sizeof(indices));
  for (int i = 0; i < 2; ++i) {
    ::tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = i == 0 ? 0 : sizeof(positions);
    view.byteLength = i == 0 ? sizeof(positions) : sizeof(indices);
    model.bufferViews.push_back(view);
    ::tinygltf::Accessor accessor;
    accessor.bufferView = i;
    accessor.componentType =
        i == 0 ? TINYGLTF_COMPONENT_TYPE_FLOAT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    accessor.type = i == 0 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR;
    accessor.count = 3;
    if (i == 0) accessor.minValues = {0, 0, 0};
    if (i == 0) accessor.maxValues = {1, 1, 0};
    model.accessors.push_back(accessor);
  }
  ::tinygltf::Primitive primitive;
  primitive.attributes["POSITION"] = 0;
  primitive.indices = 1;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  model.meshes.emplace_back();
  model.meshes[0].primitives.push_back(primitive);
  gltf::ConvertOptions options;
  options.allow_larger = true;
  EXPECT_EQ(tinygltf::encode(model, options).what, "");
  return model;
}

/// Work proportional to the square of the number would take minutes.
TEST(TinyGltf, ManyPayloads) {
  constexpr int kCount = 20000;
  Model one = codedTriangle();
  Model model = multiplied(one, kCount, kCount, [](size_t i) { return i; });
  ASSERT_EQ(tinygltf::decode(one).what, "");
  ASSERT_EQ(tinygltf::decode(model).what, "");
  const size_t each = one.buffers[0].data.size();
  EXPECT_EQ(model.buffers[0].data.size(), (kCount - 1) * ((each + 3) & ~size_t{3}) + each);
}

}  // namespace
}  // namespace mcc::test
