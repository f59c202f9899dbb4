// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reader: parses the header, runs every piece through its stages (piece.h), and stores floats and
// indices in the caller's memory.
#include "mcc/reader.h"

#include <algorithm>
#include <new>
#include <utility>

#include "base/memory.h"
#include "base/working_memory.h"
#include "container/payload_header.h"
#include "entropy/decoder_io.h"
#include "format/decodes.h"
#include "mesh/dequantize.h"
#include "reader/instances.h"
#include "reader/piece.h"
#include "vectors/octahedral.h"

namespace mcc {

struct Payload::State {
  explicit State(const Allocator& a) : allocator(a), header(a), pieces(a) {}

  Allocator allocator;
  PayloadHeader header;
  Array<PieceInfo> pieces;
  PayloadInfo info;
};

namespace {

const PayloadInfo kEmptyInfo{};

/// Which wedge goes to an element of the caller's memory.
struct WedgeAt {
  const uint32_t* order;  ///< null: as decoded

  size_t operator()(uint32_t place) const {
    return !decodes::kOrders || order == nullptr ? place : order[place];
  }
};
template <class Io>
WedgeAt wedgeAt(const PieceCoder<Io>& piece) {
  return {piece.wedge_order.empty() ? nullptr : piece.wedge_order.data()};
}

/// Where the integers of an element are, for all attributes alike. Compact code stores every
/// attribute through this.
struct ElementAt {
  const int32_t* values;
  size_t stride;
  WedgeAt wedge_at;
  const uint32_t* group = nullptr;  ///< by wedge; null: all but isolated wedges equal their group
  uint32_t isolated_first = ~uint32_t{0};  ///< wedges from here on come after the groups
  uint32_t group_count = 0;

