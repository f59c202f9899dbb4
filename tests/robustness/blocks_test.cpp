// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Damaged and forged payloads with blocks: an error or a valid shape, in time and memory that are
// proportional to what the header claims.                                             [A.11]
// [A.2.6]
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "container/enc_payload.h"
#include "container/payload_header.h"
#include "robustness/damage.h"
#include "robustness/payloads.h"
#include "support/counting_allocator.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "support/run_jobs.h"
#include "unit/failing_allocator.h"

namespace mcc::test {
namespace {

using Bytes = std::vector<uint8_t>;

NamedPayload blocksOf(const MeshPiece& piece, const std::string& name, uint32_t block_triangles) {
  EncodeSettings settings;
  settings.block_triangles = block_triangles;
  const PieceView view = piece.view();
  EncodeResult result;
  const Status status = encodeWith({&view, 1}, settings, result);
  if (!status.ok()) throw std::runtime_error(name + ": " + status.what);
  if (result.block_count < 3) throw std::runtime_error(name + " has no blocks");
  return {name, std::move(result.payload)};
}

NamedPayload blocksOf(const TestMesh& mesh, uint32_t block_triangles, const MeshBits& bits = {}) {
  return blocksOf(MeshPiece(mesh, bits), mesh.name, block_triangles);
}

NamedPayload blocksOfParts(const TestMesh& mesh, uint32_t block_triangles) {
  std::array<std::vector<uint32_t>, 3> parts;
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::vector<uint32_t>& part = parts[t / 12 % 2];  // the last one is empty
    part.insert(part.end(), &mesh.indices[t], &mesh.indices[t] + 3);
  }
  MeshPiece piece(mesh);
  piece.setParts({{parts[0]}, {parts[1]}, {parts[2]}});
  return blocksOf(piece, "parts of " + mesh.name, block_triangles);
}

const std::vector<NamedPayload>& payloads() {
  static const std::vector<NamedPayload> kPayloads = {
      blocksOf(torus(7, 5), 16),
      blocksOf(icosphere(1), 20, kExactBits),
      blocksOf(chartGrid(6, 6, 2), 20),
      blocksOf(withEqualTuples(torus(7, 5), 1), 16),  // exceptions
      blocksOf(pinchedSpheres(3), 9),                 // others
      blocksOf(withUnused(withIndexDuplicates(grid(6, 6), 1, 8), 2, 9), 18),
      blocksOf(book(4, 4, 2), 10),
      blocksOfParts(sheetWithHoles(3, 7), 12)};
  return kPayloads;
}

PayloadHeader headerOf(const Bytes& payload) {
  PayloadHeader header{Allocator{}};
  const Status status = parsePayload(payload, {}, header);
  if (!status.ok()) throw std::runtime_error(status.what);
  return header;
}

TEST(DamagedBlocks, IntactPayloadsDecode) {
  uint32_t exceptions = 0;
  for (const NamedPayload& payload : payloads()) {
    const Outcome outcome = decodeDamaged(payload.bytes);
    EXPECT_EQ(outcome.error, Error::kOk) << payload.name;
    EXPECT_EQ(outcome.failure, "") << payload.name;
    const PayloadHeader header = headerOf(payload.bytes);
    EXPECT_TRUE(header.hasBlocks());
    exceptions += header.exceptions.empty() ? 0 : 1;
  }
  EXPECT_GE(exceptions, 2u);
}

/// Each byte is covered by the checksum of the header or of a block.
TEST(DamagedBlocks, EveryFlippedBitIsAnError) {
  for (const NamedPayload& payload : payloads()) {
    Bytes damaged = payload.bytes;
    for (size_t bit = 0; bit < 8 * damaged.size(); ++bit) {
      damaged[bit / 8] = static_cast<uint8_t>(damaged[bit / 8] ^ 1u << bit % 8);
      const Outcome outcome = decodeDamaged(damaged);
      ASSERT_NE(outcome.error, Error::kOk) << payload.name << ", bit " << bit;
      ASSERT_EQ(outcome.failure, "") << payload.name << ", bit " << bit;
      damaged[bit / 8] = payload.bytes[bit / 8];
    }
  }
}

TEST(DamagedBlocks, EveryTruncationIsAnError) {
  for (const NamedPayload& payload : payloads()) {
    const size_t header_bytes = headerOf(payload.bytes).header_bytes;
    for (size_t size = 0; size < payload.bytes.size(); ++size) {
      for (const bool is_repaired : {false, true}) {
        Bytes cut(payload.bytes.begin(), payload.bytes.begin() + static_cast<std::ptrdiff_t>(size));
        if (is_repaired) repairChecksum(cut);
        const Outcome outcome = decodeDamaged(cut);
        ASSERT_NE(outcome.error, Error::kOk) << payload.name << " cut to " << size;
        ASSERT_EQ(outcome.failure, "") << payload.name << " cut to " << size;
        if (size >= header_bytes) {
          EXPECT_TRUE(outcome.error == Error::kTruncated || outcome.error == Error::kLimit);
        }
      }
    }
    Bytes longer = payload.bytes;
    longer.push_back(0);
    EXPECT_EQ(decodeDamaged(longer).error, Error::kTrailingBytes) << payload.name;
  }
}

/// Every value of every byte of the header and its table.
TEST(DamagedBlocks, HeaderBytes) {
  Watchdog watchdog;
  std::map<Error, uint64_t> errors;
  for (size_t p = 0; p < payloads().size(); ++p) {
    const NamedPayload& payload = payloads()[p];
    const size_t header_bytes = headerOf(payload.bytes).header_bytes;
    for (size_t i = kChecksummedFrom; i < header_bytes; ++i) {
      // The sanitizers are slow: they get every payload's byte, but fewer values.
      for (uint32_t value = MCC_IS_SANITIZED ? i % 7 : 0; value < 256;
           value += MCC_IS_SANITIZED ? 7 : 1) {
        Bytes damaged = payload.bytes;
        damaged[i] = static_cast<uint8_t>(value);
        repairChecksum(damaged);
        watchdog.step(p, i * 256 + value);
        const Outcome outcome = decodeDamaged(damaged);
        ASSERT_EQ(outcome.failure, "") << payload.name << ", byte " << i << " = " << value;
        ++errors[outcome.error];
      }
    }
  }
  for (const Error error : {Error::kTruncated, Error::kBadChecksum, Error::kBadHeader,
                            Error::kBadAttribute, Error::kTrailingBytes, Error::kLimit}) {
    EXPECT_GT(errors[error], 0u) << static_cast<int>(error);
  }
}

/// The streams of all blocks.
struct BlockStreams {
  explicit BlockStreams(const Bytes& payload) {
    const PayloadHeader header = headerOf(payload);
    for (size_t i = 0; i < header.blocks.size(); ++i) {
      const Streams streams = header.streamsOf(header.blocks[i]);
      bytes.push_back({copyOf(streams.codes), copyOf(streams.tokens), copyOf(streams.raw)});
    }
  }
  static Bytes copyOf(std::span<const uint8_t> of) { return {of.begin(), of.end()}; }
  std::vector<Streams> views() const {
    std::vector<Streams> all;
    for (const std::array<Bytes, 3>& block : bytes) all.push_back({block[0], block[1], block[2]});
    return all;
  }

