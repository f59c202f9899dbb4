// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <memory>

#include "commands.h"

namespace mcc::tool {
namespace {

struct DecodeCommand {
  CommonOptions common;
  std::string input;
  std::string output;
  gltf::DecodeTo decode_to = gltf::DecodeTo::kFloats;

  int run() const {
    gltf::DecodeReport report;
    const gltf::Result outcome = gltf::decodeFile(input, output, report, decode_to);
    if (!outcome.ok()) return reportFailure(outcome);
    if (common.is_quiet) return kDone;
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
  CLI::App* command = app.add_subcommand("decode", "Turn a compressed file into an ordinary .glb");
  auto state = std::make_shared<DecodeCommand>();
  command->add_option("-i,--input,IN", state->input, "The .glb or .gltf to read")->required();
  command->add_option("-o,--output,OUT", state->output, "The .glb to write")->required();
  const std::map<std::string, gltf::DecodeTo> kinds = {{"floats", gltf::DecodeTo::kFloats},
                                                       {"integers", gltf::DecodeTo::kIntegers}};
  command
      ->add_option("--decode-to", state->decode_to,
                   "What quantised attributes become; integers (KHR_mesh_quantization) take less "
                   "memory [floats]")
      ->transform(CLI::CheckedTransformer(kinds, CLI::ignore_case).description(""))
      ->type_name("floats|integers");
  addVerbosityOptions(*command, state->common);
  command->footer(
      "Examples:\n"
      "  gltf-mcc decode small.glb model.glb\n"
      "  gltf-mcc decode small.glb model.glb --decode-to integers\n"
      "  gltf-mcc decode -q -i small.glb -o model.glb");
  command->callback([state, &status]() { status = state->run(); });
}

}  // namespace mcc::tool
