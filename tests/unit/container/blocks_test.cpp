// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The header of a payload with blocks: every field comes back, from the whole payload or from its
// first bytes, and tables that no writer makes are refused.                        [A.11.1]
// [A.11.4]
#include <gtest/gtest.h>

#include <algorithm>
#include <climits>
#include <functional>
#include <vector>

#include "base/enc_bytes.h"
#include "container/enc_payload.h"
#include "container/payload_header.h"
#include "support/mesh_generators.h"
#include "unit/container/parse_without_memory.h"

namespace mcc::test {
namespace {

using Bytes = std::vector<uint8_t>;

AttributeInfo positionOfBlocks() {
  AttributeInfo a;
  a.bits = 14;
  a.lattice.step = 0.5f;
  return a;
}

AttributeInfo color() {
  AttributeInfo a;
  a.format.semantic = Semantic::kColor;
  a.format.component_count = 4;
  a.format.component_type = ComponentType::kUint8;
  a.format.normalized = true;
  a.coding = AttributeCoding::kInteger;
  return a;
}

struct DraftBlock {
  PieceHeader piece;
  std::vector<uint32_t> part_triangles = {4};
  std::vector<AttributeInfo> attributes = {positionOfBlocks(), color()};
  uint32_t repeated_count = 0;
  std::vector<BlockException> exceptions;
  CodedBox box = {{-1, 0, 5}, {1, 0, 7}};
  Bytes codes = {1, 2, 3};
  Bytes tokens = {4, 5};
  Bytes raw = {6};

  DraftBlock() {
    piece.vertex_count = piece.wedge_count = piece.face_count = 4;
    piece.operation_count = 2;
  }
};

/// A payload under construction.
struct DraftOfBlocks {
  uint32_t flags = payload_flag::kBlocks;
  std::vector<DraftBlock> blocks = std::vector<DraftBlock>(3);

