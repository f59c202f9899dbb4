// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>

#include "batch.h"
#include "commands.h"
#include "convert_comparison.h"
#include "convert_report.h"
#include "file_roles.h"
#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "gltf/inspect/report.h"
#include "host/text.h"
#include "in_out.h"
#include "interrupt.h"
#include "progress_line.h"
#include "standard_streams.h"

#if defined(MCC_HAS_FOREIGN)
#include "foreign/decoders.h"
#include "foreign/simplify.h"
#endif

namespace mcc::tool {
namespace {

struct ConvertCommand {
  CommonOptions common;
  gltf::ConvertOptions convert;
  InOut files;
  std::string report;
  bool is_forced = false;
  ConvertComparison comparison;

  int run();

 private:
  int runMany() const;
  int runOne() const;
  gltf::Result checkNames() const;
  gltf::Result convertOne(StreamSource& source, Converted& converted,
                          ConvertComparison& compared) const;
};

bool isGltf(const std::string& name) {
  gltf::Container container;
  return gltf::containerOf(name, container).ok() && container.is_gltf;
}

int ConvertCommand::run() {
  files.sort("convert");
  files.refuseReplacing("convert", "the result is not the same model to the last bit");
  if (isStandardStream(report)) {
    throw UsageError("--report", "takes the name of a file; --format json prints it");
  }
  return files.is_batch ? runMany() : runOne();
}

int ConvertCommand::runMany() const {
  const bool compares = comparison.mode == "draco" || !comparison.draco_output.empty();
  if (compares) {
    throw UsageError("convert", "--compare and --emit-draco take one input; see gltf-mcc compare");
  }
  BatchOptions options;
  options.inputs = files.inputs;
  options.folder = gltf::pathOf(files.output);
  options.report = report;
  options.common = common;
  options.job_count = convert.thread_count;
  options.is_forced = is_forced;
  options.done_name = "converted";
  options.copied_why = "nothing becomes smaller";
  options.details_name = "conversion";
  options.settings = gltf::optionsJson(convert);
  options.make = [this](const std::string& file, const std::filesystem::path& to,
                        uint32_t thread_count, BatchResult& result) {
    gltf::ConvertOptions of_file = convert;
    of_file.thread_count = thread_count;
    gltf::ConvertReport done;
    const gltf::Result outcome = gltf::convertTo({{to, nullptr}, &temporaryFiles(), &result.files},
                                                 {gltf::pathOf(file), {}}, of_file, done);
    if (!outcome.ok()) return outcome;
    result.copied = done.copied;
    result.input_bytes = done.input_bytes;
    result.output_bytes = done.output_bytes;
    result.notes = done.notes;
    if (!report.empty()) {
      result.details =
          reportJson({file, gltf::textOf(to), std::move(done), {}, {}}, of_file, nullptr);
    }
    return outcome;
  };
  return runBatch(options);
}

bool isReplaced(const std::string& input, const std::string& output) {
  std::error_code ignored;
  return std::filesystem::equivalent(gltf::pathOf(input), gltf::pathOf(output), ignored);
}

/// Converts, compares, and measures the files.
gltf::Result ConvertCommand::convertOne(StreamSource& source, Converted& converted,
                                        ConvertComparison& compared) const {
  StreamSink sink;
  gltf::Result result;
  {
    WorkProgress progress(common.is_quiet, converted.input);
    progress.tell("reading", -1);
    result = source.open(converted.input);  // may have to wait for a pipe
    if (result.ok()) result = sink.open(converted.output);
    if (result.ok()) result = source.read();
  }
  if (!result.ok()) return result;
  CommonOptions shown = common;
  shown.is_quiet |= sink.isStandardOutput();
  compared.is_full = common.is_verbose || common.format != Format::kPretty || !report.empty() ||
                     comparison.mode == "draco";
  const bool compares_size = !compared.is_full && !shown.is_quiet;
  const bool is_measured = canMeasureWhole() && (!report.empty() || !shown.is_quiet);
  const std::launch policy = launchPolicy(convert.thread_count);
  std::future<WholeSize> input_size;
  if (is_measured && isReplaced(converted.input, converted.output)) {
    auto beside = readFilesBeside(gltf::pathOf(converted.input), *source.source().bytes,
                                  !isGltf(converted.output));
    input_size = std::async(policy, [&source, beside = std::move(beside)]() {
      WholeSize size = {"input"};
      size.add(*source.source().bytes);
      for (const std::vector<uint8_t>& file : beside) size.add(file);
      return size;
    });
  }
  result =
      compared.begin(source.source(), converted.output, convert, compares_size || compared.is_full);
  if (!result.ok()) return result;
  gltf::FilesInUse used;
  {
    WorkProgress progress(common.is_quiet, converted.input);
    gltf::ConvertOptions watched = convert;
    watched.progress = [&](const char* stage, double share) {
      progress.tell(stage, share);
      const bool is_checking = std::string_view(stage) == "checking";
      if (is_checking && compares_size) {
        compared.beginSize(source.source(), convert, converted.report);
      }
    };
    gltf::ListedSink listed = sink.sink();
    listed.files = &used;
    result = gltf::convertTo(listed, source.source(), watched, converted.report);
  }
  if (result.ok()) result = sink.finish();
  if (!result.ok()) return result;
  if (is_measured && !input_size.valid()) {
    input_size = std::async(policy, [&]() {
      WholeSize size = {"input"};
      size.add(*source.source().bytes);
      if (!used.input.empty()) size.addFiles(std::span(used.input).subspan(1));
      return size;
    });
  }
  std::future<WholeSize> output_size;
  if (is_measured && !converted.report.copied) {
    output_size = std::async(policy, [&]() { return sink.measure(used.output); });
  }
  result = compared.finish(source.source(), convert, converted.report, shown, !report.empty());
  converted.draco = compared.line;
  if (!result.ok() || !is_measured) return result;
  converted.sizes.push_back(input_size.get());
  if (output_size.valid()) converted.sizes.push_back(output_size.get());
  if (compared.draco_size) converted.sizes.push_back(*compared.draco_size);
  return {};
}

/// Checks that no output is also another file of the command, and that only OUT may be an input.
gltf::Result ConvertCommand::checkNames() const {
  const std::string& input = files.inputs[0];
  const std::string& draco = comparison.draco_output;
  if (report.empty() && draco.empty()) return {};
  FileRoles roles;
  const std::filesystem::path output = gltf::pathOf(files.output);
  roles.read(gltf::pathOf(input));
  roles.readBeside(gltf::pathOf(input), gltf::folderOf(output));
  roles.replace(output);
  gltf::Result apart;
  if (!draco.empty()) apart = roles.write(gltf::pathOf(draco), "--emit-draco");
  if (apart.ok() && !report.empty()) apart = roles.write(gltf::pathOf(report), "--report");
  return apart;
}

int ConvertCommand::runOne() const {
  const gltf::Result apart = checkNames();
  if (!apart.ok()) {
    reportFailure(apart);
    return kUsage;
  }
  // Checked before any work is done, because a conversion whose report cannot be written has
  // failed.
  const gltf::Result writable = report.empty() ? gltf::Result{} : checkReport(report);
  if (!writable.ok()) return reportFailure(writable);
  Converted converted{files.inputs[0], files.output, {}, {}, {}};
  StreamSource source;
  ConvertComparison compared = comparison;
  const gltf::Result outcome = convertOne(source, converted, compared);
  if (!outcome.ok()) return reportFailure(outcome, converted.input, converted.output);
  const auto json = reportJson(converted, convert, compared.json);
  if (!report.empty()) {
    const gltf::Result written = writeReport(report, printReport(json));
    if (!written.ok()) return reportFailure(written);
  }
  if (common.is_quiet || isStandardOutput(files.output)) return kDone;
  if (common.format == Format::kJson) return printOut(printReport(json));
  std::string text = reportText(converted, common) + compared.notes;
  const bool has_tables = common.hasTables() || comparison.mode == "draco";
  if (has_tables && common.format != Format::kCsv && !compared.tables.empty()) {
    text +=
        "\nPayloads beside Draco's, without what Draco cannot code. They are made again for this, "
        "and\n"
        "times are CPU times of one thread, so figures may differ from those above.\n\n" +
        compared.tables;
  }
  return printOut(text);
}

/// What --preview stands for when it comes alone.
constexpr const char* kPreviewShare = "2%";

uint32_t previewTrianglesOf(const std::string& text) {
  if (text == kPreviewShare) return gltf::kPreviewsByShare;
  uint32_t count = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, code] = std::from_chars(text.data(), end, count);
  const bool is_number = code == std::errc() && rest == end;
  if (is_number && count != gltf::kNoPreviews && count < gltf::kPreviewsByShare) return count;
  throw UsageError("--preview", fmt::format("takes a number of triangles, 1 to {}, not {}; alone, "
                                            "it stands for 2 % of those of each primitive",
                                            gltf::kPreviewsByShare - 1, text));
}

void addPreview(Command& command, gltf::ConvertOptions& options) {
  const auto text = std::make_shared<std::string>();
  Option& option =
      command.add("--preview", "[TRIANGLES]", text.get(),
                  "Put coarse versions of large primitives in front, for loaders [2 %]");
  option.when_alone = kPreviewShare;
  option.then = [text, &options]() { options.preview_triangles = previewTrianglesOf(*text); };
  option.excludes = {"--indices-only"};
}

void addKeepOrder(Command& command, gltf::ConvertOptions& options) {
  command.addFlag("--indices-only", options.indices_only,
                  "Compress only the triangles, keep the attributes as they are");
  command
      .addFlag("--drop-unused", options.drop_unused,
               "Leave out vertices that no triangle uses; not with --indices-only")
      .excludes = {"--indices-only"};
  command.addFlag("--keep-vertex-order", options.keep_vertex_order, "Keep the order of vertices");
  command.addFlag("--keep-triangle-order", options.keep_triangle_order,
                  "Keep the order of triangles, and their first corners");
}

}  // namespace

