// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "support/paper_oracle.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace mcc::test {
namespace {

using HalfEdge = uint32_t;
using Vertex = uint32_t;  // an object of Surface; several may carry the same index of the mesh
using Kind = OracleCode::Kind;

void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(message);
}

// ---- Surfaces of half-edges ---------------------------------------------------------------------

/// Half-edges 2e and 2e + 1 are the two sides of edge e. Faces are cycles of next().
class Surface {
 public:
  Vertex addVertex(OracleVertex label) {
    labels_.push_back(label);
    return static_cast<Vertex>(labels_.size() - 1);
  }

  /// The half-edge from -> to; its twin is the next number. Both are without a face.
  HalfEdge addEdge(Vertex from, Vertex to) {
    origin_.insert(origin_.end(), {from, to});
    next_.insert(next_.end(), {kOracleNone, kOracleNone});
    alive_.insert(alive_.end(), {true, true});
    return static_cast<HalfEdge>(origin_.size() - 2);
  }

  void removeEdge(HalfEdge h) {
    for (const HalfEdge side : {h, twin(h)}) {
      alive_[side] = false;
      next_[side] = kOracleNone;
    }
  }

  static HalfEdge twin(HalfEdge h) { return h ^ 1u; }
  HalfEdge next(HalfEdge h) const { return next_[h]; }
  HalfEdge previous(HalfEdge h) const {
    HalfEdge result = h;
    while (next_[result] != h) result = next_[result];
    return result;
  }
  Vertex origin(HalfEdge h) const { return origin_[h]; }
  Vertex target(HalfEdge h) const { return origin_[twin(h)]; }

  /// The next half-edge with the same origin.
  HalfEdge counterclockwise(HalfEdge h) const { return twin(previous(h)); }
  HalfEdge clockwise(HalfEdge h) const { return next(twin(h)); }

  void makeTriangle(HalfEdge a, HalfEdge b, HalfEdge c) {
    next_[a] = b;
    next_[b] = c;
    next_[c] = a;
  }
  void makeOuterFace(HalfEdge a, HalfEdge b) {
    next_[a] = b;
    next_[b] = a;
  }
  /// `fresh` takes the place of `old` in its face.
  void replaceInFace(HalfEdge old, HalfEdge fresh) {
    const HalfEdge before = previous(old);
    const HalfEdge after = next_[old];
    next_[before] = fresh;
    next_[fresh] = after;
    next_[old] = kOracleNone;
  }

  /// Half-edges whose origin is that of h, clockwise from h.
  std::vector<HalfEdge> star(HalfEdge h) const {
    std::vector<HalfEdge> result;
    HalfEdge spoke = h;
    do {
      result.push_back(spoke);
      spoke = clockwise(spoke);
    } while (spoke != h);
    return result;
  }
  void setOriginAround(HalfEdge h, Vertex vertex) {
    for (const HalfEdge spoke : star(h)) origin_[spoke] = vertex;
  }
  void setOrigin(HalfEdge h, Vertex vertex) { origin_[h] = vertex; }

  const OracleVertex& label(Vertex vertex) const { return labels_[vertex]; }
  void setLabel(Vertex vertex, OracleVertex label) { labels_[vertex] = label; }

  HalfEdge halfEdgeCount() const { return static_cast<HalfEdge>(origin_.size()); }
  bool alive(HalfEdge h) const { return alive_[h]; }

  /// Every face has three edges but for `outer_face`, which has two; no loops; origins agree.
  void validate(HalfEdge outer_face) const {
    for (HalfEdge h = 0; h < halfEdgeCount(); ++h) {
      if (!alive_[h]) continue;
      const bool outer = outer_face != kOracleNone && (h == outer_face || h == next_[outer_face]);
      const HalfEdge second = next_[h];
      const HalfEdge end = outer ? next_[second] : next_[next_[second]];
      const bool good = alive_[second] && end == h && second != h && origin_[second] == target(h) &&
                        origin_[h] != target(h);
      if (!good) throw std::logic_error("oracle: broken surface");
    }
  }

 private:
  std::vector<Vertex> origin_;
  std::vector<HalfEdge> next_;
  std::vector<bool> alive_;
  std::vector<OracleVertex> labels_;
};

// ---- Digons -------------------------------------------------------------------------------------

/// A surface around an outer face of two edges. While it waits on the stack the outer face is
/// closed.
struct Digon {
  HalfEdge mc_edge = kOracleNone;  // from the mc-vertex to the top, on its inner side
  bool top_is_duplicate = false;
};

