// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The codec's collapse against the paper's: from the same start half-edge the same code words, in
// the same order, remove the same vertices with the same dummy marks. The codec's operations are
// written in the paper's words by inPaperWords(). Each record compared is also coded, decoded and
// counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "connectivity/enc_collapse.h"
#include "connectivity/mc_codes.h"
#include "entropy/decoder_io.h"
#include "entropy/enc_coder.h"
#include "gltf/document/accessors.h"
#include "gltf/document/document.h"
#include "prepare/enc_cut.h"
#include "prepare/enc_triangles.h"
#include "prepare/enc_weld.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "support/paper_oracle.h"
#include "writer/truth.h"

namespace mcc::test {
namespace {

using Kind = OracleCode::Kind;
using Records = std::vector<OracleRecord>;
using Triangles = std::vector<std::array<uint32_t, 3>>;

// ---- Lists of operations ------------------------------------------------------------------------

/// The operations of the codec as the paper's code words: S flag -> S before its operation, EXPAND
/// of r -> degree r + 3, TWIG -> S E, END -> E. The end of a component is not a code word. index_of
/// is the oracle's index of each of the codec's vertices.
Records inPaperWords(std::span<const McOperation> operations, const McRecord& record,
                     std::span<const uint32_t> index_of) {
  const auto vertex = [&](uint32_t v) {
    return OracleVertex{index_of[v], record.vertex_is_dummy[v] != 0};
  };
  Records words;
  for (const McOperation& op : operations) {
    if (op.join == McJoin::kStart || op.kind == McKind::kTwig) {
      words.push_back({{Kind::kStart, 0, 0, 0}, {}});
    }
    if (op.join == McJoin::kHandle) words.push_back({{Kind::kHandle, 0, 0, 0}, {}});
    if (op.kind == McKind::kExpand) {
      words.push_back({{Kind::kDegree, op.degree + 3, 0, 0}, {vertex(op.vertex_a), {}}});
    } else {
      words.push_back({{Kind::kEnd, 0, 0, 0}, {vertex(op.vertex_a), vertex(op.vertex_b)}});
    }
  }
  return words;
}

size_t firstDifference(const Records& a, const Records& b) {
  return static_cast<size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first -
                             a.begin());
}

/// Returns "" for equal lists, else the first place where they differ.
std::string difference(const Records& oracle, const Records& codec) {
  if (oracle == codec) return "";
  const size_t place = firstDifference(oracle, codec);
  const auto word = [place](const Records& list) {
    return place < list.size() ? toString(list[place]) : "nothing";
  };
  return "word " + std::to_string(place) + ": oracle " + word(oracle) + ", codec " + word(codec);
}

/// Adds the code words to the counts a decoder makes.
void addTo(CodeHistogram& counts, const Records& records) {
  bool joined = false;
  for (const OracleRecord& record : records) {
    switch (record.code.kind) {
      case Kind::kStart: ++counts.start; break;
      case Kind::kEnd: ++counts.end; break;
      case Kind::kHandle: ++counts.handle; break;
      case Kind::kDegree:
        ++counts.degree[std::min(record.code.degree, 255u)];
        // After an S the vertex already exists.
        if (record.vertices[0].dummy && !joined) ++counts.dummy;
    }
    joined = record.code.kind == Kind::kStart;
  }
}

void expectEqual(const CodeHistogram& oracle, const CodeHistogram& codec) {
  EXPECT_EQ(oracle.start, codec.start);
  EXPECT_EQ(oracle.end, codec.end);
  EXPECT_EQ(oracle.handle, codec.handle);
  EXPECT_EQ(oracle.dummy, codec.dummy);
  EXPECT_TRUE(
      std::equal(std::begin(oracle.degree), std::end(oracle.degree), std::begin(codec.degree)));
}

uint64_t contractsAndDivides(const CodeHistogram& counts) {
  return std::accumulate(std::begin(counts.degree), std::end(counts.degree), counts.start);
}

// ---- Coding and decoding ------------------------------------------------------------------------

/// The half-edge of the source that half-edge k of a decoded face became: `gate` became the second.
uint32_t sourceHalfEdge(uint32_t gate, uint32_t k) { return gate - gate % 3 + (gate + k + 2) % 3; }

/// Expects the faces of `decoded` to be the real ones of `mesh`, each once, with the same twins.
void expectSameFaces(const ClosedMesh& mesh, const FaceMesh& decoded,
                     const std::vector<uint32_t>& source_of_vertex,
                     const std::vector<uint32_t>& source_gate) {
  ASSERT_EQ(decoded.face_count, mesh.real_face_count);
  std::vector<bool> found(mesh.real_face_count, false);
  size_t wrong = 0;
  for (uint32_t f = 0; f < decoded.face_count; ++f) {
    ASSERT_LT(source_gate[f] / 3, mesh.real_face_count);
    wrong += found[source_gate[f] / 3];
    found[source_gate[f] / 3] = true;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t h = sourceHalfEdge(source_gate[f], k);
      const uint32_t vertex = decoded.words[kFaceWords * f + k];
      const uint32_t twin = decoded.words[kFaceWords * f + k + 4];
      wrong += source_of_vertex[vertex] != mesh.corner_vertex[h];
      if (mesh.twin[h] / 3 >= mesh.real_face_count) {
        wrong += twin != kNone;
      } else if (twin == kNone) {
        ++wrong;
      } else {
        wrong += sourceHalfEdge(source_gate[faceOf(twin)], twin % kFaceWords) != mesh.twin[h];
      }
    }
  }
  EXPECT_EQ(wrong, 0u);
}

