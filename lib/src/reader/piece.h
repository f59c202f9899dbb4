// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stages of one piece, in payload order, for reader and writer alike: [A.2.7]
//
//   codeConnectivity mesh collapse codes -> faces, twins            connectivity/mc_codes.h   [A.4]
//                    or faces vertex by vertex                      connectivity/pivots.h [A.4.7]
//   codeStitch       which cut vertices share a position -> groups  connectivity/stitch.h     [A.5]
//   codePositions    positions of groups and isolated vertices      positions/positions.h     [A.6]
//   codeSeams        corners -> wedges                              surface/seams.h           [A.7]
//   codeLeftovers    parts, duplicate and degenerate triangles      surface/leftovers.h       [A.8]
//   codeOrders       the source's order of triangles and wedges     surface/order.h [A.9]
//   codeAttribute    the other attributes, along the same traversal reader/attribute_stage.h [A.10]
//
// The writer runs the same stages with an encoder and with pointers to what it knows (PieceTruth).
#ifndef MCC_READER_PIECE_H_
#define MCC_READER_PIECE_H_

#include <new>
#include <optional>

#include "base/lazy.h"
#include "connectivity/mc_codes.h"
#include "connectivity/pivots.h"
#include "connectivity/stitch.h"
#include "container/payload_header.h"
#include "exact/tails.h"
#include "format/decodes.h"
#include "format/predictors.h"
#include "positions/isolated.h"
#include "positions/mirrored.h"
#include "positions/positions.h"
#include "reader/attribute_stage.h"
#include "surface/leftovers.h"
#include "surface/order.h"
#include "surface/seams.h"

namespace mcc {

/// Adaptive models of a payload; all its pieces share them.
struct PayloadModels {
  McModels mc;
  Lazy<PivotModels> pivots;
  Lazy<StitchModels> stitch;
  PositionModels positions;
  Lazy<MirrorModels> mirrors;
  IsolatedModels isolated;
  TailModels position_tails;
  SeamModels seams;
  LeftoverModels leftovers;
  Lazy<OrderModels> orders;
  AttributeModels attributes;

  /// Becomes what `o` is, in memory of `a`. Blocks have no pivots and keep no orders. Returns false
  /// when memory ran out.  [A.11.2]
  [[nodiscard]] bool copyFrom(const PayloadModels& o, const Allocator& a) {
    mc = o.mc;
    positions = o.positions;
    isolated = o.isolated;
    position_tails = o.position_tails;
    seams = o.seams;
    leftovers = o.leftovers;
    return stitch.copyFrom(o.stitch, a) && attributes.copyFrom(o.attributes, a);
  }
};

/// What the writer knows about a piece, stage by stage; all null when reading.
struct PieceTruth {
  McTruth connectivity;
  const PivotFace* pivot_faces = nullptr;     ///< only if the piece has pivots
  const uint32_t* class_of_vertex = nullptr;  ///< by decoded vertex
  uint32_t class_count = 0;
  const int32_t* positions = nullptr;  ///< 3 per group; isolated vertices follow
  /// The same as ordered floats, if they are on an exact grid.
  const int32_t* exact_positions = nullptr;
  const AxisPalette* palettes = nullptr;    ///< 3, if the position has them
  const AxisPlanes* planes = nullptr;       ///< 3, if the position has them
  const Mirrors* mirrors = nullptr;         ///< if the piece has them
  const Anchor* anchors = nullptr;          ///< by group, if the piece has them
  const uint32_t* corner_source = nullptr;  ///< source wedge of corner 3f+k
  LeftoverTruth leftovers;
  const uint32_t* triangle_order = nullptr;  ///< see TriangleOrderCoder
  const uint32_t* wedge_order = nullptr;     ///< wedge by place
};

/// The inner loops of positions that are compiled for an Io with kFast; the first that fits is
/// taken. USE(which, modes): see fixedModes(). docs/performance.md says what each is worth. With
/// MCC_ONE_LOOP there is one for all choices, which takes half of the time to compile.
#if defined(MCC_ONE_LOOP)
#define MCC_PLAIN_MODES(USE) USE(0, 0)
#define MCC_KIND_MODES(USE)
#else
#define MCC_PLAIN_MODES(USE)               \
  USE(kLoopModes, 0)                       \
  USE(kLoopModes, position_mode::kWeights) \
  USE(kLoopModes, position_mode::kWeights | position_mode::kSelect)
#define MCC_KIND_MODES(USE)                                         \
  USE(kLoopModes, position_mode::kWeights | position_mode::kShear)  \
  USE(position_mode::kKinds, position_mode::kShear)                 \
  USE(position_mode::kKinds, position_mode::kPalette)               \
  USE(kLoopModes, position_mode::kWeights | position_mode::kPlanes) \
  USE(position_mode::kKinds, position_mode::kPlanes)
#endif

/// What the stages of a piece make of it, whatever they code through.
class CodedPiece {
 public:
  CodedPiece(const PieceHeader& header, AttributeInfos attributes, const Allocator& allocator)
      : mesh(allocator),
        mc_edges(allocator),
        groups(allocator),
        records(allocator),
        mates(allocator),
        sequence(allocator),
        wedge_group(allocator),
        list(allocator),
        triangles(allocator),
        triangle_order(allocator),
        wedge_order(allocator),
        header_(header),
        attributes_(attributes) {}

