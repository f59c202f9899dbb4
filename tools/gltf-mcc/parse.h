// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_PARSE_H_
#define MCC_TOOL_PARSE_H_

#include <string>
#include <vector>

#include "options.h"

namespace mcc::tool {

/// What a command line asks for, or what is wrong with it.
struct Parsed {
  enum Kind : uint8_t { kCommand, kHelp, kVersion, kWrong };
  Kind kind = kCommand;
  const Command* command = nullptr;  ///< the one that the line names, if it names one
  // Of kWrong:
  std::string message;                 ///< in the words of the option's check or of CLI11
  std::vector<std::string> left_over;  ///< words that nothing takes, in no particular order
  const Option* option = nullptr;      ///< accepts only certain words, and got `word`
  std::string word;
};

/// Stores the values of the options in their targets. Calls no Command::run.
/// words  without the name of the program.
Parsed parse(const Program& program, const std::vector<std::string>& words);

}  // namespace mcc::tool

#endif  // MCC_TOOL_PARSE_H_
