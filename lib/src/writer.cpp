// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writer: prepares every piece (quantise, weld, sort, cut, collapse), tries the format's choices on a counting coder,
// then runs the stages of piece.h with the real one.
#include "mcc/writer.h"

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <numeric>
#include <tuple>

#include "attributes/enc_exact_grid.h"
#include "attributes/enc_position_fit.h"
#include "attributes/enc_position_planes.h"
#include "attributes/enc_predictor_search.h"
#include "attributes/enc_prices.h"
#include "attributes/enc_quantize.h"
#include "attributes/enc_variation.h"
#include "base/enc_exceptions.h"
#include "base/enc_jobs.h"
#include "connectivity/enc_collapse.h"
#include "container/enc_payload.h"
#include "entropy/enc_coder.h"
#include "piece.h"
#include "prepare/enc_cut.h"
#include "prepare/enc_triangles.h"
#include "prepare/enc_weld.h"

namespace mcc {
namespace {

constexpr uint32_t kSingleCoderVertices = 2000;  ///< up to here the single coder is tried as well

constexpr uint32_t kTrialWedges = 4000;  ///< an attribute's candidates are tried on so many wedges,
constexpr uint32_t kTrialShare = 6;      ///< or on this part of all

/// A piece on its way through the writer.
struct Plan {
  const PieceView* view = nullptr;
  PieceHeader header;
  std::vector<QuantizedAttribute> attributes;  ///< POSITION first
  std::vector<uint32_t> source_attribute;      ///< index in view->attributes of each
  PositionClasses classes;
  SortedTriangles triangles;
  CutResult cut;
  McRecord record;

