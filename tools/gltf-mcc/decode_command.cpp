// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "batch.h"
#include "commands.h"
#include "host/text.h"
#include "in_out.h"
#include "interrupt.h"
#include "notes.h"
#include "progress_line.h"
#include "standard_streams.h"

namespace mcc::tool {
namespace {

struct DecodeCommand {
  CommonOptions common;
  InOut files;
  gltf::DecodeOptions decoding;
  bool is_forced = false;

  int run() {
    files.sort("decode");
    files.refuseReplacing("decode", "the compressed file would be gone");
    return files.is_batch ? runMany() : runOne();
  }

 private:
  int runMany() const;
  int runOne() const;
};

int DecodeCommand::runMany() const {
  BatchOptions options;
  options.inputs = files.inputs;
  options.folder = gltf::pathOf(files.output);
  options.common = common;
  options.job_count = decoding.thread_count;
  options.is_forced = is_forced;
  options.done_name = "decoded";
  options.copied_why = "nothing in it is compressed";
  options.settings = {
      {"decode_to", decoding.decode_to == gltf::DecodeTo::kIntegers ? "integers" : "floats"},
      {"glb_version", static_cast<uint32_t>(decoding.glb_version)}};
  options.make = [this](const std::string& file, const std::filesystem::path& to,
                        uint32_t threads_of_file, BatchResult& result) {
    gltf::DecodeReport done;
    gltf::DecodeOptions of_file = decoding;
    of_file.thread_count = threads_of_file;
    gltf::Result outcome = gltf::decodeTo({{to, nullptr}, &temporaryFiles(), &result.files},
                                          {gltf::pathOf(file), {}}, of_file, done);
    result.copied = done.copied;
    result.input_bytes = done.input_bytes;
    result.output_bytes = done.output_bytes;
    result.notes = std::move(done.notes);
    return outcome;
  };
  return runBatch(options);
}

int DecodeCommand::runOne() const {
  const std::string& input = files.inputs[0];
  StreamSource source;
  StreamSink sink;
  gltf::DecodeReport report;
  gltf::Result outcome;
  {
    const WorkProgress progress(common.is_quiet, "decoding " + input);
    outcome = source.open(input);  // may have to wait for a pipe
    if (outcome.ok()) outcome = sink.open(files.output);
    if (outcome.ok()) outcome = gltf::decodeTo(sink.sink(), source.source(), decoding, report);
  }
  if (outcome.ok()) outcome = sink.finish();
  if (!outcome.ok()) return reportFailure(outcome, input, files.output);
  if (common.is_quiet || sink.isStandardOutput()) return kDone;
  std::string text = fmt::format("{} -> {}: {} -> {} bytes\n", gltf::printable(input),
                                 gltf::printable(files.output), grouped(report.input_bytes),
                                 grouped(report.output_bytes));
  text += fmt::format("{} of {} decoded: {} triangles, {} vertices, {:.0f} ms\n",
                      counted(report.primitive_count, "primitive", "primitives"),
                      counted(report.payload_count, "payload", "payloads"),
                      grouped(report.triangle_count), grouped(report.wedge_count),
                      1000 * report.decode_seconds);
  text += notesText(report.notes, common.is_verbose ? kAllNotes : kSomeNotes);
  return printOut(text);
}

}  // namespace

void addDecode(Program& program) {
  Command& command = program.commands.emplace_back();
  auto state = std::make_shared<DecodeCommand>();
  command.name = "decode";
  command.summary = "Turn compressed files into ordinary ones";
  state->files.addOptions(command);
  command.addWords("--decode-to", state->decoding.decode_to,
                   {{"floats", gltf::DecodeTo::kFloats}, {"integers", gltf::DecodeTo::kIntegers}},
                   "What quantised attributes become [floats]");
  addThreadCount(command, state->decoding.thread_count, "Threads to use [1]");
  command.addFlag("--force", state->is_forced, "With -o DIR: also decode what is up to date");
  addGlbVersionOption(command, state->decoding.glb_version);
  addDecodedLimitOption(command, state->decoding.max_decoded_bytes);
  addVerbosityOptions(command, state->common);
  addColorOption(command);
  command.usage = "decode [OPTIONS] IN OUT\ndecode [OPTIONS] -o DIR IN…";
  command.text =
      "IN and OUT are .glb or .gltf files, or - for standard input and output. A .gltf gets its\n"
      "buffer next to it (a.gltf: a.HASH.bin). What is not compressed is copied.\n"
      "Integers (KHR_mesh_quantization) take less memory.\n"
      "A file whose geometry decodes to more than --max-decoded-bytes is refused before memory is\n"
      "taken. Without the option 256 MiB are always accepted, and more than 4 GiB never.\n"
      "With -o DIR every IN becomes a file of the same name in DIR, as with convert.";
  command.examples =
      "decode small.glb model.glb\n"
      "decode small.glb model.gltf\n"
      "decode small.glb model.glb --decode-to integers\n"
      "decode -j 4 -o models small/*.glb\n"
      "decode - - < small.glb > model.glb";
  command.run = [state]() { return state->run(); };
}

}  // namespace mcc::tool
