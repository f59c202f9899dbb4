// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "usage_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "gltf/base/path_text.h"
#include "gltf/base/printable.h"
#include "help.h"
#include "suggest.h"
#include "terminal.h"

namespace mcc::tool {
namespace {

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::vector<std::string> optionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const OptionHelp& option : optionsOf(command)) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

/// Returns text like "there is no option --colour; did you mean --color?".
std::string noOption(const CLI::App& command, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  const bool is_long = name.starts_with("--");
  return "there is no option " + name + (is_long ? didYouMean(name, optionNames(command)) : "");
}

std::string withoutCommand(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : commandsOf(app)) names.push_back(command->get_name());
  const std::vector<std::string> own = optionNames(app);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with('-')) {
      const std::string name = word.substr(0, word.find('='));
      if (std::find(own.begin(), own.end(), name) == own.end()) return noOption(app, word);
      if (name == word && name == "--color") ++i;  // the only global option with a value
      continue;
    }
    const std::string extension = gltf::textOf(gltf::pathOf(word).extension());
    if (extension == ".glb" || extension == ".gltf") {
      return fmt::format("name a command before {}: {}", word, listed(names));
    }
    const std::string nearest = didYouMean(word, names);
    return fmt::format("\"{}\" is not a command; the commands are {}{}", word, listed(names),
                       nearest);
  }
  return "name a command: " + listed(names);
}

/// Returns a message about the words that are left over. CLI11 keeps them in no particular order.
std::string leftOver(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> words = app.remaining(true);
  for (const char* dash : {"--", "-"}) {
    for (const std::string& word : words) {
      if (word.starts_with(dash)) return command.get_name() + ": " + noOption(command, word);
    }
  }
  return fmt::format("{}: does not know what to do with {}", command.get_name(), listed(words));
}

/// Returns a message about a word that an option does not accept, or an empty string when that is
/// not the failure. CLI11's own message also lists the numbers of the words.
std::string unknownWord(const CLI::App& command, const CLI::Error& failure) {
  const std::string what = failure.what();
  for (const OptionHelp& option : optionsOf(command)) {
    const std::string& name = option.names.back();
    if (option.choices.empty() || !what.starts_with(name + ": ")) continue;
    const CLI::Option* given = command.get_option_no_throw(name);
    if (given == nullptr || given->results().empty()) return "";
    const std::string& word = given->results().back();
    return fmt::format("{}: {} is not one of {}{}", name, word, listed(option.choices),
                       didYouMean(word, option.choices));
  }
  return "";
}

std::string reasonOf(const CLI::App& app, const CLI::App& command, const CLI::Error& failure) {
  if (dynamic_cast<const CLI::ExtrasError*>(&failure) != nullptr) return leftOver(app, command);
  if (dynamic_cast<const CLI::ValidationError*>(&failure) != nullptr) {
    const std::string text = unknownWord(command, failure);
    if (!text.empty()) return text;
  }
  return failure.what();
}

}  // namespace

std::string usageErrorText(const CLI::App& app, const CLI::Error& failure, int argc,
                           const char* const* argv) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::string help =
      chosen.empty() ? "gltf-mcc --help" : "gltf-mcc " + chosen[0]->get_name() + " --help";
  const std::string reason =
      chosen.empty() ? withoutCommand(app, argc, argv) : reasonOf(app, *chosen[0], failure);
  return inLocale(fmt::format("{} {}\nRun \"{}\".\n", styleOfErrors().error("gltf-mcc:"),
                              gltf::printable(reason), help));
}

}  // namespace mcc::tool
