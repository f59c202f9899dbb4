// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "bench/emit_draco.h"
#include "comparison_report.h"
#include "file_roles.h"
#include "foreign/decoders.h"
#include "gltf/files/file_io.h"
#include "host/text.h"
#include "interrupt.h"
#include "json/json.h"
#include "other_programs.h"
#include "program.h"
#include "report_file.h"

namespace mcc::tool {
namespace {

using gltf::Json;

struct CompareCommand : CompareOptions {
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
  result = compareWithDraco(input, file, convert, nullptr, run_count, common.is_quiet, figures);
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

/// Checks that --emit-draco replaces no file that is read.
gltf::Result checkNames(const CompareOptions& options) {
  if (options.draco_output.empty()) return {};
  FileRoles roles;
  for (const std::string& input : options.inputs) {
    roles.read(input);
    roles.readBeside(input, gltf::folderOf(input));
  }
  return roles.write(options.draco_output, "--emit-draco");
}

int run(CompareCommand& command) {
  if (!command.draco_output.empty() && command.inputs.size() != 1) {
    throw UsageError("--emit-draco", "takes one input");
  }
  const gltf::Result apart = checkNames(command);
  if (!apart.ok()) {
    reportFailure(apart);
    return kUsage;
  }
  command.convert.decoders = foreign::foreignDecoders();
  return command.run();
}

}  // namespace
}  // namespace mcc::tool

int main(int argc, char** argv) {
  return mcc::tool::runProgram(argc, argv, "compare", [](mcc::tool::Program& program) {
    static mcc::tool::CompareCommand command;
    mcc::tool::addCompare(program, command).run = [] { return mcc::tool::run(command); };
  });
}
