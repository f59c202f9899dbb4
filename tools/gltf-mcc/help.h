// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_HELP_H_
#define MCC_TOOL_HELP_H_

#include <CLI/CLI.hpp>
#include <string>

namespace mcc::tool {

/// Help that says how a command is called and what an option takes, and no more.
class HelpFormatter : public CLI::Formatter {
 public:
  /// lines  what follows "gltf-mcc" in the usage, a line for each way to call the command.
  explicit HelpFormatter(std::string lines);

  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_positionals(const CLI::App* app) const override;
  std::string make_option_opts(const CLI::Option* option) const override;

 private:
  std::string usage_;
};

/// Sets the usage lines and the examples of a command; `text` comes between the options and them.
void setHelp(CLI::App& command, const std::string& usage, const std::string& text,
             const std::string& examples);

}  // namespace mcc::tool

#endif  // MCC_TOOL_HELP_H_
