// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Header and streams: every field comes back, and headers that no writer makes are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "container/enc_payload.h"
#include "container/payload_header.h"
#include "exact/grid.h"
#include "format/predictors.h"
#include "format/usual.h"
#include "support/mesh_generators.h"
#include "unit/container/parse_without_memory.h"

namespace mcc::test {
namespace {

void repairChecksum(std::vector<uint8_t>& payload) {
  const uint32_t checksum = checksumOf(payload);
  for (size_t i = 0; i < 4; ++i)
    payload[kChecksumOffset + i] = static_cast<uint8_t>(checksum >> (8 * i));
}

/// Numbers of one to five bytes.
uint32_t anyCount(Random& random, uint32_t limit) {
  return std::min(limit, static_cast<uint32_t>(random.next() >> (36 + random.below(28))));
}

AttributeInfo position() {
  AttributeInfo a;
  a.bits = 14;
  a.lattice.step = 0.5f;
  a.lattice.origin[1] = -3;
  return a;
}

/// A float of any form.
float withZeroBytes(Random& random, float value) {
  return std::bit_cast<float>(std::bit_cast<uint32_t>(value) & ~0u << 8 * random.below(3));
}

AttributeInfo anyAttribute(Random& random) {
  AttributeInfo a;
  a.format.semantic = static_cast<Semantic>(random.below(8));
  a.format.normalized = random.chance(50);
  constexpr uint8_t kCounts[] = {1, 2, 3, 4, 9, 16};
  a.format.component_count = kCounts[random.below(sizeof kCounts)];
  if (random.chance(50)) a.format.set_index = static_cast<uint8_t>(random.below(256));
  if (random.chance(50)) a.format.morph_target = static_cast<uint16_t>(random.below(65536));
  if (random.chance(40)) {
    a.format.component_type = static_cast<ComponentType>(random.below(5));
    a.coding = AttributeCoding::kInteger;
  } else if (random.chance(30)) {
    a.coding = AttributeCoding::kGrid;
    a.format.component_count = static_cast<uint8_t>(random.between(1, kGridComponents));
    a.bits = static_cast<uint8_t>(random.between(1, kGridBits + 1));
    a.grid = static_cast<uint8_t>(random.below(kGridCount));
    if (isBinaryGrid(a.grid)) {
      a.tails = static_cast<uint8_t>(random.below(3));
    }
  } else if (random.chance(30)) {
    a.coding = AttributeCoding::kExactFloat;
  } else if (random.chance(30)) {
    a.coding = AttributeCoding::kOctahedral;
    const bool is_tangent = a.format.semantic == Semantic::kTangent;
    if (is_tangent) a.format.morph_target = 0;
    a.format.component_count = is_tangent ? 4 : 3;
    if (is_tangent) a.predictor = static_cast<uint8_t>(random.below(4));
    a.bits = static_cast<uint8_t>(random.between(2, 16));
  } else {
    a.format.component_count = static_cast<uint8_t>(random.between(1, 4));
    a.bits = static_cast<uint8_t>(random.between(1, 24));
    a.lattice.step = random.chance(20) ? 0.5f : withZeroBytes(random, random.unit() + 0.25f);
    for (uint32_t c = 0; c < a.format.component_count && a.format.morph_target == 0; ++c)
      a.lattice.origin[c] = random.chance(20) ? 0 : withZeroBytes(random, random.unit() - 0.5f);
  }
  return a;
}

/// A payload under construction.
struct Draft {
  struct Piece {
    PieceHeader header;
    std::vector<uint32_t> part_triangles;
    std::vector<AttributeInfo> attributes = {position()};
  };
  uint32_t flags = 0;
  std::vector<Piece> pieces = {Piece{}};
  std::vector<uint8_t> codes = {1, 2, 3};
  std::vector<uint8_t> tokens = {4, 5};
  std::vector<uint8_t> raw = {6};

