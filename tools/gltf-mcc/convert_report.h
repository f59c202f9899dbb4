// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_CONVERT_REPORT_H_
#define MCC_TOOL_CONVERT_REPORT_H_

#include <string>

#include "commands.h"
#include "json/json.h"
#include "mcc/glb.h"
#include "report_file.h"
#include "whole_sizes.h"

namespace mcc::tool {

/// A conversion and what was measured about it.
struct Converted {
  std::string input;
  std::string output;
  gltf::ConvertReport report;
  std::vector<WholeSize> sizes;  ///< sizes of whole files; empty when not measured
  std::string draco;  ///< the same geometry with Draco, in one line; empty when not compared
};

/// Returns what `convert` prints: the summary and the notes; with -v and in other formats than
/// kPretty also tables.
std::string reportText(const Converted& converted, const CommonOptions& options);

/// Returns everything known about a conversion. `comparison` is left out when it is null.
gltf::Json reportJson(const Converted& converted, const gltf::ConvertOptions& options,
                      const gltf::Json& comparison);

/// Returns text like "1,838,104 -> 171,656 bytes (9.3 %)".
std::string sizeChange(uint64_t input_bytes, uint64_t output_bytes);

}  // namespace mcc::tool

#endif  // MCC_TOOL_CONVERT_REPORT_H_