  Bytes write() const {
    PayloadHeader out{Allocator{}};
    std::vector<Streams> streams;
    out.flags = flags;
    uint32_t first_wedge = 0;
    bool ok = true;
    for (const DraftBlock& block : blocks) {
      PieceHeader h = block.piece;
      h.first_part = static_cast<uint32_t>(out.parts.size());
      h.part_count = static_cast<uint32_t>(block.part_triangles.size());
      h.first_attribute = static_cast<uint32_t>(out.attributes.size());
      h.attribute_count = static_cast<uint32_t>(block.attributes.size());
      ok = ok && out.pieces.push_back(h);
      for (const uint32_t count : block.part_triangles) ok = ok && out.parts.push_back({count});
      for (const AttributeInfo& a : block.attributes) ok = ok && out.attributes.push_back(a);
      BlockHeader row;
      row.first_wedge = first_wedge;
      row.repeated_count = block.repeated_count;
      row.first_exception = static_cast<uint32_t>(out.exceptions.size());
      row.exception_count = static_cast<uint32_t>(block.exceptions.size());
      row.box = block.box;
      for (const BlockException& e : block.exceptions) ok = ok && out.exceptions.push_back(e);
      ok = ok && out.blocks.push_back(row);
      streams.push_back({block.codes, block.tokens, block.raw});
      first_wedge += h.wedge_count - block.repeated_count;
    }
    EXPECT_TRUE(ok);
    return writeBlocks(out, streams);
  }
};

DraftOfBlocks anyDraftOfBlocks(uint64_t seed) {
  Random random(seed);
  DraftOfBlocks draft;
  draft.blocks.resize(random.between(2, random.chance(20) ? 60 : 5));
  const uint32_t part_count = random.between(1, 3);
  const uint32_t limit = random.chance(50) ? 40 : 4000000;
  uint32_t first_wedge = 0;
  for (DraftBlock& block : draft.blocks) {
    PieceHeader& h = block.piece;
    const auto sometimes = [&](uint32_t flag) { return random.chance(40) ? flag : 0; };
    h.flags = sometimes(piece_flag::kHoles) | sometimes(piece_flag::kHandles) |
              sometimes(piece_flag::kSeams) | sometimes(piece_flag::kIsolated) |
              sometimes(piece_flag::kListed) | (part_count > 1 ? piece_flag::kManyParts : 0);
    if (h.has(piece_flag::kSeams)) h.flags |= sometimes(piece_flag::kCreases);
    h.setSurface(static_cast<SurfaceCoding>(random.below(3)));
    h.face_count = random.between(1, limit);
    h.vertex_count = random.between(1, 3 * h.face_count);
    h.operation_count = random.below(h.vertex_count + 1);
    const uint32_t surface_count = random.below(3 * h.face_count);
    h.isolated_count = h.has(piece_flag::kIsolated) ? random.between(1, 9) : 0;
    h.dummy_count = h.has(piece_flag::kHoles) ? random.between(1, 3) : 0;
    h.listed_count = h.has(piece_flag::kListed) ? random.between(1, 9) : 0;
    h.wedge_count = surface_count + h.isolated_count;
    uint32_t rest = static_cast<uint32_t>(h.triangleCount());
    block.part_triangles.clear();
    while (block.part_triangles.size() + 1 < part_count) {
      block.part_triangles.push_back(random.below(rest + 1));
      rest -= block.part_triangles.back();
    }
    block.part_triangles.push_back(rest);
    for (uint32_t s = 0; s < 3; ++s) {
      constexpr int32_t kEdges[] = {INT32_MIN, INT32_MAX, 0, -1};
      const auto any = [&] {
        return random.chance(20) ? kEdges[random.below(4)] : static_cast<int32_t>(random.next());
      };
      const int32_t a = any();
      const int32_t b = any();
      block.box.low[s] = std::min(a, b);
      block.box.high[s] = std::max(a, b);
    }
    for (Bytes* stream : {&block.codes, &block.tokens, &block.raw}) {
      stream->resize(random.chance(30) ? 0 : random.below(300));
      for (uint8_t& byte : *stream) byte = static_cast<uint8_t>(random.below(256));
    }
    if (&block != draft.blocks.data()) {
      block.repeated_count = random.below(surface_count + 1);
      uint32_t wedge = random.below(20);
      for (; wedge < surface_count && random.chance(80); wedge += random.between(1, 200)) {
        const bool names_one = first_wedge != 0 && random.chance(70);
        block.exceptions.push_back({wedge, names_one ? random.below(first_wedge) : kNone});
      }
    }
    first_wedge += h.wedge_count - block.repeated_count;
  }
  return draft;
}

bool sameSpans(std::span<const uint8_t> a, std::span<const uint8_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

void expectRows(const PayloadHeader& parsed, const DraftOfBlocks& draft, uint64_t seed) {
  ASSERT_TRUE(parsed.hasBlocks());
  ASSERT_EQ(parsed.blocks.size(), draft.blocks.size());
  ASSERT_EQ(parsed.pieces.size(), draft.blocks.size());
  EXPECT_EQ(parsed.attributes.size(), 2u);  // once for all
  uint32_t first_wedge = 0;
  size_t offset_bytes = parsed.header_bytes;
  for (size_t i = 0; i < draft.blocks.size(); ++i) {
    const DraftBlock& written = draft.blocks[i];
    const BlockHeader& row = parsed.blocks[i];
    const PieceHeader& h = parsed.pieces[i];
    EXPECT_EQ(row.first_wedge, first_wedge) << seed;
    EXPECT_EQ(row.repeated_count, written.repeated_count) << seed;
    EXPECT_EQ(row.offset_bytes, offset_bytes) << seed;
    EXPECT_EQ(row.codes_bytes, written.codes.size());
    EXPECT_EQ(row.tokens_bytes, written.tokens.size());
    EXPECT_EQ(row.raw_bytes, written.raw.size());
    EXPECT_EQ(row.checksum, checksumOf({written.codes, written.tokens, written.raw}));
    EXPECT_EQ(row.box, written.box) << seed;
    const std::span<const BlockException> exceptions = parsed.exceptionsOf(row);
    ASSERT_EQ(exceptions.size(), written.exceptions.size());
    for (size_t e = 0; e < exceptions.size(); ++e) {
      EXPECT_EQ(exceptions[e].wedge, written.exceptions[e].wedge);
      EXPECT_EQ(exceptions[e].number, written.exceptions[e].number);
    }
    EXPECT_EQ(h.wedge_count, written.piece.wedge_count);
    EXPECT_EQ(h.flags & ~piece_flag::kSameAttributes, written.piece.flags);
    ASSERT_EQ(parsed.attributesOf(h).size(), 2u);
    EXPECT_EQ(parsed.attributesOf(h)[1].format, color().format);
    ASSERT_EQ(h.part_count, written.part_triangles.size());
    for (uint32_t p = 0; p < h.part_count; ++p)
      EXPECT_EQ(parsed.parts[h.first_part + p].triangle_count, written.part_triangles[p]);
    first_wedge += h.wedge_count - row.repeated_count;
    offset_bytes += row.streamBytes();
  }
}

TEST(BlockHeaders, EveryFieldOfTheTableComesBack) {
  uint32_t padded_count = 0;
  for (uint64_t seed = 0; seed < 500; ++seed) {
    const DraftOfBlocks draft = anyDraftOfBlocks(seed);
    const Bytes payload = draft.write();
    PayloadHeader parsed{Allocator{}};
    const Status status = parsePayload(payload, {}, parsed);
    ASSERT_TRUE(status.ok()) << seed << ": " << status.what;
    expectRows(parsed, draft, seed);
    for (size_t i = 0; i < draft.blocks.size(); ++i) {
      const Streams streams = parsed.streamsOf(parsed.blocks[i]);
      EXPECT_TRUE(sameSpans(streams.codes, draft.blocks[i].codes)) << seed;
      EXPECT_TRUE(sameSpans(streams.tokens, draft.blocks[i].tokens)) << seed;
      EXPECT_TRUE(sameSpans(streams.raw, draft.blocks[i].raw)) << seed;
    }
    EXPECT_LE(elementsOf(parsed), kMaxElementsPerByte * payload.size());
    padded_count += (parsed.flags & payload_flag::kPadded) != 0 ? 1 : 0;
  }
  EXPECT_GT(padded_count, 50u);
  EXPECT_LT(padded_count, 450u);
}

TEST(BlockHeaders, HeaderIsReadFromTheFirstBytes) {
  for (uint64_t seed = 0; seed < 100; ++seed) {
    const DraftOfBlocks draft = anyDraftOfBlocks(seed);
    const Bytes payload = draft.write();
    PayloadHeader whole{Allocator{}};
    ASSERT_TRUE(parsePayload(payload, {}, whole).ok());
    for (const size_t size : {whole.header_bytes, (whole.header_bytes + payload.size()) / 2}) {
      const Bytes prefix(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size));
      PayloadHeader parsed{Allocator{}};
      const Status status = parsePrefix(prefix, payload.size(), {}, parsed);
      ASSERT_TRUE(status.ok()) << seed << ": " << status.what;
      expectRows(parsed, draft, seed);
      EXPECT_EQ(parsed.streams.codes.size(), size - parsed.header_bytes);
      // The length of the payload is part of what is checked.
      const auto errorWith = [&](uint64_t payload_bytes) {
        PayloadHeader other{Allocator{}};
        return parsePrefix(prefix, payload_bytes, {}, other).error;
      };
      EXPECT_EQ(errorWith(payload.size() + 1), Error::kTrailingBytes) << seed;
      if (elementsOf(whole) <= kMaxElementsPerByte * (payload.size() - 1)) {
        EXPECT_EQ(errorWith(payload.size() - 1), Error::kTruncated) << seed;
      }
    }
  }
}

TEST(BlockHeaders, EveryTruncationOfTheHeaderIsAnError) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const Bytes payload = anyDraftOfBlocks(seed).write();
    PayloadHeader whole{Allocator{}};
    ASSERT_TRUE(parsePayload(payload, {}, whole).ok());
    for (size_t size = 0; size < std::min<size_t>(whole.header_bytes, 1500); ++size) {
      const Bytes cut(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size));
      PayloadHeader parsed{Allocator{}};
      const Error error = parsePrefix(cut, payload.size(), {}, parsed).error;
      const Error expected = size == 0 ? Error::kBadMagic : Error::kTruncated;
      EXPECT_EQ(error, expected) << "seed " << seed << ", size " << size;
    }
  }
}

