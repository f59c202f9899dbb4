// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <memory>

#include "commands.h"
#include "help.h"
#include "standard_streams.h"

namespace mcc::tool {
namespace {

struct DecodeCommand {
  CommonOptions common;
  std::string input;
  std::string output;
  gltf::DecodeTo decode_to = gltf::DecodeTo::kFloats;

  int run() const {
    StreamSource source;
    StreamSink sink;
    gltf::Result outcome = source.open(input);
    if (outcome.ok()) outcome = sink.open(output);
    gltf::DecodeReport report;
    if (outcome.ok()) outcome = gltf::decode(source.source(), sink.sink(), report, decode_to);
    if (outcome.ok()) outcome = sink.finish();
    if (!outcome.ok()) return reportFailure(outcome);
    if (common.is_quiet || sink.isStandardOutput()) return kDone;
    std::string text = fmt::format("{} -> {}: {} -> {} bytes\n", input, output,
                                   grouped(report.input_bytes), grouped(report.output_bytes));
    text +=
        fmt::format("{} primitives of {} payloads decoded: {} triangles, {} vertices, {:.0f} ms\n",
                    report.primitive_count, report.payload_count, grouped(report.triangle_count),
                    grouped(report.wedge_count), 1000 * report.decode_seconds);
    for (const std::string& note : report.notes) text += "note: " + note + "\n";
    return printOut(text);
  }
};

}  // namespace

void addDecode(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("decode", "Turn a compressed file into an ordinary one");
  auto state = std::make_shared<DecodeCommand>();
  command->add_option("-i,--input,IN", state->input, "The same as IN")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output,OUT", state->output, "The same as OUT")
      ->required()
      ->type_name("FILE");
  const std::map<std::string, gltf::DecodeTo> kinds = {{"floats", gltf::DecodeTo::kFloats},
                                                       {"integers", gltf::DecodeTo::kIntegers}};
  command->add_option("--decode-to", state->decode_to, "What quantised attributes become [floats]")
      ->transform(CLI::CheckedTransformer(kinds, CLI::ignore_case).description(""))
      ->type_name("floats|integers");
  addVerbosityOptions(*command, state->common);
  setHelp(
      *command, "decode [OPTIONS] IN OUT",
      "IN and OUT are .glb or .gltf files, or - for standard input and output. A .gltf gets its\n"
      "buffer beside it (a.gltf: a.bin). What is not compressed is copied.\n"
      "Integers (KHR_mesh_quantization) take less memory.",
      "decode small.glb model.glb\n"
      "decode small.glb model.gltf\n"
      "decode small.glb model.glb --decode-to integers\n"
      "decode - - < small.glb > model.glb");
  command->callback([state, &status]() { status = state->run(); });
}

}  // namespace mcc::tool
