// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reports of conversions as JSON, for the tool and for the web.
#ifndef MCC_GLTF_REPORT_JSON_H_
#define MCC_GLTF_REPORT_JSON_H_

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "mcc/gltf.h"

namespace mcc::gltf {

/// What decides on the bytes of the output.
nlohmann::ordered_json optionsJson(const ConvertOptions& options);

/// Everything that is known about a conversion.
nlohmann::ordered_json reportJson(const ConvertReport& report, const ConvertOptions& options);

/// "lattice 14", "exact float", … of an attribute; `bits` 0: without them.
std::string codingName(AttributeCoding coding, uint32_t bits);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_REPORT_JSON_H_
