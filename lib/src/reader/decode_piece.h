// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes a piece, stage by stage. [A.2.7]
#ifndef MCC_READER_DECODE_PIECE_H_
#define MCC_READER_DECODE_PIECE_H_

#include <algorithm>
#include <atomic>

#include "reader/instances.h"
#include "reader/outputs.h"
#include "reader/piece.h"

namespace mcc {

/// Reports to the caller how many elements [A.2.6] are done. Threads may share it.
class Progress {
 public:
  Progress(const DecodeOptions& options, const PayloadHeader& header) : options_(options) {
    if (kCompact || options.progress == nullptr) return;
    all_ = elementsOf(header);
    if (header.hasBlocks()) all_ -= kElementsPerBlock * header.pieces.size();  // not told of
  }

  /// Returns an error if the caller asks to stop. The caller is told by one thread at a time, which
  /// also tells what others have done meanwhile.
  Status advance(uint64_t elements) {
    if (kCompact || options_.progress == nullptr) return {};
    done_ += elements;
    uint64_t told = ~done_;
    while (!is_cancelled_ && told != done_ && !is_telling_.test_and_set()) {
      told = done_;
      const double share = all_ == 0 ? 1 : static_cast<double>(told) / static_cast<double>(all_);
      if (!options_.progress(options_.progress_user, share)) is_cancelled_ = true;
      is_telling_.clear();
    }
    return is_cancelled_ ? cancelled() : Status{};
  }

 private:
  static Status cancelled() { return fail(Error::kCancelled, "decoding was cancelled"); }

  const DecodeOptions& options_;
  uint64_t all_ = 0;
  std::atomic<uint64_t> done_ = 0;
  std::atomic_flag is_telling_;
  std::atomic<bool> is_cancelled_ = false;
};

/// Reports to the caller what the stages of a piece read.
template <class Io>
class StageBits {
 public:
  StageBits(const Io& io, uint32_t piece, const DecodeOptions& options)
      : io_(io), piece_(piece), options_(options), last_(now()) {}

  void tell(DecodeStage stage, uint32_t attribute = 0) {
    if (kCompact || options_.stage_bits == nullptr) return;
    const uint64_t bits = now();
    // Counts are exact to one bit only, so a stage that reads nothing may seem to give some back.
    const uint64_t spent = bits > last_ ? bits - last_ : 0;
    last_ = std::max(last_, bits);
    options_.stage_bits(options_.stage_bits_user, piece_, stage, attribute, spent);
  }

 private:
  uint64_t now() const { return kCompact || options_.stage_bits == nullptr ? 0 : io_.spentBits(); }

  const Io& io_;
  const uint32_t piece_;
  const DecodeOptions& options_;
  uint64_t last_;
};

/// Decodes a piece and hands what it consists of to `sink`, which stores it:
///
///   surface(piece)                    after the surface and its positions, before the attributes
///   attribute(normals, index, values) after codeAttribute(); see TangentNormals
template <class Io, class Sink>
Status decodePiece(PieceCoder<Io>& piece, const PieceHeader& header, AttributeInfos infos,
                   Sink& sink, const DecodeOptions& options, StageBits<Io> bits,
                   Progress& progress) {
  const PieceTruth nothing;
  MCC_TRY(piece.codeConnectivity(nothing, options.histogram, options.mc_edge != nullptr));
  bits.tell(DecodeStage::kConnectivity);
  MCC_TRY(progress.advance(header.operation_count));
  MCC_TRY(piece.codeStitch(nothing));
  bits.tell(DecodeStage::kStitching);
  MCC_TRY(progress.advance(header.vertex_count));
  MCC_TRY(piece.codePositions(nothing));
  bits.tell(DecodeStage::kPositions);
  if (!infos.empty()) MCC_TRY(progress.advance(attributeElements(header, infos[0].format)));
  MCC_TRY(piece.codeSeams(nothing));
  bits.tell(DecodeStage::kSeams);
  MCC_TRY(piece.codeLeftovers(nothing));
  bits.tell(DecodeStage::kLeftovers);
  MCC_TRY(piece.codeOrders(nothing));
  bits.tell(DecodeStage::kOrders);
  MCC_TRY(sink.surface(piece));
  MCC_TRY(progress.advance(surfaceElements(header) - header.operation_count - header.vertex_count));
  Array<int32_t> values(options.allocator);
  MCC_TRY(piece.prepareAttributes());
  for (uint32_t phase = 0; phase < kCodingPhases; ++phase) {
    for (uint32_t a = 1; a < infos.size(); ++a) {
      if (codingPhase(infos[a]) != phase) continue;
      if (!isWithAnother(methodOf(infos, a))) {
        MCC_TRY(piece.codeAttribute(a, values));
        MCC_TRY(sink.attribute(piece.tangentNormals(), a, values));
      }
      bits.tell(DecodeStage::kAttribute, a);
      MCC_TRY(progress.advance(attributeElements(header, infos[a].format)));
    }
  }
  return {};
}

/// Estimates the memory that a piece takes at any time.
inline uint64_t expectedBytes(const PieceHeader& piece) {
  uint64_t bytes = uint64_t{piece.face_count} * kFaceWords * sizeof(uint32_t) +
                   uint64_t{piece.vertex_count} * sizeof(VertexRecord);
  if (piece.attribute_count > 1) bytes += uint64_t{piece.wedge_count} * 48;
  return bytes;
}

}  // namespace mcc

#endif  // MCC_READER_DECODE_PIECE_H_
