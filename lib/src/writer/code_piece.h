// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs the stages of a piece or block on the real coder, as its plan says.
#ifndef MCC_WRITER_CODE_PIECE_H_
#define MCC_WRITER_CODE_PIECE_H_

#include "mesh/rim.h"
#include "writer/stages.h"

namespace mcc {

/// Codes the piece and adds what it cost to `result.sizes`, and what the caller is told of it to
/// `result.pieces`. `rim`, if not null, receives the rim wedges of a block, without tuples.
/// first_attribute  is the number of attributes of the payload before this piece's
Status codePiece(Plan& plan, EncoderIo& io, StageModels& models, size_t first_attribute,
                 EncodeResult& result, Rim* rim = nullptr);

/// Adds a piece to the header of its payload.
void addPiece(Plan& plan, PayloadHeader& header);

/// Completes the sizes, of which the coders have counted `coded_bits` in streams of `stream_bytes`.
void accountHeader(double coded_bits, uint64_t stream_bytes, EncodeResult& result);

}  // namespace mcc

#endif  // MCC_WRITER_CODE_PIECE_H_