  /// Fills `triangles`. Returns false when memory ran out.
  [[nodiscard]] bool listTriangles() {
    // All of them were decoded, so their number fits in memory.
    const auto count = static_cast<size_t>(header_.triangleCount());
    const bool many = header_.part_count > 1;
    if (!triangles.wedges.resize(3 * count) || !triangles.part.resize(many ? count : 0))
      return false;
    uint32_t next = 0;
    const auto add = [&](const uint32_t* corners, uint32_t part) {
      for (uint32_t k = 0; k < 3; ++k) triangles.wedges[3 * size_t{next} + k] = corners[k];
      if (many) triangles.part[next] = part;
      ++next;
    };
    for (uint32_t f = 0; f < mesh.face_count; ++f) {
      const uint32_t* face = mesh.words.data() + size_t{f} * kFaceWords;
      add(face, face[kFaceWord]);
    }
    for (size_t i = 0; i < list.size(); ++i) add(list[i].wedge, list[i].part);
    return true;
  }

  uint32_t codedComponentsOf(uint32_t index) const { return codedComponents(attributes_, index); }

  bool needsSequence() const {
    return header_.has(piece_flag::kSeams) || header_.attribute_count > 1;
  }
  /// Returns the group whose record holds the position of a wedge. Isolated vertices come after the
  /// groups.
  uint32_t groupOf(uint32_t wedge) const {
    if (decodes::kIsolated && wedge >= wedges.isolated_first)
      return groups.count + (wedge - wedges.isolated_first);
    return header_.has(piece_flag::kSeams) ? wedge_group[wedge] : wedge;
  }

  FaceMesh mesh;  ///< corners hold vertices, after codeStitch() groups, after codeSeams() wedges
  Array<McEdgeCorners> mc_edges;  ///< only if wanted
  Groups groups;
  Array<VertexRecord> records;  ///< by group
  VertexMates mates;            ///< of groups, only with mirrors
  /// A half-edge per group, after codeSeams() per wedge, in coding order.
  Array<uint32_t> sequence;
  Array<uint32_t> wedge_group;  ///< only with seams
  WedgeSequence wedges;
  Array<ListedTriangle> list;
  TriangleTable triangles;         ///< only if an order is kept
  Array<uint32_t> triangle_order;  ///< see TriangleOrderCoder; empty if not kept
  Array<uint32_t> wedge_order;     ///< wedge by place; empty if not kept

 protected:
  const PieceHeader& header_;
  const AttributeInfos attributes_;
};

/// Runs the stages of a piece. The stages that take long to compile are defined below; for the
/// reader's and the writer's Ios they are compiled in files of their own, see instances.h.
template <SymbolIo Io>
class PieceCoder : public CodedPiece {
 public:
  PieceCoder(Io& io, PayloadModels& models, const PieceHeader& header, AttributeInfos attributes,
             const Allocator& allocator)
      : CodedPiece(header, attributes, allocator),
        io_(io),
        models_(models),
        allocator_(allocator),
        stage_(io, models.attributes, attributes, allocator),
        group_positions_(allocator) {}

