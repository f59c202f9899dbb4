// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Cut, collapse, encode, decode: the faces and twins of the cut mesh come back.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "support/mesh_generators.h"
#include "unit/surface.h"

namespace mcc::test {
namespace {

constexpr uint32_t nextCorner(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

struct Coded {
  CodeHistogram histogram;
  std::vector<uint8_t> codes;
  uint64_t cost = 0;
};

/// Looks up every face and every twin that was decoded in the source mesh.
void expectSame(const Surface& surface, const FaceMesh& decoded) {
  const ClosedMesh& source = surface.cut().mesh;
  ASSERT_EQ(decoded.face_count, source.real_face_count);
  ASSERT_EQ(decoded.vertex_count, source.real_vertex_count);
  ASSERT_EQ(checkFaceMesh(decoded, source.real_vertex_count), "");
  // Half-edge 8f+1 is the source's gate, 8f+2 the one after it, 8f the one before it.
  std::vector<uint32_t> decoded_of(3 * source.real_face_count, kNone);
  for (uint32_t f = 0; f < decoded.face_count; ++f) {
    uint32_t h = surface.sourceGate()[f];
    ASSERT_LT(h, decoded_of.size());
    for (const uint32_t k : {1u, 2u, 0u}) {
      ASSERT_EQ(decoded_of[h], kNone) << "a face comes twice";
      decoded_of[h] = f * kFaceWords + k;
      h = nextCorner(h);
    }
  }
  std::vector<uint8_t> used(source.real_vertex_count, 0);
  for (uint32_t h = 0; h < decoded_of.size(); ++h) {
    const uint32_t vertex = decoded.words[decoded_of[h]];
    ASSERT_EQ(surface.sourceOfVertex()[vertex], source.corner_vertex[h]);
    used[vertex] = 1;
    const uint32_t twin = source.twin[h] < decoded_of.size() ? decoded_of[source.twin[h]] : kNone;
    ASSERT_EQ(decoded.words[decoded_of[h] + 4], twin);
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), 1),
            static_cast<std::ptrdiff_t>(source.real_vertex_count));
}

template <bool kSingle>
Coded expectConnectivity(Surface& surface) {
  Coded coded;
  EncoderIo encoder(kSingle);
  Stages<EncoderIo> writer(encoder, surface.header(), {positionInfo(14)});
  PieceTruth truth;
  truth.connectivity = surface.truth();
  EXPECT_TRUE(writer.piece.codeConnectivity(truth).ok());
  expectSame(surface, writer.piece.mesh);
  coded.cost = encoder.cost();
  const EncoderIo::Streams streams = encoder.finish();
  coded.codes = streams.codes;

  DecoderIo<kSingle> decoder(streams.codes, streams.tokens, streams.raw);
  Stages<DecoderIo<kSingle>> reader(decoder, surface.header(), {positionInfo(14)});
  const Status status = reader.piece.codeConnectivity(PieceTruth{}, &coded.histogram);
  EXPECT_TRUE(status.ok()) << status.what;
  if (!status.ok()) return coded;
  EXPECT_TRUE(decoder.finish().ok());
  expectSame(surface, reader.piece.mesh);
  return coded;
}

Coded expectConnectivity(const TestMesh& mesh) {
  SCOPED_TRACE(mesh.name);
  Surface surface(mesh);
  const Coded coded = expectConnectivity<false>(surface);
  expectConnectivity<true>(surface);
  return coded;
}

uint64_t contractions(const CodeHistogram& histogram) {
  uint64_t sum = 0;
  for (const uint64_t count : histogram.degree) sum += count;
  return sum;
}

TEST(Connectivity, Spheres) {
  for (const TestMesh& mesh : {tetrahedron(), icosphere(0), icosphere(2), uvSphere(9, 7),
                               bipyramid(3), bipyramid(50), randomStacked(1, 200), deepStack(300),
                               combOfStacks(7, 9), flipped(icosphere(2), 3, 2000)}) {
    const Coded coded = expectConnectivity(mesh);
    // An operation removes a vertex, down to the last triangle's three. A divide removes none, but
    // leaves two parts to be ended.
    const CodeHistogram& h = coded.histogram;
    EXPECT_EQ(contractions(h) + h.start, mesh.vertexCount() - 3) << mesh.name;
    EXPECT_EQ(h.end, h.start + 1) << mesh.name;
    EXPECT_EQ(h.handle, 0u) << mesh.name;
    EXPECT_EQ(h.dummy, 0u) << mesh.name;
  }
}

TEST(Connectivity, EveryStartHalfEdge) {
  for (const TestMesh& mesh : {tetrahedron(), icosphere(0), plateWithTunnels(1, 1), grid(3, 2)}) {
    for (uint32_t h = 0; h < 3 * mesh.triangleCount(); ++h) {
      Surface surface(mesh, h);
      SCOPED_TRACE(mesh.name + ", start " + std::to_string(h));
      const uint32_t vertex = surface.record().components.front().vertex;
      EXPECT_EQ(vertex, surface.cut().mesh.corner_vertex[h]);
      expectConnectivity<true>(surface);
    }
  }
}

TEST(Connectivity, Handles) {
  for (const TestMesh& mesh :
       {torus(3, 3), torus(12, 9), plateWithTunnels(1, 2), plateWithTunnels(4, 1), mengerSponge(1),
        mengerSponge(2), flipped(torus(20, 10), 5, 3000)}) {
    const uint32_t genus = measureTopology(mesh).genus;
    const Coded coded = expectConnectivity(mesh);
    EXPECT_EQ(coded.histogram.handle, genus) << mesh.name;
  }
}

TEST(Connectivity, HolesAndComponents) {
  for (const TestMesh& mesh : {looseTriangles(1), looseTriangles(40), grid(1, 1), grid(9, 5),
                               openFan(30), sheetWithHoles(1, 2), sheetWithHoles(15, 3)}) {
    expectConnectivity(mesh);
  }
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const uint32_t genus = static_cast<uint32_t>(seed % 5);
    const uint32_t holes = static_cast<uint32_t>(seed / 5 % 6);
    const uint32_t components = static_cast<uint32_t>(1 + seed % 9);
    const TestMesh mesh = generated(seed, genus, holes, components);
    const Surface surface(mesh);
    EXPECT_EQ(surface.cut().hole_count, holes);
    EXPECT_EQ(surface.cut().mesh.components.size(), components);
    const Coded coded = expectConnectivity(mesh);
    EXPECT_EQ(coded.histogram.handle, genus) << mesh.name;
    EXPECT_LE(coded.histogram.dummy, holes) << mesh.name;
  }
}

