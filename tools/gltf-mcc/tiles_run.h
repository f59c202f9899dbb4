// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_TILES_RUN_H_
#define MCC_TOOL_TILES_RUN_H_

#include <string>

#include "commands.h"
#include "mcc/gltf.h"
#include "tiles/part.h"
#include "tiles/tileset_walk.h"

namespace mcc::tool {

/// Options of `tiles`.
struct TilesOptions {
  std::string input;      ///< the JSON of the tileset
  std::string output;     ///< the folder; created if necessary, its parent must exist
  std::string part_text;  ///< "3/8"; empty: everything
  std::string report;     ///< path of the JSON report; empty: none is written
  CommonOptions common;
  gltf::ConvertOptions convert;
  double error_share = 0.0625;
  bool has_fixed_bits = false;  ///< convert.bits.position decides, not the geometric errors
  uint32_t job_count = 1;       ///< the results do not depend on it
  bool is_forced = false;
  tiles::Part part;        ///< of the files, which this run makes
  bool waits = false;      ///< for other runs that write to the folder
  uint64_t max_tiles = tiles::kMostTiles;
};

/// Compresses a tileset. Returns an exit status: kFailed when something failed, in which case
/// everything else is still made.
int runTiles(const TilesOptions& options);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TILES_RUN_H_
