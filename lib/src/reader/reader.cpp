// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reader: parses the header, runs every piece or block through its stages (piece.h), and stores
// floats and indices in the caller's memory.
#include "mcc/reader.h"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

#include "base/caller_memory.h"
#include "base/memory.h"
#include "base/working_memory.h"
#include "container/payload_header.h"
#include "entropy/decoder_io.h"
#include "format/decodes.h"
#include "reader/decode_blocks.h"
#include "reader/decode_piece.h"
#include "reader/outputs.h"
#include "reader/starts.h"

namespace mcc {

struct Payload::State {
  explicit State(const Allocator& a)
      : allocator(a), header(a), pieces(a), blocks(a), whole_parts(a), primed(a) {}

  Status listPieces();
  Status listBlocks();
  Status decodeBlock(uint32_t index, const PieceTarget* target, const PayloadModels* from,
                     PayloadModels* left, const DecodeOptions& options) const;

  Allocator allocator;
  PayloadHeader header;
  Array<PieceInfo> pieces;
  Array<BlockInfo> blocks;
  Array<PartInfo> whole_parts;  ///< of the piece that is cut into the blocks
  uint64_t payload_bytes = 0;
  Placed<PayloadModels> primed;  ///< as block 0 left them, see prime()
  PayloadInfo info;
};

namespace {

const PayloadInfo kEmptyInfo{};

/// Checks a target for a piece, or for a block of it.
Status checkTarget(const PieceTarget& target, const PieceInfo& piece, uint32_t wedge_count) {
  if (target.attributes.size() != piece.attributes.size() ||
      target.parts.size() != piece.parts.size()) {
    return fail(Error::kBadArgument, "a target does not have the shape of its piece");
  }
  for (size_t a = 0; a < piece.attributes.size(); ++a) {
    const AttributeTarget& t = target.attributes[a];
    if (t.data != nullptr && t.stride_bytes < elementBytes(piece.attributes[a].format)) {
      return fail(Error::kBadArgument, "the stride of a target is smaller than its elements");
    }
  }
  for (const PartTarget& t : target.parts) {
    const uint32_t bits = 8 * static_cast<uint32_t>(t.index_type);
    if (bits < 32 && wedge_count > (1u << bits)) {
      return fail(Error::kBadArgument, "the index type of a target is too narrow");
    }
  }
  return {};
}

/// Checks that a target is where memory can be, with one of the three types of indices. Compact
/// code has targets of its own only.
[[maybe_unused]] Status checkPlaces(const PieceTarget& target, const PieceInfo& piece,
                                    uint32_t wedge_count, std::span<const PartInfo> parts) {
  for (size_t a = 0; a < piece.attributes.size(); ++a) {
    const AttributeTarget& t = target.attributes[a];
    const uint32_t bytes = elementBytes(piece.attributes[a].format);
    if (t.data != nullptr && !canBeInMemory(t.data, wedge_count, t.stride_bytes, bytes))
      return fail(Error::kBadArgument, "the stride of a target leads out of memory");
  }
  for (size_t p = 0; p < parts.size(); ++p) {
    const void* const indices = target.parts[p].indices;
    const auto bytes = static_cast<uint32_t>(target.parts[p].index_type);
    if (bytes != 1 && bytes != 2 && bytes != 4)
      return fail(Error::kBadArgument, "the indices of a target are not of 1, 2 or 4 bytes");
    const uint64_t count = 3 * uint64_t{parts[p].triangle_count};
    if (indices != nullptr && !canBeInMemory(indices, count, bytes, bytes))
      return fail(Error::kBadArgument, "the indices of a target lead out of memory");
  }
  return {};
}

[[maybe_unused]] Status checkTargets(const PayloadInfo& info,
                                     std::span<const PieceTarget> targets) {
  if (targets.size() != info.pieces.size()) {
    return fail(Error::kBadArgument, "the number of targets is not the number of pieces");
  }
  for (size_t i = 0; i < targets.size(); ++i) {
    const PieceInfo& piece = info.pieces[i];
    MCC_TRY(checkTarget(targets[i], piece, piece.wedge_count));
    MCC_TRY(checkPlaces(targets[i], piece, piece.wedge_count, piece.parts));
  }
  return {};
}

/// Stores a piece as it is decoded. See decodePiece().
struct PieceSink {
  const PieceInfo& info;
  uint32_t index;
  const PieceTarget& target;
  const DecodeOptions& options;
  const CodedPiece& piece;