  // Filled while the stages run; the same in every run.
  std::vector<uint32_t> node_map;
  std::vector<uint32_t> source_of_vertex;
  std::vector<uint32_t> source_gate;
  std::vector<uint32_t> class_of_vertex;
  std::vector<uint32_t> corner_source;
  std::vector<int32_t> positions;
  std::vector<int32_t> exact_positions;  ///< ordered floats, if the positions are on an exact grid
  DistinctCoordinates coordinates;
  AxisPlanes planes[3];
  PositionParameters positions_as;  ///< chosen, with fitted tables
  std::vector<uint32_t> wedge_source;
  std::vector<uint32_t> part_of_face;
  std::vector<uint32_t> duplicates_of_face;
  std::vector<uint32_t> degenerates_of_edge;
  std::vector<uint32_t> degenerate_parts;
  std::vector<ListedTriangle> list;
  std::vector<uint32_t> triangle_order;
  std::vector<uint32_t> wedge_order;
};

constexpr uint32_t nextCorner(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
constexpr uint32_t prevCorner(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

// --- preparation -----------------------------------------------------------------------------------

bool isBasePosition(const AttributeFormat& f) {
  return f.semantic == Semantic::kPosition && f.morph_target == 0;
}

Status checkPiece(const PieceView& piece) {
  if (piece.attributes.empty() || !isBasePosition(piece.attributes[0].format) ||
      piece.attributes[0].format.component_count != 3) {
    return fail(Error::kBadArgument,
                "the first attribute of a piece must be POSITION with 3 components");
  }
  if (piece.wedge_count >= (1u << 28))
    return fail(Error::kLimit, "a piece has more than 2^28 vertices");
  if (piece.parts.empty()) return fail(Error::kBadArgument, "a piece has no parts");
  for (const AttributeView& a : piece.attributes) {
    if (!isComponentCount(a.format.component_count) ||
        (a.data == nullptr && piece.wedge_count != 0) || a.stride_bytes < elementBytes(a.format) ||
        a.quantization_bits > 24) {
      return fail(Error::kBadArgument,
                  "an attribute's format, data, stride or bits are out of range");
    }
  }
  uint64_t triangles = 0;
  for (const PartView& part : piece.parts) {
    if (part.indices.size() % 3 != 0)
      return fail(Error::kBadArgument, "a part's indices are no triangles");
    triangles += part.indices.size() / 3;
    for (const uint32_t index : part.indices) {
      if (index >= piece.wedge_count)
        return fail(Error::kBadArgument, "an index is not below wedge_count");
    }
  }
  if (triangles >= (1u << 28)) return fail(Error::kLimit, "a piece has more than 2^28 triangles");
  return {};
}

void prepareConnectivity(Plan& plan, EdgePairing pairing, uint32_t start_half_edge) {
  std::vector<uint32_t> corner_class(plan.triangles.wedges.size());
  for (size_t i = 0; i < corner_class.size(); ++i) {
    corner_class[i] = plan.classes.class_of_wedge[plan.triangles.wedges[i]];
  }
  plan.cut = cutToManifold(corner_class, plan.classes.class_count, pairing, start_half_edge);
  plan.record = collapse(plan.cut.mesh);
  const ClosedMesh& mesh = plan.cut.mesh;
  plan.node_map.resize(plan.record.node_count);
  plan.source_of_vertex.resize(mesh.real_vertex_count);
  plan.source_gate.resize(mesh.real_face_count);

  PieceHeader& h = plan.header;
  h.vertex_count = mesh.real_vertex_count;
  h.face_count = mesh.real_face_count;
  h.operation_count = static_cast<uint32_t>(plan.record.operations.size());
  h.dummy_count = mesh.dummy_count;
  h.flags &= ~(piece_flag::kHoles | piece_flag::kHandles | piece_flag::kCopies |
               piece_flag::kInteriorCopies | piece_flag::kMerges);
  if (mesh.dummy_count != 0) h.flags |= piece_flag::kHoles;
  if (!plan.record.handles.empty()) h.flags |= piece_flag::kHandles;

  std::vector<uint8_t> on_boundary(mesh.real_vertex_count, 0);
  std::vector<uint8_t> has_run_start(mesh.real_vertex_count, 0);
  uint32_t run_count = 0;
  for (uint32_t c = 0; c < 3 * mesh.real_face_count; ++c) {
    const uint32_t t = mesh.twin[c];
    const bool boundary = t / 3 >= mesh.real_face_count;
    if (boundary) {
      on_boundary[mesh.corner_vertex[c]] = 1;
    } else if (plan.triangles.wedges[nextCorner(t)] == plan.triangles.wedges[c]) {
      continue;
    }
    has_run_start[mesh.corner_vertex[c]] = 1;
    ++run_count;
  }
  std::vector<uint8_t> umbrellas(plan.classes.class_count, 0);
  for (uint32_t v = 0; v < mesh.real_vertex_count; ++v) {
    uint8_t& n = umbrellas[plan.cut.class_of_vertex[v]];
    n = static_cast<uint8_t>(std::min(2, n + 1));
    run_count += has_run_start[v] == 0 ? 1 : 0;
  }
  for (uint32_t v = 0; v < mesh.real_vertex_count; ++v) {
    if (umbrellas[plan.cut.class_of_vertex[v]] < 2) continue;
    h.flags |= piece_flag::kCopies;
    if (on_boundary[v] == 0) h.flags |= piece_flag::kInteriorCopies;
  }
  const uint32_t surface_wedges = h.wedge_count - h.isolated_count;
  if (h.has(piece_flag::kSeams) && run_count > surface_wedges) h.flags |= piece_flag::kMerges;
}

bool isExact(AttributeCoding coding) {
  return coding == AttributeCoding::kExactFloat || coding == AttributeCoding::kGrid;
}

Status preparePiece(const PieceView& view, const EncodeOptions& options, const Jobs& jobs,
                    Plan& plan, std::vector<std::string>& notes) {
  MCC_TRY(checkPiece(view));
  if (options.indices_only && view.attributes.size() != 1)
    return fail(Error::kBadArgument, "a piece without attributes has more than its position");
  plan.view = &view;
  jobs.run(2, [&](size_t i) {
    if (i == 1) {
      plan.triangles = sortTriangles(view.parts, view.wedge_count);
      return;
    }
    plan.attributes = quantizeAttributes(view, notes);
    plan.classes = weldPositions(view.attributes[0], view.wedge_count,
                                 isExact(plan.attributes[0].info.coding));
  });
  PieceHeader& h = plan.header;
  h.wedge_count = view.wedge_count;
  h.isolated_count = static_cast<uint32_t>(plan.triangles.isolated.size());
  h.duplicate_count = plan.triangles.duplicate_count;
  h.listed_count = static_cast<uint32_t>(plan.triangles.listed.size());
  h.part_count = static_cast<uint32_t>(view.parts.size());
  if (options.indices_only) plan.attributes.clear();
  h.attribute_count = static_cast<uint32_t>(plan.attributes.size());
  if (h.isolated_count != 0) h.flags |= piece_flag::kIsolated;
  if (h.duplicate_count != 0) h.flags |= piece_flag::kDuplicates;
  if (h.listed_count != 0) h.flags |= piece_flag::kListed;
  if (h.part_count > 1) h.flags |= piece_flag::kManyParts;
  if (options.keep_triangle_order) h.flags |= piece_flag::kTriangleOrder;
  if (options.keep_vertex_order) h.flags |= piece_flag::kVertexOrder;
  std::vector<uint32_t> wedge_of_class(plan.classes.class_count, kNone);
  for (const uint32_t w : plan.triangles.wedges) {
    uint32_t& first = wedge_of_class[plan.classes.class_of_wedge[w]];
    if (first == kNone) first = w;
    if (first != w) h.flags |= piece_flag::kSeams;
  }
  return {};
}

// --- truth: what each stage needs to know, derived from the stage before -----------------------------

/// Where a run of the connectivity puts what it learns.
struct SurfaceLearned {
  std::vector<uint32_t>& node_map;
  std::vector<uint32_t>& source_of_vertex;
  std::vector<uint32_t>& source_gate;
};

McTruth connectivityTruth(const McRecord& r, const SurfaceLearned& learned) {
  McTruth truth;
  truth.operations = r.operations.data();
  truth.handles = r.handles.data();
  truth.components = r.components.data();
  truth.component_count = static_cast<uint32_t>(r.components.size());
  truth.gates = r.gates.data();
  truth.vertex_is_dummy = r.vertex_is_dummy.data();
  truth.node_of_collapse_node = learned.node_map.data();
  truth.source_of_vertex = learned.source_of_vertex.data();
  truth.source_gate_of_face = learned.source_gate.data();
  return truth;
}

void learnVertices(Plan& plan) {
  plan.class_of_vertex.resize(plan.source_of_vertex.size());
  for (size_t v = 0; v < plan.class_of_vertex.size(); ++v) {
    plan.class_of_vertex[v] = plan.cut.class_of_vertex[plan.source_of_vertex[v]];
  }
  plan.corner_source.resize(3 * plan.source_gate.size());
  for (size_t f = 0; f < plan.source_gate.size(); ++f) {
    const uint32_t gate = plan.source_gate[f];  // becomes half-edge 1
    plan.corner_source[3 * f] = plan.triangles.wedges[prevCorner(gate)];
    plan.corner_source[3 * f + 1] = plan.triangles.wedges[gate];
    plan.corner_source[3 * f + 2] = plan.triangles.wedges[nextCorner(gate)];
  }
}

void learnPositions(Plan& plan, const FaceMesh& mesh, const Groups& groups) {
  if (plan.attributes.empty()) return;
  const std::vector<int32_t>& q = plan.attributes[0].values;
  plan.positions.resize(3 * (size_t{groups.count} + plan.triangles.isolated.size()));
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    for (uint32_t k = 0; k < 3; ++k) {
      const size_t group = mesh.words[size_t{f} * kFaceWords + k];
      const size_t source = plan.corner_source[3 * size_t{f} + k];
      for (size_t s = 0; s < 3; ++s) plan.positions[3 * group + s] = q[3 * source + s];
    }
  }
  for (size_t i = 0; i < plan.triangles.isolated.size(); ++i) {
    for (size_t s = 0; s < 3; ++s) {
      plan.positions[3 * (groups.count + i) + s] = q[3 * size_t{plan.triangles.isolated[i]} + s];
    }
  }
  const AttributeInfo& info = plan.attributes[0].info;
  if (info.coding != AttributeCoding::kGrid) return;
  plan.exact_positions = plan.positions;
  for (int32_t& value : plan.positions) value = gridInteger(info, value);
}

/// Sorts the triangles with a doubled wedge into those along an edge of a face and the others.
void learnListed(Plan& plan, FaceMesh& mesh, const std::vector<uint32_t>& wedge_of_source) {
  struct EdgeTriangle {
    uint64_t edge;  ///< doubled wedge, single wedge
    uint32_t part;
    bool operator<(const EdgeTriangle& o) const {
      return edge != o.edge ? edge < o.edge : part < o.part;
    }
  };
  std::vector<EdgeTriangle> waiting;
  plan.list.clear();
  for (const SortedTriangles::Listed& t : plan.triangles.listed) {
    uint32_t w[3];
    for (int k = 0; k < 3; ++k) w[k] = wedge_of_source[t.wedge[k]];
    if (w[0] == w[1] && w[1] == w[2]) {
      plan.list.push_back({{w[0], w[1], w[2]}, t.part});
      continue;
    }
    const int single = w[0] == w[1] ? 2 : (w[1] == w[2] ? 0 : 1);
    waiting.push_back({uint64_t{w[(single + 1) % 3]} << 32 | w[single], t.part});
  }
  std::sort(waiting.begin(), waiting.end());
  std::vector<uint8_t> taken(waiting.size(), 0);
  plan.degenerates_of_edge.assign(waiting.empty() ? 0 : 6 * size_t{mesh.face_count}, 0);
  plan.degenerate_parts.clear();
  const FaceView faces = mesh.view();
  for (uint32_t f = 0; f < mesh.face_count && !waiting.empty(); ++f) {
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t h = f * kFaceWords + k;
      if (!EdgeDegenerateCoder<CostIo>::asksAt(faces, h)) continue;
      const uint64_t a = faces.vertex(h);
      const uint64_t b = faces.vertex(nextHalfEdge(h));
      for (const uint32_t side : {0u, 1u}) {
        const uint64_t edge = side == 0 ? a << 32 | b : b << 32 | a;
        auto it = std::lower_bound(waiting.begin(), waiting.end(), EdgeTriangle{edge, 0});
        for (; it != waiting.end() && it->edge == edge; ++it) {
          uint8_t& is_taken = taken[static_cast<size_t>(it - waiting.begin())];
          if (is_taken != 0) break;
          is_taken = 1;
          ++plan.degenerates_of_edge[2 * (3 * size_t{f} + k) + side];
          plan.degenerate_parts.push_back(it->part);
        }
      }
    }
  }
  for (size_t i = 0; i < waiting.size(); ++i) {
    if (taken[i] != 0) continue;
    const uint32_t doubled = static_cast<uint32_t>(waiting[i].edge >> 32);
    plan.list.push_back(
        {{doubled, doubled, static_cast<uint32_t>(waiting[i].edge)}, waiting[i].part});
  }
  PieceHeader& header = plan.header;
  header.edge_degenerate_count = static_cast<uint32_t>(plan.degenerate_parts.size());
  header.listed_count = static_cast<uint32_t>(plan.list.size());
  header.flags &= ~(piece_flag::kEdgeDegenerates | piece_flag::kListed);
  if (header.edge_degenerate_count != 0) header.flags |= piece_flag::kEdgeDegenerates;
  if (header.listed_count != 0) header.flags |= piece_flag::kListed;
}

void learnWedges(Plan& plan, FaceMesh& mesh) {
  plan.wedge_source.assign(plan.header.wedge_count, kNone);
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    for (uint32_t k = 0; k < 3; ++k) {
      plan.wedge_source[mesh.words[size_t{f} * kFaceWords + k]] =
          plan.corner_source[3 * size_t{f} + k];
    }
  }
  const uint32_t first_isolated = plan.header.wedge_count - plan.header.isolated_count;
  for (size_t i = 0; i < plan.triangles.isolated.size(); ++i) {
    plan.wedge_source[first_isolated + i] = plan.triangles.isolated[i];
  }
  std::vector<uint32_t> wedge_of_source(plan.header.wedge_count);
  for (uint32_t w = 0; w < plan.header.wedge_count; ++w) wedge_of_source[plan.wedge_source[w]] = w;
  plan.part_of_face.resize(mesh.face_count);
  plan.duplicates_of_face.resize(mesh.face_count);
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    plan.part_of_face[f] = plan.triangles.part[plan.source_gate[f] / 3];
    plan.duplicates_of_face[f] = plan.triangles.duplicates[plan.source_gate[f] / 3];
  }
  learnListed(plan, mesh, wedge_of_source);
}