/// Encodes and decodes; expects the mesh that the record was made of. Returns the decoder's counts.
CodeHistogram codedAndDecoded(const ClosedMesh& mesh, const McRecord& record) {
  const McCounts counts{static_cast<uint32_t>(record.operations.size()), mesh.real_vertex_count,
                        mesh.dummy_count, mesh.real_face_count, !record.handles.empty()};
  const auto run = [&](auto& io, FaceMesh& faces, const McTruth& truth, CodeHistogram& histogram) {
    McModels models;
    EXPECT_TRUE(faces.words.resize(size_t{counts.face_count} * kFaceWords));
    const McWatch watch{&histogram, nullptr};
    McMachine machine(io, models, counts, faces, truth);
    const Status status = machine.run(&watch);
    EXPECT_TRUE(status.ok()) << status.what;
    return status.ok();
  };

  std::vector<uint32_t> node_map(record.node_count);
  std::vector<uint32_t> source_of_vertex(mesh.real_vertex_count);
  std::vector<uint32_t> source_gate(mesh.real_face_count);
  const McTruth truth = connectivityTruth(record, {node_map, source_of_vertex, source_gate});
  EncoderIo encoder(false);
  FaceMesh encoded{Allocator{}};
  CodeHistogram encoder_counts;
  if (!run(encoder, encoded, truth, encoder_counts)) return {};
  const EncoderIo::Streams streams = encoder.finish();

  DecoderIo<false> decoder(streams.codes, streams.tokens, streams.raw);
  FaceMesh decoded{Allocator{}};
  CodeHistogram decoder_counts;
  if (!run(decoder, decoded, McTruth{}, decoder_counts)) return {};
  EXPECT_TRUE(decoder.finish().ok());
  EXPECT_EQ(decoded.vertex_count, mesh.real_vertex_count);
  expectSameFaces(mesh, decoded, source_of_vertex, source_gate);
  expectEqual(encoder_counts, decoder_counts);
  return decoder_counts;
}

// ---- One mesh, many starts ----------------------------------------------------------------------

/// A mesh of one component that is a sphere after its holes are coned, by the oracle and by the
/// codec. Meshes with twins of their own, which may have double edges, do without cutToManifold().
class Comparison {
 public:
  explicit Comparison(const OracleMesh& mesh) : mesh_(mesh), closed_(coneHoles(mesh)) {
    if (mesh.twins.empty()) {
      const CutResult cut = cutAt(kNone);
      codec_ = cut.mesh;
      index_of_ = cut.class_of_vertex;
    } else {
      adoptTwins();
    }
    for (uint32_t d = 0; d < codec_.dummy_count; ++d) index_of_.push_back(closed_.first_dummy + d);
    mapHalfEdges();
  }

  /// Half-edges of the closed mesh, those of cones included.
  uint32_t startCount() const { return static_cast<uint32_t>(closed_.twins.size()); }
  /// One that begins at a dummy; only for meshes with holes.
  uint32_t startAtDummy(Random& random) const {
    const uint32_t first = static_cast<uint32_t>(3 * mesh_.triangles.size());
    return first + random.below((startCount() - first) / 3) * 3 + 2;
  }

