// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "bench/measure.h"
#include "bench/measure_blocks.h"
#include "bench/measure_meshlets.h"
#include "bench/measure_without.h"
#include "bench_report.h"
#include "blocks_report.h"
#include "file_roles.h"
#include "foreign/decoders.h"
#include "gltf/files/file_io.h"
#include "host/text.h"
#include "meshlets_report.h"
#include "other_programs.h"
#include "program.h"
#include "progress_line.h"
#include "report_file.h"
#include "without_report.h"

namespace mcc::tool {
namespace {

/// How long encoding is repeated, per codec and file.
constexpr double kEncodeSeconds = 2;

struct BenchCommand : BenchOptions {
  int run() const;
  int runWithout() const;
  int runBlocks() const;
  int runMeshlets() const;
  template <class Measure>
  int runEach(const Measure& measure) const;
  gltf::Result load(const std::string& input, bench::Geometry& geometry) const;
  gltf::Result measure(size_t number, const ProgressLine& line, bench::FileFigures& figures) const;
};

std::string nameOf(const std::string& input) { return gltf::textOf(gltf::pathOf(input).stem()); }

gltf::Result BenchCommand::load(const std::string& input, bench::Geometry& geometry) const {
  gltf::Result loaded = gltf::readFile(input, geometry.file);
  if (!loaded.ok()) return loaded;
  loaded = bench::loadGeometry(input, geometry.file, convert, nullptr, geometry);
  if (!loaded.ok()) return loaded;
  if (geometry.inputs.empty()) return {input, "has no triangles to measure"};
  return {};
}

gltf::Result BenchCommand::measure(size_t number, const ProgressLine& line,
                                   bench::FileFigures& figures) const {
  const std::string& input = inputs[number];
  const std::string name = nameOf(input);
  const std::string place = fmt::format("[{}/{}] ", number + 1, inputs.size());
  line.show(place + name);
  bench::Geometry geometry;
  gltf::Result loaded = load(input, geometry);
  if (!loaded.ok()) return loaded;
  if (!sizes.empty()) {
    figures.name = name;
    for (const gltf::EncodedPayload& payload : geometry.payloads) {
      figures.full_bytes += payload.result.payload.size();
    }
    bench::fullStreams(geometry, figures.full_streams);
    return {};
  }
  bench::MeasureOptions options;
  options.run_count = run_count;
  options.encode_seconds = kEncodeSeconds;
  options.with_memory = true;
  options.progress = [&](const std::string& text) { line.show(place + text); };
  bench::Outcome measured = bench::measureFile(name, geometry, options, figures);
  if (measured.ok() && with_load) {
    line.show(place + name + ": load");
    std::vector<uint8_t> again;  // the geometry has taken the first copy
    loaded = gltf::readFile(input, again);
    if (!loaded.ok()) return loaded;
    measured = bench::measureLoad(input, again, convert, run_count, figures.load);
  }
  return measured.ok() ? gltf::Result{} : gltf::Result{input, measured.message};
}

/// Runs all files; one that fails does not stop the others.
int BenchCommand::run() const {
  FileRoles roles;
  for (const std::string& input : inputs) roles.read(input);
  const gltf::Result clash = sizes.empty() ? gltf::Result{} : roles.write(sizes, "--sizes");
  if (!clash.ok()) {
    reportFailure(clash);
    return kUsage;
  }
  if (!without.empty()) return runWithout();
  if (!blocks.empty()) return runBlocks();
  if (with_meshlets) return runMeshlets();
  int status = kDone;
  std::vector<bench::FileFigures> files;
  {
    const ProgressLine line(common.is_quiet);
    for (size_t i = 0; i < inputs.size(); ++i) {
      bench::FileFigures figures;
      const gltf::Result result = measure(i, line, figures);
      if (result.ok()) {
        files.push_back(std::move(figures));
      } else {
        line.clear();
        status = reportFailure(result, inputs[i], "");
      }
    }
  }
  if (files.empty()) return status;
  if (!sizes.empty()) {
    const gltf::Result written = writeReport(sizes, sizesCsv(files));
    return written.ok() ? status : reportFailure(written);
  }
  std::string text;
  switch (common.format) {
    case Format::kJson: text = benchJson(files, apart); break;
    case Format::kCsv: text = benchCsv(files); break;
    case Format::kPretty:
    case Format::kMarkdown: text = benchText(files, apart, common.format); break;
  }
  return printOut(text) == kDone ? status : kFailed;
}

int BenchCommand::runWithout() const {
  std::vector<bench::Ablation> ablations;
  if (const std::string wrong = bench::parseAblations(without, ablations); !wrong.empty()) {
    return reportFailure(
        {"--without", "there is no \"" + wrong + "\"; there are " + bench::featureNames()});
  }
  std::vector<bench::WithoutFigures> files;
  const int status =
      runEach([&](const std::string& name, const bench::Geometry& geometry, const auto& tell) {
        bench::WithoutFigures figures;
        bench::Outcome done =
            bench::measureWithout(name, geometry, ablations, run_count, tell, figures);
        if (done.ok()) files.push_back(std::move(figures));
        return done;
      });
  if (files.empty()) return status;
  return printOut(withoutReport(ablations, files, common.format)) == kDone ? status : kFailed;
}

int BenchCommand::runBlocks() const {
  std::vector<bench::BlocksOfFile> files;
  const int status =
      runEach([&](const std::string& name, const bench::Geometry& geometry, const auto& tell) {
        bench::BlocksOfFile figures;
        bench::Outcome done =
            bench::measureBlocks(name, geometry, blocks, run_count, tell, figures);
        if (done.ok()) files.push_back(std::move(figures));
        return done;
      });
  if (files.empty()) return status;
  return printOut(blocksReport(files, common.format)) == kDone ? status : kFailed;
}

int BenchCommand::runMeshlets() const {
  std::vector<bench::MeshletsOfFile> files;
  const int status =
      runEach([&](const std::string& name, const bench::Geometry& geometry, const auto& tell) {
        bench::MeshletsOfFile figures;
        bench::Outcome done = bench::measureMeshlets(name, geometry, run_count, tell, figures);
        if (done.ok()) files.push_back(std::move(figures));
        return done;
      });
  if (files.empty()) return status;
  return printOut(meshletsReport(files, common.format)) == kDone ? status : kFailed;
}

/// Loads every file and measures it. One that fails does not stop the others.
template <class Measure>
int BenchCommand::runEach(const Measure& measure) const {
  int status = kDone;
  const ProgressLine line(common.is_quiet);
  for (size_t i = 0; i < inputs.size(); ++i) {
    const std::string place = fmt::format("[{}/{}] ", i + 1, inputs.size());
    const auto tell = [&](const std::string& text) { line.show(place + text); };
    bench::Geometry geometry;
    gltf::Result result = load(inputs[i], geometry);
    if (result.ok()) {
      const bench::Outcome measured = measure(nameOf(inputs[i]), geometry, tell);
      if (!measured.ok()) result = {inputs[i], measured.message};
    }
    line.clear();
    if (!result.ok()) status = reportFailure(result, inputs[i], "");
  }
  return status;
}

}  // namespace
}  // namespace mcc::tool

int main(int argc, char** argv) {
  return mcc::tool::runProgram(argc, argv, "bench", [](mcc::tool::Program& program) {
    static mcc::tool::BenchCommand command;
    command.convert.decoders = mcc::foreign::foreignDecoders();
    mcc::tool::addBench(program, command).run = [] { return command.run(); };
  });
}