  std::vector<uint8_t> write() const {
    PayloadHeader out{Allocator{}};
    out.flags = flags;
    for (const Piece& piece : pieces) {
      PieceHeader h = piece.header;
      h.first_part = static_cast<uint32_t>(out.parts.size());
      h.first_attribute = static_cast<uint32_t>(out.attributes.size());
      h.attribute_count = static_cast<uint32_t>(piece.attributes.size());
      h.part_count = static_cast<uint32_t>(piece.part_triangles.size());
      bool ok = out.pieces.push_back(h);
      for (const uint32_t count : piece.part_triangles) ok = ok && out.parts.push_back({count});
      for (const AttributeInfo& a : piece.attributes) ok = ok && out.attributes.push_back(a);
      EXPECT_TRUE(ok);
    }
    return (flags & payload_flag::kSingleCoder) != 0 ? writePayload(out, {codes, {}, {}})
                                                     : writePayload(out, {codes, tokens, raw});
  }
};

/// A small piece whose counts fit together.
Draft simpleDraft() {
  Draft draft;
  PieceHeader& h = draft.pieces[0].header;
  h.vertex_count = 4;
  h.face_count = 4;
  h.operation_count = 2;
  h.wedge_count = 4;
  draft.pieces[0].part_triangles = {4};
  return draft;
}

Draft anyDraft(uint64_t seed) {
  Random random(seed);
  Draft draft;
  if (random.chance(50)) draft.flags |= payload_flag::kSingleCoder;
  draft.pieces.resize(random.chance(50) ? 1 : random.between(2, 5));
  const uint32_t limit = random.chance(50) ? 200 : 20000000;
  for (Draft::Piece& piece : draft.pieces) {
    PieceHeader& h = piece.header;
    const auto sometimes = [&](uint32_t flag) { return random.chance(50) ? flag : 0; };
    for (const uint32_t flag : {piece_flag::kManyParts, piece_flag::kHoles, piece_flag::kHandles,
                                piece_flag::kIsolated, piece_flag::kListed, piece_flag::kSeams}) {
      h.flags |= sometimes(flag);
    }
    if (seed % 16 == 8) h.flags |= piece_flag::kMirrors;
    if (seed % 16 == 4) h.flags |= piece_flag::kAnchors;
    h.setSurface(static_cast<SurfaceCoding>(random.below(4)));
    if (h.hasPivots()) h.flags &= ~(piece_flag::kHoles | piece_flag::kHandles);
    h.face_count = anyCount(random, limit) + 1;
    h.vertex_count = 1 + random.below(std::min(3 * h.face_count, 100000000u));
    if (!h.hasPivots())
      h.operation_count = random.below(std::min(h.vertex_count + 4 * h.face_count, 200000000u) + 1);
    h.wedge_count = random.below(std::min(3 * h.face_count, 100000000u));
    if (h.has(piece_flag::kHoles)) h.dummy_count = 1 + random.below(3 * h.face_count);
    if (h.has(piece_flag::kIsolated)) {
      h.isolated_count = 1 + anyCount(random, limit);
      h.wedge_count += h.isolated_count;
    }
    if (h.has(piece_flag::kListed)) h.listed_count = 1 + anyCount(random, limit);
    uint32_t rest = static_cast<uint32_t>(h.triangleCount());
    piece.part_triangles.clear();
    const uint32_t part_count = h.has(piece_flag::kManyParts) ? random.between(2, 6) : 1;
    while (piece.part_triangles.size() + 1 < part_count) {
      piece.part_triangles.push_back(random.below(rest + 1));
      rest -= piece.part_triangles.back();
    }
    piece.part_triangles.push_back(rest);
    const uint32_t attribute_count = random.below(6);
    for (uint32_t i = 0; i < attribute_count; ++i) piece.attributes.push_back(anyAttribute(random));
    if (&piece != draft.pieces.data() && random.chance(50))
      piece.attributes = (&piece - 1)->attributes;
  }
  for (std::vector<uint8_t>* stream : {&draft.codes, &draft.tokens, &draft.raw}) {
    stream->resize(random.chance(30) ? 0 : random.below(3000));
    for (uint8_t& byte : *stream) byte = static_cast<uint8_t>(random.below(256));
  }
  return draft;
}

/// The lowest minor version that has everything in `draft`.
uint8_t versionOf(const Draft& draft) {
  uint8_t version = 0;
  for (const Draft::Piece& piece : draft.pieces) {
    if (piece.header.hasMates()) version = 1;
    for (const AttributeInfo& a : piece.attributes) {
      const bool is_tangent_point =
          a.format.semantic == Semantic::kTangent && a.coding == AttributeCoding::kOctahedral;
      constexpr uint32_t kOf11 = tangent_method::kRepeats | tangent_method::kFaces;
      if (is_tangent_point && (a.predictor & kOf11) != 0) version = 1;
    }
  }
  return version;
}

Error parseError(std::span<const uint8_t> payload, const Limits& limits = {}) {
  PayloadHeader header{Allocator{}};
  const Status status = parsePayload(payload, limits, header);
  EXPECT_EQ(status.ok(), status.what[0] == '\0');
  return status.error;
}

Error errorAfter(const std::function<void(Draft&)>& change, const Limits& limits = {}) {
  Draft draft = simpleDraft();
  change(draft);
  return parseError(draft.write(), limits);
}

void expectSameAttribute(const AttributeInfo& parsed, const AttributeInfo& written) {
  EXPECT_TRUE(parsed.format == written.format);
  EXPECT_EQ(parsed.coding, written.coding);
  EXPECT_EQ(parsed.predictor, written.predictor);
  EXPECT_EQ(parsed.grid, written.grid);
  EXPECT_EQ(parsed.tails, written.tails);
  EXPECT_EQ(parsed.bits, written.bits);
  EXPECT_TRUE(parsed.lattice == written.lattice);
}

bool sameBytes(std::span<const uint8_t> a, std::span<const uint8_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

TEST(Container, EveryFieldComesBack) {
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    const Draft draft = anyDraft(seed);
    const std::vector<uint8_t> payload = draft.write();
    PayloadHeader parsed{Allocator{}};
    const Status status = parsePayload(payload, {}, parsed);
    ASSERT_TRUE(status.ok()) << seed << ": " << status.what;
    EXPECT_EQ(parsed.version_minor, versionOf(draft));
    EXPECT_EQ(parsed.singleCoder(), (draft.flags & payload_flag::kSingleCoder) != 0);
    ASSERT_EQ(parsed.pieces.size(), draft.pieces.size());
    for (size_t p = 0; p < draft.pieces.size(); ++p) {
      const Draft::Piece& written = draft.pieces[p];
      const PieceHeader& h = parsed.pieces[p];
      EXPECT_EQ(h.flags & ~piece_flag::kSameAttributes, written.header.flags);
      EXPECT_EQ(h.vertex_count, written.header.vertex_count);
      EXPECT_EQ(h.face_count, written.header.face_count);
      EXPECT_EQ(h.operation_count, written.header.operation_count);
      EXPECT_EQ(h.dummy_count, written.header.dummy_count);
      EXPECT_EQ(h.wedge_count, written.header.wedge_count);
      EXPECT_EQ(h.isolated_count, written.header.isolated_count);
      EXPECT_EQ(h.listed_count, written.header.listed_count);
      ASSERT_EQ(h.part_count, written.part_triangles.size());
      for (uint32_t i = 0; i < h.part_count; ++i)
        EXPECT_EQ(parsed.parts[h.first_part + i].triangle_count, written.part_triangles[i]);
      ASSERT_EQ(h.attribute_count, written.attributes.size());
      for (uint32_t i = 0; i < h.attribute_count; ++i)
        expectSameAttribute(parsed.attributes[h.first_attribute + i], written.attributes[i]);
    }
    EXPECT_TRUE(sameBytes(parsed.streams.codes, draft.codes));
    EXPECT_TRUE(parsed.singleCoder() || sameBytes(parsed.streams.tokens, draft.tokens));
    EXPECT_TRUE(parsed.singleCoder() || sameBytes(parsed.streams.raw, draft.raw));
    EXPECT_EQ(parsed.header_bytes + parsed.streams.codes.size() + parsed.streams.tokens.size() +
                  parsed.streams.raw.size(),
              payload.size());
  }
}

TEST(Container, EveryTruncationOfTheHeaderIsAnError) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const std::vector<uint8_t> payload = anyDraft(seed).write();
    PayloadHeader parsed{Allocator{}};
    ASSERT_TRUE(parsePayload(payload, {}, parsed).ok());
    const size_t needed =
        parsed.header_bytes +
        (parsed.singleCoder() ? 0 : parsed.streams.codes.size() + parsed.streams.tokens.size());
    for (size_t size = 0; size < std::min<size_t>(needed, 600); ++size) {
      std::vector<uint8_t> cut(payload.begin(),
                               payload.begin() + static_cast<std::ptrdiff_t>(size));
      if (size >= kChecksummedFrom) repairChecksum(cut);
      const Error error = parseError(cut);
      EXPECT_TRUE(error == (size == 0 ? Error::kBadMagic : Error::kTruncated) ||
                  (size > kChecksummedFrom && error == Error::kLimit))
          << "seed " << seed << ", size " << size << ": " << static_cast<int>(error);
    }
  }
}