  const int32_t* operator()(uint32_t place) const {
    size_t at = wedge_at(place);
    if (at >= isolated_first) {
      at = at - isolated_first + group_count;
    } else if (group != nullptr) {
      at = group[at];
    }
    return values + at * stride;
  }
};

/// Computes unit vectors from grid points, four at a time. If `has_sign`, a fourth component is -1
/// or 1.
template <class Load>
void storeNormals(int32_t centre, bool has_sign, uint32_t wedge_count,
                  const AttributeTarget& target, Load load) {
  uint8_t* to = static_cast<uint8_t*>(target.data);
  for (uint32_t w = 0; w < wedge_count; w += 4) {
    const uint32_t count = std::min(wedge_count - w, 4u);
    const int32_t* points[4];
    for (uint32_t i = 0; i < 4; ++i) points[i] = load(w + (i < count ? i : 0));
    Float4 rows[4];
    octahedralToUnit(points, centre, rows);
    rows[3] = allLanes(1.0f);
    transpose(rows[0], rows[1], rows[2], rows[3]);
    for (uint32_t i = 0; i < count; ++i, to += target.stride_bytes) {
      std::memcpy(to, &rows[i], (has_sign ? 4 : 3) * sizeof(float));
      if (has_sign && points[i][2] != 0) storeFloat(to + 12, -1.0f);
    }
  }
}

/// Stores lattice values. They have kComponents, which 0 leaves open.
template <uint32_t kComponents, class Load>
void storeLattice(const AttributeInfo& info, uint32_t wedge_count, const AttributeTarget& target,
                  Load load) {
  const uint32_t components = kComponents != 0 ? kComponents : info.format.component_count;
  const Lattice lattice = info.lattice;
  uint8_t* to = static_cast<uint8_t*>(target.data);
  for (uint32_t w = 0; w < wedge_count; ++w, to += target.stride_bytes) {
    const int32_t* q = load(w);
    for (uint32_t c = 0; c < components; ++c) {
      storeFloat(to + 4 * c, latticeValue(q[c], lattice.step, lattice.origin[c]));
    }
  }
}

/// Copies coded integers to the caller's elements; `load(i)` points to the integers of element i.
///                                                                                        [A.8.11]
template <class Load>
void storeElements(const AttributeInfo& info, uint32_t wedge_count, const AttributeTarget& target,
                   Load load) {
  if (target.data == nullptr) return;
  const AttributeFormat& format = info.format;
  const uint32_t components = format.component_count;
  uint8_t* to = static_cast<uint8_t*>(target.data);
  const size_t stride = target.stride_bytes;
  switch (info.coding) {
    case AttributeCoding::kLattice:
      if (!kCompact && components == 3) return storeLattice<3>(info, wedge_count, target, load);
      if (!kCompact && components == 2) return storeLattice<2>(info, wedge_count, target, load);
      return storeLattice<0>(info, wedge_count, target, load);
    case AttributeCoding::kOctahedral:
      storeNormals(octahedralCentre(info.bits), components == 4, wedge_count, target, load);
      return;
    case AttributeCoding::kExactFloat:
    case AttributeCoding::kGrid:  // its values are ordered floats at this point
      if (!decodes::kExactFloats) return;
      for (uint32_t w = 0; w < wedge_count; ++w, to += stride) {
        const int32_t* q = load(w);
        for (uint32_t c = 0; c < components; ++c) {
          const uint32_t bits = bitsFromOrdered(q[c]);
          std::memcpy(to + 4 * c, &bits, 4);
        }
      }
      return;
    default: {
      const uint32_t bytes = componentBytes(format.component_type);
      for (uint32_t w = 0; w < wedge_count; ++w, to += stride) {
        const int32_t* q = load(w);
        for (uint32_t c = 0; c < components; ++c) {
          storeInteger(to + size_t{bytes} * c, format.component_type, q[c]);
        }
      }
    }
  }
}

/// Computes tangents from angles in the planes of their normals. [A.8.7]
void storeTangents(const AttributeInfo& info, const int32_t* values,
                   const AttributeInfo& normal_info, const int32_t* normals, uint32_t wedge_count,
                   WedgeAt wedge_at, const AttributeTarget& target) {
  const int32_t centre = octahedralCentre(normal_info.bits);
  uint8_t* to = static_cast<uint8_t*>(target.data);
  for (uint32_t w = 0; w < wedge_count; w += 4) {
    const uint32_t count = std::min(wedge_count - w, 4u);
    const int32_t* points[4];
    AngleSteps steps[4] = {{0, 2}, {0, 2}, {0, 2}, {0, 2}};
    int32_t signs[4];
    for (uint32_t i = 0; i < 4; ++i) {
      const size_t from = wedge_at(w + (i < count ? i : 0));
      points[i] = normals + 2 * from;
      steps[i] = AngleSteps(values[2 * from], info.bits);
      signs[i] = values[2 * from + 1] != 0 ? -1 : 1;
    }
    Float4 normal[3];
    Float4 rows[4];
    octahedralToUnit(points, centre, normal);
    tangentFromSteps(
        normal, fourFloats(steps[0].quarter, steps[1].quarter, steps[2].quarter, steps[3].quarter),
        fourFloats(steps[0].rest, steps[1].rest, steps[2].rest, steps[3].rest), info.bits, rows);
    rows[3] = fourFloats(signs[0], signs[1], signs[2], signs[3]);
    transpose(rows[0], rows[1], rows[2], rows[3]);
    for (uint32_t i = 0; i < count; ++i, to += target.stride_bytes) {
      std::memcpy(to, &rows[i], 4 * sizeof(float));
    }
  }
}

/// Stores `values`, value_stride per wedge, in the target of attribute `index` and of all its
/// aliases.
template <class Io>
void storeAttribute(const PieceCoder<Io>& piece, const PieceInfo& info, uint32_t index,
                    const int32_t* values, uint32_t value_stride,
                    std::span<const AttributeTarget> targets) {
  const AttributeInfo& a = info.attributes[index];
  const WedgeAt wedge_at = wedgeAt(piece);
  for (size_t i = index; i < targets.size(); ++i) {
    const bool is_alias = info.attributes[i].coding == AttributeCoding::kAlias &&
                          info.attributes[i].alias_of == index;
    if (targets[i].data == nullptr || (i != index && !is_alias)) continue;
    if (a.coding == AttributeCoding::kTangentAngle) {
      storeTangents(a, values, piece.tangentNormalInfo(), piece.tangentNormals(), info.wedge_count,
                    wedge_at, targets[i]);
    } else {
      if constexpr (kCompact) {
        storeElements(a, info.wedge_count, targets[i], ElementAt{values, value_stride, wedge_at});
      } else {
        storeElements(a, info.wedge_count, targets[i],
                      [=](uint32_t place) { return values + wedge_at(place) * value_stride; });
      }
    }
  }
}

template <class Io>
void storePositions(const PieceCoder<Io>& piece, const AttributeInfo& info, uint32_t wedge_count,
                    const AttributeTarget& target) {
  const VertexRecord* records = piece.records.data();
  if constexpr (kCompact) {
    storeElements(info, wedge_count, target,
                  ElementAt{records->q, sizeof(VertexRecord) / sizeof(int32_t), wedgeAt(piece),
                            piece.wedge_group.empty() ? nullptr : piece.wedge_group.data(),
                            piece.wedges.isolated_first, piece.groups.count});
  } else if (piece.wedge_group.empty() && piece.wedge_order.empty()) {
    storeElements(info, wedge_count, target, [=](uint32_t w) { return records[w].q; });
  } else {
    storeElements(info, wedge_count, target,
                  [&piece, records, wedge_at = wedgeAt(piece)](uint32_t i) {
                    return records[piece.groupOf(static_cast<uint32_t>(wedge_at(i)))].q;
                  });
  }
}

void storeIndex(const PartTarget& target, size_t at, uint32_t index) {
  switch (target.index_type) {
    case IndexType::kUint8:
      static_cast<uint8_t*>(target.indices)[at] = static_cast<uint8_t>(index);
      return;
    case IndexType::kUint16:
      static_cast<uint16_t*>(target.indices)[at] = static_cast<uint16_t>(index);
      return;
    case IndexType::kUint32: static_cast<uint32_t*>(target.indices)[at] = index; return;
  }
}

/// Stores the triangles in the usual case of one part and no triangles apart from the surface.
template <class Index>
void storeFaces(const FaceMesh& mesh, Index* to) {
  const uint32_t* face = mesh.words.data();
  for (uint32_t f = 0; f < mesh.face_count; ++f, face += kFaceWords, to += 3) {
    for (int k = 0; k < 3; ++k) to[k] = static_cast<Index>(face[k]);
  }
}

template <class Io>
Status tellMcEdges(const PieceCoder<Io>& piece, uint32_t piece_index,
                   const DecodeOptions& options) {
  Array<uint32_t> place_of(options.allocator);
  if (!place_of.resize(piece.wedge_order.size()))
    return fail(Error::kOutOfMemory, "no memory for the mc-edges");
  for (uint32_t i = 0; i < piece.wedge_order.size(); ++i) place_of[piece.wedge_order[i]] = i;
  const auto wedge = [&](uint32_t half_edge) {
    const uint32_t w = piece.mesh.words[half_edge];
    return place_of.empty() ? w : place_of[w];
  };
  for (size_t i = 0; i < piece.mc_edges.size(); ++i) {
    const McEdgeCorners corners = piece.mc_edges[i];
    options.mc_edge(options.mc_edge_user, piece_index, wedge(corners.of_vertex),
                    wedge(corners.of_from));
  }
  return {};
}

Status checkPartCounts(std::span<const PartInfo> infos, const Array<uint32_t>& counts) {
  for (size_t p = 0; p < infos.size(); ++p) {
    if (counts[p] != infos[p].triangle_count) {
      return fail(Error::kBadAttribute,
                  "a part has another number of triangles than the header claims");
    }
  }
  return {};
}

/// Stores triangles and wedges in the orders that are kept.
template <class Io>
Status storeOrderedTriangles(const PieceCoder<Io>& piece, std::span<const PartInfo> infos,
                             std::span<const PartTarget> targets, const Allocator& allocator) {
  Array<uint32_t> fill(allocator);
  Array<uint32_t> place_of(allocator);
  if (!fill.assign(targets.size(), 0) || !place_of.resize(piece.wedge_order.size()))
    return fail(Error::kOutOfMemory, "no memory for the order");
  for (uint32_t i = 0; i < piece.wedge_order.size(); ++i) place_of[piece.wedge_order[i]] = i;
  const TriangleTable& table = piece.triangles;
  for (uint32_t i = 0; i < table.count(); ++i) {
    const uint32_t ordered =
        piece.triangle_order.empty() ? orderedTriangle(i, 0) : piece.triangle_order[i];
    const uint32_t triangle = ordered >> 2;
    const uint32_t part = table.partOf(triangle);
    const uint32_t at = fill[part]++;
    if (at >= infos[part].triangle_count || targets[part].indices == nullptr) continue;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t wedge = table.wedges[3 * size_t{triangle} + ((ordered & 3) + k) % 3];
      storeIndex(targets[part], 3 * size_t{at} + k, place_of.empty() ? wedge : place_of[wedge]);
    }
  }
  return checkPartCounts(infos, fill);
}

/// Stores faces in decoding order, then the listed triangles, split into parts. [A.10.4]
template <class Io>
Status storeTriangles(PieceCoder<Io>& piece, std::span<const PartInfo> infos,
                      std::span<const PartTarget> targets, const Allocator& allocator) {
  if (decodes::kOrders && piece.triangles.count() != 0)
    return storeOrderedTriangles(piece, infos, targets, allocator);
  const bool many = targets.size() > 1;
  if (!many && piece.list.empty()) {
    void* to = targets[0].indices;
    if (to == nullptr) return {};
    switch (targets[0].index_type) {
      case IndexType::kUint8: storeFaces(piece.mesh, static_cast<uint8_t*>(to)); break;
      case IndexType::kUint16: storeFaces(piece.mesh, static_cast<uint16_t*>(to)); break;
      case IndexType::kUint32: storeFaces(piece.mesh, static_cast<uint32_t*>(to)); break;
    }
    return {};
  }
  Array<uint32_t> fill(allocator);
  if (!fill.assign(targets.size(), 0)) return fail(Error::kOutOfMemory, "no memory for the parts");
  const auto store = [&](uint32_t part, const uint32_t* wedges) {
    const size_t at = fill[part]++;
    if (at >= infos[part].triangle_count || targets[part].indices == nullptr) return;
    for (size_t k = 0; k < 3; ++k) storeIndex(targets[part], 3 * at + k, wedges[k]);
  };
  for (uint32_t f = 0; f < piece.mesh.face_count; ++f) {
    const uint32_t* face = piece.mesh.words.data() + size_t{f} * kFaceWords;
    store(many ? face[kFaceWord] : 0, face);
  }
  for (size_t i = 0; i < piece.list.size(); ++i) store(piece.list[i].part, piece.list[i].wedge);
  return checkPartCounts(infos, fill);
}

[[maybe_unused]] Status checkTargets(const PayloadInfo& info,
                                     std::span<const PieceTarget> targets) {
  if (targets.size() != info.pieces.size()) {
    return fail(Error::kBadArgument, "the number of targets is not the number of pieces");
  }
  for (size_t i = 0; i < targets.size(); ++i) {
    const PieceInfo& piece = info.pieces[i];
    if (targets[i].attributes.size() != piece.attributes.size() ||
        targets[i].parts.size() != piece.parts.size()) {
      return fail(Error::kBadArgument, "a target does not have the shape of its piece");
    }
    for (size_t a = 0; a < piece.attributes.size(); ++a) {
      const AttributeTarget& t = targets[i].attributes[a];
      if (t.data != nullptr && t.stride_bytes < elementBytes(piece.attributes[a].format)) {
        return fail(Error::kBadArgument, "the stride of a target is smaller than its elements");
      }
    }
    for (const PartTarget& t : targets[i].parts) {
      const uint32_t bits = 8 * static_cast<uint32_t>(t.index_type);
      if (bits < 32 && piece.wedge_count > (1u << bits)) {
        return fail(Error::kBadArgument, "the index type of a target is too narrow");
      }
    }
  }
  return {};
}

/// Reports to the caller how many elements [A.2.6] are done.
class Progress {
 public:
  Progress(const DecodeOptions& options, const PayloadHeader& header) : options_(options) {
    if (!kCompact && options.progress != nullptr) all_ = elementsOf(header);
  }

