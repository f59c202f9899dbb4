// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Mesh Collapse Compression after Isenburg & Snoeyink: the operations in decoding order. [A.4]
//
// State. The digons are circular lists of nodes: the link of the (implicit) mc-vertex, with one
// node per edge mc-vertex -- vertex. `top` is the vertex end of the mc-edge of the digon at work,
// and `stack` holds the tops of the digons that wait. The gate of node i is the edge from its
// vertex to the vertex of next(i), seen from the side that is not decoded yet.
//
//       a3 ---- a2
//      /   \   /  \   <- gates
//    a4 --  mc --  a1
//      \   /  \   /
//       a5 ---- a0 = top
//
//   EXPAND(v, r)  v takes the r gates after top = a0; the r-1 nodes between a0 and a_r close. This
//                 is an mc-expand of degree r+3.
//   SPUR          EXPAND with r = 0: v hangs on the top, whose vertex then has two nodes. It is an
//                 mc-expand of degree 3.
//   END(v1, v2)   A trivial digon; the digon at work is pushed (paper: E).
//   START         The digon on the stack is joined: mc-join (paper: S). It is a property of the
//                 operation before it, whose vertex is the stack's top.
//   TWIG          END followed by START: a spur whose top stays (paper: E, S).
//   HANDLE        Like START, but splits the cycle and puts the other part back into the stack
//                 (paper: M).
//   finish        The mc-vertex takes all gates: an END with an empty stack; the last operation.
//
// Triangles are final as soon as they are emitted, and their twins are known in the same step:
// every gate carries the half-edge of the finished triangle across it, or the gate it is glued to,
// or kGateBoundary.
#ifndef MCC_CONNECTIVITY_MC_CODES_H_
#define MCC_CONNECTIVITY_MC_CODES_H_

#include <algorithm>
#include <cstdint>

#include "base/memory.h"
#include "connectivity/digon_stack.h"
#include "entropy/models.h"
#include "entropy/numbers.h"
#include "mcc/reader.h"
#include "mesh/face_mesh.h"

namespace mcc {

/// The vertex of all dummies: the apex of the cone over a hole. Triangles with this vertex are not
/// emitted.
inline constexpr uint32_t kDummyVertex = kMaxVertices;

/// What the piece header claims about its connectivity.
struct McCounts {
  uint32_t operation_count = 0;
  uint32_t vertex_count = 0;
  uint32_t dummy_count = 0;
  uint32_t face_count = 0;
  bool has_handles = false;
};

enum class McKind : uint8_t { kExpand, kTwig, kEnd };
enum class McJoin : uint8_t { kSimple, kStart, kHandle };

/// One operation as the collapse recorded it; the list is replayed from the end. Encoder only.
struct McOperation {
  McKind kind = McKind::kExpand;
  McJoin join = McJoin::kSimple;
  bool finishes = false;  ///< kEnd: a component ends before this operation, in decoding order
  uint32_t degree = 0;    ///< kExpand: r
  uint32_t vertex_a = 0;  ///< the removed vertex; kEnd: v1
  uint32_t vertex_b = 0;  ///< kEnd, kTwig: v2
  uint32_t node_a = 0;    ///< the collapse nodes that this operation creates when it is decoded
  uint32_t node_b = 0;
  uint32_t first_gate = 0;  ///< kExpand: index of the first of r gates in McRecord::gates
  uint32_t handle = 0;      ///< kHandle: index in McRecord::handles
};

struct McHandle {
  uint32_t node = 0;         ///< collapse node on the waiting digon
  uint32_t top = 0;          ///< collapse node: top of the waiting digon
  uint32_t stack_depth = 0;  ///< digons above it
  uint32_t component = 0;    ///< in collapse order
};

/// The mc-vertex of a component and the gates of its last digon.
struct McComponent {
  uint32_t vertex = 0;
  /// Index of the first gate. There are as many as the last digon has nodes, counterclockwise from
  /// its top.
  uint32_t first_gate = 0;
};

// --- models --------------------------------------------------------------------------------------

/// The classes of operations used as contexts: EXPAND by degree 0..4, TWIG, END.
inline constexpr uint32_t kClassCount = 7;
inline constexpr uint32_t kClassTwig = 5;
inline constexpr uint32_t kClassEnd = 6;
inline constexpr uint32_t kStartAges = 6;

inline constexpr uint32_t kRunContexts = 4 * 16 * 2;  ///< [position][degree][shared]
/// [degree][class of the last operation][of the one before]
inline constexpr uint32_t kSpecialContexts = 8 * kClassCount * kClassCount;

struct McModels {
  BitModel run[kRunContexts];
  BitModel special[kSpecialContexts];
  BitModel start[kStartAges];
  BitModel kind_spur[4];
  BitModel kind_twig[4];
  BitModel kind_start[4];
  BitModel kind_end[4];
  BitModel kind_handle;
  BitModel finish;
  BitModel joined_spur[2];
  BitModel dummy_end[2];
  BitModel dummy_twig;
  BitModel dummy_finish;
  GolombModel dummy_degree;
  GolombModel handle_node;
  GolombModel handle_top;
  GolombModel handle_depth;
};

inline constexpr bool kTellsMcEdges = !kCompact;

/// An mc-edge between two vertices: `vertex` was reached from the edge's other end, `from`.
struct McEdge {
  uint32_t vertex;
  uint32_t from;
};
/// The same as half-edges that begin at the two vertices.
struct McEdgeCorners {
  uint32_t of_vertex;
  uint32_t of_from;
};

/// What a caller wants to know about the operations; members may be null.
struct McWatch {
  CodeHistogram* histogram = nullptr;
  Array<McEdge>* edges = nullptr;