  /// The comparison from one start half-edge of the closed mesh. Returns the number of divides.
  uint64_t expectSame(uint32_t start) const {
    SCOPED_TRACE("start half-edge " + std::to_string(start));
    const OracleCoding coding = encodeByPaper(closed_, start);
    const ClosedMesh mesh = codecMeshAt(start);
    const McRecord record = collapse(mesh);
    EXPECT_EQ(record.components.size(), 1u);
    EXPECT_EQ(index_of_[record.components[0].vertex], coding.stacks.vertices[0].index);
    EXPECT_EQ(record.vertex_is_dummy[record.components[0].vertex] != 0,
              coding.stacks.vertices[0].dummy);
    EXPECT_EQ(difference(coding.records, inPaperWords(record.operations, record, index_of_)), "");

    const CodeHistogram counts = codedAndDecoded(mesh, record);
    EXPECT_EQ(contractsAndDivides(counts), mesh.real_vertex_count + mesh.dummy_count - 3);
    EXPECT_EQ(counts.end, counts.start + 1);
    CodeHistogram oracle_counts;
    addTo(oracle_counts, coding.records);
    expectEqual(oracle_counts, counts);
    return counts.start;
  }

  /// Expects the comparison to fail after the first divide when the oracle continues with the other
  /// digon. Returns false when nothing is divided, and the lists are equal.
  bool expectOtherSideDiffers(uint32_t start) const {
    SCOPED_TRACE("start half-edge " + std::to_string(start));
    const Records other = encodeByPaper(closed_, start, {.side = OracleSide::kOther}).records;
    const McRecord record = collapse(codecMeshAt(start));
    const Records codec = inPaperWords(record.operations, record, index_of_);
    const auto is_divide = [](const OracleRecord& r) { return r.code.kind == Kind::kStart; };
    const auto divide = std::find_if(codec.begin(), codec.end(), is_divide);
    if (divide == codec.end()) {
      EXPECT_EQ(difference(other, codec), "");
      return false;
    }
    EXPECT_NE(difference(other, codec), "");
    EXPECT_GT(firstDifference(other, codec), static_cast<size_t>(divide - codec.begin()));
    return true;
  }

 private:
  CutResult cutAt(uint32_t start) const {
    std::vector<uint32_t> corner_class;
    for (const auto& t : mesh_.triangles) {
      corner_class.insert(corner_class.end(), t.begin(), t.end());
    }
    return cutToManifold(corner_class, mesh_.vertex_count, start);
  }

  ClosedMesh codecMeshAt(uint32_t start) const {
    if (mesh_.twins.empty()) return cutAt(half_edge_[start]).mesh;
    ClosedMesh mesh = codec_;
    mesh.components[0].start_half_edge = half_edge_[start];
    return mesh;
  }

  void adoptTwins() {
    for (const auto& t : closed_.triangles) {
      codec_.corner_vertex.insert(codec_.corner_vertex.end(), t.begin(), t.end());
    }
    codec_.twin = closed_.twins;
    codec_.real_face_count = static_cast<uint32_t>(mesh_.triangles.size());
    codec_.real_vertex_count = mesh_.vertex_count;
    codec_.dummy_count = closed_.vertex_count - mesh_.vertex_count;
    codec_.components.push_back({0, false});
    index_of_.resize(mesh_.vertex_count);
    std::iota(index_of_.begin(), index_of_.end(), 0u);
  }

  /// Both cone a hole by triangles (end, origin, dummy), but in different order.
  void mapHalfEdges() {
    const auto real = static_cast<uint32_t>(3 * mesh_.triangles.size());
    half_edge_.resize(closed_.twins.size());
    ASSERT_EQ(codec_.twin.size(), half_edge_.size());
    ASSERT_EQ(codec_.components.size(), 1u);
    EXPECT_FALSE(codec_.components[0].has_handles);
    for (uint32_t h = 0; h < half_edge_.size(); ++h) {
      half_edge_[h] = h < real ? h : codec_.twin[closed_.twins[h - h % 3]] + h % 3;
    }
    size_t wrong = 0;
    for (uint32_t h = 0; h < half_edge_.size(); ++h) {
      wrong += index_of_[codec_.corner_vertex[half_edge_[h]]] != oracleOrigin(closed_, h);
      wrong += codec_.twin[half_edge_[h]] != half_edge_[closed_.twins[h]];
    }
    EXPECT_EQ(wrong, 0u) << "the codec cuts or closes the mesh differently";
  }

