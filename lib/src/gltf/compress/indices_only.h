// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Plans payloads that hold only triangles, while the attributes stay ordinary accessors.
#ifndef MCC_GLTF_COMPRESS_INDICES_ONLY_H_
#define MCC_GLTF_COMPRESS_INDICES_ONLY_H_

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

/// Returns the positions of such a piece as the codec gets them, to find those that are equal.
AttributeView weldingView(const PiecePlan& piece);

/// Gives the ordinary accessors of a piece new views with their elements in decoded order.
/// accessors  those of the edited document; `views` receives the new views.
void reorderAttributes(const Document& document, const PiecePlan& piece,
                       const std::vector<uint32_t>& source_wedge, Json& accessors,
                       std::vector<NewView>& views);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_INDICES_ONLY_H_
