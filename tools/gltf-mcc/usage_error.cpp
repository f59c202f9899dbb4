// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "usage_error.h"

#include <fmt/format.h>

#include <algorithm>

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

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Returns the command that a word of other programs stands for, or an empty string.
std::string synonymOf(const std::string& word) {
  static constexpr struct {
    const char* word;
    const char* command;
  } kSynonyms[] = {{"compress", "convert"}, {"encode", "convert"},    {"pack", "convert"},
                   {"optimize", "convert"}, {"decompress", "decode"}, {"uncompress", "decode"},
                   {"unpack", "decode"},    {"info", "inspect"},      {"show", "inspect"},
                   {"list", "inspect"},     {"stats", "inspect"},     {"check", "validate"},
                   {"verify", "validate"},  {"draw", "tree"},         {"diff", "compare"},
                   {"benchmark", "bench"},  {"tileset", "tiles"},     {"version", "--version"}};
  for (const auto& [other, command] : kSynonyms) {
    if (word == other) return command;
  }
  return "";
}

/// Returns the command line with this command before the words, for people to copy.
std::string lineWith(const std::string& command, int argc, const char* const* argv) {
  std::string line = "; did you mean: gltf-mcc " + command;
  for (int i = 1; i < argc; ++i) line += " " + shellWord(argv[i]);
  return line;
}

/// Returns the help in short.
std::string commandList(const CLI::App& app) {
  std::string text = "\nUsage: gltf-mcc " + helpOf(app).usage + "\n\nCommands:\n";
  for (const CLI::App* command : commandsOf(app)) {
    text += fmt::format("  {:<12}{}\n", command->get_name(), command->get_description());
  }
  return text + "\n";
}

/// Returns what is wrong with a line that names no command; empty: it has no words at all.
std::string withoutCommand(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : commandsOf(app)) names.push_back(command->get_name());
  const std::vector<std::string> own = optionNames(app);
  const std::vector<std::string> of_convert = optionNames(*app.get_subcommand("convert"));
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with('-')) {
      const std::string name = word.substr(0, word.find('='));
      if (contains(own, name)) {
        if (name == word && name == "--color") ++i;  // the only global option with a value
        continue;
      }
      if (!contains(of_convert, name)) return noOption(app, word);
      return fmt::format("name a command before {}{}", word, lineWith("convert", argc, argv));
    }
    if (isModelName(word)) {
      const char* command = i + 1 < argc ? "convert" : "inspect";
      return fmt::format("name a command before {}: {}{}", word, listed(names),
                         lineWith(command, argc, argv));
    }
    const std::string synonym = synonymOf(word);
    return fmt::format(
        "\"{}\" is not a command; the commands are {}{}", word, listed(names),
        synonym.empty() ? didYouMean(word, names) : "; did you mean " + synonym + "?");
  }
  return "";
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
  return inLocale(fmt::format("{} {}\n{}Run \"{}\".\n", styleOfErrors().error("gltf-mcc:"),
                              reason.empty() ? "name a command" : gltf::printable(reason),
                              reason.empty() ? commandList(app) : "", help));
}

}  // namespace mcc::tool
