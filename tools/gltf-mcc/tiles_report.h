// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_TILES_REPORT_H_
#define MCC_TOOL_TILES_REPORT_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "tiles/convert_tile.h"
#include "tiles/tileset.h"

namespace mcc::tool {

enum class TilesOutcome : uint8_t { kConverted, kCopied, kRefused };

/// A file of a tileset and what became of it.
struct TilesFile {
  std::string path;          ///< relative to both folders, with '/'
  uint64_t size = 0;         ///< of the source
  uint32_t content = kNone;  ///< index into Tileset::contents; kNone: no tile shows it
  TilesOutcome outcome = TilesOutcome::kRefused;
  bool is_up_to_date = false;  ///< an earlier run made it
  gltf::Result failure;        ///< of a file that was copied although it should be compressed, too
  uint64_t input_bytes = 0;
  uint64_t output_bytes = 0;
  tiles::TileFigures figures;
};

/// Everything there is to report about a run.
struct TilesRunResult {
  std::string input;
  std::string output;
  nlohmann::ordered_json settings;
  tiles::Tileset tileset;
  std::vector<TilesFile> files;
  std::vector<std::string> notes;  ///< about the whole
};

/// Returns one row for each level, the totals, and the notes.
std::string tilesReportText(const TilesRunResult& result, const CommonOptions& options);
nlohmann::ordered_json tilesReportJson(const TilesRunResult& result);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TILES_REPORT_H_