  /// Counts codes in `histogram` if it is not null. Fills mc_edges if `wants_mc_edges`.
  Status codeConnectivity(const PieceTruth& truth, CodeHistogram* histogram = nullptr,
                          bool wants_mc_edges = false);

  Status codeStitch(const PieceTruth& truth);

  /// The writer passes the fitted tables that the position's flags ask for in `fitted`.
  Status codePositions(const PieceTruth& truth, const PositionParameters* fitted = nullptr);

  Status codeSeams(const PieceTruth& truth);

  Status codeLeftovers(const PieceTruth& truth);

  Status codeOrders(const PieceTruth& truth);

  /// Must be called after the stages before and before codeAttribute(). Overwrites the faces' parts
  /// and releases the records.
  Status prepareAttributes();

  static void describePositions(const AttributeInfo& info, PositionParameters& p) {
    const uint32_t bits = info.coding == AttributeCoding::kLattice ? info.bits
                          : info.coding == AttributeCoding::kGrid  ? info.bits
                          : info.coding == AttributeCoding::kInteger
                              ? 8 * componentBytes(info.format.component_type)
                              : kExactPositionBits;
    p.bits = static_cast<uint8_t>(std::min<uint32_t>(bits, kExactPositionBits));
    p.modes = info.predictor;
  }

  /// Codes attribute `index` (not 0) into `values`: codedComponents() per wedge.
  Status codeAttribute(uint32_t index, Array<int32_t>& values) {
    return stage_.code(index, values);
  }

  /// For the writer's trials: codeAttribute() then codes only the first wedges in coding order.
  void codeFirstWedges(uint32_t count) {
    stage_.wedges.coded_count = std::min(count, stage_.wedges.count);
  }
  /// For the writer: keeps what codeAttribute() would leave for other attributes.
  Status keepForOthers(uint32_t index, const Array<int32_t>& values) {
    return stage_.keepForOthers(index, values);
  }

  TangentNormals tangentNormals() const { return stage_.tangentNormals(); }

 private:
  /// Fills mc_edges. The next stages renumber vertices but not half-edges.
  Status findMcEdgeCorners(const Array<McEdge>& edges) {
    if constexpr (!kTellsMcEdges) return {};
    Array<uint32_t> corner(allocator_);
    if (!corner.assign(mesh.vertex_count, kNone) || !mc_edges.reserve(edges.size()))
      return noMemory();
    for (uint32_t f = 0; f < mesh.face_count; ++f) {
      for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) corner[mesh.words[h]] = h;
    }
    for (size_t i = 0; i < edges.size(); ++i) {
      const McEdgeCorners corners{corner[edges[i].vertex], corner[edges[i].from]};
      // The codes of a bad file may make vertices without a triangle.
      if (corners.of_vertex == kNone || corners.of_from == kNone) continue;
      (void)mc_edges.push_back(corners);  // reserved above
    }
    return {};
  }

  /// The scale at which the seeds of exact floats start.
  static constexpr uint8_t kExactPositionBits = 26;

  /// Lists the positions as the reader's caller gets them; values that are not finite count as 0.
  Status listExactPositions() {
    if (!stage_.exact_positions.resize(3 * size_t{header_.wedge_count})) return noMemory();
    const AttributeInfo& info = attributes_[0];
    for (uint32_t w = 0; w < header_.wedge_count; ++w) {
      const int32_t* q = records[groupOf(w)].q;
      float* to = &stage_.exact_positions[3 * size_t{w}];
      for (uint32_t s = 0; s < 3; ++s) {
        to[s] = info.coding == AttributeCoding::kLattice
                    ? latticeValue(q[s], info.lattice.step, info.lattice.origin[s])
                : info.coding == AttributeCoding::kInteger ? static_cast<float>(q[s])
                                                           : static_cast<float>(finiteValue(q[s]));
        if (!(std::fabs(to[s]) <= 3e38f)) to[s] = 0;
      }
    }
    return {};
  }

  /// Runs the compiled combination of modes that fits.
  Status runPositions(const PositionParameters& parameters, const PieceTruth& truth);

