// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "robustness/damage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "container/payload_header.h"
#include "support/counting_allocator.h"

namespace mcc::test {
namespace {

constexpr size_t kMaxTargetBytes = size_t{64} << 20;
/// What the decoder may take in addition to what is proportional to the counts: models, and small
/// arrays.
constexpr uint64_t kFixedBytes = uint64_t{16} << 20;
/// ... and per triangle, vertex and wedge, attributes apart.
constexpr uint64_t kBytesPerElement = 256;

struct PieceMemory {
  std::vector<std::vector<uint8_t>> attributes;
  std::vector<std::vector<uint32_t>> parts;
  std::vector<AttributeTarget> attribute_targets;
  std::vector<PartTarget> part_targets;
};

uint64_t targetBytes(const PayloadInfo& info) {
  uint64_t bytes = 0;
  for (const PieceInfo& piece : info.pieces) {
    for (const AttributeInfo& a : piece.attributes)
      bytes += uint64_t{piece.wedge_count} * elementBytes(a.format);
    for (const PartInfo& part : piece.parts) bytes += uint64_t{part.triangle_count} * 12;
  }
  return bytes;
}

uint64_t elementCount(const PayloadInfo& info) {
  uint64_t count = 0;
  for (const PieceInfo& piece : info.pieces) {
    uint64_t components = 0;
    for (const AttributeInfo& a : piece.attributes) {
      components = std::max<uint64_t>(components, a.format.component_count);
    }
    count += uint64_t{piece.wedge_count} * (1 + components) + piece.vertex_count;
    for (const PartInfo& part : piece.parts) count += part.triangle_count;
  }
  return count;
}

std::string checkShape(const PayloadInfo& info, const std::vector<PieceMemory>& memory) {
  for (size_t p = 0; p < info.pieces.size(); ++p) {
    const PieceInfo& piece = info.pieces[p];
    for (const std::vector<uint32_t>& part : memory[p].parts) {
      for (const uint32_t index : part) {
        if (index >= piece.wedge_count) return "an index is not below wedge_count";
      }
    }
    for (size_t a = 0; a < piece.attributes.size(); ++a) {
      if (piece.attributes[a].coding != AttributeCoding::kOctahedral) continue;
      const size_t stride = elementBytes(piece.attributes[a].format);  // tangents have a sign
      for (size_t w = 0; w < piece.wedge_count; ++w) {
        float n[3];
        std::memcpy(n, &memory[p].attributes[a][stride * w], 12);
        const double square = double{n[0]} * n[0] + double{n[1]} * n[1] + double{n[2]} * n[2];
        if (!(std::fabs(square - 1) < 1e-3)) return "a normal is not of unit length";
      }
    }
  }
  return "";
}

}  // namespace

void repairChecksum(std::vector<uint8_t>& payload) {
  if (payload.size() < kChecksummedFrom) return;
  const uint32_t checksum = checksumOf(payload);
  for (size_t i = 0; i < 4; ++i) {
    payload[kChecksumOffset + i] = static_cast<uint8_t>(checksum >> (8 * i));
  }
}

std::vector<uint8_t> mutated(std::span<const uint8_t> payload, size_t header_bytes,
                             Random& random) {
  std::vector<uint8_t> bytes(payload.begin(), payload.end());
  const auto size = [&bytes] { return static_cast<uint32_t>(bytes.size()); };
  // Damage to the first bytes, magic and checksum, would always be rejected.
  const auto place = [&](bool in_header) {
    const uint32_t end = in_header ? std::min(static_cast<uint32_t>(header_bytes), size()) : size();
    const uint32_t begin = std::min<uint32_t>(kChecksummedFrom, end - 1);
    return begin + random.below(end - begin);
  };
  const auto at = [&bytes](uint32_t i) { return bytes.begin() + i; };
  const uint32_t rounds = random.chance(70) ? 1 : random.between(2, 6);
  for (uint32_t round = 0; round < rounds; ++round) {
    const bool in_header = random.chance(25);
    const uint32_t i = place(in_header);
    const uint32_t length = std::min(random.between(1, random.chance(80) ? 8 : 64), size() - i);
    switch (random.below(8)) {
      case 0:
      case 1: bytes[i] = static_cast<uint8_t>(bytes[i] ^ 1u << random.below(8)); break;
      case 2: bytes[i] = static_cast<uint8_t>(random.below(256)); break;
      case 3: {  // numbers of the header, one more or less, or at an edge
        constexpr uint8_t kEdges[] = {0, 1, 2, 0x3f, 0x7f, 0x80, 0x81, 0xfe, 0xff};
        uint8_t& byte = bytes[place(true)];
        const uint32_t kind = random.below(3);
        byte = kind == 0   ? static_cast<uint8_t>(byte + 1)
               : kind == 1 ? static_cast<uint8_t>(byte - 1)
                           : kEdges[random.below(sizeof kEdges)];
        break;
      }
      case 4: {  // a stretch copied over another
        const uint32_t from = random.below(size() - length + 1);
        const std::vector<uint8_t> stretch(at(from), at(from + length));
        std::copy(stretch.begin(), stretch.end(), at(i));
        break;
      }
      case 5: {  // ... or inserted
        const uint32_t from = random.below(size() - length + 1);
        const std::vector<uint8_t> stretch(at(from), at(from + length));
        bytes.insert(at(i), stretch.begin(), stretch.end());
        break;
      }
      case 6:
        if (size() > kChecksummedFrom + 1 + length) bytes.erase(at(i), at(i + length));
        break;
      default: {
        const uint8_t value = static_cast<uint8_t>(random.chance(50) ? 0 : 0xff);
        std::fill(at(i), at(i + length), value);
      }
    }
  }
  return bytes;
}

Outcome decodeDamaged(std::span<const uint8_t> payload) {
  Outcome outcome;
  const auto ended = [&outcome](const Status& status) {
    outcome.error = status.error;
    if (!status.ok() && status.what[0] == '\0') outcome.failure = "an error without a text";
    if (status.error == Error::kOutOfMemory) outcome.failure = "out of memory";
    if (status.error == Error::kBadArgument) outcome.failure = "takes a good argument for a bad";
  };
  CountingAllocator counting;
  // A copy of exactly its size, so that the sanitizer sees every read beyond it.
  const std::vector<uint8_t> bytes(payload.begin(), payload.end());
  {
    Payload opened;
    Limits limits;
    limits.max_vertices = limits.max_triangles = uint64_t{1} << 18;
    const Status status = opened.open(bytes, limits, counting.allocator());
    ended(status);
    if (counting.peakBytes() > (uint64_t{1} << 16) + 256 * uint64_t{payload.size()})
      outcome.failure = "opening takes too much memory";
    if (status.ok() && targetBytes(opened.info()) <= kMaxTargetBytes) {
      outcome.reached_decode = true;
      outcome.target_bytes = targetBytes(opened.info());
      const PayloadInfo& info = opened.info();
      std::vector<PieceMemory> memory(info.pieces.size());
      std::vector<PieceTarget> targets(info.pieces.size());
      for (size_t p = 0; p < info.pieces.size(); ++p) {
        PieceMemory& m = memory[p];
        for (const AttributeInfo& a : info.pieces[p].attributes) {
          const size_t stride = elementBytes(a.format);
          m.attributes.emplace_back(stride * info.pieces[p].wedge_count);
          m.attribute_targets.push_back({m.attributes.back().data(), stride});
        }
        for (const PartInfo& part : info.pieces[p].parts) {
          m.parts.emplace_back(size_t{part.triangle_count} * 3, kNone);
          m.part_targets.push_back({m.parts.back().data(), IndexType::kUint32});
        }
        targets[p] = {m.attribute_targets, m.part_targets};
      }
      DecodeOptions options;
      options.allocator = counting.allocator();
      options.progress = [](void* user, double) {
        ++*static_cast<uint64_t*>(user);
        return true;
      };
      options.progress_user = &outcome.finished_steps;
      ended(opened.decode(targets, options));
      if (outcome.error == Error::kOk) outcome.failure = checkShape(info, memory);
      if (counting.peakBytes() > kFixedBytes + kBytesPerElement * elementCount(info))
        outcome.failure = "decoding takes " + std::to_string(counting.peakBytes()) + " bytes";
    }
  }
  outcome.peak_bytes = counting.peakBytes();
  if (counting.usedBytes() != 0) outcome.failure = "memory is not given back";
  return outcome;
}

Watchdog::Watchdog() : thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
  done_ = true;
  thread_.join();
}

void Watchdog::watch() {
  constexpr int kTicksPerMinute = 600;
  uint64_t seen = steps_;
  for (int ticks = 0; !done_; ++ticks) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (steps_ != seen) {
      seen = steps_;
      ticks = 0;
    }
    if (ticks < kTicksPerMinute) continue;
    std::fprintf(stderr, "decoding hangs: payload %llu, mutation %llu\n",
                 static_cast<unsigned long long>(payload_.load()),
                 static_cast<unsigned long long>(mutation_.load()));
    std::_Exit(1);
  }
}

}  // namespace mcc::test