/// The inner side of the bounding edge that is not the mc-edge: top -> mc-vertex.
HalfEdge leftEdge(const Surface& surface, HalfEdge mc_edge) {
  return Surface::twin(surface.next(Surface::twin(mc_edge)));
}

/// Figure 1: cuts the mesh along the mc-edge and opens it.
void openDigon(Surface& surface, HalfEdge mc_edge) {
  const HalfEdge outer = Surface::twin(mc_edge);
  const HalfEdge left = surface.addEdge(surface.target(mc_edge), surface.origin(mc_edge));
  surface.replaceInFace(outer, left);
  surface.makeOuterFace(outer, Surface::twin(left));
}

/// The inverse of openDigon(). The left edge disappears.
void closeDigon(Surface& surface, HalfEdge mc_edge) {
  const HalfEdge left = leftEdge(surface, mc_edge);
  surface.replaceInFace(left, Surface::twin(mc_edge));
  surface.removeEdge(left);
}

/// Figure 4 from left to right: cuts along a dividing edge m -> p. Afterwards `dividing` is the
/// mc-edge of the digon on the side of the left edge, and mc_edge that of the other.
void cutDigon(Surface& surface, HalfEdge mc_edge, HalfEdge dividing) {
  const HalfEdge outer = Surface::twin(mc_edge);
  const HalfEdge outer_left = surface.next(outer);
  const HalfEdge other_side = Surface::twin(dividing);
  const HalfEdge fresh = surface.addEdge(surface.origin(other_side), surface.target(other_side));
  surface.replaceInFace(other_side, fresh);
  surface.makeOuterFace(outer, Surface::twin(fresh));
  surface.makeOuterFace(other_side, outer_left);
}

/// The inverse of cutDigon(): glues the mc-edge of the left digon to the left edge of the right
/// one.
void glueDigons(Surface& surface, HalfEdge mc_edge, HalfEdge left_digon) {
  const HalfEdge outer = Surface::twin(mc_edge);
  const HalfEdge inner_left = leftEdge(surface, mc_edge);
  const HalfEdge outer_left = surface.next(Surface::twin(left_digon));
  surface.replaceInFace(inner_left, Surface::twin(left_digon));
  surface.removeEdge(inner_left);
  surface.makeOuterFace(outer, outer_left);
}

/// The edges an M may name, in the order of the file comment. Taken while the operation's input
/// exists.
std::vector<HalfEdge> edgesOfContract(const Surface& surface, HalfEdge mc_edge) {
  const HalfEdge left = leftEdge(surface, mc_edge);
  const HalfEdge inner = surface.next(mc_edge);  // p -> x1
  return {mc_edge, Surface::twin(mc_edge), Surface::twin(left), left, inner, Surface::twin(inner)};
}

std::vector<HalfEdge> edgesOfTrivial(const Surface& surface, HalfEdge mc_edge) {
  std::vector<HalfEdge> edges = edgesOfContract(surface, mc_edge);
  const HalfEdge m_to_x = surface.next(leftEdge(surface, mc_edge));
  edges.insert(edges.end(), {m_to_x, Surface::twin(m_to_x)});
  return edges;
}

// ---- Meshes -------------------------------------------------------------------------------------

std::vector<uint32_t> twinsByVertexPairs(const OracleMesh& mesh) {
  const uint32_t count = static_cast<uint32_t>(3 * mesh.triangles.size());
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> half_edges;
  for (uint32_t h = 0; h < count; ++h) {
    const bool is_new =
        half_edges.try_emplace({oracleOrigin(mesh, h), oracleOrigin(mesh, oracleNext(h))}, h)
            .second;
    require(is_new, "oracle: two half-edges run from and to the same vertices");
  }
  std::vector<uint32_t> twins(count, kOracleNone);
  for (const auto& [ends, h] : half_edges) {
    const auto found = half_edges.find({ends.second, ends.first});
    if (found != half_edges.end()) twins[h] = found->second;
  }
  return twins;
}

void requireTriangles(const OracleMesh& mesh) {
  require(!mesh.triangles.empty(), "oracle: empty mesh");
  for (const auto& [a, b, c] : mesh.triangles) {
    require(std::max({a, b, c}) < mesh.vertex_count, "oracle: vertex out of range");
    require(a != b && b != c && c != a, "oracle: degenerate triangle");
  }
}

