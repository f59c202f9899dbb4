// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_TILES_REPORT_H_
#define MCC_TOOL_TILES_REPORT_H_

#include <map>
#include <string>
#include <vector>

#include "commands.h"
#include "json/json.h"
#include "tiles/convert_tile.h"
#include "tiles/file_table.h"
#include "tiles/tileset_walk.h"

namespace mcc::tool {

enum class TilesOutcome : uint8_t { kConverted, kCopied, kRefused, kNotMade };

/// What became of a file of the tileset.
struct TilesFile {
  uint64_t input_bytes = 0;
  uint64_t output_bytes = 0;
  tiles::TileFigures figures;
  TilesOutcome outcome = TilesOutcome::kNotMade;  ///< another part makes it, or it is a buffer
  bool is_up_to_date = false;                     ///< an earlier run made it
};

/// Everything there is to report about a run. There may be millions of files, so what few of them
/// have is not a member of each.
struct TilesRunResult {
  std::string input;
  std::string output;
  std::string part;  ///< "whole" or "3-of-8"
  gltf::Json settings;
  tiles::FileTable table;
  tiles::TilesetWalk walk;
  std::vector<TilesFile> files;  ///< as in the table
  /// Files that were copied although they should be compressed, too, and those that were not made.
  std::map<uint32_t, gltf::Result> failures;
  std::map<std::string, std::vector<uint32_t>> file_notes;  ///< by their text
  std::vector<std::string> notes;                           ///< about the whole
};

/// Returns one row for each level, the totals, and the notes.
std::string tilesReportText(const TilesRunResult& result, const CommonOptions& options);

/// Returns the report as indented JSON, with a line for each file.
std::string tilesReportJson(const TilesRunResult& result);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TILES_REPORT_H_
