// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_USAGE_ERROR_H_
#define MCC_TOOL_USAGE_ERROR_H_

#include <CLI/CLI.hpp>
#include <string>

namespace mcc::tool {

/// Returns what to print when the command line was not understood: what is wrong, what may have
/// been meant, and which help to read. `app` is the whole program after parsing.
std::string usageErrorText(const CLI::App& app, const CLI::Error& failure, int argc,
                           const char* const* argv);

}  // namespace mcc::tool

#endif  // MCC_TOOL_USAGE_ERROR_H_
