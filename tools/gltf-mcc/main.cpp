// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// gltf-mcc: compresses glTF files with KHR_mesh_collapse_compression and takes them apart again.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <map>

#include "commands.h"
#include "help.h"
#include "interrupt.h"

namespace mcc::tool {

void addFormatOption(CLI::App& command, CommonOptions& options) {
  const std::map<std::string, Format> names = {{"pretty", Format::kPretty},
                                               {"md", Format::kMarkdown},
                                               {"csv", Format::kCsv},
                                               {"json", Format::kJson}};
  command.add_option("--format", options.format, "How tables are printed")
      ->transform(CLI::CheckedTransformer(names, CLI::ignore_case).description(""))
      ->type_name("pretty|md|csv|json");
}

void addVerbosityOptions(CLI::App& command, CommonOptions& options) {
  command.add_flag("-q,--quiet", options.is_quiet, "Print errors only");
  command.add_flag("-v,--verbose", options.is_verbose, "Print more");
}

int reportFailure(const gltf::Result& result) {
  std::string line = result.message();
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';  // names come from the file
  }
  fmt::print(stderr, "gltf-mcc: {}\n", line);
  return kFailed;
}

int printOut(const std::string& text) {
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (is_written && std::fflush(stdout) == 0) return kDone;
  return reportFailure({"standard output", "cannot be written"});
}

namespace {

/// Why there is no command, when there is none.
std::string missingCommand(const CLI::App& app, int argc, char** argv) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-') continue;
    return fmt::format("\"{}\" is no command; there are {}", argv[i], names);
  }
  return "name a command: " + names;
}

int run(int argc, char** argv) {
  CLI::App app("Compresses the meshes of glTF files with KHR_mesh_collapse_compression.");
  app.name("gltf-mcc");
  app.set_version_flag("--version", MCC_VERSION);
  app.require_subcommand(1);
  app.failure_message([=](const CLI::App* failed, const CLI::Error& failure) {
    const bool has_command = !failed->get_subcommands().empty();
    const std::string what =
        has_command ? std::string(failure.what()) : missingCommand(*failed, argc, argv);
    return fmt::format("gltf-mcc: {}\nRun \"gltf-mcc --help\" or \"gltf-mcc COMMAND --help\".\n",
                       what);
  });
  int status = kDone;
  addConvert(app, status);
  addDecode(app, status);
  addInspect(app, status);
  addValidate(app, status);
#if defined(MCC_HAS_FOREIGN)
  addCompare(app, status);
  addBench(app, status);
#endif
  setHelp(
      app, "COMMAND …",
      "gltf-mcc COMMAND --help says more.\n"
      "Exit status: 0 done; 1 the input is bad or the check failed, nothing was written; 2 wrong\n"
      "usage.",
      "convert model.glb small.glb\n"
      "convert -j 4 -o small models/*.glb\n"
      "decode small.glb model.glb\n"
      "inspect small.glb\n"
      "validate small.glb");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& stop) {  // also thrown for --help and --version
    return app.exit(stop) == 0 ? kDone : kUsage;
  }
  return status;
}

}  // namespace
}  // namespace mcc::tool

int main(int argc, char** argv) {
  try {
    mcc::tool::removeTemporariesOnSignals();
    return mcc::tool::run(argc, argv);
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "gltf-mcc: %s\n", exception.what());
    return mcc::tool::kFailed;
  }
}