  Status surface(const CodedPiece&) const {
    if (!info.attributes.empty())
      storePositions(piece, info.attributes[0], info.wedge_count, target.attributes[0]);
    MCC_TRY(storeTriangles(piece, info.parts, target.parts, options.allocator));
    if (!kTellsMcEdges || options.mc_edge == nullptr) return {};
    Array<uint32_t> place_of(options.allocator);
    MCC_TRY(findPlaces(piece, place_of));
    tellMcEdges(
        piece, index, [&](uint32_t w) { return place_of.empty() ? w : place_of[w]; }, options);
    return {};
  }
  Status attribute(const TangentNormals& normals, uint32_t a, const Array<int32_t>& values) const {
    storeDecoded(normals, info.attributes, a, values.data(), wedgeAt(piece, info.wedge_count),
                 target.attributes);
    return {};
  }
};

template <class Io>
Status decodePieces(Io& io, const PayloadHeader& header, const PayloadInfo& info,
                    std::span<const PieceTarget> targets, const DecodeOptions& options) {
  Placed<PayloadModels> models(options.allocator);
  if (models.make() == nullptr) return fail(Error::kOutOfMemory, "no memory for the models");
  if (header.startsTrained() &&
      !startTrained(*models.get(), header.attributes.size() > 1, options.allocator)) {
    return fail(Error::kOutOfMemory, "no memory for the models");
  }
  Progress progress(options, header);
  for (uint32_t i = 0; i < targets.size(); ++i) {
    const AttributeInfos infos = info.pieces[i].attributes;
    PieceCoder<Io> piece(io, *models.get(), header.pieces[i], infos, options.allocator);
    PieceSink sink{info.pieces[i], i, targets[i], options, piece};
    MCC_TRY(decodePiece(piece, header.pieces[i], infos, sink, options,
                        StageBits<Io>(io, i, options), progress));
  }
  return io.finish();
}

void prepareTables() {
  AdaptationTable::prepare();
  InitialRowTable::prepare();
}

Status decodeAll(const PayloadHeader& header, const PayloadInfo& info,
                 std::span<const PieceTarget> targets, const DecodeOptions& options) {
  const Streams& streams = header.streams;
  const auto decode = [&](auto&& io) { return decodePieces(io, header, info, targets, options); };
#if defined(MCC_COMPACT)
  return decode(CompactIo(streams.codes, streams.tokens, streams.raw, header.singleCoder()));
#else
  if (header.singleCoder()) return decode(CompactIo(streams.codes, {}, {}));
  return decode(StreamsIo(streams.codes, streams.tokens, streams.raw));
#endif
}

/// Estimates the memory that the largest piece takes at any time.
[[maybe_unused]] uint64_t largestExpectedBytes(const PayloadHeader& header) {
  uint64_t most = 0;
  for (size_t i = 0; i < header.pieces.size(); ++i)
    most = std::max(most, expectedBytes(header.pieces[i]));
  return most;
}

PieceInfo infoOf(const PayloadHeader& header, const PieceHeader& p) {
  PieceInfo info;
  info.wedge_count = p.wedge_count;
  info.vertex_count = p.vertex_count;
  info.surface = p.surface();
  info.attributes = header.attributesOf(p);
  info.parts = {header.parts.data() + p.first_part, p.part_count};
  info.keeps_vertex_order = p.has(piece_flag::kVertexOrder);
  info.keeps_triangle_order = p.has(piece_flag::kTriangleOrder);
  return info;
}

/// Returns coded positions in the units of the accessor.
float positionValue(const AttributeInfo& info, uint32_t axis, int32_t q) {
  if (info.coding == AttributeCoding::kLattice)
    return latticeValue(q, info.lattice.step, info.lattice.origin[axis]);
  if (info.coding == AttributeCoding::kInteger) return static_cast<float>(q);
  return std::bit_cast<float>(bitsFromOrdered(q));
}

BlockInfo infoOf(const PayloadHeader& header, size_t index) {
  const BlockHeader& block = header.blocks[index];
  const PieceHeader& piece = header.pieces[index];
  BlockInfo info;
  info.wedge_count = piece.wedge_count;
  info.repeated_count = block.repeated_count;
  info.triangle_count = static_cast<uint32_t>(piece.triangleCount());
  info.parts = {header.parts.data() + piece.first_part, piece.part_count};
  info.offset_bytes = block.offset_bytes;
  info.stream_bytes = block.streamBytes();
  for (uint32_t s = 0; s < 3; ++s) {
    info.low[s] = positionValue(header.attributes[0], s, block.box.low[s]);
    info.high[s] = positionValue(header.attributes[0], s, block.box.high[s]);
  }
  return info;
}

}  // namespace

Status Payload::State::listPieces() {
  if (!pieces.reserve(header.pieces.size()))
    return fail(Error::kOutOfMemory, "no memory for the header");
  for (size_t i = 0; i < header.pieces.size(); ++i)
    (void)pieces.push_back(infoOf(header, header.pieces[i]));  // reserved above
  return {};
}

/// Sums up the blocks to the piece that the caller sees.
Status Payload::State::listBlocks() {
  const size_t count = header.blocks.size();
  PieceInfo whole = infoOf(header, header.pieces[0]);
  if (!pieces.reserve(1) || !blocks.reserve(count) ||
      !whole_parts.assign(whole.parts.size(), PartInfo{}))
    return fail(Error::kOutOfMemory, "no memory for the header");
  whole.wedge_count = whole.vertex_count = 0;
  for (size_t i = 0; i < count; ++i) {
    const PieceHeader& piece = header.pieces[i];
    (void)blocks.push_back(infoOf(header, i));  // reserved above
    whole.wedge_count += piece.wedge_count - header.blocks[i].repeated_count;
    whole.vertex_count += piece.vertex_count;
    whole.surface = std::max(whole.surface, piece.surface());
    for (uint32_t p = 0; p < piece.part_count; ++p)
      whole_parts[p].triangle_count += header.parts[piece.first_part + p].triangle_count;
  }
  whole.parts = {whole_parts.data(), whole_parts.size()};
  whole.blocks = {blocks.data(), count};
  (void)pieces.push_back(whole);
  return {};
}

/// Decodes one block, see BlocksDecoder; stores it if `target` is not null.
Status Payload::State::decodeBlock(uint32_t index, const PieceTarget* target,
                                   const PayloadModels* from, PayloadModels* left,
                                   const DecodeOptions& options) const {
  const uint32_t wedge_count = header.pieces[index].wedge_count;
  if (target != nullptr) MCC_TRY(checkTarget(*target, pieces[0], wedge_count));
  if constexpr (!kCompact) {
    if (target != nullptr)
      MCC_TRY(checkPlaces(*target, pieces[0], wedge_count, blocks[index].parts));
  }
  prepareTables();
  Progress progress(options, header);
  DecodedBlock block(header, index, options);
  Placed<PayloadModels> models(options.allocator);
  MCC_TRY(runBlock(block, from, models, progress));
  if (left != nullptr && !left->copyFrom(*models.get(), allocator))
    return fail(Error::kOutOfMemory, "no memory for the models");
  return target == nullptr ? Status{} : block.storeAlone(*target);
}

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
  return openPrefix(bytes, bytes.size(), limits, allocator);
}