TEST(Container, ChecksumCoversEveryBit) {
  const std::vector<uint8_t> payload = anyDraft(7).write();
  for (size_t bit = 0; bit < 8 * std::min<size_t>(payload.size(), 400); ++bit) {
    std::vector<uint8_t> damaged = payload;
    damaged[bit / 8] = static_cast<uint8_t>(damaged[bit / 8] ^ 1u << bit % 8);
    const Error error = parseError(damaged);
    const Error expected = bit < 8                 ? Error::kBadMagic
                           : bit >= 12 && bit < 16 ? Error::kUnsupportedVersion
                                                   : Error::kBadChecksum;
    EXPECT_EQ(error, expected) << "bit " << bit;
  }
}

TEST(Container, Versions) {
  std::vector<uint8_t> payload = simpleDraft().write();
  for (uint32_t version = 0; version < 256; ++version) {
    payload[kVersionOffset] = static_cast<uint8_t>(version);
    repairChecksum(payload);
    PayloadHeader parsed{Allocator{}};
    const Error error = parsePayload(payload, {}, parsed).error;
    EXPECT_EQ(error, version >> 4 == 1 ? Error::kOk : Error::kUnsupportedVersion);
    EXPECT_TRUE(error != Error::kOk || parsed.version_minor == (version & 15));
  }
}

/// Tangents may repeat, or lie in faces, since 1.1: the same header is refused as one of 1.0.
TEST(Container, PredictorsOfLaterVersions) {
  for (const uint32_t predictor : {0u, 1u, 2u, 3u, 0x83u}) {
    Draft draft = simpleDraft();
    AttributeInfo tangent;
    tangent.format.semantic = Semantic::kTangent;
    tangent.format.component_count = 4;
    tangent.coding = AttributeCoding::kOctahedral;
    tangent.bits = 8;
    tangent.predictor = static_cast<uint8_t>(predictor);
    draft.pieces[0].attributes.push_back(tangent);
    std::vector<uint8_t> payload = draft.write();
    const bool is_new = (predictor & 3) != 0;
    EXPECT_EQ(payload[kVersionOffset], is_new ? 0x11 : 0x10) << predictor;
    for (uint32_t minor = 0; minor < 16; ++minor) {
      payload[kVersionOffset] = static_cast<uint8_t>(kVersionMajor << 4 | minor);
      repairChecksum(payload);
      EXPECT_EQ(parseError(payload), is_new && minor == 0 ? Error::kBadHeader : Error::kOk)
          << predictor << ", minor version " << minor;
    }
  }
}

/// The same of normals and texture coordinates that mates may have.
TEST(Container, MatesAreOfALaterVersion) {
  for (const Semantic semantic : {Semantic::kNormal, Semantic::kTexcoord}) {
    Draft draft = simpleDraft();
    AttributeInfo a;
    a.format.semantic = semantic;
    a.format.component_count = semantic == Semantic::kNormal ? 3 : 2;
    a.coding =
        semantic == Semantic::kNormal ? AttributeCoding::kOctahedral : AttributeCoding::kInteger;
    if (a.coding == AttributeCoding::kInteger) a.format.component_type = ComponentType::kUint16;
    a.bits = a.coding == AttributeCoding::kInteger ? 0 : 8;
    a.predictor = kHasMates;
    draft.pieces[0].attributes.push_back(a);
    std::vector<uint8_t> payload = draft.write();
    EXPECT_EQ(payload[kVersionOffset], 0x11);
    EXPECT_EQ(parseError(payload), Error::kOk);
    payload[kVersionOffset] = 0x10;
    repairChecksum(payload);
    EXPECT_EQ(parseError(payload), Error::kBadHeader);
  }
}

TEST(Container, TheWithdrawnFormatIsNamed) {
  std::vector<uint8_t> payload = simpleDraft().write();
  std::copy_n(kWithdrawnMagic, 3, payload.begin());
  PayloadHeader parsed{Allocator{}};
  const Status status = parsePayload(payload, {}, parsed);
  EXPECT_EQ(status.error, Error::kUnsupportedVersion);
  EXPECT_NE(std::string(status.what).find("withdrawn"), std::string::npos) << status.what;
}

TEST(Container, ReservedBits) {
  for (uint32_t flags = 0; flags < 256; ++flags) {
    const bool known = (flags & ~payload_flag::kAll) == 0;
    std::vector<uint8_t> payload = simpleDraft().write();
    payload[kChecksummedFrom] = static_cast<uint8_t>(flags);
    repairChecksum(payload);
    if (!known) {
      EXPECT_EQ(parseError(payload), Error::kBadHeader) << flags;
    }
  }
  for (uint32_t bit = 0; bit < 32; ++bit) {
    if ((piece_flag::kAll >> bit & 1) != 0) continue;
    EXPECT_EQ(errorAfter([bit](Draft& d) { d.pieces[0].header.flags |= 1u << bit; }),
              Error::kBadHeader);
  }
  // What version 1.1 adds is reserved in 1.0.
  for (const uint32_t flag : {piece_flag::kMirrors, piece_flag::kAnchors}) {
    Draft added = simpleDraft();
    added.pieces[0].header.flags |= flag;
    std::vector<uint8_t> payload = added.write();
    EXPECT_EQ(parseError(payload), Error::kOk);
    payload[kVersionOffset] = kVersionMajor << 4;
    repairChecksum(payload);
    EXPECT_EQ(parseError(payload), Error::kBadHeader);
  }
  Draft trained = simpleDraft();
  trained.flags |= payload_flag::kTrained;
  std::vector<uint8_t> payload = trained.write();
  EXPECT_EQ(payload[kVersionOffset], 0x11);
  EXPECT_EQ(parseError(payload), Error::kOk);
  payload[kVersionOffset] = kVersionMajor << 4;
  repairChecksum(payload);
  EXPECT_EQ(parseError(payload), Error::kBadHeader);
}