  void count(uint64_t CodeHistogram::*field) const {
    if (histogram != nullptr) ++(histogram->*field);
  }
  void countDegree(uint32_t degree) const {
    if (histogram != nullptr) ++histogram->degree[std::min(degree, 255u)];
  }
  /// Reserves room for all edges: at most two per operation, and one for the end of the last
  /// component.
  [[nodiscard]] bool reserve(uint32_t operation_count) const {
    return !kTellsMcEdges || edges == nullptr || edges->reserve(2 * size_t{operation_count} + 1);
  }
  void noteEdge(uint32_t vertex, uint32_t from) const {
    if constexpr (kTellsMcEdges) {
      if (edges != nullptr && vertex != kDummyVertex && from != kDummyVertex)
        (void)edges->push_back(McEdge{vertex, from});
    }
  }
};

// --- the machine ---------------------------------------------------------------------------------

inline constexpr uint32_t kGateFlag = 1u << 31;  ///< gate | kGateFlag: glued to another gate
inline constexpr uint32_t kGateBoundary = kNone;
inline constexpr uint32_t kClosedNode = kNone;  ///< vertex of a node that has left its digon

struct McNode {
  uint32_t next;
  uint32_t vertex;
  uint32_t gate;    ///< half-edge across the gate, kGateFlag | node, or kGateBoundary
  uint16_t degree;  ///< edges of the vertex so far, saturating
  uint16_t shared;  ///< the vertex has another node
};

/// What the encoder knows and the decoder learns; the pointers are null when decoding.
struct McTruth {
  const McOperation* operations = nullptr;  ///< in collapse order
  const McHandle* handles = nullptr;
  const McComponent* components = nullptr;  ///< in collapse order
  uint32_t component_count = 0;
  const uint32_t* gates = nullptr;
  const uint8_t* vertex_is_dummy = nullptr;   ///< by source vertex
  uint32_t* node_of_collapse_node = nullptr;  ///< work space
  uint32_t* source_of_vertex = nullptr;       ///< out: source vertex of each decoded vertex
  uint32_t* source_gate_of_face = nullptr;    ///< out: source half-edge of half-edge 8f+1
};

template <class Io>
class McMachine {
 public:
  McMachine(Io& io, McModels& models, const McCounts& counts, FaceMesh& mesh, const McTruth& truth)
      : io_(io),
        models_(models),
        counts_(counts),
        nodes_(mesh.allocator()),
        stack_(mesh.allocator()),
        mesh_(mesh),
        truth_(truth) {}

  /// Runs all operations and fills `mesh`, whose words must have room for
  /// counts.face_count faces. [A.4.2]
  Status run(const McWatch* watch = nullptr);

 private:
  /// The fan of triangles that one operation emits.
  struct Fan {
    /// Half-edge from the new vertex to the first gate; kNone if no triangle is there.
    uint32_t first_left = kNone;
    uint32_t last_right = kNone;  ///< half-edge from the last gate back to the new vertex
    uint32_t taken = 0;           ///< number of gates
  };

