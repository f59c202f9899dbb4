// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Accessors that hold numbers of vertices for an extension, such as the edges of
// CESIUM_primitive_outline. They get the numbers that the vertices have in the payload, so that the
// payload need not store the order of the source.
#ifndef MCC_GLTF_COMPRESS_VERTEX_NUMBERS_H_
#define MCC_GLTF_COMPRESS_VERTEX_NUMBERS_H_

#include <cstdint>
#include <vector>

#include "gltf/compress/plan.h"
#include "gltf/document/layout.h"
#include "gltf/document/references.h"

namespace mcc::gltf {

/// Finds such accessors and sets PiecePlan::vertex_numbers. Where one of them cannot be changed,
/// because it is shared with something else or cannot be read, the payload keeps the order of the
/// vertices instead. Takes time proportional to the document and these accessors.
void planVertexNumbers(const Document& document, std::vector<PayloadPlan>& payloads);

/// Gives the accessors in piece.vertex_numbers new views with the numbers of the decoded vertices.
/// Does nothing when decoded vertices have the numbers of the source.
/// source_wedge  the source vertex of each decoded one: a bijection.
/// accessors     those of the edited document; `views` receives the new views.
void renumberVertices(const Document& document, const PiecePlan& piece,
                      const std::vector<uint32_t>& source_wedge, Json& accessors,
                      std::vector<NewView>& views);

/// Whether decoded vertices have the numbers of the source.
bool isIdentity(const std::vector<uint32_t>& source_wedge);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_VERTEX_NUMBERS_H_
