// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What becomes of the vertices of a piece beside its payload: attributes that stay accessors,
// accessors that hold numbers of vertices, and vertices that no triangle uses.
#ifndef MCC_GLTF_COMPRESS_VERTICES_H_
#define MCC_GLTF_COMPRESS_VERTICES_H_

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "gltf/compress/plan.h"
#include "gltf/document/layout.h"
#include "gltf/document/references.h"
#include "mcc/writer.h"

namespace mcc::gltf {

/// Moves the attributes of all pieces to PiecePlan::ordinary. They will be reordered, so that the
/// payload need not store the order. Where something else refers to one of them, the vertex order
/// is kept instead.
void planIndicesOnly(const Document& document, std::vector<PayloadPlan>& payloads);

/// Gives the ordinary accessors of a piece new views with their elements in decoded order.
/// accessors  those of the edited document; `views` receives the new views.
void reorderAttributes(const Document& document, const PiecePlan& piece,
                       const std::vector<uint32_t>& source_wedge, Json& accessors,
                       std::vector<NewView>& views);

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

/// Whether decoded vertices have the numbers of the source, each of which is there once.
inline bool isIdentity(const std::vector<uint32_t>& source_wedge) {
  return std::is_sorted(source_wedge.begin(), source_wedge.end());
}

/// Returns the vertices that a triangle of a piece uses, in ascending order.
std::vector<uint32_t> usedVertices(const PiecePlan& piece);

/// Leaves only these vertices, in ascending order, in a piece. Its triangles use no others.
void keepVertices(std::vector<uint32_t> kept, PiecePlan& piece);

/// Notes how many vertices of each mesh no triangle uses. With options.drop_unused they are removed
/// from the pieces, except where something may refer to vertices by number. Linear in the vertices
/// and triangles.
void planUnused(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                std::vector<std::string>& notes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_VERTICES_H_
