// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/savings.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <unordered_map>

#include "gltf/document/layout.h"
#include "host/parallel.h"
#include "host/text.h"

namespace mcc::gltf {
namespace {

constexpr uint64_t kViewJsonBytes = 48;      // {"buffer":0,"byteOffset":…,"byteLength":…}
constexpr uint64_t kSmallPieceBytes = 2048;  // larger pieces always save bytes
constexpr uint64_t kSharedBytes = 24;        // bytes of a payload that its pieces share

/// Returns the bytes of JSON that a piece adds to the file.
uint64_t jsonCostOf(const PiecePlan& piece, size_t number) {
  uint64_t cost = 0;
  for (size_t part = 0; part < piece.parts.size(); ++part) {
    const size_t bytes = extensionJson(0, number, piece, part).dump().size();
    cost += (bytes + sizeof("\"extensions\":{}")) * piece.parts[part].users.size();
  }
  return cost;
}

/// Returns the bytes that a payload adds to the file.
uint64_t costOf(const EncodedPayload& payload) {
  uint64_t cost = ((payload.result.payload.size() + 3) & ~uint64_t{3}) + kViewJsonBytes;
  for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
    cost += jsonCostOf(payload.plan.pieces[i], i);
  }
  return cost;
}

/// Counts source bytes by who needs them. A byte is freed when only owners need it, and no more of
/// them than kMostOwners, so that the lists of owners are no longer than that. Each of these owners
/// frees it only as long as the others stay.
class ByteOwners {
 public:
  static constexpr size_t kSomebodyElse = ~size_t{0};
  static constexpr size_t kMostOwners = 64;

  ByteOwners(OwnedRanges ranges, size_t owner_count)
      : freed_(owner_count, 0), segments_of_(owner_count) {
    ranges.visit([&](uint64_t bytes, const OwnedRanges::Owners& owners) {
      if (owners.size() <= kMostOwners && !owners.contains(kSomebodyElse))
        addSegment(bytes, owners);
    });
  }

  const std::vector<uint64_t>& freed() const { return freed_; }
  /// Returns the bytes that the owners which have not left free together.
  uint64_t total() const { return total_; }

  /// Records that an owner needs its bytes again. Adds the owners that free less because of this to
  /// `losers`.
  void leave(size_t owner, std::vector<size_t>& losers) {
    for (const size_t number : segments_of_[owner]) {
      Segment& segment = segments_[number];
      if (segment.bytes == 0) continue;
      for (const size_t other : segment.owners) {
        freed_[other] -= segment.bytes;
        if (other != owner) losers.push_back(other);
      }
      total_ -= segment.bytes;
      segment.bytes = 0;
    }
  }

 private:
  /// A run of bytes with the same owners. `bytes` is 0 when one of them has left.
  struct Segment {
    uint64_t bytes;
    std::vector<size_t> owners;
  };

  void addSegment(uint64_t bytes, const OwnedRanges::Owners& owners) {
    Segment segment = {bytes, {}};
    for (const auto& [owner, ignored] : owners) {
      segment.owners.push_back(owner);
      segments_of_[owner].push_back(segments_.size());
      freed_[owner] += bytes;
    }
    total_ += bytes;
    segments_.push_back(std::move(segment));
  }