TEST(BlockHeaders, APrefixOfAPayloadWithoutThemIsTruncated) {
  PayloadHeader out{Allocator{}};
  DraftBlock whole;
  whole.piece.attribute_count = 1;
  ASSERT_TRUE(out.pieces.push_back(whole.piece) && out.parts.push_back({4}) &&
              out.attributes.push_back(positionOfBlocks()));
  const Bytes payload = writePayload(out, {whole.codes, whole.tokens, whole.raw});
  PayloadHeader parsed{Allocator{}};
  EXPECT_TRUE(parsePrefix(payload, payload.size(), {}, parsed).ok());
  PayloadHeader prefix{Allocator{}};
  EXPECT_EQ(parsePrefix(payload, payload.size() + 1, {}, prefix).error, Error::kTruncated);
}

/// The header's checksum covers the header; the streams have those of the table.
TEST(BlockHeaders, ChecksumCoversTheHeader) {
  const Bytes payload = anyDraftOfBlocks(3).write();
  PayloadHeader whole{Allocator{}};
  ASSERT_TRUE(parsePayload(payload, {}, whole).ok());
  for (size_t bit = 16; bit < 8 * payload.size(); ++bit) {
    Bytes damaged = payload;
    damaged[bit / 8] = static_cast<uint8_t>(damaged[bit / 8] ^ 1u << bit % 8);
    PayloadHeader parsed{Allocator{}};
    const Status status = parsePayload(damaged, {}, parsed);
    if (bit / 8 >= whole.header_bytes) {
      ASSERT_TRUE(status.ok()) << bit;
      EXPECT_TRUE(std::any_of(parsed.blocks.data(), parsed.blocks.data() + parsed.blocks.size(),
                              [&](const BlockHeader& row) {
                                return checksumOf(parsed.streamsOf(row)) != row.checksum;
                              }))
          << bit;
    } else if (bit / 8 <= kChecksummedFrom + 2) {  // the flag, and the length of the header
      EXPECT_FALSE(status.ok()) << bit;
    } else {
      EXPECT_EQ(status.error, Error::kBadChecksum) << bit;
    }
  }
}