/// The source's order of triangles as TriangleOrderCoder names them. Equal triangles are paired in their order.
void learnTriangleOrder(Plan& plan, const TriangleTable& table) {
  using Wedges = std::array<uint32_t, 3>;
  struct Named {
    Wedges wedges;  ///< of its turns the smallest
    uint32_t part;
    uint32_t place;
    bool operator<(const Named& o) const {
      return std::tie(wedges, part, place) < std::tie(o.wedges, o.part, o.place);
    }
  };
  const auto turned = [](const Wedges& w, uint32_t by) {
    return Wedges{w[by % 3], w[(by + 1) % 3], w[(by + 2) % 3]};
  };
  const auto nameOf = [&](const Wedges& w, uint32_t part, uint32_t place) {
    return Named{std::min({w, turned(w, 1), turned(w, 2)}), part, place};
  };
  std::vector<uint32_t> wedge_of_source(plan.header.wedge_count);
  for (uint32_t w = 0; w < plan.header.wedge_count; ++w) wedge_of_source[plan.wedge_source[w]] = w;
  std::vector<Wedges> source;
  std::vector<Named> wanted;
  for (uint32_t part = 0; part < plan.view->parts.size(); ++part) {
    const std::span<const uint32_t> indices = plan.view->parts[part].indices;
    for (size_t i = 0; i < indices.size(); i += 3) {
      const Wedges w = {wedge_of_source[indices[i]], wedge_of_source[indices[i + 1]],
                        wedge_of_source[indices[i + 2]]};
      wanted.push_back(nameOf(w, part, static_cast<uint32_t>(source.size())));
      source.push_back(w);
    }
  }
  const auto wedgesOf = [&](uint32_t t) {
    return Wedges{table.wedges[3 * size_t{t}], table.wedges[3 * size_t{t} + 1],
                  table.wedges[3 * size_t{t} + 2]};
  };
  std::vector<Named> coded;
  for (uint32_t t = 0; t < table.count(); ++t)
    coded.push_back(nameOf(wedgesOf(t), table.partOf(t), t));
  std::sort(wanted.begin(), wanted.end());
  std::sort(coded.begin(), coded.end());
  plan.triangle_order.resize(table.count());
  for (size_t i = 0; i < coded.size(); ++i) {
    uint32_t corner = 0;
    while (turned(wedgesOf(coded[i].place), corner) != source[wanted[i].place]) ++corner;
    plan.triangle_order[wanted[i].place] = orderedTriangle(coded[i].place, corner);
  }
}