  std::vector<Segment> segments_;
  std::vector<uint64_t> freed_;
  std::vector<std::vector<size_t>> segments_of_;  ///< by owner
  uint64_t total_ = 0;
};

struct OwnedPiece {
  const PiecePlan* piece;
  size_t owner;
};

/// Finds the owners of the bytes that pieces free.
ByteOwners ownersOf(const Document& document, const std::vector<bool>& in_other_use,
                    const std::vector<OwnedPiece>& pieces, size_t owner_count) {
  std::vector<bool> is_ours(document.accessors.size(), false);
  OwnedRanges ranges;
  const auto add = [&](uint32_t accessor, size_t owner) {
    for (const ByteRange& range :
         accessorRanges(document, accessor, document.foreign.keep_numbers)) {
      ranges.add(range, owner);
    }
  };
  for (const auto& [piece, owner] : pieces) {
    std::vector<uint32_t> accessors;
    for (const AttributePlan& attribute : piece->attributes)
      accessors.push_back(attribute.accessor);
    for (const PartPlan& part : piece->parts) accessors.push_back(part.indices_accessor);
    for (const uint32_t accessor : accessors) {
      if (accessor == kNone || in_other_use[accessor]) continue;
      is_ours[accessor] = true;
      add(accessor, owner);
    }
  }
  for (uint32_t accessor = 0; accessor < is_ours.size(); ++accessor) {
    if (!is_ours[accessor]) add(accessor, ByteOwners::kSomebodyElse);
  }
  for (const Json& image : arrayOf(document.json, "images")) {
    const uint32_t view = indexOf(findMember(image, "bufferView"), document.views.size());
    if (view != kNone) ranges.add(viewRange(document, view), ByteOwners::kSomebodyElse);
  }
  return {std::move(ranges), owner_count};
}

const AccessorData& positionsOf(const PiecePlan& piece) {
  return (piece.attributes.empty() ? piece.ordinary : piece.attributes)[0].source;
}

std::string_view textOf(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Finds the pieces among those asked for that have a position in common with another piece of
/// their mesh, and marks both. Such a piece cannot stay uncompressed alone, because the surfaces
/// would come apart.
std::vector<bool> touchingPieces(const PayloadPlan& plan, const std::vector<bool>& is_asked) {
  std::vector<bool> touches(plan.pieces.size(), false);
  if (std::find(is_asked.begin(), is_asked.end(), true) == is_asked.end()) return touches;
  // Mesh, position -> a piece that was asked for.
  std::unordered_map<uint32_t, std::unordered_map<std::string_view, size_t>> owners;
  // Pieces that share a position are marked when the second of them is visited.
  for (const bool are_asked : {true, false}) {
    for (size_t k = 0; k < plan.pieces.size(); ++k) {
      if (is_asked[k] != are_asked) continue;
      auto& owner_of = owners[plan.pieces[k].mesh()];
      const AccessorData& positions = positionsOf(plan.pieces[k]);
      for (uint64_t i = 0; i < positions.count; ++i) {
        const std::string_view position = textOf(positions.element(i));
        const auto owner =
            are_asked ? owner_of.try_emplace(position, k).first : owner_of.find(position);
        if (owner == owner_of.end() || owner->second == k) continue;
        touches[owner->second] = true;
        touches[k] = true;
      }
    }
  }
  return touches;
}

/// Leaves a piece alone. `cost_bytes` is the size of payload and JSON.
void leaveAlone(const PiecePlan& piece, uint64_t cost_bytes, uint64_t freed_bytes,
                std::vector<LeftAlone>& left_alone) {
  leaveAlone(piece,
             "would not become smaller (payload and JSON " + std::to_string(cost_bytes) +
                 " bytes, buffers " + std::to_string(freed_bytes) + " bytes); left as it was",
             true, left_alone);
}

/// Finds the payloads that cost at least as many bytes as they free. The payloads of one mesh that
/// was divided stay or go together, because their positions may meet.
class LoserSearch {
 public:
  LoserSearch(const Document& document, const std::vector<EncodedPayload>& payloads)
      : payloads_(payloads), is_lost_(payloads.size(), false), owners_(group(document)) {}

  /// Returns for each payload whether it loses.
  std::vector<bool> run(std::vector<LeftAlone>& left_alone) {
    std::vector<size_t> asked(groups_.size());
    std::iota(asked.begin(), asked.end(), size_t{0});
    // Bytes that losers need again may turn others into losers.
    while (!asked.empty()) {
      std::vector<size_t> losers;
      for (const size_t number : asked) {
        if (groups_[number].is_lost || groups_[number].cost < owners_.freed()[number]) continue;
        leaveGroupAlone(number, left_alone);
        losers.push_back(number);
      }
      asked.clear();
      for (const size_t number : losers) owners_.leave(number, asked);
    }
    uint64_t total_cost = 0;
    for (const Group& group : groups_) total_cost += group.is_lost ? 0 : group.cost;
    // Payloads that share accessors may each gain by the same bytes, and still lose together.
    const bool all_lose = total_cost >= owners_.total();
    for (size_t number = 0; all_lose && number < groups_.size(); ++number) {
      if (!groups_[number].is_lost) leaveGroupAlone(number, left_alone);
    }
    return std::move(is_lost_);
  }

 private:
  /// The payloads of a mesh.
  struct Group {
    std::vector<size_t> payloads;
    uint64_t cost = 0;
    bool is_lost = false;
  };

  ByteOwners group(const Document& document) {
    std::vector<OwnedPiece> pieces;
    for (size_t i = 0; i < payloads_.size(); ++i) {
      const PayloadPlan& plan = payloads_[i].plan;
      if (i == 0 || payloads_[i - 1].plan.mesh != plan.mesh) groups_.emplace_back();
      groups_.back().payloads.push_back(i);
      groups_.back().cost += costOf(payloads_[i]);
      for (const PiecePlan& piece : plan.pieces) pieces.push_back({&piece, groups_.size() - 1});
    }
    return ownersOf(document, accessorsInOtherUse(document, plansOf(payloads_)), pieces,
                    groups_.size());
  }

  void leaveGroupAlone(size_t number, std::vector<LeftAlone>& left_alone) {
    groups_[number].is_lost = true;
    for (const size_t i : groups_[number].payloads) {
      is_lost_[i] = true;
      for (const PiecePlan& piece : payloads_[i].plan.pieces) {
        leaveAlone(piece, groups_[number].cost, owners_.freed()[number], left_alone);
      }
    }
  }

  const std::vector<EncodedPayload>& payloads_;
  std::vector<Group> groups_;
  std::vector<bool> is_lost_;  ///< of each payload
  ByteOwners owners_;
};

}  // namespace

std::vector<bool> accessorsInOtherUse(const Document& document,
                                      const std::vector<const PayloadPlan*>& payloads) {
  std::vector<bool> is_used = accessorsOutsidePayloads(document, payloads);
  for (const PayloadPlan* payload : payloads) {
    for (const PiecePlan& piece : payload->pieces) {
      for (const AttributePlan& attribute : piece.ordinary) is_used[attribute.accessor] = true;
    }
  }
  return is_used;
}

std::vector<bool> accessorsOutsidePayloads(const Document& document,
                                           const std::vector<const PayloadPlan*>& payloads) {
  std::vector<uint64_t> uses_in_payloads(document.accessors.size(), 0);
  for (const PayloadPlan* payload : payloads) {
    for (const PiecePlan& piece : payload->pieces) {
      uint64_t users = 0;
      for (const PartPlan& part : piece.parts) {
        users += part.users.size();
        if (part.indices_accessor == kNone) continue;
        uses_in_payloads[part.indices_accessor] += part.users.size();
      }
      for (const auto* attributes : {&piece.attributes, &piece.ordinary}) {
        for (const AttributePlan& attribute : *attributes) {
          uses_in_payloads[attribute.accessor] += users;
        }
      }
    }
  }
  std::vector<bool> is_used;
  for (size_t i = 0; i < uses_in_payloads.size(); ++i) {
    const Accessor& accessor = document.accessors[i];
    is_used.push_back(accessor.isUsedOutsideMeshes() || accessor.extension_uses != 0 ||
                      accessor.primitive_uses > uses_in_payloads[i]);
  }
  return is_used;
}

void countFreedBytes(const Document& document, std::vector<EncodedPayload>& payloads) {
  std::vector<OwnedPiece> pieces;
  for (size_t i = 0; i < payloads.size(); ++i) {
    for (const PiecePlan& piece : payloads[i].plan.pieces) pieces.push_back({&piece, i});
  }
  const ByteOwners owners =
      ownersOf(document, accessorsInOtherUse(document, plansOf(payloads)), pieces, payloads.size());
  for (size_t i = 0; i < payloads.size(); ++i) payloads[i].freed_bytes = owners.freed()[i];
}

Result dropTinyPieces(const Document& document, const ConvertOptions& options,
                      std::vector<PayloadPlan>& plans, std::vector<LeftAlone>& left_alone) {
  std::vector<OwnedPiece> pieces;
  std::vector<const PayloadPlan*> plan_of;
  for (const PayloadPlan& plan : plans) {
    for (const PiecePlan& piece : plan.pieces) pieces.push_back({&piece, pieces.size()});
    plan_of.resize(pieces.size(), &plan);
  }
  const ByteOwners owners =
      ownersOf(document, accessorsInOtherUse(document, plansOf(plans)), pieces, pieces.size());
  const std::vector<uint64_t>& freed = owners.freed();
  std::vector<uint64_t> bytes_alone(pieces.size(), 0);
  MCC_GLTF_TRY(runParallel(pieces.size(), options.thread_count, [&](size_t i) -> Result {
    const bool is_small = plan_of[i]->pieces.size() > 1 && freed[i] < kSmallPieceBytes;
    if (is_small) bytes_alone[i] = bytesAlone(options, *plan_of[i], *pieces[i].piece);
    return {};
  }));
  size_t next = 0;
  for (PayloadPlan& plan : plans) {
    std::vector<bool> is_tiny;
    std::vector<uint64_t> costs;
    const size_t first = next;
    for (const PiecePlan& piece : plan.pieces) {
      const uint64_t bytes = bytes_alone[next];
      costs.push_back(bytes == 0 ? 0
                                 : jsonCostOf(piece, 1) + bytes - std::min(bytes, kSharedBytes));
      is_tiny.push_back(bytes != 0 && costs.back() >= freed[next]);
      ++next;
    }
    const std::vector<bool> touches = touchingPieces(plan, is_tiny);
    std::vector<PiecePlan> kept;
    for (size_t i = 0; i < plan.pieces.size(); ++i) {
      if (is_tiny[i] && !touches[i]) {
        leaveAlone(plan.pieces[i], costs[i], freed[first + i], left_alone);
      } else {
        kept.push_back(std::move(plan.pieces[i]));
      }
    }
    plan.pieces = std::move(kept);
  }
  std::erase_if(plans, [](const PayloadPlan& plan) { return plan.pieces.empty(); });
  return {};
}

void dropLosers(const Document& document, std::vector<EncodedPayload>& payloads,
                std::vector<LeftAlone>& left_alone) {
  const std::vector<bool> is_lost = LoserSearch(document, payloads).run(left_alone);
  std::vector<EncodedPayload> winners;
  for (size_t i = 0; i < payloads.size(); ++i) {
    if (!is_lost[i]) winners.push_back(std::move(payloads[i]));
  }
  payloads = std::move(winners);
  countFreedBytes(document, payloads);
}

}  // namespace mcc::gltf
