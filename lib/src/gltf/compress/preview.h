// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes previews: payloads with coarse versions of large primitives. A preview has some of the
// vertices of its piece, with the same attributes on the same lattices, so it ends where its
// neighbours begin and is replaced without a jump.
#ifndef MCC_GLTF_COMPRESS_PREVIEW_H_
#define MCC_GLTF_COMPRESS_PREVIEW_H_

#include <string>
#include <vector>

#include "gltf/compress/compress.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Makes the previews that options.preview_triangles asks for, in the order of the payloads: one
/// for each payload with a large primitive. Its pieces are those with such primitives, and the
/// users of its parts are the primitives that get one. What cannot be simplified gets none, and
/// `remarks` says so. Takes time O(n log n), apart from options.simplify. Error: options.simplify
/// returns triangles that it must not.
Result makePreviews(const ConvertOptions& options, const std::vector<EncodedPayload>& payloads,
                    std::vector<EncodedPayload>& previews, std::vector<std::string>& remarks);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_PREVIEW_H_
