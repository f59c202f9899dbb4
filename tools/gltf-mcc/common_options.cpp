// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Options that several commands have.
#include <algorithm>
#include <limits>
#include <memory>

#include "commands.h"
#include "mcc/glb.h"
#include "precision_options.h"

namespace mcc::tool {

void addColorOption(Command& command) {
  static std::string read_already;  // by main(), before parsing
  command.addWords("--color", read_already, {"auto", "always", "never"},
                   "Colours: on a terminal, always, or never [auto]");
}

void addFormatOption(Command& command, CommonOptions& options) {
  command.addWords("--format", options.format,
                   {{"pretty", Format::kPretty},
                    {"md", Format::kMarkdown},
                    {"csv", Format::kCsv},
                    {"json", Format::kJson}},
                   "How tables are printed");
}

void addGlbVersionOption(Command& command, gltf::GlbVersion& version) {
  command.addWords("--glb-version", version,
                   {{"smallest", gltf::GlbVersion::kSmallest},
                    {"2", gltf::GlbVersion::k2},
                    {"3", gltf::GlbVersion::k3}},
                   "Container of a .glb: smallest is 2, or 3 above 4 GiB [smallest]");
}

void addDecodedLimitOption(Command& command, uint64_t& max_decoded_bytes) {
  command
      .add("--max-decoded-bytes", "N", &max_decoded_bytes,
           "Most bytes that a file may decode to [1024 per byte of the file]")
      .limits = between(1, std::numeric_limits<uint64_t>::max());
}

void addVerbosityOptions(Command& command, CommonOptions& options) {
  command.addFlag("-q,--quiet", options.is_quiet, "Print errors only");
  command.addFlag("-v,--verbose", options.is_verbose, "Print more");
}

void addThreadCount(Command& command, uint32_t& count, const char* help) {
  command.add("-j,--thread-count", "N", &count, help).limits = between(1, 1024);
}

void addAttributeBits(Command& command, gltf::ConvertOptions& options) {
  const auto add = [&](const std::string& attribute, uint8_t& bits, uint64_t low, uint64_t high) {
    const std::string name = "--" + attribute + "-bits";
    const std::string help =
        "Bits of " + attribute + ", 0 keeps all [" + std::to_string(bits) + "]";
    command.add(name.c_str(), "N", &bits, help).limits = {Limits::kZeroOrIntegers, low, high, 0, 0};
  };
  add("position", options.position_bits, 1, 24);
  add("normal", options.normal_bits, 2, 16);
  add("texcoord", options.texcoord_bits, 1, 24);
  add("color", options.color_bits, 1, 24);
  add("tangent", options.tangent_bits, 2, 16);
  add("weight", options.weight_bits, 1, 24);
}

void addPreference(Command& command, gltf::ConvertOptions& options) {
  command.addWords("--prefer", options.prefer,
                   {{"size", Preference::kSize},
                    {"balanced", Preference::kBalanced},
                    {"speed", Preference::kSpeed}},
                   "Fewer bytes, or less time to decode [balanced]");
}

namespace {

/// Adds --max-position-error and --position-lattice, which each replace --position-bits.
void addPositionPromises(Command& command, gltf::ConvertOptions& options) {
  Option& error = command.add("--max-position-error", "X", &options.max_position_error,
                              "No position moves farther than X, in units of the model");
  error.limits.kind = Limits::kAboveZero;
  error.excludes = {"--lossless", "--position-bits", "--position-lattice"};
  command
      .addFlag("--is-error-relative", options.is_error_relative,
               "X is a fraction of the longest side of the model")
      .needs = "--max-position-error";
  const auto numbers = std::make_shared<std::vector<float>>();
  Option& lattice = command.add("--position-lattice", "X,Y,Z,STEP", numbers.get(),
                                "Lattice of positions, for tiles that must fit together");
  lattice.count = 4;
  lattice.is_list = true;
  lattice.excludes = {"--lossless", "--position-bits"};
  lattice.then = [numbers, &options]() {
    Lattice given;
    std::copy_n(numbers->begin(), 3, given.origin);
    given.step = (*numbers)[3];
    if (!isValidLattice(given, 3)) {
      throw UsageError("--position-lattice",
                       "needs finite numbers, and a step that is greater than 0");
    }
    options.position_lattice = given;
  };
}

}  // namespace

void addQuantization(Command& command, gltf::ConvertOptions& options) {
  addAttributeBits(command, options);
  command.addFlag("--lossless", options.lossless, "Keep every bit of every number").excludes = {
      "--position-bits", "--normal-bits",  "--texcoord-bits",
      "--color-bits",    "--tangent-bits", "--weight-bits"};
  addPositionPromises(command, options);
  addStep(command, options);
  addQuality(command, options);
  command.addWords("--grid", options.grid,
                   {{"mesh", gltf::Grid::kMesh},
                    {"scene", gltf::Grid::kScene},
                    {"primitive", gltf::Grid::kPrimitive}},
                   "What shares a lattice of positions, without cracks [mesh]");
  addPreference(command, options);
  command
      .add("--block-triangles", "N", &options.block_triangles,
           "Cut large surfaces into blocks of N triangles, 0 never [262144]")
      .limits = between(0, kBlocksByPreference - 1);
}

}  // namespace mcc::tool