  OracleMesh mesh_;
  OracleMesh closed_;
  ClosedMesh codec_;
  std::vector<uint32_t> index_of_;   // by vertex of codec_
  std::vector<uint32_t> half_edge_;  // of codec_, by half-edge of closed_
};

OracleMesh toOracle(const TestMesh& mesh) {
  OracleMesh result;
  result.vertex_count = mesh.vertexCount();
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    result.triangles.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  }
  return result;
}

void expectAllStarts(const OracleMesh& mesh) {
  const Comparison comparison(mesh);
  for (uint32_t h = 0; h < comparison.startCount() && !testing::Test::HasFailure(); ++h) {
    comparison.expectSame(h);
  }
}

/// Compares from random starts, and from one at a dummy where there is a hole. Returns the number
/// of divides.
uint64_t expectSomeStarts(const OracleMesh& mesh, Random& random, uint32_t starts) {
  const Comparison comparison(mesh);
  uint64_t divides = 0;
  for (uint32_t i = 0; i < starts && !testing::Test::HasFailure(); ++i) {
    divides += comparison.expectSame(random.below(comparison.startCount()));
  }
  if (comparison.startCount() > 3 * mesh.triangles.size()) {
    divides += comparison.expectSame(comparison.startAtDummy(random));
  }
  return divides;
}

uint64_t expectSomeStarts(const TestMesh& mesh, Random& random, uint32_t starts) {
  SCOPED_TRACE(mesh.name);
  return expectSomeStarts(toOracle(mesh), random, starts);
}

// ---- Meshes -------------------------------------------------------------------------------------

/// The mesh with its vertices renamed in every way, each oriented result once.
std::vector<OracleMesh> allLabellings(const TestMesh& mesh) {
  std::vector<uint32_t> names(mesh.vertexCount());
  std::iota(names.begin(), names.end(), 0u);
  std::set<Triangles> found;
  do {
    Triangles triangles = toOracle(mesh).triangles;
    for (auto& t : triangles) {
      for (uint32_t& v : t) v = names[v];
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    }
    std::sort(triangles.begin(), triangles.end());
    found.insert(std::move(triangles));
  } while (std::next_permutation(names.begin(), names.end()));
  std::vector<OracleMesh> meshes;
  for (const Triangles& triangles : found) {
    meshes.emplace_back();
    meshes.back().triangles = triangles;
    meshes.back().vertex_count = mesh.vertexCount();
  }
  return meshes;
}

TestMesh flippedSphere(Random& random, uint32_t vertices) {
  return flipped(randomStacked(random.next(), vertices - 4), random.next(), 20 * vertices);
}

/// A disc and its back, glued along the boundary. Edges between two vertices of the boundary become
/// double edges.
OracleMesh withBack(const TestMesh& disc) {
  const OracleMesh front = toOracle(disc);
  const OracleMesh closed = coneHoles(front);
  const auto faces = static_cast<uint32_t>(front.triangles.size());
  const auto is_boundary = [&](uint32_t h) { return closed.twins[h] >= 3 * faces; };
  const auto back = [&](uint32_t h) { return 3 * (faces + h / 3) + 2 - h % 3; };
  std::vector<bool> on_boundary(front.vertex_count, false);
  for (uint32_t h = 0; h < 3 * faces; ++h) {
    if (is_boundary(h)) on_boundary[oracleOrigin(front, h)] = true;
  }
  OracleMesh result = front;
  std::vector<uint32_t> back_of(front.vertex_count);
  for (uint32_t v = 0; v < front.vertex_count; ++v) {
    back_of[v] = on_boundary[v] ? v : result.vertex_count++;
  }
  for (const auto& [a, b, c] : front.triangles) {
    result.triangles.push_back({back_of[a], back_of[c], back_of[b]});
  }
  result.twins.resize(size_t{6} * faces);
  for (uint32_t h = 0; h < 3 * faces; ++h) {
    const uint32_t twin = closed.twins[h];
    result.twins[h] = is_boundary(h) ? back(h) : twin;
    result.twins[back(h)] = is_boundary(h) ? h : back(twin);
  }
  return result;
}

/// A mesh that has twins, without its last triangle.
OracleMesh withHole(OracleMesh mesh) {
  mesh.triangles.pop_back();
  for (uint32_t k = 0; k < 3; ++k) {
    mesh.twins[mesh.twins.back()] = kOracleNone;
    mesh.twins.pop_back();
  }
  return mesh;
}

