// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What programs that do not know the extension make of the output.
#include <gtest/gtest.h>

#include "cli/run_tool.h"

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

namespace mcc::test {
namespace {

bool keepImage(tinygltf::Image*, const int, std::string*, std::string*, int, int,
               const unsigned char*, int, void*) {
  return true;
}

bool load(const std::string& path, tinygltf::Model& model, std::string& message) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keepImage, nullptr);
  std::string warning;
  return path.ends_with(".glb") ? loader.LoadBinaryFromFile(&model, &message, &warning, path)
                                : loader.LoadASCIIFromFile(&model, &message, &warning, path);
}

/// Returns the floats of an accessor, as a renderer would use them.
std::vector<float> floatsOf(const tinygltf::Model& model, int index) {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(index));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
  const std::vector<unsigned char>& bytes = model.buffers.at(static_cast<size_t>(view.buffer)).data;
  const auto components =
      static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
  std::vector<float> floats(accessor.count * components);
  const auto stride = static_cast<size_t>(accessor.ByteStride(view));
  for (size_t i = 0; i < accessor.count; ++i) {
    const size_t offset = view.byteOffset + accessor.byteOffset + i * stride;
    std::memcpy(&floats[i * components], &bytes.at(offset), components * sizeof(float));
  }
  return floats;
}

const char* const kSamples[] = {"textured.glb", "skinned.glb", "morphed.glb", "two_materials.glb",
                                "quantized.glb"};

TEST(OtherLoaders, ShowTheFallback) {
#ifndef MCC_TOOL_GLTF_MCC
  GTEST_SKIP() << "the tool is not part of this build";
#endif
  const ScratchFolder folder;
  for (const std::string sample : kSamples) {
    for (const std::string& extension : {std::string(".glb"), std::string(".gltf")}) {
      const std::string out = extension.substr(1) + "_" + sample + extension;
      ASSERT_EQ(runTool(folder, "convert --fallback " + samplePath(sample) + " " + out).status, 0);
      ASSERT_EQ(runTool(folder, "decode " + out + " decoded.glb").status, 0);
      tinygltf::Model model;
      tinygltf::Model decoded;
      std::string message;
      ASSERT_TRUE(load((folder.path() / out).string(), model, message)) << message;
      ASSERT_TRUE(load((folder.path() / "decoded.glb").string(), decoded, message)) << message;
      ASSERT_EQ(model.meshes.size(), decoded.meshes.size());
      size_t compared_count = 0;
      for (size_t m = 0; m < model.meshes.size(); ++m) {
        for (size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
          const tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
          for (const auto& [name, index] : primitive.attributes) {
            const tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(index));
            if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) continue;
            const int other = decoded.meshes[m].primitives[p].attributes.at(name);
            EXPECT_EQ(floatsOf(model, index), floatsOf(decoded, other)) << out << " " << name;
            ++compared_count;
          }
        }
      }
      EXPECT_GT(compared_count + (sample == "quantized.glb" ? 1 : 0), 0u);
    }
  }
}

TEST(OtherLoaders, ValidatorFindsNothing) {
#ifndef MCC_TOOL_GLTF_MCC
  GTEST_SKIP() << "the tool is not part of this build";
#endif
  const std::string modules =
      std::string(MCC_SOURCE_DIR) + "/tests/web/node_modules/gltf-validator";
  if (!std::filesystem::exists(modules)) {
    GTEST_SKIP() << "no gltf-validator in tests/web/node_modules (npm ci)";
  }
  const ScratchFolder folder;
  std::string files;
  for (const std::string sample : kSamples) {
    for (const std::string& options : {std::string(), std::string("--fallback ")}) {
      for (const std::string& extension : {std::string(".glb"), std::string(".gltf")}) {
        const std::string name = (options.empty() ? "plain_" : "fallback_") + extension.substr(1) +
                                 "_" + sample + extension;
        ASSERT_EQ(runTool(folder, "convert " + options + samplePath(sample) + " " + name).status,
                  0);
        files += " " + name;
      }
    }
  }
  const ToolResult result =
      runCommand(folder, "node '" + std::string(MCC_SOURCE_DIR) +
                             "/tests/cli/validate_files.mjs' '" + modules + "'" + files);
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_NE(result.out.find("fallback_gltf_skinned.glb.gltf: 2 of 2 resources"), std::string::npos)
      << result.out;
}

}  // namespace
}  // namespace mcc::test
