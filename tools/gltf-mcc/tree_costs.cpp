// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tree_costs.h"

#include <memory>

#include "entropy/decoder.h"
#include "entropy/enc_cost.h"
#include "mcc/reader.h"
#include "positions/enc_recording.h"
#include "reader/outputs.h"
#include "reader/piece.h"
#include "reader/starts.h"

namespace mcc::tool {
namespace {

/// Decodes as the reader's Ios do, and counts for each vertex what its symbols take. A vertex is
/// done when its record is known, so the next of the walk over the mesh is the one being decoded.
class MeasuringIo {
 public:
  using Burst = SameIo<MeasuringIo>;
  using CodesBurst = SameIo<MeasuringIo>;
  static constexpr bool kEncoding = false;
  static constexpr bool kFast = false;

  MeasuringIo(const Streams& streams, bool is_single)
      : codes_(streams.codes), tokens_(streams.tokens), raw_(streams.raw), is_single_(is_single) {}

  bool bit(BitModel& model, bool = false) {
    const uint32_t zero = model.zeroProbability();
    const bool one = codes_.bit(model);
    spend(costOf(one ? kProbabilityOne - zero : zero, kProbabilityBits));
    return one;
  }
  template <uint32_t kState>
  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t = 0) {
    const TokenRow before = row;
    const uint32_t symbol =
        is_single_ ? codes_.token(row, schedule) : tokens_.token(kState, row, schedule);
    spend(costOf(before.frequency(symbol), kTokenBits));
    return symbol;
  }
  uint32_t raw(uint32_t bits, uint32_t = 0) {
    spend(uint64_t{bits} * kCostOne);
    return is_single_ ? codes_.raw(bits) : raw_.read(bits);
  }
  uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t, uint32_t& negative) {
    const uint32_t value = base + raw(bits);
    negative = raw(sign && value != 0 ? 1 : 0);
    return value;
  }
  bool overrun() const {
    return codes_.overrun() || (!is_single_ && (tokens_.overrun() || raw_.overrun()));
  }

  /// From here on, counts for the groups of `walk`, in this order. All of their records must be
  /// known until the walk begins.
  void watch(const Array<VertexRecord>& records, std::vector<uint32_t> walk) {
    records_ = &records;
    walk_ = std::move(walk);
    cost_.assign(records.size(), 0);
  }
  double bitsOf(uint32_t group) const { return static_cast<double>(cost_[group]) / kCostOne; }

 private:
  void spend(uint64_t cost) {
    // Before the walk begins, and after its end, the last of its vertices is known.
    if (walk_.empty() || (*records_)[walk_.back()].known()) return;
    while ((*records_)[walk_[next_]].known()) ++next_;
    cost_[walk_[next_]] += cost;
  }

  RangeDecoder codes_;
  RansDecoder tokens_;
  RawBitsDecoder raw_;
  const bool is_single_;
  const Array<VertexRecord>* records_ = nullptr;
  std::vector<uint32_t> walk_;
  size_t next_ = 0;
  std::vector<uint64_t> cost_;  ///< by group, in units of 1 / kCostOne bit
};
static_assert(SymbolIo<MeasuringIo>);

/// Fills `walk` with the groups in coding order.
Status findWalk(CodedPiece& piece, std::vector<uint32_t>& walk) {
  std::vector<VertexRecord> records(piece.groups.count);
  const std::vector<int32_t> nowhere(3 * records.size(), 0);
  PositionRecording recording;
  MCC_TRY(recording.record(piece.mesh, piece.groups, records.data(), nowhere.data()));
  for (const PositionRecording::Visit& visit : recording.visits()) walk.push_back(visit.vertex);
  return {};
}

Status measure(MeasuringIo& io, PieceCoder<MeasuringIo>& piece, const PieceHeader& header) {
  const PieceTruth nothing;
  MCC_TRY(piece.codeConnectivity(nothing));
  MCC_TRY(piece.codeStitch(nothing));
  std::vector<uint32_t> walk;
  MCC_TRY(findWalk(piece, walk));
  VertexRecord known{};
  known.q[3] = kKnown;
  if (!piece.records.assign(size_t{piece.groups.count} + header.isolated_count, known))
    return fail(Error::kOutOfMemory, "no memory for the positions");
  io.watch(piece.records, std::move(walk));
  MCC_TRY(piece.codePositions(nothing));
  MCC_TRY(piece.codeSeams(nothing));
  MCC_TRY(piece.codeLeftovers(nothing));
  return piece.codeOrders(nothing);
}

}  // namespace

Status positionCosts(std::span<const uint8_t> payload, std::vector<float>& bits) {
  const Allocator allocator;
  PayloadHeader header(allocator);
  MCC_TRY(parsePayload(payload, mcc::Limits{}, header));
  if (header.hasBlocks() || header.pieces.empty())
    return fail(Error::kBadArgument, "its payload has blocks");
  const PieceHeader& first = header.pieces[0];
  if (first.attribute_count == 0) return fail(Error::kBadArgument, "its payload has no positions");
  MeasuringIo io(header.streams, header.singleCoder());
  const auto models = std::make_unique<PayloadModels>();
  if (header.startsTrained() && !startTrained(*models, header.attributes.size() > 1, allocator))
    return fail(Error::kOutOfMemory, "no memory for the models");
  PieceCoder<MeasuringIo> piece(io, *models, first, header.attributesOf(first), allocator);
  MCC_TRY(measure(io, piece, first));
  const WedgeAt wedge_at = wedgeAt(piece, first.wedge_count);
  const auto groupAt = [&](uint32_t i) {
    return piece.groupOf(static_cast<uint32_t>(wedge_at(i)));
  };
  std::vector<uint32_t> wedges_of(piece.records.size(), 0);
  for (uint32_t i = 0; i < first.wedge_count; ++i) ++wedges_of[groupAt(i)];
  for (uint32_t i = 0; i < first.wedge_count; ++i)
    bits.push_back(static_cast<float>(io.bitsOf(groupAt(i)) / wedges_of[groupAt(i)]));
  return {};
}

}  // namespace mcc::tool
