// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_COMPRESS_H_
#define MCC_GLTF_COMPRESS_H_

#include <cstdint>
#include <vector>

#include "gltf/bounds.h"
#include "gltf/plan.h"
#include "gltf/references.h"
#include "mcc/gltf.h"
#include "mcc/writer.h"

namespace mcc::gltf {

/// A payload plan after encoding.
struct EncodedPayload {
  PayloadPlan plan;
  EncodeResult result;
  /// Bounds of the decoded data, per piece.
  struct PieceBounds {
    std::vector<Bounds> attributes;
    std::vector<Bounds> parts;  ///< of the indices
  };
  std::vector<PieceBounds> bounds;
  uint64_t payload_bytes = 0;
  uint64_t freed_bytes = 0;
};

/// A compressed document before it is written.
struct Compressed {
  Json json;
  std::vector<uint8_t> bin;
  std::vector<EncodedPayload> payloads;  ///< those that are in the document
  std::vector<LeftAlone> left_alone;
  std::vector<std::string> notes;
};

/// Compresses what gains by it. With no payloads in the result `json` and `bin` are not filled in.
/// Errors: the document contradicts itself. What the codec refuses is left alone.
Result compressDocument(const Document& document, const ConvertOptions& options,
                        Compressed& compressed);

/// Encodes the planned payloads and decodes each at once. Pieces the codec refuses go to
/// `left_alone`.
Result encodePayloads(const ConvertOptions& options, std::vector<PayloadPlan> plans,
                      std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone);

/// Fills in EncodedPayload::freed_bytes.
void countFreedBytes(const Document& document, const ForeignReferences& foreign,
                     std::vector<EncodedPayload>& payloads);

/// Bytes of a payload that holds one piece of a plan; 0 when the codec refuses it.
uint64_t bytesAlone(const ConvertOptions& options, const PayloadPlan& plan, const PiecePlan& piece);

/// Drops small pieces that are not smaller than the buffer bytes they free: with others in a payload they would hide behind
/// those. One with a position in common with others of its mesh stays: no crack may open. Error: no memory.
Result dropTinyPieces(const Document& document, const ForeignReferences& foreign,
                      const ConvertOptions& options, std::vector<PayloadPlan>& plans,
                      std::vector<LeftAlone>& left_alone);

/// Drops the payloads that are not smaller than the buffer bytes they free, those of one mesh together, and counts what the
/// others free. Takes time in proportion to the document and what its payloads hold, up to a logarithm.
void dropLosers(const Document& document, const ForeignReferences& foreign,
                std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone);

/// Accessors used by anything but the primitives of `payloads`.
std::vector<bool> accessorsOutsidePayloads(const Document& document,
                                           const ForeignReferences& foreign,
                                           const std::vector<const PayloadPlan*>& payloads);
/// The same and those that stay beside the payloads: what payloads must not take and do not free.
std::vector<bool> accessorsInOtherUse(const Document& document, const ForeignReferences& foreign,
                                      const std::vector<const PayloadPlan*>& payloads);
std::vector<bool> accessorsInOtherUse(const Document& document, const ForeignReferences& foreign,
                                      const std::vector<EncodedPayload>& payloads);

/// The extension object of a primitive that uses a part of a piece.
Json extensionJson(uint64_t buffer_view, size_t piece_number, const PiecePlan& piece,
                   size_t part_number);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_H_
