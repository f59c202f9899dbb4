// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Never larger: which payloads pay for themselves.
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "gltf/compress.h"
#include "gltf/parallel.h"
#include "gltf/rebuild.h"

namespace mcc::gltf {
namespace {

constexpr uint64_t kViewJsonBytes = 48;      // {"buffer":0,"byteOffset":…,"byteLength":…}
constexpr uint64_t kSmallPieceBytes = 2048;  // larger ones gain for certain
constexpr uint64_t kSharedBytes = 24;        // of a payload: what its pieces have in common

/// Bytes of JSON that a piece adds to the file.
uint64_t jsonCostOf(const PiecePlan& piece, size_t number) {
  uint64_t cost = 0;
  for (size_t part = 0; part < piece.parts.size(); ++part) {
    const size_t bytes = extensionJson(0, number, piece, part).dump().size();
    cost += (bytes + sizeof("\"extensions\":{}")) * piece.parts[part].users.size();
  }
  return cost;
}

/// Bytes a payload adds to the file.
uint64_t costOf(const EncodedPayload& payload) {
  uint64_t cost = ((payload.result.payload.size() + 3) & ~uint64_t{3}) + kViewJsonBytes;
  for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
    cost += jsonCostOf(payload.plan.pieces[i], i);
  }
  return cost;
}

/// Counts source bytes by who needs them. A byte is freed when only payloads need it: each of those
/// frees it as long as the others stay.
class ByteOwners {
 public:
  static constexpr size_t kSomebodyElse = ~size_t{0};

  void add(const std::vector<ByteRange>& ranges, size_t owner) {
    for (const ByteRange& range : ranges) {
      if (range.begin == range.end) continue;
      edges_.push_back({range.buffer, range.begin, true, owner});
      edges_.push_back({range.buffer, range.end, false, owner});
    }
  }

  /// Fills in freed bytes per payload; returns those of all together.
  uint64_t count(std::vector<uint64_t>& freed) {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
      return std::tie(a.buffer, a.offset, a.is_begin) < std::tie(b.buffer, b.offset, b.is_begin);
    });
    std::map<size_t, uint32_t> open;  // owner -> open ranges
    uint64_t total = 0;
    for (size_t i = 0; i < edges_.size(); ++i) {
      const Edge& edge = edges_[i];
      uint32_t& count_of = open[edge.owner];
      count_of += edge.is_begin ? 1 : ~0u;
      if (count_of == 0) open.erase(edge.owner);
      if (open.empty() || open.count(kSomebodyElse) != 0) continue;
      const uint64_t bytes = edges_[i + 1].offset - edge.offset;  // an open range has an end
      total += bytes;
      for (const auto& [owner, ignored] : open) freed[owner] += bytes;
    }
    return total;
  }

 private:
  struct Edge {
    uint32_t buffer;
    uint64_t offset;
    bool is_begin;
    size_t owner;
  };
  std::vector<Edge> edges_;
};

template <typename Visit>
void visitAccessors(const PiecePlan& piece, const Visit& visit) {
  for (const AttributePlan& attribute : piece.attributes) visit(attribute.accessor);
  for (const PartPlan& part : piece.parts) {
    if (part.indices_accessor != kNone) visit(part.indices_accessor);
  }
}

struct OwnedPiece {
  const PiecePlan* piece;
  size_t owner;
};

/// Fills in the source bytes each owner's pieces free; returns those of all together.
uint64_t countFreed(const Document& document, const ForeignReferences& foreign,
                    const std::vector<bool>& in_other_use, const std::vector<OwnedPiece>& pieces,
                    std::vector<uint64_t>& freed) {
  std::vector<bool> is_ours(document.accessors.size(), false);
  ByteOwners owners;
  for (const OwnedPiece& owned : pieces) {
    visitAccessors(*owned.piece, [&](uint32_t accessor) {
      if (in_other_use[accessor]) return;
      is_ours[accessor] = true;
      owners.add(accessorRanges(document, accessor, foreign.keep_numbers), owned.owner);
    });
  }
  for (uint32_t accessor = 0; accessor < is_ours.size(); ++accessor) {
    if (is_ours[accessor]) continue;
    owners.add(accessorRanges(document, accessor, foreign.keep_numbers), ByteOwners::kSomebodyElse);
  }
  for (const Json& image : arrayOf(document.json, "images")) {
    uint64_t view = 0;
    const Json* number = findMember(image, "bufferView");
    if (number == nullptr || !asUnsigned(*number, view) || view >= document.views.size()) continue;
    const BufferView& range = document.views[view];
    owners.add({{range.buffer, range.offset, range.offset + range.length}},
               ByteOwners::kSomebodyElse);
  }
  return owners.count(freed);
}

/// Whether a piece has a position that another piece of the plan has, too: left as it was it would part from that one.
bool touchesAnother(const PayloadPlan& plan, const PiecePlan& piece) {
  const auto positionsOf = [](const PiecePlan& of) -> const AccessorData& {
    return (of.attributes.empty() ? of.ordinary : of.attributes)[0].source;
  };
  const auto textOf = [](std::span<const uint8_t> bytes) {
    return std::string(bytes.begin(), bytes.end());
  };
  std::set<std::string> own;
  const AccessorData& positions = positionsOf(piece);
  for (uint64_t i = 0; i < positions.count; ++i) own.insert(textOf(positions.element(i)));
  for (const PiecePlan& other : plan.pieces) {
    if (&other == &piece) continue;
    const AccessorData& others = positionsOf(other);
    for (uint64_t i = 0; i < others.count; ++i) {
      if (own.count(textOf(others.element(i))) != 0) return true;
    }
  }
  return false;
}

