// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// `convert -o DIR` and `decode -o DIR`: many files into one folder.
#ifndef MCC_TOOL_BATCH_H_
#define MCC_TOOL_BATCH_H_

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "mcc/gltf.h"

namespace mcc::tool {

/// What became of a file.
struct BatchResult {
  bool copied = false;  ///< the output is the input
  uint64_t input_bytes = 0;
  uint64_t output_bytes = 0;
  gltf::FilesInUse files;
  nlohmann::ordered_json details;  ///< for the report; may be null
};

struct BatchOptions {
  std::vector<std::string> inputs;
  std::filesystem::path folder;  ///< made when its parent exists
  std::string report;            ///< JSON file; empty: none
  CommonOptions common;
  uint32_t job_count = 1;  ///< files at the same time; the results do not depend on it
  bool is_forced = false;  ///< does again what is up to date
  bool with_fallback = false;
  std::string done_name;            ///< "converted", in tables
  std::string copied_why;           ///< "nothing becomes smaller", in the line of a copy
  std::string details_name;         ///< of BatchResult::details in the report
  nlohmann::ordered_json settings;  ///< all that decides on the bytes of the outputs
  /// Makes one file of another on so many threads. Called in parallel.
  std::function<gltf::Result(const std::string& input, const std::filesystem::path& output,
                             uint32_t thread_count, BatchResult& result)>
      make;
};

/// Makes of every file one of the same name in the folder; prints a line for each, a summary, and what
/// failed. Returns an exit status: kFailed when a file failed, the others are made all the same;
/// kUsage, and nothing is done, when two files would have the same output.
int runBatch(const BatchOptions& options);

}  // namespace mcc::tool

#endif  // MCC_TOOL_BATCH_H_
