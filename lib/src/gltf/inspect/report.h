// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Builds the reports of a conversion and of what is inside a compressed file, for inspectGlb() and
// inspectFile(), and prints both as JSON.
#ifndef MCC_GLTF_INSPECT_REPORT_H_
#define MCC_GLTF_INSPECT_REPORT_H_

#include <cstdint>
#include <string>
#include <vector>

#include "gltf/check/prove.h"
#include "gltf/compress/compress.h"
#include "json/json.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Lists all primitives of the document, and adds notes on those that were left alone.
void addPrimitives(const Document& document, const Compressed& compressed, ConvertReport& report);

/// Adds the payloads with what was measured on them.
void addPayloads(const std::vector<EncodedPayload>& payloads,
                 const std::vector<PayloadProof>& proofs, ConvertReport& report);

/// Returns the options that the bytes of the output depend on.
Json optionsJson(const ConvertOptions& options);

/// Returns everything that is known about a conversion.
Json reportJson(const ConvertReport& report, const ConvertOptions& options);

/// Returns a name such as "lattice 14" or "exact float". With `bits` 0, the bits are left out.
std::string codingName(AttributeCoding coding, uint32_t bits);

/// Returns everything that is known about the payloads of a file. `input` is the file's name.
Json inspectJson(const std::string& input, const InspectReport& report);

/// Returns a text such as "f32x3" or "u8x4n".
std::string typeText(const AttributeInfo& attribute);

/// Returns "manifold", "cut", …
std::string surfaceName(SurfaceCoding surface);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_INSPECT_REPORT_H_