  /// Returns the context of a run's decisions: [position][degree][shared].
  static MCC_INLINE uint32_t runContext(uint32_t position, const McNode& node) {
    return (std::min(position, 4u) - 1) * 32 + std::min<uint32_t>(node.degree, 15) * 2 +
           node.shared;
  }

  using CodesBurst = typename Io::CodesBurst;

  // These code one operation.
  Status codeOperation(const McOperation* op);
  Status codeSpecial(const McOperation* op);
  Status codeEnd(const McOperation* op, bool first);
  Status codeExpand(const McOperation* op, McJoin join);
  Status codeRun(CodesBurst& codes, const McOperation* op, uint32_t vertex);
  Status codeDummyRun(const McOperation* op);
  Status expandSpur(const McOperation* op, uint32_t vertex);
  uint32_t specialContext() const;
  bool codeStartFlag(CodesBurst& codes, const McOperation* op);
  void remember(uint32_t operation_class);

  // These change the lists.
  Status newNode(uint32_t vertex, uint32_t degree, uint32_t& node);
  Status newVertex(bool dummy, uint32_t source, uint32_t& vertex);
  Status endRun(const McOperation* op, uint32_t vertex, uint32_t q, const Fan& fan);
  bool takeGate(uint32_t vertex, uint32_t node, Fan& fan, uint32_t source_gate);
  /// Does the same outside the inner loop.
  MCC_SHARED bool takeOther(uint32_t vertex, uint32_t node, Fan& fan, uint32_t source_gate) {
    return takeGate(vertex, node, fan, source_gate);
  }
  static Status tooManyTriangles() {
    return fail(Error::kBadConnectivity, "the codes yield more triangles than the header claims");
  }
  void closeNodes(uint32_t first, uint32_t last);
  Status spur(uint32_t vertex, uint32_t& first, uint32_t& second);
  void swapLinks(uint32_t a, uint32_t b);
  void pointBack(uint32_t node);
  Status joinStart();
  Status joinHandle(const McOperation* op, uint32_t handle_node);
  Status finishComponent();
  bool isWatched() const { return !kCompact && watch_ != nullptr; }
  void count(uint64_t CodeHistogram::*field) {
    if (isWatched()) [[unlikely]]
      watch_->count(field);
  }
  void countDegree(uint32_t degree) {
    if (isWatched()) [[unlikely]]
      watch_->countDegree(degree);
  }
  void noteEdge(uint32_t vertex, uint32_t from) {
    if (isWatched()) [[unlikely]]
      watch_->noteEdge(vertex, from);
  }

  static void addDegree(McNode& node, uint32_t edges) {
    node.degree = static_cast<uint16_t>(std::min<uint32_t>(node.degree + edges, 0xffff));
  }

  Io& io_;
  McModels& models_;
  const McCounts counts_;
  Array<McNode> nodes_;
  DigonStack stack_;
  FaceMesh& mesh_;
  const McTruth truth_;
  const McWatch* watch_ = nullptr;

