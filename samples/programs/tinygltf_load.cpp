// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// tinygltf_load IN: loads a .glb or .gltf, compressed or not, and says what is in it.
#include <tiny_gltf.h>

#include <cstdio>

#include "mcc/tinygltf.h"

/// Programs that show images leave this out; tinygltf then decodes them.
bool skipImage(tinygltf::Image*, const int, std::string*, std::string*, int, int,
               const unsigned char*, int, void*) {
  return true;
}

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(skipImage, nullptr);
  tinygltf::Model model;
  std::string error;
  std::string warning;

  // The one line: it was loader.LoadBinaryFromFile(&model, &error, &warning, arguments[1]).
  if (!mcc::tinygltf::load(loader, &model, &error, &warning, arguments[1])) {
    std::fprintf(stderr, "%s\n", error.c_str());
    return 1;
  }

  size_t vertex_count = 0;
  size_t triangle_count = 0;
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      vertex_count += model.accessors[primitive.attributes.at("POSITION")].count;
      if (primitive.indices >= 0) triangle_count += model.accessors[primitive.indices].count / 3;
    }
  }
  std::printf("%zu meshes, %zu vertices, %zu triangles\n", model.meshes.size(), vertex_count,
              triangle_count);
}