void addConvert(Program& program) {
  Command& command = program.commands.emplace_back();
  auto state = std::make_shared<ConvertCommand>();
#if defined(MCC_HAS_FOREIGN)
  state->convert.decoders = foreign::foreignDecoders();
  state->convert.simplify = foreign::simplifyMesh;
#endif
  command.name = "convert";
  command.summary = "Compress .glb and .gltf files";
  state->files.addOptions(command);
  addQuantization(command, state->convert);
  addKeepOrder(command, state->convert);
  addPreview(command, state->convert);
  command.addFlag("--fallback", state->convert.fallback,
                  "Also keep the geometry uncompressed, in OUT.HASH.fallback.bin");
  command.addFlag("--allow-larger", state->convert.allow_larger,
                  "Compress even where that makes the file larger");
  command.add("--report", "FILE", &state->report, "Write all figures to this JSON file");
  state->comparison.addOptions(command);
  addFormatOption(command, state->common);
  addThreadCount(command, state->convert.thread_count, "Threads to use [1]");
  command.addFlag("--force", state->is_forced, "With -o DIR: also convert what is up to date");
  addGlbVersionOption(command, state->convert.glb_version);
  addDecodedLimitOption(command, state->convert.max_decoded_bytes);
  addVerbosityOptions(command, state->common);
  addColorOption(command);
  command.usage = "convert [OPTIONS] IN OUT\nconvert [OPTIONS] -o DIR IN…";
  command.text =
      "IN and OUT are .glb or .gltf files, or - for standard input and output. A .gltf gets its\n"
      "buffer next to it (a.gltf: a.HASH.bin). Images in separate files stay separate, but move\n"
      "into a .glb. The result is decoded and compared with the source before it replaces OUT;\n"
      "sizes and measured errors are printed. IN may already be compressed with Draco or\n"
      "meshoptimizer (version 0 of its codec; the npm package gltf-mcc reads version 1).\n"
      "With -o DIR every IN becomes a file of the same name in DIR. A folder IN stands for the\n"
      ".glb and .gltf files in it, without its subfolders. Files that were made in DIR before, "
      "with\n"
      "the same options and from files that have not changed since, are left alone.";
  command.examples =
      "convert model.glb small.glb\n"
      "convert scene.gltf small.glb --position-bits 12 --report sizes.json\n"
      "convert scan.glb exact.glb --lossless\n"
      "convert part.glb small.glb --max-position-error 0.05\n"
      "convert -j 4 -o small models/*.glb\n"
      "convert - - < model.glb | upload";
  command.run = [state]() { return state->run(); };
}

}  // namespace mcc::tool
