// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writes what inspectFile() found as JSON, for the tool and for other languages.
#ifndef MCC_GLTF_INSPECT_INSPECT_JSON_H_
#define MCC_GLTF_INSPECT_INSPECT_JSON_H_

#include <string>

#include "json/json.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Returns everything that is known about the payloads of a file. `input` is the file's name.
Json inspectJson(const std::string& input, const InspectReport& report);

/// Returns a text such as "f32x3" or "u8x4n".
std::string typeText(const AttributeInfo& attribute);

/// Returns "manifold", "cut", …
std::string surfaceName(SurfaceCoding surface);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_INSPECT_INSPECT_JSON_H_