  std::vector<std::array<Bytes, 3>> bytes;
};

/// Writes a payload again, with checksums that fit, after a change of its header or its streams.
Bytes rewritten(const Bytes& payload,
                const std::function<void(PayloadHeader&, BlockStreams&)>& change) {
  PayloadHeader header = headerOf(payload);
  header.flags &= ~payload_flag::kPadded;
  BlockStreams streams(payload);
  change(header, streams);
  return writeBlocks(header, streams.views());
}

Error errorAfter(const Bytes& payload,
                 const std::function<void(PayloadHeader&, BlockStreams&)>& change) {
  const Outcome outcome = decodeDamaged(rewritten(payload, change));
  EXPECT_EQ(outcome.failure, "");
  return outcome.error;
}

TEST(DamagedBlocks, RewrittenWithoutAChangeTheyDecode) {
  for (const NamedPayload& payload : payloads()) {
    EXPECT_EQ(rewritten(payload.bytes, [](PayloadHeader&, BlockStreams&) {}), payload.bytes)
        << payload.name;
  }
}

/// Streams with any damage, whose checksums fit.
TEST(DamagedBlocks, StreamsWithGoodChecksums) {
  Watchdog watchdog;
  std::map<Error, uint64_t> errors;
  for (size_t p = 0; p < payloads().size(); ++p) {
    for (uint64_t i = 0; i < (MCC_IS_SANITIZED ? 150u : 1500u); ++i) {
      Random random(i * 1000 + p);
      const Bytes damaged =
          rewritten(payloads()[p].bytes, [&](PayloadHeader& header, BlockStreams& streams) {
            for (uint32_t times = random.between(1, 3); times != 0; --times) {
              const uint32_t block = random.below(static_cast<uint32_t>(header.blocks.size()));
              Bytes& bytes = streams.bytes[block][random.below(3)];
              const uint32_t at = random.below(static_cast<uint32_t>(bytes.size()) + 1);
              if (at == bytes.size()) {
                bytes.push_back(static_cast<uint8_t>(random.below(256)));
              } else if (random.chance(80)) {
                bytes[at] = static_cast<uint8_t>(bytes[at] ^ 1u << random.below(8));
              } else {
                bytes.resize(at);
              }
            }
          });
      watchdog.step(p, i);
      const Outcome outcome = decodeDamaged(damaged);
      ASSERT_EQ(outcome.failure, "") << payloads()[p].name << ", mutation " << i;
      ++errors[outcome.error];
    }
  }
  EXPECT_EQ(errors[Error::kBadChecksum], 0u);
  for (const Error error :
       {Error::kTruncated, Error::kBadConnectivity, Error::kBadAttribute, Error::kTrailingBytes}) {
    EXPECT_GT(errors[error], 0u) << static_cast<int>(error);
  }
}

/// Anything, anywhere.
TEST(DamagedBlocks, Mutations) {
  Watchdog watchdog;
  for (size_t p = 0; p < payloads().size(); ++p) {
    const Bytes& payload = payloads()[p].bytes;
    const size_t header_bytes = headerOf(payload).header_bytes;
    for (uint64_t i = 0; i < (MCC_IS_SANITIZED ? 200u : 2000u); ++i) {
      Random random(i * 1000 + p);
      Bytes damaged = mutated(payload, header_bytes, random);
      repairChecksum(damaged);
      watchdog.step(p, i);
      ASSERT_EQ(decodeDamaged(damaged).failure, "") << payloads()[p].name << ", mutation " << i;
    }
  }
}

// ---- Lies in the table --------------------------------------------------------------------------

TEST(DamagedBlocks, RepeatedCountsAreChecked) {
  for (const NamedPayload& payload : payloads()) {
    const PayloadHeader intact = headerOf(payload.bytes);
    for (size_t b = 1; b < intact.blocks.size(); ++b) {
      // Exceptions are stated as distances, which the writer makes from what the table says.
      const auto with = [&](int32_t change) {
        return errorAfter(payload.bytes, [=](PayloadHeader& header, BlockStreams&) {
          header.blocks[b].repeated_count += static_cast<uint32_t>(change);
        });
      };
      const PieceHeader& piece = intact.pieces[b];
      const bool has_more =
          intact.blocks[b].repeated_count < piece.wedge_count - piece.isolated_count;
      EXPECT_NE(with(1), Error::kOk) << payload.name << ", block " << b;
      if (has_more && b + 1 == intact.blocks.size()) {
        EXPECT_EQ(with(1), Error::kBadAttribute);
      }
      if (intact.blocks[b].repeated_count != 0) {
        EXPECT_NE(with(-1), Error::kOk) << payload.name << ", block " << b;
        EXPECT_NE(with(-static_cast<int32_t>(intact.blocks[b].repeated_count)), Error::kOk);
      }
    }
  }
}

TEST(DamagedBlocks, BoxesAreChecked) {
  for (const NamedPayload& payload : payloads()) {
    const size_t count = headerOf(payload.bytes).blocks.size();
    for (size_t b = 0; b < count; ++b) {
      for (uint32_t s = 0; s < 3; ++s) {
        for (const int32_t change : {-1, 1, 1000}) {
          const auto with = [&](int32_t(CodedBox::*ends)[3]) {
            return errorAfter(payload.bytes, [=](PayloadHeader& header, BlockStreams&) {
              (header.blocks[b].box.*ends)[s] += change;
            });
          };
          for (const Error error : {with(&CodedBox::low), with(&CodedBox::high)}) {
            EXPECT_TRUE(error == Error::kBadAttribute || error == Error::kBadHeader)
                << payload.name << ", block " << b << ": " << static_cast<int>(error);
          }
        }
      }
    }
  }
}

TEST(DamagedBlocks, LiesAboutExceptions) {
  Watchdog watchdog;
  uint64_t refused = 0;
  uint64_t decoded = 0;
  for (size_t p = 0; p < payloads().size(); ++p) {
    for (uint64_t i = 0; i < 200; ++i) {
      Random random(i);
      const Bytes damaged =
          rewritten(payloads()[p].bytes, [&](PayloadHeader& header, BlockStreams&) {
            // New exceptions for one block: any wedges, any numbers.
            const uint32_t b = random.between(1, static_cast<uint32_t>(header.blocks.size()) - 1);
            Array<BlockException> all;
            for (size_t k = 0; k < header.blocks.size(); ++k) {
              BlockHeader& block = header.blocks[k];
              std::vector<BlockException> own;
              for (const BlockException& e : header.exceptionsOf(block)) own.push_back(e);
              if (k == b) {
                own.clear();
                for (uint32_t w = 0; w < header.pieces[k].wedge_count; ++w) {
                  if (!random.chance(20)) continue;
                  const bool is_new = block.first_wedge == 0 || random.chance(40);
                  own.push_back({w, is_new ? kNone : random.below(block.first_wedge)});
                }
              }
              block.first_exception = static_cast<uint32_t>(all.size());
              block.exception_count = static_cast<uint32_t>(own.size());
              for (const BlockException& e : own) ASSERT_TRUE(all.push_back(e));
            }
            header.exceptions = std::move(all);
          });
      watchdog.step(p, i);
      const Outcome outcome = decodeDamaged(damaged);
      ASSERT_EQ(outcome.failure, "") << payloads()[p].name << ", lie " << i;
      ++(outcome.error == Error::kOk ? decoded : refused);
    }
  }
  EXPECT_GT(refused, 100u);
  EXPECT_GT(decoded, 0u);  // who names other wedges gets another shape
}

TEST(DamagedBlocks, LengthsOfStreamsThatDoNotFit) {
  for (const NamedPayload& payload : payloads()) {
    const PayloadHeader intact = headerOf(payload.bytes);
    // The row of each block has its lengths before its checksum: one varint less, another more.
    for (size_t b = 0; b < intact.blocks.size(); ++b) {
      const uint32_t checksum = intact.blocks[b].checksum;
      std::array<uint8_t, 4> wanted;
      for (uint32_t i = 0; i < 4; ++i) wanted[i] = static_cast<uint8_t>(checksum >> (8 * i));
      const auto at =
          std::search(payload.bytes.begin(), payload.bytes.end(), wanted.begin(), wanted.end());
      ASSERT_NE(at, payload.bytes.end());
      const auto offset = static_cast<size_t>(at - payload.bytes.begin());
      for (const int change : {-1, 1}) {
        Bytes damaged = payload.bytes;
        damaged[offset - 1] = static_cast<uint8_t>(damaged[offset - 1] + change);  // raw
        repairChecksum(damaged);
        const Outcome all = decodeDamaged(damaged);
        EXPECT_TRUE(all.error == Error::kTruncated || all.error == Error::kTrailingBytes ||
                    all.error == Error::kBadHeader)
            << payload.name << ": " << static_cast<int>(all.error);
      }
      if (intact.blocks[b].raw_bytes == 0 || intact.blocks[b].tokens_bytes > 100) continue;
      Bytes moved = payload.bytes;  // a byte from raw to tokens: the checksum is the same
      --moved[offset - 1];
      ++moved[offset - 2];
      repairChecksum(moved);
      EXPECT_NE(decodeDamaged(moved).error, Error::kOk) << payload.name;
    }
  }
}

TEST(DamagedBlocks, BlocksOfAnotherPlace) {
  for (const NamedPayload& payload : payloads()) {
    const size_t count = headerOf(payload.bytes).blocks.size();
    for (size_t b = 1; b < count; ++b) {
      EXPECT_NE(errorAfter(payload.bytes,
                           [=](PayloadHeader&, BlockStreams& streams) {
                             std::swap(streams.bytes[b], streams.bytes[b - 1]);
                           }),
                Error::kOk)
          << payload.name;
    }
  }
}

// ---- Memory -------------------------------------------------------------------------------------

struct Targets {
  explicit Targets(const PieceInfo& piece) {
    for (const AttributeInfo& a : piece.attributes) {
      const size_t stride = elementBytes(a.format);
      memory.emplace_back(stride * piece.wedge_count);
      attributes.push_back({memory.back().data(), stride});
    }
    for (const PartInfo& part : piece.parts) {
      indices.emplace_back(3 * size_t{part.triangle_count});
      parts.push_back({indices.back().data()});
    }
  }
  PieceTarget target() const { return {attributes, parts}; }

