// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Faces vertex by vertex: any faces of three different vertices come back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "connectivity/enc_pivots.h"
#include "support/mesh_generators.h"
#include "unit/surface.h"

namespace mcc::test {
namespace {

using Triangle = std::array<uint32_t, 3>;

/// Its smallest corner first.
Triangle canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::vector<Triangle> sortedFaces(const FaceMesh& mesh, const std::vector<uint32_t>& class_of) {
  std::vector<Triangle> faces;
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    const uint32_t* corner = mesh.words.data() + size_t{f} * kFaceWords;
    faces.push_back(canonical({class_of[corner[0]], class_of[corner[1]], class_of[corner[2]]}));
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

std::vector<Triangle> sortedFaces(const TestMesh& mesh) {
  std::vector<Triangle> faces;
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    faces.push_back(canonical({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}));
  std::sort(faces.begin(), faces.end());
  return faces;
}

PieceHeader headerOf(const PivotRecord& record) {
  PieceHeader header;
  header.setSurface(SurfaceCoding::kPivots);
  header.face_count = static_cast<uint32_t>(record.faces.size());
  header.vertex_count = header.wedge_count = static_cast<uint32_t>(record.class_of_vertex.size());
  return header;
}

/// Every corner is listed once, at its group.
void expectCorners(const FaceMesh& mesh, const Groups& groups) {
  ASSERT_TRUE(groups.hasCopies());
  ASSERT_TRUE(groups.has_corners);
  size_t count = 0;
  for (uint32_t g = 0; g < groups.count; ++g) {
    for (const uint32_t h : groups.umbrellasOf(g)) ASSERT_EQ(mesh.words[h], g);
    count += groups.umbrellasOf(g).size();
  }
  ASSERT_EQ(count, 3 * size_t{mesh.face_count});
}

PieceTruth truthOf(const PivotRecord& record) {
  PieceTruth truth;
  truth.pivot_faces = record.faces.data();
  return truth;
}

/// Bits per face.
template <bool kSingle>
double expectPivots(const TestMesh& mesh) {
  SCOPED_TRACE(mesh.name);
  const PivotRecord record = listByPivots(mesh.indices, mesh.vertexCount());
  const PieceHeader header = headerOf(record);
  EncoderIo encoder(kSingle);
  Stages<EncoderIo> writer(encoder, header, {positionInfo(10)});
  EXPECT_TRUE(writer.piece.codeConnectivity(truthOf(record)).ok());
  EXPECT_EQ(checkFaceMesh(writer.piece.mesh, header.vertex_count), "");
  EXPECT_EQ(sortedFaces(writer.piece.mesh, record.class_of_vertex), sortedFaces(mesh));
  for (uint32_t f = 0; f < header.face_count; ++f) {
    const uint32_t vertex = writer.piece.mesh.words[size_t{f} * kFaceWords + 1];
    EXPECT_EQ(record.class_of_vertex[vertex], mesh.indices[record.source_gate[f]]);
  }
  const double bits = static_cast<double>(encoder.cost()) / kCostOne;
  const EncoderIo::Streams streams = encoder.finish();
  DecoderIo<kSingle> decoder(streams.codes, streams.tokens, streams.raw);
  Stages<DecoderIo<kSingle>> reader(decoder, header, {positionInfo(10)});
  EXPECT_TRUE(reader.piece.codeConnectivity(PieceTruth{}).ok());
  EXPECT_TRUE(reader.piece.codeStitch(PieceTruth{}).ok());
  EXPECT_TRUE(decoder.finish().ok());
  const Array<uint32_t>& read = reader.piece.mesh.words;
  const Array<uint32_t>& written = writer.piece.mesh.words;
  EXPECT_TRUE(std::equal(read.data(), read.data() + read.size(), written.data(),
                         written.data() + written.size()));
  expectCorners(reader.piece.mesh, reader.piece.groups);
  return bits / header.face_count;
}

TEST(Pivots, FacesComeBack) {
  for (const TestMesh& mesh : {tetrahedron(),
                               torus(6, 5),
                               grid(5, 4),
                               looseTriangles(9),
                               moebius(9, 2),
                               kleinBottle(6, 5),
                               bowTies(4, 5, 3),
                               bipyramid(70),
                               openFan(300),
                               book(7, 6, 3),
                               fins(7),
                               randomVoxels(3, 6, 50),
                               tetrahedralSoup(3),
                               tetrahedraAsQuads(1, 4),
                               stackedCubes(1, 4, 100),
                               stackedCubes(2, 6, 50),
                               cellWalls(4),
                               doubled(icosphere(1)),
                               withIndexDuplicates(torus(6, 5), 3, 60),
                               withFlippedTriangles(icosphere(2), 3, 40)}) {
    expectPivots<true>(mesh);
    expectPivots<false>(mesh);
  }
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const uint32_t vertices = static_cast<uint32_t>(4 + seed % 40);
    expectPivots<true>(soup(seed, static_cast<uint32_t>(3 + 7 * seed), vertices, {}));
  }
}

TEST(Pivots, BitsPerFace) {
  EXPECT_LT(expectPivots<true>(tetrahedralSoup(10)), 1.5);
  EXPECT_LT(expectPivots<true>(shuffled(tetrahedralSoup(10), 1)), 1.5);
  EXPECT_LT(expectPivots<true>(tetrahedraAsQuads(1, 12)), 4.8);
  EXPECT_LT(expectPivots<true>(stackedCubes(1, 12, 100)), 2.1);
  EXPECT_LT(expectPivots<true>(stackedCubes(1, 12, 50)), 4.2);
  EXPECT_LT(expectPivots<true>(cellWalls(12)), 3.3);
}

/// A vertex of any degree is looked at once per face; with one look per pair this would take
/// minutes.
TEST(Pivots, HighDegreesTakeLinearTime) {
  expectPivots<false>(bipyramid(200000));
  expectPivots<false>(openFan(400000));
  // Every triangle of the last vertices has the same two others, so that all spokes but the last
  // are passed over.
  TestMesh mesh = openFan(60000);
  const uint32_t last = mesh.vertexCount() - 1;
  for (uint32_t v = 1; v + 1 < last; ++v) mesh.indices.insert(mesh.indices.end(), {0, v, last});
  expectPivots<false>(mesh);
}

TEST(Pivots, DamageIsAnError) {
  const TestMesh mesh = stackedCubes(2, 4, 50);
  const PivotRecord record = listByPivots(mesh.indices, mesh.vertexCount());
  const PieceHeader header = headerOf(record);
  EncoderIo encoder(true);
  Stages<EncoderIo> writer(encoder, header, {positionInfo(10)});
  ASSERT_TRUE(writer.piece.codeConnectivity(truthOf(record)).ok());
  const std::vector<uint8_t> codes = encoder.finish().codes;
  const auto decode = [](const std::vector<uint8_t>& bytes, const PieceHeader& claims) {
    DecoderIo<true> decoder(bytes, {}, {});
    Stages<DecoderIo<true>> reader(decoder, claims, {positionInfo(10)});
    const Status status = reader.piece.codeConnectivity(PieceTruth{});
    if (status.ok()) {
      EXPECT_EQ(checkFaceMesh(reader.piece.mesh, claims.vertex_count), "");
    }
    return status.ok() ? decoder.finish() : status;
  };
  EXPECT_TRUE(decode(codes, header).ok());
  for (size_t size = 0; size + 9 < codes.size(); ++size) {
    const auto end = codes.begin() + static_cast<std::ptrdiff_t>(size);
    EXPECT_FALSE(decode({codes.begin(), end}, header).ok()) << size;
  }
  for (const int by : {-1, 1}) {
    PieceHeader claims = header;
    claims.face_count += static_cast<uint32_t>(20 * by);  // few faces take less than a byte
    EXPECT_FALSE(decode(codes, claims).ok()) << by;
    claims = header;
    claims.vertex_count += static_cast<uint32_t>(by);
    EXPECT_FALSE(decode(codes, claims).ok()) << by;
  }
}

}  // namespace
}  // namespace mcc::test
