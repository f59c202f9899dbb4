// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tells what the bytes of a document are for.
#ifndef MCC_GLTF_DOCUMENT_CONTENTS_H_
#define MCC_GLTF_DOCUMENT_CONTENTS_H_

#include "gltf/document/document.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Returns what the bytes of a loaded document are for. Bytes that several things use count once,
/// for the first of geometry, images and animations. Takes time proportional to the JSON, up to a
/// logarithm. Tests: tests/gltf/contents_test.cpp.
Contents contentsOf(const Document& document);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_CONTENTS_H_