OracleMesh withTwins(OracleMesh mesh) {
  requireTriangles(mesh);
  if (mesh.twins.empty()) mesh.twins = twinsByVertexPairs(mesh);
  require(mesh.twins.size() == 3 * mesh.triangles.size(), "oracle: wrong number of twins");
  for (uint32_t h = 0; h < mesh.twins.size(); ++h) {
    const uint32_t twin = mesh.twins[h];
    if (twin == kOracleNone) continue;
    require(twin < mesh.twins.size() && mesh.twins[twin] == h && twin != h &&
                oracleOrigin(mesh, twin) == oracleOrigin(mesh, oracleNext(h)) &&
                oracleOrigin(mesh, h) == oracleOrigin(mesh, oracleNext(twin)),
            "oracle: twins disagree");
  }
  return mesh;
}

/// One boundary loop from half-edge h, with the hole on the left of the twins: each next half-edge
/// ends where the one before begins.
std::vector<uint32_t> boundaryLoop(const OracleMesh& mesh, uint32_t first) {
  std::vector<uint32_t> loop;
  uint32_t h = first;
  do {
    loop.push_back(h);
    uint32_t incoming = oraclePrevious(h);
    while (mesh.twins[incoming] != kOracleNone) incoming = oraclePrevious(mesh.twins[incoming]);
    h = incoming;
  } while (h != first);
  return loop;
}

void makeTwins(OracleMesh& mesh, uint32_t a, uint32_t b) {
  mesh.twins[a] = b;
  mesh.twins[b] = a;
}

/// Figure 9: the triangles (v, u, dummy) for all half-edges u -> v of a loop.
void addCone(OracleMesh& mesh, const std::vector<uint32_t>& loop) {
  const uint32_t dummy = mesh.vertex_count++;
  const uint32_t first = static_cast<uint32_t>(mesh.twins.size());
  const uint32_t count = static_cast<uint32_t>(loop.size());
  mesh.twins.resize(first + 3 * count);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t h = loop[i];
    mesh.triangles.push_back({oracleOrigin(mesh, oracleNext(h)), oracleOrigin(mesh, h), dummy});
    makeTwins(mesh, first + 3 * i, h);
    makeTwins(mesh, first + 3 * i + 1, first + 3 * ((i + 1) % count) + 2);
  }
}

/// Figure 8: the mc-vertex m gets an edge to each boundary vertex that has none along the boundary.
/// The triangles are (m, v, u) for the half-edges u -> v of the loop without m, from the far side
/// of `start`.
uint32_t addFan(OracleMesh& mesh, uint32_t start) {
  require(start < mesh.twins.size() && mesh.twins[start] == kOracleNone,
          "oracle: the mc-edge of a fan patch must lie on the boundary");
  const std::vector<uint32_t> loop = boundaryLoop(mesh, start);
  const auto holes = std::count(mesh.twins.begin(), mesh.twins.end(), kOracleNone);
  require(static_cast<size_t>(holes) == loop.size(), "oracle: a fan patch needs a single boundary");
  require(loop.size() >= 3, "oracle: boundary of fewer than three edges");
  const uint32_t m = oracleOrigin(mesh, start);
  uint32_t open = loop[1];  // awaits its twin m -> v
  for (size_t i = 2; i < loop.size(); ++i) {
    const uint32_t h = loop[i];
    const uint32_t first = static_cast<uint32_t>(mesh.twins.size());
    mesh.triangles.push_back({m, oracleOrigin(mesh, oracleNext(h)), oracleOrigin(mesh, h)});
    mesh.twins.resize(first + 3);
    makeTwins(mesh, first, open);
    makeTwins(mesh, first + 1, h);
    open = first + 2;
  }
  makeTwins(mesh, open, start);
  return static_cast<uint32_t>(loop.size()) - 3;
}

/// The triangles but for those of the fan.
std::vector<std::array<uint32_t, 3>> withoutFan(const OracleMesh& mesh, uint32_t start,
                                                uint32_t fan_edges) {
  std::set<uint32_t> removed;
  uint32_t h = mesh.twins[start];  // towards the mc-vertex
  for (uint32_t i = 0; i <= fan_edges; ++i) {
    removed.insert(h / 3);
    h = mesh.twins[oracleNext(h)];
  }
  require(removed.size() == fan_edges + 1, "oracle: fan larger than the star of the mc-vertex");
  std::vector<std::array<uint32_t, 3>> result;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!removed.contains(t)) result.push_back(mesh.triangles[t]);
  }
  return result;
}