TEST(Container, CountsThatContradictEachOther) {
  using Change = std::function<void(Draft&)>;
  const std::vector<Change> changes = {
      [](Draft& d) { d.pieces[0].header.vertex_count = 13; },
      [](Draft& d) { d.pieces[0].header.vertex_count = 0; },
      [](Draft& d) {
        d.pieces[0].header.face_count = 0;
        d.pieces[0].part_triangles = {0};
      },
      [](Draft& d) { d.pieces[0].header.operation_count = 4 + 16 + 1; },
      [](Draft& d) { d.pieces[0].header.operation_count = ~0u; },
      [](Draft& d) {
        d.pieces[0].header.flags |= piece_flag::kHoles;
        d.pieces[0].header.dummy_count = 13;
      },
      [](Draft& d) {
        d.pieces[0].header.flags |= piece_flag::kIsolated;
        d.pieces[0].header.isolated_count = 5;
      },
      [](Draft& d) {
        d.pieces[0].header.flags |= piece_flag::kManyParts;
        d.pieces[0].part_triangles = {};
      },
      [](Draft& d) {
        d.pieces[0].header.flags |= piece_flag::kManyParts;
        d.pieces[0].part_triangles = {1, 2};
      },
      [](Draft& d) {
        d.pieces[0].header.flags |= piece_flag::kManyParts;
        d.pieces[0].part_triangles = {5, ~0u};  // their sum is right modulo 2^32
      },
      [](Draft& d) { d.pieces[0].header.wedge_count = 13; },  // more than corners
      // Flags that are redundant, or that require another one.
      [](Draft& d) { d.pieces[0].header.flags |= piece_flag::kManyParts; },
      [](Draft& d) { d.pieces[0].header.flags |= piece_flag::kHoles; },
      [](Draft& d) { d.pieces[0].header.flags |= piece_flag::kIsolated; },
      [](Draft& d) { d.pieces[0].header.flags |= piece_flag::kListed; },
      [](Draft& d) { d.pieces[0].header.flags |= piece_flag::kCreases; },
      // A piece that is not cut has neither of them.
      [](Draft& d) {
        d.pieces[0].header.setSurface(SurfaceCoding::kPivots);
        d.pieces[0].header.flags |= piece_flag::kHandles;
      },
      [](Draft& d) {
        d.pieces[0].header.setSurface(SurfaceCoding::kPivots);
        d.pieces[0].header.flags |= piece_flag::kHoles;
        d.pieces[0].header.dummy_count = 1;
      },
  };
  EXPECT_EQ(errorAfter([](Draft&) {}), Error::kOk);
  for (size_t i = 0; i < changes.size(); ++i)
    EXPECT_EQ(errorAfter(changes[i]), Error::kBadHeader) << "change " << i;
}

void setGrid(AttributeInfo& a, uint32_t bits, uint32_t tails, uint32_t grid) {
  a.coding = AttributeCoding::kGrid;
  a.bits = static_cast<uint8_t>(bits);
  a.tails = static_cast<uint8_t>(tails);
  a.grid = static_cast<uint8_t>(grid);
}

TEST(Container, AttributesThatAreNone) {
  using Change = std::function<void(AttributeInfo&)>;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Change> changes = {
      [](AttributeInfo& a) { a.bits = 0; },
      [](AttributeInfo& a) { a.bits = 25; },
      [](AttributeInfo& a) { a.bits = 31; },
      [](AttributeInfo& a) { a.lattice.step = 0; },
      [](AttributeInfo& a) { a.lattice.step = -1; },
      [=](AttributeInfo& a) { a.lattice.step = infinity; },
      [=](AttributeInfo& a) { a.lattice.step = nan; },
      [=](AttributeInfo& a) { a.lattice.origin[0] = infinity; },
      [=](AttributeInfo& a) { a.lattice.origin[2] = -infinity; },
      [=](AttributeInfo& a) { a.lattice.origin[1] = nan; },
      [](AttributeInfo& a) { a.format.component_type = ComponentType::kUint8; },
      [](AttributeInfo& a) { a.coding = AttributeCoding::kInteger; },
      [](AttributeInfo& a) { a.coding = static_cast<AttributeCoding>(15); },
      [](AttributeInfo& a) { a.format.component_type = static_cast<ComponentType>(6); },
      [](AttributeInfo& a) { a.format.component_type = static_cast<ComponentType>(7); },
      [](AttributeInfo& a) {
        a.coding = AttributeCoding::kExactFloat;
        a.format.component_type = ComponentType::kInt16;
      },
      [](AttributeInfo& a) {
        a.coding = AttributeCoding::kOctahedral;
        a.bits = 1;
      },
      [](AttributeInfo& a) {
        a.coding = AttributeCoding::kOctahedral;
        a.bits = 17;
      },
      [](AttributeInfo& a) {
        a.coding = AttributeCoding::kOctahedral;
        a.bits = 10;
        a.format.component_count = 2;
      },
      [](AttributeInfo& a) {
        a.coding = AttributeCoding::kOctahedral;
        a.bits = 10;
        a.format.semantic = Semantic::kTangent;
        a.format.component_count = 3;
      },
      [](AttributeInfo& a) {
        a.coding = AttributeCoding::kOctahedral;
        a.bits = 10;
        a.format.semantic = Semantic::kNormal;
        a.format.component_count = 4;
      },
      [](AttributeInfo& a) {  // a delta
        a.coding = AttributeCoding::kOctahedral;
        a.bits = 10;
        a.format.semantic = Semantic::kTangent;
        a.format.component_count = 4;
        a.format.morph_target = 1;
      },
      [](AttributeInfo& a) {  // a bit that values do not have
        a.coding = AttributeCoding::kExactFloat;
        a.predictor = 4;
      },
      [](AttributeInfo& a) { setGrid(a, 0, 0, 3); },
      [](AttributeInfo& a) { setGrid(a, kGridBits + 2, 0, 3); },
      [](AttributeInfo& a) { setGrid(a, 10, 1, 3); },
      [](AttributeInfo& a) { setGrid(a, 10, 3, kGridBinary); },
      [](AttributeInfo& a) {
        setGrid(a, 10, 0, 3);
        a.format.component_count = 9;
      },
      [](AttributeInfo& a) {
        setGrid(a, 10, 0, 3);
        a.format.component_type = ComponentType::kUint32;
      },
  };
  for (size_t i = 0; i < changes.size(); ++i) {
    const Error error = errorAfter([&](Draft& d) {
      AttributeInfo a = position();
      a.format.semantic = Semantic::kCustom;
      changes[i](a);
      d.pieces[0].attributes.push_back(a);
    });
    EXPECT_EQ(error, Error::kBadHeader) << "change " << i;
  }
}

