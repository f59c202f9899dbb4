// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The oracle on its own, and against a walk over the link of the mc-vertex written for this file.
#include "support/paper_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

namespace mcc::test {
namespace {

using Kind = OracleCode::Kind;
using Triangles = std::vector<std::array<uint32_t, 3>>;

constexpr OracleOptions kValidated = {.validate = true};

// ---- Small meshes -------------------------------------------------------------------------------

class Dice {
 public:
  explicit Dice(uint32_t seed) : engine_(seed) {}
  uint32_t below(uint32_t bound) { return static_cast<uint32_t>(engine_() % bound); }
  uint32_t below(size_t bound) { return below(static_cast<uint32_t>(bound)); }

 private:
  std::mt19937 engine_;
};

OracleMesh meshOf(Triangles triangles) {
  OracleMesh mesh;
  for (const auto& t : triangles) {
    mesh.vertex_count = std::max({mesh.vertex_count, t[0] + 1, t[1] + 1, t[2] + 1});
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

OracleMesh fourFaces() { return meshOf({{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}); }

OracleMesh doublePyramid(uint32_t n) {
  Triangles triangles;
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t a = 2 + i;
    const uint32_t b = 2 + (i + 1) % n;
    triangles.push_back({0, a, b});
    triangles.push_back({1, b, a});
  }
  return meshOf(triangles);
}

OracleMesh inFours(const OracleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  uint32_t count = mesh.vertex_count;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [place, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, count);
    if (is_new) ++count;
    return place->second;
  };
  Triangles triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    const uint32_t ab = middle(a, b);
    const uint32_t bc = middle(b, c);
    const uint32_t ca = middle(c, a);
    triangles.insert(triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return meshOf(triangles);
}

OracleMesh stackedSphere(Dice& dice, uint32_t vertices) {
  OracleMesh mesh = fourFaces();
  while (mesh.vertex_count < vertices) {
    auto& triangle = mesh.triangles[dice.below(mesh.triangles.size())];
    const auto [a, b, c] = triangle;
    const uint32_t v = mesh.vertex_count++;
    triangle = {a, b, v};
    mesh.triangles.push_back({b, c, v});
    mesh.triangles.push_back({c, a, v});
  }
  return mesh;
}

/// n x n quads, n >= 3, each cut the same way.
OracleMesh gridTorus(uint32_t n, uint32_t m) {
  Triangles triangles;
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < m; ++j) {
      const uint32_t a = i * m + j;
      const uint32_t b = (i + 1) % n * m + j;
      const uint32_t c = (i + 1) % n * m + (j + 1) % m;
      const uint32_t d = i * m + (j + 1) % m;
      triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
    }
  }
  return meshOf(triangles);
}

/// The torus of seven vertices, each pair of which is an edge.
OracleMesh sevenVertexTorus() {
  Triangles triangles;
  for (uint32_t i = 0; i < 7; ++i) {
    triangles.push_back({i, (i + 1) % 7, (i + 3) % 7});
    triangles.push_back({i, (i + 3) % 7, (i + 2) % 7});
  }
  return meshOf(triangles);
}

/// The last triangle of `a` and the first of `b` are removed and their edges identified.
OracleMesh connectedSum(const OracleMesh& a, const OracleMesh& b) {
  Triangles triangles(a.triangles.begin(), a.triangles.end() - 1);
  std::vector<uint32_t> name(b.vertex_count, kOracleNone);
  const auto& hole = a.triangles.back();
  const auto& other = b.triangles.front();
  name[other[0]] = hole[0];
  name[other[1]] = hole[2];
  name[other[2]] = hole[1];
  uint32_t count = a.vertex_count;
  for (uint32_t& v : name) {
    if (v == kOracleNone) v = count++;
  }
  for (size_t t = 1; t < b.triangles.size(); ++t) {
    const auto& [x, y, z] = b.triangles[t];
    triangles.push_back({name[x], name[y], name[z]});
  }
  return meshOf(triangles);
}

OracleMesh surfaceOfGenus(uint32_t genus, uint32_t n) {
  OracleMesh mesh = gridTorus(n, n);
  for (uint32_t g = 1; g < genus; ++g) mesh = connectedSum(mesh, gridTorus(n, n));
  return mesh;
}

uint32_t headOf(const OracleMesh& mesh, uint32_t half_edge) {
  return oracleOrigin(mesh, oracleNext(half_edge));
}

bool areNeighbours(const OracleMesh& mesh, uint32_t half_edge_of_a, uint32_t b) {
  uint32_t h = half_edge_of_a;
  do {
    if (headOf(mesh, h) == b) return true;
    h = mesh.twins[oraclePrevious(h)];
  } while (h != half_edge_of_a);
  return false;
}

enum class DoubleEdges : uint8_t { kForbidden, kAllowed };

/// Replaces the edge of half-edge h by the other diagonal. The mesh is closed and has twins. False
/// where that would make a loop or a forbidden double edge.
bool flipEdge(OracleMesh& mesh, uint32_t h, DoubleEdges double_edges) {
  const uint32_t t = mesh.twins[h];
  const uint32_t a = oracleOrigin(mesh, h);
  const uint32_t b = oracleOrigin(mesh, t);
  const uint32_t c = oracleOrigin(mesh, oraclePrevious(h));
  const uint32_t d = oracleOrigin(mesh, oraclePrevious(t));
  if (c == d) return false;
  if (double_edges == DoubleEdges::kForbidden && areNeighbours(mesh, oraclePrevious(h), d)) {
    return false;
  }
  const uint32_t first = h - h % 3;
  const uint32_t second = t - t % 3;
  const std::array<uint32_t, 4> outside = {mesh.twins[oraclePrevious(t)], mesh.twins[oracleNext(h)],
                                           mesh.twins[oracleNext(t)],
                                           mesh.twins[oraclePrevious(h)]};
  mesh.triangles[first / 3] = {d, b, c};
  mesh.triangles[second / 3] = {a, d, c};
  const std::array<uint32_t, 4> inside = {first, first + 1, second, second + 2};
  for (size_t i = 0; i < 4; ++i) {
    mesh.twins[inside[i]] = outside[i];
    mesh.twins[outside[i]] = inside[i];
  }
  mesh.twins[first + 2] = second + 1;
  mesh.twins[second + 1] = first + 2;
  return true;
}

OracleMesh flippedMesh(const OracleMesh& closed, Dice& dice, uint32_t flips,
                       DoubleEdges double_edges = DoubleEdges::kForbidden) {
  OracleMesh mesh = coneHoles(closed);
  for (uint32_t i = 0; i < flips; ++i) flipEdge(mesh, dice.below(mesh.twins.size()), double_edges);
  if (double_edges == DoubleEdges::kForbidden) mesh.twins.clear();
  return mesh;
}

/// Removes vertex stars and triangles that have no vertex in common with each other.
OracleMesh punched(const OracleMesh& mesh, Dice& dice, uint32_t holes) {
  std::set<uint32_t> touched;
  std::set<size_t> removed;
  for (uint32_t tries = 0; holes > 0 && tries < 200; ++tries) {
    const uint32_t v = dice.below(mesh.vertex_count);
    std::set<size_t> star;
    std::set<uint32_t> vertices;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), v) == 0) continue;
      if (tries % 3 == 0 && !star.empty()) break;
      star.insert(t);
      vertices.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
    }
    if (std::any_of(vertices.begin(), vertices.end(),
                    [&](uint32_t x) { return touched.contains(x); }))
      continue;
    touched.merge(vertices);
    removed.merge(star);
    --holes;
  }
  OracleMesh result;
  result.vertex_count = mesh.vertex_count;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!removed.contains(t)) result.triangles.push_back(mesh.triangles[t]);
  }
  return result;
}

