// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "bench/measure.h"
#include "bench/measure_blocks.h"
#include "bench/measure_without.h"
#include "bench_report.h"
#include "blocks_report.h"
#include "commands.h"
#include "convert_report.h"
#include "file_roles.h"
#include "foreign/decoders.h"
#include "gltf/base/path_text.h"
#include "gltf/files/file_io.h"
#include "help.h"
#include "progress_line.h"
#include "without_report.h"

namespace mcc::tool {
namespace {

/// How long encoding is repeated, per codec and file.
constexpr double kEncodeSeconds = 2;

struct BenchCommand {
  CommonOptions common;
  gltf::ConvertOptions convert;
  std::vector<std::string> inputs;
  std::string sizes;  ///< when not empty: only this file is written and nothing is measured
  std::string apart;
  uint32_t run_count = 5;
  bool with_load = false;
  std::string without;           ///< when not empty: only this is measured
  std::vector<uint32_t> blocks;  ///< when not empty: only this is measured

  int run() const;
  int runWithout() const;
  int runBlocks() const;
  template <class Measure>
  int runEach(const Measure& measure) const;
  gltf::Result load(const std::string& input, bench::Geometry& geometry) const;
  gltf::Result measure(size_t number, const ProgressLine& line, bench::FileFigures& figures) const;
};

std::string nameOf(const std::string& input) { return gltf::textOf(gltf::pathOf(input).stem()); }

gltf::Result BenchCommand::load(const std::string& input, bench::Geometry& geometry) const {
  std::vector<uint8_t> file;
  gltf::Result loaded = gltf::readFile(input, file);
  if (!loaded.ok()) return loaded;
  loaded = bench::loadGeometry(input, std::move(file), convert, nullptr, geometry);
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

void addBench(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("bench", "Compare sizes and speed with Draco and meshoptimizer");
  auto state = std::make_shared<BenchCommand>();
  state->convert.decoders = foreign::foreignDecoders();
  command->add_option("IN", state->inputs, "The .glb or .gltf files to read")
      ->required()
      ->type_name("");
  addQuantization(*command, state->convert);
  command
      ->add_option("--runs", state->run_count,
                   "Decode at least N times, 5 or more, and take the least time [5]")
      ->check(CLI::Range(5, 1000).description(""))
      ->type_name("N");
  command
      ->add_option("--apart", state->apart,
                   "Categories, by their letters, to leave out of the means")
      ->type_name("LETTERS");
  command->add_flag("--load", state->with_load,
                    "Also load whole files with tinygltf (ours through our\n"
                    "adapter) and decode with two threads");
  command
      ->add_option("--without", state->without,
                   "Measure what the encoder's choices gain: bytes and decoding\n"
                   "time without each of them (a,b), without several together\n"
                   "(a+b), or without each one in turn (all)")
      ->type_name("FEATURES");
  command
      ->add_option("--blocks", state->blocks,
                   "Measure blocks of N triangles, 0 for none (0,65536,262144):\n"
                   "bytes, time with one and two threads, working memory")
      ->delimiter(',')
      ->allow_extra_args(false)  // the files follow
      ->type_name("N,N");
  command->add_option("--sizes", state->sizes, "Only write our bytes per stream to this file")
      ->type_name("FILE")
      ->group("");  // for tests/results
  addFormatOption(*command, state->common);
  command->add_flag("-q,--quiet", state->common.is_quiet, "Show no progress");
  addColorOption(*command);
  setHelp(
      *command, "bench [OPTIONS] IN…",
      "All codecs get the same lattices and run in turn on one thread of one process. Times are "
      "the\n"
      "least CPU time of at least N runs, from payloads in memory to new float and index arrays.\n"
      "Encoding takes longer; it is repeated for two seconds per codec and file, at most N times.\n"
      "The category of a file is the letter before '_' in names like a_bunny.glb.",
      "bench --format md models/*.glb > table.md");
  command->callback([state, &status]() { status = state->run(); });
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