/// The values of `index` behind those of the attributes coded with it, in `stride` words per wedge.
void learnValues(const Plan& plan, uint32_t index, uint32_t offset, uint32_t stride,
                 Array<int32_t>& values) {
  const QuantizedAttribute& a = plan.attributes[index];
  for (uint32_t w = 0; w < plan.header.wedge_count; ++w) {
    for (uint32_t c = 0; c < a.components; ++c) {
      values[size_t{w} * stride + offset + c] =
          a.values[size_t{plan.wedge_source[w]} * a.components + c];
    }
  }
}

// --- stages ------------------------------------------------------------------------------------------

/// The positions of a piece as the trials see them, whatever other stages do meanwhile.
struct RecordedPositions {
  Array<VertexRecord> records;
  PositionRecording recording;
  PositionCandidate candidate;  ///< refers to the recording
};

/// Runs every stage of one piece; `sizes`, if given, receives what each cost.
template <class Io>
class StageRunner {
 public:
  /// `first_attribute`: number of attributes of the payload before this piece's.
  StageRunner(Io& io, PayloadModels& models, Plan& plan, size_t first_attribute = 0)
      : io_(io),
        plan_(plan),
        first_attribute_(first_attribute),
        infos_(infosOf(plan)),
        piece_(io, models, plan.header, infos_.data(), {}) {}

  Status codeSurface(StreamSizes* sizes) {
    truth_.connectivity = connectivityTruth(
        plan_.record, {plan_.node_map, plan_.source_of_vertex, plan_.source_gate});
    MCC_TRY(piece_.codeConnectivity(truth_));
    account(sizes, &StreamSizes::connectivity_bits);
    learnVertices(plan_);
    truth_.class_of_vertex = plan_.class_of_vertex.data();
    truth_.class_count = plan_.classes.class_count;
    truth_.corner_source = plan_.corner_source.data();
    MCC_TRY(piece_.codeStitch(truth_));
    account(sizes, &StreamSizes::stitch_bits);
    learnPositions(plan_, piece_.mesh, piece_.groups);
    truth_.positions = plan_.positions.data();
    truth_.exact_positions = plan_.exact_positions.data();
    return {};
  }

  /// Walks the surface once for the trials; codeSurface() must have run.
  Status recordPositions(RecordedPositions& recorded) {
    PositionRecording& recording = recorded.recording;
    PositionCandidate& candidate = recorded.candidate;
    if (!recorded.records.resize(plan_.positions.size() / 3)) throwBadAlloc();
    MCC_TRY(recording.record(piece_.mesh, piece_.groups, recorded.records.data(),
                             plan_.header.isolated_count, plan_.positions.data()));
    PositionParameters parameters;
    PieceCoder<Io>::describePositions(plan_.attributes[0].info, parameters);
    candidate.recording = &recording;
    candidate.truth = plan_.positions.data();
    candidate.bits = parameters.bits;
    plan_.coordinates.find(plan_.positions, isExact(plan_.attributes[0].info.coding));
    for (uint32_t s = 0; s < 3; ++s) candidate.palettes[s] = plan_.coordinates.palette(s);
    const AttributeInfo& info = plan_.attributes[0].info;
    if (info.coding == AttributeCoding::kLattice && info.bits <= position_flag::kMaxBitsOfPlanes &&
        findPlanes(plan_.positions, plan_.planes)) {
      candidate.planes = plan_.planes;
    }
    return {};
  }

  Status codePositions(StreamSizes* sizes) {
    AxisPalette palettes[3];
    if (!plan_.attributes.empty()) {
      infos_[0] = plan_.attributes[0].info;
      for (uint32_t s = 0; s < 3; ++s) palettes[s] = plan_.coordinates.palette(s);
      truth_.palettes = palettes;
      truth_.planes = plan_.planes;
    }
    MCC_TRY(piece_.codePositions(truth_, &plan_.positions_as));
    account(sizes, &StreamSizes::position_bits);
    return {};
  }

