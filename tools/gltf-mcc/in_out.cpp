// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "in_out.h"

#include <algorithm>
#include <filesystem>

#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "host/text.h"
#include "json/json.h"
#include "standard_streams.h"
#include "suggest.h"

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;

bool isFolder(const std::string& path) {
  std::error_code ignored;
  return !isStandardStream(path) && fs::is_directory(gltf::pathOf(path), ignored);
}

/// Refuses a folder in place of IN, where its files could only become one OUT.
void refuseFolder(const std::string& command, const std::vector<std::string>& words) {
  if (words.empty() || words.size() > 2 || !isFolder(words[0])) return;
  const bool has_file = words.size() == 2 && gltf::pathOf(words[1]).has_extension();
  if (has_file) return;  // opening the folder will fail
  const std::string folder = words.size() == 2 ? shellWord(words[1]) : "DIR";
  throw UsageError(command, words[0] + ": is a folder; to " + command +
                                " all models in it, write: -o " + folder + " " +
                                shellWord(words[0]));
}

/// Refuses a tileset, before anything is said about the name of the output, which is a folder then.
void refuseTileset(const std::string& command, const std::string& input) {
  std::vector<uint8_t> bytes;
  gltf::Json json;
  const bool is_json = gltf::pathOf(input).extension() == ".json" &&
                       gltf::readFile(gltf::pathOf(input), bytes).ok() &&
                       gltf::readJson(bytes, json).ok();
  if (!is_json || !gltf::isTileset(json)) return;
  throw UsageError(command,
                   input + ": is a tileset of 3D Tiles; to compress it, write: gltf-mcc tiles " +
                       shellWord(input) + " DIR");
}

/// Returns the paths of the .glb and .gltf files in a folder, in the order of their bytes.
std::vector<std::string> modelsIn(const std::string& folder) {
  std::vector<std::string> models;
  std::error_code code;
  for (fs::directory_iterator entry(gltf::pathOf(folder), code), end; !code && entry != end;
       entry.increment(code)) {
    std::error_code ignored;
    const std::string path = gltf::textOf(entry->path());
    if (isModelName(path) && entry->is_regular_file(ignored)) models.push_back(path);
  }
  std::sort(models.begin(), models.end());
  return models;
}

/// Returns the inputs with the models of each folder in its place. A folder without models stays,
/// and fails like any other bad input, unless it is the only one.
std::vector<std::string> withModelsOfFolders(const std::string& command,
                                             const std::vector<std::string>& inputs) {
  std::vector<std::string> files;
  for (const std::string& input : inputs) {
    const std::vector<std::string> models =
        isFolder(input) ? modelsIn(input) : std::vector<std::string>{};
    if (models.empty()) files.push_back(input);
    files.insert(files.end(), models.begin(), models.end());
    if (models.empty() && inputs.size() == 1 && isFolder(input)) {
      throw UsageError(command, input + ": there is no .glb or .gltf file in this folder");
    }
  }
  return files;
}

}  // namespace

void InOut::addOptions(Command& command) {
  command.add("FILES", "", &inputs, "IN and OUT");
  command.add("-i,--input", "FILE", &input, "Same as IN");
  command.add("-o,--output", "FILE|DIR", &output, "Same as OUT, or the folder for several IN");
  command.addFlag("--in-place", may_replace_input, "Let OUT replace IN; OUT may be left out");
}

void InOut::sort(const std::string& command) {
  if (!input.empty()) inputs.insert(inputs.begin(), input);
  const bool may_be_folder = !output.empty();  // given by -o; OUT must be a file
  if (!may_be_folder) refuseFolder(command, inputs);
  if (output.empty() && inputs.size() > 2) {
    throw UsageError(command, "several inputs need a folder: -o DIR IN…");
  }
  if (output.empty() && inputs.size() == 2) {
    output = inputs.back();
    inputs.pop_back();
  }
  if (output.empty() && inputs.size() == 1 && may_replace_input) output = inputs[0];
  if (inputs.empty() || output.empty()) {
    throw UsageError(command, inputs.empty() ? "IN is missing" : "OUT is missing");
  }
  for (const std::string& path : inputs) refuseTileset(command, path);
  // A GLB may have any other extension (.vrm), but these belong to other formats.
  const std::string extension = gltf::textOf(gltf::pathOf(output).extension());
  if (isOtherFormat(output)) {
    throw UsageError(command, output + ": only .glb and .gltf files are written");
  }
  std::error_code ignored;
  // No program would open a model without an extension. An existing path may be a device or folder.
  if (extension.empty() && !may_be_folder && !isStandardStream(output) && !output.ends_with('/') &&
      !fs::exists(gltf::pathOf(output), ignored)) {
    throw UsageError(
        command, output + ": has no extension; name it " + output + ".glb or " + output + ".gltf");
  }
  is_batch = may_be_folder && (inputs.size() > 1 || output.ends_with('/') || isFolder(inputs[0]) ||
                               isFolder(output));
  if (is_batch && isModelName(output) && !output.ends_with('/') && !isFolder(output)) {
    throw UsageError(command,
                     output + ": is the name of a file, but several outputs need a folder: -o DIR");
  }
  if (is_batch) inputs = withModelsOfFolders(command, inputs);
  if (is_batch && std::any_of(inputs.begin(), inputs.end(), isStandardStream)) {
    throw UsageError(command, "standard input cannot be one of several inputs");
  }
}

void InOut::refuseReplacing(const std::string& command, const std::string& loss) const {
  std::error_code ignored;
  const bool is_same =
      !is_batch && !isStandardStream(output) &&
      std::filesystem::equivalent(gltf::pathOf(inputs[0]), gltf::pathOf(output), ignored);
  if (!is_same || may_replace_input) return;
  throw UsageError(command, output + ": is IN and OUT, and " + loss +
                                "; choose another OUT, or pass --in-place");
}

}  // namespace mcc::tool