std::vector<std::array<uint32_t, 3>> withoutDummies(const OracleMesh& mesh) {
  std::vector<std::array<uint32_t, 3>> result;
  for (const auto& triangle : mesh.triangles) {
    if (*std::max_element(triangle.begin(), triangle.end()) < mesh.first_dummy) {
      result.push_back(triangle);
    }
  }
  return result;
}

/// Each triangle (a, b, c) becomes (a, c, b): half-edge 3t + k becomes the reverse of 3t + 2 - k.
uint32_t reversedHalfEdge(uint32_t h) { return 3 * (h / 3) + 2 - h % 3; }

OracleMesh insideOut(const OracleMesh& mesh) {
  OracleMesh result = mesh;
  for (auto& triangle : result.triangles) std::swap(triangle[1], triangle[2]);
  for (uint32_t h = 0; h < mesh.twins.size(); ++h) {
    result.twins[reversedHalfEdge(h)] = reversedHalfEdge(mesh.twins[h]);
  }
  return result;
}

/// Number of triangles reached over edges from triangle 0.
size_t reachableTriangles(const OracleMesh& mesh) {
  std::set<uint32_t> reached = {0};
  std::vector<uint32_t> pending = {0};
  while (!pending.empty()) {
    const uint32_t t = pending.back();
    pending.pop_back();
    for (uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (reached.insert(mesh.twins[h] / 3).second) pending.push_back(mesh.twins[h] / 3);
    }
  }
  return reached.size();
}

/// Closed, connected, one fan per vertex. Returns the Euler number.
int64_t requireClosedManifold(const OracleMesh& mesh) {
  require(std::count(mesh.twins.begin(), mesh.twins.end(), kOracleNone) == 0, "oracle: not closed");
  require(reachableTriangles(mesh) == mesh.triangles.size(), "oracle: several components");
  std::vector<uint32_t> corners(mesh.vertex_count, 0);
  std::vector<uint32_t> one_half_edge(mesh.vertex_count, kOracleNone);
  for (uint32_t h = 0; h < mesh.twins.size(); ++h) {
    ++corners[oracleOrigin(mesh, h)];
    one_half_edge[oracleOrigin(mesh, h)] = h;
  }
  int64_t used = 0;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    if (corners[v] == 0) continue;
    ++used;
    uint32_t fan = 0;
    uint32_t h = one_half_edge[v];
    do {
      ++fan;
      h = mesh.twins[oraclePrevious(h)];
    } while (h != one_half_edge[v]);
    require(fan == corners[v], "oracle: a vertex has several fans");
  }
  return used - static_cast<int64_t>(mesh.triangles.size()) / 2;
}

/// The surface of a closed mesh. Half-edges of the mesh get new numbers: `numbers`.
Surface surfaceOf(const OracleMesh& mesh, std::vector<HalfEdge>& numbers) {
  Surface surface;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) surface.addVertex({v, v >= mesh.first_dummy});
  numbers.assign(mesh.twins.size(), kOracleNone);
  for (uint32_t h = 0; h < mesh.twins.size(); ++h) {
    if (numbers[h] != kOracleNone) continue;
    numbers[h] = surface.addEdge(oracleOrigin(mesh, h), oracleOrigin(mesh, oracleNext(h)));
    numbers[mesh.twins[h]] = Surface::twin(numbers[h]);
  }
  for (uint32_t h = 0; h < mesh.twins.size(); h += 3) {
    surface.makeTriangle(numbers[h], numbers[h + 1], numbers[h + 2]);
  }
  return surface;
}

/// The inverse of surfaceOf() for a surface without outer faces.
OracleMesh meshOf(const Surface& surface, std::vector<uint32_t>& numbers) {
  OracleMesh mesh;
  numbers.assign(surface.halfEdgeCount(), kOracleNone);
  uint32_t count = 0;
  for (HalfEdge h = 0; h < surface.halfEdgeCount(); ++h) {
    if (!surface.alive(h) || numbers[h] != kOracleNone) continue;
    const std::array<HalfEdge, 3> face = {h, surface.next(h), surface.next(surface.next(h))};
    std::array<uint32_t, 3> triangle = {};
    for (size_t k = 0; k < 3; ++k) {
      const OracleVertex& vertex = surface.label(surface.origin(face[k]));
      require(vertex.index != kOracleNone, "oracle: a vertex was never named");
      numbers[face[k]] = count++;
      triangle[k] = vertex.index;
      mesh.vertex_count = std::max(mesh.vertex_count, vertex.index + 1);
      if (vertex.dummy) mesh.first_dummy = std::min(mesh.first_dummy, vertex.index);
    }
    mesh.triangles.push_back(triangle);
  }
  mesh.twins.resize(count);
  for (HalfEdge h = 0; h < surface.halfEdgeCount(); ++h) {
    if (surface.alive(h)) mesh.twins[numbers[h]] = numbers[Surface::twin(h)];
  }
  return mesh;
}

