// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "file_roles.h"
#include "gltf/files/file_io.h"
#include "host/text.h"
#include "interrupt.h"
#include "other_programs.h"
#include "program.h"
#include "progress_line.h"
#include "standard_streams.h"
#include "tree_costs.h"
#include "tree_drawing.h"

#if defined(MCC_HAS_FOREIGN)
#include "foreign/decoders.h"
#endif

namespace mcc::tool {
namespace {

/// Finds what the positions of the tree's vertices take.
gltf::Result costsOf(const McTree& tree, std::vector<float>& bits) {
  if (!tree.is_of_payload)
    return gltf::error("", "the file is not compressed; --costs is about what a payload holds");
  if (tree.piece != 0) return gltf::error("", "--costs is only for the first piece of a payload");
  return gltf::toResult(positionCosts(tree.payload, bits), "");
}

int drawFile(const TreeOptions& options) {
  const std::string& input = options.input;
  const std::string& output = options.output;
  FileRoles roles;
  roles.read(gltf::pathOf(input));
  const gltf::Result apart = roles.write(gltf::pathOf(output), "OUT");
  if (!apart.ok()) {
    reportFailure(apart);
    return kUsage;
  }
  DrawingOptions drawing;
  std::copy_n(options.view.begin(), 3, drawing.view);
  drawing.width = options.width;
  drawing.title = input == "-" ? "" : gltf::printable(gltf::textOf(gltf::pathOf(input).filename()));
  gltf::ForeignDecoders decoders;
#if defined(MCC_HAS_FOREIGN)
  decoders = foreign::foreignDecoders();
#endif
  McTree tree;
  StreamSource source;
  gltf::Result result = source.open(input);
  std::string svg;
  if (result.ok()) {
    const WorkProgress progress(options.common.is_quiet, "drawing " + input);
    result = mcTree(source.source(), options.mesh, options.primitive, decoders, tree);
    if (result.ok() && options.is_of_costs) result = costsOf(tree, drawing.bits);
    if (result.ok()) svg = drawTree(tree, drawing);
  }
  if (!result.ok()) return reportFailure(result, input, "");
  if (isStandardOutput(output)) return printOut(svg);
  result = gltf::writeFile(gltf::pathOf(output), std::vector<uint8_t>(svg.begin(), svg.end()),
                           &temporaryFiles());
  if (!result.ok()) return reportFailure(result, input, output);
  if (options.common.is_quiet) return kDone;
  return printOut(fmt::format(
      "{} -> {}: mc-tree of {} edges on {} triangles, {}\n", gltf::printable(input),
      gltf::printable(output), grouped(tree.edges.size()), grouped(tree.indices.size() / 3),
      tree.is_of_payload ? "taken from its payload" : "as convert would make it"));
}

}  // namespace
}  // namespace mcc::tool

int main(int argc, char** argv) {
  return mcc::tool::runProgram(argc, argv, "tree", [](mcc::tool::Program& program) {
    static mcc::tool::TreeOptions options;
    mcc::tool::addTree(program, options).run = [] { return mcc::tool::drawFile(options); };
  });
}