/// The bytes of a position's lattice, alone and with what is before it in the piece.
TEST(Container, LatticesTakeFewBytes) {
  const auto bytesOf = [](const Lattice& lattice, uint8_t bits) {
    Draft draft = simpleDraft();
    const size_t without = kChecksummedFrom + 1 + 1 + 4 + 1 + 2 + 2 + draft.codes.size() +
                           draft.tokens.size() + draft.raw.size();
    draft.pieces[0].attributes[0].lattice = lattice;
    draft.pieces[0].attributes[0].bits = bits;
    const std::vector<uint8_t> payload = draft.write();
    EXPECT_EQ(parseError(payload), Error::kOk);
    return payload.size() - without;
  };
  constexpr float kAny = 0.3f;  // its lowest byte is not 0
  EXPECT_EQ(bytesOf({{kAny, kAny, -kAny}, kAny}, 14), 1u + 16);
  EXPECT_EQ(bytesOf({{kAny, kAny, -kAny}, 0x1.0002p-9f}, 14), 1u + 15);
  EXPECT_EQ(bytesOf({{kAny, kAny, 0}, kAny}, 14), 2u + 12);
  EXPECT_EQ(bytesOf({{-1, 2, 0x1.02p0f}, 0.5f}, 14), 2u + 8);
  EXPECT_EQ(bytesOf({{0, 0, 0}, 1.0f / 16383}, 14), 2u);
  EXPECT_EQ(bytesOf({{0, 0, 0}, 1.0f / 16383}, 13), 2u + 3);
  EXPECT_EQ(bytesOf({{-0.0f, 0, 0}, 1}, 1), 2u + 2);
}

/// The step of a lattice is that of the last one of the same semantic.
TEST(Container, StepsAreRepeated) {
  const auto sizeWith = [](Semantic semantic, float step, uint16_t morph_target) {
    Draft draft = simpleDraft();
    std::vector<AttributeInfo>& attributes = draft.pieces[0].attributes;
    attributes[0].lattice.step = 0.3f;
    AttributeInfo between = position();
    between.format.semantic = Semantic::kNormal;
    attributes.push_back(between);
    AttributeInfo last;
    last.format.semantic = semantic;
    last.format.morph_target = morph_target;
    last.bits = 14;
    last.lattice.step = step;
    attributes.push_back(last);
    const std::vector<uint8_t> payload = draft.write();
    PayloadHeader parsed{Allocator{}};
    EXPECT_TRUE(parsePayload(payload, {}, parsed).ok());
    EXPECT_EQ(parsed.attributes[2].lattice.step, step);
    return payload.size();
  };
  const size_t repeated = sizeWith(Semantic::kPosition, 0.3f, 1);
  EXPECT_EQ(sizeWith(Semantic::kPosition, 0.7f, 1), repeated + 4);
  EXPECT_EQ(sizeWith(Semantic::kNormal, 0.3f, 1), repeated + 4);
  EXPECT_EQ(sizeWith(Semantic::kNormal, 0.5f, 1), repeated);
  EXPECT_EQ(sizeWith(Semantic::kPosition, 1.0f / 16383, 1), repeated + 3);
}

/// A header has one form only: a number in more bytes than it needs is refused.
TEST(Container, LatticesHaveTheLargestForm) {
  struct Form {
    std::vector<uint8_t> bytes;  ///< of a lattice of one bit, that is, a usual step of 1
    Error error;
  };
  const uint8_t usual = 1 | 3 << 5;  // and 3 << 7 and so on for the origins
  const Form forms[] = {
      {{0x80 | usual, 0x7f}, Error::kBadHeader},  // one form too many
      {{0x80 | usual, 0x3f}, Error::kOk},
      {{0x80 | 1, 0x3f, 1, 0, 0x80, 0x3f}, Error::kOk},  // step of four bytes, of three, of two
      {{0x80 | 1, 0x3f, 0, 1, 0x80, 0x3f}, Error::kBadHeader},
      {{0x80 | 1 | 1 << 5, 0x3f, 1, 0x80, 0x3f}, Error::kOk},
      {{0x80 | 1 | 1 << 5, 0x3f, 0, 0x81, 0x3f}, Error::kBadHeader},
      {{0x80 | 1 | 2 << 5, 0x3f, 0x81, 0x3f}, Error::kOk},
      {{0x80 | 1 | 2 << 5, 0x3f, 0x80, 0x3f}, Error::kBadHeader},  // 1 is usual
      {{0x80 | 1 | 2 << 5, 0x3f, 0, 0}, Error::kBadHeader},        // a step of 0
      {{usual, 0x3e, 0x80, 0x3f}, Error::kTruncated},              // three origins of four bytes
      {{0x80 | usual, 0x3e, 0x80, 0x3f}, Error::kOk},              // an origin of two bytes
      {{0x80 | usual, 0x3e, 0, 0}, Error::kBadHeader},             // 0 is usual
      {{0x80 | usual, 0x3e, 0, 0x80}, Error::kOk},                 // -0 is not
  };
  Draft draft = simpleDraft();
  draft.flags = payload_flag::kSingleCoder;
  draft.pieces[0].attributes[0].lattice = {{0, 0, 0}, 1};
  draft.pieces[0].attributes[0].bits = 1;
  const std::vector<uint8_t> payload = draft.write();
  const auto begin = payload.begin() + static_cast<std::ptrdiff_t>(kChecksummedFrom + 9);
  ASSERT_EQ(*begin, 0x80 | usual);
  for (const Form& form : forms) {
    std::vector<uint8_t> changed(payload.begin(), begin);
    changed.insert(changed.end(), form.bytes.begin(), form.bytes.end());
    changed.insert(changed.end(), begin + 2, payload.end());
    repairChecksum(changed);
    EXPECT_EQ(parseError(changed), form.error) << "form " << &form - forms;
  }
}

