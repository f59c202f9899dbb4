// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "support/mesh_generators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace mcc::test {
namespace {

constexpr uint32_t kNoIndex = 0xffffffffu;

uint32_t addVertex(TestMesh& mesh, double x, double y, double z) {
  mesh.positions.push_back(static_cast<float>(x));
  mesh.positions.push_back(static_cast<float>(y));
  mesh.positions.push_back(static_cast<float>(z));
  return mesh.vertexCount() - 1;
}

/// A vertex of a mesh whose shape does not matter: places on a coarse lattice, a little displaced.
uint32_t addPlacedVertex(TestMesh& mesh) {
  const uint32_t i = mesh.vertexCount();
  Random random(i);
  const float dx = random.unit() * 0.5f;
  const float dy = random.unit() * 0.5f;
  const float dz = random.unit() * 0.5f;
  const uint32_t row = i / 64 % 64;
  const uint32_t layer = i / 4096;
  return addVertex(mesh, static_cast<float>(i % 64) + dx, static_cast<float>(row) + dy,
                   static_cast<float>(layer) + dz);
}

void addTriangle(TestMesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  mesh.indices.push_back(a);
  mesh.indices.push_back(b);
  mesh.indices.push_back(c);
}

/// The quad v[0] .. v[3] with the diagonal 0-2, or 1-3. An array, because braces are evaluated in
/// order.
void addQuad(TestMesh& mesh, const std::array<uint32_t, 4>& v, bool other_diagonal = false) {
  if (other_diagonal) {
    addTriangle(mesh, v[1], v[2], v[3]);
    addTriangle(mesh, v[1], v[3], v[0]);
  } else {
    addTriangle(mesh, v[0], v[1], v[2]);
    addTriangle(mesh, v[0], v[2], v[3]);
  }
}

/// A copy of wedge `source` with all its attributes.
uint32_t addCopy(TestMesh& mesh, uint32_t source) {
  const auto copy = [source](std::vector<float>& values, size_t width) {
    for (size_t k = 0; k < width && !values.empty(); ++k) {
      const float value = values[source * width + k];
      values.push_back(value);
    }
  };
  copy(mesh.positions, 3);
  copy(mesh.normals, 3);
  copy(mesh.texcoords, 2);
  return mesh.vertexCount() - 1;
}

std::array<double, 3> crossOfTriangle(const TestMesh& mesh, uint32_t triangle) {
  std::array<std::array<double, 3>, 3> p{};
  for (size_t k = 0; k < 3; ++k) {
    for (size_t axis = 0; axis < 3; ++axis) {
      p[k][axis] = static_cast<double>(
          mesh.positions[size_t{mesh.indices[triangle * size_t{3} + k]} * 3 + axis]);
    }
  }
  std::array<double, 3> u{};
  std::array<double, 3> v{};
  for (size_t axis = 0; axis < 3; ++axis) {
    u[axis] = p[1][axis] - p[0][axis];
    v[axis] = p[2][axis] - p[0][axis];
  }
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// Unit vector along `v`, +z when it has no length.
std::array<float, 3> unitVector(const std::array<double, 3>& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 0)) return {0.0f, 0.0f, 1.0f};
  return {static_cast<float>(v[0] / length), static_cast<float>(v[1] / length),
          static_cast<float>(v[2] / length)};
}

class UnionFind {
 public:
  explicit UnionFind(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), uint32_t{0});
  }
  uint32_t find(uint32_t x) {
    while (parent_[x] != x) {
      parent_[x] = parent_[parent_[x]];
      x = parent_[x];
    }
    return x;
  }
  void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<uint32_t> parent_;
};

uint64_t directedKey(uint32_t from, uint32_t to) { return uint64_t{from} << 32 | to; }
uint64_t edgeKey(uint32_t a, uint32_t b) { return directedKey(std::min(a, b), std::max(a, b)); }

uint32_t nextCorner(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
uint32_t previousCorner(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// Half-edges (corner h stands for the edge from its vertex to the next) of undegenerate triangles,
/// sorted by undirected edge.
struct EdgeUse {
  uint64_t edge;
  uint32_t half_edge;
};
std::vector<EdgeUse> sortedEdges(const TestMesh& mesh, const std::vector<bool>& degenerate) {
  std::vector<EdgeUse> uses;
  uses.reserve(mesh.indices.size());
  for (uint32_t h = 0; h < mesh.indices.size(); ++h) {
    if (degenerate[h / 3]) continue;
    uses.push_back({edgeKey(mesh.indices[h], mesh.indices[nextCorner(h)]), h});
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.half_edge < b.half_edge;
  });
  return uses;
}

/// Twins of an oriented manifold; kNoIndex at boundaries.
std::vector<uint32_t> twinsOf(const std::vector<uint32_t>& indices) {
  std::unordered_map<uint64_t, uint32_t> open;
  open.reserve(indices.size());
  std::vector<uint32_t> twins(indices.size(), kNoIndex);
  for (uint32_t h = 0; h < indices.size(); ++h) {
    const uint32_t from = indices[h];
    const uint32_t to = indices[nextCorner(h)];
    const auto found = open.find(directedKey(to, from));
    if (found == open.end()) {
      open.emplace(directedKey(from, to), h);
    } else {
      twins[h] = found->second;
      twins[found->second] = h;
      open.erase(found);
    }
  }
  return twins;
}

/// Puts a new vertex into triangle t: t keeps its first edge, two triangles are added at the end.
void splitTriangle(TestMesh& mesh, uint32_t t) {
  const uint32_t v = addPlacedVertex(mesh);
  const size_t first = size_t{t} * 3;
  const uint32_t a = mesh.indices[first];
  const uint32_t b = mesh.indices[first + 1];
  const uint32_t c = mesh.indices[first + 2];
  mesh.indices[first + 2] = v;
  addTriangle(mesh, b, c, v);
  addTriangle(mesh, c, a, v);
}

/// Drops wedges no triangle uses.
void dropUnused(TestMesh& mesh) {
  std::vector<uint32_t> renumbered(mesh.vertexCount(), kNoIndex);
  for (const uint32_t v : mesh.indices) renumbered[v] = 0;
  uint32_t count = 0;
  const auto move = [&count](std::vector<float>& values, size_t width, size_t from) {
    for (size_t k = 0; k < width && !values.empty(); ++k) {
      values[count * width + k] = values[from * width + k];
    }
  };
  for (uint32_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] == kNoIndex) continue;
    move(mesh.positions, 3, v);
    move(mesh.normals, 3, v);
    move(mesh.texcoords, 2, v);
    renumbered[v] = count++;
  }
  mesh.positions.resize(size_t{count} * 3);
  if (!mesh.normals.empty()) mesh.normals.resize(size_t{count} * 3);
  if (!mesh.texcoords.empty()) mesh.texcoords.resize(size_t{count} * 2);
  for (uint32_t& v : mesh.indices) v = renumbered[v];
}

std::string call(const char* name, std::initializer_list<uint64_t> arguments) {
  std::string text = name;
  text += '(';
  for (const uint64_t argument : arguments) {
    if (text.back() != '(') text += ',';
    text += std::to_string(argument);
  }
  return text + ')';
}

}  // namespace

// ---- Random numbers, angles ---------------------------------------------------------------------