/// Some disc with edges between vertices of its boundary.
TestMesh someDisc(Random& random, uint32_t size) {
  if (random.chance(30)) return flipped(openFan(size), random.next(), 4 * size);
  if (random.chance(40)) {
    const uint32_t width = 1 + random.below(4);
    return flipped(grid(width, 1 + size / width), random.next(), 8 * size);
  }
  TestMesh mesh = flippedSphere(random, 4 + size);
  mesh.indices.resize(mesh.indices.size() - 3);
  return flipped(std::move(mesh), random.next(), 10 * size);
}

// ---- Closed spheres -----------------------------------------------------------------------------

TEST(CodecAgainstOracle, AllTriangulationsUpToSixVerticesFromAllStarts) {
  size_t meshes = 0;
  for (const TestMesh& mesh : {tetrahedron(), bipyramid(3), bipyramid(4), deepStack(2)}) {
    SCOPED_TRACE(mesh.name);
    for (const OracleMesh& labelled : allLabellings(mesh)) {
      expectAllStarts(labelled);
      ++meshes;
    }
  }
  // So many labelled triangulations on 4, 5 and 6 vertices, each in both orientations.
  EXPECT_EQ(meshes, 2 * (1 + 10 + 195));
}

TEST(CodecAgainstOracle, Icospheres) {
  Random random(1);
  expectAllStarts(toOracle(icosphere(0)));
  for (uint32_t level = 1; level < 5; ++level) expectSomeStarts(icosphere(level), random, 8);
}

TEST(CodecAgainstOracle, StackedSpheres) {
  Random random(2);
  uint64_t divides = 0;
  for (uint32_t i = 0; i < 60; ++i) {
    divides += expectSomeStarts(randomStacked(i, random.below(120)), random, 5);
  }
  for (const uint32_t depth : {1u, 7u, 300u}) {
    divides += expectSomeStarts(deepStack(depth), random, 5);
    divides += expectSomeStarts(combOfStacks(3 + depth % 20, 5), random, 5);
  }
  EXPECT_GT(divides, 1000u);
}

TEST(CodecAgainstOracle, FlippedSpheres) {
  Random random(3);
  uint64_t divides = 0;
  for (uint32_t i = 0; i < 60; ++i) {
    divides += expectSomeStarts(flippedSphere(random, random.between(6, 200)), random, 5);
  }
  divides += expectSomeStarts(flippedSphere(random, 3000), random, 2);
  EXPECT_GT(divides, 1000u);
}

TEST(CodecAgainstOracle, SpheresOfTheGenerators) {
  Random random(4);
  for (const TestMesh& mesh :
       {uvSphere(12, 7), shuffled(uvSphere(20, 30), 1), bipyramid(300), subdivided(bipyramid(7), 3),
        subdivided(deepStack(9), 2), flipped(icosphere(3), 2, 3000)}) {
    expectSomeStarts(mesh, random, 6);
  }
}

TEST(CodecAgainstOracle, DoubleEdges) {
  Random random(5);
  uint64_t divides = 0;
  expectAllStarts(withBack(openFan(1)));  // two triangles: one E
  for (uint32_t i = 0; i < 60; ++i) {
    const OracleMesh mesh = withBack(someDisc(random, random.between(2, 80)));
    divides += expectSomeStarts(mesh, random, 4);
    divides += expectSomeStarts(withHole(mesh), random, 4);
  }
  EXPECT_GT(divides, 1000u);
}

// ---- Holes --------------------------------------------------------------------------------------

TEST(CodecAgainstOracle, SmallMeshesWithHolesFromAllStarts) {
  expectAllStarts(toOracle(looseTriangles(1)));
  for (const TestMesh& mesh : {grid(1, 1), grid(2, 2), openFan(5), sheetWithHoles(1, 1)}) {
    SCOPED_TRACE(mesh.name);
    expectAllStarts(toOracle(mesh));
  }
  for (const TestMesh& mesh : {bipyramid(3), bipyramid(4), deepStack(2)}) {
    SCOPED_TRACE(mesh.name);
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
      OracleMesh open = toOracle(mesh);
      open.triangles.erase(open.triangles.begin() + static_cast<std::ptrdiff_t>(t / 3));
      expectAllStarts(open);
    }
  }
}