  Status codeSeams(StreamSizes* sizes) {
    MCC_TRY(piece_.codeSeams(truth_));
    account(sizes, &StreamSizes::seam_bits);
    learnWedges(plan_, piece_.mesh);
    truth_.leftovers = {plan_.part_of_face.data(), plan_.duplicates_of_face.data(),
                        plan_.degenerates_of_edge.data(), plan_.degenerate_parts.data(),
                        plan_.list.data()};
    MCC_TRY(piece_.codeLeftovers(truth_));
    account(sizes, &StreamSizes::leftover_bits);
    return {};
  }

  Status codeOrders(StreamSizes* sizes) {
    if (plan_.header.has(piece_flag::kTriangleOrder | piece_flag::kVertexOrder)) {
      learnOrders();
      MCC_TRY(piece_.codeOrders(truth_));
      account(sizes, &StreamSizes::order_bits);
    }
    return {};
  }

  Status prepareAttributes() { return piece_.prepareAttributes(); }

  /// The seams without and with creases as contexts; sets the cheaper way. The seams must be coded again.
  Status chooseCreases(PayloadModels& models) {
    if (!plan_.header.has(piece_flag::kSeams) || plan_.attributes.empty()) return {};
    const std::vector<uint32_t> words(piece_.mesh.words.data(),
                                      piece_.mesh.words.data() + piece_.mesh.words.size());
    const std::vector<uint32_t> sequence(piece_.sequence.data(),
                                         piece_.sequence.data() + piece_.sequence.size());
    const SeamModels before = models.seams;
    uint64_t cost[2] = {};
    for (const uint32_t with : {0u, 1u}) {
      plan_.header.flags =
          (plan_.header.flags & ~piece_flag::kCreases) | (with != 0 ? piece_flag::kCreases : 0);
      const uint64_t spent = io_.cost();
      MCC_TRY(piece_.codeSeams(truth_));
      cost[with] = io_.cost() - spent;
      models.seams = before;
      piece_.wedge_group.clear();
      piece_.sequence.clear();
      for (const uint32_t h : sequence) {
        if (!piece_.sequence.push_back(h)) throwBadAlloc();
      }
      std::copy(words.begin(), words.end(), piece_.mesh.words.data());
    }
    if (cost[0] <= cost[1]) plan_.header.flags &= ~piece_flag::kCreases;
    return {};
  }

  Status codeAttribute(uint32_t index, StreamSizes* sizes) {
    infos_[index] = plan_.attributes[index].info;
    if (isCodedWithAnother(index)) return {};
    learnAttribute(index);
    MCC_TRY(piece_.codeAttribute(index, values_));
    if (sizes != nullptr) sizes->attribute_bits[first_attribute_ + index] = since();
    return {};
  }

  /// What codeAttribute() costs for the first wedges; the models adapt.
  Status tryAttribute(uint32_t index, uint32_t wedges, uint64_t& cost) {
    const uint64_t spent = io_.cost();
    piece_.codeFirstWedges(wedges);
    const Status status = codeAttribute(index, nullptr);
    piece_.codeFirstWedges(kNone);
    cost = io_.cost() - spent;
    return status;
  }

  /// Instead of codeAttribute(), when its models are not needed any more.
  Status passAttribute(uint32_t index) {
    infos_[index] = plan_.attributes[index].info;
    if (isCodedWithAnother(index)) return {};
    learnAttribute(index);
    return piece_.keepForOthers(index, values_);
  }

  uint32_t groupCount() const { return piece_.groups.count; }

 private:
  bool isCodedWithAnother(uint32_t index) const {
    return methodOf(infos_.data(), plan_.header.attribute_count, index) ==
           AttributeMethod::kWithAnother;
  }

  /// Fills values_, which coding leaves as they are.
  void learnAttribute(uint32_t index) {
    if (learned_ == index) return;
    learned_ = index;
    const uint32_t stride = piece_.codedComponentsOf(index);
    if (!values_.resize(size_t{plan_.header.wedge_count} * stride)) throwBadAlloc();
    learnValues(plan_, index, 0, stride, values_);
    const uint32_t count = plan_.header.attribute_count;
    if (methodOf(infos_.data(), count, index) != AttributeMethod::kSkin) return;
    learnValues(plan_, skinPartner(infos_.data(), count, index), kSkinSlots, stride, values_);
  }

  static std::vector<AttributeInfo> infosOf(const Plan& plan) {
    std::vector<AttributeInfo> infos;
    for (const QuantizedAttribute& a : plan.attributes) infos.push_back(a.info);
    return infos;
  }
  void learnOrders() {
    if (!piece_.listTriangles()) throwBadAlloc();
    if (plan_.header.has(piece_flag::kTriangleOrder)) learnTriangleOrder(plan_, piece_.triangles);
    plan_.wedge_order.resize(plan_.wedge_source.size());
    for (uint32_t w = 0; w < plan_.wedge_source.size(); ++w) {
      plan_.wedge_order[plan_.wedge_source[w]] = w;
    }
    truth_.triangle_order = plan_.triangle_order.data();
    truth_.wedge_order = plan_.wedge_order.data();
  }
  double since() {
    const uint64_t before = cost_before_;
    cost_before_ = io_.cost();
    return static_cast<double>(cost_before_ - before) / kCostOne;
  }
  void account(StreamSizes* sizes, double StreamSizes::*field) {
    if (sizes != nullptr) sizes->*field += since();
  }

  Io& io_;
  Plan& plan_;
  const size_t first_attribute_;
  std::vector<AttributeInfo> infos_;
  PieceCoder<Io> piece_;
  PieceTruth truth_;
  Array<int32_t> values_;
  uint32_t learned_ = kNone;  ///< attribute that values_ are of
  uint64_t cost_before_ = io_.cost();
};

std::vector<uint32_t> codingOrder(const Plan& plan) {
  std::vector<uint32_t> order;
  for (uint32_t phase = 0; phase < kCodingPhases; ++phase) {
    for (uint32_t a = 1; a < plan.attributes.size(); ++a) {
      if (codingPhase(plan.attributes[a].info) == phase) order.push_back(a);
    }
  }
  return order;
}

