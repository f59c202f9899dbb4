// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "help.h"

#include <algorithm>
#include <memory>

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

std::vector<std::string> splitAt(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// Whether the value of an option is one of a set of words, as in "--grid mesh|scene", and not a
/// placeholder, as in "-o FILE|DIR".
bool isChoice(const std::string& value) {
  return value.find('|') != std::string::npos &&
         std::none_of(value.begin(), value.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
}

}  // namespace

HelpFormatter::HelpFormatter(CommandHelp help) : help_(std::move(help)) { column_width(32); }

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
  // Hidden options leave an empty line behind.
  for (size_t at = 0; (at = text.find("\n\n\n", at)) != std::string::npos;) text.erase(at, 1);
  return inLocale(std::move(text));
}

/// Leaves out what CLI11 says about the number of commands.
std::string HelpFormatter::make_description(const CLI::App* app) const {
  return app->get_description() + "\n\n";
}

std::string HelpFormatter::make_usage(const CLI::App*, std::string) const {
  return heading("Usage:") + indented(help_.usage, " gltf-mcc ", "       gltf-mcc ");
}

std::string HelpFormatter::make_group(std::string group, bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
  std::string text = "\n" + heading(group + ":") + "\n";
  for (const CLI::Option* option : options) text += make_option(option, is_positional);
  return text;
}

std::string HelpFormatter::make_subcommands(const CLI::App* app, CLI::AppFormatMode) const {
  const std::vector<const CLI::App*> commands = commandsOf(*app);
  if (commands.empty()) return "";
  std::string text = "\n" + heading("Commands:") + "\n";
  for (const CLI::App* command : commands) text += make_subcommand(command);
  return text;
}

/// Positional arguments are shown in the usage and explained in the description.
std::string HelpFormatter::make_positionals(const CLI::App*) const { return ""; }

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const bool takes_value = option->get_type_size() != 0 && !option->get_type_name().empty();
  return takes_value ? " " + option->get_type_name() : "";
}

std::string HelpFormatter::make_footer(const CLI::App*) const {
  return (help_.text.empty() ? "" : help_.text + "\n\n") + heading("Examples:") + "\n" +
         indented(help_.examples, "  gltf-mcc ", "  gltf-mcc ");
}

void setHelp(CLI::App& command, const std::string& usage, const std::string& text,
             const std::string& examples) {
  command.formatter(std::make_shared<HelpFormatter>(CommandHelp{usage, text, examples}));
  if (CLI::Option* help = command.get_help_ptr()) help->description("Print this and exit");
}

const CommandHelp& helpOf(const CLI::App& command) {
  return dynamic_cast<const HelpFormatter&>(*command.get_formatter()).help();
}

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<OptionHelp> optionsOf(const CLI::App& command) {
  std::vector<OptionHelp> options;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->nonpositional() || option->get_group().empty()) continue;
    OptionHelp help;
    for (const std::string& name : option->get_snames()) help.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) help.names.push_back("--" + name);
    if (option->get_type_size() != 0) help.value = option->get_type_name();
    if (isChoice(help.value)) help.choices = splitAt(help.value, '|');
    help.takes_file = help.value.find("FILE") != std::string::npos ||
                      help.value.find("DIR") != std::string::npos || help.value.starts_with("OUT");
    help.description = option->get_description();
    options.push_back(std::move(help));
  }
  return options;
}

}  // namespace mcc::tool