/// cost   "payload 20 bytes"
void leaveAlone(const PiecePlan& piece, const std::string& cost, uint64_t freed_bytes,
                std::vector<LeftAlone>& left_alone) {
  const std::string note = "would not become smaller (" + cost + ", buffers " +
                           std::to_string(freed_bytes) + " bytes); left as it was";
  for (const PartPlan& part : piece.parts) {
    for (const PrimitiveRef& user : part.users) left_alone.push_back({user, note});
  }
}

}  // namespace

uint64_t countFreedBytes(const Document& document, const ForeignReferences& foreign,
                         std::vector<EncodedPayload>& payloads) {
  std::vector<OwnedPiece> pieces;
  for (size_t i = 0; i < payloads.size(); ++i) {
    for (const PiecePlan& piece : payloads[i].plan.pieces) pieces.push_back({&piece, i});
  }
  std::vector<uint64_t> freed(payloads.size(), 0);
  const uint64_t total = countFreed(
      document, foreign, accessorsInOtherUse(document, foreign, payloads), pieces, freed);
  for (size_t i = 0; i < payloads.size(); ++i) payloads[i].freed_bytes = freed[i];
  return total;
}

Result dropTinyPieces(const Document& document, const ForeignReferences& foreign,
                      const ConvertOptions& options, std::vector<PayloadPlan>& plans,
                      std::vector<LeftAlone>& left_alone) {
  std::vector<const PayloadPlan*> all;
  std::vector<OwnedPiece> pieces;
  for (const PayloadPlan& plan : plans) {
    all.push_back(&plan);
    for (const PiecePlan& piece : plan.pieces) pieces.push_back({&piece, pieces.size()});
  }
  std::vector<uint64_t> freed(pieces.size(), 0);
  countFreed(document, foreign, accessorsInOtherUse(document, foreign, all), pieces, freed);
  std::vector<const PayloadPlan*> plan_of;
  for (const PayloadPlan& plan : plans) plan_of.insert(plan_of.end(), plan.pieces.size(), &plan);
  std::vector<uint64_t> bytes_alone(pieces.size(), 0);
  MCC_GLTF_TRY(runParallel(pieces.size(), options.thread_count, [&](size_t i) -> Result {
    const bool is_small = plan_of[i]->pieces.size() > 1 && freed[i] < kSmallPieceBytes;
    if (is_small) bytes_alone[i] = bytesAlone(options, *plan_of[i], *pieces[i].piece);
    return {};
  }));
  size_t next = 0;
  for (PayloadPlan& plan : plans) {
    std::vector<bool> is_dropped;
    for (const PiecePlan& piece : plan.pieces) {
      const uint64_t bytes = bytes_alone[next];
      const uint64_t freed_bytes = freed[next++];
      const uint64_t cost = jsonCostOf(piece, 1) + bytes - std::min(bytes, kSharedBytes);
      const bool is_tiny = bytes != 0 && cost >= freed_bytes;
      is_dropped.push_back(is_tiny && !touchesAnother(plan, piece));
      if (is_dropped.back()) {
        leaveAlone(piece, "payload and JSON " + std::to_string(cost) + " bytes", freed_bytes,
                   left_alone);
      }
    }
    std::vector<PiecePlan> kept;
    for (size_t i = 0; i < plan.pieces.size(); ++i) {
      if (!is_dropped[i]) kept.push_back(std::move(plan.pieces[i]));
    }
    plan.pieces = std::move(kept);
  }
  std::erase_if(plans, [](const PayloadPlan& plan) { return plan.pieces.empty(); });
  return {};
}

void dropLosers(const Document& document, const ForeignReferences& foreign,
                std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone) {
  while (!payloads.empty()) {
    const uint64_t total_freed = countFreedBytes(document, foreign, payloads);
    uint64_t total_cost = 0;
    bool some_lose = false;
    for (const EncodedPayload& payload : payloads) {
      total_cost += costOf(payload);
      some_lose |= costOf(payload) >= payload.freed_bytes;
    }
    // Payloads that share accessors may each gain by the same bytes and still lose together.
    const bool all_lose = !some_lose && total_cost >= total_freed;
    if (!some_lose && !all_lose) return;
    std::vector<EncodedPayload> winners;
    for (EncodedPayload& payload : payloads) {
      if (all_lose || costOf(payload) >= payload.freed_bytes) {
        for (const PiecePlan& piece : payload.plan.pieces) {
          leaveAlone(piece, "payload " + std::to_string(payload.result.payload.size()) + " bytes",
                     payload.freed_bytes, left_alone);
        }
      } else {
        winners.push_back(std::move(payload));
      }
    }
    payloads = std::move(winners);  // count again: the losers still need what they share
  }
}

}  // namespace mcc::gltf
