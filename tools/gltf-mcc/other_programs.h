// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The options of the commands that are programs of their own. gltf-mcc knows them, too, for its
// help, completions, and messages about wrong usage, which it finds before it starts the program.
#ifndef MCC_TOOL_OTHER_PROGRAMS_H_
#define MCC_TOOL_OTHER_PROGRAMS_H_

#include <string>
#include <vector>

#include "commands.h"
#include "mcc/glb.h"
#include "tiles/part.h"

namespace mcc::tool {

struct TreeOptions {
  CommonOptions common;
  std::string input;
  std::string output;
  uint32_t mesh = 0;
  uint32_t primitive = 0;
  std::vector<double> view = {0.45, 0.35, 1};  ///< from the model to the eye; +Y is up
  uint32_t width = 800;                        ///< width of the picture in pixels
  bool is_of_costs = false;                    ///< draws the costs of positions, not the tree
};

struct TilesOptions {
  std::string input;      ///< the JSON of the tileset
  std::string output;     ///< the folder; created if necessary, its parent must exist
  std::string part_text;  ///< "3/8"; empty: everything
  std::string report;     ///< path of the JSON report; empty: none is written
  CommonOptions common;
  gltf::ConvertOptions convert;
  double error_share = 0.0625;
  bool has_fixed_bits = false;  ///< convert.position_bits decides, not the geometric errors
  uint32_t job_count = 1;       ///< the results do not depend on it
  bool is_forced = false;
  tiles::Part part;           ///< of the files, which this run makes
  bool waits = false;         ///< for other runs that write to the folder
  bool asks_for_glb = false;  ///< --to-glb, which there was before 1.0
  uint64_t max_tiles = uint64_t{1} << 24;
};

struct CompareOptions {
  CommonOptions common;
  gltf::ConvertOptions convert;
  std::vector<std::string> inputs;
  std::string draco_output;
  uint32_t run_count = 3;
};

struct BenchOptions {
  CommonOptions common;
  gltf::ConvertOptions convert;
  std::vector<std::string> inputs;
  std::string sizes;  ///< when not empty: only this file is written and nothing is measured
  std::string apart;
  uint32_t run_count = 5;
  bool with_load = false;
  std::string without;           ///< when not empty: only this is measured
  std::vector<uint32_t> blocks;  ///< when not empty: only this is measured
  bool with_meshlets = false;    ///< only these are measured
};

/// Each of these adds a command without Command::run. The options must outlive the command.
Command& addTree(Program& program, TreeOptions& options);
Command& addTiles(Program& program, TilesOptions& options);
Command& addCompare(Program& program, CompareOptions& options);
Command& addBench(Program& program, BenchOptions& options);

/// Adds all of them, as far as they are part of this build.
void addOtherPrograms(Program& program);

}  // namespace mcc::tool

#endif  // MCC_TOOL_OTHER_PROGRAMS_H_