TEST(CodecAgainstOracle, UpToTwentyHoles) {
  Random random(6);
  for (uint32_t holes = 0; holes <= 20; ++holes) {
    for (uint32_t i = 0; i < 4; ++i) {
      expectSomeStarts(generated(random.next(), 0, holes, 1), random, 3);
    }
    TestMesh sphere = flippedSphere(random, 30 + 25 * holes);
    punchHoles(sphere, random.next(), holes);
    expectSomeStarts(sphere, random, 3);
  }
}

TEST(CodecAgainstOracle, SheetsOfTheGenerators) {
  Random random(7);
  for (const QuadSplit split :
       {QuadSplit::kSame, QuadSplit::kAlternate, QuadSplit::kRows, QuadSplit::kRandom}) {
    expectSomeStarts(grid(15, 11, split, 1), random, 4);
  }
  for (uint32_t holes = 0; holes < 20; holes += 3) {
    expectSomeStarts(sheetWithHoles(holes, holes), random, 4);
  }
  expectSomeStarts(openFan(500), random, 4);  // also the codes of degrees above 255
  expectSomeStarts(shuffled(flipped(grid(30, 20), 3, 5000), 4), random, 4);
}

// ---- The choice at a divide ---------------------------------------------------------------------

TEST(CodecAgainstOracle, TheOtherSideAtADivideFails) {
  Random random(8);
  uint32_t divided = 0;
  const auto sample = [&](const OracleMesh& mesh, uint32_t starts) {
    const Comparison comparison(mesh);
    for (uint32_t i = 0; i < starts; ++i) {
      divided += comparison.expectOtherSideDiffers(random.below(comparison.startCount()));
    }
  };
  for (const TestMesh& mesh : {bipyramid(3), bipyramid(4), deepStack(2), icosphere(2)}) {
    sample(toOracle(mesh), 20);
  }
  for (uint32_t i = 0; i < 40; ++i) {
    sample(toOracle(randomStacked(i, 60)), 3);
    sample(toOracle(flippedSphere(random, 60)), 3);
    sample(toOracle(generated(i, 0, i % 21, 1)), 3);
    sample(withHole(withBack(someDisc(random, 30))), 3);
  }
  EXPECT_GT(divided, 300u);
}

// ---- The writer ---------------------------------------------------------------------------------

/// The start that EncodeSettings give reaches the collapse: a payload has the oracle's counts.
TEST(CodecAgainstOracle, PayloadsHaveTheCountsOfTheOracle) {
  Random random(9);
  for (uint32_t i = 0; i < 20; ++i) {
    const TestMesh mesh = generated(i, 0, i, 1);
    SCOPED_TRACE(mesh.name);
    EncodeSettings options;
    options.start_half_edge = random.below(static_cast<uint32_t>(mesh.indices.size()));
    const RoundTrip result = roundTrip(MeshPiece(mesh).view(), options);
    ASSERT_EQ(result.failure, "");
    CodeHistogram counts;
    addTo(counts, encodeByPaper(toOracle(mesh), options.start_half_edge).records);
    expectEqual(counts, result.histogram);
  }
}

// ---- Files --------------------------------------------------------------------------------------