  /// Returns an error if the caller asks to stop.
  Status advance(uint64_t elements) {
    if (kCompact || options_.progress == nullptr) return {};
    done_ += elements;
    const double share = all_ == 0 ? 1 : static_cast<double>(done_) / static_cast<double>(all_);
    if (options_.progress(options_.progress_user, share)) return {};
    return fail(Error::kCancelled, "decoding was cancelled");
  }

 private:
  const DecodeOptions& options_;
  uint64_t all_ = 0;
  uint64_t done_ = 0;
};

/// Reports to the caller what the stages of a piece read.
template <class Io>
class StageBits {
 public:
  StageBits(const Io& io, uint32_t piece, const DecodeOptions& options)
      : io_(io), piece_(piece), options_(options), last_(now()) {}

  void tell(DecodeStage stage, uint32_t attribute = 0) {
    if (kCompact || options_.stage_bits == nullptr) return;
    const uint64_t bits = now();
    // Counts are exact to one bit only, so a stage that reads nothing may seem to give some back.
    const uint64_t spent = bits > last_ ? bits - last_ : 0;
    last_ = std::max(last_, bits);
    options_.stage_bits(options_.stage_bits_user, piece_, stage, attribute, spent);
  }

 private:
  uint64_t now() const { return kCompact || options_.stage_bits == nullptr ? 0 : io_.spentBits(); }

