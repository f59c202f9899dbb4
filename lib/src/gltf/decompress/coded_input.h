// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes geometry that other codecs compressed. It is kept next to the document, whose JSON stays
// as it is.
#ifndef MCC_GLTF_DECOMPRESS_CODED_INPUT_H_
#define MCC_GLTF_DECOMPRESS_CODED_INPUT_H_

#include "gltf/document/document.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Decodes the coded buffer views that triangle primitives use, so that accessors on them can be
/// read. If `source` is not null, it must be a document with the same accessors; the views that its
/// triangle primitives use are decoded as well. Without a decoder the views stay unreadable. A view
/// that is damaged, or coded in a way the decoder does not know, gets a fault; the first of them is
/// returned in `refused`, if that is not null.
/// Error: document.decoded is above its limit.
Result decodeViews(const ForeignDecoders& decoders, Document& document,
                   const Document* source = nullptr, Result* refused = nullptr);

/// Decodes coded primitives, so that their accessors can be read. A primitive stays as it is when
/// it is damaged, or its accessors also have bytes of their own, or contradict each other or the
/// decoded mesh; Document::notes says why. The first damage is returned in `refused`, if that is
/// not null and has no error already.
/// Error: document.decoded is above its limit.
Result decodeMeshes(const ForeignDecoders& decoders, Document& document, Result* refused = nullptr);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECOMPRESS_CODED_INPUT_H_
