// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// gltf-mcc: compresses glTF files with KHR_mesh_collapse_compression, and decompresses them.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>

#include "commands.h"
#include "console.h"
#include "container/payload_header.h"
#include "gltf/base/path_text.h"
#include "gltf/base/printable.h"
#include "help.h"
#include "help_pages.h"
#include "interrupt.h"
#include "mcc/gltf.h"
#include "standard_streams.h"
#include "suggest.h"
#include "terminal.h"
#include "usage_error.h"

namespace mcc::tool {

void addColorOption(CLI::App& command) {
  // main() has read its value already, so the callback does nothing.
  command
      .add_option_function<std::string>(
          "--color", [](const std::string&) {}, "Colours: on a terminal, always, or never [auto]")
      ->check(CLI::IsMember({"auto", "always", "never"}).description(""))
      ->type_name("auto|always|never");
}

void addFormatOption(CLI::App& command, CommonOptions& options) {
  const std::map<std::string, Format> names = {{"pretty", Format::kPretty},
                                               {"md", Format::kMarkdown},
                                               {"csv", Format::kCsv},
                                               {"json", Format::kJson}};
  command.add_option("--format", options.format, "How tables are printed")
      ->transform(CLI::CheckedTransformer(names, CLI::ignore_case).description(""))
      ->type_name("pretty|md|csv|json");
}

void addDecodedLimitOption(CLI::App& command, uint64_t& max_decoded_bytes) {
  command
      .add_option("--max-decoded-bytes", max_decoded_bytes,
                  "Most bytes that a file may decode to [1024 per byte of the file]")
      ->check(CLI::Range(uint64_t{1}, std::numeric_limits<uint64_t>::max()).description(""))
      ->type_name("N");
}

void addVerbosityOptions(CLI::App& command, CommonOptions& options) {
  command.add_flag("-q,--quiet", options.is_quiet, "Print errors only");
  command.add_flag("-v,--verbose", options.is_verbose, "Print more");
}

int reportFailure(const gltf::Result& result) {
  const std::string line = gltf::printable(result.message());  // may contain names from the file
  fmt::print(stderr, "{} {}\n", styleOfErrors().error("gltf-mcc:"), line);
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
  std::string text = fmt::format("gltf-mcc {}\n", MCC_VERSION);
  text += fmt::format("{}: writes and reads format {}.{}\n", gltf::kExtensionName, kVersionMajor,
                      kVersionMinor);
#if defined(MCC_HAS_FOREIGN)
  text += "reads KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_meshopt_compression";
#else
  text += "built without Draco and meshoptimizer";
#endif
  return text;
}

int run(int argc, char** argv) {
  CLI::App app("Compresses the meshes of glTF files with KHR_mesh_collapse_compression.");
  app.name("gltf-mcc");
  app.allow_windows_style_options(false);  // "/models/a.glb" is a file there, too
  app.set_version_flag("--version", versionText())
      ->description("Print versions of program and format");
  addColorOption(app);
  app.require_subcommand(1);
  app.failure_message([=](const CLI::App* failed, const CLI::Error& failure) {
    return usageErrorText(*failed, failure, argc, argv);
  });
  int status = kDone;
  addConvert(app, status);
  addDecode(app, status);
  addInspect(app, status);
  addValidate(app, status);
  addTree(app, status);
  addTiles(app, status);
#if defined(MCC_HAS_FOREIGN)
  addCompare(app, status);
  addBench(app, status);
#endif
  addHelpCommands(app, status);
  setHelp(
      app, "COMMAND …",
      "Run gltf-mcc COMMAND --help for details.\n"
      "Exit status: 0 done; 1 an input is bad or a check failed, and nothing was written for it;\n"
      "2 wrong usage. Set NO_COLOR in the environment to turn colours off.",
      "convert model.glb small.glb\n"
      "convert -j 4 -o small models/*.glb\n"
      "decode small.glb model.glb\n"
      "inspect small.glb\n"
      "validate small.glb\n"
      "tree small.glb tree.svg\n"
      "tiles city/tileset.json small-city");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& stop) {  // also thrown for --help and --version
    std::ostringstream asked_for;
    const bool is_wrong = app.exit(stop, asked_for, std::cerr) != 0;
    return is_wrong ? kUsage : printOut(asked_for.str());
  }
  return status;
}

}  // namespace
}  // namespace mcc::tool

int main(int argc, char** argv) {
  try {
    mcc::tool::removeTemporariesOnSignals();
    mcc::tool::prepareConsole();
    std::vector<std::string> words = mcc::tool::commandLine(argc, argv);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    const int count = static_cast<int>(pointers.size());
    mcc::tool::setColorMode(mcc::tool::colorModeOf(count, pointers.data()));
    return mcc::tool::run(count, pointers.data());
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "gltf-mcc: %s\n", mcc::gltf::printable(exception.what()).c_str());
    return mcc::tool::kFailed;
  }
}
