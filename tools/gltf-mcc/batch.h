// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Implements `convert -o DIR` and `decode -o DIR`, which write many files into one folder.
#ifndef MCC_TOOL_BATCH_H_
#define MCC_TOOL_BATCH_H_

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "commands.h"
#include "json/json.h"
#include "mcc/files.h"

namespace mcc::tool {

/// The result of making one output.
struct BatchResult {
  bool copied = false;  ///< the output is the input
  uint64_t input_bytes = 0;
  uint64_t output_bytes = 0;
  gltf::FilesInUse files;
  std::vector<std::string> notes;
  gltf::Json details;  ///< for the report; may be null
};

struct BatchOptions {
  std::vector<std::string> inputs;
  std::filesystem::path folder;  ///< created if necessary; its parent must exist
  std::string report;            ///< path of the JSON report; empty: none is written
  CommonOptions common;
  uint32_t job_count = 1;    ///< files at the same time; the results do not depend on it
  bool is_forced = false;    ///< also makes outputs that are up to date
  std::string done_name;     ///< name of the outcome in tables, "converted"
  std::string copied_why;    ///< why a file was copied, "nothing becomes smaller"
  std::string details_name;  ///< key of BatchResult::details in the report
  gltf::Json settings;       ///< all options that the bytes of the outputs depend on
  /// Makes one output from one input with the given number of threads. Called in parallel.
  std::function<gltf::Result(const std::string& input, const std::filesystem::path& output,
                             uint32_t thread_count, BatchResult& result)>
      make;
};

/// Makes an output of the same name in the folder for every input. Prints a line for each, a
/// summary, and the failures. Returns an exit status: kFailed when a file failed, in which case the
/// others are still made; kUsage, with nothing done, when two inputs would have the same
/// output.
int runBatch(const BatchOptions& options);

}  // namespace mcc::tool

#endif  // MCC_TOOL_BATCH_H_