std::unique_ptr<PayloadModels> makeModels(uint32_t context_set) {
  auto models = std::make_unique<PayloadModels>(Allocator{});
  if (!models->mc.init(context_set)) throwBadAlloc();
  return models;
}

// --- choices -----------------------------------------------------------------------------------------

Status surfaceCost(Plan& plan, uint64_t& cost) {
  CostIo io;
  auto models = makeModels(0);
  StageRunner<CostIo> runner(io, *models, plan);
  MCC_TRY(runner.codeSurface(nullptr));
  cost = io.cost();
  return {};
}

Status checkHandles(const Plan& plan) {
  for (const McHandle& handle : plan.record.handles) {
    if (handle.stack_depth > kMaxHandleDepth) {
      return fail(Error::kLimit, "a piece has more nested handles than the format can state");
    }
  }
  return {};
}

/// Edges with more than two faces: joined in file order or cut apart, whichever is smaller.
Status choosePairing(Plan& plan, uint32_t start_half_edge, const Jobs& jobs) {
  prepareConnectivity(plan, EdgePairing::kStack, start_half_edge);
  MCC_TRY(checkHandles(plan));
  if (!plan.header.has(piece_flag::kCopies)) return {};
  Plan other = plan;
  prepareConnectivity(other, EdgePairing::kCut, start_half_edge);
  if (other.header.vertex_count == plan.header.vertex_count || !checkHandles(other).ok()) return {};
  uint64_t joined = 0;
  uint64_t cut = 0;
  MCC_TRY(jobs.tryAll(
      2, [&](size_t i) { return i == 0 ? surfaceCost(plan, joined) : surfaceCost(other, cut); }));
  if (cut < joined) plan = std::move(other);
  return {};
}

struct Connectivity {
  const McRecord* record;
  McCounts counts;
};

/// What the connectivity of all pieces costs with a context set.
Status contextSetCost(const std::vector<Connectivity>& pieces, uint32_t set, uint64_t& cost) {
  CostIo io;
  auto models = makeModels(set);
  FaceMesh mesh{Allocator{}};
  std::vector<uint32_t> node_map;
  std::vector<uint32_t> source_of_vertex;
  std::vector<uint32_t> source_gate;
  for (const Connectivity& piece : pieces) {
    if (!mesh.words.resize(size_t{piece.counts.face_count} * kFaceWords)) throwBadAlloc();
    node_map.resize(piece.record->node_count);
    source_of_vertex.resize(piece.counts.vertex_count);
    source_gate.resize(piece.counts.face_count);
    const McTruth truth =
        connectivityTruth(*piece.record, {node_map, source_of_vertex, source_gate});
    MCC_TRY(McMachine<CostIo>(io, models->mc, piece.counts, {}, mesh, truth, nullptr).run());
  }
  cost = io.cost();
  return {};
}

Status chooseContextSet(const std::vector<Connectivity>& pieces, const Jobs& jobs,
                        uint32_t& best_set) {
  uint64_t costs[kContextSetCount];
  MCC_TRY(jobs.tryAll(kContextSetCount, [&](size_t set) {
    return contextSetCost(pieces, static_cast<uint32_t>(set), costs[set]);
  }));
  best_set = static_cast<uint32_t>(std::min_element(costs, std::end(costs)) - costs);
  return {};
}

using Runners = std::vector<std::unique_ptr<StageRunner<CostIo>>>;

/// One choice for all pieces, since they share tables and models. Consumes the recordings.
PositionParameters choosePositions(std::vector<RecordedPositions> recorded, double surface_bits,
                                   uint8_t effort, const Jobs& jobs) {
  std::vector<PositionCandidate> candidates;
  for (const RecordedPositions& piece : recorded) candidates.push_back(piece.candidate);
  return choosePositionParameters(candidates, surface_bits, effort, jobs);
}

/// Floats on a grid may be coded as floats as well: the values of a plan are the same.
std::vector<AttributeInfo> exactAlternatives(const AttributeInfo& info) {
  std::vector<AttributeInfo> all = {info};
  if (info.coding == AttributeCoding::kGrid && info.format.morph_target == 0) {
    AttributeInfo plain;
    plain.format = info.format;
    plain.coding = AttributeCoding::kExactFloat;
    all.push_back(plain);
  }
  return all;
}

/// Tries the candidates of one attribute, from where its models are, and goes on with the best. `goes_on`: some later
/// attribute shares its models.
/// `wedge_share`: what the payload takes so far, per wedge, in the units of costs.
Status chooseAttributeMethod(Plan& plan, uint32_t index, StageRunner<CostIo>& runner,
                             PayloadModels& models, double wedge_share, bool goes_on) {
  AttributeInfo& info = plan.attributes[index].info;
  const std::vector<AttributeInfo> alternatives = exactAlternatives(info);
  const uint32_t part = std::max(kTrialWedges, plan.header.wedge_count / kTrialShare);
  // What lies below a grid is always coded for all wedges. A part of the ids may be all alike.
  const bool may_be_ids =
      info.format.component_count == 1 && info.format.semantic == Semantic::kCustom;
  const uint32_t sample = alternatives.size() > 1 || may_be_ids ? kNone : part;
  const auto before = std::make_unique<AttributeModels>(models.attributes);
  AttributeInfo best = info;
  uint64_t best_cost = ~uint64_t{0};
  for (AttributeInfo candidate : alternatives) {
    info = candidate;
    std::vector<AttributeInfo> infos;
    for (const QuantizedAttribute& a : plan.attributes) infos.push_back(a.info);
    const AttributeMethod method = methodOf(infos.data(), plan.header.attribute_count, index);
    if (method == AttributeMethod::kWithAnother) return {};
    PredictorSearch search(infos.data(), plan.header.attribute_count, index,
                           plan.header.has(piece_flag::kSeams));
    if (alternatives.size() == 1 && search.isSettled()) {
      best.predictor = search.best();
      break;
    }
    while (!search.done()) {
      uint64_t cost = 0;
      info.predictor = candidate.predictor = search.candidate();
      MCC_TRY(runner.tryAttribute(index, sample, cost));
      if (info.format.morph_target == 0) {  // deltas take time only where something moves
        const double tried = std::min(sample, plan.header.wedge_count);
        cost +=
            static_cast<uint64_t>(surcharge(tried * wedge_share, timeOf(method, info.predictor)));
      }
      search.report(cost);
      models.attributes = *before;
      if (cost >= best_cost) continue;
      best_cost = cost;
      best = candidate;
    }
  }
  info = best;
  return goes_on ? runner.codeAttribute(index, nullptr) : runner.passAttribute(index);
}