  /// Codes the tails of exact positions. The records then hold ordered floats.
  Status codePositionTails(const PieceTruth& truth);

  template <uint32_t kModes>
  Status runModes(const PositionParameters& parameters, const PieceTruth& truth);

  Status runMirrored(const PositionParameters& parameters, const Repetition& repetition,
                     const PieceTruth& truth);

  /// Used without positions: enters the groups in the order of the faces.
  Status enterGroups() {
    Array<uint8_t> is_entered(allocator_);
    if (!is_entered.assign(groups.count, 0) || !sequence.reserve(groups.count)) return noMemory();
    for (uint32_t f = 0; f < mesh.face_count; ++f) {
      for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
        const uint32_t group = mesh.words[h];
        if (is_entered[group] != 0) continue;
        is_entered[group] = 1;
        if (!sequence.push_back(h)) return noMemory();
      }
    }
    return {};
  }

  /// Computes the positions for creases and attributes, of groups and, after them, of isolated
  /// vertices.
  Status findGroupPositions() {
    if (!group_positions_.empty()) return {};
    const uint32_t count = static_cast<uint32_t>(records.size());
    const auto position = [this](uint32_t group) { return records[group].q; };
    return decodes::kExactFloats && isExact(attributes_[0].coding)
               ? floatPredictionPositions(count, position, group_positions_)
               : latticePredictionPositions(count, position, group_positions_);
  }

  Status findCreases() {
    MCC_TRY(findGroupPositions());
    return classifyCreases(mesh.view(), mesh.face_count, group_positions_.data(), allocator_);
  }

  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for the decoded mesh"); }

  Io& io_;
  PayloadModels& models_;
  const Allocator allocator_;
  AttributeStage<Io> stage_;
  Array<float> group_positions_;  ///< 4 per group, see surface/wedges.h
};

template <SymbolIo Io>
Status PieceCoder<Io>::codeConnectivity(const PieceTruth& truth, CodeHistogram* histogram,
                                        bool wants_mc_edges) {
  if (!mesh.words.resize(size_t{header_.face_count} * kFaceWords)) return noMemory();
  mesh.face_count = 0;
  mesh.vertex_count = 0;
  Array<McEdge> edges(allocator_);
  if (header_.hasPivots()) {
    PivotModels* const models = models_.pivots.get(allocator_);
    if (models == nullptr) return noMemory();
    if (wants_mc_edges && !edges.reserve(header_.vertex_count)) return noMemory();
    PivotCoder<Io> coder(io_, *models, mesh, truth.pivot_faces, wants_mc_edges ? &edges : nullptr);
    MCC_TRY(coder.run(header_.vertex_count, header_.face_count));
    return wants_mc_edges ? findMcEdgeCorners(edges) : Status{};
  }
  const McCounts counts{header_.operation_count, header_.vertex_count, header_.dummy_count,
                        header_.face_count, header_.has(piece_flag::kHandles)};
  const McWatch watch{histogram, wants_mc_edges ? &edges : nullptr};
  const bool is_watched = watch.histogram != nullptr || watch.edges != nullptr;
  McMachine<Io> machine(io_, models_.mc, counts, mesh, truth.connectivity);
  MCC_TRY(machine.run(is_watched ? &watch : nullptr));
  return wants_mc_edges ? findMcEdgeCorners(edges) : Status{};
}

template <SymbolIo Io>
Status PieceCoder<Io>::codeStitch(const PieceTruth& truth) {
  groups.count = mesh.vertex_count;
  if (header_.hasPivots()) return listCorners(mesh, groups);
  if (!header_.hasCopies()) return {};
  StitchModels* const models = models_.stitch.get(allocator_);
  if (models == nullptr) return noMemory();
  Stitcher<Io> stitcher(io_, *models, mesh, truth.class_of_vertex);
  return stitcher.run(header_.surface() == SurfaceCoding::kCopies, truth.class_count, groups);
}

