// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <cstdio>
#include <exception>
#include <filesystem>

#include "commands.h"
#include "console.h"
#include "container/payload_header.h"
#include "gltf/base/path_text.h"
#include "gltf/base/printable.h"
#include "help.h"
#include "interrupt.h"
#include "mcc/glb.h"
#include "parse.h"
#include "standard_streams.h"
#include "suggest.h"
#include "terminal.h"
#include "usage_error.h"

namespace mcc::tool {

int reportFailure(const gltf::Result& result) {
  const std::string line = gltf::printable(result.message());  // may contain names from the file
  std::fputs((styleOfErrors().error("gltf-mcc:") + " " + line + "\n").c_str(), stderr);
  return kFailed;
}

int reportFailure(const gltf::Result& result, const std::string& input, const std::string& output) {
  namespace fs = std::filesystem;
  gltf::Result advised = result;
  std::error_code code;
  if (!isStandardStream(input) && !fs::exists(gltf::pathOf(input), code)) {
    advised.what += didYouMeanFile(input);
  } else if (fs::is_directory(gltf::pathOf(input), code)) {
    if (!output.empty())
      advised.what += ", or take all models in it with -o DIR " + shellWord(input);
  } else if (fs::is_directory(gltf::pathOf(output), code)) {
    advised.what += ", or write into it with -o " + output;
  } else {
    advised.what += howToReadOther(input);
  }
  return reportFailure(advised);
}

int printOut(const std::string& text) {
  const gltf::Result result =
      writeStandardOutput({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  return result.ok() ? kDone : reportFailure(result);
}

namespace {

std::string versionText() {
  std::string text = "gltf-mcc " MCC_VERSION "\n" + std::string(gltf::kExtensionName) +
                     ": writes and reads format " + std::to_string(kVersionMajor) + "." +
                     std::to_string(kVersionMinor) + "\n";
#if defined(MCC_HAS_FOREIGN)
  text += "reads KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_meshopt_compression\n";
#else
  text += "built without Draco and meshoptimizer\n";
#endif
  return text;
}

Command rootCommand() {
  Command root;
  root.summary = "Compresses the meshes of glTF files with KHR_mesh_collapse_compression.";
  root.usage = "COMMAND …";
  root.text =
      "Run gltf-mcc COMMAND --help for details.\n"
      "Exit status: 0 done; 1 an input is bad or a check failed, and nothing was written for it;\n"
      "2 wrong usage. Set NO_COLOR in the environment to turn colours off.";
  root.examples =
      "convert model.glb small.glb\n"
      "convert -j 4 -o small models/*.glb\n"
      "decode small.glb model.glb\n"
      "inspect small.glb\n"
      "validate small.glb\n"
      "tree small.glb tree.svg\n"
      "tiles city/tileset.json small-city";
  static bool is_asked_for;  // parse() tells
  root.addFlag("--version", is_asked_for, "Print versions of program and format");
  addColorOption(root);
  return root;
}

/// Starts gltf-mcc-NAME with the words but for the name, before which only --color can be.
int startOther(const std::string& name, std::vector<std::string> words) {
  words.erase(std::find(words.begin(), words.end(), name));
  const std::string program = "gltf-mcc-" + name;
  const std::optional<int> status = startProgram(program, words);
  if (status) return *status;
  return reportFailure(
      {program,
       "is a program of its own, and neither beside gltf-mcc nor in the PATH; install it, or "
       "build it in the sources with: tools/run " +
           name});
}

int run(const Program& program, const std::vector<std::string>& words) {
  Parsed parsed = parse(program, words);
  switch (parsed.kind) {
    case Parsed::kHelp:
      return printOut(parsed.command == nullptr ? helpOf(program) : helpOf(*parsed.command));
    case Parsed::kVersion: return printOut(versionText());
    case Parsed::kWrong: break;
    case Parsed::kCommand:
      if (!parsed.command->run) return startOther(parsed.command->name, words);
      removeTemporariesOnSignals();
      try {
        return parsed.command->run();
      } catch (const UsageError& failure) {
        parsed.message = failure.what();
      }
  }
  std::fputs(usageErrorText(program, parsed, words).c_str(), stderr);
  return kUsage;
}

}  // namespace

int runProgram(int argc, const char* const* argv, const char* own_command,
               void (*add_commands)(Program&)) {
  try {
    prepareConsole();
    std::vector<std::string> words = commandLine(argc, argv);
    if (!words.empty()) words.erase(words.begin());
    setColorMode(colorModeOf(words));
    if (own_command != nullptr) words.insert(words.begin(), own_command);
    Program program{rootCommand(), {}};
    add_commands(program);
    return run(program, words);
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "gltf-mcc: %s\n", gltf::printable(exception.what()).c_str());
    return kFailed;
  }
}

}  // namespace mcc::tool