/// Creases and the methods of all attributes but positions, which are the same however they are coded. `io` has counted the
/// surfaces.
Status chooseMethods(std::vector<Plan>& plans, Runners& runners, PayloadModels& models,
                     const CostIo& io) {
  const bool only_positions = std::all_of(plans.begin(), plans.end(), [](const Plan& plan) {
    return plan.attributes.size() == 1 && !plan.header.has(piece_flag::kSeams);
  });
  if (only_positions) return {};
  double wedges = 1;
  for (size_t i = 0; i < plans.size(); ++i) {
    MCC_TRY(runners[i]->codePositions(nullptr));
    wedges += plans[i].header.wedge_count;
  }
  const double wedge_share = static_cast<double>(io.cost()) / wedges;
  for (size_t i = 0; i < plans.size(); ++i) {
    MCC_TRY(runners[i]->chooseCreases(models));
    MCC_TRY(runners[i]->codeSeams(nullptr));
    MCC_TRY(runners[i]->prepareAttributes());
    const std::vector<uint32_t> order = codingOrder(plans[i]);
    for (size_t k = 0; k < order.size(); ++k) {
      bool goes_on = i + 1 < plans.size();
      for (size_t later = k + 1; later < order.size(); ++later) {
        goes_on |= plans[i].attributes[order[later]].info.format.semantic ==
                   plans[i].attributes[order[k]].info.format.semantic;
      }
      MCC_TRY(chooseAttributeMethod(plans[i], order[k], *runners[i], models, wedge_share, goes_on));
    }
  }
  return {};
}

Status choosePredictors(std::vector<Plan>& plans, uint8_t effort, const Jobs& jobs) {
  auto models = makeModels(0);  // none of these choices depends on the context set
  CostIo io;
  Runners runners;
  for (Plan& plan : plans) {
    runners.push_back(std::make_unique<StageRunner<CostIo>>(io, *models, plan));
    MCC_TRY(runners.back()->codeSurface(nullptr));
  }
  const double surface_bits = static_cast<double>(io.cost()) / kCostOne;
  if (plans[0].attributes.empty()) return chooseMethods(plans, runners, *models, io);
  std::vector<RecordedPositions> recorded(plans.size());
  MCC_TRY(jobs.tryAll(plans.size(),
                      [&](size_t i) { return runners[i]->recordPositions(recorded[i]); }));
  PositionParameters chosen;
  MCC_TRY(jobs.tryAll(2, [&](size_t i) -> Status {
    if (i == 1) return chooseMethods(plans, runners, *models, io);
    chosen = choosePositions(std::move(recorded), surface_bits, effort, jobs);
    return {};
  }));
  for (Plan& plan : plans) {
    plan.positions_as = chosen;
    plan.attributes[0].info.predictor = PieceCoder<CostIo>::positionFlags(chosen);
  }
  return {};
}

/// The context set, predictors and methods, once the surface of every piece is settled.
Status chooseAll(std::vector<Plan>& plans, const EncodeOptions& options, const Jobs& jobs,
                 uint32_t& context_set) {
  std::vector<Connectivity> connectivity;
  for (const Plan& plan : plans) {
    const PieceHeader& h = plan.header;
    connectivity.push_back({&plan.record,
                            {h.operation_count, h.vertex_count, h.dummy_count, h.face_count,
                             h.has(piece_flag::kHandles)}});
  }
  context_set = options.context_set;
  return jobs.tryAll(2, [&](size_t i) -> Status {
    if (i == 0) return choosePredictors(plans, options.effort, jobs);
    const bool is_given = context_set < kContextSetCount;
    return is_given ? Status{} : chooseContextSet(connectivity, jobs, context_set);
  });
}

/// Instead of chooseAttributeMethod().
void varyAttributeMethod(Plan& plan, uint32_t index, Variation& variation) {
  std::vector<AttributeInfo> infos;
  for (const QuantizedAttribute& a : plan.attributes) infos.push_back(a.info);
  infos[index] = variation.oneOf(exactAlternatives(infos[index]));
  variation.predictors(infos, index);
  for (size_t i = 0; i < infos.size(); ++i) plan.attributes[i].info = infos[i];
}

/// Instead of chooseAll(), for tests: choices at random.
Status varyAll(std::vector<Plan>& plans, const EncodeOptions& options, Variation& variation,
               uint32_t& context_set) {
  context_set = options.context_set;
  if (context_set >= kContextSetCount) context_set = variation.below(kContextSetCount);
  auto models = makeModels(context_set);
  CostIo io;
  Runners runners;
  for (Plan& plan : plans) {
    runners.push_back(std::make_unique<StageRunner<CostIo>>(io, *models, plan));
    MCC_TRY(runners.back()->codeSurface(nullptr));
  }
  if (plans[0].attributes.empty()) return {};
  std::vector<RecordedPositions> recorded(plans.size());
  std::vector<PositionCandidate> candidates;
  for (size_t i = 0; i < plans.size(); ++i) {
    MCC_TRY(runners[i]->recordPositions(recorded[i]));
    candidates.push_back(recorded[i].candidate);
  }
  const PositionParameters positions = variation.positions(candidates);
  for (size_t i = 0; i < plans.size(); ++i) {
    Plan& plan = plans[i];
    plan.positions_as = positions;
    plan.attributes[0].info.predictor = PieceCoder<CostIo>::positionFlags(positions);
    if (plan.header.has(piece_flag::kSeams) && variation.coin())
      plan.header.flags ^= piece_flag::kCreases;
    for (const uint32_t a : codingOrder(plan)) varyAttributeMethod(plan, a, variation);
  }
  return {};
}