// ---- Encoding, section 4.3 ----------------------------------------------------------------------

class Encoder {
 public:
  Encoder(const OracleMesh& closed, const OracleOptions& options)
      : surface_(surfaceOf(closed, numbers_)), options_(options) {}

  OracleCoding run(uint32_t start) {
    pushDigon({numbers_[start], false});
    pushVertex(surface_.origin(numbers_[start]));
    while (!digons_.empty()) {
      digon_ = popDigon();
      while (!trivial()) {
        const HalfEdge dividing = dividingEdge();
        if (dividing != kOracleNone) {
          divide(dividing);
        } else {
          contract();
        }
        if (options_.validate) surface_.validate(Surface::twin(digon_.mc_edge));
      }
      end();
    }
    return std::move(coding_);
  }

 private:
  Vertex mcVertex() const { return surface_.origin(digon_.mc_edge); }
  Vertex top() const { return surface_.target(digon_.mc_edge); }

  void pushDigon(Digon digon) { digons_.push_back(digon); }
  Digon popDigon() {
    const Digon digon = digons_.back();
    digons_.pop_back();
    openDigon(surface_, digon.mc_edge);
    return digon;
  }

  void pushVertex(Vertex vertex) { coding_.stacks.vertices.push_back(surface_.label(vertex)); }
  void pushCode(const OracleRecord& record) {
    coding_.records.push_back(record);
    coding_.stacks.codes.push_back(record.code);
  }

  /// More than two edges join mc-vertex and top: the dividing edge (mc-vertex -> top) first met on
  /// the side of the options, or kOracleNone.
  HalfEdge dividingEdge() const {
    const bool clockwise = options_.side == OracleSide::kNextMcEdge;
    const HalfEdge outer_left = surface_.next(Surface::twin(digon_.mc_edge));
    const HalfEdge first = clockwise ? outer_left : digon_.mc_edge;
    const HalfEdge last = clockwise ? digon_.mc_edge : outer_left;
    const auto turn = [&](HalfEdge h) {
      return clockwise ? surface_.clockwise(h) : surface_.counterclockwise(h);
    };
    for (HalfEdge h = turn(first); h != last; h = turn(h)) {
      if (surface_.target(h) == top()) return h;
    }
    return kOracleNone;
  }

  /// Three vertices, and no dividing edge.
  bool trivial() const {
    std::set<HalfEdge> reached = {digon_.mc_edge};
    std::set<Vertex> vertices;
    std::vector<HalfEdge> pending = {digon_.mc_edge};
    while (!pending.empty()) {
      const HalfEdge h = pending.back();
      pending.pop_back();
      vertices.insert(surface_.origin(h));
      if (vertices.size() > 3) return false;
      for (const HalfEdge neighbour : {surface_.next(h), Surface::twin(h)}) {
        if (reached.insert(neighbour).second) pending.push_back(neighbour);
      }
    }
    return dividingEdge() == kOracleNone;
  }

  /// Section 5.2: for every waiting digon whose mc-edge is under consideration, M and no digon.
  void closeLoops(const std::vector<HalfEdge>& edges) {
    for (uint32_t edge = 0; edge < edges.size(); ++edge) {
      uint32_t position = 0;
      while (position < digons_.size()) {
        const size_t index = digons_.size() - 1 - position;
        if (digons_[index].mc_edge != edges[edge]) {
          ++position;
          continue;
        }
        digons_.erase(digons_.begin() + static_cast<std::ptrdiff_t>(index));
        OracleRecord record;
        record.code = {Kind::kHandle, 0, position, edge};
        pushCode(record);
      }
    }
  }