template <SymbolIo Io>
Status PieceCoder<Io>::codePositions(const PieceTruth& truth, const PositionParameters* fitted) {
  if (header_.attribute_count == 0) return needsSequence() ? enterGroups() : Status{};
  if (!records.resize(size_t{groups.count} + header_.isolated_count)) return noMemory();
  PositionParameters parameters = fitted != nullptr ? *fitted : PositionParameters{};
  describePositions(attributes_[0], parameters);
  MCC_TRY(codePositionTables(io_, models_.positions.tables, parameters));
  Repetition repetition;
  repetition.has_anchors = header_.has(piece_flag::kAnchors);
  repetition.anchors = truth.anchors;
  Mirrors& mirrors = repetition.mirrors;
  if (header_.has(piece_flag::kMirrors))
    MCC_TRY(codeMirrors(io_, parameters.bits, Io::kEncoding ? *truth.mirrors : mirrors, mirrors));
  PositionPalettes palettes(allocator_);
  if (parameters.has(position_mode::kPalette)) {
    MCC_TRY(palettes.code(io_, models_.positions.tables.palettes, truth.palettes, groups.count,
                          mirrors));
    for (uint32_t s = 0; s < 3; ++s) parameters.palette[s] = palettes.axis(s);
  }
  std::optional<GridPlanes> grid;  // small payloads would notice the time that its tables take
  if (parameters.has(position_mode::kPlanes)) {
    AxisPlanes planes[3];
    for (uint32_t s = 0; s < 3; ++s) {
      if (Io::kEncoding) planes[s] = truth.planes[s];
      MCC_TRY(codePlanes(io_, planes[s]));
    }
    parameters.planes = &grid.emplace(planes);
  }
  models_.positions.rows.prepare(parameters.modes);
  sequence.clear();
  if (needsSequence() && !sequence.resize(groups.count)) return noMemory();
  if constexpr (!kCompact) {
    if (!header_.hasMates()) MCC_TRY(runPositions(parameters, truth));
  }
  if (kCompact || header_.hasMates()) MCC_TRY(runMirrored(parameters, repetition, truth));
  if (decodes::kIsolated && header_.isolated_count != 0) {
    const int32_t* const known =
        Io::kEncoding ? truth.positions + 3 * size_t{groups.count} : nullptr;
    IsolatedCoder<Io> isolated(io_, models_.isolated);
    MCC_TRY(isolated.run(header_.isolated_count, records.data() + groups.count, known));
  }
  if (decodes::kExactFloats && attributes_[0].coding == AttributeCoding::kGrid)
    MCC_TRY(codePositionTails(truth));
  return {};
}

template <SymbolIo Io>
Status PieceCoder<Io>::codeSeams(const PieceTruth& truth) {
  const uint32_t surface_wedges = header_.wedge_count - header_.isolated_count;
  wedges.isolated_count = header_.isolated_count;
  wedges.isolated_first = surface_wedges;
  if (header_.has(piece_flag::kSeams)) {
    if (header_.has(piece_flag::kCreases)) MCC_TRY(findCreases());
    Array<uint32_t> starts(allocator_);
    SeamCoder<Io> coder(io_, models_.seams, mesh, groups, truth.corner_source);
    MCC_TRY(coder.run(surface_wedges, sequence, {starts, wedge_group}));
    sequence.swap(starts);
  }
  const size_t found = header_.has(piece_flag::kSeams) ? sequence.size() : groups.count;
  if (found != surface_wedges) {
    return fail(Error::kBadAttribute, "the seams make fewer wedges than the header claims");
  }
  wedges.half_edges = sequence.data();
  wedges.count = static_cast<uint32_t>(sequence.size());
  return {};
}

template <SymbolIo Io>
Status PieceCoder<Io>::codeLeftovers(const PieceTruth& truth) {
  const LeftoverCounts counts{mesh.face_count, header_.wedge_count, header_.part_count,
                              header_.listed_count};
  MCC_TRY(codeParts(io_, models_.leftovers, mesh.view(), counts, truth.leftovers));
  if (!decodes::kListed || !header_.has(piece_flag::kListed)) return {};
  return codeList(io_, models_.leftovers, mesh.view(), counts, truth.leftovers, list);
}

