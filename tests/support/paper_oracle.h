// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// M. Isenburg, J. Snoeyink, "Mesh Collapse Compression" (SIBGRAPI 1999 and the technical report),
// word by word and slowly: digons are surfaces of half-edges with an explicit outer face of two
// edges, and edges are contracted, cut and glued one at a time. It shares no code with the codec
// and is what the codec is compared with. "Section" and "figure" mean those of the paper.
//
// Conventions
//   Half-edge 3 * t + k of triangle t runs from its corner k to its corner k + 1 (mod 3).
//   The start half-edge is the mc-edge: its origin is the mc-vertex, its target the first top.
//   Triangles are counter-clockwise in the figures. With the outer face outside and the mc-vertex
//   at the bottom, the mc-edge is the bounding edge on the right:
//
//             p  top                      mc-edge       m -> p, inside it the triangle (m, p, x1)
//           / | \                         left edge     p -> m, inside it the triangle (p, m, xn)
//     left /  xn.. x1 \ mc-edge           next mc-edge  m -> xn, after mc-contract
//           \ | /
//             m  mc-vertex
//
//   In the closed mesh xn is the neighbour of m that follows p clockwise. It is nevertheless the
//   paper's "next edge counterclockwise around the mc-vertex" (4.1): the loop takes the place of
//   the mc-edge, first counter-clockwise from the outer face, and after it comes p -> xn.
//   In this reading 4.4 is the inverse of 4.1 as both are written.
//
// What the paper leaves open, and the reading taken here
//   Divide   At the dividing edge first met from the mc-edge on the side of the next mc-edge, that
//            is, turning clockwise around the mc-vertex from the left edge. The digon between the
//            two is continued with; the other, which may be complex still, is pushed.
//            OracleSide::kOther turns this round.
//   Degree   Of the vertex in the digon: both bounding edges count (4.4 moves degree - 2 edges).
//   E        Every digon ends with one, the last too, as in the pseudo-code; table 1 does not count
//            that one. The top is pushed first, then the third vertex. The pseudo-code of 4.7 pops
//            them in this same order, which a stack cannot give.
//   Mark     The mark of a duplicate belongs to the waiting digon: after it is popped its top is
//            not pushed when it is removed, be it by mc-contract or by E. The decoder knows by the
//            next code, past all S and M, being an E: the digon is about to wait for a join.
//   Waiting  Digons wait closed, their two bounding edges glued to the mc-edge, and are opened when
//            popped. Otherwise no operation could pass over the mc-edge of a connected digon (5.2).
//   Trivial  Three vertices and no dividing edge. (On a torus three vertices alone do not suffice.)
//   M        Follows its operation in encoding order; the decoder keeps it until the operation is
//            inverted. Position 0 is the top of the digon stack as it is during the operation:
//            before a divide pushes and before E pops. Edges are numbered
//              contract  0 mc-edge m->p, 1 p->m, 2 left edge m->p, 3 p->m, 4 p->x1, 5 x1->p
//              divide    0 dividing edge m->p, 1 p->m
//              trivial   0..3 as for contract, 4 p->x, 5 x->p, 6 m->x, 7 x->m
//            The copies of m and p made when a handle breaks are vertices like any other until
//            its loop is closed: two more per handle are pushed, with the index of their original.
//            There are v - 3 + 3 * genus contracts and divides.
//   Fan      The start half-edge lies on the boundary, its triangle on its left; the patch is on
//            the side of the left edge.
#ifndef MCC_TESTS_SUPPORT_PAPER_ORACLE_H_
#define MCC_TESTS_SUPPORT_PAPER_ORACLE_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mcc::test {

inline constexpr uint32_t kOracleNone = 0xffffffffu;

/// An oriented manifold triangle mesh of one component, its boundary included.
struct OracleMesh {
  std::vector<std::array<uint32_t, 3>> triangles;
  uint32_t vertex_count = 0;
  /// Vertices from here on are dummies (5.1).
  uint32_t first_dummy = kOracleNone;
  /// Per half-edge the opposite one, kOracleNone on the boundary. Empty: by vertex pairs, which
  /// then must be unique. Needed where two vertices are joined by more than one edge.
  std::vector<uint32_t> twins;

  bool operator==(const OracleMesh&) const = default;
};

/// The vertex at the origin of a half-edge.
inline uint32_t oracleOrigin(const OracleMesh& mesh, uint32_t half_edge) {
  return mesh.triangles[half_edge / 3][half_edge % 3];
}
inline uint32_t oracleNext(uint32_t half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}
inline uint32_t oraclePrevious(uint32_t half_edge) {
  return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1;
}

