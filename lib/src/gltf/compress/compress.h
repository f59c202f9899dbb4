// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_COMPRESS_COMPRESS_H_
#define MCC_GLTF_COMPRESS_COMPRESS_H_

#include <cstdint>
#include <vector>

#include "gltf/compress/plan.h"
#include "gltf/document/accessors.h"
#include "gltf/document/layout.h"
#include "mcc/gltf.h"
#include "mcc/writer.h"

namespace mcc::gltf {

/// The bounds of what the reader decodes.
struct PieceBounds {
  std::vector<Bounds> attributes;
  std::vector<Bounds> parts;
};

/// A payload plan and the payload it became.
struct EncodedPayload {
  PayloadPlan plan;
  EncodeResult result;
  std::vector<PieceBounds> bounds;  ///< one for each piece, from provePayloads()
  uint64_t freed_bytes = 0;
};

/// A compressed document before it is written.
struct Compressed {
  std::vector<EncodedPayload> payloads;  ///< the payloads that are in the document
  std::vector<LeftAlone> left_alone;
  std::vector<std::string> notes;
  std::vector<std::string> remarks;  ///< see ConvertReport::remarks
  // From storePayloads():
  Json json;
  Layout layout;               ///< of the buffer
  std::vector<NewView> views;  ///< what the layout borrows, besides the source and the payloads
};

/// Compresses every primitive for which that saves bytes. Primitives that the codec refuses are
/// left alone. Errors: the document contradicts itself.
Result compressDocument(const Document& document, const ConvertOptions& options,
                        Compressed& compressed);

/// Puts the payloads into the JSON of the document, and lays out its buffer. The payloads have
/// their bounds.
void storePayloads(const Document& document, Compressed& compressed);

/// Encodes the planned payloads. Pieces that the codec or its readers refuse go to `left_alone`.
Result encodePayloads(const ConvertOptions& options, std::vector<PayloadPlan> plans,
                      std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone);

/// Sets EncodedPayload::freed_bytes.
void countFreedBytes(const Document& document, std::vector<EncodedPayload>& payloads);

/// Returns the bytes of a payload that holds only one piece of a plan, or 0 when the codec refuses
/// it.
uint64_t bytesAlone(const ConvertOptions& options, const PayloadPlan& plan, const PiecePlan& piece);

/// Drops small pieces that cost at least as many bytes as they free. Inside a payload with larger
/// pieces, such a loss would not be noticed. A piece that has a position in common with another
/// piece of its mesh stays, so that no crack can open. Error: no memory.
Result dropTinyPieces(const Document& document, const ConvertOptions& options,
                      std::vector<PayloadPlan>& plans, std::vector<LeftAlone>& left_alone);

/// Drops the payloads that cost at least as many bytes as they free, treating those of one mesh
/// together, and counts what the others free. Takes time proportional to the document and the
/// contents of its payloads, up to a logarithm.
void dropLosers(const Document& document, std::vector<EncodedPayload>& payloads,
                std::vector<LeftAlone>& left_alone);

/// Marks accessors that something other than the primitives of `payloads` uses.
std::vector<bool> accessorsOutsidePayloads(const Document& document,
                                           const std::vector<const PayloadPlan*>& payloads);
/// The same, and also marks attributes that stay accessors next to the payloads: payloads must not
/// take these accessors, and do not free their bytes.
std::vector<bool> accessorsInOtherUse(const Document& document,
                                      const std::vector<const PayloadPlan*>& payloads);
std::vector<bool> accessorsInOtherUse(const Document& document,
                                      const std::vector<EncodedPayload>& payloads);

/// Returns the extension object of a primitive that uses a part of a piece.
Json extensionJson(uint64_t buffer_view, size_t piece_number, const PiecePlan& piece,
                   size_t part_number);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_COMPRESS_H_