uint64_t Random::next() {
  state_ += 0x9e3779b97f4a7c15u;
  uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

uint32_t Random::below(uint32_t bound) {
  return static_cast<uint32_t>((next() >> 32) * bound >> 32);
}

float Random::unit() { return static_cast<float>(next() >> 40) * 0x1p-24f; }

CosSin turn(double turns) {
  const double whole = std::floor(turns * 4 + 0.5);
  const double x = (turns - whole / 4) * 6.283185307179586;  // |x| <= pi / 4
  const double xx = x * x;
  double sin = 0;
  double cos = 0;
  for (int k = 8; k >= 0; --k) {  // Horner's rule on both series
    sin = 1 - sin * xx / ((2 * k + 2) * (2 * k + 3));
    cos = 1 - cos * xx / ((2 * k + 1) * (2 * k + 2));
  }
  sin *= x;
  const double quarter = whole - std::floor(whole / 4) * 4;
  if (quarter == 0) return {cos, sin};
  if (quarter == 1) return {-sin, cos};
  if (quarter == 2) return {-cos, -sin};
  return {sin, -cos};
}

// ---- Measuring ----------------------------------------------------------------------------------

MeshTopology measureTopology(const TestMesh& mesh) {
  MeshTopology result;
  const uint32_t vertices = mesh.vertexCount();
  const uint32_t triangles = mesh.triangleCount();
  std::vector<bool> used(vertices, false);
  std::vector<bool> solid(vertices, false);  // has an undegenerate triangle
  std::vector<uint32_t> degree(vertices, 0);
  std::vector<bool> degenerate(triangles, false);
  std::vector<std::array<uint32_t, 3>> sorted;
  UnionFind pieces(vertices);
  uint32_t faces = 0;
  for (uint32_t t = 0; t < triangles; ++t) {
    std::array<uint32_t, 3> v = {mesh.indices[size_t{t} * 3], mesh.indices[size_t{t} * 3 + 1],
                                 mesh.indices[size_t{t} * 3 + 2]};
    for (const uint32_t u : v) used[u] = true;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
      degenerate[t] = true;
      ++result.degenerate_triangles;
      continue;
    }
    ++faces;
    for (const uint32_t u : v) {
      solid[u] = true;
      result.max_degree = std::max(result.max_degree, ++degree[u]);
      pieces.join(u, v[0]);
    }
    std::sort(v.begin(), v.end());
    sorted.push_back(v);
  }
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] == sorted[i - 1]) ++result.duplicate_triangles;
  }

  UnionFind fans(mesh.indices.size());     // of corners
  UnionFind loops(vertices);               // of boundary vertices
  UnionFind sides(size_t{triangles} * 2);  // 2t: face t as it is, 2t + 1: turned round
  std::vector<bool> on_boundary(vertices, false);
  uint32_t edges = 0;
  const std::vector<EdgeUse> uses = sortedEdges(mesh, degenerate);
  for (size_t first = 0; first < uses.size();) {
    size_t last = first + 1;
    while (last < uses.size() && uses[last].edge == uses[first].edge) ++last;
    ++edges;
    const uint32_t h = uses[first].half_edge;
    const uint32_t from = mesh.indices[h];
    const uint32_t to = mesh.indices[nextCorner(h)];
    for (size_t i = first + 1; i < last; ++i) {
      const uint32_t g = uses[i].half_edge;
      const bool same = mesh.indices[g] == from;
      fans.join(h, same ? g : nextCorner(g));
      fans.join(nextCorner(h), same ? nextCorner(g) : g);
    }
    if (last - first == 1) {
      on_boundary[from] = on_boundary[to] = true;
      loops.join(from, to);
    } else if (last - first > 2) {
      ++result.crowded_edges;
    } else {
      const uint32_t g = uses[first + 1].half_edge;
      const bool same = mesh.indices[g] == from;
      if (same) ++result.inconsistent_edges;
      sides.join(h / 3 * 2, g / 3 * 2 + (same ? 1 : 0));
      sides.join(h / 3 * 2 + 1, g / 3 * 2 + (same ? 0 : 1));
    }
    first = last;
  }

  std::vector<uint32_t> fan_of(vertices, kNoIndex);
  std::vector<bool> pinched(vertices, false);
  for (uint32_t h = 0; h < mesh.indices.size(); ++h) {
    if (degenerate[h / 3]) continue;
    const uint32_t v = mesh.indices[h];
    const uint32_t fan = fans.find(h);
    if (fan_of[v] == kNoIndex) fan_of[v] = fan;
    if (fan_of[v] != fan) pinched[v] = true;
  }
  uint32_t solid_count = 0;
  for (uint32_t v = 0; v < vertices; ++v) {
    ++(used[v] ? result.used_vertices : result.unused_vertices);
    if (!solid[v]) continue;
    ++solid_count;
    if (pieces.find(v) == v) ++result.components;
    if (pinched[v]) ++result.non_manifold_vertices;
    if (on_boundary[v] && loops.find(v) == v) ++result.boundary_loops;
  }
  if (!result.manifold()) {
    result.boundary_loops = 0;
    return result;
  }
  result.orientable = true;
  for (uint32_t t = 0; t < triangles; ++t) {
    if (sides.find(t * 2) == sides.find(t * 2 + 1)) result.orientable = false;
  }
  if (result.orientable) {
    const int64_t euler = int64_t{solid_count} - edges + faces;
    const int64_t handles = (2 * int64_t{result.components} - result.boundary_loops - euler) / 2;
    result.genus = static_cast<uint32_t>(handles);
  }
  return result;
}

bool positionsDiffer(const TestMesh& mesh) {
  std::vector<std::array<uint32_t, 3>> keys(mesh.vertexCount());
  if (keys.empty()) return true;
  std::memcpy(keys.data(), mesh.positions.data(), keys.size() * sizeof(keys[0]));
  std::sort(keys.begin(), keys.end());
  return std::adjacent_find(keys.begin(), keys.end()) == keys.end();
}

// ---- Closed surfaces ----------------------------------------------------------------------------

TestMesh tetrahedron() {
  TestMesh mesh;
  mesh.name = "tetrahedron";
  addVertex(mesh, 1, 1, 1);
  addVertex(mesh, -1, -1, 1);
  addVertex(mesh, -1, 1, -1);
  addVertex(mesh, 1, -1, -1);
  mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return mesh;
}

TestMesh icosphere(uint32_t level) {
  TestMesh mesh;
  const double golden = (1 + std::sqrt(5.0)) / 2;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-golden, golden}) {
      addVertex(mesh, s, t, 0);
      addVertex(mesh, 0, s, t);
      addVertex(mesh, t, 0, s);
    }
  }
  mesh.indices = {0, 2,  1, 0,  1, 6, 0,  8,  2, 0,  6, 4, 0, 4, 8, 1,  2,  7,  1,  5,
                  6, 1,  7, 5,  2, 3, 7,  2,  8, 3,  3, 9, 7, 3, 8, 10, 3,  10, 9,  4,
                  6, 11, 4, 10, 8, 4, 11, 10, 5, 11, 6, 5, 7, 9, 5, 9,  11, 9,  10, 11};
  for (uint32_t i = 0; i <= level; ++i) {
    if (i > 0) mesh = subdivided(std::move(mesh), 1);
    for (size_t v = 0; v < mesh.positions.size(); v += 3) {
      float* p = &mesh.positions[v];
      const std::array<float, 3> unit = unitVector({double{p[0]}, double{p[1]}, double{p[2]}});
      std::copy(unit.begin(), unit.end(), p);
    }
  }
  mesh.normals = mesh.positions;
  mesh.name = call("icosphere", {level});
  return mesh;
}

