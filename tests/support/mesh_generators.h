// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Triangle meshes for tests and samples. The same arguments give the same bits on every platform:
// own integer random numbers, own sine and cosine, otherwise only + - * / and sqrt in a fixed
// order.
//
// Unless a generator says otherwise its result is manifold, consistently oriented
// (counter-clockwise seen from outside) and has pairwise different positions.
#ifndef MCC_TESTS_SUPPORT_MESH_GENERATORS_H_
#define MCC_TESTS_SUPPORT_MESH_GENERATORS_H_

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace mcc::test {

/// A triangle list on glTF vertices (wedges).
struct TestMesh {
  std::string name;
  std::vector<float> positions;   ///< 3 per wedge
  std::vector<uint32_t> indices;  ///< 3 per triangle
  std::vector<float> normals;     ///< 3 per wedge, or empty
  std::vector<float> texcoords;   ///< 2 per wedge, or empty

  uint32_t vertexCount() const { return static_cast<uint32_t>(positions.size() / 3); }
  uint32_t triangleCount() const { return static_cast<uint32_t>(indices.size() / 3); }
};

/// SplitMix64.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t next();
  /// 0 .. bound - 1; bound > 0.
  uint32_t below(uint32_t bound);
  /// low .. high, both included.
  uint32_t between(uint32_t low, uint32_t high) { return low + below(high - low + 1); }
  /// True in `percent` of 100 calls.
  bool chance(uint32_t percent) { return below(100) < percent; }
  /// 0 <= x < 1, a multiple of 2^-24.
  float unit();

 private:
  uint64_t state_;
};

struct CosSin {
  double cos;
  double sin;
};
/// Cosine and sine of `turns` full turns (error below 1e-14, same bits everywhere).
CosSin turn(double turns);

// ---- Measuring ----------------------------------------------------------------------------------

/// Properties of a triangle list as a surface, judged by indices only (positions are not welded).
struct MeshTopology {
  uint32_t used_vertices = 0;
  uint32_t unused_vertices = 0;
  uint32_t components = 0;             ///< connected by shared vertices
  uint32_t degenerate_triangles = 0;   ///< two equal indices; left out of everything below
  uint32_t duplicate_triangles = 0;    ///< same three indices as an earlier one, in any order
  uint32_t crowded_edges = 0;          ///< more than two faces
  uint32_t inconsistent_edges = 0;     ///< two faces that run along it in the same direction
  uint32_t non_manifold_vertices = 0;  ///< more than one fan (faces connected over their edges)
  uint32_t max_degree = 0;             ///< faces at one vertex
  bool orientable = false;      ///< of a manifold: some orientation of its faces is consistent
  uint32_t boundary_loops = 0;  ///< only for a manifold
  uint32_t genus = 0;           ///< only for an orientable manifold: handles of all components

  bool manifold() const {
    return degenerate_triangles == 0 && crowded_edges == 0 && non_manifold_vertices == 0;
  }
};
MeshTopology measureTopology(const TestMesh& mesh);

/// True when no two wedges have bit-equal positions.
bool positionsDiffer(const TestMesh& mesh);

// ---- Closed surfaces ----------------------------------------------------------------------------

TestMesh tetrahedron();
/// 20 * 4^level triangles.
TestMesh icosphere(uint32_t level);
/// `segments` >= 3 meridians, `rings` >= 2 bands; has normals.
TestMesh uvSphere(uint32_t segments, uint32_t rings);
/// Both at least 3; has normals.
TestMesh torus(uint32_t major_segments, uint32_t minor_segments);
/// A flat box with `genus` square tunnels; edges of the tunnels have `fineness` >= 1 quads.
TestMesh plateWithTunnels(uint32_t genus, uint32_t fineness);
/// Two apexes over a ring of n >= 3 vertices: degree n at both.
TestMesh bipyramid(uint32_t n);
/// A tetrahedron and `depth` vertices, each put into the last triangle made.
TestMesh deepStack(uint32_t depth);
/// A tetrahedron and n vertices, each put into a random triangle.
TestMesh randomStacked(uint64_t seed, uint32_t n);
/// A bipyramid of degree `teeth` with a deep stack of `depth` on each upper triangle.
TestMesh combOfStacks(uint32_t teeth, uint32_t depth);
/// Surface of the Menger sponge, level 1..3.
TestMesh mengerSponge(uint32_t level);
/// Surface of the filled cells of a box of cells, vertices shared by lattice point. Manifold only
/// where no two filled cells meet in an edge or a corner alone.
TestMesh voxelSurface(uint32_t nx, uint32_t ny, uint32_t nz,
                      const std::function<bool(uint32_t, uint32_t, uint32_t)>& filled);
/// Marching tetrahedra of field(x, y, z) = 0 on n^3 cells over [-1, 1]^3: vertices on edges and
/// diagonals of the cells. May touch itself where the field is that fine.
TestMesh isosurface(uint32_t n, const std::function<double(double, double, double)>& field);

// ---- Surfaces with boundaries -------------------------------------------------------------------

enum class QuadSplit : uint8_t { kSame, kAlternate, kRows, kRandom };
/// A sheet of w x h quads, gently waved; the diagonals follow `split`.
TestMesh grid(uint32_t w, uint32_t h, QuadSplit split = QuadSplit::kSame, uint64_t seed = 0);
/// A grid with k inner holes of several shapes: k + 1 boundary loops.
TestMesh sheetWithHoles(uint32_t k, uint64_t seed);
/// n triangles around a centre on the boundary: degree n.
TestMesh openFan(uint32_t n);
/// One component per triangle.
TestMesh looseTriangles(uint32_t n);

/// `components` pieces with `genus` handles and `holes` boundary loops in all, of random shapes,
/// flipped, jittered and shuffled. components >= 1.
TestMesh generated(uint64_t seed, uint32_t genus, uint32_t holes, uint32_t components);

