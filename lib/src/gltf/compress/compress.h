// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses a document: plans, encodes, drops what does not pay, and puts the rest into its JSON.
#ifndef MCC_GLTF_COMPRESS_COMPRESS_H_
#define MCC_GLTF_COMPRESS_COMPRESS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "gltf/compress/plan.h"
#include "gltf/document/accessors.h"
#include "gltf/document/layout.h"
#include "gltf/document/references.h"
#include "mcc/glb.h"
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
  /// An earlier payload with the same bytes, whose view it shares; kNone: there is none.
  uint32_t same_as = kNone;
  uint64_t freed_bytes = 0;
};

/// Returns the plans of payloads.
std::vector<const PayloadPlan*> plansOf(const std::vector<EncodedPayload>& payloads);
std::vector<const PayloadPlan*> plansOf(const std::vector<PayloadPlan>& payloads);

/// Encodes the planned payloads. Pieces that the codec or its readers refuse go to `left_alone`.
Result encodePayloads(const ConvertOptions& options, std::vector<PayloadPlan> plans,
                      std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone);

/// Returns the bytes of a payload that holds only one piece of a plan, or 0 when the codec refuses
/// it.
uint64_t bytesAlone(const ConvertOptions& options, const PayloadPlan& plan, const PiecePlan& piece);

/// A compressed document before it is written.
struct Compressed {
  std::vector<EncodedPayload> payloads;  ///< the payloads that are in the document
  std::vector<EncodedPayload> previews;  ///< of some of their primitives
  std::vector<LeftAlone> left_alone;
  std::vector<std::string> notes;
  std::vector<std::string> remarks;  ///< see ConvertReport::remarks
  std::vector<QualityChoice> quality_choices;
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

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_COMPRESS_H_
