// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What `convert` prints by default: some eight lines about a file, instead of tables about the
// codec.
#ifndef MCC_TOOL_CONVERT_SUMMARY_H_
#define MCC_TOOL_CONVERT_SUMMARY_H_

#include <string>

#include "convert_report.h"
#include "mcc/glb.h"

namespace mcc::tool {

/// Returns the first line of the output: the names of the files, and whether OUT is only a copy.
std::string titleText(const Converted& converted);

/// Returns the lines: geometry, images, animations, the rest and the file, before and after; the
/// largest errors; the check; and how the same geometry fares with Draco. Lines about nothing are
/// left out.
std::string summaryText(const Converted& converted);

/// Returns the largest errors in words: "positions 0.0031 % of the longest side, normals 0.11
/// degrees". Empty when nothing was compressed.
std::string accuracyText(const gltf::ConvertReport& report);

}  // namespace mcc::tool

#endif  // MCC_TOOL_CONVERT_SUMMARY_H_