template <SymbolIo Io>
Status PieceCoder<Io>::codeOrders(const PieceTruth& truth) {
  if (!header_.has(piece_flag::kTriangleOrder | piece_flag::kVertexOrder)) return {};
  OrderModels* const models = models_.orders.get(allocator_);
  if (models == nullptr || !listTriangles()) return noMemory();
  if (header_.has(piece_flag::kTriangleOrder)) {
    TriangleOrderCoder<Io> coder(io_, *models, mesh, triangles);
    MCC_TRY(coder.run(header_.part_count, truth.triangle_order, triangle_order));
  }
  if (!header_.has(piece_flag::kVertexOrder)) return {};
  WedgeOrderCoder<Io> coder(io_, *models, triangles, allocator_);
  return coder.run(header_.wedge_count, triangle_order, truth.wedge_order, wedge_order);
}

template <SymbolIo Io>
Status PieceCoder<Io>::runPositions(const PositionParameters& parameters, const PieceTruth& truth) {
  if constexpr (Io::kFast) {
#define MCC_TRY_MODES(which, modes_)            \
  if ((parameters.modes & (which)) == (modes_)) \
    return runModes<fixedModes(which, modes_)>(parameters, truth);
    MCC_PLAIN_MODES(MCC_TRY_MODES)
    MCC_KIND_MODES(MCC_TRY_MODES)
#undef MCC_TRY_MODES
    return fail(Error::kBadHeader, "the modes of the positions do not go together");
  } else {
    return runModes<kAnyModes>(parameters, truth);
  }
}

template <SymbolIo Io>
Status PieceCoder<Io>::prepareAttributes() {
  if (header_.attribute_count < 2) return {};
  MCC_TRY(stage_.wedges.build(mesh, wedges.half_edges, wedges.count, header_.wedge_count,
                              header_.has(piece_flag::kSeams) ? wedge_group.data() : nullptr));
  if (!mates.empty()) MCC_TRY(stage_.findWedgeMates(mates, groups.count));
  if (stage_.needsExactPositions()) MCC_TRY(listExactPositions());
  MCC_TRY(findGroupPositions());
  records.reset();
  if (!header_.has(piece_flag::kSeams)) {  // wedges are numbered as groups
    stage_.positions.swap(group_positions_);
    return {};
  }
  if (!stage_.positions.resize(4 * size_t{header_.wedge_count})) return noMemory();
  for (uint32_t w = 0; w < header_.wedge_count; ++w) {
    storeFloat4(&stage_.positions[4 * size_t{w}],
                loadFloat4(&group_positions_[4 * size_t{groupOf(w)}]));
  }
  group_positions_.reset();
  return {};
}

template <SymbolIo Io>
Status PieceCoder<Io>::codePositionTails(const PieceTruth& truth) {
  TailCoder<Io> tails(io_, models_.position_tails, attributes_[0], allocator_);
  MCC_TRY(tails.prepare());
  for (size_t v = 0; v < records.size(); ++v) {
    for (uint32_t s = 0; s < 3; ++s) {
      int32_t& q = records[v].q[s];
      q = tails.code(s, q, Io::kEncoding ? truth.exact_positions[3 * v + s] : 0);
    }
  }
  if (io_.overrun()) return fail(Error::kTruncated, "the token stream ends inside the positions");
  return {};
}

template <SymbolIo Io>
Status PieceCoder<Io>::runMirrored(const PositionParameters& parameters,
                                   const Repetition& repetition, const PieceTruth& truth) {
  MirrorModels* const models = header_.hasMates() ? models_.mirrors.get(allocator_) : nullptr;
  if (models == nullptr && header_.hasMates()) return noMemory();
  const GroupPositions vertices{groups, records.data(), truth.positions};
  return MirroredPositionCoder<Io>(io_, models_.positions, models, parameters, repetition, mates,
                                   mesh, vertices)
      .run(needsSequence() ? sequence.data() : nullptr);
}

template <SymbolIo Io>
template <uint32_t kModes>
Status PieceCoder<Io>::runModes(const PositionParameters& parameters, const PieceTruth& truth) {
  const GroupPositions vertices{groups, records.data(), truth.positions};
  return PositionCoder<Io, kModes>(io_, models_.positions, parameters, mesh, vertices)
      .run(needsSequence() ? sequence.data() : nullptr);
}

}  // namespace mcc

#endif  // MCC_READER_PIECE_H_
