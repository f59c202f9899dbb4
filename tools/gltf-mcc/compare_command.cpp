// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include "compare_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "bench/emit_draco.h"
#include "comparison_report.h"
#include "convert_report.h"
#include "file_roles.h"
#include "foreign/decoders.h"
#include "gltf/base/path_text.h"
#include "gltf/base/printable.h"
#include "gltf/files/file_io.h"
#include "help.h"
#include "interrupt.h"
#include "json/json.h"
#include "progress_line.h"

namespace mcc::tool {
namespace {

using gltf::Json;

struct CompareCommand {
  CommonOptions common;
  gltf::ConvertOptions convert;
  std::vector<std::string> inputs;
  std::string draco_output;
  uint32_t run_count = 3;

  int run() const;
  gltf::Result compare(const std::string& input, bench::FileFigures& figures) const;
  std::string jsonOf(const std::vector<bench::FileFigures>& files) const;
};

std::string titleOf(const std::string& input, const bench::FileFigures& figures) {
  return fmt::format(
      "{}: {} triangles, {} vertices, {} positions in {} {}\n", gltf::printable(input),
      grouped(figures.triangle_count), grouped(figures.wedge_count), grouped(figures.vertex_count),
      figures.primitive_count, figures.primitive_count == 1 ? "primitive" : "primitives");
}

std::string CompareCommand::jsonOf(const std::vector<bench::FileFigures>& files) const {
  Json list = Json::array();
  for (const bench::FileFigures& figures : files) {
    Json file = {{"file", figures.name}};
    file.update(comparisonJson(figures));
    list.push_back(std::move(file));
  }
  const Json json = {{"tool", std::string("gltf-mcc ") + MCC_VERSION}, {"files", std::move(list)}};
  return printReport(json);
}

gltf::Result CompareCommand::compare(const std::string& input, bench::FileFigures& figures) const {
  std::vector<std::string> notes;
  std::vector<uint8_t> file;
  gltf::Result result = gltf::readFile(input, file);
  if (result.ok() && !draco_output.empty()) {
    std::vector<uint8_t> draco;
    result = bench::emitDraco(input, file, convert, draco, notes);
    if (result.ok()) result = gltf::writeFile(draco_output, draco, &temporaryFiles());
  }
  if (!result.ok()) return result;
  result = compareWithDraco(input, std::move(file), convert, nullptr, run_count, common.is_quiet,
                            figures);
  for (const std::string& note : notes) figures.notes.push_back(draco_output + ": " + note);
  return result;
}

/// Compares all files; one that fails does not stop the others.
int CompareCommand::run() const {
  int status = kDone;
  const bool is_table = common.format == Format::kPretty || common.format == Format::kMarkdown;
  std::vector<bench::FileFigures> files;
  for (const std::string& input : inputs) {
    bench::FileFigures figures;
    const gltf::Result result = compare(input, figures);
    if (!result.ok()) {
      status = reportFailure(result, input, "");
      continue;
    }
    if (is_table && !common.is_quiet) {
      std::string text = (files.empty() ? "" : "\n") + titleOf(input, figures) + "\n" +
                         comparisonText(figures, common.format);
      for (const std::string& note : figures.notes) text += "note: " + gltf::printable(note) + "\n";
      if (printOut(text) != kDone) return kFailed;
    }
    files.push_back(std::move(figures));
  }
  if (common.is_quiet || files.empty()) return status;
  std::string text;
  if (common.format == Format::kJson) {
    text = jsonOf(files);
  } else if (common.format == Format::kCsv) {
    text = comparisonCsv(files);
  } else if (files.size() > 1) {
    text = "\n" + comparisonSummary(files, common.format);
  }
  return printOut(text) == kDone ? status : kFailed;
}

}  // namespace

gltf::Result compareWithDraco(const std::string& input, std::vector<uint8_t> file,
                              const gltf::ConvertOptions& convert,
                              const bench::PrimitiveFilter& wanted, uint32_t run_count,
                              bool is_quiet, bench::FileFigures& figures) {
  const ProgressLine line(is_quiet);
  bench::Geometry geometry;
  const gltf::Result loaded =
      bench::loadGeometry(input, std::move(file), convert, wanted, geometry);
  if (!loaded.ok()) return loaded;
  if (geometry.inputs.empty()) return {input, "has no triangles to compare"};
  bench::MeasureOptions options;
  options.codecs = {bench::Codec::kMcc, bench::Codec::kDraco0, bench::Codec::kDraco3,
                    bench::Codec::kDraco5};
  options.run_count = run_count;
  options.thread_count = convert.thread_count;
  options.with_errors = true;
  options.progress = [&](const std::string& text) { line.show(text); };
  const std::string name = gltf::textOf(gltf::pathOf(input).stem());
  const bench::Outcome measured = bench::measureFile(name, geometry, options, figures);
  return measured.ok() ? gltf::Result{} : gltf::Result{input, measured.message};
}

void addCompare(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("compare", "Compare with Draco: bytes, errors, times");
  auto state = std::make_shared<CompareCommand>();
  state->convert.decoders = foreign::foreignDecoders();
  command->add_option("IN", state->inputs, "The .glb or .gltf files to read")
      ->required()
      ->type_name("");
  addQuantization(*command, state->convert);
  command->add_option("--runs", state->run_count, "Decode N times and take the least time [3]")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N");
  command
      ->add_option("--emit-draco", state->draco_output,
                   "Write IN with KHR_draco_mesh_compression, speed 0, to this .glb")
      ->type_name("OUT2");
  addFormatOption(*command, state->common);
  addVerbosityOptions(*command, state->common);
  addColorOption(*command);
  setHelp(
      *command, "compare [OPTIONS] IN…",
      "Draco gets the same lattices as our codec, at speeds 0 (smallest), 3 and 5 "
      "(glTF-Transform's\n"
      "default). \"best\" is the smaller of speeds 0 and 5. Draco's connectivity is measured on\n"
      "its own, on the mesh welded by position; \"seams\" is what its triangles take beyond that\n"
      "in the file. Draco does not support morph targets, so they are left out on both sides and\n"
      "listed below. Times are CPU times in one process, from payloads in memory to float and\n"
      "index arrays, the least of several runs.",
      "compare model.glb\n"
      "compare --quantize-position 12 --format md a.glb b.glb");
  command->callback([state, &status]() {
    if (!state->draco_output.empty() && state->inputs.size() != 1) {
      throw CLI::ValidationError("--emit-draco", "takes one input");
    }
    FileRoles roles;
    for (const std::string& input : state->inputs) {
      roles.read(input);
      if (!state->draco_output.empty()) roles.readBeside(input, gltf::folderOf(input));
    }
    if (!state->draco_output.empty()) {
      const gltf::Result apart = roles.write(state->draco_output, "--emit-draco");
      if (!apart.ok()) {
        reportFailure(apart);
        status = kUsage;
        return;
      }
    }
    status = state->run();
  });
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