  /// Section 4.2, figure 4.
  void divide(HalfEdge dividing) {
    OracleRecord record;
    record.code.kind = Kind::kStart;
    pushCode(record);
    closeLoops({dividing, Surface::twin(dividing)});

    cutDigon(surface_, digon_.mc_edge, dividing);
    Digon waiting = {digon_.mc_edge, true};
    if (options_.side == OracleSide::kNextMcEdge) {
      digon_.mc_edge = dividing;
    } else {
      waiting.mc_edge = dividing;
    }
    const HalfEdge outer_top = Surface::twin(waiting.mc_edge);  // top -> mc-vertex
    surface_.setOriginAround(waiting.mc_edge, surface_.addVertex(surface_.label(mcVertex())));
    surface_.setOriginAround(outer_top, surface_.addVertex(surface_.label(top())));
    closeDigon(surface_, waiting.mc_edge);
    pushDigon(waiting);
  }

  /// Section 4.1, figure 3.
  void contract() {
    const HalfEdge mc_edge = digon_.mc_edge;
    const Vertex removed = top();
    const std::vector<HalfEdge> star = surface_.star(Surface::twin(mc_edge));
    OracleRecord record;
    record.code.degree = static_cast<uint32_t>(star.size());
    record.vertices[0] = surface_.label(removed);
    pushCode(record);
    if (!digon_.top_is_duplicate) pushVertex(removed);
    digon_.top_is_duplicate = false;
    closeLoops(edgesOfContract(surface_, mc_edge));

    // The mc-edge shrinks to a point, and its triangle (m, p, x1) to an edge.
    const HalfEdge left = leftEdge(surface_, mc_edge);
    const HalfEdge p_to_x1 = surface_.next(mc_edge);
    const HalfEdge x1_to_m = surface_.next(p_to_x1);
    for (const HalfEdge spoke : star) surface_.setOrigin(spoke, mcVertex());
    surface_.replaceInFace(Surface::twin(p_to_x1), x1_to_m);
    surface_.removeEdge(p_to_x1);
    surface_.removeEdge(mc_edge);
    // The left edge is now a loop; without it its triangle is the outer face.
    const HalfEdge m_to_xn = surface_.next(left);
    const HalfEdge xn_to_m = surface_.next(m_to_xn);
    surface_.makeOuterFace(m_to_xn, xn_to_m);
    surface_.removeEdge(left);
    digon_.mc_edge = Surface::twin(xn_to_m);
  }

  void end() {
    const Vertex third = surface_.target(surface_.next(digon_.mc_edge));
    OracleRecord record;
    record.code.kind = Kind::kEnd;
    record.vertices = {surface_.label(top()), surface_.label(third)};
    pushCode(record);
    if (!digon_.top_is_duplicate) pushVertex(top());
    pushVertex(third);
    closeLoops(edgesOfTrivial(surface_, digon_.mc_edge));
    for (const HalfEdge h : edgesOfTrivial(surface_, digon_.mc_edge)) {
      if (surface_.alive(h)) surface_.removeEdge(h);
    }
  }

  std::vector<HalfEdge> numbers_;
  Surface surface_;
  OracleOptions options_;
  std::vector<Digon> digons_;
  Digon digon_;
  OracleCoding coding_;
};

// ---- Decoding, section 4.7 ----------------------------------------------------------------------

class Decoder {
 public:
  Decoder(const OracleStacks& stacks, const OracleOptions& options)
      : codes_(stacks.codes), vertices_(stacks.vertices), options_(options) {}

  OracleDecoding run() {
    std::vector<OracleCode> handles;  // of the operation that comes next
    while (!codes_.empty()) {
      const OracleCode code = codes_.back();
      codes_.pop_back();
      if (code.kind == Kind::kHandle) {
        handles.push_back(code);
        continue;
      }
      const std::vector<HalfEdge> edges = invert(code);
      for (const OracleCode& handle : handles) openLoop(handle, edges);
      handles.clear();
      if (options_.validate) surface_.validate(Surface::twin(digon_.mc_edge));
    }
    require(handles.empty() && digon_.mc_edge != kOracleNone && digons_.empty(),
            "oracle: codes end too early");
    nameVertex(surface_.origin(digon_.mc_edge), popVertex());
    require(vertices_.empty(), "oracle: vertices are left");
    return finish();
  }

 private:
  /// Returns the edges an M of this operation may name.
  std::vector<HalfEdge> invert(const OracleCode& code) {
    switch (code.kind) {
      case Kind::kEnd: return begin();
      case Kind::kStart: return join();
      default: return expand(code.degree);
    }
  }

