// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writes reports of conversions as JSON, for the tool and for the web.
#ifndef MCC_GLTF_INSPECT_REPORT_JSON_H_
#define MCC_GLTF_INSPECT_REPORT_JSON_H_

#include <cstdint>
#include <string>

#include "json/json.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Returns the options that the bytes of the output depend on.
Json optionsJson(const ConvertOptions& options);

/// Returns everything that is known about a conversion.
Json reportJson(const ConvertReport& report, const ConvertOptions& options);

/// Returns a name such as "lattice 14" or "exact float". With `bits` 0, the bits are left out.
std::string codingName(AttributeCoding coding, uint32_t bits);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_INSPECT_REPORT_JSON_H_
