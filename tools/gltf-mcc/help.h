// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_HELP_H_
#define MCC_TOOL_HELP_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace mcc::tool {

/// What --help and the man page say about a command, apart from its options. Every line but the
/// last ends with '\n'.
struct CommandHelp {
  std::string usage;     ///< what follows "gltf-mcc", one line for each way to call the command
  std::string text;      ///< between the options and the examples; may be empty
  std::string examples;  ///< what follows "gltf-mcc", one line each
};

/// Formats help: how a command is called, and what its options take.
class HelpFormatter : public CLI::Formatter {
 public:
  explicit HelpFormatter(CommandHelp help);

  const CommandHelp& help() const { return help_; }

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override;
  std::string make_positionals(const CLI::App* app) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_footer(const CLI::App* app) const override;

 private:
  CommandHelp help_;
};

/// Sets the usage lines and the examples of a command; `text` is printed between the options and
/// the examples.
void setHelp(CLI::App& command, const std::string& usage, const std::string& text,
             const std::string& examples);

/// Returns what setHelp() set.
const CommandHelp& helpOf(const CLI::App& command);

/// Returns the commands that --help lists, in its order.
std::vector<const CLI::App*> commandsOf(const CLI::App& app);

/// An option as --help lists it.
struct OptionHelp {
  std::vector<std::string> names;    ///< "-o", "--output"
  std::string value;                 ///< "FILE|DIR"; empty: the option takes no value
  std::vector<std::string> choices;  ///< the words it accepts, if it accepts only these
  bool takes_file = false;
  std::string description;
};

/// Returns the options that --help lists for the command, in its order.
std::vector<OptionHelp> optionsOf(const CLI::App& command);

}  // namespace mcc::tool

#endif  // MCC_TOOL_HELP_H_
