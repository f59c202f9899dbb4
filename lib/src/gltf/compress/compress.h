// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses a document: plans, encodes, drops what does not pay, and puts the rest into its JSON.
#ifndef MCC_GLTF_COMPRESS_COMPRESS_H_
#define MCC_GLTF_COMPRESS_COMPRESS_H_

#include <string>
#include <vector>

#include "gltf/compress/encode.h"
#include "gltf/compress/plan.h"
#include "gltf/document/layout.h"
#include "gltf/document/references.h"
#include "mcc/glb.h"
#include "mcc/writer.h"

namespace mcc::gltf {

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
