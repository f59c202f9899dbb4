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

/// The options `--compare` and `--emit-draco` of `convert`. A build without other codecs does not
/// have them and compares nothing.
struct ConvertComparison {
  std::string mode;             ///< "draco" or "none"; empty: Draco, unless the file is large
  std::string draco_output;     ///< path of the Draco file; empty: none is written
  std::vector<uint8_t> source;  ///< a copy of the input when the output replaces it
  std::vector<uint8_t> draco;   ///< the bytes of the Draco file
  std::string text;             ///< tables and notes to print
  nlohmann::ordered_json json;  ///< see comparisonJson(); null when nothing was compared
  std::optional<WholeSize> draco_size;  ///< only when something was compared

  void addOptions(CLI::App& command);
  /// Called before the conversion: reads the source, makes the Draco file, and checks that it can
  /// be written.
  gltf::Result begin(const gltf::Source& input, const std::string& output,
                     const gltf::ConvertOptions& convert);
  /// Called after the conversion: writes the Draco file, and compares the primitives that were
  /// compressed, unless the result would not be shown or reported.
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
