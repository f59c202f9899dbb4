// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "commands.h"
#include "convert_report.h"
#include "file_roles.h"
#include "gltf/base/path_text.h"
#include "gltf/base/printable.h"
#include "gltf/files/file_io.h"
#include "help.h"
#include "interrupt.h"
#include "progress_line.h"
#include "standard_streams.h"
#include "tree_drawing.h"

#if defined(MCC_HAS_FOREIGN)
#include "foreign/decoders.h"
#endif

namespace mcc::tool {
namespace {

struct TreeCommand {
  CommonOptions common;
  gltf::ForeignDecoders decoders;
  std::string input;
  std::string output;
  uint32_t mesh = 0;
  uint32_t primitive = 0;
  DrawingOptions drawing;

  int run();
};

int TreeCommand::run() {
  FileRoles roles;
  roles.read(gltf::pathOf(input));
  const gltf::Result apart = roles.write(gltf::pathOf(output), "OUT");
  if (!apart.ok()) {
    reportFailure(apart);
    return kUsage;
  }
  drawing.title = input == "-" ? "" : gltf::printable(gltf::textOf(gltf::pathOf(input).filename()));
  gltf::McTree tree;
  StreamSource source;
  gltf::Result result = source.open(input);
  std::string svg;
  if (result.ok()) {
    const WorkProgress progress(common.is_quiet, "drawing " + input);
    result = gltf::mcTree(source.source(), mesh, primitive, decoders, tree);
    if (result.ok()) svg = drawTree(tree, drawing);
  }
  if (!result.ok()) return reportFailure(result, input, "");
  if (isStandardOutput(output)) return printOut(svg);
  result = gltf::writeFile(gltf::pathOf(output), std::vector<uint8_t>(svg.begin(), svg.end()),
                           &temporaryFiles());
  if (!result.ok()) return reportFailure(result, input, output);
  if (common.is_quiet) return kDone;
  return printOut(fmt::format(
      "{} -> {}: mc-tree of {} edges on {} triangles, {}\n", gltf::printable(input),
      gltf::printable(output), grouped(tree.edges.size()), grouped(tree.indices.size() / 3),
      tree.is_of_payload ? "taken from its payload" : "as convert would make it"));
}

}  // namespace

void addTree(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("tree", "Draw the mc-tree on its mesh");
  auto state = std::make_shared<TreeCommand>();
#if defined(MCC_HAS_FOREIGN)
  state->decoders = foreign::foreignDecoders();
#endif
  command->add_option("IN", state->input, "The model")->required()->type_name("");
  command->add_option("OUT", state->output, "The picture")->required()->type_name("");
  command->add_option("--mesh", state->mesh, "Number of the mesh in the file [0]")->type_name("N");
  command->add_option("--primitive", state->primitive, "Number of the primitive in the mesh [0]")
      ->type_name("N");
  command
      ->add_option_function<std::vector<double>>(
          "--view",
          [state](const std::vector<double>& numbers) {
            std::copy_n(numbers.begin(), 3, state->drawing.view);
            if (numbers[0] != 0 || numbers[1] != 0 || numbers[2] != 0) return;
            throw CLI::ValidationError("--view", "0,0,0 is not a direction");
          },
          "Where to look from; +Y is up [0.45,0.35,1]")
      ->expected(3)
      ->delimiter(',')
      ->type_name("X,Y,Z");
  command->add_option("--size", state->drawing.width, "Width of the picture in pixels [800]")
      ->check(CLI::Range(64, 8192).description(""))
      ->type_name("N");
  command->add_flag("-q,--quiet", state->common.is_quiet, "Print errors only");
  addColorOption(*command);
  setHelp(
      *command, "tree [OPTIONS] IN OUT",
      "IN is a .glb or .gltf file, compressed or not, or - for standard input; OUT is an SVG, or\n"
      "- for standard output. The edges along which the surface was contracted are drawn on it\n"
      "where they are visible: the trunk that starts at the mc-vertex, and the branches between S\n"
      "and E. Edges across holes are left out. A compressed file is drawn with the tree of its\n"
      "payload, for all primitives that share a piece; any other with the one convert would make.",
      "tree model.glb tree.svg\n"
      "tree small.glb tree.svg --mesh 2 --view 1,0,0\n"
      "tree model.glb - --size 400 > small.svg");
  command->callback([state, &status]() { status = state->run(); });
}

}  // namespace mcc::tool