  OracleVertex popVertex() {
    require(!vertices_.empty(), "oracle: no vertex is left");
    const OracleVertex vertex = vertices_.back();
    vertices_.pop_back();
    return vertex;
  }
  /// The top just made: the duplicate gets its name when it is joined.
  OracleVertex popTop() { return currentTopIsDuplicate() ? OracleVertex{} : popVertex(); }
  bool currentTopIsDuplicate() const {
    for (size_t i = codes_.size(); i > 0; --i) {
      const Kind kind = codes_[i - 1].kind;
      if (kind == Kind::kEnd) return true;
      if (kind == Kind::kDegree) return false;
    }
    return false;
  }

  void nameVertex(Vertex vertex, OracleVertex label) {
    const OracleVertex& old = surface_.label(vertex);
    require(old.index == kOracleNone || old == label, "oracle: two names for one vertex");
    surface_.setLabel(vertex, label);
  }
  /// The vertices at the origins of two half-edges become one. They are one star already.
  void mergeVertices(HalfEdge a, HalfEdge b) {
    const Vertex kept = surface_.origin(a);
    const Vertex other = surface_.origin(b);
    require(kept != other, "oracle: a digon is joined to itself");
    if (surface_.label(other).index != kOracleNone) nameVertex(kept, surface_.label(other));
    surface_.setOriginAround(a, kept);
  }

  /// E: the current digon waits, a trivial one begins. The mc-vertex has no name yet.
  std::vector<HalfEdge> begin() {
    if (digon_.mc_edge != kOracleNone) {
      closeDigon(surface_, digon_.mc_edge);
      digons_.push_back(digon_);
    }
    const Vertex x = surface_.addVertex(popVertex());
    const Vertex p = surface_.addVertex(popTop());
    const Vertex m = surface_.addVertex({});
    digon_.mc_edge = surface_.addEdge(m, p);
    const HalfEdge left = surface_.addEdge(p, m);
    const HalfEdge m_to_x = surface_.addEdge(m, x);
    const HalfEdge p_to_x = surface_.addEdge(p, x);
    surface_.makeTriangle(digon_.mc_edge, p_to_x, Surface::twin(m_to_x));
    surface_.makeTriangle(left, m_to_x, Surface::twin(p_to_x));
    surface_.makeOuterFace(Surface::twin(digon_.mc_edge), Surface::twin(left));
    return edgesOfTrivial(surface_, digon_.mc_edge);
  }

  /// Section 4.5: S.
  std::vector<HalfEdge> join() {
    require(digon_.mc_edge != kOracleNone && !digons_.empty(), "oracle: S without a waiting digon");
    const HalfEdge waiting = digons_.back().mc_edge;
    digons_.pop_back();
    openDigon(surface_, waiting);
    const bool waiting_is_left = options_.side == OracleSide::kOther;
    const HalfEdge left = waiting_is_left ? waiting : digon_.mc_edge;
    const HalfEdge right = waiting_is_left ? digon_.mc_edge : waiting;
    glueDigons(surface_, right, left);
    mergeVertices(digon_.mc_edge, waiting);
    mergeVertices(Surface::twin(digon_.mc_edge), Surface::twin(waiting));
    digon_.mc_edge = right;
    return {left, Surface::twin(left)};
  }

  /// Section 4.4, figure 5: the mc-edge and the next degree - 3 edges counter-clockwise around the
  /// mc-vertex move over to the new vertex p; the last is duplicated.
  std::vector<HalfEdge> expand(uint32_t degree) {
    require(digon_.mc_edge != kOracleNone && degree >= 3, "oracle: expand without a digon");
    const HalfEdge m_to_xn = surface_.next(Surface::twin(digon_.mc_edge));  // the outer face's
    const HalfEdge xn_to_m = Surface::twin(digon_.mc_edge);
    const Vertex m = surface_.origin(digon_.mc_edge);
    const Vertex p = surface_.addVertex(popTop());
    HalfEdge last = digon_.mc_edge;
    for (uint32_t i = 0; i < degree - 3; ++i) {
      require(last != m_to_xn, "oracle: degree larger than the star of the mc-vertex");
      const HalfEdge following = surface_.counterclockwise(last);
      surface_.setOrigin(last, p);
      last = following;
    }
    const HalfEdge x1_to_m = Surface::twin(last);
    const HalfEdge p_to_x1 = surface_.addEdge(p, surface_.target(last));
    surface_.replaceInFace(x1_to_m, Surface::twin(p_to_x1));
    const HalfEdge xn_to_p = x1_to_m == xn_to_m ? Surface::twin(p_to_x1) : xn_to_m;

    digon_.mc_edge = surface_.addEdge(m, p);
    const HalfEdge left = surface_.addEdge(p, m);
    surface_.makeTriangle(digon_.mc_edge, p_to_x1, x1_to_m);
    surface_.makeTriangle(left, m_to_xn, xn_to_p);
    surface_.makeOuterFace(Surface::twin(digon_.mc_edge), Surface::twin(left));
    return edgesOfContract(surface_, digon_.mc_edge);
  }

