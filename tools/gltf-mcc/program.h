// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_PROGRAM_H_
#define MCC_TOOL_PROGRAM_H_

#include "options.h"

namespace mcc::tool {

/// What main() of every program does: reads the command line, runs the command, and returns the
/// exit status. A command without Command::run is started as a program of its own.
/// own_command   null in gltf-mcc; "bench" in gltf-mcc-bench, whose words follow that command.
/// add_commands  adds those that the words may name.
int runProgram(int argc, const char* const* argv, const char* own_command,
               void (*add_commands)(Program&));

}  // namespace mcc::tool

#endif  // MCC_TOOL_PROGRAM_H_
