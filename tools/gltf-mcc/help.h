// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_HELP_H_
#define MCC_TOOL_HELP_H_

#include <string>

#include "options.h"

namespace mcc::tool {

/// Returns what --help prints: how a command is called, and what its options take.
std::string helpOf(const Command& command);

/// Returns the help of gltf-mcc itself, with the list of its commands.
std::string helpOf(const Program& program);

}  // namespace mcc::tool

#endif  // MCC_TOOL_HELP_H_