enum class OracleTurn : uint8_t {
  kCounterclockwise,  ///< as in the paper's figures
  kClockwise,  ///< the mirror image: what the other setting does to the mesh turned inside out
};

/// Side of the mc-edge on which a complex digon is divided and continued with.
enum class OracleSide : uint8_t {
  kNextMcEdge,
  kOther,  ///< spheres only
};

enum class OracleBoundary : uint8_t {
  kDummies,   ///< one dummy vertex per hole
  kFanPatch,  ///< additional edges at the mc-vertex; exactly one hole; kCounterclockwise only
};

struct OracleOptions {
  OracleTurn turn = OracleTurn::kCounterclockwise;
  OracleSide side = OracleSide::kNextMcEdge;
  OracleBoundary boundary = OracleBoundary::kDummies;
  /// Checks the whole surface after each operation: quadratic.
  bool validate = false;
};

struct OracleCode {
  enum class Kind : uint8_t { kDegree, kStart, kEnd, kHandle };  // d, S, E, M

  Kind kind = Kind::kDegree;
  uint32_t degree = 0;          ///< kDegree: of the removed vertex, 3 or more
  uint32_t stack_position = 0;  ///< kHandle: 0 is the top of the digon stack
  uint32_t edge = 0;            ///< kHandle: among the edges under consideration

  bool operator==(const OracleCode&) const = default;
};

struct OracleVertex {
  uint32_t index = kOracleNone;
  bool dummy = false;

  bool operator==(const OracleVertex&) const = default;
};

/// One code word in encoding order, and what it removes: one vertex for a degree, the top and the
/// third vertex for E, none for S and M. Marked duplicates are named too.
struct OracleRecord {
  OracleCode code;
  std::array<OracleVertex, 2> vertices;

  bool operator==(const OracleRecord&) const = default;
};

/// "5(v12)", "5(v12*)" for a dummy, "S", "E(v1 v2)", "M(0 4)".
std::string toString(const OracleRecord& record);

/// Everything that the decoder gets.
struct OracleStacks {
  std::vector<OracleCode> codes;       ///< bottom first, that is, in encoding order
  std::vector<OracleVertex> vertices;  ///< the mc-vertex is at the bottom
  std::optional<uint32_t> fan_edges;   ///< additional edges of the fan patch
};

struct OracleCoding {
  std::vector<OracleRecord> records;
  OracleStacks stacks;
};

struct OracleDecoding {
  /// Triangles with dummies and patches removed, in no particular order and rotation.
  std::vector<std::array<uint32_t, 3>> triangles;
  /// The mesh before that, with twins, and its mc-edge.
  OracleMesh closed;
  uint32_t start = kOracleNone;
};

/// The mesh with twins set and one dummy vertex per hole. Holes are numbered by their lowest
/// boundary half-edge; the triangles of a hole follow in the order of the boundary's half-edges
/// around it. A boundary half-edge u -> v gets the triangle (v, u, dummy). A mesh without boundary
/// only gets twins. Triangles, and hence half-edges, of the argument keep their numbers.
OracleMesh coneHoles(const OracleMesh& mesh);

/// Encodes by sections 4.3, 5.1 and 5.2.
/// start   half-edge: of `mesh`, or with kDummies also one of coneHoles(mesh); it is the mc-edge.
/// Throws  std::invalid_argument where the mesh is not an oriented manifold of one component or
///         does not suit the options.
/// Inverse decodeByPaper() with the same options. Tests: tests/oracle/paper_oracle_test.cpp.
///
/// The same operations as the codec's, in the same order, come out when the mesh after closing its
/// holes and the orientation are the same, the codec starts with half-edge `start` from its
/// mc-vertex to its first top, and the turn and the side are the defaults. The codec keeps the link
/// of the mc-vertex as the cycle a_0, a_1, .. with half-edges a_i -> a_(i+1) of triangles
/// (mc-vertex, a_i, a_(i+1)); going forward on it is turning counter-clockwise around the
/// mc-vertex, and its step from the top p to prev(p) is the step to xn above.
OracleCoding encodeByPaper(const OracleMesh& mesh, uint32_t start,
                           const OracleOptions& options = {});

/// Decodes by section 4.7. Throws std::invalid_argument where the codes contradict themselves.
OracleDecoding decodeByPaper(const OracleStacks& stacks, const OracleOptions& options = {});

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_PAPER_ORACLE_H_
