// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes a payload that is cut into blocks:
//
//   decode  the stages of a block, from models as block 0 left them; any thread     [A.11.2]
//   number  which of its wedges earlier blocks have; block after block    [A.11.3, A.11.4]
//   store   triangles, and the wedges that are not repeated; any thread             [A.11.4]
#ifndef MCC_READER_DECODE_BLOCKS_H_
#define MCC_READER_DECODE_BLOCKS_H_

#include <atomic>
#include <new>
#include <optional>
#if !defined(__wasm__)  // has no threads
#include <thread>
#endif

#include "base/lazy.h"
#include "base/working_memory.h"
#include "entropy/decoder_io.h"
#include "mesh/rim.h"
#include "reader/decode_piece.h"

namespace mcc {

/// The Io of payloads with three streams.
using BlockIo = std::conditional_t<kCompact, CompactIo, StreamsIo>;

/// A block after its stages, and then with its numbers.
class DecodedBlock {
 public:
  /// Borrows everything. Takes memory from huge pages if `options` has no allocator.
  DecodedBlock(const PayloadHeader& header, uint32_t index, const DecodeOptions& options)
      : options_(options),
        header_(header),
        index_(index),
        infos_(header.attributesOf(header.pieces[index])),
        pages_(expectedBytes(header.pieces[index])),
        allocator_(chooseAllocator()),
        values_(allocator_),
        part_of_face_(allocator_),
        rim_(allocator_),
        numbers_(allocator_) {}

  uint32_t index() const { return index_; }
  const Allocator& allocator() const { return allocator_; }

  /// Runs the stages. The models are used during this call only.
  Status decode(PayloadModels& models, Progress& progress) {
    const BlockHeader& block = header_.blocks[index_];
    if (!header_.isLoaded(block))
      return fail(Error::kTruncated, "the payload ends before the end of a block",
                  header_.header_bytes + header_.streams.codes.size());
    const Streams streams = header_.streamsOf(block);
    if (checksumOf(streams) != block.checksum) {
      return fail(Error::kBadChecksum, "the checksum of a block does not match: it is damaged",
                  block.offset_bytes);
    }
    if (!values_.resize(valuesBefore(static_cast<uint32_t>(infos_.size())))) return noMemory();
    DecodeOptions options = options_;
    options.allocator = allocator_;
    BlockIo io(streams.codes, streams.tokens, streams.raw);
    piece_.emplace(io, models, pieceHeader(), infos_, allocator_);
    MCC_TRY(decodePiece(*piece_, pieceHeader(), infos_, *this, options,
                        StageBits<BlockIo>(io, 0, options), progress));
    return io.finish();
  }

  // decodePiece() calls these two.
  Status surface(const CodedPiece& piece) {
    CodedBox box;
    for (uint32_t s = 0; s < 3; ++s) box.low[s] = INT32_MAX, box.high[s] = INT32_MIN;
    for (uint32_t w = 0; w < pieceHeader().wedge_count; ++w) {
      const int32_t* q = piece.records[piece.groupOf(w)].q;
      for (uint32_t s = 0; s < 3; ++s) {
        values_[3 * size_t{w} + s] = q[s];
        box.low[s] = std::min(box.low[s], q[s]);
        box.high[s] = std::max(box.high[s], q[s]);
      }
    }
    if (box != header_.blocks[index_].box)
      return fail(Error::kBadAttribute, "a block has another box than the header claims");
    if (pieceHeader().part_count == 1) return {};
    if (!part_of_face_.resize(piece.mesh.face_count)) return noMemory();
    for (uint32_t f = 0; f < piece.mesh.face_count; ++f)
      part_of_face_[f] = piece.mesh.words[size_t{f} * kFaceWords + kFaceWord];
    return {};
  }
  Status attribute(const TangentNormals&, uint32_t index, const Array<int32_t>& values) {
    std::copy_n(values.data(), values.size(), values_.data() + valuesBefore(index));
    return {};
  }

