// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_CONVERT_COMPARISON_H_
#define MCC_TOOL_CONVERT_COMPARISON_H_

#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "json/json.h"
#include "mcc/files.h"
#include "whole_sizes.h"

namespace mcc::tool {

/// What Draco makes of the primitives that were compressed.
struct DracoSize {
  uint64_t bytes = 0;         ///< 0: it failed
  bool has_left_out = false;  ///< without what Draco cannot code, such as morph targets
};

/// The options `--compare` and `--emit-draco` of `convert`. A build without other codecs does not
/// have them and compares nothing. The bytes of every input are in memory, and outlive the object.
struct ConvertComparison {
  std::string mode;            ///< "draco" or "none"; empty: Draco, unless the geometry is large
  std::string draco_output;    ///< path of the Draco file; empty: none is written
  std::vector<uint8_t> draco;  ///< the bytes of the Draco file
  std::string line;            ///< Draco's size in words; empty when nothing was compared
  std::string tables;          ///< empty unless is_full
  std::string notes;           ///< lines to print
  gltf::Json json;             ///< see comparisonJson(); null unless is_full
  std::optional<WholeSize> draco_size;  ///< only when is_full
  /// Whether Draco is measured at all its speeds, for tables and reports; else only its size, the
  /// smaller of speeds 0 and 5, while the conversion is being checked.
  bool is_full = false;

  void addOptions(Command& command);
  /// Called before the conversion: makes the Draco file, and checks that it can be written.
  /// `is_shown`: whether anybody will see Draco's size.
  gltf::Result begin(const gltf::Source& input, const std::string& output,
                     const gltf::ConvertOptions& convert, bool is_shown);
  /// Called when everything is encoded and `report` lists the primitives: starts to measure Draco's
  /// size on a thread of its own.
  void beginSize(const gltf::Source& input, const gltf::ConvertOptions& convert,
                 const gltf::ConvertReport& report);
  /// Called after the conversion: writes the Draco file, and waits for Draco's size or, when
  /// is_full, compares the primitives that were compressed, unless the result would not be shown or
  /// reported.
  gltf::Result finish(const gltf::Source& input, const gltf::ConvertOptions& convert,
                      const gltf::ConvertReport& report, const CommonOptions& common,
                      bool is_reported);

 private:
  gltf::Result compare(const gltf::Source& input, const gltf::ConvertOptions& convert,
                       const CommonOptions& common, const gltf::ConvertReport& report);

  std::shared_future<DracoSize> size_;
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_CONVERT_COMPARISON_H_