Error blocksError(const Bytes& payload, const Limits& limits = {}) {
  PayloadHeader parsed{Allocator{}};
  const Status status = parsePayload(payload, limits, parsed);
  EXPECT_EQ(status.ok(), status.what[0] == '\0');
  return status.error;
}

Error errorAfter(const std::function<void(DraftOfBlocks&)>& change, const Limits& limits = {}) {
  DraftOfBlocks draft;
  change(draft);
  return blocksError(draft.write(), limits);
}

TEST(BlockHeaders, HaveWhatBlocksMayHave) {
  EXPECT_EQ(errorAfter([](DraftOfBlocks&) {}), Error::kOk);
  const auto expectBad = [](const char* what, const std::function<void(DraftOfBlocks&)>& change) {
    EXPECT_EQ(errorAfter(change), Error::kBadHeader) << what;
  };
  expectBad("one block", [](DraftOfBlocks& d) { d.blocks.resize(1); });
  expectBad("a single coder", [](DraftOfBlocks& d) { d.flags |= payload_flag::kSingleCoder; });
  expectBad("trained models", [](DraftOfBlocks& d) { d.flags |= payload_flag::kTrained; });
  expectBad("other attributes", [](DraftOfBlocks& d) { d.blocks[2].attributes[0].bits = 15; });
  expectBad("no attributes", [](DraftOfBlocks& d) {
    for (DraftBlock& block : d.blocks) block.attributes.clear();
  });
  expectBad("another number of parts", [](DraftOfBlocks& d) {
    d.blocks[1].piece.flags |= piece_flag::kManyParts;
    d.blocks[1].part_triangles = {2, 2};
  });
  for (size_t i = 0; i < 3; ++i) {
    expectBad("no faces", [i](DraftOfBlocks& d) {
      PieceHeader& h = d.blocks[i].piece;
      h.face_count = h.vertex_count = h.wedge_count = h.operation_count = 0;
      d.blocks[i].part_triangles = {0};
    });
    expectBad("pivots", [i](DraftOfBlocks& d) {
      d.blocks[i].piece.setSurface(SurfaceCoding::kPivots);
      d.blocks[i].piece.operation_count = 0;
    });
    for (const uint32_t flag : {piece_flag::kTriangleOrder, piece_flag::kVertexOrder})
      expectBad("an order", [i, flag](DraftOfBlocks& d) { d.blocks[i].piece.flags |= flag; });
  }
}

