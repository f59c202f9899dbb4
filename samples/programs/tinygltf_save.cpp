// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// tinygltf_save IN OUT.glb: loads a model, compresses it, saves it.
#include <tiny_gltf.h>

#include <cstdio>

#include "mcc/tinygltf.h"

/// Keeps images as they are in the file; "as_is" makes tinygltf save them unchanged.
bool keepImage(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return 2;
  tinygltf::TinyGLTF io;
  io.SetImageLoader(keepImage, nullptr);
  tinygltf::Model model;
  std::string error;
  std::string warning;
  if (!mcc::tinygltf::load(io, &model, &error, &warning, arguments[1])) {
    std::fprintf(stderr, "%s\n", error.c_str());
    return 1;
  }

  // The one line. Its options are those of gltf-mcc convert.
  const mcc::tinygltf::Result result = mcc::tinygltf::encode(model);
  if (!result.ok()) {
    std::fprintf(stderr, "%s\n", result.message().c_str());
    return 1;
  }

  const bool is_saved = io.WriteGltfSceneToFile(&model, arguments[2], true, true, false, true);
  return is_saved ? 0 : 1;
}
