// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <memory>

#include "commands.h"
#include "help.h"
#include "standard_streams.h"
#include "tiles_run.h"

#if defined(MCC_HAS_FOREIGN)
#include "foreign/decoders.h"
#endif

namespace mcc::tool {
namespace {

/// Reads "3/8". Returns false for anything else.
bool readPart(const std::string& text, tiles::Part& part) {
  const char* const end = text.data() + text.size();
  const auto [slash, bad_number] = std::from_chars(text.data(), end, part.number);
  if (bad_number != std::errc() || slash == end || *slash != '/') return false;
  const auto [rest, bad_count] = std::from_chars(slash + 1, end, part.count);
  constexpr uint32_t kMostParts = 1000000;
  return bad_count == std::errc() && rest == end && part.number >= 1 && part.number <= part.count &&
         part.count <= kMostParts;
}

}  // namespace

void addTiles(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("tiles", "Compress the tiles of a 3D Tiles tileset");
  auto state = std::make_shared<TilesOptions>();
#if defined(MCC_HAS_FOREIGN)
  state->convert.decoders = foreign::foreignDecoders();
#endif
  command->add_option("IN", state->input, "The tileset")->type_name("FILE")->required();
  command->add_option("OUT", state->output, "The folder to write")->type_name("DIR")->required();
  command
      ->add_option("--error-share", state->error_share,
                   "Positions move by at most F of the tile's geometric error [0.0625]")
      ->check(CLI::Range(1e-9, 1.0).description(""))
      ->type_name("F");
  addAttributeBits(*command, state->convert);
  CLI::Option* bits = command->get_option("--quantize-position");
  bits->description("Bits of position, 0 keeps all; replaces --error-share");
  bits->excludes(command->get_option("--error-share"));
  addPreference(*command, state->convert);
  command->add_option("--report", state->report, "Write all figures to this JSON file")
      ->type_name("FILE");
  addFormatOption(*command, state->common);
  command->add_option("-j,--jobs", state->job_count, "Tiles at the same time [1]")
      ->check(CLI::Range(1, 1024).description(""))
      ->type_name("N");
  command
      ->add_option("--part", state->part_text,
                   "Make only the K-th of N parts; the parts of several machines make a whole")
      ->type_name("K/N");
  command->add_flag("--wait", state->waits, "Wait for other runs that write to the same folder");
  CLI::Option* to_glb = command->add_flag("--to-glb")->group("");
  command->add_option("--max-tiles", state->max_tiles, "Refuse tilesets with more tiles [16777216]")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 40).description(""))
      ->type_name("N");
  command->add_flag("--force", state->is_forced, "Also convert what is up to date");
  addDecodedLimitOption(*command, state->convert.max_decoded_bytes);
  addVerbosityOptions(*command, state->common);
  addColorOption(*command);
  setHelp(
      *command, "tiles [OPTIONS] IN/tileset.json OUT",
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
      "alone.",
      "tiles city/tileset.json small-city\n"
      "tiles -j 8 terrain/tileset.json out --error-share 0.01 --report sizes.json\n"
      "tiles city/tileset.json small-city --quantize-position 12\n"
      "tiles city/tileset.json small-city --part 3/8");
  command->callback([state, bits, to_glb, &status]() {
    if (to_glb->count() != 0) {
      throw CLI::ValidationError(
          "--to-glb",
          "is no option any more; upgrade b3dm before: npx 3d-tiles-tools upgrade "
          "--targetVersion 1.1 -i IN/tileset.json -o DIR/tileset.json");
    }
    if (isStandardStream(state->report)) {
      throw CLI::ValidationError("--report", "takes the name of a file; --format json prints it");
    }
    if (!state->part_text.empty() && !readPart(state->part_text, state->part)) {
      throw CLI::ValidationError("--part", "takes K/N, as in 3/8, with K from 1 to N");
    }
    state->has_fixed_bits = bits->count() != 0;
    status = runTiles(*state);
  });
}

}  // namespace mcc::tool