Status Payload::openPrefix(std::span<const uint8_t> bytes, uint64_t payload_bytes,
                           const Limits& limits, const Allocator& allocator) {
  *this = Payload();
  void* memory = allocateBytes(allocator, sizeof(State));
  if (memory == nullptr) return fail(Error::kOutOfMemory, "no memory for the header");
  Payload opened;
  opened.state_ = new (memory) State(allocator);
  State& state = *opened.state_;
  PayloadHeader& header = state.header;
  MCC_TRY(parsePrefix(bytes, payload_bytes, limits, header));
  state.payload_bytes = payload_bytes;
  MCC_TRY(header.hasBlocks() ? state.listBlocks() : state.listPieces());
  state.info.version_major = kVersionMajor;
  state.info.version_minor = header.version_minor;
  state.info.single_coder = header.singleCoder();
  state.info.pieces = {state.pieces.data(), state.pieces.size()};
  state.info.codes_bytes = header.streams.codes.size();
  state.info.tokens_bytes = header.streams.tokens.size();
  state.info.raw_bits_bytes = header.streams.raw.size();
  if (header.hasBlocks()) {
    state.info.codes_bytes = 0;
    for (size_t i = 0; i < header.blocks.size(); ++i) {
      state.info.codes_bytes += header.blocks[i].codes_bytes;
      state.info.tokens_bytes += header.blocks[i].tokens_bytes;
      state.info.raw_bits_bytes += header.blocks[i].raw_bytes;
    }
  }
  state.info.header_bytes = header.header_bytes;
  *this = std::move(opened);
  return {};
}

