// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tells what the bytes of a document are for.
#ifndef MCC_GLTF_DOCUMENT_CONTENTS_H_
#define MCC_GLTF_DOCUMENT_CONTENTS_H_

#include "gltf/document/document.h"

namespace mcc::gltf {

/// What the bytes of a document and its buffers are for. The four sums add up to its size.
struct Contents {
  uint64_t geometry_bytes = 0;    ///< attributes, indices and morph targets of meshes, coded or not
  uint64_t image_bytes = 0;       ///< images inside of the document
  uint64_t animation_bytes = 0;   ///< samplers of animations, and matrices of skins
  uint64_t other_bytes = 0;       ///< the JSON, padding, and everything else
  uint32_t image_count = 0;       ///< images inside of the document
  uint32_t image_file_count = 0;  ///< images in files of their own, which no sum contains
  uint32_t animation_count = 0;
};

/// Returns what the bytes of a loaded document are for. Bytes that several things use count once,
/// for the first of geometry, images and animations. Takes time proportional to the JSON, up to a
/// logarithm.
Contents contentsOf(const Document& document);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_CONTENTS_H_
