// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Never larger: which payloads pay for themselves.
#include <algorithm>
#include <map>
#include <tuple>

#include "gltf/compress.h"
#include "gltf/rebuild.h"

namespace mcc::gltf {
namespace {

constexpr uint64_t kViewJsonBytes = 48;  // {"buffer":0,"byteOffset":…,"byteLength":…}

/// Bytes a payload adds to the file.
uint64_t costOf(const EncodedPayload& payload) {
  uint64_t cost = ((payload.result.payload.size() + 3) & ~uint64_t{3}) + kViewJsonBytes;
  for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
    const PiecePlan& piece = payload.plan.pieces[i];
    for (size_t part = 0; part < piece.parts.size(); ++part) {
      const size_t bytes = extensionJson(0, i, piece, part).dump().size();
      cost += (bytes + sizeof("\"extensions\":{}")) * piece.parts[part].users.size();
    }
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
void visitAccessors(const EncodedPayload& payload, const Visit& visit) {
  for (const PiecePlan& piece : payload.plan.pieces) {
    for (const AttributePlan& attribute : piece.attributes) visit(attribute.accessor);
    for (const PartPlan& part : piece.parts) {
      if (part.indices_accessor != kNone) visit(part.indices_accessor);
    }
  }
}

void leaveAlone(const EncodedPayload& payload, std::vector<LeftAlone>& left_alone) {
  const std::string note = "would not become smaller (payload " +
                           std::to_string(payload.result.payload.size()) + " bytes, buffers " +
                           std::to_string(payload.freed_bytes) + " bytes); left as it was";
  for (const PiecePlan& piece : payload.plan.pieces) {
    for (const PartPlan& part : piece.parts) {
      for (const PrimitiveRef& user : part.users) left_alone.push_back({user, note});
    }
  }
}

}  // namespace

uint64_t countFreedBytes(const Document& document, const ForeignReferences& foreign,
                         std::vector<EncodedPayload>& payloads) {
  const std::vector<bool> in_other_use = accessorsInOtherUse(document, foreign, payloads);
  std::vector<bool> is_ours(document.accessors.size(), false);
  ByteOwners owners;
  for (size_t i = 0; i < payloads.size(); ++i) {
    visitAccessors(payloads[i], [&](uint32_t accessor) {
      if (in_other_use[accessor]) return;
      is_ours[accessor] = true;
      owners.add(accessorRanges(document, accessor, foreign.keep_numbers), i);
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
  std::vector<uint64_t> freed(payloads.size(), 0);
  const uint64_t total = owners.count(freed);
  for (size_t i = 0; i < payloads.size(); ++i) payloads[i].freed_bytes = freed[i];
  return total;
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
        leaveAlone(payload, left_alone);
      } else {
        winners.push_back(std::move(payload));
      }
    }
    payloads = std::move(winners);  // count again: the losers still need what they share
  }
}

}  // namespace mcc::gltf