  /// Section 5.2: M puts a digon back on the stack.
  void openLoop(const OracleCode& handle, const std::vector<HalfEdge>& edges) {
    require(handle.edge < edges.size() && handle.stack_position <= digons_.size(),
            "oracle: M out of range");
    const auto place = digons_.end() - static_cast<std::ptrdiff_t>(handle.stack_position);
    digons_.insert(place, {edges[handle.edge], false});
  }

  OracleDecoding finish() {
    closeDigon(surface_, digon_.mc_edge);
    if (options_.validate) surface_.validate(kOracleNone);
    std::vector<uint32_t> numbers;
    OracleDecoding result;
    result.closed = meshOf(surface_, numbers);
    result.start = numbers[digon_.mc_edge];
    return result;
  }

  std::vector<OracleCode> codes_;
  std::vector<OracleVertex> vertices_;
  OracleOptions options_;
  Surface surface_;
  std::vector<Digon> digons_;
  Digon digon_;
};

}  // namespace

std::string toString(const OracleRecord& record) {
  const auto name = [](const OracleVertex& vertex) {
    return "v" + std::to_string(vertex.index) + (vertex.dummy ? "*" : "");
  };
  switch (record.code.kind) {
    case Kind::kStart: return "S";
    case Kind::kEnd: return "E(" + name(record.vertices[0]) + " " + name(record.vertices[1]) + ")";
    case Kind::kHandle:
      return "M(" + std::to_string(record.code.stack_position) + " " +
             std::to_string(record.code.edge) + ")";
    case Kind::kDegree: break;
  }
  return std::to_string(record.code.degree) + "(" + name(record.vertices[0]) + ")";
}

OracleMesh coneHoles(const OracleMesh& mesh) {
  OracleMesh result = withTwins(mesh);
  const uint32_t half_edges = static_cast<uint32_t>(result.twins.size());
  for (uint32_t h = 0; h < half_edges; ++h) {
    if (result.twins[h] != kOracleNone) continue;
    require(mesh.first_dummy == kOracleNone, "oracle: a mesh with dummies must be closed");
    result.first_dummy = mesh.vertex_count;
    addCone(result, boundaryLoop(result, h));
  }
  return result;
}

OracleCoding encodeByPaper(const OracleMesh& mesh, uint32_t start, const OracleOptions& options) {
  const bool clockwise = options.turn == OracleTurn::kClockwise;
  const bool fan = options.boundary == OracleBoundary::kFanPatch;
  require(!fan || !clockwise, "oracle: fan patches are built counter-clockwise only");
  OracleMesh closed;
  std::optional<uint32_t> fan_edges;
  if (fan) {
    closed = withTwins(mesh);
    fan_edges = addFan(closed, start);
  } else {
    closed = coneHoles(mesh);
  }
  require(start < closed.twins.size(), "oracle: no such start half-edge");
  const int64_t euler = requireClosedManifold(closed);
  require(euler == 2 || options.side == OracleSide::kNextMcEdge,
          "oracle: the other side is for spheres only");
  if (clockwise) {
    start = reversedHalfEdge(closed.twins[start]);
    closed = insideOut(closed);
  }
  OracleCoding coding = Encoder(closed, options).run(start);
  coding.stacks.fan_edges = fan_edges;
  return coding;
}

OracleDecoding decodeByPaper(const OracleStacks& stacks, const OracleOptions& options) {
  OracleDecoding result = Decoder(stacks, options).run();
  if (options.turn == OracleTurn::kClockwise) {
    result.start = reversedHalfEdge(result.closed.twins[result.start]);
    result.closed = insideOut(result.closed);
  }
  result.triangles = stacks.fan_edges ? withoutFan(result.closed, result.start, *stacks.fan_edges)
                                      : withoutDummies(result.closed);
  return result;
}

}  // namespace mcc::test
