// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Pages generated from the program's own help: its man page, and completions for shells.
#ifndef MCC_TOOL_HELP_PAGES_H_
#define MCC_TOOL_HELP_PAGES_H_

#include <string>

#include "options.h"

namespace mcc::tool {

/// Returns the man page in roff, for section 1.
std::string manPage(const Program& program);

/// Returns a script for bash 4 or newer, to be sourced or saved in a folder of bash-completion.
std::string bashCompletion(const Program& program);

/// Returns a script for zsh, to be sourced, or saved as _gltf-mcc in a folder of fpath.
std::string zshCompletion(const Program& program);

/// Adds `help`, `completion` and `man`, which are about all commands of the program, also those
/// that are added later.
void addHelpCommands(Program& program);

}  // namespace mcc::tool

#endif  // MCC_TOOL_HELP_PAGES_H_