/// Floats with the usual number of components need no type, and may not state it.
TEST(Container, UsualTypesAreNotStated) {
  for (uint32_t semantic = 0; semantic < 8; ++semantic) {
    const auto written = [&](uint8_t components, bool normalized) {
      Draft draft = simpleDraft();
      AttributeInfo a;
      a.format.semantic = static_cast<Semantic>(semantic);
      a.format.component_count = components;
      a.format.normalized = normalized;
      a.coding = AttributeCoding::kExactFloat;
      draft.pieces[0].attributes.push_back(a);
      return draft.write();
    };
    const uint8_t usual = kUsualComponents[semantic];
    const size_t size = written(usual, false).size();
    EXPECT_EQ(written(usual, true).size(), size + 1);
    EXPECT_EQ(written(16, false).size(), size + 1);
    std::vector<uint8_t> stated = written(usual, true);
    const auto type = std::find(stated.begin() + kChecksummedFrom, stated.end(),
                                static_cast<uint8_t>(0x80 | (usual - 1) << 3 | 5));
    ASSERT_NE(type, stated.end());
    *type &= 0x7f;
    repairChecksum(stated);
    EXPECT_EQ(parseError(stated), Error::kBadHeader);
  }
}

TEST(Container, TangentsNeedNormalsOfTheBaseMesh) {
  const auto errorWithNormals = [](uint16_t morph_target) {
    return errorAfter([=](Draft& d) {
      AttributeInfo normal = position();
      normal.format.semantic = Semantic::kNormal;
      normal.format.morph_target = morph_target;
      normal.coding = AttributeCoding::kOctahedral;
      normal.bits = 10;
      AttributeInfo tangent = position();
      tangent.format.semantic = Semantic::kTangent;
      tangent.format.component_count = 4;
      tangent.coding = AttributeCoding::kTangentAngle;
      tangent.bits = 12;
      d.pieces[0].attributes.push_back(normal);
      d.pieces[0].attributes.push_back(tangent);
    });
  };
  EXPECT_EQ(errorWithNormals(0), Error::kOk);
  EXPECT_EQ(errorWithNormals(1), Error::kBadHeader);  // it would be decoded after the tangents
}

TEST(Container, PlanesNeedACoarseLattice) {
  const auto errorOf = [](uint8_t bits, AttributeCoding coding, uint8_t flags) {
    return errorAfter([=](Draft& d) {
      AttributeInfo& a = d.pieces[0].attributes[0];
      a.bits = bits;
      a.coding = coding;
      a.predictor = static_cast<uint8_t>(position_mode::kPlanes | flags);
    });
  };
  constexpr uint8_t kBoth = position_mode::kWeights | position_mode::kSelect;
  EXPECT_EQ(errorOf(17, AttributeCoding::kLattice, kBoth), Error::kOk);
  EXPECT_EQ(errorOf(18, AttributeCoding::kLattice, 0), Error::kBadHeader);
  EXPECT_EQ(errorOf(0, AttributeCoding::kExactFloat, 0), Error::kBadHeader);
  EXPECT_EQ(errorOf(14, AttributeCoding::kLattice, position_mode::kFold), Error::kBadHeader);
  EXPECT_EQ(errorOf(14, AttributeCoding::kLattice, position_mode::kSplit), Error::kBadHeader);
  EXPECT_EQ(errorOf(14, AttributeCoding::kLattice, position_mode::kOwnScale), Error::kBadHeader);
}

TEST(Container, PositionComesFirst) {
  EXPECT_EQ(errorAfter([](Draft& d) { d.pieces[0].attributes.clear(); }), Error::kOk);
  EXPECT_EQ(errorAfter([](Draft& d) {
              d.pieces[0].attributes.clear();
              d.pieces[0].header.flags |= piece_flag::kSeams | piece_flag::kCreases;
            }),
            Error::kBadHeader);
  const std::vector<std::function<void(AttributeInfo&)>> changes = {
      [](AttributeInfo& a) { a.format.semantic = Semantic::kNormal; },
      [](AttributeInfo& a) { a.format.morph_target = 1; },
      [](AttributeInfo& a) { a.format.component_count = 2; },
      [](AttributeInfo& a) { a.format.component_count = 4; },
      [](AttributeInfo& a) {
        a.coding = AttributeCoding::kOctahedral;
        a.bits = 10;
      },
  };
  for (const auto& change : changes) {
    EXPECT_EQ(errorAfter([&](Draft& d) { change(d.pieces[0].attributes[0]); }), Error::kBadHeader);
  }
  // The first piece has none before it whose attributes it could share.
  std::vector<uint8_t> payload = simpleDraft().write();
  payload[kChecksummedFrom + 1] |= piece_flag::kSameAttributes;
  repairChecksum(payload);
  EXPECT_EQ(parseError(payload), Error::kBadHeader);
}

TEST(Container, EqualAttributesAreWrittenOnce) {
  Draft draft = simpleDraft();
  draft.pieces.push_back(draft.pieces[0]);
  const size_t equal_bytes = draft.write().size();
  draft.pieces[1].attributes[0].bits = 15;
  EXPECT_EQ(draft.write().size(), equal_bytes + 1 + 2 + 6);  // count, kind, predictor, lattice
}