/// All labelled simple triangulations of the sphere that flips make of `mesh`.
std::set<Triangles> flipGraph(const OracleMesh& mesh) {
  const auto canonical = [](Triangles triangles) {
    for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  std::set<Triangles> found = {canonical(mesh.triangles)};
  std::vector<Triangles> pending(found.begin(), found.end());
  while (!pending.empty()) {
    const OracleMesh current = coneHoles(meshOf(pending.back()));
    pending.pop_back();
    for (uint32_t h = 0; h < current.twins.size(); ++h) {
      OracleMesh neighbour = current;
      if (!flipEdge(neighbour, h, DoubleEdges::kForbidden)) continue;
      Triangles triangles = canonical(neighbour.triangles);
      if (found.insert(triangles).second) pending.push_back(std::move(triangles));
    }
  }
  return found;
}

std::vector<OracleMesh> allSpheres(uint32_t vertices) {
  Dice dice(1);
  std::vector<OracleMesh> meshes;
  for (const Triangles& triangles : flipGraph(stackedSphere(dice, vertices))) {
    meshes.push_back(meshOf(triangles));
  }
  return meshes;
}

// ---- Checks -------------------------------------------------------------------------------------

Triangles sortedTriangles(Triangles triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Walks both closed meshes together from their start half-edges: names, next and twins agree.
bool sameFrom(const OracleMesh& a, uint32_t start_a, const OracleMesh& b, uint32_t start_b) {
  if (a.twins.size() != b.twins.size()) return false;
  std::vector<uint32_t> partner(a.twins.size(), kOracleNone);
  std::vector<std::pair<uint32_t, uint32_t>> pending = {{start_a, start_b}};
  while (!pending.empty()) {
    const auto [h, g] = pending.back();
    pending.pop_back();
    if (partner[h] == g) continue;
    if (partner[h] != kOracleNone || oracleOrigin(a, h) != oracleOrigin(b, g)) return false;
    partner[h] = g;
    pending.emplace_back(oracleNext(h), oracleNext(g));
    pending.emplace_back(a.twins[h], b.twins[g]);
  }
  return true;
}

struct Counts {
  uint32_t contracts = 0;
  uint32_t divides = 0;
  uint32_t ends = 0;
  uint32_t handles = 0;
};

Counts countCodes(const OracleCoding& coding) {
  Counts counts;
  for (const OracleRecord& record : coding.records) {
    switch (record.code.kind) {
      case Kind::kDegree: ++counts.contracts; break;
      case Kind::kStart: ++counts.divides; break;
      case Kind::kEnd: ++counts.ends; break;
      case Kind::kHandle: ++counts.handles; break;
    }
  }
  return counts;
}

uint32_t usedVertices(const OracleMesh& mesh) {
  std::set<uint32_t> used;
  for (const auto& t : mesh.triangles) used.insert(t.begin(), t.end());
  return static_cast<uint32_t>(used.size());
}

/// Encodes and decodes with holes coned, and checks what the paper says about the numbers of codes.
OracleCoding expectRoundTrip(const OracleMesh& mesh, uint32_t start,
                             const OracleOptions& options = {}, uint32_t genus = 0) {
  SCOPED_TRACE("start " + std::to_string(start));
  OracleCoding coding = encodeByPaper(mesh, start, options);
  const OracleDecoding decoding = decodeByPaper(coding.stacks, options);
  const OracleMesh closed = coneHoles(mesh);
  EXPECT_TRUE(sameFrom(closed, start, decoding.closed, decoding.start));
  const uint32_t vertices = usedVertices(closed);
  const Counts counts = countCodes(coding);
  EXPECT_EQ(counts.contracts + counts.divides, vertices - 3 + 3 * genus);
  EXPECT_EQ(counts.divides, counts.ends - 1 + genus);
  EXPECT_EQ(counts.handles, genus);
  EXPECT_EQ(coding.stacks.vertices.size(), vertices + 2 * genus);
  if (closed.first_dummy >= mesh.vertex_count) {
    EXPECT_EQ(sortedTriangles(decoding.triangles), sortedTriangles(mesh.triangles));
  }
  return coding;
}

std::vector<uint32_t> someStarts(const OracleMesh& closed, Dice& dice, uint32_t count) {
  std::vector<uint32_t> starts;
  for (uint32_t i = 0; i < count; ++i) {
    starts.push_back(dice.below(3 * closed.triangles.size()));
  }
  return starts;
}

std::string listing(const std::vector<OracleRecord>& records) {
  std::string text;
  for (const OracleRecord& record : records) text += toString(record) + " ";
  return text;
}

// ---- The reference walk over the link list ------------------------------------------------------

/// What a codec does that keeps, instead of digons, the cycles of nodes around the copies of the
/// mc-vertex: node a_i has a vertex and the half-edge a_i -> a_(i+1), and moves triangles from
/// outside into the star.
class LinkWalk {
 public:
  explicit LinkWalk(const OracleMesh& closed)
      : mesh_(closed), node_of_gate_(closed.twins.size(), kOracleNone) {}

  std::vector<OracleRecord> run(uint32_t start) {
    top_ = makeStar(start);
    for (;;) {
      step();
      if (top_ == kOracleNone && waiting_.empty()) return records_;
      if (top_ == kOracleNone) {
        top_ = waiting_.back();
        waiting_.pop_back();
      }
    }
  }

 private:
  struct Node {
    uint32_t vertex;
    uint32_t gate;
    uint32_t next;
    uint32_t previous;
  };

  uint32_t makeNode(uint32_t gate) {
    const uint32_t node = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({oracleOrigin(mesh_, gate), gate, node, node});
    node_of_gate_[gate] = node;
    return node;
  }
  void link(uint32_t a, uint32_t b) {
    nodes_[a].next = b;
    nodes_[b].previous = a;
  }
  void setGate(uint32_t node, uint32_t gate) {
    nodes_[node].gate = gate;
    node_of_gate_[gate] = node;
  }
  OracleVertex vertexOf(uint32_t node) const {
    return {nodes_[node].vertex, nodes_[node].vertex >= mesh_.first_dummy};
  }

  /// The triangles around the origin of `start`, counter-clockwise. Returns the node of its target.
  uint32_t makeStar(uint32_t start) {
    const uint32_t first = makeNode(oracleNext(start));
    uint32_t last = first;
    for (uint32_t h = mesh_.twins[oraclePrevious(start)]; h != start;
         h = mesh_.twins[oraclePrevious(h)]) {
      const uint32_t node = makeNode(oracleNext(h));
      link(last, node);
      last = node;
    }
    link(last, first);
    return first;
  }

  void swapLinks(uint32_t p, uint32_t s) {
    const uint32_t after_p = nodes_[p].next;
    const uint32_t after_s = nodes_[s].next;
    link(p, after_s);
    link(s, after_p);
    const uint32_t gate_p = nodes_[p].gate;
    const uint32_t gate_s = nodes_[s].gate;
    setGate(p, gate_s);
    setGate(s, gate_p);
  }

  void step() {
    const uint32_t p = top_;
    const uint32_t a0 = nodes_[p].previous;
    std::vector<uint32_t> gates;
    uint32_t g = nodes_[a0].gate;
    uint32_t s = kOracleNone;
    for (;;) {
      const uint32_t t = mesh_.twins[g];
      s = node_of_gate_[t];
      if (s != kOracleNone) break;
      gates.push_back(oracleNext(t));
      g = oraclePrevious(t);
    }
    OracleRecord record;
    if (s != p) {
      swapLinks(p, s);
      waiting_.push_back(s);
      record.code.kind = Kind::kStart;
      records_.push_back(record);
    }
    if (gates.empty() && nodes_[p].next == nodes_[p].previous) {
      record.code.kind = Kind::kEnd;
      record.vertices = {vertexOf(p), vertexOf(a0)};
      records_.push_back(record);
      top_ = kOracleNone;
      return;
    }
    record.code = {Kind::kDegree, static_cast<uint32_t>(gates.size()) + 3, 0, 0};
    record.vertices[0] = vertexOf(p);
    records_.push_back(record);
    contract(p, a0, gates);
    top_ = a0;
  }

  void contract(uint32_t p, uint32_t a0, const std::vector<uint32_t>& gates) {
    node_of_gate_[nodes_[a0].gate] = kOracleNone;
    node_of_gate_[nodes_[p].gate] = kOracleNone;
    if (gates.empty()) {  // a0 and the node after p are the same vertex
      const uint32_t q = nodes_[p].next;
      setGate(a0, nodes_[q].gate);
      link(a0, nodes_[q].next);
      return;
    }
    const uint32_t after = nodes_[p].next;
    setGate(a0, gates[0]);
    uint32_t last = a0;
    for (size_t i = 1; i < gates.size(); ++i) {
      const uint32_t node = makeNode(gates[i]);
      link(last, node);
      last = node;
    }
    link(last, after);
  }

  const OracleMesh& mesh_;
  std::vector<uint32_t> node_of_gate_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> waiting_;
  uint32_t top_ = kOracleNone;
  std::vector<OracleRecord> records_;
};

std::vector<OracleRecord> walkLink(const OracleMesh& mesh, uint32_t start) {
  const OracleMesh closed = coneHoles(mesh);
  return LinkWalk(closed).run(start);
}

/// The oracle's list is the walk's list.
void expectSameAsWalk(const OracleMesh& mesh, uint32_t start, const OracleCoding& coding) {
  EXPECT_EQ(coding.records, walkLink(mesh, start))
      << "start " << start << "\noracle " << listing(coding.records) << "\nwalk   "
      << listing(walkLink(mesh, start));
}

void expectRoundTripAndWalk(const OracleMesh& mesh, uint32_t start,
                            const OracleOptions& options = {}) {
  expectSameAsWalk(mesh, start, expectRoundTrip(mesh, start, options));
}

void expectAllStarts(const OracleMesh& mesh) {
  const uint32_t half_edges = static_cast<uint32_t>(coneHoles(mesh).twins.size());
  for (uint32_t h = 0; h < half_edges && !testing::Test::HasFailure(); ++h) {
    expectRoundTripAndWalk(mesh, h, kValidated);
  }
}

// ---- Section 4: spheres -------------------------------------------------------------------------

TEST(PaperOracle, TwoTrianglesAreATrivialDigon) {
  OracleMesh mesh = meshOf({{0, 1, 2}, {0, 2, 1}});
  mesh.twins = {5, 4, 3, 2, 1, 0};
  EXPECT_EQ(listing(encodeByPaper(mesh, 0).records), "E(v1 v2) ");
  EXPECT_EQ(listing(encodeByPaper(mesh, 1).records), "E(v2 v0) ");
  expectAllStarts(mesh);
}

TEST(PaperOracle, Tetrahedron) {
  // Around vertex 0: 1, 2, 3 counter-clockwise. After 1 the next mc-edge is 0 -> 3. Opening the
  // mc-edge doubles it: the digon's degree of vertex 1 is 4.
  EXPECT_EQ(listing(encodeByPaper(fourFaces(), 0).records), "4(v1) E(v3 v2) ");
  expectAllStarts(fourFaces());
}

TEST(PaperOracle, Octahedron) {
  // Around vertex 0: 2, 3, 4, 5 counter-clockwise, so the mc-edge goes on from 2 to 5 and 4.
  // Removing 2 moves its edge to vertex 1 over to vertex 0.
  EXPECT_EQ(listing(encodeByPaper(doublePyramid(4), 0).records), "5(v2) 4(v5) 4(v4) E(v3 v1) ");
  expectAllStarts(doublePyramid(4));
}

TEST(PaperOracle, AllTriangulationsUpToSixVertices) {
  EXPECT_EQ(allSpheres(5).size(), 20u);   // 10 labelled triangulations, in two orientations
  EXPECT_EQ(allSpheres(6).size(), 390u);  // 195
  uint32_t divides = 0;
  for (const uint32_t vertices : {5u, 6u}) {
    for (const OracleMesh& mesh : allSpheres(vertices)) {
      expectAllStarts(mesh);
      divides += countCodes(encodeByPaper(mesh, 0)).divides;
    }
  }
  EXPECT_GT(divides, 0u);
}

TEST(PaperOracle, AllTriangulationsOfSevenVertices) {
  const std::vector<OracleMesh> meshes = allSpheres(7);
  EXPECT_EQ(meshes.size(), 11424u);  // 5712 labelled triangulations
  Dice dice(7);
  for (const OracleMesh& mesh : meshes) {
    if (HasFailure()) return;
    expectRoundTripAndWalk(mesh, dice.below(30u), kValidated);
  }
}

TEST(PaperOracle, Icospheres) {
  Dice dice(2);
  OracleMesh mesh = fourFaces();
  for (int level = 0; level < 4; ++level) {
    mesh = inFours(mesh);
    for (const uint32_t h : someStarts(mesh, dice, 20)) expectRoundTripAndWalk(mesh, h);
  }
  OracleMesh round = inFours(inFours(inFours(doublePyramid(5))));
  for (const uint32_t h : someStarts(round, dice, 20)) expectRoundTripAndWalk(round, h);
}

TEST(PaperOracle, RandomStackedSpheres) {
  Dice dice(3);
  for (uint32_t i = 0; i < 60 && !HasFailure(); ++i) {
    const OracleMesh mesh = stackedSphere(dice, 4 + dice.below(80u));
    for (const uint32_t h : someStarts(mesh, dice, 5)) expectRoundTripAndWalk(mesh, h, kValidated);
  }
}

TEST(PaperOracle, RandomlyFlippedSpheres) {
  Dice dice(4);
  uint32_t divides = 0;
  for (uint32_t i = 0; i < 60 && !HasFailure(); ++i) {
    const uint32_t vertices = 6 + dice.below(200u);
    const OracleMesh mesh = flippedMesh(stackedSphere(dice, vertices), dice, 20 * vertices);
    for (const uint32_t h : someStarts(mesh, dice, 5)) {
      const OracleCoding coding = expectRoundTrip(mesh, h);
      expectSameAsWalk(mesh, h, coding);
      divides += countCodes(coding).divides;
    }
  }
  EXPECT_GT(divides, 1000u);
}

TEST(PaperOracle, FlippedSphereOfThousands) {
  Dice dice(5);
  const OracleMesh mesh = flippedMesh(stackedSphere(dice, 3000), dice, 100000);
  for (const uint32_t h : someStarts(mesh, dice, 2)) expectRoundTripAndWalk(mesh, h);
}

/// Several edges between two vertices: digons that are complex at once, or after an operation with
/// d > 1.
TEST(PaperOracle, DoubleEdges) {
  Dice dice(6);
  uint32_t complex_twice = 0;
  for (uint32_t i = 0; i < 150 && !HasFailure(); ++i) {
    const uint32_t vertices = 4 + dice.below(i < 100 ? 6u : 60u);
    const OracleMesh mesh =
        flippedMesh(stackedSphere(dice, vertices), dice, 20 * vertices, DoubleEdges::kAllowed);
    const uint32_t half_edges = static_cast<uint32_t>(mesh.twins.size());
    for (uint32_t h = 0; h < half_edges; h += i < 100 ? 1 : 7) {
      const OracleCoding coding = expectRoundTrip(mesh, h, kValidated);
      expectSameAsWalk(mesh, h, coding);
      for (size_t k = 2; k < coding.records.size(); ++k) {
        complex_twice += coding.records[k].code.kind == Kind::kStart &&
                         coding.records[k - 1].code.kind == Kind::kEnd;
      }
    }
  }
  EXPECT_GT(complex_twice, 100u);
}

TEST(PaperOracle, MarkedDuplicatesAreNotPushed) {
  Dice dice(8);
  const OracleMesh mesh = flippedMesh(stackedSphere(dice, 60), dice, 1000);
  const OracleCoding coding = encodeByPaper(mesh, 0);
  EXPECT_GT(countCodes(coding).divides, 1u);
  EXPECT_EQ(coding.stacks.vertices.front(), (OracleVertex{oracleOrigin(mesh, 0), false}));
  std::set<uint32_t> pushed;
  for (const OracleVertex& vertex : coding.stacks.vertices) {
    EXPECT_TRUE(pushed.insert(vertex.index).second) << vertex.index;
  }
  EXPECT_EQ(pushed.size(), 60u);
  size_t named = 1;
  for (const OracleRecord& record : coding.records) {
    for (const OracleVertex& vertex : record.vertices) named += vertex.index != kOracleNone;
  }
  EXPECT_EQ(named, 60u + countCodes(coding).divides);
}

// ---- The choices of the comparison --------------------------------------------------------------

TEST(PaperOracle, TheOtherSideAtADivideDiffers) {
  Dice dice(9);
  const OracleOptions other = {.side = OracleSide::kOther, .validate = true};
  uint32_t divided = 0;
  uint32_t different = 0;
  for (uint32_t i = 0; i < 40 && !HasFailure(); ++i) {
    const OracleMesh mesh = flippedMesh(stackedSphere(dice, 40), dice, 800);
    for (const uint32_t h : someStarts(mesh, dice, 3)) {
      const OracleCoding coding = expectRoundTrip(mesh, h, other);
      const bool same = coding.records == walkLink(mesh, h);
      if (countCodes(coding).divides == 0) {
        EXPECT_TRUE(same);
        continue;
      }
      ++divided;
      different += !same;
    }
  }
  EXPECT_GT(divided, 90u);
  // The lists are only equal where both digons of each divide have equal codes and vertices.
  EXPECT_EQ(different, divided);
}

TEST(PaperOracle, TheOtherSideRoundTripsWithDoubleEdges) {
  Dice dice(10);
  const OracleOptions other = {.side = OracleSide::kOther, .validate = true};
  for (uint32_t i = 0; i < 40 && !HasFailure(); ++i) {
    const OracleMesh mesh = flippedMesh(stackedSphere(dice, 12), dice, 300, DoubleEdges::kAllowed);
    for (uint32_t h = 0; h < mesh.twins.size(); ++h) expectRoundTrip(mesh, h, other);
  }
}

TEST(PaperOracle, ClockwiseIsTheMirrorImage) {
  Dice dice(11);
  const OracleOptions clockwise = {.turn = OracleTurn::kClockwise, .validate = true};
  uint32_t different = 0;
  for (uint32_t i = 0; i < 40 && !HasFailure(); ++i) {
    const OracleMesh mesh = flippedMesh(stackedSphere(dice, 30), dice, 600);
    OracleMesh mirror = mesh;
    for (auto& t : mirror.triangles) std::swap(t[1], t[2]);
    const OracleMesh closed = coneHoles(mesh);
    for (const uint32_t h : someStarts(mesh, dice, 3)) {
      const OracleCoding coding = expectRoundTrip(mesh, h, clockwise);
      const uint32_t twin = closed.twins[h];
      const uint32_t mirrored = 3 * (twin / 3) + 2 - twin % 3;
      EXPECT_EQ(coding.records, encodeByPaper(mirror, mirrored).records);
      different += coding.records != walkLink(mesh, h);
    }
  }
  EXPECT_GT(different, 100u);
}

// ---- Section 5.1: holes and boundaries ----------------------------------------------------------

TEST(PaperOracle, ConeOfATriangle) {
  const OracleMesh triangle = meshOf({{0, 1, 2}});
  const OracleMesh closed = coneHoles(triangle);
  EXPECT_EQ(closed.triangles, (Triangles{{0, 1, 2}, {1, 0, 3}, {0, 2, 3}, {2, 1, 3}}));
  EXPECT_EQ(closed.first_dummy, 3u);
  EXPECT_EQ(closed.twins, (std::vector<uint32_t>{3, 9, 6, 0, 8, 10, 2, 11, 4, 1, 5, 7}));
  EXPECT_EQ(listing(encodeByPaper(triangle, 0).records), "4(v1) E(v3* v2) ");
  EXPECT_EQ(coneHoles(closed), closed);
  expectAllStarts(triangle);
}

TEST(PaperOracle, SmallMeshesWithHoles) {
  Dice dice(12);
  for (const OracleMesh& mesh : allSpheres(6)) {
    if (HasFailure()) return;
    const OracleMesh open = punched(mesh, dice, 2);
    const auto half_edges = static_cast<uint32_t>(coneHoles(open).twins.size());
    for (uint32_t h = dice.below(3u); h < half_edges; h += 3) {
      expectRoundTripAndWalk(open, h, kValidated);
    }
  }
}

TEST(PaperOracle, RandomMeshesWithHoles) {
  Dice dice(13);
  uint32_t dummies = 0;
  for (uint32_t i = 0; i < 60 && !HasFailure(); ++i) {
    const uint32_t vertices = 20 + dice.below(150u);
    const OracleMesh open = punched(flippedMesh(stackedSphere(dice, vertices), dice, 20 * vertices),
                                    dice, 1 + dice.below(8u));
    const OracleMesh closed = coneHoles(open);
    std::vector<uint32_t> starts = someStarts(closed, dice, 4);
    starts.push_back(static_cast<uint32_t>(closed.twins.size()) - 1);  // dummy -> boundary
    EXPECT_GE(oracleOrigin(closed, starts.back()), closed.first_dummy);
    for (const uint32_t h : starts) {
      const OracleCoding coding = expectRoundTrip(open, h);
      expectSameAsWalk(open, h, coding);
      EXPECT_EQ(encodeByPaper(closed, h).records, coding.records);
      for (const OracleVertex& vertex : coding.stacks.vertices) dummies += vertex.dummy;
    }
  }
  EXPECT_GT(dummies, 500u);
}

/// Discs whose boundary touches much of the mesh: triangles are added at random along the boundary,
/// which also is filled where it turns inward.
OracleMesh randomDisc(Dice& dice, uint32_t triangles) {
  OracleMesh mesh = meshOf({{0, 1, 2}});
  std::vector<uint32_t> boundary = {0, 1, 2};  // counter-clockwise
  std::set<std::pair<uint32_t, uint32_t>> edges = {{0, 1}, {1, 2}, {0, 2}};
  const auto joined = [&](uint32_t a, uint32_t b) {
    return edges.contains({std::min(a, b), std::max(a, b)});
  };
  while (mesh.triangles.size() < triangles) {
    std::rotate(boundary.begin(), boundary.begin() + dice.below(boundary.size()), boundary.end());
    const uint32_t a = boundary[0];
    const uint32_t b = boundary[1];
    if (boundary.size() > 3 && dice.below(2u) == 0 && !joined(a, boundary[2])) {
      mesh.triangles.push_back({b, a, boundary[2]});
      edges.insert({std::min(a, boundary[2]), std::max(a, boundary[2])});
      boundary.erase(boundary.begin() + 1);
      continue;
    }
    const uint32_t v = mesh.vertex_count++;
    mesh.triangles.push_back({b, a, v});
    edges.insert({{a, v}, {b, v}});
    boundary.insert(boundary.begin() + 1, v);
  }
  return mesh;
}

/// With the fan patch from every boundary half-edge.
void expectFanRoundTrips(const OracleMesh& mesh) {
  const OracleOptions fan = {.boundary = OracleBoundary::kFanPatch, .validate = true};
  const OracleMesh closed = coneHoles(mesh);
  const auto first_cone = static_cast<uint32_t>(3 * mesh.triangles.size());
  const uint32_t boundary_edges =
      static_cast<uint32_t>(closed.triangles.size() - mesh.triangles.size());
  for (uint32_t h = 0; h < first_cone; ++h) {
    if (closed.twins[h] < first_cone) {
      EXPECT_THROW(encodeByPaper(mesh, h, fan), std::invalid_argument);
      continue;
    }
    const OracleCoding coding = encodeByPaper(mesh, h, fan);
    ASSERT_TRUE(coding.stacks.fan_edges.has_value());
    EXPECT_EQ(*coding.stacks.fan_edges, boundary_edges - 3);
    const Counts counts = countCodes(coding);
    EXPECT_EQ(counts.contracts + counts.divides, mesh.vertex_count - 3);
    const OracleDecoding decoding = decodeByPaper(coding.stacks, fan);
    EXPECT_EQ(sortedTriangles(decoding.triangles), sortedTriangles(mesh.triangles)) << h;
    EXPECT_EQ(oracleOrigin(decoding.closed, decoding.start), oracleOrigin(mesh, h));
    EXPECT_EQ(headOf(decoding.closed, decoding.start), headOf(mesh, h));
    EXPECT_EQ(decoding.closed.triangles.size(), mesh.triangles.size() + boundary_edges - 2);
  }
}

TEST(PaperOracle, FanPatchOfSmallDiscs) {
  expectFanRoundTrips(meshOf({{0, 1, 2}}));
  expectFanRoundTrips(meshOf({{0, 1, 2}, {0, 2, 3}}));
  expectFanRoundTrips(meshOf({{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}));
  expectFanRoundTrips(meshOf({{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));  // double edges at 0
}

TEST(PaperOracle, FanPatchOfRandomDiscs) {
  Dice dice(14);
  for (uint32_t i = 0; i < 120 && !HasFailure(); ++i) {
    expectFanRoundTrips(randomDisc(dice, 1 + dice.below(60u)));
  }
}

TEST(PaperOracle, FanPatchOfPunchedSpheres) {
  Dice dice(15);
  for (uint32_t i = 0; i < 20 && !HasFailure(); ++i) {
    OracleMesh open = punched(flippedMesh(stackedSphere(dice, 30), dice, 600), dice, 1);
    open.vertex_count = usedVertices(open);
    if (open.vertex_count < 30) {  // one vertex is gone: close the gap in the numbers
      std::vector<uint32_t> names(30, 0);
      for (const auto& t : open.triangles) {
        for (const uint32_t v : t) names[v] = 1;
      }
      uint32_t count = 0;
      for (uint32_t& name : names) name = name == 0 ? kOracleNone : count++;
      for (auto& t : open.triangles) {
        for (uint32_t& v : t) v = names[v];
      }
    }
    expectFanRoundTrips(open);
  }
}

// ---- Section 5.2: handles -----------------------------------------------------------------------

/// Which edge an M named, and during what.
using HandleCases = std::set<std::pair<Kind, uint32_t>>;

void collectCases(const OracleCoding& coding, HandleCases& cases, uint32_t& deepest) {
  Kind operation = Kind::kHandle;
  for (const OracleRecord& record : coding.records) {
    if (record.code.kind == Kind::kHandle) {
      cases.insert({operation, record.code.edge});
      deepest = std::max(deepest, record.code.stack_position);
    } else {
      operation = record.code.kind;
    }
  }
}

TEST(PaperOracle, SevenVertexTorusFromAllStarts) {
  for (uint32_t h = 0; h < 42; ++h) expectRoundTrip(sevenVertexTorus(), h, kValidated, 1);
}

TEST(PaperOracle, SurfacesOfGenusOneToThree) {
  for (const uint32_t genus : {1u, 2u, 3u}) {
    const OracleMesh mesh = surfaceOfGenus(genus, 4);
    const auto half_edges = static_cast<uint32_t>(3 * mesh.triangles.size());
    for (uint32_t h = 0; h < half_edges && !HasFailure(); ++h) {
      expectRoundTrip(mesh, h, kValidated, genus);
    }
  }
}

TEST(PaperOracle, EveryCaseOfAHandleOccurs) {
  Dice dice(16);
  HandleCases cases;
  uint32_t deepest = 0;
  for (uint32_t i = 0; i < 400 && !HasFailure(); ++i) {
    const uint32_t genus = 1 + i % 3;
    const DoubleEdges double_edges = i % 2 == 0 ? DoubleEdges::kForbidden : DoubleEdges::kAllowed;
    const OracleMesh mesh =
        flippedMesh(surfaceOfGenus(genus, 3 + dice.below(3u)), dice, 1000, double_edges);
    for (const uint32_t h : someStarts(mesh, dice, 10)) {
      collectCases(expectRoundTrip(mesh, h, {}, genus), cases, deepest);
    }
  }
  HandleCases all;
  for (uint32_t edge = 0; edge < 6; ++edge) all.insert({Kind::kDegree, edge});
  for (uint32_t edge = 0; edge < 2; ++edge) all.insert({Kind::kStart, edge});
  for (uint32_t edge = 0; edge < 8; ++edge) all.insert({Kind::kEnd, edge});
  for (const auto& [kind, edge] : all) {
    EXPECT_TRUE(cases.contains({kind, edge}))
        << "operation " << static_cast<int>(kind) << " edge " << edge;
  }
  EXPECT_GT(deepest, 1u);
}

TEST(PaperOracle, HandlesWithHolesAndClockwise) {
  Dice dice(17);
  const OracleOptions clockwise = {.turn = OracleTurn::kClockwise, .validate = true};
  for (uint32_t i = 0; i < 40 && !HasFailure(); ++i) {
    const uint32_t genus = 1 + i % 3;
    const OracleMesh open =
        punched(flippedMesh(surfaceOfGenus(genus, 4), dice, 500), dice, 1 + dice.below(3u));
    for (const uint32_t h : someStarts(coneHoles(open), dice, 4)) {
      expectRoundTrip(open, h, kValidated, genus);
      expectRoundTrip(open, h, clockwise, genus);
    }
  }
}

TEST(PaperOracle, ManyHandles) {
  Dice dice(18);
  const OracleMesh mesh = flippedMesh(surfaceOfGenus(25, 5), dice, 20000);
  for (const uint32_t h : someStarts(mesh, dice, 5)) expectRoundTrip(mesh, h, {}, 25);
}

// ---- Arguments and codes that are refused -------------------------------------------------------

TEST(PaperOracle, RefusesOtherMeshes) {
  const auto refuses = [](const OracleMesh& mesh, uint32_t start, const OracleOptions& options) {
    EXPECT_THROW(encodeByPaper(mesh, start, options), std::invalid_argument);
  };
  refuses({}, 0, {});
  refuses(fourFaces(), 12, {});
  refuses(meshOf({{0, 1, 1}}), 0, {});
  refuses(meshOf({{0, 1, 2}, {0, 1, 3}}), 0, {});  // not oriented
  refuses(meshOf({{0, 1, 2}, {3, 4, 5}}), 0, {});  // two components
  refuses(meshOf({{0, 1, 2}, {0, 3, 4}}), 0, {});  // bow-tie
  refuses(sevenVertexTorus(), 0, {.side = OracleSide::kOther});
  refuses(fourFaces(), 0, {.boundary = OracleBoundary::kFanPatch});
}

TEST(PaperOracle, RefusesContradictoryCodes) {
  const OracleStacks good = encodeByPaper(doublePyramid(5), 0).stacks;
  EXPECT_NO_THROW(decodeByPaper(good));
  OracleStacks stacks = good;
  stacks.codes.pop_back();  // no E
  EXPECT_THROW(decodeByPaper(stacks), std::invalid_argument);
  stacks = good;
  stacks.codes.front().degree = 9;
  EXPECT_THROW(decodeByPaper(stacks), std::invalid_argument);
  stacks = good;
  stacks.codes.front().kind = Kind::kStart;
  EXPECT_THROW(decodeByPaper(stacks), std::invalid_argument);
  stacks = good;
  stacks.vertices.pop_back();
  EXPECT_THROW(decodeByPaper(stacks), std::invalid_argument);
  stacks = good;
  stacks.vertices.push_back({9, false});
  EXPECT_THROW(decodeByPaper(stacks), std::invalid_argument);
  EXPECT_THROW(decodeByPaper({}), std::invalid_argument);
}

}  // namespace
}  // namespace mcc::test
