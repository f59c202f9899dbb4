// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_CONVERT_COMPARISON_H_
#define MCC_TOOL_CONVERT_COMPARISON_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "mcc/gltf.h"

namespace mcc::tool {

/// `--compare` and `--emit-draco` of `convert`. In a build without other codecs there are no such
/// options and nothing is compared.
struct ConvertComparison {
  std::string mode;             ///< "draco" or "none"; empty: Draco, unless the file is large
  std::string draco_output;     ///< empty: none
  std::vector<uint8_t> source;  ///< the input before it is replaced, if it is
  std::vector<uint8_t> draco;   ///< the Draco file
  std::string text;             ///< tables
  nlohmann::ordered_json json;  ///< see comparisonJson(); null when nothing was compared

  void addOptions(CLI::App& command);
  /// Before the conversion: reads the source, makes the Draco file, sees whether it can be written.
  gltf::Result begin(const std::string& input, const gltf::ConvertOptions& convert);
  /// After it: writes the Draco file; compares the primitives that were compressed, unless nobody
  /// sees it.
  gltf::Result finish(const std::string& input, const gltf::ConvertOptions& convert,
                      const gltf::ConvertReport& report, const CommonOptions& common,
                      bool is_reported);
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_CONVERT_COMPARISON_H_
