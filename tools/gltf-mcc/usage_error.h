// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_USAGE_ERROR_H_
#define MCC_TOOL_USAGE_ERROR_H_

#include <string>
#include <vector>

#include "parse.h"

namespace mcc::tool {

/// Returns what to print when a command line was not understood: what is wrong, what may have been
/// meant, and which help to read.
std::string usageErrorText(const Program& program, const Parsed& parsed,
                           const std::vector<std::string>& words);

}  // namespace mcc::tool

#endif  // MCC_TOOL_USAGE_ERROR_H_
