// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "usage_error.h"

#include <algorithm>

#include "host/text.h"
#include "suggest.h"
#include "terminal.h"

namespace mcc::tool {
namespace {

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::vector<std::string> optionNames(const Command& command) {
  std::vector<std::string> names;
  for (const Option* option : command.shownOptions()) {
    for (const std::string& name : option->shownNames()) names.push_back(name);
  }
  return names;
}

/// Returns text like "there is no option --colour; did you mean --color?".
std::string noOption(const Command& command, const std::string& word) {
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
std::string lineWith(const std::string& command, const std::vector<std::string>& words) {
  std::string line = "; did you mean: gltf-mcc " + command;
  for (const std::string& word : words) line += " " + shellWord(word);
  return line;
}

/// Returns the help in short.
std::string commandList(const Program& program) {
  constexpr size_t kColumn = 12;
  std::string text = "\nUsage: gltf-mcc " + program.root.usage + "\n\nCommands:\n";
  for (const Command& command : program.commands) {
    const std::string space(kColumn - std::min(kColumn, command.name.size()), ' ');
    text += "  " + command.name + space + command.summary + "\n";
  }
  return text + "\n";
}

const Command* findCommand(const Program& program, const std::string& name) {
  for (const Command& command : program.commands) {
    if (command.name == name) return &command;
  }
  return nullptr;
}

/// Returns what is wrong with a line that names no command; empty: it has no words at all.
std::string withoutCommand(const Program& program, const std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (const Command& command : program.commands) names.push_back(command.name);
  const std::vector<std::string> own = optionNames(program.root);
  const Command* const convert = findCommand(program, "convert");
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.starts_with('-')) {
      const std::string name = word.substr(0, word.find('='));
      if (contains(own, name)) {
        if (name == word && name == "--color") ++i;  // the only global option with a value
        continue;
      }
      if (convert == nullptr || !contains(optionNames(*convert), name)) {
        return noOption(program.root, word);
      }
      return "name a command before " + word + lineWith("convert", words);
    }
    if (isModelName(word)) {
      const char* command = i + 1 < words.size() ? "convert" : "inspect";
      return "name a command before " + word + ": " + listed(names) + lineWith(command, words);
    }
    const std::string synonym = synonymOf(word);
    return "\"" + word + "\" is not a command; the commands are " + listed(names) +
           (synonym.empty() ? didYouMean(word, names) : "; did you mean " + synonym + "?");
  }
  return "";
}

/// Returns a message about the words that are left over.
std::string leftOver(const Command& command, const std::vector<std::string>& words) {
  for (const char* dash : {"--", "-"}) {
    for (const std::string& word : words) {
      if (word.starts_with(dash)) return command.name + ": " + noOption(command, word);
    }
  }
  return command.name + ": does not know what to do with " + listed(words);
}

std::string reasonOf(const Parsed& parsed) {
  if (!parsed.left_over.empty()) return leftOver(*parsed.command, parsed.left_over);
  if (parsed.option == nullptr) return parsed.message;
  std::vector<std::string> accepted;
  for (const Word& word : parsed.option->words) accepted.push_back(word.text);
  return parsed.option->shownNames().back() + ": " + parsed.word + " is not one of " +
         listed(accepted) + didYouMean(parsed.word, accepted);
}

}  // namespace

std::string usageErrorText(const Program& program, const Parsed& parsed,
                           const std::vector<std::string>& words) {
  const std::string help = parsed.command == nullptr
                               ? "gltf-mcc --help"
                               : "gltf-mcc " + parsed.command->name + " --help";
  const std::string reason =
      parsed.command == nullptr ? withoutCommand(program, words) : reasonOf(parsed);
  return inLocale(styleOfErrors().error("gltf-mcc:") + " " +
                  (reason.empty() ? "name a command" : gltf::printable(reason)) + "\n" +
                  (reason.empty() ? commandList(program) : "") + "Run \"" + help + "\".\n");
}

}  // namespace mcc::tool