  uint32_t top_ = kNone;
  uint32_t free_ = kNone;  ///< closed nodes that can be used again, linked by `next`
  uint32_t vertex_count_ = 0;
  uint32_t dummy_count_ = 0;
  uint32_t face_count_ = 0;
  uint32_t component_ = 0;
  uint32_t operation_ = 0;  ///< operations started
  uint32_t age_ = 0;        ///< operations since the last END
  uint32_t last_class_ = kClassEnd;
  uint32_t class_before_ = kClassEnd;
};

template <class Io>
Status McMachine<Io>::run(const McWatch* watch) {
  watch_ = watch;
  // Handles refer to nodes by number, so with handles no node is reused and there is about one per
  // vertex. Without handles there are only as many as are open at the same time.
  const uint64_t expected = uint64_t{counts_.vertex_count} + counts_.vertex_count / 8;
  const uint64_t first = counts_.has_handles ? expected : std::min<uint64_t>(expected, 1u << 10);
  // A size of 32 bits may cut it off. Then less is reserved, and push_back() asks for the rest.
  if (!nodes_.reserve(static_cast<size_t>(first))) {
    return fail(Error::kOutOfMemory, "no memory for the connectivity decoder");
  }
  if (isWatched() && !watch_->reserve(counts_.operation_count)) {
    return fail(Error::kOutOfMemory, "no memory for the mc-edges");
  }
  for (uint32_t i = 0; operation_ < counts_.operation_count; ++i) {
    const McOperation* op =
        Io::kEncoding ? truth_.operations + (counts_.operation_count - 1 - operation_) : nullptr;
    ++operation_;
    MCC_TRY(top_ == kNone ? codeEnd(op, true) : codeOperation(op));
    if ((i & 0xfff) == 0 && io_.overrun()) {
      return fail(Error::kTruncated, "the code stream ends before its last operation");
    }
  }
  if (top_ != kNone) MCC_TRY(finishComponent());
  if (vertex_count_ != counts_.vertex_count || face_count_ != counts_.face_count ||
      dummy_count_ != counts_.dummy_count) {
    return fail(Error::kBadConnectivity,
                "the codes do not yield the counts that the header claims");
  }
  mesh_.face_count = face_count_;
  mesh_.vertex_count = vertex_count_;
  return {};
}

// --- coding --------------------------------------------------------------------------------------

template <class Io>
MCC_INLINE uint32_t McMachine<Io>::specialContext() const {
  const uint32_t degree = std::min<uint32_t>(nodes_[top_].degree, 7);
  return (degree * kClassCount + last_class_) * kClassCount + class_before_;
}

template <class Io>
MCC_INLINE void McMachine<Io>::remember(uint32_t operation_class) {
  class_before_ = last_class_;
  last_class_ = operation_class;
}

template <class Io>
MCC_INLINE bool McMachine<Io>::codeStartFlag(CodesBurst& codes, const McOperation* op) {
  if (age_ >= kStartAges || stack_.empty()) return false;
  return codes.bit(models_.start[age_],
                   Io::kEncoding && op->kind == McKind::kExpand && op->join == McJoin::kStart);
}

template <class Io>
MCC_INLINE Status McMachine<Io>::codeOperation(const McOperation* op) {
  CodesBurst codes(io_);
  if (codeStartFlag(codes, op)) {
    codes.giveBack(io_);
    return codeExpand(op, McJoin::kStart);
  }
  const bool is_special =
      Io::kEncoding && (op->kind != McKind::kExpand || op->join != McJoin::kSimple ||
                        op->degree == 0 || truth_.vertex_is_dummy[op->vertex_a] != 0);
  if (!codes.bit(models_.special[specialContext()], is_special)) [[likely]] {
    uint32_t vertex = 0;
    MCC_TRY(newVertex(false, Io::kEncoding ? op->vertex_a : 0, vertex));
    return codeRun(codes, op, vertex);
  }
  codes.giveBack(io_);
  return codeSpecial(op);
}

/// Codes all operations except the EXPAND of a new vertex that takes gates.
template <class Io>
Status McMachine<Io>::codeSpecial(const McOperation* op) {
  const uint32_t context = std::min<uint32_t>(std::max<uint32_t>(nodes_[top_].degree, 1) - 1, 3);
  const bool plain_expand = Io::kEncoding && op->kind == McKind::kExpand &&
                            op->join == McJoin::kSimple &&
                            truth_.vertex_is_dummy[op->vertex_a] == 0;
  if (io_.bit(models_.kind_spur[context], plain_expand)) {
    uint32_t vertex = 0;
    MCC_TRY(newVertex(false, Io::kEncoding ? op->vertex_a : 0, vertex));
    return expandSpur(op, vertex);
  }
  if (io_.bit(models_.kind_twig[context], Io::kEncoding && op->kind == McKind::kTwig)) {
    const bool dummy =
        dummy_count_ < counts_.dummy_count &&
        io_.bit(models_.dummy_twig, Io::kEncoding && truth_.vertex_is_dummy[op->vertex_b] != 0);
    uint32_t vertex = 0;
    MCC_TRY(newVertex(dummy, Io::kEncoding ? op->vertex_b : 0, vertex));
    uint32_t tip = 0;
    uint32_t copy = 0;
    MCC_TRY(spur(vertex, tip, copy));
    if constexpr (Io::kEncoding) {
      truth_.node_of_collapse_node[op->node_a] = copy;
      truth_.node_of_collapse_node[op->node_b] = tip;
    }
    nodes_[copy].shared = nodes_[top_].shared;
    nodes_[top_].shared = 1;
    addDegree(nodes_[copy], 1);
    top_ = copy;
    ++age_;
    remember(kClassTwig);
    count(&CodeHistogram::end);
    count(&CodeHistogram::start);
    return {};
  }
  if (!stack_.empty() &&
      io_.bit(models_.kind_start[context],
              Io::kEncoding && op->kind == McKind::kExpand && op->join == McJoin::kStart)) {
    return codeExpand(op, McJoin::kStart);
  }
  const bool may_be_other = counts_.has_handles || dummy_count_ < counts_.dummy_count;
  if (!may_be_other ||
      io_.bit(models_.kind_end[context], Io::kEncoding && op->kind == McKind::kEnd)) {
    return codeEnd(op, false);
  }
  const bool handle_possible = counts_.has_handles;
  const bool dummy_possible = dummy_count_ < counts_.dummy_count;
  bool handle = handle_possible;
  if (handle_possible && dummy_possible) {
    handle = io_.bit(models_.kind_handle, Io::kEncoding && op->join == McJoin::kHandle);
  }
  if (handle) return codeExpand(op, McJoin::kHandle);
  uint32_t vertex = 0;
  MCC_TRY(newVertex(true, Io::kEncoding ? op->vertex_a : 0, vertex));
  count(&CodeHistogram::dummy);
  return codeDummyRun(op);
}

/// Codes an END, preceded by the end of the component if the stack is empty. [A.4.3]
template <class Io>
Status McMachine<Io>::codeEnd(const McOperation* op, bool first) {
  if (!first) {
    bool finishes = false;
    if (stack_.empty()) finishes = io_.bit(models_.finish, Io::kEncoding && op->finishes);
    if (finishes) {
      MCC_TRY(finishComponent());
    } else if (!stack_.insertBelow(0, top_)) {
      return fail(Error::kOutOfMemory, "no memory for the digon stack");
    }
  }
  uint32_t vertex[2] = {};
  for (int i = 0; i < 2; ++i) {
    const uint32_t source = Io::kEncoding ? (i == 0 ? op->vertex_a : op->vertex_b) : 0;
    const bool dummy =
        dummy_count_ < counts_.dummy_count &&
        io_.bit(models_.dummy_end[i], Io::kEncoding && truth_.vertex_is_dummy[source] != 0);
    MCC_TRY(newVertex(dummy, source, vertex[i]));
  }
  uint32_t a = 0;
  uint32_t b = 0;
  MCC_TRY(newNode(vertex[0], 1, a));
  MCC_TRY(newNode(vertex[1], 1, b));
  if constexpr (Io::kEncoding) {
    truth_.node_of_collapse_node[op->node_a] = a;
    truth_.node_of_collapse_node[op->node_b] = b;
  }
  nodes_[a].next = b;
  nodes_[b].next = a;
  nodes_[a].gate = kGateFlag | b;
  nodes_[b].gate = kGateFlag | a;
  noteEdge(vertex[0], vertex[1]);
  top_ = a;
  age_ = 0;
  remember(kClassEnd);
  count(&CodeHistogram::end);
  return {};
}

/// Codes an EXPAND that is joined with another digon, so that its vertex is not new. [A.4.4]
template <class Io>
Status McMachine<Io>::codeExpand(const McOperation* op, McJoin join) {
  uint32_t vertex = 0;
  uint32_t handle_node = kNone;
  if (join == McJoin::kStart) {
    vertex = nodes_[stack_.top()].vertex;
    if (vertex == kClosedNode) return fail(Error::kBadConnectivity, "a waiting digon was closed");
  } else {
    const uint32_t last = static_cast<uint32_t>(nodes_.size()) - 1;
    uint32_t back = 0;
    if constexpr (Io::kEncoding) {
      back = last - truth_.node_of_collapse_node[truth_.handles[op->handle].node];
    }
    back = codeGolomb(io_, models_.handle_node, back);
    if (back > last)
      return fail(Error::kBadConnectivity, "a handle refers to a node that is not there");
    handle_node = last - back;
    vertex = nodes_[handle_node].vertex;
    if (vertex == kClosedNode)
      return fail(Error::kBadConnectivity, "a handle refers to a closed node");
  }
  const bool dummy = vertex == kDummyVertex;
  const bool is_spur = !dummy && io_.bit(models_.joined_spur[join == McJoin::kStart ? 0 : 1],
                                         Io::kEncoding && op->degree == 0);
  if (dummy) {
    MCC_TRY(codeDummyRun(op));
  } else {
    CodesBurst codes(io_);
    MCC_TRY(is_spur ? expandSpur(op, vertex) : codeRun(codes, op, vertex));
  }
  return join == McJoin::kStart ? joinStart() : joinHandle(op, handle_node);
}

/// Codes an EXPAND of degree 3, which takes no gate. [A.4.5]
template <class Io>
Status McMachine<Io>::expandSpur(const McOperation* op, uint32_t vertex) {
  uint32_t tip = 0;
  uint32_t copy = 0;
  MCC_TRY(spur(vertex, tip, copy));
  if constexpr (Io::kEncoding) {
    truth_.node_of_collapse_node[op->node_a] = tip;
    truth_.node_of_collapse_node[op->node_b] = copy;
  }
  nodes_[copy].shared = 1;
  addDegree(nodes_[top_], 1);
  top_ = tip;
  ++age_;
  remember(0);
  countDegree(3);
  return {};
}

/// Codes the degree of an EXPAND, gate by gate: "close the next vertex too?". The decoder spends
/// most of its time here, so everything this loop needs is local, and each node is read
/// once. [A.4.5]
template <class Io>
MCC_CALLED_IF_SMALL Status McMachine<Io>::codeRun(CodesBurst& codes, const McOperation* op,
                                                  uint32_t vertex) {
  const McNode* const nodes = nodes_.data();
  BitModel* const models = models_.run;
  const uint32_t top = top_;
  const uint32_t first_closed = nodes[top].next;
  uint32_t before = top;
  uint32_t q = top;
  Fan fan;
  for (;;) {
    if (!takeGate(vertex, q, fan, Io::kEncoding ? truth_.gates[op->first_gate + fan.taken] : 0))
        [[unlikely]]
      return tooManyTriangles();
    before = q;
    q = nodes[q].next;
    if (q == top) break;
    BitModel& model = models[runContext(fan.taken, nodes[q])];
    if (!codes.bit(model, Io::kEncoding && fan.taken < op->degree)) break;
  }
  codes.giveBack(io_);
  if (before != top) closeNodes(first_closed, before);
  return endRun(op, vertex, q, fan);
}

/// Codes a dummy vertex. Its degree comes first, because holes have any size. [A.4.5]
template <class Io>
Status McMachine<Io>::codeDummyRun(const McOperation* op) {
  const uint32_t degree = codeGolomb(io_, models_.dummy_degree, Io::kEncoding ? op->degree : 0);
  if (degree == 0) return expandSpur(op, kDummyVertex);
  const uint32_t first_closed = nodes_[top_].next;
  uint32_t before = top_;
  uint32_t q = top_;
  Fan fan;
  do {
    (void)takeOther(kDummyVertex, q, fan, 0);  // emits nothing
    before = q;
    q = nodes_[q].next;
  } while (fan.taken < degree && q != top_);
  if (fan.taken != degree) {
    return fail(Error::kBadConnectivity, "a dummy vertex takes more edges than its digon has");
  }
  if (before != top_) closeNodes(first_closed, before);
  return endRun(op, kDummyVertex, q, fan);
}

/// Puts the new vertex in the place of the closed ones: top -> node -> q.
template <class Io>
MCC_CALLED_IF_SMALL Status McMachine<Io>::endRun(const McOperation* op, uint32_t vertex, uint32_t q,
                                                 const Fan& fan) {
  uint32_t node = 0;
  MCC_TRY(newNode(vertex, fan.taken + 1, node));
  if constexpr (Io::kEncoding) truth_.node_of_collapse_node[op->node_a] = node;
  if (isWatched()) [[unlikely]] {
    watch_->noteEdge(vertex, nodes_[top_].vertex);
    watch_->countDegree(fan.taken + 3);
  }
  addDegree(nodes_[top_], 1);
  addDegree(nodes_[q], 1);
  nodes_[top_].next = node;
  nodes_[node].next = q;
  nodes_[top_].gate = fan.first_left;
  nodes_[node].gate = fan.last_right;
  top_ = node;
  ++age_;
  remember(std::min(fan.taken, 4u));
  return {};
}

// --- lists ---------------------------------------------------------------------------------------

template <class Io>
MCC_CALLED_IF_SMALL Status McMachine<Io>::newNode(uint32_t vertex, uint32_t degree,
                                                  uint32_t& node) {
  const uint16_t clamped = static_cast<uint16_t>(std::min(degree, 0xffffu));
  if (free_ != kNone) [[likely]] {
    node = free_;
    free_ = nodes_[node].next;
    nodes_[node] = McNode{node, vertex, kGateBoundary, clamped, 0};
    return {};
  }
  if (nodes_.size() >= kMaxVertices) return fail(Error::kLimit, "too many digon nodes");
  node = static_cast<uint32_t>(nodes_.size());
  if (!nodes_.push_back(McNode{node, vertex, kGateBoundary, clamped, 0})) {
    return fail(Error::kOutOfMemory, "no memory for the connectivity decoder");
  }
  return {};
}

template <class Io>
MCC_INLINE Status McMachine<Io>::newVertex(bool dummy, uint32_t source, uint32_t& vertex) {
  if (dummy) {
    ++dummy_count_;  // callers have checked that a dummy is left
    vertex = kDummyVertex;
    return {};
  }
  if (vertex_count_ == counts_.vertex_count) {
    return fail(Error::kBadConnectivity, "the codes create more vertices than the header claims");
  }
  if constexpr (Io::kEncoding) truth_.source_of_vertex[vertex_count_] = source;
  vertex = vertex_count_++;
  return {};
}

/// Emits the triangle (vertex, node's vertex, next node's vertex) across the gate of `node`, unless
/// it touches a dummy. Returns false if there are more triangles than the header claims.
template <class Io>
MCC_INLINE bool McMachine<Io>::takeGate(uint32_t vertex, uint32_t node, Fan& fan,
                                        uint32_t source_gate) {
  McNode* nodes = nodes_.data();
  uint32_t* words = mesh_.words.data();
  const McNode& n = nodes[node];
  const uint32_t va = n.vertex;
  const uint32_t vb = nodes[n.next].vertex;
  const uint32_t gate = n.gate;  // read only now: the triangle before may have been glued to it
  uint32_t left = kNone;
  uint32_t base = kNone;
  if (std::max(vertex, std::max(va, vb)) < kDummyVertex) [[likely]] {
    if (face_count_ == counts_.face_count) return false;
    if constexpr (Io::kEncoding) truth_.source_gate_of_face[face_count_] = source_gate;
    left = face_count_++ * kFaceWords;
    base = left + 1;
    uint32_t* face = words + left;
    face[0] = vertex;
    face[1] = va;
    face[2] = vb;
    face[kFaceWord] = 0;
    face[4] = fan.last_right;
    face[5] = gate < kGateFlag ? gate : kNone;
    face[6] = kNone;
    face[kSeamWord] = 0;
  }
  if (gate < kGateFlag) {
    words[gate + 4] = base;
  } else if (gate != kGateBoundary) {
    nodes[gate ^ kGateFlag].gate = base;  // kNone is kGateBoundary
  }
  if (fan.taken == 0) {
    fan.first_left = left;
  } else if (fan.last_right != kNone) {
    words[fan.last_right + 4] = left;
  }
  fan.last_right = left == kNone ? kNone : left + 2;
  ++fan.taken;
  return true;
}

/// Closes the nodes from `first` to `last` along `next`. Invariant: `next` permutes the open nodes,
/// so every walk along a digon ends where it began, whatever the stream says. Only a handle can
/// refer to nodes outside the digon at work. With handles, closed nodes are therefore marked;
/// without, they are reused.
template <class Io>
MCC_CALLED_IF_SMALL void McMachine<Io>::closeNodes(uint32_t first, uint32_t last) {
  if (!counts_.has_handles) {
    nodes_[last].next = free_;
    free_ = first;
    return;
  }
  for (uint32_t q = first;; q = nodes_[q].next) {
    nodes_[q].vertex = kClosedNode;
    if (q == last) return;
  }
}

/// Inserts `tip` (of a new vertex) and `copy` (of the top's vertex) after the top: top -> tip ->
/// copy.
template <class Io>
Status McMachine<Io>::spur(uint32_t vertex, uint32_t& tip, uint32_t& copy) {
  MCC_TRY(newNode(nodes_[top_].vertex, nodes_[top_].degree + 1u, copy));
  MCC_TRY(newNode(vertex, 1, tip));
  McNode& t = nodes_[top_];
  noteEdge(vertex, t.vertex);
  addDegree(t, 1);
  nodes_[copy].next = t.next;
  nodes_[copy].gate = t.gate;
  pointBack(copy);
  nodes_[tip].next = copy;
  t.next = tip;
  t.gate = kGateFlag | tip;
  nodes_[tip].gate = kGateFlag | top_;
  return {};
}

/// If a gate is glued to the gate of `node`, tells it where that gate is now.
template <class Io>
void McMachine<Io>::pointBack(uint32_t node) {
  const uint32_t gate = nodes_[node].gate;
  if (gate >= kGateFlag && gate != kGateBoundary) nodes_[gate ^ kGateFlag].gate = kGateFlag | node;
}

template <class Io>
void McMachine<Io>::swapLinks(uint32_t a, uint32_t b) {
  std::swap(nodes_[a].next, nodes_[b].next);
  if (nodes_[a].gate == (kGateFlag | b)) return;  // glued to each other, and they stay so
  std::swap(nodes_[a].gate, nodes_[b].gate);
  pointBack(a);
  pointBack(b);
}

template <class Io>
Status McMachine<Io>::joinStart() {
  const uint32_t s = stack_.top();
  stack_.pop();
  if (nodes_[s].vertex == kClosedNode) {  // closed by this very operation
    return fail(Error::kBadConnectivity, "a waiting digon was closed");
  }
  swapLinks(top_, s);
  const uint32_t degree = uint32_t{nodes_[top_].degree} + nodes_[s].degree;
  nodes_[s].degree = static_cast<uint16_t>(std::min(degree, 0xffffu));
  nodes_[s].shared = 1;
  nodes_[top_].degree = static_cast<uint16_t>(std::min(degree + 1, 0xffffu));
  count(&CodeHistogram::start);
  return {};
}

/// Splits the cycle at two nodes of one vertex; the other part is inserted below `depth` digons.
template <class Io>
Status McMachine<Io>::joinHandle(const McOperation* op, uint32_t handle_node) {
  uint32_t other_top = 0;
  uint32_t depth = 0;
  if constexpr (Io::kEncoding) {
    other_top = truth_.node_of_collapse_node[truth_.handles[op->handle].top];
    depth = truth_.handles[op->handle].stack_depth;
  }
  const int32_t difference =
      codeSignedGolomb(io_, models_.handle_top, static_cast<int32_t>(other_top - handle_node));
  other_top = handle_node + static_cast<uint32_t>(difference);
  depth = codeGolomb(io_, models_.handle_depth, depth);
  if (other_top >= nodes_.size() || depth > kMaxHandleDepth || depth > stack_.size() ||
      nodes_[other_top].vertex == kClosedNode || nodes_[handle_node].vertex == kClosedNode) {
    return fail(Error::kBadConnectivity, "a handle refers to a digon that is not there");
  }
  swapLinks(top_, handle_node);
  if (!stack_.insertBelow(depth, other_top)) {
    return fail(Error::kOutOfMemory, "no memory for the digon stack");
  }
  nodes_[handle_node].shared = 1;
  addDegree(nodes_[top_], 1);
  count(&CodeHistogram::handle);
  return {};
}

/// Ends a component: the mc-vertex takes all gates of the last digon. [A.4.6]
template <class Io>
Status McMachine<Io>::finishComponent() {
  if (!stack_.empty()) {
    return fail(Error::kBadConnectivity, "a component ends while digons wait on the stack");
  }
  const McComponent* component = nullptr;
  if constexpr (Io::kEncoding) {
    component = truth_.components + (truth_.component_count - 1 - component_);
  }
  const bool dummy = dummy_count_ < counts_.dummy_count &&
                     io_.bit(models_.dummy_finish,
                             Io::kEncoding && truth_.vertex_is_dummy[component->vertex] != 0);
  uint32_t vertex = 0;
  MCC_TRY(newVertex(dummy, Io::kEncoding ? component->vertex : 0, vertex));
  noteEdge(vertex, nodes_[top_].vertex);
  uint32_t before = top_;
  uint32_t q = top_;
  Fan fan;
  do {
    if (!takeOther(vertex, q, fan,
                   Io::kEncoding ? truth_.gates[component->first_gate + fan.taken] : 0)) {
      return tooManyTriangles();
    }
    before = q;
    q = nodes_[q].next;
  } while (q != top_);
  closeNodes(top_, before);
  uint32_t* words = mesh_.words.data();
  if (fan.first_left != kNone) words[fan.first_left + 4] = fan.last_right;
  if (fan.last_right != kNone) words[fan.last_right + 4] = fan.first_left;
  top_ = kNone;
  ++component_;
  return {};
}

}  // namespace mcc

#endif  // MCC_CONNECTIVITY_MC_CODES_H_
