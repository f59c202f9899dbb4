// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// decode_arrays IN.mcc: decodes a payload, the content of a buffer view, into arrays in one call.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "mcc/simple.h"

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  std::ifstream stream(arguments[1], std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(stream), {}};

  std::vector<mcc::simple::Mesh> meshes;
  const mcc::Status status =
      mcc::simple::decode({reinterpret_cast<const uint8_t*>(file.data()), file.size()}, meshes);
  if (!status.ok()) {
    std::fprintf(stderr, "%s\n", status.what);
    return 1;
  }
  for (const mcc::simple::Mesh& mesh : meshes) {
    for (const std::vector<uint32_t>& indices : mesh.primitives) {
      std::printf("%u vertices, %zu triangles", mesh.vertex_count, indices.size() / 3);
    }
    if (const mcc::simple::Attribute* position = mesh.find("POSITION")) {
      const std::span<const float> values = position->floats();
      if (!values.empty())
        std::printf(", the first at (%.3f, %.3f, %.3f)", values[0], values[1], values[2]);
    }
    std::printf("\n");
  }
}
