// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "robustness/payloads.h"

#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "mcc/writer.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "support/mirrored.h"
#include "support/repeated.h"

namespace mcc::test {
namespace {

class PayloadList {
 public:
  void add(const std::string& name, std::span<const PieceView> pieces,
           const EncodeSettings& options = {}) {
    EncodeResult result;
    const Status status = encodeWith(pieces, options, result);
    if (!status.ok()) throw std::runtime_error(name + ": " + status.what);
    payloads_.push_back({name, std::move(result.payload)});
  }
  void add(const TestMesh& mesh, const MeshBits& bits = {}, const EncodeSettings& options = {}) {
    const MeshPiece piece(mesh, bits);
    const PieceView view = piece.view();
    add(mesh.name, {&view, 1}, options);
  }
  std::vector<NamedPayload> take() { return std::move(payloads_); }

 private:
  std::vector<NamedPayload> payloads_;
};

EncodeOptions keepingOrders(bool vertices, bool triangles) {
  EncodeOptions options;
  options.keep_vertex_order = vertices;
  options.keep_triangle_order = triangles;
  return options;
}

/// Deals triangles out to `count` parts in turn, and adds an empty part after them.
void addParts(PayloadList& list, const TestMesh& mesh, uint32_t count,
              const EncodeOptions& options = {}) {
  std::vector<std::vector<uint32_t>> indices(count + 1);
  for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
    std::vector<uint32_t>& part = indices[t / 3 % count];
    part.insert(part.end(), mesh.indices.begin() + 3 * t, mesh.indices.begin() + 3 * t + 3);
  }
  std::vector<PartView> parts;
  for (const std::vector<uint32_t>& part : indices) parts.push_back({part});
  MeshPiece piece(mesh);
  piece.setParts(std::move(parts));
  const PieceView view = piece.view();
  list.add("parts of " + mesh.name, {&view, 1}, options);
}

void addIndicesOnly(PayloadList& list, const TestMesh& mesh) {
  const MeshPiece piece(mesh, kExactBits);
  PieceView view = piece.view();
  view.attributes = view.attributes.first(1);
  EncodeOptions options = keepingOrders(true, false);
  options.indices_only = true;
  list.add("indices of " + mesh.name, {&view, 1}, options);
}

void addPieces(PayloadList& list) {
  const TestMesh meshes[] = {torus(6, 5), torus(5, 4), withUnused(torus(4, 3), 3, 4),
                             uvSphere(6, 4), sheetWithHoles(2, 7)};
  std::vector<std::unique_ptr<MeshPiece>> pieces;
  std::vector<PieceView> views;
  for (const TestMesh& mesh : meshes) {
    pieces.push_back(std::make_unique<MeshPiece>(mesh));
    views.push_back(pieces.back()->view());
  }
  list.add("five pieces", views);
}

/// One attribute of each component type and count that matters, filled with a little of everything.
void addAttributes(PayloadList& list, const TestMesh& mesh) {
  MeshPiece piece(mesh, {16, 12, 0});
  std::vector<std::vector<uint8_t>> memory;
  uint8_t set = 1;
  const auto attribute = [&](Semantic semantic, ComponentType type, uint8_t components,
                             uint16_t morph_target, uint8_t bits) {
    AttributeFormat format;
    format.semantic = semantic;
    format.set_index = set++;
    format.component_type = type;
    format.component_count = components;
    format.normalized = type == ComponentType::kUint8;
    format.morph_target = morph_target;
    const uint32_t bytes = componentBytes(type);
    memory.emplace_back(size_t{mesh.vertexCount()} * elementBytes(format));
    for (size_t i = 0; i < memory.back().size() / bytes; ++i) {
      const float x = mesh.positions[i % mesh.positions.size()];
      if (type == ComponentType::kFloat32) {
        std::memcpy(&memory.back()[4 * i], &x, 4);
      } else {
        const int32_t value = static_cast<int32_t>(x * 100);
        std::memcpy(&memory.back()[bytes * i], &value, bytes);
      }
    }
    piece.add(format, memory.back().data(), bits);
  };
  memory.reserve(16);
  attribute(Semantic::kJoints, ComponentType::kUint8, 4, 0, 0);
  attribute(Semantic::kWeights, ComponentType::kFloat32, 4, 0, 10);
  attribute(Semantic::kColor, ComponentType::kUint8, 4, 0, 0);
  attribute(Semantic::kTangent, ComponentType::kFloat32, 4, 0, 10);
  attribute(Semantic::kTexcoord, ComponentType::kUint16, 2, 0, 0);
  attribute(Semantic::kCustom, ComponentType::kInt8, 1, 0, 0);
  attribute(Semantic::kCustom, ComponentType::kInt16, 3, 0, 0);
  attribute(Semantic::kCustom, ComponentType::kUint32, 16, 0, 0);
  attribute(Semantic::kPosition, ComponentType::kFloat32, 3, 1, 12);
  attribute(Semantic::kNormal, ComponentType::kFloat32, 3, 1, 8);
  const PieceView view = piece.view();
  list.add("attributes on " + mesh.name, {&view, 1});
}

/// Everything is exact: grids with and without tails, computed normals, tangents, and values that
/// fit nothing.
void addExact(PayloadList& list, const TestMesh& mesh) {
  MeshPiece piece(mesh, kExactBits);
  std::vector<std::vector<float>> memory;
  memory.reserve(8);
  const auto attribute = [&](Semantic semantic, uint8_t components, uint16_t target, float scale) {
    memory.emplace_back();
    for (uint32_t i = 0; i < mesh.vertexCount() * components; ++i) {
      const float x = mesh.positions[i % mesh.positions.size()] * scale;
      memory.back().push_back(i % 40 == 3 ? -0.0f : x);
    }
    AttributeFormat format;
    format.semantic = semantic;
    format.component_count = components;
    format.morph_target = target;
    format.set_index = semantic == Semantic::kTexcoord ? 1 : 0;
    piece.add(format, memory.back().data());
  };
  attribute(Semantic::kTangent, 4, 0, 1);
  attribute(Semantic::kTexcoord, 2, 0, 0.371f);
  attribute(Semantic::kColor, 4, 0, 1e37f);
  attribute(Semantic::kWeights, 4, 0, 3e38f);
  attribute(Semantic::kNormal, 3, 1, 0.01f);
  const PieceView view = piece.view();
  list.add("exact attributes on " + mesh.name, {&view, 1});
}

void addAnchors(PayloadList& list) {
  const TestMesh part = jittered(torus(7, 5), 1, 0.05f);
  list.add(repeated(part, 4, 3));
  for (uint64_t variation = 1; variation <= 4; ++variation) {
    EncodeSettings settings;
    settings.variation = variation;
    list.add(repeated(withNormals(part), 5, static_cast<Turn>(variation)), {14, 6, 0}, settings);
  }
}

void addMirrors(PayloadList& list) {
  list.add(mirrored(halfSheet(7, 5, 1), 0));
  list.add(withNoise(mirrored(mirrored(halfSheet(6, 5, 2), 0), 1), 14));
  for (uint64_t variation = 1; variation <= 6; ++variation) {
    EncodeSettings settings;
    settings.variation = variation;
    list.add(mirrored(book(4, 3, 2), 0), {static_cast<uint8_t>(variation % 2 * 12), 0, 0},
             settings);
  }
  // Three streams.
  list.add(mirrored(halfSheet(50, 40, 3), 0));
  // Normals and texture coordinates of mates, one and several on a vertex.
  list.add(withNormals(mirrored(mirrored(halfSheet(6, 5, 4), 0), 1)));
  for (uint64_t variation = 1; variation <= 6; ++variation) {
    EncodeSettings settings;
    settings.variation = variation;
    list.add(withRandomWedges(withNormals(mirrored(halfSheet(6, 5, 5), 0)), variation, 5),
             {10, 4, 6}, settings);
  }
}

std::vector<NamedPayload> makePayloads() {
  PayloadList list;
  list.add(tetrahedron());
  list.add(looseTriangles(1), kExactBits);
  list.add(icosphere(1), kExactBits);
  list.add(torus(9, 7));
  list.add(plateWithTunnels(3, 2));
  list.add(sheetWithHoles(4, 1));
  list.add(generated(5, 4, 6, 7), {});
  list.add(mengerSponge(1));
  list.add(book(4, 3, 2));
  list.add(fins(5));
  list.add(bowTies(3, 3, 2));
  list.add(randomVoxels(3, 4, 50));
  list.add(moebius(12, 2));
  list.add(pinchedSpheres(3));
  list.add(tetrahedralSoup(2));
  list.add(doubled(icosphere(0)));
  list.add(chartGrid(8, 8, 3));
  list.add(withRandomWedges(torus(7, 5), 4, 3));
  list.add(withRandomWedges(book(3, 3, 3), 4, 3), kExactBits);
  list.add(flatShaded(icosphere(0)));
  list.add(withIndexDuplicates(icosphere(1), 5, 9));
  list.add(withPositionDuplicates(icosphere(1), 5, 9));
  list.add(withDegenerates(icosphere(1), 5, 9));
  list.add(withUnused(icosphere(1), 5, 9));
  list.add(randomSoup(11));
  list.add(randomSoup(12), kExactBits);
  const TestMesh leftovers = withDegenerates(withIndexDuplicates(grid(6, 6), 1, 8), 2, 8);
  addParts(list, leftovers, 3);
  addParts(list, leftovers, 3, keepingOrders(true, true));
  list.add(shuffled(icosphere(1), 1), {}, keepingOrders(true, false));
  list.add(chartGrid(8, 8, 3), {}, keepingOrders(false, true));
  addIndicesOnly(list, withRandomWedges(book(3, 3, 3), 4, 3));
  addPieces(list);
  addAttributes(list, withNormals(torus(8, 6)));
  addExact(list, withNormals(torus(8, 6)));
  addExact(list, withNormals(withRandomWedges(chartGrid(6, 6, 3), 4, 3)));
  list.add(chartGrid(8, 8, 3), kExactBits);
  // More than 2000 vertices: three streams.
  addExact(list, withNormals(torus(60, 40)));
  list.add(icosphere(4), {20, 10, 12});
  list.add(generated(9, 5, 12, 40));
  list.add(chartGrid(50, 50, 9));
  list.add(unionOf(std::array{randomVoxels(5, 9, 40), book(5, 8, 8), flipped(icosphere(4), 3, 999)},
                   "big copies"));
  addMirrors(list);
  addAnchors(list);
  addParts(list, withDegenerates(withIndexDuplicates(grid(50, 50), 1, 80), 2, 80), 3);
  addAttributes(list, withNormals(torus(60, 40)));
  list.add(shuffled(chartGrid(50, 50, 9), 1), {}, keepingOrders(true, true));
  return list.take();
}

}  // namespace

const std::vector<NamedPayload>& robustnessPayloads() {
  static const std::vector<NamedPayload> kPayloads = makePayloads();
  return kPayloads;
}

}  // namespace mcc::test
