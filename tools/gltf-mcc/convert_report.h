// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_CONVERT_REPORT_H_
#define MCC_TOOL_CONVERT_REPORT_H_

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "commands.h"
#include "mcc/gltf.h"

namespace mcc::tool {

/// The tables of `convert`.
std::string reportText(const std::string& input, const std::string& output,
                       const gltf::ConvertReport& report, const CommonOptions& options);

/// Everything that is known about a conversion, as JSON. `comparison` is left out when it is null.
std::string reportJson(const std::string& input, const std::string& output,
                       const gltf::ConvertOptions& options, const gltf::ConvertReport& report,
                       const nlohmann::ordered_json& comparison);

/// Whether a file can be written; an empty one is left when there was none.
gltf::Result checkWritable(const std::string& path);

/// Writes a text file.
gltf::Result writeText(const std::string& path, const std::string& text);

/// "lattice 14", "exact", … of an attribute.
std::string codingName(AttributeCoding coding, uint32_t bits);

}  // namespace mcc::tool

#endif  // MCC_TOOL_CONVERT_REPORT_H_
