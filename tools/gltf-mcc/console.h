// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the program needs of the system's console. console_posix.cpp and console_windows.cpp
// implement it.
#ifndef MCC_TOOL_CONSOLE_H_
#define MCC_TOOL_CONSOLE_H_

#include <optional>
#include <string>
#include <vector>

namespace mcc::tool {

/// The standard streams, by their descriptors.
inline constexpr int kStandardInput = 0;
inline constexpr int kStandardOutput = 1;
inline constexpr int kStandardErrors = 2;

/// Makes the standard streams transport bytes without changing them, and a console show UTF-8. Must
/// be called once, before anything is printed.
void prepareConsole();

/// Undoes what the program has changed of the console, which outlives it. Called by exit(); what
/// ends the process in another way calls it first, from any thread.
void restoreConsole();

/// Returns the words of the command line in UTF-8, the name of the program first.
std::vector<std::string> commandLine(int argc, const char* const* argv);

/// Runs another program with these words, and returns its exit status; nothing when there is none
/// of this name, neither in the folder of this program nor in the PATH. On POSIX it takes the place
/// of this one, so the function returns only in that case. Must be called before other threads are
/// started.
std::optional<int> startProgram(const std::string& name, const std::vector<std::string>& words);

/// Whether a standard stream is a terminal.
bool isTerminal(int stream);
/// Whether it is a terminal that understands escape sequences for colours.
bool isColorTerminal(int stream);
/// Returns the width of the terminal of standard errors; 0 when it is not known.
size_t consoleColumns();
/// Whether the terminal shows UTF-8, by the locale of the environment where there is one.
bool hasUtf8();

}  // namespace mcc::tool

#endif  // MCC_TOOL_CONSOLE_H_