  /// Finds the rim and its tuples. Returns false when memory ran out.
  [[nodiscard]] bool findRim() {
    if (!rim_.find(piece_->mesh, pieceHeader().wedge_count)) return false;
    for (uint32_t a = 0; a < infos_.size(); ++a) rim_.tuple_words += wordsOf(a);
    if (rim_.wedges.empty()) return true;
    if (!rim_.tuples.resize(rim_.wedges.size() * rim_.tuple_words)) return false;
    uint32_t column = 0;
    for (uint32_t a = 0; a < infos_.size(); ++a) {
      const uint32_t words = wordsOf(a);
      const int32_t* from = values_.data() + valuesBefore(a);
      int32_t* to = rim_.tuples.data() + column;
      for (size_t i = 0; i < rim_.wedges.size(); ++i, to += rim_.tuple_words)
        std::copy_n(from + size_t{rim_.wedges[i]} * words, words, to);
      column += words;
    }
    return true;
  }

  Rim& rim() { return rim_; }

  /// Numbers the wedges. Must be called block after block.
  Status number(RimTable& table) {
    const BlockHeader& block = header_.blocks[index_];
    uint32_t repeated_count = 0;
    if (!findRim() || !numberWedges(table, rim_, header_.exceptionsOf(block), block.first_wedge,
                                    pieceHeader().wedge_count, numbers_, repeated_count))
      return noMemory();
    if (repeated_count == block.repeated_count) return {};
    return fail(Error::kBadAttribute, "a block repeats another number of wedges than it claims");
  }

  /// Stores the triangles, and the wedges that earlier blocks do not have, where they belong in the
  /// whole piece. `first_triangles` are those of each part before this block.
  Status store(const PieceTarget& target, const uint32_t* first_triangles) {
    Array<AttributeTarget> attributes(allocator_);
    Array<PartTarget> parts(allocator_);
    Array<uint32_t> fresh(allocator_);
    const uint32_t first = header_.blocks[index_].first_wedge;
    const uint32_t fresh_count = pieceHeader().wedge_count - header_.blocks[index_].repeated_count;
    if (!attributes.resize(infos_.size()) || !parts.resize(pieceHeader().part_count) ||
        !fresh.reserve(fresh_count))
      return noMemory();
    for (size_t a = 0; a < attributes.size(); ++a) {
      AttributeTarget& to = attributes[a] = target.attributes[a];
      if (to.data != nullptr) to.data = static_cast<uint8_t*>(to.data) + to.stride_bytes * first;
    }
    for (size_t p = 0; p < parts.size(); ++p) {
      PartTarget& to = parts[p] = target.parts[p];
      const size_t triangle_bytes = 3 * static_cast<size_t>(to.index_type);
      if (to.indices != nullptr)
        to.indices = static_cast<uint8_t*>(to.indices) + triangle_bytes * first_triangles[p];
    }
    for (uint32_t w = 0; w < pieceHeader().wedge_count; ++w) {
      if (numbers_[w] >= first) (void)fresh.push_back(w);  // number() has checked how many
    }
    storeValues({fresh.data(), fresh_count}, {attributes.data(), attributes.size()});
    const auto number = [this](uint32_t wedge) { return numbers_[wedge]; };
    MCC_TRY(storeParts({parts.data(), parts.size()}, number));
    if constexpr (kTellsMcEdges) tellMcEdges(*piece_, 0, number, options_);
    return {};
  }

  /// Stores the block alone: all its wedges, in its own numbers.
  Status storeAlone(const PieceTarget& target) {
    storeValues({nullptr, pieceHeader().wedge_count}, target.attributes);
    return storeParts(target.parts, [](uint32_t wedge) { return wedge; });
  }

 private:
  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for a block"); }

  /// Stands for WorkingMemory in compact code, which has no huge pages.
  struct NoPages {
    explicit NoPages(uint64_t) {}
    static Allocator allocator() { return {}; }
  };

  Allocator chooseAllocator() {
    const uint64_t expected_bytes = expectedBytes(pieceHeader());
    const bool pays =
        !kCompact && isHeap(options_.allocator) && WorkingMemory::pays(expected_bytes);
    return pays ? pages_.allocator() : options_.allocator;
  }
  const PieceHeader& pieceHeader() const { return header_.pieces[index_]; }

  /// Returns the integers that a wedge has for an attribute; 0 if another attribute holds them.
  uint32_t wordsOf(uint32_t a) const {
    if (a == 0) return 3;
    return isWithAnother(methodOf(infos_, a)) ? 0 : codedComponents(infos_, a);
  }
  /// Returns where the values of an attribute begin: those of all wedges, attribute by attribute.
  size_t valuesBefore(uint32_t index) const {
    size_t words = 0;
    for (uint32_t a = 0; a < index; ++a) words += wordsOf(a);
    return words * pieceHeader().wedge_count;
  }