TEST(Connectivity, TrianglesAloneAreNearlyFree) {
  // Alone, before and after other components, and next to triangles that are not alone.
  const Coded loose = expectConnectivity(looseTriangles(1000));
  EXPECT_LT(loose.cost, 100 * uint64_t{kCostOne});
  EXPECT_EQ(loose.histogram.end, 1000u);
  EXPECT_EQ(loose.histogram.degree[4], 1000u);
  const std::vector<TestMesh> mixed = {looseTriangles(3), icosphere(1),      looseTriangles(1),
                                       grid(2, 1),        looseTriangles(2), torus(5, 4),
                                       grid(3, 3),        looseTriangles(1)};
  expectConnectivity(unionOf(mixed, "triangles among others"));
  const std::vector<TestMesh> closed = {looseTriangles(1), torus(5, 4), tetrahedron()};
  expectConnectivity(unionOf(closed, "one hole"));
}

TEST(Connectivity, WhatTheCutLeavesOfBadMeshes) {
  for (const TestMesh& mesh : {moebius(8, 2), kleinBottle(6, 5), bowTies(3, 4, 3),
                               pinchedSpheres(4), book(5, 4, 3), fins(5), randomVoxels(2, 5, 50),
                               tetrahedralSoup(2), withFlippedTriangles(torus(8, 6), 3, 30)}) {
    expectConnectivity(mesh);
  }
  for (uint32_t seed = 0; seed < 60; ++seed) {
    SoupOptions options;
    options.opposite_percent = seed % 3 == 0 ? 20 : 0;
    const TestMesh mesh = soup(seed, 5 + seed * 3, 4 + seed % 30, options);
    expectConnectivity(mesh);
  }
}

TEST(Connectivity, SoupsOfManyHandles) {
  // Random gluing of triangles on few vertices: handles, holes and copies in every order.
  uint64_t handles = 0;
  for (uint64_t seed = 100; seed < 130; ++seed) {
    const TestMesh mesh = soup(seed, 400, 12, {});
    const Coded coded = expectConnectivity(mesh);
    handles += coded.histogram.handle;
  }
  EXPECT_GT(handles, 100u);
}

TEST(Connectivity, WorkIsLinear) {
  // Count operations and gates instead of time: a gate is looked at once when it is coded.
  for (const TestMesh& mesh : {icosphere(4), combOfStacks(40, 40), flipped(icosphere(4), 7, 20000),
                               bipyramid(3000), sheetWithHoles(20, 4), torus(50, 40)}) {
    const Surface surface(mesh);
    const McRecord& record = surface.record();
    const ClosedMesh& cut = surface.cut().mesh;
    EXPECT_LE(record.operations.size(), cut.real_vertex_count + cut.dummy_count) << mesh.name;
    EXPECT_LE(record.node_count,
              cut.real_vertex_count + cut.dummy_count + 2 * record.operations.size())
        << mesh.name;
    EXPECT_EQ(record.gates.size(), cut.faceCount()) << mesh.name;  // one gate per triangle
  }
}

TEST(Connectivity, ClaimsOfTheHeaderAreChecked) {
  Surface surface(generated(3, 1, 2, 2));
  EncoderIo encoder(true);
  Stages<EncoderIo> writer(encoder, surface.header(), {positionInfo(14)});
  PieceTruth truth;
  truth.connectivity = surface.truth();
  ASSERT_TRUE(writer.piece.codeConnectivity(truth).ok());
  const std::vector<uint8_t> codes = encoder.finish().codes;
  const auto decode = [&](const PieceHeader& header) {
    DecoderIo<true> decoder(codes, {}, {});
    Stages<DecoderIo<true>> reader(decoder, header, {positionInfo(14)});
    return reader.piece.codeConnectivity(PieceTruth{}).error;
  };
  EXPECT_EQ(decode(surface.header()), Error::kOk);
  const PieceHeader good = surface.header();
  for (uint32_t PieceHeader::*field : {&PieceHeader::vertex_count, &PieceHeader::face_count}) {
    for (const uint32_t wrong : {good.*field - 1, good.*field + 1, 0u, 1u}) {
      PieceHeader header = good;
      header.*field = wrong;
      EXPECT_EQ(decode(header), Error::kBadConnectivity);
    }
  }
  for (uint32_t operations = 0; operations < good.operation_count; ++operations) {
    PieceHeader header = good;
    header.operation_count = operations;
    EXPECT_EQ(decode(header), Error::kBadConnectivity) << operations;
  }
}

}  // namespace
}  // namespace mcc::test