TestMesh uvSphere(uint32_t segments, uint32_t rings) {
  TestMesh mesh;
  mesh.name = call("uvSphere", {segments, rings});
  addVertex(mesh, 0, 1, 0);
  for (uint32_t r = 1; r < rings; ++r) {
    const CosSin latitude = turn(0.5 * r / rings);
    for (uint32_t s = 0; s < segments; ++s) {
      const CosSin longitude = turn(static_cast<double>(s) / segments);
      addVertex(mesh, latitude.sin * longitude.cos, latitude.cos, -latitude.sin * longitude.sin);
    }
  }
  const uint32_t south = addVertex(mesh, 0, -1, 0);
  const auto at = [segments](uint32_t r, uint32_t s) {
    return 1 + (r - 1) * segments + s % segments;
  };
  for (uint32_t s = 0; s < segments; ++s) addTriangle(mesh, 0, at(1, s), at(1, s + 1));
  for (uint32_t r = 1; r + 1 < rings; ++r) {
    for (uint32_t s = 0; s < segments; ++s) {
      addQuad(mesh, {at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  for (uint32_t s = 0; s < segments; ++s)
    addTriangle(mesh, at(rings - 1, s), south, at(rings - 1, s + 1));
  mesh.normals = mesh.positions;
  return mesh;
}

TestMesh torus(uint32_t major_segments, uint32_t minor_segments) {
  TestMesh mesh;
  mesh.name = call("torus", {major_segments, minor_segments});
  for (uint32_t i = 0; i < major_segments; ++i) {
    const CosSin u = turn(static_cast<double>(i) / major_segments);
    for (uint32_t j = 0; j < minor_segments; ++j) {
      const CosSin v = turn(static_cast<double>(j) / minor_segments);
      const double radius = 1 + 0.4 * v.cos;
      addVertex(mesh, radius * u.cos, 0.4 * v.sin, -radius * u.sin);
      for (const double n : {v.cos * u.cos, v.sin, -v.cos * u.sin}) {
        mesh.normals.push_back(static_cast<float>(n));
      }
    }
  }
  const auto at = [=](uint32_t i, uint32_t j) {
    return i % major_segments * minor_segments + j % minor_segments;
  };
  for (uint32_t i = 0; i < major_segments; ++i) {
    for (uint32_t j = 0; j < minor_segments; ++j) {
      addQuad(mesh, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TestMesh plateWithTunnels(uint32_t genus, uint32_t fineness) {
  const uint32_t f = fineness;
  TestMesh mesh =
      voxelSurface((2 * genus + 1) * f, 3 * f, (f + 1) / 2,
                   [f](uint32_t x, uint32_t y, uint32_t) { return x / f % 2 == 0 || y / f != 1; });
  mesh.name = call("plateWithTunnels", {genus, fineness});
  return mesh;
}

TestMesh bipyramid(uint32_t n) {
  TestMesh mesh;
  mesh.name = call("bipyramid", {n});
  for (uint32_t i = 0; i < n; ++i) {
    const CosSin a = turn(static_cast<double>(i) / n);
    addVertex(mesh, a.cos, a.sin, 0);
  }
  const uint32_t top = addVertex(mesh, 0, 0, 1);
  const uint32_t bottom = addVertex(mesh, 0, 0, -1);
  for (uint32_t i = 0; i < n; ++i) {
    addTriangle(mesh, top, i, (i + 1) % n);
    addTriangle(mesh, bottom, (i + 1) % n, i);
  }
  return mesh;
}

TestMesh deepStack(uint32_t depth) {
  TestMesh mesh = tetrahedron();
  for (uint32_t i = 0; i < depth; ++i) splitTriangle(mesh, mesh.triangleCount() - 1);
  mesh.name = call("deepStack", {depth});
  return mesh;
}

TestMesh randomStacked(uint64_t seed, uint32_t n) {
  TestMesh mesh = tetrahedron();
  Random random(seed);
  for (uint32_t i = 0; i < n; ++i) splitTriangle(mesh, random.below(mesh.triangleCount()));
  mesh.name = call("randomStacked", {seed, n});
  return mesh;
}

TestMesh combOfStacks(uint32_t teeth, uint32_t depth) {
  TestMesh mesh = translated(bipyramid(teeth), -2, 0, 0);
  for (uint32_t tooth = 0; tooth < teeth; ++tooth) {
    uint32_t triangle = tooth * 2;
    for (uint32_t i = 0; i < depth; ++i) {
      splitTriangle(mesh, triangle);
      triangle = mesh.triangleCount() - 1;
    }
  }
  mesh.name = call("combOfStacks", {teeth, depth});
  return mesh;
}

TestMesh mengerSponge(uint32_t level) {
  uint32_t n = 1;
  for (uint32_t i = 0; i < level; ++i) n *= 3;
  TestMesh mesh = voxelSurface(n, n, n, [n](uint32_t x, uint32_t y, uint32_t z) {
    for (uint32_t size = n; size > 1; size /= 3) {
      const uint32_t third = size / 3;
      const auto middle = [=](uint32_t c) { return c % size / third == 1 ? 1 : 0; };
      if (middle(x) + middle(y) + middle(z) >= 2) return false;
    }
    return true;
  });
  mesh.name = call("mengerSponge", {level});
  return mesh;
}

namespace {

/// Six tetrahedra a cube, each from its first corner to its last along another order of the axes.
class MarchingTetrahedra {
 public:
  MarchingTetrahedra(uint32_t n, const std::function<double(double, double, double)>& field)
      : n_(n) {
    for (uint32_t i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i) {
      double at[3];
      place(i, at);
      value_.push_back(field(at[0], at[1], at[2]));
    }
  }

  TestMesh run() {
    constexpr uint32_t kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                        {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const uint32_t stride[3] = {1, n_ + 1, (n_ + 1) * (n_ + 1)};
    for (uint32_t cell = 0; cell < n_ * n_ * n_; ++cell) {
      const uint32_t first =
          cell % n_ * stride[0] + cell / n_ % n_ * stride[1] + cell / n_ / n_ * stride[2];
      for (uint32_t o = 0; o < 6; ++o) {
        uint32_t corner[4] = {first, 0, 0, 0};
        for (uint32_t i = 0; i < 3; ++i) corner[i + 1] = corner[i] + stride[kOrders[o][i]];
        cut(corner, o >= 3);
      }
    }
    mesh_.name = call("isosurface", {n_});
    return std::move(mesh_);
  }

 private:
  void place(uint32_t corner, double* at) const {
    const uint32_t k[3] = {corner % (n_ + 1), corner / (n_ + 1) % (n_ + 1),
                           corner / (n_ + 1) / (n_ + 1)};
    for (uint32_t s = 0; s < 3; ++s) at[s] = 2.0 * k[s] / n_ - 1;
  }
  bool isInside(uint32_t corner) const { return value_[corner] < 0; }

  uint32_t vertexBetween(uint32_t a, uint32_t b) {
    if (a > b) std::swap(a, b);
    const auto [entry, is_new] = vertices_.try_emplace({a, b}, mesh_.vertexCount());
    if (is_new) {
      double from[3];
      double to[3];
      place(a, from);
      place(b, to);
      const double t = value_[a] / (value_[a] - value_[b]);
      for (uint32_t s = 0; s < 3; ++s) from[s] += t * (to[s] - from[s]);
      addVertex(mesh_, from[0], from[1], from[2]);
    }
    return entry->second;
  }

  /// What is inside of one tetrahedron: a corner, an edge or a face.
  void cut(const uint32_t* corner, bool mirrored) {
    uint32_t inside[4];
    uint32_t outside[4];
    uint32_t in = 0;
    uint32_t out = 0;
    bool odd = mirrored;  // the permutation that puts the inner corners first
    for (uint32_t i = 0; i < 4; ++i) {
      if (isInside(corner[i])) {
        odd ^= out % 2 != 0;
        inside[in++] = corner[i];
      } else {
        outside[out++] = corner[i];
      }
    }
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
      if (odd) std::swap(b, c);
      addTriangle(mesh_, a, b, c);
    };
    const auto between = [&](uint32_t i, uint32_t o) {
      return vertexBetween(inside[i], outside[o]);
    };
    if (in == 1) add(between(0, 0), between(0, 1), between(0, 2));
    if (in == 3) add(between(0, 0), between(1, 0), between(2, 0));
    if (in == 2) {
      const uint32_t quad[4] = {between(0, 0), between(0, 1), between(1, 1), between(1, 0)};
      add(quad[0], quad[1], quad[2]);
      add(quad[0], quad[2], quad[3]);
    }
  }

  uint32_t n_;
  std::vector<double> value_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> vertices_;
  TestMesh mesh_;
};

}  // namespace

TestMesh isosurface(uint32_t n, const std::function<double(double, double, double)>& field) {
  return MarchingTetrahedra(n, field).run();
}

TestMesh voxelSurface(uint32_t nx, uint32_t ny, uint32_t nz,
                      const std::function<bool(uint32_t, uint32_t, uint32_t)>& filled) {
  TestMesh mesh;
  mesh.name = call("voxelSurface", {nx, ny, nz});
  std::vector<uint32_t> vertex_at(size_t{nx + 1} * (ny + 1) * (nz + 1), kNoIndex);
  const auto vertex = [&](uint32_t x, uint32_t y, uint32_t z) {
    uint32_t& v = vertex_at[(size_t{z} * (ny + 1) + y) * (nx + 1) + x];
    if (v == kNoIndex) v = addVertex(mesh, x, y, z);
    return v;
  };
  const auto empty = [&](uint32_t x, uint32_t y, uint32_t z) {  // 0 - 1 wraps and is outside too
    return x >= nx || y >= ny || z >= nz || !filled(x, y, z);
  };
  for (uint32_t z = 0; z < nz; ++z) {
    for (uint32_t y = 0; y < ny; ++y) {
      for (uint32_t x = 0; x < nx; ++x) {
        if (!filled(x, y, z)) continue;
        const auto at = [&](uint32_t dx, uint32_t dy, uint32_t dz) {
          return vertex(x + dx, y + dy, z + dz);
        };
        if (empty(x - 1, y, z)) addQuad(mesh, {at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)});
        if (empty(x + 1, y, z)) addQuad(mesh, {at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)});
        if (empty(x, y - 1, z)) addQuad(mesh, {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)});
        if (empty(x, y + 1, z)) addQuad(mesh, {at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)});
        if (empty(x, y, z - 1)) addQuad(mesh, {at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)});
        if (empty(x, y, z + 1)) addQuad(mesh, {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
      }
    }
  }
  return mesh;
}

// ---- Surfaces with boundaries -------------------------------------------------------------------

TestMesh grid(uint32_t w, uint32_t h, QuadSplit split, uint64_t seed) {
  TestMesh mesh;
  mesh.name = call("grid", {w, h, static_cast<uint64_t>(split), seed});
  Random random(seed);
  for (uint32_t y = 0; y <= h; ++y) {
    for (uint32_t x = 0; x <= w; ++x) {
      addVertex(mesh, x, y, 0.5 * turn(x / 24.0).sin + 0.5 * turn(y / 36.0).cos);
    }
  }
  for (uint32_t y = 0; y < h; ++y) {
    for (uint32_t x = 0; x < w; ++x) {
      const uint32_t a = y * (w + 1) + x;
      bool other = false;
      switch (split) {
        case QuadSplit::kSame: break;
        case QuadSplit::kAlternate: other = (x + y) % 2 != 0; break;
        case QuadSplit::kRows: other = y % 2 != 0; break;
        case QuadSplit::kRandom: other = random.chance(50); break;
      }
      addQuad(mesh, {a, a + 1, a + w + 2, a + w + 1}, other);
    }
  }
  return mesh;
}

TestMesh sheetWithHoles(uint32_t k, uint64_t seed) {
  uint32_t size = 3;
  while ((size - 1) * (size - 1) < 4 * k) ++size;
  for (;; size += 1 + size / 4) {
    TestMesh mesh = grid(size, size, QuadSplit::kRandom, seed);
    if (punchHoles(mesh, seed, k) < k) continue;
    mesh.name = call("sheetWithHoles", {k, seed});
    return mesh;
  }
}

TestMesh openFan(uint32_t n) {
  TestMesh mesh;
  mesh.name = call("openFan", {n});
  addVertex(mesh, 0, 0, 0);
  for (uint32_t i = 0; i <= n; ++i) {
    const CosSin a = turn(0.9 * i / n);
    addVertex(mesh, a.cos, a.sin, 0);
  }
  for (uint32_t i = 1; i <= n; ++i) addTriangle(mesh, 0, i, i + 1);
  return mesh;
}

TestMesh looseTriangles(uint32_t n) {
  TestMesh mesh;
  mesh.name = call("looseTriangles", {n});
  for (uint32_t i = 0; i < n; ++i) {
    for (int corner = 0; corner < 3; ++corner) mesh.indices.push_back(addPlacedVertex(mesh));
  }
  return mesh;
}

namespace {

/// One component with `genus` handles and `holes` boundary loops; `big` allows more triangles.
TestMesh generatedPiece(Random& random, uint32_t genus, uint32_t holes, bool big) {
  TestMesh mesh;
  if (genus == 0 && holes == 0) {
    const uint64_t inner_seed = random.next();
    const uint32_t size = random.between(1, 12);
    switch (random.below(big ? 6 : 4)) {
      case 0: mesh = tetrahedron(); break;
      case 1: mesh = bipyramid(2 + size); break;
      case 2: mesh = randomStacked(inner_seed, size); break;
      case 3: mesh = plateWithTunnels(0, 1); break;
      case 4: mesh = uvSphere(2 + size, 2 + size / 2); break;
      default: mesh = icosphere(1 + size % 2); break;
    }
  } else if (genus == 0 && random.chance(50)) {
    mesh = sheetWithHoles(holes - 1, random.next());
  } else if (genus == 1 && holes == 0 && random.chance(50)) {
    const uint32_t size = random.between(3, 16);
    mesh = torus(size, 3 + size / 2);
  } else {
    uint32_t fineness = big ? random.between(1, 3) : 1;
    const uint64_t seed = random.next();
    do {
      mesh = plateWithTunnels(genus, fineness++);
    } while (punchHoles(mesh, seed, holes) < holes);
  }
  mesh.normals.clear();
  const uint64_t flips = uint64_t{mesh.triangleCount()} * random.below(4) / 3;
  mesh = flipped(std::move(mesh), random.next(), flips);
  return jittered(std::move(mesh), random.next(), 0.03125f);
}

}  // namespace

TestMesh generated(uint64_t seed, uint32_t genus, uint32_t holes, uint32_t components) {
  Random random(seed);
  std::vector<uint32_t> genus_of(components, 0);
  std::vector<uint32_t> holes_of(components, 0);
  const uint32_t spread = std::min(components, random.between(1, 6));
  for (uint32_t i = 0; i < genus; ++i) ++genus_of[random.below(spread)];
  for (uint32_t i = 0; i < holes; ++i) ++holes_of[random.below(spread)];
  std::vector<TestMesh> pieces;
  for (uint32_t i = 0; i < components; ++i) {
    TestMesh piece = generatedPiece(random, genus_of[i], holes_of[i], components <= 20);
    const uint32_t row = i / 8 % 8;
    const uint32_t layer = i / 64;
    pieces.push_back(translated(std::move(piece), static_cast<float>(i % 8) * 64,
                                static_cast<float>(row) * 64, static_cast<float>(layer) * 64));
  }
  TestMesh mesh = shuffled(unionOf(pieces, ""), random.next());
  mesh.name = call("generated", {seed, genus, holes, components});
  return mesh;
}

// ---- Not manifold or not orientable -------------------------------------------------------------

TestMesh moebius(uint32_t n, uint32_t m) {
  TestMesh mesh;
  mesh.name = call("moebius", {n, m});
  for (uint32_t i = 0; i < n; ++i) {
    const CosSin u = turn(static_cast<double>(i) / n);
    const CosSin half = turn(0.5 * i / n);
    for (uint32_t j = 0; j <= m; ++j) {
      const double s = 0.8 * j / m - 0.4;
      addVertex(mesh, (1 + s * half.cos) * u.cos, s * half.sin, -(1 + s * half.cos) * u.sin);
    }
  }
  const auto at = [=](uint32_t i, uint32_t j) { return i < n ? i * (m + 1) + j : m - j; };
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < m; ++j) {
      addQuad(mesh, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TestMesh kleinBottle(uint32_t n, uint32_t m) {
  TestMesh mesh;
  mesh.name = call("kleinBottle", {n, m});
  for (uint32_t i = 0; i < n; ++i) {
    const CosSin u = turn(static_cast<double>(i) / n);
    const CosSin half = turn(0.5 * i / n);
    for (uint32_t j = 0; j < m; ++j) {
      const double v = (j + 0.5) / m;
      const double s1 = turn(v).sin;
      const double s2 = turn(2 * v).sin;
      const double radius = 2 + half.cos * s1 - half.sin * s2;
      addVertex(mesh, radius * u.cos, radius * u.sin, half.sin * s1 + half.cos * s2);
    }
  }
  const auto at = [=](uint32_t i, uint32_t j) {
    const uint32_t k = j % m;
    return i < n ? i * m + k : m - 1 - k;
  };
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < m; ++j) {
      addQuad(mesh, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TestMesh bowTies(uint32_t count, uint32_t fans, uint32_t blades) {
  TestMesh mesh;
  mesh.name = call("bowTies", {count, fans, blades});
  for (uint32_t i = 0; i < count; ++i) {
    const double x = 3.0 * i;
    const uint32_t knot = addVertex(mesh, x, 0, 0);
    for (uint32_t fan = 0; fan < fans; ++fan) {
      for (uint32_t b = 0; b <= blades; ++b) {
        const CosSin a = turn((fan + 0.7 * b / blades) / fans);
        const uint32_t v = addVertex(mesh, x + a.cos, a.sin, 0);
        if (b > 0) addTriangle(mesh, knot, v - 1, v);
      }
    }
  }
  return mesh;
}

TestMesh pinchedSpheres(uint32_t count) {
  TestMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const TestMesh sphere = uvSphere(5 + i % 3, 4);
    const uint32_t south = sphere.vertexCount() - 1;
    const uint32_t base = mesh.vertexCount();
    const double y = -2.0 * i;
    // The north pole of every sphere but the first is the south pole of the one before.
    for (uint32_t v = i > 0 ? 1 : 0; v <= south; ++v) {
      const float* p = &sphere.positions[size_t{v} * 3];
      addVertex(mesh, double{p[0]}, double{p[1]} + y, double{p[2]});
    }
    for (const uint32_t v : sphere.indices) mesh.indices.push_back(i == 0 ? v : base + v - 1);
  }
  mesh.name = call("pinchedSpheres", {count});
  return mesh;
}

TestMesh book(uint32_t pages, uint32_t length, uint32_t width) {
  TestMesh mesh;
  mesh.name = call("book", {pages, length, width});
  for (uint32_t y = 0; y <= length; ++y) addVertex(mesh, 0, y, 0);
  for (uint32_t page = 0; page < pages; ++page) {
    const CosSin a = turn(static_cast<double>(page) / pages);
    const uint32_t base = mesh.vertexCount();
    for (uint32_t x = 1; x <= width; ++x) {
      for (uint32_t y = 0; y <= length; ++y) addVertex(mesh, x * a.cos, y, x * a.sin);
    }
    const auto at = [=](uint32_t x, uint32_t y) {
      return x == 0 ? y : base + (x - 1) * (length + 1) + y;
    };
    for (uint32_t x = 0; x < width; ++x) {
      for (uint32_t y = 0; y < length; ++y) {
        addQuad(mesh, {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
      }
    }
  }
  return mesh;
}

TestMesh fins(uint32_t n) {
  TestMesh mesh = grid(n, n);
  for (uint32_t y = 1; y < n; y += 2) {
    const uint32_t low = y * (n + 1);
    const uint32_t high = mesh.vertexCount();
    for (uint32_t x = 0; x <= n; ++x) addVertex(mesh, x, y, 3);
    for (uint32_t x = 0; x < n; ++x) addQuad(mesh, {low + x, low + x + 1, high + x + 1, high + x});
  }
  mesh.name = call("fins", {n});
  return mesh;
}

TestMesh randomVoxels(uint64_t seed, uint32_t n, uint32_t percent) {
  Random random(seed);
  std::vector<bool> cells(size_t{n} * n * n);
  for (size_t i = 0; i < cells.size(); ++i) cells[i] = random.chance(percent);
  TestMesh mesh = voxelSurface(n, n, n, [&](uint32_t x, uint32_t y, uint32_t z) {
    return cells[(size_t{z} * n + y) * n + x];
  });
  mesh.name = call("randomVoxels", {seed, n, percent});
  return mesh;
}

namespace {

/// The corners of n^3 cells: corner c of a cell is one step along the axes of its bits (x, y, z).
TestMesh latticePoints(uint32_t n) {
  TestMesh mesh;
  for (uint32_t z = 0; z <= n; ++z) {
    for (uint32_t y = 0; y <= n; ++y) {
      for (uint32_t x = 0; x <= n; ++x) addVertex(mesh, x, y, z);
    }
  }
  return mesh;
}

/// Calls visit(corners) for every cell, x first.
template <class Visit>
void forCells(uint32_t n, Visit visit) {
  for (uint32_t z = 0; z < n; ++z) {
    for (uint32_t y = 0; y < n; ++y) {
      for (uint32_t x = 0; x < n; ++x) {
        uint32_t corners[8];
        for (uint32_t c = 0; c < 8; ++c)
          corners[c] = ((z + (c >> 2)) * (n + 1) + y + (c >> 1 & 1)) * (n + 1) + x + (c & 1);
        visit(corners);
      }
    }
  }
}

/// Calls visit(a, b, c, d) for the six tetrahedra of every cell, which are the six ways to walk the
/// axes one after the other from corner 0 to corner 7.
template <class Visit>
void forTetrahedra(uint32_t n, Visit visit) {
  constexpr uint32_t kPaths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
  forCells(n, [&](const uint32_t* corners) {
    for (const auto& path : kPaths)
      visit(corners[0], corners[path[0]], corners[path[1]], corners[7]);
  });
}

void addWall(TestMesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  addTriangle(mesh, a, b, c);
  addTriangle(mesh, a, c, d);
}

}  // namespace

TestMesh tetrahedralSoup(uint32_t n) {
  TestMesh mesh = latticePoints(n);
  mesh.name = call("tetrahedralSoup", {n});
  forTetrahedra(n, [&mesh](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    addTriangle(mesh, a, c, b);
    addTriangle(mesh, a, b, d);
    addTriangle(mesh, b, c, d);
    addTriangle(mesh, a, d, c);
  });
  return mesh;
}

TestMesh tetrahedraAsQuads(uint64_t seed, uint32_t n) {
  TestMesh mesh = latticePoints(n);
  mesh.name = call("tetrahedraAsQuads", {seed, n});
  Random random(seed);
  forTetrahedra(n, [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    uint32_t quad[4] = {a, b, c, d};
    for (uint32_t i = 3; i != 0; --i) std::swap(quad[i], quad[random.below(i + 1)]);
    addWall(mesh, quad[0], quad[1], quad[2], quad[3]);
  });
  return mesh;
}

TestMesh stackedCubes(uint64_t seed, uint32_t n, uint32_t percent) {
  TestMesh mesh = latticePoints(n);
  mesh.name = call("stackedCubes", {seed, n, percent});
  Random random(seed);
  forCells(n, [&](const uint32_t* c) {
    if (!random.chance(percent)) return;
    addWall(mesh, c[0], c[2], c[3], c[1]);
    addWall(mesh, c[4], c[5], c[7], c[6]);
    addWall(mesh, c[0], c[1], c[5], c[4]);
    addWall(mesh, c[1], c[3], c[7], c[5]);
    addWall(mesh, c[3], c[2], c[6], c[7]);
    addWall(mesh, c[2], c[0], c[4], c[6]);
  });
  return mesh;
}

TestMesh cellWalls(uint32_t n) {
  TestMesh mesh = latticePoints(n);
  mesh.name = call("cellWalls", {n});
  uint32_t cell = 0;
  forCells(n, [&](const uint32_t* c) {
    const bool is_last[3] = {cell % n == n - 1, cell / n % n == n - 1, cell / n / n == n - 1};
    ++cell;
    addWall(mesh, c[0], c[1], c[3], c[2]);
    addWall(mesh, c[0], c[4], c[5], c[1]);
    addWall(mesh, c[0], c[2], c[6], c[4]);
    if (is_last[0]) addWall(mesh, c[1], c[3], c[7], c[5]);
    if (is_last[1]) addWall(mesh, c[2], c[6], c[7], c[3]);
    if (is_last[2]) addWall(mesh, c[4], c[5], c[7], c[6]);
  });
  return mesh;
}

TestMesh soup(uint64_t seed, uint32_t triangles, uint32_t vertices, const SoupOptions& options) {
  TestMesh mesh;
  Random random(seed);
  for (uint32_t v = 0; v < vertices; ++v) {
    if (v > 0 && random.chance(options.shared_position_percent)) {
      addCopy(mesh, random.below(v));
    } else {
      for (int axis = 0; axis < 3; ++axis) mesh.positions.push_back(random.unit());
    }
  }
  for (uint32_t t = 0; t < triangles; ++t) {
    if (random.chance(options.degenerate_percent)) {
      const uint32_t a = random.below(vertices);
      std::array<uint32_t, 3> corners = {a, a, random.chance(12) ? a : random.below(vertices)};
      std::rotate(corners.begin(), corners.begin() + random.below(3), corners.end());
      addTriangle(mesh, corners[0], corners[1], corners[2]);
      continue;
    }
    const uint32_t choice = random.below(100);
    if (t > 0 && choice < options.duplicate_percent + options.opposite_percent) {
      const size_t first = size_t{random.below(t)} * 3;
      const uint32_t turned = random.below(3);
      const uint32_t a = mesh.indices[first + turned];
      const uint32_t b = mesh.indices[first + (turned + 1) % 3];
      const uint32_t c = mesh.indices[first + (turned + 2) % 3];
      if (choice < options.duplicate_percent) {
        addTriangle(mesh, a, b, c);
      } else {
        addTriangle(mesh, b, a, c);
      }
      continue;
    }
    const uint32_t a = random.below(vertices);
    uint32_t b = random.below(vertices);
    while (b == a) b = random.below(vertices);
    uint32_t c = random.below(vertices);
    while (c == a || c == b) c = random.below(vertices);
    addTriangle(mesh, a, b, c);
  }
  mesh.name = call(
      "soup", {seed, triangles, vertices, options.degenerate_percent, options.duplicate_percent,
               options.opposite_percent, options.shared_position_percent});
  return mesh;
}

TestMesh randomSoup(uint64_t seed) {
  Random random(seed);
  // Small counts as often as large ones.
  const uint32_t triangles = 3 + random.below(random.chance(50) ? 30 : 2998);
  const uint32_t vertices = 3 + random.below(random.chance(50) ? 20 : 298);
  SoupOptions options;
  if (random.chance(50)) options.degenerate_percent = random.below(31);
  if (random.chance(50)) options.duplicate_percent = random.below(31);
  if (random.chance(50)) options.opposite_percent = random.below(31);
  if (random.chance(50)) options.shared_position_percent = random.below(51);
  TestMesh mesh = soup(random.next(), triangles, vertices, options);
  mesh.name = call("randomSoup", {seed});
  return mesh;
}

// ---- Changes ------------------------------------------------------------------------------------

TestMesh unionOf(std::span<const TestMesh> meshes, const std::string& name) {
  TestMesh result;
  result.name = name;
  bool all_normals = true;
  bool all_texcoords = true;
  for (const TestMesh& mesh : meshes) {
    const uint32_t base = result.vertexCount();
    for (const uint32_t v : mesh.indices) result.indices.push_back(base + v);
    result.positions.insert(result.positions.end(), mesh.positions.begin(), mesh.positions.end());
    result.normals.insert(result.normals.end(), mesh.normals.begin(), mesh.normals.end());
    result.texcoords.insert(result.texcoords.end(), mesh.texcoords.begin(), mesh.texcoords.end());
    all_normals = all_normals && !mesh.normals.empty();
    all_texcoords = all_texcoords && !mesh.texcoords.empty();
  }
  if (!all_normals) result.normals.clear();
  if (!all_texcoords) result.texcoords.clear();
  return result;
}

TestMesh shuffled(TestMesh mesh, uint64_t seed) {
  Random random(seed);
  const uint32_t vertices = mesh.vertexCount();
  const uint32_t triangles = mesh.triangleCount();
  const auto permutation = [&random](uint32_t count) {
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), uint32_t{0});
    for (uint32_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
  };
  const std::vector<uint32_t> new_vertex = permutation(vertices);
  const std::vector<uint32_t> new_triangle = permutation(triangles);
  const auto move = [&](std::vector<float>& values, size_t width) {
    if (values.empty()) return;
    std::vector<float> moved(values.size());
    for (size_t v = 0; v < vertices; ++v) {
      for (size_t k = 0; k < width; ++k) moved[new_vertex[v] * width + k] = values[v * width + k];
    }
    values = std::move(moved);
  };
  move(mesh.positions, 3);
  move(mesh.normals, 3);
  move(mesh.texcoords, 2);
  std::vector<uint32_t> indices(mesh.indices.size());
  for (size_t t = 0; t < triangles; ++t) {
    const uint32_t turned = random.below(3);
    for (uint32_t k = 0; k < 3; ++k) {
      indices[size_t{new_triangle[t]} * 3 + k] = new_vertex[mesh.indices[t * 3 + (k + turned) % 3]];
    }
  }
  mesh.indices = std::move(indices);
  mesh.name = "shuffled " + mesh.name;
  return mesh;
}

TestMesh flipped(TestMesh mesh, uint64_t seed, uint64_t flips) {
  Random random(seed);
  std::vector<uint32_t>& indices = mesh.indices;
  std::vector<uint32_t> twins = twinsOf(indices);
  std::unordered_set<uint64_t> edges;
  edges.reserve(indices.size());
  for (uint32_t h = 0; h < indices.size(); ++h) {
    edges.insert(edgeKey(indices[h], indices[nextCorner(h)]));
  }
  const auto link = [&twins](uint32_t h, uint32_t t) {
    twins[h] = t;
    if (t != kNoIndex) twins[t] = h;
  };
  //     c              c
  //   / h \          / | \      h: a -> b in the triangle a b c
  //  a --- b   ->   a  |  b     t: b -> a in the triangle b a d
  //   \ t /          \ | /
  //     d              d
  uint64_t done = 0;
  for (uint64_t trial = 0; trial < flips * 4 && done < flips; ++trial) {
    const uint32_t h = random.below(static_cast<uint32_t>(indices.size()));
    const uint32_t t = twins[h];
    if (t == kNoIndex) continue;
    const uint32_t a = indices[h];
    const uint32_t b = indices[t];
    const uint32_t c = indices[previousCorner(h)];
    const uint32_t d = indices[previousCorner(t)];
    if (c == d || edges.count(edgeKey(c, d)) != 0) continue;
    edges.erase(edgeKey(a, b));
    edges.insert(edgeKey(c, d));
    const uint32_t bc = twins[nextCorner(h)];
    const uint32_t ca = twins[previousCorner(h)];
    const uint32_t ad = twins[nextCorner(t)];
    const uint32_t db = twins[previousCorner(t)];
    const uint32_t first = h / 3 * 3;
    const uint32_t second = t / 3 * 3;
    indices[first] = a, indices[first + 1] = d, indices[first + 2] = c;
    indices[second] = d, indices[second + 1] = b, indices[second + 2] = c;
    link(first, ad);
    link(first + 1, second + 2);
    link(first + 2, ca);
    link(second, db);
    link(second + 1, bc);
    ++done;
  }
  mesh.name = "flipped " + mesh.name;
  return mesh;
}

TestMesh subdivided(TestMesh mesh, uint32_t times) {
  const std::string name = "subdivided " + mesh.name;
  for (uint32_t i = 0; i < times; ++i) {
    std::unordered_map<uint64_t, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [place, added] = middles.try_emplace(edgeKey(a, b), mesh.vertexCount());
      if (!added) return place->second;
      const auto average = [a, b](std::vector<float>& values, size_t width) {
        for (size_t k = 0; k < width && !values.empty(); ++k) {
          const float value = (values[a * width + k] + values[b * width + k]) * 0.5f;
          values.push_back(value);
        }
      };
      average(mesh.positions, 3);
      average(mesh.normals, 3);
      average(mesh.texcoords, 2);
      return place->second;
    };
    const std::vector<uint32_t> coarse = std::move(mesh.indices);
    mesh.indices.clear();
    for (size_t t = 0; t < coarse.size(); t += 3) {
      const uint32_t a = coarse[t];
      const uint32_t b = coarse[t + 1];
      const uint32_t c = coarse[t + 2];
      const uint32_t ab = middle(a, b);
      const uint32_t bc = middle(b, c);
      const uint32_t ca = middle(c, a);
      addTriangle(mesh, a, ab, ca);
      addTriangle(mesh, b, bc, ab);
      addTriangle(mesh, c, ca, bc);
      addTriangle(mesh, ab, bc, ca);
    }
  }
  mesh.name = name;
  return mesh;
}

uint32_t punchHoles(TestMesh& mesh, uint64_t seed, uint32_t holes) {
  Random random(seed);
  const uint32_t triangles = mesh.triangleCount();
  const std::vector<uint32_t> twins = twinsOf(mesh.indices);
  std::vector<bool> blocked(mesh.vertexCount(), false);
  for (uint32_t h = 0; h < twins.size(); ++h) {
    if (twins[h] == kNoIndex)
      blocked[mesh.indices[h]] = blocked[mesh.indices[nextCorner(h)]] = true;
  }
  std::vector<bool> removed(triangles, false);
  uint32_t made = 0;
  for (uint32_t trial = 0; trial < 20 * holes + 20 && made < holes; ++trial) {
    const uint32_t start = random.below(static_cast<uint32_t>(mesh.indices.size()));
    std::vector<uint32_t> patch = {start / 3};
    if (random.chance(50) && !blocked[mesh.indices[start]]) {  // all triangles around the vertex
      for (uint32_t h = twins[previousCorner(start)]; h != start; h = twins[previousCorner(h)]) {
        patch.push_back(h / 3);
      }
    }
    bool free = patch.size() < triangles / 2;
    for (const uint32_t t : patch) {
      for (uint32_t k = 0; k < 3; ++k)
        free = free && !removed[t] && !blocked[mesh.indices[size_t{t} * 3 + k]];
    }
    if (!free) continue;
    for (const uint32_t t : patch) {
      removed[t] = true;
      for (uint32_t k = 0; k < 3; ++k) blocked[mesh.indices[size_t{t} * 3 + k]] = true;
    }
    ++made;
  }
  std::vector<uint32_t> kept;
  for (uint32_t t = 0; t < triangles; ++t) {
    if (removed[t]) continue;
    for (uint32_t k = 0; k < 3; ++k) kept.push_back(mesh.indices[size_t{t} * 3 + k]);
  }
  mesh.indices = std::move(kept);
  dropUnused(mesh);
  return made;
}

TestMesh jittered(TestMesh mesh, uint64_t seed, float amount) {
  Random random(seed);
  for (float& x : mesh.positions) x += (random.unit() * 2 - 1) * amount;
  return mesh;
}

TestMesh translated(TestMesh mesh, float x, float y, float z) {
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    mesh.positions[i] += x;
    mesh.positions[i + 1] += y;
    mesh.positions[i + 2] += z;
  }
  return mesh;
}

TestMesh withFlippedTriangles(TestMesh mesh, uint64_t seed, uint32_t percent) {
  Random random(seed);
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    if (random.chance(percent)) std::swap(mesh.indices[t], mesh.indices[t + 1]);
  }
  mesh.name = "turned " + mesh.name;
  return mesh;
}

TestMesh withIndexDuplicates(TestMesh mesh, uint64_t seed, uint32_t count) {
  Random random(seed);
  const uint32_t triangles = mesh.triangleCount();
  for (uint32_t i = 0; i < count; ++i) {
    const size_t first = size_t{random.below(triangles)} * 3;
    uint32_t a = mesh.indices[first];
    uint32_t b = mesh.indices[first + 1];
    const uint32_t c = mesh.indices[first + 2];
    if (i % 3 == 2) std::swap(a, b);
    addTriangle(mesh, b, c, a);
  }
  mesh.name = "index duplicates of " + mesh.name;
  return mesh;
}

TestMesh withPositionDuplicates(TestMesh mesh, uint64_t seed, uint32_t count) {
  Random random(seed);
  const uint32_t triangles = mesh.triangleCount();
  for (uint32_t i = 0; i < count; ++i) {
    const size_t first = size_t{random.below(triangles)} * 3;
    uint32_t a = addCopy(mesh, mesh.indices[first]);
    uint32_t b = addCopy(mesh, mesh.indices[first + 1]);
    const uint32_t c = addCopy(mesh, mesh.indices[first + 2]);
    if (i % 3 == 2) std::swap(a, b);
    addTriangle(mesh, b, c, a);
  }
  mesh.name = "position duplicates of " + mesh.name;
  return mesh;
}

TestMesh withDegenerates(TestMesh mesh, uint64_t seed, uint32_t count) {
  Random random(seed);
  const uint32_t corners = static_cast<uint32_t>(mesh.indices.size());
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t h = random.below(corners);
    const uint32_t a = mesh.indices[h];
    const uint32_t on_edge = mesh.indices[nextCorner(h)];
    const uint32_t anywhere = random.below(mesh.vertexCount());
    switch (i % 6) {
      case 0: addTriangle(mesh, a, a, on_edge); break;
      case 1: addTriangle(mesh, a, on_edge, a); break;
      case 2: addTriangle(mesh, on_edge, a, a); break;
      case 3: addTriangle(mesh, a, a, anywhere); break;
      case 4: addTriangle(mesh, anywhere, a, a); break;
      default: addTriangle(mesh, a, a, a); break;
    }
  }
  mesh.name = "degenerates on " + mesh.name;
  return mesh;
}

TestMesh withUnused(TestMesh mesh, uint64_t seed, uint32_t count) {
  Random random(seed);
  const uint32_t vertices = mesh.vertexCount();
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t v = addCopy(mesh, random.below(vertices));
    if (i % 2 == 0) continue;
    for (size_t k = 0; k < 3; ++k) mesh.positions[size_t{v} * 3 + k] = random.unit();
  }
  mesh = shuffled(std::move(mesh), random.next());
  mesh.name = "unused wedges, " + mesh.name;
  return mesh;
}

TestMesh doubled(const TestMesh& mesh) {
  const std::array<TestMesh, 2> both = {mesh, mesh};
  return unionOf(both, "doubled " + mesh.name);
}

TestMesh withNormals(TestMesh mesh) {
  std::vector<std::array<double, 3>> sums(mesh.vertexCount(), {0, 0, 0});
  for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
    const std::array<double, 3> normal = crossOfTriangle(mesh, t);
    for (uint32_t k = 0; k < 3; ++k) {
      for (size_t axis = 0; axis < 3; ++axis)
        sums[mesh.indices[size_t{t} * 3 + k]][axis] += normal[axis];
    }
  }
  mesh.normals.clear();
  for (const std::array<double, 3>& sum : sums) {
    const std::array<float, 3> unit = unitVector(sum);
    mesh.normals.insert(mesh.normals.end(), unit.begin(), unit.end());
  }
  return mesh;
}

// ---- Seams --------------------------------------------------------------------------------------

TestMesh chartGrid(uint32_t w, uint32_t h, uint32_t chart) {
  const TestMesh whole = withNormals(grid(w, h, QuadSplit::kAlternate));
  TestMesh mesh;
  mesh.name = call("chartGrid", {w, h, chart});
  const uint32_t charts = (std::max(w, h) + chart - 1) / chart;
  std::unordered_map<uint64_t, uint32_t> wedges;          // of (chart, vertex)
  for (size_t t = 0; t < whole.indices.size(); t += 6) {  // two triangles per quad
    const uint32_t quad = static_cast<uint32_t>(t / 6);
    const uint32_t cx = quad % w / chart;
    const uint32_t cy = quad / w / chart;
    for (size_t k = 0; k < 6; ++k) {
      const uint32_t v = whole.indices[t + k];
      const auto [place, added] =
          wedges.try_emplace(directedKey(cy * charts + cx, v), mesh.vertexCount());
      if (added) {
        for (size_t axis = 0; axis < 3; ++axis) {
          mesh.positions.push_back(whole.positions[size_t{v} * 3 + axis]);
          mesh.normals.push_back(whole.normals[size_t{v} * 3 + axis]);
        }
        const double s = static_cast<double>(v % (w + 1) - cx * chart) / chart;
        const uint32_t row = v / (w + 1);
        const double r = static_cast<double>(row - cy * chart) / chart;
        mesh.texcoords.push_back(static_cast<float>((cx + 0.05 + 0.9 * s) / charts));
        mesh.texcoords.push_back(static_cast<float>((cy + 0.05 + 0.9 * r) / charts));
      }
      mesh.indices.push_back(place->second);
    }
  }
  return mesh;
}

namespace {

/// Gives each corner one of `wedges` copies of its vertex; copy 0 is the vertex itself.
std::vector<std::pair<uint32_t, uint32_t>> splitWedges(TestMesh& mesh, uint64_t seed,
                                                       uint32_t wedges) {
  Random random(seed);
  std::vector<uint32_t> copies(size_t{mesh.vertexCount()} * wedges, kNoIndex);
  std::vector<std::pair<uint32_t, uint32_t>> made;  // wedge, number of the copy
  for (uint32_t& v : mesh.indices) {
    const uint32_t copy = random.below(wedges);
    uint32_t& wedge = copies[size_t{v} * wedges + copy];
    if (wedge == kNoIndex && copy == 0) wedge = v;
    if (wedge == kNoIndex) {
      wedge = addCopy(mesh, v);
      made.emplace_back(wedge, copy);
    }
    v = wedge;
  }
  return made;
}

}  // namespace

TestMesh withRandomWedges(TestMesh mesh, uint64_t seed, uint32_t wedges) {
  mesh.texcoords.clear();
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    mesh.texcoords.push_back(static_cast<float>(v % 61) / 61);
    mesh.texcoords.push_back(static_cast<float>(v % 53) / 53);
  }
  for (const auto& [wedge, copy] : splitWedges(mesh, seed, wedges)) {
    mesh.texcoords[size_t{wedge} * 2] += static_cast<float>(copy);
  }
  dropUnused(mesh);
  mesh.name = call("random wedges", {seed, wedges}) + " of " + mesh.name;
  return mesh;
}

TestMesh withEqualTuples(TestMesh mesh, uint64_t seed) {
  splitWedges(mesh, seed, 2);
  dropUnused(mesh);
  mesh.name = call("equal tuples", {seed}) + " of " + mesh.name;
  return mesh;
}

TestMesh flatShaded(const TestMesh& mesh) {
  TestMesh flat;
  flat.name = "flat " + mesh.name;
  for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
    const std::array<float, 3> normal = unitVector(crossOfTriangle(mesh, t));
    for (uint32_t k = 0; k < 3; ++k) {
      const size_t first = size_t{mesh.indices[size_t{t} * 3 + k]} * 3;
      for (size_t axis = 0; axis < 3; ++axis) {
        flat.positions.push_back(mesh.positions[first + axis]);
        flat.normals.push_back(normal[axis]);
      }
      flat.indices.push_back(t * 3 + k);
    }
  }
  return flat;
}

std::vector<TestMesh> smallZoo() {
  std::vector<TestMesh> zoo = {tetrahedron(),
                               icosphere(0),
                               icosphere(2),
                               uvSphere(3, 2),
                               uvSphere(12, 7),
                               torus(3, 3),
                               torus(14, 9),
                               bipyramid(3),
                               bipyramid(50),
                               deepStack(60),
                               randomStacked(1, 200),
                               combOfStacks(7, 20),
                               mengerSponge(1),
                               mengerSponge(2),
                               openFan(1),
                               openFan(2),
                               openFan(40),
                               looseTriangles(1),
                               looseTriangles(25),
                               moebius(3, 1),
                               moebius(24, 4),
                               kleinBottle(4, 4),
                               kleinBottle(16, 9),
                               bowTies(1, 2, 1),
                               bowTies(5, 3, 4),
                               pinchedSpheres(4),
                               book(3, 1, 1),
                               book(4, 6, 2),
                               book(5, 9, 3),
                               fins(9),
                               randomVoxels(3, 5, 50),
                               randomVoxels(4, 7, 15),
                               tetrahedralSoup(1),
                               tetrahedralSoup(3),
                               tetrahedraAsQuads(1, 3),
                               stackedCubes(1, 3, 100),
                               stackedCubes(2, 5, 50),
                               cellWalls(3),
                               generated(11, 2, 3, 4)};
  for (uint32_t genus = 0; genus <= 5; ++genus)
    zoo.push_back(plateWithTunnels(genus, 1 + genus % 3));
  for (const QuadSplit split :
       {QuadSplit::kSame, QuadSplit::kAlternate, QuadSplit::kRows, QuadSplit::kRandom}) {
    zoo.push_back(grid(11, 7, split, 5));
  }
  for (const uint32_t holes : {0u, 1u, 5u, 20u}) zoo.push_back(sheetWithHoles(holes, holes + 1));
  for (uint64_t seed = 0; seed < 6; ++seed) zoo.push_back(randomSoup(seed));
  zoo.push_back(flipped(icosphere(2), 1, 3000));
  zoo.push_back(flipped(subdivided(torus(6, 5), 2), 2, 150));
  zoo.push_back(shuffled(torus(12, 9), 3));
  zoo.push_back(withFlippedTriangles(icosphere(1), 4, 30));
  zoo.push_back(withFlippedTriangles(torus(9, 6), 5, 50));
  zoo.push_back(withIndexDuplicates(uvSphere(9, 6), 6, 12));
  zoo.push_back(withPositionDuplicates(uvSphere(9, 6), 7, 12));
  zoo.push_back(withDegenerates(grid(6, 6), 8, 24));
  zoo.push_back(withDegenerates(moebius(9, 2), 9, 24));
  zoo.push_back(withUnused(torus(8, 6), 10, 11));
  zoo.push_back(doubled(icosphere(1)));
  zoo.push_back(doubled(book(4, 3, 2)));
  zoo.push_back(chartGrid(12, 9, 4));
  zoo.push_back(shuffled(chartGrid(9, 12, 1), 11));
  zoo.push_back(withRandomWedges(icosphere(2), 12, 3));
  zoo.push_back(withRandomWedges(bowTies(4, 3, 5), 13, 2));
  zoo.push_back(withRandomWedges(book(4, 5, 2), 14, 2));
  zoo.push_back(withRandomWedges(randomSoup(4), 15, 3));
  zoo.push_back(withEqualTuples(torus(9, 7), 16));
  zoo.push_back(withEqualTuples(pinchedSpheres(3), 17));
  zoo.push_back(flatShaded(icosphere(1)));
  zoo.push_back(flatShaded(randomVoxels(5, 4, 40)));
  return zoo;
}

}  // namespace mcc::test
