// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// "IN OUT" and "-o DIR IN…" on the command line.
#ifndef MCC_TOOL_IN_OUT_H_
#define MCC_TOOL_IN_OUT_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace mcc::tool {

struct InOut {
  std::vector<std::string> inputs;  ///< as they stand on the command line, until sort()
  std::string input;                ///< of -i
  std::string output;               ///< of -o, until sort()
  bool is_batch = false;            ///< `output` is a folder

  void addOptions(CLI::App& command);
  /// Tells inputs from the output. -o names a folder by a slash, because it is one, or because there are several
  /// inputs. Throws what the parser reports as wrong usage.
  void sort(const std::string& command);
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_IN_OUT_H_
