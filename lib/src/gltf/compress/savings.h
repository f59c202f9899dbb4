// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes sure that files never become larger: who else needs the bytes that payloads replace, and
// which payloads save more than they cost.
#ifndef MCC_GLTF_COMPRESS_SAVINGS_H_
#define MCC_GLTF_COMPRESS_SAVINGS_H_

#include <vector>

#include "gltf/compress/compress.h"
#include "gltf/compress/plan.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Marks accessors that something other than the primitives of `payloads` uses.
std::vector<bool> accessorsOutsidePayloads(const Document& document,
                                           const std::vector<const PayloadPlan*>& payloads);
/// The same, and also marks attributes that stay accessors next to the payloads: payloads must not
/// take these accessors, and do not free their bytes.
std::vector<bool> accessorsInOtherUse(const Document& document,
                                      const std::vector<const PayloadPlan*>& payloads);

/// Drops small pieces that cost at least as many bytes as they free. Inside a payload with larger
/// pieces, such a loss would not be noticed. A piece that has a position in common with another
/// piece of its mesh stays, so that no crack can open. Error: no memory.
Result dropTinyPieces(const Document& document, const ConvertOptions& options,
                      std::vector<PayloadPlan>& plans, std::vector<LeftAlone>& left_alone);

/// Drops the payloads that cost at least as many bytes as they free, treating those of one mesh
/// together, and counts what the others free. Takes time proportional to the document and the
/// contents of its payloads, up to a logarithm.
void dropLosers(const Document& document, std::vector<EncodedPayload>& payloads,
                std::vector<LeftAlone>& left_alone);

/// Sets EncodedPayload::freed_bytes.
void countFreedBytes(const Document& document, std::vector<EncodedPayload>& payloads);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_SAVINGS_H_