  std::vector<Bytes> memory;
  std::vector<std::vector<uint32_t>> indices;
  std::vector<AttributeTarget> attributes;
  std::vector<PartTarget> parts;
};

TEST(DamagedBlocks, OutOfMemory) {
  for (const size_t p : {size_t{2}, size_t{3}, size_t{7}}) {
    const NamedPayload& payload = payloads()[p];
    Payload opened;
    ASSERT_TRUE(opened.open(payload.bytes).ok());
    const Targets targets(opened.info().pieces[0]);
    const PieceTarget target = targets.target();
    for (const RunJobs& hook : {RunJobs(), RunJobs(runBackwards)}) {
      for (uint64_t allocations = 0;; ++allocations) {
        FailingAllocator memory(allocations);
        DecodeOptions options;
        options.allocator = memory.allocator();
        options.run_jobs = runnerOf(hook);
        const Error error = opened.decode({&target, 1}, options).error;
        ASSERT_EQ(memory.liveBlocks(), 0u) << payload.name << ", " << allocations;
        ASSERT_TRUE(memory.booksBalance()) << payload.name << ", " << allocations;
        if (error == Error::kOk) break;
        ASSERT_EQ(error, Error::kOutOfMemory) << payload.name << ", " << allocations;
        ASSERT_LT(allocations, 20000u);
      }
    }
    for (uint64_t allocations = 0;; ++allocations) {
      FailingAllocator memory(allocations);
      Error error = Error::kOk;
      {
        Payload again;
        error = again.open(payload.bytes, {}, memory.allocator()).error;
      }
      ASSERT_EQ(memory.liveBlocks(), 0u) << payload.name << ", " << allocations;
      ASSERT_TRUE(memory.booksBalance());
      if (error == Error::kOk) break;
      ASSERT_EQ(error, Error::kOutOfMemory);
      ASSERT_LT(allocations, 1000u);
    }
  }
}

/// After a block that fails, and in whatever order blocks come, everything is given back.
TEST(DamagedBlocks, GiveBackTheirMemoryAfterAnError) {
  for (const NamedPayload& payload : payloads()) {
    const PayloadHeader header = headerOf(payload.bytes);
    for (size_t b = 0; b < header.blocks.size(); ++b) {
      Bytes damaged = payload.bytes;
      damaged[header.blocks[b].offset_bytes] ^= 1;
      const Bytes other_count = rewritten(payload.bytes, [&](PayloadHeader& h, BlockStreams&) {
        ++h.blocks[b].box.high[1];  // found after the block was decoded
      });
      for (const Bytes& bytes : {damaged, other_count}) {
        for (const RunJobs& hook : {RunJobs(), RunJobs(runBackwards)}) {
          Payload opened;
          ASSERT_TRUE(opened.open(bytes).ok());
          const Targets targets(opened.info().pieces[0]);
          const PieceTarget target = targets.target();
          FailingAllocator memory;
          DecodeOptions options;
          options.allocator = memory.allocator();
          options.run_jobs = runnerOf(hook);
          EXPECT_FALSE(opened.decode({&target, 1}, options).ok()) << payload.name;
          EXPECT_EQ(memory.liveBlocks(), 0u) << payload.name;
          EXPECT_TRUE(memory.booksBalance()) << payload.name;
        }
      }
    }
  }
}

// ---- Work ---------------------------------------------------------------------------------------

/// A payload of as many tiny blocks as its bytes allow, all of them copies of one.
Bytes manyTinyBlocks(uint32_t count) {
  const Bytes few = blocksOf(looseTriangles(40), 10).bytes;
  return rewritten(few, [=](PayloadHeader& header, BlockStreams& streams) {
    const PieceHeader piece = header.pieces[0];
    const BlockHeader row = header.blocks[0];
    const PartInfo part = header.parts[0];
    header.pieces.clear();
    header.parts.clear();
    header.blocks.clear();
    header.exceptions.clear();
    const std::array<Bytes, 3> bytes = streams.bytes[0];
    streams.bytes.assign(count, bytes);
    for (uint32_t i = 0; i < count; ++i) {
      PieceHeader own = piece;
      own.first_part = i;
      BlockHeader own_row = row;
      own_row.first_exception = own_row.exception_count = 0;
      EXPECT_TRUE(header.pieces.push_back(own) && header.parts.push_back(part) &&
                  header.blocks.push_back(own_row));
    }
  });
}

/// The copies of models are what such a payload costs; a block counts 16,384 elements for them.
TEST(DamagedBlocks, ManyTinyBlocksCountTheCopiesOfModels) {
  const Bytes payloads_of_many[] = {manyTinyBlocks(10), manyTinyBlocks(2000),
                                    blocksOf(looseTriangles(1500), 1).bytes};
  for (const Bytes& bytes : payloads_of_many) {
    const bool is_forged = &bytes != &payloads_of_many[2];
    const PayloadHeader header = headerOf(bytes);
    const uint64_t count = header.blocks.size();
    EXPECT_TRUE(is_forged || count > 1000) << count;
    EXPECT_GE(elementsOf(header), count * 16384);
    EXPECT_GE(bytes.size() * 1024, elementsOf(header));
    Payload opened;
    Limits limits;
    limits.max_elements = elementsOf(header);
    ASSERT_TRUE(opened.open(bytes, limits).ok());
    --limits.max_elements;
    Payload other;
    EXPECT_EQ(other.open(bytes, limits).error, Error::kLimit);
    const Targets targets(opened.info().pieces[0]);
    const PieceTarget target = targets.target();
    for (const RunJobs& hook : {RunJobs(), RunJobs(runBackwards)}) {
      CountingAllocator taken;
      DecodeOptions options;
      options.allocator = taken.allocator();
      options.run_jobs = runnerOf(hook);
      EXPECT_TRUE(opened.decode({&target, 1}, options).ok() || is_forged);
      EXPECT_LE(taken.allBytes(), 64 * elementsOf(header)) << count;
      EXPECT_LE(taken.peakBytes(), (uint64_t{4} << 20) + 16 * elementsOf(header)) << count;
    }
  }
}

TEST(DamagedBlocks, MoreTinyBlocksThanTheBytesAllow) {
  const Bytes bytes = manyTinyBlocks(500);
  const PayloadHeader header = headerOf(bytes);
  PayloadHeader prefix{Allocator{}};
  EXPECT_EQ(parsePrefix(bytes, (elementsOf(header) - 1) / 1024, {}, prefix).error, Error::kLimit);
  Limits limits;
  limits.max_pieces = 499;
  Payload opened;
  EXPECT_EQ(opened.open(bytes, limits).error, Error::kLimit);
}

/// All wedges of all blocks are on rims and have the same tuple, or all have others.
TEST(DamagedBlocks, RimsOfManyWedges) {
  for (const bool are_equal : {false, true}) {
    TestMesh mesh = looseTriangles(3000);
    if (are_equal) mesh.positions.assign(mesh.positions.size(), 1.5f);
    EncodeSettings settings;
    settings.block_triangles = 10;
    const MeshPiece piece(mesh, kExactBits);
    const RoundTrip trip = roundTrip(piece.view(), settings);
    EXPECT_EQ(trip.failure, "");
    // With equal tuples each wedge would be an exception.
    EXPECT_EQ(trip.encoded.block_count == 0, are_equal);
  }
}

TEST(DamagedBlocks, BeginningOfAPayloadWithoutBlocks) {
  const TestMesh mesh = looseTriangles(20);
  const MeshPiece piece(mesh, kExactBits);
  const Bytes bytes = roundTrip(piece.view(), {}).encoded.payload;
  Payload payload;
  for (size_t size = 1; size < bytes.size(); ++size) {
    const Status status = payload.openPrefix(std::span(bytes).first(size), bytes.size());
    EXPECT_EQ(status.error, Error::kTruncated) << size;
  }
  EXPECT_TRUE(payload.openPrefix(bytes, bytes.size()).ok());
}

}  // namespace
}  // namespace mcc::test