/// Welded triangles of the first primitive of a corpus file. False when the corpus is absent.
bool loadCorners(const std::string& name, std::vector<uint32_t>& corner_class,
                 uint32_t& class_count) {
  std::ifstream file(std::string(MCC_CORPUS_DIR) + "/" + name + ".glb", std::ios::binary);
  if (!file) return false;
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  gltf::Document document;
  const std::span<const uint8_t> view(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  EXPECT_TRUE(gltf::loadDocument(view, nullptr, document).ok());
  const auto& primitive = document.json["meshes"][0]["primitives"][0];
  std::vector<uint32_t> indices;
  EXPECT_TRUE(gltf::readIndices(document, primitive["indices"].get<uint32_t>(), indices).ok());
  gltf::AccessorData positions;
  EXPECT_TRUE(
      gltf::readAccessor(document, primitive["attributes"]["POSITION"].get<uint32_t>(), positions)
          .ok());
  AttributeView attribute;
  attribute.data = positions.data;
  attribute.stride_bytes = positions.stride_bytes;
  const auto wedges = static_cast<uint32_t>(positions.count);
  const PositionClasses classes = weldPositions(attribute, wedges, false);
  const PartView part{indices};
  for (const uint32_t wedge : sortTriangles({&part, 1}, wedges).wedges) {
    corner_class.push_back(classes.class_of_wedge[wedge]);
  }
  class_count = classes.class_count;
  return true;
}

/// The component of a half-edge as a mesh of its own. index_of gets the names of its vertices.
OracleMesh componentOf(const ClosedMesh& mesh, uint32_t& start, std::vector<uint32_t>& index_of) {
  std::vector<uint32_t> faces = {start / 3};
  std::vector<uint32_t> number(mesh.faceCount(), kNone);
  number[start / 3] = 0;
  for (size_t i = 0; i < faces.size(); ++i) {
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t neighbour = mesh.twin[3 * faces[i] + k] / 3;
      if (number[neighbour] != kNone) continue;
      number[neighbour] = static_cast<uint32_t>(faces.size());
      faces.push_back(neighbour);
    }
  }
  const auto numbered = [&](uint32_t h) { return 3 * number[h / 3] + h % 3; };
  OracleMesh result;
  const auto name = [&](bool dummies) {
    for (const uint32_t f : faces) {
      for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        const uint32_t v = mesh.corner_vertex[h];
        if ((v >= mesh.real_vertex_count) == dummies && index_of[v] == kNone) {
          index_of[v] = result.vertex_count++;
        }
      }
    }
  };
  name(false);
  result.first_dummy = result.vertex_count;
  name(true);
  for (const uint32_t f : faces) {
    const uint32_t* v = &mesh.corner_vertex[3 * f];
    result.triangles.push_back({index_of[v[0]], index_of[v[1]], index_of[v[2]]});
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) result.twins.push_back(numbered(mesh.twin[h]));
  }
  start = numbered(start);
  return result;
}

/// All components without handles, from the starts that the writer chooses; a mesh of one such
/// component also from others.
class CorpusAgainstOracle : public testing::TestWithParam<const char*> {};

TEST_P(CorpusAgainstOracle, SameCodes) {
  std::vector<uint32_t> corner_class;
  uint32_t class_count = 0;
  if (!loadCorners(GetParam(), corner_class, class_count)) {
    GTEST_SKIP() << "no " << GetParam() << ".glb in MCC_CORPUS_DIR";
  }
  const ClosedMesh mesh = cutToManifold(corner_class, class_count, kNone).mesh;
  const McRecord record = collapse(mesh);
  const CodeHistogram counts = codedAndDecoded(mesh, record);
  CodeHistogram oracle_counts;
  std::vector<uint32_t> index_of(record.vertex_is_dummy.size(), kNone);
  std::span<const McOperation> rest = record.operations;
  uint32_t spheres = 0;
  for (size_t i = mesh.components.size(); i-- != 0 && !HasFailure();) {
    const auto last =
        std::find_if(rest.begin(), rest.end(), [](const McOperation& op) { return op.finishes; });
    ASSERT_NE(last, rest.end());
    const auto operations = rest.first(static_cast<size_t>(last - rest.begin()) + 1);
    rest = rest.subspan(operations.size());
    if (mesh.components[i].has_handles) continue;
    SCOPED_TRACE("component " + std::to_string(i));
    uint32_t start = mesh.components[i].start_half_edge;
    const OracleMesh component = componentOf(mesh, start, index_of);
    const Records records = encodeByPaper(component, start).records;
    EXPECT_EQ(difference(records, inPaperWords(operations, record, index_of)), "");
    addTo(oracle_counts, records);
    ++spheres;
  }
  EXPECT_TRUE(rest.empty());
  EXPECT_GT(spheres, 0u);
  if (spheres != mesh.components.size()) return;
  expectEqual(oracle_counts, counts);
  if (spheres != 1) return;
  OracleMesh welded;
  welded.vertex_count = class_count;
  for (size_t i = 0; i < corner_class.size(); i += 3) {
    welded.triangles.push_back({corner_class[i], corner_class[i + 1], corner_class[i + 2]});
  }
  Random random(10);
  expectSomeStarts(welded, random, 2);
}

INSTANTIATE_TEST_SUITE_P(Files, CorpusAgainstOracle,
                         testing::Values("a_boat_uv", "a_hammer", "a_koala", "c_human_uvn",
                                         "c_mountain", "c_plane_holes", "d_lionstatue",
                                         "d_manycomp", "e_voxels", "f_cesiumman", "f_clothfolds",
                                         "f_greysnapper", "f_house"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace mcc::test