TEST(BlockHeaders, RepeatOnlyWedgesOfTheirSurface) {
  const auto withIsolated = [](DraftOfBlocks& d) {
    PieceHeader& h = d.blocks[2].piece;
    h.flags |= piece_flag::kIsolated;
    h.isolated_count = 3;
    h.wedge_count = 7;
  };
  for (const uint32_t count : {4u, 5u}) {
    EXPECT_EQ(errorAfter([&](DraftOfBlocks& d) {
                withIsolated(d);
                d.blocks[2].repeated_count = count;
              }),
              count == 4 ? Error::kOk : Error::kBadHeader);
    const uint32_t wedge = count - 1;
    EXPECT_EQ(errorAfter([&](DraftOfBlocks& d) {
                withIsolated(d);
                d.blocks[2].exceptions = {{0, kNone}, {wedge, 7}};
              }),
              wedge == 3 ? Error::kOk : Error::kBadHeader);
  }
}

/// The number is stated as a distance to the first wedge of the block.
TEST(BlockHeaders, ExceptionsNameEarlierWedges) {
  const auto withNumber = [](uint32_t number) {
    return errorAfter([=](DraftOfBlocks& d) { d.blocks[2].exceptions = {{1, number}}; });
  };
  EXPECT_EQ(withNumber(0), Error::kOk);
  EXPECT_EQ(withNumber(7), Error::kOk);
  EXPECT_EQ(withNumber(8), Error::kOk);  // the distance 0: it is new
  EXPECT_EQ(withNumber(9), Error::kBadHeader);
  EXPECT_EQ(withNumber(0x80000000), Error::kBadHeader);
  // More than there can be.
  EXPECT_EQ(errorAfter([](DraftOfBlocks& d) {
              for (uint32_t i = 0; i < 5; ++i) d.blocks[2].exceptions.push_back({i, kNone});
            }),
            Error::kBadHeader);
}

TEST(BlockHeaders, BoxesHaveIntegersOf32Bits) {
  const auto withBox = [](int32_t low, int32_t high) {
    return errorAfter([=](DraftOfBlocks& d) {
      d.blocks[1].box.low[1] = low;
      d.blocks[1].box.high[1] = high;
    });
  };
  EXPECT_EQ(withBox(INT32_MIN, INT32_MAX), Error::kOk);
  EXPECT_EQ(withBox(INT32_MAX, INT32_MAX), Error::kOk);
  EXPECT_EQ(withBox(INT32_MAX, INT32_MIN), Error::kBadHeader);  // wraps
  EXPECT_EQ(withBox(5, 4), Error::kBadHeader);
}

/// Replaces the length of the header, which has one byte.
Bytes withHeaderLength(Bytes payload, uint32_t value) {
  ByteWriter length;
  length.writeVarint(value);
  const auto at = payload.begin() + kChecksummedFrom + 1;
  payload.insert(payload.erase(at), length.bytes().begin(), length.bytes().end());
  const uint32_t checksum = checksumOf(payload);
  for (size_t i = 0; i < 4; ++i)
    payload[kChecksumOffset + i] = static_cast<uint8_t>(checksum >> (8 * i));
  return payload;
}

TEST(BlockHeaders, HeaderHasTheLengthThatItClaims) {
  DraftOfBlocks draft;
  for (DraftBlock& block : draft.blocks) block.raw.resize(40);  // no padding
  const Bytes payload = draft.write();
  PayloadHeader whole{Allocator{}};
  ASSERT_TRUE(parsePayload(payload, {}, whole).ok());
  const auto header_bytes = static_cast<uint32_t>(whole.header_bytes);
  ASSERT_LT(header_bytes, 0x80u);
  ASSERT_EQ(payload[kChecksummedFrom + 1], header_bytes);
  EXPECT_EQ(blocksError(withHeaderLength(payload, header_bytes)), Error::kOk);
  for (const uint32_t length : {0u, 1u, 6u, 7u, 8u, header_bytes - 1, header_bytes + 1}) {
    EXPECT_NE(blocksError(withHeaderLength(payload, length)), Error::kOk) << length;
  }
  EXPECT_EQ(blocksError(withHeaderLength(payload, header_bytes - 1)), Error::kBadHeader);
  const auto size = static_cast<uint32_t>(payload.size());
  EXPECT_NE(blocksError(withHeaderLength(payload, size)), Error::kOk);
  EXPECT_EQ(blocksError(withHeaderLength(payload, size + 2)), Error::kTruncated);
  EXPECT_EQ(blocksError(withHeaderLength(payload, ~0u)), Error::kTruncated);
}