  void storeValues(WedgeAt wedge_at, std::span<const AttributeTarget> targets) {
    const TangentNormals normals = piece_->tangentNormals();
    for (uint32_t a = 0; a < infos_.size(); ++a) {
      const int32_t* values = values_.data() + valuesBefore(a);
      if (a == 0) {
        storeAttribute(normals, infos_, 0, values, 3, wedge_at, targets);
      } else if (wordsOf(a) != 0) {
        storeDecoded(normals, infos_, a, values, wedge_at, targets);
      }
    }
  }
  template <class Number>
  Status storeParts(std::span<const PartTarget> targets, const Number& number) {
    const PieceHeader& piece = pieceHeader();
    const auto part_of = [this](uint32_t f) { return part_of_face_[f]; };
    return storeSurface(*piece_, {header_.parts.data() + piece.first_part, piece.part_count},
                        targets, number, part_of, allocator_);
  }

  const DecodeOptions& options_;
  const PayloadHeader& header_;
  const uint32_t index_;
  const AttributeInfos infos_;
  std::conditional_t<kCompact, NoPages, WorkingMemory> pages_;
  const Allocator allocator_;
  std::optional<PieceCoder<BlockIo>> piece_;
  Array<int32_t> values_;         ///< of all attributes, see valuesBefore()
  Array<uint32_t> part_of_face_;  ///< only with several parts
  Rim rim_;
  Array<uint32_t> numbers_;  ///< by wedge
};

/// Creates and destroys large objects in memory of an allocator.
template <class T>
class Placed {
 public:
  explicit Placed(const Allocator& allocator) : allocator_(allocator) {}
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;
  ~Placed() {
    if (made_ != nullptr) made_->~T();
    releaseBytes(allocator_, made_, sizeof(T));
  }
  /// Returns null when memory ran out.
  template <class... Arguments>
  T* make(Arguments&&... arguments) {
    void* memory = allocateBytes(allocator_, sizeof(T));
    if (memory != nullptr) made_ = new (memory) T(std::forward<Arguments>(arguments)...);
    return made_;
  }
  T* get() const { return made_; }

 private:
  const Allocator allocator_;
  T* made_ = nullptr;
};

/// Decodes a block with models that are made in `models`. They begin as `primed`, or as those of
/// every payload if that is null.
inline Status runBlock(DecodedBlock& block, const PayloadModels* primed,
                       Placed<PayloadModels>& models, Progress& progress) {
  if (models.make() == nullptr ||
      (primed != nullptr && !models.get()->copyFrom(*primed, block.allocator())))
    return fail(Error::kOutOfMemory, "no memory for the models");
  return block.decode(*models.get(), progress);
}

/// Decodes all blocks of a payload. Threads that have decoded a block number and store all blocks
/// whose turn has come, so that none waits for another.
class BlocksDecoder {
 public:
  BlocksDecoder(const PayloadHeader& header, const PieceTarget& target,
                const DecodeOptions& options)
      : header_(header),
        target_(target),
        options_(options),
        progress_(options, header),
        primed_(options.allocator),
        table_(options.allocator),
        first_triangles_(options.allocator),
        decoded_(options.allocator),
        statuses_(options.allocator) {}
  ~BlocksDecoder() {
    for (size_t i = 0; i < decoded_.size(); ++i) drop(decoded_[i]);
  }

  Status run() {
    const size_t count = header_.blocks.size();
    if (primed_.make() == nullptr || !listFirstTriangles() || !decoded_.assign(count, nullptr) ||
        !statuses_.assign(count, Status{}))
      return noMemory();
    decode(0);
    const bool is_watched = options_.histogram != nullptr || options_.mc_edge != nullptr ||
                            options_.stage_bits != nullptr;
    const auto job = [](void* self, size_t i) {
      auto* decoder = static_cast<BlocksDecoder*>(self);
      if (kCompact || i + 1 < decoder->decoded_.size())
        decoder->decode(static_cast<uint32_t>(i + 1));
    };
    if (options_.run_jobs.run != nullptr && !is_watched) {
      options_.run_jobs.run(options_.run_jobs.user, count - 1, job, this);
      if (!kCompact && first_failed_ == kNone && next_ < count)
        return fail(Error::kBadArgument, "run_jobs returned before all jobs had ended");
    } else {
      for (size_t i = 0; i + 1 < count; ++i) job(this, i);
    }
    return first_failed_ == kNone ? Status{} : statuses_[first_failed_];
  }