// --- output ------------------------------------------------------------------------------------------

void scale(StreamSizes& sizes, double by) {
  for (double* bits : {&sizes.connectivity_bits, &sizes.stitch_bits, &sizes.leftover_bits,
                       &sizes.seam_bits, &sizes.position_bits, &sizes.order_bits}) {
    *bits *= by;
  }
  for (double& bits : sizes.attribute_bits) bits *= by;
}

Status codeAll(std::vector<Plan>& plans, uint32_t context_set, bool single, EncodeResult& result) {
  EncoderIo io(single);
  auto models = makeModels(context_set);
  PayloadHeader header{Allocator{}};
  header.flags =
      context_set << payload_flag::kContextSetShift | (single ? payload_flag::kSingleCoder : 0);
  result.sizes = StreamSizes{};
  result.pieces.clear();
  for (Plan& plan : plans) {
    StageRunner<EncoderIo> runner(io, *models, plan, header.attributes.size());
    result.sizes.attribute_bits.resize(header.attributes.size() + plan.attributes.size(), 0);
    MCC_TRY(runner.codeSurface(&result.sizes));
    MCC_TRY(runner.codePositions(&result.sizes));
    MCC_TRY(runner.codeSeams(&result.sizes));
    MCC_TRY(runner.codeOrders(&result.sizes));
    MCC_TRY(runner.prepareAttributes());
    for (const uint32_t a : codingOrder(plan)) MCC_TRY(runner.codeAttribute(a, &result.sizes));

    plan.header.first_attribute = static_cast<uint32_t>(header.attributes.size());
    plan.header.first_part = static_cast<uint32_t>(header.parts.size());
    for (const QuantizedAttribute& a : plan.attributes) {
      if (!header.attributes.push_back(a.info)) throwBadAlloc();
    }
    for (const PartView& part : plan.view->parts) {
      if (!header.parts.push_back({static_cast<uint32_t>(part.indices.size() / 3)}))
        throwBadAlloc();
    }
    if (!header.pieces.push_back(plan.header)) throwBadAlloc();

    PieceResult piece;
    piece.source_wedge = plan.wedge_source;
    if (plan.header.has(piece_flag::kVertexOrder)) {
      std::iota(piece.source_wedge.begin(), piece.source_wedge.end(), 0u);
    }
    piece.topological_vertex_count = runner.groupCount();
    piece.cut_copy_count = plan.header.vertex_count - runner.groupCount();
    piece.hole_count = plan.cut.hole_count;
    piece.component_count = static_cast<uint32_t>(plan.cut.mesh.components.size());
    piece.leftover_triangle_count =
        static_cast<uint32_t>(plan.header.triangleCount()) - plan.header.face_count;
    result.pieces.push_back(std::move(piece));
  }
  const double coded_bits = static_cast<double>(io.cost()) / kCostOne;
  const EncoderIo::Streams streams = io.finish();
  result.payload = writePayload(header, streams.codes, streams.tokens, streams.raw);
  const double stream_bits =
      8.0 * static_cast<double>(streams.codes.size() + streams.tokens.size() + streams.raw.size());
  // The count of costs is off by a little, which over millions of tokens may be more than the flushes.
  const double spent_bits = std::min(coded_bits, stream_bits);
  if (spent_bits < coded_bits) scale(result.sizes, spent_bits / coded_bits);
  result.sizes.header_bits = 8.0 * static_cast<double>(result.payload.size()) - spent_bits;
  return {};
}

Status encodePieces(std::span<const PieceView> pieces, const EncodeOptions& options,
                    EncodeResult& result) {
  if (pieces.empty()) return fail(Error::kBadArgument, "there is nothing to encode");
  result = EncodeResult{};
  const Jobs jobs(options.run_jobs);
  std::vector<Plan> plans(pieces.size());
  std::vector<std::vector<std::string>> notes(pieces.size());
  const auto prepare = [&](size_t i) -> Status {
    MCC_TRY(preparePiece(pieces[i], options, jobs, plans[i], notes[i]));
    return choosePairing(plans[i], i == 0 ? options.start_half_edge : kNone, jobs);
  };
  MCC_TRY(jobs.tryAll(pieces.size(), prepare));
  uint64_t vertices = 0;
  for (size_t i = 0; i < pieces.size(); ++i) {
    vertices += plans[i].header.vertex_count;
    result.notes.insert(result.notes.end(), notes[i].begin(), notes[i].end());
  }
  uint32_t context_set = kNone;
  Variation variation(options.variation);
  MCC_TRY(variation.active() ? varyAll(plans, options, variation, context_set)
                             : chooseAll(plans, options, jobs, context_set));
  MCC_TRY(codeAll(plans, context_set, false, result));
  if (vertices > kSingleCoderVertices) return {};
  EncodeResult single;
  MCC_TRY(codeAll(plans, context_set, true, single));
  if (variation.active() ? variation.coin() : single.payload.size() < result.payload.size()) {
    single.notes = std::move(result.notes);
    result = std::move(single);
  }
  return {};
}

}  // namespace

Status encode(std::span<const PieceView> pieces, const EncodeOptions& options,
              EncodeResult& result) {
  return catchBadAlloc(
      [&]() { return encodePieces(pieces, options, result); },
      []() { return fail(Error::kOutOfMemory, "no memory for the encoder"); });
}

}  // namespace mcc