TEST(BlockHeaders, StreamsFillThePayload) {
  Bytes payload = DraftOfBlocks().write();
  payload.push_back(0);
  EXPECT_EQ(blocksError(payload), Error::kTrailingBytes);
  DraftOfBlocks draft;
  for (DraftBlock& block : draft.blocks) block.raw.resize(100);  // so that elements are no matter
  payload = draft.write();
  payload.pop_back();
  EXPECT_EQ(blocksError(payload), Error::kTruncated);
}

/// Limits of the caller hold for the sum of all blocks, but attributes count once.
TEST(BlockHeaders, LimitsOfTheCaller) {
  const auto same = [](DraftOfBlocks&) {};
  Limits limits;
  limits.max_attributes = 2;
  limits.max_pieces = 3;
  limits.max_vertices = limits.max_triangles = 12;
  EXPECT_EQ(errorAfter(same, limits), Error::kOk);
  limits.max_attributes = 1;
  EXPECT_EQ(errorAfter(same, limits), Error::kLimit);
  limits.max_attributes = 2;
  limits.max_pieces = 2;
  EXPECT_EQ(errorAfter(same, limits), Error::kLimit);
  limits.max_pieces = 3;
  limits.max_vertices = 11;
  EXPECT_EQ(errorAfter(same, limits), Error::kLimit);
  limits.max_vertices = 12;
  limits.max_triangles = 11;
  EXPECT_EQ(errorAfter(same, limits), Error::kLimit);
}

/// The glued piece has fewer than 2^28 vertices, triangles and wedges.
TEST(BlockHeaders, LimitsOfTheGluedPiece) {
  Limits limits;
  limits.max_vertices = limits.max_triangles = ~uint64_t{0};
  const auto with = [&](uint32_t faces, uint32_t vertices, uint32_t wedges, uint32_t repeated) {
    return errorAfter(
        [=](DraftOfBlocks& d) {
          d.blocks.resize(2);
          for (DraftBlock& block : d.blocks) {
            block.piece.face_count = faces;
            block.piece.vertex_count = vertices;
            block.piece.operation_count = vertices;
            block.piece.wedge_count = wedges;
            block.part_triangles = {faces};
            block.attributes.resize(1);
          }
          d.blocks[1].repeated_count = repeated;
        },
        limits);
  };
  constexpr uint32_t kHalf = 1u << 27;
  EXPECT_EQ(with(kHalf, 4, 4, 0), Error::kLimit);
  EXPECT_EQ(with(kHalf - 1, kHalf, 4, 0), Error::kLimit);
  EXPECT_EQ(with(kHalf - 1, 4, kHalf, 0), Error::kLimit);
  EXPECT_EQ(with(kHalf - 1, 4, kHalf, 1), Error::kOk);  // repeated wedges do not count
}

/// A block costs the copy of all models.
TEST(BlockHeaders, Elements) {
  const auto elements = [](uint32_t count) {
    DraftOfBlocks draft;
    draft.blocks.resize(count);
    PayloadHeader parsed{Allocator{}};
    EXPECT_TRUE(parsePayload(draft.write(), {}, parsed).ok());
    return elementsOf(parsed);
  };
  // Operations, vertices, wedges, triangles, those of two attributes, components, tables, a copy.
  const uint64_t block = 2 + 4 + 4 + 4 + 2 * 4 + 4 * (3 + 4) + 2 * 1024 + 16384;
  EXPECT_EQ(elements(2), 2 * block);
  EXPECT_EQ(elements(70), 70 * block);
  // 18 bytes for each block, or there are too many elements.
  const Bytes payload = [] {
    DraftOfBlocks draft;
    draft.blocks.resize(300);
    return draft.write();
  }();
  PayloadHeader parsed{Allocator{}};
  ASSERT_TRUE(parsePayload(payload, {}, parsed).ok());
  EXPECT_GE(payload.size() * 1024, 300 * block);
}

TEST(BlockHeaders, OutOfMemory) {
  const Bytes payload = anyDraftOfBlocks(8).write();
  expectParsesOrRunsOutOfMemory(payload);
}

}  // namespace
}  // namespace mcc::test
