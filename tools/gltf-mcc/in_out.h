// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Parses "IN OUT" and "-o DIR IN…" on the command line.
#ifndef MCC_TOOL_IN_OUT_H_
#define MCC_TOOL_IN_OUT_H_

#include <string>
#include <vector>

#include "options.h"

namespace mcc::tool {

struct InOut {
  std::vector<std::string> inputs;  ///< IN and OUT as on the command line; inputs after sort()
  std::string input;                ///< the value of -i
  std::string output;               ///< the value of -o; the output after sort()
  bool is_batch = false;            ///< `output` is a folder
  bool may_replace_input = false;   ///< --in-place

  void addOptions(Command& command);
  /// Separates the inputs from the output. The value of -o is a folder if it ends with a slash, if
  /// a folder of that name exists, or if there are several inputs or a folder of them, which is
  /// replaced by the models in it. Throws UsageError.
  void sort(const std::string& command);
  /// Throws UsageError where OUT is IN, unless --in-place was given; `loss` says what
  /// would be lost. Called after sort().
  void refuseReplacing(const std::string& command, const std::string& loss) const;
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_IN_OUT_H_