  const Io& io_;
  const uint32_t piece_;
  const DecodeOptions& options_;
  uint64_t last_;
};

/// Decodes an attribute and stores it. Attributes that are coded with another one are stored with
/// that one.
template <class Io>
Status decodeAttribute(PieceCoder<Io>& piece, const PieceInfo& info, uint32_t index,
                       const PieceTarget& target, Array<int32_t>& values) {
  const AttributeMethod method = methodOf(info.attributes, index);
  if (isWithAnother(method)) return {};
  MCC_TRY(piece.codeAttribute(index, values));
  const uint32_t stride = piece.codedComponentsOf(index);
  storeAttribute(piece, info, index, values.data(), stride, target.attributes);
  if (method != AttributeMethod::kSkin || info.wedge_count == 0) return {};
  storeAttribute(piece, info, skinPartner(info.attributes, index), values.data() + kSkinSlots,
                 stride, target.attributes);
  return {};
}

template <class Io>
Status decodePiece(Io& io, PayloadModels& models, const PieceHeader& header, const PieceInfo& info,
                   const PieceTarget& target, uint32_t piece_index, const DecodeOptions& options,
                   Progress& progress) {
  const Allocator& allocator = options.allocator;
  PieceCoder<Io> piece(io, models, header, info.attributes, allocator);
  StageBits<Io> bits(io, piece_index, options);
  const PieceTruth nothing;
  MCC_TRY(piece.codeConnectivity(nothing, options.histogram, options.mc_edge != nullptr));
  bits.tell(DecodeStage::kConnectivity);
  MCC_TRY(progress.advance(header.operation_count));
  MCC_TRY(piece.codeStitch(nothing));
  bits.tell(DecodeStage::kStitching);
  MCC_TRY(progress.advance(header.vertex_count));
  MCC_TRY(piece.codePositions(nothing));
  bits.tell(DecodeStage::kPositions);
  if (header.attribute_count != 0) {
    MCC_TRY(progress.advance(attributeElements(header, info.attributes[0].format)));
  }
  MCC_TRY(piece.codeSeams(nothing));
  bits.tell(DecodeStage::kSeams);
  MCC_TRY(piece.codeLeftovers(nothing));
  bits.tell(DecodeStage::kLeftovers);
  MCC_TRY(piece.codeOrders(nothing));
  bits.tell(DecodeStage::kOrders);
  if (header.attribute_count != 0)
    storePositions(piece, info.attributes[0], info.wedge_count, target.attributes[0]);
  MCC_TRY(storeTriangles(piece, info.parts, target.parts, allocator));
  if (kTellsMcEdges && options.mc_edge != nullptr)
    MCC_TRY(tellMcEdges(piece, piece_index, options));
  MCC_TRY(progress.advance(surfaceElements(header) - header.operation_count - header.vertex_count));
  Array<int32_t> values(allocator);
  MCC_TRY(piece.prepareAttributes());
  for (uint32_t phase = 0; phase < kCodingPhases; ++phase) {
    for (uint32_t a = 1; a < info.attributes.size(); ++a) {
      if (codingPhase(info.attributes[a]) != phase) continue;
      MCC_TRY(decodeAttribute(piece, info, a, target, values));
      bits.tell(DecodeStage::kAttribute, a);
      MCC_TRY(progress.advance(attributeElements(header, info.attributes[a].format)));
    }
  }
  return {};
}

template <class Io>
Status decodePieces(Io& io, const PayloadHeader& header, const PayloadInfo& info,
                    std::span<const PieceTarget> targets, const DecodeOptions& options) {
  void* memory = allocateBytes(options.allocator, sizeof(PayloadModels));
  if (memory == nullptr) return fail(Error::kOutOfMemory, "no memory for the models");
  PayloadModels* models = new (memory) PayloadModels(options.allocator);
  Progress progress(options, header);
  Status status;
  if (!models->mc.init(header.contextSet()))
    status = fail(Error::kOutOfMemory, "no memory for the models");
  for (size_t i = 0; i < targets.size() && status.ok(); ++i) {
    status = decodePiece(io, *models, header.pieces[i], info.pieces[i], targets[i],
                         static_cast<uint32_t>(i), options, progress);
  }
  if (status.ok()) status = io.finish();
  models->~PayloadModels();
  releaseBytes(options.allocator, memory, sizeof(PayloadModels));
  return status;
}

Status decodeAll(const PayloadHeader& header, const PayloadInfo& info,
                 std::span<const PieceTarget> targets, const DecodeOptions& options) {
  AdaptationTable::prepare();
  InitialRowTable::prepare();
  const auto decode = [&](auto&& io) { return decodePieces(io, header, info, targets, options); };
#if defined(MCC_COMPACT)
  return decode(CompactIo(header.codes, header.tokens, header.raw, header.singleCoder()));
#else
  if (header.singleCoder()) return decode(CompactIo(header.codes, {}, {}));
  return decode(StreamsIo(header.codes, header.tokens, header.raw));
#endif
}

/// Estimates the memory that the largest piece takes at any time.
[[maybe_unused]] uint64_t expectedBytes(const PayloadHeader& header) {
  uint64_t most = 0;
  for (size_t i = 0; i < header.pieces.size(); ++i) {
    const PieceHeader& p = header.pieces[i];
    uint64_t bytes = uint64_t{p.face_count} * kFaceWords * sizeof(uint32_t) +
                     uint64_t{p.vertex_count} * sizeof(VertexRecord);
    if (p.attribute_count > 1) bytes += uint64_t{p.wedge_count} * 48;
    most = std::max(most, bytes);
  }
  return most;
}

}  // namespace

