// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Stitching: any partition of the vertices of the cut mesh into classes comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "support/mesh_generators.h"
#include "unit/surface.h"

namespace mcc::test {
namespace {

/// Corners of decoded faces, by vertex: what stitching rewrites.
std::vector<uint32_t> cornersOf(const FaceMesh& mesh) {
  std::vector<uint32_t> corners;
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    for (uint32_t k = 0; k < 3; ++k) corners.push_back(mesh.words[size_t{f} * kFaceWords + k]);
  }
  return corners;
}

void expectGroups(const FaceMesh& mesh, const Groups& groups, const std::vector<uint32_t>& vertices,
                  const std::vector<uint32_t>& class_of_vertex) {
  const std::vector<uint32_t> corners = cornersOf(mesh);
  ASSERT_EQ(corners.size(), vertices.size());
  std::map<uint32_t, uint32_t> group_of_class;
  std::set<uint32_t> seen;
  for (size_t c = 0; c < corners.size(); ++c) {
    const auto [entry, is_new] = group_of_class.emplace(class_of_vertex[vertices[c]], corners[c]);
    ASSERT_EQ(entry->second, corners[c]) << "a class in two groups";
    ASSERT_TRUE(!is_new || seen.insert(corners[c]).second) << "two classes in a group";
  }
  ASSERT_EQ(groups.count, group_of_class.size());
  ASSERT_TRUE(groups.hasCopies());
  // The umbrellas of a listed group: one half-edge leaving it per vertex. Where there are copies,
  // all vertices are in one.
  std::set<uint32_t> stitched;
  for (uint32_t g = 0; g < groups.count; ++g) {
    for (const uint32_t h : groups.umbrellasOf(g)) {
      ASSERT_EQ(mesh.words[h], g);
      ASSERT_TRUE(stitched.insert(vertices[3 * faceOf(h) + (h & 3)]).second);
    }
  }
  std::map<uint32_t, std::set<uint32_t>> vertices_of_group;
  for (size_t c = 0; c < corners.size(); ++c) vertices_of_group[corners[c]].insert(vertices[c]);
  for (const auto& [group, members] : vertices_of_group) {
    ASSERT_EQ(groups.umbrellasOf(group).size(),
              members.size() > 1 || !groups.umbrellasOf(group).empty() ? members.size() : 0);
  }
}

/// `classes` empty: those of the cut. Otherwise by decoded vertex.
template <bool kSingle>
void expectStitched(Surface& surface, bool interior, std::vector<uint32_t> classes = {}) {
  PieceHeader header = surface.header();
  header.setSurface(interior ? SurfaceCoding::kCopies : SurfaceCoding::kBoundaryCopies);
  EncoderIo encoder(kSingle);
  Stages<EncoderIo> writer(encoder, header, {positionInfo(10)});
  PieceTruth truth;
  truth.connectivity = surface.truth();
  ASSERT_TRUE(writer.piece.codeConnectivity(truth).ok());
  if (classes.empty()) classes = surface.classOfVertex();
  truth.class_of_vertex = classes.data();
  truth.class_count = *std::max_element(classes.begin(), classes.end()) + 1;
  const std::vector<uint32_t> vertices = cornersOf(writer.piece.mesh);
  ASSERT_TRUE(writer.piece.codeStitch(truth).ok());
  expectGroups(writer.piece.mesh, writer.piece.groups, vertices, classes);
  const EncoderIo::Streams streams = encoder.finish();

  DecoderIo<kSingle> decoder(streams.codes, streams.tokens, streams.raw);
  Stages<DecoderIo<kSingle>> reader(decoder, header, {positionInfo(10)});
  ASSERT_TRUE(reader.piece.codeConnectivity(PieceTruth{}).ok());
  const Status status = reader.piece.codeStitch(PieceTruth{});
  ASSERT_TRUE(status.ok()) << status.what;
  ASSERT_TRUE(decoder.finish().ok());
  ASSERT_EQ(checkFaceMesh(reader.piece.mesh, reader.piece.groups.count), "");
  expectGroups(reader.piece.mesh, reader.piece.groups, vertices, classes);
  ASSERT_EQ(cornersOf(reader.piece.mesh), cornersOf(writer.piece.mesh));
}

TEST(Stitch, WhatTheCutMadeApart) {
  for (const TestMesh& mesh :
       {moebius(9, 2), kleinBottle(6, 5), bowTies(4, 5, 3), bowTies(40, 2, 2), pinchedSpheres(5),
        book(7, 6, 3), fins(7), randomVoxels(3, 6, 50), mengerSponge(2), tetrahedralSoup(3),
        withFlippedTriangles(torus(9, 7), 1, 40)}) {
    SCOPED_TRACE(mesh.name);
    Surface surface(mesh);
    if (!surface.hasCopies()) continue;
    expectStitched<true>(surface, true);
    expectStitched<false>(surface, true);
  }
}

TEST(Stitch, BoundariesAlone) {
  // The spine of a book with three pages: two of them stay joined, the third is cut off.
  Surface surface(book(3, 6, 3));
  ASSERT_TRUE(surface.hasCopies());
  expectStitched<true>(surface, false);
  expectStitched<false>(surface, false);
}

TEST(Stitch, AnyPartitionOfTheVertices) {
  for (const TestMesh& mesh : {grid(12, 9), torus(8, 7), sheetWithHoles(4, 2), looseTriangles(60),
                               bipyramid(70), generated(4, 1, 3, 4)}) {
    for (const uint32_t class_count : {1u, 2u, 7u, 40u, 1000000u}) {
      SCOPED_TRACE(mesh.name + ", " + std::to_string(class_count) + " classes");
      Surface surface(mesh);
      Random random(class_count);
      std::vector<uint32_t> classes(surface.header().vertex_count);
      for (uint32_t& c : classes) c = random.below(class_count);
      expectStitched<true>(surface, true, classes);
      expectStitched<false>(surface, true, std::move(classes));
    }
  }
}

/// Returns the bits of a copy, flags included.
double bitsPerCopy(const TestMesh& mesh) {
  Surface surface(mesh);
  PieceHeader header = surface.header();
  header.setSurface(SurfaceCoding::kCopies);
  CostIo io;
  Stages<CostIo> stages(io, header, {positionInfo(10)});
  PieceTruth truth;
  truth.connectivity = surface.truth();
  EXPECT_TRUE(stages.piece.codeConnectivity(truth).ok());
  const std::vector<uint32_t> classes = surface.classOfVertex();
  truth.class_of_vertex = classes.data();
  truth.class_count = *std::max_element(classes.begin(), classes.end()) + 1;
  const uint64_t before = io.cost();
  EXPECT_TRUE(stages.piece.codeStitch(truth).ok());
  const double copies = header.vertex_count - stages.piece.groups.count;
  return static_cast<double>(io.cost() - before) / kCostOne / copies;
}

TEST(Stitch, BitsPerCopy) {
  EXPECT_LT(bitsPerCopy(randomVoxels(3, 16, 50)), 11);
  EXPECT_LT(bitsPerCopy(tetrahedralSoup(8)), 3.5);
  EXPECT_LT(bitsPerCopy(withFlippedTriangles(torus(60, 60), 1, 10)), 8);
}

TEST(Stitch, DamageIsAnError) {
  Surface surface(book(7, 6, 3));
  EncoderIo encoder(true);
  Stages<EncoderIo> writer(encoder, surface.header(), {positionInfo(10)});
  PieceTruth truth;
  truth.connectivity = surface.truth();
  ASSERT_TRUE(writer.piece.codeConnectivity(truth).ok());
  const std::vector<uint32_t> classes = surface.classOfVertex();
  truth.class_of_vertex = classes.data();
  truth.class_count = 1000;
  ASSERT_TRUE(writer.piece.codeStitch(truth).ok());
  const std::vector<uint8_t> codes = encoder.finish().codes;
  for (size_t size = 0; size + 9 < codes.size(); ++size) {
    const std::vector<uint8_t> cut(codes.begin(),
                                   codes.begin() + static_cast<std::ptrdiff_t>(size));
    DecoderIo<true> decoder(cut, {}, {});
    Stages<DecoderIo<true>> reader(decoder, surface.header(), {positionInfo(10)});
    Status status = reader.piece.codeConnectivity(PieceTruth{});
    if (status.ok()) status = reader.piece.codeStitch(PieceTruth{});
    if (status.ok()) status = decoder.finish();
    EXPECT_FALSE(status.ok()) << size;
  }
}

TEST(Stitch, ManifoldsHaveNone) {
  Surface surface(torus(5, 5));
  EXPECT_FALSE(surface.hasCopies());
  EncoderIo encoder(true);
  Stages<EncoderIo> writer(encoder, surface.header(), {positionInfo(10)});
  PieceTruth truth;
  truth.connectivity = surface.truth();
  ASSERT_TRUE(writer.piece.codeConnectivity(truth).ok());
  const uint64_t cost = encoder.cost();
  ASSERT_TRUE(writer.piece.codeStitch(truth).ok());
  EXPECT_EQ(encoder.cost(), cost);
  EXPECT_EQ(writer.piece.groups.count, 25u);
  EXPECT_FALSE(writer.piece.groups.hasCopies());
}

}  // namespace
}  // namespace mcc::test
