// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What is made of the program's own help: its man page, and completions for shells.
#ifndef MCC_TOOL_HELP_PAGES_H_
#define MCC_TOOL_HELP_PAGES_H_

#include <CLI/CLI.hpp>
#include <string>

namespace mcc::tool {

/// roff of section 1, for man(1).
std::string manPage(const CLI::App& app);

/// A script for bash 4 or newer, alone or in a folder of bash-completion.
std::string bashCompletion(const CLI::App& app);

/// A script for zsh, to be called _gltf-mcc in a folder of fpath, or sourced.
std::string zshCompletion(const CLI::App& app);

/// `help`, `completion` and the hidden `man`.
void addHelpCommands(CLI::App& app, int& status);

}  // namespace mcc::tool

#endif  // MCC_TOOL_HELP_PAGES_H_
