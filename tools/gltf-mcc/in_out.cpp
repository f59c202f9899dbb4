// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "in_out.h"

#include <algorithm>
#include <filesystem>

#include "gltf/base/path_text.h"
#include "standard_streams.h"

namespace mcc::tool {

void InOut::addOptions(CLI::App& command) {
  command.add_option("FILES", inputs, "IN and OUT");
  command.add_option("-i,--input", input, "Same as IN")->type_name("FILE");
  command.add_option("-o,--output", output, "Same as OUT, or the folder for several IN")
      ->type_name("FILE|DIR");
  command.add_flag("--in-place", may_replace_input, "Let OUT replace IN");
}

void InOut::sort(const std::string& command) {
  if (!input.empty()) inputs.insert(inputs.begin(), input);
  const bool may_be_folder = !output.empty();  // given by -o; OUT must be a file
  if (output.empty() && inputs.size() > 2) {
    throw CLI::ValidationError(command, "several inputs need a folder: -o DIR IN…");
  }
  if (output.empty() && inputs.size() == 2) {
    output = inputs.back();
    inputs.pop_back();
  }
  if (inputs.empty() || output.empty()) {
    throw CLI::ValidationError(command, inputs.empty() ? "IN is missing" : "OUT is missing");
  }
  // A GLB may have any other extension (.vrm), but these belong to other formats.
  const std::string extension = gltf::textOf(gltf::pathOf(output).extension());
  for (const char* other : {".obj", ".ply", ".stl", ".fbx", ".dae", ".usdz", ".drc"}) {
    if (extension != other) continue;
    throw CLI::ValidationError(command, output + ": only .glb and .gltf files are written");
  }
  std::error_code ignored;
  // No program would open a model without an extension. An existing path may be a device or folder.
  if (extension.empty() && !may_be_folder && !isStandardStream(output) && !output.ends_with('/') &&
      !std::filesystem::exists(gltf::pathOf(output), ignored)) {
    throw CLI::ValidationError(
        command, output + ": has no extension; name it " + output + ".glb or " + output + ".gltf");
  }
  is_batch = may_be_folder && (inputs.size() > 1 || output.ends_with('/') ||
                               std::filesystem::is_directory(gltf::pathOf(output), ignored));
  if (is_batch && std::any_of(inputs.begin(), inputs.end(), isStandardStream)) {
    throw CLI::ValidationError(command, "standard input cannot be one of several inputs");
  }
}

void InOut::refuseReplacing(const std::string& command, const std::string& loss) const {
  std::error_code ignored;
  const bool is_same =
      !is_batch && !isStandardStream(output) &&
      std::filesystem::equivalent(gltf::pathOf(inputs[0]), gltf::pathOf(output), ignored);
  if (!is_same || may_replace_input) return;
  throw CLI::ValidationError(command, output + ": is IN and OUT, and " + loss +
                                          "; choose another OUT, or pass --in-place");
}

}  // namespace mcc::tool
