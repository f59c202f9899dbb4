// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// `convert -o DIR`: many files into one folder.
#ifndef MCC_TOOL_BATCH_H_
#define MCC_TOOL_BATCH_H_

#include <filesystem>
#include <string>
#include <vector>

#include "commands.h"
#include "mcc/gltf.h"

namespace mcc::tool {

struct BatchOptions {
  std::vector<std::string> inputs;
  std::filesystem::path folder;  ///< made when its parent exists
  std::string report;            ///< JSON file; empty: none
  gltf::ConvertOptions convert;
  CommonOptions common;
  uint32_t job_count = 1;  ///< files at the same time; the results do not depend on it
  bool is_forced = false;  ///< converts what is up to date, too
};

/// Converts every file to one of the same name in the folder; prints a line for each, a summary, and
/// what failed. Returns an exit status: kFailed when a file failed, the others are converted all the
/// same; kUsage, and nothing is done, when two files would have the same output.
int runBatch(const BatchOptions& options);

}  // namespace mcc::tool

#endif  // MCC_TOOL_BATCH_H_
