// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/tinygltf_loader.h"

#if __has_include(<tiny_gltf.h>) && __has_include(<nlohmann/json.hpp>)

// A namespace of its own: programs may link another tinygltf, without Draco.
#define tinygltf tinygltf_with_draco
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_ENABLE_DRACO
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

#include <chrono>
#include <ctime>

#include "mcc/glb.h"

namespace mcc::foreign {
namespace {

using Clock = std::chrono::steady_clock;

double cpuSeconds() {
  std::timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool keepImage(::tinygltf::Image* image, const int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

}  // namespace

Outcome loadWithTinygltf(std::span<const uint8_t> glb, uint32_t thread_count, TinygltfLoad& load) {
  ::tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keepImage, nullptr);
  ::tinygltf::Model model;
  std::string error;
  std::string warning;
  const double begin = cpuSeconds();
  // What loadFromMemory() does, with the time of its first half.
  const Clock::time_point start = Clock::now();
  std::vector<uint8_t> plain;
  gltf::DecodeReport report;
  gltf::DecodeOptions options;
  options.thread_count = thread_count;
  const gltf::Result result = gltf::decodeGlb(glb, plain, report, options);
  if (!result.ok()) return {result.message()};
  load.decode_seconds = secondsSince(start);
  if (!loader.LoadBinaryFromMemory(&model, &error, &warning, plain.data(),
                                   static_cast<unsigned>(plain.size()))) {
    return {error};
  }
  load.cpu_seconds = cpuSeconds() - begin;
  load.vertex_count = 0;
  for (const ::tinygltf::Mesh& mesh : model.meshes) {
    for (const ::tinygltf::Primitive& primitive : mesh.primitives) {
      const auto position = primitive.attributes.find("POSITION");
      if (position == primitive.attributes.end()) continue;
      load.vertex_count += model.accessors[static_cast<size_t>(position->second)].count;
    }
  }
  return {};
}

}  // namespace mcc::foreign

#else

namespace mcc::foreign {

Outcome loadWithTinygltf(std::span<const uint8_t>, uint32_t, TinygltfLoad&) {
  return {"this build has no tinygltf"};
}

}  // namespace mcc::foreign

#endif