// ---- Not manifold or not orientable -------------------------------------------------------------

/// n >= 3 quads around, m >= 1 across. Faces are consistent but for the row where the strip closes.
TestMesh moebius(uint32_t n, uint32_t m);
/// n, m >= 4.
TestMesh kleinBottle(uint32_t n, uint32_t m);
/// `count` vertices with `fans` open fans of `blades` triangles each.
TestMesh bowTies(uint32_t count, uint32_t fans, uint32_t blades);
/// A chain of closed spheres, neighbours sharing one pole.
TestMesh pinchedSpheres(uint32_t count);
/// `pages` sheets of length x width quads on one spine: every spine edge has `pages` faces.
TestMesh book(uint32_t pages, uint32_t length, uint32_t width);
/// A sheet of n x n quads with an upright rib on every second row: edges of three faces.
TestMesh fins(uint32_t n);
/// Every cell of an n^3 box filled with probability `percent`.
TestMesh randomVoxels(uint64_t seed, uint32_t n, uint32_t percent);
/// n^3 cubes of six tetrahedra, all four faces of each: inner triangles come twice, once per side.
TestMesh tetrahedralSoup(uint32_t n);
/// The same tetrahedra, two faces of each, with their corners in random order: what remains of a
/// file that lists tetrahedra as quads.
TestMesh tetrahedraAsQuads(uint64_t seed, uint32_t n);
/// Every cell of an n^3 box with probability `percent`, all twelve triangles of each: inner ones
/// come twice.
TestMesh stackedCubes(uint64_t seed, uint32_t n, uint32_t percent);
/// The walls between the cells of an n^3 box and around it, once each.
TestMesh cellWalls(uint32_t n);

struct SoupOptions {
  uint32_t degenerate_percent = 0;       ///< (a,a,b) in any rotation, one in eight (a,a,a)
  uint32_t duplicate_percent = 0;        ///< an earlier triangle, rotated
  uint32_t opposite_percent = 0;         ///< an earlier triangle, turned round
  uint32_t shared_position_percent = 0;  ///< vertices that repeat an earlier vertex' position
};
/// `triangles` random triangles on `vertices` vertices; what no triangle takes is unused.
TestMesh soup(uint64_t seed, uint32_t triangles, uint32_t vertices, const SoupOptions& options);
/// A soup whose counts (3..3000 triangles, 3..300 vertices) and options are random too.
TestMesh randomSoup(uint64_t seed);

// ---- Changes ------------------------------------------------------------------------------------

/// All meshes side by side as one. Attributes are kept when every mesh has them.
TestMesh unionOf(std::span<const TestMesh> meshes, const std::string& name);
/// Random order of wedges and triangles, random rotation of each triangle.
TestMesh shuffled(TestMesh mesh, uint64_t seed);
/// Flips `flips` random inner edges (fewer where an edge cannot be flipped). The mesh must be an
/// oriented manifold without double edges, and stays one.
TestMesh flipped(TestMesh mesh, uint64_t seed, uint64_t flips);
/// Each triangle in four, `times` times.
TestMesh subdivided(TestMesh mesh, uint32_t times);
/// Removes triangles or vertex stars that touch neither each other nor a boundary: up to `holes`
/// new boundary loops. Returns how many were made.
uint32_t punchHoles(TestMesh& mesh, uint64_t seed, uint32_t holes);
/// Moves every position by up to `amount` in each coordinate.
TestMesh jittered(TestMesh mesh, uint64_t seed, float amount);
TestMesh translated(TestMesh mesh, float x, float y, float z);
/// Turns round `percent` of the triangles.
TestMesh withFlippedTriangles(TestMesh mesh, uint64_t seed, uint32_t percent);
/// Repeats `count` random triangles with the same indices; every third one turned round.
TestMesh withIndexDuplicates(TestMesh mesh, uint64_t seed, uint32_t count);
/// Repeats `count` random triangles on new wedges with the same positions; every third one turned
/// round.
TestMesh withPositionDuplicates(TestMesh mesh, uint64_t seed, uint32_t count);
/// Adds `count` degenerate triangles: on edges that exist, on pairs that are none, and (a,a,a).
TestMesh withDegenerates(TestMesh mesh, uint64_t seed, uint32_t count);
/// Adds wedges no triangle uses, every other one on a position that is in use; then shuffles.
TestMesh withUnused(TestMesh mesh, uint64_t seed, uint32_t count);
/// The whole mesh twice on the same positions, sharing no wedge.
TestMesh doubled(const TestMesh& mesh);
/// Area-weighted normals per wedge (wedges of one position are not joined).
TestMesh withNormals(TestMesh mesh);

// ---- Seams: several wedges per vertex -----------------------------------------------------------

/// A grid cut into charts of chart x chart quads with their own texture coordinates; the vertices
/// on chart borders have one wedge per chart. Has normals.
TestMesh chartGrid(uint32_t w, uint32_t h, uint32_t chart);
/// Gives every corner one of up to `wedges` copies of its vertex at random: wedges that are not
/// contiguous in their fan, and that span fans where the mesh has several at a vertex.
/// The copies differ in their texture coordinates.
TestMesh withRandomWedges(TestMesh mesh, uint64_t seed, uint32_t wedges);
/// As withRandomWedges with two copies, but the tuples of the copies are equal.
TestMesh withEqualTuples(TestMesh mesh, uint64_t seed);
/// One wedge per corner, the face normal as normal: flat shading.
TestMesh flatShaded(const TestMesh& mesh);

/// Runs every generator above with small arguments: one mesh or more of each kind, including those
/// of seams and soups.
std::vector<TestMesh> smallZoo();

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_MESH_GENERATORS_H_