Payload::Payload(Payload&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}

Payload& Payload::operator=(Payload&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Payload::~Payload() {
  if (state_ == nullptr) return;
  const Allocator allocator = state_->allocator;
  state_->~State();
  releaseBytes(allocator, state_, sizeof(State));
}

Status Payload::open(std::span<const uint8_t> bytes, const Limits& limits,
                     const Allocator& allocator) {
  *this = Payload();
  void* memory = allocateBytes(allocator, sizeof(State));
  if (memory == nullptr) return fail(Error::kOutOfMemory, "no memory for the header");
  Payload opened;
  opened.state_ = new (memory) State(allocator);
  State& state = *opened.state_;
  PayloadHeader& header = state.header;
  MCC_TRY(parsePayload(bytes, limits, header));
  if (!state.pieces.reserve(header.pieces.size()))
    return fail(Error::kOutOfMemory, "no memory for the header");
  for (size_t i = 0; i < header.pieces.size(); ++i) {
    const PieceHeader& p = header.pieces[i];
    PieceInfo info;
    info.wedge_count = p.wedge_count;
    info.vertex_count = p.vertex_count;
    info.surface = p.surface();
    info.attributes = header.attributesOf(p);
    info.parts = {header.parts.data() + p.first_part, p.part_count};
    info.keeps_vertex_order = p.has(piece_flag::kVertexOrder);
    info.keeps_triangle_order = p.has(piece_flag::kTriangleOrder);
    (void)state.pieces.push_back(info);  // cannot fail, since memory was reserved above
  }
  state.info.version_major = kVersionMajor;
  state.info.version_minor = header.version_minor;
  state.info.single_coder = header.singleCoder();
  state.info.context_set = header.contextSet();
  state.info.pieces = {state.pieces.data(), state.pieces.size()};
  state.info.codes_bytes = header.codes.size();
  state.info.tokens_bytes = header.tokens.size();
  state.info.raw_bits_bytes = header.raw.size();
  state.info.header_bytes = header.header_bytes;
  *this = std::move(opened);
  return {};
}

const PayloadInfo& Payload::info() const { return state_ == nullptr ? kEmptyInfo : state_->info; }

Status Payload::decode(std::span<const PieceTarget> targets, const DecodeOptions& options) const {
  if (state_ == nullptr) return fail(Error::kBadArgument, "no payload is open");
  if constexpr (!kCompact) MCC_TRY(checkTargets(state_->info, targets));  // else they are ours
  if constexpr (!kCompact) {  // compact code has no huge pages
    const uint64_t expected_bytes = expectedBytes(state_->header);
    if (isHeap(options.allocator) && WorkingMemory::pays(expected_bytes)) {
      WorkingMemory memory(expected_bytes);
      DecodeOptions with_memory = options;
      with_memory.allocator = memory.allocator();
      return decodeAll(state_->header, state_->info, targets, with_memory);
    }
  }
  return decodeAll(state_->header, state_->info, targets, options);
}

}  // namespace mcc
