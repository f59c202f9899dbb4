// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include "program.h"
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

int run(TilesOptions& options) {
  if (options.asks_for_glb) {
    throw UsageError("--to-glb",
                     "is no option any more; upgrade b3dm before: npx 3d-tiles-tools upgrade "
                     "--targetVersion 1.1 -i IN/tileset.json -o DIR/tileset.json");
  }
  if (isStandardStream(options.report)) {
    throw UsageError("--report", "takes the name of a file; --format json prints it");
  }
  if (!options.part_text.empty() && !readPart(options.part_text, options.part)) {
    throw UsageError("--part", "takes K/N, as in 3/8, with K from 1 to N");
  }
#if defined(MCC_HAS_FOREIGN)
  options.convert.decoders = foreign::foreignDecoders();
#endif
  return runTiles(options);
}

}  // namespace
}  // namespace mcc::tool

int main(int argc, char** argv) {
  return mcc::tool::runProgram(argc, argv, "tiles", [](mcc::tool::Program& program) {
    static mcc::tool::TilesOptions options;
    mcc::tool::addTiles(program, options).run = [] { return mcc::tool::run(options); };
  });
}
