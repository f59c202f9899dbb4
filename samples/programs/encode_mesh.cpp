// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// encode_mesh OUT.mcc: compresses a torus from arrays and writes the payload to a file.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

#include "mcc/simple.h"

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;

  // A torus of 64 * 32 vertices, as a program has it: floats and indices.
  constexpr uint32_t kAround = 64;
  constexpr uint32_t kAcross = 32;
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < kAround; ++i) {
    for (uint32_t k = 0; k < kAcross; ++k) {
      const float u = 6.2831853f * static_cast<float>(i) / kAround;
      const float v = 6.2831853f * static_cast<float>(k) / kAcross;
      const float radius = 2 + std::cos(v);
      positions.insert(positions.end(), {radius * std::cos(u), radius * std::sin(u), std::sin(v)});
      const uint32_t a = i * kAcross + k;
      const uint32_t b = i * kAcross + (k + 1) % kAcross;
      const uint32_t c = (a + kAcross) % (kAround * kAcross);
      const uint32_t d = (b + kAcross) % (kAround * kAcross);
      indices.insert(indices.end(), {a, c, b, b, c, d});
    }
  }

  mcc::simple::Mesh mesh;
  mesh.add("POSITION", positions);  // three floats are the default
  mesh.primitives = {indices};

  std::vector<uint8_t> payload;
  const mcc::Status status = mcc::simple::encode(mesh, payload);
  if (!status.ok()) {
    std::fprintf(stderr, "%s\n", status.what);
    return 1;
  }
  std::ofstream(arguments[1], std::ios::binary)
      .write(reinterpret_cast<const char*>(payload.data()),
             static_cast<std::streamsize>(payload.size()));
  std::printf("%zu triangles in %zu bytes\n", indices.size() / 3, payload.size());
}
