// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reports as JSON, in a file or on standard output.
#ifndef MCC_TOOL_REPORT_FILE_H_
#define MCC_TOOL_REPORT_FILE_H_

#include <string>

#include "json/json.h"
#include "mcc/result.h"

namespace mcc::tool {

/// Returns the indented text of a report.
std::string printReport(const gltf::Json& json);

/// Checks whether a report can be written, before any work is done for it.
gltf::Result checkReport(const std::string& path);

/// Writes a report. It replaces an older one only when it is complete.
gltf::Result writeReport(const std::string& path, const std::string& text);

}  // namespace mcc::tool

#endif  // MCC_TOOL_REPORT_FILE_H_
