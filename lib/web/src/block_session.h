// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_WEB_BLOCK_SESSION_H_
#define MCC_WEB_BLOCK_SESSION_H_

// A part of decoder.cpp, as session.h is.
#include <algorithm>
#include <bit>
#include <optional>

#include "container/payload_header.h"
#include "reader/decode_blocks.h"
#include "session.h"

namespace mcc {
namespace {

/// A payload of which blocks are decoded or numbered.
class BlockSession {
 public:
  /// `bytes` must outlive it. Of what comes after the header, only the streams of block 0 and of a
  /// block that is decoded need to be there, at the time when it is.
  Status open(std::span<const uint8_t> bytes, uint64_t payload_bytes, const Limits& limits) {
    MCC_TRY(session.payload.openPrefix(bytes, payload_bytes, limits));
    if (session.payload.info().pieces[0].blocks.empty())
      return fail(Error::kBadHeader, "the payload has no blocks");
    MCC_TRY(parsePrefix(bytes, payload_bytes, limits, header_));
    MCC_TRY(session.describe());
    return listBlocks();
  }

  const uint32_t* words() const { return words_.data(); }

  /// Decodes a block for itself, and primes the models first if that has not been done. Every block
  /// but the first takes the bytes of both.
  Status decode(uint32_t index, IndexType widest_short, bool finds_rim) {
    if (index >= header_.blocks.size()) return fail(Error::kBadArgument, "there is no such block");
    AdaptationTable::prepare();
    InitialRowTable::prepare();
    if (index != 0 && primed_.get() == nullptr) {
      DecodedBlock first(header_, 0, options_);
      MCC_TRY(run(first));
    }
    DecodedBlock block(header_, index, options_);
    MCC_TRY(run(block));
    const PieceInfo& whole = session.payload.info().pieces[0];
    const BlockInfo& info = whole.blocks[index];
    piece_ = whole;
    piece_.wedge_count = info.wedge_count;
    piece_.parts = info.parts;
    session.block = &piece_;
    session.outputs.clear();
    MCC_TRY(session.describe());
    MCC_TRY(session.placeOutputs(widest_short));
    MCC_TRY(block.storeAlone(session.pieces[0]));
    if (!finds_rim) return {};
    if (!block.findRim()) return noMemory();
    rim_.wedges.swap(block.rim().wedges);
    rim_.tuples.swap(block.rim().tuples);
    rim_.tuple_words = block.rim().tuple_words;
    return {};
  }

  const Rim& rim() const { return rim_; }

  /// Numbers the wedges of the next block, whose rim decode() has found elsewhere.
  Status number(std::span<const uint32_t> wedges, std::span<const int32_t> tuples) {
    if (next_ >= header_.blocks.size()) return fail(Error::kBadArgument, "there is no such block");
    const BlockHeader& block = header_.blocks[next_];
    const uint32_t wedge_count = header_.pieces[next_].wedge_count;
    const size_t words = wedges.empty() ? 0 : tuples.size() / wedges.size();
    if (words * wedges.size() != tuples.size() ||
        (next_ != 0 && words != 0 && words != tuple_words_))
      return fail(Error::kBadArgument, "a rim has tuples of another size");
    for (size_t i = 0; i < wedges.size(); ++i) {
      if (wedges[i] >= wedge_count || (i != 0 && wedges[i] <= wedges[i - 1]))
        return fail(Error::kBadArgument, "rim wedges must ascend");
    }
    if (!rim_.wedges.resize(wedges.size()) || !rim_.tuples.resize(tuples.size())) return noMemory();
    std::copy(wedges.begin(), wedges.end(), rim_.wedges.data());
    std::copy(tuples.begin(), tuples.end(), rim_.tuples.data());
    if (words != 0) rim_.tuple_words = tuple_words_ = static_cast<uint32_t>(words);
    uint32_t repeated_count = 0;
    if (!numberWedges(table_, rim_, header_.exceptionsOf(block), block.first_wedge, wedge_count,
                      numbers_, repeated_count))
      return noMemory();
    if (repeated_count != block.repeated_count)
      return fail(Error::kBadAttribute, "a block repeats another number of wedges than it claims");
    ++next_;
    return {};
  }

  /// Those of the block that was numbered last, by wedge.
  const uint32_t* numbers() const { return numbers_.data(); }

 private:
  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for a block"); }

  Status listBlocks() {
    constexpr size_t kBlockWords = 11;
    const std::span<const BlockInfo> blocks = session.payload.info().pieces[0].blocks;
    if (!words_.reserve(2 + kBlockWords * blocks.size())) return noMemory();
    add(header_.header_bytes);
    add(blocks.size());
    for (const BlockInfo& block : blocks) {
      add(block.wedge_count);
      add(block.repeated_count);
      add(block.triangle_count);
      add(block.offset_bytes);
      add(block.stream_bytes);
      for (const float low : block.low) add(std::bit_cast<uint32_t>(low));
      for (const float high : block.high) add(std::bit_cast<uint32_t>(high));
    }
    return {};
  }
  /// Cannot fail, because the words were reserved.
  void add(uint64_t word) { (void)words_.push_back(static_cast<uint32_t>(word)); }

  /// Runs the stages of a block. The first one leaves the models with which all others begin.
  Status run(DecodedBlock& block) {
    const bool is_first = block.index() == 0;
    Progress progress(options_, header_);
    models_.emplace(options_.allocator);
    MCC_TRY(runBlock(block, is_first ? nullptr : primed_.get(), *models_, progress));
    if (!is_first || primed_.get() != nullptr) return {};
    if (primed_.make() == nullptr || !primed_.get()->copyFrom(*models_->get(), options_.allocator))
      return noMemory();
    return {};
  }

  DecodeOptions options_;
  PayloadHeader header_{options_.allocator};
  Placed<PayloadModels> primed_{options_.allocator};
  std::optional<Placed<PayloadModels>> models_;  ///< of the block that was decoded last
  Array<uint32_t> words_;
  PieceInfo piece_;  ///< the block that was decoded last, as a piece
  Rim rim_{options_.allocator};
  RimTable table_{options_.allocator};
  uint32_t tuple_words_ = 0;
  uint32_t next_ = 0;
  Array<uint32_t> numbers_;
};

std::optional<BlockSession> blocks;

}  // namespace
}  // namespace mcc

#endif  // MCC_WEB_BLOCK_SESSION_H_