TEST(Container, LimitsOfTheCaller) {
  const auto big = [](Draft& d) {
    PieceHeader& h = d.pieces[0].header;
    h.flags |= piece_flag::kListed;
    h.vertex_count = 100;
    h.face_count = 200;
    h.wedge_count = 150;
    h.listed_count = 30;
    d.pieces[0].part_triangles = {230};
    d.pieces[0].attributes.push_back(position());
    d.pieces[0].attributes.push_back(position());
    d.pieces.push_back(simpleDraft().pieces[0]);
  };
  Limits limits;
  EXPECT_EQ(errorAfter(big, limits), Error::kOk);
  limits.max_vertices = 149;
  EXPECT_EQ(errorAfter(big, limits), Error::kLimit);
  limits = {};
  limits.max_triangles = 229;
  EXPECT_EQ(errorAfter(big, limits), Error::kLimit);
  limits = {};
  limits.max_attributes = 3;
  EXPECT_EQ(errorAfter(big, limits), Error::kLimit);
  limits.max_attributes = 4;
  EXPECT_EQ(errorAfter(big, limits), Error::kOk);
  limits.max_pieces = 1;
  EXPECT_EQ(errorAfter(big, limits), Error::kLimit);
  limits.max_pieces = 2;
  EXPECT_EQ(errorAfter(big, limits), Error::kOk);

  // Operations, vertices, wedges, triangles, those of three attributes, components: of the first
  // piece, then of the other.
  limits = {};
  limits.max_elements = 2 + 100 + 150 + 230 + 3 * (1024 + 230) + 9 * 150;
  limits.max_elements += 2 + 4 + 4 + 4 + (1024 + 4) + 3 * 4;
  EXPECT_EQ(errorAfter(big, limits), Error::kOk);
  --limits.max_elements;
  EXPECT_EQ(errorAfter(big, limits), Error::kLimit);
  limits = {};
  limits.max_output_bytes = 230 * 12 + 9 * 4 * 150 + 4 * 12 + 3 * 4 * 4;
  EXPECT_EQ(errorAfter(big, limits), Error::kOk);
  --limits.max_output_bytes;
  EXPECT_EQ(errorAfter(big, limits), Error::kLimit);
}

/// The limits apply to a payload, not to each of its pieces.
TEST(Container, LimitsHoldForAllPiecesTogether) {
  const auto three = [](Draft& d) { d.pieces.assign(3, simpleDraft().pieces[0]); };
  Limits limits;
  limits.max_vertices = 12;
  limits.max_triangles = 12;
  EXPECT_EQ(errorAfter(three, limits), Error::kOk);
  limits.max_vertices = 11;
  EXPECT_EQ(errorAfter(three, limits), Error::kLimit);
  limits.max_vertices = 12;
  limits.max_triangles = 11;
  EXPECT_EQ(errorAfter(three, limits), Error::kLimit);
}

TEST(Container, LimitsOfTheFormat) {
  Limits limits;
  limits.max_vertices = limits.max_triangles = ~uint64_t{0};
  const auto with = [&limits](uint32_t PieceHeader::*field, uint32_t value) {
    return errorAfter(
        [=](Draft& d) {
          PieceHeader& h = d.pieces[0].header;
          h.flags |= piece_flag::kListed;
          h.listed_count = 1;
          h.*field = value;
          d.pieces[0].part_triangles = {static_cast<uint32_t>(d.pieces[0].header.triangleCount())};
        },
        limits);
  };
  EXPECT_EQ(with(&PieceHeader::wedge_count, 1u << 28), Error::kLimit);
  EXPECT_EQ(with(&PieceHeader::wedge_count, ~0u), Error::kLimit);
  EXPECT_EQ(with(&PieceHeader::vertex_count, 1u << 28), Error::kLimit);
  EXPECT_EQ(with(&PieceHeader::face_count, 1u << 28), Error::kLimit);
  EXPECT_EQ(with(&PieceHeader::listed_count, (1u << 28) - 4), Error::kLimit);
  EXPECT_EQ(with(&PieceHeader::listed_count, ~0u), Error::kLimit);
}

/// The number of pieces is stated when it is not 1.
TEST(Container, NoPiecesAndOnePiece) {
  for (const uint8_t count : {uint8_t{0}, uint8_t{1}}) {
    std::vector<uint8_t> payload = simpleDraft().write();
    payload[kChecksummedFrom] |= payload_flag::kManyPieces;
    payload.insert(payload.begin() + kChecksummedFrom + 1, count);
    repairChecksum(payload);
    EXPECT_EQ(parseError(payload), Error::kBadHeader);
  }
}

/// A set of 0 of the base mesh is not stated, nor is padding of no bytes.
TEST(Container, WhatNeedsNoStatement) {
  std::vector<uint8_t> payload = simpleDraft().write();
  const size_t kind = kChecksummedFrom + 1 + 1 + 4 + 1;  // after flags, counts, attribute count
  std::vector<uint8_t> more = payload;
  more[kind] |= 0x80;
  more.insert(more.begin() + kind + 1, 2, 0);
  repairChecksum(more);
  EXPECT_EQ(parseError(more), Error::kBadHeader);
  more[kind + 1] = 1;
  repairChecksum(more);
  EXPECT_EQ(parseError(more), Error::kBadHeader) << "a position of set 1 is none of the base mesh";

  PayloadHeader parsed{Allocator{}};
  ASSERT_TRUE(parsePayload(payload, {}, parsed).ok());
  payload[kChecksummedFrom] |= payload_flag::kPadded;
  payload.insert(payload.begin() + static_cast<std::ptrdiff_t>(parsed.header_bytes), 0);
  repairChecksum(payload);
  EXPECT_EQ(parseError(payload), Error::kBadHeader);
}

/// The same claims in fewer bytes.
std::vector<uint8_t> withoutPadding(std::vector<uint8_t> payload) {
  PayloadHeader parsed{Allocator{}};
  EXPECT_TRUE(parsePayload(payload, {}, parsed).ok());
  size_t begin = parsed.header_bytes;  // the padding ends the header: its length, then zeros
  while (payload[begin - 1] == 0) --begin;
  for (size_t rest = parsed.header_bytes - begin; rest != 0; rest >>= 7) --begin;
  payload.erase(payload.begin() + static_cast<std::ptrdiff_t>(begin),
                payload.begin() + static_cast<std::ptrdiff_t>(parsed.header_bytes));
  payload[kChecksummedFrom] &= static_cast<uint8_t>(~payload_flag::kPadded);
  repairChecksum(payload);
  return payload;
}

