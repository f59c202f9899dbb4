// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "help.h"

#include "terminal.h"

namespace mcc::tool {
namespace {

/// Puts a prefix before every line of a text, and `first` before the first line.
std::string indented(const std::string& text, const std::string& first, const std::string& prefix) {
  std::string result = first;
  for (const char c : text) {
    result += c;
    if (c == '\n') result += prefix;
  }
  return result + "\n";
}

std::string heading(const std::string& text) { return styleOfOutput().bold(text); }

/// An entry of a list: a name, and what it means in a column of its own.
std::string entry(const std::string& name, const std::string& meaning) {
  constexpr size_t kColumn = 32;
  const std::string margin(kColumn, ' ');
  std::string text = "  " + name;
  text += text.size() < kColumn ? std::string(kColumn - text.size(), ' ') : "\n" + margin;
  return indented(meaning, text, margin);
}

std::string optionList(const Command& command) {
  std::string text = "\n" + heading("Options:") + "\n";
  for (const Option* option : command.shownOptions()) {
    std::string name;
    for (const std::string& one : option->shownNames()) name += (name.empty() ? "" : ",") + one;
    text += entry(name + (option->value.empty() ? "" : " " + option->value), option->help);
  }
  return text;
}

std::string pageOf(const Command& command, const std::string& command_list) {
  const std::string text = command.text.empty() ? "" : command.text + "\n\n";
  return inLocale(command.summary + "\n\n" + heading("Usage:") +
                  indented(command.usage, " gltf-mcc ", "       gltf-mcc ") + optionList(command) +
                  command_list + "\n" + text + heading("Examples:") + "\n" +
                  indented(command.examples, "  gltf-mcc ", "  gltf-mcc "));
}

}  // namespace

std::string helpOf(const Command& command) { return pageOf(command, ""); }

std::string helpOf(const Program& program) {
  std::string text = "\n" + heading("Commands:") + "\n";
  for (const Command& command : program.commands) text += entry(command.name, command.summary);
  return pageOf(program.root, text);
}

}  // namespace mcc::tool
