// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Builds the report of a conversion.
#ifndef MCC_GLTF_API_CONVERT_REPORT_H_
#define MCC_GLTF_API_CONVERT_REPORT_H_

#include <vector>

#include "gltf/check/prove.h"
#include "gltf/compress/compress.h"

namespace mcc::gltf {

/// Lists all primitives of the document, and adds notes on those that were left alone.
void addPrimitives(const Document& document, const Compressed& compressed, ConvertReport& report);

/// Adds the payloads with what was measured on them.
void addPayloads(const std::vector<EncodedPayload>& payloads,
                 const std::vector<PayloadProof>& proofs, ConvertReport& report);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_API_CONVERT_REPORT_H_
