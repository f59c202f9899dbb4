// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_COMPRESS_COMPRESS_H_
#define MCC_GLTF_COMPRESS_COMPRESS_H_

#include <cstdint>
#include <vector>

#include "gltf/base/payload.h"
#include "gltf/compress/plan.h"
#include "gltf/document/references.h"
#include "mcc/glb.h"
#include "mcc/writer.h"

namespace mcc::gltf {

/// A payload plan and the payload it became.
struct EncodedPayload {
  PayloadPlan plan;
  EncodeResult result;
  /// What the reader decodes from result.payload. Empty until decodePayloads() and after the check.
  std::vector<DecodedPiece> decoded;
  uint64_t freed_bytes = 0;
};

/// A compressed document before it is written.
struct Compressed {
  Json json;
  std::vector<uint8_t> bin;
  std::vector<EncodedPayload> payloads;  ///< the payloads that are in the document
  std::vector<LeftAlone> left_alone;
  std::vector<std::string> notes;
  std::vector<std::string> remarks;  ///< see ConvertReport::remarks
  double decode_seconds = 0;         ///< time of decodePayloads()
};

/// Compresses every primitive for which that saves bytes. If there is no payload in the result,
/// `json` and `bin` are not set. Primitives that the codec refuses are left alone. Errors: the
/// document contradicts itself.
Result compressDocument(const Document& document, const ConvertOptions& options,
                        Compressed& compressed);

/// Encodes the planned payloads. Pieces that the codec or its readers refuse go to `left_alone`.
Result encodePayloads(const ConvertOptions& options, std::vector<PayloadPlan> plans,
                      std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone);

/// Sets EncodedPayload::decoded. The payloads are decoded once: the bounds of accessors come from
/// the decoded values, and the check compares them with the source.
/// Errors: a payload cannot be decoded.
Result decodePayloads(uint32_t thread_count, std::vector<EncodedPayload>& payloads);

/// Sets EncodedPayload::freed_bytes.
void countFreedBytes(const Document& document, const ForeignReferences& foreign,
                     std::vector<EncodedPayload>& payloads);

/// Returns the bytes of a payload that holds only one piece of a plan, or 0 when the codec refuses
/// it.
uint64_t bytesAlone(const ConvertOptions& options, const PayloadPlan& plan, const PiecePlan& piece);

/// Drops small pieces that cost at least as many bytes as they free. Inside a payload with larger
/// pieces, such a loss would not be noticed. A piece that has a position in common with another
/// piece of its mesh stays, so that no crack can open. Error: no memory.
Result dropTinyPieces(const Document& document, const ForeignReferences& foreign,
                      const ConvertOptions& options, std::vector<PayloadPlan>& plans,
                      std::vector<LeftAlone>& left_alone);

/// Drops the payloads that cost at least as many bytes as they free, treating those of one mesh
/// together, and counts what the others free. Takes time proportional to the document and the
/// contents of its payloads, up to a logarithm.
void dropLosers(const Document& document, const ForeignReferences& foreign,
                std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone);

/// Marks accessors that something other than the primitives of `payloads` uses.
std::vector<bool> accessorsOutsidePayloads(const Document& document,
                                           const ForeignReferences& foreign,
                                           const std::vector<const PayloadPlan*>& payloads);
/// The same, and also marks attributes that stay accessors next to the payloads: payloads must not
/// take these accessors, and do not free their bytes.
std::vector<bool> accessorsInOtherUse(const Document& document, const ForeignReferences& foreign,
                                      const std::vector<const PayloadPlan*>& payloads);
std::vector<bool> accessorsInOtherUse(const Document& document, const ForeignReferences& foreign,
                                      const std::vector<EncodedPayload>& payloads);

/// Returns the extension object of a primitive that uses a part of a piece.
Json extensionJson(uint64_t buffer_view, size_t piece_number, const PiecePlan& piece,
                   size_t part_number);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_COMPRESS_H_
