// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Geometry that other codecs compressed: decoded next to the document, whose JSON stays as it is.
#ifndef MCC_GLTF_CODED_INPUT_H_
#define MCC_GLTF_CODED_INPUT_H_

#include "gltf/references.h"
#include "mcc/gltf.h"

namespace mcc::gltf {

/// Decodes the coded buffer views that triangle primitives use, so that accessors on them can be read, and those that the
/// triangle primitives of `source` use, when it is not null: a document with the same accessors. Without a decoder
/// they stay unreadable. Errors: a view is damaged, or coded in a way the decoder does not know;
/// document.decoded is above its limit.
Result decodeViews(const ForeignDecoders& decoders, Document& document,
                   const Document* source = nullptr);

/// Decodes coded primitives, so that their accessors can be read. Those whose accessors have bytes of their own besides, or
/// contradict each other or what was decoded, stay as they are; Document::notes says why.
Result decodeMeshes(const ForeignDecoders& decoders, Document& document);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_CODED_INPUT_H_
