// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// decode_primitive IN.mcc: decodes a payload, the content of a buffer view, into arrays as a
// graphics card wants them: interleaved vertices and 16 bit indices.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "mcc/reader.h"

struct Vertex {
  float position[3] = {0, 0, 0};
  float normal[3] = {0, 0, 1};  // for payloads without normals
};

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  std::ifstream stream(arguments[1], std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(stream), {}};

  // Open: header, checksum and counts are checked; nothing is decoded yet.
  mcc::Payload payload;
  mcc::Status status = payload.open({reinterpret_cast<const uint8_t*>(file.data()), file.size()});
  if (!status.ok() || payload.info().pieces.empty()) {
    std::fprintf(stderr, "%s\n", status.what);
    return 1;
  }

  // One target per attribute; those that are not needed stay null, and are dropped.
  const mcc::PieceInfo& piece = payload.info().pieces[0];
  std::vector<Vertex> vertices(piece.wedge_count);
  std::vector<mcc::AttributeTarget> attributes(piece.attributes.size());
  for (size_t i = 0; i < attributes.size(); ++i) {
    const mcc::AttributeFormat& format = piece.attributes[i].format;
    if (format.component_type != mcc::ComponentType::kFloat32 || format.morph_target != 0) continue;
    if (format.semantic == mcc::Semantic::kPosition) attributes[i].data = vertices[0].position;
    if (format.semantic == mcc::Semantic::kNormal) attributes[i].data = vertices[0].normal;
    attributes[i].stride_bytes = sizeof(Vertex);
  }

  // A part is the triangle list of one primitive. 16 bits are enough for 65,536 vertices; decode()
  // checks that.
  std::vector<uint16_t> indices(size_t{3} * piece.parts[0].triangle_count);
  std::vector<mcc::PartTarget> parts(piece.parts.size());
  parts[0] = {indices.data(), mcc::IndexType::kUint16};

  // One target per piece; a glTF mesh whose primitives have vertices of their own has several.
  const mcc::PieceTarget target{attributes, parts};
  status = payload.decode({&target, 1});
  if (!status.ok()) {
    std::fprintf(stderr, "%s\n", status.what);
    return 1;
  }
  const Vertex& first = vertices[indices[0]];
  std::printf("%zu vertices, %zu triangles, the first at (%.3f, %.3f, %.3f)\n", vertices.size(),
              indices.size() / 3, first.position[0], first.position[1], first.position[2]);
}
