// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "commands.h"
#include "convert_comparison.h"
#include "convert_report.h"
#if defined(MCC_HAS_FOREIGN)
#include "foreign/decoders.h"
#endif

namespace mcc::tool {
namespace {

struct ConvertCommand {
  CommonOptions common;
  gltf::ConvertOptions convert;
  std::string input;
  std::string output;
  std::string report;
  ConvertComparison comparison;

  int run() const {
    // Before any work is done: a conversion whose report cannot be written is a failure.
    const bool report_is_new = !report.empty() && !std::filesystem::exists(report);
    if (!report.empty()) {
      const gltf::Result writable = checkWritable(report);
      if (!writable.ok()) return reportFailure(writable);
    }
    gltf::ConvertReport result;
    ConvertComparison compared = comparison;
    gltf::Result outcome = compared.begin(input, convert);
    if (outcome.ok()) outcome = gltf::convertFile(input, output, convert, result);
    if (!outcome.ok()) {
      if (report_is_new) std::remove(report.c_str());
      return reportFailure(outcome);
    }
    outcome = compared.finish(input, convert, result, common, !report.empty());
    if (!outcome.ok()) return reportFailure(outcome);
    const std::string json = reportJson(input, output, convert, result, compared.json);
    if (!report.empty()) {
      const gltf::Result written = writeText(report, json);
      if (!written.ok()) return reportFailure(written);
    }
    if (common.is_quiet) return kDone;
    if (common.format == Format::kJson) return printOut(json);
    const std::string text = reportText(input, output, result, common);
    return printOut(compared.text.empty() ? text : text + "\n" + compared.text);
  }
};

void addBits(CLI::App& command, const std::string& name, uint8_t& bits, int low, int high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    int number = -1;
    const bool is_number = CLI::detail::lexical_cast(text, number);
    if (is_number && (number == 0 || (number >= low && number <= high))) return "";
    return fmt::format("{} is not 0 or {} to {}", text, low, high);
  };
  // Parsed as a number: a uint8_t would be taken for a character.
  command
      .add_option_function<int>(
          "--quantize-" + name, [&bits](const int& number) { bits = static_cast<uint8_t>(number); },
          fmt::format("Bits of {}, 0 keeps all [{}]", name, bits))
      ->check(CLI::Validator(check, ""))
      ->type_name("N");
}

/// --max-error, --max-error-relative, --lattice: each instead of --quantize-position.
void addPositionPromises(CLI::App& command, gltf::ConvertOptions& options, CLI::Option* lossless) {
  const auto addError = [&](const std::string& name, bool is_relative, const std::string& help) {
    return command
        .add_option_function<double>(
            name,
            [&options, is_relative](const double& value) {
              options.max_position_error = value;
              options.is_error_relative = is_relative;
            },
            help)
        ->check(CLI::PositiveNumber.description(""))
        ->type_name("X");
  };
  CLI::Option* absolute =
      addError("--max-error", false, "No position moves farther than X, in units of the model");
  CLI::Option* relative =
      addError("--max-error-relative", true, "The same, X times the longest side of the box");
  CLI::Option* lattice =
      command
          .add_option_function<std::vector<float>>(
              "--lattice",
              [&options](const std::vector<float>& numbers) {
                Lattice given;
                std::copy_n(numbers.begin(), 3, given.origin);
                given.step = numbers[3];
                if (!(given.step > 0)) {
                  throw CLI::ValidationError("--lattice", "the step must be greater than 0");
                }
                options.position_lattice = given;
              },
              "Origin and step of the grid of positions, for tiles that must fit together")
          ->expected(4)
          ->delimiter(',')
          ->type_name("X,Y,Z,STEP");
  CLI::Option* bits = command.get_option("--quantize-position");
  for (CLI::Option* option : {absolute, relative, lattice}) {
    option->excludes(lossless)->excludes(bits);
  }
  absolute->excludes(relative)->excludes(lattice);
  relative->excludes(lattice);
}

}  // namespace

void addQuantization(CLI::App& command, gltf::ConvertOptions& options) {
  addBits(command, "position", options.bits.position, 1, 24);
  addBits(command, "normal", options.bits.normal, 2, 16);
  addBits(command, "texcoord", options.bits.texcoord, 1, 24);
  addBits(command, "color", options.bits.color, 1, 24);
  addBits(command, "tangent", options.bits.tangent, 2, 16);
  addBits(command, "weight", options.bits.weight, 1, 24);
  CLI::Option* lossless =
      command.add_flag("--lossless", options.lossless, "Keep every bit of every number");
  addPositionPromises(command, options, lossless);
  const std::map<std::string, gltf::Grid> grids = {{"mesh", gltf::Grid::kMesh},
                                                   {"scene", gltf::Grid::kScene},
                                                   {"primitive", gltf::Grid::kPrimitive}};
  command
      .add_option("--grid", options.grid,
                  "What shares one grid of positions, so that no cracks open [mesh]")
      ->transform(CLI::CheckedTransformer(grids, CLI::ignore_case).description(""))
      ->type_name("mesh|scene|primitive");
}

void addKeepOrder(CLI::App& command, gltf::ConvertOptions& options) {
  command.add_flag("--indices-only", options.indices_only,
                   "Compress the triangles alone, keep the attributes as they are");
  command
      .add_option_function<std::string>(
          "--keep-order",
          [&options](const std::string& what) {
            options.keep_vertex_order = what != "triangles";
            options.keep_triangle_order = what != "vertices";
          },
          "Bring back the order of vertices, triangles or both")
      ->check(CLI::IsMember({"vertices", "triangles", "both"}).description(""))
      ->type_name("vertices|triangles|both");
}

void addConvert(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("convert", "Compress a .glb or .gltf into a .glb");
  auto state = std::make_shared<ConvertCommand>();
#if defined(MCC_HAS_FOREIGN)
  state->convert.decoders = foreign::foreignDecoders();
#endif
  command->add_option("-i,--input,IN", state->input, "The .glb or .gltf to read")->required();
  command->add_option("-o,--output,OUT", state->output, "The .glb to write")->required();
  addQuantization(*command, state->convert);
  addKeepOrder(*command, state->convert);
  command->add_option("--report", state->report, "Write all figures to this JSON file")
      ->type_name("FILE");
  state->comparison.addOptions(*command);
  addFormatOption(*command, state->common);
  command->add_option("-j,--jobs", state->convert.thread_count, "Threads to use [1]")
      ->check(CLI::Range(1, 1024).description(""))
      ->type_name("N");
  addVerbosityOptions(*command, state->common);
  command->footer(
      "The result is decoded and compared with the source before it takes its place; sizes and\n"
      "measured errors are printed. IN may be compressed with Draco or meshoptimizer already.\n\n"
      "Examples:\n"
      "  gltf-mcc convert model.glb small.glb\n"
      "  gltf-mcc convert scene.gltf small.glb --quantize-position 12 --report sizes.json\n"
      "  gltf-mcc convert scan.glb exact.glb --lossless\n"
      "  gltf-mcc convert part.glb small.glb --max-error 0.05\n"
      "  gltf-mcc convert terrain.glb small.glb --keep-order both");
  command->callback([state, &status]() { status = state->run(); });
}

}  // namespace mcc::tool
