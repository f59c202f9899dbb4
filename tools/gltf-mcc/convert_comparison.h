// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_CONVERT_COMPARISON_H_
#define MCC_TOOL_CONVERT_COMPARISON_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "commands.h"
#include "mcc/gltf.h"
#include "whole_sizes.h"

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
  std::optional<WholeSize> draco_size;  ///< when something was compared

  void addOptions(CLI::App& command);
  /// Before the conversion: reads the source, makes the Draco file, sees whether it can be written.
  gltf::Result begin(const gltf::Source& input, const std::string& output,
                     const gltf::ConvertOptions& convert);
  /// After it: writes the Draco file; compares the primitives that were compressed, unless nobody
  /// sees it.
  gltf::Result finish(const gltf::Source& input, const gltf::ConvertOptions& convert,
                      const gltf::ConvertReport& report, const CommonOptions& common,
                      bool is_reported);

 private:
  gltf::Result compare(const gltf::Source& input, const gltf::ConvertOptions& convert,
                       const CommonOptions& common,
                       const std::set<std::pair<uint32_t, uint32_t>>& compressed);
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_CONVERT_COMPARISON_H_
