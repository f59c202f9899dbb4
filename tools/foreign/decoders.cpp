// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/decoders.h"

#include "foreign/draco_codec.h"
#include "foreign/meshopt_codec.h"

namespace mcc::foreign {
namespace {

gltf::Result toResult(const Outcome& outcome) { return {"", outcome.message}; }

gltf::Result decodeView(const gltf::CodedView& view, std::vector<uint8_t>& elements) {
  return toResult(decodeMeshoptView(view.bytes, view.count, view.stride_bytes, view.mode,
                                    view.filter, elements));
}

gltf::Result decodeMesh(const gltf::CodedMesh& coded, gltf::DecodedMesh& mesh) {
  DracoCounts counts;
  Outcome outcome = readDracoCounts(coded.bytes, counts);
  if (!outcome.ok()) return toResult(outcome);
  if (counts.triangle_count != coded.triangle_count || counts.vertex_count > coded.vertex_count) {
    return {"", "holds " + std::to_string(counts.triangle_count) + " triangles and " +
                    std::to_string(counts.vertex_count) + " vertices, the accessors " +
                    std::to_string(coded.triangle_count) + " and " +
                    std::to_string(coded.vertex_count)};
  }
  DecodedMesh decoded;
  outcome = decodeDraco(coded.bytes, decoded);
  if (!outcome.ok()) return toResult(outcome);
  if (decoded.vertex_count != coded.vertex_count ||
      decoded.triangle_count != coded.triangle_count) {
    return {"", "decodes to " + std::to_string(decoded.vertex_count) +
                    " vertices, the accessors have " + std::to_string(coded.vertex_count)};
  }
  const auto indices = decoded.indexSpan();
  mesh.indices.assign(indices.begin(), indices.end());
  for (const gltf::CodedMesh::Attribute& wanted : coded.attributes) {
    const DecodedAttribute* found = decoded.find(wanted.id);
    const std::string name = "attribute " + std::to_string(wanted.id);
    if (found == nullptr) return {"", "has no " + name};
    if (found->component_type != wanted.component_type ||
        found->component_count != wanted.component_count) {
      return {"", name + " has another type than its accessor"};
    }
    const auto* first = reinterpret_cast<const uint8_t*>(found->values.get());
    mesh.attributes.emplace_back(first, first + decoded.vertex_count * found->elementBytes());
  }
  return {};
}

}  // namespace

gltf::ForeignDecoders foreignDecoders() { return {decodeView, decodeMesh}; }

}  // namespace mcc::foreign