const PayloadInfo& Payload::info() const { return state_ == nullptr ? kEmptyInfo : state_->info; }

Status Payload::extend(std::span<const uint8_t> bytes) {
  if (state_ == nullptr) return fail(Error::kBadArgument, "no payload is open");
  if (!state_->header.hasBlocks()) return {};  // it was complete
  PayloadHeader& header = state_->header;
  if (bytes.size() > state_->payload_bytes ||
      bytes.size() < header.header_bytes + header.streams.codes.size())
    return fail(Error::kBadArgument, "these are fewer bytes than before, or too many");
  header.streams.codes = bytes.subspan(header.header_bytes);
  return {};
}

uint32_t Payload::loadedBlockCount() const {
  if (!decodes::kBlocks || state_ == nullptr) return 0;
  const PayloadHeader& header = state_->header;
  const BlockHeader* const begin = header.blocks.data();
  return static_cast<uint32_t>(
      std::partition_point(begin, begin + header.blocks.size(),
                           [&](const BlockHeader& block) { return header.isLoaded(block); }) -
      begin);
}

Status Payload::prime(const PieceTarget* target, const DecodeOptions& options) {
  if (!decodes::kBlocks || state_ == nullptr || !state_->header.hasBlocks())
    return fail(Error::kBadArgument, "no payload with blocks is open");
  if (state_->primed.get() == nullptr && state_->primed.make() == nullptr)
    return fail(Error::kOutOfMemory, "no memory for the models");
  return state_->decodeBlock(0, target, nullptr, state_->primed.get(), options);
}

Status Payload::decodeBlock(uint32_t block, const PieceTarget& target,
                            const DecodeOptions& options) const {
  if (!decodes::kBlocks || state_ == nullptr || block >= state_->header.blocks.size())
    return fail(Error::kBadArgument, "there is no such block");
  const PayloadModels* const primed = state_->primed.get();
  if (block != 0 && primed == nullptr)
    return fail(Error::kBadArgument, "blocks after the first need prime()");
  return state_->decodeBlock(block, &target, block == 0 ? nullptr : primed, nullptr, options);
}

Status Payload::decode(std::span<const PieceTarget> targets, const DecodeOptions& options) const {
  if (state_ == nullptr) return fail(Error::kBadArgument, "no payload is open");
  if constexpr (!kCompact) MCC_TRY(checkTargets(state_->info, targets));  // else they are ours
  prepareTables();
  if constexpr (decodes::kBlocks) {
    if (state_->header.hasBlocks()) return BlocksDecoder(state_->header, targets[0], options).run();
  }
  if constexpr (!kCompact) {  // compact code has no huge pages
    const uint64_t expected_bytes = largestExpectedBytes(state_->header);
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