 private:
  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for the blocks"); }

  /// Others hold the lock for some instructions only, unless the system has interrupted them: then
  /// they need the processor that waiting would take.
  void lock() {
    while (is_locked_.test_and_set(std::memory_order_acquire)) {
#if !defined(__wasm__)
      std::this_thread::yield();
#endif
    }
  }
  void unlock() { is_locked_.clear(std::memory_order_release); }

  /// Finds where the triangles of each part of each block begin in the whole part.
  bool listFirstTriangles() {
    if (!first_triangles_.resize(header_.parts.size())) return false;
    const uint32_t part_count = header_.pieces[0].part_count;
    for (size_t i = 0; i < header_.parts.size(); ++i) {
      first_triangles_[i] = i < part_count ? 0
                                           : first_triangles_[i - part_count] +
                                                 header_.parts[i - part_count].triangle_count;
    }
    return true;
  }

  DecodedBlock* make(uint32_t index) {
    void* memory = allocateBytes(options_.allocator, sizeof(DecodedBlock));
    return memory == nullptr ? nullptr : new (memory) DecodedBlock(header_, index, options_);
  }
  void drop(DecodedBlock* block) {
    if (block == nullptr) return;
    block->~DecodedBlock();
    releaseBytes(options_.allocator, block, sizeof(DecodedBlock));
  }

  /// Decodes a block, unless one before it has failed: the first that fails says what is wrong.
  void decode(uint32_t index) {
    if (first_failed_ < index) return;
    DecodedBlock* block = make(index);
    const Status status = block == nullptr ? noMemory() : decodeStages(*block);
    if (status.ok()) return passOn(block);
    drop(block);
    failAt(index, status);
  }

  Status decodeStages(DecodedBlock& block) {
    const bool is_first = block.index() == 0;
    Placed<PayloadModels> models(options_.allocator);
    MCC_TRY(runBlock(block, is_first ? nullptr : primed_.get(), models, progress_));
    if (!is_first || primed_.get()->copyFrom(*models.get(), options_.allocator)) return {};
    return noMemory();
  }

  void failAt(uint32_t index, const Status& status) {
    lock();
    statuses_[index] = status;
    if (index < first_failed_) first_failed_ = index;
    unlock();
  }

  /// Numbers and stores blocks as long as it is somebody's turn.
  void passOn(DecodedBlock* decoded) {
    lock();
    decoded_[decoded->index()] = decoded;
    while (!is_numbering_ && next_ < decoded_.size() && decoded_[next_] != nullptr) {
      DecodedBlock* block = std::exchange(decoded_[next_], nullptr);
      is_numbering_ = true;
      unlock();
      Status status = block->number(table_);
      lock();
      if (status.ok()) {  // otherwise no block after it has its turn
        is_numbering_ = false;
        ++next_;
      }
      unlock();
      if (status.ok()) {
        const PieceHeader& piece = header_.pieces[block->index()];
        status = block->store(target_, first_triangles_.data() + piece.first_part);
      }
      if (!status.ok()) failAt(block->index(), status);
      drop(block);
      lock();
    }
    unlock();
  }

  const PayloadHeader& header_;
  const PieceTarget& target_;
  const DecodeOptions& options_;
  Progress progress_;
  Placed<PayloadModels> primed_;  ///< as block 0 left them
  RimTable table_;
  Array<uint32_t> first_triangles_;  ///< in its part, for each part of each block
  std::atomic<uint32_t> first_failed_ = kNone;
  std::atomic_flag is_locked_;    ///< for what follows
  Array<DecodedBlock*> decoded_;  ///< blocks that wait for their turn
  Array<Status> statuses_;
  uint32_t next_ = 0;  ///< the block whose turn it is
  bool is_numbering_ = false;
};

}  // namespace mcc

#endif  // MCC_READER_DECODE_BLOCKS_H_