/// A payload has at least one byte per 1024 elements, padded with zeros if necessary.
TEST(Container, Padding) {
  const auto claim = [](uint32_t faces) {
    Draft draft = simpleDraft();
    PieceHeader& h = draft.pieces[0].header;
    h.face_count = faces;
    h.vertex_count = h.wedge_count = faces / 2;
    h.operation_count = faces / 2;
    draft.pieces[0].part_triangles = {faces};
    return draft;
  };
  const std::vector<uint8_t> small = claim(100).write();
  EXPECT_EQ(small[kChecksummedFrom] & payload_flag::kPadded, 0u);
  for (const uint32_t faces : {200000u, 2000000u, 100000000u}) {
    const std::vector<uint8_t> payload = claim(faces).write();
    EXPECT_NE(payload[kChecksummedFrom] & payload_flag::kPadded, 0u);
    PayloadHeader parsed{Allocator{}};
    ASSERT_TRUE(parsePayload(payload, {}, parsed).ok());
    EXPECT_TRUE(sameBytes(parsed.streams.codes, claim(faces).codes));
    EXPECT_GE(payload.size() * kMaxElementsPerByte, uint64_t{faces} * 2);
    EXPECT_LE(payload.size(), uint64_t{faces} * 5 / kMaxElementsPerByte + 100);

    std::vector<uint8_t> damaged = payload;  // the padding ends the header
    damaged[parsed.header_bytes - 1] = 1;
    repairChecksum(damaged);
    EXPECT_EQ(parseError(damaged), Error::kBadHeader);

    EXPECT_EQ(parseError(withoutPadding(payload)), Error::kLimit);
  }
}

/// What takes work or memory counts, in every piece.
TEST(Container, Elements) {
  const auto elements = [](uint32_t flags, uint32_t more_pieces) {
    Draft draft = simpleDraft();
    PieceHeader& h = draft.pieces[0].header;
    h.flags |= flags;
    h.wedge_count = 6;
    if (h.hasPivots()) h.operation_count = 0;
    if (h.has(piece_flag::kIsolated)) h.isolated_count = 2;
    AttributeInfo color;
    color.format.semantic = Semantic::kColor;
    color.format.component_count = 4;
    color.coding = AttributeCoding::kExactFloat;
    draft.pieces[0].attributes.push_back(color);
    for (uint32_t i = 0; i < more_pieces; ++i) draft.pieces.push_back(draft.pieces[0]);
    PayloadHeader parsed{Allocator{}};
    const std::vector<uint8_t> payload = draft.write();
    EXPECT_TRUE(parsePayload(payload, {}, parsed).ok());
    EXPECT_LE(elementsOf(parsed), 1024 * payload.size());
    return elementsOf(parsed);
  };
  // Operations, vertices, wedges, triangles, those of two attributes, components, tables.
  const uint64_t plain = 2 + 4 + 6 + 4 + 2 * 4 + 6 * (3 + 4) + 2 * 1024;
  EXPECT_EQ(elements(0, 0), plain);
  EXPECT_EQ(elements(0, 70), 71 * plain);  // equal attributes are stated once
  const auto surface = [](SurfaceCoding coding) {
    return static_cast<uint32_t>(coding) << piece_flag::kSurfaceShift;
  };
  EXPECT_EQ(elements(surface(SurfaceCoding::kBoundaryCopies), 0), plain + 8 * 4);
  EXPECT_EQ(elements(surface(SurfaceCoding::kCopies), 0), plain + 8 * 4);
  EXPECT_EQ(elements(surface(SurfaceCoding::kPivots), 0), plain - 2 + 8 * 4);
  EXPECT_EQ(elements(piece_flag::kIsolated, 0), plain + 8 * 2);
  EXPECT_EQ(elements(piece_flag::kTriangleOrder, 0), plain + 8 * 4);
  EXPECT_EQ(elements(piece_flag::kVertexOrder, 0), plain + 8 * (6 + 4));
}

/// Handles and copies make any number of faces on four wedges for almost no bits, and every
/// attribute walks over them.
TEST(Container, FacesOfAttributesAreBounded) {
  Draft draft = simpleDraft();
  draft.flags = payload_flag::kSingleCoder;
  PieceHeader& h = draft.pieces[0].header;
  h.flags |= piece_flag::kHandles;
  h.setSurface(SurfaceCoding::kCopies);
  h.vertex_count = h.operation_count = 200000;
  h.face_count = 400000;
  h.wedge_count = 4;
  draft.pieces[0].part_triangles = {h.face_count};
  AttributeInfo normal;
  normal.format.semantic = Semantic::kNormal;
  normal.coding = AttributeCoding::kOctahedral;
  normal.bits = 8;
  draft.pieces[0].attributes.resize(61, normal);
  const std::vector<uint8_t> payload = draft.write();
  ASSERT_EQ(parseError(payload), Error::kOk);  // padded as much as needed
  EXPECT_GT(payload.size(), 61u * 400000 / 1024);
  EXPECT_EQ(parseError(withoutPadding(payload)), Error::kLimit);
}

/// Callers of the reader allocate what attributes claim, so a short payload must not claim much.
TEST(Container, ClaimsOfAttributesAreBounded) {
  Draft draft = simpleDraft();
  draft.flags = payload_flag::kSingleCoder;
  PieceHeader& h = draft.pieces[0].header;
  h.flags |= piece_flag::kIsolated;
  h.wedge_count = 2000000;
  h.isolated_count = h.wedge_count - 4;
  AttributeInfo wide;
  wide.format.semantic = Semantic::kCustom;
  wide.format.component_type = ComponentType::kUint32;
  wide.format.component_count = 16;
  wide.coding = AttributeCoding::kInteger;
  draft.pieces[0].attributes.resize(100, wide);
  std::fill(draft.pieces[0].attributes.begin() + 1, draft.pieces[0].attributes.end(), wide);
  const std::vector<uint8_t> payload = draft.write();
  ASSERT_EQ(parseError(payload), Error::kOk);  // padded as much as needed
  EXPECT_GT(payload.size(), 100u * 1000);
  EXPECT_EQ(parseError(withoutPadding(payload)), Error::kLimit);
}

TEST(Container, OutOfMemory) {
  const std::vector<uint8_t> payload = anyDraft(11).write();
  expectParsesOrRunsOutOfMemory(payload);
}

}  // namespace
}  // namespace mcc::test
