// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "other_programs.h"

namespace mcc::tool {

Command& addTree(Program& program, TreeOptions& options) {
  Command& command = program.commands.emplace_back();
  command.name = "tree";
  command.summary = "Draw the mc-tree on its mesh";
  command.add("IN", "", &options.input, "The model").is_required = true;
  command.add("OUT", "", &options.output, "The picture").is_required = true;
  command.add("--mesh", "N", &options.mesh, "Number of the mesh in the file [0]");
  command.add("--primitive", "N", &options.primitive, "Number of the primitive in the mesh [0]");
  Option& view =
      command.add("--view", "X,Y,Z", &options.view, "Where to look from; +Y is up [0.45,0.35,1]");
  view.count = 3;
  view.is_list = true;
  view.then = [&view = options.view]() {
    if (view[0] != 0 || view[1] != 0 || view[2] != 0) return;
    throw UsageError("--view", "0,0,0 is not a direction");
  };
  command.add("--size", "N", &options.width, "Width of the picture in pixels [800]").limits =
      between(64, 8192);
  command.addFlag("--costs", options.is_of_costs,
                  "Colour the surface by the bits of its positions, without a tree");
  command.addFlag("-q,--quiet", options.common.is_quiet, "Print errors only");
  addColorOption(command);
  command.usage = "tree [OPTIONS] IN OUT";
  command.text =
      "IN is a .glb or .gltf file, compressed or not, or - for standard input; OUT is an SVG, or\n"
      "- for standard output. The edges along which the surface was contracted are drawn on it\n"
      "where they are visible: the trunk that starts at the mc-vertex, and the branches between S\n"
      "and E. Edges across holes are left out. A compressed file is drawn with the tree of its\n"
      "payload, for all primitives that share a piece; any other with the one convert would make.\n"
      "--costs needs a compressed file, and shows what is mirrored or repeated: it costs little.";
  command.examples =
      "tree model.glb tree.svg\n"
      "tree small.glb tree.svg --mesh 2 --view 1,0,0\n"
      "tree small.glb costs.svg --costs\n"
      "tree model.glb - --size 400 > small.svg";
  return command;
}

Command& addTiles(Program& program, TilesOptions& options) {
  Command& command = program.commands.emplace_back();
  command.name = "tiles";
  command.summary = "Compress the tiles of a 3D Tiles tileset";
  command.add("IN", "FILE", &options.input, "The tileset").is_required = true;
  command.add("OUT", "DIR", &options.output, "The folder to write").is_required = true;
  command
      .add("--error-share", "F", &options.error_share,
           "Positions move by at most F of the tile's geometric error [0.0625]")
      .limits = {Limits::kReals, 0, 0, 1e-9, 1};
  addAttributeBits(command, options.convert);
  Option& bits = command.find("--position-bits");
  bits.help = "Bits of position, 0 keeps all; replaces --error-share";
  bits.excludes = {"--error-share"};
  bits.then = [&options]() { options.has_fixed_bits = true; };
  addPreference(command, options.convert);
  command.add("--report", "FILE", &options.report, "Write all figures to this JSON file");
  addFormatOption(command, options.common);
  addThreadCount(command, options.job_count, "Tiles at the same time [1]");
  command.add("--part", "K/N", &options.part_text,
              "Make only the K-th of N parts; the parts of several machines make a whole");
  command.addFlag("--wait", options.waits, "Wait for other runs that write to the same folder");
  command.addFlag("--to-glb", options.asks_for_glb, "").is_hidden = true;
  command.add("--max-tiles", "N", &options.max_tiles, "Refuse tilesets with more tiles [16777216]")
      .limits = between(1, uint64_t{1} << 40);
  command.addFlag("--force", options.is_forced, "Also convert what is up to date");
  addDecodedLimitOption(command, options.convert.max_decoded_bytes);
  addVerbosityOptions(command, options.common);
  addColorOption(command);
  command.usage = "tiles [OPTIONS] IN/tileset.json OUT";
  command.text =
      "Writes the whole folder of the tileset to OUT: glTF, b3dm, i3dm and cmpt that its tiles "
      "show\n"
      "are compressed, also those of external tilesets; every other file is copied. URIs stay the\n"
      "same.\n"
      "The accuracy of positions follows from the tile's geometric error. A tile without one, as\n"
      "leaves are, takes half of its nearest ancestor's. Tiles of one level with the same "
      "transform\n"
      "share a lattice of positions, so that borders between them stay closed.\n"
      "A tile that is damaged is copied; the others are converted, and the exit status is 1. A "
      "run\n"
      "that was interrupted continues where it was, and tiles that have not changed are left "
      "alone.";
  command.examples =
      "tiles city/tileset.json small-city\n"
      "tiles -j 8 terrain/tileset.json out --error-share 0.01 --report sizes.json\n"
      "tiles city/tileset.json small-city --position-bits 12\n"
      "tiles city/tileset.json small-city --part 3/8";
  return command;
}

Command& addCompare(Program& program, CompareOptions& options) {
  Command& command = program.commands.emplace_back();
  command.name = "compare";
  command.summary = "Compare with Draco: bytes, errors, times";
  command.add("IN", "", &options.inputs, "The .glb or .gltf files to read").is_required = true;
  addQuantization(command, options.convert);
  command.add("--runs", "N", &options.run_count, "Decode N times and take the least time [3]")
      .limits = between(1, 1000);
  command.add("--emit-draco", "OUT2", &options.draco_output,
              "Write IN with KHR_draco_mesh_compression, speed 0, to this .glb");
  addFormatOption(command, options.common);
  addVerbosityOptions(command, options.common);
  addColorOption(command);
  command.usage = "compare [OPTIONS] IN…";
  command.text =
      "Draco gets the same lattices as our codec, at speeds 0 (smallest), 3 and 5 "
      "(glTF-Transform's\n"
      "default). \"best\" is the smaller of speeds 0 and 5. Draco's connectivity is measured on\n"
      "its own, on the mesh welded by position; \"seams\" is what its triangles take beyond that\n"
      "in the file. Draco does not support morph targets, so they are left out on both sides and\n"
      "listed below. Times are CPU times in one process, from payloads in memory to float and\n"
      "index arrays, the least of several runs.";
  command.examples =
      "compare model.glb\n"
      "compare --position-bits 12 --format md a.glb b.glb";
  return command;
}

Command& addBench(Program& program, BenchOptions& options) {
  Command& command = program.commands.emplace_back();
  command.name = "bench";
  command.summary = "Compare sizes and speed with Draco and meshoptimizer";
  command.add("IN", "", &options.inputs, "The .glb or .gltf files to read").is_required = true;
  addQuantization(command, options.convert);
  command
      .add("--runs", "N", &options.run_count,
           "Decode at least N times, 5 or more, and take the least time [5]")
      .limits = between(5, 1000);
  command.add("--apart", "LETTERS", &options.apart,
              "Categories, by their letters, to leave out of the means");
  command.addFlag("--load", options.with_load,
                  "Also load whole files with tinygltf (ours through our\n"
                  "adapter) and decode with two threads");
  command.add("--without", "FEATURES", &options.without,
              "Measure what the encoder's choices gain: bytes and decoding\n"
              "time without each of them (a,b), without several together\n"
              "(a+b), or without each one in turn (all)");
  command
      .add("--blocks", "N,N", &options.blocks,
           "Measure blocks of N triangles, 0 for none (0,65536,262144):\n"
           "bytes, time with one and two threads, working memory")
      .is_list = true;
  command.addFlag("--meshlets", options.with_meshlets,
                  "Measure meshlets of the decoded triangles, in both orders,\n"
                  "and those of meshopt_buildMeshlets(): vertices, bounding\n"
                  "spheres, cones of normals, time");
  command.add("--sizes", "FILE", &options.sizes, "Only write our bytes per stream to this file")
      .is_hidden = true;  // for tests/results
  addFormatOption(command, options.common);
  command.addFlag("-q,--quiet", options.common.is_quiet, "Show no progress");
  addColorOption(command);
  command.usage = "bench [OPTIONS] IN…";
  command.text =
      "All codecs get the same lattices and run in turn on one thread of one process. Times are "
      "the\n"
      "least CPU time of at least N runs, from payloads in memory to new float and index arrays.\n"
      "Encoding takes longer; it is repeated for two seconds per codec and file, at most N times.\n"
      "The category of a file is the letter before '_' in names like a_bunny.glb.";
  command.examples = "bench --format md models/*.glb > table.md";
  return command;
}

void addOtherPrograms(Program& program) {
  static TreeOptions of_tree;  // what parse() stores here is read again by the program itself
  static TilesOptions of_tiles;
  addTree(program, of_tree);
  addTiles(program, of_tiles);
#if defined(MCC_HAS_FOREIGN)
  static CompareOptions of_compare;
  static BenchOptions of_bench;
  addCompare(program, of_compare);
  addBench(program, of_bench);
#endif
}

}  // namespace mcc::tool
